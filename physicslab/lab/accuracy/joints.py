"""Bodies on joints, whose motion has a closed form."""

import math

from physicslab.components import Mass, Pin, Shape, Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.figures import number
from physicslab.lab.accuracy.problem import Ladder, Problem, state_error
from physicslab.lab.worlds import GRAVITY, empty_world
from physicslab.world import World

_LENGTH, _WIDTH, _ANGLE = 1.0, 0.1, 2.5
"""Of the bar [m], and its angle from the lowest at first [rad]."""
_RATE = math.sqrt(0.5 * GRAVITY * _LENGTH / ((_LENGTH**2 + _WIDTH**2) / 12.0 + 0.25 * _LENGTH**2))
"""Of small oscillations [rad/s]."""


def _compound_pendulum(simulation: SimulationConfig) -> World:
    """Return a bar that is held at its upper end, and let go high above it."""
    world, half = empty_world(simulation), 0.5 * _LENGTH
    middle = half * math.sin(_ANGLE), -half * math.cos(_ANGLE)
    parts = Transform(middle, _ANGLE), Velocity(), Mass(1.0), Shape.box(_WIDTH, _LENGTH)
    bar = world.spawn(*parts, name="bar")
    world.spawn(Pin(b=bar, anchor_b=(0.0, half)))
    return world


def _error(world: World, i: int) -> float:
    moment = ("t=1", "t=10")[i]
    x, y, vx, vy = (number("compound_pendulum", moment, key) for key in ("x", "y", "vx", "vy"))
    return state_error(world, "bar", (x, y), (vx, vy), _RATE)


JOINED = (
    Problem(
        name="compound_pendulum", title="A bar on a pin, let go 143 degrees from below", group="pendulum",
        compared="x, y, vx, vy of its middle after 1 and 10 s", times=(1.0, 10.0),
        measure="largest error of x, y and of vx, vy over sqrt(m g l / I) [m]",
        build=_compound_pendulum, error=_error, good=1e-6, excellent=1e-10, ladder=Ladder(512),
    ),
)  # fmt: skip
"""Every problem with joints."""
