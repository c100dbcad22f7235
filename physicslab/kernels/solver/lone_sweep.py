"""A sweep over scalar contacts as a kernel of its own.

Ten boxes that lie on each other take nine tenths of the time for which a step is interpreted there, and it is
compiled in a twentieth of the time of :func:`physicslab.kernels.solver.soft.advance`.
"""

from physicslab.kernels import Plain, kernel
from physicslab.kernels.arguments import Motion
from physicslab.kernels.constraint.stirred import Stirred
from physicslab.kernels.python_fallback import native_for
from physicslab.kernels.solver.constraints import Constraints
from physicslab.kernels.solver.sweep import sweep
from physicslab.kernels.wide.solve import SoftConstraint


@native_for(sweep)
@kernel
def sweep_contacts(
    constraints: Plain[Constraints], motion: Plain[Motion], soft: Plain[SoftConstraint],
    stirred: Plain[Stirred], booked: bool,
) -> tuple[bool, float, float]:  # fmt: skip
    """Return what :func:`physicslab.kernels.solver.sweep.sweep` does."""
    return sweep(Constraints(*constraints), Motion(*motion), SoftConstraint(*soft), Stirred(*stirred), booked)
