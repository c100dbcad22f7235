"""Two bodies that attract each other, one of which may be fixed: their motion in closed form."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, GRAVITY, PX, PY
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.ode.kepler import kepler_change
from physicslab.state.state import State

type Motion = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Positions [m] and velocities [m/s] of bodies, (n, 2) each."""
_HEAD_ON = 1e-12
"""Half-width of an orbit, as a share of the distance, below which the two fall straight into each other."""


@dataclass(frozen=True, slots=True)
class TwoBodies:
    """Bodies on Kepler orbits about their common centre of mass, or about the one that is fixed.

    Attributes
    ----------
    pair : int64 array (2,)
        The rows that attract each other.
    moves : bool array (2,)
        Which of them move: n of the two.
    share : float64 array (2,)
        The share of each in the mass of both; a fixed body counts for all of it.
    mu : float
        G times the mass that attracts [m^3/s^2].
    what : str
        The motion that it covers, in words.
    """

    pair: NDArray[np.int64]
    moves: NDArray[np.bool_]
    share: NDArray[np.float64]
    mu: float
    what: str

    @property
    def rows(self) -> NDArray[np.int64]:
        """The rows that move (n,)."""
        return self.pair[self.moves]

    def motion(self, state: State) -> Motion:
        """Return copies of the present positions [m] and velocities [m/s] of both (2, 2)."""
        linear = state.table(Velocity)["linear"][self.pair]
        linear[~self.moves] = 0.0
        return state.table(Transform)["position"][self.pair], linear

    def change(self, start: Motion, t: float) -> Motion:
        """Return the changes of positions [m] and velocities [m/s] of what moves (n, 2) in a time t [s]."""
        position, velocity = start
        moved, gained = np.zeros(2), np.zeros(2)
        kepler_change(position[1] - position[0], velocity[1] - velocity[0], self.mu, t, moved, gained)
        arms = np.array((-self.share[1], self.share[0]))[self.moves, None]
        return self.share @ velocity * t + arms * moved, arms * gained

    def after(self, start: Motion, t: float) -> Motion:
        """Return positions [m] and velocities [m/s] of what moves (n, 2) a time t [s] after a start."""
        moved, gained = self.change(start, t)
        return start[0][self.moves] + moved, start[1][self.moves] + gained

    def given(self, state: State, t: float) -> dict[int, NDArray[np.float64]]:
        """Return what comes in by a body that is fixed within a time t [s].

        Momentum [N s], and angular momentum about the origin [N m s], in an account (4,): the line of the
        force always leads through the fixed body. Gravity stores the energy.
        """
        row = np.zeros(ACCOUNTS)
        if not self.moves.all():
            start, other = self.motion(state), int(self.moves[0])
            row[[PX, PY]] = self.change(start, t)[1][0] * state.table(Mass)["mass"][self.pair[1 - other]]
            row[ANGULAR_MOMENTUM] = start[0][other, 0] * row[PY] - start[0][other, 1] * row[PX]
        return {GRAVITY: row}


def two_bodies(state: State) -> TwoBodies | None:
    """Return how two bodies that attract each other move, where gravity alone acts on nothing but these.

    ``None`` where more bodies attract or move, where one is driven, where the pull is softened or damped, and
    where the two fall straight into each other.
    """
    physics, pair, speeds = state.physics, state.batch(Transform, Mass).rows, state.table(Velocity)
    if len(pair) != 2 or physics.softening or physics.linear_damping or physics.G <= 0.0:
        return None
    moves, mass = speeds.present[pair], state.table(Mass)["mass"][pair]
    count = np.count_nonzero(moves)
    if not count or count != np.count_nonzero(speeds.present):
        return None
    if 0.0 in state.bodies.inverse_mass[pair][moves]:
        return None
    one, other = mass.tolist()
    pulls, share = one + other, mass / (one + other)
    if count == 1:
        pulls, share = (other if moves[0] else one), (~moves).astype(np.float64)
    form = TwoBodies(pair, moves, share, physics.G * pulls, sentence("attraction_of_two"))
    position, velocity = form.motion(state)
    (x, y), (u, v) = (position[1] - position[0]).tolist(), (velocity[1] - velocity[0]).tolist()
    return form if abs(x * v - y * u) > math.sqrt(_HEAD_ON * form.mu) * math.sqrt(math.hypot(x, y)) else None
