"""A world is marked, reset, copied and sent to another process, and goes on with the same bits."""

import copy
import pickle
from itertools import pairwise

import numpy as np
import pytest
from desk import bits, empty_world
from hypothesis import given
from hypothesis import strategies as st

from physicslab import World, load_scene
from physicslab.components import Mass, Name, Rod, Spring, Transform, Velocity
from physicslab.prefabs import box, circle
from physicslab.scenes import SCENES
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem


def after(world: World, steps: int = 40) -> tuple[bytes, float, int, str]:
    """Return all that a run leads to, and by what plan."""
    world.run(steps=steps)
    rows = world.batch(Transform).rows
    columns = *world.table(Transform).columns, *world.table(Velocity).columns, world.account.sums
    moved = b"".join(column[rows].tobytes() for column in columns[:-1]) + columns[-1].tobytes()
    return moved, world.time, world.collisions, repr(world.plan.kept)


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_that_is_reset_has_the_bits_of_a_fresh_one(name: str) -> None:
    world = load_scene(name)
    expected = after(world)
    for steps in (40, 7):
        world.reset()
        assert (world.time, world.steps) == (0.0, 0)
        assert after(world, steps) == (expected if steps == 40 else after(load_scene(name), steps))


@pytest.mark.parametrize("name", SCENES)
def test_a_copy_and_what_is_unpickled_go_on_with_the_same_bits(name: str) -> None:
    world = load_scene(name)
    world.run(steps=25)
    others, sent = [world.copy(), copy.deepcopy(world)], pickle.loads(pickle.dumps(world))
    expected = after(world)
    assert [after(other) for other in others] == [expected] * 2
    sent.run(steps=40)  # accounts and counts begin anew, as in a file that is opened
    assert bits(sent) == bits(world) and sent.time == world.time
    assert [other.title for other in (*others, sent)] == [world.title] * 3


@given(st.integers(0, 2**32), st.integers(1, 60), st.booleans())
def test_any_scene_that_is_reset_has_the_bits_of_a_fresh_one(seed: int, steps: int, edited: bool) -> None:
    check_reset(seed, steps, edited)


@pytest.mark.slow
def test_a_thousand_scenes_that_are_reset_have_the_bits_of_fresh_ones(pytestconfig: pytest.Config) -> None:
    for seed in range(round(1000 * pytestconfig.getoption("effort"))):
        check_reset(seed, 5 + seed % 40, seed % 2 == 1)


def check_reset(seed: int, steps: int, edited: bool) -> None:
    def made() -> World:
        random = np.random.default_rng(seed)
        world = empty_world(gravity=(0.0, -9.81 * random.integers(2)))
        bodies = []
        for n in range(random.integers(1, 9)):
            at, mass = (1.1 * n, random.uniform(0, 3)), random.uniform(0.1, 9)
            if random.integers(2):
                bodies.append(circle(world, at, radius=0.3, mass=mass))
            else:
                bodies.append(box(world, at, width=0.5, height=0.4, mass=mass))
        for a, b in pairwise(bodies):
            if random.integers(3) == 0:
                world.spawn(Rod(a, b) if random.integers(2) else Spring(a, b, rest_length=1.0, damping=0.1))
        box(world, (0.0, -1.0), width=30.0, height=1.0, static=True)
        return world

    world = made()
    expected = after(world, steps)
    if edited:
        world.component(world.entities()[0], Transform).position = (0.0, 9.0)
        world.spawn(Transform((3.0, 9.0)), Velocity(), Mass(1.0))
        world.run(steps=3)
    world.reset()
    assert after(world, steps) == expected
    world.reset()
    assert after(world, steps) == expected


def test_a_mark_is_gone_back_to_as_often_as_wanted() -> None:
    world = load_scene("newtons_cradle")
    world.run(steps=30)
    world.mark()
    marked = bits(world)
    expected = after(world)
    world.remove(world.entities()[0])
    world.reset()
    assert bits(world) == marked and world.steps == 30
    assert after(world) == expected


def test_a_world_that_grew_between_is_gone_back_in_as_often_as_wanted() -> None:
    world = load_scene("drop")
    expected = after(world)
    for count in (0, 100, 0, 1000):  # its columns are elsewhere in memory then
        more = [world.spawn(Transform((50.0 + k, 0.0)), Velocity(), Mass(1.0)) for k in range(count)]
        world.run(steps=2)
        for entity in more[::2]:
            world.remove(entity)
        world.reset()
        assert after(world) == expected
        world.reset()
        assert after(world) == expected


def test_a_world_that_was_not_stepped_is_where_it_was() -> None:
    world = load_scene("drop")
    before = bits(world)
    world.reset()
    assert bits(world) == before


def test_worlds_and_their_copies_do_not_mix() -> None:
    world = World(GravitySystem(), IntegrateSystem())
    ball = world.spawn(Transform(), Velocity(), Mass(1.0), Name("ball"))
    other = world.copy()
    other.component("ball", Mass).mass = 5.0
    other.spawn(Transform(), Name("second"))
    other.run(seconds=1.0)
    assert world.component(ball, Mass).mass == 1.0 and world.time == 0.0 and world.entities() == [ball]
    assert [type(system) for system in other.schedule.systems] == [type(s) for s in world.schedule.systems]
