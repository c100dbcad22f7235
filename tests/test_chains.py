"""Chains: their seams take no energy, their solid side holds what comes, and a file keeps them."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from desk import Desk, bits
from hypothesis import given, settings
from hypothesis import strategies as st
from recording import RecordingCanvas

from physicslab import SceneError, World, load_scene, save_scene
from physicslab.components import Mass, Shape, Transform, Velocity
from physicslab.components.vertices import regular
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.kernels.near_counts import ACTIVE
from physicslab.prefabs import box, circle, ground, loop, polygon
from physicslab.view.controls.picking import body_at

LEVEL = [(20.0 - 0.1 * k, 0.0) for k in range(300)]


def put(world: World, what: str, x: float, **options: Any) -> int:
    if what == "ball":
        return circle(world, (x, 0.2), radius=0.2, **options)
    if what == "box":
        return box(world, (x, 0.2), width=0.5, height=0.4, **options)
    return polygon(world, (x, 0.2 * math.cos(math.pi / 6)), regular(6, 0.2), **options)


def test_a_ball_is_near_few_segments_however_long_the_chain_is() -> None:
    """The margin of a body is a share of its reach: with that of a chain of 200 m a ball had 80 pairs."""
    world = World(simulation=SimulationConfig(contacts="soft"))
    world.spawn(Transform(), Shape.chain([(100.0 - 0.2 * k, 0.1 * math.sin(0.2 * k)) for k in range(1000)]))
    for n in range(20):
        put(world, "ball", 8.0 * n - 80.0)
    world.run(steps=30)
    assert world.contacts.recorded < 20 * 8 and world.contacts.counts[ACTIVE] >= 10


@pytest.mark.parametrize("contacts", ["rigid", "soft"])
@pytest.mark.parametrize("what", ["ball", "box", "six"])
@pytest.mark.parametrize("bend", [0.2, 1.0])
def test_nothing_touches_it_from_behind(bend: float, what: str, contacts: str) -> None:
    """Arcs of a bend had thrown what was near, two metres behind them, to the other side in a step."""
    world = World(simulation=SimulationConfig(contacts=contacts))
    world.spawn(
        Transform(), Shape.chain([(-4.0, 2.0 * bend), (-2.0, 0.5 * bend), (0.0, 0.0), (2.0, 0.3 * bend)])
    )
    falls = put(world, what, -1.5, friction=0.5)
    world.component(falls, Transform).position = (-1.5, 2.4)
    for _ in range(36):  # until its middle is at the chain
        other = world.copy()
        other.step()
        world.step()
        assert bits(other) == bits(world)
        assert world.component(falls, Transform).position.y == pytest.approx(
            2.4 - 4.905 * world.time**2, abs=0.02
        )
    assert world.collisions == 0


@pytest.mark.parametrize("contacts", ["rigid", "soft"])
@pytest.mark.parametrize("speed", [1.0, 10.0, 100.0])
@pytest.mark.parametrize("what", ["ball", "box", "six"])
def test_seams_take_nothing(what: str, speed: float, contacts: str) -> None:
    world = World(simulation=SimulationConfig(contacts=contacts))
    ground(world, LEVEL, friction=0.0)
    slider = put(world, what, -8.0, velocity=(speed, 0.0), friction=0.0)
    world.run(seconds=min(0.5, 25.0 / speed))
    velocity = world.component(slider, Velocity)
    assert velocity.linear.x == speed
    assert abs(velocity.linear.y) < 1e-6
    assert world.collisions == 0
    assert world.component(slider, Transform).position.x > -8.0 + 0.9 * min(0.5 * speed, 25.0)


def test_a_ball_rolls_over_seams_as_over_a_box() -> None:
    ways = []
    for chained in (True, False):
        world = World()
        if chained:
            ground(world, LEVEL, friction=0.8)
        else:
            box(world, (0.0, -0.5), width=60.0, height=1.0, static=True, friction=0.8)
        ball = put(world, "ball", -8.0, velocity=(5.0, 0.0), angular_velocity=-25.0, friction=0.8)
        world.run(seconds=1.0)
        transform = world.component(ball, Transform)
        ways.append((transform.position.x, transform.position.y, transform.angle))
    assert ways[0] == pytest.approx(ways[1], abs=1e-9)


@settings(max_examples=20, deadline=None)
@given(
    st.integers(3, 8), st.floats(0.0, 0.1), st.floats(0.0, 6.0), st.floats(20.0, 3000.0), st.floats(-1.5, 1.5)
)
def test_nothing_goes_through_a_valley(
    corners: int, radius: float, turn: float, speed: float, aside: float
) -> None:
    world = World()
    valley = [(4.0 - 0.2 * k, 0.1 * (4.0 - 0.2 * k) ** 2) for k in range(41)]
    ground(world, valley)
    flier = polygon(
        world, (aside, 5.0), regular(corners, 0.15), radius=radius, angle=turn, velocity=(0.0, -speed),
        fixed_rotation=True,
    )  # fmt: skip
    for _ in range(30):
        world.step()
        place = world.component(flier, Transform).position
        assert place.y > 0.1 * place.x**2 - 1e-3 or abs(place.x) > 4.0
    assert world.collisions > 0


def test_a_crowd_that_slides_over_hills_keeps_its_energy() -> None:
    """Many contacts are followed within a step: not beyond the end of a segment."""
    world = World(simulation=SimulationConfig(contacts="soft", collisions="step", sleeping=False))
    ground(world, [(50.0 - 0.5 * k, 0.4 * math.cos(0.25 * (50.0 - 0.5 * k))) for k in range(200)], friction=0)
    for i in range(80):
        x, speed = i - 40.0, 0.3
        slope = math.atan(-0.1 * math.sin(0.25 * x))
        aside = Vector2(-math.sin(slope), math.cos(slope)) * 0.2
        at = Vector2(x, 0.4 * math.cos(0.25 * x)) + aside
        along = Vector2(math.cos(slope), math.sin(slope)) * speed
        box(world, at, width=0.4, height=0.4, angle=slope, velocity=along, friction=0.0)
    before = measure_energy(world)
    world.run(seconds=1.0)
    assert world.contacts.wide.filled > 0
    assert measure_energy(world).total == pytest.approx(before.total, abs=0.03 * before.kinetic)


def test_it_is_solid_on_its_left_alone() -> None:
    for turned, stays in ((False, True), (True, False)):
        world = World()
        line = [(2.0, 0.0), (0.5, 0.0), (-2.0, 0.0)]
        ground(world, line[::-1] if turned else line)
        ball = put(world, "ball", 0.0)
        world.run(seconds=1.0)
        assert (world.component(ball, Transform).position.y > 0.19) == stays


@pytest.mark.parametrize("turned", [False, True])
def test_who_comes_from_the_solid_side_is_told_of_the_order_of_vertices(turned: bool) -> None:
    world = World()
    vertices = [(-3.0, 1.0), (-1.0, 0.3), (1.0, 0.0), (3.0, 0.5)]
    world.spawn(Transform(), Shape.chain(vertices[::-1] if turned else vertices))
    circle(world, (-1.5, 1.0), radius=0.15, velocity=(0.5, 0.0))
    world.run(seconds=1.0)
    told = [warning for warning in find_warnings(world) if "vertices of a chain" in str(warning)]
    assert len(told) == (0 if turned else 1)


def test_corners_ends_and_valleys_hold_what_rests_there() -> None:
    world = World()
    ground(world, [(2.0, -1.0), (0.0, 0.0), (-2.0, -1.0)], friction=0.8)
    ridden = box(world, (0.0, 0.2), width=0.8, height=0.4, friction=0.8)
    ground(world, [(12.0, 1.0), (10.0, 0.0), (8.0, 1.0)], friction=0.0)
    caught = circle(world, (10.0, 0.5), radius=0.3, friction=0.0)
    ground(world, [(22.0, 0.0), (20.0, 0.0)], friction=0.8)
    hanging = box(world, (19.9, 0.2), width=0.8, height=0.4, friction=0.8)
    falling = box(world, (22.1, 0.2), width=0.8, height=0.4, friction=0.8)
    world.run(seconds=1.5)
    assert world.component(ridden, Transform).position.y == pytest.approx(0.2, abs=2e-3)
    place = world.component(caught, Transform).position
    assert (place.x, place.y) == pytest.approx((10.0, 0.3 * math.hypot(1.0, 0.5)), abs=3e-3)
    assert world.component(hanging, Transform).position.y < -1.0
    assert world.component(falling, Transform).position.y < -1.0


def test_a_closed_one_has_no_end() -> None:
    world = World(physics=PhysicsConfig(gravity_mode="none"))
    room = [Vector2.from_angle(-0.25 * math.pi * k, 2.0) for k in range(8)]
    ground(world, [*room, room[0]], restitution=1.0, friction=0.0)
    balls = [
        circle(
            world,
            (0.4 * k - 0.6, 0.1 * k),
            radius=0.15,
            velocity=(3.0 - k, 2.0),
            restitution=1.0,
            friction=0.0,
        )
        for k in range(4)
    ]
    before = measure_energy(world).total
    world.run(seconds=5.0)
    for ball in balls:
        assert world.component(ball, Transform).position.magnitude < 1.9
    assert world.collisions > 20
    assert measure_energy(world).total == pytest.approx(before, rel=1e-9)
    assert abs(measure_account(world).energy["numerical"]) < 1e-9 * before


def test_a_ball_goes_around_a_loop_if_it_is_fast_enough() -> None:
    radius, ball = 2.0, 0.2
    inner = radius - ball
    for share, passes, segments, contacts in (
        (1.001, True, 24, "rigid"),
        (1.001, True, 900, "rigid"),
        (0.95, False, 50, "rigid"),
        (1.011, True, 50, "soft"),
        (0.95, False, 900, "soft"),
    ):
        world = World(simulation=SimulationConfig(contacts=contacts))
        loop(world, (0.0, 0.0), radius=radius, run=1.0, segments=segments, friction=0.0)
        speed = share * math.sqrt(5.0 * 9.81 * inner)
        slider = circle(world, (-0.3, ball), radius=ball, velocity=(speed, 0.0), friction=0.0)
        highest, left = 0.0, False
        for _ in range(90):
            world.step()
            place = world.component(slider, Transform).position
            highest = max(highest, place.y)
            left |= place.x < -0.9 * inner and highest > radius + 0.99 * inner
        assert left == passes


@pytest.mark.parametrize(
    ("vertices", "allowed"),
    [
        ([(0, 0)], "2 to 1000 vertices; these are 1"),
        ([(0.01 * k, 0.0) for k in range(1001)], "2 to 1000 vertices; these are 1001"),
        ([(0, 0), (1, 0), (1, 0)], "vertices at different places; number 2 and number 3 are at one"),
        ([(0, 0), (1, 0), (0, 0)], "open, or a loop of more than two segments"),
        ([(0, 0), (math.inf, 0)], r"a list of points \[x, y\] m of finite numbers"),
    ],
)
def test_what_is_no_chain_is_refused(vertices: Any, allowed: str) -> None:
    with pytest.raises(InvalidValue, match=rf"^Shape\.vertices = .*: must be .*{allowed}"):
        Shape("chain", vertices=vertices)


def test_one_that_moves_is_refused(tmp_path: Path) -> None:
    world = World()
    world.spawn(Transform(), Velocity(), Mass(1.0), Shape.chain([(1, 0), (0, 0)]), name="belt")
    with pytest.raises(
        InvalidValue, match=r"belt: Shape\.kind = .chain.: must be that of a body without Velocity"
    ):
        world.step()
    entity = {
        "id": "belt",
        "Transform": {},
        "Velocity": {},
        "Shape": {"kind": "chain", "vertices": [[1, 0], [0, 0]]},
    }
    (tmp_path / "belt.json").write_text(json.dumps({"format": "physicslab-scene/1", "entities": [entity]}))
    with pytest.raises(
        SceneError, match=r'entity "belt": Shape\.kind = "chain": must be that of a body without'
    ):
        load_scene(tmp_path / "belt.json")


def test_a_file_keeps_its_contacts_and_goes_on_with_the_same_bits(tmp_path: Path) -> None:
    world = World()
    ground(world, [(3.0 - 0.3 * k, 0.05 * (3.0 - 0.3 * k) ** 2) for k in range(21)], name="valley")
    for k in range(3):
        put(world, ("ball", "box", "six")[k], k - 1.0, velocity=(0.5, 0.0))
    world.run(seconds=0.5)
    save_scene(world, tmp_path / "valley.json")
    again = load_scene(tmp_path / "valley.json")
    for one in (world, again):
        one.run(seconds=0.5)
    assert bits(world) == bits(again)
    assert world.plan.contacts == "rigid"


def test_in_the_window_it_is_painted_picked_and_resized() -> None:
    canvas = RecordingCanvas((1280, 720))
    world = World()
    hill = ground(world, [(2.0, 0.0), (0.0, 1.0), (-2.0, 0.0)])
    put(world, "ball", 3.0)
    desk = Desk(world, canvas)
    camera = desk.window.camera
    desk.frames()
    starts = [np.round(call["start"]).tolist() for call in canvas.called("lines") if len(call["start"]) == 2]
    assert [[840.0, 360.0], [640.0, 260.0]] in starts
    assert body_at(world, camera, camera.to_screen(Vector2(1.0, 0.5))) == hill
    assert body_at(world, camera, camera.to_screen(Vector2(0.0, 0.5))) != hill
    handles, edits = desk.window.handles, desk.window.edits
    handles.dragged = "size"
    handles.drag(edits, hill, camera, Vector2(4.0, 0.0), snaps=False)
    handles.release(edits)
    assert world.component(hill, Shape).vertices[1] == Vector2(0.0, 2.0)
    pygame.display.quit()
