"""Bodies thrown and dropped, in the void and in air."""

from __future__ import annotations

import math
from functools import partial

from physicslab.components import Drag, Mass, Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.figures import digits, number
from physicslab.lab.accuracy.problem import Ladder, Problem
from physicslab.lab.accuracy.states import state_error
from physicslab.lab.worlds import GRAVITY, empty_world, place, velocity
from physicslab.prefabs import box, circle
from physicslab.world import World

__all__ = ["BALLISTIC"]


_problem = partial(Problem, group="ballistic")


def _free_fall(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    world.spawn(Transform((0, 20)), Velocity((5, 0)), Mass(1), name="ball")
    return world


def _free_fall_error(world: World, i: int) -> float:
    where, how = place(world, "ball"), velocity(world, "ball")
    return max(abs(where.x - number("free_fall", "x")), abs(where.y - number("free_fall", "y")),
               abs(how.y - number("free_fall", "vy")))  # fmt: skip


def _projectile(simulation: SimulationConfig) -> World:
    # A ball starts on the floor; one that gives all of its speed back shows by where it is later when it hit.
    world = empty_world(simulation)
    box(world, (30, -0.5), width=100, height=1, static=True, restitution=1, friction=0)
    speed = (10.0, 10.0 * math.sqrt(3.0))
    circle(world, (0, 0.25), radius=0.25, velocity=speed, restitution=1, friction=0, name="ball")
    return world


def _projectile_error(world: World, i: int) -> float:
    reach, apex = number("projectile", "R"), number("projectile", "H")
    where, how = place(world, "ball"), velocity(world, "ball")
    passed = (0.5, 1.5)[i]
    return max(abs(where.x - passed * reach), abs(where.y - 0.25 - apex), abs(how.y / GRAVITY))


def _drag_linear(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    world.spawn(Transform(), Velocity((10, 15)), Mass(2), Drag(linear=0.5), name="ball")
    return world


def _drag_linear_error(world: World, i: int) -> float:
    x, y, vx, vy = (number("drag_linear", key) for key in ("x", "y", "vx", "vy"))
    return state_error(world, "ball", (x, y), (vx, vy))


def _drag_linear_energy(t: float) -> float:
    mass, rate = 2.0, 0.25  # c / m [1/s]
    gone, sink = -math.expm1(-rate * t) / rate, GRAVITY / rate
    vx, vy = 10.0 * math.exp(-rate * t), (15.0 + sink) * math.exp(-rate * t) - sink
    return mass * (0.5 * (vx * vx + vy * vy) + GRAVITY * ((15.0 + sink) * gone - sink * t))


def _drag_quadratic(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    world.spawn(Transform(), Velocity(), Mass(1), Drag(quadratic=0.1), name="ball")
    return world


def _drag_quadratic_error(world: World, i: int) -> float:
    depth, speed = (float(digits("drag_quadratic", key)) for key in ("d", "v"))
    return state_error(world, "ball", (0.0, -depth), (0.0, -speed))


def _drag_quadratic_energy(t: float) -> float:
    # v = v_t tanh(g t / v_t); the distance is its integral.
    terminal = math.sqrt(GRAVITY / 0.1)
    speed = terminal * math.tanh(GRAVITY * t / terminal)
    fallen = terminal**2 / GRAVITY * math.log(math.cosh(GRAVITY * t / terminal))
    return 0.5 * speed * speed - GRAVITY * fallen


_FLIGHT = number("projectile", "T")

BALLISTIC = (
    _problem(
        name="free_fall",
        title="Free fall with a sideways throw",
        compared="x, y, vy after 2 s",
        measure="largest error [m], [m/s]",
        build=_free_fall,
        times=(2.0,),
        error=_free_fall_error,
        good=1e-12,
        excellent=4.0 * math.ulp(20.0),
        ladder=Ladder(16),
    ),
    _problem(
        name="projectile",
        title="A ball thrown at 60 degrees, bouncing off level ground",
        compared="range, apex and flight time, from the states at half and at one and a half flights",
        measure="largest error of x, y [m] and of the time [s]",
        build=_projectile,
        times=(0.5 * _FLIGHT, 1.5 * _FLIGHT),
        error=_projectile_error,
        good=1e-6,
        excellent=1e-13,
        ladder=Ladder(1280, 5, by_step=True),
        touches=True,
        collisions=1,
    ),
    _problem(
        name="drag_linear",
        title="A throw in a viscous medium",
        compared="x, y, vx, vy after 3 s",
        measure="largest error [m], [m/s]",
        build=_drag_linear,
        times=(3.0,),
        error=_drag_linear_error,
        good=1e-6,
        excellent=1e-13,
        ladder=Ladder(16, 9),
        exact_energy=_drag_linear_energy,
    ),
    _problem(
        name="drag_quadratic",
        title="A fall in air",
        compared="distance fallen and speed after 2 s",
        measure="largest error [m], [m/s]",
        build=_drag_quadratic,
        times=(2.0,),
        error=_drag_quadratic_error,
        good=1e-6,
        excellent=1e-13,
        ladder=Ladder(16, 9),
        exact_energy=_drag_quadratic_energy,
    ),
)
"""Their problems."""
