"""Whole steps of a world whose bodies touch, in one compiled loop: the stages of leapfrog, in their order."""

from physicslab.kernels import Flags, Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.contact import find_contacts
from physicslab.kernels.gravity import uniform_gravity
from physicslab.kernels.grid import still_holds
from physicslab.kernels.impact import strike
from physicslab.kernels.impulse import MOST_PARTS, relax, separate, solve
from physicslab.kernels.motion import clear, drift, find_not_finite, kick
from physicslab.kernels.records import Manifolds, Points

__all__ = ["ALL", "BEGIN", "CROWDED", "DIVERGED", "FIND", "STRIKE", "UNLISTED", "advance"]

ALL, UNLISTED, CROWDED, DIVERGED = range(4)
"""Why the loop ended: all steps are made; the near pairs must be listed anew; so many bodies touch that they
may be worth blocks; the last step has left something that is not finite."""
BEGIN, FIND, STRIKE = range(3)
"""Where in a substep the loop begins: at its start; where bodies touch; at the impacts."""

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
_Lanes = tuple[Numbers, int, Rows, Rows, Numbers, int, Rows, Rows]
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


@kernel
def advance(
    steps: int, substeps: int, substep: int, stage: int, h: float, iterations: int, few: int,
    state: _State, kept: _State, sizes: _Sizes, materials: _Two, inverse: _Two, tethered: Flags,
    forces: _Forces, damping: tuple[float, float], fall: float, fat: Vectors, bounds: _Bounds,
    manifolds: Manifolds, points: Points, loose: Rows, loose_count: int, touching: Rows, active: int,
    lanes: _Lanes, spring: _Spring, span: float,
) -> tuple[int, int, int, int, int, int, int, float]:  # fmt: skip
    """Make ``steps`` steps of ``substeps`` times ``h`` seconds, beginning at a stage of a substep.

    The stages are those of :data:`physicslab.integrators.leapfrog.LEAPFROG`, and what happens at each is what
    the systems do there. ``fall`` is how far [m] the forces may bring two bodies together within a substep;
    ``few`` contacts or more end the loop.

    Returns why it ended, how many steps are done, the substep that it was in, how many pairs touch, how many
    of them the impacts left, the impacts in the steps that are done and all impacts, and the time [s] that
    the points' impulses stand for. ``kept`` is the state in which the last step began.
    """
    position, angle, linear, angular = state
    force, torque, mass, has_forces, gx, gy = forces
    kicked = has_forces or damping[0] != 0.0 or damping[1] != 0.0
    hertz, damping_ratio, slop, max_push = spring
    done, left, impacts, impacts_done = 0, 0, 0, 0
    while done < steps:
        if stage == BEGIN:
            if substep == 0:
                _keep(state, kept)
            drift(position, angle, linear, angular, tethered, 0.5 * h)
            if has_forces:
                clear(force, torque)
                uniform_gravity(force, mass, inverse[0], gx, gy)
            if kicked:
                kick(linear, angular, force, torque, *inverse, tethered, *damping, 0.5 * h)
            if not still_holds(position, angle, linear, *sizes, fat, h):
                return UNLISTED, done, substep, active, left, impacts_done, impacts, span
        if stage != STRIKE:
            active = find_contacts(
                manifolds, points, loose, loose_count, touching, *state, *sizes, *materials, *inverse, *bounds,
                substep == 0, h, -0.5, fall,
            )  # fmt: skip
            if substep == 0 and active >= few:
                return CROWDED, done, substep, active, left, impacts_done, impacts, span
        stage, left = BEGIN, 0
        if active:
            struck, left = strike(
                manifolds, points, touching, active, *state, force, *inverse, has_forces, h, -0.5 * h, 0.5 * h
            )
            impacts += struck
        if kicked:
            kick(linear, angular, force, torque, *inverse, tethered, *damping, 0.5 * h)
        if left:
            carried = h / max(span, h / MOST_PARTS) if span > 0.0 else 1.0
            span = h
            solve(
                manifolds, points, touching, active, *lanes, linear, angular, *inverse, force, has_forces,
                h, carried, iterations, hertz, damping_ratio, slop,
            )  # fmt: skip
        drift(position, angle, linear, angular, tethered, 0.5 * h)
        if left:
            relax(
                manifolds, points, touching, active, *lanes, linear, angular, *inverse, 0.5 * h, iterations
            )
            separate(manifolds, points, touching, active, position, inverse[0], max_push * (0.5 * h))
        substep += 1
        if substep == substeps:
            substep = 0
            if find_not_finite(position, angle) >= 0 or find_not_finite(linear, angular) >= 0:
                return DIVERGED, done, substep, active, left, impacts_done, impacts, span
            done, impacts_done = done + 1, impacts
    return ALL, done, substep, active, left, impacts_done, impacts, span
