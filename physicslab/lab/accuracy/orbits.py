"""Two and three bodies on orbits that come again."""

from __future__ import annotations

import math

from physicslab.components import Mass, Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.accuracy.figures import number
from physicslab.lab.accuracy.problem import Ladder, Problem
from physicslab.lab.accuracy.states import distance
from physicslab.lab.worlds import PLANETS, empty_world, place
from physicslab.world import World

__all__ = ["ORBITS"]

_ALL = frozenset({"energy", "momentum", "angular_momentum"})
_MOMENTS = ("t=1", "t=10", "t=200pi+1")


def _kepler(e: str, nearest: float, speed: str, work: int) -> Problem:
    """Return the problem of a Kepler orbit with a = 1 about a fixed mass: digits of e and of the speed."""
    name = f"kepler_e{e}"

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation, PLANETS)
        world.spawn(Transform(), Mass(1), name="star")
        world.spawn(Transform((nearest, 0)), Velocity((0, float(speed))), Mass(1), name="planet")
        return world

    def error(world: World, i: int) -> float:
        x, y = (number(name, _MOMENTS[i], key) for key in ("x", "y"))
        return distance(world, {"planet": (x, y)})

    return Problem(
        name=name,
        title=f"A Kepler orbit of eccentricity {e}, 100 times round and a bit",
        group="gravity",
        source=name,
        compared="position after 1, 10 and 200 pi + 1 s",
        measure="largest distance from the true place [m], with a = 1 m",
        build=build,
        times=(1.0, 10.0, 200.0 * math.pi + 1.0),
        error=error,
        good=1e-4,
        excellent=1e-10,
        ladder=Ladder(work),
        keeps=frozenset({"energy", "angular_momentum"}),
    )


def _spawn(world: World, places: list[tuple[float, float]], speeds: list[tuple[float, float]]) -> World:
    for i, (where, how) in enumerate(zip(places, speeds, strict=True), 1):
        world.spawn(Transform(where), Velocity(how), Mass(1), name=str(i))
    return world


_EIGHT_PLACES = [(-1.0, 0.0), (1.0, 0.0), (0.0, 0.0)]
_EIGHT_PERIOD = number("figure_eight", "T")


def _figure_eight(simulation: SimulationConfig) -> World:
    p1, p2 = number("figure_eight", "p1"), number("figure_eight", "p2")
    return _spawn(
        empty_world(simulation, PLANETS), _EIGHT_PLACES, [(p1, p2), (p1, p2), (-2.0 * p1, -2.0 * p2)]
    )


def _figure_eight_error(world: World, i: int) -> float:
    # After a third of the period each body is where another was at the start: they chase each other.
    order = (0, 1, 2) if i == 0 else _CHASE
    return distance(world, {str(1 + body): _EIGHT_PLACES[start] for body, start in enumerate(order)})


_CHASE = (1, 2, 0)


def _simo(simulation: SimulationConfig) -> World:
    x, y, vx, vy = 0.97000436, -0.24308753, -0.93240737, -0.86473146
    return _spawn(
        empty_world(simulation, PLANETS), [(x, y), (-x, -y), (0.0, 0.0)],
        [(-0.5 * vx, -0.5 * vy), (-0.5 * vx, -0.5 * vy), (vx, vy)],
    )  # fmt: skip


def _simo_error(world: World, i: int) -> float:
    found = {str(n): (f"x{n}", f"y{n}") for n in (1, 2, 3)}
    return distance(
        world,
        {body: [number("figure_eight", "simo_t20", key) for key in keys] for body, keys in found.items()},
    )


_RADIUS = number("lagrange_equal", "omega") / 3.0
_CORNERS = [0.0, 2.0 * math.pi / 3.0, 4.0 * math.pi / 3.0]
_LAGRANGE_TIMES = (7.5, 14.75)
_LAGRANGE_LIMITS = ((1e-6, 1e-12), (1e-2, 1e-8))


def _lagrange(simulation: SimulationConfig) -> World:
    # In this place most numbers are exact: each rounding at the start grows 85 times a period.
    half = math.sqrt(3.0) / 2.0
    radius = 1.0 / math.sqrt(3.0)
    places = [(radius, 0.0), (-0.5 * radius, 0.5), (-0.5 * radius, -0.5)]
    return _spawn(empty_world(simulation, PLANETS), places, [(0.0, 1.0), (-half, -0.5), (half, -0.5)])


def _lagrange_error(world: World, t: float) -> float:
    turn = math.sqrt(3.0) * t
    return max(
        math.hypot(*(place(world, str(i)) - Vector2.from_angle(corner + turn, 1.0 / math.sqrt(3.0))))
        for i, corner in enumerate(_CORNERS, 1)
    )


def _lagrange_problem(t: float, good: float, excellent: float) -> Problem:
    return Problem(
        name=f"lagrange_equal_t{t:g}",
        title=f"Three equal bodies circling in a triangle, for {t:g} s",
        group="gravity",
        source="lagrange_equal",
        compared=f"positions after {t:g} s, a little more than {int(t / 3.62)} periods",
        measure="largest distance from the true place [m], with sides of 1 m",
        build=_lagrange,
        times=(t,),
        error=lambda world, i: _lagrange_error(world, t),
        good=good,
        excellent=excellent,
        ladder=Ladder(512, 9),
        keeps=_ALL,
        chaotic=True,
        note="unstable: what is rounded at the start grows 85 times a period",
    )


def _eight(name: str, title: str, compared: str, times: tuple[float, ...], start: bool) -> Problem:
    return Problem(
        name=name,
        title=title,
        group="gravity",
        source="figure_eight",
        compared=compared,
        measure="largest distance from the true place [m], with bodies 1 m apart",
        build=_figure_eight if start else _simo,
        times=times,
        error=_figure_eight_error if start else _simo_error,
        good=1e-4,
        excellent=1e-11,
        ladder=Ladder(2048 if start else 1024, 9),
        keeps=_ALL,
    )


ORBITS = (
    _kepler("0", 1.0, "1", 4096),
    _kepler("0.5", 0.5, "1.7320508075688772935", 16384),
    _kepler("0.9", 0.1, "4.3588989435406735522", 65536),
    _kepler("0.99", 0.01, "14.106735979665884425", 65536),
    _eight(
        "figure_eight", "Three bodies chasing each other round a figure of eight",
        "positions after 10 periods, and after 10 1/3, when each is where another was",
        (10.0 * _EIGHT_PERIOD, 31.0 / 3.0 * _EIGHT_PERIOD), start=True,
    ),
    _eight(
        "figure_eight_simo", "The figure of eight from a start of eight digits", "positions after 20 s",
        (20.0,), start=False,
    ),
    *(_lagrange_problem(t, *limits) for t, limits in zip(_LAGRANGE_TIMES, _LAGRANGE_LIMITS, strict=True)),
)  # fmt: skip
"""Their problems."""
