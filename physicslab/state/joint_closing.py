"""Places of bodies at which their joints hold: from where they are, with the least that is moved."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.kernels.joints.measured import AX, BX, TURN_A
from physicslab.state.joint_figures import errors_of_rows, measured_terms
from physicslab.state.joint_rows import Role
from physicslab.state.state import State

type Numbers = NDArray[np.float64]
"""A float64 array (n,)."""

_TURNS = 12
"""Newton's steps at most."""
_APART, _MOST_ROWS = 1e-9, 400
"""How far joints are apart [m or rad] that are closed before a run, and how many rows they may have."""


def closing_places(state: State, least: float, *, limits: bool = False) -> tuple[Numbers, Numbers] | None:
    """Return places (rows, 2) [m] and angles (rows,) [rad] at which joints hold; ``None`` if none is found.

    Heavy bodies are moved least. Where light ones between them leave no way, all move as if they were equal.

    Parameters
    ----------
    state : State
        It is not changed.
    least : float
        The error that may be left [m or rad].
    limits : bool
        Whether limits are kept too, and ropes are no longer than they are.
    """
    mass, inertia = state.bodies.inverse_mass, state.bodies.inverse_inertia
    found = _closed(state, least, limits, mass, inertia)
    if found is None:
        scale = np.where(mass > 0.0, mass, 1.0)
        found = _closed(state, least, limits, mass / scale, inertia / scale)
    return found


def _closed(
    state: State, least: float, limits: bool, mass: Numbers, inertia: Numbers
) -> tuple[Numbers, Numbers] | None:
    """Return places and angles at which joints hold, found by these inverse masses and moments (rows,)."""
    joints, transform = state.joints, state.table(Transform)
    owner = state.joints.row
    position, angle = transform["position"].copy(), transform["angle"].copy()
    give = np.sqrt(np.stack((mass, mass, inertia), axis=1))
    for _ in range(_TURNS):
        terms = measured_terms(state, position, angle)
        error = errors_of_rows(state, terms)
        held = (joints.role == Role.HOLD) | (limits & (joints.role == Role.LIMIT) & (error < 0.0))
        error = np.where(held, error, 0.0)
        if np.abs(error).max(initial=0.0) < least:
            return position, angle
        gradient = np.zeros((len(joints), len(angle), 3))
        pulls = joints.scale[:, None] * terms
        np.add.at(gradient, (owner, joints.a), pulls[:, AX : TURN_A + 1])
        np.add.at(gradient, (owner, joints.b), pulls[:, BX:])
        moved = (gradient * give)[held].reshape(-1, give.size)
        if not (np.isfinite(moved).all() and np.isfinite(error).all()):
            return None
        closing = np.linalg.lstsq(moved, -error[held], rcond=1e-6)[0].reshape(give.shape) * give
        # No farther at once than errors reach: rods in line do not say which way they would close.
        closing *= min(1.0, np.abs(error).sum() / max(np.abs(closing[:, :2]).max(), 1e-300))
        position += closing[:, :2]
        angle += closing[:, 2]
    return None


def far_places(state: State, turn: float = 0.0) -> tuple[Numbers, Numbers] | None:
    """Return places (rows, 2) [m] and angles (rows,) [rad] at which joints hold, ropes and limits too.

    ``None`` where they hold already, where none are found, and where no body would turn by ``turn`` [rad].
    """
    if not 0 < len(state.joints) <= _MOST_ROWS:
        return None
    transform, found = state.table(Transform), closing_places(state, _APART, limits=True)
    if found is None or np.abs(found[1] - transform["angle"]).max() < turn:
        return None
    return None if np.array_equal(found[0], transform["position"]) and not turn else found


def close_joints(state: State) -> None:
    """Move bodies to where joints hold them, if something was set by which they are apart; else nothing."""
    state.joints.refresh(state.entity_index)
    found = far_places(state)
    if found is not None:
        transform = state.table(Transform)
        transform["position"][:], transform["angle"][:] = found
