"""Ropes that go taut, ropes over wheels, and a motor that stalls: events of joints at their times."""

import math

from physicslab.components import Mass, Pin, Pulley, Rope, Shape, Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.figures import number
from physicslab.lab.accuracy.problem import Ladder, Problem, state_error
from physicslab.lab.worlds import GRAVITY, empty_world, place, spawn_point, velocity
from physicslab.world import World

_NOT_USED = {"leapfrog": "beside its kicks limits are springs, whose error does not go by its order"}
_LADDER = Ladder(240, 4, by_step=True)
_NONE: frozenset[str] = frozenset()


def _slack(simulation: SimulationConfig) -> World:
    """Return a point on a rope of 1 m, let go .6 m beside the point from which it hangs."""
    world = empty_world(simulation)
    bob = spawn_point(world, (0.6, 0.0), mass=2.0, name="bob")
    world.spawn(Rope(b=bob, length=1.0))
    return world


def _slack_error(world: World, i: int) -> float:
    x, y, vx, vy = (number("rope_taut", ("t=1", "t=3")[i], key) for key in ("x", "y", "vx", "vy"))
    return state_error(world, "bob", (x, y), (vx, vy), math.sqrt(GRAVITY))


def _slack_energy(t: float) -> float:
    """Return the energy: of what it has when it goes taut, .8 m below, it keeps (.6 v)^2 of v^2."""
    return -2.0 * 0.64 * 0.8 * GRAVITY if t > math.sqrt(1.6 / GRAVITY) else 0.0


def _hanging(name: str, masses: tuple[float, float], ratio: float) -> Problem:
    """Return the problem of two points at rest that hang over wheels 10 m above, on a rope with a ratio."""

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation)
        first, second = (
            spawn_point(world, (x, 0.0), mass=mass, name=f"{mass:g} kg")
            for x, mass in zip((-1.0, 1.0), masses, strict=True)
        )
        world.spawn(Pulley(a=first, b=second, wheel_a=(-1.0, 10.0), wheel_b=(1.0, 10.0), ratio=ratio))
        return world

    def error(world: World, i: int) -> float:
        pace, pull = number(name, "a"), number(name, "pull")
        off = [abs(float(world.joints.force[0]) - pull) / pull]
        for mass, rate in zip(masses, (ratio * pace, -pace), strict=True):
            body = f"{mass:g} kg"
            off += [abs(velocity(world, body).y - rate), abs(place(world, body).y - 0.5 * rate)]
        return max(off)

    return Problem(
        name=name, group="rope", build=build, error=error, times=(1.0,), good=1e-6, excellent=1e-10,
        title="Two masses over a wheel" if ratio == 1.0 else "A load on a block and tackle of two strands",
        compared="heights and speeds after 1 s, and the pull of the rope",
        measure="largest error of heights [m], of speeds [m/s], and of the pull as a share of it",
        ladder=_LADDER, not_used=_NOT_USED, touches=True,
    )  # fmt: skip


def _lifted(simulation: SimulationConfig) -> World:
    """Return a bar that hangs from a motor, which begins to lift it and can hold it up to 30 degrees."""
    world = empty_world(simulation)
    at = Transform((0.0, -0.5), -0.5 * math.pi), Velocity((0.25, 0.0), 0.5)
    bar = world.spawn(*at, Mass(1.0), Shape.box(1.0, 0.1), name="bar")
    world.spawn(Pin(b=bar, anchor_b=(-0.5, 0.0), motor_speed=0.5, max_torque=0.25 * GRAVITY))
    return world


def _lifted_error(world: World, i: int) -> float:
    moment, bar = ("t=1.5", "t=2.5")[i], world.entity("bar")
    angle = world.component(bar, Transform).angle + 0.5 * math.pi - number("motor_stalls", moment, "angle")
    spin = world.component(bar, Velocity).angular - number("motor_stalls", moment, "spin")
    return max(abs(angle), abs(spin))


LIMITED = (
    Problem(
        name="rope_taut", title="A mass on a slack rope, which goes taut", group="rope", times=(1.0, 3.0),
        compared="x, y, vx, vy after 1 and 3 s", build=_slack, error=_slack_error,
        measure="largest error of x, y and of vx, vy over sqrt(g / l) [m]", good=1e-6, excellent=1e-10,
        ladder=_LADDER, exact_energy=_slack_energy, keeps=_NONE, not_used=_NOT_USED, touches=True,
    ),
    _hanging("atwood_rope", (2.0, 3.0), 1.0),
    _hanging("tackle_rope", (1.0, 3.0), 2.0),
    Problem(
        name="motor_stalls", title="A bar that a motor lifts until it is too heavy for it", group="rope",
        compared="angle and spin after 1.5 and 2.5 s", times=(1.5, 2.5), build=_lifted, error=_lifted_error,
        measure="largest error of the angle [rad] and of the spin [rad/s]", good=1e-6, excellent=1e-10,
        ladder=_LADDER, keeps=_NONE, not_used=_NOT_USED, touches=True,
    ),
)  # fmt: skip
"""Every problem with limits."""
