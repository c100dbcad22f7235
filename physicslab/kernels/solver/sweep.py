"""One sweep over scalar contacts: the normal impulses of a pair, then its friction, left and right alike."""

from typing import NamedTuple

from physicslab.kernels import fused, inlined
from physicslab.kernels.arguments import Contacts, Inverse, Motion
from physicslab.kernels.records import Manifold, Point
from physicslab.kernels.wide.solve import (
    SoftConstraint,
    free_change,
    held_by_friction,
    one_normal,
    two_frictions,
    two_normals,
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
def _normals(
    manifold: Manifold, one: Point, two: Point, v: Velocities, weights: Weights, soft: SoftConstraint
) -> tuple[Velocities, float]:
    """Find the normal impulses of a pair; return the velocities after them, and the largest change [N s]."""
    nx, ny, size = manifold.normal_x, manifold.normal_y, manifold.size
    along = nx * (v.bx - v.ax) + ny * (v.by - v.ay)
    d2 = turn_2a = turn_2b = 0.0
    turn_1a, turn_1b = one.arm_ax * ny - one.arm_ay * nx, one.arm_bx * ny - one.arm_by * nx
    x1, x2 = one.normal_impulse, two.normal_impulse
    change1, mass1 = _free(one, along + v.wb * turn_1b - v.wa * turn_1a, size, soft)
    if manifold.count == 2:
        turn_2a, turn_2b = two.arm_ax * ny - two.arm_ay * nx, two.arm_bx * ny - two.arm_by * nx
        change2, mass2 = _free(two, along + v.wb * turn_2b - v.wa * turn_2a, size, soft)
        between = weights.ma + weights.mb + weights.ia * turn_1a * turn_2a + weights.ib * turn_1b * turn_2b
        d1, d2 = two_normals(x1, x2, change1, change2, mass1, mass2, between)
        two.normal_impulse = x2 + d2
    else:
        d1 = one_normal(x1, change1)
    one.normal_impulse = x1 + d1
    turn_a, turn_b = d1 * turn_1a + d2 * turn_2a, d1 * turn_1b + d2 * turn_2b
    px, py = (d1 + d2) * nx, (d1 + d2) * ny
    return _pushed(v, weights, px, py, turn_a, turn_b), max(abs(d1), abs(d2))


@fused
def _friction(
    manifold: Manifold, one: Point, two: Point, v: Velocities, weights: Weights
) -> tuple[Velocities, float]:
    """Find the tangential impulses of a pair, each at most mu times the normal one.

    Returns the velocities after them, and the largest change [N s].
    """
    nx, ny, mu = manifold.normal_x, manifold.normal_y, manifold.friction
    across = nx * (v.by - v.ay) - ny * (v.bx - v.ax)
    d2 = turn_2a = turn_2b = 0.0
    turn_1a, turn_1b = one.arm_ax * nx + one.arm_ay * ny, one.arm_bx * nx + one.arm_by * ny
    v1 = across + v.wb * turn_1b - v.wa * turn_1a
    x1, m1, limit1 = one.tangent_impulse, one.tangent_mass, mu * one.normal_impulse
    if manifold.count == 2:
        turn_2a, turn_2b = two.arm_ax * nx + two.arm_ay * ny, two.arm_bx * nx + two.arm_by * ny
        v2 = across + v.wb * turn_2b - v.wa * turn_2a
        between = weights.ma + weights.mb + weights.ia * turn_1a * turn_2a + weights.ib * turn_1b * turn_2b
        x2, m2, limit2 = two.tangent_impulse, two.tangent_mass, mu * two.normal_impulse
        d1, d2 = two_frictions(x1, x2, v1, v2, m1, m2, limit1, limit2, between)
        two.tangent_impulse = x2 + d2
    else:
        d1 = held_by_friction(x1, m1, v1, limit1) - x1
    one.tangent_impulse = x1 + d1
    turn_a, turn_b = d1 * turn_1a + d2 * turn_2a, d1 * turn_1b + d2 * turn_2b
    return _pushed(v, weights, -(d1 + d2) * ny, (d1 + d2) * nx, turn_a, turn_b), max(abs(d1), abs(d2))


@inlined
def sweep(contacts: Contacts, motion: Motion, inverse: Inverse, soft: SoftConstraint, backward: bool) -> bool:
    """Solve all scalar contacts once, ``backward`` from the last to the first.

    Friction is limited by the newest normal impulse. Returns whether any impulse has changed by more than
    :data:`_SETTLED`.
    """
    linear, angular, unsettled = motion.linear, motion.angular, False
    for number in range(contacts.number):
        p = contacts.touching[contacts.number - 1 - number if backward else number]
        manifold, one, two = contacts.manifolds[p], contacts.points[2 * p], contacts.points[2 * p + 1]
        a, b = manifold.a, manifold.b
        weights = Weights(inverse.mass[a], inverse.inertia[a], inverse.mass[b], inverse.inertia[b])
        v = Velocities(linear[a, 0], linear[a, 1], angular[a], linear[b, 0], linear[b, 1], angular[b])
        v, change = _normals(manifold, one, two, v, weights, soft)
        if manifold.friction > 0.0:
            v, slid = _friction(manifold, one, two, v, weights)
            change = max(change, slid)
        linear[a, 0], linear[a, 1], angular[a] = v.ax, v.ay, v.wa
        linear[b, 0], linear[b, 1], angular[b] = v.bx, v.by, v.wb
        held = one.normal_impulse + (two.normal_impulse if manifold.count == 2 else 0.0)
        unsettled = unsettled or change > _SETTLED * held
    return unsettled
