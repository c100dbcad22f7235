"""Bodies that are driven, and charges in fields, whose motion has a closed form."""

import math

from physicslab.components import Drag, Spring, Thrust
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.problem import Ladder, Problem, state_error
from physicslab.lab.closed_forms import driven
from physicslab.lab.worlds import empty_world, spawn_point
from physicslab.world import World

_STIFFNESS, _DRAG, _STRENGTH = 100.0, 0.5, 2.0
"""Of the driven oscillators of 1 kg [N/m], [kg/s], [N]: their own frequency is 10 rad/s."""


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


FIELDS = (
    _driven(0.5, "A damped mass on a spring, driven at half its own frequency"),
    _driven(1.0, "The same at resonance"),
    _driven(2.0, "The same at twice its own frequency"),
)
"""Every problem with forces of this kind."""
