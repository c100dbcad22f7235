"""What a contact case with a known answer is."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from physicslab.components import Transform
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.case import Case
from physicslab.world import World

__all__ = ["PLACE", "ContactCase", "Pose", "in_frames", "single", "state_off"]

type Pose = tuple[float, float, float]
"""x, y [m] and angle [rad]."""

PLACE = "largest error of x, y [m] and of the angle [rad]"


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactCase(Case):
    """Bodies that touch, and where they should be.

    Attributes
    ----------
    compared, measure : str
        What is compared and when; how the error is measured, with its unit.
    source : str
        How the answer was found.
    build : callable
        Takes a configuration of steps and returns the worlds, which are advanced alike.
    times : tuple of floats
        When they are compared [s], in order: whole sixtieths, which every step divides.
    error : callable
        Returns the error of the worlds at the i-th of these times.
    wanted : float
        The largest error that rigid contacts may have.
    """

    compared: str
    measure: str = PLACE
    source: str = "closed form"
    build: Callable[[SimulationConfig], tuple[World, ...]]
    times: tuple[float, ...]
    error: Callable[[Sequence[World], int], float]
    wanted: float = 1e-9

    @property
    def seconds(self) -> float:
        """The last of the times that are compared [s]."""
        return self.times[-1]


def in_frames(*frames: int) -> tuple[float, ...]:
    """Return times of so many sixtieths of a second [s]."""
    return tuple(count / 60.0 for count in frames)


def state_off(world: World, name: str, expected: Pose) -> float:
    """Return the largest error of x, y [m] and of the angle [rad], whole turns left out."""
    found = world.component(world.entity(name), Transform)
    off = found.position.x - expected[0], found.position.y - expected[1]
    return max(*map(abs, off), abs(math.remainder(found.angle - expected[2], math.tau)))


def single(
    name: str,
    title: str,
    compared: str,
    build: Callable[[SimulationConfig], World],
    frames: Sequence[int],
    truth: Callable[[float], dict[str, Pose]],
    *,
    group: str,
    source: str = "closed form",
    wanted: float = 1e-9,
) -> ContactCase:
    """Return a case of one world of which ``truth`` has the poses of bodies at a time [s], by name."""
    times = in_frames(*frames)

    def error(worlds: Sequence[World], i: int) -> float:
        return max(state_off(worlds[0], body, pose) for body, pose in truth(times[i]).items())

    return ContactCase(
        name=name, title=title, group=group, compared=compared, source=source,
        build=partial(_alone, build), times=times, error=error, wanted=wanted,
    )  # fmt: skip


def _alone(build: Callable[[SimulationConfig], World], simulation: SimulationConfig) -> tuple[World, ...]:
    return (build(simulation),)
