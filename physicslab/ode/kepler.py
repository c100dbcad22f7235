"""Two bodies that attract each other, one of which may be fixed: their motion in closed form."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.kernels import direct_entry
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, GRAVITY, PX, PY
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.ode.kepler import move_two
from physicslab.state.state import State

type Motion = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Positions [m] and velocities [m/s] of bodies, (n, 2) each."""
_HEAD_ON = 1e-16
"""Half-width of an orbit, as a share of the distance, below which the two fall straight into each other: the
closest passage is then half of this."""
_LARGEST = 1e60
"""The largest distance, speed and attraction of which powers have all digits, and one over the smallest."""


@dataclass(frozen=True, slots=True)
class TwoBodies:
    """Bodies on Kepler orbits about their common centre of mass, or about the one that is fixed.

    Attributes
    ----------
    pair : int64 array (2,)
        The rows that attract each other.
    moves : slice
        Which of them move: n of the two.
    mass, weight : float64 arrays (2,)
        Their masses [kg]; and how much of these attracts, 0 of one that moves about a fixed one.
    constant : float
        G [m^3/(kg s^2)].
    what : str
        The motion that it covers, in words.
    """

    pair: NDArray[np.int64]
    moves: slice
    mass: NDArray[np.float64]
    weight: NDArray[np.float64]
    constant: float
    what: str

    @property
    def rows(self) -> NDArray[np.int64]:
        """The rows that move (n,)."""
        return self.pair[self.moves]

    def motion(self, state: State) -> Motion:
        """Return the present positions [m] and velocities [m/s] of both, and remainders of zero (4, 2)."""
        places, rates = np.zeros((4, 2)), np.zeros((4, 2))
        places[:2] = state.table(Transform)["position"].take(self.pair, axis=0)
        rates[self.moves] = state.table(Velocity)["linear"].take(self.rows, axis=0)
        return places, rates

    def follow(self, motion: Motion, spans: NDArray[np.float64]) -> Motion:
        """Move on both and their remainders (4, 2), in place, through spans of time [s] (k,).

        Return positions [m] and velocities [m/s] of what moves after each (k, n, 2).
        """
        q, v = np.zeros((len(spans), 4)), np.zeros((len(spans), 4))
        direct_entry(move_two)(*motion, self.weight, self.constant, spans, q, v)
        return q.reshape(-1, 2, 2)[:, self.moves], v.reshape(-1, 2, 2)[:, self.moves]

    def after(self, start: Motion, t: float) -> Motion:
        """Return positions [m] and velocities [m/s] of what moves (n, 2) a time t [s] after a start."""
        (position,), (velocity,) = self.follow((start[0].copy(), start[1].copy()), np.array((t,)))
        return position, velocity

    def given(self, start: Motion, t: float) -> dict[int, NDArray[np.float64]]:
        """Return what comes in by a body that is fixed within a time t [s] from a start.

        Momentum [N s], and angular momentum about the origin [N m s], in an account (4,): the line of the
        force always leads through the fixed body. Gravity stores the energy.
        """
        row = np.zeros(ACCOUNTS)
        if len(self.rows) == 1:
            fixed = 1 - self.moves.start
            gained = self.after(start, t)[1][0] - start[1][1 - fixed]
            row[[PX, PY]] = gained * self.mass[1 - fixed]
            row[ANGULAR_MOMENTUM] = start[0][fixed, 0] * row[PY] - start[0][fixed, 1] * row[PX]
        return {GRAVITY: row}

    def holds(self, motion: Motion) -> bool:
        """Whether the two do not fall straight into each other from there, and numbers are of usual size."""
        (x, y), (u, v) = ((of[1] - of[0]).tolist() for of in motion)
        mu, r, speed = self.constant * float(self.weight.sum()), math.hypot(x, y), math.hypot(u, v)
        if not (min(mu, r) > 1.0 / _LARGEST and max(mu, r, speed) < _LARGEST):
            return False
        leaves = x * u + y * v >= 0.0 and speed * speed * r >= 2.0 * mu
        return leaves or abs(x * v - y * u) > math.sqrt(_HEAD_ON * mu * r)


def two_bodies(state: State) -> TwoBodies | None:
    """Return how two bodies that attract each other move, where gravity alone acts on nothing but these.

    ``None`` where more bodies attract or move, where one is driven, where the pull is softened or damped, and
    where the two fall straight into each other.
    """
    physics, pair, speeds = state.physics, state.batch(Transform, Mass).rows, state.table(Velocity)
    if len(pair) != 2 or physics.softening or physics.linear_damping or physics.G <= 0.0:
        return None
    moves, mass = speeds.present[pair], state.table(Mass)["mass"][pair]
    count = int(np.count_nonzero(moves))
    if not count or count != np.count_nonzero(speeds.present):
        return None
    if 0.0 in state.bodies.inverse_mass[pair][moves]:
        return None
    first = int(moves.argmax())
    weight = np.where(moves, 0.0, mass) if count == 1 else mass
    which = slice(first, first + count)
    form = TwoBodies(pair, which, mass, weight, physics.G, sentence("attraction_of_two"))
    return form if form.holds(form.motion(state)) else None
