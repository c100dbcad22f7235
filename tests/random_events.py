"""Random events on one window: whatever a user, a file or the window manager may do, in any order."""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pygame
from desk import FRAME, Desk, middle_of

from physicslab import load_scene, save_scene
from physicslab.components import Name, Transform
from physicslab.scenes import SCENES
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.controls.controls import KEYS
from physicslab.view.controls.tools import TOOLS
from physicslab.world import World

__all__ = ["HOSTILE_NAMES", "Hands", "hostile_folder", "with_hostile_words"]

HOSTILE_NAMES = (
    b"caf\xe9.json", b"a##b.json", b"###.json", b"%s%n.json", "\u202egnp.json".encode(), b"two\nlines.json",
    b"x" * 240 + b".json", b"\x1b[2J.json", b"-.json", b"=1+1.json", b" .json",
)  # fmt: skip
_WORDS = (
    "##", "###a", "a##b", "%d%s%n", "The world", "none", "a fixed point", "itself", "\u202ex",
    "e" + "\u0301" * 60, "\U0001f680", "x" * 200, "Gravity", "wall", "circle 1", "=1", "'", '"', "\\",
    "\uf25a", "A##1", "a\u200bb",
)  # fmt: skip
_TEXTS = (
    "",
    "1",
    "-1",
    "1e308",
    "nan",
    "2e",
    "1,5",
    "1/0",
    "a##b",
    "../x",
    "\u202e",
    "~nobody/x",
    "9" * 400,
    "é",
)
_SIZES = ((1, 1), (64, 48), (320, 240), (1280, 720), (2000, 300))
_APART = frozenset({"f5", "ctrl+s", "shift+f12", "f12", "ctrl+shift+s"})
"""Keys that begin other processes, or write files by the hundred."""
_MODS = (0, 0, 0, pygame.KMOD_SHIFT, pygame.KMOD_CTRL, pygame.KMOD_ALT)
_OTHER_KEYS = (
    "tab",
    "return",
    "escape",
    "backspace",
    "delete",
    "left",
    "right",
    "up",
    "down",
    "home",
    "f6",
    "f10",
)


def with_hostile_words(world: World) -> World:
    """Give entities ids that widgets, formats and tables might take for something else."""
    for entity, words in zip(world.batch(Transform).entities.tolist(), _WORDS, strict=False):
        world.add(entity, Name(words))
    return world


def hostile_folder(folder: Path) -> list[Path]:
    """Fill a folder with files that are scenes, or are not, under names of any kind; return their paths."""
    for n, (name, scene) in enumerate(zip(HOSTILE_NAMES, SCENES, strict=False)):
        world = with_hostile_words(load_scene(("drop", "pendulum", "spring_chain", "newtons_cradle")[n % 4]))
        world.title = f"{_WORDS[n]} {scene}"
        save_scene(world, folder / os.fsdecode(name))
    (folder / "no.json").write_bytes(b'{"format": "physicslab-scene/1", "entities": [{"id": 3}]}')
    (folder / "deep.json").write_bytes(b"physicslab-scene/1" + b"[" * 100_000)
    (folder / "folder.json").mkdir()
    (folder / "nowhere.json").symlink_to(folder / "gone")
    os.mkfifo(folder / "pipe.json")
    return list(folder.iterdir())


class Hands:
    """Sends events by a seed, one after the other.

    Parameters
    ----------
    desk : Desk
        The window.
    files : sequence of path
        What is dropped on it.
    """

    def __init__(self, desk: Desk, files: list[Path], seed: int) -> None:
        self._desk, self._files, self._random = desk, files, random.Random(seed)
        self._keys = sorted(set(KEYS) - _APART)
        self._deeds: dict[Callable[[], None], int] = {
            self._click_widget: 30, self._click: 18, self._key: 20, self._text: 6, self._move: 8,
            self._press: 6, self._release: 6, self._wheel: 4, self._size: 1, self._drop: 2, self._scene: 2,
            self._leave: 1, self._tool: 4, self._select: 6, self._level: 1,
        }  # fmt: skip
        self.done: list[str] = []

    def act(self) -> None:
        """Do something, and let a few frames go by."""
        (deed,) = self._random.choices(list(self._deeds), list(self._deeds.values()))
        self.done.append(deed.__name__)
        deed()
        self._desk.frames(self._random.choice((0, 1, 1, 2, 3)), self._random.choice((FRAME, FRAME, 0.0, 1.0)))

    def _pixel(self) -> tuple[int, int]:
        width, height = self._desk.window.canvas.size
        if self._random.random() < 0.5 and len(self._desk.world.batch(Transform)):
            table = self._desk.world.table(Transform)
            row = self._random.choice(self._desk.world.batch(Transform).rows.tolist())
            x, y = table["position"][row]
            if abs(x) < 1e6 and abs(y) < 1e6:
                return self._desk.pixel(float(x), float(y))
        return self._random.randrange(-5, width + 5), self._random.randrange(-5, height + 5)

    def _post(self, kind: int, **what: Any) -> None:
        pygame.event.post(pygame.Event(kind, **what))

    def _button(self) -> int:
        return self._random.choice((1, 1, 1, 1, 2, 3, 6, 7))

    def _move_to(self, place: tuple[int, int]) -> None:
        held = self._random.choice(((0, 0, 0), (1, 0, 0), (0, 1, 0)))
        self._post(pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=held, touch=False)

    def _click_at(self, place: tuple[int, int]) -> None:
        button = self._button()
        self._post(pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=(0, 0, 0), touch=False)
        self._desk.frames(2)
        for kind in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP):
            self._post(kind, button=button, pos=place, touch=False)
            self._desk.frames()

    def _click_widget(self) -> None:
        places = [
            label for label in self._desk.ui.places if "screenshot" not in label and "rror" not in label
        ]
        if places:
            label = self._random.choice(places)
            self.done[-1] += f" {label!a}"
            self._click_at(middle_of(self._desk, label))

    def _click(self) -> None:
        self._click_at(self._pixel())

    def _press(self) -> None:
        self._post(pygame.MOUSEBUTTONDOWN, button=self._button(), pos=self._pixel(), touch=False)

    def _release(self) -> None:
        self._post(pygame.MOUSEBUTTONUP, button=self._button(), pos=self._pixel(), touch=False)

    def _move(self) -> None:
        self._move_to(self._pixel())

    def _key(self) -> None:
        if self._random.random() < 0.3:
            name, mod = self._random.choice(_OTHER_KEYS), self._random.choice(_MODS)
        else:
            *held, name = self._random.choice(self._keys).rsplit("+", 1)
            held = held[0].split("+") if held else []
            mod = pygame.KMOD_CTRL * ("ctrl" in held) | pygame.KMOD_SHIFT * ("shift" in held)
        if name in ("escape", "esc") and self._random.random() < 0.5:
            return
        self.done[-1] += f" {mod} {name}"
        try:
            code = pygame.key.key_code(name)
        except ValueError:
            code = pygame.K_UNKNOWN
        printed = name if len(name) == 1 else ""
        for kind in (pygame.KEYDOWN, pygame.KEYUP):
            self._post(kind, key=code, mod=mod, unicode=printed, scancode=0)
            self._desk.frames()

    def _text(self) -> None:
        text = self._random.choice((*_TEXTS, *_WORDS, *map(str, self._files)))
        self.done[-1] += f" {text[:30]!a}"
        for letter in text[:60]:
            if letter.isprintable():
                self._post(pygame.TEXTINPUT, text=letter)
        self._desk.frames()
        key = self._random.choice((pygame.K_RETURN, pygame.K_TAB, pygame.K_ESCAPE, pygame.K_DOWN))
        self._post(pygame.KEYDOWN, key=key, mod=0, unicode="", scancode=0)

    def _wheel(self) -> None:
        turn = self._random.choice((-1.0, 1.0, 0.3, 40.0))
        self._post(pygame.MOUSEWHEEL, x=0, y=int(turn), precise_x=0.0, precise_y=turn)

    def _size(self) -> None:
        canvas = self._desk.window.canvas
        assert isinstance(canvas, PygameCanvas)
        canvas.surface = pygame.Surface(self._random.choice(_SIZES), 0, 32)

    def _drop(self) -> None:
        path = self._random.choice(self._files)
        self.done[-1] += f" {path.name!a}"
        self._post(pygame.DROPFILE, file=str(path), window=None)

    def _scene(self) -> None:
        self._desk.window.next_world = with_hostile_words(
            load_scene(self._random.choice(("drop", "two_planets")))
        )

    def _leave(self) -> None:
        self._post(pygame.WINDOWFOCUSLOST, window=None)

    def _tool(self) -> None:
        self._desk.window.tool = self._random.choice(list(TOOLS))

    def _select(self) -> None:
        entities = self._desk.world.entities()
        if entities:
            self._desk.window.selection.take(self._random.choice(entities), add=self._random.random() < 0.3)

    def _level(self) -> None:
        self._desk.window.level = self._random.choice(("Explore", "Measure", "Engineer"))
        self._desk.window.figures = self._random.random() < 0.8
