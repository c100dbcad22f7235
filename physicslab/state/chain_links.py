"""The links of a chain as rows of the pool: see :mod:`physicslab.kernels.geometry.links`."""

import math

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels.geometry.links import BLOCK, ROWS
from physicslab.kernels.geometry.shapes import Shapes

SMOOTH = math.radians(15.0)
"""The largest angle by which a chain turns and is round there [rad]."""
_ANGLE_ROUNDING = 1e-9
"""Rounding of angles [rad] and of shares of a length."""
_ONE_CIRCLE = 1e-10
"""Share of its radius by which the centres and radii of arcs of one circle differ."""
_FINE = 0.05
"""The angle of a side of an arc that is painted [rad]."""
_WIDEST = 0.5 * math.pi
"""The largest angle of an arc, but for a corner [rad]: its normal tells whether a place is beside it."""

type _Points = NDArray[np.float64]
type _Row = tuple[float, ...]

NO_LINKS: _Points = np.zeros((0, 2))


def links_of(vertices: _Points) -> tuple[_Points, _Points]:
    """Return the vertices at which a chain turns, and its links as rows of the pool.

    Links in line are one segment, so that no seam is left on it.

    Parameters
    ----------
    vertices : float64 array (n, 2)
        Along the chain [m]; the last one is the first one where it is closed.

    Returns
    -------
    kept : float64 array (k, 2)
        Vertices [m].
    rows : float64 array (ROWS m + 2 b + 1, 2)
        Of ``m`` links, ``b`` boxes about several of them, and their number. None of vertices that are no
        chain, which are refused.
    """
    way = np.diff(vertices, axis=0)
    if not np.isfinite(way).all() or not np.hypot(*way.T).all():
        return vertices, NO_LINKS
    closed = bool((vertices[0] == vertices[-1]).all())
    kept = vertices[_corners(way.tolist(), closed)]
    if len(kept) < 2:
        return vertices, NO_LINKS
    way = np.diff(kept, axis=0)
    length = np.hypot(way[:, 0], way[:, 1])
    along = way / length[:, None]
    links = _rows(kept.tolist(), along.tolist(), length.tolist(), closed)
    return kept, _with_boxes(np.array(links).reshape(-1, ROWS - 2, 2), closed)


def _corners(way: list[list[float]], closed: bool) -> list[int]:
    """Return the numbers of the vertices at which a chain turns, and of its ends."""
    last, kept = len(way), [0]
    x, y = way[0]
    for k in range(1, last):
        if _turn(x, y, *way[k]) == 0.0:
            x, y = x + way[k][0], y + way[k][1]
        else:
            kept.append(k)
            x, y = way[k]
    if closed and len(kept) > 2 and _turn(x, y, *way[0]) == 0.0:
        return [*kept[1:], kept[1]]
    return [*kept, last]


def _turn(x: float, y: float, to_x: float, to_y: float) -> float:
    """Return by how much one direction is turned against another, to the left [rad]; 0 for rounding."""
    turn = math.atan2(x * to_y - y * to_x, x * to_x + y * to_y)
    return turn if abs(turn) > _ANGLE_ROUNDING else 0.0


def _rows(
    places: list[list[float]], along: list[list[float]], length: list[float], closed: bool
) -> list[_Row]:
    """Return the links between places [m]: bend, size, place, both normals, segment, and that it goes on."""
    count, links = len(along), list[_Row]()
    turns = [_turn(*along[k - 1], *along[k % count]) for k in range(count + 1)]
    used = [0.5 * min(length[k - 1], length[k % count]) for k in range(count + 1)]
    used = [  # nothing where a turn that was just beyond rounding is within it, taken of whole lengths
        way if 0.0 < abs(turn) <= SMOOTH + _ANGLE_ROUNDING else 0.0
        for way, turn in zip(used, turns, strict=True)
    ]
    if not closed:
        used[0] = used[-1] = 0.0
        (x, y), (u, w) = places[0], along[0]
        links.append((1.0, 0.0, x, y, -u, -w, w, -u, 0.0, 1.0))
    for k in range(count):
        (x, y), (u, w), segment = places[k], along[k], float(k)
        straight = length[k] - used[k] - used[k + 1]
        if straight > _ANGLE_ROUNDING * length[k]:
            links.append((0.0, straight, x + used[k] * u, y + used[k] * w, w, -u, w, -u, segment, 1.0))
        x, y, turn, way = *places[k + 1], turns[k + 1], used[k + 1]
        to_u, to_w = along[(k + 1) % count]
        if k + 1 == count and not closed:
            links.append((1.0, 0.0, x, y, w, -u, u, w, segment, 1.0))
        elif way > 0.0:
            bend, radius = math.copysign(1.0, turn), way / math.tan(0.5 * abs(turn))
            x, y = x - way * u - bend * radius * w, y - way * w + bend * radius * u
            _append(links, (bend, radius, x, y, w, -u, to_w, -to_u, segment, 1.0))
        elif abs(turn) >= math.pi - _ANGLE_ROUNDING:  # back on the other side: two right angles
            links.append((1.0, 0.0, x, y, w, -u, u, w, segment, 1.0))
            links.append((1.0, 0.0, x, y, u, w, to_w, -to_u, segment, 1.0))
        elif turn > 0.0:
            links.append((1.0, 0.0, x, y, w, -u, to_w, -to_u, segment, 1.0))
    return links


def _append(links: list[_Row], arc: _Row) -> None:
    """Add an arc; to the last one where both are of one circle."""
    bend, radius, x, y, _, _, to_x, to_y, _, _ = arc
    if links and links[-1][0] == bend and links[-1][1] > 0.0:
        _, size, at_x, at_y, from_x, from_y, _, _, segment, _ = links[-1]
        off = max(abs(size - radius), abs(at_x - x), abs(at_y - y))
        if off <= _ONE_CIRCLE * radius and abs(_turn(from_x, from_y, to_x, to_y)) <= _WIDEST:
            links[-1] = (bend, size, at_x, at_y, from_x, from_y, to_x, to_y, segment, 1.0)
            return
    links.append(arc)


def _with_boxes(links: _Points, closed: bool) -> _Points:
    """Return links (m, 5, 2) with boxes about them, those about several, and their number."""
    (bend, size), place, begin, end = links[:, 0].T, links[:, 1], links[:, 2], links[:, 3]
    flat = bend == 0.0
    links[:, 4, 1] = ~(flat & np.roll(flat, -1))  # two faces meet in a notch
    if not closed:
        links[-1, 4, 1] = 0.0
    tangent = np.stack((-begin[:, 1], begin[:, 0]), axis=1)
    reach = (bend * size)[:, None]
    ends = np.where(
        flat[:, None], [place, place + size[:, None] * tangent], [place + reach * begin, place + reach * end]
    )
    half = np.sqrt(np.maximum(0.5 + 0.5 * (begin * end).sum(axis=1), 0.0))
    sagitta = np.where(flat, 0.0, size * (1.0 - half))[:, None]
    low, high = ends.min(axis=0) - sagitta, ends.max(axis=0) + sagitta
    blocks = range(0, len(links), BLOCK)
    about = [(low[k : k + BLOCK].min(axis=0), high[k : k + BLOCK].max(axis=0)) for k in blocks]
    whole = np.concatenate((links[:, :4], low[:, None], high[:, None], links[:, 4:]), axis=1)
    return np.concatenate((whole.reshape(-1, 2), np.array(about).reshape(-1, 2), [(float(len(links)), 0.0)]))


def segment_of_link(shapes: Shapes, row: int, k: int) -> int:
    """Return the number of the segment on which link k of the chain in a row begins."""
    return int(links_in(shapes, row)[k, ROWS - 1, 0])


def links_in(shapes: Shapes, row: int) -> _Points:
    """Return the links (m, ROWS, 2) of the chain in a row of the table of shapes."""
    return links_before(shapes.pool, int(shapes.first[row]))


def links_before(pool: _Points, first: int) -> _Points:
    """Return the links (m, ROWS, 2) before a vertex of the pool (n, 4), the first one of a chain."""
    count = int(pool[first - 2, 0])
    begin = first - 2 - ROWS * count - 2 * -(-count // BLOCK)
    return pool[begin : begin + ROWS * count, :2].reshape(count, ROWS, 2)


def line_along(links: _Points) -> _Points:
    """Return places (n, 2) along links (m, ROWS, 2) [m]: arcs are many short sides."""
    places: list[_Points] = []
    for (bend, size), place, begin, end in links[:, :4]:
        if bend == 0.0:
            places.append(np.array((place, place + size * np.array((-begin[1], begin[0])))))
        elif size == 0.0:
            places.append(place[None])
        else:
            turn = _turn(*begin.tolist(), *end.tolist())
            angles = math.atan2(begin[1], begin[0]) + np.linspace(0.0, turn, 2 + int(abs(turn) / _FINE))
            around = np.stack((np.cos(angles), np.sin(angles)), axis=1)
            places.append(place + bend * size * around)
    line = np.concatenate(places)
    apart = np.abs(np.diff(line, axis=0)).max(axis=1) > _ANGLE_ROUNDING * np.abs(line).max()
    return line[np.concatenate(([True], apart))]
