"""The page of a recorded run: one file of HTML with its style, its player and its data."""

import html
import json
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any

from physicslab.ecs.text import printable
from physicslab.export.packing import pack
from physicslab.export.recording import RunRecorder, extent_of_run
from physicslab.world import World

_SCRIPTS = ("run.js", "picture.js", "figures.js", "controls.js")
"""The player, in order: one script, whose parts see the names of those before."""


def page(world: World, name: str, recorder: RunRecorder, notes: Sequence[str]) -> bytes:
    """Return the page that plays what was recorded, in UTF-8.

    Parameters
    ----------
    world : World
        At the end of the run.
    name : str
        What the scene is called where it has no title.
    recorder : RunRecorder
        What kept the run.
    notes : sequence of str
        Lines for the foot of the page: how it was computed, and what is not to be trusted.
    """
    title = printable(world.title or name)
    texts = {
        "TITLE": html.escape(title),
        "DESCRIPTION": html.escape(printable(world.description.replace("\n", " "))),
        "STYLE": _part("style.css"),
        "PLAYER": "".join(map(_part, _SCRIPTS)),
        "RUN": _json(_document(world, recorder, notes)),
    }
    filled = _part("page.html")
    head, *rest = filled.split("{{")
    pieces = [head]
    for piece in rest:
        key, _, after = piece.partition("}}")
        pieces += [texts[key], after]
    return "".join(pieces).encode()


def _document(world: World, recorder: RunRecorder, notes: Sequence[str]) -> dict[str, Any]:
    """Return what the player is given."""
    columns, bodies, springs = recorder.columns, recorder.bodies(world), recorder.springs(world)
    physics = world.physics
    bounds = None if physics.bounds is None else list(physics.bounds)
    uniform = physics.gravity_mode == "linear" and "gravity" in recorder.energies
    return {
        "start": recorder.start,
        "instants": recorder.count,
        "energies": recorder.energies,
        "bodies": bodies,
        "springs": springs,
        "joints": recorder.joints(world),
        "gravity": list(physics.gravity) if uniform else None,
        "bounds": bounds,
        "view": world.view or extent_of_run(world, recorder),
        "notes": notes,
        "data": pack(columns),
    }


def _part(name: str) -> str:
    return files("physicslab.export").joinpath("player", name).read_text("utf-8")


def _json(document: Mapping[str, Any]) -> str:
    """Return a document in ASCII that no browser takes for the end of the script that holds it."""
    text = json.dumps(document, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c")
