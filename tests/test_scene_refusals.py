"""What no scene may hold: every refusal, and the one line that it gives."""

import json
import math
from pathlib import Path
from typing import Any

import esper
import pytest

from physicslab import SceneError, World, load_scene
from physicslab.components import Mass, Material, Shape, Spring, Trail, Transform, Velocity
from physicslab.ecs.component import COMPONENTS
from physicslab.files.scene import read_scene

BALL: dict[str, Any] = {"id": "ball", "Transform": {}, "Velocity": {}, "Mass": {}}


def scene(*entities: Any, **sections: Any) -> dict[str, Any]:
    """Return a scene document."""
    return {"format": "physicslab-scene/1", **sections, "entities": list(entities)}


def with_ball(**components: Any) -> dict[str, Any]:
    """Return a scene of the ball with other components."""
    return scene(BALL | components)


def refused(document: object, tmp_path: Path) -> str:
    """Return the line with which a document, or a text, is refused as a file, after the file's path."""
    path = tmp_path / "scene.json"
    path.write_text(document if isinstance(document, str) else json.dumps(document), "utf-8")
    active = World()  # it lives until the end: where that of another test is collected, none is active
    before = esper.current_world
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    assert esper.current_world == before == active.context, "a refused scene leaves the active world active"
    line = str(caught.value)
    assert "\n" not in line and len(line) < 400
    assert line.startswith(str(path))
    return line.removeprefix(str(path)).removeprefix(": ")


BALLS = [
    ({"Mass": {"mass": 0}}, "Mass.mass = 0: must be a finite number > 0 kg"),
    ({"Mass": {"mass": -1}}, "Mass.mass = -1: must be a finite number > 0 kg"),
    ({"Mass": {"mass": "1"}}, 'Mass.mass = "1": must be a finite number > 0 kg'),
    ({"Mass": {"mass": True}}, "Mass.mass = true: must be a finite number > 0 kg"),
    ({"Mass": {"mass": None}}, "Mass.mass = null: must be a finite number > 0 kg"),
    ({"Mass": {"mass": math.nan}}, "Mass.mass = NaN: must be a finite number > 0 kg"),
    ({"Mass": {"mass": -math.inf}}, "Mass.mass = -Infinity: must be a finite number > 0 kg"),
    ({"Mass": {"inertia": 0}}, "Mass.inertia = 0: must be a finite number > 0 kg m^2"),
    ({"Mass": {"fixed_rotation": 1}}, "Mass.fixed_rotation = 1: must be true or false"),
    ({"Mass": {"weight": 3}}, "Mass.weight = 3: unknown field; must be one of mass, inertia, fixed_rotation"),
    ({"Transform": {"position": [1]}}, "Transform.position = [1]: must be two finite numbers [x, y] m"),
    ({"Transform": {"position": 1}}, "Transform.position = 1: must be two finite numbers [x, y] m"),
    ({"Transform": {"position": ["0", 0]}}, 'Transform.position = ["0", 0]: must be two finite numbers'),
    ({"Transform": {"position": [0, math.nan]}}, "Transform.position = [0, NaN]: must be two finite numbers"),
    ({"Transform": [0, 1]}, 'Transform = [0, 1]: must be an object {"position": ..., "angle": ...}'),
    ({"Shape": {}}, 'Shape needs kind: one of "circle", "box"'),
    ({"Shape": {"kind": "oval"}}, 'Shape.kind = "oval": must be one of "circle", "box"'),
    ({"Shape": {"kind": "circle"}}, "Shape.radius = 0.0: must be a finite number > 0 m"),
    ({"Shape": {"kind": "circle", "radius": 0}}, "Shape.radius = 0.0: must be a finite number > 0 m"),
    ({"Shape": {"kind": "box", "width": 1}}, "Shape.height = 0.0: must be a finite number > 0 m"),
    ({"Shape": {"kind": "box", "width": -1}}, "Shape.width = -1: must be a finite number"),
    ({"Shape": {"kind": "circle", "radius": 1, "width": 1}}, "Shape.width = 1.0: must be left out"),
    ({"Material": {"restitution": 1.01}}, "Material.restitution = 1.01: must be a finite number from 0 to 1"),
    ({"Material": {"restitution": -0.1}}, "Material.restitution = -0.1: must be a finite number from 0 to 1"),
    ({"Material": {"friction": -1}}, "Material.friction = -1: must be a finite number >= 0"),
    ({"Spring": {"stiffness": -1}}, "Spring.stiffness = -1: must be a finite number >= 0 N/m"),
    ({"Spring": {"damping": -1}}, "Spring.damping = -1: must be a finite number >= 0 N s/m"),
    ({"Spring": {"rest_length": -1}}, "Spring.rest_length = -1: must be a finite number >= 0 m"),
    ({"Spring": {"b": "bll"}}, 'Spring.b = "bll": must be the id of an entity in this scene, or null'),
    ({"Spring": {"b": "bll"}}, '; did you mean "ball"?'),
    ({"Spring": {"a": 1}}, "Spring.a = 1: must be the id of an entity in this scene, or null"),
    ({"Trail": {"length": 0}}, "Trail.length = 0: must be a finite number > 0 s"),
    ({"Velocty": {}}, "Velocty = {}: unknown component; must be one of id,"),
    ({"Velocty": {}}, '; did you mean "Velocity"?'),
    ({"Held": {}}, "Held = {}: unknown component"),
    (
        {"Mass": {"fixed_rotation": True}, "Velocity": {"angular": 1}},
        "Velocity.angular = 1.0: must be 0 rad/s where Mass.fixed_rotation is true",
    ),
]


@pytest.mark.parametrize(("components", "line"), BALLS, ids=[line for _, line in BALLS])
def test_what_no_entity_may_hold_is_refused(components: dict[str, Any], line: str, tmp_path: Path) -> None:
    refusal = refused(with_ball(**components), tmp_path)
    assert refusal.startswith('entity "ball": ')
    assert line in refusal


ENTITIES = [
    ([{"Velocity": {}}], "entity 1: Velocity = {}: must have a Transform beside it"),
    ([{"Mass": {}}], "entity 1: Mass = {}: must have a Transform beside it"),
    ([{"Shape": {"kind": "circle", "radius": 1}}], "entity 1: Shape = {"),
    ([{"Material": {}}], "entity 1: Material = {}: must have a Transform beside it"),
    ([{"Trail": {}}], "entity 1: Trail = {}: must have a Transform beside it"),
    ([{"Thrust": {}}], "entity 1: Thrust = {}: must have a Transform beside it"),
    ([{"Charge": {}}], "entity 1: Charge = {}: must have a Transform beside it"),
    ([{"Molecule": {}}], "entity 1: Molecule = {}: must have a Transform beside it"),
    ([BALL | {"Pin": {"upper": 1e10}}], 'entity "ball": Pin.upper = 10000000000.0: must be a finite number'),
    (
        [{"Transform": {}, "Shape": {"kind": "chain", "vertices": [[0, 0], [1e-200, 0]]}}],
        "entity 1: Shape.vertices = [[0.0, 0.0], [1e-200, 0.0]]: must be vertices of which one is at least",
    ),
    (
        [{"id": "s", "Spring": {}}],
        'entity "s": Spring.a = null: must be the id of an entity with a Transform',
    ),
    (
        [{"id": "s"}, BALL | {"Spring": {"b": "s"}}],
        'entity "ball": Spring.b = "s": must be the id of an entity with a Transform',
    ),
    ([BALL, BALL], 'entity 2: id = "ball": must be an id of its own; entity 1 has this one'),
    ([{"id": ""}], 'entity 1: id = "": must be a text that is not empty'),
    ([{"id": 3}], "entity 1: id = 3: must be a text on one line"),
    ([{"id": "a\nb"}], 'entity 1: id = "a\\nb": must be a text on one line'),
    ([{"id": "\ud800"}], 'entity 1: id = "\\ud800": must be a text on one line'),
    ([[]], 'entity 1 = []: must be an object {"id": ...'),
]


@pytest.mark.parametrize(("entities", "line"), ENTITIES, ids=[line for _, line in ENTITIES])
def test_entities_that_make_no_sense_are_refused(entities: list[Any], line: str, tmp_path: Path) -> None:
    assert refused(scene(*entities), tmp_path).startswith(line)


SECTIONS = [
    ({"bodies": []}, "bodies = []: unknown key; must be one of format, name"),
    ({"entities": {}}, "entities = {}: must be a list of entities"),
    ({"format": "physicslab-scene/2"}, 'format = "physicslab-scene/2": must be "physicslab-scene/1"'),
    ({"name": 3}, "name = 3: must be a text"),
    ({"title": "a\nb"}, 'title = "a\\nb": must be a text on one line'),
    ({"time": -1}, "time = -1: must be a finite number >= 0 s"),
    ({"time": 1e13}, "time = 10000000000000.0: must be at most 4.69125e+12 s: a clock counts"),
    ({"time": "now"}, 'time = "now": must be a finite number >= 0 s'),
    ({"physics": []}, "physics = []: must be an object of settings"),
    ({"physics": {"gravty": 1}}, "physics.gravty = 1: unknown setting; must be one of gravity_mode, gravity"),
    ({"physics": {"gravity": 9.81}}, "physics.gravity = 9.81: must be two finite numbers"),
    ({"physics": {"gravity_mode": "up"}}, 'physics.gravity_mode = "up": must be one of "linear", "planet"'),
    ({"physics": {"softening": -1}}, "physics.softening = -1: must be a finite number >= 0"),
    ({"physics": {"linear_damping": -1}}, "physics.linear_damping = -1: must be a finite number >= 0"),
    ({"physics": {"bounds": [0, 0, 0, 1]}}, "physics.bounds = [0"),
    ({"physics": {"bounds": "wide"}}, 'physics.bounds = "wide": must be null or four'),
    (
        {"physics": {"bounds_restitution": 2}},
        "physics.bounds_restitution = 2: must be a finite number from 0",
    ),
    ({"simulation": {"dt": 0}}, "simulation.dt = 0: must be a finite number from 1e-100 to 1e+100"),
    ({"simulation": {"substeps": 0}}, "simulation.substeps = 0: must be a whole number"),
    ({"simulation": {"substeps": 1.5}}, "simulation.substeps = 1.5: must be a whole number"),
    ({"simulation": {"sleeping": "no"}}, 'simulation.sleeping = "no": must be "auto", true or false'),
    ({"simulation": {"collisions": "never"}}, 'simulation.collisions = "never": must be one of "auto"'),
    ({"simulation": {"integrator": "euler"}}, 'simulation.integrator = "euler": must be one of "auto"'),
    ({"contacts": {}}, "contacts = {}: must be a list of lists"),
    ({"contacts": [["ball", None]]}, 'contacts[0][0] = "ball": must be the id of an entity with a Shape'),
    ({"contacts": [[0, None]]}, "contacts[0][0] = 0: must be the id of an entity with a Shape"),
    ({"contacts": [[None]]}, "contacts[0] = [null]: must be a list of two ids"),
    ({"contacts": [[None, None, "1"]]}, 'contacts[0][2] = "1": must be a finite number'),
    ({"contacts": [[None, None, math.nan]]}, "contacts[0][2] = NaN: must be a finite number"),
    ({"contacts": [[None, None, 0]]}, "contacts: a contact has"),
    ({"rests": {}}, "rests = {}: must be a list of lists"),
    ({"rests": ["ball"]}, 'rests[0] = "ball": must be an id for a sleeper, which a force'),
    ({"rests": [["ball", 1.0]]}, 'rests[0] = ["ball", 1.0]: must be an id for a sleeper'),
    ({"rests": [["ball"]]}, 'rests[0][0] = "ball": must be the id of an entity with Velocity, Mass, Shape'),
    ({"rests": [[None]]}, "rests[0][0] = null: must be the id of an entity with Velocity, Mass, Shape"),
]


@pytest.mark.parametrize(("sections", "line"), SECTIONS, ids=[line for _, line in SECTIONS])
def test_sections_that_are_wrong_are_refused(sections: dict[str, Any], line: str, tmp_path: Path) -> None:
    assert refused(scene(BALL) | sections, tmp_path).startswith(line)


BODY = {"Transform": {}, "Velocity": {}, "Mass": {}, "Shape": {"kind": "circle", "radius": 1}, "id": "disc"}
RESTS = [
    ([["disc", 0, 0.1]], "rests[0][1] = 0: must be a finite number > 0 s"),
    ([["disc", math.inf, 0.1]], "rests[0][1] = Infinity: must be a finite number > 0 s"),
    ([["disc", 0.1, -1]], "rests[0][2] = -1: must be a finite number >= 0 m/s"),
    ([["disc"], ["disc", 0.1, 0.0]], 'rests[1][0] = "disc": must be an id that has no rest yet'),
]


@pytest.mark.parametrize(("rests", "line"), RESTS, ids=[line for _, line in RESTS])
def test_rests_that_make_no_sense_are_refused(rests: list[Any], line: str, tmp_path: Path) -> None:
    assert refused(scene(BODY) | {"rests": rests}, tmp_path).startswith(line)


TEXTS = [
    ("[]", '= []: must be an object {"format"'),
    ('{"entities": []}', 'format is missing: must be "physicslab-scene/1"'),
    ('{"format": "physicslab-scene/1"}', "entities is missing: must be a list of entities"),
    ("", "is not JSON: Expecting value at line 1, column 1"),
    ('{"format":\n }', "is not JSON: Expecting value at line 2, column 2"),
    (100_000 * "[", "is nested too deeply to be a scene"),
    ('{"format": "physicslab-scene/1", "entities": [], "entities": []}', 'the key "entities" is given twice'),
]


@pytest.mark.parametrize(("text", "line"), TEXTS, ids=[line for _, line in TEXTS])
def test_texts_that_are_no_scene_are_refused(text: str, line: str, tmp_path: Path) -> None:
    assert refused(text, tmp_path).strip().startswith(line)


@pytest.mark.parametrize(
    "digits", ["1e999", "1" + 400 * "0", "1" + 9_000 * "0"], ids=["1e999", "10^400", "10^9000"]
)
def test_numbers_too_large_for_any_float_are_refused(digits: str, tmp_path: Path) -> None:
    text = json.dumps(with_ball(Mass={"mass": 12345})).replace("12345", digits)
    assert refused(text, tmp_path) == 'entity "ball": Mass.mass = Infinity: must be a finite number > 0 kg'
    text = json.dumps(scene(simulation={"substeps": 12345})).replace("12345", digits)
    assert refused(text, tmp_path).startswith("simulation.substeps = Infinity: must be a whole number")


def test_a_key_given_twice_is_refused_where_it_stands(tmp_path: Path) -> None:
    text = json.dumps(with_ball(Mass={"mass": 1, "muss": 2})).replace("muss", "mass")
    assert refused(text, tmp_path) == 'entity "ball": Mass: the key "mass" is given twice; must be given once'
    text = json.dumps(with_ball(Mass={}, Muss={})).replace("Muss", "Mass")
    assert refused(text, tmp_path) == 'entity "ball": the key "Mass" is given twice; must be given once'
    text = json.dumps(scene(physics={"G": 1, "H": 1})).replace("H", "G")
    assert refused(text, tmp_path) == 'physics: the key "G" is given twice; must be given once'


def test_long_values_are_shortened(tmp_path: Path) -> None:
    line = refused(with_ball(Transform={"position": list(range(5000))}), tmp_path)
    assert "[0, 1, 2," in line and "...: must be two finite numbers" in line


def test_values_that_no_file_holds_are_refused_too() -> None:
    deep: list[Any] = []
    for _ in range(100_000):
        deep = [deep]
    for value in (10**5000, deep, object(), 1j):
        with pytest.raises(SceneError, match=r"Mass\.mass = .*: must be a finite number > 0 kg"):
            read_scene(with_ball(Mass={"mass": value}))


def test_every_field_of_every_component_refuses_a_wrong_type(tmp_path: Path) -> None:
    wrong = {"number": "1", "whole": 1.5, "vector": [1, 2, 3], "flag": 0, "entity": 1.5, "choice": "?"}
    wrong["points"] = [[1, 2], [3]]
    base: dict[str, Any] = {"Shape": {"kind": "circle", "radius": 1}}
    for kind in (Transform, Velocity, Mass, Shape, Material, Spring, Trail):
        name = kind.__name__
        for spec in COMPONENTS[name].FIELDS:
            value = wrong[spec.kind]
            line = refused(with_ball(**{name: base.get(name, {}) | {spec.name: value}}), tmp_path)
            assert line.startswith(f'entity "ball": {name}.{spec.name} = {json.dumps(value)}: must be ')


def test_every_setting_refuses_a_wrong_type(tmp_path: Path) -> None:
    world = World()
    for section, config in (("physics", world.physics), ("simulation", world.simulation)):
        for name in type(config).__dataclass_fields__:
            line = refused(scene(**{section: {name: {"": math.pi}}}), tmp_path)
            assert line.startswith(f'{section}.{name} = {{"": 3.14159')
