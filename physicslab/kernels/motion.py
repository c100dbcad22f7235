"""Newton's second law: the masses of bodies, and how forces change velocities and velocities positions."""

import math
import sys

from physicslab.kernels import Flags, Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.geometry.moments import inertia_of
from physicslab.kernels.geometry.shapes import ShapesTuple, SizesTuple, derive_shape, named_shapes
from physicslab.kernels.records import Pairs

FARTHEST = 1e300
"""The largest coordinate that a scene may hold [m] (``physicslab.ecs.fields.COORDINATE_LIMIT``)."""
LARGEST = sys.float_info.max
"""The largest number that is finite."""


@kernel
def derive_masses(
    has_velocity: Flags, has_mass: Flags, held: Flags,
    mass: Numbers, inertia: Numbers, inertia_given: Flags, fixed_rotation: Flags,
    kind: Rows, own: Rows, sizes: SizesTuple, kinds: Pairs, extents: Vectors, plain_shapes: ShapesTuple,
    angular: Numbers, inverse_mass: Numbers, inverse_inertia: Numbers,
    awake_inverse_mass: Numbers, awake_inverse_inertia: Numbers, asleep: Flags,
) -> tuple[float, int, int, float]:  # fmt: skip
    """Fill the table of shapes; compute moments of inertia, inverse masses [1/kg] and inertias [1/(kg m^2)].

    Returns the ratio of the greatest mass that can be moved to the least, of what has a shape, 1 if none has;
    and the first row of which the moment of inertia is not finite, or -1; and the first row of
    which a size is not above 0, or -1; and the smallest diameter or side of all shapes [m], infinite if
    there are none.

    A body without velocity or mass, or one that is
    held, has infinite mass; one too small to have an inverse inertia does not turn.
    """
    lightest, heaviest, infinite, sizeless, smallest = 0.0, math.inf, -1, -1, math.inf
    shapes = named_shapes(plain_shapes)
    for i in range(len(mass)):
        sized = derive_shape(i, kind, own, sizes, kinds, extents, shapes)
        if kind[i] != 0:
            smallest = min(smallest, 2.0 * shapes.thin[i])
        if sizeless < 0 and not sized:
            sizeless = i
        if not inertia_given[i]:
            inertia[i] = inertia_of(shapes, i, mass[i])
        moves_freely = has_velocity[i] and has_mass[i] and not held[i]
        inverse_mass[i] = 1.0 / mass[i] if moves_freely else 0.0
        turns_freely = moves_freely and inertia[i] > 0.0 and not fixed_rotation[i]
        inverse = 1.0 / inertia[i] if turns_freely else 0.0
        inverse_inertia[i] = inverse if math.isfinite(inverse) else 0.0  # too small to be turned
        awake_inverse_mass[i] = 0.0 if asleep[i] else inverse_mass[i]
        awake_inverse_inertia[i] = 0.0 if asleep[i] else inverse_inertia[i]
        if fixed_rotation[i]:
            angular[i] = 0.0
        if inverse_mass[i] > 0.0 and kind[i] != 0:
            lightest, heaviest = max(lightest, inverse_mass[i]), min(heaviest, inverse_mass[i])
        if infinite < 0 and not math.isfinite(inertia[i]):
            infinite = i
    return (lightest / heaviest if lightest > 0.0 else 1.0), infinite, sizeless, smallest


@kernel
def clear(force: Vectors, torque: Numbers) -> None:
    """Set every force and torque to zero."""
    for i in range(len(torque)):
        force[i, 0] = 0.0
        force[i, 1] = 0.0
        torque[i] = 0.0


@inlined
def damped(rate: float, h: float) -> tuple[float, float]:
    """Return the factors of v and of a that v' = a - ``rate`` v makes of a speed v in ``h`` seconds."""
    if rate > 0.0:
        return math.exp(-rate * h), -math.expm1(-rate * h) / rate
    return 1.0, h


@kernel
def kick(
    linear: Vectors, angular: Numbers, force: Vectors, torque: Numbers,
    inverse_mass: Numbers, inverse_inertia: Numbers, sub_integrated: Flags,
    linear_damping: float, angular_damping: float, h: float,
) -> None:  # fmt: skip
    """Change velocities by constant forces over a time h, with damping dv/dt = -c v solved exactly.

    Rows that are ``sub_integrated`` are left to the method that moves them.

    v(h) = v e^(-c h) + a (1 - e^(-c h)) / c, so that half kicks compose to whole ones.
    """
    decay, gain = damped(linear_damping, h)
    angular_decay, angular_gain = damped(angular_damping, h)
    for i in range(len(inverse_mass)):
        if inverse_mass[i] > 0.0 and not sub_integrated[i]:
            linear[i, 0] = linear[i, 0] * decay + force[i, 0] * inverse_mass[i] * gain
            linear[i, 1] = linear[i, 1] * decay + force[i, 1] * inverse_mass[i] * gain
            angular[i] = angular[i] * angular_decay + torque[i] * inverse_inertia[i] * angular_gain


@kernel
def drift(
    position: Vectors, angle: Numbers, linear: Vectors, angular: Numbers, sub_integrated: Flags, h: float
) -> None:
    """Move and turn every row that is not sub-integrated at its present velocity for a time h."""
    free = True
    for i in range(len(sub_integrated)):
        free &= not sub_integrated[i]
    if free:  # the usual case, without a branch in the loop, so that it is vectorised
        places, velocities = position.reshape(position.size), linear.reshape(linear.size)
        for i in range(len(places)):
            places[i] += h * velocities[i]
        for i in range(len(angle)):
            angle[i] += h * angular[i]
        return
    for i in range(len(angle)):
        if not sub_integrated[i]:
            position[i, 0] += h * linear[i, 0]
            position[i, 1] += h * linear[i, 1]
            angle[i] += h * angular[i]


@kernel
def predict(
    linear: Vectors, angular: Numbers, force: Vectors, torque: Numbers,
    inverse_mass: Numbers, inverse_inertia: Numbers, sub_integrated: Flags, unkicked: Flags, h: float,
) -> None:  # fmt: skip
    """Change velocities of sub-integrated rows that follow no fast force by what forces cause in a time h."""
    for i in range(len(unkicked)):
        if sub_integrated[i] and not unkicked[i]:
            linear[i, 0] += h * force[i, 0] * inverse_mass[i]
            linear[i, 1] += h * force[i, 1] * inverse_mass[i]
            angular[i] += h * torque[i] * inverse_inertia[i]


@kernel
def pack_state(
    position: Vectors, angle: Numbers, linear: Vectors, angular: Numbers, now: float, packed: Vectors
) -> None:
    """Write the coordinates of all rows and the time [s], and their rates, as compiled forces read them."""
    q, v, n = packed[0], packed[1], len(angle)
    for i in range(n):
        q[2 * i], q[2 * i + 1], q[2 * n + i] = position[i, 0], position[i, 1], angle[i]
        v[2 * i], v[2 * i + 1], v[2 * n + i] = linear[i, 0], linear[i, 1], angular[i]
    q[3 * n] = now


@kernel
def find_beyond(vectors: Vectors, numbers: Numbers, limit: float) -> int:
    """Return the first row with a vector beyond a finite limit, or a number that is not finite, or -1."""
    for i in range(len(numbers)):
        within = abs(vectors[i, 0]) <= limit and abs(vectors[i, 1]) <= limit  # which NaN is not
        if not (within and math.isfinite(numbers[i])):
            return i
    return -1
