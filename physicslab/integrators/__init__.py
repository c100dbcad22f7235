"""The methods that move bodies, one file each, in one explicit list."""

from physicslab.integrators.integrator import Integrator
from physicslab.integrators.leapfrog import LEAPFROG
from physicslab.integrators.symplectic_euler import SYMPLECTIC_EULER

__all__ = ["INTEGRATORS", "Integrator", "choose"]

INTEGRATORS: dict[str, Integrator] = {method.name: method for method in (SYMPLECTIC_EULER, LEAPFROG)}
"""Every method that can be asked for by name."""


def choose(name: str, *, can_touch: bool) -> tuple[Integrator, str]:
    """Return the method for ``name`` and why; ``"auto"`` chooses by what the scene holds.

    Raises
    ------
    LookupError
        If there is no such method yet; the message names those there are.
    """
    if name != "auto":
        if name not in INTEGRATORS:
            there_are = ", ".join(f'"{known}"' for known in ("auto", *INTEGRATORS))
            raise LookupError(f'integrator "{name}" is not there yet; there are {there_are}')
        return INTEGRATORS[name], "asked for"
    if can_touch:
        return LEAPFROG, "bodies can touch"
    return LEAPFROG, "nothing can touch; symplectic, second order, exact in uniform gravity"
