"""The log of impacts and the accounts of what they take, whichever way an impact was found.

Both follow from the same numbers: the impulses, and the velocities of both bodies at that moment. An impulse
J works J (v- + v+) / 2, with the velocities at its point before and after all impulses of the moment: the sum
over all points is the change of the kinetic energy, exactly.
"""

from typing import NamedTuple

from physicslab.kernels import Vectors, always_inlined, inlined
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, ENERGY, FRICTION, HAND, IMPACTS, book
from physicslab.kernels.constraint.impact_law import ImpactImpulses
from physicslab.kernels.constraint.pair import (
    ContactFrame,
    PairInverseMass,
    PairVelocity,
    impulse_at,
    mean_velocity,
    moments_of,
    point_state,
)
from physicslab.kernels.records import Impacts, Manifold


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


class ImpactPoints(NamedTuple):
    """Where a pair meets, and the impulses there; of one point, those of the second are 0."""

    one: ContactFrame[float]
    two: ContactFrame[float]
    impulses: ImpactImpulses


@inlined
def pair_of(manifold: Manifold) -> Pair:
    """Return what an impact of a pair is recorded with."""
    return Pair(manifold.entity_a, manifold.entity_b, manifold.wall, manifold.restitution, manifold.friction)


@inlined
def _in_order(points: ImpactPoints) -> ImpactPoints:
    """Return the points of an impact, that with the larger normal impulse first."""
    normal1, tangent1, normal2, tangent2 = points.impulses
    if normal2 <= normal1:
        return points
    return ImpactPoints(points.two, points.one, ImpactImpulses(normal2, tangent2, normal1, tangent1))


@inlined
def shares_of(along: float, across: float) -> tuple[float, float]:
    """Return what restitution and what friction give [J], from the work of normal and tangential impulses.

    A sliding that turns round within the impact can make one of these positive, though their sum is not: the
    mean of its speeds is not the speed at which friction acted. Neither gives energy then.
    """
    both = along + across
    friction_work = min(max(across, min(both, 0.0)), 0.0)
    return both - friction_work, friction_work


@always_inlined
def book_impact(
    account: Vectors, points: ImpactPoints, pose: Pose, before: PairVelocity[float],
    after: PairVelocity[float], mass: PairInverseMass[float], row: int,
) -> None:  # fmt: skip
    """Add the work of the impulses of an impact to the accounts, and the momentum that comes from outside.

    All of it goes to the cause ``row`` where that is IMPACTS; friction of what rests has its own. A body
    without an inverse mass is outside: fixed, or moved by a hand or of itself. A body that moves so works as
    well, by the impulse times its velocity.
    """
    one, two, (normal1, tangent1, normal2, tangent2) = points
    mean = mean_velocity(before, after)
    at1, at2 = point_state(one, mean), point_state(two, mean)
    bounced = normal1 * at1.v + normal2 * at2.v
    friction_work = tangent1 * at1.sliding + tangent2 * at2.sliding
    if row != IMPACTS:
        bounced, friction_work = shares_of(bounced, friction_work)
        account[FRICTION, ENERGY] += friction_work
        friction_work = 0.0
    account[row, ENERGY] += bounced + friction_work
    if mass.a > 0.0 and mass.b > 0.0 and mass.inertia_a > 0.0 and mass.inertia_b > 0.0:
        return
    x1, y1 = impulse_at(one.nx, one.ny, normal1, tangent1)
    x2, y2 = impulse_at(two.nx, two.ny, normal2, tangent2)
    moment_1a, moment_1b = moments_of(one, x1, y1)
    moment_2a, moment_2b = moments_of(two, x2, y2)
    book_outside(
        account, row, mass, pose, mean, x1 + x2, y1 + y2, moment_1a + moment_2a, moment_1b + moment_2b
    )


@inlined
def book_outside(
    account: Vectors, row: int, mass: PairInverseMass[float], pose: Pose, mean: PairVelocity[float],
    px: float, py: float, moment_a: float, moment_b: float,
) -> None:  # fmt: skip
    """Book what comes from outside by the impulse (px, py) [N s] on B and its opposite on A.

    ``moment_a`` and ``moment_b`` are its moments about both centres [N m s]. A body that is driven takes the
    cause HAND, and does the impulse times its ``mean`` velocity.
    """
    # A body that cannot turn takes a torque from outside.
    if mass.a > 0.0 and mass.b > 0.0:
        account[row, ANGULAR_MOMENTUM] += moment_a if mass.inertia_a == 0.0 else 0.0
        account[row, ANGULAR_MOMENTUM] -= moment_b if mass.inertia_b == 0.0 else 0.0
        return
    if mass.b > 0.0:
        driven = mean.ax != 0.0 or mean.ay != 0.0 or mean.wa != 0.0
        power = px * mean.ax + py * mean.ay + moment_a * mean.wa
        turned = pose.bx * py - pose.by * px + (moment_b if mass.inertia_b > 0.0 else 0.0)
    else:
        driven = mean.bx != 0.0 or mean.by != 0.0 or mean.wb != 0.0
        px, py = -px, -py
        power = px * mean.bx + py * mean.by - moment_b * mean.wb
        turned = pose.ax * py - pose.ay * px - (moment_a if mass.inertia_a > 0.0 else 0.0)
    cause = HAND if driven else row
    account[HAND, ENERGY] += power
    book(account[cause], 0, 0.0, px, py, turned)


@inlined
def write_impact(
    log: Impacts, k: int, pair: Pair, time: float, approach: float, points: ImpactPoints, pose: Pose,
    before: PairVelocity[float], after: PairVelocity[float], mass: PairInverseMass[float], law: int,
    alone: bool,
) -> None:  # fmt: skip
    """Write an impact into the log as number ``k``, the point with the larger normal impulse first."""
    record, (one, two, (normal1, tangent1, normal2, tangent2)) = log[k % len(log)], _in_order(points)
    record.time, record.entity_a, record.entity_b, record.wall = time, pair.entity_a, pair.entity_b, pair.wall
    record.restitution, record.friction = pair.restitution, pair.friction
    record.law, record.alone, record.points = law, 1 if alone else 0, 2 if normal2 > 0.0 else 1
    record.normal_x, record.normal_y, record.approach_speed = one.nx, one.ny, approach
    record.x, record.y = pose.bx + one.arm_bx, pose.by + one.arm_by
    record.x_2 = record.y_2 = record.normal_impulse_2 = record.tangent_impulse_2 = 0.0
    if normal2 > 0.0:
        record.x_2, record.y_2 = pose.bx + two.arm_bx, pose.by + two.arm_by
        record.normal_impulse_2, record.tangent_impulse_2 = normal2, tangent2
    record.normal_impulse, record.tangent_impulse = normal1 + normal2, tangent1 + tangent2
    # Surfaces of a pair that meets late, as when a third body has struck one of them, overlap: A is put
    # where both arms lead to one point, so that the record is the impact that was resolved.
    record.center_ax, record.center_ay = record.x - one.arm_ax, record.y - one.arm_ay
    record.angle_a = pose.angle_a
    record.center_bx, record.center_by, record.angle_b = pose.bx, pose.by, pose.angle_b
    record.before_ax, record.before_ay, record.before_wa = before.ax, before.ay, before.wa
    record.before_bx, record.before_by, record.before_wb = before.bx, before.by, before.wb
    record.after_ax, record.after_ay, record.after_wa = after.ax, after.ay, after.wa
    record.after_bx, record.after_by, record.after_wb = after.bx, after.by, after.wb
    record.inverse_mass_a, record.inverse_inertia_a = mass.a, mass.inertia_a
    record.inverse_mass_b, record.inverse_inertia_b = mass.b, mass.inertia_b
