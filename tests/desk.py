"""A sandbox that tests use as users do: they send SDL's events and let frames go by."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import partial

import numpy as np
import pygame

from physicslab.components import Transform, Velocity
from physicslab.desktop.sandbox import Sandbox
from physicslab.ecs.config import PhysicsConfig, WindowConfig
from physicslab.ecs.vector import Vector2
from physicslab.systems.standard import standard_systems
from physicslab.view.canvas.canvas import Canvas, Painter
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.toolkit.pictures import Pictures
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.view.workbench.trust_badge import BADGE
from physicslab.world import World

FRAME = 1.0 / 60.0
BUTTONS = {"left": 1, "middle": 2, "right": 3}
MENUS = ("File", "Scenes", "Lessons", "Edit", "World", "Instruments", "View", "Help")
_LINES_A_TURN = 5.0
"""How far a turn of the wheel scrolls [heights of the text]."""
SETTLED = 3
"""Frames after which panels show what an event has done, and what it was clicked for is done."""


def empty_world(**physics: object) -> World:
    """Return a world with every physics system and nothing in it."""
    return World(*standard_systems(), physics=PhysicsConfig(**physics))  # type: ignore[arg-type]


def bits(world: World) -> bytes:
    """Return the whole state of motion of a world, bit for bit."""
    world.synchronise()
    transform, velocity = world.table(Transform), world.table(Velocity)
    columns = (transform["position"], transform["angle"], velocity["linear"], velocity["angular"])
    return b"".join(np.ascontiguousarray(column).tobytes() for column in columns)


class LateCanvas(PygameCanvas):
    """Paints a frame when its pixels are looked at: painting is half the work of a frame, and few are."""

    def __init__(self, surface: pygame.Surface) -> None:
        self._due: list[Callable[[], None]] = []
        super().__init__(surface)

    @property
    def surface(self) -> pygame.Surface:
        """The surface with all that is drawn."""
        due, self._due = self._due, []
        for draw in due:
            draw()
        return self._surface

    @surface.setter
    def surface(self, surface: pygame.Surface) -> None:
        self._surface = surface

    @property
    def size(self) -> tuple[int, int]:
        """Width and height [px]."""
        return self._surface.get_size()

    def keep(self, key: Hashable, draw: Callable[[], None]) -> None:
        """Begin the picture: what is due of the one before is seen by nothing."""
        self._due.clear()
        if self._kept is not None and self._kept_key == (key, self.size):
            self._due.append(partial(super().keep, key, draw))
        else:
            super().keep(key, draw)

    def paint(self, painter: Painter) -> None:
        """Let panels be drawn later; what reads the picture has it at once."""
        drawn = painter.func if isinstance(painter, partial) else painter
        if isinstance(getattr(drawn, "__self__", None), Pictures | Ui):
            self._due.append(partial(super().paint, painter))
        else:
            super().paint(painter)


def _late(method: str) -> Callable[..., None]:
    return lambda canvas, *given, **named: canvas._due.append(
        partial(getattr(PygameCanvas, method), canvas, *given, **named)
    )


for _method in ("clear", "glows", "discs", "boxes", "rounded", "lines", "panel", "text"):
    setattr(LateCanvas, _method, _late(_method))


class Desk:
    """A world in a window of 1280 x 720 whose camera shows 100 px per metre, the origin in the middle.

    The clock that limits the steps of a frame stands still, so that no step depends on the machine's load.
    """

    def __init__(
        self, world: World, canvas: Canvas | None = None, config: WindowConfig | None = None
    ) -> None:
        pygame.display.init()
        if canvas is None:
            canvas = LateCanvas(pygame.display.set_mode((1280, 720)))
        self.window = Window(canvas, config)
        self.window.reduced_motion = True  # a picture shows at once what was done
        self.sandbox = Sandbox(world, self.window, clock=lambda: 0.0)
        self.window.camera.look_at((0.0, 0.0, 0.0, 0.0), 100.0)
        self._held: set[str] = set()
        pygame.event.clear()

    @property
    def world(self) -> World:
        """The world that is shown."""
        return self.sandbox.world

    @property
    def ui(self) -> Ui:
        """The panels as they were built last."""
        return self.sandbox.interface.ui

    def pixel(self, x: float, y: float) -> tuple[int, int]:
        """Return the pixel that shows a point of the world [m]."""
        across, down = self.window.camera.to_screen(Vector2(x, y))
        return round(across), round(down)

    def press(self, x: float, y: float, button: str = "left") -> None:
        """Press a mouse button at a point of the world [m]."""
        self._held.add(button)
        pygame.event.post(
            pygame.Event(pygame.MOUSEBUTTONDOWN, button=BUTTONS[button], pos=self.pixel(x, y), touch=False)
        )

    def release(self, x: float, y: float, button: str = "left") -> None:
        """Let a mouse button go at a point of the world [m]."""
        self._held.discard(button)
        pygame.event.post(
            pygame.Event(pygame.MOUSEBUTTONUP, button=BUTTONS[button], pos=self.pixel(x, y), touch=False)
        )

    def move(self, x: float, y: float) -> None:
        """Move the cursor to a point of the world [m]."""
        held = tuple(int(button in self._held) for button in BUTTONS)
        pygame.event.post(
            pygame.Event(pygame.MOUSEMOTION, pos=self.pixel(x, y), rel=(0, 0), buttons=held, touch=False)
        )

    def key(self, name: str, mod: int = 0) -> None:
        """Press a key, by its name in SDL."""
        code = pygame.key.key_code(name)
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=code, mod=mod, unicode="", scancode=0))

    def key_up(self, name: str) -> None:
        """Let a key go."""
        code = pygame.key.key_code(name)
        pygame.event.post(pygame.Event(pygame.KEYUP, key=code, mod=0, unicode="", scancode=0))

    def frames(self, count: int = 1, elapsed: float = FRAME) -> None:
        """Let frames go by."""
        for _ in range(count):
            self.sandbox.frame(elapsed)
        if count > 1 and isinstance(self.window.canvas, LateCanvas):
            self.window.canvas.surface.get_size()  # what has settled is painted

    def drag(self, start: tuple[float, float], velocity: tuple[float, float], frames: int) -> Vector2:
        """Press at a point, move the cursor at a speed [m/s] for so many frames, and let go there."""
        self.press(*start)
        self.frames()
        x, y = start
        for n in range(1, frames + 1):
            x = start[0] + velocity[0] * n * FRAME
            y = start[1] + velocity[1] * n * FRAME
            self.move(x, y)
            if n < frames:
                self.frames()
        self.release(x, y)
        return Vector2(x, y)


type Place = tuple[int, int]


def sized(size: tuple[int, int], world: World | None = None, text_scale: float = 1.0) -> Desk:
    """Return a desk with a window of a size [px], drawn in software, with its panels built."""
    pygame.display.init()
    pygame.display.set_mode((64, 64))
    desk = Desk(empty_world() if world is None else world, LateCanvas(pygame.Surface(size, 0, 32)))
    desk.window.text_scale = text_scale
    desk.frames(SETTLED)
    return desk


def middle_of(desk: Desk, label: str) -> Place:
    """Return the middle of a widget [px], found by its words."""
    left, top, width, height = desk.ui.places[label]
    return left + width // 2, top + height // 2


def point(desk: Desk, place: Place, held: tuple[int, int, int] = (0, 0, 0)) -> None:
    """Move the cursor to a pixel, and let panels follow."""
    pygame.event.post(pygame.Event(pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=held, touch=False))
    desk.frames()


def button_down(desk: Desk, place: Place, button: str = "left") -> None:
    """Press a mouse button at a pixel."""
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONDOWN, button=BUTTONS[button], pos=place, touch=False))
    desk.frames()


def button_up(desk: Desk, place: Place, button: str = "left") -> None:
    """Let a mouse button go at a pixel, and let panels follow."""
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONUP, button=BUTTONS[button], pos=place, touch=False))
    desk.frames(SETTLED)


def click_at(desk: Desk, place: Place, button: str = "left") -> None:
    """Move the cursor to a pixel, press and let go."""
    point(desk, place)
    button_down(desk, place, button)
    button_up(desk, place, button)


def bring_into_sight(desk: Desk, label: str) -> None:
    """Turn the wheel over what stands at the right of the world until a widget of it is in sight."""
    left, top, width, height = desk.sandbox.interface.layout.side
    if label in (*MENUS, "...", BADGE) or desk.sandbox.interface.toolkit.has_popup():
        return
    if desk.ui.places[label][0] < left:  # in a window that is docked between the world and the panel
        world_left, _, world_width, _ = desk.window.framing.room()
        left, width = world_left + world_width, left - world_left - world_width
        tab, edge = round(2.0 * desk.ui.size), round(desk.ui.size)
        top, height, width = top + tab, height - tab, width - edge
    for _ in range(200):
        x, y, _, down = desk.ui.places[label]
        if x < left or (y >= top and y + down <= top + height):
            return
        point(desk, (left + width - 2, top + height // 2))
        turn = (top + 0.5 * (height - down) - y) / (_LINES_A_TURN * desk.ui.size)
        pygame.event.post(pygame.Event(pygame.MOUSEWHEEL, x=0, y=0, precise_x=0.0, precise_y=turn))
        desk.frames(SETTLED)
    raise AssertionError(f"{label} cannot be scrolled into sight")


def click(desk: Desk, label: str, button: str = "left") -> None:
    """Click a widget of a panel, found by its words; the panel is scrolled where that is needed."""
    bring_into_sight(desk, label)
    click_at(desk, middle_of(desk, label), button)


def choose(desk: Desk, menu: str, *lines: str) -> None:
    """Open a menu or a list, and click a line of it."""
    for label in (menu, *lines):
        click(desk, label)


def tap(desk: Desk, name: str, mod: int = 0) -> None:
    """Press a key and let it go within a frame, as quick fingers do; by its name in SDL."""
    code = pygame.key.key_code(name)
    for kind in (pygame.KEYDOWN, pygame.KEYUP):
        pygame.event.post(pygame.Event(kind, key=code, mod=mod, unicode="", scancode=0))
    desk.frames(SETTLED + 1)  # Dear ImGui takes what is let go a frame later


def write(desk: Desk, text: str) -> None:
    """Type a text, key by key, with the text that each key enters."""
    for letter in text:
        try:
            code = pygame.key.key_code(letter)
        except ValueError:
            code = pygame.K_UNKNOWN
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=code, mod=0, unicode=letter, scancode=0))
        pygame.event.post(pygame.Event(pygame.TEXTINPUT, text=letter))
        pygame.event.post(pygame.Event(pygame.KEYUP, key=code, mod=0, unicode=letter, scancode=0))
        desk.frames()
    desk.frames(2)


def fill(desk: Desk, label: str, text: str, end: str = "return") -> None:
    """Click into a field, write a text over what is there, and press a key."""
    click(desk, label)
    write(desk, text)
    tap(desk, end)
