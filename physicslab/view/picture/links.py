"""Rods as bars with eyes, ropes that are woven and hang where they are slack, ropes over wheels."""

import math

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Pulley, Rod, Rope
from physicslab.ecs.vector import Vector2
from physicslab.state.joint_rows import ends_of
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Numbers, Points
from physicslab.view.picture.pen import Pen, aside, divided
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
_FAR = 4e3
"""Length of a rope above which it is not woven [px]."""
_STEPS = 8
"""Steps of Newton's method for catenaries: the last ones change nothing."""


def link_ends(world: World, kind: type) -> tuple[Points, Points, NDArray[np.bool_], NDArray[np.bool_]]:
    """Return where joints of a kind hold A and B (n, 2) [m], and whether that is the world (n,)."""
    table, rows = world.table(kind), world.batch(kind).rows
    a, b = ends_of(world.entity_index, kind)
    a, b = np.maximum(a, 0), np.maximum(b, 0)
    start, end = place_of(world, a, table["anchor_a"][rows]), place_of(world, b, table["anchor_b"][rows])
    return start, end, a == 0, b == 0


def draw_rods(world: World, pen: Pen, kind: type = Rod) -> None:
    """Add a bar with an eye at each end, and a bracket where it is fixed to the world."""
    at_a, at_b, *fixed = link_ends(world, kind)
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
    ends, project = (pen.camera.project(at_a), pen.camera.project(at_b)), pen.camera.project
    with np.errstate(over="ignore", invalid="ignore"):
        slack = np.hypot(*(at_b - at_a).T) < length * (1.0 - _SLACK)
    _hold(pen, ends, fixed)
    if not slack.all():
        _weave(pen, np.stack((ends[0][~slack], ends[1][~slack]), axis=1))
    if slack.any():
        linear = world.physics.gravity_mode == "linear" and bool(world.physics.gravity)
        pull = world.physics.gravity if linear else _DOWN
        hanging = rope_paths(at_a[slack], at_b[slack], length[slack], pull)
        _weave(pen, project(hanging.reshape(-1, 2)).reshape(hanging.shape))
    for spots in ends:
        pen.rings(spots, 3.6, pen.dark(pen.theme.rope), pen.theme.rope, 1.0)
    _screw(pen, ends, fixed)


def rope_paths(start: Points, end: Points, length: Numbers, pull: Vector2) -> Points:
    """Return points (n, k, 2) [m], at equal distances along ropes (n,) that hang between two ends (n, 2).

    They are catenaries: with the span h, the drop v and the length L, h / 2a = x follows from
    sinh(x) / x = sqrt(L^2 - v^2) / h. The lengths [m] are above the distances of the ends.
    """
    up = -pull.normalized
    axes = np.array(((up.y, -up.x), (up.x, up.y)))
    across, v = ((end - start) @ axes.T).T
    h = np.maximum(np.abs(across), _NARROW * length)
    a = 0.5 * h / _catenary(np.sqrt(length * length - v * v) / h)
    lowest = 0.5 * h - a * np.arctanh(v / length)  # from the start, along the span
    first = -a * np.sinh(lowest / a)
    s = first[:, None] + length[:, None] * np.linspace(0.0, 1.0, _PIECES + 1)
    a, first, lowest = a[:, None], first[:, None], lowest[:, None]
    along = (lowest + a * np.arcsinh(s / a)) * (across / h)[:, None]
    height = np.hypot(a, s) - np.hypot(a, first)
    points: Points = start[:, None, :] + np.stack((along, height), axis=2) @ axes
    return points


def _catenary(wanted: Numbers) -> Numbers:
    """Return x > 0 with sinh(x) / x = ``wanted`` > 1, by Newton's method for the logarithm of both sides.

    >>> _catenary(np.array((1.1752011936438014, 100.0))).round(9).tolist()
    [1.0, 7.283997681]
    """
    logarithm = np.log(wanted)
    x = np.sqrt(6.0 * logarithm) + logarithm
    for _ in range(_STEPS):
        x = x - (np.log(np.sinh(x) / x) - logarithm) / (1.0 / np.tanh(x) - 1.0 / x)
    return x


def _weave(pen: Pen, paths: Points) -> None:
    """Add ropes along paths (n, k, 2) [px] of points at equal distances: dark edges, bodies, and strands."""
    colour, pieces = pen.theme.rope, paths.shape[1] - 1
    pen.paths(paths, pen.dark(colour, 0.6), _ROPE + 1.8)
    pen.paths(paths, colour, _ROPE)
    ways = np.diff(paths, axis=1)
    with np.errstate(all="ignore"):
        length = pieces * np.hypot(ways[:, 0, 0], ways[:, 0, 1])
        count = np.where(length < _FAR, length / (_STRAND * pen.unit), 0.0).astype(np.int64)
    if len(paths) > _MAX_WOVEN or not count.any():
        return
    rope, nth = divided(count)
    share = (nth + 0.5) * pieces / count[rope]
    piece = share.astype(np.int64)
    way = ways[rope, piece]
    spots = paths[rope, piece] + (share - piece)[:, None] * way
    way = way * (pen.unit / np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9))[:, None]
    slant = 1.1 * way + 1.5 * np.stack((way[:, 1], -way[:, 0]), axis=1)
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
        over = _evenly(pulley_path(ends, hubs, _WHEEL * pen.unit))
        pen.brackets(hubs, 1.0)
        pen.rings(hubs, _WHEEL, pen.dark(pen.theme.rod), pen.dark(pen.theme.rod, 0.2), 1.6)
        pen.rings(hubs, 0.62 * _WHEEL, pen.dark(pen.theme.rod, 0.4), pen.dark(pen.theme.rod, 0.05), 1.0)
        _weave(pen, over[None])
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


def _evenly(path: Points) -> Points:
    """Return points at equal distances along a path (n, 2) [px]."""
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))))
    at = np.linspace(0.0, along[-1], 4 * _PIECES + 1)
    return np.stack((np.interp(at, along, path[:, 0]), np.interp(at, along, path[:, 1])), axis=1)


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
