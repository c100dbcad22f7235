"""The table of shapes: what follows from vertices and a radius."""

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components.shape import KINDS, Kind
from physicslab.kernels.geometry import moments, shapes
from physicslab.kernels.geometry.shapes import Shapes, ShapesTuple
from physicslab.kernels.interpreter import fallback_of
from physicslab.state.shapes import Register, with_names

area_and_moment, inertia_of, derive_shape = (
    fallback_of(kernel) for kernel in (moments.area_and_moment, moments.inertia_of, shapes.derive_shape)
)
sizes = st.floats(0.01, 100.0)


def regular(count: int) -> tuple[tuple[float, float], ...]:
    turns = [2.0 * math.pi * k / count for k in range(count)]
    return tuple((math.cos(turn), math.sin(turn)) for turn in turns)


@cache
def register_with(kind: Kind) -> Register:
    """Return a register of one kind more; it has the lists of points of all tests before, too."""
    return Register((*KINDS.values(), kind))


def row_of(
    kind: Kind, radius: float = 0.0, width: float = 0.0, height: float = 0.0, length: float = 0.0
) -> Shapes:
    """Return a table of one shape of a kind, which comes behind the others in the register."""
    columns = np.array([radius]), np.array([width]), np.array([height]), np.array([length])
    kinds, extents, pool = register_with(kind).arrays()
    plain: ShapesTuple = np.zeros((2, 1), np.int64), np.zeros((6, 1)), pool
    table, own = with_names(plain), np.zeros(1, np.int64)
    assert derive_shape(0, np.array([len(KINDS) + 1]), own, columns, kinds, extents, table)
    return table


@given(count=st.integers(3, 8), reach=sizes)
def test_a_regular_polygon_is_one_row(count: int, reach: float) -> None:
    table = row_of(Kind(regular(count), x="radius", y="radius"), radius=reach)
    assert table.reach[0] == pytest.approx(reach, rel=1e-15)
    side, inner = 2.0 * reach * math.sin(math.pi / count), reach * math.cos(math.pi / count)
    area, moment = area_and_moment(table, 0)
    assert area == pytest.approx(0.5 * count * side * inner, rel=1e-14)
    assert moment / area == pytest.approx((side * side / 12.0 + inner * inner) / 2.0, rel=1e-14)


@given(width=sizes, height=sizes, radius=sizes)
def test_a_rounded_box_is_boxes_and_quarters_of_a_disc(width: float, height: float, radius: float) -> None:
    corners = ((0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5))
    kind = Kind(corners, x="width", y="height", radius="radius")
    table = row_of(kind, radius, width, height)
    area, moment = area_and_moment(table, 0)
    w, h, r = width, height, radius
    assert area == pytest.approx(w * h + 2 * r * (w + h) + math.pi * r * r, rel=1e-14)
    strips = 0.0
    for a, b in ((w, h), (h, w)):  # two strips a by r, their middles (b + r) / 2 away
        strips += 2.0 * a * r * ((a * a + r * r) / 12.0 + (b + r) ** 2 / 4.0)
    # A quarter disc about its corner (x, y): pi r^4 / 8, and its first moments r^3 / 3.
    quarters = 4.0 * (math.pi * r**4 / 8.0 + r**3 / 3.0 * (w + h) + math.pi * r * r / 16.0 * (w * w + h * h))
    assert moment == pytest.approx(w * h * (w * w + h * h) / 12.0 + strips + quarters, rel=1e-13)


@given(length=sizes, radius=sizes)
def test_a_capsule_is_a_box_and_two_half_discs(length: float, radius: float) -> None:
    table = row_of(KINDS["capsule"], radius, length=length)
    area, moment = area_and_moment(table, 0)
    box, disc = 2.0 * radius * length, math.pi * radius * radius
    assert area == pytest.approx(box + disc, rel=1e-14)
    inner = box * (length * length + 4.0 * radius * radius) / 12.0
    # Half a disc about its centre m r^2 / 2; its middle is 4 r / (3 pi) from there.
    ends = disc * (radius * radius / 2.0 + length * length / 4.0 + length * 4.0 * radius / (3.0 * math.pi))
    assert moment == pytest.approx(inner + ends, rel=1e-13)


def test_the_general_formula_gives_what_boxes_have() -> None:
    box = KINDS["box"]
    general = row_of(box, width=2.0, height=0.5)
    area, moment = area_and_moment(general, 0)
    assert general.first[0] != shapes.BOX
    special = general._replace(first=np.array([shapes.BOX]))
    assert 3.0 * moment / area == pytest.approx(inertia_of(special, 0, 3.0), rel=1e-15)
    assert np.array_equal(general.pool[shapes.BOX :][:4, :2], 2.0 * np.array(box.core))
