"""Which worlds have rigid contacts, what they do where events accumulate, and what lies beside them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from physicslab import World
from physicslab.components import Mass, Material, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.scene import load_scene, save_scene
from physicslab.prefabs import box, circle
from physicslab.stepping.rigid import Rigid
from physicslab.systems.standard import standard_systems

G = 9.81


def laboratory(contacts: str, **physics: Any) -> World:
    return World(
        *standard_systems(),
        physics=PhysicsConfig(**physics),
        simulation=SimulationConfig(contacts=contacts),
    )


def row_of_boxes(count: int) -> World:
    world = laboratory("auto")
    box(world, (0, -0.5), width=100, height=1, static=True)
    for i in range(count):
        box(world, (2.0 * i, 0.5), width=1, height=1)
    return world


def test_auto_takes_rigid_contacts_where_few_bodies_touch() -> None:
    chosen = []
    for world in (row_of_boxes(12), row_of_boxes(13)):
        world.synchronise()
        chosen.append((world.plan.contacts, world.plan.contact_reason))
    assert chosen == [("rigid", "few bodies touch"), ("soft", "more than 12 bodies can touch")]


def test_auto_leaves_stiff_springs_to_soft_contacts() -> None:
    world = row_of_boxes(2)
    world.spawn(Spring(2, 3, rest_length=2.0, stiffness=1e7))
    world.synchronise()
    assert world.plan.contacts == "soft"
    assert world.plan.contact_reason.startswith("forces act at 4.47e+03 rad/s")


def test_a_scene_that_states_nothing_has_soft_contacts(tmp_path: Path) -> None:
    world = row_of_boxes(1)
    world.simulation = replace(world.simulation, contacts=SimulationConfig().contacts)
    save_scene(world, tmp_path / "scene.json")
    loaded = load_scene(tmp_path / "scene.json")
    loaded.synchronise()
    assert (loaded.plan.contacts, loaded.plan.contact_reason) == ("soft", "asked for")


def into_a_corner(contacts: str) -> World:
    world = laboratory(contacts)
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=0.5, friction=0.1)
    box(world, (3.5, 1.5), width=1, height=5, static=True, restitution=0.5, friction=0.1)
    circle(
        world, (0.1, 0.5), radius=0.5, velocity=(2, 0), angular_velocity=-4.0, restitution=0.5, friction=0.1
    )
    return world


def test_what_rests_beside_exact_collisions_is_rigid() -> None:
    """A disc rolls into a corner: the wall's friction lifts it by mu (1 + e) v = 0.3 m/s."""
    world, alone, steppers = into_a_corner("auto"), into_a_corner("rigid"), set()
    world.contacts.read = True
    for _ in range(90):
        world.step()
        alone.step()
        assert world.stepper is not None
        steppers.add(world.stepper.name)
        if world.contacts.logged:
            break
    hit = world.contacts.log[world.contacts.logged - 1]["time"]
    assert hit == pytest.approx(2.4 / 2.0, abs=1e-12)
    expected = 0.1 * 1.5 * 2.0 - G * (world.time - hit)
    assert world.component(3, Velocity).linear.y == pytest.approx(expected, abs=1e-12)
    assert steppers == {"rigid"} and world.plan.collisions == "exact"
    for _ in range(60):
        world.step()
        alone.step()
        assert world.stepper is not None
        steppers.add(world.stepper.name)
    assert steppers == {"rigid", "event_driven"}
    place, other = world.component(3, Transform), alone.component(3, Transform)
    assert (place.position - other.position).magnitude < 1e-9
    assert place.angle == pytest.approx(other.angle, abs=1e-9)


@pytest.mark.parametrize("steps", [1, 7, 90])
def test_a_run_of_exact_collisions_beside_rigid_ones_has_the_bits_of_steps(steps: int) -> None:
    one, other = (laboratory("auto") for _ in range(2))
    for world in (one, other):
        box(world, (0, -0.5), width=20, height=1, static=True, restitution=0.5)
        for i in range(3):
            circle(world, (2.0 * i, 0.4 + 0.3 * i), radius=0.2, restitution=0.5)
        world.run(steps=20)
    one.run(steps=steps)
    for _ in range(steps):
        other.step()
    for column in ("position", "angle"):
        assert one.table(Transform)[column].tobytes() == other.table(Transform)[column].tobytes()
    assert one.collisions == other.collisions and one.contacts.logged == other.contacts.logged


@pytest.mark.parametrize("speed", [50, 500, 1e5, 1e6])
@pytest.mark.parametrize("moving", [False, True], ids=["static", "moving"])
@pytest.mark.parametrize("kind", ["circle", "box"])
@pytest.mark.parametrize("e", [0.0, 0.5])
def test_nothing_passes_through_a_thin_wall(speed: float, moving: bool, kind: str, e: float) -> None:
    world = laboratory("rigid", gravity_mode="none")
    shape = Shape.circle(0.05) if kind == "circle" else Shape.box(0.1, 0.1)
    bullet = world.spawn(Transform((-3, 0)), Velocity((speed, 0)), Mass(1), shape, Material(e, 0))
    parts = (Velocity((-1, 0)), Mass(10)) if moving else ()
    wall = world.spawn(Transform((0, 0)), Shape.box(0.005, 2), Material(e, 0), *parts)
    energy = measure_energy(world).total
    for _ in range(30):
        world.step()
        assert world.component(bullet, Transform).position.x < world.component(wall, Transform).position.x
    assert measure_energy(world).total <= energy * (1 + 1e-9)
    assert rigid_of(world).left_to_soft == rigid_of(world).by_impulses == 0


def rigid_of(world: World) -> Rigid:
    return next(stepper for stepper in world.steppers.usable if isinstance(stepper, Rigid))


def test_a_step_longer_than_the_scenes_own_is_divided() -> None:
    long, short = load_scene("slope"), load_scene("slope")
    long.step(0.5)
    short.run(seconds=0.5)
    assert (long.step_divisions, long.steps, long.time) == (30, 1, 0.5)
    apart = long.table(Transform)["position"] - short.table(Transform)["position"]
    assert np.abs(apart).max() < 1e-12


def heap(seed: int) -> World:
    """Return twelve boxes and discs that fall into a groove: more events than a step has room for."""
    random, world = np.random.default_rng(seed), laboratory("rigid")
    for side in (-1, 1):
        box(world, (1.6 * side, 1.0), width=4, height=0.3, angle=0.7 * side, static=True, friction=0.3)
    for i in range(12):
        size, place = random.uniform(0.15, 0.3), (float(random.uniform(-0.4, 0.4)), 1.2 + 0.4 * i)
        surface: Any = {"restitution": 0.4, "friction": 0.5, "mass": float(random.uniform(0.3, 3.0))}
        if i % 2:
            circle(world, place, radius=0.5 * size, **surface)
        else:
            box(world, place, width=size, height=0.8 * size, angle=float(random.uniform(-1, 1)), **surface)
    return world


def test_where_events_accumulate_the_step_is_finished_by_impulses_and_that_is_told() -> None:
    by_impulses = 0
    for seed in range(3):
        world = heap(seed)
        energy = measure_energy(world).total
        for _ in range(120):
            world.step()
            assert measure_energy(world).total <= energy + 1e-9 * abs(energy)
            energy = measure_energy(world).total
        assert rigid_of(world).left_to_soft == 0, rigid_of(world).why_soft
        told = [warning for warning in find_warnings(world) if "by impulses in 32 parts" in warning.what]
        assert len(told) == (rigid_of(world).by_impulses > 0)
        by_impulses += rigid_of(world).by_impulses
    assert by_impulses > 0
