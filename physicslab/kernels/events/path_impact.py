"""The impulse of an impact, as it changes two paths, with rounding compensated."""

from physicslab.kernels import Numbers, Vectors, inlined
from physicslab.kernels.arguments import Inverse
from physicslab.kernels.events.path import push
from physicslab.kernels.ode.compensated import add_pair, multiply
from physicslab.kernels.records import Manifold, Point
from physicslab.kernels.solver.blow import Blow

__all__ = ["resolve_ballistic_impacts"]


@inlined
def _speed_against(
    paths: Vectors, angular: Numbers, a: int, b: int, point: Point, along_x: float, along_y: float
) -> tuple[float, float]:
    """Return how fast B's contact point moves against A's along a direction, and the remainder.

    The paths begin now.
    """
    vx, x_low = add_pair(paths[b, 4], paths[b, 5], -paths[a, 4], -paths[a, 5])
    vy, y_low = add_pair(paths[b, 6], paths[b, 7], -paths[a, 6], -paths[a, 7])
    vx += angular[a] * point.arm_ay - angular[b] * point.arm_by
    vy += angular[b] * point.arm_bx - angular[a] * point.arm_ax
    return vx * along_x + vy * along_y, x_low * along_x + y_low * along_y


@inlined
def _short_of(v: float, v_low: float, before: float, before_low: float, restitution: float) -> float:
    """Return by how much a speed after an impact misses -e times that before."""
    target, target_low = multiply(restitution, before)
    missed, low = add_pair(v, v_low, target, target_low + restitution * before_low)
    return missed + low


@inlined
def _bounce_two(
    manifold: Manifold, one: Point, two: Point, v1: float, v2: float, inverse: Inverse
) -> tuple[float, float]:
    """Return the normal impulses that turn both approach speeds of a contact into e times themselves.

    The two are solved together, so that a box that lands flat does not start to turn. Where one impulse would
    pull, the other acts alone.
    """
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    turn_a1, turn_b1 = one.arm_ax * ny - one.arm_ay * nx, one.arm_bx * ny - one.arm_by * nx
    turn_a2, turn_b2 = two.arm_ax * ny - two.arm_ay * nx, two.arm_bx * ny - two.arm_by * nx
    k11, k22 = 1.0 / one.normal_mass, 1.0 / two.normal_mass
    k12 = inverse.mass[a] + inverse.mass[b] + inverse.inertia[a] * turn_a1 * turn_a2
    k12 += inverse.inertia[b] * turn_b1 * turn_b2
    r1, r2 = -(1.0 + manifold.restitution) * v1, -(1.0 + manifold.restitution) * v2
    determinant = k11 * k22 - k12 * k12
    if determinant > 1e-9 * k11 * k22:
        j1 = (k22 * r1 - k12 * r2) / determinant
        j2 = (k11 * r2 - k12 * r1) / determinant
        if j1 >= 0.0 and j2 >= 0.0:
            return j1, j2
    if r1 >= r2:
        return r1 / k11, 0.0
    return 0.0, r2 / k22


@inlined
def _bounce(
    manifold: Manifold, one: Point, two: Point, meets_1: bool, meets_2: bool, v1: float, v2: float,
    inverse: Inverse,
) -> tuple[float, float]:  # fmt: skip
    """Return the normal impulses on B of an impact at the approach speeds v1 and v2 of its points [N s]."""
    if meets_1 and meets_2:
        return _bounce_two(manifold, one, two, v1, v2, inverse)
    if meets_1:
        return -(1.0 + manifold.restitution) * v1 * one.normal_mass, 0.0
    return 0.0, -(1.0 + manifold.restitution) * v2 * two.normal_mass


@inlined
def _friction_impulse(manifold: Manifold, point: Point, j: float, sliding: float) -> float:
    """Return the impulse that stops the sliding, at most mu times the normal impulse j [N s]."""
    limit = manifold.friction * j
    along: float = min(max(-point.tangent_mass * sliding, -limit), limit)
    return along


@inlined
def _hit(
    manifold: Manifold, point: Point, j: float, v: float, paths: Vectors, angular: Numbers, inverse: Inverse
) -> float:
    """Apply a normal impulse and its friction to the paths of A and B, and record them.

    Returns the tangential impulse [N s].
    """
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    along = 0.0
    if manifold.friction > 0.0:
        # A normal impulse at the arm of a disc, or on what does not turn, leaves the sliding as it is.
        sliding, low = _speed_against(paths, angular, a, b, point, -ny, nx)
        along = _friction_impulse(manifold, point, j, sliding + low)
    px, py = j * nx - along * ny, j * ny + along * nx
    push(paths, a, -inverse.mass[a], px, py)
    push(paths, b, inverse.mass[b], px, py)
    angular[a] -= inverse.inertia[a] * (point.arm_ax * py - point.arm_ay * px)
    angular[b] += inverse.inertia[b] * (point.arm_bx * py - point.arm_by * px)
    point.approach_speed = max(point.approach_speed, -v)
    point.impact_normal += j
    point.impact_tangent += along
    return along


@inlined
def resolve_ballistic_impacts(
    manifold: Manifold, one: Point, two: Point, paths: Vectors, angular: Numbers, inverse: Inverse
) -> Blow:
    """Bounce a pair whose paths begin now and whose points are filled; return the impulses."""
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    v1, low1 = _speed_against(paths, angular, a, b, one, nx, ny)
    along1, along2, left, j2 = 0.0, 0.0, 0.0, 0.0
    if manifold.count == 2:
        v2, _ = _speed_against(paths, angular, a, b, two, nx, ny)
        j1, j2 = _bounce(manifold, one, two, True, True, v1, v2, inverse)
        if j2 > 0.0:
            along2 = _hit(manifold, two, j2, v2, paths, angular, inverse)
    else:
        j1, _ = _bounce(manifold, one, two, True, False, v1, 0.0, inverse)
    if j1 > 0.0:
        along1 = _hit(manifold, one, j1, v1, paths, angular, inverse)
    if manifold.count == 1 and j1 > 0.0:
        # The rounding of j is the same at every impact of a pair and would add up: it is corrected.
        v, low = _speed_against(paths, angular, a, b, one, nx, ny)
        left = -_short_of(v, low, v1, low1, manifold.restitution) * one.normal_mass
        push(paths, a, -inverse.mass[a], left * nx, left * ny)
        push(paths, b, inverse.mass[b], left * nx, left * ny)
    manifold.impact_count += 1
    return Blow(max(j1, 0.0) + left, along1, max(j2, 0.0), along2)
