"""Scenes saved and loaded: the same documents, the same bits, and files that are never half written."""

import dataclasses
import errno
import json
import math
import os
from collections.abc import Callable
from pathlib import Path, PurePath
from typing import Any

import esper
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab import SceneError, World, load_scene, save_scene
from physicslab.components import Drag, Held, Mass, Name, Shape, Spring, Trail, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.text import unique_name
from physicslab.ecs.vector import Vector2
from physicslab.files.json_text import json_text
from physicslab.files.scene import read_scene, write_scene
from physicslab.prefabs import box, circle, container, pendulum, pile, stack
from physicslab.scenes import SCENES
from physicslab.state.masses import Diverged
from physicslab.systems.standard import standard_systems

numbers = st.floats(-1e3, 1e3)
positive = st.floats(1e-3, 1e3)
share = st.floats(0.0, 1.0)
pairs = st.tuples(numbers, numbers)


@st.composite
def worlds(draw: st.DrawFn) -> World:
    """Make a world of a few bodies with whatever components, and springs between them."""
    physics = PhysicsConfig(
        gravity_mode=draw(st.sampled_from(("linear", "planet", "none"))),
        gravity=Vector2(*draw(pairs)),
        G=draw(numbers),
        softening=draw(positive),
        linear_damping=draw(share),
        bounds=draw(st.none() | st.just((-1e4, -1e4, 1e4, 1e4))),
    )
    dt, substeps = draw(st.floats(1e-4, 0.1)), draw(st.integers(1, 4))
    simulation = SimulationConfig(dt=dt, substeps=substeps, contacts=draw(st.sampled_from(("soft", "auto"))))
    world = World(*standard_systems(), physics=physics, simulation=simulation)
    world.time = draw(st.floats(0.0, 1e6))
    bodies: list[int] = []
    for i in range(draw(st.integers(1, 4))):
        parts: list[Any] = [Transform(draw(pairs), draw(numbers))]
        if draw(st.booleans()):
            parts.append(Velocity(draw(pairs), draw(numbers)))
        elif draw(st.booleans()):
            parts.append(Trail(draw(positive)))
        if draw(st.booleans()):
            parts.append(Mass(draw(positive), draw(st.none() | positive)))
        if draw(st.booleans()):
            parts.append(draw(st.builds(Shape.circle, positive) | st.builds(Shape.box, positive, positive)))
        bodies.append(world.spawn(*parts, name=draw(st.none() | st.just(f"body {i}"))))
    for _ in range(draw(st.integers(0, 2))):
        a = draw(st.sampled_from(bodies))
        b = draw(st.sampled_from([None, *(body for body in bodies if body != a)]))
        spring = Spring(a, b, draw(pairs), draw(pairs), draw(positive), draw(share), draw(share))
        world.spawn(spring)
    return world


def bits(world: World) -> list[bytes]:
    """Return the state of every body, bit by bit."""
    world.synchronise()
    columns = ((Transform, "position"), (Transform, "angle"), (Velocity, "linear"), (Velocity, "angular"))
    return [np.ascontiguousarray(world.table(kind)[name][1:]).tobytes() for kind, name in columns]


@given(worlds())
def test_a_world_written_and_read_is_the_same_world(world: World) -> None:
    document = write_scene(world)
    again = read_scene(json.loads(json_text(document)))
    assert json_text(write_scene(again)) == json_text(document)
    assert (again.physics, again.simulation, again.time) == (world.physics, world.simulation, world.time)
    assert bits(again) == bits(world)
    assert outcome(again) == outcome(world)
    assert bits(again) == bits(world)
    assert again.time == world.time


def outcome(world: World) -> str:
    """Run a world a little; return what stops it, as planets in one place do."""
    try:
        world.run(steps=3)
    except Diverged as error:
        return str(error)
    return "none"


@pytest.mark.parametrize("contacts", ["soft", "auto"])
@pytest.mark.parametrize("name", SCENES)
def test_every_built_in_scene_goes_on_bit_for_bit_from_a_file(
    name: str, contacts: str, tmp_path: Path
) -> None:
    world = load_scene(name)
    world.simulation = dataclasses.replace(world.simulation, contacts=contacts)
    world.run(steps=40)
    save_scene(world, tmp_path / "scene.json")
    again = load_scene(tmp_path / "scene.json")
    assert again.time == world.time
    assert (again.name, again.title, again.description) == (world.name, world.title, world.description)
    assert bits(again) == bits(world)
    save_scene(again, tmp_path / "again.json")
    assert (tmp_path / "again.json").read_text() == (tmp_path / "scene.json").read_text()
    world.run(steps=20)
    again.run(steps=20)
    assert bits(again) == bits(world)


def test_entities_keep_their_order_when_some_were_removed(tmp_path: Path) -> None:
    world = World(*standard_systems())
    floor = box(world, (0, -0.5), width=20, height=1, static=True)
    boxes = stack(world, 6)
    ball = circle(world, (3, 1), restitution=0.5)
    world.run(steps=30)
    world.remove(boxes[2])
    world.run(steps=30)
    save_scene(world, tmp_path / "scene.json")
    again = load_scene(tmp_path / "scene.json")
    assert len(again.entities()) == 7
    for _ in range(60):
        world.step()
        again.step()
    left = [entity for entity in (floor, *boxes, ball) if entity != boxes[2]]
    for entity, copy in zip(left, again.entities(), strict=True):
        assert world.component(entity, Transform).values() == again.component(copy, Transform).values()


def test_what_is_derived_is_not_written_and_what_was_given_is() -> None:
    world = World()
    circle(world, (0, 0), radius=2.0)
    world.spawn(Transform(), Velocity(), Mass(1.0, 0.125))
    world.synchronise()
    first, second = write_scene(world)["entities"]
    assert first["Mass"] == {}
    assert second["Mass"] == {"inertia": 0.125}


def test_negative_zero_is_not_taken_for_a_default() -> None:
    world = World()
    world.spawn(Transform((0.0, -0.0), -0.0))
    again = read_scene(json.loads(json_text(write_scene(world))))
    transform = again.component(1, Transform)
    assert math.copysign(1.0, transform.position.y) == math.copysign(1.0, transform.angle) == -1.0


def test_ids_are_invented_where_needed_and_only_in_the_file() -> None:
    world = World()
    world.spawn(Transform(), name="entity 2")
    bob = world.spawn(Transform())
    world.spawn(Transform())
    world.spawn(Spring(bob, 1))
    document = write_scene(world)
    assert [entity.get("id") for entity in document["entities"]] == ["entity 2", "entity 2 (2)", None, None]
    assert document["entities"][3]["Spring"] == {"a": "entity 2 (2)", "b": "entity 2"}
    assert world.label(bob) == "entity 2" and len(world.components(bob)) == 1
    assert json_text(write_scene(read_scene(document))) == json_text(document)
    assert unique_name("a", {"a", "a (2)"}) == "a (3)"


def test_what_is_held_is_saved_as_let_go() -> None:
    world = World()
    ball = circle(world, (0, 0))
    world.add(ball, Held())
    assert "Held" not in write_scene(world)["entities"][0]
    assert world.has(ball, Held)


def test_a_spring_of_a_removed_body_is_not_saved() -> None:
    world = World(*standard_systems())
    ball = circle(world, (0, 0))
    world.spawn(Spring(ball))
    world.remove(ball)
    assert write_scene(world)["entities"] == []


def test_plain_esper_components_are_left_behind() -> None:
    world = World()
    world.spawn(Transform(), PurePath("a plain component"))
    assert write_scene(world)["entities"] == [{"Transform": {}}]


SPOILT: list[tuple[Callable[[World], Any], str]] = [
    (
        lambda w: w.table(Transform)["position"].__setitem__((1, 0), math.nan),
        'entity "bob": Transform.position',
    ),
    (lambda w: w.table(Mass)["mass"].__setitem__(1, -1.0), "bob: Mass.mass = -1.0: must be"),
    (
        lambda w: esper.create_entity(Transform(), Name("bob")),
        'entity 2: id = "bob": must be an id of its own',
    ),
    (
        lambda w: esper.create_entity(Transform(), Name("")),
        'entity 2: id = "": must be a text that is not empty',
    ),
    (lambda w: w.spawn(Transform(), Spring(1, 99), entity=9), "Spring.b = 99: must be an entity"),
    (lambda w: setattr(w, "time", -1.0), "time = -1.0: must be a finite number >= 0 s"),
    (lambda w: setattr(w, "title", "\ud800"), 'title = "\\ud800": must be a text'),
]


@pytest.mark.parametrize(("spoil", "line"), SPOILT, ids=[line for _, line in SPOILT])
def test_what_could_not_be_read_again_is_not_saved(
    spoil: Callable[[World], Any], line: str, tmp_path: Path
) -> None:
    world = World()
    pendulum(world, (0, 0), name="bob")
    world.synchronise()
    path = tmp_path / "scene.json"
    save_scene(world, path)
    before = path.read_bytes()
    spoil(world)
    with pytest.raises(SceneError) as caught:
        save_scene(world, path)
    assert line in str(caught.value)
    assert path.read_bytes() == before
    assert os.listdir(tmp_path) == ["scene.json"]


def test_a_disk_that_fails_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "scene.json"
    save_scene(load_scene("drop"), path)
    before = path.read_bytes()

    def full(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        save_scene(load_scene("stack"), path)
    assert path.read_bytes() == before
    assert os.listdir(tmp_path) == ["scene.json"]


def test_a_saved_file_keeps_its_permissions_and_its_link(tmp_path: Path) -> None:
    path, link = tmp_path / "scene.json", tmp_path / "link.json"
    path.touch()
    path.chmod(0o640)
    link.symlink_to(path)
    save_scene(load_scene("drop"), link)
    assert link.is_symlink() and load_scene(path).name == "drop"
    assert path.stat().st_mode & 0o777 == 0o640


def test_a_directory_is_no_place_for_a_scene(tmp_path: Path) -> None:
    world = load_scene("drop")
    with pytest.raises(IsADirectoryError):
        save_scene(world, tmp_path)
    with pytest.raises(FileNotFoundError):
        save_scene(world, tmp_path / "none" / "scene.json")
    assert os.listdir(tmp_path) == []


def test_a_collapsing_pyramid_goes_on_with_the_same_bits() -> None:
    """Near pairs come and go at other times in the loaded world; the result must not depend on that."""
    world = load_scene("pyramid")
    world.physics = dataclasses.replace(world.physics, gravity=Vector2(5, -10))
    world.run(steps=20)
    again = read_scene(write_scene(world))
    for _ in range(300):
        world.step()
        again.step()
    for component, name in ((Transform, "position"), (Transform, "angle"), (Velocity, "linear")):
        assert world.table(component)[name].tobytes() == again.table(component)[name].tobytes()


def falling_pile() -> World:
    world = World(*standard_systems())
    container(world, width=3.0, height=9.0)
    pile(world, 150, columns=11)
    world.run(steps=150)
    return world


def add_one(world: World, discs: list[int]) -> None:
    circle(world, (0.2, 7.0), radius=0.1)


def take_one(world: World, discs: list[int]) -> None:
    world.remove(discs[len(discs) // 2])


def burden_one(world: World, discs: list[int]) -> None:
    world.component(discs[len(discs) // 2], Mass).mass *= 1.2


def overburden_one(world: World, discs: list[int]) -> None:
    world.component(discs[-1], Mass).mass *= 30.0  # which takes more substeps than configured


def shorten(world: World, discs: list[int]) -> None:
    world.simulation = dataclasses.replace(world.simulation, substeps=6)


@pytest.mark.parametrize("edit", [add_one, take_one, burden_one, overburden_one, shorten])
@pytest.mark.parametrize("steps", [0, 1, 25])
def test_a_pile_that_was_edited_goes_on_with_the_same_bits(
    edit: Callable[[World, list[int]], None], steps: int
) -> None:
    world = falling_pile()
    edit(world, [entity for entity in world.entities() if world.has(entity, Mass)])
    for _ in range(steps):
        world.step()
    again = read_scene(json.loads(json_text(write_scene(world))))
    for _ in range(30):
        world.step()
        again.step()
    assert world.contacts.wide.filled + world.sleep.count > 0
    pairs = zip(world.entities(), again.entities(), strict=True)
    for entity, copy in pairs:
        for component in (Transform, Velocity):
            if world.has(entity, component):
                assert (
                    world.component(entity, component).values() == again.component(copy, component).values()
                )


def fast_with_drag(world: World) -> int:
    ball = circle(world, (0, 3), velocity=(500, 0))
    world.add(ball, Drag(quadratic=900.0))
    return ball


def in_the_air(world: World) -> int:
    return circle(world, (0, 3), radius=0.5, restitution=0.5)


@pytest.mark.parametrize("make", [fast_with_drag, in_the_air])
def test_what_was_chosen_for_an_earlier_motion_is_kept(make: Callable[[World], int]) -> None:
    """The method was chosen by how a body moved; the world that is loaded meets it nearly at rest."""
    world = World(*standard_systems())
    box(world, (0, -0.5), width=50, height=1, static=True, restitution=0.5)
    body = make(world)
    world.synchronise()
    plan, row = world.plan, world.entity_index.row_of[body]
    world.table(Velocity)["linear"][row] = 1e-6, 0.0
    world.table(Transform)["position"][row] = 0.0, 0.5
    document = json.loads(json_text(write_scene(world)))
    again = read_scene(document)
    again.synchronise()
    assert world.plan is plan and again.plan.kept == plan.kept != fresh(document).plan.kept
    for each in (world, again):
        each.run(steps=20)
    assert bits(again) == bits(world)
    again.physics = dataclasses.replace(again.physics, G=2.0)
    again.synchronise()
    assert again.plan.kept == fresh(write_scene(again)).plan.kept, "an edit is a reason to choose again"


def fresh(document: dict[str, Any]) -> World:
    """Return the world of a document that keeps nothing of the solver."""
    world = read_scene({key: value for key, value in document.items() if key != "solver"})
    world.synchronise()
    return world


@pytest.mark.parametrize(
    ("solver", "words"),
    [
        ({"span": 0.0}, "scene: solver.span = 0.0: must be"),
        ({"finer": 17}, "scene: solver.finer = 17: must be"),
        ({"finer": 1.5}, "scene: solver.finer = 1.5: must be"),
        ({"spin": 1}, "scene: solver: spin = 1: unknown key"),
        ({"chosen": ["step", "dop853"]}, 'scene: solver.chosen = ["step", "dop853"]: must be [how'),
        ({"chosen": ["step", "magic", 1]}, 'scene: solver.chosen = ["step", "magic", 1]: must be'),
        ({"chosen": ["step", ["rk4"], 1]}, "scene: solver.chosen = "),
        ({"chosen": ["later", "rk4", 1]}, "scene: solver.chosen = "),
        ({"chosen": ["step", "rk4", 0]}, "scene: solver.chosen = "),
        ({"chosen": ["step", "rk4", 1.0]}, "scene: solver.chosen = "),
        ([], "scene: solver = []: must be"),
    ],
)
def test_a_solver_that_makes_no_sense_is_refused(solver: object, words: str) -> None:
    with pytest.raises(SceneError) as refused:
        read_scene({"format": "physicslab-scene/1", "entities": [], "solver": solver})
    assert str(refused.value).startswith(words)
