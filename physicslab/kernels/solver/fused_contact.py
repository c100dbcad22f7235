"""Whole steps of a world whose bodies touch, in one compiled loop: the stages of leapfrog, in their order."""

from physicslab.kernels import Flags, Rows, Vectors, inlined, kernel
from physicslab.kernels.accounts import BALANCE, BEFORE, ENERGY, PX, PY, SPIN
from physicslab.kernels.arguments import (
    Acting,
    ActingTuple,
    Bounds,
    BoundsTuple,
    Gravity,
    GravityTuple,
    Inverse,
    InverseTuple,
    Log,
    Materials,
    MaterialsTuple,
    Motion,
    MotionTuple,
    Near,
    NearTuple,
    Plan,
    PlanTuple,
    Sizes,
    SizesTuple,
    Sleepers,
    SleepersTuple,
    Softness,
    SoftnessTuple,
    named_near,
)
from physicslab.kernels.broad.fat_boxes import still_holds
from physicslab.kernels.energy import moments_of_mass, motion_totals
from physicslab.kernels.forces.gravity import uniform_gravity
from physicslab.kernels.motion import FARTHEST, LARGEST, clear, drift, find_beyond, kick
from physicslab.kernels.near_counts import ACTIVE, OUTSIDE, WIDE_COUNT
from physicslab.kernels.records import Impacts
from physicslab.kernels.sleep.islands import count_rest, find_touched
from physicslab.kernels.solver.stages import find_touching, press, relax, resolve_all_impacts
from physicslab.kernels.solver.work import book_damping, book_gravity
from physicslab.kernels.ticks import charge, ticks
from physicslab.kernels.wide.graph_colour import ADDED, MIN_WIDE, SPARSE, add_to_blocks

__all__ = [
    "ACCELERATE", "ALL", "BEGIN", "BLOCKS_FULL", "BROAD_PHASE", "CONTACT", "COSTS", "DIVERGED", "FIND",
    "GRAVITY", "IMPACTS", "INTEGRATE", "PAIRS_STALE", "RESOLVE", "SLEEP", "SLEEP_PENDING", "STEPS",
    "WAKE_PENDING", "WALL_PENDING", "advance",
]  # fmt: skip

ALL, PAIRS_STALE, BLOCKS_FULL, DIVERGED, WAKE_PENDING, SLEEP_PENDING, WALL_PENDING = range(7)
"""Why the loop ended: all steps are done; the near pairs must be listed again; so many bodies touch that more
blocks may be needed; the last step left a number that is not finite; a sleeping body is touched; at the end
of a step, an island may fall asleep, or a body was beyond the bounds."""
BEGIN, FIND, IMPACTS = range(3)
"""Where in a substep the loop begins: at its start; where bodies touch; at the impacts."""
COSTS, STEPS = 8, 7
ACCELERATE, GRAVITY, INTEGRATE, BROAD_PHASE, CONTACT, RESOLVE, SLEEP = range(STEPS)
"""The systems that do the same work in single stages, in the order of their times in ``cost``; then how many
steps were begun."""
_TIMED = 8
"""Every such step is timed: reading the clock takes a twentieth of a step of ten bodies."""


@inlined
def _keep(motion: Motion, kept: Motion) -> None:
    """Copy a state into existing arrays."""
    for i in range(len(motion.angle)):
        kept.position[i, 0], kept.position[i, 1] = motion.position[i, 0], motion.position[i, 1]
        kept.angle[i] = motion.angle[i]
        kept.linear[i, 0], kept.linear[i, 1] = motion.linear[i, 0], motion.linear[i, 1]
        kept.angular[i] = motion.angular[i]


@inlined
def _keep_book(account: Vectors) -> None:
    """Copy the accounts, to return to where a step fails."""
    for row in range(BEFORE):
        for column in range(4):
            account[BEFORE + row, column] = account[row, column]


@inlined
def _balance(account: Vectors, motion: Motion, gravity: Gravity, cause: int) -> None:
    """Measure energy and momentum, and book what they have changed by to a cause, unless that is negative."""
    translation, rotation, px, py, spin, mx, my = motion_totals(
        motion.position, motion.linear, motion.angular, gravity.mass, gravity.inertia, gravity.inverse_mass,
        gravity.inverse_inertia,
    )  # fmt: skip
    energy = translation + rotation
    energy += -(gravity.gx * mx + gravity.gy * my)
    if cause >= 0:
        account[cause, ENERGY] += energy - account[BALANCE, ENERGY]
        account[cause, PX] += px - account[BALANCE, PX]
        account[cause, PY] += py - account[BALANCE, PY]
        account[cause, SPIN] += spin - account[BALANCE, SPIN]
    account[BALANCE, ENERGY], account[BALANCE, PX] = energy, px
    account[BALANCE, PY], account[BALANCE, SPIN] = py, spin


@inlined
def _pull(acting: Acting, gravity: Gravity, cost: Rows, now: int) -> int:
    """Add up the forces, if there are any."""
    if acting.any:
        clear(acting.force, acting.torque)
        now = charge(cost, ACCELERATE, now)
        uniform_gravity(acting.force, gravity.mass, gravity.inverse_mass, gravity.gx, gravity.gy)
        now = charge(cost, GRAVITY, now)
    return now


@inlined
def _kick(
    motion: Motion, inverse: Inverse, acting: Acting, sub_integrated: Flags, damping: tuple[float, float],
    h: float,
) -> None:  # fmt: skip
    """Change velocities by the forces, and by damping."""
    kick(
        motion.linear, motion.angular, acting.force, acting.torque, inverse.mass, inverse.inertia,
        sub_integrated, damping[0], damping[1], h,
    )  # fmt: skip


@inlined
def _book_damping(
    near: Near, motion: Motion, inverse: Inverse, acting: Acting, sub_integrated: Flags,
    damping: tuple[float, float], h: float, later: float,
) -> None:  # fmt: skip
    """Book what damping takes in a kick, if there is any."""
    if damping[0] != 0.0 or damping[1] != 0.0:
        book_damping(
            motion.position, motion.linear, motion.angular, acting.force, acting.torque, inverse.mass,
            inverse.inertia, sub_integrated, damping[0], damping[1], h, later, near.account,
        )  # fmt: skip


@inlined
def _made_wide(
    near: Near, motion: Motion, sizes: Sizes, materials: Materials, inverse: Inverse, sleepers: Sleepers,
    opened: Rows, h: float,
) -> bool:  # fmt: skip
    """Put steady contacts into blocks; return whether there was room for them."""
    if near.counts[WIDE_COUNT] == 0 and near.counts[ACTIVE] < MIN_WIDE:
        return True
    came = SPARSE  # the first blocks are made in Python
    if near.counts[WIDE_COUNT] > 0:
        came = add_to_blocks(
            near, opened, sleepers.pairs, sleepers.inactive, sleepers.asleep, motion, sizes, materials,
            inverse, h,
        )  # fmt: skip
    return came == ADDED


@inlined
def _advance(
    steps: int, substep: int, stage: int, plan: Plan, cause: int,
    motion: Motion, kept: Motion, sizes: Sizes, materials: Materials, inverse: Inverse, sub_integrated: Flags,
    acting: Acting, gravity: Gravity, sleepers: Sleepers, damping: tuple[float, float], fat: Vectors,
    bounds: Bounds, near: Near, opened: Rows, softness: Softness, impulse_dt: float, impacts: Impacts,
    cost: Rows,
) -> tuple[int, int, int, int, int, float]:  # fmt: skip
    """Advance by steps, beginning at a stage of a substep, as :func:`advance` describes."""
    position, angle, linear, angular = motion
    h, counts = plan.h, near.counts
    kicked = acting.any or damping[0] != 0.0 or damping[1] != 0.0
    done, impact_count, finished_impacts = 0, 0, 0
    now = ticks()
    while done < steps:
        if stage == BEGIN:
            if substep == 0:
                now = ticks() if cost[STEPS] % _TIMED == 0 else -1
                cost[STEPS] += 1
                _keep(motion, kept)
                if cause < 0 or done > 0:  # else it was kept before what was changed between steps was booked
                    _keep_book(near.account)
                now = charge(cost, ACCELERATE, now)
            drift(position, angle, linear, angular, sub_integrated, 0.5 * h)
            now = _pull(acting, gravity, cost, charge(cost, INTEGRATE, now))
            if kicked:
                _book_damping(near, motion, inverse, acting, sub_integrated, damping, 0.5 * h, 0.25 * h)
                _kick(motion, inverse, acting, sub_integrated, damping, 0.5 * h)
            now = charge(cost, ACCELERATE, now)
            holds = still_holds(
                position, angle, linear, angular, sizes.kind, sizes.radius, sizes.width, sizes.height, fat, h,
                gravity.margin,
            )  # fmt: skip
            now = charge(cost, BROAD_PHASE, now)
            if not holds:
                return PAIRS_STALE, done, substep, finished_impacts, impact_count, impulse_dt
        if stage != IMPACTS:
            find_touching(
                near, motion, sizes, materials, inverse, bounds, substep == 0, h, -0.5, gravity.margin
            )
            now = charge(cost, CONTACT, now)
            if substep == 0:
                wide = _made_wide(near, motion, sizes, materials, inverse, sleepers, opened, h)
                now = charge(cost, CONTACT, now)
                if not wide:
                    return BLOCKS_FULL, done, substep, finished_impacts, impact_count, impulse_dt
            if sleepers.number:
                counts[ACTIVE], found = find_touched(
                    near.manifolds, near.points, near.touching, counts[ACTIVE], inverse.mass, linear, angular,
                    sleepers.asleep, sleepers.marked,
                )  # fmt: skip
                now = charge(cost, SLEEP, now)
                if found:
                    return WAKE_PENDING, done, substep, finished_impacts, impact_count, impulse_dt
        stage = BEGIN
        moment = plan.time + done * plan.dt + (substep + 0.5) * h
        total, mx, my = 0.0, 0.0, 0.0
        if acting.any:
            total, mx, my = moments_of_mass(position, gravity.mass, inverse.mass)
        came = resolve_all_impacts(
            near, motion, sizes, inverse, acting, Log(impacts, moment, near.account), h, -0.5 * h, 0.5 * h
        )
        impact_count += came
        now = charge(cost, RESOLVE, now)
        if acting.any:
            book_gravity(near.account, total, mx, my, gravity.gx, gravity.gy, 0.5 * h)
            if came > 0:
                total, mx, my = moments_of_mass(position, gravity.mass, inverse.mass)
            book_gravity(near.account, total, mx, my, gravity.gx, gravity.gy, 0.5 * h)
        if kicked:
            _book_damping(near, motion, inverse, acting, sub_integrated, damping, 0.5 * h, -0.25 * h)
            _kick(motion, inverse, acting, sub_integrated, damping, 0.5 * h)
            now = charge(cost, ACCELERATE, now)
        impulse_dt = press(near, motion, inverse, acting, softness, h, impulse_dt, plan.iterations)
        now = charge(cost, RESOLVE, now)
        drift(position, angle, linear, angular, sub_integrated, 0.5 * h)
        now = charge(cost, INTEGRATE, now)
        relax(near, motion, inverse, acting, softness, 0.5 * h, plan.iterations)
        now = charge(cost, RESOLVE, now)
        substep += 1
        if substep == plan.substeps:
            substep = 0
            failed = find_beyond(position, angle, FARTHEST) >= 0 or find_beyond(linear, angular, LARGEST) >= 0
            now = charge(cost, ACCELERATE, now)
            if failed:
                return DIVERGED, done, substep, finished_impacts, impact_count, impulse_dt
            done, finished_impacts = done + 1, impact_count
            if sleepers.on:
                check = count_rest(
                    linear, angular, sizes.kind, sizes.radius, sizes.width, sizes.height,
                    gravity.inverse_mass, sub_integrated, sleepers.asleep, sleepers.rest, sleepers.slowest,
                    plan.dt,
                )  # fmt: skip
                now = charge(cost, SLEEP, now)
                if check:
                    return SLEEP_PENDING, done, substep, finished_impacts, impact_count, impulse_dt
            if counts[OUTSIDE] != 0:
                return WALL_PENDING, done, substep, finished_impacts, impact_count, impulse_dt
    return ALL, done, substep, finished_impacts, impact_count, impulse_dt


@kernel
def advance(
    steps: int, substep: int, stage: int, plan: PlanTuple, cause: int,
    motion: MotionTuple, kept: MotionTuple, sizes: SizesTuple, materials: MaterialsTuple,
    inverse: InverseTuple, sub_integrated: Flags, acting: ActingTuple, gravity: GravityTuple,
    sleepers: SleepersTuple, damping: tuple[float, float], fat: Vectors, bounds: BoundsTuple,
    near: NearTuple, opened: Rows, softness: SoftnessTuple, impulse_dt: float, impacts: Impacts, cost: Rows,
) -> tuple[int, int, int, int, int, float]:  # fmt: skip
    """Advance by ``steps`` steps, beginning at a stage of a substep.

    The stages are those of :data:`physicslab.integrators.leapfrog.LEAPFROG`, and each does what the systems
    do there. ``kept`` has the state now, and receives that in which the last step began. ``impacts`` is the
    log, and ``cost`` (COSTS,) gets ticks added for each system, and the number of steps. What was changed
    since the last step is booked to a ``cause``, unless that is negative.

    Returns why it ended, how many steps are done, the substep that it was in, the impacts in the steps that
    are done and all impacts, and the time [s] over which the points' impulses act.
    """
    of, moved, masses = named_near(near), Motion(*motion), Gravity(*gravity)
    if cause >= 0:
        _balance(of.account, moved, masses, cause)
    ended = _advance(
        steps, substep, stage, Plan(*plan), cause, moved, Motion(*kept),
        Sizes(*sizes), Materials(*materials), Inverse(*inverse), sub_integrated,
        Acting(*acting), masses, Sleepers(*sleepers), damping, fat,
        Bounds(*bounds), of, opened, Softness(*softness), impulse_dt, impacts, cost,
    )  # fmt: skip
    _balance(of.account, moved, masses, -1)
    return ended
