"""The arguments of kernels: arrays of a world that belong together, in named tuples.

Python passes them as :data:`~physicslab.kernels.types.Plain` tuples (for the fused loop that takes 4 us
instead of 15); what Python calls gives them their names: ``Motion(*motion)``.
"""

from typing import NamedTuple

from physicslab.kernels import Flags, Numbers, Plain, Rows, Vectors, inlined, inlined_by_numba
from physicslab.kernels.forces.force_calls import Calls
from physicslab.kernels.records import (
    Aparts,
    ConstraintPoints,
    ConstraintRecords,
    Couples,
    Impacts,
    Manifolds,
    Points,
)
from physicslab.kernels.wide_layout import Slots


class Motion(NamedTuple):
    """Positions (rows, 2) [m], angles [rad], velocities (rows, 2) [m/s] and angular velocities [rad/s]."""

    position: Vectors
    angle: Numbers
    linear: Vectors
    angular: Numbers


class Materials(NamedTuple):
    """Restitutions and coefficients of friction."""

    restitution: Numbers
    friction: Numbers


class Inverse(NamedTuple):
    """Inverse masses [1/kg] and inverse moments of inertia [1/(kg m^2)]."""

    mass: Numbers
    inertia: Numbers


class Acting(NamedTuple):
    """Forces (rows, 2) [N] and torques [N m], both in one (3 rows,), whether there are any.

    Then the rows that they do not kick.
    Then whether they are uniform: they accelerate all that can be moved alike, and turn nothing.
    """

    force: Vectors
    torque: Numbers
    pull: Numbers
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
    impulses of a substep (:mod:`physicslab.kernels.solver.work`); and for when each body last met another
    one in the substep, and when it meets the next [s from now] (:mod:`physicslab.kernels.solver.meet_again`).
    Last, how far apart pairs are, and how far bodies have come (5, rows)
    (:mod:`physicslab.kernels.geometry.apart`); and in which sweep impulses changed each body last (rows,)
    (:mod:`physicslab.kernels.constraint.stirred`). Then how sweeps solve the scalar contacts
    (:mod:`physicslab.kernels.solver.constraints`).
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
    moments: Vectors
    apart: Aparts
    travels: Vectors
    stirred: Rows
    constraints: ConstraintRecords
    constraint_points: ConstraintPoints


class Contacts(NamedTuple):
    """The scalar pairs that touch: records, points, which pairs, and how many.

    A function that is given no more than it takes is called faster: near pairs are hundreds of machine words.
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
    """The contact spring: the share of overlap corrected in a substep, stiffness, largest push.

    Stiffness is that of a spring over a substep h with one sweep: effective masses over h^2. Deep overlap is
    corrected by at most ``max_push`` of a body's reach in a substep.
    """

    push: float
    stiffness: float
    max_push: float


class Plan(NamedTuple):
    """Substeps a step, iterations of the solver, the substep and the step [s], the time at the start [s].

    0 iterations: their number is chosen from that of the contacts. Then the time [s] that a step counts as
    rest, and the substep in which the records of a step begin, -1 where they have begun. Last, the configured
    substep [s], and how many times as many substeps loads have been found to need, 0 where none are.
    """

    substeps: int
    iterations: int
    h: float
    dt: float
    time: float
    rested: float
    first: int
    own_h: float
    finer: int


class Course(NamedTuple):
    """The parts of a substep in order (n,), as numbered in :mod:`physicslab.kernels.solver.soft`.

    Then times (3, n) in substeps: of each part its SHARE of the substep, how far the positions have DRIFTED
    before it, and by how much the middle of the substep comes LATER than that of a kick. Where the substep
    begins and ends, seen from where impacts are resolved, and how long after its beginning that is. Last,
    whether the ends of steps are Python's, as some parts are.
    """

    parts: Rows
    times: Vectors
    start: float
    end: float
    middle: float
    hooked: bool


class Sampled(NamedTuple):
    """Rows of which samples are taken (moving,), and room (n, 6 moving) for x, y, the angle and their rates.

    The first is due after so many steps of a call, and then one every ``stride`` steps, while there is room.
    """

    rows: Rows
    room: Vectors
    first: int
    stride: int


class Springs(NamedTuple):
    """Bodies on springs (:mod:`physicslab.kernels.ode.spring_flow`), in two arrays: each costs 0.1 us."""

    numbers: Numbers
    whole: Rows


class Packed(NamedTuple):
    """The state as compiled forces read it, places before bodies are moved apart, and forces on that way.

    These are (4, 3 rows + 1); then come the addresses of the forces (n, 3).
    """

    state: Vectors
    calls: Calls


class Gravity(NamedTuple):
    """Masses and moments of inertia, the inverse of both (of all bodies), gravity [m/s^2].

    Then the speculative margin [m], and the cause by which kicks of other forces are booked.
    """

    mass: Numbers
    inertia: Numbers
    inverse_mass: Numbers
    inverse_inertia: Numbers
    gx: float
    gy: float
    margin: float
    other: int


class Sleepers(NamedTuple):
    """Whether bodies may sleep and how many do; which, their rests [s] and lowest speeds [m/s].

    Then room for marks, the rows whose pairs are inactive, and those pairs; the forces (rows, 3) [N, N m] on
    those that sleep, and whether some came from a file, so that what supports them is not known yet.
    """

    on: bool
    number: int
    asleep: Flags
    rest: Numbers
    slowest: Numbers
    marked: Flags
    inactive: Flags
    pairs: Rows
    forces: Vectors
    unverified: bool


ActingTuple = tuple[Numbers, bool, Flags, bool]


@inlined_by_numba
def named_acting(plain: ActingTuple) -> Acting:
    """Give names to a tuple, and to both parts of the forces."""
    pull, acts, unkicked, uniform = plain
    rows = len(unkicked)
    return Acting(
        pull[: 2 * rows].reshape(rows, 2), pull[2 * rows : 3 * rows], pull, acts, unkicked, uniform
    )  # fmt: skip


@inlined_by_numba
def named_near(plain: Plain[Near]) -> Near:
    """Give names to a tuple, and to the slots within it."""
    (
        counts, manifolds, points, scalar, touching, discs, boxes, proximity, activation_distance, entities,
        rotations, account, noted, linear_before, angular_before, moments, apart, travels,
        stirred, constraints, constraint_points,
    ) = plain  # fmt: skip
    return Near(
        counts, manifolds, points, scalar, touching, Slots(*discs), Slots(*boxes),
        proximity, activation_distance, entities, rotations, account, noted, linear_before, angular_before,
        moments, apart, travels, stirred, constraints, constraint_points,
    )  # fmt: skip


@inlined
def take_sample(motion: Motion, sampled: Sampled, made: int) -> None:
    """Take the sample that is due after so many steps of a call, if one is."""
    late = made - sampled.first
    place = late // sampled.stride
    if late < 0 or late % sampled.stride > 0 or place >= len(sampled.room):
        return
    for k in range(len(sampled.rows)):
        i, sample = sampled.rows[k], sampled.room[place, 6 * k : 6 * k + 6]
        sample[0], sample[1], sample[2] = motion.position[i, 0], motion.position[i, 1], motion.angle[i]
        sample[3], sample[4], sample[5] = motion.linear[i, 0], motion.linear[i, 1], motion.angular[i]
