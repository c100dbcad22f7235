"""Proximity pairs: when they get a record, in which order, and that it makes no difference."""

from __future__ import annotations

import os

import numpy as np
import pytest
from desk import bits
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.contacts.outlines import outlines_of
from physicslab.contacts.report import count_near_pairs, list_contacts
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.scene import load_scene, read_scene, write_scene
from physicslab.kernels import Numbers, Rows, Vectors, allocating_kernel, compile_kernels
from physicslab.kernels.broad import near_pairs
from physicslab.kernels.records import MANIFOLD, POINT, Couples, Manifolds, Points
from physicslab.prefabs import box, gas
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.contact import ContactSystem
from physicslab.systems.standard import standard_systems
from physicslab.world import World


@allocating_kernel
def activate(
    proximity: Couples, activation_distance: Numbers, far: int, manifolds: Manifolds, points: Points,
    count: int, scalar: Rows, scalar_count: int, entities: Rows, position: Vectors, linear: Vectors,
    h: float, margin: float,
) -> tuple[int, int, int]:  # fmt: skip
    """Call the inner function of that name."""
    return near_pairs.activate(
        proximity, activation_distance, far, manifolds, points, count, scalar, scalar_count, entities,
        position, linear, h, margin, np.empty(far, np.int64),
    )  # fmt: skip


def disc(world: World, x: float, y: float, velocity: tuple[float, float] = (0.0, 0.0)) -> int:
    return world.spawn(
        Transform((x, y)), Velocity(velocity), Mass(1.0), Shape.circle(0.5), Material(1.0, 0.0)
    )


def recorded(world: World) -> list[tuple[int, int]]:
    """Return the pairs that have records."""
    records = world.contacts.manifolds[: world.contacts.recorded]
    return [(int(record["entity_a"]), int(record["entity_b"])) for record in records]


def test_a_disc_on_its_way_gets_a_record_when_it_comes_within_reach() -> None:
    world = World(BroadPhaseSystem(), ContactSystem())
    one, other = disc(world, 0.0, 0.0), disc(world, 1.05, 0.0)
    world.step()
    assert (world.contacts.recorded, world.contacts.proximity_count, world.contacts.candidate_pairs) == (
        0,
        1,
        1,
    )
    world.component(other, Velocity).linear = (-30.0, 0.0)
    world.step()
    assert recorded(world) == [(one, other)]
    assert (world.contacts.proximity_count, world.contacts.count) == (0, 1)


@pytest.mark.parametrize("name", ["gas", "slope", "dominoes"])
def test_near_pairs_are_counted_from_the_present_motion_alone(name: str) -> None:
    world = load_scene(name)
    world.run(steps=40)
    rows, velocity = world.batch(Transform, Shape).rows, world.table(Velocity)
    bodies, moves = outlines_of(world, rows), velocity.present[rows]
    ways = np.where(moves[:, None], np.abs(velocity["linear"][rows]), 0.0) * world.simulation.dt
    reach, (i, j) = bodies.reach + 0.1 * bodies.size[:, None] + ways, np.triu_indices(len(rows), 1)
    low, high = bodies.place - reach, bodies.place + reach
    near = ((low[i] <= high[j]) & (low[j] <= high[i])).all(axis=1) & (moves[i] | moves[j])
    walls = 0
    if world.physics.bounds is not None:
        bounds = np.array(world.physics.bounds)
        walls = int((low[moves] <= bounds[:2]).sum() + (high[moves] >= bounds[2:]).sum())
    assert count_near_pairs(world) == near.sum() + walls >= world.contacts.count
    # The list is made when a body leaves its box; a world that goes on from here makes one of its own.
    assert count_near_pairs(read_scene(write_scene(world))) == count_near_pairs(world)


def test_pairs_that_part_are_proximity_pairs_in_the_next_list() -> None:
    world = World(BroadPhaseSystem(), ContactSystem())
    one, other = disc(world, 0.0, 0.0), disc(world, 1.0, 0.0)
    world.step()
    assert recorded(world) == [(one, other)]
    world.component(other, Transform).position = (1.08, 0.0)
    world.step()
    assert recorded(world) == [(one, other)]
    assert world.contacts.count == 0
    world.contacts.stale = True
    world.step()
    assert (world.contacts.recorded, world.contacts.proximity_count) == (0, 1)


def test_records_are_gone_through_in_the_order_of_rows_whenever_they_came() -> None:
    world = World(BroadPhaseSystem(), ContactSystem())
    for i in range(30):
        disc(world, 1.03 * (i % 6), 1.03 * (i // 6))
    world.step()
    assert world.contacts.recorded == 0
    random = np.random.default_rng(2)
    linear = world.table(Velocity)["linear"]
    for _ in range(12):  # so short a step that none leaves its fat box
        linear[random.integers(1, 31)] = random.uniform(-40.0, 40.0, 2)
        world.step(0.002)
    contacts = world.contacts
    assert contacts.recorded > 5
    assert recorded(world) != sorted(recorded(world))
    scalar = [recorded(world)[p] for p in contacts.scalar[: contacts.scalar_count]]
    assert scalar == sorted(recorded(world))
    reported = [(contact.a, contact.b) for contact in list_contacts(world)]
    assert reported == sorted(reported)


def test_a_gas_goes_on_with_the_same_bits_whatever_pairs_have_no_record() -> None:
    region = (-3.0, -2.0, 3.0, 2.0)
    laws = PhysicsConfig(gravity_mode="none", bounds=region, bounds_restitution=1.0)
    simulation = SimulationConfig(sleeping=False)
    worlds = [World(*standard_systems(), physics=laws, simulation=simulation) for _ in range(3)]
    for world in worlds:
        gas(world, 120, region)
    for step in range(120):
        for world in worlds:
            world.step()
        worlds[1].contacts.stale = True
        if step % 10 == 0:
            worlds[2] = read_scene(write_scene(worlds[2]))
        assert bits(worlds[0]) == bits(worlds[1]) == bits(worlds[2])
    assert worlds[0].collisions > 100


places = st.lists(st.tuples(st.floats(-6, 6), st.floats(-6, 6)), min_size=2, max_size=40)


@given(places, st.floats(0.0, 0.2), st.integers(0, 2**32 - 1))
def test_just_those_within_reach_are_promoted(made: list[tuple[float, float]], h: float, seed: int) -> None:
    position = np.array([(0.0, 0.0), *made])
    linear = np.random.default_rng(seed).uniform(-3.0, 3.0, position.shape)
    rows = len(position)
    couples = [(a, b) for a in range(1, rows) for b in range(a + 1, rows)]
    shuffled = np.random.default_rng(seed).permutation(couples)
    proximity, activation_distance = shuffled.astype(np.uint32).ravel(), np.full(len(couples), 0.8)
    room = len(couples)
    manifolds, points = np.zeros(room, MANIFOLD), np.zeros(2 * room, POINT)
    scalar, entities = np.zeros(room, np.int64), 10 * np.arange(rows)
    compile_kernels((activate,))
    proximity_count, count, scalar_count = activate(
        proximity,
        activation_distance,
        room,
        manifolds,
        points,
        0,
        scalar,
        0,
        entities,
        position,
        linear,
        h,
        0.01,
    )
    moved = np.abs(linear[:, None] - linear[None]).sum(axis=2) * h
    apart = np.linalg.norm(position[:, None] - position[None], axis=2) - (0.8 + np.sqrt(2.0) * (moved + 0.01))
    left = {tuple(pair) for pair in proximity[: 2 * proximity_count].reshape(-1, 2).tolist()}
    promoted = [(int(m["a"]), int(m["b"])) for m in manifolds[scalar[:scalar_count]]]
    assert count == scalar_count == room - proximity_count
    assert promoted == sorted(promoted)
    assert left | set(promoted) == set(couples)
    assert not left & set(promoted)
    assert all(apart[pair] < 1e-9 for pair in promoted)
    assert all(apart[pair] > -1e-9 for pair in left)
    assert (manifolds["entity_b"][:count] == 10 * manifolds["b"][:count]).all()


@given(
    st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9), st.integers(-1, 3)), max_size=60, unique=True)
)
def test_scalar_pairs_are_sorted_by_rows_and_walls(pairs: list[tuple[int, int, int]]) -> None:
    manifolds = np.zeros(len(pairs), MANIFOLD)
    for p, pair in enumerate(pairs):
        manifolds[p]["a"], manifolds[p]["b"], manifolds[p]["wall"] = pair
    scalar = np.arange(len(pairs))
    compile_kernels((near_pairs.sort_scalar,))
    near_pairs.sort_scalar(manifolds, scalar, len(pairs), 10)
    assert [pairs[p] for p in scalar] == sorted(pairs)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are not forked here")
def test_what_a_forked_process_does_changes_no_contact_here() -> None:
    """Memory that both share was that of the records: the world went on with what the other had found."""
    worlds = []
    for _ in range(2):
        world = World()
        box(world, (0.0, -0.5), width=20.0, height=1.0, static=True)
        for k in range(40):
            box(world, (0.51 * (k % 8) - 2.0, 0.25 + 0.51 * (k // 8)), velocity=(0.3 * (k % 3), 0.0))
        world.run(steps=20)
        worlds.append(world)
    child = os.fork()
    if child == 0:
        worlds[0].run(steps=30)
        os._exit(0)
    os.waitpid(child, 0)
    for world in worlds:
        world.run(steps=10)
    places = [world.table(Transform)["position"].tobytes() for world in worlds]
    assert places[0] == places[1]
