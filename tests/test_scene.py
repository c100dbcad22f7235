"""Scenes: what is read, from where, and what becomes of it."""

import json
import os
from pathlib import Path
from typing import Any

import pytest

from physicslab import SceneError, World, load_scene
from physicslab.components import Material, Shape, Spring, Velocity
from physicslab.ecs.component import InvalidValue, Vector, component, field
from physicslab.ecs.vector import Vector2
from physicslab.files.checks import JsonObject, shown
from physicslab.files.scene import read_scene
from physicslab.scenes import SCENES

CONTRACT = """
{"format": "physicslab-scene/1",
 "name": "drop", "title": "A ball on a floor", "description": "...",
 "physics": {"gravity_mode": "linear", "gravity": [0, -9.81],
             "G": 1.0, "softening": 0.0, "softening_law": "clamp",
             "linear_damping": 0.0, "angular_damping": 0.0,
             "bounds": null, "bounds_restitution": 0.5, "bounds_friction": 0.3},
 "simulation": {"dt": 0.016666666666666666, "substeps": 4, "iterations": null, "integrator": "auto",
                "sleeping": true, "collisions": "auto"},
 "entities": [
   {"id": "floor", "Transform": {"position": [0, -0.5]}, "Shape": {"kind": "box", "width": 20, "height": 1},
    "Material": {"restitution": 0.5, "friction": 0.6}},
   {"id": "ball", "Transform": {"position": [0, 5]}, "Velocity": {"linear": [1, 0]},
    "Mass": {"mass": 1}, "Shape": {"kind": "circle", "radius": 0.25}, "Material": {"restitution": 0.8}},
   {"id": "rope", "Spring": {"a": "ball", "anchor_b": [0, 6], "rest_length": 1, "stiffness": 50}}]}
"""


def scene(*entities: Any) -> dict[str, Any]:
    """Return a scene document."""
    return {"format": "physicslab-scene/1", "entities": list(entities)}


def test_the_scene_of_the_contract_is_read(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_text(CONTRACT)
    world = load_scene(str(path))
    assert (world.name, world.title, world.description) == ("drop", "A ball on a floor", "...")
    floor, ball, rope = world.entities()
    assert [world.label(entity) for entity in (floor, ball, rope)] == ["floor", "ball", "rope"]
    assert world.component(ball, Velocity).linear == Vector2(1.0, 0.0)
    assert world.component(ball, Shape).radius == 0.25
    assert world.component(ball, Material).friction == Material().friction
    assert not world.has(floor, Velocity)
    spring = world.component(rope, Spring)
    assert (spring.a, spring.b, spring.anchor_b) == (ball, None, Vector2(0.0, 6.0))
    assert world.physics.gravity == Vector2(0.0, -9.81)
    assert world.simulation.substeps == 4
    world.step()


def test_everything_but_format_and_entities_has_a_default() -> None:
    world, plain = read_scene(scene({"Transform": {}})), World()
    assert world.label(1) == "entity 1"
    assert (world.name, world.time) == ("", 0.0)
    assert (world.physics, world.simulation) == (plain.physics, plain.simulation)


def test_springs_may_name_entities_that_come_later_and_null_is_none() -> None:
    ball = {"id": "ball", "Transform": {}, "Velocity": {}, "Mass": {}}
    world = read_scene(scene({"Spring": {"a": "ball", "b": None}}, ball))
    assert (world.component(1, Spring).a, world.component(1, Spring).b) == (2, None)
    carried = read_scene(scene(ball | {"Spring": {}}))
    carried.step()
    assert carried.component(1, Spring).a is None


def test_a_contributors_component_is_read_and_checked_like_any_other() -> None:
    @component
    class Charge:
        charge: float = field(default=0.0, unit="C", minimum=-1.0, maximum=1.0)
        dipole: Vector = field(default=(0.0, 0.0), unit="C m")
        partner: int | None = field(default=None)

    values = {"charge": 0.5, "dipole": [1, 2], "partner": "ball"}
    world = read_scene(scene({"id": "x", "Transform": {}, "Charge": values}, {"id": "ball"}))
    charge = world.component(1, Charge)
    assert (charge.charge, charge.dipole, charge.partner) == (0.5, Vector2(1.0, 2.0), 2)
    wrong: list[tuple[dict[str, object], str]] = [
        ({"charge": 2}, r"Charge\.charge = 2: must be a finite number from -1 to 1 C"),
        ({"partner": "y"}, r'Charge\.partner = "y": must be the id of an entity in this scene'),
        ({"mass": 1}, r"Charge\.mass = 1: unknown field; must be one of charge, dipole, partner"),
    ]
    for refused, line in wrong:
        with pytest.raises(SceneError, match=f'^scene: entity "x": {line}'):
            read_scene(scene({"id": "x", "Charge": refused}))


def test_files_that_cannot_be_read_are_refused(tmp_path: Path) -> None:
    def line(path: str | Path) -> str:
        with pytest.raises(SceneError) as caught:
            load_scene(path)
        assert "\n" not in str(caught.value)
        return str(caught.value)

    assert line(tmp_path) == f"{tmp_path}: is a directory, not a scene file"
    missing = tmp_path / "pendulums" / "atwood.json"
    assert line(missing) == f"{missing}: no such file"
    missing.parent.mkdir()
    (missing.parent / "atwoods.json").touch()
    assert line(missing) == f'{missing}: no such file; did you mean "atwoods.json"?'
    assert line("drop.step") == 'drop.step: no such file; did you mean "drop"?'
    assert line("pyramide").endswith('did you mean "pyramid"?')
    assert f"the built-in scenes are {', '.join(SCENES)}" in line("qqqq")
    assert "no such file" in line(Path("drop")), "a Path is never a built-in name"
    assert "is no file name" in line("a\0b")
    assert "cannot be read: File name too long" in line(5000 * "a")
    latin = tmp_path / "latin.json"
    latin.write_bytes(b'{"format": "\xe9"}')
    assert line(latin) == f"{latin}: is not UTF-8: byte 12 cannot be read; must be JSON in UTF-8"
    if os.geteuid():
        latin.chmod(0)
        assert "cannot be read: Permission denied" in line(latin)


def test_a_byte_order_mark_is_no_hindrance(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_bytes(b"\xef\xbb\xbf" + json.dumps(scene({"id": "Größe"}), ensure_ascii=False).encode())
    assert load_scene(path).label(1) == "Größe"


def test_a_file_of_a_built_in_name_is_opened_by_its_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("drop").write_text(json.dumps(scene()))
    assert load_scene("drop").entities()
    assert not load_scene("./drop").entities()
    assert not load_scene(Path("drop")).entities()


def test_json_objects_record_a_key_given_twice() -> None:
    assert JsonObject.of([("a", 1), ("b", 2)]).repeated is None
    assert JsonObject.of([("a", 1), ("b", 2), ("b", 3)]).repeated == "b"


def test_values_are_shown_on_one_line_and_short() -> None:
    assert shown({"a": [True, None, "\x1b\u2028é"]}) == '{"a": [true, null, "\\u001b\\u2028é"]}'
    assert len(shown("x" * 1000)) == 60
    assert shown(10**5000) == "<int>"


def test_a_refused_value_of_any_size_can_be_named() -> None:
    with pytest.raises(InvalidValue, match=r"^Material\.friction = <int>: must be"):
        Material(friction=10**5000)


def test_an_entity_without_an_id_is_called_by_what_it_is_and_its_number() -> None:
    ball = {"Transform": {}, "Shape": {"kind": "circle", "radius": 1}}
    point: dict[str, Any] = {"Transform": {}, "Velocity": {}}
    named = {"id": "floor", "Transform": {}, "Shape": {"kind": "box", "width": 1, "height": 1}}
    world = read_scene(scene(ball, point, named, {"Spring": {"a": "floor"}}, {}))
    words = ["circle 1", "point 2", "floor", "spring 4", "entity 5"]
    assert [world.label(entity) for entity in world.entities()] == words
    assert world.label(99) == "entity 99"
