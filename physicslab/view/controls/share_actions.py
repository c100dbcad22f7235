"""Actions that make a page of a scene, for any browser."""

import copy
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from physicslab.components import Held, MadeOf, Shape, Slider, Velocity
from physicslab.components.slider import GRAVITY
from physicslab.ecs.component import Component, InvalidValue
from physicslab.ecs.text import printable
from physicslab.export.page import field_words
from physicslab.files.places import SECTIONS, entity_names, find_place
from physicslab.files.replace import reason_of, replace_file
from physicslab.files.scene import SceneError, save_scene
from physicslab.stepping.keyframe import Keyframe
from physicslab.view.controls.saving import name_of
from physicslab.view.window.naming import named_after
from physicslab.view.window.sharing import (
    FROM_EDIT,
    FROM_NOW,
    FROM_START,
    WHOLE_LESSON,
    Sharing,
    Slid,
    beginnings,
)
from physicslab.view.window.window import Window
from physicslab.world import World

_GRAVITY = "physics.gravity.y"
"""Uniform gravity, upwards, as the command line names it."""
_VALUES = 9
"""How many values a slider of the scene gets in the page."""
_MOST = 200
"""How many entities are offered."""
_LIMIT = 600.0
"""The longest run that the panel takes [s]."""


def toggle_sharing(world: World, window: Window) -> None:
    """Let the user choose a page, or no longer; stop the one that is being made."""
    sharing = window.sharing
    if sharing.running:
        stop_sharing(world, window)
        return
    sharing.choosing = not sharing.choosing
    if sharing.choosing:
        lesson = None if window.lesson is None else window.lesson.lesson
        sharing.begins = usual_beginning(window, sharing.begins) if lesson is None else WHOLE_LESSON
        sharing.naming = named_after(name_of(world, window) if lesson is None else lesson.name, ".html")
        _take_sliders(world, window)


def usual_beginning(window: Window, chosen: str) -> str:
    """Return where to begin: what was built while time ran or stood is not there at the start."""
    return chosen if chosen == FROM_NOW else beginnings(window.edits.history.last_edit)[0]


def _take_sliders(world: World, window: Window) -> None:
    """Let the page have the sliders of the scene; those of another scene are dropped."""
    names = _names(world)
    found = []
    for entity in sorted(world.batch(Slider).entities.tolist()):
        one = world.component(entity, Slider)
        if one.changes == GRAVITY:
            found.append(Slid(_GRAVITY, f"{0.0 - one.low:g}:{0.0 - one.high:g}:{_VALUES}"))
        elif one.entity in names:
            found.append(Slid(f"{names[one.entity]}.{one.changes}", f"{one.low:g}:{one.high:g}:{_VALUES}"))
    known = varying(world)
    for n, slid in enumerate(window.sharing.slid):
        if n < len(found):
            slid.path, slid.span = found[n].path, found[n].span
        elif slid.path not in known:
            slid.path = ""


def _names(world: World) -> dict[int | None, str]:
    """Return what the command line calls each entity."""
    return {entity: name for name, entity in entity_names(world, _MOST).items()}


def varying(world: World) -> dict[str, str]:
    """Return the words of each field that may be varied: what moves, gravity, then the rest."""
    found, gravity = {"": words_of("")}, {_GRAVITY: "gravity y"}
    moving = set(world.batch(Velocity).entities.tolist())
    for entity, name in sorted(_names(world).items(), key=lambda named: named[0] not in moving):
        found |= {} if entity in moving else gravity
        for part in world.components(entity) if entity is not None else ():
            kind = type(part)
            if not isinstance(part, Component) or not kind.physical or kind is Held:
                continue
            sizes = Shape.HAS[part.kind] if isinstance(part, Shape) else None
            for spec in kind.FIELDS:
                if sizes is None or spec.name in sizes:
                    for end in _ENDS.get(spec.kind, ()):
                        path = f"{name}.{kind.__name__}.{spec.name}{end}"
                        found[path] = words_of(path)
    return found | gravity


_ENDS = {"number": ("",), "vector": (".x", ".y")}
"""Endings that name one number of a field."""


def words_of(path: str) -> str:
    """Return a path of a field in words.

    >>> words_of("ball.Velocity.linear.x"), words_of("physics.gravity.y"), words_of("")
    ('ball: velocity x', 'gravity y', 'nothing')
    """
    if not path:
        return "nothing"
    whole = path.removesuffix(".x").removesuffix(".y")
    owner, _, field = whole.rpartition(".")
    words = field_words(field, path[len(whole) + 1 :])
    return words if owner in SECTIONS else f"{printable(owner.rpartition('.')[0])}: {words}"


def choose_slid(world: World, window: Window, slid: Slid, path: str) -> None:
    """Let a slider of the page change another quantity, at first around the value with which it begins."""
    slid.path, slid.refused = path, ""
    if not path:
        return
    low, high, _ = span_around(world, window, window.sharing.begins, path)
    slid.span = f"{low:.3g}:{high:.3g}:{_VALUES}"


def span_around(world: World, window: Window, begins: str, path: str) -> tuple[float, float, str]:
    """Return half and one and a half of a field's first value, as far as it may be so, and its unit."""
    place = find_place(world, "", path, "")
    with gone_back(window, begins):
        now = place.value(world)
    low, high = sorted((0.5 * now, 1.5 * now)) if now else (0.0, 5.0)
    return max(low, place.spec.lowest), min(high, place.spec.highest), place.spec.unit


def begin_sharing(world: World, window: Window, over: Path | None = None) -> None:
    """Begin to make the page that was chosen; where it cannot be, say why."""
    sharing, naming = window.sharing, window.sharing.naming
    path = naming.path((".html", ".htm"), over)
    if path is None:
        return
    if sharing.begins == WHOLE_LESSON and window.lesson is not None:
        naming.refused = _why_not("1", path.parent)
        if not naming.refused:
            sharing.make_lesson(window.lesson.source, window.lesson.lesson.language, path)
            sharing.choosing = False
        return
    naming.refused = _why_not(sharing.seconds, path.parent)
    for slid in sharing.slid:
        form = not slid.path or slid.span.count(":") == 2
        slid.refused = "" if form else "must be from : to : how many values, as 1:5:9"
    if naming.refused or any(slid.refused for slid in sharing.slid):
        return
    window.put_down(world)

    def write(scene: Path) -> None:
        begun = World()
        with gone_back(window, sharing.begins):
            Keyframe(world).fill(begun)
        _show_alike(begun, world)
        save_scene(begun, scene)

    try:
        sharing.make(write, path)
    except (OSError, SceneError) as error:
        naming.refused = f"The page could not be made: {reason_of(error)}"
        return
    sharing.choosing = False


@contextmanager
def gone_back(window: Window, begins: str) -> Iterator[None]:
    """Show the scene as it was where it is to begin, and then as it is now again."""
    history = window.edits.history
    here = history.step_count
    begin = {FROM_START: 0, FROM_EDIT: history.last_edit}.get(begins, here)
    moved = begin < here
    if moved:
        history.seek(begin)
    try:
        yield
    finally:
        if moved:
            history.seek(here)


def _show_alike(begun: World, now: World) -> None:
    """Give a scene as it was at its start the texts, names, colours and instruments that it has now."""
    begun.name, begun.title, begun.description = now.name, now.title, now.description
    begun.view, begun.desk = now.view, now.desk
    for entity in set(begun.entities()) - set(now.entities()):
        if all(map(_is_shown, begun.components(entity))):
            begun.remove(entity)
    there = set(begun.entities())
    for entity in now.entities():
        parts = now.components(entity)
        shown = [copy.copy(part) for part in parts if _is_shown(part)]
        if entity not in there and len(shown) == len(parts):
            begun.spawn(*shown, entity=entity)
        for part in shown if entity in there else ():
            with suppress(InvalidValue):  # a body that is gone now may have had that name
                begun.add(entity, part)


def _is_shown(part: object) -> bool:
    """Whether a component changes what is seen, and not the motion."""
    return not getattr(part, "physical", True) and not isinstance(part, MadeOf)


def _why_not(seconds: str, folder: Path) -> str:
    """Return why no page can be made of so many seconds in a folder, empty if it can be."""
    try:
        is_time = 0.0 < float(seconds) <= _LIMIT
    except ValueError:
        is_time = False
    if not is_time:
        return f"{seconds.strip() or 'Nothing'} is no time: a number above 0, {_LIMIT:g} s at most"
    if not os.access(folder, os.W_OK):
        missing = "Nothing may be written in" if folder.is_dir() else "There is no folder"
        return f"{missing} {printable(str(folder))}"
    return ""


def stop_sharing(world: World, window: Window) -> None:
    """Give up the page that is being made."""
    window.sharing.abandon()
    window.notify("The page was given up")


def _refuse(sharing: Sharing) -> None:
    """Say why there is no page: beside the values that it cannot be made with, or beside its name."""
    for slid in sharing.slid:
        said, sign, reason = sharing.failure.partition(f' = "{slid.span}": ')
        if slid.path and sign and slid.path.removesuffix(".x").removesuffix(".y").endswith(said.split()[-1]):
            slid.refused = reason
            return
    sharing.naming.refused = sharing.failure.removeprefix("physicslab: ")


def finish_sharing(window: Window) -> None:
    """Write the page where it has been made just now, or say why there is none."""
    sharing = window.sharing
    report = sharing.ended()
    if report is None:
        return
    if not report:
        sharing.choosing = True
        _refuse(sharing)
        return
    page: bytes = report["page"]
    try:
        replace_file(sharing.path, page)
    except OSError as error:
        sharing.choosing = True
        sharing.naming.refused = f"The page could not be saved: {reason_of(error)}"
        return
    size = f"{len(page) / 1000:,.0f} kB"
    window.notify(
        f"Saved {printable(str(sharing.path))}, {size}: any browser plays it, without a network", 8.0
    )
