"""Bodies as they appear on the screen: where, how large, in what colours."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Colour, Held, MadeOf, Mass, Medium, Shape, Transform, Velocity
from physicslab.components.colour import rgb_of
from physicslab.components.made_of import look_of
from physicslab.components.shape import BOX, CHAIN, CIRCLE
from physicslab.contacts.outlines import Outlines, outlines_of
from physicslab.ecs.text import text_of
from physicslab.ecs.vector import rotated
from physicslab.state.shapes import line_of
from physicslab.theme import GLOW, GLOWS, LEAST_PLANET, MAX_SHADOWS, PLANET, POINT_RADIUS, STAR, Theme
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Finish, Look, Rounded
from physicslab.view.picture.squash import Squash
from physicslab.world import World

type Rows = NDArray[np.int64]
"""Row numbers (n,)."""

_CHAIN, _SHADE = 2.5, 4.0
"""Width of a chain, and half of that of the shade on its solid side [px]."""
_FINISHES = {
    "grain": Finish.WOOD, "metal": Finish.STEEL, "frost": Finish.ICE, "matt": Finish.RUBBER,
    "clear": Finish.GLASS, "speckle": Finish.STONE,
}  # fmt: skip
"""How materials look that are not plain."""
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
    rims = (theme.kinematic, theme.held, theme.fluid, *theme.bodies)
    fills = [theme.earth, *(theme.within_fluid if rim == theme.fluid else theme.fill(rim) for rim in rims)]
    return np.array((theme.static, *rims), np.uint8), np.array(fills, np.uint8)


@lru_cache(maxsize=256)
def _edge(theme: Theme, red: int, green: int, blue: int) -> tuple[int, int, int]:
    return theme.edge((red, green, blue))


_STATIC, _KINEMATIC, _HELD, _FLUID, _OWN = range(5)


def own_colours(world: World, theme: Theme, rows: Rows) -> NDArray[np.uint8]:
    """Return the colours (n, 3) of the bodies of ``rows`` (n,): that of a Colour, or one in turn."""
    rims, _ = _palette(theme)
    found = rims[_OWN + world.entity_index.entities[rows] % len(theme.bodies)]
    if len(world.batch(Colour)):
        chosen = world.table(Colour)["colour"][rows]
        for code in np.unique(chosen[chosen > 0]).tolist():
            found[chosen == code] = rgb_of(text_of(code))
    return found


def named_colour(world: World, theme: Theme, entity: int) -> tuple[int, int, int]:
    """Return the colour of what is written of a body: its own, or by its number as when it is gone."""
    row = world.entity_index.row_of.get(entity)
    own = row is not None and world.table(Colour).present[row]
    return body_colour(world, theme, entity) if own else theme.body(entity)


def body_colour(world: World, theme: Theme, entity: int) -> tuple[int, int, int]:
    """Return the colour in which a body is drawn that nothing holds."""
    row = np.array([world.entity_index.row_of[entity]])
    own = world.table(Colour).present[row[0]]
    shown = own_colours(world, theme, row) if own else _look(world, theme, row, held=False).rim
    red, green, blue = shown[0].tolist()
    return red, green, blue


def _look(world: World, theme: Theme, rows: Rows, *, held: bool = True) -> Look:
    rims, fills = _palette(theme)
    moves, grasped = world.table(Velocity).present[rows], world.table(Held).present[rows]
    fluid, coloured = world.table(Medium).present[rows], world.table(Colour).present[rows]
    kind = np.where(moves, _KINEMATIC, np.where(fluid, _FLUID, _STATIC))
    fill, rim = fills[kind], rims[kind]
    own = moves & world.table(Mass).present[rows] & ~coloured
    rim[own] = own_colours(world, theme, rows[own])
    fill[own] = theme.faded(rim[own], theme.fill_share)
    if coloured.any():
        fill[coloured] = own_colours(world, theme, rows[coloured])
        shades, which = np.unique(fill[coloured], axis=0, return_inverse=True)
        edges = [_edge(theme, red, green, blue) for red, green, blue in shades.tolist()]
        rim[coloured] = np.array(edges, np.uint8)[which]
    if held:
        rim[grasped] = rims[_HELD]
    finish = np.where(fluid, Finish.FLAT, np.where(moves, Finish.LIT, Finish.GROUND))
    made = world.table(MadeOf)["material"][rows] if len(world.batch(MadeOf)) else rows[:0]
    for code in np.unique(made[made > 0]).tolist():
        if (look := look_of(text_of(code))) in _FINISHES:
            finish[made == code] = _FINISHES[look]
    shadow = theme.shadow if len(rows) <= MAX_SHADOWS and not fluid.any() else 0.0
    return Look(fill, rim, finish, shadow)


def _marker_look(world: World, theme: Theme, rows: Rows) -> Look:
    """Return the look of points: one colour in and around, also of a fixed one: it is no wall."""
    rims, _ = _palette(theme)
    colour = own_colours(world, theme, rows)
    colour[world.table(Held).present[rows]] = rims[_HELD]
    return Look(colour, colour.copy(), np.zeros(len(rows), np.int64))


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


def draw_bodies(
    world: World, camera: Camera, theme: Theme, canvas: Canvas, squash: Squash | None = None
) -> None:
    """Draw every body that is on the screen, media behind all others."""
    squash = squash or Squash()
    rows, fluid = body_rows(world), world.table(Medium).present
    for row in rows.chains.tolist():
        _draw_chain(world, row, camera, theme, canvas)
    for layer in (True, False) if len(world.batch(Medium)) else (False,):
        boxes, rounded, discs = (
            part[fluid[part] == layer] for part in (rows.boxes, rows.rounded, rows.discs)
        )
        if len(boxes):
            _draw_boxes(world, boxes, camera, theme, canvas, squash)
        if len(rounded):
            _draw_rounded(world, rounded, camera, theme, canvas)
        if len(discs):
            _draw_discs(world, discs, camera, theme, canvas, squash)
    _draw_points(world, rows.points, camera, theme, canvas)


def point_radii(world: World, rows: Rows) -> NDArray[np.float64]:
    """Return how large bodies without a Shape are drawn (n,) [px]; planets by the cube root of mass."""
    radius = np.full(len(rows), POINT_RADIUS)
    if world.physics.gravity_mode == "planet" and len(rows):
        size = np.cbrt(np.maximum(world.table(Mass)["mass"][rows], 0.0))
        largest = size.max()
        if largest > 0.0:
            radius = np.maximum(PLANET * size / largest, LEAST_PLANET)
    return radius


def point_radius(world: World, entity: int) -> float:
    """Return how large a body without a Shape is drawn [px]."""
    points = body_rows(world).points
    found = point_radii(world, points)[world.entity_index.entities[points] == entity]
    return float(found[0]) if len(found) else POINT_RADIUS


def _draw_points(world: World, rows: Rows, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw bodies without a Shape; among planets one that outweighs all others shines."""
    if not len(rows):
        return
    centre, radius = camera.project(world.table(Transform)["position"][rows]), point_radii(world, rows)
    seen = _on_screen(centre, GLOW * radius, camera.size)
    if not seen.any():
        return
    look = _marker_look(world, theme, rows[seen])
    mass = np.where(world.table(Mass).present[rows], world.table(Mass)["mass"][rows], 0.0)
    if world.physics.gravity_mode == "planet":
        star = int(np.argmax(mass))
        look.finish[:] = Finish.POINT
        if mass[star] > STAR * (mass.sum() - mass[star]) and seen[star]:
            at = int(np.count_nonzero(seen[:star]))
            look.finish[at], look.fill[at], look.rim[at] = Finish.FLAT, theme.spark, theme.spark
            if theme.is_dark:
                reach = GLOW * radius[[star]]
                for share, strength in GLOWS:
                    canvas.glows(centre[[star]], share * reach, theme.spark, np.array([strength]))
    canvas.discs(centre[seen], radius[seen], np.zeros(len(look.rim)), look)


def _draw_boxes(
    world: World, rows: Rows, camera: Camera, theme: Theme, canvas: Canvas, squash: Squash
) -> None:
    transform, shape = world.table(Transform), world.table(Shape)
    place, size = squash.of(world, rows, transform["position"][rows])
    extent = np.stack((size * shape["width"][rows], size * shape["height"][rows]), axis=1) * camera.scale
    extent = np.maximum(extent, 2.0 * _MIN_HALF)
    centre, angle = camera.project(place), transform["angle"][rows]
    seen = _on_screen(centre, 0.5 * np.hypot(extent[:, 0], extent[:, 1]), camera.size) & np.isfinite(angle)
    if seen.any():
        canvas.boxes(centre[seen], extent[seen], angle[seen], _look(world, theme, rows[seen]))


def _draw_chain(world: World, row: int, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw the line of a chain, arcs where it is round, with a shade on the side that is solid."""
    transform, line = world.table(Transform), line_of(int(world.table(Shape)["vertices"][row]))
    corners = camera.project(transform["position"][row] + rotated(line, transform["angle"][row]))
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


def _draw_discs(
    world: World, rows: Rows, camera: Camera, theme: Theme, canvas: Canvas, squash: Squash
) -> None:
    transform = world.table(Transform)
    place, size = squash.of(world, rows, transform["position"][rows])
    radius = np.maximum(size * world.table(Shape)["radius"][rows] * camera.scale, _MIN_HALF)
    centre, angle = camera.project(place), transform["angle"][rows]
    seen = _on_screen(centre, radius, camera.size) & np.isfinite(angle)
    if seen.any():
        canvas.discs(centre[seen], radius[seen], angle[seen], _look(world, theme, rows[seen]))
