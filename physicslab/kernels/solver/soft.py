"""Substeps of a world whose bodies touch, in one compiled loop.

It goes through the stages of a substep in the order in which it is given them
(:data:`physicslab.integrators.leapfrog.LEAPFROG` has them as data), and returns where Python is needed: to
list pairs, to wake bodies, or at a stage where systems act that no kernel computes.
"""

from physicslab.kernels import Flags, Numbers, Plain, Rows, Vectors, inlined, kernel
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, BALANCE, BEFORE, ENERGY, PX, PY, book
from physicslab.kernels.arguments import (
    Acting,
    ActingTuple,
    Bounds,
    Course,
    Gravity,
    Inverse,
    Log,
    Materials,
    Motion,
    Near,
    Packed,
    Plan,
    Sampled,
    Sleepers,
    Softness,
    Springs,
    named_acting,
    named_near,
    take_sample,
)
from physicslab.kernels.broad.fat_boxes import all_inside
from physicslab.kernels.broad.leaving import FatBoxes, list_leavers
from physicslab.kernels.clock import next_time
from physicslab.kernels.energy import moments_of_mass, motion_totals
from physicslab.kernels.forces.force_calls import add_forces
from physicslab.kernels.forces.gravity import uniform_gravity
from physicslab.kernels.geometry.contact import BEGINS, GOES_ON, WITHIN
from physicslab.kernels.geometry.shapes import Shapes, ShapesTuple, named_shapes
from physicslab.kernels.joints.blocks import Joints
from physicslab.kernels.joints.measured import overloaded
from physicslab.kernels.motion import FARTHEST, LARGEST, clear, drift, find_beyond, kick, pack_state, predict
from physicslab.kernels.near_counts import ACTIVE, LEFT, OUTSIDE, ROUND, WIDE_COUNT
from physicslab.kernels.ode.damped_flow import flow_forces
from physicslab.kernels.ode.spring_flow import flow_at, rows_in
from physicslab.kernels.records import Impacts
from physicslab.kernels.sleep.edits import find_pushed
from physicslab.kernels.sleep.islands import count_rest, find_touched
from physicslab.kernels.solver.finer import factor_for
from physicslab.kernels.solver.meet_again import is_outdated
from physicslab.kernels.solver.separate import book_stored
from physicslab.kernels.solver.stages import (
    find_touching,
    press,
    relax,
    resolve_all_impacts,
    resolve_later_impacts,
)
from physicslab.kernels.solver.work import book_damping, book_gravity, book_held, book_kick, note_flow
from physicslab.kernels.ticks import charge, ticks
from physicslab.kernels.wide.graph_colour import ADDED, MIN_WIDE, SPARSE, add_to_blocks

(
    ALL, PYTHON, PAIRS_STALE, BLOCKS_FULL, DIVERGED, WAKE_PENDING, SLEEP_PENDING, WALL_PENDING,
    OTHER_SUBSTEPS, OVERLOADED,
) = range(10)  # fmt: skip
"""Why the loop ended: all steps are done; it is at a part that is Python's; the near pairs must be listed
again; so many bodies touch that more blocks may be needed; the last step left a number that is not finite; a
sleeping body is touched or pushed; at the end of a step, an island may fall asleep, or a body was beyond the
bounds, or the next step needs another number of substeps, or a joint has to break."""
(
    HOOK, DRIFT, UNIFORM, PACKED, KICK, PAIRS, FIND, WIDEN, WAKE, IMPACTS, PAIRS_AGAIN, LATER_IMPACTS,
    PREDICT, SOLVE, RELAX, OVERLAP, MOVED, SPRINGS,
) = range(18)  # fmt: skip
"""The parts of a substep: what is Python's; bodies move; uniform forces, or compiled ones, are added up, and
kick; whether the near pairs are still all that are near; where bodies touch; steady contacts get into blocks,
once a step; whether sleeping bodies are to be woken; impacts; whether the near pairs still are all after
these, and what they have left swift meets others; velocities are predicted; the impulses of contacts, and
those after bodies have moved; what springs store elsewhere, if these have moved bodies apart, and what is
Python's if they have. From SPRINGS on, the bodies of the flow of that number move, or Python moves them."""
SHARE, DRIFTED, LATER = range(3)
"""Where in ``Course.times`` these are."""
COSTS, STEPS = 8, 7
ACCELERATE, GRAVITY, INTEGRATE, BROAD_PHASE, CONTACT, RESOLVE, SLEEP = range(STEPS)
"""The systems whose work this is, in the order of their times in ``cost``; then how many steps were begun."""
_TIMED = 8
"""Every such step is timed: reading the clock takes a twentieth of a step of ten bodies."""


@inlined
def _keep(motion: Motion, kept: Numbers) -> None:
    """Copy a state into an existing array (6 rows,), one column after the other."""
    n = len(motion.angle)
    for i in range(n):
        kept[2 * i], kept[2 * i + 1] = motion.position[i, 0], motion.position[i, 1]
        kept[2 * n + i] = motion.angle[i]
        kept[3 * n + 2 * i], kept[3 * n + 2 * i + 1] = motion.linear[i, 0], motion.linear[i, 1]
        kept[5 * n + i] = motion.angular[i]


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
        last = account[BALANCE]
        book(
            account[cause],
            0,
            energy - last[ENERGY],
            px - last[PX],
            py - last[PY],
            spin - last[ANGULAR_MOMENTUM],
        )
    account[BALANCE] = 0.0
    book(account[BALANCE], 0, energy, px, py, spin)


@inlined
def _moved(motion: Motion, before: Numbers) -> bool:
    """Whether any body is elsewhere than before."""
    for i in range(len(motion.angle)):
        if motion.position[i, 0] != before[2 * i] or motion.position[i, 1] != before[2 * i + 1]:
            return True
    return False


@inlined
def _note_flow(
    near: Near, motion: Motion, inverse: Inverse, acting: Acting, flow: Springs, sign: float, h: float
) -> None:
    """Take a flow from the velocities noted, if any were, as :func:`note_flow` does."""
    if near.counts[LEFT] + near.counts[WIDE_COUNT] > 0:
        for rows in rows_in(flow):
            note_flow(
                near.linear_before, near.angular_before, motion.linear, motion.angular, acting.force,
                acting.torque, inverse.mass, inverse.inertia, rows, acting.unkicked, acting.uniform, sign, h,
            )  # fmt: skip


@inlined
def _woken(near: Near, motion: Motion, inverse: Inverse, acting: Acting, sleepers: Sleepers) -> bool:
    """Return whether a sleeping body is to be woken; what rests on fixed bodies is passed over by impacts."""
    if sleepers.unverified:
        return True
    if sleepers.number == 0:
        return False
    near.counts[ACTIVE], found = find_touched(
        near.manifolds, near.points, near.touching, near.counts[ACTIVE], inverse.mass, motion.linear,
        motion.angular, sleepers.asleep, sleepers.marked,
    )  # fmt: skip
    if acting.any and not acting.uniform:
        found += find_pushed(acting.force, acting.torque, sleepers.forces, sleepers.asleep, sleepers.marked)
    return found > 0


@inlined
def _made_wide(
    near: Near, motion: Motion, shapes: Shapes, materials: Materials, inverse: Inverse, sleepers: Sleepers,
    opened: Rows, h: float, substeps: int,
) -> bool:  # fmt: skip
    """Put steady contacts into blocks; return whether there was room for them."""
    if near.counts[WIDE_COUNT] == 0 and near.counts[ACTIVE] < MIN_WIDE:
        return True
    came = SPARSE  # the first blocks are made in Python
    if near.counts[WIDE_COUNT] > 0:
        came = add_to_blocks(
            near, opened, sleepers.pairs, sleepers.inactive, sleepers.asleep, motion, shapes, materials,
            inverse, h, substeps,
        )  # fmt: skip
    return came == ADDED


@inlined
def _advance(
    steps: int, substep: int, part: int, plan: Plan, course: Course, cause: int,
    motion: Motion, kept: Numbers, shapes: Shapes, materials: Materials, inverse: Inverse,
    sub_integrated: Flags, acting: Acting, gravity: Gravity, packed: Packed, springs: Springs,
    sleepers: Sleepers, damping: tuple[float, float], fat: FatBoxes, bounds: Bounds, near: Near,
    joints: Joints, opened: Rows, softness: Softness, impulse_dt: float, impacts: Impacts, cost: Rows,
    sampled: Sampled,
) -> tuple[int, int, int, int, int, int, int, float]:  # fmt: skip
    """Advance by steps, beginning at a part of a substep, as :func:`advance` describes."""
    position, angle, linear, angular = motion
    h, counts, account = plan.h, near.counts, near.account
    damped = damping[0] != 0.0 or damping[1] != 0.0
    done, bounced, finished, evaluations, evaluated = 0, 0, 0, 0, 0
    weighed, total, mx, my, began = False, 0.0, 0.0, 0.0, plan.time
    now = ticks()
    while done < steps:
        if substep == 0 and part == 0:
            now = ticks() if course.hooked or cost[STEPS] % _TIMED == 0 else -1
            cost[STEPS] += 1
            evaluated = evaluations
            if not course.hooked:
                _keep(motion, kept)
                if cause < 0 or done > 0:  # else it was kept before what was changed between steps was booked
                    _keep_book(account)
                now = charge(cost, ACCELERATE, now)
        while part < len(course.parts):
            what, span, why = course.parts[part], course.times[SHARE, part] * h, ALL
            if what == DRIFT:
                drift(position, angle, linear, angular, sub_integrated, span)
                weighed = False
                now = charge(cost, INTEGRATE, now)
            elif what >= SPRINGS:
                flow = flow_at(springs, what - SPRINGS)
                _note_flow(near, motion, inverse, acting, flow, 1.0, span)
                made = flow_forces(motion, flow, span, account)
                _note_flow(near, motion, inverse, acting, flow, -1.0, 0.0 if made >= 0 else -span)
                evaluations += max(0, made)
                why = ALL if made >= 0 else PYTHON
                weighed = False
                now = charge(cost, INTEGRATE, now)
            elif what in (UNIFORM, PACKED):
                clear(acting.force, acting.torque)
                now = charge(cost, ACCELERATE, now)
                if what == UNIFORM:
                    uniform_gravity(acting.force, gravity.mass, gravity.inverse_mass, gravity.gx, gravity.gy)
                else:
                    drifted = began + substep * h + course.times[DRIFTED, part] * h
                    pack_state(position, angle, linear, angular, drifted, packed.state)
                    add_forces(packed.state[0], packed.state[1], acting.pull, packed.calls)
                now = charge(cost, GRAVITY, now)
            elif what == KICK:
                if acting.uniform:
                    if not weighed:
                        total, mx, my = moments_of_mass(position, gravity.mass, inverse.mass)
                        weighed = True
                    book_gravity(account, total, mx, my, gravity.gx, gravity.gy, span)
                elif acting.any:
                    book_kick(
                        position, acting.force, acting.torque, gravity.mass, inverse.mass, inverse.inertia,
                        sub_integrated, gravity.gx, gravity.gy, gravity.other, span, account,
                    )  # fmt: skip
                if sleepers.number > 0:
                    book_held(
                        position, gravity.mass, gravity.inverse_mass, gravity.inverse_inertia, inverse.mass,
                        sleepers.forces, acting.uniform, gravity.gx, gravity.gy, gravity.other, span,
                        joints.nodes, joints.body, joints.gradient, joints.impulse,
                        span / (impulse_dt if impulse_dt > 0.0 else h), account,
                    )  # fmt: skip
                if damped:
                    book_damping(
                        position, linear, angular, acting.force, acting.torque, inverse.mass, inverse.inertia,
                        sub_integrated, damping[0], damping[1], span, course.times[LATER, part] * h, account,
                    )  # fmt: skip
                if damped or acting.any:
                    kick(
                        linear, angular, acting.force, acting.torque, inverse.mass, inverse.inertia,
                        sub_integrated, damping[0], damping[1], span,
                    )  # fmt: skip
                now = charge(cost, ACCELERATE, now)
            elif what == PAIRS:
                holds = all_inside(motion, shapes, fat.ways, span, gravity.margin)
                now = charge(cost, BROAD_PHASE, now)
                why = ALL if holds else PAIRS_STALE
            elif what == FIND:
                when = (GOES_ON if done > 0 else BEGINS) if substep == plan.first else WITHIN
                find_touching(
                    near, motion, shapes, materials, inverse, bounds, when, span, course.start,
                    gravity.margin, plan.substeps,
                )  # fmt: skip
                now = charge(cost, CONTACT, now)
            elif what == WIDEN:
                if substep == plan.first:
                    room = _made_wide(
                        near, motion, shapes, materials, inverse, sleepers, opened, span, plan.substeps
                    )
                    now = charge(cost, CONTACT, now)
                    why = ALL if room else BLOCKS_FULL
            elif what == WAKE:
                if _woken(near, motion, inverse, acting, sleepers):
                    why = WAKE_PENDING
                now = charge(cost, SLEEP, now)
            elif what == IMPACTS:
                moment = began + (substep + course.middle) * h
                came = resolve_all_impacts(
                    near, motion, shapes, materials, inverse, acting, bounds, Log(impacts, moment, account),
                    span, course.start * span, course.end * span, gravity.margin,
                )  # fmt: skip
                bounced += came
                weighed = weighed and came == 0
                now = charge(cost, RESOLVE, now)
            elif what == PAIRS_AGAIN:
                if is_outdated(near, motion, shapes, fat.ways, span, gravity.margin):
                    why = PAIRS_STALE
            elif what == LATER_IMPACTS:
                moment = began + (substep + course.middle) * h
                came = resolve_later_impacts(
                    near, motion, shapes, materials, inverse, acting, fat.ways, Log(impacts, moment, account),
                    span, course.start * span, course.end * span, gravity.margin,
                )  # fmt: skip
                bounced += came
                weighed = weighed and came == 0
                if counts[ROUND] > 0:
                    part -= 2  # back to the pairs
                now = charge(cost, RESOLVE, now)
            elif what == PREDICT:
                predict(
                    linear, angular, acting.force, acting.torque, inverse.mass, inverse.inertia,
                    sub_integrated, acting.unkicked, span,
                )  # fmt: skip
            elif what == SOLVE:
                impulse_dt = press(
                    near, joints, motion, inverse, acting, softness, span, impulse_dt, plan.iterations,
                    plan.finer > 0,
                )  # fmt: skip
                now = charge(cost, RESOLVE, now)
            elif what == RELAX:
                if part + 1 < len(course.parts) and OVERLAP <= course.parts[part + 1] <= MOVED:
                    for i in range(len(angle)):
                        packed.state[2, 2 * i], packed.state[2, 2 * i + 1] = position[i, 0], position[i, 1]
                half = 0.5 * impulse_dt
                relax(
                    near, joints, motion, shapes, inverse, acting, softness, span, half, plan.iterations,
                    plan.finer > 0,
                )  # fmt: skip
                weighed = False
                now = charge(cost, RESOLVE, now)
            elif what == HOOK or _moved(motion, packed.state[2]):
                why = PYTHON if what != OVERLAP else ALL
                if what == OVERLAP:
                    book_stored(packed, motion, acting, inverse, account)
                    now = charge(cost, RESOLVE, now)
            if why == PAIRS_STALE and list_leavers(
                near, motion, shapes, gravity.inverse_mass, fat, bounds.walls, h, gravity.margin
            ):
                why = ALL
                now = charge(cost, BROAD_PHASE, now)
            if why != ALL:
                return why, done, substep, part, finished, bounced, evaluations, impulse_dt
            part += 1
        substep, part = substep + 1, 0
        if substep == plan.substeps:
            substep = 0
            if course.hooked:
                return ALL, 1, substep, part, bounced, bounced, evaluations, impulse_dt
            failed = find_beyond(position, angle, FARTHEST) >= 0 or find_beyond(linear, angular, LARGEST) >= 0
            now = charge(cost, ACCELERATE, now)
            if failed:
                return DIVERGED, done, substep, part, finished, bounced, evaluated, impulse_dt
            done, finished, pending = done + 1, bounced, ALL
            began = next_time(began, plan.dt)
            if sleepers.on:
                check = count_rest(
                    linear, angular, shapes.reach, gravity.inverse_mass, sub_integrated, sleepers.asleep,
                    sleepers.rest, sleepers.slowest, plan.rested,
                )  # fmt: skip
                now = charge(cost, SLEEP, now)
                pending = SLEEP_PENDING if check else ALL
            if pending == ALL and counts[OUTSIDE] != 0:
                pending = WALL_PENDING
            if pending == ALL and plan.finer > 0:
                needed = factor_for(
                    near, joints, motion, shapes, inverse, acting.force, plan, softness, impulse_dt
                )
                now = charge(cost, RESOLVE, now)
                pending = ALL if needed == plan.finer else OTHER_SUBSTEPS
            if pending == ALL and len(joints.bears) > 0:
                acted = impulse_dt if impulse_dt > 0.0 else h
                pending = OVERLOADED if overloaded(joints, position, angle, joints.impulse, acted) else ALL
            take_sample(motion, sampled, done)  # and again in Python where a step ends there
            if pending != ALL:
                return pending, done, substep, part, finished, bounced, evaluations, impulse_dt
    return ALL, done, substep, part, finished, bounced, evaluations, impulse_dt


@kernel
def advance(
    steps: int, substep: int, part: int, plan: Plain[Plan], course: Plain[Course], cause: int,
    motion: Plain[Motion], kept: Numbers, shapes: ShapesTuple, materials: Plain[Materials],
    inverse: Plain[Inverse], sub_integrated: Flags, acting: ActingTuple, gravity: Plain[Gravity],
    packed: Plain[Packed], springs: Plain[Springs], sleepers: Plain[Sleepers], damping: tuple[float, float],
    fat: Plain[FatBoxes], bounds: Plain[Bounds], near: Plain[Near], joints: Plain[Joints], opened: Rows,
    softness: Plain[Softness], impulse_dt: float, impacts: Impacts, cost: Rows, sampled: Plain[Sampled],
) -> tuple[int, int, int, int, int, int, int, float]:  # fmt: skip
    """Advance by ``steps`` steps, beginning at a part of a substep.

    ``kept`` has the state now, and receives that in which the last step began. ``impacts`` is the log, and
    ``cost`` (COSTS,) gets ticks added for each system, and the number of steps. A change since the
    last step is booked to ``cause``, unless that is negative. Samples that are due after steps are taken.

    Where some parts are Python's, the ends of steps are too: nothing is kept, and energy is not measured.

    Returns why it ended, how many steps are done, the substep and the part that it was in, the impacts in the
    steps that are done and all impacts, how often the forces of springs that move bodies were evaluated, and
    the time [s] over which the points' impulses act.
    """
    of, moved, masses, along = named_near(near), Motion(*motion), Gravity(*gravity), Course(*course)
    if cause >= 0:
        _balance(of.account, moved, masses, cause)
    ended = _advance(
        steps, substep, part, Plan(*plan), along, cause, moved, kept,
        named_shapes(shapes), Materials(*materials), Inverse(*inverse), sub_integrated,
        named_acting(acting), masses, Packed(*packed), Springs(*springs), Sleepers(*sleepers), damping,
        FatBoxes(*fat), Bounds(*bounds), of, Joints(*joints), opened, Softness(*softness), impulse_dt,
        impacts, cost, Sampled(*sampled),
    )  # fmt: skip
    if not along.hooked:
        _balance(of.account, moved, masses, -1)
    return ended
