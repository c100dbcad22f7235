"""Which bodies are near each other."""

from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np
import pytest
from desk import bits
from hypothesis import given, settings
from hypothesis import strategies as st

from physicslab import load_scene
from physicslab.components import Layer, Mass, Material, Pin, Rod, Shape, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.kernels.broad import grid, leaving
from physicslab.kernels.broad.leaving import NUMBER, FatBoxes
from physicslab.prefabs import gas
from physicslab.systems import broad_phase
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.standard import standard_systems
from physicslab.world import World

SOFT = SimulationConfig(contacts="soft", collisions="step", sleeping=False)


def near(world: World) -> list[tuple[int, int, int]]:
    """Return the near pairs as (entity, entity, wall)."""
    contacts, entities = world.contacts, world.entity_index.entities
    manifolds = contacts.manifolds[: contacts.recorded]
    recorded = [(int(m["entity_a"]), int(m["entity_b"]), int(m["wall"])) for m in manifolds]
    proximity = [
        (*pair, -1)
        for pair in entities[contacts.proximity[: 2 * contacts.proximity_count].reshape(-1, 2)].tolist()
    ]
    return sorted(recorded + proximity)


def body(world: World, x: float, y: float, shape: Shape, *, moves: bool = True, angle: float = 0.0) -> int:
    parts = (Velocity(), Mass(1.0)) if moves else ()
    return world.spawn(Transform((x, y), angle), shape, *parts)


def test_overlapping_bodies_are_a_pair_once_however_many_cells_they_span() -> None:
    world = World(BroadPhaseSystem())
    floor = body(world, 0, 0, Shape.box(40, 1), moves=False)
    balls = [body(world, x, 0.7, Shape.circle(0.25)) for x in range(-15, 16)]
    world.step()
    assert near(world) == [(floor, ball, -1) for ball in balls]


def test_far_bodies_are_no_pair() -> None:
    world = World(BroadPhaseSystem())
    body(world, 0, 0, Shape.circle(0.5))
    body(world, 3, 0, Shape.box(1, 1))
    world.step()
    assert near(world) == []


def test_static_and_kinematic_bodies_make_no_pairs_with_each_other() -> None:
    world = World(BroadPhaseSystem())
    body(world, 0, 0, Shape.circle(0.5), moves=False)
    world.spawn(Transform((0.1, 0)), Shape.circle(0.5), Velocity((1, 0)))
    ball = body(world, 0.2, 0, Shape.circle(0.5))
    world.step()
    assert [pair[:2] for pair in near(world)] == [(1, ball), (2, ball)]


def test_a_body_past_the_bounds_is_near_their_wall() -> None:
    world = World(BroadPhaseSystem(), physics=PhysicsConfig(bounds=(0, 0, 10, 10)))
    corner = body(world, 9.8, 0.2, Shape.circle(0.25))
    body(world, 5, 5, Shape.circle(0.25))
    world.step()
    assert near(world) == [(0, corner, 1), (0, corner, 2)]


def test_the_list_holds_until_a_body_leaves_its_fat_box() -> None:
    world = World(IntegrateSystem(), BroadPhaseSystem())
    ball = world.spawn(Transform((0, 0)), Velocity((2, 0)), Mass(1), Shape.circle(0.5))
    other = body(world, 5, 0, Shape.circle(0.5))
    world.step(0.01)
    assert near(world) == []
    world.run(seconds=2.0)
    assert near(world) == [(ball, other, -1)]


def test_a_changed_size_takes_effect() -> None:
    world = World(BroadPhaseSystem())
    ball = body(world, 0, 0, Shape.circle(0.5))
    other = body(world, 3, 0, Shape.circle(0.5))
    world.step()
    world.component(ball, Shape).radius = 2.6
    world.step()
    assert near(world) == [(ball, other, -1)]


sizes = st.floats(-3.0, 2.0).map(lambda exponent: 10.0**exponent)
bodies = st.tuples(
    st.floats(-20, 20), st.floats(-20, 20), sizes, sizes, st.floats(-4, 4), st.booleans(), st.booleans()
)


@given(st.lists(bodies, min_size=2, max_size=40), st.sampled_from([1.0, 1e-2, 1e7]))
def test_the_grid_finds_every_pair_that_touches_and_each_once(
    made: list[tuple[float, float, float, float, float, bool, bool]], spread: float
) -> None:
    world = World(BroadPhaseSystem())
    radii, moves, places = [], [], []
    for x, y, width, height, angle, is_circle, moving in made:
        shape = Shape.circle(width) if is_circle else Shape.box(width, height)
        body(world, x * spread, y * spread, shape, moves=moving, angle=angle)
        radii.append(width if is_circle else min(width, height) / 2)
        moves.append(moving)
        places.append((x * spread, y * spread))
    world.step()
    found = near(world)
    assert len(set(found)) == len(found)

    pairs = {(a, b) for a, b, _ in found}
    for i in range(len(made)):
        for j in range(i + 1, len(made)):
            if (moves[i] or moves[j]) and math.dist(places[i], places[j]) < radii[i] + radii[j]:
                assert (i + 1, j + 1) in pairs


@pytest.mark.parametrize("count", [300, 1200])
def test_the_number_of_pairs_grows_with_the_bodies_and_not_their_square(count: int) -> None:
    world = World(BroadPhaseSystem())
    for x, y in np.random.default_rng(3).uniform(0, math.sqrt(count), (count, 2)).tolist():
        body(world, x, y, Shape.circle(0.25))
    world.step()
    assert len(near(world)) < 2 * count


def funnel(seed: int, bounded: bool, apart: bool = False) -> World:
    """Return 90 discs and boxes that fall between slopes, past a plank that turns, to a floor or bounds.

    Where some are to be kept ``apart``, rods hold each third to the next, and each fifth is in a layer.
    """
    rng = np.random.default_rng(seed)
    bounds = PhysicsConfig(bounds=(-5.0, -3.0, 5.0, 30.0) if bounded else None)
    world = World(*standard_systems(), physics=bounds, simulation=SOFT)
    if not bounded:
        body(world, 0.0, -3.5, Shape.box(40.0, 1.0), moves=False)
    for side in (-1.0, 1.0):
        body(world, 2.6 * side, 1.5, Shape.box(5.0, 0.2), moves=False, angle=0.6 * side)
    world.spawn(Transform((0.0, -1.0)), Velocity((0.0, 0.0), 2.0), Shape.box(3.0, 0.1))
    for i in range(90):
        size = rng.uniform(0.15, 0.3)
        shape = Shape.box(size, size) if i % 2 else Shape.circle(0.5 * size)
        place = (-2.0 + 0.45 * (i % 10), 3.0 + 0.45 * (i // 10))
        world.spawn(
            Transform(place, rng.uniform(0.0, 3.0)), Velocity(tuple(rng.uniform(-2.0, 2.0, 2))), Mass(1.0),
            shape, Material(float(rng.choice((0.0, 0.6))), 0.4),
        )  # fmt: skip
    world.synchronise()
    if apart:
        *fallen, last = world.batch(Velocity, Mass).entities.tolist()
        for one, other in zip(fallen[::3], [*fallen[1::3], last], strict=False):
            world.spawn(Rod(one, other))
        for entity in fallen[::5]:
            world.add(entity, Layer(int(rng.integers(1, 4)), rng.choice(("own", "others", "none"))))
    return world


def kept_apart(world: World) -> set[tuple[int, int]]:
    """Return the pairs of entities that joints, or the words of Layer, keep from touching each other."""
    rods = [world.component(entity, Rod) for entity in world if world.has(entity, Rod)]
    found = {(min(rod.a, rod.b), max(rod.a, rod.b)) for rod in rods if rod.a and rod.b}
    layers = {entity: world.component(entity, Layer) for entity in world if world.has(entity, Layer)}

    def touches(one: int, other: int) -> bool:
        own, number = layers.get(one), layers[other].number if other in layers else None
        if own is None:
            return True
        return {"own": number in (own.number, None), "others": number != own.number}.get(own.touches, False)

    for one, other in itertools.combinations(world.entities(), 2):
        if not (touches(one, other) and touches(other, one)):
            found.add((one, other))
    return found


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 2**32 - 1), st.booleans(), st.booleans())
def test_new_pairs_of_few_bodies_give_the_same_bits_as_new_lists_of_all(
    seed: int, bounded: bool, apart: bool
) -> None:
    added, listed = funnel(seed, bounded, apart), funnel(seed, bounded, apart)
    system = added.schedule.find(BroadPhaseSystem)
    assert system is not None
    most = 0
    for _ in range(150):
        added.step()
        most = max(most, FatBoxes(*system.fat).counts[NUMBER])
    assert most > 3
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(broad_phase, "_FEW", 10**9)
        listed.run(steps=150)
    assert bits(added) == bits(listed)
    pairs = near(added)
    assert len(set(pairs)) == len(pairs)
    if apart:
        assert kept_apart(added).isdisjoint(pair[:2] for pair in pairs)


@pytest.mark.parametrize("seed", [10, 19, 30, 33])
def test_no_bit_depends_on_how_long_lists_hold(seed: int) -> None:
    """Pairs that had records of a longer list met what an impact had thrown at them; others did not."""
    worlds = [funnel(seed, seed % 2 > 0) for _ in range(2)]
    for world, ahead in zip(worlds, (1.0, 6.0), strict=True):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(broad_phase, "_LOOKAHEAD_OF_FEW", ahead)
            world.run(steps=150)
    assert bits(worlds[0]) == bits(worlds[1])


def test_in_a_gas_whose_records_are_few_all_pairs_are_listed_again() -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"), simulation=SOFT)
    gas(world, 300, (-4.0, -4.0, 4.0, 4.0))
    world.step()
    system = world.schedule.find(BroadPhaseSystem)
    assert system is not None
    listed = 0
    for _ in range(60):
        before = FatBoxes(*system.fat).boxes.copy()
        world.step()
        assert FatBoxes(*system.fat).counts[NUMBER] == 0, "no body had its new pairs alone listed"
        listed += not np.array_equal(before, FatBoxes(*system.fat).boxes)
    assert listed > 10
    assert 2 * world.contacts.recorded < len(world.entity_index)


def count_lists(world: World, steps: int) -> int:
    """Make steps; return how often pairs were listed."""
    system = world.schedule.find(BroadPhaseSystem)
    assert system is not None
    listed, list_pairs = 0, system.list_pairs

    def listing(state: World, h: float) -> None:
        nonlocal listed
        listed += 1
        list_pairs(state, h)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(system, "list_pairs", listing)
        world.run(steps=steps)
    return listed


def swinging_chains() -> World:
    """Return four chains of seven links on pins, let go side by side from the horizontal."""
    world = World(*standard_systems(), simulation=SOFT)
    for n in range(4):
        before: int | None = None
        for k in range(7):
            link = body(world, k + 0.5, 1.2 * n, Shape.box(0.9, 0.1))
            at = (0.0, 1.2 * n) if before is None else (0.5, 0.0)
            world.spawn(Pin(before, link, at, (-0.5, 0.0)))
            before = link
    world.synchronise()
    return world


def test_where_joints_keep_bodies_apart_lists_are_few_and_bits_the_same() -> None:
    seldom, often = swinging_chains(), swinging_chains()
    few = count_lists(seldom, 120)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(broad_phase, "_FURTHER_APART", 0.5)
        many = count_lists(often, 120)
    assert few < 0.5 * many
    assert bits(seldom) == bits(often)


@pytest.mark.parametrize("name", ["catapult", "car"])
def test_substeps_that_joined_bodies_need_do_not_depend_on_which_pairs_are_listed(name: str) -> None:
    moved = []
    for factor in (0.5, 4.0):
        world = load_scene(name)
        world.simulation = dataclasses.replace(world.simulation, contacts="soft")
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(broad_phase, "_FURTHER_APART", factor)
            world.run(steps=90)
        moved.append(bits(world))
    assert moved[0] == moved[1]


@pytest.mark.parametrize("bounded", [False, True])
def test_all_pairs_of_boxes_that_overlap_are_listed_when_some_have_left(bounded: bool) -> None:
    world = funnel(7, bounded)
    system = world.schedule.find(BroadPhaseSystem)
    assert system is not None
    for _ in range(120):
        world.step()
        inverse, listed = world.bodies.inverse_mass, {pair[:2] for pair in near(world)}
        boxes, entities = FatBoxes(*system.fat).boxes, world.entity_index.entities
        meet = (boxes[:, None, :2] <= boxes[None, :, 2:]).all(axis=2)
        meet &= meet.T & (inverse[:, None] + inverse[None] > 0.0)
        for a, b in zip(*np.nonzero(np.triu(meet, 1)), strict=True):
            reach = FatBoxes(*system.fat).ways[3, [a, b]]
            if max(reach) <= 4.0 * min(reach):  # else one may be beside the other
                assert (int(entities[a]), int(entities[b])) in listed


def test_a_body_whose_box_meets_more_cells_than_there_are_integers_is_listed_in_no_time() -> None:
    for speed in (1e10, 5e10, 9e10, 2e11, 5e11, 9e11):
        world = funnel(3, False)
        world.step()
        first = next(entity for entity in world.entities() if world.has(entity, Mass))
        world.component(first, Velocity).linear = (speed, speed)
        world.step()
        assert world.table(Transform)["position"].max() > 1e7


def crowd_that_falls(speed: float) -> World:
    """Return 400 discs in loose rows that fall together."""
    simulation = SimulationConfig(contacts="soft", collisions="step", sleeping=False)
    world = World(*standard_systems(), simulation=simulation)
    for i in range(400):
        place = (0.45 * (i % 20), 0.45 * (i // 20))
        world.spawn(Transform(place), Velocity((0.0, -speed)), Mass(1.0), Shape.circle(0.1))
    world.step()
    return world


def test_what_falls_together_is_near_what_is_before_it_and_not_what_is_beside_it() -> None:
    for speed, pairs_each in ((1.0, 2), (20.0, 10)):  # with a margin for its way on every side: 2 and 40
        assert len(near(crowd_that_falls(speed))) < pairs_each * 400


def test_a_fat_box_reaches_as_far_as_its_body_would_come_and_not_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(broad_phase, "_sparse", lambda state: False)  # as where many pairs have records
    world = World(*standard_systems(), simulation=SimulationConfig(contacts="soft", collisions="step"))
    for x, vx in ((0.0, 40.0), (50.0, -30.0)):
        world.spawn(Transform((x, 0.5 * x)), Velocity((vx, 0.0)), Mass(1.0), Shape.circle(0.5))
    world.step()
    system = world.schedule.find(BroadPhaseSystem)
    assert system is not None
    right, left = (
        FatBoxes(*system.fat).boxes[1:, 2] - (0.0, 50.0),
        (0.0, 50.0) - FatBoxes(*system.fat).boxes[1:, 0],
    )
    assert right[0] > 2.0 * left[0] > 1.0
    assert left[1] > 1.5 * right[1] > 0.75


def test_bodies_of_many_sizes_are_all_found_by_their_cells() -> None:
    sizes = np.tile((1.0, 3.0, 6.0, 9.0), 50)
    boxes, n = np.zeros((200, 4)), 200
    boxes[:, :2] = np.random.default_rng(2).uniform(0.0, 60.0, (n, 2))
    boxes[:, 2:] = boxes[:, :2] + sizes[:, None]
    first, (body, home_x, home_y) = np.zeros(513, np.int64), np.zeros((3, n), np.int64)
    sorted_ones, count, cell = leaving.index_bodies(boxes, np.ones(n, np.int64), first, body, home_x, home_y)
    assert (sorted_ones, count) == (n, n)
    assert cell < 4.0, "the small ones are in small cells"
    assert sorted(body.tolist()) == list(range(n))


@pytest.mark.parametrize("far", [60.0, 1e5])
def test_the_same_pairs_are_found_where_cells_are_shared_by_a_hash(far: float) -> None:
    """A body that is far out makes cells too many for a bucket each; what spans some cells looks at these."""
    chance, n = np.random.default_rng(5), 300
    boxes, fat = np.zeros((n, 4)), np.zeros((8, n))
    boxes[:, :2] = chance.uniform(0.0, 8.0, (n, 2))
    boxes[0, :2] = far
    boxes[:, 2:] = boxes[:, :2] + chance.choice((0.1, 0.3, 0.9), (n, 1), p=(0.7, 0.2, 0.1))
    pairs, couples = np.zeros((8, 3), np.int64), np.zeros(2 * 8192, np.uint32)
    found, walls, crowded = grid.find_pairs(
        boxes, fat, np.ones(n, np.int64), np.ones(n), False, np.zeros(4), pairs, couples
    )
    low, high = boxes[:, None, :2], boxes[:, None, 2:]
    meet = ((low <= boxes[None, :, 2:]) & (boxes[None, :, :2] <= high)).all(axis=2)
    expected = {(i, j) for i, j in np.argwhere(meet).tolist() if i < j}
    listed = np.sort(couples[: 2 * found].reshape(-1, 2), axis=1).tolist()
    assert (walls, crowded) == (0, False) and len(listed) == len(expected) > 100
    assert {(i, j) for i, j in listed} == expected
