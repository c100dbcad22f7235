"""Whole steps of a world whose bodies touch, in one compiled loop: the stages of leapfrog, in their order."""

from physicslab.kernels import Flags, Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.contact import find_contacts
from physicslab.kernels.gravity import uniform_gravity
from physicslab.kernels.grid import still_holds
from physicslab.kernels.impact import strike
from physicslab.kernels.impulse import MOST_PARTS, relax, separate, solve
from physicslab.kernels.islands import count_rest, find_touched
from physicslab.kernels.motion import clear, drift, find_not_finite, kick
from physicslab.kernels.records import Manifolds, Points
from physicslab.kernels.ticks import charge, ticks

__all__ = [
    "ALL", "BEGIN", "CROWDED", "DIVERGED", "DROWSY", "FIND", "STIRRED", "STRIKE", "SYSTEMS", "UNLISTED",
    "advance",
]  # fmt: skip

ALL, UNLISTED, CROWDED, DIVERGED, STIRRED, DROWSY = range(6)
"""Why the loop ended: all steps are made; the near pairs must be listed anew; so many bodies touch that they
may be worth blocks; the last step has left something that is not finite; somebody asleep is touched; at the
end of a step, somebody may fall asleep."""
BEGIN, FIND, STRIKE = range(3)
"""Where in a substep the loop begins: at its start; where bodies touch; at the impacts."""
SYSTEMS = (
    "Bodies", "GravitySystem", "IntegrateSystem", "BroadPhaseSystem", "ContactSystem", "ResolveSystem",
    "SleepSystem",
)  # fmt: skip
"""Whose work it is, in the order in which ``cost`` holds what each took."""
_BODIES, _GRAVITY, _INTEGRATE, _BROAD_PHASE, _CONTACT, _RESOLVE, _SLEEP = range(7)

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
_Sleep = tuple[bool, int, float, Numbers, Flags, Numbers, Numbers, Flags]
"""Whether bodies may sleep, how many do, the step [s], inverse masses of sleepers too, who sleeps, rests [s]
and lowest speeds [m/s]; room for marks."""
_Bounds = tuple[Numbers, float, float]
"""Where they are [m], their restitution and friction."""
_Touch = tuple[Manifolds, Points, Rows, int]
"""The records of near pairs, which of them touch, and how many."""
_Lanes = tuple[Numbers, int, Rows, Rows, Rows, Numbers, int, Rows, Rows, Rows]
"""Blocks of discs and of boxes, of which none is in use."""
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
    forces: _Forces, sleep: _Sleep, damping: tuple[float, float], fall: float, fat: Vectors, bounds: _Bounds,
    manifolds: Manifolds, points: Points, loose: Rows, loose_count: int, touching: Rows, active: int,
    lanes: _Lanes, spring: _Spring, span: float, cost: Rows,
) -> tuple[int, int, int, int, int, int, int, float]:  # fmt: skip
    """Make ``steps`` steps of ``substeps`` times ``h`` seconds, beginning at a stage of a substep.

    The stages are those of :data:`physicslab.integrators.leapfrog.LEAPFROG`, and what happens at each is what
    the systems do there. ``fall`` is how far [m] the forces may bring two bodies together within a substep;
    ``few`` contacts or more end the loop. ``cost`` (7,) gets ticks added for each of ``SYSTEMS``.

    Returns why it ended, how many steps are done, the substep that it was in, how many pairs touch, how many
    of them the impacts left, the impacts in the steps that are done and all impacts, and the time [s] that
    the points' impulses stand for. ``kept`` is the state in which the last step began.
    """
    position, angle, linear, angular = state
    drowsy, sleepers, dt, own_inverse_mass, asleep, rest, slowest, touched = sleep
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
            now = _pull(forces, own_inverse_mass, cost, charge(cost, _INTEGRATE, now))
            if kicked:
                kick(linear, angular, forces[0], forces[1], *inverse, tethered, *damping, 0.5 * h)
            now = charge(cost, _BODIES, now)
            holds = still_holds(position, angle, linear, *sizes, fat, h)
            now = charge(cost, _BROAD_PHASE, now)
            if not holds:
                return UNLISTED, done, substep, active, left, impacts_done, impacts, span
        if stage != STRIKE:
            active = find_contacts(
                manifolds, points, loose, loose_count, touching, *state, *sizes, *materials, *inverse,
                walls, bounds_restitution, bounds_friction, substep == 0, h, -0.5, fall,
            )  # fmt: skip
            now = charge(cost, _CONTACT, now)
            if substep == 0 and active >= few:
                return CROWDED, done, substep, active, left, impacts_done, impacts, span
            if sleepers:
                active, found = find_touched(
                    manifolds, points, touching, active, inverse[0], linear, angular, asleep, touched
                )
                now = charge(cost, _SLEEP, now)
                if found:
                    return STIRRED, done, substep, active, left, impacts_done, impacts, span
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
                return DIVERGED, done, substep, active, left, impacts_done, impacts, span
            done, impacts_done = done + 1, impacts
            if drowsy:
                due = count_rest(
                    linear, angular, *sizes, own_inverse_mass, tethered, asleep, rest, slowest, dt
                )
                now = charge(cost, _SLEEP, now)
                if due:
                    return DROWSY, done, substep, active, left, impacts_done, impacts, span
    return ALL, done, substep, active, left, impacts_done, impacts, span
