"""One sweep over scalar contacts: the normal impulses of a pair, then its friction, left and right alike."""

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
from physicslab.kernels.constraint.stirred import SETTLED, Stirred, is_stirred, stir
from physicslab.kernels.records import Manifold, Point
from physicslab.kernels.wide.solve import (
    SoftConstraint,
    free_change,
    held_by_friction,
    one_normal,
    two_frictions,
    two_normals,
    work_of,
)


class Done(NamedTuple):
    """The largest change of an impulse [N s], and the work of normal and of tangential impulses [J]."""

    change: float
    pressed: float
    friction_work: float


@always_inlined
def _free(point: Point, v: float, size: float, soft: SoftConstraint) -> tuple[float, float]:
    """Return what :func:`free_change` does; nothing for a point that meets after this substep."""
    if point.ahead != 0:
        return 0.0, 0.0
    v = v - point.bend
    return free_change(point.normal_impulse, point.normal_mass, v, point.separation, size, soft)


@always_inlined
def _one_point(
    manifold: Manifold,
    point: Point,
    v: PairVelocity[float],
    mass: PairInverseMass[float],
    soft: SoftConstraint,
    booked: bool,
) -> tuple[PairVelocity[float], Done]:
    """Find the impulses of a pair of one point; return the velocities after them, and what was done.

    Work of friction is computed only where it is ``booked``.

    How the normal impulse changes the speed of sliding is added to it: a shorter chain of operations, each of
    which waits for the one before, than by the velocities after it.
    """
    at = frame_of(manifold, point)
    turn_a, turn_b, roll_a, roll_b = moment_arms(at)
    along, across = along_and_across(at.nx, at.ny, v.bx - v.ax, v.by - v.ay)
    approach = along + (v.wb * turn_b - v.wa * turn_a)
    change, _ = _free(point, approach, manifold.size, soft)
    before = point.normal_impulse
    normal, tangent, moment_a, moment_b = one_normal(before, change), 0.0, 0.0, 0.0
    point.normal_impulse = before + normal
    ma, ia, ib, friction_work = mass.a + mass.b, mass.inertia_a, mass.inertia_b, 0.0
    pressed = work_of(normal * approach, normal, normal * turn_a, normal * turn_b, ma, ia, ib)
    if manifold.friction > 0.0:
        coupling = response(0.0, ia, ib, turn_a, turn_b, roll_a, roll_b)
        slide = across + (v.wb * roll_b - v.wa * roll_a) + normal * coupling
        held, limit = point.tangent_impulse, manifold.friction * point.normal_impulse
        tangent = held_by_friction(held, point.tangent_mass, slide, limit) - held
        point.tangent_impulse = held + tangent
        moment_a, moment_b = tangent * roll_a, tangent * roll_b
        if booked:
            friction_work = work_of(tangent * slide, tangent, moment_a, moment_b, ma, ia, ib)
    px, py = impulse_at(at.nx, at.ny, normal, tangent)
    moment_a, moment_b = normal * turn_a + moment_a, normal * turn_b + moment_b
    done = Done(max(abs(normal), abs(tangent)), pressed, friction_work)
    return after_impulse(v, mass, px, py, moment_a, moment_b), done


@always_inlined
def _normals(
    manifold: Manifold,
    one: Point,
    two: Point,
    v: PairVelocity[float],
    mass: PairInverseMass[float],
    soft: SoftConstraint,
) -> tuple[PairVelocity[float], Done]:
    """Find the normal impulses of two points; return the velocities after them, and what was done."""
    nx, ny, size, both = manifold.normal_x, manifold.normal_y, manifold.size, mass.a + mass.b
    along, _ = along_and_across(nx, ny, v.bx - v.ax, v.by - v.ay)
    turn_1a, turn_1b, _, _ = moment_arms(frame_of(manifold, one))
    turn_2a, turn_2b, _, _ = moment_arms(frame_of(manifold, two))
    x1, x2 = one.normal_impulse, two.normal_impulse
    v1, v2 = along + v.wb * turn_1b - v.wa * turn_1a, along + v.wb * turn_2b - v.wa * turn_2a
    change1, mass1 = _free(one, v1, size, soft)
    change2, mass2 = _free(two, v2, size, soft)
    between = response(both, mass.inertia_a, mass.inertia_b, turn_1a, turn_1b, turn_2a, turn_2b)
    d1, d2 = two_normals(x1, x2, change1, change2, mass1, mass2, between)
    one.normal_impulse, two.normal_impulse = x1 + d1, x2 + d2
    turn_a, turn_b = d1 * turn_1a + d2 * turn_2a, d1 * turn_1b + d2 * turn_2b
    px, py = (d1 + d2) * nx, (d1 + d2) * ny
    work = work_of(d1 * v1 + d2 * v2, d1 + d2, turn_a, turn_b, both, mass.inertia_a, mass.inertia_b)
    return after_impulse(v, mass, px, py, turn_a, turn_b), Done(max(abs(d1), abs(d2)), work, 0.0)


@always_inlined
def _friction(
    manifold: Manifold, one: Point, two: Point, v: PairVelocity[float], mass: PairInverseMass[float]
) -> tuple[PairVelocity[float], Done]:
    """Find the tangential impulses of two points, each at most mu times the normal one.

    Returns the velocities after them, and what was done.
    """
    nx, ny, mu, both = manifold.normal_x, manifold.normal_y, manifold.friction, mass.a + mass.b
    _, across = along_and_across(nx, ny, v.bx - v.ax, v.by - v.ay)
    _, _, turn_1a, turn_1b = moment_arms(frame_of(manifold, one))
    _, _, turn_2a, turn_2b = moment_arms(frame_of(manifold, two))
    v1 = across + v.wb * turn_1b - v.wa * turn_1a
    v2 = across + v.wb * turn_2b - v.wa * turn_2a
    between = response(both, mass.inertia_a, mass.inertia_b, turn_1a, turn_1b, turn_2a, turn_2b)
    x1, x2 = one.tangent_impulse, two.tangent_impulse
    limit1, limit2 = mu * one.normal_impulse, mu * two.normal_impulse
    d1, d2 = two_frictions(x1, x2, v1, v2, one.tangent_mass, two.tangent_mass, limit1, limit2, between)
    one.tangent_impulse, two.tangent_impulse = x1 + d1, x2 + d2
    turn_a, turn_b = d1 * turn_1a + d2 * turn_2a, d1 * turn_1b + d2 * turn_2b
    work = work_of(d1 * v1 + d2 * v2, d1 + d2, turn_a, turn_b, both, mass.inertia_a, mass.inertia_b)
    after = after_impulse(v, mass, -(d1 + d2) * ny, (d1 + d2) * nx, turn_a, turn_b)
    return after, Done(max(abs(d1), abs(d2)), 0.0, work)


@always_inlined
def sweep(
    contacts: Contacts, motion: Motion, inverse: Inverse, soft: SoftConstraint, stirred: Stirred, booked: bool
) -> tuple[bool, float, float]:
    """Solve the scalar contacts of stirred bodies once, in every other sweep from the last to the first.

    Friction is limited by the newest normal impulse. Returns whether any impulse has changed by more than
    :data:`SETTLED` of the normal one, which stirs its bodies, and where it is ``booked`` the work of normal
    and of tangential impulses [J].
    """
    linear, angular, unsettled = motion.linear, motion.angular, False
    backward = stirred.sweep % 2 == 1
    pressed, friction_work = 0.0, 0.0
    for number in range(contacts.number):
        p = contacts.touching[contacts.number - 1 - number if backward else number]
        manifold, one, two = contacts.manifolds[p], contacts.points[2 * p], contacts.points[2 * p + 1]
        a, b = manifold.a, manifold.b
        if not (is_stirred(stirred, a) or is_stirred(stirred, b)):
            continue
        mass, v = inverse_mass_of(inverse, a, b), velocity_of(linear, angular, a, b)
        if manifold.count == 1:
            v, done = _one_point(manifold, one, v, mass, soft, booked)
            change = done.change
            if booked:
                pressed, friction_work = pressed + done.pressed, friction_work + done.friction_work
        else:
            v, done = _normals(manifold, one, two, v, mass, soft)
            change = done.change
            if booked:
                pressed += done.pressed
            if manifold.friction > 0.0:
                v, done = _friction(manifold, one, two, v, mass)
                change = max(change, done.change)
                if booked:
                    friction_work += done.friction_work
        put_velocity(linear, angular, a, b, v)
        held = one.normal_impulse + (two.normal_impulse if manifold.count == 2 else 0.0)
        if change > SETTLED * held:
            unsettled = True
            stir(stirred, inverse, a)
            stir(stirred, inverse, b)
    return unsettled, pressed, friction_work
