"""Marks of the selection and of tools: outlines, handles, the cursor, what would be made, snapping."""

import math
from collections.abc import Sequence

import numpy as np

from physicslab.components import Shape, Transform
from physicslab.contacts.outlines import Outlines
from physicslab.diagnostics.period import spring_state
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Drawing
from physicslab.view.canvas.canvas import Canvas, Look, Numbers, Points, Rect, TextStyle
from physicslab.view.canvas.rim import rim_of
from physicslab.view.canvas.theme import Colour
from physicslab.view.overlay.arrows import VELOCITY, draw_arrows, even_dashes
from physicslab.view.picture.bodies import POINT_RADIUS
from physicslab.view.picture.joints import joint_lines
from physicslab.world import World

_RADIUS = 5.0
"""Radius of a handle [px]."""

_SQUARE = np.array(((-1, -1), (1, -1), (1, 1), (-1, 1)), np.float64)

type Pixel = tuple[float, float]


def draw_handles(middle: Pixel, places: Sequence[tuple[str, Pixel]], on: Drawing) -> None:
    """Draw handles at their places [px], each with the line that joins it to the middle of the body."""
    for kind, place in places:
        start, span = np.array([middle]), np.array([place]) - np.array([middle])
        if kind == "velocity":
            draw_arrows(start, span, VELOCITY, on)
        elif kind == "angle":
            on.canvas.lines(start, start + span, on.theme.accent, 1.0, 0.6)
    spots = np.array([place for _, place in places])
    if len(spots):
        look = Look.plain(on.theme.background, on.theme.accent, len(spots))
        on.canvas.discs(spots, np.full(len(spots), _RADIUS), np.zeros(len(spots)), look)


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
"""Straight lines that a circle is drawn as."""
_WIDTH = 2.0
_SPRING_WIDTH = 15.0
"""Width of the band along a spring or a joint [px]."""
_FAR = 1e6
"""Lines farther out of the picture than this are not drawn [px]."""


def draw_selection(world: World, entities: Sequence[int], on: Drawing, colour: Colour | None = None) -> None:
    """Draw a line around each body, or along a spring; in a colour, or that of the selection."""
    for entity in entities:
        if world.has(entity, Transform):
            corners = on.camera.project(_outline(world, entity, _GAP / on.camera.scale))
            on.canvas.lines(corners, np.roll(corners, -1, axis=0), colour or on.theme.accent, _WIDTH)
            continue
        lines = joint_lines(world, on.camera, entity)
        if (spring := spring_state(world, entity)) is not None:
            lines = on.camera.project(np.array([tuple(spring.start), tuple(spring.end)]))[None]
        if len(lines) and (np.abs(lines) < _FAR).all():
            on.canvas.lines(lines[:, 0], lines[:, 1], colour or on.theme.accent, _SPRING_WIDTH, 0.5)


def draw_band(corner: tuple[float, float], pointer: tuple[float, float], on: Drawing) -> None:
    """Draw the rectangle that is being drawn around bodies, from its corner to the cursor [px]."""
    (x0, y0), (x1, y1) = corner, pointer
    corners = np.array(((x0, y0), (x1, y0), (x1, y1), (x0, y1)), np.float64)
    on.canvas.lines(corners, np.roll(corners, -1, axis=0), on.theme.accent, 1.0, 0.8)


def _outline(world: World, entity: int, gap: float) -> Points:
    """Return the corners of the line around a body (n, 2) [m]."""
    transform, core, radius = world.component(entity, Transform), np.zeros((1, 2)), POINT_RADIUS / 100.0
    if world.has(entity, Shape):
        shape = world.component(entity, Shape)
        core, radius = np.array([tuple(corner) for corner in shape.core]), shape.rounding
    corners = rim_of(core, radius + gap, _CORNERS)
    return _placed(corners, transform.angle, np.array((transform.position.x, transform.position.y)))


def _placed(corners: Points, angle: float, place: Numbers) -> Points:
    """Return corners (n, 2), turned by an angle [rad] and moved to a place (2,)."""
    c, s = math.cos(angle), math.sin(angle)
    placed: Points = corners @ np.array(((c, s), (-s, c))) + place
    return placed


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
    for n in range(len(ghost.place)):
        core = ghost.corners[n, : ghost.vertices[n]]
        own = rim_of(core, float(ghost.radius[n]), _GHOST_CORNERS)
        corners = on.camera.project(ghost.place[n] + own)
        on.canvas.lines(corners, np.roll(corners, -1, axis=0), colour, 1.4, _GHOST_OPACITY)


_DASH, _END, _MAX_ENDS = 9.0, 4.0, 9
"""Length of a dash, radius of the discs at the ends [px] and of how many lines, of what is being drawn."""


def draw_dashes(lines: Sequence[tuple[Vector2, Vector2]], on: Drawing) -> None:
    """Draw dashed lines between points of the world [m], with discs at their ends where they are few."""
    spots = on.camera.project(np.array([tuple(place) for line in lines for place in line]).reshape(-1, 2))
    if not len(spots) or not (np.abs(spots) < _FAR).all():
        return
    for start, end in zip(spots[::2], spots[1::2], strict=True):
        on.canvas.lines(*even_dashes(start, end, _DASH), on.theme.accent, 2.0)
    if len(lines) > _MAX_ENDS:  # a stroke
        return
    look = Look.plain(on.theme.accent, on.theme.accent, len(spots))
    on.canvas.discs(spots, np.full(len(spots), _END), np.zeros(len(spots)), look)


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
    look = Look.plain(on.theme.accent, on.theme.accent, 1)
    on.canvas.discs(np.array([(x, y)]), np.full(1, _DOT), np.zeros(1), look)
