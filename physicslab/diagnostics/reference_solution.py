"""Worlds whose motion has an exact solution, and how far a simulated world is from it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform, Velocity
from physicslab.kernels.ode.propagate import propagate
from physicslab.ode.closed_form import NoClosedForm, closed_form
from physicslab.ode.kepler import propagate_kepler
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

    There is one for uniform gravity, linear drag and springs to fixed points (see
    :func:`~physicslab.ode.closed_form.closed_form`), and for two bodies that attract each other.
    """
    world.synchronise()
    if why_not_smooth(world, world.schedule) is not None or not len(world.batch(Transform, Velocity)):
        return None
    try:
        form = closed_form(world, world.schedule.smooth_forces)
    except NoClosedForm:
        return _two_bodies(world)
    x, v = form.motion(world)
    world.compile((propagate,))

    def positions_after(t: float) -> NDArray[np.float64]:
        positions = x.copy()
        form.advance(positions, v.copy(), t)
        return positions

    return ReferenceSolution(form.what, world.time, form.rows, positions_after)


def _two_bodies(world: World) -> ReferenceSolution | None:
    """Return Kepler's solution where two bodies attract each other and nothing else acts."""
    physics, forces = world.physics, [force.name for force in world.schedule.smooth_forces]
    rows = world.batch(Transform, Mass).rows
    moving = np.flatnonzero(world.table(Transform).present & world.table(Velocity).present)
    alone = forces == ["GravitySystem"] and physics.gravity_mode == "planet" and physics.softening == 0.0
    inverse = world.bodies.inverse_mass
    if not alone or physics.linear_damping or len(rows) != 2 or not np.isin(moving, rows).all():
        return None
    if not (inverse[moving] > 0.0).all() or physics.G <= 0.0:
        return None
    mass = np.where(inverse[rows] > 0.0, world.table(Mass)["mass"][rows], np.inf)
    pull = world.table(Mass)["mass"][rows]
    x = world.table(Transform)["position"][rows].copy()
    v = np.where(np.isin(rows, moving)[:, None], world.table(Velocity)["linear"][rows], 0.0)
    mu = physics.G * float(pull.sum() if np.isfinite(mass).all() else pull[np.isinf(mass)].sum())
    share = _shares(mass)
    if not (x[1] - x[0]).any():
        return None
    middle, drift = share @ x, share @ v

    def positions_after(t: float) -> NDArray[np.float64]:
        apart, _ = propagate_kepler(x[1] - x[0], v[1] - v[0], mu, t)
        both = middle + drift * t + np.stack((-share[1] * apart, share[0] * apart))
        positions: NDArray[np.float64] = both[np.searchsorted(rows, moving)]
        return positions

    return ReferenceSolution("two bodies on Kepler orbits", world.time, moving, positions_after)


def _shares(mass: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return each body's share of the mass of both; a body that is fixed counts for all of it."""
    if np.isinf(mass).any():
        return np.isinf(mass).astype(np.float64)
    shares: NDArray[np.float64] = mass / mass.sum()
    return shares
