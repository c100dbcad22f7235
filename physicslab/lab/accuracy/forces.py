"""Bodies that are driven, charges in fields, molecules; bodies that attract each other, few and many."""

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial

from physicslab.components import Charge, Drag, Mass, Molecule, Spring, Thrust, Transform
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.accuracy.problem import Ladder, Problem, distance, number, record, state_error
from physicslab.lab.closed_forms import crossed, driven, molecules_period, repelled
from physicslab.lab.worlds import PLANETS, empty_world, spawn_point
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


def _in_fields(name: str, title: str, electric_field: Vector2) -> Problem:
    """Return the problem of one charge in uniform fields, the magnetic one of 0.8 T."""
    mass, charge = 2.0, 3.0
    laws = PhysicsConfig(gravity_mode="none", electric_field=electric_field, magnetic_field=0.8)
    rate, share = charge * laws.magnetic_field / mass, charge / mass
    pull = complex(*laws.electric_field) * share

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation, laws)
        where, how = (_START.real, _START.imag), (_SPEED.real, _SPEED.imag)
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
    _in_fields("cyclotron", "A charge that circles in a magnetic field, 19 times", Vector2()),
    _in_fields(
        "crossed_fields", "A charge on a cycloid, in an electric and a magnetic field", Vector2(0.5, -1.0)
    ),
    _charged(
        name="rutherford", title="Two charges of one sign meet, and scatter", build=_two_charges,
        error=_rutherford_error, times=(1.0, 3.0), compared="places when they are nearest, and 2 s later",
        measure="largest distance from the true place [m]", keeps={"energy", "momentum", "angular_momentum"},
    ),
    Problem(
        name="two_molecules", title="Two molecules that oscillate, ten periods", group="molecules",
        build=_two_molecules, error=_molecules_error, times=(10.0 * _PERIOD,), good=1e-6, excellent=1e-10,
        compared="x, y, vx, vy after ten periods, which are found by quadrature", ladder=Ladder(2048),
        measure="largest error of x, y and of vx, vy over the rate [m]",
        keeps={"energy", "momentum", "angular_momentum"},
    ),
)  # fmt: skip
"""Every problem with forces of this kind."""


type _Pair = tuple[float, float]
type _Build = Callable[[SimulationConfig], World]

_problem = partial(
    Problem, group="gravity", keeps={"energy", "momentum", "angular_momentum"},
    measure="largest distance from the true place [m]",
)  # fmt: skip
_NAMES = ("1", "2", "3")


def _bodies(bodies: Iterable[tuple[_Pair, _Pair]], masses: Iterable[float], softening: float = 0.0) -> _Build:
    """Return what builds a world of bodies at places with velocities, named by their numbers from 1 on."""
    listed = list(zip(bodies, masses, strict=True))

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation, replace(PLANETS, softening=softening))
        for i, ((where, how), mass) in enumerate(listed, 1):
            spawn_point(world, where, how, mass=mass, name=str(i))
        return world

    return build


# ---- orbits ------------------------------------------------------------------------------------------------


def _kepler(e: str, nearest: float, speed: str, work: int) -> Problem:
    """Return the problem of a Kepler orbit with a = 1 about a fixed mass: digits of e and of the speed."""
    name = f"kepler_e{e}"

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation, PLANETS)
        world.spawn(Transform(), Mass(1), name="star")
        spawn_point(world, (nearest, 0), (0, float(speed)), name="planet")
        return world

    def error(world: World, i: int) -> float:
        moment = ("t=1", "t=10", "t=200pi+1")[i]
        return distance(world, {"planet": [number(name, moment, axis) for axis in "xy"]})

    return _problem(
        name=name, title=f"A Kepler orbit of eccentricity {e}, 100 times round and a bit", source=name,
        compared="position after 1, 10 and 200 pi + 1 s", build=build, error=error, good=1e-4,
        measure="largest distance from the true place [m], with a = 1 m", excellent=1e-10,
        times=(1.0, 10.0, 200.0 * math.pi + 1.0), ladder=Ladder(work), keeps={"energy", "angular_momentum"},
    )  # fmt: skip


_EIGHT = [(-1.0, 0.0), (1.0, 0.0), (0.0, 0.0)]
_EIGHT_PERIOD = number("figure_eight", "T")


def _figure_eight() -> _Build:
    p1, p2 = number("figure_eight", "p1"), number("figure_eight", "p2")
    return _bodies(zip(_EIGHT, [(p1, p2), (p1, p2), (-2.0 * p1, -2.0 * p2)], strict=True), [1.0] * 3)


def _figure_eight_error(world: World, i: int) -> float:
    # After a third of the period each body is where another was at the start: they chase each other.
    order = ((0, 1, 2), (1, 2, 0))[i]
    return distance(world, {name: _EIGHT[start] for name, start in zip(_NAMES, order, strict=True)})


def _simo() -> _Build:
    x, y, vx, vy = 0.97000436, -0.24308753, -0.93240737, -0.86473146
    half = (-0.5 * vx, -0.5 * vy)
    return _bodies((((x, y), half), ((-x, -y), half), ((0.0, 0.0), (vx, vy))), [1.0] * 3)


def _recorded(figures: tuple[str, ...], world: World, i: int) -> float:
    """Return how far three bodies are from the places on record."""
    return distance(world, {n: [number(*figures, f"{axis}{n}") for axis in "xy"] for n in _NAMES})


def _lagrange() -> _Build:
    # In this place most numbers are exact: each rounding at the start grows 85 times a period.
    half, radius = math.sqrt(3.0) / 2.0, 1.0 / math.sqrt(3.0)
    places = [(radius, 0.0), (-0.5 * radius, 0.5), (-0.5 * radius, -0.5)]
    return _bodies(zip(places, [(0.0, 1.0), (-half, -0.5), (half, -0.5)], strict=True), [1.0] * 3)


def _lagrange_problem(t: float, good: float, excellent: float) -> Problem:
    def error(world: World, i: int) -> float:
        angles = {name: 2.0 * n * math.pi / 3.0 + math.sqrt(3.0) * t for n, name in enumerate(_NAMES)}
        radius = 1.0 / math.sqrt(3.0)
        return distance(world, {n: tuple(Vector2.from_angle(angle, radius)) for n, angle in angles.items()})

    return _problem(
        name=f"lagrange_equal_t{t:g}", title=f"Three equal bodies circling in a triangle, for {t:g} s",
        source="lagrange_equal", build=_lagrange(), times=(t,), error=error, good=good, excellent=excellent,
        compared=f"positions after {t:g} s, a little more than {int(t / 3.62)} periods",
        measure="largest distance from the true place [m], with sides of 1 m", ladder=Ladder(512, 9),
        chaotic=True, note="unstable: what is rounded at the start grows 85 times a period",
    )  # fmt: skip


_eight = partial(
    _problem, source="figure_eight", good=1e-4, excellent=1e-11,
    measure="largest distance from the true place [m], with bodies 1 m apart",
)  # fmt: skip

# ---- without order -----------------------------------------------------------------------------------------

_LIMITS = {5: (1e-4, 1e-11), 10: (1e-4, 1e-10), 15: (1e-4, 1e-10), 20: (1e-4, 6e-10), 40: (1e-3, 4e-8),
           60: (1e-1, 4e-4), 70: (1.0, 1e-2)}  # fmt: skip
"""Good and excellent by time [s]. From 20 s on, excellent is what REBOUND's IAS15 does with doubles."""
_CORNERS: tuple[_Pair, ...] = ((1, 3), (-2, -1), (1, -1))


def _pythagorean(t: int) -> Problem:
    good, excellent = _LIMITS[t]
    return _problem(
        name=f"pythagorean_t{t}", source="pythagorean", compared=f"positions after {t} s", times=(float(t),),
        title=f"Masses of 3, 4 and 5 kg let go in a triangle of sides 3, 4 and 5 m, for {t} s",
        build=_bodies(((corner, (0.0, 0.0)) for corner in _CORNERS), (3, 4, 5)), good=good,
        error=partial(_recorded, ("pythagorean", f"t={t}")), excellent=excellent,
        ladder=Ladder(4096 * max(1, t // 5), 7), chaotic=True,
        note="chaotic: passages as close as 0.4 mm make each rounding grow",
    )  # fmt: skip


CROWD, CROWD_SOFTENING, CROWD_TIME = 100, 0.05, 2.3


def crowd() -> list[tuple[_Pair, _Pair]]:
    """Return place [m] and velocity [m/s] of each of 100 bodies of 10 g, with no random numbers in it.

    Radii are those of a Plummer disc by quantiles, directions advance by the golden angle, and every third
    body circles the other way; the speed is two thirds of that of a circular orbit. All are multiples of
    2^-20, so that arithmetic of any precision begins at the same numbers.
    """
    golden = math.pi * (3.0 - math.sqrt(5.0))
    bodies = []
    for i in range(CROWD):
        share = (i + 0.5) / CROWD
        radius = math.sqrt(share / (1.0 - 0.9 * share))
        speed = 2.0 / 3.0 * math.sqrt(share / radius) * (-1.0 if i % 3 == 0 else 1.0)
        where = Vector2.from_angle(i * golden, radius)
        how = where.normalized.perpendicular * speed
        x, y, vx, vy = (round(value * 2**20) / 2**20 for value in (*where, *how))
        bodies.append(((x, y), (vx, vy)))
    return bodies


def _crowd_error(world: World, i: int) -> float:
    places: dict[str, list[str]] = record("crowd100")["reference"]["places"]
    return distance(world, {f"{int(n) + 1}": [*map(float, digits)] for n, digits in places.items()})


ATTRACTED = (
    _kepler("0", 1.0, "1", 4096),
    _kepler("0.5", 0.5, "1.7320508075688772935", 16384),
    _kepler("0.9", 0.1, "4.3588989435406735522", 65536),
    _kepler("0.99", 0.01, "14.106735979665884425", 65536),
    _eight(
        name="figure_eight", title="Three bodies chasing each other round a figure of eight",
        compared="positions after 10 periods, and after 10 1/3, when each is where another was",
        build=_figure_eight(), error=_figure_eight_error, ladder=Ladder(2048, 9),
        times=(10.0 * _EIGHT_PERIOD, 31.0 / 3.0 * _EIGHT_PERIOD),
    ),
    _eight(
        name="figure_eight_simo", title="The figure of eight from a start of eight digits", times=(20.0,),
        compared="positions after 20 s", build=_simo(), ladder=Ladder(1024, 9),
        error=partial(_recorded, ("figure_eight", "simo_t20")),
    ),
    _lagrange_problem(7.5, 1e-6, 1e-12),
    _lagrange_problem(14.75, 1e-2, 1e-8),
    *map(_pythagorean, _LIMITS),
    _problem(
        name="crowd100", title="A hundred bodies that attract each other, softened", good=1e-4,
        compared=f"positions of all after {CROWD_TIME} s", times=(CROWD_TIME,), excellent=1e-6,
        build=_bodies(crowd(), [1.0 / CROWD] * CROWD, CROWD_SOFTENING), error=_crowd_error,
        ladder=Ladder(128, 5), note="our own, in place of plummer100, whose figures do not contain its start",
    ),
)  # fmt: skip
"""Their problems."""
