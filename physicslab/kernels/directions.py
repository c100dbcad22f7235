"""Cosines and sines of eight angles at once, as Taylor series within an eighth of a turn.

The C library's take them one by one. These are right to 2e-16, and to the last digit of the angle where that
is of more than a million turns; where the angle is no number, neither are they.
"""

import math

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels.float64x8 import Wide, choose, greater, lesser, put_pairs, size_of, take
from physicslab.kernels.wide_layout import WIDE

_QUARTER = 0.5 * math.pi
_FIRST = float.fromhex("0x1.921fb544p+0")
_SECOND = float.fromhex("0x1.0b4611a6p-34")
_THIRD = float.fromhex("0x1.3198a2e037073p-69")
"""The quarter of a turn [rad] in three parts: the first two times a whole number below 2^20 are exact."""
_WHOLE = 1.5 * 2.0**52
"""Added to a number below 2^51 and subtracted again, it rounds to a whole one."""
_S3, _S5, _S7, _S9, _S11, _S13, _S15 = ((-1.0) ** (n // 2) / math.factorial(n) for n in range(3, 16, 2))
_C4, _C6, _C8, _C10, _C12, _C14, _C16 = ((-1.0) ** (n // 2) / math.factorial(n) for n in range(4, 17, 2))


@always_inlined
def _direction(angle: Wide) -> tuple[Wide, Wide]:
    """Return the cosines and sines of eight angles [rad]."""
    quarters = (angle * (1.0 / _QUARTER) + _WHOLE) - _WHOLE
    rest = ((angle - quarters * _FIRST) - quarters * _SECOND) - quarters * _THIRD
    rest = greater(-1.0, lesser(1.0, rest))  # of angles that are too large for the parts
    turns = (0.25 * quarters + _WHOLE) - _WHOLE
    quarter = quarters - 4.0 * turns  # from -2 to 2
    z = rest * rest
    sine = _S9 + z * (_S11 + z * (_S13 + z * _S15))
    sine = rest + rest * z * (_S3 + z * (_S5 + z * (_S7 + z * sine)))
    cosine = _C10 + z * (_C12 + z * (_C14 + z * _C16))
    cosine = (1.0 - 0.5 * z) + z * z * (_C4 + z * (_C6 + z * (_C8 + z * cosine)))
    size = size_of(quarter)
    odd = (size > 0.5) & (size < 1.5)
    c, s = choose(odd, sine, cosine), choose(odd, cosine, sine)
    c = choose((quarter > 0.5) | (quarter < -1.5), -c, c)
    s = choose((quarter < -0.5) | (quarter > 1.5), -s, s)
    return c, s


@inlined
def face(angle: Numbers, facing: Vectors) -> None:
    """Give ``facing`` (8 n, 2) the directions of angles (8 n,) [rad]: their cosines and sines."""
    for at in range(0, len(angle), WIDE):
        c, s = _direction(take(angle, at))
        put_pairs(facing, at, c, s)
