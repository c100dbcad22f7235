"""What the stages of a substep work on: arrays of a world, in named tuples."""

from typing import NamedTuple

from physicslab.kernels import Numbers, Rows, Vectors
from physicslab.kernels.records import Couples, Impacts, Manifolds, Points
from physicslab.kernels.wide.slots import Slots

__all__ = ["Acting", "Bounds", "Inverse", "Log", "Materials", "Motion", "Near", "Sizes", "Softness"]


class Motion(NamedTuple):
    """Positions (rows, 2) [m], angles [rad], velocities (rows, 2) [m/s] and angular velocities [rad/s]."""

    position: Vectors
    angle: Numbers
    linear: Vectors
    angular: Numbers


class Sizes(NamedTuple):
    """Kinds of shape, and radii, widths and heights [m]."""

    kind: Rows
    radius: Numbers
    width: Numbers
    height: Numbers


class Materials(NamedTuple):
    """Restitutions and coefficients of friction."""

    restitution: Numbers
    friction: Numbers


class Inverse(NamedTuple):
    """Inverse masses [1/kg] and inverse moments of inertia [1/(kg m^2)]."""

    mass: Numbers
    inertia: Numbers


class Acting(NamedTuple):
    """Forces (rows, 2) [N] and torques [N m], and whether there are any."""

    force: Vectors
    torque: Numbers
    any: bool


class Bounds(NamedTuple):
    """The world's bounds: where they are (4,) [m], their restitution and friction."""

    walls: Numbers
    restitution: float
    friction: float


class Near(NamedTuple):
    """The near pairs: their records, points and counts, which are scalar, which of them touch.

    Then the slots of discs and of boxes; the pairs without records, how near each must come to get one [m],
    and the entities of all rows.
    """

    counts: Rows
    manifolds: Manifolds
    points: Points
    scalar: Rows
    touching: Rows
    discs: Slots
    boxes: Slots
    proximity: Couples
    activation_distance: Numbers
    entities: Rows


class Log(NamedTuple):
    """A ring of impacts, and the time [s] at which their moment is reckoned from."""

    impacts: Impacts
    time: float


class Softness(NamedTuple):
    """The contact spring: frequency [Hz], damping ratio, overlap left alone, fastest push [m/s]."""

    hertz: float
    damping_ratio: float
    slop: float
    max_push: float
