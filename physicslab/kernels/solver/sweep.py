"""One sweep over scalar contacts: the normal impulses of a pair, then its friction, left and right alike."""

from typing import NamedTuple

from physicslab.kernels import always_inlined, fused
from physicslab.kernels.arguments import Contacts, Inverse, Motion
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

__all__ = ["sweep"]

_SETTLED = 1e-10
"""Share of a normal impulse by which an impulse may still change where sweeps come to their end."""


class Weights(NamedTuple):
    """Inverse masses [1/kg] and moments of inertia [1/(kg m^2)] of A and of B."""

    ma: float
    ia: float
    mb: float
    ib: float


class Velocities(NamedTuple):
    """Velocities [m/s] and angular velocities [rad/s] of A and of B."""

    ax: float
    ay: float
    wa: float
    bx: float
    by: float
    wb: float


class Done(NamedTuple):
    """The largest change of an impulse [N s], and the work of normal and of tangential impulses [J]."""

    change: float
    pressed: float
    rubbed: float


@fused
def _free(point: Point, v: float, size: float, soft: SoftConstraint) -> tuple[float, float]:
    """Return what :func:`free_change` does; nothing for a point that meets after this substep."""
    if point.ahead != 0:
        return 0.0, 0.0
    return free_change(point.normal_impulse, point.normal_mass, v, point.separation, size, soft)


@fused
def _pushed(
    v: Velocities, weights: Weights, px: float, py: float, turn_a: float, turn_b: float
) -> Velocities:
    """Return velocities after an impulse (px, py) [N s] on B, of the moments ``turn_a`` and ``turn_b``."""
    return Velocities(
        v.ax - weights.ma * px, v.ay - weights.ma * py, v.wa - weights.ia * turn_a,
        v.bx + weights.mb * px, v.by + weights.mb * py, v.wb + weights.ib * turn_b,
    )  # fmt: skip


@fused
def _one_point(
    manifold: Manifold, point: Point, v: Velocities, weights: Weights, soft: SoftConstraint, booked: bool
) -> tuple[Velocities, Done]:
    """Find the impulses of a pair of one point; return the velocities after them, and what was done.

    Of friction the work is computed only where it is ``booked``.

    How the normal impulse changes the speed of sliding is added to it: a shorter chain of operations, each of
    which waits for the one before, than by the velocities after it.
    """
    nx, ny = manifold.normal_x, manifold.normal_y
    vx, vy = v.bx - v.ax, v.by - v.ay
    turn_a, turn_b = point.arm_ax * ny - point.arm_ay * nx, point.arm_bx * ny - point.arm_by * nx
    approach = nx * vx + ny * vy + (v.wb * turn_b - v.wa * turn_a)
    change, _ = _free(point, approach, manifold.size, soft)
    before = point.normal_impulse
    normal, tangent, moment_a, moment_b = one_normal(before, change), 0.0, 0.0, 0.0
    point.normal_impulse = before + normal
    ma, ia, ib, rubbed = weights.ma + weights.mb, weights.ia, weights.ib, 0.0
    pressed = work_of(normal * approach, normal, normal * turn_a, normal * turn_b, ma, ia, ib)
    if manifold.friction > 0.0:
        roll_a, roll_b = point.arm_ax * nx + point.arm_ay * ny, point.arm_bx * nx + point.arm_by * ny
        coupling = weights.ia * turn_a * roll_a + weights.ib * turn_b * roll_b
        slide = nx * vy - ny * vx + (v.wb * roll_b - v.wa * roll_a) + normal * coupling
        held, limit = point.tangent_impulse, manifold.friction * point.normal_impulse
        tangent = held_by_friction(held, point.tangent_mass, slide, limit) - held
        point.tangent_impulse = held + tangent
        moment_a, moment_b = tangent * roll_a, tangent * roll_b
        if booked:
            rubbed = work_of(tangent * slide, tangent, moment_a, moment_b, ma, ia, ib)
    px, py = normal * nx - tangent * ny, normal * ny + tangent * nx
    moment_a, moment_b = normal * turn_a + moment_a, normal * turn_b + moment_b
    done = Done(max(abs(normal), abs(tangent)), pressed, rubbed)
    return _pushed(v, weights, px, py, moment_a, moment_b), done


@fused
def _normals(
    manifold: Manifold, one: Point, two: Point, v: Velocities, weights: Weights, soft: SoftConstraint
) -> tuple[Velocities, Done]:
    """Find the normal impulses of two points; return the velocities after them, and what was done."""
    nx, ny, size = manifold.normal_x, manifold.normal_y, manifold.size
    along = nx * (v.bx - v.ax) + ny * (v.by - v.ay)
    turn_1a, turn_1b = one.arm_ax * ny - one.arm_ay * nx, one.arm_bx * ny - one.arm_by * nx
    turn_2a, turn_2b = two.arm_ax * ny - two.arm_ay * nx, two.arm_bx * ny - two.arm_by * nx
    x1, x2 = one.normal_impulse, two.normal_impulse
    v1, v2 = along + v.wb * turn_1b - v.wa * turn_1a, along + v.wb * turn_2b - v.wa * turn_2a
    change1, mass1 = _free(one, v1, size, soft)
    change2, mass2 = _free(two, v2, size, soft)
    between = weights.ma + weights.mb + weights.ia * turn_1a * turn_2a + weights.ib * turn_1b * turn_2b
    d1, d2 = two_normals(x1, x2, change1, change2, mass1, mass2, between)
    one.normal_impulse, two.normal_impulse = x1 + d1, x2 + d2
    turn_a, turn_b = d1 * turn_1a + d2 * turn_2a, d1 * turn_1b + d2 * turn_2b
    px, py = (d1 + d2) * nx, (d1 + d2) * ny
    work = work_of(
        d1 * v1 + d2 * v2, d1 + d2, turn_a, turn_b, weights.ma + weights.mb, weights.ia, weights.ib
    )
    return _pushed(v, weights, px, py, turn_a, turn_b), Done(max(abs(d1), abs(d2)), work, 0.0)


@fused
def _friction(
    manifold: Manifold, one: Point, two: Point, v: Velocities, weights: Weights
) -> tuple[Velocities, Done]:
    """Find the tangential impulses of two points, each at most mu times the normal one.

    Returns the velocities after them, and what was done.
    """
    nx, ny, mu = manifold.normal_x, manifold.normal_y, manifold.friction
    across = nx * (v.by - v.ay) - ny * (v.bx - v.ax)
    turn_1a, turn_1b = one.arm_ax * nx + one.arm_ay * ny, one.arm_bx * nx + one.arm_by * ny
    turn_2a, turn_2b = two.arm_ax * nx + two.arm_ay * ny, two.arm_bx * nx + two.arm_by * ny
    v1 = across + v.wb * turn_1b - v.wa * turn_1a
    v2 = across + v.wb * turn_2b - v.wa * turn_2a
    between = weights.ma + weights.mb + weights.ia * turn_1a * turn_2a + weights.ib * turn_1b * turn_2b
    x1, x2 = one.tangent_impulse, two.tangent_impulse
    limit1, limit2 = mu * one.normal_impulse, mu * two.normal_impulse
    d1, d2 = two_frictions(x1, x2, v1, v2, one.tangent_mass, two.tangent_mass, limit1, limit2, between)
    one.tangent_impulse, two.tangent_impulse = x1 + d1, x2 + d2
    turn_a, turn_b = d1 * turn_1a + d2 * turn_2a, d1 * turn_1b + d2 * turn_2b
    work = work_of(
        d1 * v1 + d2 * v2, d1 + d2, turn_a, turn_b, weights.ma + weights.mb, weights.ia, weights.ib
    )
    after = _pushed(v, weights, -(d1 + d2) * ny, (d1 + d2) * nx, turn_a, turn_b)
    return after, Done(max(abs(d1), abs(d2)), 0.0, work)


@always_inlined
def sweep(
    contacts: Contacts, motion: Motion, inverse: Inverse, soft: SoftConstraint, backward: bool, booked: bool
) -> tuple[bool, float, float]:
    """Solve all scalar contacts once, ``backward`` from the last to the first.

    Friction is limited by the newest normal impulse. Returns whether any impulse has changed by more than
    :data:`_SETTLED`, and where it is ``booked`` the work of normal and of tangential impulses [J].
    """
    linear, angular, unsettled = motion.linear, motion.angular, False
    pressed, rubbed = 0.0, 0.0
    for number in range(contacts.number):
        p = contacts.touching[contacts.number - 1 - number if backward else number]
        manifold, one, two = contacts.manifolds[p], contacts.points[2 * p], contacts.points[2 * p + 1]
        a, b = manifold.a, manifold.b
        weights = Weights(inverse.mass[a], inverse.inertia[a], inverse.mass[b], inverse.inertia[b])
        v = Velocities(linear[a, 0], linear[a, 1], angular[a], linear[b, 0], linear[b, 1], angular[b])
        if manifold.count == 1:
            v, done = _one_point(manifold, one, v, weights, soft, booked)
            change = done.change
            if booked:
                pressed, rubbed = pressed + done.pressed, rubbed + done.rubbed
        else:
            v, done = _normals(manifold, one, two, v, weights, soft)
            change = done.change
            if booked:
                pressed += done.pressed
            if manifold.friction > 0.0:
                v, done = _friction(manifold, one, two, v, weights)
                change = max(change, done.change)
                if booked:
                    rubbed += done.rubbed
        linear[a, 0], linear[a, 1], angular[a] = v.ax, v.ay, v.wa
        linear[b, 0], linear[b, 1], angular[b] = v.bx, v.by, v.wb
        held = one.normal_impulse + (two.normal_impulse if manifold.count == 2 else 0.0)
        unsettled = unsettled or change > _SETTLED * held
    return unsettled, pressed, rubbed
