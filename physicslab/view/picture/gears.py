"""Gears: toothed rims of two wheels that turn against each other, and a belt where they turn alike."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Gear, Pin, Shape, Slot, Transform
from physicslab.components.shape import CIRCLE
from physicslab.state.joint_rows import ends_of
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Points
from physicslab.view.picture.links import link_ends
from physicslab.view.picture.pen import Pen
from physicslab.world import World

_TOOTH, _PITCH = 5.5, 11.0
"""How far teeth stand out of a rim, and about how far apart they are [px]."""
_BELT, _MARK = 0.5, 26.0
"""The sum of the radii of wheels of a belt as a share of their distance; how far apart its marks are [px]."""
_FITS = 0.01
"""How near to the ratio of a gear that of the radii of two discs is for its belt to go around them."""


@dataclass(frozen=True, slots=True)
class _Wheel:
    """A coupled joint: its place [m], its angle [rad] (nan of a slot), the radius of its disc [m], or 0."""

    place: Points
    angle: float
    radius: float


@dataclass(frozen=True, slots=True)
class _Pair:
    """Both wheels of a gear: their middles (2, 2) [px], radii [px], angles [rad], and the way to the second.

    ``paths`` (n, 2) [px] are their rims, the belt around both, or the line between them.
    """

    entity: int
    middles: Points
    radii: tuple[float, float]
    angles: tuple[float, float]
    way: float
    is_belt: bool
    paths: tuple[Points, ...]


def draw_gears(world: World, pen: Pen) -> None:
    """Add the rims of each gear, its belt where both turn alike, and a dashed line where one slides."""
    for pair in _pairs(world, pen.camera):
        if math.isnan(sum(pair.angles)):
            pen.lines(pair.middles[:1], pair.middles[1:], pen.dark(pen.theme.rod), 2.0)
        elif pair.is_belt:
            _draw_belt(pen, pair)
        else:
            _draw_teeth(pen, pair)


def gear_paths(world: World, camera: Camera) -> dict[int, tuple[Points, ...]]:
    """Return the lines (n, 2) [px] along which each gear is drawn, by its entity."""
    return {pair.entity: pair.paths for pair in _pairs(world, camera)}


def _pairs(world: World, camera: Camera) -> Iterator[_Pair]:
    """Yield the wheels of each gear that is in the picture."""
    batch, table = world.batch(Gear), world.table(Gear)
    known = _wheels(world) if len(batch) else {}
    for entity, row in zip(batch.entities.tolist(), batch.rows.tolist(), strict=True):
        ends = [int(table[name][row]) for name in ("first", "second")]
        if not all(end in known for end in ends):
            continue
        one, other = (known[end] for end in ends)
        middles = camera.project(np.stack((one.place, other.place)))
        if not np.isfinite(middles).all():
            continue
        x, y = (other.place - one.place).tolist()
        gap, way, ratio = math.hypot(x, y) * camera.scale, math.atan2(y, x), float(table["ratio"][row])
        share = abs(ratio) / (1.0 + abs(ratio))
        radii = (gap * share, gap * (1.0 - share))
        paths: tuple[Points, ...] = (middles,)
        if ratio > 0.0:
            radii = _of_belt(one, other, ratio, camera.scale, radii)
        is_belt = ratio > 0.0 and abs(radii[0] - radii[1]) < gap
        if not math.isnan(one.angle + other.angle):
            circle = np.linspace(0.0, 2.0 * math.pi, 65)
            rims = (_arc(middles[n], radii[n], circle) for n in (0, 1))
            paths = (_belt(middles, radii, gap, way),) if is_belt else tuple(rims)
        yield _Pair(entity, middles, radii, (one.angle, other.angle), way, is_belt, paths)


def _wheels(world: World) -> dict[int, _Wheel]:
    """Return the wheels by the entities of all joints that a gear can couple."""
    found: dict[int, _Wheel] = {}
    angles, shape = world.table(Transform)["angle"], world.table(Shape)
    for kind in (Pin, Slot):
        at_a, at_b, *fixed = link_ends(world, kind)
        a, b = (np.maximum(end, 0) for end in ends_of(world.entity_index, kind))
        body = np.where(fixed[1], a, b)
        is_disc = shape.present[body] & (shape["kind"][body] == CIRCLE)
        radius = np.where(is_disc, shape["radius"][body], 0.0).tolist()
        for n, entity in enumerate(world.batch(kind).entities.tolist()):
            turns = kind is Pin
            found[entity] = _Wheel(
                at_a[n] if turns else at_b[n], float(angles[body[n]]) if turns else math.nan, radius[n]
            )
    return found


def _of_belt(
    one: _Wheel, other: _Wheel, ratio: float, scale: float, radii: tuple[float, float]
) -> tuple[float, float]:
    """Return the radii of a belt's wheels [px]: those of two discs that fit its ratio, else smaller ones."""
    if other.radius and abs(one.radius / other.radius / ratio - 1.0) < _FITS:
        return one.radius * scale, other.radius * scale
    return _BELT * radii[0], _BELT * radii[1]


def _arc(middle: Points, radius: float, turns: NDArray[np.float64]) -> Points:
    """Return the points (n, 2) [px] of a circle at angles (n,) [rad]."""
    points: Points = middle + radius * np.stack((np.cos(turns), -np.sin(turns)), axis=1)
    return points


def _belt(middles: Points, radii: tuple[float, float], gap: float, way: float) -> Points:
    """Return the closed path (n, 2) [px] around two wheels, counter-clockwise."""
    lean = math.acos((radii[0] - radii[1]) / gap)
    far = np.linspace(way + lean, way + 2.0 * math.pi - lean, 33)
    near = np.linspace(way - lean, way + lean, 33)
    path = np.concatenate((_arc(middles[0], radii[0], far), _arc(middles[1], radii[1], near)))
    return np.concatenate((path, path[:1]))


def _draw_belt(pen: Pen, pair: _Pair) -> None:
    """Add a belt with marks that go along with the first wheel."""
    (path,) = pair.paths
    for shade, width in ((pen.dark(pen.theme.rope, 0.65), 5.0), (pen.theme.rope, 3.2)):
        pen.paths(path[None], shade, width)
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))))
    count = max(round(along[-1] / (_MARK * pen.unit)), 2)
    at = (along[-1] * np.arange(count) / count + pair.radii[0] * pair.angles[0]) % along[-1]
    spots = np.stack([np.interp(at, along, path[:, n]) for n in (0, 1)], axis=1)
    pen.discs(spots, 1.3, pen.dark(pen.theme.rope, 0.9))


def _draw_teeth(pen: Pen, pair: _Pair) -> None:
    """Add toothed rims: as many teeth go by on both, and one has gaps where the other has teeth."""
    first, second = pair.radii
    count = max(round(2.0 * math.pi * first / (_PITCH * pen.unit)), 6)
    steps = [2.0 * math.pi / n for n in (count, max(round(count * second / first) if first else 0, 6))]
    toward = pair.way, pair.way + math.pi
    met = sum((pair.angles[n] - toward[n]) / steps[n] for n in (0, 1))
    shift = 0.0, steps[1] * (0.5 - met)
    for n in (0, 1):
        _draw_rim(pen, pair.middles[n], pair.radii[n], steps[n], pair.angles[n] + shift[n])


def _draw_rim(pen: Pen, centre: Points, radius: float, step: float, angle: float) -> None:
    """Add a rim with teeth in steps of an angle [rad], the first at another."""
    colour = pen.theme.rod
    turns = angle + step * np.arange(round(2.0 * math.pi / step), dtype=np.float64)
    inner, outer = radius - 0.5 * _TOOTH * pen.unit, radius + 0.4 * _TOOTH * pen.unit
    width = max(0.42 * radius * step / pen.unit, 1.0)
    rim = _arc(centre, inner - 1.5 * pen.unit, np.linspace(0.0, 2.0 * math.pi, 65))[None]
    for grown, shade in ((1.8, pen.dark(colour, 0.65)), (0.0, colour)):
        pen.lines(_arc(centre, inner, turns), _arc(centre, outer, turns), shade, width + grown)
        pen.paths(rim, shade, 3.4 + grown)
