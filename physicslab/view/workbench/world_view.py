"""The world as the camera sees it, with the overlays that are on."""

from typing import Any

from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.view.canvas.canvas import is_within
from physicslab.view.controls.measuring import spot_of
from physicslab.view.controls.picking import body_at
from physicslab.view.controls.tools import TOOLS
from physicslab.view.overlay.banners import text_size
from physicslab.view.overlay.free_body import draw_free_body
from physicslab.view.overlay.impulses import draw_impulses
from physicslab.view.overlay.instruments import draw_instruments, instruments_of
from physicslab.view.overlay.marks import (
    draw_band,
    draw_cursor,
    draw_ghost,
    draw_handles,
    draw_reading,
    draw_selection,
    draw_snap_marks,
)
from physicslab.view.overlay.vectors import draw_vectors
from physicslab.view.picture.picture import draw_world
from physicslab.view.window.placing import refused_place
from physicslab.view.window.window import Window
from physicslab.world import World


class WorldView:
    """Draws a world as the camera of a window sees it: what a :class:`RenderSystem` is given.

    Parameters
    ----------
    window : Window
        The camera, the theme and the canvas.
    """

    def __init__(self, window: Window) -> None:
        self._window = window

    def draw(self, world: World, impacts: NDArray[Any]) -> None:
        """Draw the world and the overlays; ``impacts`` are those since the last picture, of IMPACT (n,)."""
        window = self._window
        camera, theme, canvas, overlays = window.camera, window.theme, window.canvas, window.overlays
        window.sparks.advance(impacts, world.time, camera.scale)
        window.microscope.note(impacts, world.time)
        if overlays.impulses:
            overlays.impacts.note(world, impacts, overlays.reach)
        draw_world(world, camera, theme, canvas, grid=window.grid)
        window.sparks.draw(camera, theme, canvas)
        if overlays.arrows:
            draw_vectors(world, overlays, camera, theme, canvas)
        if overlays.impulses:
            self._draw_impulses(world)
        draw_selection(world, window.selection.entities, camera, theme, canvas)
        self._draw_forces(world)
        if window.band is not None:
            draw_band(camera.to_screen(window.band), window.pointer, theme, canvas)
        self._draw_instruments(world)
        if not window.filming.running:  # a film has no cursor
            self._draw_handles(world)
            self._draw_ghost(world)
            self._draw_snapping()
            if window.points_by_key:
                draw_cursor(window.pointer, theme.accent, canvas)
        window.spring_tool.draw(world, camera, window.pointer, theme, canvas)

    def _draw_snapping(self) -> None:
        """Draw where what is dragged snaps, and the length of a spring whose pin is dragged."""
        window, canvas, theme = self._window, self._window.canvas, self._window.theme
        if window.pins.words:
            size = text_size(canvas, window.text_scale)
            draw_reading(window.pins.words, window.pointer, size, theme, canvas)
        snapping = window.snapping
        if snapping.place is not None:
            marks = [(mark.axis, mark.at) for mark in snapping.marks]
            draw_snap_marks(marks, snapping.place, window.camera, theme, canvas)

    def _draw_forces(self, world: World) -> None:
        """Measure the forces on the selection where its panel is shown, and draw them with the arrows."""
        window, overlays = self._window, self._window.overlays
        chosen = window.selection.entities
        shown = len(chosen) == 1 and (overlays.arrows or window.figures)
        window.measured.follow(world, chosen[0] if shown else None, window.now, paused=window.pace.paused)
        if overlays.arrows and window.measured.forces:
            size = text_size(window.canvas, window.text_scale) - 1
            moved = window.measured.moved(world, chosen[0])
            draw_free_body(
                window.measured.forces, moved, world.time, overlays, window.camera, window.theme,
                window.canvas, size,
            )  # fmt: skip

    def _draw_impulses(self, world: World) -> None:
        """Draw impulses; resting contacts have numbers where they are selected or under the cursor."""
        window = self._window
        hovered = None if window.pointer_on_panel else body_at(world, window.camera, window.pointer)
        written = {*window.selection.entities, *(() if hovered is None else (hovered,))}
        size = text_size(window.canvas, window.text_scale) - 2
        draw_impulses(world, window.overlays, written, window.camera, window.theme, window.canvas, size)

    def _draw_instruments(self, world: World) -> None:
        """Draw what measures, what is being placed of it, and beside the cursor what to do next."""
        window = self._window
        camera, theme, canvas, state = window.camera, window.theme, window.canvas, window.measuring
        tool = TOOLS[window.tool]
        preview = state.preview(spot_of(world, window)) if state.spots else None
        shown = [*instruments_of(world, state.overrides), *([] if preview is None else [preview])]
        if state.writing is not None:
            shown = [one for one in shown if one.entity != state.writing.entity]
        size, chosen = text_size(canvas, window.text_scale), window.selection.entities
        covered = window.overlays.covered
        state.rects = draw_instruments(
            world, shown, chosen, state.labels, covered, camera, theme, canvas, size
        )
        if state.hovered is not None:
            draw_selection(world, (state.hovered,), camera, theme, canvas)
        idle = not (window.pointer_on_panel or window.filming.running)
        if tool.prompts and idle and state.dragged is None and state.writing is None:
            words = tool.prompts[min(len(state.spots), len(tool.prompts) - 1)]
            draw_reading(words, window.pointer, size, theme, canvas, window.room())

    def _draw_handles(self, world: World) -> None:
        """Draw the handles of the selection while paused, and the number that one has given."""
        window, entity = self._window, self._window.handled
        if entity is None or not world.has(entity, Transform):
            return
        camera, theme, canvas = window.camera, window.theme, window.canvas
        middle = camera.to_screen(world.component(entity, Transform).position)
        places = [(one.kind, camera.to_screen(one.place)) for one in window.handles.of(world, entity, camera)]
        draw_handles(middle, places, theme, canvas)
        if window.handles.words:
            size = text_size(canvas, window.text_scale)
            draw_reading(window.handles.words, window.pointer, size, theme, canvas)

    def _draw_ghost(self, world: World) -> None:
        """Show at the cursor what a click would make, in the colour of errors where there is no room."""
        window, spawn = self._window, TOOLS[self._window.tool].spawn
        held = window.hand.entity, window.handles.dragged, window.spring_tool.entity
        idle = held == (None, None, None) and not window.pointer_on_panel and window.has_pointed
        if spawn is None or not idle or not is_within(window.pointer, window.room()):
            return
        if body_at(world, window.camera, window.pointer) is not None:
            return
        ghost, theme = spawn.outlines(window), window.theme
        colour = theme.error if refused_place(world, ghost) else theme.accent
        draw_ghost(ghost.place, ghost.half, ghost.radius, ghost.angle, colour, window.camera, window.canvas)
