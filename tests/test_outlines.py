"""Outlines drawn by hand: their convex parts."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab import Vector2, World
from physicslab.components import Mass, Transform, Velocity
from physicslab.components.shape import KINDS, Shape
from physicslab.components.vertices import why_not_convex
from physicslab.contacts.report import count_near_pairs
from physicslab.diagnostics.joints import joint_states
from physicslab.prefabs.outlines import convex_parts, outline

COMB = [(0.0, 0.0), (5.0, 0.0), *((0.5 * (10 - k), 1.0 if k % 2 else 3.0) for k in range(1, 10))]


def area(points: list[tuple[float, float]] | tuple[Vector2, ...]) -> float:
    """Return the area that an outline encloses [m^2]."""
    x, y = (np.array(values) - values[0] for values in zip(*points, strict=True))
    return abs(0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))))


def star(radii: list[float], turned: float) -> list[tuple[float, float]]:
    """Return an outline that is seen from its middle: a corner at each of equal angles."""
    angles = [turned + 2.0 * math.pi * k / len(radii) for k in range(len(radii))]
    return [(r * math.cos(a), r * math.sin(a)) for r, a in zip(radii, angles, strict=True)]


def common_area(one: tuple[Vector2, ...], other: tuple[Vector2, ...]) -> float:
    """Return the area [m^2] that two convex polygons have in common: one is clipped by the other's sides."""
    left = list(one)
    for a, b in zip(other, other[1:] + other[:1], strict=True):
        heights = [(b - a).cross(point - a) for point in left]
        kept: list[Vector2] = []
        for k, point in enumerate(left):
            before, height = heights[k - 1], heights[k]
            if before * height < 0.0:
                kept.append(left[k - 1] + (point - left[k - 1]) * (before / (before - height)))
            if height >= 0.0:
                kept.append(point)
        left = kept
    return area(tuple(left)) if len(left) > 2 else 0.0


def check(points: list[tuple[float, float]]) -> list[tuple[Vector2, ...]]:
    """Check that parts are shapes that fill the outline and do not overlap; return them."""
    parts = convex_parts(points)
    whole = area(points)
    assert sum(map(area, parts)) == pytest.approx(whole, rel=1e-8)
    for k, part in enumerate(parts):
        assert why_not_convex(part, *KINDS["polygon"].own) is None
        Shape.polygon(part)
        assert all(common_area(part, other) < 1e-8 * whole for other in parts[:k])
    return parts


@given(
    st.lists(st.floats(0.05, 1.0), min_size=5, max_size=24),
    st.floats(0.0, 7.0),
    st.floats(-1e3, 1e3),
    st.booleans(),
)
def test_parts_are_convex_and_fill_the_outline(
    radii: list[float], turned: float, shift: float, reverse: bool
) -> None:
    points = [(x + shift, y - shift) for x, y in star(radii, turned)]
    check(points[::-1] if reverse else points)


@given(st.lists(st.tuples(st.integers(1, 4), st.integers(1, 4)), min_size=2, max_size=10))
def test_a_skyline_with_points_in_line_is_cut(towers: list[tuple[int, int]]) -> None:
    points, x = [(0.0, 0.0)], 0.0
    for width, height in towers:
        points += [(x, float(height)), (x + width, float(height))]
        x += width
    check([*points, (x, 0.0), (0.5 * x, 0.0)])


def test_what_is_convex_stays_one_part_up_to_eight_corners() -> None:
    assert [len(check(star([1.0] * count, 0.3))) for count in (3, 8, 9, 100)] == [1, 1, 2, 17]


def test_corners_alone_count() -> None:
    (part,) = check([(0, 0), (1, 0), (1, 0), (2, 0), (2, 1), (2, 3), (2, 2), (0, 2), (0, 0)])
    assert {tuple(vertex) for vertex in part} == {(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)}


def test_a_comb_is_its_teeth_and_what_they_stand_on() -> None:
    assert len(check(COMB)) == 5


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ([(0, 0), (2, 2), (2, 0), (0, 2)], r"this one does: from \[0.0, 0.0\] to \[2.0"),
        ([(0, 0), (2, 0), (2, 2), (1, 0), (0, 2)], "cross or touch itself"),
        ([(0, 0), (1, 1), (2, 2), (3, 3)], "on a line"),
        ([(0, 0), (1, 1)], "3 to 1,000 finite points; this one is 2"),
        ([(0, 0), (1, 1), (math.nan, 0)], "3 to 1,000 finite points"),
    ],
)
def test_an_outline_that_is_no_area_is_refused(points: list[tuple[float, float]], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        convex_parts(points)


def test_a_drawn_thing_is_welded_and_moves_as_one() -> None:
    world = World()
    parts = outline(world, COMB, mass=6.0, velocity=(1.0, 2.0), angular_velocity=1.0, name="comb")
    masses = [world.component(part, Mass).mass for part in parts]
    assert sum(masses) == pytest.approx(6.0)
    momentum = [
        world.component(part, Velocity).linear * mass for part, mass in zip(parts, masses, strict=True)
    ]
    assert sum(momentum, Vector2()).magnitude == pytest.approx(6.0 * math.hypot(1.0, 2.0))
    places = [world.component(part, Transform).position for part in parts]
    start = [(one - places[0]).magnitude for one in places]
    assert world.label(parts[0]) == "comb"
    world.run(seconds=0.5)
    assert [world.component(part, Transform).angle for part in parts] == pytest.approx([0.5] * len(parts))
    places = [world.component(part, Transform).position for part in parts]
    assert [(one - places[0]).magnitude for one in places] == pytest.approx(start)
    assert len(joint_states(world)) == len(parts) - 1
    assert count_near_pairs(world) == 0
    still = World()
    outline(still, COMB, static=True)
    assert not joint_states(still)
