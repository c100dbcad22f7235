"""One sweep over scalar contacts: the normal impulses of a pair, then its friction, left and right alike."""

from typing import NamedTuple

from physicslab.kernels import always_inlined
from physicslab.kernels.arguments import Motion
from physicslab.kernels.constraint.pair import (
    PairVelocity,
    after_impulse,
    impulse_at,
    put_velocity,
    velocity_of,
)
from physicslab.kernels.constraint.stirred import SETTLED, Stirred, is_stirred, stir
from physicslab.kernels.float64x8 import greater
from physicslab.kernels.records import Constraint, ConstraintPoint
from physicslab.kernels.solver.constraints import Constraints, mass_of, speeds_at
from physicslab.kernels.types import unsigned
from physicslab.kernels.wide.solve import (
    ContactSpring,
    SoftConstraint,
    free_impulse,
    held_by_friction,
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
def _free(point: ConstraintPoint, v: float, soft: SoftConstraint) -> float:
    """Return what :func:`free_impulse` does."""
    spring = ContactSpring(point.gain, point.closing, point.push, point.limit, point.given, point.give)
    free: float = free_impulse(point.normal_impulse, v, spring, soft)
    return free


@always_inlined
def _one_point(
    pair: Constraint, point: ConstraintPoint, v: PairVelocity[float], soft: SoftConstraint, booked: bool
) -> tuple[PairVelocity[float], Done]:
    """Find the impulses of a pair of one point; return the velocities after them, and what was done."""
    approach, slide = speeds_at(pair, point, v)
    pressing = greater(_free(point, approach, soft), 0.0)
    normal, tangent = pressing - point.normal_impulse, 0.0
    point.normal_impulse = pressing
    if pair.friction > 0.0:
        slide = slide + normal * point.turning
        held = held_by_friction(point.tangent_impulse - point.tangent_mass * slide, pair.friction * pressing)
        tangent = held - point.tangent_impulse
        point.tangent_impulse = held
    px, py = impulse_at(pair.normal_x, pair.normal_y, normal, tangent)
    push_a, push_b = normal * point.normal_arm_a, normal * point.normal_arm_b
    rub_a, rub_b = tangent * point.tangent_arm_a, tangent * point.tangent_arm_b
    pressed, friction_work = 0.0, 0.0
    if booked:
        both, ia, ib = pair.mass_a + pair.mass_b, pair.inertia_a, pair.inertia_b
        pressed = work_of(normal * approach, normal, push_a, push_b, both, ia, ib)
        friction_work = work_of(tangent * slide, tangent, rub_a, rub_b, both, ia, ib)
    done = Done(max(abs(normal), abs(tangent)), pressed, friction_work)
    return after_impulse(v, mass_of(pair), px, py, push_a + rub_a, push_b + rub_b), done


@always_inlined
def _two_points(
    pair: Constraint, one: ConstraintPoint, two: ConstraintPoint, v: PairVelocity[float],
    soft: SoftConstraint, booked: bool,
) -> tuple[PairVelocity[float], Done]:  # fmt: skip
    """Find the impulses of a pair of two points; return the velocities after them, and what was done.

    How the normal impulses change the speeds of sliding is added to these: a shorter chain of operations,
    each of which waits for the one before, than by the velocities after them.
    """
    (v1, slide1), (v2, slide2) = speeds_at(pair, one, v), speeds_at(pair, two, v)
    x1, x2 = one.normal_impulse, two.normal_impulse
    push1, push2 = two_normals(x1, x2, _free(one, v1, soft), _free(two, v2, soft), one.between, two.between)
    one.normal_impulse, two.normal_impulse = x1 + push1, x2 + push2
    rub1, rub2 = 0.0, 0.0
    if pair.friction > 0.0:
        slide1 = slide1 + (push1 * one.turning + push2 * one.turned_by_other)
        slide2 = slide2 + (push2 * two.turning + push1 * two.turned_by_other)
        y1, y2 = one.tangent_impulse, two.tangent_impulse
        rub1, rub2 = two_frictions(
            y1, y2, y1 - one.tangent_mass * slide1, y2 - two.tangent_mass * slide2,
            pair.friction * (x1 + push1), pair.friction * (x2 + push2), one.across, two.across,
        )  # fmt: skip
        one.tangent_impulse, two.tangent_impulse = y1 + rub1, y2 + rub2
    push_a = push1 * one.normal_arm_a + push2 * two.normal_arm_a
    push_b = push1 * one.normal_arm_b + push2 * two.normal_arm_b
    rub_a = rub1 * one.tangent_arm_a + rub2 * two.tangent_arm_a
    rub_b = rub1 * one.tangent_arm_b + rub2 * two.tangent_arm_b
    push, rub, pressed, friction_work = push1 + push2, rub1 + rub2, 0.0, 0.0
    if booked:
        both, ia, ib = pair.mass_a + pair.mass_b, pair.inertia_a, pair.inertia_b
        pressed = work_of(push1 * v1 + push2 * v2, push, push_a, push_b, both, ia, ib)
        friction_work = work_of(rub1 * slide1 + rub2 * slide2, rub, rub_a, rub_b, both, ia, ib)
    px, py = impulse_at(pair.normal_x, pair.normal_y, push, rub)
    change = max(max(abs(push1), abs(push2)), max(abs(rub1), abs(rub2)))
    after = after_impulse(v, mass_of(pair), px, py, push_a + rub_a, push_b + rub_b)
    return after, Done(change, pressed, friction_work)


@always_inlined
def sweep(
    constraints: Constraints, motion: Motion, soft: SoftConstraint, stirred: Stirred, booked: bool
) -> tuple[bool, float, float]:
    """Solve the scalar contacts of stirred bodies once, in every other sweep from the last to the first.

    Friction is limited by the newest normal impulse. Returns whether any impulse has changed by more than
    :data:`SETTLED` of the normal one, which stirs its bodies, and where it is ``booked`` the work of normal
    and of tangential impulses [J].
    """
    linear, angular, unsettled = motion.linear, motion.angular, False
    backward = stirred.sweep % 2 == 1
    pressed, friction_work = 0.0, 0.0
    for number in range(constraints.number):
        k = unsigned(constraints.number - 1 - number if backward else number)
        pair = constraints.pairs[k]
        a, b = pair.a, pair.b
        if not (is_stirred(stirred, a) or is_stirred(stirred, b)):
            continue
        one, v = constraints.points[k + k], velocity_of(linear, angular, a, b)
        held = 0.0
        if pair.count == 1:
            v, done = _one_point(pair, one, v, soft, booked)
        else:
            two = constraints.points[k + k + unsigned(1)]
            v, done = _two_points(pair, one, two, v, soft, booked)
            held = two.normal_impulse
        put_velocity(linear, angular, a, b, v)
        if booked:
            pressed, friction_work = pressed + done.pressed, friction_work + done.friction_work
        if done.change > SETTLED * (held + one.normal_impulse):
            unsettled = True
            stir(stirred, a, pair.mass_a, pair.inertia_a)
            stir(stirred, b, pair.mass_b, pair.inertia_b)
    return unsettled, pressed, friction_work
