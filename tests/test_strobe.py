"""Strobe pictures: kept at the exact multiples of an interval, wherever steps end."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from physicslab.components import Strobe, Transform, Velocity
from physicslab.history import AddComponent, History, RemoveComponent
from physicslab.prefabs import box, circle
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.strobe import StrobeSystem
from physicslab.world import World


def falling(interval: float, count: int = 100) -> tuple[World, StrobeSystem, int]:
    """Return a world with a stone that is thrown and turns."""
    system = StrobeSystem()
    world = World(GravitySystem(), IntegrateSystem(), system)
    body = circle(world, (0, 0), radius=0.1, velocity=(2.0, 3.0))
    world.component(body, Velocity).angular = 4.0
    world.add(body, Strobe(interval, count))
    return world, system, body


@given(st.floats(0.011, 0.5), st.floats(0.003, 0.1))
@settings(deadline=None, max_examples=30)
def test_places_are_those_of_the_exact_motion_at_the_multiples(interval: float, h: float) -> None:
    world, system, _ = falling(interval)
    for _ in range(min(round(1.0 / h), 120)):
        world.step(h)
    _, seen = system.pictures(world)
    x, y, angle, times = seen.T
    turns = np.arange(len(seen))
    assert np.array_equal(times, turns * interval)
    assert world.time - interval <= times[-1] + 1e-9 * interval <= world.time + 2e-9
    assert np.allclose(x, 2.0 * times, atol=1e-12) and np.allclose(angle, 4.0 * times, atol=1e-12)
    assert np.allclose(y, 3.0 * times - 0.5 * 9.81 * times**2, atol=1e-12)


def test_so_many_are_shown_as_the_strobe_has() -> None:
    world, system, body = falling(0.05, count=7)
    world.run(seconds=1.02)
    rows, seen = system.pictures(world)
    assert set(world.entity_index.entities[rows]) == {body}
    assert seen[:, 3] == pytest.approx(np.arange(14, 21) * 0.05)
    world.component(body, Strobe).count = 2
    world.run(seconds=0.1)
    assert len(system.pictures(world)[0]) == 2


def test_a_long_step_keeps_no_more_than_is_shown() -> None:
    world, system, _ = falling(0.001, count=5)
    world.step(1.0)
    assert system.pictures(world)[1][:, 3] == pytest.approx([0.995, 0.996, 0.997, 0.998, 0.999])


def test_a_ball_that_bounces_is_never_shown_below_the_floor() -> None:
    world = World(*standard_systems())
    ball = circle(world, (0, 1.0), radius=0.1, restitution=0.9)
    world.spawn(*floor())
    world.add(ball, Strobe(0.005, 200))
    world.run(seconds=2.5)
    system = world.schedule.find(StrobeSystem)
    assert system is not None
    seen = system.pictures(world)[1]
    assert len(seen) == 200 and seen[:, 1].min() > 0.1 - 2e-3


def floor() -> list[object]:
    scratch = World()
    entity = box(scratch, (0, -0.5), width=10, height=1, static=True, restitution=0.9)
    return [type(part)(**part.given()) for part in scratch.components(entity)]


def test_it_leaves_itself_out_and_its_record_goes_with_the_strobe() -> None:
    world, system, body = falling(0.05)
    world.run(seconds=0.5)
    assert len(system.pictures(world)[0])
    world.discard(body, Strobe)
    world.step()
    assert not len(system.pictures(world)[0]) and world.schedule.find(StrobeSystem) is None
    assert any(one.reason == "no Strobe in the scene" for one in world.schedule.left_out)


@given(st.lists(st.integers(0, 120), min_size=1, max_size=5))
@settings(deadline=None, max_examples=15)
def test_going_back_in_time_gives_the_pictures_of_a_fresh_run(places: list[int]) -> None:
    world, system, body = falling(0.04, count=12)
    history, fresh = History(world), []
    fresh.append(system.pictures(world)[1])
    for _ in range(120):
        history.step(1 / 60)
        fresh.append(system.pictures(world)[1])
    for place in places:
        history.seek(place)
        assert np.array_equal(system.pictures(world)[1], fresh[place])
    history.seek(120)
    history.do(RemoveComponent(body, "Strobe"))
    history.undo()
    assert np.array_equal(system.pictures(world)[1], fresh[120])


def test_a_strobe_that_comes_later_begins_there() -> None:
    world = World(IntegrateSystem(), StrobeSystem())
    body = world.spawn(Transform(), Velocity((1.0, 0.0)))
    history = History(world)
    history.step(0.01, steps=33)
    history.do(AddComponent(body, Strobe(0.1)))
    history.step(0.01, steps=33)
    system = world.schedule.find(StrobeSystem)
    assert system is not None
    assert system.pictures(world)[1][:, 3] == pytest.approx([0.4, 0.5, 0.6])
