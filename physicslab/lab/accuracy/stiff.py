"""Springs and dampers that are fast beside the step: each for several z, the rate times a step of 10 ms."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import partial

from physicslab.components import Drag, Mass, Spring, Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.figures import number, record
from physicslab.lab.accuracy.problem import Ladder, Problem
from physicslab.lab.accuracy.states import state_error
from physicslab.lab.worlds import GRAVITY, empty_world, place, velocity
from physicslab.world import World

__all__ = ["STIFF"]

_STEP = 0.01
_problem = partial(Problem, group="stiff", dt=_STEP)
_RESTS = "its steps shrink without end as the weight comes to rest: they are measured by the present speed"


def _rate(z: str) -> Fraction:
    """Return z over the step of 10 ms [1/s]."""
    return Fraction(z) * 100


def _spring(z: str) -> Problem:
    rate = float(_rate(z))

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation, gravity=None)
        spring = Spring(rest_length=0, stiffness=float(_rate(z) ** 2))
        world.spawn(Transform((1, 0)), Velocity(), Mass(1), spring, name="bob")
        return world

    def error(world: World, i: int) -> float:
        x, v = number("stiff_spring", z, "x"), number("stiff_spring", z, "v_over_w")
        return state_error(world, "bob", (x, 0.0), (rate * v, 0.0), rate=rate)

    return _problem(
        name=f"stiff_spring_z{z}",
        title=f"An undamped spring, omega dt = {z} at 10 ms",
        source="stiff_spring",
        compared="x and v after 10 s",
        measure="largest error of x and of v / omega [m]",
        build=build,
        times=(10.0,),
        error=error,
        good=1e-4,
        excellent=1e-12,
        ladder=Ladder(1000, 6, by_step=True),
        keeps=frozenset({"energy", "angular_momentum"}),
    )


def _sag(z: str) -> Problem:
    def build(simulation: SimulationConfig) -> World:
        rate = _rate(z)
        world = empty_world(simulation)
        # A spring of no rest length, so that a sag of 0.1 um is not the difference of two lengths of 1 m.
        spring, damper = Spring(rest_length=0, stiffness=float(rate**2)), Drag(linear=float(rate / 10))
        world.spawn(Transform(), Velocity(), Mass(1), spring, damper, name="bob")
        return world

    def error(world: World, i: int) -> float:
        rest = number("stiff_spring_gravity_sag", z, "rest")
        return abs((place(world, "bob").y - number("stiff_spring_gravity_sag", z, "x_at_1s")) / rest)

    return _problem(
        name=f"stiff_spring_gravity_sag_z{z}",
        title=f"A weight let go on a damped spring, omega dt = {z} at 10 ms",
        source="stiff_spring_gravity_sag",
        compared="how far it hangs down after 1 s",
        measure="error as a share of the sag at rest",
        build=build,
        times=(1.0,),
        error=error,
        good=1e-9,
        excellent=1e-12,
        ladder=Ladder(100, 8, by_step=True),
        keeps=frozenset(),
        not_used={"dop853": _RESTS} if float(z) > 1.0 else {},
    )


def _damper(z: str) -> Problem:
    rate = float(_rate(z))

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation)
        world.spawn(Transform(), Velocity((0, 1)), Mass(1), Drag(linear=rate), name="bob")
        return world

    def error(world: World, i: int) -> float:
        expected = number("stiff_damper", z, ("v_10ms", "v_terminal")[i])
        return abs(velocity(world, "bob").y - expected)

    def energy(t: float) -> float:
        sink = GRAVITY / rate
        v = (1.0 + sink) * math.exp(-rate * t) - sink
        return 0.5 * v * v + GRAVITY * ((1.0 + sink) * -math.expm1(-rate * t) / rate - sink * t)

    return _problem(
        name=f"stiff_damper_z{z}",
        title=f"A body falling in syrup, c dt / m = {z} at 10 ms",
        source="stiff_damper",
        compared="the velocity after 10 ms, and after 4 s, when it has become steady",
        measure="largest error [m/s]",
        build=build,
        times=(_STEP, 4.0),
        error=error,
        good=1e-9,
        excellent=1e-13,
        ladder=Ladder(400, 6, by_step=True),
        exact_energy=energy,
    )


STIFF = (
    *map(_spring, record("stiff_spring")["reference"]),
    *map(_sag, record("stiff_spring_gravity_sag")["reference"]),
    *map(_damper, record("stiff_damper")["reference"]),
)
"""Their problems."""
