"""The balance of a world before and after each step: what was booked between is what changed it."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Mass, Transform, Velocity
from physicslab.kernels import digest, direct_entry, energy
from physicslab.kernels.accounts import FIELDS, JOINTS
from physicslab.ode.system import OdeSystem
from physicslab.state.account import Balance
from physicslab.state.joint_closing import far_places
from physicslab.state.state import State
from physicslab.systems.schedule import Schedule
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import ForceSystem, Stage, System

_FAR = 0.01
"""The turn [rad] from which on a joint that an edit has put apart is closed at once."""
_MANY = 256
"""Rows from which on it is seen by a digest that nothing was changed since the last step."""


def held_in(state: State) -> tuple[int, ...]:
    """Return the entities that a hand holds."""
    return tuple(state.table(Held).handles)


def _columns(state: State) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Return what kernels take: the columns of a balance, and those of a digest, bit by bit."""
    kept, revision = state.account.columns, state.entity_index.revision
    if kept is not None and kept[0] == revision and kept[1][-2] is state.bodies.inverse_mass:
        return kept[1], kept[2]
    state.compile((energy.motion_totals, digest.digest_sums))
    velocity, mass, transform = state.table(Velocity), state.table(Mass), state.table(Transform)
    bodies = state.bodies
    own = mass["mass"], mass["inertia"], bodies.inverse_mass, bodies.inverse_inertia
    motion = transform["position"], velocity["linear"], velocity["angular"]
    bits = transform["position"], transform["angle"], velocity["linear"], velocity["angular"], *own
    words = tuple(column.reshape(-1).view(np.int64) for column in bits)
    state.account.columns = revision, (*motion, *own), words
    return (*motion, *own), words


def motion_totals_of(state: State) -> tuple[float, float, float, float, float, float, float]:
    """Return the sums of :func:`physicslab.kernels.energy.motion_totals`; all rows must be up to date."""
    columns, _ = _columns(state)
    totals: tuple[float, float, float, float, float, float, float] = direct_entry(energy.motion_totals)(
        *columns
    )
    return totals


def balance_of(
    state: State, forces: Sequence[ForceSystem], potential: dict[str, float] | None = None
) -> Balance:
    """Return energy and momentum as they are now; all rows and masses must be up to date.

    Energy that each force stores [J] is added to ``potential`` by the force's name, where that is given.
    """
    translation, rotation, px, py, spin, mx, my = motion_totals_of(state)
    total = translation + rotation
    for force in forces:
        if force.potential is None:
            continue
        g = force.uniform_acceleration(state) if force.is_engine else None
        stored = force.potential_energy(state) if g is None else -(g.x * mx + g.y * my)
        total += stored
        if potential is not None:
            potential[force.potential] = potential.get(force.potential, 0.0) + stored
    return Balance(total, px, py, spin)


def _is_of_columns(forces: Sequence[ForceSystem]) -> bool:
    """Whether a balance depends on columns, laws and settings of forces alone."""
    stores = [force for force in forces if force.potential is not None]
    return all(force.is_engine or type(force) is SpringSystem for force in stores)


def _seen(state: State, forces: Sequence[ForceSystem]) -> object | None:
    """Return what a balance depends on, in short.

    ``None`` where a force may depend on more, and of so few bodies that a balance takes no longer.
    """
    if len(state.entity_index) < _MANY:
        return None
    if not _is_of_columns(forces):
        return None
    _, words = _columns(state)
    settings = [force.settings(state) for force in forces if force.potential is not None]
    return direct_entry(digest.digest_sums)(*words), state.physics, settings, state.entity_index.revision


def open_account(state: State, forces: Sequence[ForceSystem], *, unedited: bool = False) -> None:
    """Begin a step: what was changed since the last one is an edit, or a hand's.

    ``unedited`` says that no column was.
    """
    account = state.account
    unchanged = unedited and account.is_known and _is_of_columns(forces)
    if not unchanged:
        seen = _seen(state, forces)
        unchanged = seen is not None and seen == account.seen and account.is_known
    if unchanged:
        account.held = held_in(state)
    else:
        account.open(balance_of(state, forces), held_in(state), state.time)
    account.is_open = True


def put_together(state: State, forces: Sequence[ForceSystem], ode: OdeSystem) -> None:
    """Move what joints hold together and an edit, or a scene, has put apart; the energy goes to joints."""
    places = ode.placed_together()
    if places is not None:
        before = balance_of(state, forces)
        ode.place(state, places)
        state.account.sums[JOINTS] += np.subtract(balance_of(state, forces), before)
    ode.set_going()


def put_far_together(state: State, forces: Sequence[ForceSystem]) -> None:
    """Put together what an edit, or a scene, has put so far apart that soft joints would turn it by much.

    Their springs would leave it spinning: they pull along arms that have turned away before they let go. The
    energy goes to joints.
    """
    found = _far_places(state)
    state.joints.placed = _places(state)
    if found is None:
        return
    state.joints.impulse[:] = 0.0  # they held other places
    if not state.account.is_open:
        open_account(state, forces)
    before, transform = balance_of(state, forces), state.table(Transform)
    transform["position"][:], transform["angle"][:] = found
    state.account.sums[JOINTS] += np.subtract(balance_of(state, forces), before)
    state.contacts.stale = True


def kept_joints(state: State) -> list[tuple[int, str, list[float]]]:
    """Return the impulses of joints (``Joints.kept``) with which another world goes on as this one does.

    There are none where an edit has put joints far apart: both worlds then put them together first.
    """
    return [] if _far_places(state) is not None else list(state.joints.kept())


def restore_joints(state: State, kept: Sequence[tuple[int, str, Sequence[float]]], *sources: State) -> None:
    """Give back impulses that :func:`kept_joints` returned of ``sources``, where bodies are now.

    An edit that has moved bodies since the last step of a source is seen before the next one.
    """
    state.joints.restore(kept)
    edited = any(_is_edited(source, state) for source in sources)
    state.joints.placed = b"" if edited or not state.joints.impulse.any() else _places(state)


def _is_edited(source: State, state: State) -> bool:
    """Whether bodies are elsewhere in ``state`` than the last step of a source has left them."""
    (now, rows), (then, others) = (
        (one.table(Transform), one.entity_index.entities) for one in (state, source)
    )
    shared, here, there = np.intersect1d(rows, others, return_indices=True)
    here, there = here[shared > 0], there[shared > 0]  # 0: a row without a body
    same = all(np.array_equal(now[name][here], then[name][there]) for name in ("position", "angle"))
    return not same or source.joints.placed != _places(source)


def _far_places(state: State) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Return places (rows, 2) [m] and angles (rows,) [rad] of what :func:`put_far_together` has to move."""
    known = state.joints.placed == _places(state) or state.sleep.count
    return None if known else far_places(state, _FAR)


def note_places(state: State) -> None:
    """Note where soft joints have left what they hold."""
    state.joints.placed = _places(state)


def _places(state: State) -> bytes:
    transform = state.table(Transform)
    return transform["position"].tobytes() + transform["angle"].tobytes()


def acts_unbooked(system: System) -> bool:
    """Whether a system is called within a step and books nothing: neither a force nor one of the engine's."""
    return system.acts_within_step() and not (system.engine or isinstance(system, ForceSystem))


def run_measured(stage: Stage, schedule: Schedule, state: State, h: float) -> None:
    """Run a stage; what a system that books nothing changes is measured, and booked as that of a field."""
    for system in schedule.running:
        method = type(system).marked().get(stage)
        if method is None:
            continue
        measured = acts_unbooked(system)
        before = balance_of(state, schedule.forces) if measured else None
        schedule.call(system, getattr(system, method), state, h)
        if before is not None:
            state.account.sums[FIELDS] += np.subtract(balance_of(state, schedule.forces), before)


def book_account(state: State, forces: Sequence[ForceSystem]) -> None:
    """Book what was changed since the last step, or since this was called last."""
    state.account.book(balance_of(state, forces), held_in(state))
    state.account.seen = None  # what was seen belongs to the balance before


def close_account(state: State, forces: Sequence[ForceSystem]) -> None:
    """End a step: what is not booked of what it changed is an error."""
    state.account.last, state.account.is_open = balance_of(state, forces), False
    state.account.seen = _seen(state, forces)
