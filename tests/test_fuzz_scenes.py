"""Any scene document is refused in one line or runs with finite numbers.

A few examples are tried with every run of the tests; thousands by

    pytest -m fuzz --fuzz thorough tests/test_fuzz_*.py
"""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
from deadline import deadline
from hostile_scenes import scenes
from hypothesis import HealthCheck, example, given, settings

from physicslab.diagnostics.energy import Audit
from physicslab.diagnostics.run_report import RunRecord, find_not_finite, run_report
from physicslab.ecs.component import COMPONENTS, InvalidValue
from physicslab.files.json_text import json_text
from physicslab.files.scene import SceneError, read_scene, write_scene
from physicslab.state.masses import Diverged
from physicslab.world import World

STEPS = 3


def one_line(message: str) -> None:
    """Check that a message is one line that a person can read."""
    assert message and len(message.splitlines()) == 1 and len(message) < 1000, message


def check_numbers(world: World) -> None:
    """Check that every number of every component is finite."""
    for kind in COMPONENTS.values():
        table = world.table(kind)
        for spec in kind.FIELDS:
            assert np.isfinite(table[spec.name]).all(), (kind.__name__, spec.name)


def run_or_refuse(document: dict[str, Any]) -> str:
    """Read and run a scene; return what came of it."""
    try:
        world = read_scene(document)
    except SceneError as error:
        one_line(str(error))
        return "refused"
    try:
        record = RunRecord("fuzz", Audit(world))
        world.run(steps=STEPS)
    except (Diverged, InvalidValue) as error:
        one_line(str(error))
        return "stopped"
    check_numbers(world)
    assert math.isfinite(world.time)
    report = run_report(world, record)
    if find_not_finite(report) is None:
        json.loads(json_text(report), parse_constant=_refuse)
    json.loads(json_text(write_scene(world)), parse_constant=_refuse)
    return "ran"


def _refuse(word: str) -> None:
    raise AssertionError(f"{word} in JSON")


def tiny(shape: dict[str, Any]) -> dict[str, Any]:
    """Return a disc on a body of which a size is the smallest number there is."""
    disc = {"Transform": {}, "Velocity": {}, "Mass": {}, "Shape": {"kind": "circle", "radius": 1.0}}
    body = {"Transform": {}, "Mass": {}, "Drag": {}, "Shape": shape}
    return {"format": "physicslab-scene/1", "entities": [disc, body]}


def far_apart() -> dict[str, Any]:
    """Return two discs so far apart that a count of strips between them times their width overflowed."""
    disc = {"kind": "circle", "radius": 1.0}
    bodies: list[dict[str, Any]] = [
        {"id": "a", "Shape": disc, "Transform": {"position": [1e9, 1e300]}},
        {"id": "b", "Shape": disc, "Transform": {}, "Velocity": {}},
    ]
    return {"format": "physicslab-scene/1", "entities": bodies}


@settings(suppress_health_check=list(HealthCheck))
@given(scenes())
@example(tiny({"kind": "box", "width": 5e-324, "height": 1.0}))
@example(tiny({"kind": "circle", "radius": 5e-324}))
@example(far_apart())
def test_a_scene_is_refused_in_one_line_or_runs_with_finite_numbers(document: dict[str, Any]) -> None:
    with deadline(document):
        run_or_refuse(document)
