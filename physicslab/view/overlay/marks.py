"""Marks of the selection and of tools: outlines, handles, the cursor, what would be made, snapping."""

import math
from collections.abc import Sequence

import numpy as np

from physicslab.components import Shape, Transform
from physicslab.components.shape import CHAIN, CIRCLE
from physicslab.contacts.outlines import Outlines
from physicslab.diagnostics.period import spring_state
from physicslab.ecs.vector import Vector2, rotated
from physicslab.theme import Colour
from physicslab.view.canvas.camera import Drawing
from physicslab.view.canvas.canvas import Canvas, Numbers, Points, Rect, TextStyle, draw_spots
from physicslab.view.canvas.quantities import quantity
from physicslab.view.canvas.rim import rim_of
from physicslab.view.overlay.arrows import VELOCITY, draw_arrows, even_dashes
from physicslab.view.picture.bodies import point_radius
from physicslab.view.picture.joints import joint_lines
from physicslab.world import World

_RADIUS = 5.0
"""Radius of a handle [px]."""

type Pixel = tuple[float, float]


def draw_handles(middle: Pixel, places: Sequence[tuple[str, Pixel]], on: Drawing) -> None:
    """Draw handles at their places [px], each with the line that joins it to the middle of the body."""
    for kind, place in places:
        start, span = np.array([middle]), np.array([place]) - np.array([middle])
        if kind == "velocity":
            draw_arrows(start, span, VELOCITY, on)
        elif kind in ("angle", "rest"):  # no arrow: it does not move
            on.canvas.lines(start, start + span, on.theme.accent, 1.0, 0.6)
    spots = np.array([place for _, place in places])
    if len(spots):
        draw_spots(on.canvas, spots, _RADIUS, on.theme.background, on.theme.accent)


def draw_reading(words: str, pointer: Pixel, on: Drawing, room: Rect | None = None) -> None:
    """Write words beside the cursor, within the room that is given or the picture [px]."""
    low, top_edge, across, _ = room or (0, 0, *on.canvas.size)
    style = TextStyle(on.size, on.theme.text, bold=True)
    width, height = on.canvas.text_size(words, style)
    left = max(min(round(pointer[0]) + on.size, low + across - width - on.size), low + on.size)
    top = max(round(pointer[1]) - 2 * on.size, top_edge + on.size)
    rect: Rect = (left - on.size // 2, top - on.size // 4, width + on.size, height + on.size // 2)
    on.canvas.panel(rect, on.theme.panel, on.theme.outline, 0.95)
    on.canvas.text(words, (left, top), style)


_GAP = 4.0
"""Between a body and the line around it [px]."""
_CORNERS = 48
"""Straight lines that a circle is drawn as; half of them where there are many circles."""
_MANY = 64
_WIDTH = 2.0
_SPRING_WIDTH, _RIM_WIDTH = 15.0, 3.0
"""Width of the band along a spring or a joint [px]."""
_FAR = 1e6
"""Lines farther out of the picture than this are not drawn [px]."""


def draw_selection(world: World, entities: Sequence[int], on: Drawing, colour: Colour | None = None) -> None:
    """Draw a line around each body, or along a spring; in a colour, or that of the selection."""
    if not entities:
        return
    chosen = np.array(entities, np.int64)
    rows = world.entity_index.rows_of(chosen)
    placed = (rows > 0) & world.table(Transform).present[rows]
    bodies, rows = chosen[placed].tolist(), rows[placed]
    shape, gap = world.table(Shape), _GAP / on.camera.scale
    is_disc = shape.present[rows] & (shape["kind"][rows] == CIRCLE)
    discs = rows[is_disc]
    corners = _CORNERS if len(discs) <= _MANY else _CORNERS // 2
    rims = _rings(world.table(Transform)["position"][discs], shape["radius"][discs] + gap, corners)
    rims += [_outline(world, bodies[n], on.camera.scale) for n in np.flatnonzero(~is_disc)]
    _draw_rims(rims, colour or on.theme.accent, _WIDTH, 1.0, on)
    for entity in chosen[~placed].tolist():
        lines = joint_lines(world, on.camera, entity)
        if (spring := spring_state(world, entity)) is not None:
            lines = on.camera.project(np.array([tuple(spring.start), tuple(spring.end)]))[None]
        if len(lines) and (np.abs(lines) < _FAR).all():
            width, alpha = (_SPRING_WIDTH, 0.5) if len(lines) == 1 else (_RIM_WIDTH, 1.0)  # rims overlap
            on.canvas.lines(lines[:, 0], lines[:, 1], colour or on.theme.accent, width, alpha)


_HAND, _LEAST_BAND = 9.0, 4.0
"""Radius of the ring of the hand, and the least length of a band [px]."""
_THROW, _LEAST_THROW = 0.2, 0.2
"""The arrow of a throw is the way of so long a time [s]; speed from which there is one [m/s]."""


def draw_grip(place: Vector2, target: Vector2, thrown: Vector2, on: Drawing) -> None:
    """Draw a ring where the hand is [m], a band to what it holds, and how fast it would throw that [m/s]."""
    start, end = (on.camera.project(np.array([tuple(spot)])) for spot in (place, target))
    if not (np.abs(np.concatenate((start, end))) < _FAR).all():
        return
    (ring,) = _rings(end, np.array([_HAND]), _CORNERS // 2)
    on.canvas.lines(ring, np.roll(ring, -1, axis=0), on.theme.accent, 1.5, 0.8)
    if float(np.hypot(*(end - start)[0])) > _LEAST_BAND:
        on.canvas.lines(start, end, on.theme.accent, 2.5, 0.55)
    if thrown.magnitude >= _LEAST_THROW:
        span = on.camera.scale * _THROW * np.array([(thrown.x, -thrown.y)])
        draw_arrows(start, span, VELOCITY, on)
        x, y = (start + span)[0].tolist()
        style = TextStyle(on.size, on.theme.velocity, bold=True)
        on.canvas.text(quantity(thrown.magnitude, "m/s"), (round(x) + 8, round(y) - on.size), style)


def draw_band(corner: tuple[float, float], pointer: tuple[float, float], on: Drawing) -> None:
    """Draw the rectangle that is being drawn around bodies, from its corner to the cursor [px]."""
    (x0, y0), (x1, y1) = corner, pointer
    corners = np.array(((x0, y0), (x1, y0), (x1, y1), (x0, y1)), np.float64)
    on.canvas.lines(corners, np.roll(corners, -1, axis=0), on.theme.accent, 1.0, 0.8)


def _outline(world: World, entity: int, scale: float) -> Points:
    """Return the corners of the line around a body (n, 2) [m], at a scale [px/m]."""
    transform, core, is_chain = world.component(entity, Transform), np.zeros((1, 2)), False
    radius = point_radius(world, entity) / scale
    if world.has(entity, Shape):
        shape = world.component(entity, Shape)
        core, radius = np.array([tuple(corner) for corner in shape.core]), shape.rounding
        is_chain = world.table(Shape)["kind"][world.entity_index.rows_of(np.array([entity]))[0]] == CHAIN
    corners = core if is_chain else rim_of(core, radius + _GAP / scale, _CORNERS)
    return rotated(corners, transform.angle) + tuple(transform.position)


_GHOST_CORNERS = 40
"""Straight lines that a circle is drawn as."""
_GHOST_OPACITY = 0.65
_ARM = 9.0
"""Length of the arms of the cross that shows the cursor [px]."""


def draw_cursor(pixel: tuple[float, float], colour: Colour, canvas: Canvas) -> None:
    """Draw a cross where the cursor is that keys move."""
    arms = np.array(((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)))
    canvas.lines(pixel + 0.3 * _ARM * arms, pixel + _ARM * arms, colour, 1.6)


def draw_ghost(ghost: Outlines, colour: Colour, on: Drawing) -> None:
    """Draw outlines of bodies that are not there yet."""
    is_disc = ghost.vertices == 1
    rims = [
        ghost.place[n] + rim_of(ghost.corners[n, : ghost.vertices[n]], float(ghost.radius[n]), _GHOST_CORNERS)
        for n in np.flatnonzero(~is_disc)
    ]
    rims += _rings(ghost.place[is_disc], ghost.radius[is_disc], _GHOST_CORNERS)
    _draw_rims(rims, colour, 1.4, _GHOST_OPACITY, on)


def _rings(places: Points, radii: Numbers, corners: int) -> list[Points]:
    """Return circles as so many corners each."""
    turns = np.linspace(0.0, 2.0 * math.pi, corners, endpoint=False)
    ring = np.stack((np.cos(turns), np.sin(turns)), axis=1)
    return list(places[:, None] + radii[:, None, None] * ring)


def _draw_rims(rims: Sequence[Points], colour: Colour, width: float, opacity: float, on: Drawing) -> None:
    """Draw closed lines through corners [m], all at once: of hundreds each by itself costs milliseconds."""
    if not rims:
        return
    first = np.concatenate(rims)
    after = np.concatenate([np.concatenate((rim[1:], rim[:1])) for rim in rims])
    on.canvas.lines(on.camera.project(first), on.camera.project(after), colour, width, opacity)


_DASH, _END, _MAX_ENDS = 9.0, 4.0, 9
"""Length of a dash, radius of the discs at the ends [px] and of how many lines, of what is being drawn."""


def draw_dashes(lines: Sequence[tuple[Vector2, Vector2]], on: Drawing) -> None:
    """Draw dashed lines between points of the world [m], with discs at their ends where they are few."""
    spots = on.camera.project(np.array([tuple(place) for line in lines for place in line]).reshape(-1, 2))
    if not len(spots) or not (np.abs(spots) < _FAR).all():
        return
    for start, end in zip(spots[::2], spots[1::2], strict=True):
        on.canvas.lines(*even_dashes(start, end, _DASH), on.theme.accent, 2.0)
    if len(lines) <= _MAX_ENDS:  # no stroke
        draw_spots(on.canvas, spots, _END, on.theme.accent, on.theme.accent)


_SNAP_OPACITY = 0.75
_DOT = 3.5
"""Radius of the disc at the middle of what has snapped [px]."""


def draw_snap_marks(marks: Sequence[tuple[int, float]], middle: Vector2, on: Drawing) -> None:
    """Draw a line across the picture for each mark, and a disc at the middle of what has snapped [m].

    A mark is an axis (0 for x, 1 for y) and the coordinate along it [m].
    """
    width, height = on.camera.size
    x, y = on.camera.to_screen(middle)
    for axis, at in marks:
        across, down = on.camera.to_screen(Vector2(at, at))
        start, end = ((across, 0), (across, height)) if axis == 0 else ((0, down), (width, down))
        on.canvas.lines(
            np.array([start], np.float64), np.array([end], np.float64), on.theme.accent, 1.0, _SNAP_OPACITY
        )
    draw_spots(on.canvas, np.array([(x, y)]), _DOT, on.theme.accent, on.theme.accent)
