"""Graphs, meters and sliders in scene files: what is refused, and what is left out."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from desk import empty_world, sized
from plotting import graph_of

from physicslab.components import Graph, GraphLine, Meter, Transform
from physicslab.files.scene import SceneError, load_scene, save_scene
from physicslab.prefabs import circle
from physicslab.world import World


def scene_with(**entities: object) -> str:
    document = {
        "format": "physicslab-scene/1",
        "entities": [
            {"id": "ball", "Transform": {}},
            {"id": "plot", "Graph": {}},
            *({"id": name, **parts} for name, parts in entities.items()),  # type: ignore[dict-item]
        ],
    }
    return json.dumps(document)


WITH = "must be the id of an entity with a"
LINE: dict[str, object] = {"graph": "plot", "quantity": "x", "body": "ball"}
MASS: dict[str, object] = {"changes": "Mass.mass", "entity": "ball"}
REFUSED: list[tuple[str, dict[str, object], str]] = [
    ("GraphLine", LINE | {"quantity": "sped"}, '.quantity = "sped": must be one of "x"'),
    ("GraphLine", LINE | {"graph": "nothing"}, '.graph = "nothing": must be the id of an entity'),
    ("GraphLine", LINE | {"graph": "ball"}, f'.graph = "ball": {WITH} Graph'),
    ("GraphLine", LINE | {"graph": None}, ".graph = null: must be an entity with a Graph"),
    ("GraphLine", LINE | {"body": None}, '.quantity = "x": must be one of "momentum x"'),
    ("GraphLine", LINE | {"body": "plot"}, f'.body = "plot": {WITH} Transform'),
    ("GraphLine", {"graph": "plot"}, " needs quantity"),
    ("Graph", {"across": "sped"}, '.across = "sped": must be one of "time"'),
    ("Graph", {"across": "x"}, '.across = "x": must be "time", or one of'),
    ("Meter", {"quantity": "speed"}, '.quantity = "speed": must be one of'),
    ("Meter", {"quantity": "momentum", "corner": "middle"}, '.corner = "middle": must be one of "bottom'),
    ("Slider", {"changes": "gravity", "low": 3, "high": 2}, ".high = 2.0: must be a finite number > 3 m/s^2"),
    ("Slider", MASS | {"low": 1}, f'.entity = "ball": {WITH} Mass'),
    ("Slider", MASS, ".low = 0.0: must be a finite number > 0 kg, as Mass.mass is"),
    ("Slider", {"changes": "Mass.mass"}, ".entity = null: must be an entity with a Mass for Mass.mass"),
]


@pytest.mark.parametrize(("kind", "fields", "words"), REFUSED)
def test_a_bad_instrument_is_refused_in_one_line(
    kind: str, fields: dict[str, object], words: str, tmp_path: Path
) -> None:
    path = tmp_path / "bad.json"
    path.write_text(scene_with(one={kind: fields}), "utf-8")
    with pytest.raises(SceneError, match=re.escape(f'bad.json: entity "one": {kind}{words}')) as caught:
        load_scene(path)
    assert "\n" not in str(caught.value)


def test_what_refers_to_nothing_in_a_world_is_not_shown_and_not_saved(tmp_path: Path) -> None:
    world = empty_world()
    ball = circle(world, (0, 0), name="ball")
    graph = world.spawn(Graph())
    world.spawn(GraphLine(99, "x", ball))
    world.spawn(GraphLine(graph, "x", 77))
    world.spawn(Meter("speed", ball))
    desk = sized((1280, 720), world)
    desk.frames(5)
    assert [line.key for line in graph_of(desk).lines] == [(77, "x")]
    save_scene(world, tmp_path / "some.json")
    again: World = load_scene(tmp_path / "some.json")
    assert len(again.batch(Graph).entities) == len(again.batch(Meter).entities) == 1
    assert not len(again.batch(GraphLine).entities)


def test_instruments_change_no_motion() -> None:
    plain, measured = load_scene("newtons_cradle"), load_scene("newtons_cradle")
    measured.spawn(Graph())
    measured.spawn(Meter("total energy"))
    for world in (plain, measured):
        world.run(seconds=1.0)
    places = [world.table(Transform)["position"][world.batch(Transform).rows] for world in (plain, measured)]
    assert np.array_equal(places[0], places[1])
