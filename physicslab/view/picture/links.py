"""Rods as bars with eyes, ropes that are woven and hang where they are slack, ropes over wheels."""

import math

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Pulley, Rod, Rope
from physicslab.ecs.vector import Vector2
from physicslab.state.joint_rows import ends_of
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Points
from physicslab.view.picture.pen import Pen, aside
from physicslab.view.picture.springs import place_of
from physicslab.world import World

_BAR, _EYE = 5.0, 4.4
"""Width of a rod, and radius of the eyes at its ends [px]."""
_ROPE, _STRAND = 4.4, 4.5
"""Width of a rope, and the distance of its strands [px]."""
_PIECES = 24
"""How many straight lines a slack rope is drawn as."""
_MAX_WOVEN = 60
"""Number of ropes above which none is woven."""
_SLACK = 1e-4
"""Share of its length by which the ends of a rope are nearer than it is long, where it hangs."""
_NARROW = 1e-3
"""Least distance across of the ends of a rope that hangs, as a share of its length."""
_WHEEL = 11.0
"""Radius of the wheel of a pulley [px]."""
_DOWN = Vector2(0.0, -1.0)


def link_ends(world: World, kind: type) -> tuple[Points, Points, NDArray[np.bool_], NDArray[np.bool_]]:
    """Return where joints of a kind hold A and B (n, 2) [m], and whether that is the world (n,)."""
    table, rows = world.table(kind), world.batch(kind).rows
    a, b = ends_of(world.entity_index, kind)
    a, b = np.maximum(a, 0), np.maximum(b, 0)
    start, end = place_of(world, a, table["anchor_a"][rows]), place_of(world, b, table["anchor_b"][rows])
    return start, end, a == 0, b == 0


def draw_rods(world: World, pen: Pen) -> None:
    """Add a bar with an eye at each end, and a bracket where it is fixed to the world."""
    at_a, at_b, *fixed = link_ends(world, Rod)
    start, end = pen.camera.project(at_a), pen.camera.project(at_b)
    colour = pen.theme.rod
    shine = aside(end - start) * pen.unit
    shine *= np.where(shine[:, 1] > 0.0, -1.0, 1.0)[:, None]  # the light comes from above
    _hold(pen, (start, end), fixed)
    pen.lines(start, end, pen.dark(colour), _BAR + 2.0)
    pen.lines(start, end, colour, _BAR)
    pen.lines(start + shine, end + shine, pen.light(colour), 1.3)
    for spots in (start, end):
        pen.rings(spots, _EYE, pen.dark(colour), colour, 1.0)
        pen.discs(spots, 1.5, pen.dark(colour, 0.8))
    _screw(pen, (start, end), fixed)


def draw_ropes(world: World, pen: Pen) -> None:
    """Add ropes; one whose ends are nearer than it is long hangs as a chain does, with its whole length."""
    at_a, at_b, *fixed = link_ends(world, Rope)
    length = world.table(Rope)["length"][world.batch(Rope).rows]
    down = world.physics.gravity if world.physics.gravity_mode == "linear" else Vector2()
    paths = [
        pen.camera.project(np.array(rope_path(Vector2(*start), Vector2(*end), float(whole), down)))
        for start, end, whole in zip(at_a.tolist(), at_b.tolist(), length, strict=True)
    ]
    ends = np.array([path[0] for path in paths]), np.array([path[-1] for path in paths])
    _hold(pen, ends, fixed)
    for path in paths:
        _weave(pen, path, is_woven=len(paths) <= _MAX_WOVEN)
    for spots in ends:
        pen.rings(spots, 3.6, pen.dark(pen.theme.rope), pen.theme.rope, 1.0)
    _screw(pen, ends, fixed)


def rope_path(start: Vector2, end: Vector2, length: float, pull: Vector2) -> list[tuple[float, float]]:
    """Return points along a rope of a length between two ends [m]: a straight line, or a catenary.

    With the span h, the drop v and the length L, h / 2a = x follows from sinh(x) / x = sqrt(L^2 - v^2) / h;
    the points are at equal distances along it. Without a pull it hangs downwards all the same.
    """
    way = end - start
    if not math.isfinite(length) or way.magnitude >= length * (1.0 - _SLACK):
        return [tuple(start), tuple(end)]
    up = -pull.normalized if pull else -_DOWN
    right = Vector2(up.y, -up.x)
    across, v = way.dot(right), way.dot(up)
    h = max(abs(across), _NARROW * length)
    right = right if across >= 0.0 else -right
    wanted = math.sqrt(length * length - v * v) / h
    x = _catenary(wanted)
    a, half = 0.5 * h / x, 0.5 * h
    lowest = half - a * math.atanh(v / length)  # from the start, along the span
    first = a * math.sinh(-lowest / a)
    points = []
    for n in range(_PIECES + 1):
        s = first + length * n / _PIECES
        along = (lowest + a * math.asinh(s / a)) * (abs(across) / h)
        height = math.hypot(a, s) - math.hypot(a, first)
        points.append(tuple(start + right * along + up * height))
    return points


def _catenary(wanted: float) -> float:
    """Return x > 0 with sinh(x) / x = ``wanted`` > 1, by bisection, which nothing upsets.

    >>> round(_catenary(1.1752011936438014), 9)
    1.0
    """
    low, high = 1e-4, 20.0
    for _ in range(60):
        x = 0.5 * (low + high)
        low, high = (x, high) if math.sinh(x) < wanted * x else (low, x)
    return 0.5 * (low + high)


def _weave(pen: Pen, path: Points, *, is_woven: bool) -> None:
    """Add a rope along a path (n, 2) [px]: a dark edge, its body, and its strands at equal distances."""
    colour, corners = pen.theme.rope, path[None]
    pen.paths(corners, pen.dark(colour, 0.6), _ROPE + 1.8)
    pen.paths(corners, colour, _ROPE)
    steps = np.hypot(*np.diff(path, axis=0).T)
    along = np.concatenate(([0.0], np.cumsum(steps)))
    count = int(min(along[-1], 4e3) / (_STRAND * pen.unit)) if np.isfinite(along[-1]) else 0
    if not is_woven or count < 2:
        return
    at = (np.arange(count) + 0.5) * along[-1] / count
    spots = np.stack((np.interp(at, along, path[:, 0]), np.interp(at, along, path[:, 1])), axis=1)
    piece = np.clip(np.searchsorted(along, at) - 1, 0, len(steps) - 1)
    ways = np.diff(path, axis=0)[piece] / np.maximum(steps[piece], 1e-9)[:, None]
    slant = (1.1 * ways + 1.5 * aside(ways)) * pen.unit
    pen.lines(spots - slant, spots + slant, pen.dark(colour, 0.45), 1.1)


def draw_pulleys(world: World, pen: Pen) -> None:
    """Add the rope of each pulley from body to body over its two wheels, and the wheels on their brackets."""
    at_a, at_b, *_ = link_ends(world, Pulley)
    table, rows = world.table(Pulley), world.batch(Pulley).rows
    for n, row in enumerate(rows.tolist()):
        hubs = pen.camera.project(np.stack((table["wheel_a"][row], table["wheel_b"][row])))
        ends = pen.camera.project(np.stack((at_a[n], at_b[n])))
        if not (np.isfinite(hubs).all() and np.isfinite(ends).all()):
            continue
        over = pulley_path(ends, hubs, _WHEEL * pen.unit)
        pen.brackets(hubs, 1.0)
        pen.rings(hubs, _WHEEL, pen.dark(pen.theme.rod), pen.dark(pen.theme.rod, 0.2), 1.6)
        pen.rings(hubs, 0.62 * _WHEEL, pen.dark(pen.theme.rod, 0.4), pen.dark(pen.theme.rod, 0.05), 1.0)
        _weave(pen, over, is_woven=len(rows) <= _MAX_WOVEN)
        pen.rings(ends, 3.6, pen.dark(pen.theme.rope), pen.theme.rope, 1.0)
        pen.screws(hubs, np.full(2, 0.7))


def pulley_path(ends: Points, hubs: Points, radius: float) -> Points:
    """Return the points of a rope between two ends over the rims of wheels at two hubs (2, 2) [px]."""
    middle, corners = hubs.mean(axis=0), [ends[0]]
    for n in (0, 1):
        way = ends[n] - hubs[n]
        side = aside(way[None])[0] * radius
        other = ends[1 - n] if np.allclose(hubs[0], hubs[1]) else middle
        side = side if side @ (other - hubs[n]) <= 0.0 else -side  # it runs down on the outer side
        begin = math.atan2(side[1], side[0])
        turn = math.remainder(-0.5 * math.pi - begin, 2.0 * math.pi)
        angles = begin + turn * np.linspace(0.0, 1.0, 9)
        arc = hubs[n] + radius * np.stack((np.cos(angles), np.sin(angles)), axis=1)
        corners += list(arc if n == 0 else arc[::-1])
    return np.array([*corners, ends[1]])


def _hold(pen: Pen, ends: tuple[Points, Points], fixed: list[NDArray[np.bool_]]) -> None:
    for spots, at in zip(ends, fixed, strict=True):
        pen.brackets(spots[at], 1.0)


def _screw(pen: Pen, ends: tuple[Points, Points], fixed: list[NDArray[np.bool_]]) -> None:
    for spots, at in zip(ends, fixed, strict=True):
        pen.screws(spots[at], np.full(int(at.sum()), 0.7))


def line_ends(world: World, camera: Camera, kind: type) -> tuple[Points, Points]:
    """Return the ends (n, 2) [px] of the lines that joints of a kind are drawn as."""
    at_a, at_b, *_ = link_ends(world, kind)
    return camera.project(at_a), camera.project(at_b)
