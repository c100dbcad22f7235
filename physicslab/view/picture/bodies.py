"""Bodies as they appear on the screen: where, how large, in what colours."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Mass, Medium, Shape, Transform, Velocity
from physicslab.components.shape import BOX, CHAIN, CIRCLE
from physicslab.contacts.outlines import Outlines, outlines_of
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Look, Rounded
from physicslab.view.canvas.theme import Theme, mixed
from physicslab.world import World

type Rows = NDArray[np.int64]
"""Row numbers (n,)."""

POINT_RADIUS = 5.0
"""How large a body without a Shape appears [px]."""
_CHAIN, _SHADE = 2.5, 4.0
"""Width of a chain, and half of that of the shade on its solid side [px]."""
_FAINT = 0.5
"""Share of its colour in the rim of a medium: bodies within it are to stand out."""
_MIN_HALF = 0.9
"""Half extent of a body on the screen [px] below which it is drawn larger: it is still seen from far away."""


@dataclass(frozen=True, slots=True)
class BodyRows:
    """Rows of bodies by how they are drawn; in each, static ones first, else in the order of their entities.

    Attributes
    ----------
    chains, boxes, rounded, discs, points : int64 arrays
        Drawn in this order, so that points lie on top; ``rounded`` are all other polygons.
    """

    chains: Rows
    boxes: Rows
    rounded: Rows
    discs: Rows
    points: Rows

    @property
    def all(self) -> Rows:
        """All of them, in this order (n,)."""
        return np.concatenate((self.chains, self.boxes, self.rounded, self.discs, self.points))


def body_rows(world: World) -> BodyRows:
    """Return the bodies of a world: what has a Transform, and a Shape, a Velocity or a Mass."""
    rows = world.batch(Transform).rows
    moves = world.table(Velocity).present[rows]
    rows = np.concatenate((rows[~moves], rows[moves]))
    kind = world.table(Shape)["kind"][rows]
    is_body = world.table(Velocity).present[rows] | world.table(Mass).present[rows]
    chains, boxes, discs = kind == CHAIN, kind == BOX, kind == CIRCLE
    others = (kind != 0) & ~chains & ~boxes & ~discs
    return BodyRows(rows[chains], rows[boxes], rows[others], rows[discs], rows[(kind == 0) & is_body])


@lru_cache(maxsize=8)
def _palette(theme: Theme) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Return rims and fills: of static, kinematic and held bodies, of media, then of all others in turn."""
    fluid = mixed(theme.background, theme.bodies[0], _FAINT)
    rims = (theme.static, theme.kinematic, theme.held, fluid, *theme.bodies)
    return np.array(rims, np.uint8), np.array([theme.fill(rim) for rim in rims], np.uint8)


_STATIC, _KINEMATIC, _HELD, _FLUID, _OWN = range(5)


def own_colour(world: World, theme: Theme, rows: Rows) -> Rows:
    """Return which of ``theme.bodies`` (n,) the bodies of ``rows`` (n,) have."""
    return world.entity_index.entities[rows] % len(theme.bodies)


def _look(world: World, theme: Theme, rows: Rows) -> Look:
    rims, fills = _palette(theme)
    moves, held = world.table(Velocity).present[rows], world.table(Held).present[rows]
    own = _OWN + own_colour(world, theme, rows)
    fluid = world.table(Medium).present[rows]
    still = np.where(fluid, _FLUID, _STATIC)
    fill = np.where(moves, np.where(world.table(Mass).present[rows], own, _KINEMATIC), still)
    return Look(fills[fill], rims[np.where(held, _HELD, fill)], ~moves & ~fluid)


def _marker_look(world: World, theme: Theme, rows: Rows) -> Look:
    """Return the look of points: one colour in and around, also of a fixed one: it is no wall."""
    rims, _ = _palette(theme)
    own = _OWN + own_colour(world, theme, rows)
    colour = rims[np.where(world.table(Held).present[rows], _HELD, own)]
    return Look(colour, colour, np.zeros(len(rows), np.bool_))


def _on_screen(
    centre: NDArray[np.float64], reach: NDArray[np.float64], size: tuple[int, int]
) -> NDArray[np.bool_]:
    """Whether each body can be seen; what is not finite cannot."""
    # A column at a time: numpy is slow where the last axis is as short as two.
    across, down = centre[:, 0], centre[:, 1]
    with np.errstate(invalid="ignore"):
        inside: NDArray[np.bool_] = (across > -reach) & (across < size[0] + reach)
        inside &= (down > -reach) & (down < size[1] + reach)
    return inside


def draw_bodies(world: World, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw every body that is on the screen, media behind all others."""
    rows, fluid = body_rows(world), world.table(Medium).present
    for row in rows.chains.tolist():
        _draw_chain(world, row, camera, theme, canvas)
    for layer in (True, False) if len(world.batch(Medium)) else (False,):
        boxes, rounded, discs = (
            part[fluid[part] == layer] for part in (rows.boxes, rows.rounded, rows.discs)
        )
        _draw_boxes(world, boxes, camera, theme, canvas)
        _draw_rounded(world, rounded, camera, theme, canvas)
        _draw_discs(world, discs, camera, theme, canvas)
    centre = camera.project(world.table(Transform)["position"][rows.points])
    radius = np.full(len(centre), POINT_RADIUS)
    seen = _on_screen(centre, radius, camera.size)
    if seen.any():
        look = _marker_look(world, theme, rows.points[seen])
        canvas.discs(centre[seen], radius[seen], np.zeros(len(look.rim)), look)


def _draw_boxes(world: World, rows: Rows, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    transform, shape = world.table(Transform), world.table(Shape)
    extent = np.stack((shape["width"][rows], shape["height"][rows]), axis=1) * camera.scale
    extent = np.maximum(extent, 2.0 * _MIN_HALF)
    centre, angle = camera.project(transform["position"][rows]), transform["angle"][rows]
    seen = _on_screen(centre, 0.5 * np.hypot(extent[:, 0], extent[:, 1]), camera.size) & np.isfinite(angle)
    if seen.any():
        canvas.boxes(centre[seen], extent[seen], angle[seen], _look(world, theme, rows[seen]))


def _draw_chain(world: World, row: int, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw the segments of a chain, with a shade on the side that is solid."""
    outline = outlines_of(world, np.array([row]))
    corners = camera.project(outline.place + outline.corners[0, : outline.vertices[0] // 2 + 1])
    start, end = corners[:-1], corners[1:]
    along = (end - start) / np.maximum(np.hypot(*(end - start).T), 1e-9)[:, None]
    aside = _SHADE * np.stack((along[:, 1], -along[:, 0]), axis=1)  # to the left, where y points down
    canvas.lines(start + aside, end + aside, theme.static, 2.0 * _SHADE, 0.3)
    canvas.lines(start, end, theme.static, _CHAIN)


def _draw_rounded(world: World, rows: Rows, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    outlines = outlines_of(world, rows)
    centre = camera.project(outlines.place)
    reach = camera.scale * (np.hypot(*outlines.corners.transpose(2, 0, 1)).max(axis=1) + outlines.radius)
    seen = _on_screen(centre, reach, camera.size) & np.isfinite(outlines.corners).all(axis=(1, 2))
    if seen.any():
        canvas.rounded(on_canvas(outlines, seen, camera), _look(world, theme, rows[seen]))


def on_canvas(outlines: Outlines, seen: NDArray[np.bool_], camera: Camera) -> Rounded:
    """Return those of the outlines that are ``seen`` (n,), in pixels."""
    corners = camera.project(outlines.place[seen])[:, None, :]
    corners = corners + outlines.corners[seen] * (camera.scale, -camera.scale)
    radius = np.maximum(outlines.radius[seen] * camera.scale, _MIN_HALF)
    return Rounded(corners, outlines.vertices[seen], radius)


def _draw_discs(world: World, rows: Rows, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    transform = world.table(Transform)
    radius = np.maximum(world.table(Shape)["radius"][rows] * camera.scale, _MIN_HALF)
    centre, angle = camera.project(transform["position"][rows]), transform["angle"][rows]
    seen = _on_screen(centre, radius, camera.size) & np.isfinite(angle)
    if seen.any():
        canvas.discs(centre[seen], radius[seen], angle[seen], _look(world, theme, rows[seen]))
