"""Numbers that are legal and absurd: each is refused by name, or runs on with finite numbers."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest
from deadline import deadline
from test_fuzz_scenes import run_or_refuse

from physicslab.cli import main
from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.ecs.component import COMPONENTS, InvalidValue
from physicslab.ensembles import ensemble
from physicslab.files.scene import SceneError, read_scene, scene_bytes
from physicslab.state.masses import Diverged
from physicslab.systems.spring import SpringSystem
from physicslab.world import World

BALL: dict[str, Any] = {
    "id": "ball",
    "Transform": {"position": [0.0, 2.0]},
    "Velocity": {"linear": [1.0, 0.0]},
    "Mass": {"mass": 1.0},
    "Shape": {"kind": "circle", "radius": 0.5},
    "Material": {"restitution": 0.5},
}
BOX: dict[str, Any] = BALL | {"id": "box", "Shape": {"kind": "box", "width": 1.0, "height": 1.0}}
FLOOR: dict[str, Any] = {
    "id": "floor",
    "Transform": {},
    "Shape": {"kind": "box", "width": 9.0, "height": 1.0},
}
ROPE: dict[str, Any] = {"Spring": {"a": "ball", "anchor_b": [0.0, 5.0]}}
PLANET: dict[str, Any] = BALL | {"id": "planet", "Transform": {"position": [9.0, 2.0]}}


def scene(*entities: dict[str, Any], **sections: Any) -> dict[str, Any]:
    """Return a scene document that nothing else shares."""
    return copy.deepcopy({"format": "physicslab-scene/1", "entities": list(entities), **sections})


def changed(entity: dict[str, Any], **components: dict[str, Any]) -> dict[str, Any]:
    return entity | {name: entity.get(name, {}) | values for name, values in components.items()}


EXTREMES = {
    "a denormal dt": scene(BALL, FLOOR, simulation={"dt": 5e-324}),
    "a denormal dt of springs": scene(BALL, ROPE, simulation={"dt": 5e-324}),
    "a long dt": scene(BALL, FLOOR, simulation={"dt": 1e308}),
    "many substeps": scene(BALL, FLOOR, simulation={"substeps": 10_000}),
    "a huge box": scene(changed(BOX, Shape={"width": 1e300}), FLOOR),
    "a huge box alone": scene(changed(BOX, Shape={"width": 1e300, "height": 1e300})),
    "a tiny box": scene(changed(BOX, Shape={"width": 1e-300, "height": 1e-300}), FLOOR),
    "a thin box": scene(changed(BOX, Shape={"width": 1e-300, "height": 1e300}), FLOOR),
    "a denormal radius": scene(changed(BALL, Shape={"radius": 1e-320}), FLOOR),
    "a radius of a denormal inertia": scene(changed(BALL, Shape={"radius": 1e-160}), FLOOR),
    "a huge radius": scene(changed(BALL, Shape={"radius": 1e308}), FLOOR),
    "a huge mass": scene(changed(BALL, Mass={"mass": 1.7e308}), FLOOR),
    "a huge spinning mass": scene(changed(BOX, Mass={"mass": 1.7e308}, Velocity={"angular": 1.0})),
    "a tiny mass": scene(changed(BALL, Mass={"mass": 1e-300}), FLOOR),
    "a tiny mass on a spring": scene(changed(BALL, Mass={"mass": 1e-300, "inertia": 1e-300}), ROPE),
    "huge bounds": scene(BALL, physics={"bounds": [-1e308, -1e308, 1e308, 1e308]}),
    "narrow bounds": scene(BALL, physics={"bounds": [0, 0, 5e-324, 5e-324]}),
    "a stiff spring": scene(BALL, changed(ROPE, Spring={"stiffness": 1e308})),
    "a damped spring": scene(BALL, changed(ROPE, Spring={"damping": 1e308})),
    "a long spring": scene(BALL, changed(ROPE, Spring={"rest_length": 1e308})),
    "a far anchor": scene(BALL, changed(ROPE, Spring={"anchor_a": [1e308, 1e308]})),
    "a stiff spring beside contacts": scene(BALL, FLOOR, changed(ROPE, Spring={"stiffness": 1e308})),
    "a fast body": scene(changed(BALL, Velocity={"linear": [1e308, 1e308]}), FLOOR),
    "a fast box": scene(changed(BOX, Velocity={"linear": [1e308, 1e308], "angular": 1e308}), FLOOR),
    "a fast body alone": scene(changed(BALL, Velocity={"linear": [1e308, 1e308]})),
    "a fast body with drag": scene(changed(BALL, Velocity={"linear": [1e308, 0]}, Drag={"quadratic": 1.0})),
    "a body far out": scene(changed(BALL, Transform={"position": [1e308, 1e308]}), FLOOR),
    "a large angle": scene(changed(BOX, Transform={"angle": 1e308}), FLOOR),
    "gravity": scene(BALL, FLOOR, physics={"gravity": [0, -1e308]}),
    "gravity alone": scene(BALL, physics={"gravity": [1e308, -1e308]}),
    "attraction": scene(BALL, PLANET, physics={"gravity_mode": "planet", "G": 1e308}),
    "attraction apart": scene(BALL, PLANET, physics={"gravity_mode": "planet", "G": -1e308}),
    "softening": scene(BALL, PLANET, physics={"gravity_mode": "planet", "softening": 1e308}),
    "planets on one spot": scene(BALL, BALL | {"id": "second"}, physics={"gravity_mode": "planet"}),
    "damping": scene(BALL, FLOOR, physics={"linear_damping": 1e308, "angular_damping": 1e308}),
    "a negative zero": scene(changed(BALL, Material={"restitution": -0.0, "friction": -0.0}), FLOOR),
    "much friction": scene(changed(BALL, Material={"friction": 1e308}), FLOOR),
    "the end of time": scene(BALL, FLOOR, time=1.7e308),
}


@pytest.mark.parametrize("name", EXTREMES)
def test_an_extreme_number_is_refused_or_runs_with_finite_numbers(name: str) -> None:
    with deadline(name):
        run_or_refuse(EXTREMES[name])


def test_what_is_absurd_is_saved_without_a_warning_of_numpy() -> None:
    world = read_scene(scene(changed(BALL, Drag={"quadratic": 1e308}), FLOOR))
    world.synchronise()
    assert b"1e+308" in scene_bytes(world, "absurd")


HEAVY = {"Mass": {"mass": 1e200}}
TOO_LARGE = [
    (changed(BOX, Shape={"width": 1e60}, **HEAVY), "Shape.width = 1e+60: must be smaller: the moment of"),
    (changed(BALL, Shape={"radius": 1e80}, **HEAVY), "Shape.radius = 1e+80: must be smaller"),
    (
        changed(BOX, Shape={"height": 1e308}),
        "Shape.height = 1e+308: must be a finite number >= 0 m, at most 1e+150",
    ),
]


@pytest.mark.parametrize(("entity", "line"), TOO_LARGE)
def test_a_body_too_large_to_have_an_inertia_is_refused_by_its_size(
    entity: dict[str, Any], line: str
) -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(scene(entity), "far.json")
    assert str(caught.value).startswith(f'far.json: entity "{entity["id"]}": {line}')


def test_a_mass_that_grows_until_no_inertia_is_finite_is_refused_by_name() -> None:
    world = read_scene(scene(changed(BOX, Shape={"width": 1e60})))
    world.component(world.entity("box"), Mass).mass = 1e200
    with pytest.raises(InvalidValue, match=r"box: Mass\.inertia = inf: must be a finite number"):
        world.step()


FAR = [
    (
        "Transform",
        "position",
        [1.7976931348623157e308, 0.25],
        "two finite numbers [x, y] m, at most 1e+300 each",
    ),
    ("Spring", "anchor_b", [0.0, -1e308], "two finite numbers [x, y] m, at most 1e+150 each"),
    ("Spring", "rest_length", 1e308, "a finite number >= 0 m, at most 1e+150"),
]


@pytest.mark.parametrize(("component", "field", "value", "allowed"), FAR)
def test_a_place_that_the_engine_cannot_hold_is_refused(
    component: str, field: str, value: Any, allowed: str
) -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(scene(changed(BALL, **{component: {field: value}})))
    assert f"{component}.{field} = " in str(caught.value) and str(caught.value).endswith(
        f": must be {allowed}"
    )
    world = read_scene(scene(changed(BALL, **{component: {}})))
    handle = world.component(world.entity("ball"), COMPONENTS[component])
    with pytest.raises(InvalidValue, match=f"{component}.{field} = "):
        setattr(handle, field, value)


def test_walls_that_the_engine_cannot_hold_are_refused() -> None:
    with pytest.raises(SceneError, match=r"physics\.bounds = .*must be null or four .* at most 1e\+300"):
        read_scene(scene(BALL, physics={"bounds": [-1e308, -1.0, 1e308, 1.0]}))


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("title", "\u200b\u200d"), ("title", "\u0301"), ("title", " "), ("title", "x" * 5_000),
        ("name", "\u2060"), ("name", "x" * 10**6),
    ],
)  # fmt: skip
def test_a_title_that_no_window_can_show_is_refused(key: str, value: str) -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(scene(BALL, **{key: value}))
    line = str(caught.value)
    assert line.startswith(f"scene: {key} = ") and ": must be a text " in line and len(line) < 200
    read_scene(scene(BALL, **{key: "x" * 200}))


def test_a_body_too_small_to_have_an_inertia_does_not_turn() -> None:
    world = read_scene(scene(changed(BALL, Shape={"radius": 1e-160})))
    world.step()
    assert not world.bodies.inverse_inertia.any()


@pytest.mark.parametrize(
    ("document", "line"),
    [
        (EXTREMES["a fast body"], r"ball: Transform .* at t = "),
        (EXTREMES["gravity alone"], r"ball: (Transform|Velocity) .* at t = "),
    ],
)
def test_what_leaves_the_numbers_is_named_with_its_time(document: dict[str, Any], line: str) -> None:
    world = read_scene(document)
    with pytest.raises(Diverged, match=line):
        world.run(steps=200)


@pytest.mark.parametrize("id_", ["x" * 10**6, "a\nb", "a\x1b[2Jb", "\u2028", "\ud800", "", " ", "\u200b"])
def test_an_id_that_would_not_stand_in_a_line_is_refused_in_one(id_: str) -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(scene(BALL | {"id": id_}))
    with pytest.raises(InvalidValue) as refused:
        World().spawn(name=id_)
    for error in (caught, refused):
        line = str(error.value)
        assert line.isprintable() and len(line) < 200 and ": must be a text " in line


def test_an_id_given_twice_is_refused_in_one_printable_line() -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(scene(BALL | {"id": "\u202eb" * 60}, BALL | {"id": "\u202eb" * 60}))
    assert str(caught.value).isprintable() and len(str(caught.value)) < 300


@pytest.mark.parametrize("ends", [(1, 1), (None, 1)])
def test_a_spring_needs_two_ends(ends: tuple[int | None, int]) -> None:
    world = World(SpringSystem())
    body = world.spawn(Transform(), Velocity())
    with pytest.raises(InvalidValue, match=r"Spring\.b = 1: must be another entity than a"):
        if ends[0] is None:
            world.add(body, Spring(None, body))
        else:
            world.spawn(Spring(*ends))
    with pytest.raises(InvalidValue, match=r"Spring\.b = 2: must be another entity than a"):
        world.spawn(Transform(), Velocity(), Spring(b=world.next_entity))
    assert len(world.entities()) == 1
    for entity in (ROPE, BALL | ROPE):
        spring = changed(entity, Spring={"b": "ball"})
        entities = [spring] if "id" in entity else [BALL, spring]
        with pytest.raises(SceneError, match=r'Spring\.b = "ball": must be another entity than a'):
            read_scene(scene(*entities))


@pytest.mark.parametrize("steps", [10**400, 2**62, -1, 1.5, True, "1"])
def test_steps_that_cannot_be_counted_are_refused(steps: Any) -> None:
    with pytest.raises(ValueError, match=r"run\.steps = .*: must be a whole number from 0 to"):
        World().run(steps=steps)


@pytest.mark.parametrize("seconds", [10**400, float("inf"), float("nan"), -1, "one", "1 m", True])
def test_a_time_that_is_none_is_refused(seconds: Any) -> None:
    with pytest.raises(ValueError, match=r"run\.seconds = .*: must be a finite number >= 0 s"):
        World().run(seconds=seconds)
    with pytest.raises(ValueError, match=r"step\.dt = .*: must be a finite number from 1e-100 to 1e\+100 s"):
        World().step(seconds)


def test_a_run_of_more_steps_than_can_be_counted_is_refused() -> None:
    with pytest.raises(ValueError, match=r"run\.seconds = 1e\+308: must be less than 2\*\*53 steps"):
        World().run(seconds=1e308)


@pytest.mark.parametrize("stride", [0, -1, 1.5, True, "1", 10**400, None])
def test_a_stride_that_never_ends_is_refused(stride: Any) -> None:
    with pytest.raises(InvalidValue, match=r"stepping\.stride = .*: must be a whole number >= 1"):
        next(World().stepping(steps=3, stride=stride))


@pytest.mark.parametrize("command", [["run"], ["accuracy"], ["bench"], []])
def test_every_command_refuses_what_its_world_refuses_in_one_line(
    command: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "far.json"
    path.write_text(json.dumps(scene(changed(BOX, Shape={"height": 1e308}))))
    assert main([*command, str(path)]) == 2
    said = capsys.readouterr()
    line = 'far.json: entity "box": Shape.height = 1e+308: must be a finite number >= 0 m, at most 1e+150'
    assert said.out == "" and said.err.endswith(f"{line}\n") and said.err.count("\n") == 1


def test_what_only_a_world_can_refuse_is_one_line_too(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(world: World) -> None:
        raise InvalidValue("box: Mass", "inertia", float("inf"), "a finite number")

    monkeypatch.setattr(World, "synchronise", refuse)
    for command in ("run", "accuracy", "bench"):
        assert main([command, "drop"]) == 2
        said = capsys.readouterr().err
        assert "box: Mass.inertia = inf: must be a finite number" in said and said.count("\n") == 1


def test_the_deviation_of_huge_numbers_is_a_number() -> None:
    """Their squares are not."""
    rows = {"ball.Transform.position.y": [0.0, 1e300]}
    result = ensemble(scene(BALL), rows, measure={"y": "ball.y"}, steps=1, executor="serial")
    assert result.spread()["y"]["deviation"] == pytest.approx(1e300 / 2**0.5)


def test_where_nothing_is_trust_says_so_and_no_more(tmp_path: Path, capsys: Any) -> None:
    path = tmp_path / "empty.json"
    path.write_text(json.dumps(scene()))
    assert main(["run", str(path), "--steps", "2", "--trust", "--json", "-"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["islands_reason"] == "at most one body moves"
    assert found["stepper"]["reason"] == "nothing moves the bodies"
