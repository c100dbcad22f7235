"""Times of meeting: at contact to rounding, never too late, and never the same one again."""

import math
from typing import Any

import numpy as np
from compiled import compiled
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from physicslab.kernels.events import encounter, meeting
from physicslab.kernels.events.meeting import Course
from physicslab.kernels.events.path import FIELDS
from physicslab.kernels.geometry.shapes import Shapes
from physicslab.kernels.interpreter import fallback_of
from physicslab.kernels.records import MANIFOLD
from physicslab.state.shapes import blank_shapes, with_names

meet_line, meet_circle = compiled(meeting.meet_line), compiled(meeting.meet_circle)
time_apart, meeting_of = fallback_of(encounter.time_apart), fallback_of(encounter.meeting_of)
away = st.floats(1.0, 3.0)
turns = st.floats(0.0, 6.28).map(lambda angle: angle if angle > 1e-100 else 0.0)
# The kernels state that squares of numbers other than zero must not underflow.
speeds = st.floats(-5.0, 5.0).map(lambda v: v if abs(v) > 1e-150 else 0.0)
SPAN = 4.0
TIMES = np.linspace(0.0, SPAN, 1601)


def path(t: NDArray[np.float64], d: float, u: float, w: float) -> NDArray[np.float64]:
    place: NDArray[np.float64] = d + t * (u + 0.5 * t * w)
    return place


def check(t: float, gap: NDArray[np.float64], gap_at: float, scale: float) -> None:
    """Check a time of meeting against the gap along the way."""
    if t <= SPAN:
        assert abs(gap_at) < 1e-12 * scale
        assert (gap[t - 1e-9 > TIMES] > -1e-12 * scale).all()
    else:
        assert (gap > -1e-9 * scale).all()


@settings(max_examples=300)
@given(away, turns, speeds, speeds, speeds, speeds, st.booleans())
def test_circles(d: float, turn: float, ux: float, uy: float, wx: float, wy: float, pulled: bool) -> None:
    dx, dy, wx, wy = d * math.cos(turn), d * math.sin(turn), wx * pulled, wy * pulled
    t = meet_circle(Course(dx, dy, ux, uy, wx, wy), 0.9, SPAN, 0.0, 1.0)

    def gap(at: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.hypot(path(at, dx, ux, wx), path(at, dy, uy, wy)) - 0.9

    check(t, gap(TIMES), float(gap(np.array(min(t, SPAN)))), 1.0 + SPAN**2 * 10)


DISC, BOX, CAPSULE = range(3)
CORES = (
    np.zeros((1, 2)),
    np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]),
    np.array([(1.0, 0.0), (-1.0, 0.0)]),
)
SIZES = ((0.0, 0.0, 0.4), (0.5, 0.3, 0.0), (0.5, 0.0, 0.2))
"""Half of the extents of the cores, and radii."""


def table(kinds: tuple[int, int]) -> Shapes:
    """Return a table of two shapes."""
    cores, lengths, _ = blank_shapes(2)
    first = np.cumsum([0, *map(len, CORES)])
    cores[:] = [len(CORES[kind]) for kind in kinds], first[list(kinds)]
    lengths[:3] = np.array([SIZES[kind] for kind in kinds]).T
    lengths[3:5] = np.hypot(lengths[0], lengths[1]), np.minimum(lengths[0], lengths[1])
    lengths[3:5] += lengths[2]
    return with_names((cores, lengths, np.concatenate(CORES)))


def pair_on_paths(
    place: tuple[float, float], rates: list[float], wx: float, wy: float, wall: int = -1
) -> tuple[Any, NDArray[np.float64]]:
    """Return a pair of which A moves evenly from the origin and B on a parabola."""
    manifold = np.zeros(1, MANIFOLD).view(np.recarray)
    manifold["a"], manifold["b"], manifold["wall"] = 0, 1, wall
    paths = np.zeros((2, FIELDS))
    paths[1, [0, 2]], paths[1, [4, 6]], paths[0, [4, 6]] = place, rates[:2], rates[2:]
    paths[1, 8:10] = wx, wy
    return manifold[0], paths


def core_of(kind: int, angle: float) -> NDArray[np.float64]:
    c, s = math.cos(angle), math.sin(angle)
    turned: NDArray[np.float64] = CORES[kind] * SIZES[kind][:2] @ np.array(((c, s), (-s, c)))
    return turned


def gap_along(
    kinds: tuple[int, int], angles: tuple[float, float], d: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the gap of two shapes where B is at each of the places d (n, 2), by all edges and vertices."""
    a, b = core_of(kinds[0], angles[0]), core_of(kinds[1], angles[1])
    inside, outside = np.full(len(d), -np.inf), np.full(len(d), np.inf)
    for one, other, way in ((a, b, d), (b, a, -d)):
        for k in range(len(one)):
            start, along = one[k], one[(k + 1) % len(one)] - one[k]
            length = math.hypot(*along)
            if len(one) > 1:
                normal = np.array((along[1], -along[0])) / length
                inside = np.maximum(inside, way @ normal + (other @ normal).min() - start @ normal)
            for v in other:
                to = way + v - start
                share = np.clip(to @ along / (length * length), 0.0, 1.0) if length else np.zeros(len(d))
                outside = np.minimum(outside, np.hypot(*(to - share[:, None] * along).T))
    crossing = (inside <= 0.0) & (len(a) * len(b) > 4)  # what two segments have inside is no area
    gap: NDArray[np.float64] = np.where(crossing, inside, outside)
    return gap - SIZES[kinds[0]][2] - SIZES[kinds[1]][2]


@settings(max_examples=120)
@given(
    st.tuples(st.integers(0, 2), st.integers(0, 2)), st.floats(1.7, 3.0), turns,
    speeds, speeds, speeds, speeds, st.booleans(), st.tuples(turns, turns), st.booleans(),
)  # fmt: skip
def test_any_two_shapes(
    kinds: tuple[int, int], d: float, turn: float, ux: float, uy: float, wx: float, wy: float, pulled: bool,
    angles: tuple[float, float], parallel: bool,
) -> None:  # fmt: skip
    place, wx, wy = (d * math.cos(turn), d * math.sin(turn)), wx * pulled, wy * pulled
    angles = (angles[0], angles[0]) if parallel else angles
    manifold, paths = pair_on_paths(place, [ux, uy, 0.0, 0.0], wx, wy)
    shapes, walls = table(kinds), np.zeros(4)
    t, feature = meeting_of(manifold, paths, np.array(angles), shapes, walls, 0.0, 0.0, SPAN, 0.0)

    def gap(at: NDArray[np.float64]) -> NDArray[np.float64]:
        way = np.stack((path(at, place[0], ux, wx), path(at, place[1], uy, wy)), axis=1)
        return gap_along(kinds, angles, way)

    assert (feature >= 0) == (t < math.inf)
    check(t, gap(TIMES), float(gap(np.array([min(t, SPAN)]))[0]), 1.0 + SPAN**2 * 10)


def squarable(low: float) -> st.SearchStrategy[float]:
    """Return numbers up to 10 whose squares do not vanish below the smallest that a float can be."""
    return st.floats(low, 10).filter(lambda x: x == 0.0 or abs(x) > 1e-150)


@given(squarable(0), squarable(-10), squarable(-10))
def test_a_line(gap: float, speed: float, pull: float) -> None:
    t = meet_line(gap, speed, pull, 0.0)
    if t < math.inf:
        assert t >= 0.0 and speed + pull * t <= 1e-12 * (abs(speed) + abs(pull) * t)
        assert (
            abs(gap + t * (speed + 0.5 * t * pull))
            <= 1e-12 * (gap + abs(speed) * t + abs(pull) * t * t) + 1e-300
        )


def test_what_has_just_bounced_is_not_met_again() -> None:
    for gap in (0.0, 1e-17, -1e-17):
        assert meet_line(gap, 1.0, 0.0, 0.0) == math.inf
        assert abs(meet_line(gap, 1.0, -2.0, 0.0) - 1.0) < 1e-15
        assert meet_circle(Course(1.0 + gap, 0.0, 1.0, 0.5, 0.0, 0.0), 1.0, SPAN, 0.0, 1.0) == math.inf
        later = meet_circle(Course(1.0 + gap, 0.0, 1.0, 0.0, -2.0, 0.0), 1.0, SPAN, 0.0, 1.0)
        assert abs(later - 1.0) < 1e-15
        manifold, paths = pair_on_paths((0.9 + gap, 0.1), [1.0, 0.0, 0.0, 0.0], -2.0, 0.0)
        for kinds in ((BOX, DISC), (DISC, BOX), (CAPSULE, BOX)):
            reach = sum(SIZES[kind][0] + SIZES[kind][2] for kind in kinds)
            paths[1, 0] = reach + gap
            later, _ = meeting_of(
                manifold, paths, np.zeros(2), table(kinds), np.zeros(4), 0.0, 0.0, SPAN, 0.0
            )
            assert abs(later - 1.0) < 1e-14


def test_the_fastest_and_the_faintest_meeting_are_found() -> None:
    assert meet_circle(Course(1e6, 0.0, -1e12, 0.0, 0.0, 0.0), 1.0, SPAN, 0.0, 1.0) == (1e6 - 1.0) / 1e12
    graze = 1.0 - 1e-12
    assert abs(meet_circle(Course(10.0, graze, -5.0, 0.0, 0.0, 0.0), 1.0, SPAN, 0.0, 1.0) - 2.0) < 1e-5
    # A parabola whose top dips into the circle from below.
    t = meet_circle(Course(-2.0, -3.0, 1.0, math.sqrt(2 * (2.0 + 1e-9)), 0.0, -1.0), 1.0, SPAN, 0.0, 1.0)
    assert 1.99 < t < 2.0


@settings(max_examples=300)
@given(
    kinds=st.tuples(st.integers(0, 2), st.integers(0, 2)),
    wall=st.integers(-4, 3),
    angles=st.tuples(*[st.sampled_from((0.0, 0.7))] * 2),
    place=st.tuples(*[st.floats(-4.0, 4.0)] * 2),
    rates=st.lists(speeds, min_size=4, max_size=4),
    pulled=st.booleans(),
    now=st.sampled_from((0.0, 0.3)),
)
def test_no_pair_meets_while_it_is_taken_as_apart(
    kinds: tuple[int, int], wall: int, angles: tuple[float, float], place: tuple[float, float],
    rates: list[float], pulled: bool, now: float,
) -> None:  # fmt: skip
    manifold, paths = pair_on_paths(place, rates, 0.0, -9.81 * pulled, max(wall, -1))
    shapes, walls, angle = table(kinds), np.array([-5.0, -5.0, 5.0, 5.0]), np.array(angles)
    apart = time_apart(manifold, paths, angle, shapes, walls, now, 1e-10)
    meets, _ = meeting_of(manifold, paths, angle, shapes, walls, now, 0.0, SPAN, 0.0)
    assert 0.0 <= apart <= meets
