"""The accounts of a contact step that is made stage by stage."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.contacts.arguments import inverse_in
from physicslab.ecs.vector import Vector2
from physicslab.kernels.accounts import DAMPING, ENERGY, GRAVITY, HAND, OVERLAP, SPRINGS
from physicslab.kernels.solver import work
from physicslab.state.packed import spring_ends, turned_anchors
from physicslab.state.state import State
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import ForceSystem, Stage, System

__all__ = ["StageAccounts"]


class StageAccounts:
    """Books what the forces of a substep do to energy and momentum, from the state before and after stages.

    What impulses do is booked within the kernels, what moves sub-integrated bodies within their flow. A force
    that kicks bodies and stores no energy does its work along the way of the substep.

    Parameters
    ----------
    forces : sequence of ForceSystem
        What acts.
    """

    kernels: tuple[Any, ...] = (work.book_kick, work.book_damping)

    def __init__(self, state: State, forces: Sequence[ForceSystem]) -> None:
        uniform = [force.uniform_acceleration(state) if force.is_engine else None for force in forces]
        self._gravity = sum((g for g in uniform if g is not None), start=Vector2(0.0, 0.0))
        others = [force for force, g in zip(forces, uniform, strict=True) if g is None]
        free = [force for force in others if force.potential is None]
        springs = any(isinstance(force, SpringSystem) for force in others)
        self._other = free[0].account if free else (SPRINGS if springs else GRAVITY)
        self._pulls = {force: np.zeros_like(state.bodies.pull) for force in free}
        self._storing = [force for force in others if force.potential is not None]
        self._follows_way, self._damps = bool(others), springs and _has_dampers(state)
        self._dampers = np.zeros_like(state.bodies.pull)
        self._before: NDArray[np.float64]
        self._start: tuple[NDArray[np.float64], NDArray[np.float64]]
        self._driven: NDArray[np.bool_] | None = None
        self._generation = -1
        self._kicked = 0.0

    @property
    def notes_forces(self) -> bool:
        """Whether a force stores no energy, or not all its work, so that each must be noted by itself."""
        return bool(self._pulls) or self._damps

    def begin_substep(self, state: State) -> None:
        """Note where bodies are, if a force does work along their way that is booked."""
        bodies, self._kicked = state.bodies, 0.0
        if not self._follows_way:
            return
        if self._generation != state.generation:  # once a step
            driven = state.table(Velocity).present & (bodies.inverse_mass == 0.0) & ~bodies.sub_integrated
            self._driven, self._generation = driven if driven.any() else None, state.generation
        if self.notes_forces or self._driven is not None:
            transform = state.table(Transform)
            self._start = transform["position"].copy(), transform["angle"].copy()

    def note_force(self, system: System, before: NDArray[np.float64], state: State) -> None:
        """Note the pull of a force that stores no energy; ``before`` is that of those before it."""
        if system in self._pulls:
            np.subtract(state.bodies.pull, before, out=self._pulls[system])
        elif self._damps and isinstance(system, SpringSystem):
            self._dampers = _pull_of_dampers(state)

    def begin(self, stage: Stage, state: State, share: float, h: float) -> None:
        """Note what a stage is about to change, of a ``share`` of the substep of ``h`` seconds."""
        if stage is Stage.KICK:
            self._book_kick(state, share, h)
        elif stage is Stage.RELAX and self._follows_way:
            self._book_way(state)
            self._before = state.table(Transform)["position"].copy()

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

    def end(self, stage: Stage, state: State) -> None:
        """Book what a stage of a substep has changed."""
        if stage is Stage.RELAX and self._storing:
            self._book_overlap(state)

    def _book_overlap(self, state: State) -> None:
        """Book what moving bodies apart has changed in what forces store that are not the same everywhere.

        The kernel has booked their work as if they stayed as they are along that way.
        """
        position, bodies = state.table(Transform)["position"], state.bodies
        way = position - self._before
        if not way.any():
            return
        now = position.copy()
        stored = sum(force.potential_energy(state) for force in self._storing)
        position[:] = self._before
        stored -= sum(force.potential_energy(state) for force in self._storing)
        position[:] = now
        weight = state.table(Mass)["mass"][:, None] * np.array((self._gravity.x, self._gravity.y))
        free = (bodies.awake_inverse_mass > 0.0)[:, None]
        state.account.sums[OVERLAP, ENERGY] += stored + float(((bodies.force - weight) * way * free).sum())

    def _book_way(self, state: State) -> None:
        """Book the work of forces along the way of the substep, and that of what drives against them."""
        driven, transform, bodies = self._driven, state.table(Transform), state.bodies
        if driven is None and not self.notes_forces:
            return
        sums = state.account.sums
        way = np.concatenate(
            ((transform["position"] - self._start[0]).ravel(), transform["angle"] - self._start[1])
        )
        kicked = (bodies.awake_inverse_mass > 0.0) & ~bodies.sub_integrated
        rows = np.concatenate((np.repeat(kicked, 2), kicked & (bodies.awake_inverse_inertia > 0.0)))
        for force, pull in self._pulls.items():
            sums[force.account, ENERGY] += float(pull[rows] @ way[rows])
        if self._damps:
            sums[DAMPING, ENERGY] += float(self._dampers[rows] @ way[rows])
        if driven is not None:
            rows = np.concatenate((np.repeat(driven, 2), driven))
            sums[HAND, ENERGY] -= float(bodies.pull[rows] @ way[rows])


def _has_dampers(state: State) -> bool:
    """Whether a spring has a damper that kicks: what is sub-integrated books its own."""
    rows, a, b = spring_ends(state)
    kicked = state.table(Velocity).present & ~state.bodies.sub_integrated
    return bool(((state.table(Spring)["damping"][rows] > 0.0) & (kicked[a] | kicked[b])).any())


def _pull_of_dampers(state: State) -> NDArray[np.float64]:
    """Return the forces and torques of the dampers of all springs, row by row as in ``bodies.pull``."""
    (rows, a, b), spring, n = spring_ends(state), state.table(Spring), len(state.entity_index)
    transform, velocity = state.table(Transform), state.table(Velocity)
    ends = [
        (turned_anchors(state, end, rows, anchor), end, sign)
        for anchor, end, sign in (("anchor_a", a, -1.0), ("anchor_b", b, 1.0))
    ]
    apart, rate = np.zeros((len(rows), 2)), np.zeros((len(rows), 2))
    for arm, end, sign in ends:
        across = np.stack((-arm[:, 1], arm[:, 0]), axis=1)
        apart += sign * (transform["position"][end] + arm)
        rate += sign * (velocity["linear"][end] + velocity["angular"][end, None] * across)
    length = np.hypot(*apart.T)
    along = apart / np.where(length > 0.0, length, np.inf)[:, None]
    force = (spring["damping"][rows] * (rate * along).sum(axis=1))[:, None] * along
    pull = np.zeros(3 * n)
    for arm, end, sign in ends:
        np.add.at(pull[: 2 * n].reshape(n, 2), end, -sign * force)
        np.add.at(pull[2 * n :], end, -sign * (arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]))
    return pull
