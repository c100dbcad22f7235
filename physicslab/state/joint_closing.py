"""Places of bodies at which their joints hold: from where they are, with the least that is moved."""

import math

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform
from physicslab.kernels.joints.measured import AX, BX, TURN_A
from physicslab.state.joint_figures import errors_of_rows, measured_terms
from physicslab.state.joint_rows import Role
from physicslab.state.state import State

type Numbers = NDArray[np.float64]
"""A float64 array (n,)."""

_TURNS = 12
"""Newton's steps at most."""
_MAX_TURN = 0.25
"""How far the hand turns a body in a pause before joints are closed again [rad], lest it overshoots."""
_APART, _MOST_ROWS = 1e-9, 400
"""How far joints are apart [m or rad] that are closed before a run, and how many rows they may have."""


def closing_places(
    state: State, least: float, *, limits: bool = False, start: tuple[Numbers, Numbers] | None = None,
    give: Numbers | None = None,
) -> tuple[Numbers, Numbers] | None:  # fmt: skip
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
    start : float64 arrays (rows, 2) and (rows,), optional
        Where bodies are [m], and their angles [rad], if not where the state has them.
    give : float64 array (rows, 3), optional
        Inverse masses along x and y [1/kg] and inverse moments of inertia [1/(kg m^2)], if others than those.
    """
    transform = state.table(Transform)
    begin = (transform["position"], transform["angle"]) if start is None else start
    if give is not None:
        return _closed(state, least, limits, begin, give)
    mass, inertia = state.bodies.inverse_mass, state.bodies.inverse_inertia
    give = np.stack((mass, mass, inertia), axis=1)
    found = _closed(state, least, limits, begin, give)
    if found is None:
        found = _closed(state, least, limits, begin, give / np.where(mass > 0.0, mass, 1.0)[:, None])
    return found


def _closed(
    state: State, least: float, limits: bool, start: tuple[Numbers, Numbers], give: Numbers
) -> tuple[Numbers, Numbers] | None:
    """Return places and angles at which joints hold, found with inverse masses and moments ``give``."""
    joints, owner = state.joints, state.joints.row
    position, angle = (values.copy() for values in start)
    give = np.sqrt(give)
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


def is_joined(state: State, row: int) -> bool:
    """Whether a joint holds the body of a row."""
    state.joints.refresh(state.entity_index)
    joints = state.joints
    return bool(((joints.a == row) | (joints.b == row)).any())


def joined_rows(state: State, row: int) -> NDArray[np.bool_]:
    """Return which rows (rows,) joints hold together with one, that one as well; fixed bodies part them."""
    joints = state.joints
    found = np.zeros(len(state.entity_index), np.bool_)
    found[row] = True
    moves = state.bodies.inverse_mass > 0.0
    pairs = np.stack((joints.a, joints.b), axis=1)[moves[joints.a] & moves[joints.b]]
    while (more := pairs[found[pairs].any(axis=1) & ~found[pairs].all(axis=1)]).size:
        found[more] = True
    return found


def posed_places(
    state: State, row: int, arm: tuple[float, float], way: tuple[float, float]
) -> tuple[Numbers, Numbers] | None:
    """Return places (rows, 2) [m] and angles (rows,) [rad] as a hand moves a point of a body by a way [m].

    ``arm`` is the point from the body's middle [m], along the axes of the world.
    Bodies that are joined to it follow; where they cannot, it gives way itself. ``None`` where no joint holds
    it, or no places are found.
    """
    if not is_joined(state, row) or len(state.joints) > _MOST_ROWS:
        return None
    bodies, mass = state.bodies, state.table(Mass)
    position, angle = (state.table(Transform)[name].copy() for name in ("position", "angle"))
    position[row] += way
    give = np.stack((bodies.inverse_mass, bodies.inverse_mass, bodies.inverse_inertia), axis=1)
    give[row] = 0.0
    found = closing_places(state, _APART, limits=True, start=(position, angle), give=give)
    if found is None and mass.present[row]:
        turns = not mass["fixed_rotation"][row] and mass["inertia"][row] > 0.0
        give[row, :2] = 1.0 / mass["mass"][row]
        give[row, 2] = 1.0 / mass["inertia"][row] if turns else 0.0
        # An impulse at the point moves it by the way, and the body about it.
        across = np.array((-arm[1], arm[0]))
        impulse = np.linalg.solve(give[row, 0] * np.eye(2) + give[row, 2] * np.outer(across, across), way)
        share = min(1.0, _MAX_TURN * math.hypot(*arm) / max(math.hypot(*way), 1e-300))
        position[row] += give[row, 0] * impulse - way
        angle[row] += share * give[row, 2] * (across @ impulse)
        found = closing_places(state, _APART, limits=True, start=(position, angle), give=give)
    return found


def close_joints(state: State) -> None:
    """Move bodies to where joints hold them, if something was set by which they are apart; else nothing."""
    state.joints.refresh(state.entity_index)
    found = far_places(state)
    if found is not None:
        transform = state.table(Transform)
        transform["position"][:], transform["angle"][:] = found
