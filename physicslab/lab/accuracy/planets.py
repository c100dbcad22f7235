"""Bodies that attract each other: on orbits that come again, in close passages, and in a crowd."""

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial

from physicslab.components import Mass, Transform
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.accuracy.figures import number, record
from physicslab.lab.accuracy.problem import Ladder, Problem, distance
from physicslab.lab.worlds import PLANETS, empty_world, spawn_point
from physicslab.world import World

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
