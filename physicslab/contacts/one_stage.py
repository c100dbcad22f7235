"""One stage of a substep by itself, as the systems of contacts do it."""

import numpy as np

from physicslab.contacts.arguments import (
    acting_in,
    bounds_of,
    inverse_in,
    joints_in,
    materials_of,
    motion_of,
    near_in,
    shapes_of,
    speculative_margin,
)
from physicslab.kernels.arguments import ActingTuple, InverseTuple, MotionTuple, NearTuple, SoftnessTuple
from physicslab.kernels.solver import soft
from physicslab.state.state import State

_NOTHING = np.zeros(0)
_NO_VECTORS = np.zeros((0, 2))


def do_stage(
    state: State, part: int, h: float, *, softness: SoftnessTuple = (0.0, 0.0, 0.0), first: bool = False,
    near: NearTuple | None = None, motion: MotionTuple | None = None, inverse: InverseTuple | None = None,
    acting: ActingTuple | None = None,
) -> int:  # fmt: skip
    """Do one part of a substep, as the loop of whole steps does it; return how many impacts there were.

    Parameters
    ----------
    state : State
        Of which everything is taken that is not given.
    part : int
        One of those for contacts and joints in :mod:`physicslab.kernels.solver.soft`.
    h : float
        The time that it covers [s].
    softness : tuple of three floats
        The contact spring.
    first : bool
        Whether it is in the first substep of a step.
    near, motion, inverse, acting : tuples of arrays, optional
        What takes part.
    """
    state.compile((soft.advance,))
    near, inverse, contacts = near or near_in(state), inverse or inverse_in(state), state.contacts
    motion = motion or motion_of(state)
    none = np.zeros(0, np.bool_)
    course = np.array([part]), np.array([[1.0], [0.0], [0.0]]), *state.window, -1.0, True
    plan = 2, state.simulation.iterations or 0, h, h, state.moment, h, 1 if first else 0
    gravity = _NOTHING, _NOTHING, *inverse, 0.0, 0.0, speculative_margin(state, h), 0
    packed = _NO_VECTORS, np.zeros((0, 3), np.int64)
    rows = np.zeros(0, np.int64)
    sleepers = False, 0, none, _NOTHING, _NOTHING, none, none, rows, _NO_VECTORS, False
    *_, impacts, _, contacts.impulse_dt = soft.advance(
        1, 1, 0, plan, course, -1, motion, _NOTHING, shapes_of(state), materials_of(state), inverse,
        state.bodies.sub_integrated, acting or acting_in(state), gravity, packed, (_NOTHING, rows), sleepers,
        (0.0, 0.0), np.zeros((8, 0)), bounds_of(state), near, joints_in(state), contacts.opened, softness,
        contacts.impulse_dt, contacts.step_log, np.zeros(soft.COSTS, np.int64),
    )  # fmt: skip
    return int(impacts)
