"""Saving the last good state of a world whose run could not go on."""

from __future__ import annotations

import re
from pathlib import Path

from physicslab.files.scene import save_scene
from physicslab.world import World

__all__ = ["save_last_good"]


def save_last_good(world: World, name: str, directory: Path) -> Path:
    """Save a world that stands before a step that diverged, and return the path of the scene file.

    It is ``<name>-before-divergence.json``, numbered where that is there already: nothing is overwritten.

    Raises
    ------
    SceneError
        If the world holds what no scene may.
    OSError
        If the file cannot be written.
    """
    stem = re.sub(r"[^\w.-]+", "-", name).strip("-.") or "scene"
    path, count = directory / f"{stem}-before-divergence.json", 1
    while path.exists() or path.is_symlink():
        count += 1
        path = directory / f"{stem}-before-divergence-{count}.json"
    save_scene(world, path)
    return path
