"""TrailSystem: it records where bodies have been, and changes nothing of the world."""

import numpy as np
import pytest
from desk import bits, empty_world

from physicslab.components import Mass, Trail, Transform, Velocity
from physicslab.files.scene import load_scene
from physicslab.prefabs import circle
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.trail import SAMPLES, TrailSystem
from physicslab.world import World


def gliding(length: float = 1.0) -> tuple[World, TrailSystem, int]:
    """Return a world with one body that moves at 2 m/s to the right, from the origin."""
    system = TrailSystem()
    world = World(IntegrateSystem(), system)
    return world, system, world.spawn(Transform(), Velocity((2, 0)), Trail(length))


def test_the_record_is_where_the_body_was() -> None:
    world, system, body = gliding()
    world.run(seconds=0.5)
    places, times = system.path(body)
    assert times[0] == 0.0 and times[-1] == pytest.approx(0.5, abs=1e-12)
    assert len(times) == 31 and (np.diff(times) > 0.0).all()
    assert np.allclose(places, np.stack((2.0 * times, 0.0 * times), axis=1), atol=1e-12)


@pytest.mark.parametrize("length", [0.3, 1.0, 2.13, 10.0, 1000.0])
def test_it_goes_back_as_far_as_its_length_in_bounded_room(length: float) -> None:
    world, system, body = gliding(length)
    world.step()
    for _ in range(SAMPLES * 3):
        world.step(length / 150)
    _, times = system.path(body)
    assert len(times) <= SAMPLES
    assert 0.96 * length <= times[-1] - times[0] <= length * (1.0 + 1e-9)
    assert times[-1] == pytest.approx(world.time)


def test_paths_of_all_end_where_the_bodies_are() -> None:
    world, system, first = gliding()
    world.run(steps=200)
    second = world.spawn(Transform((5, 5)), Velocity((0, 1)), Trail(0.5))
    world.run(steps=10)
    places, ages = system.paths()
    assert system.entities.tolist() == [first, second]
    assert np.allclose(places[:, -1], world.table(Transform)["position"][[1, 2]])
    assert ages[:, -1].tolist() == [0.0, 0.0]
    shown = ages[1] <= 1.0
    assert shown.sum() == 12 and np.allclose(places[1, shown][0], (5, 5))


def test_the_record_goes_with_the_body_and_with_its_trail() -> None:
    world, system, first = gliding()
    second = world.spawn(Transform((0, 1)), Velocity((1, 0)), Trail())
    third = world.spawn(Transform((0, 2)), Velocity((1, 0)), Trail())
    world.run(steps=20)
    kept = system.path(third)[0]
    world.remove(first)
    world.discard(second, Trail)
    world.synchronise()
    assert system.entities.tolist() == [third]
    assert np.array_equal(system.path(third)[0], kept)
    with pytest.raises(KeyError, match="has no trail on record"):
        system.path(first)
    world.clear()
    world.synchronise()
    assert not len(system.entities)


def test_a_clock_that_is_set_back_begins_a_new_record() -> None:
    world, system, body = gliding()
    world.run(steps=20)
    world.time = 0.0
    world.run(steps=3)
    assert len(system.path(body)[1]) == 3


def test_it_is_left_out_without_a_trail() -> None:
    world = empty_world()
    ball = circle(world, (0, 0))
    world.synchronise()
    assert {out.name: out.reason for out in world.schedule.left_out}["TrailSystem"] == (
        "no Trail in the scene"
    )
    world.add(ball, Trail())
    world.synchronise()
    assert world.schedule.find(TrailSystem) is not None


@pytest.mark.parametrize("name", ["bounces", "billiards", "newtons_cradle", "stack"])
def test_recording_changes_no_bit_of_the_world(name: str) -> None:
    plain, recorded = load_scene(name), load_scene(name)
    for entity in recorded.entities():
        if recorded.has(entity, Mass):
            recorded.add(entity, Trail())
    plain.run(steps=300)
    recorded.run(steps=300)
    assert bits(plain) == bits(recorded)


def of_trails(world: World) -> TrailSystem:
    system = world.schedule.find(TrailSystem)
    assert system is not None
    return system


@pytest.mark.parametrize("length", [0.3, 1.0, 3.1, 40.0])
def test_one_call_of_many_steps_records_what_single_steps_do(length: float) -> None:
    (one, long, body), (other, short, _) = gliding(length), gliding(length)
    still, _ = (world.spawn(Transform((0, 3)), Trail(length)) for world in (one, other))
    other.component(still, Trail).length = one.component(still, Trail).length = 2.0 * length
    one.run(steps=700)
    for _ in range(700):
        other.step()
    assert one.schedule.timings["TrailSystem"].calls == 1
    assert other.schedule.timings["TrailSystem"].calls == 700
    for of in (body, still):
        (places, times), (expected, at) = long.path(of), short.path(of)
        assert len(times) == len(at) and np.allclose(places, expected, rtol=0.0, atol=1e-12)
        assert np.allclose(times, at, rtol=0.0, atol=1e-12)


def test_islands_and_recorded_runs_leave_a_trail() -> None:
    worlds = [load_scene("crossed_fields") for _ in range(4)]
    for _ in range(150):
        worlds[0].step()
    worlds[1].run(steps=150)
    worlds[2].record(seconds=150 * worlds[2].simulation.dt)
    worlds[3].record(seconds=150 * worlds[3].simulation.dt, every=0.1)
    assert worlds[1].islands.members
    for world in worlds[1:]:
        for entity in of_trails(world).entities.tolist():
            (places, times), (expected, at) = of_trails(world).path(entity), of_trails(worlds[0]).path(entity)
            assert np.allclose(times, at, rtol=0.0, atol=1e-9)
            assert np.allclose(places, expected, rtol=0.0, atol=1e-9)


def test_a_call_that_makes_fewer_steps_than_it_might_records_those() -> None:
    worlds = [load_scene("carts") for _ in range(2)]  # one stepper leaves each step to another
    cart = worlds[0].batch(Transform, Velocity).entities.tolist()[0]
    for world in worlds:
        world.add(cart, Trail(5.0))
    worlds[0].run(steps=150)
    for _ in range(150):
        worlds[1].step()
    (places, times), (expected, at) = (of_trails(world).path(cart) for world in worlds)
    assert np.allclose(times, at, rtol=0.0, atol=1e-9) and times[-1] == pytest.approx(2.5)
    assert np.allclose(places, expected, rtol=0.0, atol=1e-9)


def test_what_is_undone_and_made_again_is_recorded_once() -> None:
    world = load_scene("two_planets")
    world.mark()
    world.run(steps=300)
    first = [of_trails(world).path(entity) for entity in of_trails(world).entities.tolist()]
    world.reset()
    world.run(steps=300)
    again = [of_trails(world).path(entity) for entity in of_trails(world).entities.tolist()]
    for (places, times), (expected, at) in zip(again, first, strict=True):
        assert np.array_equal(times, at) and np.array_equal(places, expected)
