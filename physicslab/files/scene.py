"""Scenes by name and on disk: what opens one, and what saves one, under a new name too."""

import gc
import itertools
import json
import math
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.text import printable, shortened, suggestion
from physicslab.files.checks import JsonObject, SceneError
from physicslab.files.json_text import json_bytes
from physicslab.files.plain import read_bytes
from physicslab.files.reader import check_scene, read_scene
from physicslab.files.replace import create_first, replace_file, with_numbers
from physicslab.files.writer import write_scene
from physicslab.scenes import SCENES
from physicslab.world import World

__all__ = [
    "SceneError", "load_scene", "parse_json", "read_scene", "read_text", "save_scene", "scene_bytes",
    "write_scene",
]  # fmt: skip

BRACKET_LIMIT = 1_000_000
"""Objects and lists that a scene file may hold, 125,000 bodies: reading them takes up to 1.1 GB of memory."""
VALUE_LIMIT = 8_000_000
"""Values that it may hold, counted by the brackets and commas before them, those within texts included."""


def load_scene(
    scene: str | bytes | os.PathLike[str] | Mapping[str, Any], losses: list[str] | None = None
) -> World:
    """Return a new world: a built-in scene, or one from a file, with the systems that it needs.

    Parameters
    ----------
    scene : str, path or dict
        A built-in scene's name, or a path, as text or bytes. Where there is a file of that name too,
        ``./drop`` is the file. One that ends in ``.step`` is a world of KDE Step. A dict is what such a file
        holds.
    losses : list of str, optional
        Gets what of such a world has no place in a scene, a line each.

    Returns
    -------
    World
        esper's active world from here on, like any new one.

    Raises
    ------
    SceneError
        If there is no such scene, or anything in it is not allowed; one line: what and where.

    Examples
    --------
    >>> world = load_scene("drop")
    >>> world.title
    'A ball on a floor'
    """
    if isinstance(scene, Mapping):
        return read_scene(scene, "the scene")
    if isinstance(scene, str) and scene in SCENES:
        return SCENES[scene].build()
    path = _path(scene)
    source = printable(path)
    try:
        if is_step(path):
            from physicslab.files.kde_step.world import read_step  # for such files alone

            name, left_out = file_stem(Path(path).stem), [] if losses is None else losses
            with uncollected():
                return read_step(read_content(path, source), source, name, left_out)
        text = read_text(path, source)
    except SceneError as error:
        if not isinstance(error.__cause__, FileNotFoundError):
            raise
        raise SceneError(f"{source}: no such file{_likely(path)}") from error.__cause__
    with uncollected():
        return read_scene(parse_json(text, source), source)


def _likely(path: str) -> str:
    """Return the rest of the line that says that a file is not there: which it may have been meant to be."""
    folder, name = os.path.split(path)
    if not folder and not os.path.splitext(name)[1]:
        built_in = suggestion(path, SCENES) or f"; the built-in scenes are {', '.join(SCENES)}"
        return f", and no built-in scene{built_in}"
    try:
        beside = sorted(os.listdir(folder or "."))
    except OSError:
        beside = []
    return suggestion(name, [*beside, *SCENES])


def is_step(path: str | os.PathLike[str]) -> bool:
    """Whether a file is a world of KDE Step, by its ending."""
    return os.fspath(path).lower().endswith(".step")


def save_scene(world: World, path: str | bytes | os.PathLike[str]) -> None:
    """Write a world to a scene file, from which :func:`load_scene` makes the same world, bit for bit.

    A file that was there before is replaced only by one that is complete and can be read again.

    Raises
    ------
    SceneError
        If the world holds what no scene may: a number that is not finite, an id used twice, ...
    OSError
        If the file cannot be written.
    """
    path = _path(path)
    replace_file(path, scene_bytes(world, path))


def _path(given: object) -> str:
    """Return a path as text; any other value is a TypeError that names the function for documents."""
    try:
        return os.fsdecode(given)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"a scene has a name or a path; got {shortened(repr(given))}") from None


def scene_bytes(world: World, source: str) -> bytes:
    """Return the content of a scene file, checked as it will be when it is read.

    Parameters
    ----------
    world : World
        The world to write.
    source : str
        Name of the scene in messages: the path that it will have.

    Raises
    ------
    SceneError
        If the world holds what no scene may.
    """
    if is_step(source):
        raise SceneError(f"{printable(source)}: is the name of a world of KDE Step; a scene is JSON")
    try:
        document = write_scene(world)
    except InvalidValue as error:  # written to a column
        raise SceneError(f"{printable(source)}: {error}") from error
    check_scene(document, printable(source))
    return json_bytes(document)


@contextmanager
def uncollected() -> Iterator[None]:
    """Collect no garbage in a ``with`` block: of the millions of objects of a large scene, none is any.

    A search takes half of the time that such a scene takes to load.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def read_text(path: str | os.PathLike[str], source: str) -> str:
    """Read a file of JSON, called ``source`` in messages; one that cannot be read is a SceneError."""
    try:
        return read_content(path, source).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SceneError(
            f"{source}: is not UTF-8: byte {error.start} cannot be read; must be JSON in UTF-8"
        ) from error


def read_content(path: str | os.PathLike[str], source: str) -> bytes:
    """Read a scene file, called ``source`` in messages; one that cannot be read is a SceneError."""
    try:
        return read_bytes(path, source)
    except OSError as error:
        raise SceneError(f"{source}: cannot be read: {error.strerror}") from error
    except SceneError:
        raise
    except ValueError as error:  # a null character or half a surrogate pair in the name
        raise SceneError(f"{source}: is no file name: {error}") from error


def parse_json(text: str, source: str) -> object:
    """Return the content of a JSON text; an invalid one, or more than a scene may hold, is a SceneError."""
    # Counted before it is parsed: every one becomes a Python object, many times its size in the file.
    brackets = text.count("{") + text.count("[")
    if brackets > BRACKET_LIMIT:
        raise SceneError(
            f"{source}: holds too much: a scene must have at most {BRACKET_LIMIT:,} objects and lists"
        )
    if brackets + text.count(",") > VALUE_LIMIT:
        raise SceneError(f"{source}: holds too much: a scene must have at most {VALUE_LIMIT:,} values")
    try:
        return json.loads(text, object_pairs_hook=JsonObject.of, parse_int=_whole)
    except json.JSONDecodeError as error:
        raise SceneError(
            f"{source}: is not JSON: {error.msg} at line {error.lineno}, column {error.colno}"
        ) from error
    except RecursionError as error:
        raise SceneError(f"{source}: is nested too deeply to be a scene") from error


def _whole(digits: str) -> int | float:
    """Read a whole number; one that no float can hold is infinite, which the check of its field refuses."""
    return int(digits) if len(digits) < 310 else math.copysign(math.inf, -1.0 if digits[0] == "-" else 1.0)


_NAME_LIMIT = 100
"""Bytes of the part of a file name that comes from a scene's name: systems allow 143 to 255 for the whole."""


def file_stem(name: str) -> str:
    """Return a scene's name as far as a file may bear it: without what paths are made of, and shortened.

    >>> file_stem("a/b c"), file_stem("../.."), len(file_stem("x" * 1000))
    ('a-b-c', 'scene', 100)
    """
    plain = re.sub(r"[^\w.-]+", "-", name[:_NAME_LIMIT])
    return plain.encode("utf-8", "ignore")[:_NAME_LIMIT].decode("utf-8", "ignore").strip("-.") or "scene"


def save_new_scene(world: World, paths: Iterable[Path]) -> Path:
    """Save a world under the first of some names that nothing has, and return it: nothing is overwritten.

    Parameters
    ----------
    world : World
        The world to save.
    paths : iterable of Path
        The names in order; one that does not end.

    Raises
    ------
    SceneError
        If the world holds what no scene may.
    OSError
        If the file cannot be written.
    """
    first, names = itertools.tee(paths)
    return create_first(names, scene_bytes(world, str(next(first))))


def save_last_good(world: World, name: str, directory: Path) -> Path:
    """Save a world that stands before a step that diverged, and return the path of the scene file.

    It is ``<name>-before-divergence.json``, numbered where that is there already, with the name shortened
    where it is long: nothing is overwritten, even by runs that diverge at the same time.

    Raises
    ------
    SceneError
        If the world holds what no scene may.
    OSError
        If the file cannot be written.
    """
    first = directory / f"{file_stem(name)}-before-divergence.json"
    return save_new_scene(world, with_numbers(first))
