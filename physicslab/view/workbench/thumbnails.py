"""Small pictures of scenes, at a moment that shows what they are about; made a little in each frame."""

import time
from dataclasses import dataclass
from pathlib import Path

import pygame

from physicslab.components import Charge, Mass, Medium, Shape, Spring, Trail, Transform, Velocity
from physicslab.ecs.text import printable
from physicslab.files.scene import SceneError, load_scene
from physicslab.lessons.catalogue import find_lesson, openings
from physicslab.scenes import SCENES
from physicslab.state.masses import Diverged
from physicslab.theme import Theme
from physicslab.view.picture.picture import picture_of
from physicslab.world import World

type Source = str | Path
OF_LESSON = "lesson: "
"""The beginning of the source of a lesson, before its name."""

LESSON_TAG = "lesson"
"""The tag of lessons."""
_SHARE = 0.006
"""How long work may take in one frame [s], but for a step or a picture that takes longer."""
_TRACED = 12
"""Moving bodies up to which a picture has their trails."""
_MANY = 100
"""Bodies from which on a scene is one of many bodies."""
_PLAYED = 6.0
"""After how long a picture that moves begins again, in times of the moment that it shows."""


@dataclass(slots=True)
class Known:
    """Facts of a scene once it was read.

    Attributes
    ----------
    title, words : str
        Its title and description.
    tags : tuple of str
        Its subjects and contents.
    failure : str
        Why it cannot be read.
    also : tuple of str
        Further words that find it.
    """

    title: str
    words: str
    tags: tuple[str, ...] = ()
    failure: str = ""
    also: tuple[str, ...] = ()


@dataclass(slots=True)
class _Running:
    """A scene that is run for its picture."""

    source: Source
    world: World
    moment: float


def tags_of(world: World) -> tuple[str, ...]:
    """Return what a scene is about, by what is in it."""
    count = {kind: len(world.batch(kind)) for kind in (Spring, Charge, Medium, Shape, Mass)}
    found = {
        "planets": world.physics.gravity_mode == "planet",
        "springs": count[Spring] > 0,
        "joints": bool(world.joints.joints),
        "charges": count[Charge] > 0,
        "liquids": count[Medium] > 0,
        "solid bodies": count[Shape] > 1 or (count[Shape] > 0 and world.physics.bounds is not None),
        "many bodies": count[Mass] >= _MANY,
    }
    return tuple(tag for tag, is_there in found.items() if is_there)


class Thumbnails:
    """Keeps what was read of scenes, and their pictures."""

    def __init__(self) -> None:
        self._language = ""
        self._known: dict[Source, Known] = {}
        self._stills: dict[tuple[Source, tuple[int, int], str, bool], pygame.Surface] = {}
        self._running: _Running | None = None
        self._runs = False
        self.missing = False

    def begin(self, language: str = "", *, runs: bool) -> None:
        """Begin a frame: nothing is missing yet; ``runs`` says whether scenes may be run, not shown alone."""
        self.missing, self._runs = False, runs
        if language != self._language:
            self._language = language
            self._known = {one: known for one, known in self._known.items() if not lesson_of(one)}

    def known(self, source: Source) -> Known | None:
        """Return what is known of a scene; ``None`` for now where it was not read yet, one a frame is."""
        if source not in self._known:
            if source in SCENES:
                scene = SCENES[str(source)]
                tags = *scene.teaches, *scene.tags
                self._known[source] = Known(scene.title, scene.description, tags, also=scene.search_words)
            elif isinstance(source, str):
                name = lesson_of(source)
                own, english = openings(self._language)[name], openings()[name]
                also = own.needs, *english
                self._known[source] = Known(own.title, own.text, (LESSON_TAG,), also=also)
            elif self.missing:
                return None
            else:
                self.missing = True
                self._known[source] = self._read(source)
        return self._known[source]

    def _read(self, source: Source) -> Known:
        try:
            world = load_scene(source)
            world.synchronise()
        except (SceneError, OSError, ValueError) as error:
            why = printable(str(error)).removeprefix(f"{printable(str(source))}: ")
            return Known(_name(source), "", failure=why[:1].upper() + why[1:])
        return Known(world.title or _name(source), world.description, tags_of(world))

    def forget(self, source: Source) -> None:
        """Read a scene again: its file was written since."""
        self._known.pop(source, None)
        self._stills = {key: still for key, still in self._stills.items() if key[0] != source}

    def still(self, source: Source, size: tuple[int, int], theme: Theme) -> pygame.Surface | None:
        """Return the picture of a scene at its moment; ``None`` where there is none yet, or never one."""
        key = source, size, theme.name, self._runs
        if key in self._stills:
            return self._stills[key]
        if self.missing or (found := self._known.get(source)) is None or found.failure:
            return None
        self.missing = True
        running = self._run(source)
        if running is None:
            return None
        if self._advance(running, running.moment):
            self._stills[key] = picture_of(running.world, size, theme)
            self._running = None
        return self._stills.get(key)

    def moving(self, source: Source, size: tuple[int, int], theme: Theme) -> pygame.Surface | None:
        """Return the picture of a scene that goes on from frame to frame."""
        running = self._run(source)
        if running is None or not self._runs:
            return self.still(source, size, theme)
        self.missing = True
        begun = running.world.time
        if begun > _PLAYED * max(running.moment, 1.0):
            self._running = None
        self._advance(running, begun + 1.0 / 30.0 * max(running.moment, 1.0))
        return picture_of(running.world, size, theme)

    def _run(self, source: Source) -> _Running | None:
        """Return the scene that is run, begun again where it is another."""
        if self._running is None or self._running.source != source:
            self._running = None
            try:
                world = _world(source)
            except (SceneError, OSError, ValueError):
                return None
            moment = SCENES[str(source)].moment if source in SCENES else 1.0 if lesson_of(source) else 0.0
            movers = world.batch(Transform, Velocity).entities.tolist()
            if len(movers) <= _TRACED and not len(world.batch(Trail)):
                for entity in movers:
                    world.add(entity, Trail(max(moment, 1.0)))
            self._running = _Running(source, world, moment)
        return self._running

    def _advance(self, running: _Running, until: float) -> bool:
        """Step for a part of a frame; return whether the time is reached, or cannot be."""
        world, deadline = running.world, time.perf_counter() + _SHARE
        if not self._runs:
            return True
        try:
            while world.time < until - 0.5 * world.simulation.dt:
                world.step()
                if time.perf_counter() >= deadline:
                    return world.time >= until - 0.5 * world.simulation.dt
        except Diverged:
            return True
        return True


def lesson_of(source: Source) -> str:
    """Return the name of a lesson by its source; empty for that of a scene."""
    is_lesson = isinstance(source, str) and source.startswith(OF_LESSON)
    return str(source).removeprefix(OF_LESSON) if is_lesson else ""


def _world(source: Source) -> World:
    """Return the world of a scene, or of a lesson."""
    name = lesson_of(source)
    return find_lesson(name).setup.world() if name else load_scene(source)


def _name(source: Source) -> str:
    return printable(source.name) if isinstance(source, Path) else source
