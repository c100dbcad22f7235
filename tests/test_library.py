"""The package as a library: texts with units, ids in place of numbers, scenes as dicts, public names."""

import math
import os
import pickle
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import physicslab
from physicslab import (
    InvalidValue,
    PhysicsConfig,
    SceneError,
    SimulationConfig,
    Vector2,
    World,
    circle,
    cli,
    load_scene,
    save_scene,
    systems,
)
from physicslab.components import Drag, GraphLine, Mass, Rod, Spring, Transform, Velocity
from physicslab.files.scene import parse_json
from physicslab.systems.standard import PHYSICS_SYSTEMS


@pytest.mark.parametrize("name", physicslab.__all__)
def test_every_public_name_can_be_imported(name: str) -> None:
    assert getattr(physicslab, name) is not None and name in dir(physicslab)


def test_systems_are_imported_from_one_place() -> None:
    named = {name for name in systems.__all__ if getattr(systems, name) in PHYSICS_SYSTEMS}
    assert named == {system.__name__ for system in PHYSICS_SYSTEMS}
    with pytest.raises(AttributeError, match='did you mean "GravitySystem"'):
        _ = systems.GravitySytem  # type: ignore[attr-defined]


def test_numbers_are_given_with_their_units() -> None:
    assert Mass("2000 g").mass == 2.0
    placed = Transform(("20 cm", 1), "30 deg")
    assert tuple(placed.position) == (0.2, 1.0) and placed.angle == math.radians(30.0)
    placed.position, placed.angle = "[1, 2] km", "0.5 turn"
    assert tuple(placed.position) == (1000.0, 2000.0) and placed.angle == math.pi
    assert Mass(inertia="1 kg m^2").inertia == 1.0
    settings: dict[str, Any] = {"dt": "5 ms"}
    assert SimulationConfig(**settings) == SimulationConfig(dt=0.005)
    laws: dict[str, Any] = {"gravity": ("0", "-1.62 m/s^2")}
    assert tuple(PhysicsConfig(**laws).gravity) == (0.0, -1.62)


@given(st.floats(1e-200, 1e200))
def test_a_text_holds_every_bit_of_a_number(mass: float) -> None:
    assert Mass(f"{mass!r} kg").mass == mass


@pytest.mark.parametrize(
    "text", ["2 m", "heavy", "", "-1 kg", "nan", "1e999 kg", "__import__('os')", "[1, 2] kg"]
)
def test_a_text_that_is_no_mass_is_refused_as_it_was_written(text: str) -> None:
    with pytest.raises(InvalidValue) as refused:
        Mass(text)
    assert str(refused.value).startswith(f"Mass.mass = {text!r}: must be a finite number > 0 kg")


@pytest.mark.parametrize(
    ("part", "value"),
    [({"Mass": {"mass": "2 kg"}}, '"2 kg"'), ({"Transform": {"position": ["1 m", 2]}}, '["1 m", 2]')],
)
def test_files_have_si_numbers(part: dict[str, object], value: str) -> None:
    with pytest.raises(SceneError) as refused:
        load_scene({"format": "physicslab-scene/1", "entities": [{"Transform": {}} | part]})
    assert value in str(refused.value) and "finite number" in str(refused.value)


def test_ids_stand_for_entities_wherever_one_is_taken() -> None:
    world = World(physics=PhysicsConfig(gravity=Vector2(0.0, -10.0)))
    bob = circle(world, (0.0, 0.0), mass=2.0, name="bob")
    assert world["bob"] == bob
    rod = world.spawn(Rod(b="bob", anchor_a=(0.0, 2.0)), name="rod")
    assert world.component("rod", Rod).b == bob
    assert world.component(world.spawn(GraphLine(rod, "joint force", "rod")), GraphLine).body == rod
    world.add("bob", Spring(b="rod"))
    world.discard("bob", Spring)
    world.run(seconds=0.5)
    assert tuple(world.component("bob", Transform).position) == pytest.approx((0.0, 0.0), abs=1e-12)


def test_a_component_with_an_id_can_be_sent_elsewhere() -> None:
    assert pickle.loads(pickle.dumps(Spring(a="ball", b="floor"))).a == "ball"


def test_a_scene_is_a_dict_as_well() -> None:
    document = {
        "format": "physicslab-scene/1",
        "title": "A throw",
        "entities": [
            {
                "id": "ball",
                "Transform": {"position": [0, 1]},
                "Velocity": {"linear": [2, 3]},
                "Mass": {"mass": 1},
            }
        ],
    }
    world, again = load_scene(document), load_scene(document)
    for each in (world, again):
        each.run(seconds=1.0)
    assert repr(world) == "<World 'A throw': entities: 1, t = 1 s>"
    assert np.array_equal(world.table(Velocity)["linear"], again.table(Velocity)["linear"])


def test_what_is_saved_is_such_a_dict(tmp_path: object) -> None:
    path = f"{tmp_path}/drop.json"
    save_scene(load_scene("drop"), path)
    with open(path, encoding="utf-8") as file:
        document = parse_json(file.read(), "drop")
    assert isinstance(document, dict) and load_scene(document).title == load_scene(path).title


def test_the_version_is_that_of_the_package(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--version"]) == 0
    assert capsys.readouterr().out == f"physicslab {physicslab.__version__}\n"
    root = Path(__file__).parents[1]
    for name in ("pyproject.toml", "CITATION.cff", "CHANGELOG.md"):
        assert physicslab.__version__ in (root / name).read_text("utf-8"), name


def test_the_package_is_a_command() -> None:
    done = subprocess.run([sys.executable, "-m", "physicslab", "--version"], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, f"physicslab {physicslab.__version__}\n")


TASKS = Path(__file__).parents[1].joinpath("docs", "library.md").read_text("utf-8").split("### Four tasks")[1]
BLOCKS = [block.split("```")[0] for block in TASKS.split("```python")[1:5]]


@pytest.mark.parametrize("block", BLOCKS, ids=["period", "impacts", "parting", "throw"])
def test_a_task_of_the_documents_takes_nine_lines(block: str) -> None:
    lines = [line for line in block.splitlines() if line.strip() and "import" not in line]
    written = [line for line in lines if line.startswith((">>>", "..."))] if ">>>" in block else lines
    assert len(written) <= 9


def test_the_slowest_throw_is_found_by_scipy() -> None:
    pytest.importorskip("scipy")
    known: dict[str, Any] = {"World": World, "circle": circle, "Drag": Drag, "Velocity": Velocity, "np": np}
    exec(BLOCKS[3], known)
    best, height = known["best"], known["height"]
    assert best.fun == pytest.approx(11.1, abs=2.0)
    for angle in (best.x - 0.02, best.x + 0.02):
        assert height(best.fun, angle) < 1.0, "no other angle reaches it at this speed"


PUBLIC = [import_module(f"physicslab{name}") for name in ("", ".ensembles", ".prefabs", ".systems")]
"""What the reference has whole; the fields of components are in the documents of what they do."""


def test_every_public_name_is_in_the_reference() -> None:
    text = Path(__file__).parents[1].joinpath("docs", "reference.md").read_text("utf-8")
    listed = re.findall(r"^::: physicslab\.(\S+)$", text, re.MULTILINE)
    public = {name: module for module in PUBLIC for name in module.__all__}
    assert sorted(path.rpartition(".")[2] for path in listed) == sorted(public)
    for path in listed:
        module, _, name = path.rpartition(".")
        assert getattr(import_module(f"physicslab.{module}"), name) is getattr(public[name], name)


MISTAKES = {
    "Mass(mas=3)": 'Unexpected keyword argument "mas" for "Mass"; did you mean "mass"?',
    "Mass([1.0])": 'Argument 1 to "Mass" has incompatible type "list[float]"',
    "world.run(3.0)": 'Argument 1 to "run" of "World" has incompatible type "float"; expected "Never"',
    'world.component("ball", "Shape")': 'Argument 2 to "component" of "Entities" has incompatible type "str"',
    'world.component("ball", Mass).masss': '"Mass" has no attribute "masss"; maybe "mass"?',
    "world.gravty = (0, -1)": '"World" has no attribute "gravty"',
    'world.record("3 s", every=[1])': 'Argument "every" to "record" of "Facade" has incompatible type',
    'world.record(3.0).column["ball.x"]': '"Run" has no attribute "column"; maybe "columns"?',
    "world.energy.totl": '"Energy" has no attribute "totl"; maybe "total"?',
    "from physicslab import Wrld": 'Module "physicslab" has no attribute "Wrld"; maybe "World"?',
    "load_scene(3)": 'Argument 1 to "load_scene" has incompatible type "int"',
}
"""Lines of a user's file, and what mypy says of them."""


@pytest.mark.slow
def test_type_checkers_find_what_a_user_mistypes(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    head = "from physicslab import World, circle, load_scene\nfrom physicslab.components import Mass\n"
    right = 'world: World = load_scene("drop")\ncircle(world, (0, 1), mass=2.0, name="bob")\n'
    right += 'height: float = world.record(1.0, until="bob.y < 0").columns["bob.y"].max()\n'
    (tmp_path / "user.py").write_text(head + right + "\n".join(MISTAKES) + "\n", encoding="utf-8")
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), "user.py"]
    environment = {**os.environ, "MYPYPATH": str(Path(physicslab.__file__).parents[1])}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    said = [line for line in done.stdout.splitlines() if line.startswith("user.py") and "note:" not in line]
    lines = {int(line.split(":")[1]) for line in said}
    first = len((head + right).splitlines()) + 1
    assert lines == set(range(first, first + len(MISTAKES))), done.stdout
    for words in MISTAKES.values():
        assert any(words in line for line in said), (words, done.stdout)
