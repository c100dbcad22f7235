"""Times of meeting: at contact to rounding, never too late, and never the same one again."""

import math

import numpy as np
from compiled import compiled
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from physicslab.kernels.events import encounter, meeting
from physicslab.kernels.events.meeting import Course
from physicslab.kernels.events.path import FIELDS
from physicslab.kernels.geometry.outline import Outline
from physicslab.kernels.geometry.shapes import BOX
from physicslab.kernels.interpreter import twin_of
from physicslab.kernels.records import MANIFOLD
from physicslab.state.shapes import blank_shapes, with_names

meet_line, meet_circle_circle = compiled(meeting.meet_line), compiled(meeting.meet_circle_circle)
meet_circle_box, meet_box_box = compiled(meeting.meet_circle_box), compiled(meeting.meet_box_box)
time_apart, meeting_of = twin_of(encounter.time_apart), twin_of(encounter.meeting_of)
away = st.floats(1.0, 3.0)
turns = st.floats(0.0, 6.28)
# The kernels state that squares of numbers other than zero must not underflow.
speeds = st.floats(-5.0, 5.0).map(lambda v: v if abs(v) > 1e-150 else 0.0)
SPAN = 4.0
TIMES = np.linspace(0.0, SPAN, 4001)


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
    t = meet_circle_circle(Course(dx, dy, ux, uy, wx, wy), 0.9, SPAN, 0.0)

    def gap(at: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.hypot(path(at, dx, ux, wx), path(at, dy, uy, wy)) - 0.9

    check(t, gap(TIMES), float(gap(np.array(min(t, SPAN)))), 1.0 + SPAN**2 * 10)


@settings(max_examples=300)
@given(away, turns, speeds, speeds, speeds, speeds, st.booleans())
def test_a_circle_and_a_box(
    d: float, turn: float, ux: float, uy: float, wx: float, wy: float, pulled: bool
) -> None:
    dx, dy, wx, wy = d * math.cos(turn), d * math.sin(turn), wx * pulled, wy * pulled
    t = meet_circle_box(Course(dx, dy, ux, uy, wx, wy), 0.5, 0.3, 0.2, SPAN, 0.0)

    def gap(at: NDArray[np.float64]) -> NDArray[np.float64]:
        x, y = np.abs(path(at, dx, ux, wx)) - 0.5, np.abs(path(at, dy, uy, wy)) - 0.3
        return np.hypot(np.maximum(x, 0.0), np.maximum(y, 0.0)) - 0.2

    check(t, gap(TIMES), float(gap(np.array(min(t, SPAN)))), 1.0 + SPAN**2 * 10)


@settings(max_examples=200)
@given(st.floats(1.5, 3.0), turns, speeds, speeds, speeds, speeds, turns, turns)
def test_two_boxes(
    d: float, turn: float, ux: float, uy: float, wx: float, wy: float, a: float, b: float
) -> None:
    dx, dy = d * math.cos(turn), d * math.sin(turn)
    one = Outline(True, math.cos(a), math.sin(a), 0.5, 0.3, 0.0, 4, BOX)
    other = Outline(True, math.cos(b), math.sin(b), 0.4, 0.2, 0.0, 4, BOX)
    t, face = meet_box_box(Course(dx, dy, ux, uy, wx, wy), one, other, 0.0)

    def gap(at: NDArray[np.float64]) -> NDArray[np.float64]:
        x, y = path(at, dx, ux, wx), path(at, dy, uy, wy)
        c, s = abs(math.cos(a - b)), abs(math.sin(a - b))
        sides = (
            (a, 0.5 + c * 0.4 + s * 0.2, 0.3 + s * 0.4 + c * 0.2),
            (b, 0.4 + c * 0.5 + s * 0.3, 0.2 + s * 0.5 + c * 0.3),
        )
        gaps = [
            (
                np.abs(math.cos(q) * x + math.sin(q) * y) - along,
                np.abs(math.cos(q) * y - math.sin(q) * x) - up,
            )
            for q, along, up in sides
        ]
        widest: NDArray[np.float64] = np.stack([one for pair in gaps for one in pair]).max(axis=0)
        return widest

    assert (face >= 0) == (t < math.inf)
    check(t, gap(TIMES), float(gap(np.array(min(t, SPAN)))), 1.0 + SPAN**2 * 10)


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
        assert meet_circle_circle(Course(1.0 + gap, 0.0, 1.0, 0.5, 0.0, 0.0), 1.0, SPAN, 0.0) == math.inf
        later = meet_circle_circle(Course(1.0 + gap, 0.0, 1.0, 0.0, -2.0, 0.0), 1.0, SPAN, 0.0)
        assert abs(later - 1.0) < 1e-15
        later = meet_circle_box(Course(1.0 + gap, 0.1, 1.0, 0.0, -2.0, 0.0), 0.5, 0.5, 0.5, SPAN, 0.0)
        assert abs(later - 1.0) < 1e-15


def test_the_fastest_and_the_faintest_meeting_are_found() -> None:
    assert meet_circle_circle(Course(1e6, 0.0, -1e12, 0.0, 0.0, 0.0), 1.0, SPAN, 0.0) == (1e6 - 1.0) / 1e12
    graze = 1.0 - 1e-12
    assert abs(meet_circle_circle(Course(10.0, graze, -5.0, 0.0, 0.0, 0.0), 1.0, SPAN, 0.0) - 2.0) < 1e-5
    # A parabola whose top dips into the circle from below.
    t = meet_circle_circle(Course(-2.0, -3.0, 1.0, math.sqrt(2 * (2.0 + 1e-9)), 0.0, -1.0), 1.0, SPAN, 0.0)
    assert 1.99 < t < 2.0


@settings(max_examples=300)
@given(
    kinds=st.tuples(st.sampled_from((1, 2)), st.sampled_from((1, 2))),
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
    manifold = np.zeros(1, MANIFOLD).view(np.recarray)
    manifold["a"], manifold["b"], manifold["wall"] = 0, 1, max(wall, -1)
    paths = np.zeros((2, FIELDS))
    paths[1, [0, 2]], paths[1, [4, 6]], paths[0, [4, 6]] = place, rates[:2], rates[2:]
    paths[1, 9] = -9.81 * pulled
    plain = blank_shapes(2)
    box = np.array(kinds) == 2
    plain[0][:] = np.where(box, 4, 1), box
    plain[1][:3] = [0.3, 0.75] * box, [0.4, 0.1] * box, [0.4, 0.3] * ~box
    shapes = with_names(plain)
    walls, angle = np.array([-5.0, -5.0, 5.0, 5.0]), np.array(angles)
    apart = time_apart(manifold[0], paths, angle, shapes, walls, now, 1e-10)
    meets, _ = meeting_of(manifold[0], paths, angle, shapes, walls, now, 0.0, SPAN, 0.0)
    assert 0.0 <= apart <= meets
