"""``run --set``: fields set before a run, as an edited file would have them, or refused in one line."""

import csv
import io
import json
from pathlib import Path
from typing import Any

import pytest

from physicslab import cli, load_scene, save_scene
from physicslab.components import Mass, Shape, Spring, Transform, Velocity
from physicslab.ecs.component import Component, component, field
from physicslab.files.assignments import assign
from physicslab.files.checks import SceneError
from physicslab.world import World

BALL = 'entity "ball": '


def report(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    """Run a scene; return the document of the run."""
    assert cli.main(["run", *arguments, "--json", "-"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    read: dict[str, Any] = json.loads(out)
    return read


def refusal(world: World, *texts: str) -> str:
    with pytest.raises(SceneError) as error:
        assign(world, texts)
    assert "\n" not in str(error.value)
    return str(error.value).removeprefix("--set")


def edited(path: Path, name: str, **components: dict[str, Any]) -> None:
    """Change fields of an entity in a scene file."""
    document = json.loads(path.read_text())
    entity = next(entity for entity in document["entities"] if entity.get("id") == name)
    for kind, values in components.items():
        entity.setdefault(kind, {}).update(values)
    path.write_text(json.dumps(document))


def test_a_run_goes_as_that_of_a_file_with_these_fields(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "drop.json"
    save_scene(load_scene("drop"), path)
    edited(path, "ball", Mass={"mass": 0.25}, Velocity={"linear": [2.0, -0.5]}, Material={"restitution": 0.5})
    by_hand = report(capsys, str(path), "--seconds", "3")
    by_option = report(
        capsys, "drop", "--seconds", "3", "--set", "ball.Mass.mass=250 g",
        "--set", "ball.Velocity.linear=[2, -50 cm/s]", "--set", "ball.Material.restitution=50 %",
    )  # fmt: skip
    assert by_option["entities"] == by_hand["entities"]
    assert by_option["energy"] == by_hand["energy"]
    assert by_option["entities"] != report(capsys, "drop", "--seconds", "3")["entities"]


@pytest.mark.parametrize(
    ("text", "kind", "name", "value"),
    [
        ("ball.Mass.mass=2 kg", Mass, "mass", 2.0),
        ("ball.Mass.mass = 3e3 g", Mass, "mass", 3.0),
        ("ball.Mass.inertia=0.5", Mass, "inertia", 0.5),
        ("ball.Mass.fixed_rotation=true", Mass, "fixed_rotation", True),
        ("ball.Transform.angle=180 deg", Transform, "angle", 3.141592653589793),
        ("ball.Transform.position=[1, 2]", Transform, "position", (1.0, 2.0)),
        ("ball.Velocity.linear=[3.6, -7.2] km/h", Velocity, "linear", (1.0, -2.0)),
        ("ball.Velocity.linear=[36 km/h, 1]", Velocity, "linear", (10.0, 1.0)),
        ("ball.Velocity.angular=60 rpm", Velocity, "angular", 6.283185307179586),
        ("ball.Shape.radius=10 cm", Shape, "radius", 0.1),
    ],
)
def test_what_values_may_be(text: str, kind: type[Component], name: str, value: object) -> None:
    world = load_scene("drop")
    assign(world, [text])
    found = getattr(world.component(world.entity("ball"), kind), name)
    assert (tuple(found) if isinstance(value, tuple) else found) == value


def test_a_part_of_a_vector_is_set_and_the_other_stays() -> None:
    world = load_scene("drop")
    assign(world, ["ball.Velocity.linear.y = 9 km/h", "physics.gravity.x=1", "physics.gravity.y=-2"])
    assert tuple(world.component("ball", Velocity).linear) == (1.0, 2.5)
    assert tuple(world.physics.gravity) == (1.0, -2.0)
    assign(world, ["ball.Velocity.linear=[3, 4]", "ball.Velocity.linear.x=5"])
    assert tuple(world.component("ball", Velocity).linear) == (5.0, 4.0)
    must = "must be linear.x or linear.y"
    assert refusal(world, "ball.Velocity.linear.z=1") == f': {BALL}Velocity.linear.z = "1": {must}'
    must = 'physics.gravity.z = "1": must be gravity.x or gravity.y'
    assert refusal(world, "physics.gravity.z=1") == f": {must}"
    must = "must be a number, or a part of a vector"
    assert refusal(world, "ball.Mass.mass.x=1") == f': {BALL}Mass.mass.x = "1": {must}'
    why = "'1 kg' is in kg; this is in m/s; must be a finite number m/s"
    line = f': {BALL}Velocity.linear.x = "1 kg": {why}'
    assert refusal(world, "ball.Velocity.linear.x=1 kg") == line
    must = "unknown field; must be one of linear, angular"
    assert refusal(world, "ball.Velocity.x=3") == f': {BALL}Velocity.x = "3": {must}'
    assert refusal(world, "ball.x=3") == ' "ball.x=3": must be ID.Component.field=VALUE'


def test_the_walls_of_the_world_are_set_as_in_a_file() -> None:
    world = load_scene("gas")
    for text, bounds in (
        ("[-1, 0, 2*3, 40 dm]", (-1.0, 0.0, 6.0, 4.0)),
        ("[-300, 0, 300, 100] cm", (-3.0, 0.0, 3.0, 1.0)),
        ("null", None),
    ):
        assign(world, [f"physics.bounds={text}"])
        assert world.physics.bounds == bounds
    allowed = (
        "must be null or four finite numbers [xmin, ymin, xmax, ymax] m with xmin < xmax and ymin < ymax"
    )
    for bad in ("[1, 0, 0, 1]", "[0, 0, 1]", "[0, 0, 1, 1e999]", "[0, 0, 1, 2 kg]", "wide", ""):
        line = refusal(world, f"physics.bounds={bad}")
        assert line.startswith(f': physics.bounds = "{bad}": ') and allowed in line


def test_fields_of_one_component_are_checked_together_and_the_later_of_two_holds() -> None:
    world = load_scene("drop")
    box = ["ball.Shape.kind=box", "ball.Shape.radius=0", "ball.Shape.width=9", "ball.Shape.height=1"]
    assign(world, [*box, "ball.Shape.width=2"])
    shape = world.component(world.entity("ball"), Shape)
    assert (shape.kind, shape.width, shape.height, shape.radius) == ("box", 2.0, 1.0, 0.0)


def test_a_derived_field_is_given_and_left_to_the_shape_again() -> None:
    world = load_scene("drop")
    ball = world.entity("ball")
    before = world.component(ball, Mass)
    world.synchronise()
    derived = before.inertia
    assign(world, ["ball.Mass.inertia=7"])
    world.synchronise()
    assert world.component(ball, Mass).inertia == 7.0
    assign(world, ["ball.Mass.inertia=null", "ball.Mass.mass=2"])
    world.synchronise()
    assert world.component(ball, Mass).inertia == pytest.approx(2.0 * derived, rel=1e-15)


def test_the_end_of_a_spring_is_another_entity_or_none() -> None:
    world = World()
    for name in ("left", "right", "third"):
        world.spawn(Transform(), Velocity(), Mass(), name=name)
    rope = world.spawn(Spring(a=world.entity("left"), b=world.entity("right")), name="rope")
    assign(world, ["rope.Spring.b=third"])
    assert world.component(rope, Spring).b == world.entity("third")
    assign(world, ["rope.Spring.b=null"])
    assert world.component(rope, Spring).b is None
    assert refusal(world, "rope.Spring.b=thrid").startswith(
        ': entity "rope": Spring.b = "thrid": there is no such entity; must be one of left, right, '
        'third, rope; did you mean "third"?'
    )


def test_choices_whole_numbers_and_flags_of_a_component_of_ones_own() -> None:
    @component
    class Valve(Component):
        mode: str = field(choices=("open", "shut"), default="open", meaning="how it stands")
        turns: int = field(default=1, minimum=0, meaning="turns of the wheel")
        locked: bool = field(default=False, meaning="whether it stays so")

    world = World()
    valve = world.spawn(Valve(), name="v")
    assign(world, ["v.Valve.mode=shut", "v.Valve.turns=1e1", "v.Valve.locked=true"])
    found = world.component(valve, Valve)
    assert (found.mode, found.turns, found.locked) == ("shut", 10, True)
    assert 'Valve.mode = "ajar": must be one of "open", "shut"' in refusal(world, "v.Valve.mode=ajar")
    assert 'Valve.turns = "1.5": must be a whole number >= 0' in refusal(world, "v.Valve.turns=1.5")
    assert 'Valve.locked = "yes": must be true or false' in refusal(world, "v.Valve.locked=yes")


def test_ids_have_dots_and_equals_signs_and_entities_without_one_have_numbers() -> None:
    world = load_scene("bounces")
    assign(world, ["e = 0.5.Mass.mass=4"])
    assert world.component(world.entity("e = 0.5"), Mass).mass == 4.0
    nameless = world.spawn(Transform(), Velocity(), Mass())
    assign(world, [f"{world.label(nameless)}.Mass.mass=5"])
    assert world.component(nameless, Mass).mass == 5.0


def test_a_sleeping_body_that_gets_a_velocity_moves(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    world = load_scene("pyramid")
    world.run(seconds=6.0)
    assert world.sleep.count == 465
    top = max(world.entities(), key=lambda entity: world.component(entity, Transform).position.y)
    path = tmp_path / "asleep.json"
    save_scene(world, path)
    lifted = report(
        capsys, str(path), "--steps", "6", "--set", f"{world.label(top)}.Velocity.linear=[0, 5]"
    )["entities"][world.label(top)]  # fmt: skip
    assert lifted["position"][1] > world.component(top, Transform).position.y + 0.3


REFUSED = [
    (
        "bal.Mass.mass=1",
        ': entity "bal": Mass.mass = "1": there is no such entity; must be one of floor, ball; '
        'did you mean "ball"?',
    ),
    (
        "ball.Mas.mass=1",
        f': {BALL}Mas.mass = "1": unknown component Mas; must be one of Transform, Shape, Material, '
        'Velocity, Mass; did you mean "Mass"?',
    ),
    (
        "ball.Drag.linear=1",
        f': {BALL}Drag.linear = "1": the entity has no Drag; must be one of Transform, Shape, Material, '
        "Velocity, Mass",
    ),
    (
        "ball.Mass.mas=1",
        f': {BALL}Mass.mas = "1": unknown field; must be one of mass, inertia, fixed_rotation; '
        'did you mean "mass"?',
    ),
    ("ball.Mass.mass=-1 g", f': {BALL}Mass.mass = "-1 g": must be a finite number > 0 kg'),
    (
        "ball.Mass.mass=3 m",
        f": {BALL}Mass.mass = \"3 m\": '3 m' is in m; this is in kg; must be a finite number > 0 kg",
    ),
    ("ball.Mass.mass=heavy", "'heavy' is no unit that is known"),
    ("ball.Mass.mass=", f': {BALL}Mass.mass = "": a number is needed; must be a finite number > 0 kg'),
    ("ball.Mass.mass=1e999", "is not finite; must be a finite number"),
    ("ball.Mass.mass=null", "must be a finite number > 0 kg"),
    ("ball.Material.restitution=120 %", 'restitution = "120 %": must be a finite number from 0 to 1'),
    ("ball.Velocity.linear=3", "linear = \"3\": '3' is no pair; must be two finite numbers [x, y] m/s"),
    ("ball.Velocity.linear=[1, 2, 3]", "is no pair; must be two finite numbers [x, y] m/s"),
    ("ball.Velocity.linear=[1, 2 kg]", "'2 kg' is in kg; this is in m/s; must be two finite numbers"),
    ("ball.Shape.kind=bx", f': {BALL}Shape.kind = "bx": must be one of "circle", "box"'),
    ("ball.Shape.kind=box", f': {BALL}Shape.kind = "box": with it radius = 0.25 must be left out: a box has'
    ),
    ("ball.Name.id=egg", "unknown component Name"),
    ("ball.Mass=3", ' "ball.Mass=3": must be ID.Component.field=VALUE'),
    ("3", ' "3": must be ID.Component.field=VALUE'),
    ("", ' "": must be ID.Component.field=VALUE'),
    ("..=", ' "..=": must be ID.Component.field=VALUE'),
    ("a\nb.Mass.mass=1", 'entity "a\\nb": Mass.mass'),
    ("ball.Mass.mass=" + "9" * 5000, "is too long"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "line"), REFUSED, ids=[ascii(text)[:40] for text, _ in REFUSED])
def test_what_cannot_be_set_is_refused_by_name(text: str, line: str) -> None:
    world = load_scene("drop")
    assert line in refusal(world, text)
    assert world.component(world.entity("ball"), Mass).mass == 1.0


def test_the_command_refuses_in_one_line_and_writes_nothing(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    table = tmp_path / "rows.csv"
    line = ["run", "drop", "--csv", str(table), "--set", "ball.Mass.mass=0"]
    assert cli.main(line) == 2
    out, err = capsys.readouterr()
    assert out == "" and not table.exists()
    assert err == f'physicslab: --set: {BALL}Mass.mass = "0": must be a finite number > 0 kg\n'


def test_what_no_scene_may_be_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    settings = ["--set", "ball.Velocity.angular=1", "--set", "ball.Mass.fixed_rotation=true"]
    assert cli.main(["run", "drop", *settings]) == 2
    line = f'--set: {BALL}Velocity.angular = "1": must be 0.0 beside the entity\'s other fields'
    assert capsys.readouterr().err == f"physicslab: {line}\n"


# ---- the table ---------------------------------------------------------------------------------------------


def rows(capsys: pytest.CaptureFixture[str], *arguments: str) -> list[dict[str, str]]:
    assert cli.main(["run", *arguments, "--csv", "-"]) == 0
    return list(csv.DictReader(io.StringIO(capsys.readouterr().out)))


def test_the_table_has_the_energies_and_momenta_of_the_run(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    document = tmp_path / "run.json"
    last = rows(capsys, "resonance", "--seconds", "1.3", "--json", str(document))[-1]
    told = json.loads(document.read_text())
    names = ("kinetic_linear", "kinetic_angular", "potential_gravity", "potential_spring")
    for name in names:
        assert float(last[f"{name.replace('_', ' ')} [J]"]) == told["energy"][name]
    assert float(last["energy [J]"]) == told["energy"]["final"]
    assert float(last["potential spring [J]"]) != 0.0
    assert [float(last[name]) for name in ("px [kg m/s]", "py [kg m/s]")] == told["momentum"]
    assert float(last["angular momentum [kg m^2/s]"]) == told["angular_momentum"]


def test_every_spaces_the_rows_and_changes_no_bit(capsys: pytest.CaptureFixture[str]) -> None:
    dense = rows(capsys, "drop", "--seconds", "1.29")
    spaced = rows(capsys, "drop", "--seconds", "1.29", "--every", "0.25")
    times = [float(row["time [s]"]) for row in spaced if row["entity"] == "ball"]
    assert times == [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.29]
    assert [row for row in dense if float(row["time [s]"]) in times] == spaced


def test_every_that_is_no_multiple_of_a_step_takes_the_step_after_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    spaced = rows(capsys, "drop", "--steps", "12", "--every", "0.06")  # 3.6 steps
    times = [float(row["time [s]"]) for row in spaced if row["entity"] == "ball"]
    assert times == pytest.approx([0.0, 4 / 60, 8 / 60, 11 / 60, 12 / 60], abs=1e-12)


@pytest.mark.parametrize("every", ["1", "1e300", "1e308"])
def test_every_longer_than_the_run_keeps_its_ends(every: str, capsys: pytest.CaptureFixture[str]) -> None:
    spaced = rows(capsys, "drop", "--steps", "4", "--every", every)
    assert sorted({float(row["time [s]"]) for row in spaced}) == [0.0, 4 / 60]


def test_every_shorter_than_a_step_takes_every_step(capsys: pytest.CaptureFixture[str]) -> None:
    assert rows(capsys, "drop", "--steps", "5", "--every", "1e-9") == rows(capsys, "drop", "--steps", "5")


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["--every", "1"], "--every: must go with --csv, whose rows it spaces"),
        (["--csv-for", "excel"], "--csv-for: must go with --csv or --ledger, whose rows it is about"),
        (["--csv", "-", "--every", "0"], "argument --every: '0': must be a finite number > 0 s"),
        (["--csv", "-", "--every", "nan"], "argument --every: 'nan': must be a finite number > 0 s"),
    ],
)
def test_a_bad_spacing_is_refused(
    arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["run", "drop", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1 and line in err


def test_laws_and_how_they_are_stepped_are_set_like_fields() -> None:
    world = load_scene("drop")
    assign(world, ["physics.gravity=[0, -1.62]", "simulation.substeps=2*4", "physics.linear_damping=1/(2 s)"])
    assert world.physics.gravity.y == -1.62 and world.simulation.substeps == 8
    assert world.physics.linear_damping == 0.5
    assert 'physics.softening = "-1": must be a finite number >= 0 m' in refusal(
        world, "physics.softening=-1"
    )
    found = refusal(world, "physics.gravty=1")
    assert "physics.gravty" in found and "unknown field" in found and 'did you mean "gravity"' in found
