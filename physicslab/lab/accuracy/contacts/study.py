"""Contact cases with known answers, by every engine, the step halved again and again: errors and order."""

import math
import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

from physicslab.components import Transform
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.problem import Advance, KnownCase, own_steps
from physicslab.lab.accuracy.study import Curve, climb
from physicslab.lab.case import Verdict, attempt, cpu_time
from physicslab.lab.jobs import Job
from physicslab.lab.peers.mirrors import Box2D3Mirror, Box2DMirror, PymunkMirror
from physicslab.lab.peers.peer import Peer
from physicslab.lab.worlds import steps_not_rigid
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


@dataclass(frozen=True, slots=True)
class ContactEngine:
    """One way to compute a contact case.

    Attributes
    ----------
    name, title : str
        For documents, and for people.
    simulation : callable
        Takes the step [s] and returns the configuration with which worlds are built.
    start : callable
        Takes a world and the step; returns what advances it. May raise
        :class:`~physicslab.lab.peers.peer.CannotBuild`, or ``ImportError`` where the engine is not installed.
    own : bool
        Whether it is one of ours.
    """

    name: str
    title: str
    simulation: Callable[[float], SimulationConfig]
    start: Callable[[World, float], Advance]
    own: bool = False


def _simulation(contacts: str, collisions: str, dt: float) -> SimulationConfig:
    return SimulationConfig(dt=dt, contacts=contacts, collisions=collisions, sleeping=False)


def _theirs(peer: type[Peer], world: World, dt: float) -> Advance:
    mirror, reached = peer(world), 0.0

    def advance(t: float) -> None:
        nonlocal reached
        steps = round((t - reached) / dt)
        mirror.run((t - reached) / steps, steps)
        mirror.write_back()
        reached = t

    return advance


_SOFT = partial(_simulation, "soft", "step")
OWN = (
    ContactEngine("rigid", "rigid contacts", partial(_simulation, "rigid", "auto"), own_steps, own=True),
    ContactEngine("soft", "soft contacts", _SOFT, own_steps, own=True),
)
"""Ours."""
ENGINES = (
    *OWN,
    ContactEngine("pymunk", "pymunk", _SOFT, partial(_theirs, PymunkMirror)),
    ContactEngine("box2d", "Box2D 2.3", _SOFT, partial(_theirs, Box2DMirror)),
    ContactEngine("box2d_v3", "Box2D 3", _SOFT, partial(_theirs, Box2D3Mirror)),
)
"""All of them; each takes one of its own steps for one of the scene's."""


HALVINGS = 6
"""How often the step of 1/60 s is halved."""
_SPARSE = (0, 2, 4)
"""How often it is halved for the rungs of a sparse study."""
ROUNDING = 1e-11
"""An error below this is put down to rounding, and has no order."""
_SOFT_ORDER = 0.9
"""With soft contacts errors should fall at least with this power of the step."""
_REPEATED_BELOW_S = 0.05
"""A run that takes less is made twice more, and the median of its times counts."""
_ENDS_S = 10.0
"""The first rung that takes longer is the last."""


@dataclass(slots=True)
class ContactRow:
    """One engine with one step.

    Attributes
    ----------
    dt : float
        The step [s].
    error : float, optional
        As the case measures it; ``None`` where the run diverged.
    cpu_s_per_s : float
        Process time of one world for each second that it is advanced, compiling and building left out.
    left_to_soft, by_impulses : int
        How many steps rigid contacts left to soft ones, and made by impulses in short steps.
    failure : str
        Why there is no error; empty where there is one.
    """

    dt: float
    error: float | None
    cpu_s_per_s: float
    left_to_soft: int = 0
    by_impulses: int = 0
    failure: str = ""


ContactCurve = Curve[ContactEngine, ContactRow]


@dataclass(slots=True)
class ContactStudy:
    """A case and what engines do with it."""

    case: ContactCase
    curves: list[ContactCurve]


def fitted_order(steps: Sequence[float], errors: Sequence[float | None]) -> float | None:
    """Return the power of the step with which errors fall: the median of what each next step shows.

    A jump, where another thing happens from some step on, so counts as one of them. Errors of rounding are
    left out; ``None`` where fewer than three others are left.

    >>> fitted_order([0.1, 0.05, 0.025, 0.0125], [1e-4, 5e-5, 2.5e-5, 1e-9])
    1.0
    """
    clear = [(h, e) for h, e in zip(steps, errors, strict=True) if e is not None and e > ROUNDING]
    if len(clear) < 3:
        return None
    slopes = [math.log(e / finer) / math.log(h / shorter) for (h, e), (shorter, finer) in pairwise(clear)]
    return round(statistics.median(slopes), 12)


def study_case(case: ContactCase, *, sparse: bool = False) -> Job[ContactStudy]:
    """Compute a case with every engine; yield the share of the work that is done.

    With ``sparse``, with our own engines alone, and three steps instead of seven.
    """
    engines = OWN if sparse else ENGINES
    steps = [2.0**-k / 60.0 for k in (_SPARSE if sparse else range(HALVINGS + 1))]
    plan = [(ContactCurve(engine), steps) for engine in engines]
    yield from climb(plan, partial(measure_row, case), lambda row: row.cpu_s_per_s * case.seconds > _ENDS_S)
    for curve, _ in plan:
        curve.order = fitted_order([row.dt for row in curve.rows], curve.errors)
        curve.verdict = _verdict(case, curve)
    return ContactStudy(case, [curve for curve, _ in plan])


def _verdict(case: ContactCase, curve: ContactCurve) -> Verdict | None:
    """Return whether rigid contacts are within what is wanted at every step, and soft ones converge."""
    if not curve.method.own:
        return None
    if curve.largest is None:
        return Verdict.FAILED
    if curve.largest <= case.wanted:
        return Verdict.EXCELLENT
    converges = curve.order is not None and curve.order >= _SOFT_ORDER
    return Verdict.GOOD if curve.method.name == "soft" and converges else Verdict.SHORT


def measure_row(case: ContactCase, engine: ContactEngine, dt: float) -> ContactRow:
    """Compute a case with an engine and a step [s], repeatedly if that is short.

    Raises
    ------
    CannotBuild
        If the engine has nothing of the kind that the case needs.
    ImportError
        If the engine is not installed.
    """
    for world in case.worlds(engine.simulation(dt)):
        attempt(partial(engine.start(world, dt), 1.0 / 60.0))  # loads kernels, which is no part of a run
    row = _run(case, engine, dt)
    if row.cpu_s_per_s * case.seconds < _REPEATED_BELOW_S:
        more = [_run(case, engine, dt).cpu_s_per_s for _ in range(2)]
        row.cpu_s_per_s = statistics.median([row.cpu_s_per_s, *more])
    return row


def _run(case: ContactCase, engine: ContactEngine, dt: float) -> ContactRow:
    worlds, spent = case.worlds(engine.simulation(dt)), [0.0]
    advances = [partial(_clocked, spent, engine.start(world, dt)) for world in worlds]
    compiled = sum(world.compile_s for world in worlds)
    error, failure = attempt(partial(case.finish, worlds, advances))
    compiled = sum(world.compile_s for world in worlds) - compiled
    cost = max(0.0, sum(spent) - compiled) / case.seconds / len(worlds)
    return ContactRow(dt, error, cost, *((0, 0) if failure else steps_not_rigid(*worlds)), failure)


def _clocked(spent: list[float], advance: Advance, t: float) -> None:
    """Advance a world to a time [s], and add the process time that this takes [s]."""
    spent.append(cpu_time(partial(advance, t))[0])
