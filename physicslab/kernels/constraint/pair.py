"""The algebra of a pair: how B's point moves against A's, and what an impulse there changes.

The normal n leads from A to B, the tangent t is n turned counter-clockwise; impulses act on B, and on A with
the other sign. One formula serves a pair (float), eight pairs at once (:class:`Wide`) and arrays of pairs.
"""

from typing import NamedTuple

from physicslab.kernels import Numbers, Vectors, always_inlined
from physicslab.kernels.arguments import Inverse
from physicslab.kernels.float64x8 import Wide
from physicslab.kernels.records import Manifold, Point


class PairVelocity[N: (float, Wide)](NamedTuple):
    """Velocities [m/s] and angular velocities [rad/s] of A and of B."""

    ax: N
    ay: N
    wa: N
    bx: N
    by: N
    wb: N


class PairInverseMass[N: (float, Wide)](NamedTuple):
    """Inverse masses [1/kg] and inverse moments of inertia [1/(kg m^2)] of A and of B."""

    a: N
    inertia_a: N
    b: N
    inertia_b: N


class ContactFrame[N: (float, Wide)](NamedTuple):
    """The normal from A to B, and the arms from both centres to a point [m]."""

    nx: N
    ny: N
    arm_ax: N
    arm_ay: N
    arm_bx: N
    arm_by: N


class MomentArms[N: (float, Wide)](NamedTuple):
    """Moments of unit impulses about both centres [m]: r_a x n, r_b x n, r_a x t, r_b x t."""

    normal_a: N
    normal_b: N
    tangent_a: N
    tangent_b: N


class PointState[N: (float, Wide)](NamedTuple):
    """The moment arms of a point [m]; B's velocity there against A's, along n and along t [m/s]."""

    normal_a: N
    normal_b: N
    tangent_a: N
    tangent_b: N
    v: N
    sliding: N


@always_inlined
def velocity_of(linear: Vectors, angular: Numbers, a: int, b: int) -> PairVelocity[float]:
    """Return the velocities of two rows, from arrays (rows, 2) and (rows,)."""
    return PairVelocity(linear[a, 0], linear[a, 1], angular[a], linear[b, 0], linear[b, 1], angular[b])


@always_inlined
def put_velocity(linear: Vectors, angular: Numbers, a: int, b: int, v: PairVelocity[float]) -> None:
    """Write the velocities of two rows into arrays (rows, 2) and (rows,)."""
    linear[a, 0], linear[a, 1], angular[a] = v.ax, v.ay, v.wa
    linear[b, 0], linear[b, 1], angular[b] = v.bx, v.by, v.wb


@always_inlined
def inverse_mass_of(inverse: Inverse, a: int, b: int) -> PairInverseMass[float]:
    """Return the inverse masses and moments of inertia of two rows."""
    return PairInverseMass(inverse.mass[a], inverse.inertia[a], inverse.mass[b], inverse.inertia[b])


@always_inlined
def frame_of(manifold: Manifold, point: Point) -> ContactFrame[float]:
    """Return the normal of a pair and the arms of one of its points."""
    return ContactFrame(
        manifold.normal_x, manifold.normal_y, point.arm_ax, point.arm_ay, point.arm_bx, point.arm_by
    )


@always_inlined
def point_velocity[N: (float, Wide)](at: ContactFrame[N], v: PairVelocity[N]) -> tuple[N, N]:
    """Return the velocity of B's point against A's [m/s]."""
    vx: N = v.bx - v.wb * at.arm_by - v.ax + v.wa * at.arm_ay
    vy: N = v.by + v.wb * at.arm_bx - v.ay - v.wa * at.arm_ax
    return vx, vy


@always_inlined
def along_and_across[N: (float, Wide)](nx: N, ny: N, x: N, y: N) -> tuple[N, N]:
    """Return the parts of a vector along the normal and along the tangent."""
    return x * nx + y * ny, y * nx - x * ny


@always_inlined
def impulse_at[N: (float, Wide)](nx: N, ny: N, normal: N, tangent: N) -> tuple[N, N]:
    """Return the vector of a normal and a tangential impulse [N s]."""
    return normal * nx - tangent * ny, normal * ny + tangent * nx


@always_inlined
def moments_of[N: (float, Wide)](at: ContactFrame[N], px: N, py: N) -> tuple[N, N]:
    """Return the moments of an impulse about both centres [N m s]."""
    return at.arm_ax * py - at.arm_ay * px, at.arm_bx * py - at.arm_by * px


@always_inlined
def moment_arms[N: (float, Wide)](at: ContactFrame[N]) -> MomentArms[N]:
    """Return the moments of unit impulses along the normal and the tangent at a point [m]."""
    return MomentArms(
        at.arm_ax * at.ny - at.arm_ay * at.nx, at.arm_bx * at.ny - at.arm_by * at.nx,
        at.arm_ax * at.nx + at.arm_ay * at.ny, at.arm_bx * at.nx + at.arm_by * at.ny,
    )  # fmt: skip


@always_inlined
def point_state(at: ContactFrame[float], v: PairVelocity[float]) -> PointState[float]:
    """Return the moment arms of a point, and how B moves against A there."""
    arms = moment_arms(at)
    vx, vy = point_velocity(at, v)
    along, across = along_and_across(at.nx, at.ny, vx, vy)
    return PointState(arms.normal_a, arms.normal_b, arms.tangent_a, arms.tangent_b, along, across)


@always_inlined
def response[N: (float, Wide)](
    mass: N, inertia_a: N, inertia_b: N, one_a: N, one_b: N, other_a: N, other_b: N
) -> N:
    """Return how an impulse at one point changes the velocity along it at another [1/kg].

    An element of the Delassus matrix J M^-1 J^T of impulses in one direction, of the moment arms ``one`` and
    ``other`` [m]; ``mass`` is the sum of both inverse masses, or 0 for directions across each other.
    """
    element: N = mass + inertia_a * one_a * other_a + inertia_b * one_b * other_b
    return element


@always_inlined
def after_impulse[N: (float, Wide)](
    v: PairVelocity[N], mass: PairInverseMass[N], px: N, py: N, moment_a: N, moment_b: N
) -> PairVelocity[N]:
    """Return the velocities after an impulse (px, py) [N s] on B, with its moments about both centres."""
    return PairVelocity(
        v.ax - mass.a * px, v.ay - mass.a * py, v.wa - mass.inertia_a * moment_a,
        v.bx + mass.b * px, v.by + mass.b * py, v.wb + mass.inertia_b * moment_b,
    )  # fmt: skip


@always_inlined
def after_impulse_at[N: (float, Wide)](
    v: PairVelocity[N], mass: PairInverseMass[N], at: ContactFrame[N], normal: N, tangent: N
) -> PairVelocity[N]:
    """Return the velocities after a normal and a tangential impulse at a point [N s]."""
    px, py = impulse_at(at.nx, at.ny, normal, tangent)
    moment_a, moment_b = moments_of(at, px, py)
    return after_impulse(v, mass, px, py, moment_a, moment_b)


@always_inlined
def mean_velocity(one: PairVelocity[float], other: PairVelocity[float]) -> PairVelocity[float]:
    """Return the mean of the velocities before and after impulses: those at which they do their work."""
    return PairVelocity(
        0.5 * (one.ax + other.ax), 0.5 * (one.ay + other.ay), 0.5 * (one.wa + other.wa),
        0.5 * (one.bx + other.bx), 0.5 * (one.by + other.by), 0.5 * (one.wb + other.wb),
    )  # fmt: skip
