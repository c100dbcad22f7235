"""Thrust: a push that a body carries with it, over packed coordinates."""

import math

from physicslab.kernels.forces.force_calls import force_kernel


@force_kernel
def thrust(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add the force and the torque of each, times cos(omega t + phase).

    ``parameters``: seven of each: force (x, y), torque, where it acts in the body's frame (x, y), omega
    [rad/s] and phase [rad]. ``indices``: how many, and where the time is; then three of each: where x and
    the angle are, -1 for an angle that it does not change, and whether the force turns with the body.
    """
    now = q[indices[1]]
    for p in range(indices[0]):
        k, w = 7 * p, 2 + 3 * p
        i, turn = indices[w], indices[w + 1]
        swing = math.cos(parameters[k + 5] * now + parameters[k + 6])
        fx, fy = swing * parameters[k], swing * parameters[k + 1]
        if turn >= 0:
            c, s = math.cos(q[turn]), math.sin(q[turn])
            if indices[w + 2] != 0:
                fx, fy = c * fx - s * fy, s * fx + c * fy
            x, y = parameters[k + 3], parameters[k + 4]
            force[turn] += (c * x - s * y) * fy - (s * x + c * y) * fx + swing * parameters[k + 2]
        force[i] += fx
        force[i + 1] += fy
