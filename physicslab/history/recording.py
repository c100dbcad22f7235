"""A line in a file, with the scene that it began with, and what came of every step.

The file is JSON: ``{"format": "physicslab-recording/1", "scene": {...}, "entries": [...]}``. Entities of the
scene have the numbers of their places in it, from 1.
"""

import os

from physicslab.ecs.text import printable
from physicslab.files.checks import checked_keys, checked_object, refusal, shown
from physicslab.files.json_text import json_bytes
from physicslab.files.reader import check_scene, read_scene
from physicslab.files.replace import replace_file
from physicslab.files.scene import parse_json, read_text
from physicslab.files.writer import write_scene
from physicslab.history.document import line_document, read_line
from physicslab.history.line import Line
from physicslab.world import World

FORMAT = "physicslab-recording/1"
"""What the key ``format`` of a recording holds."""


def save(world: World, line: Line, path: str | os.PathLike[str]) -> None:
    """Write a line to a file; ``world`` is as at its beginning.

    Raises
    ------
    SceneError
        If the world holds what no scene may.
    OSError
        If the file cannot be written; one that was there before is as it was.
    """
    scene = write_scene(world)
    check_scene(scene, printable(os.fspath(path)))
    numbers = {entity: place for place, entity in enumerate(world.entities(), start=1)}
    entries = line_document(line, numbers)
    replace_file(path, json_bytes({"format": FORMAT, "scene": scene, "entries": entries}))


def load(path: str | os.PathLike[str]) -> tuple[World, Line]:
    """Return the world at the beginning of a recording, and the line.

    Raises
    ------
    SceneError
        If the file cannot be read or is no recording: one line that names the place.
    """
    source = printable(os.fspath(path))
    document = parse_json(read_text(path, source), source)
    found = checked_object(document, source, 'a recording {"format": ..., "scene": ..., "entries": [...]}')
    if found.get("format") != FORMAT:
        raise refusal(f"{source}: format", found.get("format"), f"{shown(FORMAT)}, for a recording")
    checked_keys(found, f"{source}: ", "key", ("format", "scene", "entries"))
    line = read_line(found.get("entries"), source)
    return read_scene(found.get("scene"), f"{source}: scene"), line
