"""Numbers that were written to columns, where no handle checks them."""

import math

from physicslab.kernels import Flags, Numbers, kernel


@kernel
def find_outside(
    has_mass: Flags, mass: Numbers, inertia: Numbers, restitution: Numbers, friction: Numbers,
    stiffness: Numbers, damping: Numbers, rest_length: Numbers, linear_drag: Numbers, quadratic_drag: Numbers,
) -> int:  # fmt: skip
    """Return the first row in which a number is not finite or below what a step can take, or -1.

    Masses [kg] are above 0, restitutions at most 1; none of the others, in SI units, is negative. A moment of
    inertia that is not finite is found where it is used.
    """
    for i in range(len(mass)):
        heavy = (0.0 < mass[i] < math.inf or not has_mass[i]) and not inertia[i] < 0.0
        surface = 0.0 <= restitution[i] <= 1.0 and 0.0 <= friction[i] < math.inf
        spring = 0.0 <= stiffness[i] < math.inf and 0.0 <= damping[i] < math.inf
        drag = 0.0 <= linear_drag[i] < math.inf and 0.0 <= quadratic_drag[i] < math.inf
        if not (heavy and surface and spring and drag and 0.0 <= rest_length[i] < math.inf):
            return i
    return -1
