"""Joints: pins with screws, limits and motors, slots as rails, welds as beads; the table of all kinds."""

import math
from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Gear, Pin, Pulley, Rod, Rope, Slot, Transform, Weld
from physicslab.state.joint_rows import KINDS, ends_of
from physicslab.theme import Theme
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Points
from physicslab.view.picture.gears import draw_gears, gear_paths
from physicslab.view.picture.links import draw_pulleys, draw_rods, draw_ropes, line_ends, link_ends
from physicslab.view.picture.pen import Pen
from physicslab.world import World

_CATCH = 6.5
"""How near to a screw, a slider or a bead a press need be [px]."""
_NEAR_LINE = 6.0
"""How near to a rod or a rope [px]."""
_LIMIT, _TICK, _MOTOR = 22.0, 5.0, 12.5
"""Radius of the arc between limits, half length of the stops at its ends, radius of the arrow of a motor."""
_RAIL, _SLIDER = 5.5, (9.0, 6.0)
"""Half the width of a rail, half the sides of its slider [px]."""
_OPEN = 0.6
"""How far beyond its slider a rail without a limit is drawn [m]."""
_BEAD = 3.8
"""Radius of the beads of a weld [px]."""


def draw_joints(world: World, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw all joints; nothing is done where there are none."""
    if not world.joints.joints:
        return
    pen = Pen(camera, theme)
    for kind, draw in _PICTURES.items():
        if len(world.batch(kind)):
            draw(world, pen)
    pen.draw(canvas)


def _angles(world: World, kind: type) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the angles of A and B (n,) [rad]."""
    a, b = (np.maximum(end, 0) for end in ends_of(world.entity_index, kind))
    angle = world.table(Transform)["angle"]
    return angle[a], angle[b]


def _around(centre: Points, radius: float, begin: float, end: float) -> Points:
    """Return the points of an arc (1, k, 2) [px] between two angles [rad]."""
    turns = np.linspace(begin, end, max(round(abs(end - begin) / 0.2), 2) + 1)
    return (centre + radius * np.stack((np.cos(turns), -np.sin(turns)), axis=1))[None]


def _arrow_head(tip: Points, way: Points, size: float) -> Points:
    """Return the corners (1, 3, 2) [px] of the head of an arrow that points along a unit vector."""
    back, side = tip - size * way, np.array((-way[1], way[0])) * 0.75 * size
    return np.stack((back + side, tip, back - side))[None]


# ---- pins --------------------------------------------------------------------------------------------------


def _draw_pins(world: World, pen: Pen) -> None:
    at_a, _, *fixed = link_ends(world, Pin)
    table, rows = world.table(Pin), world.batch(Pin).rows
    centre, (angle_a, angle_b) = pen.camera.project(at_a), _angles(world, Pin)
    to_world, turning = fixed[0] | fixed[1], np.where(fixed[1], angle_a, angle_b)
    pen.brackets(centre[to_world], -1.0)
    limited = table["lower_given"][rows] | table["upper_given"][rows]
    if limited.any():
        arms, length = _arms(world, at_a)
        small = (length > 1e-9) & (
            length * pen.camera.scale < 1.4 * _LIMIT * pen.unit
        )  # the arc would hide it
        for n in np.flatnonzero(limited & ~small).tolist():
            _draw_limits(pen, centre[n], arms[n], float(angle_b[n] - angle_a[n]), table, int(rows[n]))
    pen.screws(centre, turning)
    for n in np.flatnonzero(table["motor_speed_given"][rows]).tolist():
        _draw_motor(pen, centre[n], float(table["motor_speed"][rows[n]]), bool(fixed[1][n]))


def _arms(world: World, place: Points) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return in which directions the bodies lie that pins turn (n,) [rad], and how far off (n,) [m].

    They are B, or A where B is the world.
    """
    a, b = (np.maximum(end, 0) for end in ends_of(world.entity_index, Pin))
    body, transform = np.where(b == 0, a, b), world.table(Transform)
    way = transform["position"][body] - place
    length = np.hypot(way[:, 0], way[:, 1])
    return np.where(length > 1e-9, np.arctan2(way[:, 1], way[:, 0]), transform["angle"][body]), length


def _draw_limits(pen: Pen, centre: Points, arm: float, now: float, table: object, row: int) -> None:
    """Add the arc through which the body beyond a pin can turn, with stops where that ends."""
    radius, colour = _LIMIT * pen.unit, pen.theme.accent
    found = [table[name][row] - now for name in ("lower", "upper") if table[f"{name}_given"][row]]  # type: ignore[index]
    stops = [float(arm + part) for part in found]
    low = stops[0] if table["lower_given"][row] else stops[-1] - 0.5 * math.pi  # type: ignore[index]
    high = stops[-1] if table["upper_given"][row] else stops[0] + 0.5 * math.pi  # type: ignore[index]
    if high - low > 2.0 * math.pi:
        low, high = high - 2.0 * math.pi, high
    edge = pen.dark(colour, 0.85)
    for shade, width in ((edge, 3.6), (colour, 1.6)):
        pen.paths(_around(centre, radius, low, high), shade, width)
        for stop in stops:
            way = np.array((math.cos(stop), -math.sin(stop)))
            tick, at = _TICK * pen.unit * way, (centre + radius * way)[None]
            pen.lines(at - tick, at + tick, shade, width + 1.2)


def _draw_motor(pen: Pen, centre: Points, speed: float, turns_a: bool) -> None:
    """Add an arrow around a pin in the direction in which its motor turns what it holds."""
    sign = math.copysign(1.0, -speed if turns_a else speed)
    begin, radius, colour = -0.25 * math.pi, _MOTOR * pen.unit, pen.theme.accent
    end = begin + sign * 1.5 * math.pi
    arc = _around(centre, radius, begin, end)
    pen.paths(arc, pen.dark(pen.theme.accent, 0.85), 4.6)
    pen.paths(arc, colour, 2.4)
    way = sign * np.array((-math.sin(end), -math.cos(end)))
    pen.paths(_arrow_head(arc[0, -1] + 3.5 * pen.unit * way, way, 6.0 * pen.unit), colour, 2.4)


# ---- slots -------------------------------------------------------------------------------------------------


def _draw_slots(world: World, pen: Pen) -> None:
    at_a, at_b, *fixed = link_ends(world, Slot)
    table, (angle_a, angle_b) = world.table(Slot), _angles(world, Slot)
    for n, row in enumerate(world.batch(Slot).rows.tolist()):
        x, y = table["axis"][row]
        turn = math.atan2(y, x) + float(angle_a[n])
        axis = np.array((math.cos(turn), math.sin(turn)))
        now = float((at_b[n] - at_a[n]) @ axis)
        lower, upper = (
            float(table[name][row]) if table[f"{name}_given"][row] else None for name in ("lower", "upper")
        )
        low = lower if lower is not None else min(now, 0.0) - _OPEN
        high = upper if upper is not None else max(now, 0.0) + _OPEN
        rail = pen.camera.project(np.stack((at_a[n] + low * axis, at_a[n] + high * axis)))
        slider = pen.camera.project(at_b[n][None])
        if np.isfinite(rail).all() and np.isfinite(slider).all():
            _draw_slot(pen, rail, slider, (lower, upper), turn)
            if fixed[0][n]:
                pen.discs(rail, 2.2, pen.theme.pin)
            if table["turns"][row]:
                pen.screws(slider, angle_b[n : n + 1])
            if table["motor_speed_given"][row]:
                _draw_drive(pen, slider[0], turn, float(table["motor_speed"][row]))


def _draw_slot(
    pen: Pen, rail: Points, slider: Points, limits: tuple[float | None, float | None], turn: float
) -> None:
    """Add a rail of two bars, with stops where it has limits, and the block that slides between them."""
    ahead = np.array((math.cos(turn), -math.sin(turn)))
    aside, colour = _RAIL * pen.unit * np.array((ahead[1], -ahead[0])), pen.theme.rod
    inset = _RAIL * pen.unit * ahead
    pen.lines(rail[:1] + inset, rail[1:] - inset, pen.dark(colour, 0.8), 2.0 * _RAIL)
    for side in (aside, -aside):
        pen.lines(rail[:1] + side, rail[1:] + side, pen.dark(colour), 3.6)
        pen.lines(rail[:1] + side, rail[1:] + side, colour, 2.0)
    for spot, limit in zip(rail, limits, strict=True):
        if limit is not None:
            pen.lines((spot - 1.7 * aside)[None], (spot + 1.7 * aside)[None], pen.theme.pin, 3.4)
    along, across = _SLIDER
    for grown, shade in ((1.2, pen.dark(pen.theme.pin)), (0.0, pen.dark(pen.theme.pin, 0.15))):
        reach = (along - across) * pen.unit * ahead
        pen.lines(slider - reach, slider + reach, shade, 2.0 * (across + grown))


def _draw_drive(pen: Pen, slider: Points, turn: float, speed: float) -> None:
    """Add an arrow on a slider in the direction in which its motor moves it."""
    way = math.copysign(1.0, speed) * np.array((math.cos(turn), -math.sin(turn)))
    for n in (16.0, 21.0):
        tip = slider + n * pen.unit * way
        pen.paths(_arrow_head(tip, way, 4.0 * pen.unit), pen.theme.accent, 1.8)


# ---- welds -------------------------------------------------------------------------------------------------


def _draw_welds(world: World, pen: Pen) -> None:
    """Add three beads in a row at each weld, across the line between the middles of what it joins."""
    at_a, _, *fixed = link_ends(world, Weld)
    a, b = (np.maximum(end, 0) for end in ends_of(world.entity_index, Weld))
    position, centre = world.table(Transform)["position"], pen.camera.project(at_a)
    way = np.where((b == 0)[:, None], at_a, position[b]) - np.where((a == 0)[:, None], at_a, position[a])
    size = np.hypot(way[:, 0], way[:, 1])[:, None]
    way = np.where(size > 1e-9, way, (1.0, 0.0)) / np.where(size > 1e-9, size, 1.0)
    across = np.stack((way[:, 1], way[:, 0]), axis=1) * 1.35 * _BEAD * pen.unit
    pen.brackets(centre[fixed[0] | fixed[1]], -1.0)
    for n in (-1.6, -0.8, 0.0, 0.8, 1.6):
        pen.rings(centre + n * across, _BEAD, pen.dark(pen.theme.pin, 0.6), pen.dark(pen.theme.pin, 0.2), 1.0)


_PICTURES: dict[type, Callable[[World, Pen], None]] = {
    Gear: draw_gears, Slot: _draw_slots, Weld: _draw_welds, Pulley: draw_pulleys, Rope: draw_ropes,
    Rod: draw_rods, Pin: _draw_pins,
}  # fmt: skip
"""The function that draws each kind of joint, the lowest first; one without is drawn as a rod."""
_LIKE_RODS = {kind: partial(draw_rods, kind=kind) for kind in KINDS if kind not in _PICTURES}
_PICTURES |= _LIKE_RODS


# ---- what is under the cursor ------------------------------------------------------------------------------


def joint_at(world: World, camera: Camera, pixel: tuple[float, float], *, lines: bool = False) -> int | None:
    """Return the entity of the joint at a place on the screen [px], or ``None``.

    By its screw, slider, bead or wheel; with ``lines`` by its bar, rope, rim or belt, behind bodies.
    """
    best, found = math.inf, None
    for kind in _PICTURES:
        if kind is Gear or not len(world.batch(kind)) or lines != (kind in (Rod, Rope, *_LIKE_RODS)):
            continue
        start, end = line_ends(world, camera, kind)
        if kind is Pulley:
            table, rows = world.table(kind), world.batch(kind).rows
            start, end = (camera.project(table[name][rows]) for name in ("wheel_a", "wheel_b"))
        elif not lines:
            start = end = end if kind is Slot else start
        gaps = gaps_to(start, end, pixel)
        nearest = int(np.argmin(gaps))
        if gaps[nearest] < best:
            best, found = float(gaps[nearest]), int(world.batch(kind).entities[nearest])
    for entity, paths in gear_paths(world, camera).items() if lines else ():
        gap = min(float(gaps_to(path[:-1], path[1:], pixel).min()) for path in paths)
        if gap < best:
            best, found = gap, entity
    return found if best <= (_NEAR_LINE if lines else _CATCH) else None


def gaps_to(start: Points, end: Points, pixel: tuple[float, float]) -> NDArray[np.float64]:
    """Return how far a place is from lines (n,) [px]; infinite for those that are not finite."""
    with np.errstate(all="ignore"):
        along, offset = end - start, np.array(pixel) - start
        size = np.maximum((along**2).sum(axis=1), 1e-12)
        share = np.clip((along * offset).sum(axis=1) / size, 0.0, 1.0)[:, None]
        gaps: NDArray[np.float64] = np.hypot(*(offset - share * along).T)
    gaps[~np.isfinite(gaps)] = np.inf
    return gaps


def joint_lines(world: World, camera: Camera, entity: int) -> Points:
    """Return the line along each joint of an entity (n, 2, 2) [px], which a selection marks."""
    found = []
    for kind in _PICTURES:
        entities = world.batch(kind).entities.tolist() if kind is not Gear else []
        if entity in entities:
            n = entities.index(entity)
            start, end = line_ends(world, camera, kind)
            found.append((start[n], end[n]))
    for path in gear_paths(world, camera).get(entity, ()):
        found += list(pairwise(path))
    return np.array(found).reshape(-1, 2, 2)
