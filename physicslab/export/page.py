"""The page of a recorded run: one file of HTML with its style, its player and its data."""

import html
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

from physicslab.diagnostics.energy import measure_account
from physicslab.ecs.text import printable
from physicslab.export import parts
from physicslab.export.look import look, style
from physicslab.export.packing import pack
from physicslab.export.recording import RunRecorder, extent_of_run
from physicslab.languages.catalogue import SOURCE
from physicslab.languages.language import language
from physicslab.systems.breaking import breaks_of
from physicslab.world import World

_SCRIPTS = ("run.js", "bodies.js", "picture.js", "figures.js", "controls.js", "lesson.js")
"""The player, in order: one script, whose parts see the names of those before; the last is for lessons."""
_SAID = re.compile(r'\bsay\("([^"]+)"\)|\{\{say:([^}]+)\}\}')
"""A text of the player in its scripts, and in its page."""
_OF_STEPS = ("acceleration", "force", "net force", "joint")
"""The beginnings of quantities that soft contacts have a share in: it is that of the last substep."""
_WORDS = {"linear": "velocity", "angular": "angular velocity"}
"""Labels of fields whose names are not clear without their components."""


def field_words(field: str, part: str) -> str:
    """Return what a field is called, or its ``part`` x or y.

    >>> field_words("linear", "x"), field_words("rest_length", "")
    ('velocity x', 'rest length')
    """
    return f"{_WORDS.get(field, field.replace('_', ' '))} {part}".strip()


@dataclass(frozen=True, slots=True)
class Varied:
    """A quantity that differs from run to run: what a slider of the page says, and its values."""

    label: str
    unit: str
    values: Sequence[float]


def page(world: World, name: str, runs: Sequence[Mapping[str, Any]], varied: Sequence[Varied] = ()) -> bytes:
    """Return the page that plays what was recorded, in UTF-8.

    Parameters
    ----------
    world : World
        The scene, for its title and its description.
    name : str
        Name of a scene that has no title.
    runs : sequence of dict
        As :func:`run_document` returns them, or ``{"failure": why}``: one, or one for each combination of
        values, those of the last quantity next to each other.
    varied : sequence of Varied
        Fields that differ between the runs.
    """
    views = [*([world.view] if world.view else []), *(run["view"] for run in runs if "view" in run)]
    low, high = (
        [best(view[k] for view in views) for k in ends] for best, ends in ((min, (0, 1)), (max, (2, 3)))
    )
    document = {
        "view": [*low, *high], "runs": runs,
        "sliders": [{"label": one.label, "unit": one.unit, "values": one.values} for one in varied],
    }  # fmt: skip
    return fill_page(world.title or name, world.description.replace("\n", " "), document)


def fill_page(
    title: str, description: str, document: Mapping[str, Any], article: str = "", code: str = SOURCE
) -> bytes:
    """Return the page of the player with what it plays, in UTF-8.

    Parameters
    ----------
    title, description : str
        The lines above it.
    document : dict
        The player's data, as JSON.
    article : str
        HTML of a lesson, in which the player stands where a run is made; none where it is empty.
    code : str
        The language of the page.
    """
    own = language(code)
    words = {text: own.reword(text) for text in player_texts()}
    shown = {text: said for text, said in {**words, **document.get("words", {})}.items() if said != text}
    scripts, styles = (_SCRIPTS, ("style.css", "lesson.css")) if article else (_SCRIPTS[:-1], ("style.css",))
    texts = {
        "CODE": html.escape(code),
        "TITLE": html.escape(printable(title)),
        "DESCRIPTION": html.escape(printable(description)),
        "STYLE": style() + "".join(map(player_part, styles)),
        "ARTICLE": article,
        "PLAYER": "".join(map(player_part, scripts)),
        "RUN": _json({**document, "look": look(), "words": shown, "mark": own.say(".")}),
    }
    texts |= {f"say:{text}": html.escape(said) for text, said in words.items()}
    head, *rest = player_part("page.html").split("{{")
    pieces = [head]
    for piece in rest:
        key, _, after = piece.partition("}}")
        pieces += [texts[key], after]
    return "".join(pieces).encode()


def player_texts() -> list[str]:
    """Return the player's own texts, which a page has in its language."""
    sources = map(player_part, (*_SCRIPTS, "page.html"))
    return list(dict.fromkeys(one or other for source in sources for one, other in _SAID.findall(source)))


def run_document(
    world: World, recorder: RunRecorder, notes: Sequence[str], *, is_one_of_many: bool = False
) -> dict[str, Any]:
    """Return what the player is given of a run; ``world`` is at the end of it.

    ``notes`` are lines for the foot of the page: how it was computed, and what is not to be trusted.
    The view of the scene holds the run that was seen; one of many may leave it.
    """
    physics = world.physics
    uniform = physics.gravity_mode == "linear" and "gravity" in recorder.energies
    index = {key: number for number, key in enumerate(recorder.quantities)}
    broke = {(one.entity, one.kind): one.time for one in breaks_of(world.schedule.systems, world.time)}
    return {
        "start": recorder.start,
        "instants": recorder.count,
        "energies": recorder.energies,
        "quantities": recorder.words,
        "graphs": [
            {"across": None if across is None else index[across], "lines": [index[line] for line in lines]}
            for across, lines in recorder.graphs
        ],
        "bodies": recorder.bodies(world),
        "springs": parts.springs_of(world),
        "joints": [
            one | {"until": broke[one["entity"], one["kind"]] - recorder.start}
            if (one["entity"], one["kind"]) in broke
            else one
            for one in recorder.joints
        ],
        "fields": parts.fields_of(world),
        "thrusts": parts.thrusts_of(world),
        "texts": parts.notes_of(world),
        "gates": parts.gates_of(world, recorder.start),
        "space": physics.gravity_mode == "planet",
        "gravity": list(physics.gravity) if uniform else None,
        "bounds": None if physics.bounds is None else list(physics.bounds),
        "notes": notes,
        "view": (None if is_one_of_many else world.view) or extent_of_run(world, recorder),
        "data": pack(recorder.columns),
    }


def page_of(instants: Iterable[World], name: str) -> bytes:
    """Return the page that plays a world at one instant after another, in UTF-8; it has no accounts then.

    Nor has it forces that soft contacts have a share in, but at an instant to which a step has led.
    """
    recorder: RunRecorder | None = None
    for world in instants:
        recorder = recorder or RunRecorder(world)
        is_known = world.forces_known or (world.plan.collisions, world.plan.contacts) != ("step", "soft")
        recorder.write(world, measure_account(world).unknown, () if is_known else _OF_STEPS)
    assert recorder is not None
    return page(world, name, [run_document(world, recorder, [])])


def player_part(name: str) -> str:
    """Return a file of the player."""
    return files("physicslab.export").joinpath("player", name).read_text("utf-8")


def _json(document: Mapping[str, Any]) -> str:
    """Return a document in ASCII that no browser takes for the end of the script that holds it."""
    text = json.dumps(document, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c")
