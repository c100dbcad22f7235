"""Capsules: they roll, stand, lie on each other and conserve what they should."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from desk import Desk
from hypothesis import given, settings
from hypothesis import strategies as st
from recording import RecordingCanvas

from physicslab import World, load_scene, save_scene
from physicslab.components import Mass, Shape, Transform, Velocity
from physicslab.contacts.outlines import outlines_of
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.worlds import open_space
from physicslab.prefabs import box, capsule, circle, container
from physicslab.systems.standard import standard_systems
from physicslab.view.canvas.canvas import Look, Rounded
from physicslab.view.canvas.plain_shapes import draw_rounded
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.controls.picking import body_at


def ground() -> World:
    world = World(*standard_systems())
    box(world, (0.0, -0.5), width=20.0, height=1.0, static=True, friction=0.8, name="floor")
    return world


def height(world: World, entity: int) -> float:
    return world.component(entity, Transform).position.y


def test_its_moment_of_inertia_is_that_of_a_box_and_two_half_discs() -> None:
    world = ground()
    pill = capsule(world, (0.0, 5.0), length=2.0, radius=0.5, mass=3.0)
    world.synchronise()
    length, r = 2.0, 0.5
    inner, ends = 2.0 * r * length, math.pi * r * r
    density = 3.0 / (inner + ends)
    moment = inner * (length**2 + 4.0 * r**2) / 12.0
    moment += ends * (0.5 * r**2 + 0.25 * length**2 + 4.0 * r * length / (3.0 * math.pi))
    assert world.component(pill, Mass).inertia == pytest.approx(density * moment, rel=1e-14)


def test_lying_ones_stack_and_stay() -> None:
    world = ground()
    pills = [capsule(world, (0.0, 0.2 + 0.4 * n), length=1.0, radius=0.2, friction=0.6) for n in range(4)]
    world.run(seconds=2.0)
    for n, pill in enumerate(pills):
        transform = world.component(pill, Transform)
        assert transform.position.y == pytest.approx(0.2 + 0.4 * n, abs=4e-3)
        assert abs(transform.angle) < 1e-6
        assert abs(transform.position.x) < 1e-6


def test_a_very_short_one_rolls_as_a_disc_does() -> None:
    world = ground()
    pill = capsule(
        world, (0.0, 0.3), length=1e-6, radius=0.3, velocity=(1.0, 0.0), angular_velocity=-1.0 / 0.3
    )
    disc = circle(world, (0.0, 3.3), radius=0.3, velocity=(1.0, 0.0), angular_velocity=-1.0 / 0.3)
    box(world, (0.0, 2.5), width=20.0, height=1.0, static=True, friction=0.8)
    world.run(seconds=2.0)
    ours, theirs = world.component(pill, Transform), world.component(disc, Transform)
    assert ours.position.x == pytest.approx(theirs.position.x, abs=1e-4)
    assert ours.angle == pytest.approx(theirs.angle, abs=1e-3)


def test_upright_and_leaning_it_falls_and_comes_to_lie() -> None:
    world = ground()
    pill = capsule(world, (0.0, 0.7), length=1.0, radius=0.2, angle=0.5 * math.pi + 0.01, friction=0.6)
    world.run(seconds=4.0)
    assert height(world, pill) == pytest.approx(0.2, abs=5e-3)


@settings(max_examples=10, deadline=None)
@given(
    st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(-0.3, 0.3), st.sampled_from(("pill", "disc", "box"))
)
def test_elastic_impacts_keep_energy_and_momenta(turn: float, spin: float, aside: float, other: str) -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"))
    capsule(
        world, (-2.0, 0.0), length=1.0, radius=0.2, angle=turn, velocity=(3.0, 0.0), angular_velocity=spin,
        restitution=1.0, friction=0.4, mass=2.0,
    )  # fmt: skip
    if other == "pill":
        capsule(world, (0.0, aside), length=0.6, radius=0.3, angle=1.0, restitution=1.0, friction=0.4)
    elif other == "disc":
        circle(world, (0.0, aside), radius=0.4, restitution=1.0, friction=0.0)
    else:
        box(world, (0.0, aside), width=0.8, height=0.4, angle=0.3, restitution=1.0, friction=0.0)

    def totals() -> tuple[float, float, float]:
        x = y = spun = 0.0
        for entity in world.batch(Velocity).entities.tolist():
            mass, velocity = world.component(entity, Mass), world.component(entity, Velocity)
            place = world.component(entity, Transform).position
            x, y = x + mass.mass * velocity.linear.x, y + mass.mass * velocity.linear.y
            spun += mass.mass * place.cross(velocity.linear) + mass.inertia * velocity.angular
        return x, y, spun

    before, energy = totals(), measure_energy(world).total
    world.run(seconds=1.5)
    assert world.collisions > 0
    assert totals() == pytest.approx(before, abs=1e-9)
    lost = energy - measure_energy(world).total
    assert -1e-9 * energy < lost
    if other != "pill":  # friction takes some
        assert lost < 1e-9 * energy


def test_impact_and_friction_take_what_the_accounts_say() -> None:
    world = ground()
    for n in range(6):
        capsule(
            world, (0.3 * n, 1.0 + 0.8 * n), length=0.6, radius=0.15, angle=0.7 * n, restitution=0.3,
            velocity=(0.5 - 0.2 * n, 0.0),
        )  # fmt: skip
    world.run(seconds=3.0)
    account = measure_account(world)
    assert account.change < -20.0
    assert account.energy["impacts"] < 0.0
    assert account.energy["friction"] < 0.0
    assert abs(account.energy["numerical"]) < 1e-9 * abs(account.change)


def test_a_heap_of_them_comes_to_rest_and_sleeps_and_the_budget_closes() -> None:
    """Points that were found again in each substep let it rock at 10 mm/s for ever."""
    world, random = open_space(sleeping=True), np.random.default_rng(0)
    container(world, width=4.0, height=12.0)
    for i, turn in enumerate(random.uniform(0.0, 2.0 * math.pi, 120).tolist()):
        at = -1.6 + 0.36 * (i % 10), 0.4 + 0.36 * (i // 10)
        capsule(world, at, length=0.15, radius=0.08, angle=turn, mass=1.0)
    before = measure_energy(world).total
    world.run(seconds=2.0)
    assert world.contacts.wide.filled > 64
    account = measure_account(world).energy
    assert measure_energy(world).total - before == pytest.approx(sum(account.values()), rel=1e-9)
    assert abs(account["numerical"]) < 1e-9 * before
    world.run(seconds=6.0)
    assert world.sleep.asleep.sum() == 120


def test_in_bounds_it_bounces_and_stays() -> None:
    world = World(
        *standard_systems(), physics=PhysicsConfig(bounds=(0.0, 0.0, 4.0, 3.0), bounds_restitution=0.5)
    )
    pill = capsule(world, (1.0, 1.5), length=1.0, radius=0.25, angle=0.4, velocity=(2.0, 0.0))
    world.run(seconds=6.0)
    assert height(world, pill) == pytest.approx(0.25, abs=5e-3)


def test_a_file_keeps_it_and_goes_on_with_the_same_bits(tmp_path: Path) -> None:
    world = ground()
    pill = capsule(world, (0.0, 0.7), length=1.0, radius=0.2, angle=0.5, name="pill")
    world.run(seconds=0.5)
    save_scene(world, tmp_path / "pill.json")
    again = load_scene(tmp_path / "pill.json")
    assert again.component(again.entity("pill"), Shape).length == 1.0
    for one in (world, again):
        one.run(seconds=1.0)
    ours, theirs = world.component(pill, Transform), again.component(again.entity("pill"), Transform)
    assert (ours.position.x, ours.position.y, ours.angle) == (
        theirs.position.x,
        theirs.position.y,
        theirs.angle,
    )


@pytest.mark.parametrize(
    ("name", "value"), [("length", -1.0), ("length", 0.0), ("radius", 0.0), ("width", 1.0)]
)
def test_bad_sizes_are_refused_by_name(name: str, value: float) -> None:
    sizes: dict[str, Any] = {"length": 1.0, "radius": 0.5, name: value}
    with pytest.raises(InvalidValue, match=rf"^Shape\.{name} = {value}: must be"):
        Shape("capsule", **sizes)


def test_in_the_window_it_is_picked_painted_and_resized_by_its_outline() -> None:
    canvas = RecordingCanvas((1280, 720))
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"))
    pill = capsule(world, (1.0, 0.5), length=1.0, radius=0.25, angle=0.5 * math.pi)
    desk = Desk(world, canvas)
    camera = desk.window.camera
    desk.frames()
    (drawn,) = canvas.called("rounded")[-1:]
    assert drawn["shapes"].radius.tolist() == pytest.approx([0.25 * camera.scale])
    for place, hit in (((1.0, 1.2), pill), ((1.2, 1.0), pill), ((1.0, 1.4), None), ((1.24, 1.24), None)):
        assert body_at(world, camera, camera.to_screen(Vector2(*place))) == hit
    outlines = outlines_of(world, np.array([world.entity_index.row_of[pill]]))
    assert outlines.reach[0].tolist() == pytest.approx([0.25, 0.75])
    assert outlines.size[0] == 0.5
    handles, edits = desk.window.handles, desk.window.edits
    handles.dragged = "size"
    handles.drag(edits, pill, camera, Vector2(1.0 + 0.4, 0.5 + 0.9), snaps=False)
    handles.release(edits)
    shape = world.component(pill, Shape)
    assert (shape.length, shape.radius) == pytest.approx((1.8, 0.4))
    pygame.display.quit()


def test_it_is_painted_smoothly_and_before_that_roughly() -> None:
    surface = pygame.Surface((80, 60), depth=32)
    corners = np.zeros((1, 8, 2))
    corners[0, :] = (60.0, 30.0), *((20.0, 30.0),) * 7
    look = Look(np.array([[9, 99, 9]], np.uint8), np.array([[200, 0, 0]], np.uint8), np.zeros(1, np.int64))
    shapes = Rounded(corners, np.array([2]), np.array([12.0]))
    for draw in (
        PygameCanvas(surface).rounded,
        lambda shapes, look: draw_rounded(surface, shapes, np.zeros(1), look, 1.6),
    ):
        surface.fill((0, 0, 0))
        draw(shapes, look)
        assert surface.get_at((30, 35))[:3] == (9, 99, 9)
        assert surface.get_at((20, 18))[0] > 100, "its rim"
        assert surface.get_at((70, 40))[:3] == surface.get_at((9, 19))[:3] == (0, 0, 0), "its ends are round"
        assert surface.get_at((50, 30))[:3] == (9, 99, 9), "its outline shows how it lies, and no line"
