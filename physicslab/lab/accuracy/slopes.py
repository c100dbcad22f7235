"""Bodies on inclined planes: how fast they go down, and from which friction or angle on they do."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.accuracy.figures import number
from physicslab.lab.accuracy.problem import Ladder, Problem
from physicslab.lab.worlds import empty_world, place, velocity
from physicslab.prefabs import box
from physicslab.world import World

__all__ = ["SLOPES"]

_problem = partial(Problem, group="contact", touches=True)
_THETA = math.pi / 6.0
_NONE: frozenset[str] = frozenset()


def _plane(simulation: SimulationConfig, angle: float, friction: float) -> tuple[World, Vector2]:
    """Return a world with a plane through the origin that rises to the right, and its unit normal."""
    world = empty_world(simulation)
    normal = Vector2.from_angle(angle).perpendicular
    box(world, normal * -0.5, width=60, height=1, angle=angle, static=True, friction=friction)
    return world, normal


def _block(simulation: SimulationConfig, friction: float) -> World:
    world, normal = _plane(simulation, _THETA, friction)
    box(world, normal * 0.25, width=1, height=0.5, angle=_THETA, friction=friction, name="body")
    return world


def _wheel(simulation: SimulationConfig, friction: float, share: float) -> World:
    world, normal = _plane(simulation, _THETA, friction)
    shape = Shape.circle(0.5), Material(0, friction), Mass(1, inertia=share * 0.25)
    world.spawn(Transform(normal * 0.5), Velocity(), *shape, name="body")
    return world


def _gone(world: World) -> tuple[float, float]:
    """Return how far down the body is [m], and how fast it goes down [m/s]; it started over the origin."""
    down = -Vector2.from_angle(_THETA)
    return place(world, "body").dot(down), velocity(world, "body").dot(down)


def _going(name: str, title: str, key: str, build: Callable[[SimulationConfig], World]) -> Problem:
    def error(world: World, i: int) -> float:
        distance, speed = _gone(world)
        acceleration = number("incline", key)
        return max(abs(2.0 * distance / acceleration - 1.0), abs(speed / acceleration - 1.0))

    return _problem(
        name=f"incline_{name}",
        title=title,
        source="incline",
        compared="distance and speed after 1 s",
        measure="largest relative error of the acceleration that they stand for",
        build=build,
        times=(1.0,),
        error=error,
        good=1e-3,
        excellent=1e-9,
        ladder=Ladder(240, 4, by_step=True),
        keeps=frozenset({"energy"}) if "rolling" in key else _NONE,
    )


def _held_error(world: World, i: int) -> float:
    return abs(_gone(world)[0])


def _bisect(low: float, high: float, width: float, above: Callable[[float], bool]) -> float:
    """Return where ``above`` turns from false to true, to half of ``width``."""
    while high - low > width:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if above(middle) else (middle, high)
    return 0.5 * (low + high)


def _threshold(simulation: Callable[[], SimulationConfig]) -> float:
    """Return the relative error of the friction from which on a block is held."""

    def held(friction: float) -> bool:
        world = _block(simulation(), friction)
        world.run(seconds=2.0)
        return _gone(world)[1] < 1e-4

    true = number("incline", "block_slides_if_mu_below")
    return abs(_bisect(0.55, 0.6, 2e-5, held) / true - 1.0)


def _topple_at(simulation: SimulationConfig, angle: float) -> World:
    world, normal = _plane(simulation, angle, 1.0)
    box(world, normal, width=1, height=2, angle=angle, friction=1, name="body")
    return world


def _topple_error(simulation: Callable[[], SimulationConfig]) -> float:
    """Return the error of the angle from which on a box falls over [deg]."""

    def topples(degrees: float) -> bool:
        angle = math.radians(degrees)
        world = _topple_at(simulation(), angle)
        world.run(seconds=4.0)
        return abs(world.component(world.entity("body"), Transform).angle - angle) > 0.2

    return abs(_bisect(25.5, 27.5, 4e-3, topples) - number("box_topple", "theta_deg"))


def _never(world: World, i: int) -> float:
    raise NotImplementedError("what is compared is looked for with many worlds")


SLOPES = (
    _going("block", "A block slides down 30 degrees, mu = 0.4", "block_a_mu04", lambda s: _block(s, 0.4)),
    _going("disc", "A disc rolls down 30 degrees", "disc_rolling_a", lambda s: _wheel(s, 0.6, 0.5)),
    _going("sphere", "A sphere rolls down 30 degrees", "sphere_rolling_a", lambda s: _wheel(s, 0.6, 0.4)),
    _going(
        "slipping",
        "A disc slips down 30 degrees, mu = 0.1",
        "disc_slip_mu01_a",
        lambda s: _wheel(s, 0.1, 0.5),
    ),
    _problem(
        name="incline_held",
        title="A block that friction holds on 30 degrees, mu = 0.7",
        source="incline",
        compared="how far it has gone after 10 s",
        measure="way [m]",
        build=lambda s: _block(s, 0.7),
        times=(10.0,),
        error=_held_error,
        good=1e-4,
        excellent=1e-12,
        ladder=Ladder(2400, 2, by_step=True),
    ),
    _problem(
        name="incline_threshold",
        title="The friction that just holds a block on 30 degrees",
        source="incline",
        compared="the smallest friction with which it stands still after 2 s, by bisection",
        measure="relative error of the coefficient",
        build=lambda s: _block(s, 0.5),
        times=(2.0,),
        error=_never,
        good=1e-2,
        excellent=1e-3,
        ladder=Ladder(480, 3, by_step=True),
        keeps=_NONE,
        search=_threshold,
    ),
    _problem(
        name="box_topple",
        title="The slope on which a box of 1 m by 2 m falls over",
        compared="the smallest angle at which it has fallen after 4 s, by bisection",
        measure="error of the angle [deg]",
        build=lambda s: _topple_at(s, math.radians(26.0)),
        times=(4.0,),
        error=_never,
        good=0.5,
        excellent=0.05,
        ladder=Ladder(960, 3, by_step=True),
        keeps=_NONE,
        search=_topple_error,
    ),
)
"""Their problems."""
