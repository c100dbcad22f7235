"""Vector2: construction, arithmetic, geometry, type guards."""

import copy
import math
import pickle
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.ecs.vector import Vector2

coordinates = st.floats(-1e6, 1e6)
vectors = st.builds(Vector2, coordinates, coordinates)
angles = st.floats(-10.0, 10.0)


def test_components_are_floats() -> None:
    single: Any = np.float32(2.5)
    v = Vector2(1, single)
    assert (v.x, v.y) == (1.0, 2.5)
    assert type(v.x) is float and type(v.y) is float
    assert Vector2() == Vector2(0.0, 0.0)


@pytest.mark.parametrize("value", ["1", None, True, 1j, [1.0], np.array([1.0])])
def test_only_numbers_make_a_vector(value: Any) -> None:
    with pytest.raises(TypeError, match=r"Vector2\.x takes a number"):
        Vector2(value, 0.0)
    with pytest.raises(TypeError, match=r"Vector2\.y takes a number"):
        Vector2(0.0, value)


def test_arithmetic() -> None:
    a, b = Vector2(1, 2), Vector2(3, -4)
    assert a + b == Vector2(4, -2)
    assert a - b == Vector2(-2, 6)
    assert 2 * a == a * 2 == Vector2(2, 4)
    assert b / 2 == Vector2(1.5, -2)
    assert -a == Vector2(-1, -2) and +a == a
    assert abs(b) == 5.0
    assert sum([a, b], Vector2()) == a + b


def test_every_kind_of_number_scales() -> None:
    two: Any
    for two in (np.float64(2), np.float32(2), np.int64(2), Fraction(2)):
        assert two * Vector2(1, 2) == Vector2(1, 2) * two == Vector2(2, 4)
        assert type((Vector2(1, 2) * two).x) is float


PAIR = (1.0, 2.0)
ODD_OPERATIONS: dict[str, Any] = {
    "vector + number": lambda v: v + 5,
    "number + vector": lambda v: 5 + v,
    "vector - number": lambda v: v - 5,
    "number - vector": lambda v: 5 - v,
    "vector + tuple": lambda v: v + PAIR,
    "vector + None": lambda v: v + None,
    "vector * vector": lambda v: v * v,
    "vector * tuple": lambda v: v * PAIR,
    "vector * bool": lambda v: v * True,
    "vector / vector": lambda v: v / v,
    "number / vector": lambda v: 1 / v,
    "vector + array": lambda v: v + np.ones(2),
    "array + vector": lambda v: np.ones(2) + v,
    "array * vector": lambda v: np.ones(2) * v,
    "vector * array": lambda v: v * np.ones(2),
    "vector < vector": lambda v: v < v,
    "vector ** 2": lambda v: v**2,
    "sum without a start": lambda v: sum([v, v]),
    "dot with a tuple": lambda v: v.dot(PAIR),
    "cross with a number": lambda v: v.cross(1),
    "reflected in a tuple": lambda v: v.reflected((0, 1)),
}


@pytest.mark.parametrize("operation", ODD_OPERATIONS.values(), ids=ODD_OPERATIONS)
def test_nothing_is_broadcast(operation: Any) -> None:
    with pytest.raises(TypeError):
        operation(Vector2(1, 2))


def test_equality_and_hash() -> None:
    assert Vector2(1, 2) == Vector2(1.0, 2.0) != Vector2(2, 1)
    pair: Any = (1, 2)
    assert (Vector2(1, 2) == pair) is False
    assert {Vector2(1, 2): "here"}[Vector2(1, 2)] == "here"
    assert hash(Vector2(0.0, -0.0)) == hash(Vector2(-0.0, 0.0))


def test_immutable() -> None:
    v = Vector2(1, 2)
    with pytest.raises(AttributeError):
        v.x = 3.0  # type: ignore[misc]
    with pytest.raises(AttributeError):
        del v.y
    with pytest.raises((AttributeError, TypeError)):
        v.z = 3.0  # type: ignore[attr-defined]
    assert v == Vector2(1, 2)


def test_unpacks_and_copies() -> None:
    x, y = v = Vector2(1, 2)
    assert (x, y) == (1.0, 2.0)
    assert pickle.loads(pickle.dumps(v)) == copy.copy(v) == copy.deepcopy(v) == v
    assert repr(v) == "Vector2(x=1.0, y=2.0)"
    assert not Vector2() and Vector2(0, 1e-300)


def test_angles() -> None:
    assert Vector2.from_angle(math.pi / 2, 3.0).y == 3.0
    assert Vector2(-1, 0).angle == math.pi
    assert Vector2(1, 0).perpendicular == Vector2(0, 1)
    assert Vector2(1, 0).cross(Vector2(0, 1)) == 1.0 == -Vector2(0, 1).cross(Vector2(1, 0))


def test_reflection_flips_the_part_along_the_normal() -> None:
    assert Vector2(2, -3).reflected(Vector2(0, 10)) == Vector2(2, 3)


def test_the_zero_vector_has_no_direction() -> None:
    with pytest.raises(ValueError, match="no direction"):
        _ = Vector2().normalized
    with pytest.raises(ValueError, match="no direction"):
        Vector2(1, 1).reflected(Vector2())


@pytest.mark.parametrize("size", [5e-324, 1e-310, 1e-200, 1.0, 1e200, 1.7e308])
def test_normalized_neither_over_nor_underflows(size: float) -> None:
    assert abs(Vector2(size, -size).normalized.magnitude - 1.0) < 1e-15


@given(vectors, vectors)
def test_dot_and_cross_share_out_the_magnitudes(a: Vector2, b: Vector2) -> None:
    product = a.magnitude * b.magnitude
    assert math.hypot(a.dot(b), a.cross(b)) == pytest.approx(product, rel=1e-9, abs=1e-9)
    assert a.cross(b) == -b.cross(a)


@given(vectors, angles)
def test_rotation_keeps_the_length(v: Vector2, angle: float) -> None:
    turned = v.rotated(angle)
    assert turned.magnitude == pytest.approx(v.magnitude, rel=1e-14)
    assert (turned.rotated(-angle) - v).magnitude <= 1e-14 * v.magnitude + 1e-300


@given(vectors, angles)
def test_two_reflections_undo_each_other(v: Vector2, angle: float) -> None:
    normal = Vector2.from_angle(angle, 2.0)
    assert (v.reflected(normal).reflected(normal) - v).magnitude <= 1e-14 * v.magnitude + 1e-300


@given(angles, st.floats(1e-6, 1e6))
def test_from_angle_and_back(angle: float, magnitude: float) -> None:
    v = Vector2.from_angle(angle, magnitude)
    assert v.magnitude == pytest.approx(magnitude)
    assert math.cos(v.angle - angle) == pytest.approx(1.0)
