"""What an edit puts beyond the bounds comes back in, whatever is fixed there."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from desk import empty_world
from hypothesis import example, given, settings
from hypothesis import strategies as st

from physicslab.components import Layer, Material, Medium, Shape, Transform, Velocity
from physicslab.contacts.outlines import outlines_of, overlap
from physicslab.contacts.report import count_near_pairs
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene
from physicslab.lab.peers.peer import find_contacts
from physicslab.prefabs import box, capsule, circle, polygon
from physicslab.world import World

WALLS = (-5.8, -0.4, 5.8, 5.8)
LIMIT = 0.02
"""Share of its size by which a body may be beyond the bounds, as what is pressed against them."""


def room(contacts: str = "soft", **physics: Any) -> World:
    """Return a room of bounds with a floor that ends at both walls, a pillar in a corner, and a ramp."""
    world = empty_world(bounds=WALLS, **physics)
    world.simulation = SimulationConfig(contacts=contacts)
    box(world, (0.0, -0.2), width=11.6, height=0.4, static=True, friction=0.6)
    box(world, (5.4, 1.0), width=0.8, height=2.0, static=True, friction=0.6)
    box(world, (-4.0, 0.9), width=3.2, height=0.16, angle=-0.42, static=True, friction=0.6)
    return world


def outside(world: World, body: int) -> float:
    """Return by how much a body is beyond the bounds, as a share of its size; negative inside."""
    row = np.array([world.entity_index.row_of[body]])
    shape = outlines_of(world, row)
    low, high = (shape.place - shape.reach)[0], (shape.place + shape.reach)[0]
    xmin, ymin, xmax, ymax = WALLS
    beyond = max(xmin - low[0], ymin - low[1], high[0] - xmax, high[1] - ymax)
    return float(beyond / shape.size[0])


DEEP = 0.1
"""Share of its size up to which contacts leave a body that is wedged in: they move apart what is deeper."""


def deepest(world: World, body: int) -> float:
    """Return by how much a body overlaps anything fixed, as a share of its size."""
    rows = world.batch(Transform, Shape).rows
    shapes, fixed = outlines_of(world, rows), ~world.table(Velocity).present[rows]
    n = int(np.flatnonzero(rows == world.entity_index.row_of[body])[0])
    depths = [overlap(shapes, int(m), shapes, n)[0] for m in np.flatnonzero(fixed)]
    return max(depths) / float(shapes.size[n])


def test_a_box_held_between_the_floor_and_the_wall_comes_back_in() -> None:
    world = load_scene("sandbox")
    body = box(world, (6.05, -0.15), width=0.5, height=0.5, mass=1.25)
    world.run(seconds=1.0)
    assert outside(world, body) < 1e-3 and deepest(world, body) < 1e-2
    assert world.component(body, Velocity).linear.magnitude < 0.01


@pytest.mark.parametrize("contacts", ["soft", "rigid"])
@settings(max_examples=60, deadline=None)
@given(
    x=st.floats(-9.0, 9.0),
    y=st.floats(-4.0, 9.0),
    size=st.floats(0.1, 1.2),
    angle=st.floats(-math.pi, math.pi),
    is_box=st.booleans(),
    pulled=st.booleans(),
)
@example(x=-2.5, y=-1.0, size=0.75, angle=0.0, is_box=True, pulled=False)  # wedged between ramp and floor
def test_wherever_a_body_is_put_it_is_inside_within_a_second(
    contacts: str, x: float, y: float, size: float, angle: float, is_box: bool, pulled: bool
) -> None:
    world = room(contacts, gravity_mode="linear" if pulled else "none")
    if is_box:
        body = box(world, (x, y), width=size, height=0.7 * size, angle=angle, mass=2.0)
    else:
        body = circle(world, (x, y), radius=0.5 * size, mass=2.0)
    world.synchronise()
    was_outside = outside(world, body) > LIMIT
    fastest = 0.0
    for _ in range(60):
        world.step()
        velocity = world.component(body, Velocity)
        fastest = max(fastest, velocity.linear.magnitude)
    assert outside(world, body) <= LIMIT
    if was_outside:
        assert deepest(world, body) <= DEEP + 1e-9
    fall = math.sqrt(2.0 * 9.81 * (WALLS[3] - WALLS[1])) if pulled else 0.0
    assert fastest <= fall + 2.0, "nothing is thrown"


def test_a_body_too_large_for_a_wedge_leaves_it_without_bounds_too() -> None:
    world = empty_world(gravity_mode="none")
    for side in (-1.0, 1.0):
        box(world, (0.0, 0.3 * side), width=4.0, height=0.4, angle=0.1 * side, static=True)
    body = box(world, (0.5, 0.0), width=0.6, height=0.6, mass=2.0)
    world.run(seconds=0.1)
    assert deepest(world, body) <= 1e-3 and world.returned_inside == 1
    assert world.component(body, Velocity).linear.magnitude < 2.0


def test_what_comes_back_brings_no_energy_but_what_is_booked() -> None:
    world = room(gravity_mode="linear")
    body = box(world, (6.05, -0.15), width=0.5, height=0.5, mass=1.25)
    world.synchronise()
    before = measure_energy(world).total
    world.step()
    assert world.returned_inside == 1
    booked, came = measure_account(world).energy["overlap"], measure_energy(world).total - before
    assert booked == pytest.approx(came, abs=0.05 * abs(came)) and booked > 0.0
    for _ in range(120):
        world.step()
    assert measure_energy(world).total <= before + booked + 1e-3
    assert world.returned_inside == 1 and world.component(body, Velocity).linear.magnitude < 0.01


def test_many_are_brought_back_at_once_and_a_run_has_the_bits_of_its_steps() -> None:
    def made() -> World:
        world = room(gravity_mode="linear")
        for n in range(70):
            side = 1.0 if n % 2 else -1.0
            place = (side * (5.9 + 0.02 * n), -0.3 + 0.04 * n)
            if n % 3:
                circle(world, place, radius=0.12, mass=0.3)
            else:
                box(world, place, width=0.25, height=0.2, mass=0.3)
        return world

    one, other = made(), made()
    one.run(steps=120)
    for _ in range(120):
        other.step()
    assert one.returned_inside == other.returned_inside > 0
    position = one.table(Transform)["position"]
    assert position.tobytes() == other.table(Transform)["position"].tobytes()
    bodies = one.batch(Transform, Velocity).entities.tolist()
    assert max(outside(one, body) for body in bodies) < 0.05
    assert np.hypot(*one.table(Velocity)["linear"].T).max() < 12.0


def test_where_nothing_is_outside_nothing_is_brought_back() -> None:
    world = load_scene("sandbox")
    world.run(seconds=3.0)
    assert world.returned_inside == 0 and measure_account(world).energy["overlap"] == 0.0


@pytest.mark.parametrize("kept_apart", ["medium", "layer"])
def test_a_body_is_not_put_out_of_a_shape_that_it_does_not_touch(kept_apart: str) -> None:
    world = room(gravity_mode="none")
    around = box(world, (3.0, 1.8), width=9.0, height=4.6, static=True)
    body = box(world, (6.05, -0.15), width=0.5, height=0.5)  # held between the floor and the wall
    if kept_apart == "medium":
        world.add(around, Medium(density=1.0))
        assert count_near_pairs(world) == 4  # with two walls, the floor and the pillar
    else:
        world.add(around, Layer(1, "own"))
        world.add(body, Layer(2, "own"))
    world.run(steps=20)
    assert world.returned_inside == 1
    assert (world.component(body, Transform).position - Vector2(6.05, -0.15)).magnitude < 2.0


def test_a_body_larger_than_the_world_stays_where_it_is() -> None:
    world = room()
    box(world, (7.0, 0.0), width=14.0, height=0.5, mass=1.0)
    world.run(steps=30)
    assert world.returned_inside == 0 and np.isfinite(world.table(Transform)["position"]).all()


def test_an_elastic_ball_outside_comes_back_where_impacts_are_located_in_time() -> None:
    world = empty_world(bounds=WALLS, bounds_restitution=1.0, bounds_friction=0.0)
    ball = circle(world, (8.0, 2.0), radius=0.2, mass=1.0, restitution=1.0, friction=0.0)
    world.component(ball, Material).friction = 0.0
    world.run(seconds=1.0)
    assert outside(world, ball) <= LIMIT


def hexagon(world: World, place: tuple[float, float], angle: float) -> int:
    corners = [(math.cos(math.tau * k / 6), math.sin(math.tau * k / 6)) for k in range(6)]
    return polygon(world, place, corners, angle=angle)


SHAPES = st.sampled_from((
    lambda world, place, angle: circle(world, place, radius=0.8, angle=angle),
    lambda world, place, angle: box(world, place, width=1.8, height=1.2, angle=angle),
    lambda world, place, angle: capsule(world, place, length=1.2, radius=0.4, angle=angle),
    lambda world, place, angle: polygon(world, place, ((0, 0), (1, 0), (0.3, 1.2)), radius=0.1, angle=angle),
    hexagon,
))  # fmt: skip
ANGLE = st.floats(-3.0, 3.0)


@given(one=SHAPES, two=SHAPES, place=st.tuples(ANGLE, ANGLE), angles=st.tuples(ANGLE, ANGLE))
def test_outlines_overlap_as_deep_as_contacts_do(
    one: Any, two: Any, place: tuple[float, float], angles: tuple[float, float]
) -> None:
    """They go by another law: the way out is the shortest one of all directions, looked at at once."""
    world = empty_world()
    bodies = [one(world, (0.0, 0.0), angles[0]), two(world, place, angles[1])]
    find_contacts(world)
    shapes = outlines_of(world, np.array([world.entity_index.row_of[body] for body in bodies]))
    depth, way = overlap(shapes, 0, shapes, 1)
    assert np.hypot(*way) == pytest.approx(1.0)
    assert world.contacts.max_penetration == pytest.approx(max(depth, 0.0), abs=1e-9)
    if depth > 0.0:
        shapes.place[1] += depth * way
        assert abs(overlap(shapes, 0, shapes, 1)[0]) < 1e-9, "that is a way out, and none is shorter"
