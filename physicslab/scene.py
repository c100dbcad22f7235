"""Scenes by name and on disk: what opens one, and what saves one."""

from __future__ import annotations

import json
import math
import os
from pathlib import Path

from physicslab.file_replacement import replace_file
from physicslab.json_text import json_text
from physicslab.scene_checks import JsonObject, SceneError, printable, suggestion
from physicslab.scene_reader import check_scene, read_scene
from physicslab.scene_writer import write_scene
from physicslab.scenes import SCENES
from physicslab.world import World

__all__ = ["SceneError", "load_scene", "read_scene", "save_scene", "write_scene"]


def load_scene(name_or_path: str | os.PathLike[str]) -> World:
    """Return a new world: a built-in scene, or one from a file, with the systems that it needs.

    Parameters
    ----------
    name_or_path : str or path
        A built-in scene's name, or a path. Where there is a file of that name too, ``./drop`` is the file.

    Returns
    -------
    World
        esper's active world from here on, like any new one.

    Raises
    ------
    SceneError
        If there is no such scene, or anything in it is not allowed; one line that says what and where.

    Examples
    --------
    >>> world = load_scene("drop")
    >>> world.title
    'A ball on a floor'
    """
    if isinstance(name_or_path, str) and name_or_path in SCENES:
        return SCENES[name_or_path].build()
    source = printable(os.fspath(name_or_path))
    return read_scene(_parse(_read_text(name_or_path, source), source), source)


def save_scene(world: World, path: str | os.PathLike[str]) -> None:
    """Write a world to a scene file, from which :func:`load_scene` makes the same world, bit for bit.

    A file that was there before is replaced only by one that is complete and can be read again.

    Raises
    ------
    SceneError
        If the world holds what no scene may: a number that is not finite, an id used twice, ...
    OSError
        If the file cannot be written.
    """
    source = printable(os.fspath(path))
    document = write_scene(world)
    check_scene(document, source)
    replace_file(path, json_text(document).encode("utf-8"))


def _read_text(path: str | os.PathLike[str], source: str) -> str:
    try:
        return Path(path).read_bytes().decode("utf-8-sig")
    except FileNotFoundError as error:
        names = ", ".join(SCENES)
        likely = suggestion(os.fspath(path), SCENES)
        raise SceneError(
            f"{source}: no such file, and no built-in scene{likely or f'; the built-in scenes are {names}'}"
        ) from error
    except IsADirectoryError as error:
        raise SceneError(f"{source}: is a directory, not a scene file") from error
    except UnicodeDecodeError as error:
        raise SceneError(f"{source}: is not UTF-8: byte {error.start} cannot be read") from error
    except OSError as error:
        raise SceneError(f"{source}: cannot be read: {error.strerror}") from error
    except ValueError as error:  # a null character in the name
        raise SceneError(f"{source}: is no file name: {error}") from error


def _parse(text: str, source: str) -> object:
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
