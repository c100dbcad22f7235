"""Worlds whose motion has an exact solution, and how far a simulated world is from it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.integrators.exact import EXACT
from physicslab.ode.closed_form import NoClosedForm, closed_form
from physicslab.stepping.planning import why_not_smooth
from physicslab.world import World


@dataclass(frozen=True, slots=True)
class ReferenceSolution:
    """The exact motion of the bodies of a world.

    Attributes
    ----------
    what : str
        The solution in words.
    since : float
        The world's time [s] at which the solution begins.
    rows : int64 array (n,)
        The rows that move.
    positions_after : callable
        Takes a time [s] since then and returns the positions [m] (n, 2).
    """

    what: str
    since: float
    rows: NDArray[np.int64]
    positions_after: Callable[[float], NDArray[np.float64]]

    def error(self, world: World) -> float:
        """Return the largest distance of a body from where it should be [m]."""
        apart = world.table(Transform)["position"][self.rows] - self.positions_after(world.time - self.since)
        return float(np.hypot(apart[:, 0], apart[:, 1]).max(initial=0.0))


def reference_solution(world: World) -> ReferenceSolution | None:
    """Return the exact solution of a world's motion from now on, or ``None`` where there is none.

    There is one where :func:`~physicslab.ode.closed_form.closed_form` finds one.
    """
    world.synchronise()
    if why_not_smooth(world, world.schedule) is not None or not len(world.batch(Transform, Velocity)):
        return None
    try:
        form = closed_form(world, world.schedule.smooth_forces)
    except NoClosedForm:
        return None
    start = form.motion(world)
    world.compile(EXACT.kernels)

    def positions_after(t: float) -> NDArray[np.float64]:
        return form.after(start, t)[0]

    return ReferenceSolution(form.what, world.time, form.rows, positions_after)
