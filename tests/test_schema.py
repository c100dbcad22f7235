"""The JSON Schema of scene files beside the checks of the program."""

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from physicslab import SceneError, cli, load_scene, save_scene
from physicslab.ecs.component import COMPONENTS
from physicslab.files.entities import UNSAVED
from physicslab.files.schema import scene_schema
from physicslab.scenes import SCENES

SCHEMA = scene_schema()
CHECK = jsonschema.Draft202012Validator(SCHEMA)


def document(scene: str, folder: Path, steps: int = 0) -> dict[str, Any]:
    """Return a scene as its file has it."""
    world = load_scene(scene)
    world.run(steps=steps)
    save_scene(world, folder / "scene.json")
    found: dict[str, Any] = json.loads((folder / "scene.json").read_text("utf-8"))
    return found


def test_it_is_a_schema_and_has_every_component(capsys: pytest.CaptureFixture[str]) -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    assert set(SCHEMA["$defs"]) == {"entity", *COMPONENTS} - {kind.__name__ for kind in UNSAVED}
    assert cli.main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out) == SCHEMA


@pytest.mark.parametrize("scene", SCENES)
def test_every_built_in_scene_is_valid(scene: str, tmp_path: Path) -> None:
    assert [error.message for error in CHECK.iter_errors(document(scene, tmp_path))] == []


@pytest.mark.parametrize("scene", ["stack", "car", "two_planets"])
def test_so_is_one_that_has_run(scene: str, tmp_path: Path) -> None:
    assert [error.message for error in CHECK.iter_errors(document(scene, tmp_path, steps=60))] == []


BALL = {"id": "ball", "Transform": {"position": [0, 1]}, "Velocity": {}, "Mass": {"mass": 1}}
WRONG: list[dict[str, Any]] = [
    {"format": "physicslab-scene/2"},
    {"entitties": []},
    {"entities": {}},
    {"title": 3},
    {"view": [0, 0, 1]},
    {"time": -1},
    {"physics": {"gravity": 9.81}},
    {"physics": {"gravity_mode": "up"}},
    {"physics": {"bounds": [0, 1]}},
    {"simulation": {"dt": 0}},
    {"simulation": {"substeps": 1.5}},
    {"simulation": {"sleeping": "never"}},
    {"desk": {"level": "Expert"}},
    *(
        {"entities": [BALL | wrong]}
        for wrong in list[dict[str, Any]](
            (
                {"Mass": {"mass": 0}},
                {"Mass": {"mass": "2 kg"}},
                {"Mass": {"mas": 1}},
                {"Mas": {}},
                {"Transform": {"position": [0]}},
                {"Transform": {"angle": "up"}},
                {"Shape": {"radius": 1}},
                {"Shape": {"kind": "star"}},
                {"Shape": {"kind": "circle", "radius": -1}},
                {"Material": {"restitution": 1.5}},
                {"Spring": {"a": 1}},
                {"Held": {}},
                {"id": 5},
            )
        )
    ),
]


@pytest.mark.parametrize("wrong", WRONG, ids=str)
def test_what_the_program_refuses_the_schema_refuses(wrong: dict[str, Any]) -> None:
    right = {"format": "physicslab-scene/1", "entities": [BALL]}
    assert CHECK.is_valid(right) and load_scene(right)
    with pytest.raises(SceneError):
        load_scene({**right, **wrong})
    assert not CHECK.is_valid({**right, **wrong})
