"""An immutable vector in the plane."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import FrozenInstanceError, dataclass
from numbers import Real
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, init=False)
class Vector2:
    """A vector (x, y) of two floats; every operation returns a new one.

    Vectors add to vectors and scale by numbers. Nothing is broadcast: ``v + 5`` is a ``TypeError``, because a
    vector and a number have no sum; and a vector is not equal to a tuple, nor does it multiply with an array.

    Parameters
    ----------
    x, y : float
        Components, in whatever unit the quantity has; y points up.

    Examples
    --------
    >>> Vector2(1, 2) + Vector2(3, 4)
    Vector2(x=4.0, y=6.0)
    >>> 2 * Vector2(3, 4)
    Vector2(x=6.0, y=8.0)
    >>> Vector2(1, 2) + 5
    Traceback (most recent call last):
    ...
    TypeError: unsupported operand type(s) for +: 'Vector2' and 'int'
    """

    x: float
    y: float

    # numpy would otherwise take a Vector2 for a scalar and make an array of vectors of ``array * vector``.
    __array_ufunc__: ClassVar[None] = None

    def __init__(self, x: float = 0.0, y: float = 0.0) -> None:
        _set_x(self, x if type(x) is float else _as_float("x", x))
        _set_y(self, y if type(y) is float else _as_float("y", y))

    @classmethod
    def from_angle(cls, angle: float, magnitude: float = 1.0) -> Vector2:
        """Return the vector of the given length at ``angle`` radians, counter-clockwise from the x axis.

        >>> Vector2.from_angle(0.0, 2.0)
        Vector2(x=2.0, y=0.0)
        """
        return cls(magnitude * math.cos(angle), magnitude * math.sin(angle))

    def __add__(self, other: Vector2) -> Vector2:
        if not isinstance(other, Vector2):
            return NotImplemented
        return Vector2(self.x + other.x, self.y + other.y)

    def __sub__(self, other: Vector2) -> Vector2:
        if not isinstance(other, Vector2):
            return NotImplemented
        return Vector2(self.x - other.x, self.y - other.y)

    def __mul__(self, factor: float) -> Vector2:
        if not _is_number(factor):
            return NotImplemented
        factor = float(factor)
        return Vector2(self.x * factor, self.y * factor)

    __rmul__ = __mul__

    def __truediv__(self, divisor: float) -> Vector2:
        if not _is_number(divisor):
            return NotImplemented
        divisor = float(divisor)
        return Vector2(self.x / divisor, self.y / divisor)

    def __neg__(self) -> Vector2:
        return Vector2(-self.x, -self.y)

    def __pos__(self) -> Vector2:
        return self

    def __abs__(self) -> float:
        return self.magnitude

    def __bool__(self) -> bool:
        return self.x != 0.0 or self.y != 0.0

    def __iter__(self) -> Iterator[float]:
        """Yield x, then y, so that ``x, y = v`` works."""
        yield self.x
        yield self.y

    @property
    def magnitude(self) -> float:
        """The length, without overflow for large components.

        >>> Vector2(3, 4).magnitude
        5.0
        """
        return math.hypot(self.x, self.y)

    @property
    def magnitude_squared(self) -> float:
        """The squared length.

        >>> Vector2(3, 4).magnitude_squared
        25.0
        """
        return self.x * self.x + self.y * self.y

    @property
    def angle(self) -> float:
        """The direction in radians, counter-clockwise from the x axis, from -pi to pi.

        >>> Vector2(0, 1).angle == math.pi / 2
        True
        """
        return math.atan2(self.y, self.x)

    @property
    def normalized(self) -> Vector2:
        """The unit vector of the same direction; the zero vector has none and raises ``ValueError``.

        >>> Vector2(3, 4).normalized
        Vector2(x=0.6, y=0.8)
        """
        largest = max(abs(self.x), abs(self.y))
        if largest == 0.0:
            raise ValueError("the zero vector has no direction to normalize")
        x, y = self.x / largest, self.y / largest  # so that neither a huge nor a tiny vector loses digits
        length = math.hypot(x, y)
        return Vector2(x / length, y / length)

    @property
    def perpendicular(self) -> Vector2:
        """The vector turned a quarter turn counter-clockwise.

        >>> Vector2(1, 0).perpendicular
        Vector2(x=-0.0, y=1.0)
        """
        return Vector2(-self.y, self.x)

    def dot(self, other: Vector2) -> float:
        """Return the scalar product.

        >>> Vector2(1, 2).dot(Vector2(3, 4))
        11.0
        """
        _require_vector("dot", other)
        return self.x * other.x + self.y * other.y

    def cross(self, other: Vector2) -> float:
        """Return the signed area x1 y2 - y1 x2: positive where ``other`` is counter-clockwise of this vector.

        >>> Vector2(1, 0).cross(Vector2(0, 1))
        1.0
        """
        _require_vector("cross", other)
        return self.x * other.y - self.y * other.x

    def reflected(self, normal: Vector2) -> Vector2:
        """Return v - 2 (v . n) n, the mirror image in a surface with this normal (of any length but zero).

        >>> Vector2(1, -1).reflected(Vector2(0, 1))
        Vector2(x=1.0, y=1.0)
        """
        _require_vector("reflected", normal)
        n = normal.normalized
        return self - n * (2.0 * self.dot(n))

    def rotated(self, angle: float) -> Vector2:
        """Return the vector turned by ``angle`` radians counter-clockwise.

        >>> Vector2(1, 0).rotated(math.pi).x
        -1.0
        """
        c, s = math.cos(angle), math.sin(angle)
        return Vector2(c * self.x - s * self.y, s * self.x + c * self.y)


# The slots' own setters: nothing else writes to a frozen dataclass as fast, and every read of a vector column
# makes a vector.
def _refuse(vector: Vector2, name: str, value: object) -> None:
    if name not in ("x", "y"):
        raise AttributeError(f"a Vector2 has x and y, and no {name}")
    whole = f"({value!r}, {vector.y!r})" if name == "x" else f"({vector.x!r}, {value!r})"
    raise FrozenInstanceError(
        f"a vector's {name} cannot be changed by itself: assign a whole one, transform.position = {whole}"
    )


def rotated(vectors: NDArray[np.float64], angles: NDArray[np.float64] | float) -> NDArray[np.float64]:
    """Return vectors (..., 2), each turned by its angle (...) [rad] counter-clockwise."""
    c, s, x, y = np.cos(angles), np.sin(angles), vectors[..., 0], vectors[..., 1]
    return np.stack((c * x - s * y, s * x + c * y), axis=-1)


setattr(Vector2, "__setattr__", _refuse)  # noqa: B010
_set_x = Vector2.__dict__["x"].__set__
_set_y = Vector2.__dict__["y"].__set__


def _is_number(value: object) -> bool:
    return type(value) is float or (isinstance(value, Real) and not isinstance(value, bool))


def _as_float(name: str, value: float) -> float:
    if not _is_number(value):
        raise TypeError(f"Vector2.{name} takes a number, got {value!r}")
    return float(value)


def _require_vector(method: str, value: object) -> None:
    if not isinstance(value, Vector2):
        raise TypeError(f"Vector2.{method} takes a Vector2, got {value!r}")
