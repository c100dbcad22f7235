"""Contacts as sweeps solve them: what all sweeps of a substep have in common, computed once.

A sweep then reads what it needs in the order of its contacts, and each of its operations waits for as few
others as can be: how an impulse at one point changes the velocity at the other is a factor, known before.
"""

from typing import NamedTuple

from physicslab.kernels import always_inlined
from physicslab.kernels.arguments import Contacts, Inverse, Motion
from physicslab.kernels.constraint.pair import (
    PairInverseMass,
    PairVelocity,
    after_impulse,
    along_and_across,
    frame_of,
    impulse_at,
    inverse_mass_of,
    moment_arms,
    put_velocity,
    response,
    velocity_of,
)
from physicslab.kernels.records import Constraint, ConstraintPoint, ConstraintPoints, ConstraintRecords
from physicslab.kernels.wide.solve import SoftConstraint, spring_of


class Constraints(NamedTuple):
    """Records of contacts, those of their points, 2 k and 2 k + 1, and how many contacts there are."""

    pairs: ConstraintRecords
    points: ConstraintPoints
    number: int


@always_inlined
def mass_of(pair: Constraint) -> PairInverseMass[float]:
    """Return the inverse masses and moments of inertia of a pair."""
    return PairInverseMass(pair.mass_a, pair.inertia_a, pair.mass_b, pair.inertia_b)


@always_inlined
def speeds_at(pair: Constraint, point: ConstraintPoint, v: PairVelocity[float]) -> tuple[float, float]:
    """Return how fast B's point moves against A's along the normal, and across it [m/s]."""
    along, across = along_and_across(pair.normal_x, pair.normal_y, v.bx - v.ax, v.by - v.ay)
    along = along + (v.wb * point.normal_arm_b - v.wa * point.normal_arm_a)
    return along, across + (v.wb * point.tangent_arm_b - v.wa * point.tangent_arm_a)


@always_inlined
def moments_about(point: ConstraintPoint, normal: float, tangent: float) -> tuple[float, float]:
    """Return the moments of a normal and a tangential impulse about both centres [N m s]."""
    moment_a = normal * point.normal_arm_a + tangent * point.tangent_arm_a
    return moment_a, normal * point.normal_arm_b + tangent * point.tangent_arm_b


@always_inlined
def constrain(contacts: Contacts, constraints: Constraints, inverse: Inverse, scale: float) -> None:
    """Compute what is the same in a substep; it starts from the last impulses, ``scale`` times as large."""
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold, pair = contacts.manifolds[p], constraints.pairs[k]
        mass = inverse_mass_of(inverse, manifold.a, manifold.b)
        both, ia, ib = mass.a + mass.b, mass.inertia_a, mass.inertia_b
        pair.a, pair.b, pair.count, pair.friction = manifold.a, manifold.b, manifold.count, manifold.friction
        pair.normal_x, pair.normal_y = manifold.normal_x, manifold.normal_y
        pair.mass_a, pair.inertia_a, pair.mass_b, pair.inertia_b = mass
        pair.between = 0.0  # of one point
        for j in range(manifold.count):
            found, point = contacts.points[2 * p + j], constraints.points[2 * k + j]
            arms = moment_arms(frame_of(manifold, found))
            point.normal_arm_a, point.normal_arm_b, point.tangent_arm_a, point.tangent_arm_b = arms
            point.tangent_mass, met = found.tangent_mass, 0.0 if found.ahead != 0 else scale
            tangent_scale = met if manifold.friction > 0.0 else 0.0  # an edit may have taken it away
            point.normal_impulse = met * found.normal_impulse
            point.tangent_impulse = tangent_scale * found.tangent_impulse
            point.turning = response(
                0.0, ia, ib, arms.normal_a, arms.normal_b, arms.tangent_a, arms.tangent_b
            )
        if manifold.count == 2:
            one, two = constraints.points[2 * k], constraints.points[2 * k + 1]
            n1a, n1b, t1a, t1b = one.normal_arm_a, one.normal_arm_b, one.tangent_arm_a, one.tangent_arm_b
            n2a, n2b, t2a, t2b = two.normal_arm_a, two.normal_arm_b, two.tangent_arm_a, two.tangent_arm_b
            pair.between = response(both, ia, ib, n1a, n1b, n2a, n2b)
            across = response(both, ia, ib, t1a, t1b, t2a, t2b)
            one.across, two.across = across * one.tangent_mass, across * two.tangent_mass
            one.turned_by_other = response(0.0, ia, ib, n2a, n2b, t1a, t1b)
            two.turned_by_other = response(0.0, ia, ib, n1a, n1b, t2a, t2b)


@always_inlined
def stretch(contacts: Contacts, constraints: Constraints, soft: SoftConstraint) -> None:
    """Compute how the normal impulses answer to velocities, for the separations of now."""
    for k in range(contacts.number):
        p = contacts.touching[k]
        size, pair = contacts.manifolds[p].size, constraints.pairs[k]
        for j in range(pair.count):
            found, point = contacts.points[2 * p + j], constraints.points[2 * k + j]
            mass = 0.0 if found.ahead != 0 else found.normal_mass  # what meets later is an impact
            spring = spring_of(mass, found.separation, size, soft)
            point.gain, point.push, point.limit, point.given, point.give = (
                spring.gain, spring.push, spring.limit, spring.given, spring.give,
            )  # fmt: skip
            point.closing = spring.closing + spring.gain * found.bend
            point.between = pair.between * spring.gain


@always_inlined
def warm_start(constraints: Constraints, motion: Motion) -> None:
    """Apply the impulses with which a substep starts."""
    for k in range(constraints.number):
        pair = constraints.pairs[k]
        v = velocity_of(motion.linear, motion.angular, pair.a, pair.b)
        for j in range(2 * k, 2 * k + pair.count):
            point = constraints.points[j]
            normal, tangent = point.normal_impulse, point.tangent_impulse
            px, py = impulse_at(pair.normal_x, pair.normal_y, normal, tangent)
            moment_a, moment_b = moments_about(point, normal, tangent)
            v = after_impulse(v, mass_of(pair), px, py, moment_a, moment_b)
        put_velocity(motion.linear, motion.angular, pair.a, pair.b, v)


@always_inlined
def keep_impulses(contacts: Contacts, constraints: Constraints) -> None:
    """Put the impulses where the next substep finds them."""
    for k in range(contacts.number):
        p = contacts.touching[k]
        for j in range(constraints.pairs[k].count):
            found, point = contacts.points[2 * p + j], constraints.points[2 * k + j]
            found.normal_impulse, found.tangent_impulse = point.normal_impulse, point.tangent_impulse
