"""The record of a method, and how one is split into drifts and kicks."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.sentences import sentence
from physicslab.integrators.along_joints import follows_joints, split_along_joints
from physicslab.kernels.accounts import FIELDS
from physicslab.kernels.forces.force_calls import add_forces
from physicslab.kernels.ode.dop853 import dop853
from physicslab.kernels.ode.splitting import split
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State
from physicslab.systems.system import Stage


@dataclass(frozen=True)
class Splitting:
    """The flow of the method kick, drift, kick, ..., drift, kick.

    Bodies stay where they are during a kick, so the work of a force in it is the impulse times the mean
    velocity: an integrator whose flow is of this type has its forces that store nothing kept for that.

    Attributes
    ----------
    drifts, kicks : tuple of float
        Shares of the step, n and n + 1.
    """

    drifts: tuple[float, ...]
    kicks: tuple[float, ...]

    @cached_property
    def shares(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Drifts (n,) and kicks (n + 1,), as kernels take them."""
        return np.array(self.drifts), np.array(self.kicks)

    def __call__(self, state: State, ode: OdeSystem, h: float, steps: int) -> int:
        """Advance by so many steps of so many seconds; return the force evaluations."""
        if follows_joints(ode):
            state.compile((dop853, add_forces))
            made = split_along_joints(ode, self.drifts, self.kicks, h, steps)
            if made < 0:
                raise StepTooSmall(sentence("forces_without_limit"))
            return made
        q_low, v_low = ode.remainders(state)
        return split(
            ode.q, ode.v, q_low, v_low, ode.inverse_mass, ode.damping, ode.calls, *self.shares, ode.places,
            ode.gyration, ode.slots.get(FIELDS, -1), ode.by_velocity, h, steps,
        )  # fmt: skip


type Flow = Callable[[State, OdeSystem, float, int], int]
"""Advances the equations of a world by so many steps of so many seconds; returns the force evaluations."""


class StepTooSmall(ArithmeticError):
    """No step is short enough for the required accuracy: the motion is singular."""


class Exhausted(StepTooSmall):
    """It takes more evaluations than it may."""


@dataclass(frozen=True, slots=True)
class Integrator:
    """One method: how it advances, and its properties as data for reports.

    To add one, write its file, and name it in the list of :mod:`physicslab.integrators`. Its tests hold it to
    what it states here.

    Attributes
    ----------
    name, title : str
        For files, and for people.
    order : int
        The error after a fixed time falls with the ``order``-th power of the step, for smooth forces (that
        depend on positions alone, where ``positions_only``).
    evaluations : int
        Force evaluations a step.
    source : str
        Where the method is described.
    flow : callable
        How it advances a world in which nothing but forces acts, compiled.
    stability_limit : float
        Largest omega h at which an undamped oscillation stays bounded.
    symplectic : bool
        Whether phase-space area, and so energy over long times, is kept.
    kernels : tuple of kernels
        What ``flow`` calls; that of a :class:`Splitting` by default.
    substep : tuple of (Stage, float)
        How it advances a world in which more than forces acts: the stages of one substep in order, each with
        its share of the substep's time. Empty for a method that cannot.
    window : tuple of two floats
        When the substep begins and ends, relative to the moment at which impacts are resolved, in substeps.
    positions_only : bool
        Whether the order holds only for forces that do not depend on velocities.
    chooses_steps : bool
        Whether it chooses its own steps within the given time.
    phase_share, phase_order : float, int
        The share of omega t by which the phase of an oscillation is wrong is ``phase_share`` times omega h to
        the power ``phase_order``, for small omega h; 0 where it is not known.
    samples : bool
        Whether ``flow`` fills what is ``wanted`` of the system: the motion at moments within its span.
    """

    name: str
    title: str
    order: float
    evaluations: int
    source: str
    flow: Flow
    stability_limit: float = math.inf
    symplectic: bool = False
    kernels: tuple[Any, ...] = (split,)
    substep: tuple[tuple[Stage, float], ...] = ()
    window: tuple[float, float] = (0.0, 1.0)
    positions_only: bool = False
    chooses_steps: bool = False
    phase_share: float = 0.0
    phase_order: int = 2
    samples: bool = False

    @property
    def kicks(self) -> bool:
        """Whether it changes velocities by forces at places that stay meanwhile."""
        return isinstance(self.flow, Splitting)
