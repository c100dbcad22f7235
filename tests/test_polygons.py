"""Polygons: what is refused and how they are centred; they touch, fly, sleep and are kept as boxes are."""

import json
import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from desk import Desk, bits
from hypothesis import example, given, settings
from hypothesis import strategies as st
from recording import RecordingCanvas

from physicslab import World, load_scene, save_scene
from physicslab.components import Mass, Shape, Transform, Velocity
from physicslab.components.vertices import centre_of_mass, centred, regular
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.assignments import assign
from physicslab.files.checks import SceneError
from physicslab.history import History, SetField
from physicslab.prefabs import box, circle, polygon
from physicslab.systems.standard import standard_systems
from physicslab.view.controls.picking import body_at

G = 9.81
TRIANGLE = [(0.0, 0.0), (3.0, 0.0), (0.0, 1.5)]
STAR = [(math.cos(0.8 * math.pi * k), math.sin(0.8 * math.pi * k)) for k in range(5)]


def ground(contacts: str = "auto", **physics: Any) -> World:
    simulation = SimulationConfig(contacts=contacts)
    world = World(*standard_systems(), physics=PhysicsConfig(**physics), simulation=simulation)
    box(world, (0.0, -0.5), width=20.0, height=1.0, static=True, friction=0.5, name="floor")
    return world


def corners(vertices: Sequence[tuple[float, float]]) -> list[Vector2]:
    return [Vector2(*vertex) for vertex in vertices]


@pytest.mark.parametrize(
    ("vertices", "allowed"),
    [
        ([(0, 0), (1, 0)], "3 to 8 vertices; these are 2"),
        (regular(9, 1.0), "3 to 8 vertices; these are 9"),
        (TRIANGLE[::-1], r"counter-clockwise; these are clockwise: take \[\[0.0, 0.0\], \[3.0, 0.0\]"),
        ([(0, 0), (1, 0), (0.2, 0.2), (0, 1)], "convex; at number 3 these turn inwards"),
        ([(0, 0), (1, 0), (2, 0), (0, 1)], "convex, each vertex a corner; number 2 is in line"),
        ([(0, 0), (1, 0), (1, 0), (0, 1)], "vertices at different places; number 2 and number 3 are at one"),
        ([(0, 0), (1, 1), (2, 2)], "convex, each vertex a corner; number 2 is in line"),
        (STAR, "convex; these go around more than once"),
        (
            TRIANGLE,
            r"that of these is at \[1.0, 0.5\] m: shift them by \[-1.0, -0.5\] m, to \[\[-1.0, -0.5\]",
        ),
        ([(0, 0), (1, math.nan), (0, 1)], r"a list of points \[x, y\] m of finite numbers"),
        ([(0, 0), (1, 0, 0), (0, 1)], r"a list of points \[x, y\] m of finite numbers"),
        (3.0, r"a list of points \[x, y\] m of finite numbers"),
    ],
)
def test_what_is_no_polygon_is_refused_by_what_it_must_be(vertices: Any, allowed: str) -> None:
    with pytest.raises(InvalidValue, match=rf"^Shape\.vertices = .*: must be .*{allowed}"):
        Shape("polygon", vertices=vertices)
    if vertices is not TRIANGLE:  # which is shifted to its centre
        with pytest.raises(InvalidValue, match=rf"^Shape\.vertices = .*: must be .*{allowed}"):
            Shape.polygon(vertices)


@pytest.mark.parametrize("radius", [0.0, 0.3, 1e3, 1e120, 1e150])
@pytest.mark.parametrize("size", [1e-300, 1e-90, 1.0, 1e150])
def test_extreme_sizes_are_taken_or_refused_by_the_field_that_is_at_fault(size: float, radius: float) -> None:
    square = [(-size, -size), (size, -size), (size, size), (-size, size)]
    if size < 1e-100:
        with pytest.raises(InvalidValue, match=r"^Shape\.vertices = .* two are at least 1e-100 m apart"):
            Shape("polygon", vertices=square, radius=radius)
    else:
        assert centre_of_mass([Vector2(*corner) for corner in square], radius).magnitude <= 1e-15 * (
            size + radius
        )
        assert Shape("polygon", vertices=square, radius=radius).radius == radius


@given(
    corners=st.integers(3, 8), size=st.floats(1e-90, 1e140), turn=st.floats(0, 6), x=st.floats(-3, 3),
    radius=st.floats(0, 2),
)  # fmt: skip
@example(corners=3, size=2.0, turn=0.0, x=0.0, radius=0.0)
def test_the_vertices_that_a_message_proposes_are_taken(
    corners: int, size: float, turn: float, x: float, radius: float
) -> None:
    at = Vector2(x * size, 0.3 * size)
    vertices = [at + corner.rotated(turn) for corner in regular(corners, size)]
    try:
        Shape("polygon", vertices=vertices, radius=radius * size)
    except InvalidValue as refused:
        shown = str(refused)
        told = shown.partition("must be")[2]  # the numbers given, before it, may be rounded
        assert "e-16" not in told or not 1e-3 < size < 1e3
        Shape("polygon", vertices=json.loads(shown.rpartition(", to ")[2]), radius=radius * size)


@pytest.mark.parametrize("line", [[0.0, 1.0, 2.0], [0.0, 2.0, 1.0], [2.0, 1.0, 0.0], [0.0, 3.0, 1.0, 2.0]])
def test_vertices_in_one_line_are_told_so(line: list[float]) -> None:
    for vertices in ([(x, 0.0) for x in line], [(0.0, x) for x in line], [(x, x) for x in line]):
        with pytest.raises(InvalidValue, match="in line with its neighbours"):
            Shape("polygon", vertices=vertices)


def test_sizes_and_vertices_of_other_kinds_are_refused() -> None:
    with pytest.raises(InvalidValue, match=r"^Shape\.vertices = \[\[0.0, 0.0\], .*left out: a box has no"):
        Shape("box", width=1.0, height=1.0, vertices=TRIANGLE)
    with pytest.raises(InvalidValue, match=r"^Shape\.width = 1.0: must be left out: a polygon has no width"):
        Shape("polygon", vertices=centred(TRIANGLE), width=1.0)
    with pytest.raises(InvalidValue, match=r"^Shape\.radius = -1.0: must be"):
        Shape("polygon", vertices=centred(TRIANGLE), radius=-1.0)


def test_a_code_that_was_written_to_the_column_and_stands_for_no_vertices_is_refused() -> None:
    world = ground()
    wedge = polygon(world, (0.0, 1.0), TRIANGLE, name="wedge")
    world.synchronise()
    world.table(Shape)["vertices"][world.entity_index.row_of[wedge]] = 10**9
    with pytest.raises(
        InvalidValue, match=r"wedge.*Shape\.vertices = 1000000000: must be a code of vertices"
    ):
        world.step()


@given(
    st.lists(st.floats(0.0, 2.0 * math.pi), min_size=3, max_size=8), st.floats(0.1, 10.0), st.floats(0.0, 2.0)
)
def test_centre_and_inertia_are_those_of_a_fine_outline(
    turns: list[float], stretch: float, radius: float
) -> None:
    turns.sort()
    if min(b - a for a, b in pairwise((*turns, turns[0] + 2.0 * math.pi))) < 0.05:
        return
    given_ = [Vector2(stretch * math.cos(turn), math.sin(turn)) for turn in turns]
    vertices = centred(given_, radius)
    assert centre_of_mass(vertices, radius).magnitude < 1e-12 * stretch
    # Each corner becomes an arc of many short sides; area and moments of those follow from triangles.
    outline: list[tuple[float, float]] = []
    for before, at, after in zip(
        (vertices[-1], *vertices), vertices, (*vertices[1:], vertices[0]), strict=False
    ):
        one, two = (math.atan2(-e.x, e.y) for e in (at - before, after - at))
        for share in np.linspace(0.0, 1.0, 2000):
            turn = one + share * ((two - one) % (2.0 * math.pi))
            outline.append((at.x + radius * math.cos(turn), at.y + radius * math.sin(turn)))
    x, y = np.array(outline).T
    p, q = np.roll(x, -1), np.roll(y, -1)
    cross = x * q - p * y
    area = 0.5 * cross.sum()
    middle = ((x + p) * cross).sum() / (6.0 * area), ((y + q) * cross).sum() / (6.0 * area)
    assert np.hypot(*middle) < 1e-6 * (stretch + radius)
    moment = (cross * (x * x + x * p + p * p + y * y + y * q + q * q)).sum() / 12.0
    world = World()
    entity = world.spawn(
        Transform(), Velocity(), Mass(2.0), Shape("polygon", radius=radius, vertices=vertices)
    )
    world.synchronise()
    assert world.component(entity, Mass).inertia == pytest.approx(2.0 * moment / area, rel=1e-6)


@pytest.mark.parametrize("contacts", ["soft", "rigid"])
def test_one_with_the_corners_of_a_box_moves_as_the_box_does(contacts: str) -> None:
    ways = []
    for as_polygon in (False, True):
        world = ground(contacts, bounds=(-4.0, -1.0, 2.5, 5.0), bounds_restitution=0.5)
        # With soft contacts boxes have a sweep of their own, which leaves out that they turn.
        angle = 0.3 if contacts == "rigid" else 0.0
        options: Any = {"velocity": (2.0, 0.0), "angle": angle, "restitution": 0.4, "friction": 0.3}
        if as_polygon:
            around = [(0.4, 0.2), (-0.4, 0.2), (-0.4, -0.2), (0.4, -0.2)]
            body = polygon(world, (0.0, 1.0), around, **options)
        else:
            body = box(world, (0.0, 1.0), width=0.8, height=0.4, **options)
        places = []
        for _ in range(12):
            world.run(seconds=0.05)
            transform = world.component(body, Transform)
            places.append((*transform.position, transform.angle))
        ways.append(np.array(places))
    assert ways[1] == pytest.approx(ways[0], abs=1e-11)


def test_one_that_does_not_turn_flies_and_meets_in_closed_form() -> None:
    world = ground()
    world.simulation = SimulationConfig(collisions="exact")
    drop = 2.0
    wedge = polygon(world, (0.0, 0.5 + drop), TRIANGLE, fixed_rotation=True, restitution=0.5)
    box(world, (8.0, 0.5), width=1.0, height=1.0, static=True)
    world.component(world.entity("floor"), Shape)
    world.run(seconds=0.9)
    met = math.sqrt(2.0 * drop / G)
    assert world.contacts.impacts["time"][0] == pytest.approx(met, abs=1e-14)
    assert world.stepper is not None and world.stepper.name in ("event_driven", "rigid")
    assert world.component(wedge, Transform).position.y > 0.0


def test_a_ball_meets_a_slope_in_time() -> None:
    world = World(simulation=SimulationConfig(collisions="exact"))
    slope = polygon(world, (1.0, 0.5), TRIANGLE, static=True, restitution=1.0, friction=0.0)
    ball = circle(world, (1.2, 3.0), radius=0.1, restitution=1.0, friction=0.0)
    world.run(seconds=1.0)
    # The slope goes from (3, 0) to (0, 1.5); the ball touches where its centre is 0.1 m from it.
    height = 1.5 - 0.5 * 1.2 + 0.1 * math.hypot(1.0, 0.5)
    assert slope and world.contacts.impacts["time"][0] == pytest.approx(
        math.sqrt(2.0 * (3.0 - height) / G), abs=1e-14
    )
    assert measure_account(world).energy["impacts"] == pytest.approx(0.0, abs=1e-12)
    assert world.component(ball, Velocity).linear.x > 1.0


@settings(max_examples=10, deadline=None)
@given(st.integers(3, 8), st.integers(3, 8), st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(-0.3, 0.3))
def test_elastic_impacts_keep_energy_and_momenta(
    count: int, other: int, turn: float, spin: float, aside: float
) -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"))
    polygon(
        world, (-2.0, 0.0), regular(count, 0.5), angle=turn, velocity=(3.0, 0.0), angular_velocity=spin,
        restitution=1.0, friction=0.0, mass=2.0,
    )  # fmt: skip
    polygon(world, (0.0, aside), regular(other, 0.4), radius=0.05, angle=1.0, restitution=1.0, friction=0.0)

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
    assert measure_energy(world).total == pytest.approx(energy, rel=1e-9)


@settings(max_examples=20, deadline=None)
@given(st.integers(3, 8), st.floats(20.0, 5000.0), st.floats(0.0, 6.0), st.floats(-1.0, 1.0))
def test_a_fast_one_goes_through_no_thin_one(count: int, speed: float, turn: float, aside: float) -> None:
    world = World(physics=PhysicsConfig(gravity_mode="none"), simulation=SimulationConfig(contacts="soft"))
    blade = [(-0.001, 0.0), (0.0, -5.0), (0.001, 0.0), (0.0, 5.0)]
    polygon(world, (0.0, 0.0), blade, static=True)
    flier = polygon(
        world, (-2.0, aside), regular(count, 0.05), angle=turn, velocity=(speed, 0.0), fixed_rotation=True
    )
    for _ in range(4 + int(150.0 / speed)):
        world.step()
        assert world.component(flier, Transform).position.x < 0.0
    assert world.collisions > 0


def test_a_heap_falls_asleep() -> None:
    world = ground()
    for x in (-2.0, 2.0):
        box(world, (x, 5.0), width=0.5, height=12.0, static=True)
    for n in range(70):
        around = regular((3, 4, 5, 6, 8)[n % 5], 0.3)
        polygon(world, (-1.2 + 0.6 * (n % 5), 0.4 + 0.65 * (n // 5)), around, angle=0.7 * n)
    world.run(seconds=8.0)
    assert world.sleep.count == 70
    assert abs(measure_account(world).energy["numerical"]) < 1e-9 * abs(measure_account(world).change)


def test_a_file_keeps_it_and_goes_on_with_the_same_bits(tmp_path: Path) -> None:
    world = ground()
    polygon(world, (0.0, 1.0), TRIANGLE, angle=0.5, name="wedge", radius=0.1)
    world.run(seconds=0.4)
    save_scene(world, tmp_path / "wedge.json")
    again = load_scene(tmp_path / "wedge.json")
    assert again.component(again.entity("wedge"), Shape).vertices == centred(TRIANGLE, 0.1)
    for one in (world, again):
        one.run(seconds=0.6)
    assert bits(world) == bits(again)
    document = json.loads((tmp_path / "wedge.json").read_text())
    del document["entities"][1]["Shape"]["vertices"]
    (tmp_path / "wedge.json").write_text(json.dumps(document))
    with pytest.raises(ValueError, match=r'entity "wedge": Shape\.vertices = \[\]: must be 3 to 8 vertices'):
        load_scene(tmp_path / "wedge.json")


def test_an_edit_of_vertices_is_undone_and_done_again() -> None:
    world = ground()
    wedge = polygon(world, (0.0, 1.0), TRIANGLE)
    history = History(world)
    history.step(5)
    before = bits(world)
    mirrored = [[-vertex.x, vertex.y] for vertex in reversed(world.component(wedge, Shape).vertices)]
    history.do(SetField(wedge, "Shape", "vertices", mirrored))
    mirrored[0][0] = 5.0  # the list that was given
    history.step(60)
    after = bits(world)
    history.undo()
    history.undo()
    assert bits(world) == before
    assert world.component(wedge, Shape).vertices == centred(TRIANGLE)
    history.redo()
    assert world.component(wedge, Shape).vertices[0].x == -centred(TRIANGLE)[2].x
    history.step(60)
    assert bits(world) == after


def test_vertices_are_set_from_the_command_line() -> None:
    world = ground()
    wedge = polygon(world, (0.0, 1.0), TRIANGLE, name="wedge")
    assign(world, ["wedge.Shape.vertices=[[-1, -1], [2, -1], [-1, 4/2]] cm"])
    assert world.component(wedge, Shape).vertices == tuple(
        corners([(-0.01, -0.01), (0.02, -0.01), (-0.01, 0.02)])
    )
    with pytest.raises(
        SceneError, match=r"wedge.*vertices = .3.: .3. is no list of points \[\[x, y\], ...\]"
    ):
        assign(world, ["wedge.Shape.vertices=3"])


def test_in_the_window_it_is_picked_painted_resized_and_listed() -> None:
    canvas = RecordingCanvas((1280, 720))
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"))
    wedge = polygon(world, (1.0, 0.5), TRIANGLE, angle=0.5 * math.pi)
    desk = Desk(world, canvas)
    camera = desk.window.camera
    desk.frames()
    (drawn,) = canvas.called("rounded")[-1:]
    assert drawn["shapes"].vertices.tolist() == [3]
    # It lies with its right angle at (1.5, -0.5), and goes up to (1.5, 2.5) and left to (0, -0.5).
    for place, hit in (((1.4, 2.0), wedge), ((0.2, -0.45), wedge), ((0.5, 1.0), None), ((1.6, 0.0), None)):
        assert body_at(world, camera, camera.to_screen(Vector2(*place))) == hit
    handles, edits = desk.window.handles, desk.window.edits
    (size,) = (handle for handle in handles.of(world, wedge, camera) if handle.kind == "size")
    handles.dragged = "size"
    middle = Vector2(1.0, 0.5)
    handles.drag(edits, wedge, camera, middle + 2.0 * (size.place - middle), snaps=False)
    handles.release(edits)
    for vertex, wanted in zip(world.component(wedge, Shape).vertices, centred(TRIANGLE), strict=True):
        assert tuple(vertex) == pytest.approx(tuple(2.0 * wanted), abs=1e-9)
    pygame.display.quit()
