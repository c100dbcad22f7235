"""The attraction of planets, called as integrators and steps call it: packed, by address."""

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels import compile_kernels
from physicslab.kernels.forces import packed_forces
from physicslab.kernels.forces.force_calls import add_forces

__all__ = ["attraction"]


def attraction(
    position: NDArray[np.float64], mass: NDArray[np.float64], G: float, softening: float, plummer: bool
) -> NDArray[np.float64]:
    """Return the force [N] on each of n bodies (n, 2) at ``position`` (n, 2) [m]."""
    n, force = len(mass), np.zeros(position.shape)
    parameters = np.concatenate(((G, softening), mass, mass, np.ones(n), (0.0,)))
    indices = np.concatenate(((n, plummer, 2 + 3 * n), 2 * np.arange(n))).astype(np.int64)
    compile_kernels((packed_forces.inverse_square, add_forces))
    call = packed_forces.inverse_square.address, parameters.ctypes.data, indices.ctypes.data
    add_forces(position.ravel(), np.zeros(2 * n), force.reshape(-1), np.array([call]))
    return force
