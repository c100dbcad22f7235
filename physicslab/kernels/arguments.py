"""The arguments of kernels: arrays of a world that belong together, in named tuples.

Python passes them as plain tuples, which numba unpacks three times as fast (for the fused loop 4 us instead
of 15); what Python calls gives them their names: ``Motion(*motion)``.
"""

from typing import NamedTuple

from physicslab.kernels import Flags, Numbers, Rows, Vectors, fused
from physicslab.kernels.records import Couples, Impacts, Manifolds, Points
from physicslab.kernels.wide.layout import Slots, SlotsTuple

__all__ = [
    "Acting", "ActingTuple", "Bounds", "BoundsTuple", "Contacts", "Gravity", "GravityTuple", "Inverse",
    "InverseTuple", "Log", "Materials", "MaterialsTuple", "Motion", "MotionTuple", "Near", "NearTuple",
    "Plan", "PlanTuple", "Sizes", "SizesTuple", "Sleepers", "SleepersTuple", "Softness", "SoftnessTuple",
    "named_near",
]  # fmt: skip


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
    """Forces (rows, 2) [N] and torques [N m], whether there are any, and the rows that they do not kick.

    Then whether they are uniform: they accelerate all that can be moved alike, and turn nothing.
    """

    force: Vectors
    torque: Numbers
    any: bool
    unkicked: Flags
    uniform: bool


class Bounds(NamedTuple):
    """The world's bounds: where they are (4,) [m], their restitution and friction."""

    walls: Numbers
    restitution: float
    friction: float


class Near(NamedTuple):
    """The near pairs: their records, points and counts, which are scalar, which of them touch.

    Then the slots of discs and of boxes; the pairs without records, the distance at which each gets one [m],
    the entities of all rows, and the angle of each box when its cosine and sine were computed, and those; the
    account that contacts and impacts add to (:mod:`physicslab.kernels.accounts`). For that, room for what is
    noted of points (points, 4), and for the velocities (rows, 2) and angular velocities from before the
    impulses of a substep (:mod:`physicslab.kernels.solver.work`).
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
    rotations: Vectors
    account: Vectors
    noted: Vectors
    linear_before: Vectors
    angular_before: Numbers


class Contacts(NamedTuple):
    """The scalar pairs that touch: records, points, which pairs, and how many.

    A function that is given no more than it takes is called faster: the near pairs are 160 machine words.
    """

    manifolds: Manifolds
    points: Points
    touching: Rows
    number: int


class Log(NamedTuple):
    """A ring of impacts, the time [s] from which theirs are counted, and the account that they add to."""

    impacts: Impacts
    time: float
    account: Vectors


class Softness(NamedTuple):
    """The contact spring: the share of overlap corrected in a substep, stiffness, fastest push [m/s].

    Stiffness is that of a spring over a substep h with one sweep: effective masses over h^2.
    """

    push: float
    stiffness: float
    max_push: float


class Plan(NamedTuple):
    """Substeps a step, iterations of the solver, the substep and the step [s], the time at the start [s].

    Of 0 iterations, the number goes by that of the contacts.
    """

    substeps: int
    iterations: int
    h: float
    dt: float
    time: float


class Gravity(NamedTuple):
    """Masses and moments of inertia, the inverse of both (of all bodies), gravity [m/s^2].

    Then the speculative margin [m].
    """

    mass: Numbers
    inertia: Numbers
    inverse_mass: Numbers
    inverse_inertia: Numbers
    gx: float
    gy: float
    margin: float


class Sleepers(NamedTuple):
    """Whether bodies may sleep and how many do; which, their rests [s] and lowest speeds [m/s].

    Then room for marks, the rows whose pairs are inactive, and those pairs.
    """

    on: bool
    number: int
    asleep: Flags
    rest: Numbers
    slowest: Numbers
    marked: Flags
    inactive: Flags
    pairs: Rows


MotionTuple = tuple[Vectors, Numbers, Vectors, Numbers]
SizesTuple = tuple[Rows, Numbers, Numbers, Numbers]
MaterialsTuple = tuple[Numbers, Numbers]
InverseTuple = tuple[Numbers, Numbers]
ActingTuple = tuple[Vectors, Numbers, bool, Flags, bool]
BoundsTuple = tuple[Numbers, float, float]
NearTuple = tuple[
    Rows,
    Manifolds,
    Points,
    Rows,
    Rows,
    SlotsTuple,
    SlotsTuple,
    Couples,
    Numbers,
    Rows,
    Vectors,
    Vectors,
    Vectors,
    Vectors,
    Numbers,
]
SoftnessTuple = tuple[float, float, float]
PlanTuple = tuple[int, int, float, float, float]
GravityTuple = tuple[Numbers, Numbers, Numbers, Numbers, float, float, float]
SleepersTuple = tuple[bool, int, Flags, Numbers, Numbers, Flags, Flags, Rows]
"""The same, without names."""


@fused
def named_near(plain: NearTuple) -> Near:
    """Give names to a tuple, and to the slots within it."""
    (
        counts, manifolds, points, scalar, touching, discs, boxes, proximity, activation_distance, entities,
        rotations, account, noted, linear_before, angular_before,
    ) = plain  # fmt: skip
    return Near(
        counts, manifolds, points, scalar, touching, Slots(*discs), Slots(*boxes),
        proximity, activation_distance, entities, rotations, account, noted, linear_before, angular_before,
    )  # fmt: skip
