"""A step of rigid contacts: from event to event, and by impulses where events accumulate."""

import math
import sys
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.sentences import sentence
from physicslab.kernels import Plain
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, ENERGY, OVERLAP, PX, PY
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.joints import layout
from physicslab.kernels.rigid import motion, time_stepping
from physicslab.kernels.rigid.equations import UNKNOWN, VECTORS
from physicslab.kernels.rigid.features import MEASURES, PAIR, POINT_FIELDS
from physicslab.kernels.rigid.segment_end import STARTS
from physicslab.kernels.rigid.smooth_segment import Stages
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State
from physicslab.stepping.forces import fastest_rate
from physicslab.stepping.rigid_rows import RigidRows

type Numbers = NDArray[np.float64]
"""An array of coordinates, of speeds, or of sums (n,)."""

MAX_POINTS = 64
"""Largest number of points that touch at one time: their equations are dense."""
_TOLERANCE = 1e-13
"""Error of a smooth segment, as a share of the largest coordinate and speed."""
_MAX_EVENTS = 2000
"""Largest number of events in a step."""
_MAX_WORK = 8_500
"""Largest work of a step by events (:attr:`MadeStep.work`): short steps need the rest of a frame."""
_WORK_OF_A_SEGMENT = 8
"""Units of work of a segment of motion, beside its force evaluations and half a unit for each pair near."""
_RESTING = 2.0
"""In speeds that a short step gives: what is no faster than that comes to rest."""
_REPEATS, _SHORT_REPEATS = 8, 3
"""How often contacts are found again after impacts at one time, and within a short step."""
_MAX_STALLED = 60
"""Largest number of events in a row without time between them."""
_NO_TIME = 1e-13
"""Share of a step that is no time."""
_SHORT_STEPS = 32
"""Number of steps by impulses in a whole step."""
_MAX_SHORT_STEPS = 320
"""Largest number of them: fast bodies must not pass through each other."""
_SLOW = 2.0
"""Multiple of what forces add to a speed in a short step up to which an approach is treated as zero."""
_OVERLAP = 1e-3
"""Largest overlap that is moved apart at the start of a step, as a share of a size; soft contacts leave
half."""
_SEPARATE = 1e-11
"""Largest overlap that stays, as a share of a size."""
_NEAR = 4.0
"""Multiple of an overlap within which other gaps are looked at, as bodies that move apart may press into
them."""
_COORDINATE_ROUNDING = 4e-15
"""Share of the largest coordinate that is rounding."""
_SEPARATIONS = 12
"""How often bodies are moved apart, as that can press them into others."""
_WHY = {
    motion.NO_FORCES: sentence("no_forces"),
    motion.UNRESOLVED: sentence("unresolved"),
    motion.TOO_MANY: sentence("many_points", limit=MAX_POINTS),
}


@dataclass(slots=True)
class MadeStep:
    """Results of a step.

    Attributes
    ----------
    points, measures, forces : arrays
        Points that are closed at the end, their measures, and their forces [N].
    closed, impacts, evaluations : int
        How many points are closed at the end; how many impacts and force evaluations there were.
    energetic, lowered : int
        How many impacts obeyed Stronge's law, and how often those of several points had their restitutions
        lowered, as Newton's law would have made energy.
    energy_added : float
        By moving bodies apart that overlapped [J].
    work : int
        About as many as microseconds: of segments, of force evaluations with n points and r rows of joints
        (1 + 2 n) (1 + r) / 4, of impacts.
    by_impulses : str
        Why the step, or its last part, was made by impulses in short steps; empty if it was not.
    refused : str
        Why it cannot be made; empty if it was.
    """

    points: NDArray[np.int64]
    measures: NDArray[np.float64]
    forces: NDArray[np.float64]
    closed: int = 0
    impacts: int = 0
    evaluations: int = 0
    energetic: int = 0
    lowered: int = 0
    energy_added: float = 0.0
    work: int = 0
    by_impulses: str = ""
    refused: str = ""


def _stages_of(n: int) -> Plain[Stages]:
    """Return room for the stages of a segment with n coordinates, the clock and accounts among them."""
    return np.zeros((16, n)), np.zeros((16, n)), np.zeros(n), np.zeros(n), np.zeros(n)


class RigidMotion:
    """Moves the bodies of a world as a constrained system.

    Parameters
    ----------
    ode : OdeSystem
        Where the bodies are, how they move and what forces act on them.
    pairs : int
        How many pairs may touch.
    steady : bool
        Whether forces depend on the state of motion alone.
    rows : RigidRows
        Which of the pairs are limits and motors.
    """

    def __init__(self, ode: OdeSystem, pairs: int, steady: bool, rows: RigidRows) -> None:
        self._ode, self._steady, self._pairs, self._rows = ode, steady, pairs, rows
        m = 2 * MAX_POINTS
        self._equations, self._room = (
            (
                np.zeros((MAX_POINTS, POINT_FIELDS), np.int64), np.zeros((MAX_POINTS, MEASURES)),
                np.zeros((m, m)), np.zeros((VECTORS, m)), np.zeros((m, m)), np.zeros((2, 2 * m), np.int64),
                np.zeros((2 * m, 4 * m + 2)),
            )
            for _ in range(2)
        )  # fmt: skip
        self._stages = _stages_of(0)
        self._start = np.zeros((STARTS, max(MAX_POINTS, pairs)))
        self._changed = np.full((MAX_POINTS, POINT_FIELDS), -1)

    def step(self, scene: tuple[Any, ...], state: State, at: float, h: float) -> MadeStep:
        """Make a step of ``h`` seconds from time ``at``, by events, and by impulses where they accumulate."""
        if len(self._stages[2]) != len(self._ode.q):
            self._stages = _stages_of(len(self._ode.q))
        made = MadeStep(self._equations[0], self._equations[1], self._equations[3][UNKNOWN])
        done = self._by_events(scene, state, at, h, made)
        if made.by_impulses:
            rate = fastest_rate(state, self._ode.forces)  # kicks of longer steps than its inverse would grow
            longest = min(h / _SHORT_STEPS, 1.0 / rate) if rate > 0.0 else h / _SHORT_STEPS
            made.refused = self._by_impulses(scene, state, at + done, h - done, longest, made)
        return made

    def _by_events(self, scene: tuple[Any, ...], state: State, at: float, h: float, made: MadeStep) -> float:
        """Go from event to event; return how far that leads [s]. The reason to stop is noted in ``made``."""
        q, v, changed = self._ode.q, self._ode.v, self._changed
        done, stalled, foreseen = 0.0, 0, True
        changed[0, PAIR], rows = -1, 1 + int(self._ode.joints[1][layout.ROWS])
        made.refused = self._move_apart(scene, state, _OVERLAP, made, pay=False)
        if made.refused:
            return 0.0
        for _ in range(_MAX_EVENTS):
            why, count, rest, still = self._begin(scene, state, at + done, made)
            if why == motion.TOO_MANY:
                made.refused = _WHY[why]
                return done
            if why != motion.DONE:
                made.by_impulses = _WHY[why]
                return done
            made.closed = count
            if still:
                self._go_on_at_rest(h - done)
            if done >= h or still:
                return h
            segment, evaluations, foreseen = motion.advance_segment(
                scene, self._equations, count, self._room, self._stages, self._start, changed, q, v,
                h - done, _TOLERANCE, rest, foreseen,
            )  # fmt: skip
            made.evaluations += evaluations
            made.work += _WORK_OF_A_SEGMENT + self._pairs // 2 + evaluations * (1 + 2 * count) * rows // 4
            stalled = stalled + 1 if segment <= _NO_TIME * h else 0
            done = h if segment == h - done else done + segment
            if not math.isfinite(segment):
                made.refused = sentence("segment_not_finite")
                return done
            if stalled > _MAX_STALLED or made.work > _MAX_WORK:
                break
        made.by_impulses = sentence("stalled")
        return done

    def _begin(
        self, scene: tuple[Any, ...], state: State, at: float, made: MadeStep
    ) -> tuple[int, int, float, bool]:
        """Let what approaches bounce, stop what cannot slide on, and begin a segment of motion.

        Returns what :func:`motion.begin_motion` does.
        """
        for _ in range(_MAX_STALLED):
            why, count = self._collide(scene, state, at, made)
            if why != motion.DONE:
                return why, made.closed, 0.0, False
            began = motion.begin_motion(
                scene, self._equations, count, self._stages, self._changed, self._ode.q, self._ode.v,
                self._steady,
            )  # fmt: skip
            if began[0] != motion.STOPPED:
                return began
        return motion.NO_FORCES, 0, 0.0, False

    def _by_impulses(
        self, scene: tuple[Any, ...], state: State, at: float, left: float, longest: float, made: MadeStep
    ) -> str:
        """Make the rest of a step by short ones; return why that is not possible, nothing if it is."""
        q, v = self._ode.q, self._ode.v
        self._changed[0, PAIR] = -1
        h, end, made_steps = longest, at + left, 0
        while left > 0.0:
            short = min(longest, self._time_to_pass(scene))
            if made_steps == 0 or short < h:
                h = left / math.ceil(left / short) if short > 0.0 else 0.0
            if left > (_MAX_SHORT_STEPS - made_steps) * h:
                return sentence("too_fast_for_short_steps")
            made_steps += 1
            last = left <= 1.5 * h
            h = left if last else h
            time_stepping.drift(q, v, 0.5 * h)
            gained = h * time_stepping.kick(scene, self._stages[-1], q, v, h)
            tolerance = _SLOW * gained
            if self._rows.driven:
                stages, account = self._stages, state.account.sums
                time_stepping.drive(scene, self._equations, stages[-1], stages[3], q, v, h, account)
            made.evaluations, made.closed = made.evaluations + 1, 0
            why = self._resist(scene, state, end - left + 0.5 * h, h, tolerance, made)
            if why != motion.DONE:
                return _WHY[why]
            time_stepping.drift(q, v, 0.5 * h)
            left = 0.0 if last else left - h
            # A body as slow as a short step makes it comes to rest; moved each time, it would not.
            rests = float(np.abs(v[: self._ode.layout.clock]).max(initial=0.0)) <= _RESTING * gained
            if rests and not last:
                continue
            refused = self._move_apart(scene, state, math.inf, made, pay=True)
            if refused:
                return refused
        made.forces /= h
        self._find_forces(scene, state, end, made)
        return ""

    def _go_on_at_rest(self, span: float) -> None:
        """Book what holds bodies at rest, and what pulls at them, for ``span`` seconds: they do no work."""
        first = self._ode.layout.clock + 1
        given = self._stages[-1][first:].reshape(-1, ACCOUNTS)
        self._ode.v[first:].reshape(-1, ACCOUNTS)[:, PX:] += span * given[:, PX:]

    def _time_to_pass(self, scene: tuple[Any, ...]) -> float:
        """Return how long a short step may be in which nothing passes a quarter of the smallest size [s].

        A step changes the velocity, and moves by what it is then.
        """
        v, rows, reach, sizes = self._ode.v, scene[0], scene[4][1][3], scene[7][:, 2]
        spins = np.abs(v[2 * rows : 3 * rows]) * reach
        fastest = float((np.hypot(v[0 : 2 * rows : 2], v[1 : 2 * rows : 2]) + spins).max())
        push = time_stepping.kick(scene, self._stages[-1], self._ode.q, v, 0.0)
        way = 0.25 * float(sizes.min(initial=math.inf))
        total = fastest + math.sqrt(fastest * fastest + 4.0 * push * way)
        return 2.0 * way / total if total > 0.0 else math.inf

    def _find_forces(self, scene: tuple[Any, ...], state: State, at: float, made: MadeStep) -> None:
        """Find the forces at the end of a step; where there are none, the mean ones of the last impulses."""
        why, closed, _, _ = self._begin(scene, state, at, made)
        if why == motion.DONE:
            made.points, made.measures = self._equations[0], self._equations[1]
            made.forces = self._equations[3][UNKNOWN]
        made.closed = closed

    def _move_apart(
        self, scene: tuple[Any, ...], state: State, allowed: float, made: MadeStep, *, pay: bool
    ) -> str:
        """Move bodies apart that overlap; return why that is not possible, nothing if it is.

        An overlap beyond the share ``allowed`` of a size is left, and refused. The energy that this adds is
        noted, less what the bodies ``pay`` for it with their speeds.
        """
        q, v, deepest = self._ode.q, self._ode.v, 0.0
        largest = float(np.abs(q[: self._ode.layout.clock]).max(initial=0.0))
        smallest = max(float(scene[7][:, 2].min(initial=math.inf)), sys.float_info.min)
        rounding = _COORDINATE_ROUNDING * largest / smallest
        before = None
        for _ in range(_SEPARATIONS):
            why, count, rest, deepest, _ = self._touch(scene, q, _NEAR * deepest)
            if why != motion.DONE:
                return _WHY[why]
            if not math.isfinite(rest):  # every speed would be treated as zero
                return sentence("squares_not_finite")
            if deepest <= max(_SEPARATE, rounding):
                if before is not None:
                    at_first = v.copy()
                    added, change = time_stepping.take_work(
                        scene, self._equations, count, self._stages, before, q, v, pay
                    )
                    made.energy_added += added
                    _book_overlap(state, self._ode, before, at_first, change)
                return ""
            before = q.copy() if before is None else before
            if deepest > allowed or not time_stepping.separate(scene, self._equations, count, q, v):
                break
        return sentence("joints_overlap" if len(self._rows) else "overlap", share=f"{deepest:.2g}")

    def _resist(
        self, scene: tuple[Any, ...], state: State, time: float, h: float, tolerance: float, made: MadeStep
    ) -> int:
        """Find the impulses in the middle of a short step of ``h`` seconds; return why that failed.

        They act at all points that would touch by its end, or bounce. Speeds up to ``tolerance`` [m/s]
        are treated as zero.
        """
        q, v, soon = self._ode.q, self._ode.v, self._stages[2]
        for _ in range(_SHORT_REPEATS):
            soon[:] = q
            time_stepping.drift(soon, v, h)
            why, _, points = self._meet(scene, state, soon, tolerance, 2.0 / h, 1, time, made)
            if why != motion.DONE or points == 0:
                return why
            made.closed = points
            made.points, made.measures = self._room[0].copy(), self._room[1].copy()
            made.forces = self._room[3][UNKNOWN].copy()
        return motion.DONE

    def _collide(self, scene: tuple[Any, ...], state: State, time: float, made: MadeStep) -> tuple[int, int]:
        """Find what touches, and resolve impacts; return why that failed, and how many points touch."""
        why, count, _ = self._meet(scene, state, self._ode.q, 0.0, 0.0, _REPEATS, time, made)
        return why, count

    def _touch(
        self, scene: tuple[Any, ...], place: NDArray[np.float64], within: float = 0.0
    ) -> tuple[int, int, float, float, bool]:
        """Find which points touch at a place; returns what :func:`motion.touch` does."""
        acceleration, q, v = self._stages[-1], self._ode.q, self._ode.v
        return motion.touch(scene, self._equations, self._room, acceleration, place, q, v, within)

    def _meet(
        self, scene: tuple[Any, ...], state: State, place: NDArray[np.float64], tolerance: float, rate: float,
        repeats: int, time: float, made: MadeStep,
    ) -> tuple[int, int, int]:  # fmt: skip
        """Find which points touch at a place, and let those that approach bounce; repeat both.

        An impact can change which faces two boxes turn to each other. Speeds up to ``tolerance`` [m/s] are
        treated as zero; points that would touch in 1 / ``rate`` seconds do. Returns why the motion cannot go
        on, how many points touch, and how many the last impulses act at.
        """
        contacts, count, last = state.contacts, 0, 0
        for _ in range(repeats):
            why, count, rest, _, approaching = self._touch(scene, place)
            if why != motion.DONE or not approaching:
                return why, count, last
            new, solved, energetic, lowered, last, work = motion.collide(
                scene, self._equations, count, self._room, self._ode.q, self._ode.v, self._stages[3],
                self._stages[-1], max(rest, tolerance), rate, state.entity_index.entities, contacts.log,
                contacts.logged, time, state.account.sums,
            )  # fmt: skip
            contacts.logged += new
            made.impacts += new
            made.energetic += energetic
            made.lowered += lowered
            made.work += work // 4
            if not solved:
                return motion.UNRESOLVED, count, last
        return motion.DONE, count, last


def _book_overlap(state: State, ode: OdeSystem, place: Numbers, speed: Numbers, energy: float) -> None:
    """Book that bodies were moved apart, from a place (n,) and a speed (n,), which changed the energy [J]."""
    row = state.account.sums[OVERLAP]
    row[ENERGY] += energy
    row[[PX, PY, ANGULAR_MOMENTUM]] += _momenta(ode, ode.q, ode.v) - _momenta(ode, place, speed)


def _momenta(ode: OdeSystem, q: Numbers, v: Numbers) -> Numbers:
    """Return momentum (x, y) and angular momentum about the origin of what forces move (3,)."""
    clock = ode.layout.clock
    free = ode.inverse_mass > 0.0
    p = np.where(free, v[:clock] / np.where(free, ode.inverse_mass, 1.0), 0.0)
    n = 2 * len(ode.layout.moving)
    x, y, px, py = q[:n:2], q[1:n:2], p[:n:2], p[1:n:2]
    return np.array((px.sum(), py.sum(), (x * py - y * px).sum() + p[n:].sum()))
