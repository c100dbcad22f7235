"""What rounding leaves out is carried from step to step, and kept in scene files."""

import cmath
import math
from pathlib import Path
from typing import Any

import pytest

from physicslab import World, load_scene, save_scene
from physicslab.components import Drag, Mass, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.checks import SceneError
from physicslab.files.reader import read_scene
from physicslab.files.writer import write_scene
from physicslab.state.masses import Diverged
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import Stage, System, at

MASSES = 1.0, 0.01, 0.002
SIDE = math.sqrt(3.0)
OMEGA = math.sqrt(sum(MASSES) / SIDE**3)
CORNERS = [cmath.rect(1.0, 2.0 * math.pi * k / 3.0) for k in range(3)]
MIDDLE = sum(m * c for m, c in zip(MASSES, CORNERS, strict=True)) / sum(MASSES)


def lagrange(**simulation: Any) -> World:
    """Return Lagrange's triangle, turning steadily, with masses at which it is stable."""
    physics = PhysicsConfig(gravity_mode="planet", G=1.0)
    world = World(*standard_systems(), physics=physics, simulation=SimulationConfig(**simulation))
    for mass, corner in zip(MASSES, CORNERS, strict=True):
        start = corner - MIDDLE
        rate = 1j * OMEGA * start
        world.spawn(Transform((start.real, start.imag)), Velocity((rate.real, rate.imag)), Mass(mass))
    return world


def bits(world: World) -> list[Any]:
    return [
        world.table(kind)[name].tobytes()
        for kind, name in ((Transform, "position"), (Velocity, "linear"), (Transform, "angle"))
    ]


@pytest.mark.parametrize("name", ["leapfrog", "rk4", "blanes_moan", "symplectic_euler"])
def test_steps_of_one_length_give_the_bits_of_a_run(name: str) -> None:
    at_once, stepped = lagrange(integrator=name), lagrange(integrator=name)
    at_once.run(steps=500)
    for _ in range(500):
        stepped.step()
    assert bits(stepped) == bits(at_once)


@pytest.mark.parametrize("name", ["leapfrog", "rk4", "blanes_moan", "symplectic_euler"])
def test_they_do_beside_what_depends_on_velocities(name: str) -> None:
    at_once, stepped = lagrange(integrator=name), lagrange(integrator=name)
    for world in (at_once, stepped):
        for entity in world.entities():
            world.add(entity, Drag(quadratic=0.3))
    at_once.run(steps=50)
    for _ in range(50):
        stepped.step()
    assert bits(stepped) == bits(at_once)


@pytest.mark.parametrize("name", ["auto", "blanes_moan", "implicit_midpoint"])
def test_a_saved_world_goes_on_bit_for_bit(name: str, tmp_path: Path) -> None:
    world = lagrange(integrator=name)
    world.run(steps=40)
    save_scene(world, tmp_path / "scene.json")
    document = write_scene(world)
    assert len(document["remainders"]) == 3
    again = load_scene(tmp_path / "scene.json")
    assert write_scene(again)["remainders"] == document["remainders"]
    for going in (world, again):
        for _ in range(40):
            going.step()
    assert bits(again) == bits(world)
    without = read_scene({key: value for key, value in document.items() if key != "remainders"})
    for _ in range(40):
        without.step()
    assert bits(without) != bits(world), "the remainders make a difference"


def test_an_edit_drops_the_remainder_of_what_it_changed_in_the_file_as_well() -> None:
    world = lagrange()
    world.run(steps=40)
    before = {row[0]: row[1:] for row in write_scene(world)["remainders"]}
    world.component(2, Transform).position += Vector2(0.25, 0.0)
    after = {row[0]: row[1:] for row in write_scene(world)["remainders"]}
    assert before["point 2"][0] != 0.0 == after["point 2"][0]
    before["point 2"][0] = 0.0
    assert after == before
    again = read_scene(write_scene(world))
    world.run(steps=20)
    again.run(steps=20)
    assert bits(again) == bits(world)


def test_a_body_that_comes_or_goes_leaves_the_remainders_of_the_others() -> None:
    world = lagrange()
    world.run(steps=40)
    kept = write_scene(world)["remainders"]
    world.remove(2)
    world.spawn(Transform((5, 0)), Velocity((0, 0.1)), Mass(0.1))
    document = write_scene(world)
    assert [row[1:] for row in document["remainders"]] == [kept[0][1:], kept[2][1:]]
    again = read_scene(document)
    world.run(steps=20)
    again.run(steps=20)
    assert [part.tobytes() for part in _moving(again)] == [part.tobytes() for part in _moving(world)]


def _moving(world: World) -> list[Any]:
    rows = world.batch(Velocity).rows
    return [world.table(Transform)["position"][rows], world.table(Velocity)["linear"][rows]]


def test_where_nothing_is_compensated_there_are_none() -> None:
    for name in ("stack", "newtons_cradle"):
        world = load_scene(name)
        world.run(steps=30)
        assert "remainders" not in write_scene(world)


def test_a_step_that_fails_takes_the_remainders_back() -> None:
    class Poison(System):
        @at(Stage.FINISH)
        def spoil(self, world: World, h: float) -> None:
            if world.steps == 41:
                raise Diverged("spoilt")

    world, good = lagrange(), lagrange()
    world.install(Poison())
    for going in (world, good):
        for _ in range(41):
            going.step()
    with pytest.raises(Diverged, match="spoilt"):
        world.step()
    assert write_scene(world)["remainders"] == write_scene(good)["remainders"]


@pytest.mark.parametrize(
    ("remainders", "words"),
    [
        ({}, r"remainders = \{\}: must be a list of \[id, x, y, angle, vx, vy, omega\]"),
        ([["a", 0, 0, 0, 0, 0]], r"remainders\[0\] = .*: must be \[id, x, .*\], six finite numbers"),
        ([["a", 0, 0, 0, 0, 0, None]], r"remainders\[0\] = .*six finite numbers"),
        (
            [["b", 0, 0, 0, 0, 0, 0]],
            r'remainders\[0\]\[0\] = "b": must be the id of an entity with Transform',
        ),
        ([[1, 0, 0, 0, 0, 0, 0]], r"remainders\[0\]\[0\] = 1: must be the id"),
        ([["a", 0, 0, 0, 0, 0, 0]] * 2, r'remainders\[1\]\[0\] = "a": must be an id that has none yet'),
        (
            [["a", 1e-15, 0, 0, 0, 0, 0]],
            r"remainders\[0\]\[1\] = 1e-15: must be at most 2.22045e-16, the last",
        ),
    ],
)
def test_remainders_that_make_no_sense_are_refused(remainders: object, words: str) -> None:
    entities = [{"id": "a", "Transform": {"position": [1, 0]}, "Velocity": {}}, {"id": "b", "Transform": {}}]
    with pytest.raises(SceneError, match=words):
        read_scene({"format": "physicslab-scene/1", "entities": entities, "remainders": remainders})
