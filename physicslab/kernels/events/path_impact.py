"""The impulse of an impact, as it changes two paths, with rounding compensated."""

from physicslab.kernels import Numbers, Vectors, inlined
from physicslab.kernels.constraint import pair
from physicslab.kernels.constraint.impact_law import NEWTON, ImpactImpulses, point_response, solve_impact
from physicslab.kernels.constraint.pair import ContactFrame, PairInverseMass, PairVelocity, PointState
from physicslab.kernels.events.path import push
from physicslab.kernels.ode.compensated import add_pair, multiply
from physicslab.kernels.records import Manifold


@inlined
def path_velocity(paths: Vectors, angular: Numbers, a: int, b: int) -> PairVelocity[float]:
    """Return how two rows move whose paths begin now."""
    return PairVelocity(
        paths[a, 4] + paths[a, 5], paths[a, 6] + paths[a, 7], angular[a],
        paths[b, 4] + paths[b, 5], paths[b, 6] + paths[b, 7], angular[b],
    )  # fmt: skip


@inlined
def _state(
    paths: Vectors, angular: Numbers, a: int, b: int, at: ContactFrame[float]
) -> tuple[PointState[float], float]:
    """Return the state of a point and the remainder of its velocity along the normal; the paths begin now."""
    vx, x_low = add_pair(paths[b, 4], paths[b, 5], -paths[a, 4], -paths[a, 5])
    vy, y_low = add_pair(paths[b, 6], paths[b, 7], -paths[a, 6], -paths[a, 7])
    state = pair.point_state(at, PairVelocity(0.0, 0.0, angular[a], vx, vy, angular[b]))
    return state, x_low * at.nx + y_low * at.ny


@inlined
def _push_pair(
    paths: Vectors, angular: Numbers, a: int, b: int, mass: PairInverseMass[float],
    at: ContactFrame[float], normal: float, tangent: float,
) -> None:  # fmt: skip
    """Apply impulses at a point to the paths of A and B."""
    px, py = pair.impulse_at(at.nx, at.ny, normal, tangent)
    moment_a, moment_b = pair.moments_of(at, px, py)
    push(paths, a, -mass.a, px, py)
    push(paths, b, mass.b, px, py)
    angular[a] -= mass.inertia_a * moment_a
    angular[b] += mass.inertia_b * moment_b


@inlined
def resolve_ballistic_impacts(
    manifold: Manifold, at: ContactFrame[float], paths: Vectors, angular: Numbers,
    mass: PairInverseMass[float],
) -> tuple[ImpactImpulses, int]:  # fmt: skip
    """Bounce a pair whose paths begin now, and which meets there; return the impulses, and their law."""
    a, b, e = manifold.a, manifold.b, manifold.restitution
    state, low = _state(paths, angular, a, b, at)
    if state.v >= 0.0:
        return ImpactImpulses(0.0, 0.0, 0.0, 0.0), NEWTON
    response, left = point_response(state, mass), 0.0
    normal, tangent, law = solve_impact(response, e, manifold.friction)
    _push_pair(paths, angular, a, b, mass, at, normal, tangent)
    if law == NEWTON:
        # The rounding of the impulse is the same at every impact of a pair and would add up: it is corrected.
        after, after_low = _state(paths, angular, a, b, at)
        target, target_low = multiply(e, state.v)
        missed, missed_low = add_pair(after.v, after_low, target, target_low + e * low)
        left = -(missed + missed_low) / response.kn
        push(paths, a, -mass.a, left * at.nx, left * at.ny)
        push(paths, b, mass.b, left * at.nx, left * at.ny)
    return ImpactImpulses(normal + left, tangent, 0.0, 0.0), law
