"""Which springs are followed together: those that bodies couple, and those that need as many steps.

A few fast springs then make no others finer, and only those too fast for any steps have another method.
"""

from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Drag, Spring, Velocity
from physicslab.state.packed import spring_ends
from physicslab.state.state import State
from physicslab.stepping.forces import MAX_STEPS, WELL_RESOLVED, steps_needed
from physicslab.stepping.partition import join
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import ForceSystem

_RESOLVED = 0.26
"""omega h of the steps of spring_splitting. Its phase is then right to 4e-10, and what it adds to the error
of contacts within four substeps is 1e-5 of that (docs/decisions/springs-beside-contacts.md)."""
_DAMPED = 1.0
"""The same for rates of decay, whose exponential function a kick has."""
_FEW = 64
"""Bodies up to which ``MAX_STEPS`` take longer than ``implicit_midpoint``. Its equations of a net take as the
square of their number, so more bodies may take more steps: 4,363 of them 0.18 s a step, not 31."""
_MULTIPLIED = 8
"""How often x is multiplied where bounds on rates are made closer: for nets of all masses within 4 %."""
_BEYOND = MAX_STEPS
"""Kind of those that are too fast: the others are as many as the binary digits of their number of steps."""


class SpringGroup(NamedTuple):
    """Bodies that are followed together.

    Attributes
    ----------
    rows : bool array (rows,)
        The bodies, and what does not move that springs hold them to.
    steps : int
        Into how many steps half a substep is divided; 0 where they are too fast for any.
    rate : float
        The fastest rate at which they swing or are slowed [1/s].
    """

    rows: NDArray[np.bool_]
    steps: int
    rate: float


class Net(NamedTuple):
    """How n springs pull at rows, and are stretched by them. Rows have numbers of the middle and of turns.

    Attributes
    ----------
    ends : int array (4 n,)
        The number at A and at B of each spring, and that of the turn of A and of B.
    arm : float array (4 n,)
        How far each end goes by it: 1, and for turns the distance from the middle [m].
    gain : float array (2 rows,)
        Inverse masses [1/kg], and inverse inertias [1/(kg m^2)].
    """

    ends: NDArray[np.int64]
    arm: NDArray[np.float64]
    gain: NDArray[np.float64]

    @classmethod
    def of(cls, state: State, springs: NDArray[np.int64]) -> Self:
        """Return that of ``springs`` (3, n): rows of these, and of their ends."""
        (which, a, b), bodies, spring = springs, state.bodies, state.table(Spring)
        arms = [np.hypot(*spring[anchor][which].T) for anchor in ("anchor_a", "anchor_b")]
        rows = len(bodies.inverse_mass)
        ends, arm = np.concatenate((a, b, a + rows, b + rows)), np.concatenate((np.ones(2 * len(a)), *arms))
        return cls(ends, arm, np.concatenate((bodies.inverse_mass, bodies.inverse_inertia)))

    def stretched(self, moved: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return by how much springs (n,) are stretched at most by changes of rows (2 rows,)."""
        stretch: NDArray[np.float64] = (self.arm * moved[self.ends]).reshape(4, -1).sum(axis=0)
        return stretch

    def pulled(self, pull: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the sums of pulls (n,) and of torques on rows (2 rows,)."""
        return np.bincount(self.ends, self.arm * np.tile(pull, 4), len(self.gain))


def drag_per_mass(state: State, rows: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return how fast linear drag and damping slow rows (n,) [1/s]; 0 for what nothing moves."""
    inverse = state.bodies.inverse_mass[rows]
    damped = np.where(inverse > 0.0, state.physics.linear_damping, 0.0)
    return state.table(Drag)["linear"][rows] * inverse + damped


def spring_groups(state: State, forces: Sequence[ForceSystem], rows: NDArray[np.bool_]) -> list[SpringGroup]:
    """Return the groups of the bodies and ends among ``rows``, the slowest first.

    ``rows`` (rows,) tells which rows of the world these are. It depends on settings alone, on no place and no
    velocity. Bodies in drag alone take steps of their own: it matters only whether they are too fast for any.
    """
    moves = state.table(Velocity).present
    _, a, b = spring_ends(state)
    moving = np.flatnonzero(rows & moves)
    couples = np.stack((a, b), axis=1)[moves[a] & moves[b]]
    labels, of = np.unique(join(moving, couples.tolist()), return_inverse=True)
    bounds = [force.bounds(state) for force in forces if isinstance(force, SpringSystem)]
    swings, decays = (sum((one[i][moving] for one in bounds), np.zeros(len(moving))) for i in (0, 1))
    swing, damped, dragged = (
        _largest(rates, of, len(labels)) for rates in (swings, decays, drag_per_mass(state, moving))
    )
    set_of = np.full(len(moves), len(labels))
    set_of[moving] = of
    swing = np.sqrt(_closer(state, "stiffness", set_of, np.square(swing)))
    damped = _closer(state, "damping", set_of, damped)
    half, substeps = 0.5 * state.simulation.dt / state.simulation.substeps, state.simulation.substeps
    decay = damped + dragged
    rate = np.maximum(swing, decay)
    too_fast = [
        _is_too_fast(steps_needed(one, half, WELL_RESOLVED), 2 * substeps, coupled)
        for one, coupled in zip(rate.tolist(), np.bincount(of, minlength=len(labels)).tolist(), strict=True)
    ]
    sprung = np.zeros(len(labels), np.bool_)
    sprung[of[np.isin(moving, np.concatenate((a, b)))]] = True
    swing, decay, rate = (np.where(sprung, rates, 0.0) for rates in (swing, decay, rate))
    steps = [
        max(steps_needed(fast, half, _RESOLVED), steps_needed(slowed, half, _DAMPED))
        for fast, slowed in zip(swing.tolist(), decay.tolist(), strict=True)
    ]
    kinds: dict[int, list[int]] = {}
    for label, (needed, beyond) in enumerate(zip(steps, too_fast, strict=True)):
        kinds.setdefault(_BEYOND if beyond else (needed - 1).bit_length(), []).append(label)
    groups = []
    for kind, chosen in sorted(kinds.items()):
        part = np.zeros(len(moves), np.bool_)
        part[moving[np.isin(of, chosen)]] = True
        for end, other in ((a, b), (b, a)):
            part[end[part[other] & ~moves[end]]] = True
        most = 0 if kind == _BEYOND else max(steps[label] for label in chosen)
        groups.append(SpringGroup(part, most, float(rate[chosen].max())))
    return groups


def _is_too_fast(needed: int, flows: int, coupled: int) -> bool:
    """Whether ``coupled`` bodies whose flows, so many a step, need so many steps have another method."""
    return flows * needed > MAX_STEPS * max(1.0, coupled / _FEW) or 2 * needed > MAX_STEPS


def _closer(
    state: State, name: str, set_of: NDArray[np.int64], largest: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return closer bounds on the eigenvalues of sets (n,) than ``largest``.

    ``set_of`` (rows,) is n where a row is of none. A spring is stretched by at most what both of its ends
    move, and moves them by that times its stiffness or damping. None of these numbers is negative, so that no
    eigenvalue is above the largest ratio of A x to x, for any x > 0 (Collatz, 1942); multiplied by A, x comes
    closer to where all ratios are the largest eigenvalue. Rows have two numbers: of the middle, and of turns.
    """
    springs, rows = np.stack(spring_ends(state)), len(set_of)
    strength, net = state.table(Spring)[name][springs[0]], Net.of(state, springs)
    if not strength.any():
        return largest
    gain = np.where(np.tile(set_of, 2) < len(largest), net.gain, 0.0)
    sets, stretch, after = np.concatenate((set_of, set_of)), np.ones(len(strength)), np.zeros(2 * rows)
    with np.errstate(all="ignore"):  # an overflow is an unlimited rate: the bound stays as it is
        shrink = gain / np.append(largest, 1.0)[sets]
        for _ in range(_MULTIPLIED):
            before, after = after, shrink * net.pulled(strength * stretch)
            stretch = net.stretched(after)
        ratios = np.where(before > 0.0, after / before, np.where(after > 0.0, np.inf, 0.0))
        return np.fmin(largest, largest * _largest(ratios, sets, len(largest) + 1)[:-1])


def _largest(rates: NDArray[np.float64], of: NDArray[np.int64], count: int) -> NDArray[np.float64]:
    """Return the largest rate of each of ``count`` sets; ``of`` (n,) tells of which set each is."""
    largest = np.zeros(count)
    np.maximum.at(largest, of, rates)
    return largest
