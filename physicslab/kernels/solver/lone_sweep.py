"""A sweep over scalar contacts as a kernel of its own.

Ten boxes that lie on each other take nine tenths of the time for which a step is interpreted there, and it is
compiled in a twentieth of the time of :func:`physicslab.kernels.solver.soft.advance`.
"""

from physicslab.kernels import Rows, kernel
from physicslab.kernels.arguments import Contacts, Inverse, InverseTuple, Motion, MotionTuple
from physicslab.kernels.python_fallback import native_for
from physicslab.kernels.records import Manifolds, Points
from physicslab.kernels.solver.sweep import sweep
from physicslab.kernels.wide.solve import SoftConstraint


@native_for(sweep)
@kernel
def sweep_contacts(
    contacts: tuple[Manifolds, Points, Rows, int], motion: MotionTuple, inverse: InverseTuple,
    soft: tuple[float, float, float, float, float], backward: bool, booked: bool,
) -> tuple[bool, float, float]:  # fmt: skip
    """Return what :func:`physicslab.kernels.solver.sweep.sweep` does."""
    return sweep(
        Contacts(*contacts), Motion(*motion), Inverse(*inverse), SoftConstraint(*soft), backward, booked
    )
