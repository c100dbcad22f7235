"""Colours of the inside of bodies: what light and materials make of them, pixel by pixel.

A pixel is 32 bits of four 8-bit channels in any order.
"""

import math

from physicslab.kernels import inlined

DIAGONAL = 0.7071067811865476
"""Share of a place along each axis in that along the diagonal."""
_EVERY_OTHER = 0x00FF00FF
"""Two channels of a pixel, with room between them for products."""
WHITE, BLACK = 0xFFFFFFFF, 0
HATCH_SPACING = 10.0
"""Distance between the lines that mark what cannot move [px]."""
HATCH = 0.12
"""Share of the rim's colour in these lines."""
BRIGHT, DIM, DIM_DEEP = 0.2, 0.24, 0.432
"""Share of white where light falls on a body, and of black on its other side and deep in the ground."""
WEDGE_FROM = 3.0
"""Radius [px] from which a disc shows how far it has turned."""
WEDGE, WEDGE_REACH, WEDGE_SHARE = 0.3, 0.8, 0.4
"""Half the angle of the wedge that shows it [rad], its length as a share of the radius, its opacity."""
LIGHT_X, LIGHT_Y, LIGHT_REACH = 0.3, 0.5, 2.5
"""How far left of and above the middle of a disc it is lit most [radii]; squared distance of the dim side."""
DEEP = 260.0
"""Depth below its top in which ground is dim [px]."""
SHADOW_DOWN, SHADOW_SOFT, SHADOW_FROM = 3.0, 3.5, 5.0
"""How far below a body its shadow lies, half the width of its edge, least half extent with one [px]."""
FINISHES = ("FLAT", "POINT", "LIT", "RUBBER", "GROUND", "WOOD", "STEEL", "STONE", "ICE", "GLASS")
"""How the inside of a body is painted, by number: :class:`physicslab.view.canvas.canvas.Finish`."""
FLAT, _POINT, LIT, _RUBBER, GROUND, _WOOD, _STEEL, _STONE, _ICE, _GLASS = range(len(FINISHES))


@inlined
def blended(under: int, over: int, share: int) -> int:
    """Return ``under`` with a share (0..256) of ``over`` laid on it, channel by channel."""
    low = ((under & _EVERY_OTHER) * (256 - share) + (over & _EVERY_OTHER) * share) >> 8
    high = ((under >> 8) & _EVERY_OTHER) * (256 - share) + ((over >> 8) & _EVERY_OTHER) * share
    return (low & _EVERY_OTHER) | (high & (_EVERY_OTHER << 8))


@inlined
def mixed(under: int, over: int, share: float) -> int:
    """Return what :func:`blended` does, for a share from 0 to 1."""
    return blended(under, over, int(share * 256.0 + 0.5))


@inlined
def unit(value: float) -> float:
    """Return a value held within 0..1."""
    return min(max(value, 0.0), 1.0)


@inlined
def _share_of(place: float, period: float) -> float:
    """Return how far a place is in its period, 0 to 1."""
    turns = place / period
    return turns - math.floor(turns)


@inlined
def _speck(i: int, j: int) -> float:
    """Return a number from 0 to 1 that looks random."""
    n = (i * 374761393 + j * 668265263) & 0xFFFFFFFF
    n = ((n ^ (n >> 13)) * 1274126177) & 0xFFFFFFFF
    return float((n >> 16) & 255) / 255.0


@inlined
def _mottle(x: float, y: float) -> float:
    """Return a number from 0 to 1 that goes smoothly from one speck to the next."""
    i, j = int(x), int(y)
    s, t = x - i, y - j
    s, t = s * s * (3.0 - 2.0 * s), t * t * (3.0 - 2.0 * t)
    low = _speck(i, j) * (1.0 - s) + _speck(i + 1, j) * s
    high = _speck(i, j + 1) * (1.0 - s) + _speck(i + 1, j + 1) * s
    return low * (1.0 - t) + high * t


@inlined
def hatched(diagonal: float, colour: int, edge: int) -> int:
    """Return the colour of the ground at a place, by how far it is along the diagonal of the body [px]."""
    across = HATCH_SPACING * abs(_share_of(diagonal, HATCH_SPACING) - 0.5)
    return mixed(colour, edge, HATCH * unit(1.25 - across))


@inlined
def textured(finish: int, u: float, v: float, colour: int, edge: int, under: int) -> int:
    """Return the colour of a material at a place in the body's own frame [px], before what is under it."""
    if finish == GROUND:
        return hatched((u + v) * DIAGONAL, colour, edge)
    if finish == _WOOD:
        wave = _share_of(u, 90.0)
        grain = abs(_share_of(v + 7.0 * wave * (1.0 - wave), 6.0) - 0.5)
        return mixed(colour, BLACK, 0.04 + 0.2 * unit(1.0 - 6.0 * grain))
    if finish == _STEEL:
        sheen = 0.16 * unit(1.0 - 5.0 * abs(_share_of(u + v, 120.0) - 0.5))
        brushed = mixed(colour, BLACK, 0.09 * _speck(int(u / 41.0 + 1e4), int(v + 1e4)))
        return mixed(brushed, WHITE, sheen)
    if finish == _STONE:
        grain = _speck(int(u + 1e4), int(v + 1e4))
        return mixed(colour, BLACK, 0.13 * _mottle(0.2 * u + 1e4, 0.2 * v + 1e4) + 0.08 * grain)
    streak = max(
        1.0 - 14.0 * abs(_share_of(u - 0.6 * v, 47.0) - 0.3),
        0.6 - 14.0 * abs(_share_of(u - 0.6 * v, 47.0) - 0.5),
    )
    clear = 0.8 if finish == _ICE else 0.45
    return mixed(mixed(under, colour, clear), WHITE, 0.35 * unit(streak))


@inlined
def lit(fill: int, finish: int) -> int:
    """Return the colour of a body where light falls on it."""
    if finish in (FLAT, GROUND):
        return fill
    return mixed(fill, WHITE, 0.3 * BRIGHT if finish == _RUBBER else BRIGHT)


@inlined
def shaded(fill: int, finish: int) -> int:
    """Return the colour of a body on the side away from the light."""
    if finish == FLAT:
        return fill
    return mixed(fill, BLACK, DIM_DEEP if finish == GROUND else DIM)
