"""Rulers, protractors, gates and notes: where their points are, what they read, and how they are drawn."""

import math
import textwrap
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Gate, Note, Protractor, Ruler, Shape, Transform
from physicslab.ecs.vector import Vector2
from physicslab.state.attached import INSTRUMENTS, place_of
from physicslab.systems.gate import GateSystem
from physicslab.theme import Colour, Theme
from physicslab.view.canvas.camera import Camera, Drawing
from physicslab.view.canvas.canvas import Rect, TextStyle, draw_spots, is_within
from physicslab.view.canvas.drawable_text import drawable
from physicslab.view.canvas.quantities import quantity, rounded_up
from physicslab.view.overlay.arrows import even_dashes
from physicslab.view.overlay.labels import Label, Labels
from physicslab.world import World

type Points = Mapping[str, Vector2]
type Overrides = Mapping[tuple[int, str], Vector2]


@dataclass(frozen=True, slots=True)
class Instrument:
    """One instrument of a world.

    Attributes
    ----------
    entity : int
        Its entity, 0 for one that is not made yet.
    kind : component type
        Its kind.
    points : mapping of str to Vector2
        Where its points are in the world, by their names [m].
    """

    entity: int
    kind: type[Any]
    points: Points


def instrument_of(world: World, entity: int) -> Instrument | None:
    """Return the instrument that an entity is, or ``None``."""
    return next((one for one in instruments_of(world) if one.entity == entity), None)


def instruments_of(world: World, overrides: Overrides | None = None) -> Iterator[Instrument]:
    """Yield every instrument; ``overrides`` says where points are that are being dragged."""
    for kind in INSTRUMENTS:
        for entity in world.batch(kind).entities.tolist():
            points = {name: place_of(world, entity, kind, name) for name in kind.POINTS}
            for (owner, name), place in (overrides or {}).items():
                if owner == entity and name in points:
                    points[name] = place
            yield Instrument(entity, kind, points)


def angle_between(points: Points) -> float:
    """Return the angle between the arms of a protractor, from 0 to 180 degrees; 0 where an arm has no length.

    >>> angle_between({"vertex": Vector2(), "first": Vector2(2, 0), "second": Vector2(0, 1)})
    90.0
    """
    one, two = points["first"] - points["vertex"], points["second"] - points["vertex"]
    across = one.x * two.y - one.y * two.x
    return math.degrees(math.atan2(abs(across), one.dot(two))) if one and two else 0.0


def reading_of(one: Instrument) -> list[tuple[str, str]]:
    """Return what an instrument reads: names and values."""
    if one.kind is Protractor:
        return [("Angle", f"{angle_between(one.points):.2f}°")]
    if one.kind is Ruler:
        way = one.points["end"] - one.points["start"]
        return [
            ("Length", quantity(way.magnitude, "m")),
            ("Across", quantity(way.x, "m")),
            ("Up", quantity(way.y, "m")),
            ("From the right", f"{math.degrees(way.angle) if way else 0.0:.2f}°"),
        ]
    return []


def readings_of(world: World, entity: int) -> list[tuple[str, str]]:
    """Return what the instrument reads that an entity is; nothing of others."""
    one = instrument_of(world, entity)
    if one is None:
        return []
    part = world.component(entity, one.kind)
    bodies = ((name, getattr(part, f"{name}_body")) for name in one.kind.POINTS)
    attached = [(f"{name.capitalize()} attached to", world.label(body)) for name, body in bodies if body]
    return [*reading_of(one), *attached]


# ---- drawing -----------------------------------------------------------------------------------------------


_WIDTH, _CHOSEN_WIDTH = 1.8, 2.8
"""Width of lines, and of the selection [px]."""
_TICK, _APART = 5.0, 9.0
"""Length of the strokes on a ruler, and how far apart they are at least [px]."""
_MAX_TICKS = 400
_POST = 4.0
"""Radius of the discs at the ends of gates and of handles [px]."""
_ARC, _ARC_SHARE = 58.0, 0.55
"""Radius of a protractor's arc at most [px], and as a share of its shorter arm."""
_FAR = 1e6
"""Lines farther out of the picture than this are not drawn [px]."""
_LETTERS = 44
"""Letters in a line of a note."""
_PAD = 6
_CLEAR = 14
"""Distance of the boxes along a line that labels keep clear of [px]."""
_BEAM_DASH = 6.0
"""Length of the dashes of a gate's beam [px]."""
_FLASH = 0.12
"""How long a gate that was crossed is drawn brighter [s]."""

type _Pixels = NDArray[np.float64]
type _Places = dict[str, _Pixels]
"""Where the points of an instrument are, by their names: float64 arrays (2,) [px]."""
type _Drawn = tuple[_Pixels, list[str]]
"""The place that belongs to the label of an instrument (2,) [px], and the lines of that."""


def draw_instruments(
    world: World, instruments: Sequence[Instrument], selected: Collection[int], labels: Labels,
    covered: Sequence[Rect], on: Drawing, room: Rect | None = None,
) -> dict[int, Rect]:  # fmt: skip
    """Draw instruments with what they read; return where the words of each are [px].

    Labels keep clear of all lines, of the bodies that points go with, of each other and of what is covered;
    a note whose place is in the room of the world [px], the picture if that is left out, is within it.
    """
    if not instruments:
        return {}
    shown: list[tuple[Instrument, _Places]] = []
    for one in instruments:
        pixels = {name: np.array(on.camera.to_screen(place)) for name, place in one.points.items()}
        if all((np.abs(pixel) < _FAR).all() for pixel in pixels.values()):
            shown.append((one, pixels))
    taken, written = list(covered), list[Label]()
    for one, pixels in shown:
        taken += _room_of(pixels, on.camera.size)
        if one.kind is not Note:
            taken += _bodies_of(world, one, on.camera)
    rects: dict[int, Rect] = {}
    for one, pixels in shown:
        chosen = one.entity in selected or not one.entity
        if one.kind is Note:
            inside = room or (0, 0, *on.camera.size)
            rects[one.entity] = _draw_note(world, one, pixels["place"], chosen, inside, on)
            taken.append(rects[one.entity])
            continue
        at, lines = _DRAW[one.kind](world, one, pixels, chosen, on)
        if 0 <= at[0] < on.camera.size[0] and 0 <= at[1] < on.camera.size[1]:
            written.append(Label((one.entity,), (float(at[0]), float(at[1])), lines))
    placed = labels.draw(written, taken, on, always=True)
    for one, pixels in shown:
        if one.entity in selected:
            _draw_handles(list(pixels.values()), on)
    return rects | {key[0]: rect for key, rect in placed.items()}


def _line_colour(chosen: bool, theme: Theme) -> tuple[Colour, float]:
    return (theme.accent, _CHOSEN_WIDTH) if chosen else (theme.kinematic, _WIDTH)


def _draw_handles(pixels: Sequence[_Pixels], on: Drawing) -> None:
    draw_spots(on.canvas, np.array(pixels), _POST + 1.5, on.theme.background, on.theme.accent)


def _draw_ruler(world: World, one: Instrument, pixels: _Places, chosen: bool, on: Drawing) -> _Drawn:
    """Draw a line with strokes at round lengths."""
    colour, width = _line_colour(chosen, on.theme)
    start, end = pixels["start"], pixels["end"]
    length = float(np.hypot(*(end - start)))
    on.canvas.lines(start[None], end[None], colour, width)
    if length > 0.0:
        along = (end - start) / length
        aside = np.array((along[1], -along[0]))
        step = rounded_up(_APART / on.camera.scale) * on.camera.scale
        turns = np.arange(1, min(math.ceil(length / step), _MAX_TICKS))
        reach = np.where(turns % 10 == 0, 2.0, np.where(turns % 5 == 0, 1.5, 1.0)) * _TICK
        foot = start + (turns * step)[:, None] * along
        on.canvas.lines(foot, foot + reach[:, None] * aside, colour, 1.0, 0.8)
        ends, stroke = np.stack((start, end)), 1.6 * _TICK * aside
        on.canvas.lines(ends - stroke, ends + stroke, colour, width)
    values = dict(reading_of(one))
    way = one.points["end"] - one.points["start"]
    lines = [values["Length"], f"({way.x:.3g}, {way.y:.3g}) m   {values['From the right'][:-2]}°"]
    return 0.5 * (start + end), lines


def _draw_protractor(world: World, one: Instrument, pixels: _Places, chosen: bool, on: Drawing) -> _Drawn:
    """Draw two arms and the arc between them."""
    colour, width = _line_colour(chosen, on.theme)
    vertex = pixels["vertex"]
    ends = np.stack((pixels["first"], pixels["second"]))
    on.canvas.lines(np.stack((vertex, vertex)), ends, colour, width)
    first, second = ((one.points[name] - one.points["vertex"]) for name in ("first", "second"))
    words = [f"{angle_between(one.points):.1f}°"]
    if not (first and second):
        return vertex, words
    radius = min(_ARC, _ARC_SHARE * float(min(np.hypot(*(end - vertex)) for end in ends)))
    turn = math.remainder(second.angle - first.angle, 2.0 * math.pi)
    angles = first.angle + np.linspace(0.0, turn, max(2, math.ceil(abs(turn) / 0.1)))
    arc = vertex + radius * np.stack((np.cos(angles), -np.sin(angles)), axis=1)
    on.canvas.lines(arc[:-1], arc[1:], colour, 0.8 * width)
    middle = first.angle + 0.5 * turn
    return vertex + radius * np.array((math.cos(middle), -math.sin(middle))), words


def _draw_gate(world: World, one: Instrument, pixels: _Places, chosen: bool, on: Drawing) -> _Drawn:
    """Draw a dashed beam between two posts."""
    start, end, last = pixels["start"], pixels["end"], _last_crossings(world)
    crossed = world.time - last.get(one.entity, -math.inf) < _FLASH
    colour = on.theme.accent if chosen else on.theme.force if crossed else on.theme.notice
    beam = even_dashes(start, end, _BEAM_DASH)
    on.canvas.lines(*beam, colour, _CHOSEN_WIDTH if chosen or crossed else _WIDTH)
    draw_spots(on.canvas, np.stack((start, end)), _POST, colour, colour)
    words = world.label(one.entity) if one.entity else "gate"
    lines = [drawable(words[:_LETTERS])]
    if one.entity in last:
        lines.append(f"{last[one.entity]:.4g} s")
    return start if start[1] < end[1] else end, lines


_DRAW = {Ruler: _draw_ruler, Protractor: _draw_protractor, Gate: _draw_gate}


def _draw_note(world: World, one: Instrument, at: _Pixels, chosen: bool, room: Rect, on: Drawing) -> Rect:
    """Draw a note with its left upper corner at its place, or as near to it as it fits into a room [px]."""
    text = world.component(one.entity, Note).text if one.entity else ""
    lines = [part for line in text.split("\n") for part in (textwrap.wrap(drawable(line), _LETTERS) or [""])]
    style = TextStyle(on.size, on.theme.text)
    height = on.canvas.text_size("Ag", style)[1]
    width = max((on.canvas.text_size(line, style)[0] for line in lines), default=0)
    left, top = round(at[0]), round(at[1])
    wide, high = width + 2 * _PAD, height * len(lines) + 2 * _PAD
    if is_within((left, top), room):
        left = max(min(left, room[0] + room[2] - wide), room[0])
        top = max(min(top, room[1] + room[3] - high), room[1])
    rect = (left, top, wide, high)
    body = world.component(one.entity, Note).place_body if one.entity else None
    if body is not None and world.has(body, Transform):
        middle = np.array(on.camera.to_screen(world.component(body, Transform).position))
        corner = np.array(rect[:2], np.float64)
        nearest = np.clip(middle, corner, corner + np.array(rect[2:]))
        if (np.abs(middle) < _FAR).all():
            on.canvas.lines(middle[None], nearest[None], on.theme.faint, 1.0, 0.8)
    on.canvas.panel(
        rect, on.theme.panel, on.theme.accent if chosen else on.theme.outline, on.theme.panel_opacity
    )
    for n, line in enumerate(lines):
        on.canvas.text(line, (left + _PAD, top + _PAD + n * height), style)
    return rect


def _room_of(pixels: Mapping[str, _Pixels], screen: tuple[int, int]) -> list[Rect]:
    """Return small boxes along the lines of an instrument, within the picture [px]."""
    points = list(pixels.values())
    boxes: list[Rect] = []
    for other in points[1:]:
        low, high = np.minimum(points[0], other), np.maximum(points[0], other)
        if (high - low).min() < _CLEAR:  # upright or level: one box will do
            left, top = np.clip(low, 0, screen) - 0.5 * _CLEAR
            width, height = np.clip(high, 0, screen) - np.clip(low, 0, screen) + _CLEAR
            boxes.append((round(left), round(top), round(width), round(height)))
            continue
        count = min(max(math.ceil(float(np.hypot(*(other - points[0]))) / _CLEAR), 1), _MAX_TICKS)
        places = points[0] + np.linspace(0.0, 1.0, count + 1)[:, None] * (other - points[0])
        inside = ((places > -_CLEAR) & (places < np.array(screen) + _CLEAR)).all(axis=1)
        boxes += [
            (round(x) - _CLEAR // 2, round(y) - _CLEAR // 2, _CLEAR, _CLEAR)
            for x, y in places[inside].tolist()
        ]
    return boxes


def _bodies_of(world: World, one: Instrument, camera: Camera) -> Iterator[Rect]:
    """Yield the boxes around the bodies that an instrument's points go with [px]."""
    part = world.component(one.entity, one.kind) if one.entity else None
    for name in one.points if part is not None else ():
        body = getattr(part, f"{name}_body")
        if body is None or not (world.has(body, Transform) and world.has(body, Shape)):
            continue
        shape = world.component(body, Shape)
        reach = camera.scale * (shape.radius or 0.5 * math.hypot(shape.width, shape.height))
        x, y = camera.to_screen(world.component(body, Transform).position)
        if max(abs(x), abs(y), reach) < _FAR:
            yield round(x - reach), round(y - reach), round(2 * reach), round(2 * reach)


def _last_crossings(world: World) -> dict[int, float]:
    """Return when each gate was crossed last [s]."""
    system = world.schedule.find(GateSystem)
    return {one.gate: one.time for one in system.crossings} if system is not None else {}
