"""What a problem with a known answer is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.systems.standard import standard_systems
from physicslab.world import World

__all__ = ["Ladder", "LeftOut", "Problem", "empty_world"]


@dataclass(frozen=True, slots=True)
class Ladder:
    """How coarse and how fine a problem is computed.

    Attributes
    ----------
    work : int
        Of the coarsest rung: force evaluations of the whole time, or steps where ``by_step``.
    rungs : int
        Each takes twice the steps of the one before.
    by_step : bool
        Whether all methods take the same steps, instead of as many as make the same work.
    """

    work: int
    rungs: int = 8
    by_step: bool = False

    def steps(self, evaluations: int) -> list[int]:
        """Return the steps of each rung, for a method of so many force evaluations a step.

        >>> Ladder(44, 3).steps(11)
        [4, 8, 16]
        """
        first = self.work if self.by_step else max(1, round(self.work / max(1, evaluations)))
        return [first << rung for rung in range(self.rungs)]


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """A world whose motion is known.

    Attributes
    ----------
    name, title, group : str
        For the command line, for people, and which kind of problem it is.
    source : str
        The name under which ``problems.json`` holds the figures. Several problems may share one: the cases of
        a family, which the command line knows by this name.
    compared, measure : str
        What is compared and when; how the error is measured, with its unit.
    build : callable
        Makes the world, stepped as it is told.
    times : tuple of floats
        When the world is compared [s], in order.
    error : callable
        Returns the error of a world at the i-th of these times.
    good, excellent : float
        The largest error that is called so.
    ladder : Ladder
        How finely it is computed with methods of fixed steps.
    touches : bool
        Whether bodies touch in it.
    dt : float
        Step [s] with which ``auto`` meets it.
    exact_energy : callable, optional
        The energy [J] at a time, where friction, drag or a damper takes some away.
    keeps : frozenset of str
        What is conserved among ``"energy"``, ``"momentum"`` and ``"angular_momentum"``.
    collisions : int, optional
        How many impacts there are.
    chaotic : bool
        Whether the motion makes each rounding grow exponentially.
    not_asked : mapping of str to str
        Methods that are left out although the engine would take them, and why.
    search : callable, optional
        Returns the error where one world does not show it: a threshold that is looked for with many.
    note : str
        What else people should know.
    """

    name: str
    title: str
    group: str
    source: str
    compared: str
    measure: str
    build: Callable[[SimulationConfig], World]
    times: tuple[float, ...]
    error: Callable[[World, int], float]
    good: float
    excellent: float
    ladder: Ladder
    touches: bool = False
    dt: float = 1.0 / 60.0
    exact_energy: Callable[[float], float] | None = None
    keeps: frozenset[str] = frozenset({"energy"})
    collisions: int | None = None
    chaotic: bool = False
    not_asked: Mapping[str, str] = field(default_factory=dict)
    search: Callable[[Callable[[], SimulationConfig]], float] | None = None
    note: str = ""

    @property
    def seconds(self) -> float:
        """The last of the times that are compared [s]."""
        return self.times[-1]


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A reference problem that the engine cannot be asked, and why."""

    name: str
    reason: str


def empty_world(
    simulation: SimulationConfig,
    gravity: float | None = 9.81,
    *,
    planets: bool = False,
    softening: float = 0.0,
) -> World:
    """Return a world with every physics system and nothing in it.

    Parameters
    ----------
    gravity : float, optional
        Downwards [m/s^2]; none where ``None`` or ``planets``.
    planets : bool
        Whether bodies attract each other with G = 1.
    softening : float
        Of that attraction, by Plummer's law [m].
    """
    mode = "planet" if planets else "none" if gravity is None else "linear"
    physics = PhysicsConfig(
        gravity_mode=mode,
        gravity=Vector2(0.0, -(gravity or 0.0)),
        softening=softening,
        softening_law="plummer",
    )  # fmt: skip
    return World(*standard_systems(), physics=physics, simulation=simulation)
