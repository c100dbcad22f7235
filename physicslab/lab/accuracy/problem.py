"""Problems with known answers: figures, how they are computed, and the distance of bodies from them.

Figures are decimal digits, as ``problems.json`` keeps them.
"""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from typing import Any, override

import numpy as np

from physicslab.diagnostics.step_warnings import fastest_force
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.integrators import Integrator
from physicslab.lab.case import Case
from physicslab.lab.worlds import place, velocity
from physicslab.world import World


@cache
def _document() -> dict[str, Any]:
    text = files("physicslab.lab.accuracy").joinpath("problems.json").read_text(encoding="utf-8")
    problems: dict[str, Any] = json.loads(text)["problems"]
    return problems


def record(problem: str) -> dict[str, Any]:
    """Return all that is on record of a problem: what is given, the reference, and how it was found."""
    found: dict[str, Any] = _document()[problem]
    return found


def digits(problem: str, *keys: str) -> str:
    """Return a figure of a problem's reference as the digits on record.

    >>> digits("projectile", "T")
    '3.531194306970188162135'
    """
    found: Any = record(problem)["reference"]
    for key in keys:
        found = found[key]
    if not isinstance(found, str):
        raise KeyError(f"{problem}: {' '.join(keys)} is no figure")
    return found


def number(problem: str, *keys: str) -> float:
    """Return a figure of a problem's reference, rounded once: the nearest float."""
    return float(digits(problem, *keys))


@dataclass(frozen=True, slots=True)
class Ladder:
    """How coarse and how fine a problem is computed.

    Attributes
    ----------
    work : int
        Work of the coarsest rung: force evaluations of the whole time, or steps where ``by_step``.
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


type Advance = Callable[[float], object]
"""Advances one world to a time [s]."""


def own_steps(world: World, dt: float = 0.0) -> Advance:
    """Return what advances a world by its own steps, whose length it has already."""
    world.synchronise()
    return lambda t: world.run(seconds=t - world.time)


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownCase(Case):
    """A world whose motion is known.

    Attributes
    ----------
    compared, measure : str
        The quantity compared, and when; the measure of the error, with its unit.
    build : callable
        Takes a configuration of steps and returns the world.
    variant : callable, optional
        Returns a second world that is advanced alike, where that is what the first is compared with.
    times : tuple of floats
        When the world is compared [s], in order.
    error : callable
        Takes the world, the variant where there is one, and i; returns the error at the i-th of these times.
    """

    compared: str
    measure: str
    build: Callable[[SimulationConfig], World]
    variant: Callable[[SimulationConfig], World] | None = None
    times: tuple[float, ...]
    error: Callable[..., float]

    @property
    def seconds(self) -> float:
        """The last of the times that are compared [s]."""
        return self.times[-1]

    def worlds(self, simulation: SimulationConfig) -> tuple[World, ...]:
        """Return the world, and the variant if there is one."""
        builds = (self.build,) if self.variant is None else (self.build, self.variant)
        return tuple(build(simulation) for build in builds)

    def finish(self, worlds: Sequence[World], advances: Sequence[Advance] = ()) -> float:
        """Run worlds through the times that are compared, and return the largest error.

        Parameters
        ----------
        advances : sequence of callables, optional
            They advance each world; its own steps where there are none.
        """
        largest, advances = 0.0, advances or [own_steps(world) for world in worlds]
        for i, t in enumerate(self.times):
            for advance in advances:
                advance(t)
            largest = float(np.maximum(largest, self.error(*worlds, i)))  # numpy's maximum keeps NaN
        return largest


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem(KnownCase):
    """A world whose motion is known, for every method.

    Attributes
    ----------
    source : str
        The name under which ``problems.json`` holds the figures, where it is not the problem's own. Problems
        that share one are a family, with this name on the command line.
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
    keeps : set of str
        The conserved ones among ``"energy"``, ``"momentum"`` and ``"angular_momentum"``.
    collisions : int, optional
        How many impacts there are.
    chaotic : bool
        Whether the motion makes each rounding grow exponentially.
    not_used : mapping of str to str
        Methods that are left out although the engine would take them, and why.
    search : callable, optional
        Returns the error where no single world shows it: a threshold that is found with many worlds.
    note : str
        Remarks for the reader.
    """

    source: str = ""
    good: float
    excellent: float
    ladder: Ladder
    touches: bool = False
    dt: float = 1.0 / 60.0
    exact_energy: Callable[[float], float] | None = None
    keeps: Set[str] = frozenset({"energy"})
    collisions: int | None = None
    chaotic: bool = False
    not_used: Mapping[str, str] = field(default_factory=dict)
    search: Callable[[Callable[[], SimulationConfig]], float] | None = None
    note: str = ""

    @property
    @override
    def family(self) -> str:
        return self.source or self.name


def distance(world: World, expected: Mapping[str, Sequence[float]]) -> float:
    """Return the largest distance of a body from where it should be [m], of those that are named."""
    return max((place(world, name) - Vector2(*where)).magnitude for name, where in expected.items())


def state_error(
    world: World, name: str, where: Sequence[float], how: Sequence[float], rate: float = 1.0
) -> float:
    """Return the largest error of x, y [m] and of vx / rate, vy / rate [m] of a body."""
    off = place(world, name) - Vector2(*where)
    slip = (velocity(world, name) - Vector2(*how)) / rate
    return max(abs(off.x), abs(off.y), abs(slip.x), abs(slip.y))


def on_record(
    name: str, *, moments: Sequence[str] = (), axes: Sequence[str] = ("x", "y", "vx", "vy"),
    body: str = "body", rate: float = 1.0,
) -> Callable[[World, int], float]:  # fmt: skip
    """Return the error of place and velocity beside the figures of a problem, velocities over a rate [1/s].

    ``axes`` are the keys of x, y, vx and vy, below those of the ``moments`` if there are several; an empty
    one stands for 0.
    """

    def error(world: World, i: int) -> float:
        x, y, vx, vy = (number(name, *moments[i : i + 1], key) if key else 0.0 for key in axes)
        return state_error(world, body, (x, y), (vx, vy), rate)

    return error


_TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-15, 1e-16, 1e-17)
_SUBSTEPS = 4
"""Parts of a step where bodies touch: the default of scenes."""
_EVALUATIONS_LIMIT = 1e7
"""Force evaluations that one rung may take."""
_STIFF_LIMIT = 6.0
"""Rate times step [rad] beyond which an explicit adaptive method is no longer stable."""


@dataclass(frozen=True, slots=True)
class Setting:
    """A method, and how finely it is used.

    Attributes
    ----------
    integrator : str
        Its name, or ``"auto"``.
    steps : int, optional
        Into how many the time is divided; ``None`` for a method that chooses its steps.
    tolerance : float, optional
        Tolerance of an adaptive method.
    collisions : str
        How contacts are found.
    contacts : str
        How bodies that touch are held apart, with ``"auto"``.
    """

    integrator: str
    steps: int | None = None
    tolerance: float | None = None
    collisions: str = "auto"
    contacts: str = "auto"

    def simulation(self, problem: Problem) -> SimulationConfig:
        """Return the configuration of the problem's world, in which nothing sleeps.

        A method of fixed steps has soft contacts: rigid ones choose their steps.
        """
        if self.integrator == "auto":
            return SimulationConfig(dt=problem.dt, sleeping=False, contacts=self.contacts)
        tolerance = self.tolerance or SimulationConfig().tolerance
        parts = _SUBSTEPS if problem.touches else 1
        dt = problem.seconds * parts / (self.steps or 1)
        return SimulationConfig(
            dt=dt, substeps=parts, integrator=self.integrator, tolerance=tolerance,
            sleeping=False, collisions=self.collisions, contacts="soft",
        )  # fmt: skip


def refusal(problem: Problem, method: Integrator) -> str:
    """Return why a method is not used on a problem; empty if it is."""
    if method.name in problem.not_used:
        return problem.not_used[method.name]
    world = problem.build(SimulationConfig(dt=problem.dt, integrator=method.name))
    world.synchronise()
    if world.plan.refused:
        return world.plan.refused
    if method.chooses_steps and method.evaluations:
        rate, _ = fastest_force(world)
        work = problem.seconds * rate * method.evaluations / _STIFF_LIMIT
        if work > _EVALUATIONS_LIMIT:
            return f"an explicit method would take about {work:.0e} force evaluations to stay bounded"
    return ""


def ladder(problem: Problem, method: Integrator) -> Iterator[Setting]:
    """Yield the rungs of a method, from coarse to fine."""
    if not method.evaluations:
        yield Setting(method.name)
    elif method.chooses_steps:
        for tolerance in _TOLERANCES:
            yield Setting(method.name, tolerance=tolerance)
    else:
        # Located impacts have no step: they come with the closed form, or with auto.
        collisions = "step" if problem.touches else "auto"
        for steps in problem.ladder.steps(method.evaluations):
            yield Setting(method.name, steps, collisions=collisions)


def depends_on_velocity(problem: Problem) -> bool:
    """Whether forces in a problem depend on velocities, other than by turning them."""
    world = problem.build(SimulationConfig(dt=problem.dt))
    world.synchronise()
    forces = [force for force in world.schedule.smooth_forces if force.gyration(world) is None]
    return any(force.depends_on_velocity(world) for force in forces)
