"""Few bodies that touch: rigid contacts, their laws solved to rounding, events located in time."""

from __future__ import annotations

import math
import time
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material, Shape, Velocity
from physicslab.components.shape import BOX
from physicslab.kernels.broad import near_pairs
from physicslab.kernels.rigid import motion
from physicslab.kernels.rigid.equations import VECTORS
from physicslab.kernels.rigid.features import MEASURES, OUTLINE_FIELDS, PAIR, POINT_FIELDS
from physicslab.kernels.wide import slots
from physicslab.ode.system import OdeSystem
from physicslab.state.masses import check_finite
from physicslab.state.state import State
from physicslab.stepping.ballistic import pairs_that_may_meet
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.rigid_records import RigidRecords
from physicslab.stepping.stepper import Advance
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import Stage

__all__ = ["MAX_POINTS", "Rigid"]

MAX_POINTS = 64
"""Largest number of points that touch at one time: their equations are dense."""
_TOLERANCE = 1e-13
"""Error of a smooth piece, as a share of the largest coordinate and speed."""
_MAX_EVENTS = 400
"""Largest number of events in a step."""
_REPEATS = 8
"""How often contacts are found again after impacts at one time."""
_MAX_STALLED = 60
"""Largest number of events in a row without time between them."""
_NO_TIME = 1e-13
"""Share of a step that is no time."""
_WHY = {
    motion.OVERLAP: "bodies overlap",
    motion.NO_FORCES: "no contact forces keep all laws (Painleve's paradox, or bodies that are jammed)",
    motion.UNRESOLVED: "an impact has no solution",
    motion.TOO_MANY: f"more than {MAX_POINTS} points touch",
}


class Rigid:
    """Advances bodies as a constrained system, from event to event.

    Nothing is remembered between steps: what touches follows from the state. A step that it cannot make is
    left to the next stepper, with soft contacts.

    Attributes
    ----------
    left_to_soft : int
        How many steps were.
    why_soft : str
        Why, at the last of them.
    restitutions_lowered : int
        How often impacts at one time got lower restitutions, as Newton's law would have made energy.
    """

    name: ClassVar[str] = "rigid"
    title: ClassVar[str] = "Rigid contacts, events at their exact times"
    leaps: ClassVar[bool] = False
    leaves_forces: ClassVar[bool] = False
    kernels: tuple[Any, ...] = (
        motion.touch, motion.advance_piece, motion.begin_motion, motion.collide,
        near_pairs.carry_over, slots.list_scalar,
    )  # fmt: skip

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._schedule = schedule
        self.reason = plan.contact_reason
        self._ode = OdeSystem(state, schedule.forces, every_row=True)
        self._steady = not schedule.interpreted
        self._pairs = pairs_that_may_meet(state)
        self._records = RigidRecords(self._pairs)
        self._refused, self.left_to_soft, self.why_soft = -1, 0, ""
        self.restitutions_lowered = 0
        rows, m = len(state.entity_index), 2 * MAX_POINTS
        n = 3 * rows + 1
        self._equations, self._room = (
            (
                np.zeros((MAX_POINTS, POINT_FIELDS), np.int64), np.zeros((MAX_POINTS, MEASURES)),
                np.zeros((m, m)), np.zeros((VECTORS, m)), np.zeros((m, m)), np.zeros((2, 2 * m), np.int64),
                np.zeros((2 * m, 4 * m + 2)),
            )
            for _ in range(2)
        )  # fmt: skip
        self._stages = np.zeros((n, 16)), np.zeros((n, 16)), np.zeros(n), np.zeros(n), np.zeros(n)
        self._start = np.zeros((5, max(MAX_POINTS, len(self._pairs))))
        self._changed = np.full((MAX_POINTS, POINT_FIELDS), -1)

    @classmethod
    def why_not(cls, state: State, schedule: Schedule, plan: StepPlan) -> str | None:
        """Return why contacts are soft, or ``None``."""
        return None if plan.contacts == "rigid" else plan.contact_reason

    def holds(self, state: State) -> bool:
        """Whether no number was changed that the layout of the forces depends on."""
        return not self._ode.outdated(state)

    def ready(self, state: State, h: float) -> bool:
        """Whether the coming step is not one that it has just refused."""
        return self._refused != state.steps

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Make the steps, or those before the first that it cannot make and is not ready for."""
        began = time.perf_counter_ns()
        ode = self._ode
        ode.gather(state)
        scene = self._scene(state)
        made, count, impacts = 0, 0, 0
        while made < steps:
            before = ode.q.copy(), ode.v.copy()
            logged = state.contacts.logged
            ode.q[-1], ode.v[-1] = state.time + made * h, 1.0  # the clock goes by one second a second
            count, impacts, refused = self._step(state, scene, state.time + made * h, h)
            if refused:
                ode.q[:], ode.v[:] = before
                state.contacts.logged = logged
                self._refused, self.why_soft = state.steps + made, refused
                self.left_to_soft += 1
                break
            state.collisions += impacts
            made += 1
        if made:
            ode.scatter(state, 0.0)
            self._records.write(state, self._equations, count, impacts, h)
            self._note(began, made)
            check_finite(state, state.time + h * made)
            state.substeps = state.simulation.substeps
            self._schedule.run_others(ResolveSystem, Stage.IMPACT, state, h)
        return Advance(made)

    def _step(self, state: State, scene: tuple[Any, ...], at: float, h: float) -> tuple[int, int, str | None]:
        """Make one step.

        Returns how many points are closed at its end, how many impacts there were, and why it cannot be made.
        """
        q, v = self._ode.q, self._ode.v
        changed, done, impacts, stalled = self._changed, 0.0, 0, 0
        changed[0, PAIR] = -1
        for _ in range(_MAX_EVENTS):
            why, count, new = self._collide(scene, state, at + done)
            impacts += new
            rest, still = 0.0, False
            if why == motion.DONE:
                why, count, rest, still = motion.begin_motion(
                    scene, self._equations, count, self._stages, changed, q, v, self._steady
                )
            if why != motion.DONE:
                return 0, impacts, _WHY[why]
            if done >= h or still:
                return count, impacts, None
            piece, evaluations = motion.advance_piece(
                scene, self._equations, count, self._room, self._stages, self._start, changed, q, v,
                h - done, _TOLERANCE, rest,
            )  # fmt: skip
            state.force_evaluations += evaluations
            stalled = stalled + 1 if piece <= _NO_TIME * h else 0
            if stalled > _MAX_STALLED or not math.isfinite(piece):
                return 0, impacts, "events follow each other without time between them"
            done = h if piece == h - done else done + piece
        return 0, impacts, f"more than {_MAX_EVENTS} events in a step"

    def _collide(self, scene: tuple[Any, ...], state: State, time: float) -> tuple[int, int, int]:
        """Find what touches, and resolve impacts; return why that failed, and how many there are of both.

        An impact can change which faces two boxes turn to each other, so contacts are then found again.
        """
        q, v, contacts, impacts = self._ode.q, self._ode.v, state.contacts, 0
        entities, acceleration = state.entity_index.entities, self._stages[-1]
        for _ in range(_REPEATS):
            why, count, rest, approaching = motion.touch(
                scene, self._equations, self._room, acceleration, q, v
            )
            if why != motion.DONE or not approaching:
                break
            why, new, lowered = motion.collide(
                scene, self._equations, count, self._room, rest, q, v, entities, contacts.log,
                contacts.logged, time,
            )  # fmt: skip
            contacts.logged += new
            impacts += new
            self.restitutions_lowered += lowered
            if why != motion.DONE:
                break
        return why, count, impacts

    def _scene(self, state: State) -> tuple[Any, ...]:
        """Return what the kernels take of the state, beside the state of motion."""
        shape, material, physics = state.table(Shape), state.table(Material), state.physics
        present = np.concatenate((np.repeat(state.table(Velocity).present, 2), state.table(Velocity).present))
        self._ode.v[:-1][~present] = 0.0
        width, height, radius = shape["width"], shape["height"], shape["radius"]
        box = shape["kind"] == BOX
        reach = np.where(box, 0.5 * np.hypot(width, height), radius)
        size = np.where(box, np.minimum(width, height), 2.0 * radius)
        outlines = np.empty((len(box), OUTLINE_FIELDS))
        for column, values in enumerate((shape["kind"], radius, width, height, reach)):
            outlines[:, column] = values
        a, b, wall = self._pairs.T
        walled = wall >= 0
        coefficients = np.empty((len(a), 3))
        friction, restitution = material["friction"], material["restitution"]
        coefficients[:, 0] = np.sqrt(np.where(walled, physics.bounds_friction, friction[a]) * friction[b])
        coefficients[:, 1] = np.minimum(
            np.where(walled, physics.bounds_restitution, restitution[a]), restitution[b]
        )
        coefficients[:, 2] = np.where(walled, size[b], np.minimum(size[a], size[b]))
        walls: NDArray[np.float64] = np.array(physics.bounds or (0.0, 0.0, 0.0, 0.0))
        ode = self._ode
        return (
            len(box), ode.inverse_mass, ode.damping, ode.calls, outlines, walls, self._pairs, coefficients
        )  # fmt: skip

    def _note(self, began: int, steps: int) -> None:
        self._schedule.note(IntegrateSystem.__name__, steps, time.perf_counter_ns() - began)
        for system in self._schedule.running:
            if system.is_engine and system.acts_within_step() and not isinstance(system, IntegrateSystem):
                self._schedule.note(system.name, steps, 0)  # their time is part of the loop's
