"""Springs and dampers between bodies, or a body and a fixed point."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.ecs.vector import rotated
from physicslab.kernels import accounts, direct_entry
from physicslab.kernels.forces import budget, packed_forces, springs
from physicslab.kernels.forces.resistance import damper_resistance
from physicslab.state.packed import PackedForce, StateLayout, spring_ends, turned_anchors
from physicslab.state.state import State
from physicslab.systems.joint import remove_lost
from physicslab.systems.system import ROUNDING, ForceSystem

_NOTHING = 1e-9
"""Share of its rest length below which a spring has no direction."""


class SpringSystem(ForceSystem):
    """Pulls the ends of every Spring together by F = k (length - rest_length) + c (rate of lengthening)."""

    needs = (Spring,)
    account = accounts.SPRINGS
    kernels = (packed_forces.springs,)
    potential = "spring"
    turns = True

    def __init__(self) -> None:
        self._rows = self._a = self._b = np.zeros(0, np.int64)

    def attach(self, state: State) -> None:
        """Find the bodies at both ends of every spring; a spring whose body was removed goes with it.

        Raises
        ------
        InvalidValue
            If an end never was an entity, or is one without a Transform.
        """
        self._rows, self._a, self._b = _, a, b = spring_ends(state)
        remove_lost(state, Spring, a, b)

    def turned(self, state: State) -> NDArray[np.int64]:
        """Return the rows that springs hold away from their middle."""
        spring = state.table(Spring)
        off_a, off_b = (spring[anchor][self._rows].any(axis=1) for anchor in ("anchor_a", "anchor_b"))
        return np.concatenate((self._a[off_a], self._b[off_b]))

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return the pull for compiled integrators."""
        spring, angle = state.table(Spring), state.table(Transform)["angle"]
        takes_part = (layout.place[self._a] >= 0) & (layout.place[self._b] >= 0)
        rows, ends = self._rows[takes_part], (self._a[takes_part], self._b[takes_part])
        places = []
        for end, anchors in zip(ends, ("anchor_a", "anchor_b"), strict=True):
            turns = spring[anchors][rows].any(axis=1)  # the middle of a body stays where it is
            places += [layout.place[end], np.where(turns, layout.turn[end], -1)]
        indices, books = self._booked(state, ends, np.stack(places, axis=1))
        parameters = np.empty((len(rows), 7))
        for column, end, anchors in ((0, ends[0], "anchor_a"), (2, ends[1], "anchor_b")):
            steady = np.where(layout.turn[end] < 0, angle[end], 0.0)
            parameters[:, column : column + 2] = rotated(spring[anchors][rows], steady)
        for column, name in enumerate(("rest_length", "stiffness", "damping"), 4):
            parameters[:, column] = spring[name][rows]
        resistance = damper_resistance if self.depends_on_velocity(state) else None
        return PackedForce(
            packed_forces.springs, parameters.ravel(), indices, resistance, work_slots=books,
            dissipation_slot=4 + 4 * len(rows) if resistance else None,
        )  # fmt: skip

    def _booked(
        self, state: State, ends: tuple[NDArray[np.int64], NDArray[np.int64]], places: NDArray[np.int64]
    ) -> tuple[NDArray[np.int64], tuple[tuple[int, int], ...]]:
        """Return the indices of the kernel, for ``ends`` A and B at ``places`` (n, 4), and what it books."""
        bodies, n, moved = state.bodies, len(places), np.zeros(len(places), np.int64)
        goes, driven = state.table(Velocity).present, False
        for end, turn, moves, turns in (
            (ends[0], places[:, 1], budget.A_MOVES, budget.A_TURNS),
            (ends[1], places[:, 3], budget.B_MOVES, budget.B_TURNS),
        ):
            shifted = bodies.inverse_mass[end] > 0.0
            turned = (turn < 0) | (bodies.inverse_inertia[end] > 0.0)
            moved |= np.where(shifted, moves, 0) | np.where(turned, turns, 0)
            driven |= bool((goes[end] & ~(shifted & turned)).any())
        found = []
        if (moved != budget.ALL_MOVED).any():
            found.append((accounts.SPRINGS, 1 + 4 * n))
        if driven:
            found.append((accounts.HAND, 3 + 4 * n))
        if self.depends_on_velocity(state):
            found.append((accounts.DAMPING, 2 + 4 * n))
        opened = np.flatnonzero(moved != budget.ALL_MOVED)
        open_ends = np.stack((opened, moved[opened]), axis=1)
        behind = (-1, -1, -1, -1, len(opened))
        return np.concatenate(([n], places.ravel(), behind, open_ends.ravel())), tuple(found)

    def inputs(self, state: State, layout: StateLayout) -> bytes:
        """Return every number of every spring, and the angles of anchors that no force turns."""
        spring, angle, found = state.table(Spring), state.table(Transform)["angle"], [self.settings(state)]
        for end, anchors in ((self._a, "anchor_a"), (self._b, "anchor_b")):
            if spring[anchors].any():
                steady = layout.turn[end] < 0
                off = spring[anchors][self._rows[steady]].any(axis=1)
                found.append(angle[end[steady][off]].tobytes())
        return b"".join(found)

    def rates(self, state: State) -> NDArray[np.float64]:
        """Return for each row a bound on its fastest oscillation or decay [rad/s]."""
        return np.maximum(*self.bounds(state))

    def bounds(self, state: State) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return for each row a bound on its fastest oscillation [rad/s], and on its fastest decay [1/s].

        The stiffnesses of a body's springs add up, weighted with the masses at both ends; no eigenvalue of
        the whole is larger than these sums (Gershgorin).
        """
        spring, bodies = state.table(Spring), state.bodies
        stiff, damped = (np.zeros(len(bodies.inverse_mass)) for _ in range(2))
        # An overflow is an unlimited rate, and so is infinity times zero inertia.
        with np.errstate(over="ignore", invalid="ignore"):
            for end, anchors in ((self._a, "anchor_a"), (self._b, "anchor_b")):
                arm2 = np.square(spring[anchors][self._rows]).sum(axis=1)
                give = bodies.inverse_mass[end] + arm2 * bodies.inverse_inertia[end]
                np.add.at(stiff, end, 2.0 * spring["stiffness"][self._rows] * give)
                np.add.at(damped, end, 2.0 * spring["damping"][self._rows] * give)
            stiff, damped = (np.where(np.isnan(bound), np.inf, bound) for bound in (stiff, damped))
        fixed = (bodies.inverse_mass[self._a] == 0.0) | (bodies.inverse_mass[self._b] == 0.0)
        share = 0.5 if fixed.all() else 1.0  # no pair of bodies moves against each other
        return np.sqrt(share * stiff), share * damped

    def rounding_floor(self, state: State) -> float:
        """Return that of a spring as long as its rest length, or as far from the origin as its fixed end."""
        bodies, spring, position = state.bodies, state.table(Spring), state.table(Transform)["position"]
        give, reach = bodies.inverse_mass[self._a] + bodies.inverse_mass[self._b], spring["rest_length"]
        reach = reach[self._rows]
        for end in (self._a, self._b):
            fixed = bodies.inverse_mass[end] == 0.0
            reach = np.maximum(reach, np.where(fixed, np.hypot(*position[end].T), 0.0))
        return ROUNDING * float((spring["stiffness"][self._rows] * give * reach).max(initial=0.0))

    def why_singular(self, state: State) -> str | None:
        """Return a reason if the energy could compress a spring to length zero, where it has no direction.

        Estimated with a margin of four: kinetic energy, energy of springs, a fall by twice a spring's length.
        """
        spring, bodies = state.table(Spring), state.bodies
        rest, stiffness = spring["rest_length"][self._rows], spring["stiffness"][self._rows]
        rigid = (rest > 0.0) & (stiffness > 0.0)
        if not rigid.any() or len(self.directionless(state)):
            return None  # or it is singular already, and no step leads away from there but a fixed one
        free = bodies.inverse_mass > 0.0
        mass, linear = state.table(Mass)["mass"][free], state.table(Velocity)["linear"][free]
        available = 0.5 * float(mass @ np.square(linear).sum(axis=1)) + self.potential_energy(state)
        if state.physics.gravity_mode == "linear":
            available += 2.0 * float(mass.sum()) * state.physics.gravity.magnitude * float(rest.max())
        enough = available > 0.25 * float((0.5 * stiffness * rest * rest)[rigid].min())
        return sentence("compressed_to_nothing") if enough else None

    def directionless(self, state: State) -> NDArray[np.int64]:
        """Return the rows (n,) of springs that push, but whose ends are in one place."""
        rest, stiffness = (state.table(Spring)[name][self._rows] for name in ("rest_length", "stiffness"))
        return self._rows[(rest > 0.0) & (stiffness > 0.0) & (self._lengths(state) < _NOTHING * rest)]

    def _lengths(self, state: State) -> NDArray[np.float64]:
        """Return how long every spring is [m]."""
        position, apart = state.table(Transform)["position"], np.zeros((len(self._rows), 2))
        for end, anchors, sign in ((self._a, "anchor_a", -1.0), (self._b, "anchor_b", 1.0)):
            apart += sign * (position[end] + turned_anchors(state, end, self._rows, anchors))
        return np.hypot(apart[:, 0], apart[:, 1])

    def settings(self, state: State) -> bytes:
        """Return every number of every spring."""
        spring = state.table(Spring)
        columns = ("anchor_a", "anchor_b", "rest_length", "stiffness", "damping")
        return b"".join(spring[column].tobytes() for column in columns)

    def couples(self, state: State) -> NDArray[np.int64]:
        """Return the bodies at both ends of every spring."""
        return np.stack((self._a, self._b), axis=1)

    def depends_on_velocity(self, state: State) -> bool:
        """Whether a spring has a damper."""
        return bool((state.table(Spring)["damping"][self._rows] > 0.0).any())

    def potential_energy(self, state: State) -> float:
        """Return the sum of k (length - rest_length)^2 / 2 [J]."""
        return spring_energy(state, self._rows, self._a, self._b)


def spring_energy(state: State, rows: NDArray[np.int64], a: NDArray[np.int64], b: NDArray[np.int64]) -> float:
    """Return the energy [J] of springs of some rows (n,), whose ends A and B are at bodies of others."""
    spring, transform = state.table(Spring), state.table(Transform)
    state.compile((springs.spring_potential,))
    stored: float = direct_entry(springs.spring_potential)(
        transform["position"], transform["angle"], rows, a, b,
        spring["anchor_a"], spring["anchor_b"], spring["rest_length"], spring["stiffness"],
    )  # fmt: skip
    return stored
