"""SDL's events, turned into what they do to the world and to the window."""

import contextlib
from collections.abc import Callable, Sequence
from pathlib import Path

import pygame

from physicslab.components import Held, Shape, Transform
from physicslab.contacts.outlines import Outlines
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.keyboard import held_keys, usual_event
from physicslab.view.controls import actions, drawing
from physicslab.view.controls.choosing_keys import choose_key, usual
from physicslab.view.controls.context import open_context, thing_at
from physicslab.view.controls.controls import KEYS, RELEASES, reaches_world
from physicslab.view.controls.drawn import is_dragged
from physicslab.view.controls.file_actions import open_file
from physicslab.view.controls.impact_actions import clicked_impact, close_up
from physicslab.view.controls.keyboard import open_menu
from physicslab.view.controls.measuring import follow_pointer, let_instrument_go, take_end
from physicslab.view.controls.picking import body_at
from physicslab.view.controls.pouring import pour
from physicslab.view.controls.preview import about
from physicslab.view.controls.spawning import BOX
from physicslab.view.controls.tool import Tool
from physicslab.view.controls.tools import TOOLS
from physicslab.view.window.changing import set_end
from physicslab.view.window.placing import outline_of
from physicslab.view.window.window import Action, Window
from physicslab.world import World

_BY_PRINT = ("+", "-", ".", ",", "[", "]")
"""Keys that go by what they print: on other keyboards they are elsewhere, or need AltGr."""
_PRESSES = (pygame.KEYDOWN, pygame.MOUSEBUTTONDOWN, pygame.MOUSEWHEEL)
_SNAPPING = pygame.KMOD_ALT | pygame.KMOD_CTRL
"""Keys with which places snap while they are held."""
_OTHER_USE = pygame.KMOD_ALT | pygame.KMOD_META
"""With these keys held, another key is meant for the desktop: Alt+Tab is no slow motion."""

_HELD = 0.4
"""How long [s] the right button is held to open a menu."""
_HELD_KEYS = (
    pygame.K_LCTRL, pygame.K_RCTRL, pygame.K_LSHIFT, pygame.K_RSHIFT, pygame.K_LALT, pygame.K_RALT,
    pygame.K_LGUI, pygame.K_RGUI,
)  # fmt: skip
_MENU = 0x40000065
"""The key beside the right Ctrl, which SDL calls "Application"."""
_COMING_BACK = 0.15
"""How long [s] after the window came to the front a press is what brought it there."""


class WindowEvents:
    """Turns SDL's events into actions, and moves the body that is held: what an InputSystem is given.

    It follows events alone and never reads the state of keys and buttons, so that posted events are as good
    as real ones.

    Parameters
    ----------
    window : Window
        Where the cursor is, and what is held.
    take : callable
        Lets panels have an event first, and returns whether the world is not to see it.
    """

    def __init__(self, window: Window, take: Callable[[pygame.Event], bool]) -> None:
        self._window = window
        self._take = take
        self._panning = 0  # the button that drags the picture
        self._alt_alone = False  # whether Alt went down, and nothing else since
        self._tool: Tool | None = None  # what the left button was pressed with
        self._right: float | None = None  # when the right button went down, until it draws or is let go [s]
        self._elapsed = 0.0  # since the last frame [s]
        self._cursor = pygame.SYSTEM_CURSOR_ARROW
        self._entered = False  # whether the pointer has not moved since it is over the window
        self._came_back = -_COMING_BACK  # when another window was left for this one [s]
        self._handlers: dict[int, Callable[[World, pygame.Event], object]] = {
            pygame.KEYDOWN: self._key,
            pygame.KEYUP: self._key_up,
            pygame.MOUSEBUTTONDOWN: self._press,
            pygame.MOUSEBUTTONUP: self._release,
            pygame.MOUSEMOTION: self._motion,
            pygame.MOUSEWHEEL: lambda world, event: actions.zoom(
                window, getattr(event, "precise_y", event.y)
            ),
            pygame.DROPFILE: lambda world, event: open_file(world, window, Path(event.file)),
            pygame.WINDOWFOCUSGAINED: self._come_back,
            pygame.WINDOWFOCUSLOST: self._leave,
            pygame.WINDOWMINIMIZED: self._leave,
            pygame.WINDOWHIDDEN: self._leave,
            pygame.WINDOWLEAVE: lambda world, event: window.put("pointer_on_panel", True),
            pygame.QUIT: lambda world, event: window.put("closing", True),
        }

    def begin(self, world: World, events: Sequence[pygame.Event], elapsed: float) -> None:
        """Do what panels were clicked for in the last frame."""
        self._window.now += elapsed
        self._elapsed = elapsed
        self._window.touched = bool(events or self._window.pending)
        self._do_pending(world)

    def handle(self, world: World, event: pygame.Event) -> None:
        """Do what an event calls for."""
        window, event = self._window, usual_event(event)
        if window.keys.asks and event.type == pygame.KEYDOWN:
            self._choose_key(world, event)
            return
        taken = self._take(event)
        self._do_pending(world)  # an entry in a field is done before the click beside it
        self._follow_alt(world, event)
        handler = self._handlers.get(event.type)
        if taken:
            window.pointer = getattr(event, "pos", window.pointer)
        elif handler is not None:
            handler(world, event)
        if event.type == pygame.MOUSEMOTION:
            window.pointer_on_panel = taken
            # A window that opens under a mouse at rest is told where that is; nothing is to be made there.
            window.has_pointed |= not (self._entered and event.rel == (0, 0))
            self._entered = False
        self._entered |= event.type == pygame.WINDOWENTER

    @property
    def waits(self) -> bool:
        """Whether a button that is held does something after a while: it opens a menu, or it pours."""
        return self._right is not None or self._pours

    @property
    def _pours(self) -> bool:
        window = self._window
        drawn = TOOLS[window.sketch.name or window.tool].draws
        return drawn is not None and drawn.pours and bool(window.sketch.held)

    def end(self, world: World) -> None:
        """Let what follows the cursor follow it."""
        window = self._window
        window.framing.follow(world)
        window.trails.follow(world)
        self._follow_snapping(world)
        window.hand.move(window.target, window.now)
        window.hand.lead(world, window.coming(world), window.pace.paused)
        if self._right is not None and window.sketch.grips and is_dragged(BOX, window):
            self._right = None
        if self._right is not None and window.now - self._right > _HELD:
            self._right = None
            open_context(world, window)
        if self._pours:
            pour(world, window, self._elapsed)
        self._show_cursor()

    def _show_cursor(self) -> None:
        """Let the cursor look like the tool in hand; on panels it is an arrow."""
        window = self._window
        arrow = window.pointer_on_panel or window.hand.entity is not None
        wanted = pygame.SYSTEM_CURSOR_ARROW if arrow else TOOLS[window.tool].cursor
        if wanted != self._cursor:
            self._cursor = wanted
            with contextlib.suppress(pygame.error):  # where the system has no such cursor
                pygame.mouse.set_cursor(wanted)

    def _follow_snapping(self, world: World) -> None:
        """Let the place of the cursor snap, where that is on or a key for it is held."""
        self._window.snapping.held = bool(held_keys() & _SNAPPING)
        follow_snapping(world, self._window)

    def _do_pending(self, world: World) -> None:
        """Do what panels were clicked for."""
        pending, self._window.pending = self._window.pending, []
        for action in pending:
            self._do(action, world)

    def _do(self, action: Action, world: World) -> None:
        """Do something; what the system refuses, as in a folder that was removed, is said."""
        try:
            action(world, self._window)
        except OSError as error:
            self._window.notify(f"Not done: {error.strerror or error}", 6.0, failed=True)

    def _choose_key(self, world: World, event: pygame.Event) -> None:
        """Take a key for what asks for one; those that are held with others are none."""
        name, _, held = _named(event)
        if event.key not in _HELD_KEYS:
            choose_key(world, self._window, held + name)

    def _key(self, world: World, event: pygame.Event) -> None:
        mod = getattr(event, "mod", 0)
        name, printed, held = _named(event)
        if self._types(name, printed, held):
            return
        keys = usual((held + name, held.replace("shift+", "") + name), self._window)
        action = next((KEYS[key] for key in keys if key in KEYS), None)
        other_use = mod & _OTHER_USE and name not in _BY_PRINT
        if action is None or other_use:
            return
        if reaches_world(keys, self._window):
            self._do(action, world)

    def _types(self, name: str, printed: str, held: str) -> bool:
        """Take a key for the numbers of what is being drawn, or held; return whether it is one of these."""
        sketch, lesson = self._window.sketch, self._window.lesson
        holds = self._window.hand.entity is not None and lesson is None
        if not (holds or (sketch.grips and sketch.held)) or "ctrl" in held:
            return False
        letter = {"backspace": "\b", "tab": "\t"}.get(name, printed)
        if not letter or (letter not in "\b\t" and not letter.isprintable()):
            return False
        if not sketch.typed and not (letter.isdigit() or letter in ("-" if holds else ".-(\b\t")):
            return False  # a number begins so: other keys stay what they are
        sketch.write(letter)
        return True

    def _follow_alt(self, world: World, event: pygame.Event) -> None:
        """Open the menus where Alt is pressed and let go alone: with other keys it is for the desktop."""
        is_alt = getattr(event, "key", None) == pygame.K_LALT
        if event.type == pygame.KEYUP and is_alt and self._alt_alone:
            open_menu(world, self._window)
        if event.type in (*_PRESSES, pygame.KEYUP, pygame.WINDOWFOCUSLOST):
            self._alt_alone = is_alt and event.type == pygame.KEYDOWN

    def _key_up(self, world: World, event: pygame.Event) -> None:
        keys = usual((pygame.key.name(event.key).lower(),), self._window)
        action = next((RELEASES[key] for key in keys if key in RELEASES), None)
        if action is not None:  # whatever else is held by now: what was begun must end
            self._do(action, world)

    def _press(self, world: World, event: pygame.Event) -> None:
        self._window.pointer = event.pos
        if self._window.now - self._came_back < _COMING_BACK:
            return  # it brought the window to the front
        follow_pointer(world, self._window)
        self._window.adding = bool(held_keys() & (pygame.KMOD_SHIFT | pygame.KMOD_CTRL))
        self._follow_snapping(world)
        if event.button == pygame.BUTTON_LEFT:
            if self._window.picking is not None:
                picking, self._window.picking = self._window.picking, None
                picked = body_at(world, self._window.camera, event.pos)
                set_end(world, self._window, picking.entity, picking.kind, picking.field, picked)
                return
            if self._window.lesson is None and self._takes_handle(world, event.pos):
                return
            if (impact := clicked_impact(world, self._window, event.pos)) is not None:
                close_up(world, self._window, impact)
                return
            self._tool = TOOLS[self._window.tool]
            self._tool.press(world, self._window)
        elif event.button == pygame.BUTTON_RIGHT and self._window.lesson is None and not self._is_busy:
            # Enter ends what is drawn while the button is held: letting that go opens no menu of it.
            self._right = None if getattr(event, "by_key", False) else self._window.now
            if thing_at(world, self._window) is None:
                drawing.press(world, self._window, BOX, pygame.BUTTON_RIGHT)
        by_tool = event.button == pygame.BUTTON_LEFT and self._tool is not None and self._tool.pans
        if event.button == pygame.BUTTON_MIDDLE or by_tool:
            self._panning = event.button

    @property
    def _is_busy(self) -> bool:
        """Whether something else is drawn, or is in the hand: no menu opens over it, nor is it given up."""
        sketch = self._window.sketch
        return self._window.hand.entity is not None or bool(sketch.grips and sketch.name != BOX.name)

    def _takes_handle(self, world: World, pixel: tuple[float, float]) -> bool:
        """Take the handle of the selection that lies under the cursor; return whether there is one."""
        window = self._window
        if take_end(world, window):
            return True
        return window.handled is not None and window.handles.press(
            world, window.handled, window.camera, pixel
        )

    def _release(self, world: World, event: pygame.Event) -> None:
        self._window.pointer = event.pos
        self._follow_snapping(world)
        follow_pointer(world, self._window)
        if event.button == pygame.BUTTON_LEFT:
            self._window.handles.release(self._window.edits)
            if self._window.hand.entity is not None:
                self._window.sketch.typed = ""
            let_instrument_go(world, self._window)
        if event.button == pygame.BUTTON_LEFT and self._tool is not None:
            self._tool.release(world, self._window)
            self._tool = None
        if event.button == pygame.BUTTON_RIGHT == self._window.sketch.held:
            drawing.release(world, self._window, BOX)
        elif (
            event.button == pygame.BUTTON_RIGHT and self._right is not None and thing_at(world, self._window)
        ):
            open_context(world, self._window)
        if event.button == pygame.BUTTON_RIGHT:
            self._right = None
        if event.button == self._panning:
            self._panning = 0

    def _motion(self, world: World, event: pygame.Event) -> None:
        window = self._window
        window.points_by_key = getattr(event, "by_key", False)
        if not event.buttons[0]:  # let go where no report came from, as over another window
            window.hand.drop(world)
            window.handles.release(window.edits)
            window.pins.release(window.edits)
            let_instrument_go(world, window)
            self._tool = None
        if window.sketch.held and not event.buttons[window.sketch.held - 1]:
            window.sketch.cancel()
        if self._panning and not event.buttons[self._panning - 1]:
            self._panning = 0
        if self._panning:
            dx, dy = event.pos[0] - window.pointer[0], event.pos[1] - window.pointer[1]
            window.camera.pan(dx, dy)
        window.pointer = event.pos
        self._follow_snapping(world)
        drawing.follow(window, TOOLS[window.sketch.name or window.tool].draws)
        if window.handles.dragged is not None and window.handled is not None:
            rounds = bool(held_keys() & pygame.KMOD_SHIFT)
            snaps = rounds or (window.snapping.active and window.handles.dragged == "angle")
            window.handles.drag(window.edits, window.handled, window.camera, window.target, snaps=snaps)
        window.pins.drag(window.edits, window.target, paused=window.pace.paused)
        follow_pointer(world, window)

    def _come_back(self, world: World, event: pygame.Event) -> None:
        self._came_back = self._window.now

    def _leave(self, world: World, event: pygame.Event) -> None:
        """Let go of everything while another window has the focus."""
        self._window.hand.drop(world)
        self._window.pins.release(self._window.edits)
        self._window.sketch.cancel()
        let_instrument_go(world, self._window)
        self._panning, self._tool, self._right = 0, None, None


def follow_snapping(world: World, window: Window) -> None:
    """Find where the cursor's place snaps to: of a body in the hand, a size, a pin, or what is made next."""
    snapping, cursor = window.snapping, window.place
    snapping.clear()
    if not snapping.active or window.pointer_on_panel:
        return
    held, camera = window.hand.entity, window.camera
    if held is not None:
        if window.pace.paused and world.has(held, Held) and world.has(held, Transform):
            transform = world.component(held, Transform)
            middle = cursor - world.component(held, Held).grip.rotated(transform.angle)
            snapping.follow(world, camera, cursor, middle, _about(world, held), (held,))
    elif window.handles.dragged is not None:
        if window.handles.dragged == "size":
            snapping.follow(world, camera, cursor, cursor, None, window.selection.entities)
    elif window.pins.dragged is not None:
        snapping.follow(world, camera, cursor, cursor, None, ())
    elif (drawn := TOOLS[window.tool].draws) is not None:
        whole = drawn.build is not None and drawn.by_click and not window.sketch.grips
        snapping.follow(world, camera, cursor, cursor, about(drawn, window) if whole else None, ())


def _about(world: World, entity: int) -> Outlines | None:
    """Return the outline of a body, as if its middle were at the origin."""
    if not world.has(entity, Shape):
        return None
    return outline_of(world, entity).moved(Vector2() - world.component(entity, Transform).position)


def _named(event: pygame.Event) -> tuple[str, str, str]:
    """Return the name of a key, what it prints, and ``"ctrl+"`` and ``"shift+"`` where these are held."""
    mod, printed = getattr(event, "mod", 0), getattr(event, "unicode", "")
    held = ("ctrl+" if mod & pygame.KMOD_CTRL else "") + ("shift+" if mod & pygame.KMOD_SHIFT else "")
    name = printed if printed in _BY_PRINT else pygame.key.name(event.key).lower()
    return "menu" if event.key == _MENU else name, printed, held
