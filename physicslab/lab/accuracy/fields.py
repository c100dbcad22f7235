"""Bodies that are driven, and charges in fields, whose motion has a closed form."""

import math
from functools import partial

from physicslab.components import Charge, Drag, Molecule, Spring, Thrust
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.accuracy.problem import Ladder, Problem, distance, state_error
from physicslab.lab.closed_forms import crossed, driven, molecules_period, repelled
from physicslab.lab.worlds import empty_world, spawn_point
from physicslab.world import World

_STIFFNESS, _DRAG, _STRENGTH = 100.0, 0.5, 2.0
"""Stiffness [N/m], damping [kg/s] and force [N] of the driven oscillators of 1 kg, whose own frequency is
10 rad/s."""


def _driven(share: float, title: str) -> Problem:
    """Return the problem of an oscillator that is driven at a share of its own frequency."""
    rate = share * math.sqrt(_STIFFNESS)

    def build(simulation: SimulationConfig) -> World:
        world, spring = empty_world(simulation, gravity=None), Spring(rest_length=0.0, stiffness=_STIFFNESS)
        drive = Thrust((_STRENGTH, 0.0), frequency=rate / (2.0 * math.pi))
        spawn_point(world, (0.1, 0.0), (0.0, 0.0), spring, Drag(linear=_DRAG), drive, name="body")
        return world

    def error(world: World, i: int) -> float:
        x, v = driven(_STIFFNESS, _DRAG, _STRENGTH, rate, 0.1, (1.0, 10.0)[i])
        return state_error(world, "body", (x, 0.0), (v, 0.0), math.sqrt(_STIFFNESS))

    return Problem(
        name=f"driven_{share:g}", source="driven", title=title, group="oscillator", build=build, error=error,
        compared="x and v after 1 and 10 s", measure="largest error of x and of v / omega [m]",
        times=(1.0, 10.0), good=1e-6, excellent=1e-10, ladder=Ladder(512), keeps=frozenset(),
    )  # fmt: skip


# ---- charges -----------------------------------------------------------------------------------------------

_START, _SPEED = complex(0.3, 0.1), complex(1.0, 0.5)
_charged = partial(Problem, group="charges", good=1e-6, excellent=1e-11, ladder=Ladder(512))


def _in_fields(name: str, title: str, mass: float, charge: float, laws: PhysicsConfig) -> Problem:
    """Return the problem of one charge in uniform fields."""
    rate, share = charge * laws.magnetic_field / mass, charge / mass
    pull = complex(*laws.electric_field) * share

    def build(simulation: SimulationConfig) -> World:
        world, where, how = (
            empty_world(simulation, laws),
            (_START.real, _START.imag),
            (_SPEED.real, _SPEED.imag),
        )
        spawn_point(world, where, how, Charge(charge), mass=mass, name="body")
        return world

    def error(world: World, i: int) -> float:
        z, speed = crossed(pull, rate, _START, _SPEED, (1.0, 100.0)[i])
        return state_error(world, "body", (z.real, z.imag), (speed.real, speed.imag), rate)

    return _charged(
        name=name, title=title, build=build, error=error, times=(1.0, 100.0),
        compared="x, y, vx, vy after 1 and 100 s",
        measure="largest error of x, y and of vx, vy over q B / m [m]",
    )  # fmt: skip


_AXIS, _EXCESS, _REPULSION, _BEFORE = 0.2, 1.5, 6.0, -1.0
"""Axis and shape of the hyperbola of two charges [m]; k q q (1/m + 1/m) [m^3/s^2]; the start before
the nearest point [s]."""


def _two_charges(simulation: SimulationConfig) -> World:
    laws = PhysicsConfig(gravity_mode="none", coulomb_constant=1.0)
    world, (z, speed) = empty_world(simulation, laws), repelled(_REPULSION, _AXIS, _EXCESS, _BEFORE)
    for name, share in (("light", 0.75), ("heavy", -0.25)):  # 1 kg and 3 kg, with 1 C and 4.5 C
        mass, charge = (1.0, 1.0) if share > 0.0 else (3.0, 4.5)
        where, how = share * z, share * speed
        parts = (where.real, where.imag), (how.real, how.imag), Charge(charge)
        spawn_point(world, *parts, mass=mass, name=name)
    return world


def _rutherford_error(world: World, i: int) -> float:
    z, _ = repelled(_REPULSION, _AXIS, _EXCESS, _BEFORE + (1.0, 3.0)[i])
    return distance(
        world, {"light": (0.75 * z.real, 0.75 * z.imag), "heavy": (-0.25 * z.real, -0.25 * z.imag)}
    )


# ---- molecules ---------------------------------------------------------------------------------------------

_DEPTH, _DISTANCE, _BOUND = 2.0, 0.5, -0.75
"""Depth [J] and distance [m] of two molecules of 1 kg; their energy as a share of the depth."""
_NEAREST, _PERIOD = molecules_period(_BOUND, math.sqrt(2.0 * _DEPTH) / _DISTANCE)


def _two_molecules(simulation: SimulationConfig) -> World:
    world = empty_world(simulation, gravity=None)
    for sign in (-1.0, 1.0):
        start = 0.5 * sign * _NEAREST * _DISTANCE, 0.0
        spawn_point(
            world, start, (0.0, 0.0), Molecule(_DEPTH, _DISTANCE), name="left" if sign < 0.0 else "right"
        )
    return world


def _molecules_error(world: World, i: int) -> float:
    x, rate = 0.5 * _NEAREST * _DISTANCE, 2.0 * math.pi / _PERIOD
    return max(
        state_error(world, name, (s * x, 0.0), (0.0, 0.0), rate) for name, s in (("left", -1), ("right", 1))
    )


FIELDS = (
    _driven(0.5, "A damped mass on a spring, driven at half its own frequency"),
    _driven(1.0, "The same at resonance"),
    _driven(2.0, "The same at twice its own frequency"),
    _in_fields(
        "cyclotron",
        "A charge that circles in a magnetic field, 19 times",
        2.0,
        3.0,
        PhysicsConfig(gravity_mode="none", magnetic_field=0.8),
    ),
    _in_fields(
        "crossed_fields",
        "A charge on a cycloid, in an electric and a magnetic field",
        2.0,
        3.0,
        PhysicsConfig(gravity_mode="none", electric_field=Vector2(0.5, -1.0), magnetic_field=0.8),
    ),
    _charged(
        name="rutherford",
        title="Two charges of one sign meet, and scatter",
        build=_two_charges,
        error=_rutherford_error,
        times=(1.0, 3.0),
        compared="places when they are nearest, and 2 s later",
        measure="largest distance from the true place [m]",
        keeps={"energy", "momentum", "angular_momentum"},
    ),
    Problem(
        name="two_molecules",
        title="Two molecules that oscillate, ten periods",
        group="molecules",
        build=_two_molecules,
        error=_molecules_error,
        times=(10.0 * _PERIOD,),
        good=1e-6,
        excellent=1e-10,
        compared="x, y, vx, vy after ten periods, which are found by quadrature",
        ladder=Ladder(2048),
        measure="largest error of x, y and of vx, vy over the rate [m]",
        keeps={"energy", "momentum", "angular_momentum"},
    ),
)
"""Every problem with forces of this kind."""
