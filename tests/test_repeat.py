"""A step made again as the last one was: the same bits as one made in full, whatever is done in between."""

from dataclasses import replace
from random import Random

import esper
import pytest

from physicslab import load_scene
from physicslab.components import Drag, Mass, Material, Spring, Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.prefabs import box, circle
from physicslab.state.state import State
from physicslab.stepping import repeat
from physicslab.stepping.stepper import Advancer
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import Stage, System, at
from physicslab.world import World

SOFT_ISLANDS = "soft islands"
SCENES = (
    SOFT_ISLANDS,
    "slope",
    "stack",
    "newtons_cradle",
    "pendulum",
    "two_planets",
    "resonance",
    "car",
    "floating",
    "bridge",
    "bounces",
    "carts",
    "billiards",
)


def figures(world: World) -> list[bytes]:
    """Return all numbers of a world that a step may change."""
    columns = [column.tobytes() for table in world.entity_index.tables.values() for column in table.columns]
    counts = world.time, world.steps, world.collisions, world.force_evaluations, world.substeps
    kept = world.account.sums, world.contacts.impacts, world.joints.force, world.sleep.asleep
    taken = [
        getattr(one, name, None) for one in world.steppers.usable for name in ("energy_taken", "left_to_soft")
    ]
    told = repr((*counts, *taken, world.account.last)).encode()
    return [*columns, told, *(one.tobytes() for one in kept)]


def edit(world: World, random: Random) -> World:
    """Do one of many things to a world between two steps, mostly nothing; return the world to go on with."""
    moving = world.batch(Velocity, Mass).entities.tolist()
    body, choice = random.choice(moving), random.randrange(60)
    if choice == 0:
        world.component(body, Velocity).linear = (random.uniform(-1, 1), random.uniform(-1, 1))
    elif choice == 1:
        world.table(Transform)["position"][world.entity_index.row_of[body]] += 0.001
    elif choice == 2:
        world.component(body, Mass).mass *= 1.5
    elif choice == 3:
        for material in world.batch(Material).entities.tolist():
            world.component(material, Material).restitution = 0.3
    elif choice == 4:
        circle(world, (random.uniform(-5, 5), 9.0), radius=0.2)
    elif choice == 5 and len(moving) > 2:
        with world.active():
            esper.delete_entity(body)
    elif choice == 6:
        world.physics = replace(world.physics, linear_damping=0.1)
    elif choice == 7:
        world.simulation = replace(world.simulation, substeps=world.simulation.substeps + 1)
    elif choice == 8:
        world.time = random.uniform(0.0, 3.0)
    elif choice == 9:
        return world.copy()
    elif choice == 10:
        world.reset()
    elif choice == 11:
        world.book_edits()
    return world


def soft_islands() -> World:
    """Return a world of three heaps with soft contacts: discs, some in drag, and boxes on a spring."""
    world = World(simulation=SimulationConfig(contacts="soft"))
    box(world, (0.0, -0.5), width=100.0, height=1.0, static=True, name="floor")
    for k in range(5):
        circle(world, (-20.0 + 0.35 * (k % 2), 0.3 + 0.6 * k), radius=0.25)
        circle(world, (20.0 + 0.3 * (k % 2), 0.3 + 0.6 * k), radius=0.25, mass=1.0 + 30.0 * (k == 4))
    boxes = [box(world, (0.1 * (k % 2), 0.25 + 0.55 * k), velocity=(0.0, 1.0)) for k in range(5)]
    world.spawn(Spring(boxes[0], boxes[3], stiffness=40.0, damping=0.5, rest_length=1.2))
    world.add(world.entities()[2], Drag(0.4))
    return world


def scene(name: str) -> World:
    """Return the world of that name."""
    return soft_islands() if name == SOFT_ISLANDS else load_scene(name)


def drive(name: str, seed: int) -> list[list[bytes]]:
    """Return the figures of a scene after each of many steps, with edits in between."""
    world, random, found = scene(name), Random(seed), []
    for _ in range(60):
        world = edit(world, random)
        kind = random.randrange(8)
        if kind == 0:
            world.run(steps=random.randint(1, 6))
        elif kind == 1:
            world.step(0.004)
        else:
            world.step()
        found.append(figures(world))
    return found


@pytest.mark.parametrize("name", SCENES)
def test_a_repeated_step_has_the_bits_of_one_made_in_full(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    repeated = drive(name, 3)
    monkeypatch.setattr(repeat, "_FEW", -1)
    in_full = drive(name, 3)
    assert [n for n, (one, other) in enumerate(zip(repeated, in_full, strict=True)) if one != other] == []


def test_soft_islands_go_on_without_being_chosen_for_again(monkeypatch: pytest.MonkeyPatch) -> None:
    world, made, go_on = soft_islands(), list[int](), World.go_on
    world.run(steps=10)
    steppers = [island.world.stepper_for(0.01).name for island in world.islands.members]
    assert steppers == ["fused_contact"] * 3

    def counted(self: World, h: float, steps: int) -> int:
        made.append(go_on(self, h, steps))
        return made[-1]

    monkeypatch.setattr(World, "go_on", counted)
    for _ in range(10):
        world.run(steps=3)
    assert sum(made) >= 75  # of 90 steps of islands


@pytest.mark.parametrize("name", ["slope", "stack", "pendulum", "two_planets", "drop"])
def test_steps_are_repeated_while_nothing_is_edited(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    world, full, choose = load_scene(name), list[float](), World.stepper_for

    def counted(self: World, h: float) -> Advancer:
        full.append(self.time)
        return choose(self, h)

    monkeypatch.setattr(World, "stepper_for", counted)
    for _ in range(20):
        world.step()
    assert len(full) <= 1 + len(world.parts)
    world.component(world.batch(Velocity, Mass).entities.tolist()[0], Velocity).linear *= 0.5
    before = len(full)
    world.step()
    assert len(full) > before


class Writes(System):
    """Throws all that moves upwards, and makes it heavier, at the end of the 21st step."""

    @at(Stage.IMPACT)
    def write(self, state: State, h: float) -> None:
        """Write speeds [m/s] and masses [kg]."""
        if state.steps == 20:
            rows = state.batch(Velocity, Mass).rows
            state.table(Velocity)["linear"][rows] = (0.0, 5.0)
            state.table(Mass)["mass"][rows] = 7.0


class Counts(System):
    """Counts how often it is called."""

    def __init__(self) -> None:
        self.calls = 0

    @at(Stage.IMPACT)
    def count(self, state: State, h: float) -> None:
        self.calls += 1


@pytest.mark.parametrize(("height", "stepper"), [(0.5, "rigid"), (50.0, "event_driven")])
def test_a_run_calls_what_looks_at_impacts_once_a_step(height: float, stepper: str) -> None:
    counts = Counts()
    world = World(systems=(*standard_systems(), counts))
    world.simulation = replace(world.simulation, collisions="exact" if height > 1.0 else "auto")
    box(world, (0, -0.5), width=8, height=1, static=True)
    circle(world, (0.0, height), radius=0.5)
    world.run(steps=30)
    assert world.stepper is not None and world.stepper.name == stepper
    assert counts.calls == 30


@pytest.mark.parametrize(("height", "stepper"), [(0.5, "rigid"), (50.0, "event_driven")])
def test_speeds_and_masses_that_a_system_writes_at_impacts_are_those_of_the_next_step(
    height: float, stepper: str
) -> None:
    world = World(systems=(*standard_systems(), Writes()))
    world.simulation = replace(world.simulation, collisions="exact" if height > 1.0 else "auto")
    box(world, (0, -0.5), width=8, height=1, static=True)
    thrown = circle(world, (0.0, height), radius=0.5)
    for _ in range(21):
        world.step()
    reached = world.component(thrown, Transform).position.y
    world.step()
    assert world.stepper is not None and world.stepper.name == stepper
    assert world.component(thrown, Transform).position.y > reached + 4.0 * world.simulation.dt
    assert world.bodies.inverse_mass[world.entity_index.row_of[thrown]] == pytest.approx(1.0 / 7.0)


def test_pairs_listed_by_hand_between_steps_are_those_that_the_next_step_goes_on_with() -> None:
    """The broad phase fills other arrays, and the loop went on with those of its last call."""
    worlds, bodies = (World(), World()), []
    for world in worlds:
        box(world, (0.0, -0.5), width=20.0, height=1.0, static=True)
        bodies = [
            box(world, (0.31 * (k % 4), 0.15 + 0.31 * (k // 4)), width=0.3, height=0.3) for k in range(16)
        ]
    for _ in range(30):
        for world in worlds:
            world.run(steps=3)
        with worlds[1].active():
            worlds[1].contacts.stale = True
            worlds[1].schedule.run(Stage.BROAD_PHASE, worlds[1], 0.0)
    places = [[world.component(body, Transform).position for body in bodies] for world in worlds]
    assert places[0] == places[1]
