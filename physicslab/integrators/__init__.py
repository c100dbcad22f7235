"""The methods that move bodies, one file each, in one explicit list."""

from physicslab.integrators.blanes_moan import BLANES_MOAN
from physicslab.integrators.dop853 import DOP853
from physicslab.integrators.exact import EXACT
from physicslab.integrators.implicit_midpoint import IMPLICIT_MIDPOINT
from physicslab.integrators.integrator import Exhausted, Integrator, StepTooSmall
from physicslab.integrators.leapfrog import LEAPFROG
from physicslab.integrators.rk4 import RK4
from physicslab.integrators.spring_splitting import SPRING_SPLITTING
from physicslab.integrators.symplectic_euler import SYMPLECTIC_EULER

__all__ = ["INTEGRATORS", "SPLIT_METHODS", "Exhausted", "Integrator", "StepTooSmall"]

INTEGRATORS: dict[str, Integrator] = {
    method.name: method
    for method in (
        SYMPLECTIC_EULER,
        LEAPFROG,
        RK4,
        BLANES_MOAN,
        DOP853,
        EXACT,
        IMPLICIT_MIDPOINT,
    )
}  # fmt: skip
"""Every method that can be chosen by name."""

SPLIT_METHODS: dict[str, Integrator] = {**INTEGRATORS, SPRING_SPLITTING.name: SPRING_SPLITTING}
"""Every method that may move bodies between contacts; spring_splitting is chosen by ``auto`` alone."""
