"""Whole steps of a world whose bodies touch, in one compiled loop: the stages of leapfrog, in their order."""

from physicslab.kernels import Flags, Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.contact import find_contacts
from physicslab.kernels.gravity import uniform_gravity
from physicslab.kernels.grid import still_holds
from physicslab.kernels.impact import strike
from physicslab.kernels.impulse import MOST_PARTS, relax, separate, solve
from physicslab.kernels.motion import clear, drift, find_not_finite, kick
from physicslab.kernels.near_pairs import promote
from physicslab.kernels.records import Couples, Manifolds, Points
from physicslab.kernels.ticks import charge, ticks

__all__ = [
    "ALL", "BEGIN", "CROWDED", "DIVERGED", "FIND", "STRIKE", "SYSTEMS", "UNLISTED", "advance",
]  # fmt: skip

ALL, UNLISTED, CROWDED, DIVERGED = range(4)
"""Why the loop ended: all steps are made; the near pairs must be listed anew; so many bodies touch that they
may be worth blocks; the last step has left something that is not finite."""
BEGIN, FIND, STRIKE = range(3)
"""Where in a substep the loop begins: at its start; where bodies touch; at the impacts."""
SYSTEMS = ("Bodies", "GravitySystem", "IntegrateSystem", "BroadPhaseSystem", "ContactSystem", "ResolveSystem")
"""Whose work it is, in the order in which ``cost`` holds what each took."""
_BODIES, _GRAVITY, _INTEGRATE, _BROAD_PHASE, _CONTACT, _RESOLVE = range(6)

_TIMED = 8
"""One of so many steps of a call is timed: reading the clock takes a twentieth of a step of ten bodies."""

_State = tuple[Vectors, Numbers, Vectors, Numbers]
"""Positions [m], angles [rad], velocities [m/s], angular velocities [rad/s]."""
_Sizes = tuple[Rows, Numbers, Numbers, Numbers]
"""Kinds of shape, radii, widths, heights [m]."""
_Two = tuple[Numbers, Numbers]
"""Restitutions and frictions; inverse masses [1/kg] and moments of inertia [1/(kg m^2)]."""
_Forces = tuple[Vectors, Numbers, Numbers, bool, float, float]
"""Forces [N], torques [N m], masses [kg]; whether any act, and gravity [m/s^2]."""
_Bounds = tuple[Numbers, float, float]
"""Where they are [m], their restitution and friction."""
_Touch = tuple[Manifolds, Points, Rows, int]
"""The records of near pairs, which of them touch, and how many."""
_Lanes = tuple[Numbers, int, Rows, Rows, Rows, Numbers, int, Rows, Rows, Rows]
"""Blocks of discs and of boxes, of which none is in use."""
_Idle = tuple[Couples, Numbers, Rows]
"""The near pairs without records and how near each must come to get one [m]; the entities of all rows."""
_Spring = tuple[float, float, float, float]
"""Of contacts: frequency [Hz], damping ratio, slop, fastest push [m/s]."""


@inlined
def _keep(state: _State, kept: _State) -> None:
    """Copy a state into arrays that are there."""
    for i in range(len(state[1])):
        kept[0][i, 0], kept[0][i, 1] = state[0][i, 0], state[0][i, 1]
        kept[1][i] = state[1][i]
        kept[2][i, 0], kept[2][i, 1] = state[2][i, 0], state[2][i, 1]
        kept[3][i] = state[3][i]


@inlined
def _pull(forces: _Forces, inverse_mass: Numbers, cost: Rows, now: int) -> int:
    """Add up the forces anew, if there are any."""
    force, torque, mass, has_forces, gx, gy = forces
    if has_forces:
        clear(force, torque)
        now = charge(cost, _BODIES, now)
        uniform_gravity(force, mass, inverse_mass, gx, gy)
        now = charge(cost, _GRAVITY, now)
    return now


@inlined
def _solve(
    touch: _Touch, lanes: _Lanes, linear: Vectors, angular: Numbers, inverse: _Two, forces: _Forces,
    h: float, span: float, iterations: int, spring: _Spring,
) -> float:  # fmt: skip
    """Keep apart what the impacts have left; return the time that impulses now stand for [s]."""
    hertz, damping_ratio, slop, _ = spring
    carried = h / max(span, h / MOST_PARTS) if span > 0.0 else 1.0
    both = touch + lanes
    solve(
        *both, linear, angular, *inverse, forces[0], forces[3],
        h, carried, iterations, hertz, damping_ratio, slop,
    )  # fmt: skip
    return h


@kernel
def advance(
    steps: int, substeps: int, substep: int, stage: int, h: float, iterations: int, few: int,
    state: _State, kept: _State, sizes: _Sizes, materials: _Two, inverse: _Two, tethered: Flags,
    forces: _Forces, damping: tuple[float, float], fall: float, fat: Vectors, bounds: _Bounds,
    idle: _Idle, near: tuple[int, int, int],
    manifolds: Manifolds, points: Points, loose: Rows, touching: Rows, active: int,
    lanes: _Lanes, spring: _Spring, span: float, cost: Rows,
) -> tuple[int, int, int, tuple[int, int, int], int, int, int, int, float]:  # fmt: skip
    """Make ``steps`` steps of ``substeps`` times ``h`` seconds, beginning at a stage of a substep.

    The stages are those of :data:`physicslab.integrators.leapfrog.LEAPFROG`, and what happens at each is what
    the systems do there. ``fall`` is how far [m] the forces may bring two bodies together within a substep;
    ``few`` contacts or more end the loop. ``near`` is how many near pairs lie idle, have records and are
    loose. ``cost`` (6,) gets ticks added for each of ``SYSTEMS``.

    Returns why it ended, how many steps are done, the substep that it was in, ``near`` as it is then, how
    many pairs touch, how many of them the impacts left, the impacts in the steps that are done and all
    impacts, and the time [s] that the points' impulses stand for. ``kept`` is the state in which the last
    step began.
    """
    position, angle, linear, angular = state
    walls, bounds_restitution, bounds_friction = bounds
    kicked = forces[3] or damping[0] != 0.0 or damping[1] != 0.0
    done, left, impacts, impacts_done = 0, 0, 0, 0
    now = ticks()
    while done < steps:
        if stage == BEGIN:
            if substep == 0:
                now = ticks() if done % _TIMED == 0 else -1
                _keep(state, kept)
                now = charge(cost, _BODIES, now)
            drift(position, angle, linear, angular, tethered, 0.5 * h)
            now = _pull(forces, inverse[0], cost, charge(cost, _INTEGRATE, now))
            if kicked:
                kick(linear, angular, forces[0], forces[1], *inverse, tethered, *damping, 0.5 * h)
            now = charge(cost, _BODIES, now)
            holds = still_holds(position, angle, linear, *sizes, fat, h)
            now = charge(cost, _BROAD_PHASE, now)
            if not holds:
                return UNLISTED, done, substep, near, active, left, impacts_done, impacts, span
        if stage != STRIKE:
            near = promote(
                idle[0], idle[1], near[0], manifolds, points, near[1], loose, near[2], idle[2],
                position, linear, h, fall,
            )  # fmt: skip
            active = find_contacts(
                manifolds, points, loose, near[2], touching, *state, *sizes, *materials, *inverse,
                walls, bounds_restitution, bounds_friction, substep == 0, h, -0.5, fall,
            )  # fmt: skip
            now = charge(cost, _CONTACT, now)
            if substep == 0 and active >= few:
                return CROWDED, done, substep, near, active, left, impacts_done, impacts, span
        stage, left, touch = BEGIN, 0, (manifolds, points, touching, active)
        if active:
            struck, left = strike(*touch, *state, forces[0], *inverse, forces[3], h, -0.5 * h, 0.5 * h)
            impacts += struck
            now = charge(cost, _RESOLVE, now)
        if kicked:
            kick(linear, angular, forces[0], forces[1], *inverse, tethered, *damping, 0.5 * h)
            now = charge(cost, _BODIES, now)
        if left:
            span = _solve(touch, lanes, linear, angular, inverse, forces, h, span, iterations, spring)
            now = charge(cost, _RESOLVE, now)
        drift(position, angle, linear, angular, tethered, 0.5 * h)
        now = charge(cost, _INTEGRATE, now)
        if left:
            both = touch + lanes
            relax(*both, linear, angular, *inverse, 0.5 * h, iterations)
            separate(*touch, position, inverse[0], spring[3] * (0.5 * h))
            now = charge(cost, _RESOLVE, now)
        substep += 1
        if substep == substeps:
            substep = 0
            failed = find_not_finite(position, angle) >= 0 or find_not_finite(linear, angular) >= 0
            now = charge(cost, _BODIES, now)
            if failed:
                return DIVERGED, done, substep, near, active, left, impacts_done, impacts, span
            done, impacts_done = done + 1, impacts
    return ALL, done, substep, near, active, left, impacts_done, impacts, span
