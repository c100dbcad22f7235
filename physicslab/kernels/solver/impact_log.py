"""The log of impacts and the accounts of what they take, whichever way an impact was found.

Both follow from the same numbers: the impulses, and the velocities of both bodies at that moment. An impulse
J works J (v- + v+) / 2, with the velocities at its point before and after all impulses of the moment: the sum
over all points is the change of the kinetic energy, exactly.
"""

from typing import NamedTuple

from physicslab.kernels import Vectors, always_inlined, inlined
from physicslab.kernels.accounts import ENERGY, FRICTION, HAND, IMPACTS, PX, PY, SPIN
from physicslab.kernels.records import Impacts
from physicslab.kernels.solver.blow import Blow
from physicslab.kernels.solver.impact_pose import Meeting

__all__ = [
    "Masses",
    "Pair",
    "Pose",
    "Speeds",
    "Struck",
    "book_impact",
    "book_outside",
    "in_order",
    "shares_of",
    "write_impact",
]


class Pair(NamedTuple):
    """The entities that meet, the wall or -1, and the restitution and friction of the pair."""

    entity_a: int
    entity_b: int
    wall: int
    restitution: float
    friction: float


class Pose(NamedTuple):
    """Where A and B are at the moment of an impact: centres [m] and angles [rad]."""

    ax: float
    ay: float
    angle_a: float
    bx: float
    by: float
    angle_b: float


class Speeds(NamedTuple):
    """Velocities [m/s] and angular velocities [rad/s] of A and of B."""

    ax: float
    ay: float
    wa: float
    bx: float
    by: float
    wb: float


class Masses(NamedTuple):
    """Inverse masses [1/kg] and inverse moments of inertia [1/(kg m^2)] of A and of B."""

    a: float
    turn_a: float
    b: float
    turn_b: float


class Struck(NamedTuple):
    """Where a pair meets, and the impulses there; of one point, those of the second are 0."""

    one: Meeting
    two: Meeting
    blow: Blow


@inlined
def in_order(struck: Struck) -> Struck:
    """Return the points of an impact, that with the larger normal impulse first."""
    blow = struck.blow
    if blow.normal2 <= blow.normal1:
        return struck
    return Struck(struck.two, struck.one, Blow(blow.normal2, blow.tangent2, blow.normal1, blow.tangent1))


@inlined
def _relative(meeting: Meeting, speeds: Speeds) -> tuple[float, float]:
    """Return the velocity of B against A at a point, along the normal and the tangent [m/s]."""
    nx, ny, ax, ay, bx, by = meeting
    vx = speeds.bx - speeds.wb * by - speeds.ax + speeds.wa * ay
    vy = speeds.by + speeds.wb * bx - speeds.ay - speeds.wa * ax
    return vx * nx + vy * ny, vy * nx - vx * ny


@inlined
def shares_of(along: float, across: float) -> tuple[float, float]:
    """Return what restitution and what friction give [J], from the work of normal and tangential impulses.

    A sliding that turns round within the impact can make one of these positive, though their sum is not: the
    mean of its speeds is not the speed at which friction acted. Neither gives energy then.
    """
    both = along + across
    rubbed = min(max(across, min(both, 0.0)), 0.0)
    return both - rubbed, rubbed


@always_inlined
def book_impact(
    account: Vectors, struck: Struck, pose: Pose, before: Speeds, after: Speeds, masses: Masses, row: int
) -> None:
    """Add the work of the impulses of an impact to the accounts, and the momentum that comes from outside.

    All of it goes to the cause ``row`` where that is IMPACTS; friction of what rests has its own. A body
    without an inverse mass is outside: fixed, or moved by a hand or of itself. What moves so works as well,
    by the impulse times its velocity.
    """
    one, two, blow = struck
    mean = Speeds(
        0.5 * (before.ax + after.ax), 0.5 * (before.ay + after.ay), 0.5 * (before.wa + after.wa),
        0.5 * (before.bx + after.bx), 0.5 * (before.by + after.by), 0.5 * (before.wb + after.wb),
    )  # fmt: skip
    v1, s1 = _relative(one, mean)
    v2, s2 = _relative(two, mean)
    bounced, rubbed = blow.normal1 * v1 + blow.normal2 * v2, blow.tangent1 * s1 + blow.tangent2 * s2
    if row != IMPACTS:
        bounced, rubbed = shares_of(bounced, rubbed)
        account[FRICTION, ENERGY] += rubbed
        rubbed = 0.0
    account[row, ENERGY] += bounced + rubbed
    if masses.a > 0.0 and masses.b > 0.0 and masses.turn_a > 0.0 and masses.turn_b > 0.0:
        return
    x1, y1 = blow.normal1 * one.nx - blow.tangent1 * one.ny, blow.normal1 * one.ny + blow.tangent1 * one.nx
    x2, y2 = blow.normal2 * two.nx - blow.tangent2 * two.ny, blow.normal2 * two.ny + blow.tangent2 * two.nx
    px, py = x1 + x2, y1 + y2
    turn_a = one.arm_ax * y1 - one.arm_ay * x1 + two.arm_ax * y2 - two.arm_ay * x2
    turn_b = one.arm_bx * y1 - one.arm_by * x1 + two.arm_bx * y2 - two.arm_by * x2
    book_outside(account, row, masses, pose, mean, px, py, turn_a, turn_b)


@inlined
def book_outside(
    account: Vectors, row: int, masses: Masses, pose: Pose, mean: Speeds, px: float, py: float, turn_a: float,
    turn_b: float,
) -> None:  # fmt: skip
    """Book what comes from outside by the impulse (px, py) [N s] on B and its opposite on A.

    ``turn_a`` and ``turn_b`` are its moments about both centres [N m s]. What drives a body takes the cause
    HAND, and does the impulse times its ``mean`` velocity.
    """
    # What cannot turn takes a torque from outside.
    if masses.a > 0.0 and masses.b > 0.0:
        account[row, SPIN] += (turn_a if masses.turn_a == 0.0 else 0.0) - (
            turn_b if masses.turn_b == 0.0 else 0.0
        )
        return
    if masses.b > 0.0:
        driven = mean.ax != 0.0 or mean.ay != 0.0 or mean.wa != 0.0
        power = px * mean.ax + py * mean.ay + turn_a * mean.wa
        turned = pose.bx * py - pose.by * px + (turn_b if masses.turn_b > 0.0 else 0.0)
    else:
        driven = mean.bx != 0.0 or mean.by != 0.0 or mean.wb != 0.0
        px, py = -px, -py
        power = px * mean.bx + py * mean.by - turn_b * mean.wb
        turned = pose.ax * py - pose.ay * px - (turn_a if masses.turn_a > 0.0 else 0.0)
    cause = HAND if driven else row
    account[HAND, ENERGY] += power
    account[cause, PX] += px
    account[cause, PY] += py
    account[cause, SPIN] += turned


@inlined
def write_impact(
    log: Impacts, k: int, pair: Pair, time: float, approach: float, struck: Struck, pose: Pose,
    before: Speeds, after: Speeds, masses: Masses, law: int, alone: bool,
) -> None:  # fmt: skip
    """Write an impact, its points :func:`in_order`, into the log as number ``k``."""
    record, (one, two, blow) = log[k % len(log)], struck
    record.time, record.entity_a, record.entity_b, record.wall = time, pair.entity_a, pair.entity_b, pair.wall
    record.restitution, record.friction = pair.restitution, pair.friction
    record.law, record.alone, record.points = law, 1 if alone else 0, 2 if blow.normal2 > 0.0 else 1
    record.normal_x, record.normal_y, record.approach_speed = one.nx, one.ny, approach
    record.x, record.y = pose.bx + one.arm_bx, pose.by + one.arm_by
    record.x_2 = record.y_2 = record.normal_impulse_2 = record.tangent_impulse_2 = 0.0
    if blow.normal2 > 0.0:
        record.x_2, record.y_2 = pose.bx + two.arm_bx, pose.by + two.arm_by
        record.normal_impulse_2, record.tangent_impulse_2 = blow.normal2, blow.tangent2
    record.normal_impulse, record.tangent_impulse = blow.normal1 + blow.normal2, blow.tangent1 + blow.tangent2
    # Of a pair that meets late, as when a third body has struck one of them, the surfaces overlap: A is put
    # where both arms lead to one point, so that the record is the impact that was resolved.
    record.center_ax, record.center_ay = record.x - one.arm_ax, record.y - one.arm_ay
    record.angle_a = pose.angle_a
    record.center_bx, record.center_by, record.angle_b = pose.bx, pose.by, pose.angle_b
    record.before_ax, record.before_ay, record.before_wa = before.ax, before.ay, before.wa
    record.before_bx, record.before_by, record.before_wb = before.bx, before.by, before.wb
    record.after_ax, record.after_ay, record.after_wa = after.ax, after.ay, after.wa
    record.after_bx, record.after_by, record.after_wb = after.bx, after.by, after.wb
    record.inverse_mass_a, record.inverse_inertia_a = masses.a, masses.turn_a
    record.inverse_mass_b, record.inverse_inertia_b = masses.b, masses.turn_b
