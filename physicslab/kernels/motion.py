"""Newton's second law: what bodies weigh, how forces change velocities and velocities positions."""

import math

from numba import boolean, float64, int64, void

from physicslab.kernels import kernel

__all__ = ["clear", "derive_masses", "drift", "find_not_finite", "kick"]

_FLAGS = boolean[::1]
_CODES = int64[::1]
_NUMBERS = float64[::1]
_VECTORS = float64[:, ::1]


@kernel(
    void(
        _FLAGS, _FLAGS, _FLAGS, _NUMBERS, _NUMBERS, _FLAGS, _FLAGS, _CODES,
        _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS,
    )
)  # fmt: skip
def derive_masses(
    has_velocity, has_mass, held, mass, inertia, inertia_given, fixed_rotation, kind,
    radius, width, height, angular, inverse_mass, inverse_inertia,
):  # fmt: skip
    """Work out each row's moment of inertia and its inverse mass [1/kg] and inertia [1/(kg m^2)].

    A disc has I = m r^2 / 2, a box m (w^2 + h^2) / 12. What has no velocity, no mass or is held weighs infinitely much.
    """
    for i in range(len(mass)):
        if not inertia_given[i]:
            if kind[i] == 1:
                inertia[i] = 0.5 * mass[i] * radius[i] * radius[i]
            elif kind[i] == 2:
                inertia[i] = mass[i] * (width[i] * width[i] + height[i] * height[i]) / 12.0
            else:
                inertia[i] = 0.0
        moves_freely = has_velocity[i] and has_mass[i] and not held[i]
        inverse_mass[i] = 1.0 / mass[i] if moves_freely else 0.0
        turns_freely = moves_freely and inertia[i] > 0.0 and not fixed_rotation[i]
        inverse_inertia[i] = 1.0 / inertia[i] if turns_freely else 0.0
        if fixed_rotation[i]:
            angular[i] = 0.0


@kernel(void(_VECTORS, _NUMBERS))
def clear(force, torque):
    """Set every force and torque to zero."""
    for i in range(len(torque)):
        force[i, 0] = 0.0
        force[i, 1] = 0.0
        torque[i] = 0.0


@kernel(void(_VECTORS, _NUMBERS, _VECTORS, _NUMBERS, _NUMBERS, _NUMBERS, float64, float64, float64))
def kick(linear, angular, force, torque, inverse_mass, inverse_inertia, linear_damping, angular_damping, h):
    """Change velocities by constant forces over a time h, with damping dv/dt = -c v solved exactly.

    v(h) = v e^(-c h) + a (1 - e^(-c h)) / c, so that half kicks compose to whole ones.
    """
    decay, gain = 1.0, h
    if linear_damping > 0.0:
        decay = math.exp(-linear_damping * h)
        gain = -math.expm1(-linear_damping * h) / linear_damping
    angular_decay, angular_gain = 1.0, h
    if angular_damping > 0.0:
        angular_decay = math.exp(-angular_damping * h)
        angular_gain = -math.expm1(-angular_damping * h) / angular_damping
    for i in range(len(inverse_mass)):
        if inverse_mass[i] > 0.0:
            linear[i, 0] = linear[i, 0] * decay + force[i, 0] * inverse_mass[i] * gain
            linear[i, 1] = linear[i, 1] * decay + force[i, 1] * inverse_mass[i] * gain
            angular[i] = angular[i] * angular_decay + torque[i] * inverse_inertia[i] * angular_gain


@kernel(void(_VECTORS, _NUMBERS, _VECTORS, _NUMBERS, float64))
def drift(position, angle, linear, angular, h):
    """Move and turn every row at its present velocity for a time h."""
    for i in range(len(angle)):
        position[i, 0] += h * linear[i, 0]
        position[i, 1] += h * linear[i, 1]
        angle[i] += h * angular[i]


@kernel(int64(_VECTORS, _NUMBERS, _VECTORS, _NUMBERS))
def find_not_finite(position, angle, linear, angular):
    """Return the first row with a value that is not finite, or -1."""
    for i in range(len(angle)):
        total = position[i, 0] + position[i, 1] + angle[i] + linear[i, 0] + linear[i, 1] + angular[i]
        if not math.isfinite(total):
            return i
    return -1
