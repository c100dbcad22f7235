"""The links of a chain: tangents go on without a jump, and impacts on each are at their time to rounding."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from physicslab import World
from physicslab.components import Transform, Velocity
from physicslab.components.vertices import regular
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.kernels.geometry.links import ROWS
from physicslab.prefabs import box, circle, ground, loop, polygon
from physicslab.state.chain_links import SMOOTH, line_along, links_of

BOWL, BALL = 2.0, 0.2


def links(vertices: list[tuple[float, float]]) -> np.ndarray:
    """Return the links of a chain (m, ROWS, 2)."""
    rows = links_of(np.array(vertices, dtype=np.float64))[1]
    count = int(rows[-1, 0])
    return rows[: ROWS * count].reshape(count, ROWS, 2)


def ends(link: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return where a link begins and ends (2,) [m]."""
    (bend, size), place, begin, end = link[:4]
    if bend == 0.0:
        return place, place + size * np.array((-begin[1], begin[0]))
    return place + bend * size * begin, place + bend * size * end


def round_ground(world: World, *, restitution: float = 0.0, friction: float = 0.0) -> None:
    """Spawn a bowl, whose arcs are a circle about the origin."""
    outer = BOWL / math.cos(math.pi / 72)
    angles = [math.pi * (k + 0.5) / 36 for k in range(36)]
    vertices = [(outer * math.cos(a), -outer * math.sin(a)) for a in angles]
    ground(world, vertices, restitution=restitution, friction=friction)


@given(st.lists(st.tuples(st.floats(0.1, 3.0), st.floats(-SMOOTH, SMOOTH)), min_size=2, max_size=40))
@example([(0.9083632821479097, 0.0), (1.2985095355740277, 1e-9)])
def test_what_is_smooth_has_no_corner_but_its_ends(ways: list[tuple[float, float]]) -> None:
    place, direction, vertices = Vector2(), 0.0, [(0.0, 0.0)]
    for length, turn in ways:
        direction += turn
        place += Vector2.from_angle(direction, length)
        vertices.append((place.x, place.y))
    first, *inner, last = links(vertices)
    assert first[0].tolist() == last[0].tolist() == [1.0, 0.0]
    for one, after in pairwise(inner):
        assert ends(one)[1] == pytest.approx(ends(after)[0], abs=1e-6)
        assert one[3] == pytest.approx(after[2], abs=1e-7)
    assert line_along(np.array(inner))[-1] == pytest.approx(vertices[-1], abs=1e-9)


def test_real_corners_stay_and_vertices_in_line_are_none() -> None:
    kinds = [tuple(link[0]) for link in links([(5, 0), (3, 0), (1, 0), (0, 1), (-1, 0), (-2, 0), (-5, 0)])]
    assert [bend for bend, _ in kinds] == [1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]
    assert kinds[3] == (1.0, 0.0)
    assert kinds[1][1] == pytest.approx(4.0)


def test_arcs_of_one_circle_are_one_link_a_quarter() -> None:
    outline = [(vertex.x, vertex.y) for vertex in regular(100, 1.0)]
    found = links([*outline, outline[0]])
    assert len(found) <= 5
    assert found[:, 0, 1] == pytest.approx(math.cos(math.pi / 100))


@pytest.mark.parametrize("collisions", ["exact", "step"])
@pytest.mark.parametrize("x", [-0.7, 0.0, 1.1])
def test_a_ball_meets_a_bowl_at_its_time(x: float, collisions: str) -> None:
    simulation = SimulationConfig(collisions="auto" if collisions == "step" else collisions, contacts="rigid")
    world = World(simulation=simulation)
    round_ground(world, restitution=1.0)
    e = 1.0 if collisions == "exact" else 0.5
    ball = circle(world, (x, 0.5), radius=BALL, restitution=e, friction=0.0)
    depth = math.sqrt((BOWL - BALL) ** 2 - x * x)
    falls = math.sqrt(2.0 * (0.5 + depth) / 9.81)
    world.run(seconds=falls + 0.05)
    fast = 9.81 * falls
    normal = Vector2(-x, depth) * (1.0 / (BOWL - BALL))
    after = Vector2(0.0, -fast) + normal * ((1.0 + e) * fast * normal.y)
    place = Vector2(x, -depth) + after * 0.05 + Vector2(0.0, -0.5 * 9.81 * 0.05**2)
    found = world.component(ball, Transform).position
    assert (found - place).magnitude < 1e-12
    assert world.collisions == 1


@pytest.mark.parametrize("what", ["ball", "box", "six"])
def test_what_slides_in_a_bowl_and_over_hills_keeps_its_energy(what: str) -> None:
    world = World(simulation=SimulationConfig(contacts="rigid"))
    waves = [(6.0 - 0.15 * k, 0.1 * math.cos(6.0 - 0.15 * k)) for k in range(81)]
    ground(world, waves, friction=0.0)
    start = -math.pi, -0.1 + BALL + 0.1
    if what == "ball":
        slider = circle(world, start, radius=BALL, velocity=(2.5, 0.0), friction=0.0)
    elif what == "box":
        slider = box(world, start, width=0.5, height=0.4, velocity=(2.5, 0.0), friction=0.0)
    else:
        slider = polygon(world, start, regular(6, BALL), velocity=(2.5, 0.0), friction=0.0)
    world.run(seconds=0.5)
    landed = measure_energy(world).total
    impacts = measure_account(world).energy["impacts"]
    world.run(seconds=1.0)
    lost = measure_account(world).energy["impacts"] - impacts
    assert world.component(slider, Velocity).linear.x > 1.0
    assert abs(measure_account(world).energy["numerical"]) < 1e-11 * landed
    assert abs(lost) < (1e-12 if what == "ball" else 0.1) * landed


def test_a_ball_in_a_loop_loses_nothing_however_few_segments_it_has() -> None:
    for segments in (24, 900):
        world = World(simulation=SimulationConfig(contacts="rigid"))
        loop(world, (0.0, 0.0), radius=BOWL, run=1.0, segments=segments, friction=0.0)
        circle(world, (-0.3, BALL), radius=BALL, velocity=(10.0, 0.0), friction=0.0)
        before = measure_energy(world).total
        world.run(seconds=1.0)
        assert measure_energy(world).total == pytest.approx(before, rel=1e-11)


def test_many_balls_fly_from_impact_to_impact_in_a_round_room() -> None:
    world = World(simulation=SimulationConfig(collisions="exact"))
    room = [Vector2.from_angle(-math.pi * k / 15.0, BOWL) for k in range(30)]
    ground(world, [*room, room[0]], restitution=1.0, friction=0.0)
    balls = [
        circle(
            world, (0.3 * (k % 5) - 0.6, 0.35 * (k // 5) - 0.5), radius=0.1, restitution=1.0, friction=0.0,
            velocity=(1.0 + 0.1 * k, 2.0 - 0.3 * k),
        )
        for k in range(15)
    ]  # fmt: skip
    before = measure_energy(world).total
    world.run(seconds=1.0)
    assert world.plan.collisions == "exact"
    assert world.collisions > 20
    assert all(world.component(ball, Transform).position.magnitude < BOWL for ball in balls)
    assert measure_energy(world).total == pytest.approx(before, rel=1e-12)
