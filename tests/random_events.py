"""Random events on one window: whatever a user, a file or the window manager may do, in any order."""

from __future__ import annotations

import json
import os
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pygame
from desk import FRAME, Desk, middle_of
from random_edits import state_hash

from physicslab import load_scene, save_scene
from physicslab.components import Held, Name, Transform
from physicslab.diagnostics.energy import measure_account
from physicslab.diagnostics.warnings import find_warnings
from physicslab.files.json_text import json_text
from physicslab.files.scene import read_scene, write_scene
from physicslab.scenes import SCENES
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.controls import actions
from physicslab.view.controls.context import open_context
from physicslab.view.controls.controls import KEYS
from physicslab.view.controls.copies import begin_copies, duplicate_selected, make_copies, paste
from physicslab.view.controls.tools import DRAWING, TOOLS, remove_selected
from physicslab.world import World

__all__ = ["HOSTILE_NAMES", "Hands", "hostile_folder", "with_hostile_words"]

HOSTILE_NAMES = (
    b"caf\xe9.json", b"a##b.json", b"###.json", b"%s%n.json", "\u202egnp.json".encode(), b"two\nlines.json",
    b"x" * 240 + b".json", b"\x1b[2J.json", b"-.json", b"=1+1.json", b" .json",
)  # fmt: skip
_WORDS = (
    "##", "###a", "a##b", "%d%s%n", "The world", "none", "fixed point", "itself", "\u202ex",
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
_APART = frozenset({"f5", "shift+f12", "f12"})
"""Keys that begin other processes, or write files by the hundred."""
_MODS = (0, 0, 0, pygame.KMOD_SHIFT, pygame.KMOD_CTRL, pygame.KMOD_ALT)
_FILE_KEYS = ("ctrl+n", "ctrl+s", "ctrl+shift+s", "ctrl+o", "f8", "l")
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
    return sorted(folder.iterdir())


def _named(key: str) -> tuple[str, int]:
    """Return the name of a key, and what is held with it."""
    *held, name = key.rsplit("+", 1)
    parts = held[0].split("+") if held else []
    return name, pygame.KMOD_CTRL * ("ctrl" in parts) | pygame.KMOD_SHIFT * ("shift" in parts)


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
            self._leave: 1, self._tool: 4, self._select: 6, self._level: 1, self._drag: 6, self._edit: 4,
            self._panel: 4, self._file: 6, self._draw: 20, self._menu: 8, self._copies: 3, self._search: 4,
            self._theme: 1, self._all_back: 2, self._written: 2,
        }  # fmt: skip
        self.done: list[str] = []

    def act(self) -> None:
        """Do something, and let a few frames go by; the accounts are numbers, or a warning says why not."""
        (deed,) = self._random.choices(list(self._deeds), list(self._deeds.values()))
        self.done.append(deed.__name__)
        deed()
        self._desk.frames(self._random.choice((0, 1, 1, 2, 3)), self._random.choice((FRAME, FRAME, 0.0, 1.0)))
        world = self._desk.world
        accounts = measure_account(world)
        known = np.isfinite([accounts.now.energy, *accounts.energy.values()]).all()
        assert known or find_warnings(world), "an energy that is no number is told"

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

    def _drag(self) -> None:
        """Drag from one place to another: what is drawn, a title that is docked, an edge between windows."""
        button, start, end = self._button(), self._pixel(), self._pixel()
        if self._random.random() < 0.4 and self._desk.sandbox.interface.covered:
            left, top, width, _ = self._random.choice(self._desk.sandbox.interface.covered)
            start = left + self._random.randrange(max(width, 1)), top + self._random.randrange(-2, 12)
        self._post(pygame.MOUSEMOTION, pos=start, rel=(0, 0), buttons=(0, 0, 0), touch=False)
        self._desk.frames()
        self._post(pygame.MOUSEBUTTONDOWN, button=button, pos=start, touch=False)
        for n in range(1, 4):
            self._desk.frames()
            at = tuple(a + (b - a) * n // 3 for a, b in zip(start, end, strict=True))
            self._post(
                pygame.MOUSEMOTION, pos=at, rel=(0, 0), buttons=(button == 1, 0, button == 3), touch=False
            )
        self._post(pygame.MOUSEBUTTONUP, button=button, pos=end, touch=False)

    def _edit(self) -> None:
        """Edit the world in a pause, and find it as it was after one undo."""
        desk = self._desk
        window = desk.window
        desk.frames(2)  # what was pressed before may take hold of something
        window.pace.halt()
        window.hand.drop(desk.world)
        window.sketch.cancel()
        window.edits.keep()
        history, world = window.edits.history, desk.world
        before, count = self._state(), len(history.entries)
        at_end = history.step_count == history.steps_range[1] and history.position == count
        edits = (actions.clear, duplicate_selected, actions.toggle_gravity, remove_selected, paste)
        self._random.choice(edits)(world, window)
        made = len(history.entries) - count
        self.done[-1] += f" {made}"
        if at_end and made:
            assert made == 1, "one act is one entry"
            actions.undo(world, window)
            assert self._state() == before, "one undo takes back one act"

    def _quiet(self) -> bool:
        """Let nothing be held, begun or shown alone; return whether the window shows the end of the line."""
        window, history = self._desk.window, self._desk.sandbox.history
        self._desk.frames(2)
        window.pace.halt()
        window.hand.drop(self._desk.world)
        window.sketch.cancel()
        window.keys.asks = ""  # the first letter of a number would be taken for a key, and the next act
        window.edits.keep()
        history = self._desk.sandbox.history
        return history.step_count == history.steps_range[1] and history.position == len(history.entries)

    def _draw(self) -> None:
        """Draw with a tool by one drag, with typed numbers: one entry, which one undo takes back."""
        desk, name = self._desk, self._random.choice(list(DRAWING))
        window = desk.window
        at_end, history = self._quiet(), desk.sandbox.history
        window.tool, window.picking, window.context = name, None, None
        before = self._state()  # a press that was begun may end in its frame
        count = len(history.entries)
        start, end = self._pixel(), self._pixel()
        typed = self._random.choice(("", "", "", "2", "1.5\t30", "1/0", "-3", "1e9", "0", "5 kg", "40", "2m"))
        self.done[-1] += f" {name} {typed!a} {start} {end}"
        self._post(pygame.MOUSEMOTION, pos=start, rel=(0, 0), buttons=(0, 0, 0), touch=False)
        desk.frames(2)
        self._post(pygame.MOUSEBUTTONDOWN, button=1, pos=start, touch=False)
        for n in range(1, 4):
            desk.frames()
            at = tuple(a + (b - a) * n // 3 for a, b in zip(start, end, strict=True))
            self._post(pygame.MOUSEMOTION, pos=at, rel=(0, 0), buttons=(1, 0, 0), touch=False)
        desk.frames()
        for letter in typed if window.sketch.grips and window.sketch.held else "":
            key = pygame.K_TAB if letter == "\t" else pygame.key.key_code(letter) if letter != " " else 32
            self._post(pygame.KEYDOWN, key=key, mod=0, unicode=letter, scancode=0)
            self._post(pygame.KEYUP, key=key, mod=0, unicode="", scancode=0)
        self._post(pygame.MOUSEBUTTONUP, button=1, pos=end, touch=False)
        desk.frames(3)
        if history is desk.sandbox.history and window.pace.paused and window.tool == name and at_end:
            self._taken_back_at_once(count, before)

    def _state(self) -> bytes:
        """Return a hash of the world as the next frame shows it; trails follow their switch, not edits.

        A plan holds until the motion is edited (``planning.outlived``): what is taken back has been.
        """
        self._desk.frames(1, 0.0)
        return state_hash(self._desk.world, planned=False)

    def _taken_back_at_once(self, count: int, before: bytes) -> None:
        """Check that what was done is one entry at most, and that one undo takes it back."""
        desk = self._desk
        desk.window.edits.keep()
        made = len(desk.sandbox.history.entries) - count
        self.done[-1] += f" {made}"
        assert made <= 1, "one act is one entry"
        if made == 1 and not desk.sandbox.history.entries[-1].steps:
            actions.undo(desk.world, desk.window)
            assert self._state() == before, "one undo takes back one act"
            if self._random.random() < 0.8:
                actions.redo(desk.world, desk.window)

    def _menu(self) -> None:
        """Hold the right button until a menu opens, or press its key, and choose something there."""
        desk = self._desk
        place, known = self._pixel(), set(desk.ui.places)
        self._post(pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=(0, 0, 0), touch=False)
        desk.frames()
        if self._random.random() < 0.5:
            self._post(pygame.MOUSEBUTTONDOWN, button=3, pos=place, touch=False)
            desk.frames(32)
            self._post(pygame.MOUSEBUTTONUP, button=3, pos=place, touch=False)
        else:
            open_context(desk.world, desk.window)
        desk.frames(3)
        new = [label for label in desk.ui.places if label not in known]
        for _ in range(self._random.choice((1, 1, 2))):
            if new:
                label = self._random.choice(new)
                self.done[-1] += f" {label!a}"
                if label in desk.ui.places:
                    self._post_click(middle_of(desk, label))
                new = [label for label in desk.ui.places if label not in known]

    def _post_click(self, place: tuple[int, int]) -> None:
        self._post(pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=(0, 0, 0), touch=False)
        self._desk.frames(2)
        for kind in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP):
            self._post(kind, button=1, pos=place, touch=False)
            self._desk.frames()

    def _copies(self) -> None:
        """Make copies of what is selected, as their panel does."""
        desk = self._desk
        at_end, world, window = self._quiet(), desk.world, desk.window
        before = self._state()
        count = len(desk.sandbox.history.entries)
        begin_copies(world, window)
        desk.frames(2)
        if window.copying is not None:
            places = [label for label in desk.ui.places if label.startswith(("copies ", "way"))]
            if places and self._random.random() < 0.7:
                self._post_click(middle_of(desk, self._random.choice(places)))
                self._text()
                desk.frames(3)
        if window.copying is not None and len(window.copying.offsets) < 60 and desk.world is world:
            make_copies(world, window)
            if (
                at_end
                and desk.sandbox.history.world is world
                and len(desk.sandbox.history.entries) <= count + 1
            ):
                self._taken_back_at_once(count, before)

    def _search(self) -> None:
        """Find a command by its letters, and do it."""
        self._press_key("k", pygame.KMOD_CTRL)
        self._desk.frames(2)
        if self._desk.window.search is not None:
            text = self._random.choice(
                ("grav", "tour", "copy", "new", "box", "graph", "level", "theme", "page")
            )
            self.done[-1] += f" {text}"
            for letter in text:
                self._post(pygame.TEXTINPUT, text=letter)
            self._desk.frames(2)
            for _ in range(self._random.randrange(4)):
                self._post(pygame.KEYDOWN, key=pygame.K_DOWN, mod=0, unicode="", scancode=0)
                self._desk.frames()
            self._post(pygame.KEYDOWN, key=pygame.K_RETURN, mod=0, unicode="", scancode=0)

    def _theme(self) -> None:
        """Choose other colours, or another size of the text."""
        actions.next_theme(self._desk.world, self._desk.window)
        actions.scale_text(self._desk.window, self._random.choice((-2, -1, 1, 2)))

    def _all_back(self) -> None:
        """Take back all that was done, and do it all again: no bit is another one."""
        if not self._quiet():
            return
        history = self._desk.sandbox.history
        before, steps = self._state(), history.step_count
        while history.undo() is not None:
            pass
        while history.redo() is not None:
            pass
        assert history.difference is None and history.step_count == steps
        self._desk.window.trails.goes_elsewhere = True  # as where the window goes
        assert self._state() == before, "what was taken back and done again is as it was"

    def _written(self) -> None:
        """Write the world to a file: what is read from it is written alike, and its energies are numbers."""
        self._quiet()
        world = self._desk.world
        if len(world.batch(Held)):
            return
        document = json.loads(json_text(write_scene(world)))
        again = read_scene(document)
        assert json.loads(json_text(write_scene(again))) == document, "a file holds what is seen"

    def _panel(self) -> None:
        """Open or close a panel as its owner does, or reset the layout."""
        window = self._desk.window
        name = self._random.choice(("impacts.shown", "shows_stopwatch", "lists_history", "help", "layout"))
        if name == "layout":
            actions.reset_layout(self._desk.world, window)
        else:
            window.put(name, not window.is_open(name))

    def _release(self) -> None:
        self._post(pygame.MOUSEBUTTONUP, button=self._button(), pos=self._pixel(), touch=False)

    def _move(self) -> None:
        self._move_to(self._pixel())

    def _file(self) -> None:
        """Save, open, share or begin a scene, and often give it a name."""
        self._press_key(*_named(self._random.choice(_FILE_KEYS)))
        self._desk.frames(2)
        if self._random.random() < 0.7:
            self._text()

    def _key(self) -> None:
        if self._random.random() < 0.3:
            name, mod = self._random.choice(_OTHER_KEYS), self._random.choice(_MODS)
        else:
            name, mod = _named(self._random.choice(self._keys))
        self._press_key(name, mod)

    def _press_key(self, name: str, mod: int) -> None:
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
        self._desk.window.scenes.next_world = with_hostile_words(
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
