"""Whole steps of a world whose bodies touch, in one compiled loop: the stages of leapfrog, in their order."""

from physicslab.kernels import Flags, Numbers, Rows, Vectors, fused, inlined, kernel
from physicslab.kernels.broad.grid import still_holds
from physicslab.kernels.broad.near_pairs import activate, sort_scalar
from physicslab.kernels.forces.gravity import uniform_gravity
from physicslab.kernels.motion import clear, drift, find_not_finite, kick
from physicslab.kernels.narrow.contact import CACHE_TOLERANCE, CACHE_TURN_TOLERANCE, find_contacts
from physicslab.kernels.narrow.pair import CONTACT_MARGIN, SWEEP_THRESHOLD
from physicslab.kernels.records import Couples, Manifolds, Points
from physicslab.kernels.sleep.islands import count_rest, find_touched
from physicslab.kernels.solver.impact import resolve_impacts
from physicslab.kernels.solver.impulse import MAX_SUBSTEP_FACTOR, relax, separate, solve
from physicslab.kernels.ticks import charge, ticks
from physicslab.kernels.wide.graph_colour import ADDED, FEW, SPARSE, add_constraints
from physicslab.kernels.wide.layout import BOX, DISC
from physicslab.kernels.wide.refresh import refresh
from physicslab.kernels.wide.slots import (
    ACTIVE,
    BOX_BLOCKS,
    DISC_BLOCKS,
    LEFT,
    PROXIMITY,
    RECORDED,
    SCALAR,
    UNORDERED,
    WIDE_COUNT,
    Slots,
    wake,
)

__all__ = [
    "ALL", "BEGIN", "BLOCKS_FULL", "DIVERGED", "FIND", "IMPACTS", "PAIRS_STALE", "SLEEP_PENDING",
    "SYSTEMS", "WAKE_PENDING", "advance",
]  # fmt: skip

ALL, PAIRS_STALE, BLOCKS_FULL, DIVERGED, WAKE_PENDING, SLEEP_PENDING = range(6)
"""Why the loop ended: all steps are made; the near pairs must be listed anew; so many bodies touch that more
blocks may be needed; the last step has left something that is not finite; somebody asleep is touched; at the
end of a step, somebody may fall asleep."""
BEGIN, FIND, IMPACTS = range(3)
"""Where in a substep the loop begins: at its start; where bodies touch; at the impacts."""
SYSTEMS = (
    "Bodies", "GravitySystem", "IntegrateSystem", "BroadPhaseSystem", "ContactSystem", "ResolveSystem",
    "SleepSystem",
)  # fmt: skip
"""Whose work it is, in the order in which ``cost`` holds what each took."""
_BODIES, _GRAVITY, _INTEGRATE, _BROAD_PHASE, _CONTACT, _RESOLVE, _SLEEP = range(7)

_TIMED = 8
"""One of so many steps of a call is timed: reading the clock takes a twentieth of a step of ten bodies."""

_State = tuple[Vectors, Numbers, Vectors, Numbers]
"""Positions [m], angles [rad], velocities [m/s], angular velocities [rad/s]."""
_Sizes = tuple[Rows, Numbers, Numbers, Numbers]
"""Kinds of shape, radii, widths, heights [m]."""
_Two = tuple[Numbers, Numbers]
"""Restitutions and frictions; inverse masses [1/kg] and moments of inertia [1/(kg m^2)]."""
_Forces = tuple[Vectors, Numbers, Numbers, bool, float, float]
"""Forces [N], torques [N m], masses [kg]; whether any act, and gravity [m/s^2]."""
_Sleep = tuple[bool, int, float, Numbers, Flags, Numbers, Numbers, Flags, Flags, Rows]
"""Whether bodies may sleep, how many do, the step [s], inverse masses of sleepers too, who sleeps, rests [s]
and lowest speeds [m/s]; room for marks; whose pairs are laid aside, and which pairs those are."""
_Bounds = tuple[Numbers, float, float]
"""Where they are [m], their restitution and friction."""
_Pairs = tuple[Manifolds, Points, Rows, Rows]
"""The records of near pairs, which of them are loose, and which of those touch."""
_Wide = tuple[Numbers, int, Rows, Rows, Rows, Numbers, int, Rows, Rows, Rows]
"""Blocks of discs and of boxes: data, how many, their order, rows of A and B."""
_Idle = tuple[Couples, Numbers, Rows]
"""The near pairs without records and how near each must come to get one [m]; the entities of all rows."""
_Spring = tuple[float, float, float, float]
"""Of contacts: frequency [Hz], damping ratio, slop, fastest push [m/s]."""


@inlined
def _keep(state: _State, kept: _State) -> None:
    """Copy a state into arrays that are there."""
    for i in range(len(state[1])):
        kept[0][i, 0], kept[0][i, 1] = state[0][i, 0], state[0][i, 1]
        kept[1][i] = state[1][i]
        kept[2][i, 0], kept[2][i, 1] = state[2][i, 0], state[2][i, 1]
        kept[3][i] = state[3][i]


@inlined
def _pull(forces: _Forces, inverse_mass: Numbers, cost: Rows, now: int) -> int:
    """Add up the forces anew, if there are any."""
    force, torque, mass, has_forces, gx, gy = forces
    if has_forces:
        clear(force, torque)
        now = charge(cost, _BODIES, now)
        uniform_gravity(force, mass, inverse_mass, gx, gy)
        now = charge(cost, _GRAVITY, now)
    return now


@inlined
def _find(
    counts: Rows, discs: Slots, boxes: Slots, proximity: _Idle, pairs: _Pairs, state: _State, sizes: _Sizes,
    materials: _Two, inverse: _Two, bounds: _Bounds, first: bool, h: float, speculative_margin: float,
) -> None:  # fmt: skip
    """Find where settled contacts touch now, which idle pairs come near, then where the loose ones touch."""
    manifolds, points, scalar, touching = pairs
    walls, bounds_restitution, bounds_friction = bounds
    if counts[WIDE_COUNT] > 0:
        before = counts[SCALAR]
        for kind in (DISC, BOX):
            data, a, b, pair, colour, used, _ = discs if kind == DISC else boxes
            counts[SCALAR] = refresh(
                kind, data, counts[DISC_BLOCKS if kind == DISC else BOX_BLOCKS], a, b, pair, colour, used,
                manifolds, points, scalar, counts[SCALAR], *state,
                first, h, SWEEP_THRESHOLD, CONTACT_MARGIN, speculative_margin, CACHE_TOLERANCE,
                CACHE_TURN_TOLERANCE,
            )  # fmt: skip
        came = counts[SCALAR] - before
        counts[WIDE_COUNT] -= came
        if came > 0 or counts[UNORDERED] != 0:
            sort_scalar(manifolds, scalar, counts[SCALAR], len(state[1]))
            counts[UNORDERED] = 0
    couples, activation_distance, entities = proximity
    counts[PROXIMITY], counts[RECORDED], counts[SCALAR] = activate(
        couples, activation_distance, counts[PROXIMITY], manifolds, points, counts[RECORDED], scalar,
        counts[SCALAR], entities,
        state[0], state[2], h, speculative_margin,
    )  # fmt: skip
    counts[ACTIVE] = find_contacts(
        manifolds, points, scalar, counts[SCALAR], touching, *state, *sizes, *materials, *inverse,
        walls, bounds_restitution, bounds_friction, first, h, -0.5, speculative_margin,
    )  # fmt: skip


@inlined
def _resolve_impacts(
    counts: Rows, discs: Slots, boxes: Slots, pairs: _Pairs, state: _State, inverse: _Two, forces: _Forces,
    h: float,
) -> int:  # fmt: skip
    """Bounce what meets, settled contacts that this wakes among it; return how many impacts there were."""
    manifolds, points, scalar, touching = pairs
    impacts, counts[LEFT] = 0, 0
    while counts[ACTIVE] > 0:
        impact_count, counts[LEFT] = resolve_impacts(
            manifolds, points, touching, counts[ACTIVE], *state, forces[0], *inverse, forces[3],
            h, -0.5 * h, 0.5 * h,
        )  # fmt: skip
        impacts += impact_count
        before = counts[ACTIVE]
        if impact_count > 0 and counts[WIDE_COUNT] > 0:
            for kind in (DISC, BOX):
                data, a, b, pair, colour, used, _ = discs if kind == DISC else boxes
                counts[SCALAR], counts[ACTIVE] = wake(
                    kind, data, counts[DISC_BLOCKS if kind == DISC else BOX_BLOCKS], a, b, pair, colour, used,
                    manifolds, points, scalar, counts[SCALAR], touching, counts[ACTIVE],
                    state[2], state[3], forces[0], inverse[0], h,
                )  # fmt: skip
        if counts[ACTIVE] == before:
            break
        counts[WIDE_COUNT] -= counts[ACTIVE] - before
        counts[UNORDERED] = 1
    return impacts


@inlined
def _warm_start_scale(h: float, impulse_dt: float) -> float:
    """Return how many times as long a substep is as the time that the points' impulses stand for.

    What an instant left behind is mostly rounding, which is not to be blown up.
    """
    return h / max(impulse_dt, h / MAX_SUBSTEP_FACTOR) if impulse_dt > 0.0 else 1.0


@fused
def _solved(counts: Rows, discs: Slots, boxes: Slots) -> _Wide:
    """Return what the solver wants to know of the blocks."""
    return (
        discs[0], counts[DISC_BLOCKS], discs[6], discs[1], discs[2],
        boxes[0], counts[BOX_BLOCKS], boxes[6], boxes[1], boxes[2],
    )  # fmt: skip


@kernel
def advance(
    steps: int, substeps: int, substep: int, stage: int, h: float, iterations: int,
    state: _State, kept: _State, sizes: _Sizes, materials: _Two, inverse: _Two, sub_integrated: Flags,
    forces: _Forces, sleep: _Sleep, damping: tuple[float, float], speculative_margin: float, fat: Vectors,
    bounds: _Bounds,
    proximity: _Idle, pairs: _Pairs, counts: Rows, discs: Slots, boxes: Slots, opened: Rows,
    spring: _Spring, impulse_dt: float, cost: Rows,
) -> tuple[int, int, int, int, int, float]:  # fmt: skip
    """Make ``steps`` steps of ``substeps`` times ``h`` seconds, beginning at a stage of a substep.

    The stages are those of :data:`physicslab.integrators.leapfrog.LEAPFROG`, and what happens at each is what
    the systems do there. ``speculative_margin`` is how far [m] the forces may bring two bodies together
    within a substep; ``counts`` are those of :mod:`physicslab.kernels.wide.slots`, and change. ``cost`` (7,)
    gets ticks added for each of ``SYSTEMS``.

    Returns why it ended, how many steps are done, the substep that it was in, the impacts in the steps that
    are done and all impacts, and the time [s] that the points' impulses stand for. ``kept`` is the state in
    which the last step began.
    """
    position, angle, linear, angular = state
    manifolds, points, scalar, touching = pairs
    hertz, damping_ratio, slop, max_push = spring
    sleeps, sleepers, dt, own_inverse_mass, asleep, rest, slowest, touched, inactive, sleeping = sleep
    kicked = forces[3] or damping[0] != 0.0 or damping[1] != 0.0
    done, impacts, impacts_done = 0, 0, 0
    now = ticks()
    while done < steps:
        if stage == BEGIN:
            if substep == 0:
                now = ticks() if done % _TIMED == 0 else -1
                _keep(state, kept)
                now = charge(cost, _BODIES, now)
            drift(position, angle, linear, angular, sub_integrated, 0.5 * h)
            now = _pull(forces, own_inverse_mass, cost, charge(cost, _INTEGRATE, now))
            if kicked:
                kick(linear, angular, forces[0], forces[1], *inverse, sub_integrated, *damping, 0.5 * h)
            now = charge(cost, _BODIES, now)
            holds = still_holds(position, angle, linear, *sizes, fat, h)
            now = charge(cost, _BROAD_PHASE, now)
            if not holds:
                return PAIRS_STALE, done, substep, impacts_done, impacts, impulse_dt
        if stage != IMPACTS:
            _find(
                counts, discs, boxes, proximity, pairs, state, sizes, materials, inverse, bounds,
                substep == 0, h, speculative_margin,
            )  # fmt: skip
            now = charge(cost, _CONTACT, now)
            if substep == 0 and (counts[WIDE_COUNT] > 0 or counts[ACTIVE] >= FEW):
                came = SPARSE  # the first blocks are Python's to make
                if counts[WIDE_COUNT] > 0:
                    came = add_constraints(
                        counts, discs, boxes, opened, manifolds, points, scalar, sleeping, touching, inactive,
                        asleep, sizes[0], sizes[1], *materials, linear, *inverse, h,
                    )  # fmt: skip
                now = charge(cost, _CONTACT, now)
                if came != ADDED:
                    return BLOCKS_FULL, done, substep, impacts_done, impacts, impulse_dt
            if sleepers:
                counts[ACTIVE], found = find_touched(
                    manifolds, points, touching, counts[ACTIVE], inverse[0], linear, angular, asleep, touched
                )
                now = charge(cost, _SLEEP, now)
                if found:
                    return WAKE_PENDING, done, substep, impacts_done, impacts, impulse_dt
        stage = BEGIN
        impacts += _resolve_impacts(counts, discs, boxes, pairs, state, inverse, forces, h)
        now = charge(cost, _RESOLVE, now)
        if kicked:
            kick(linear, angular, forces[0], forces[1], *inverse, sub_integrated, *damping, 0.5 * h)
            now = charge(cost, _BODIES, now)
        touch = manifolds, points, touching, counts[ACTIVE]
        both, solving = touch + _solved(counts, discs, boxes), counts[LEFT] + counts[WIDE_COUNT] > 0
        if solving:
            solve(
                *both, linear, angular, *inverse, forces[0], forces[3],
                h, _warm_start_scale(h, impulse_dt), iterations, hertz, damping_ratio, slop,
            )  # fmt: skip
            impulse_dt = h
            now = charge(cost, _RESOLVE, now)
        drift(position, angle, linear, angular, sub_integrated, 0.5 * h)
        now = charge(cost, _INTEGRATE, now)
        if solving:
            relax(*both, linear, angular, *inverse, 0.5 * h, iterations)
            separate(*touch, position, inverse[0], max_push * (0.5 * h))
            now = charge(cost, _RESOLVE, now)
        substep += 1
        if substep == substeps:
            substep = 0
            failed = find_not_finite(position, angle) >= 0 or find_not_finite(linear, angular) >= 0
            now = charge(cost, _BODIES, now)
            if failed:
                return DIVERGED, done, substep, impacts_done, impacts, impulse_dt
            done, impacts_done = done + 1, impacts
            if sleeps:
                due = count_rest(
                    linear, angular, *sizes, own_inverse_mass, sub_integrated, asleep, rest, slowest, dt
                )
                now = charge(cost, _SLEEP, now)
                if due:
                    return SLEEP_PENDING, done, substep, impacts_done, impacts, impulse_dt
    return ALL, done, substep, impacts_done, impacts, impulse_dt
