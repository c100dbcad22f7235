"""What a user of the library writes wrongly is refused at once, in words that say what to write."""

from __future__ import annotations

import dataclasses
import inspect
import logging
import math
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import physicslab
from physicslab import (
    InvalidValue,
    PhysicsConfig,
    SceneError,
    SimulationConfig,
    World,
    circle,
    load_scene,
    pendulum,
    save_scene,
)
from physicslab.components import Mass, Shape, Spring, Transform, Velocity
from physicslab.ecs.component import COMPONENTS
from physicslab.systems import integrate
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem

BALL = (Transform((0, 5)), Velocity(), Mass(2.0), Shape.circle(0.1))


@pytest.fixture
def world() -> World:
    world = World()
    world.spawn(*(type(part)(**part.given()) for part in BALL), name="ball")
    return world


def change(path: str, value: object) -> Callable[[World], None]:
    """Return what assigns to a part of a world, or of its ball."""

    def assign(world: World) -> None:
        *way, name = path.split(".")
        held: Any = world.component("ball", Transform) if way[:1] == ["transform"] else world
        for part in way[way[:1] == ["transform"] :]:
            held = getattr(held, part)
        setattr(held, name, value)

    return assign


WRONG: dict[str, tuple[Callable[[World], object], type[Exception], str]] = {
    "gravity": (change("gravity", (0, -1)), AttributeError, "world.physics = dataclasses.replace("),
    "dt": (change("dt", 0.1), AttributeError, "world.simulation = dataclasses.replace("),
    "misspelt": (change("gravty", 1.0), AttributeError, "no attribute 'gravty'"),
    "misspelt law, read": (lambda world: world.gravty, AttributeError, 'did you mean "gravity"?'),  # type: ignore[attr-defined]
    "misspelt figure": (lambda world: world.enrgy, AttributeError, 'did you mean "energy"?'),  # type: ignore[attr-defined]
    "figure that is measured": (change("energy", 3.0), AttributeError, "world.energy is measured and cannot"),
    "clock": (change("time", "now"), InvalidValue, "world.time = 'now': must be a finite number s"),
    "clock without end": (change("time", math.inf), InvalidValue, "world.time = inf: must be a finite"),
    "language": (lambda world: world.describe("xx"), InvalidValue, 'must be one of "en", "de"'),
    "misspelt law": (
        lambda world: PhysicsConfig(gravty=(0, 1)), TypeError,  # type: ignore[call-arg]
        "PhysicsConfig has no field 'gravty'; it has gravity_mode, gravity, ",
    ),
    "misspelt setting": (
        lambda world: dataclasses.replace(world.simulation, substep=2), TypeError, 'did you mean "substeps"?'  # type: ignore[call-arg]
    ),
    "misspelt law, written": (
        change("physics.gravty", 1), AttributeError, 'PhysicsConfig has no field \'gravty\'; it has'
    ),
    "misspelt field, read": (
        lambda world: world.component("ball", Velocity).liner, AttributeError,  # type: ignore[attr-defined]
        "Velocity has no field 'liner'; it has linear, angular; did you mean \"linear\"?",
    ),
    "misspelt field, written": (
        change("transform.positon", (1, 2)), AttributeError,
        "Transform has no field 'positon'; it has position, angle; did you mean \"position\"?",
    ),
    "misspelt name": (lambda world: physicslab.Wrld, AttributeError, 'did you mean "World"?'),  # type: ignore[attr-defined]
    "column": (
        lambda world: world.copy().record(0.1).columns["ball.z"], KeyError,
        "has no column 'ball.z'; it has time, ball.x, ball.y, ",
    ),
    "one system as a list": (lambda world: World(systems=GravitySystem()), TypeError, "systems=[...]"),  # type: ignore[arg-type]
    "size of another shape": (
        lambda world: Shape("circle", width=3), InvalidValue,
        "Shape.width = 3.0: must be left out: a circle has no width, it has radius",
    ),
    "coordinates apart": (
        lambda world: circle(world, 0, 0), TypeError,  # type: ignore[arg-type, call-arg]
        "circle(world, 0, 0): a position is one pair, as (0, 5); name all else",
    ),
    "misspelt size": (
        lambda world: circle(world, (0, 0), raduis=1), TypeError, 'did you mean "radius"?'  # type: ignore[call-arg]
    ),
    "law": (change("physics.gravity", (0, 1)), dataclasses.FrozenInstanceError, "dataclasses.replace("),
    "setting": (change("simulation.dt", 1), dataclasses.FrozenInstanceError, "dataclasses.replace("),
    "part of a vector": (
        change("transform.position.x", 3), dataclasses.FrozenInstanceError, "transform.position = (3, 5.0)"
    ),
    "dict": (lambda world: world.spawn({"mass": 1}), TypeError, "{'mass': 1} is none"),
    "number": (lambda world: world.spawn(3), TypeError, "3 is none"),
    "array": (lambda world: world.add("ball", np.zeros(2)), TypeError, "is none"),
    "type": (lambda world: world.spawn(Mass), TypeError, "write Mass(...)"),
    "no such end": (lambda world: world.spawn(Spring(a=999)), InvalidValue, "Spring.a = 999: must be an"),
    "end, added": (lambda world: world.add("ball", Spring(b=77)), InvalidValue, "Spring.b = 77: must be"),
    "end, without springs": (
        lambda world: World(GravitySystem()).spawn(Transform(), Spring(b=5)), InvalidValue, "Spring.b = 5"
    ),
    "unknown id for an end": (
        lambda world: world.spawn(Spring(a="bal")), InvalidValue,
        "Spring.a = 'bal': must be the id of an entity of this world: no entity has the id 'bal'; did you",
    ),
    "unit of something else": (lambda world: Mass("2 m"), InvalidValue, "'2 m' is in m; this is in kg"),
    "text that is no number": (lambda world: Mass("heavy"), InvalidValue, "Mass.mass = 'heavy': must be"),
    "run": (lambda world: world.run(3.0), TypeError, "say run(seconds=3.0)"),  # type: ignore[arg-type]
    "stepping": (lambda world: world.stepping(3.0), TypeError, "say stepping(seconds=3.0)"),  # type: ignore[arg-type]
    "name of a component": (lambda world: world.component("ball", "Shape"), TypeError, "by its type"),  # type: ignore[arg-type]
    "has": (lambda world: world.has("ball", "Shape"), TypeError, "by its type"),  # type: ignore[arg-type]
    "misspelt id": (lambda world: world.entity("balll"), KeyError, 'did you mean "ball"?'),
    "misspelt id of a part": (lambda world: world.component("bal", Mass), KeyError, 'did you mean "ball"?'),
    "document": (lambda world: load_scene({"a": 1}), SceneError, "the scene"),
    "path": (lambda world: save_scene(world, 3), TypeError, "a scene has a name or a path; got 3"),  # type: ignore[arg-type]
    "both": (lambda world: World(GravitySystem(), systems=()), TypeError, "not both"),
    "laws": (change("physics", {"gravity": (0, 1)}), TypeError, "write PhysicsConfig(...)"),
    "laws of a new world": (
        lambda world: World(physics=(0, 1)), TypeError, "world.physics is a PhysicsConfig, not (0, 1)"  # type: ignore[arg-type]
    ),
    "settings": (change("simulation", 0.1), TypeError, "write SimulationConfig(...)"),
    "method": (lambda world: SimulationConfig(integrator="euler"), InvalidValue, '"symplectic_euler"'),
    "gravity in one number": (lambda world: PhysicsConfig(gravity=9.81), InvalidValue, "two finite numbers"),  # type: ignore[arg-type]
    "no system": (lambda world: World(3), TypeError, "3 is no System"),  # type: ignore[arg-type]
    "misspelt field": (lambda world: Mass(mas=3), TypeError, "no field 'mas'; it has mass, inertia"),  # type: ignore[call-arg]
    "mass below zero": (lambda world: Mass(-1), InvalidValue, "Mass.mass = -1: must be"),
    "place in one number": (lambda world: Transform(3), InvalidValue, "two finite numbers [x, y] m"),  # type: ignore[arg-type]
    "kind of shape": (lambda world: Shape("triangle"), InvalidValue, '"circle", "box"'),
    "radius": (lambda world: circle(world, (0, 0), radius=-1), InvalidValue, "Shape.radius = -1"),
    "two of a kind": (lambda world: world.spawn(Mass(), Mass()), ValueError, "one Mass, not 2"),
    "id twice": (lambda world: world.spawn(name="ball"), InvalidValue, "entity 1 has this one"),
    "no such component": (lambda world: world.component("ball", Spring), KeyError, "ball has no Spring"),
    "scene": (lambda world: load_scene("dorp"), SceneError, 'did you mean "drop"?'),
    "length of a step": (lambda world: world.step("a"), InvalidValue, "step.dt = 'a'"),  # type: ignore[arg-type]
    "neither": (lambda world: world.run(), TypeError, "either seconds or steps"),
    "time below zero": (lambda world: world.run(seconds=-1), InvalidValue, "run.seconds = -1"),
    "stride": (lambda world: world.stepping(steps=3, stride=0), InvalidValue, "stepping.stride = 0"),
    "record": (lambda world: world.record(1, 0.1), TypeError, "give every=... or until=... by name"),  # type: ignore[arg-type]
    "record, for how long": (lambda world: world.record(), TypeError, "World.record() missing 1"),  # type: ignore[call-arg]
    "component, of which kind": (lambda world: world.component("ball"), TypeError, "World.component() m"),  # type: ignore[call-arg]
    "condition": (lambda world: world.record(1, until=3), InvalidValue, "as 'ball.x >= 8 m' is one"),  # type: ignore[arg-type]
    "angle": (lambda world: pendulum(world, (0, 0), angle="3 m"), InvalidValue, "Transform.angle = '3 m'"),  # type: ignore[arg-type]
    "no quantity": (lambda world: world.record(1, until="bal.x > 3"), InvalidValue, "one of ball, world"),
}  # fmt: skip


@pytest.mark.parametrize("wrong", WRONG.values(), ids=WRONG)
def test_it_is_refused_at_once_and_says_what_to_write(
    wrong: tuple[Callable[[World], object], type[Exception], str], world: World
) -> None:
    attempt, error, words = wrong
    before = world.entities(), world.time
    with pytest.raises(error) as refused:
        attempt(world)
    message = str(refused.value.args[0] if isinstance(refused.value, KeyError) else refused.value)
    assert words in message and message.isprintable() and len(message) < 200
    assert (world.entities(), world.time) == before


def test_an_id_is_taken_wherever_an_entity_is(world: World, tmp_path: Path) -> None:
    assert world.has("ball", Mass) and not world.has("bell", Mass)
    assert world.component("ball", Mass).mass == 2.0 and len(world.components("ball")) == 5
    world.add("ball", Mass(np.array(3.0)))  # type: ignore[arg-type]
    assert world.component("ball", Mass).mass == 3.0
    assert world.discard("ball", Shape) is not None and world.label("ball") == "ball"
    save_scene(world, os.fsencode(tmp_path / "b.json"))
    assert load_scene(os.fsencode(tmp_path / "b.json")).has("ball", Mass)
    assert "ball" in world and 1 in world and "bell" not in world and 2 not in world and [*world] == [1]
    world.remove("ball")
    assert not world.entities() and "ball" not in world


def test_a_world_without_a_list_has_what_it_needs_and_one_with_a_list_just_that(
    world: World, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(integrate, "_warned", set())
    world.run(seconds=1.0)
    assert world.component("ball", Transform).position.y == pytest.approx(5 - 0.5 * 9.81, rel=1e-9)
    assert {one.name for one in world.schedule.left_out} >= {"SpringSystem", "DragSystem"}
    assert World(systems=()).schedule.systems[1:] == () and not caplog.records
    for _ in range(2):
        just = World(GravitySystem())
        ball = just.spawn(Transform((0, 5)), Velocity(), Mass(2.0))
        just.step(0.01)
        assert just.component(ball, Velocity).linear.y == pytest.approx(-0.0981, rel=1e-12)
        assert just.component(ball, Transform).position.y == 5.0
    (told,) = caplog.records
    assert told.levelno == logging.WARNING
    assert told.getMessage().startswith(
        "World(GravitySystem()): velocities move nothing without an Integrate"
    )
    moving = World(GravitySystem(), IntegrateSystem())
    moving.spawn(Transform(), Velocity(), Mass())
    moving.step()
    assert len(caplog.records) == 1


@pytest.mark.parametrize("kind", COMPONENTS.values(), ids=COMPONENTS)
def test_help_shows_the_fields_of_a_component(kind: type[Any]) -> None:
    known = inspect.signature(kind).parameters
    assert list(known) == [spec.name for spec in kind.FIELDS]
    assert all(f"{spec.name} : " in str(kind.__doc__) for spec in kind.FIELDS)


def test_a_failure_within_is_not_a_name_that_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(name: str) -> None:
        raise AttributeError("'function' object has no attribute 'get_call_template'")

    monkeypatch.setattr(physicslab, "import_module", broken)
    with pytest.raises(ImportError, match=r"physicslab\.World cannot be imported: 'function' object has no"):
        physicslab.__getattr__("World")


def test_numba_that_may_not_compile_is_refused_in_one_line() -> None:
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    main = "from physicslab.cli import main; import sys; sys.exit(main(['kernels', 'export', '/dev/null']))"
    done = subprocess.run(
        [sys.executable, "-c", main], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and "PHYSICSLAB_INTERPRET=1" in done.stderr


def test_type_checkers_are_told_that_there_are_types() -> None:
    assert (Path(physicslab.__file__).parent / "py.typed").is_file()
