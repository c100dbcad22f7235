"""Where rounded polygons touch: the general way against those of discs and boxes, and against distances."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from physicslab.components.shape import KINDS, Kind
from physicslab.kernels.geometry import cores, manifold, sweep
from physicslab.kernels.geometry import outline as turning
from physicslab.kernels.geometry.cores import Touch
from physicslab.kernels.geometry.outline import Outline, Way
from physicslab.kernels.geometry.shapes import BOX
from physicslab.kernels.interpreter import fallback_of
from physicslab.state.shapes import Register

touch_cores, sweep_cores = fallback_of(cores.touch_cores), fallback_of(sweep.sweep_outlines)
least_gap, rotation = fallback_of(sweep.least_gap), fallback_of(turning.rotation)
box_box, circle_box, pose_at = (
    fallback_of(manifold.box_box),
    fallback_of(manifold.circle_box),
    fallback_of(sweep.pose_at),
)

_TURNS = [2.0 * math.pi * k / 5 for k in range(5)]
FIVE = Kind(tuple((math.cos(turn), math.sin(turn)) for turn in _TURNS), x="radius", y="radius")
REGISTER = Register((*KINDS.values(), FIVE))
POOL, (WIDE, TALL) = REGISTER.pool, REGISTER.extents[len(KINDS) + 1]
FIRST = {"disc": 0, "box": BOX, "capsule": 5, "five": 7}
COUNT = {"disc": 1, "box": 4, "capsule": 2, "five": 5}
angles = st.floats(-math.pi, math.pi, allow_subnormal=False)  # by which Python cannot divide in silence
extents = st.floats(0.2, 2.0)
kinds = st.sampled_from(("box", "capsule", "five"))
far = Way(0.0, 0.0, 0.0, 0.0)


def outline(kind: str, angle: float, a: float, b: float) -> Outline:
    half_x, half_y, radius = {
        "disc": (0.0, 0.0, a), "box": (a, b, 0.0), "capsule": (a, 0.0, b),
        "five": (a * WIDE, a * TALL, 0.3 * b),
    }[kind]  # fmt: skip
    c, s = (math.cos(angle), math.sin(angle)) if kind != "disc" else (1.0, 0.0)
    return Outline(
        kind == "box", c, s, half_x, half_y, radius, COUNT[kind], FIRST[kind], min(half_x, half_y) + radius
    )


def touch(dx: float, dy: float, one: Outline, other: Outline, margin: float = math.inf) -> Touch:
    found: Touch = touch_cores(Way(dx, dy, 0.0, 0.0), one, other, POOL, margin, 0)
    return found


def corners(one: Outline, x: float = 0.0, y: float = 0.0) -> list[complex]:
    pool = POOL[one.first : one.first + one.vertices, :2] * (one.half_x, one.half_y)
    return [complex(x, y) + complex(*place) * complex(one.c, one.s) for place in pool.tolist()]


def to_edge(place: complex, a: complex, b: complex) -> float:
    share = min(max(((place - a) * (b - a).conjugate()).real / abs(b - a) ** 2, 0.0), 1.0)
    return abs(place - a - share * (b - a))


def distance(one: list[complex], other: list[complex]) -> float:
    """Return the distance of two cores that are apart [m]: a corner of one is nearest to an edge."""
    gap = math.inf
    for some, others in ((one, other), (other, one)):
        edges = list(zip(others, others[1:] + others[:1], strict=True))
        gap = min(gap, *(to_edge(place, a, b) for place in some for a, b in edges if a != b), math.inf)
    return gap


@given(st.floats(0.5, 4.0), angles, angles, angles, extents, extents, extents, extents)
def test_of_boxes_it_gives_what_their_own_way_gives(
    d: float, way: float, turn_a: float, turn_b: float, ax: float, ay: float, bx: float, by: float
) -> None:
    dx, dy = d * math.cos(way), d * math.sin(way)
    one, other = outline("box", turn_a, ax, ay), outline("box", turn_b, bx, by)
    gap, nx, ny, count, first, second = box_box(dx, dy, 0.0, 0.0, one, other, 10.0, 0)
    found = touch(dx, dy, one, other, 10.0)
    assert found.gap == pytest.approx(gap, abs=1e-12)
    if count == found.points and abs(found.nx * nx + found.ny * ny - 1.0) < 1e-9:
        theirs = sorted(point.separation for point in (first, second)[:count])
        assert sorted(p.separation for p in (found.one, found.two)[:count]) == pytest.approx(
            theirs, abs=1e-11
        )


@given(st.floats(0.5, 4.0), angles, angles, extents, extents, extents)
def test_of_a_disc_and_a_box_it_gives_what_their_own_way_gives(
    d: float, way: float, turn: float, half_x: float, half_y: float, radius: float
) -> None:
    dx, dy = d * math.cos(way), d * math.sin(way)
    box, disc = outline("box", turn, half_x, half_y), outline("disc", 0.0, radius, 0.0)
    nx, ny, _px, _py, separation = circle_box(dx, dy, box, radius)
    found = touch(dx, dy, box, disc)
    # Beside the end of a face the corner counts as nearest from a millionth of the radius on: where the
    # middle is that much farther from it, the normal is turned by the root of twice their ratio at most.
    assert found.gap == pytest.approx(separation, abs=1e-6 * radius)
    if separation > 1e-6 - radius:  # nearer to the middle of a side either side may be the nearest
        turned = max(1e-5, math.sqrt(2e-6 * radius / (separation + radius)))
        assert (found.nx, found.ny) == pytest.approx((nx, ny), abs=turned)
    assert found.points == 1


@given(kinds, kinds, st.floats(0.5, 6.0), angles, angles, angles, extents, extents, extents, extents)
def test_the_gap_of_what_is_apart_is_the_distance(
    kind: str, other_kind: str, d: float, way: float, turn_a: float, turn_b: float, ax: float, ay: float,
    bx: float, by: float,
) -> None:  # fmt: skip
    dx, dy = d * math.cos(way), d * math.sin(way)
    one, other = outline(kind, turn_a, ax, ay), outline(other_kind, turn_b, bx, by)
    found = touch(dx, dy, one, other)
    apart = distance(corners(one), corners(other, dx, dy)) - one.radius - other.radius
    if found.gap + one.radius + other.radius > 1e-9:
        assert found.gap <= apart + 1e-6
        if one.radius + other.radius > 0.0:
            assert found.gap == pytest.approx(apart, abs=1e-5)
            assert found.points > 0
    assert math.hypot(found.nx, found.ny) == pytest.approx(1.0)


@given(kinds, kinds, st.floats(0.1, 4.0), angles, angles, angles, angles, extents, extents, extents, extents)
def test_it_does_not_depend_on_who_is_first_nor_on_directions(
    kind: str, other_kind: str, d: float, way: float, turn_a: float, turn_b: float, whole: float, ax: float,
    ay: float, bx: float, by: float,
) -> None:  # fmt: skip
    dx, dy = d * math.cos(way), d * math.sin(way)
    one, other = outline(kind, turn_a, ax, ay), outline(other_kind, turn_b, bx, by)
    found, back = touch(dx, dy, one, other), touch(-dx, -dy, other, one)
    assert back.gap == pytest.approx(found.gap, abs=1e-9)
    place = complex(dx, dy) * complex(math.cos(whole), math.sin(whole))
    turned = touch(
        place.real, place.imag, outline(kind, turn_a + whole, ax, ay),
        outline(other_kind, turn_b + whole, bx, by),
    )  # fmt: skip
    assert turned.gap == pytest.approx(found.gap, abs=1e-9)
    for same in (back, turned):
        if same.points == found.points == 1:
            assert same.one.separation == pytest.approx(found.one.separation, abs=1e-5)


@settings(max_examples=50)
@given(kinds, kinds, angles, angles, angles, st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), extents, extents)
def test_a_sweep_ends_where_they_touch(
    kind: str, other_kind: str, way: float, turn_a: float, turn_b: float, spin_a: float, spin_b: float,
    a: float, b: float,
) -> None:  # fmt: skip
    one, other = outline(kind, turn_a, a, b), outline(other_kind, turn_b, b, a)
    dx, dy = 9.0 * math.cos(way), 9.0 * math.sin(way)
    path = Way(dx, dy, -2.0 * dx, -2.0 * dy)  # through each other
    t = sweep_cores(path, spin_a, spin_b, 0.0, one, other, POOL)
    assert 0.0 < t < 1.0
    moved, at_a, at_b = pose_at(path, spin_a, spin_b, one, other, t)
    assert touch(moved.dx, moved.dy, at_a, at_b).gap == pytest.approx(0.0, abs=1e-9)
    for earlier in np.linspace(0.0, t - 1e-6, 20).tolist():
        moved, at_a, at_b = pose_at(path, spin_a, spin_b, one, other, earlier)
        assert touch(moved.dx, moved.dy, at_a, at_b).gap > 0.0


@given(
    kinds, kinds, st.floats(0.5, 4.0), angles, angles, angles, extents, extents, st.floats(-1.0, 1.0),
    st.floats(-1.0, 1.0), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.sampled_from((-0.5, 0.5, 1.0)),
)  # fmt: skip
def test_they_come_no_nearer_than_the_line_to_the_least_gap(
    kind: str, other_kind: str, d: float, way: float, turn_a: float, turn_b: float, a: float, b: float,
    ux: float, uy: float, spin_a: float, spin_b: float, share: float,
) -> None:  # fmt: skip
    place = Way(d * math.cos(way), d * math.sin(way), ux, uy)
    one, other = outline(kind, turn_a, a, b), outline(other_kind, turn_b, b, a)
    found: Touch = touch_cores(place, one, other, POOL, math.inf, 0)
    assume(found.gap > 0.0)
    least = least_gap(found, place, spin_a, spin_b, share, one, other, POOL)
    for part in np.linspace(0.0, 1.0, 9):
        moved, at_one, at_other = pose_at(place, spin_a, spin_b, one, other, part * share)
        apart = distance(corners(at_one), corners(at_other, moved.dx, moved.dy)) - one.radius - other.radius
        assert apart >= (1.0 - part) * found.gap + part * least - 1e-9
    straight = least_gap(found, place, 0.0, 0.0, share, one, other, POOL)
    assert straight == pytest.approx(found.gap + share * (found.nx * ux + found.ny * uy), abs=1e-12)


@given(st.floats(-7.0, 7.0) | st.floats(-0.11, 0.11))
def test_small_angles_turn_by_their_series(angle: float) -> None:
    assert rotation(angle) == pytest.approx((math.cos(angle), math.sin(angle)), rel=1e-15, abs=1e-17)


def test_two_capsules_on_each_other_have_two_points_and_end_to_end_one() -> None:
    one = outline("capsule", 0.0, 1.0, 0.25)
    above, beside = touch(0.0, 0.6, one, one), touch(2.7, 0.0, one, one)
    assert (above.points, above.nx, above.ny) == (2, 0.0, 1.0)
    assert above.gap == above.one.separation == pytest.approx(0.1)
    assert {above.one.x, above.two.x} == {1.0, -1.0}
    assert (beside.points, beside.nx, beside.ny) == (1, 1.0, 0.0)
    assert beside.gap == pytest.approx(0.2)


@given(angles)
def test_what_is_within_another_leaves_by_a_face(turn: float) -> None:
    assume(abs(math.sin(turn)) > 0.01)
    found = touch(0.0, 0.0, outline("box", 0.0, 2.0, 1.0), outline("capsule", turn, 0.5, 0.1))
    assert found.gap < 0.0
    assert found.points > 0


@given(
    angle_a=angles, angle_b=angles, turn=angles, aside=angles, extents=st.tuples(extents, extents), kind=kinds
)
@settings(deadline=None)
def test_what_overlaps_touches_from_wherever_it_comes(
    angle_a: float, angle_b: float, turn: float, aside: float, extents: tuple[float, float], kind: str
) -> None:
    # A capsule at any rounded polygon or box, that overlaps it by little; it comes on from any side.
    one, other = outline("capsule", angle_a, *extents), outline(kind, angle_b, extents[1], extents[0])
    x, y = math.cos(turn), math.sin(turn)
    far, near = 10.0, 0.0
    for _ in range(60):
        middle = 0.5 * (far + near)
        far, near = (middle, near) if touch(middle * x, middle * y, one, other).gap > -1e-3 else (far, middle)
    way = Way(near * x, near * y, 0.01 * math.cos(aside), 0.01 * math.sin(aside))
    found: Touch = touch_cores(way, one, other, POOL, 0.1, 0)
    assert found.points > 0
    assert min(found.one.separation, found.two.separation if found.points > 1 else 0.0) < 0.0
