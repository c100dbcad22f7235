"""The world as the camera sees it, with the overlays that are on."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from numpy.typing import NDArray

from physicslab.components import Held, Transform, Velocity
from physicslab.diagnostics.joints import joint_states
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Drawing
from physicslab.view.canvas.canvas import Rect, is_within
from physicslab.view.canvas.quantities import quantity
from physicslab.view.controls import preview
from physicslab.view.controls.copies import coming
from physicslab.view.controls.measuring import spot_of
from physicslab.view.controls.picking import body_at
from physicslab.view.controls.tools import SELECT, TOOLS
from physicslab.view.overlay import marks
from physicslab.view.overlay.forces import draw_free_body, draw_vectors
from physicslab.view.overlay.impulses import draw_impulses
from physicslab.view.overlay.instruments import draw_instruments, instruments_of
from physicslab.view.overlay.labels import Label
from physicslab.view.overlay.whole import draw_wholes
from physicslab.view.picture.joints import joint_at
from physicslab.view.picture.picture import draw_world
from physicslab.view.window.changing import plain_kind
from physicslab.view.window.placing import refused_place
from physicslab.view.window.window import Window
from physicslab.world import World

_COPIES = 200
"""How many of the copies that are to be made are shown at most."""


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
        window, on = self._window, self._window.drawing
        camera, theme, canvas, overlays = on.camera, on.theme, on.canvas, window.overlays
        window.sparks.advance(impacts, world.time, camera.scale)
        window.dust.advance(world)
        window.sounds.play(world, impacts)
        if window.sounds.failure and window.sounds.on:
            window.sounds.on = False
            window.notify(f"No sound: {window.sounds.failure}", 6.0, failed=True)
        window.squash.note(impacts, world.time)
        plays = window.level == "Explore" and not (window.pace.paused or window.reduced_motion)
        window.microscope.note(impacts, world.time)
        if overlays.impulses:
            overlays.impacts.note(world, impacts, overlays.reach)
        draw_world(world, camera, theme, canvas, grid=window.grid, squash=window.squash if plays else None)
        window.dust.draw(world.time, camera, theme, canvas)
        window.sparks.draw(camera, theme, canvas)
        overlays.awaits_prediction = window.lesson is not None and window.lesson.waits
        if overlays.arrows:
            draw_vectors(world, overlays, on)
        if overlays.centres or overlays.momenta:
            draw_wholes(world, window.selection.entities, overlays, on)
        marks.draw_selection(world, window.selection.entities, on)
        taken = list(overlays.covered)  # labels keep clear of those of the kinds before
        has_impulses = overlays.impulses and not overlays.awaits_prediction
        smaller = replace(on, size=on.size - 2)
        numbers = self._draw_impulses(world, smaller) if has_impulses else []  # below the names of forces
        taken += self._draw_forces(world, taken, on)
        if has_impulses:
            taken += overlays.labels.draw(numbers, taken, smaller).values()
        if window.band is not None:
            marks.draw_band(camera.to_screen(window.band), window.pointer, on)
        self._draw_instruments(world, taken, on)
        if not window.filming.running:  # a film has no cursor
            self._draw_hand(world, on)
            self._draw_handles(world, on)
            self._draw_ghost(world, on)
            self._draw_snapping(on)
            if window.points_by_key:
                marks.draw_cursor(window.pointer, theme.accent, canvas)
            self._draw_joint(world, on)
        self._draw_sketch(world, on)
        self._draw_prompt(world, on)

    def _draw_hand(self, world: World, on: Drawing) -> None:
        """Draw a band from what is held to the hand, and the velocity of a throw before it is let go."""
        window, target = self._window, self._window.hand.target
        entity = window.hand.entity
        if target is None or entity is None or not world.has(entity, Transform):
            return
        transform = world.component(entity, Transform)
        grip = world.component(entity, Held).grip if world.has(entity, Held) else Vector2()
        place = transform.position + grip.rotated(transform.angle)
        thrown = Vector2() if window.pace.paused else window.hand.throw(window.now)
        marks.draw_grip(place, target, thrown, on)

    def _draw_snapping(self, on: Drawing) -> None:
        """Draw where what is dragged snaps, and the length of a spring whose pin is dragged."""
        window, snapping = self._window, self._window.snapping
        if window.pins.words:
            marks.draw_reading(window.pins.words, window.pointer, on)
        if snapping.place is not None:
            marks.draw_snap_marks([(mark.axis, mark.at) for mark in snapping.marks], snapping.place, on)

    def _draw_forces(self, world: World, covered: Sequence[Rect], on: Drawing) -> list[Rect]:
        """Measure the forces on the selection where its panel is shown, and draw them with the arrows."""
        window, overlays, measured = self._window, self._window.overlays, self._window.measured
        chosen = window.selection.entities
        shown = len(chosen) == 1 and (overlays.arrows or window.figures) and not overlays.awaits_prediction
        measured.follow(world, chosen[0] if shown else None, window.now, paused=window.pace.paused)
        overlays.shows_body_forces = overlays.arrows and bool(measured.forces)
        if not overlays.shows_body_forces:
            return []
        moved, smaller = measured.moved(world, chosen[0]), replace(on, size=on.size - 1)
        return draw_free_body(measured.forces, moved, world.time, overlays, covered, smaller)

    def _draw_impulses(self, world: World, on: Drawing) -> list[Label]:
        """Draw impulses; resting contacts have numbers where they are selected or under the cursor."""
        window = self._window
        hovered = None if window.pointer_on_panel else body_at(world, window.camera, window.pointer)
        written = {*window.selection.entities, *(() if hovered is None else (hovered,))}
        return draw_impulses(world, window.overlays, written, on)

    def _draw_instruments(self, world: World, covered: Sequence[Rect], on: Drawing) -> None:
        """Draw what measures, and what is being placed of it."""
        window, state = self._window, self._window.measuring
        preview = state.preview(spot_of(world, window)) if state.spots else None
        shown = [*instruments_of(world, state.overrides), *([] if preview is None else [preview])]
        if state.writing is not None:
            shown = [one for one in shown if one.entity != state.writing.entity]
        chosen = window.selection.entities
        room = window.framing.room()
        state.rects = draw_instruments(world, shown, chosen, state.labels, covered, on, room)
        if state.hovered is not None:
            marks.draw_selection(world, (state.hovered,), on)

    def _draw_prompt(self, world: World, on: Drawing) -> None:
        """Write beside the cursor what the tool in hand is to be given next, or the size of what is drawn."""
        window, state, tool = self._window, self._window.measuring, TOOLS[self._window.tool]
        idle = window.has_pointed and not (window.pointer_on_panel or window.filming.running)
        words = tool.prompts[min(len(state.spots), len(tool.prompts) - 1)] if tool.prompts else ""
        if window.sketch.name or not words:
            drawn = TOOLS[window.sketch.name or tool.name].draws
            words = "" if drawn is None else preview.reading(world, drawn, window)
        if window.hand.entity is not None and window.sketch.typed:
            words = f"{window.sketch.typed}_"
        if words and idle and state.dragged is None and state.writing is None:
            marks.draw_reading(words, window.pointer, on, window.framing.room())

    def _draw_handles(self, world: World, on: Drawing) -> None:
        """Draw the handles of the selection while paused, and the number that one has given."""
        window, entity, camera = self._window, self._window.handled, on.camera
        if entity is None or not world.has(entity, Transform):
            return
        middle = camera.to_screen(world.component(entity, Transform).position)
        rests = not world.has(entity, Velocity) or not world.component(entity, Velocity).linear
        places = [
            ("rest" if one.kind == "velocity" and rests else one.kind, camera.to_screen(one.place))
            for one in window.handles.of(world, entity, camera)
        ]
        marks.draw_handles(middle, places, on)
        if window.handles.words:
            marks.draw_reading(window.handles.words, window.pointer, on)

    def _draw_ghost(self, world: World, on: Drawing) -> None:
        """Show what a click or letting go makes, in the colour of errors where there is no room."""
        window = self._window
        if window.copying is not None:
            for _, one in coming(world, window, window.copying)[:_COPIES]:
                marks.draw_ghost(one, on.theme.error if refused_place(world, one) else on.theme.accent, on)
            return
        drawn = TOOLS[window.sketch.name or window.tool].draws
        idle = (window.hand.entity, window.handles.dragged) == (None, None) and not window.pointer_on_panel
        if drawn is None or drawn.build is None or not idle or not window.has_pointed:
            return
        if not window.sketch.grips and (
            body_at(world, on.camera, window.pointer) is not None
            or not is_within(window.pointer, window.framing.room())
            or window.pointer_beside_panel
        ):
            return
        shown = preview.ghost(world, drawn, window)
        if shown is not None:
            marks.draw_ghost(shown[0], on.theme.accent if shown[1] else on.theme.error, on)

    def _draw_joint(self, world: World, on: Drawing) -> None:
        """Write the force of the joint under the cursor, where the tool in hand draws nothing."""
        window = self._window
        idle = window.hand.entity is None and window.pins.dragged is None and not window.pointer_on_panel
        if window.tool != SELECT.name or not idle or not window.has_pointed or not world.joints.joints:
            return
        camera, at = on.camera, window.pointer
        found = joint_at(world, camera, at)
        if found is None:
            found = joint_at(world, camera, at, lines=True)
            if found is not None and body_at(world, camera, at) is not None:  # which lies before it
                return
        for joint in joint_states(world) if found is not None else ():
            if joint.entity == found:
                loads = [quantity(joint.force.magnitude, "N")] if joint.has_force else []
                loads += [quantity(joint.torque, "N m")] if joint.has_torque else []
                words = f"{plain_kind(joint.kind)}: {', '.join(loads)}"
                marks.draw_selection(world, (joint.entity,), on)
                marks.draw_reading(words, at, on, window.framing.room())

    def _draw_sketch(self, world: World, on: Drawing) -> None:
        """Draw a joint or a polygon in the making, and a line around the body that a joint holds next."""
        window, drawn = self._window, TOOLS[self._window.sketch.name or self._window.tool].draws
        window.sketch.follow(world)
        if drawn is None or window.pointer_on_panel or window.filming.running:
            return
        if drawn.join is None and not (drawn.is_open or drawn.hangs):
            return
        body = preview.hovered(world, drawn, window)
        if body is not None:
            marks.draw_selection(world, (body,), on)
        if window.sketch.grips:
            marks.draw_dashes(preview.lines(world, drawn, window), on)
