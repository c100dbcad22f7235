"""Masses on springs, damped and not, and one that swings."""

from __future__ import annotations

import math

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.figures import number
from physicslab.lab.accuracy.problem import Ladder, Problem
from physicslab.lab.accuracy.states import state_error
from physicslab.lab.worlds import empty_world
from physicslab.world import World

__all__ = ["OSCILLATORS"]

_RATE = 2.0 * math.pi


def _harmonic(simulation: SimulationConfig) -> World:
    world = empty_world(simulation, gravity=None)
    spring = Spring(rest_length=0, stiffness=4.0 * math.pi**2)
    world.spawn(Transform((1, 0)), Velocity(), Mass(1), spring, name="bob")
    return world


def _harmonic_error(world: World, i: int) -> float:
    x, v = number("harmonic", "x"), number("harmonic", "v")
    return state_error(world, "bob", (x, 0.0), (v, 0.0), rate=_RATE)


def _damped(name: str, title: str, damping: float) -> Problem:
    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation, gravity=None)
        spring = Spring(rest_length=0, stiffness=100, damping=damping)
        world.spawn(Transform((1, 0)), Velocity(), Mass(1), spring, name="bob")
        return world

    def error(world: World, i: int) -> float:
        return state_error(world, "bob", (number(name, "x"), 0.0), (number(name, "v"), 0.0), rate=10.0)

    return Problem(
        name=name,
        title=title,
        group="oscillator",
        source=name,
        compared="x and v after 0.7 s",
        measure="largest error of x and of v / omega [m]",
        build=build,
        times=(0.7,),
        error=error,
        good=1e-6,
        excellent=1e-13,
        ladder=Ladder(32, 9),
        exact_energy=lambda t: _damped_energy(0.5 * damping, t),
    )


def _damped_energy(decay: float, t: float) -> float:
    """Return the energy [J] at a time: x'' + 2 decay x' + 100 x = 0 from x = 1 at rest."""
    gap = 100.0 - decay * decay
    if gap > 0.0:
        rate = math.sqrt(gap)
        swing, slope = math.cos(rate * t), math.sin(rate * t) / rate
    elif gap < 0.0:
        rate = math.sqrt(-gap)
        swing, slope = math.cosh(rate * t), math.sinh(rate * t) / rate
    else:
        swing, slope = 1.0, t
    left = math.exp(-decay * t)
    x, v = left * (swing + decay * slope), -100.0 * left * slope
    return 0.5 * v * v + 50.0 * x * x


_MOMENTS = ("t=1", "t=5", "t=10")


def _elastic_pendulum(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    spring = Spring(rest_length=1, stiffness=40)
    world.spawn(Transform((1.2, 0)), Velocity(), Mass(1), spring, name="bob")
    return world


def _elastic_pendulum_error(world: World, i: int) -> float:
    x, y, vx, vy = (number("elastic_pendulum", _MOMENTS[i], key) for key in ("x", "y", "vx", "vy"))
    return state_error(world, "bob", (x, y), (vx, vy), rate=math.sqrt(40.0))


OSCILLATORS = (
    Problem(
        name="harmonic",
        title="A mass on a spring, 100 1/4 periods",
        group="oscillator",
        compared="x and v after 100.25 s, where x = 0: an error of the phase shows in full",
        measure="largest error of x and of v / omega [m]",
        build=_harmonic,
        times=(100.25,),
        error=_harmonic_error,
        good=1e-4,
        excellent=1e-12,
        ladder=Ladder(8192),
        keeps=frozenset({"energy", "angular_momentum"}),
    ),
    _damped("damped_under", "A mass on a spring with weak damping (0.1 of critical)", 2.0),
    _damped("damped_critical", "A mass on a spring with critical damping", 20.0),
    _damped("damped_over", "A mass on a spring with strong damping (5 times critical)", 100.0),
    Problem(
        name="elastic_pendulum",
        title="A mass that swings on a spring",
        group="pendulum",
        compared="x, y, vx, vy after 1, 5 and 10 s",
        measure="largest error of x, y and of vx, vy over sqrt(k / m) [m]",
        build=_elastic_pendulum,
        times=(1.0, 5.0, 10.0),
        error=_elastic_pendulum_error,
        good=1e-5,
        excellent=1e-11,
        ladder=Ladder(512),
    ),
)
"""Their problems."""
