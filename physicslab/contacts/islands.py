"""Islands of bodies that touch: how they fall asleep and wake, and which edits wake them."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Material, Transform, Velocity
from physicslab.contacts.arguments import acting_in, inverse_in, joints_in, motion_of
from physicslab.ecs.vector import Vector2
from physicslab.kernels.accounts import CONTACT
from physicslab.kernels.arguments import Inverse, Motion, named_acting
from physicslab.kernels.joints.blocks import Joints
from physicslab.kernels.joints.soft import begin_joints
from physicslab.kernels.python_fallback import fallback_of
from physicslab.kernels.sleep import edits, islands
from physicslab.kernels.solver import work
from physicslab.state.state import State

type _Marks = NDArray[np.bool_]


def follow_rows(state: State) -> None:
    """Move the values of every entity where rows are numbered again."""
    if state.sleep.follow(state.entity_index.entities):
        state.contacts.stale = True
        _set_contacts_inactive(state)


def check_edits(state: State, *, within: bool = False) -> None:
    """Wake the bodies that an edit affects: they, or bodies that touch them, have other values now.

    ``within`` a step, kinematic bodies may have moved.
    """
    sleep = state.sleep
    if not sleep.count:
        sleep.gone = sleep.gone[:0]
        return
    marked = sleep.asleep & state.bodies.sub_integrated
    if state.joints.refresh(state.entity_index):
        marked |= sleep.asleep
    if sleep.laws != (state.physics, state.simulation):
        marked |= sleep.asleep
    figures, edited = _figures(state), np.zeros(len(sleep.asleep), np.bool_)
    velocity = state.table(Velocity)
    found = edits.find_edited(
        figures, sleep.kept, velocity["linear"], velocity["angular"], sleep.asleep, sleep.known,
        within, edited,
    )  # fmt: skip
    fresh = ~sleep.known & (figures[:, edits.INVERSE_MASS] == 0.0) & (sleep.entities > 0)
    if found or len(sleep.gone) or fresh.any():
        causes = np.flatnonzero((edited | fresh) & ~sleep.asleep)
        edits.find_overlapped(figures, causes, sleep.asleep, marked)
        _mark_neighbours(state, np.concatenate((sleep.gone, sleep.entities[edited])), marked)
        marked |= edited & sleep.asleep
    changed = found > 0 or len(sleep.gone) > 0 or fresh.any() or marked.any()
    sleep.kept, sleep.gone = figures, sleep.gone[:0]
    sleep.known = sleep.entities > 0
    if changed:
        wake(state, marked)


def _mark_neighbours(state: State, causes: NDArray[np.int64], marked: _Marks) -> None:
    """Mark the sleeping bodies that touched some of the entities ``causes`` when pairs were last listed."""
    a, b, count = _touching(state)
    near = state.contacts.manifolds[: state.contacts.recorded]
    for entity, row in ((near["entity_a"], b), (near["entity_b"], a)):
        met = row[(count > 0) & np.isin(entity, causes) & (row >= 0)]
        marked[met[state.sleep.asleep[met]]] = True


def wake_neighbours(state: State, entities: NDArray[np.int64]) -> None:
    """Wake what sleeps and touched some entities (n,) when pairs were last listed."""
    if state.sleep.count:
        marked = np.zeros(len(state.sleep.asleep), np.bool_)
        _mark_neighbours(state, entities, marked)
        if marked.any():
            wake(state, marked)


def wake(state: State, marked: _Marks) -> _Marks:
    """Wake the islands of the ``marked`` bodies (rows,), and mark all of them; return which bodies woke."""
    sleep = state.sleep
    a, b, count = _touching(state)
    joined = state.joints.edges
    islands.join_marked(
        np.concatenate((a, joined[:, 0])), np.concatenate((b, joined[:, 1])),
        np.concatenate((count, np.ones(len(joined), np.int64))), sleep.asleep, marked,
    )  # fmt: skip
    woken = marked & sleep.asleep
    sleep.asleep &= ~woken
    sleep.rest[woken] = sleep.slowest[woken] = 0.0
    sleep.count = int(np.count_nonzero(sleep.asleep))
    touches = (count > 0) & (a >= 0) & (b >= 0) & (woken[a] | woken[b])
    state.contacts.rescale(touches, _impulse_dt(state), state.contacts.impulse_dt)
    set_inactive(state)
    return woken


def fall_asleep(state: State, falling: _Marks) -> None:
    """Put bodies to sleep: those that are ``falling`` (rows,)."""
    sleep, velocity, bodies = state.sleep, state.table(Velocity), state.bodies
    _book_rest(state, falling)
    velocity["linear"][falling] = velocity["angular"][falling] = 0.0
    sleep.rest[falling] = sleep.slowest[falling] = 0.0
    sleep.forces[falling, :2] = bodies.force[falling]
    sleep.forces[falling, 2] = bodies.torque[falling]
    sleep.asleep |= falling
    sleep.count = int(np.count_nonzero(sleep.asleep))
    a, b, count = _touching(state)
    contacts = state.contacts
    contacts.release(sleep.asleep)
    _begin(state)
    contacts.rescale((count > 0) & (falling[a] | falling[b]), contacts.impulse_dt, _impulse_dt(state))
    set_inactive(state)


def _book_rest(state: State, falling: _Marks) -> None:
    """Book that contacts take what is left of the motion of bodies that fall asleep."""
    position, velocity, mass = state.table(Transform)["position"], state.table(Velocity), state.table(Mass)
    free = falling & (state.bodies.inverse_mass > 0.0)
    turning = free & (state.bodies.inverse_inertia > 0.0)
    momentum = mass["mass"][free, None] * velocity["linear"][free]
    turned = mass["inertia"][turning] * velocity["angular"][turning]
    energy = (momentum * velocity["linear"][free]).sum() + turned @ velocity["angular"][turning]
    x, y = position[free].T
    spin = (x * momentum[:, 1] - y * momentum[:, 0]).sum() + turned.sum()
    state.account.sums[CONTACT] -= (0.5 * energy, *momentum.sum(axis=0), spin)


def measure_joints(state: State) -> None:
    """Find the gradients of joints that have impulses from a file or a key frame, and were in no step yet."""
    joints = Joints(*joints_in(state))
    if joints.impulse.any() and not joints.gradient.any():
        rotations = np.full((len(state.entity_index), 3), np.nan)
        motion, inverse = Motion(*motion_of(state)), Inverse(*inverse_in(state))
        acting = fallback_of(named_acting)(acting_in(state))
        fallback_of(begin_joints)(joints, motion, rotations, inverse, acting, 0.0)


def pull_of(state: State) -> Vector2:
    """Return uniform gravity [m/s^2], or zero."""
    return state.physics.gravity if state.physics.gravity_mode == "linear" else Vector2()


def book_sleep(state: State, asleep: _Marks, h: float) -> None:
    """Book that forces pull bodies (rows,) that sleep for ``h`` seconds, and what holds them."""
    measure_joints(state)
    bodies, acted, joints = state.bodies, state.contacts.impulse_dt, Joints(*joints_in(state))
    gravity = pull_of(state)
    work.book_held(
        state.table(Transform)["position"], state.table(Mass)["mass"], bodies.inverse_mass,
        bodies.inverse_inertia, np.where(asleep, 0.0, bodies.inverse_mass), state.sleep.forces,
        state.uniform_forces, gravity.x, gravity.y, state.sleep.other, h, joints.nodes, joints.body,
        joints.gradient, joints.impulse, h / (acted or _impulse_dt(state)), state.account.sums,
    )  # fmt: skip


def _begin(state: State) -> None:
    """Record the present state; an edit is a difference from it."""
    sleep = state.sleep
    sleep.laws = state.physics, state.simulation
    sleep.kept, sleep.known = _figures(state), sleep.entities > 0


def keep_places(state: State) -> None:
    """Record where a step has moved kinematic bodies: one that is elsewhere later was edited."""
    if state.sleep.count:
        transform, kept = state.table(Transform), state.sleep.kept
        rows = np.flatnonzero(state.table(Velocity).present & (state.bodies.inverse_mass == 0.0))
        kept[rows, :2], kept[rows, 2] = transform["position"][rows], transform["angle"][rows]


def wake_all(state: State) -> None:
    """Wake every body, and begin all rests again."""
    sleep = state.sleep
    sleep.asleep[:] = False
    sleep.rest[:] = sleep.slowest[:] = 0.0
    sleep.count, sleep.unverified = 0, False
    set_inactive(state)


def all_asleep(state: State) -> bool:
    """Whether a step would change nothing but the clock: all that can be moved sleeps, and nothing moves.

    No system may act within the step but those of the engine's own contact step.
    """
    sleep = state.sleep
    if not sleep.count or sleep.unverified or sleep.acted_upon or state.contacts.stale:
        return False
    if sleep.count != np.count_nonzero(state.bodies.inverse_mass):
        return False
    velocity = state.table(Velocity)
    return not (velocity["linear"].any() or velocity["angular"].any())


def _figures(state: State) -> NDArray[np.float64]:
    transform, material = state.table(Transform), state.table(Material)
    bodies, shapes = state.bodies, state.bodies.shapes
    figures = np.zeros((len(state.sleep.asleep), edits.FIGURES))
    state.compile(state.sleep.kernels)
    edits.note_figures(
        transform["position"], transform["angle"],
        shapes.vertices, shapes.first, shapes.half_x, shapes.half_y, shapes.reach,
        material["restitution"], material["friction"], bodies.inverse_mass, bodies.inverse_inertia,
        state.table(Velocity).present, figures,
    )  # fmt: skip
    return figures


def set_inactive(state: State) -> None:
    """Update bodies and contacts by which bodies sleep now."""
    state.bodies.set_inactive(state.sleep.asleep)
    _set_contacts_inactive(state)


def _set_contacts_inactive(state: State) -> None:
    asleep = state.sleep.asleep
    none = np.zeros(0, np.bool_)
    inactive = asleep | ~state.table(Velocity).present if state.sleep.count else none
    state.contacts.set_inactive(inactive, len(asleep))


def impulse_spans(state: State, pairs: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the time [s] over which the impulses of recorded pairs (n,) act.

    It is the substep of the last step, which may be shorter than others; of those that sleep the usual one.
    """
    near, spans = state.contacts.manifolds[pairs], np.full(len(pairs), state.contacts.impulse_dt)
    if state.sleep.count:
        asleep = state.sleep.asleep
        spans[asleep[np.maximum(near["a"], 0)] | asleep[np.maximum(near["b"], 0)]] = _impulse_dt(state)
    return spans


def _impulse_dt(state: State) -> float:
    """Return the time [s] over which impulses of sleeping contacts act."""
    simulation = state.sleep.laws[1] if state.sleep.laws is not None else state.simulation
    span: float = simulation.dt / simulation.substeps
    return span


def export_rests(state: State) -> list[list[Any]]:
    """Return lists: an entity that sleeps, or one with how long [s] and how slowly [m/s] it has rested.

    A sleeper is followed by the force [N] and the torque [N m] under which it fell asleep, where these are
    known: others wake it. Only bodies that a file can restore: those with a Shape that can be moved.
    """
    sleep = state.sleep
    movable = (state.bodies.inverse_mass > 0.0) & (state.bodies.shapes.vertices != 0)
    rows = np.flatnonzero((sleep.asleep | (sleep.rest > 0.0)) & movable)
    columns = (sleep.entities, sleep.asleep, sleep.rest, sleep.slowest, sleep.forces)
    values = zip(*(column[rows].tolist() for column in columns), strict=True)
    return [
        [entity, *(force if force[0] == force[0] else ())] if asleep else [entity, rest, slowest]
        for entity, asleep, rest, slowest, force in values
    ]


def restore_rests(state: State, rows: Sequence[Sequence[Any]]) -> None:
    """Restore what :func:`export_rests` returned; where bodies may not sleep, all are awake."""
    sleep = state.sleep
    if not (sleep.on and rows):
        return
    sleep.forces[:] = np.nan
    for entity, *rested in rows:
        row = state.entity_index.row_of[entity]
        if len(rested) == 2:
            sleep.rest[row], sleep.slowest[row] = rested
            continue
        sleep.asleep[row] = True
        if rested:
            sleep.forces[row] = rested
    sleep.count = int(np.count_nonzero(sleep.asleep))
    sleep.unverified = sleep.count > 0
    _begin(state)
    set_inactive(state)


def _touching(state: State) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the present rows of every near pair, -1 for removed bodies, and how many points it has."""
    near = state.contacts.manifolds[: state.contacts.recorded]
    index = state.entity_index
    a, b = (np.ascontiguousarray(index.rows_of(near[name])) for name in ("entity_a", "entity_b"))
    return a, b, np.ascontiguousarray(near["count"])
