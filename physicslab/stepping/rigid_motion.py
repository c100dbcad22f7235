"""A step of rigid contacts: from event to event, and by impulses where events accumulate."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.sentences import sentence
from physicslab.kernels import direct_entry
from physicslab.kernels.accounts import CONTACT, PX
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.rigid import motion, step
from physicslab.kernels.rigid.equations import VECTORS
from physicslab.kernels.rigid.features import MEASURES, POINT_FIELDS
from physicslab.kernels.rigid.segment_end import STARTS
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State
from physicslab.stepping.forces import fastest_rate
from physicslab.stepping.rigid_rows import RigidRows

MAX_POINTS = 64
"""Largest number of points that touch at one time: their equations are dense."""
_MAX_EVENTS = 2000
"""Largest number of events in a step."""
_MAX_WORK = 8_500
"""Largest work of a step by events, about as many as microseconds: short steps need the rest of a frame.

It is that of segments, of impacts, and of evaluations of forces, (1 + 2 n) (1 + r) / 4 with n points and r
rows of joints.
"""
_SHORT_STEPS = 32
"""Number of steps by impulses in a whole step."""
_WHY = {
    motion.NO_FORCES: sentence("no_forces"),
    motion.UNRESOLVED: sentence("unresolved"),
    motion.TOO_MANY: sentence("many_points", limit=MAX_POINTS),
    step.STALLED: sentence("stalled"),
    step.NOT_FINITE: sentence("segment_not_finite"),
    step.SQUARES_NOT_FINITE: sentence("squares_not_finite"),
    step.TOO_FAST: sentence("too_fast_for_short_steps"),
}
_CREEP = 1e-5
"""Share of the smallest size by which impulses may have moved bodies in a step that hold them at rest."""
_BEFORE = 5
"""Where the room has a state, by whose length it is made."""
_GO_ON_BY_IMPULSES = motion.NO_FORCES, motion.UNRESOLVED, step.STALLED


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
    by_impulses : str
        Why the step, or its last part, was made by impulses in short steps; empty if it was not.
    refused : str
        Why it cannot be made; empty if it was.
    rests : bool
        Whether the next step from there changes nothing either, as long as no number is changed.
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
    by_impulses: str = ""
    refused: str = ""
    rests: bool = False


def room_for(n: int, pairs: int) -> tuple[Any, ...]:
    """Return what a step of n coordinates works in (:class:`physicslab.kernels.rigid.step.Course`)."""
    m = 2 * MAX_POINTS
    equations, scratch = (
        (
            np.zeros((MAX_POINTS, POINT_FIELDS), np.int64), np.zeros((MAX_POINTS, MEASURES)),
            np.zeros((m, m)), np.zeros((VECTORS, m)), np.zeros((m, m)), np.zeros((2, 2 * m), np.int64),
            np.zeros((2 * m, 4 * m + 2)),
        )
        for _ in range(2)
    )  # fmt: skip
    return (
        equations, scratch, (np.zeros((16, n)), np.zeros((16, n)), *np.zeros((3, n))),
        np.full((MAX_POINTS, POINT_FIELDS), -1), np.zeros((STARTS, max(MAX_POINTS, pairs))),
        np.zeros((2, n)), np.zeros((MAX_POINTS, POINT_FIELDS), np.int64),
        np.zeros((MAX_POINTS, MEASURES)), np.zeros(m), np.zeros(step.COUNTED, np.int64),
    )  # fmt: skip


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
        self._ode, self._pairs, self._steady, self._driven = ode, pairs, steady, rows.driven
        self._joined = len(rows) > 0
        self._room: tuple[Any, ...] = ()
        self._entry: Callable[..., Any] = step.make_step

    def step(self, scene: tuple[Any, ...], state: State, at: float, h: float) -> MadeStep:
        """Make a step of ``h`` seconds from time ``at``, by events, and by impulses where they accumulate."""
        if self._room and self._room[_BEFORE].shape[1] == len(self._ode.q):
            self._entry = direct_entry(step.make_step)
        else:
            self._room, self._entry = room_for(len(self._ode.q), self._pairs), step.make_step
        *_, points, measures, forces, counts = self._room
        made = MadeStep(points, measures, forces)
        counts[step.LOGGED] = state.contacts.logged
        why, done, added = self._make(scene, state, at, h, 0.0)
        if why in _GO_ON_BY_IMPULSES:
            made.by_impulses, made.energy_added = _WHY[why], added
            rate = fastest_rate(state, self._ode.forces)  # kicks of longer steps than its inverse would grow
            longest = min(h / _SHORT_STEPS, 1.0 / rate) if rate > 0.0 else h / _SHORT_STEPS
            why, _, added = self._make(scene, state, at + done, h - done, longest)
        if why == motion.DONE:
            made.energy_added += added
        elif why == step.OVERLAPS:
            made.refused = sentence("joints_overlap" if self._joined else "overlap", share=f"{added:.2g}")
        else:
            made.refused = _WHY[why]
        (
            made.closed, made.impacts, made.evaluations, made.energetic, made.lowered, _,
            state.contacts.logged,
        ) = counts.tolist()  # fmt: skip
        made.rests = self._steady and not (made.evaluations or made.impacts or made.refused)
        return made

    def rest_held(
        self, made: MadeStep, sums: NDArray[np.float64], before: tuple[NDArray[np.float64], ...],
        booked: NDArray[np.float64], h: float, smallest: float,
    ) -> None:  # fmt: skip
        """Let bodies rest where they were before a step of ``h`` seconds, if impulses have held them in it.

        A heap that is wedged may have no forces, and events without end. Impulses in short steps hold it, and
        leave gaps over which it falls in the next step, and so on. ``before`` are q and v (n,) of then, and
        ``booked`` the ``sums`` (CAUSES, 4) of the account; what touches has the ``smallest`` size [m].
        Where joints hold too, what they give and what contacts do is not told apart, and the step stays.
        """
        q, v, n = self._ode.q, self._ode.v, self._ode.layout.clock
        moved = before[1][:n].any() or v[:n].any() or not self._steady
        if self._joined or moved or np.abs(q[:n] - before[0][:n]).max(initial=0.0) > _CREEP * smallest:
            return
        given, contact = self._room[2][-1][n + 1 :].reshape(-1, ACCOUNTS), self._ode.slots[CONTACT] - n - 1
        given[:] = ((v - before[1])[n + 1 :] / h).reshape(-1, ACCOUNTS)
        given[contact // ACCOUNTS] = 0.0
        given[contact // ACCOUNTS] = -given.sum(axis=0)  # what holds them, as by impacts and friction
        (q[:], v[:]), sums[:] = before, booked
        self.rest(h)
        made.rests, made.impacts, made.energetic, made.lowered, made.energy_added = True, 0, 0, 0, 0.0

    def rest(self, h: float) -> None:
        """Book another step of ``h`` seconds like the last one, in which nothing moved."""
        first, given = self._ode.layout.clock + 1, self._room[2][-1]
        self._ode.v[first:].reshape(-1, ACCOUNTS)[:, PX:] += h * given[first:].reshape(-1, ACCOUNTS)[:, PX:]

    def _make(
        self, scene: tuple[Any, ...], state: State, at: float, h: float, longest: float
    ) -> tuple[int, float, float]:
        """Call :func:`physicslab.kernels.rigid.step.make_step`."""
        ode, contacts = self._ode, state.contacts
        found: tuple[int, float, float] = self._entry(
            scene, self._room, ode.q, ode.v, state.entity_index.entities, contacts.log, state.account.sums,
            at, h, longest, self._steady, self._driven, _MAX_EVENTS, _MAX_WORK,
        )  # fmt: skip
        return found
