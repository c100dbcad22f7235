"""Saving the last good state of a world whose run could not go on."""

from __future__ import annotations

import itertools
from pathlib import Path

from physicslab.files.new_scene import file_stem, save_new_scene
from physicslab.world import World

__all__ = ["save_last_good"]


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
