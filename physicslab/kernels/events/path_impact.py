"""The impulse of an impact, as it changes two paths, with rounding compensated."""

from physicslab.kernels import Numbers, Vectors, inlined
from physicslab.kernels.arguments import Inverse
from physicslab.kernels.events.path import push
from physicslab.kernels.ode.compensated import add_pair, multiply
from physicslab.kernels.records import Manifold, Point
from physicslab.kernels.solver.impact import bounce, friction_impulse

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
def _hit(
    manifold: Manifold, point: Point, j: float, v: float, paths: Vectors, angular: Numbers, inverse: Inverse
) -> None:
    """Apply a normal impulse and its friction to the paths of A and B, and record them."""
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    along = 0.0
    if manifold.friction > 0.0:
        # A normal impulse at the arm of a disc, or on what does not turn, leaves the sliding as it is.
        sliding, low = _speed_against(paths, angular, a, b, point, -ny, nx)
        along = friction_impulse(manifold, point, j, sliding + low)
    px, py = j * nx - along * ny, j * ny + along * nx
    push(paths, a, -inverse.mass[a], px, py)
    push(paths, b, inverse.mass[b], px, py)
    angular[a] -= inverse.inertia[a] * (point.arm_ax * py - point.arm_ay * px)
    angular[b] += inverse.inertia[b] * (point.arm_bx * py - point.arm_by * px)
    point.approach_speed = max(point.approach_speed, -v)
    point.impact_normal += j
    point.impact_tangent += along


@inlined
def resolve_ballistic_impacts(
    manifold: Manifold, one: Point, two: Point, paths: Vectors, angular: Numbers, inverse: Inverse
) -> None:
    """Bounce a pair whose paths begin now and whose points are filled."""
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    v1, low1 = _speed_against(paths, angular, a, b, one, nx, ny)
    if manifold.count == 2:
        v2, _ = _speed_against(paths, angular, a, b, two, nx, ny)
        j1, j2 = bounce(manifold, one, two, True, True, v1, v2, inverse)
        if j2 > 0.0:
            _hit(manifold, two, j2, v2, paths, angular, inverse)
    else:
        j1, _ = bounce(manifold, one, two, True, False, v1, 0.0, inverse)
    if j1 > 0.0:
        _hit(manifold, one, j1, v1, paths, angular, inverse)
    if manifold.count == 1 and j1 > 0.0:
        # The rounding of j is the same at every impact of a pair and would add up: it is corrected.
        v, low = _speed_against(paths, angular, a, b, one, nx, ny)
        left = -_short_of(v, low, v1, low1, manifold.restitution) * one.normal_mass
        push(paths, a, -inverse.mass[a], left * nx, left * ny)
        push(paths, b, inverse.mass[b], left * nx, left * ny)
    manifold.impact_count += 1
