"""Stiff chains with dampers: as exact as can be seen, at the price of that."""

import numpy as np
import pytest

from physicslab import World
from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.reader import read_scene
from physicslab.files.writer import write_scene
from physicslab.systems.standard import standard_systems


def chain(stiffness: float, ratio: float = 0.3, **simulation: float | str) -> World:
    """Return a chain of 12 bodies of 1 kg that hangs between two points and swings, damped.

    The ratio is that of a spring's damping to the critical one, where one of its ends is fixed.
    """
    physics = PhysicsConfig(linear_damping=0.5)
    world = World(*standard_systems(), physics=physics, simulation=SimulationConfig(**simulation))  # type: ignore[arg-type]
    damping, last = 2.0 * ratio * stiffness**0.5, 0
    for n in range(12):
        body = world.spawn(Transform((0.1 * (n + 1), -0.02 * min(n, 11 - n))), Velocity(), Mass(1.0))
        link = {"rest_length": 0.1, "stiffness": stiffness, "damping": damping}
        world.spawn(Spring(a=body, **({"b": last} if last else {"anchor_b": (0, 0)}), **link))
        last = body
    world.spawn(Spring(a=last, anchor_b=(1.3, 0), **link))
    return world


def places(world: World) -> np.ndarray:
    found: np.ndarray = world.table(Transform)["position"][world.batch(Velocity).rows]
    return found


@pytest.mark.parametrize("stepped", [False, True])
def test_auto_takes_three_times_the_evaluations_of_1e_10_at_most_and_is_better_than_1e_11(
    stepped: bool,
) -> None:
    auto = chain(1e4)
    cheap, best = (chain(1e4, integrator="dop853", tolerance=tolerance) for tolerance in (1e-10, 1e-16))
    for world in (auto, cheap, best):
        if stepped:
            for _ in range(60):
                world.step()
        else:
            world.run(seconds=1.0)
    assert auto.plan.integrator.name == "dop853"
    assert "tolerance 1e-13" in auto.plan.reason
    assert np.abs(places(auto) - places(best)).max() < 1e-11
    assert auto.force_evaluations < 3 * cheap.force_evaluations
    assert auto.force_evaluations < 0.7 * best.force_evaluations  # which stops where forces are rounded


@pytest.mark.parametrize(("stiffness", "ratio"), [(1e3, 5.0), (1e4, 1.5), (1e4, 3.0), (1e5, 1.5)])
def test_what_dampers_stop_from_swinging_takes_no_more_than_can_be_seen(
    stiffness: float, ratio: float
) -> None:
    """It is better than 1e-11 m, in less than three times the evaluations of a tolerance of 1e-8."""
    auto = chain(stiffness, ratio)
    cheap, best = (chain(stiffness, ratio, integrator="dop853", tolerance=t) for t in (1e-8, 1e-14))
    for world in (auto, cheap, best):
        world.run(seconds=1.0)
    assert "tolerance 1e-09" in auto.plan.reason
    assert np.abs(places(auto) - places(best)).max() < 1e-11
    assert auto.force_evaluations < 3 * cheap.force_evaluations


def test_a_tolerance_that_was_chosen_and_springs_that_are_not_stiff_keep_theirs() -> None:
    for world, tolerance in ((chain(1e4, tolerance=1e-15), "1e-15"), (chain(10.0), "1e-17")):
        world.step()
        assert f"tolerance {tolerance}" in world.plan.reason


def test_a_loaded_chain_goes_on_with_the_same_bits() -> None:
    world = chain(1e4)
    world.run(steps=10)
    again = read_scene(write_scene(world))
    for going in (world, again):
        going.run(steps=10)
    assert places(again).tobytes() == places(world).tobytes()
