"""The record of a contact case with a known answer."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from physicslab.components import Transform
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.problem import KnownCase
from physicslab.world import World

type Pose = tuple[float, float, float]
"""x, y [m] and angle [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactCase(KnownCase):
    """Bodies that touch, and where they should be at times of whole sixtieths, which every step divides.

    Attributes
    ----------
    source : str
        How the answer was found.
    wanted : float
        The largest error that rigid contacts may have.
    """

    measure: str = "largest error of x, y [m] and of the angle [rad]"
    source: str = "closed form"
    wanted: float = 1e-9


def state_off(world: World, name: str, expected: Pose) -> float:
    """Return the largest error of x, y [m] and of the angle [rad], whole turns left out."""
    found = world.component(world.entity(name), Transform)
    off = found.position.x - expected[0], found.position.y - expected[1]
    return max(*map(abs, off), abs(math.remainder(found.angle - expected[2], math.tau)))


def pose_case(
    name: str, title: str, compared: str, build: Callable[[SimulationConfig], World], frames: Sequence[int],
    truth: Callable[[float], dict[str, Pose]], *, group: str, source: str = "closed form",
    wanted: float = 1e-9,
) -> ContactCase:  # fmt: skip
    """Return a case of one world of which ``truth`` has the poses of bodies at a time [s], by name.

    They are compared after so many ``frames``, sixtieths of a second.
    """
    times = tuple(count / 60.0 for count in frames)

    def error(world: World, i: int) -> float:
        return max(state_off(world, body, pose) for body, pose in truth(times[i]).items())

    return ContactCase(
        name=name, title=title, group=group, compared=compared, source=source, build=build, times=times,
        error=error, wanted=wanted,
    )  # fmt: skip
