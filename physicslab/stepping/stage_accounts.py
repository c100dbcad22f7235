"""The accounts of a contact step that is made stage by stage."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform, Velocity
from physicslab.contacts.arguments import inverse_in
from physicslab.ecs.vector import Vector2
from physicslab.kernels.accounts import ENERGY, FRICTION, GRAVITY, HAND, SPRINGS
from physicslab.kernels.solver import work
from physicslab.state.state import State
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import ForceSystem, Stage, System

__all__ = ["StageAccounts"]

_OF_CONTACTS = (Stage.SOLVE, Stage.RELAX)
"""Stages in which impulses act that are booked as changes of kinetic energy."""


class StageAccounts:
    """Books what stages of a substep do to energy and momentum, from the state before and after each.

    Impacts, friction and driven bodies are booked within the kernels, sub-integrated bodies within their
    flow. A force that kicks bodies and stores no energy does its work along the way of the substep.

    Parameters
    ----------
    forces : sequence of ForceSystem
        What acts.
    """

    kernels: tuple[Any, ...] = (work.book_kick, work.book_damping, work.book_contacts)

    def __init__(self, state: State, forces: Sequence[ForceSystem]) -> None:
        uniform = [force.uniform_acceleration(state) if force.is_engine else None for force in forces]
        self._gravity = sum((g for g in uniform if g is not None), start=Vector2(0.0, 0.0))
        others = [force for force, g in zip(forces, uniform, strict=True) if g is None]
        free = [force for force in others if force.potential is None]
        springs = any(isinstance(force, SpringSystem) for force in others)
        self._other = free[0].account if free else (SPRINGS if springs else GRAVITY)
        self._pulls = {force: np.zeros_like(state.bodies.pull) for force in free}
        self._follows_way = bool(others)
        self._before: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]
        self._start: tuple[NDArray[np.float64], NDArray[np.float64]]
        self._booked = self._kicked = 0.0

    @property
    def notes_forces(self) -> bool:
        """Whether a force stores no energy, so that each must be noted by itself."""
        return bool(self._pulls)

    def begin_substep(self, state: State) -> None:
        """Note where bodies are, if a force does work along their way."""
        self._kicked = 0.0
        if self._follows_way:
            transform = state.table(Transform)
            self._start = transform["position"].copy(), transform["angle"].copy()

    def note_force(self, system: System, before: NDArray[np.float64], state: State) -> None:
        """Note the pull of a force that stores no energy; ``before`` is that of those before it."""
        if system in self._pulls:
            np.subtract(state.bodies.pull, before, out=self._pulls[system])

    def begin(self, stage: Stage, state: State, share: float, h: float) -> None:
        """Note what a stage is about to change, of a ``share`` of the substep of ``h`` seconds."""
        if stage is Stage.KICK:
            self._book_kick(state, share, h)
        elif stage in _OF_CONTACTS:
            velocity, position = state.table(Velocity), state.table(Transform)["position"]
            self._before = position.copy(), velocity["linear"].copy(), velocity["angular"].copy()
            self._booked = _booked_within(state)
            if stage is Stage.RELAX and self._follows_way:
                self._book_way(state)

    def _book_kick(self, state: State, share: float, h: float) -> None:
        """Book the impulses of forces, and those of damping."""
        bodies, physics, velocity = state.bodies, state.physics, state.table(Velocity)
        position, inverse = state.table(Transform)["position"], inverse_in(state)
        if state.has_forces:
            work.book_kick(
                position, bodies.force, bodies.torque, state.table(Mass)["mass"], *inverse,
                bodies.sub_integrated, self._gravity.x, self._gravity.y, self._other, share * h,
                state.account.sums,
            )  # fmt: skip
        if physics.linear_damping > 0.0 or physics.angular_damping > 0.0:
            work.book_damping(
                position, velocity["linear"], velocity["angular"], bodies.force, bodies.torque, *inverse,
                bodies.sub_integrated, physics.linear_damping, physics.angular_damping, share * h,
                (0.5 - self._kicked - 0.5 * share) * h, state.account.sums,
            )  # fmt: skip
        self._kicked += share

    def end(self, stage: Stage, state: State, h: float) -> None:
        """Book what a stage of the substep of ``h`` seconds has changed."""
        if stage not in _OF_CONTACTS:
            return
        velocity, mass, bodies = state.table(Velocity), state.table(Mass), state.bodies
        work.book_contacts(
            velocity["linear"], velocity["angular"], *self._before,
            bodies.force, bodies.torque, mass["mass"], mass["inertia"], *inverse_in(state), bodies.unkicked,
            h if stage is Stage.SOLVE and state.has_forces else 0.0,
            _booked_within(state) - self._booked, state.account.sums,
        )  # fmt: skip

    def _book_way(self, state: State) -> None:
        """Book the work of forces along the way of the substep, and that of what drives against them."""
        transform, bodies, sums = state.table(Transform), state.bodies, state.account.sums
        way = np.concatenate(
            ((transform["position"] - self._start[0]).ravel(), transform["angle"] - self._start[1])
        )
        kicked = (bodies.awake_inverse_mass > 0.0) & ~bodies.sub_integrated
        rows = np.concatenate((np.repeat(kicked, 2), kicked & (bodies.awake_inverse_inertia > 0.0)))
        for force, pull in self._pulls.items():
            sums[force.account, ENERGY] += float(pull[rows] @ way[rows])
        driven = state.table(Velocity).present & (bodies.inverse_mass == 0.0) & ~bodies.sub_integrated
        if driven.any():
            rows = np.concatenate((np.repeat(driven, 2), driven))
            sums[HAND, ENERGY] -= float(bodies.pull[rows] @ way[rows])


def _booked_within(state: State) -> float:
    """Return the work that kernels of contacts have booked."""
    return float(state.account.sums[FRICTION, ENERGY] + state.account.sums[HAND, ENERGY])
