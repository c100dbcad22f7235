"""Scene files under names that nothing has yet."""

import itertools
import re
from collections.abc import Iterable
from pathlib import Path

from physicslab.files.replace import create_file
from physicslab.files.scene import scene_bytes
from physicslab.world import World

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

    Several programs that save at once under the same names get names of their own.

    Parameters
    ----------
    world : World
        What is saved.
    paths : iterable of Path
        The names in order; one that does not end.

    Raises
    ------
    SceneError
        If the world holds what no scene may.
    OSError
        If the file cannot be written.
    """
    content: bytes | None = None
    for path in paths:
        if content is None:
            content = scene_bytes(world, str(path))
        try:
            create_file(path, content)
        except FileExistsError:
            continue
        return path
    raise FileExistsError("every name is taken")


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
    stem = f"{file_stem(name)}-before-divergence"
    numbered = (directory / f"{stem}-{number}.json" for number in itertools.count(2))
    return save_new_scene(world, itertools.chain([directory / f"{stem}.json"], numbered))
