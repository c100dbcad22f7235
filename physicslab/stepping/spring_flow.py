"""Springs between the middles of bodies, beside contacts: packed for a flow of their own."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Drag, Mass, Spring, Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.ecs.vector import Vector2
from physicslab.integrators.spring_splitting import DRIFTS, KICKS
from physicslab.kernels import Plain
from physicslab.kernels.arguments import Springs
from physicslab.kernels.ode.spring_flow import HEAD, KNOWN, LONGEST, UNIFORM, WEIGHT
from physicslab.kernels.wide_layout import WIDE
from physicslab.state.packed import StateLayout, spring_ends, turned_anchors
from physicslab.state.state import State
from physicslab.stepping.kick_series import reach_of_terms, series_terms
from physicslab.stepping.spring_groups import SpringGroup, drag_per_mass
from physicslab.systems.drag import DragSystem
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import ForceSystem

_SHORTEST = 0.5
"""Share of its rest length below which a spring is not followed: across it, the pull changes faster."""
_SERIES = 1e-11
"""Share of a velocity that is left out of the series of a kick, which dampers and drag make one of."""


def why_no_spring_flow(state: State, forces: Sequence[ForceSystem]) -> str | None:
    """Return why the bodies on springs cannot be moved by a :class:`SpringFlow`, or ``None``."""
    physics, (_, a, b) = state.physics, spring_ends(state)
    for force in forces:
        if type(force) not in (SpringSystem, GravitySystem, DragSystem):
            return sentence("acts", system=force.name)
    if physics.gravity_mode == "planet":
        return sentence("planets")
    if physics.angular_damping:
        return sentence("motion_damped")
    if state.table(Drag)["quadratic"][np.concatenate((a, b))].any():
        return sentence("drag_held")
    return None


def _in_blocks(a: NDArray[np.int64], b: NDArray[np.int64], moving: int) -> NDArray[np.int64]:
    """Return the springs in blocks of eight (8 n,), -1 where there is none.

    No two of a block pull at one of the bodies that move, the first so many; what a hand or a given speed
    moves is among these, as the work on it is booked. Each goes into the first block with room for it.
    """
    free, within = [0] * moving, [set[int]() for _ in range(moving)]
    blocks: list[list[int]] = []
    full = 0  # all blocks before this one are
    for spring, ends in enumerate(zip(a.tolist(), b.tolist(), strict=True)):
        held = [end for end in ends if end < moving]
        block = max(full, *(free[end] for end in held)) if held else full
        while block < len(blocks) and (
            len(blocks[block]) == WIDE or any(block in within[end] for end in held)
        ):
            block += 1
        if block == len(blocks):
            blocks.append([])
        blocks[block].append(spring)
        while full < len(blocks) and len(blocks[full]) == WIDE:
            full += 1
        for end in held:
            within[end].add(block)
            while free[end] in within[end]:
                free[end] += 1
    return np.array([[*block, *[-1] * (WIDE - len(block))] for block in blocks], np.int64).ravel()


def _in_order(
    a: NDArray[np.int64], b: NDArray[np.int64], moving: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the springs (n,) between rows in blocks, and the rows that move in the order of these."""
    rows, ends = np.unique(np.stack((a, b)), return_inverse=True)
    moves = np.isin(rows, moving)
    place = np.where(moves, np.cumsum(moves) - 1, len(rows))[ends.reshape(2, -1)]
    order = _in_blocks(place[0], place[1], len(moving))
    taken, first = np.unique(place[:, order[order >= 0]].T.ravel(), return_index=True)
    return order, rows[moves][taken[np.argsort(first[taken < len(moving)])]]


class SpringFlow:
    """The springs and bodies of a world as :func:`flow_forces` takes them (kernels/ode/damped_flow.py).

    Parameters
    ----------
    state : State
        A state that :func:`why_no_spring_flow` has no reason against.
    forces : sequence of ForceSystem
        The forces that act.
    layout : StateLayout
        Layout of the bodies that are moved.
    group : SpringGroup
        How fast they are, and into how many steps of the method half a substep is divided.

    Attributes
    ----------
    arrays : Plain[Springs]
        All of it, which the flow goes on from.
    changes_with_speed : bool
        Whether drag slows a body faster if it is faster.
    """

    def __init__(
        self, state: State, forces: Sequence[ForceSystem], layout: StateLayout, group: SpringGroup
    ) -> None:
        self._forces, bodies = tuple(forces), state.bodies
        springs = np.stack(spring_ends(state))
        springs = springs[:, (layout.place[springs[1:]] >= 0).all(axis=0)]
        step = 0.5 * state.simulation.dt / state.simulation.substeps / group.steps
        kicks = step * np.append(KICKS, KICKS[-1] + KICKS[0])
        terms, terms_of_drag = series_terms(state, springs, kicks, _SERIES)
        fastest_first = np.argsort(-terms.max(axis=0), kind="stable")
        terms, (rows, a, b) = terms[:, fastest_first], springs[:, fastest_first]
        held = np.isin(layout.moving, np.concatenate((a, b)))
        drag, alone = state.table(Drag), layout.moving[~held]
        alone = np.pad(alone, (0, -len(alone) % WIDE))  # with the row of the world, which nothing moves
        order, moving = _in_order(a, b, layout.moving[held])
        self._moving, inverse = moving, bodies.inverse_mass[moving]
        (ends_a, ends_b), (p, spare) = self._ends(state, rows, a, b)
        turns = self._turns(state, rows, a, b)
        turned = bodies.inverse_inertia[moving] * turns
        used = order >= 0
        slots = [np.where(used, end[order], spare) for end in (ends_a, ends_b)]
        ends = np.concatenate((np.flatnonzero(inverse == 0.0), np.arange(len(moving), spare)))
        first = np.unique(np.stack(slots, axis=1), return_index=True)[1][ends] // 2
        ends, first = ends[np.argsort(first)], np.sort(first)
        spring = {
            name: np.where(used, state.table(Spring)[name][rows[order]], 0.0)
            for name in ("rest_length", "stiffness", "damping")
        }
        damped = WIDE * len(np.trim_zeros(spring["damping"].reshape(-1, WIDE).any(axis=1), "b"))
        parts = [np.zeros(HEAD + 6 * p), np.repeat(inverse, 2), np.zeros(4 * len(moving))]
        parts += [spring["rest_length"], spring["stiffness"], DRIFTS, KICKS]
        slowed = np.flatnonzero(drag_per_mass(state, moving) > 0.0)
        by_drag = np.full(-(-len(slowed) // WIDE) * WIDE, spare)
        by_drag[: len(slowed)] = slowed
        full = turns or damped > 0 or len(slowed) > 0
        if full:
            parts += [turned, np.zeros(-(-len(moving) // WIDE) * WIDE), np.tile((1.0, 0.0), p + WIDE)]
            parts += [np.zeros(5 * p), spring["damping"], np.zeros(4 * len(order))]
            parts += [*_arms(state, rows, order, slots, len(moving)), np.zeros(4 * len(order) + 6)]
        gain = np.zeros((2, len(by_drag)))
        gain[:, : len(slowed)] = drag_per_mass(state, moving)[slowed] / inverse[slowed], inverse[slowed]
        parts += [gain.ravel(), np.zeros(4 * len(by_drag))]
        by_mass = bodies.inverse_mass[alone]
        parts += [drag_per_mass(state, alone), drag["quadratic"][alone] * by_mass, _reciprocal(by_mass)]
        sizes = len(moving), p, len(order), len(DRIFTS), full, turns
        dampers = [2 * np.flatnonzero(used & np.isin(end, ends)) + at_b for at_b, end in enumerate(slots)]
        whole = [np.array((*sizes, len(alone), len(ends), len(by_drag), damped)), moving, *slots, ends]
        if full:
            of_slots, of_drag = np.where(used, terms[:, order], 0), terms_of_drag[:, moving[slowed]]
            whole += [reach_of_terms(of_slots, np.stack(slots), of_drag, by_drag, len(moving), first).ravel()]
        whole += [*(dampers if damped else ()), by_drag, alone]
        self.changes_with_speed = bool(drag["quadratic"][alone].any())
        self.arrays: Plain[Springs] = np.concatenate(parts), np.concatenate(whole).astype(np.int64)
        self.arrays[0][LONGEST : LONGEST + 2] = step, _SHORTEST
        self._places = p
        self._physics: object = None

    def _ends(
        self, state: State, rows: NDArray[np.int64], a: NDArray[np.int64], b: NDArray[np.int64]
    ) -> tuple[tuple[NDArray[np.int64], NDArray[np.int64]], tuple[int, int]]:
        """Return the places of both ends of each spring; how many places there are, and that of no spring."""
        m, moves = len(self._moving), state.table(Velocity).present
        number_of = np.full(len(moves), -1)
        number_of[self._moving] = np.arange(m)
        ends_a, ends_b = number_of[a], number_of[b]
        fixed_a, fixed_b = np.flatnonzero(~moves[a]), np.flatnonzero(~moves[b])
        ends_a[fixed_a] = m + np.arange(len(fixed_a))
        ends_b[fixed_b] = m + len(fixed_a) + np.arange(len(fixed_b))
        self._fixed = (a[fixed_a], rows[fixed_a], "anchor_a"), (b[fixed_b], rows[fixed_b], "anchor_b")
        spare = m + len(fixed_a) + len(fixed_b)
        return (ends_a, ends_b), (spare + 1, spare)

    def _turns(
        self, state: State, rows: NDArray[np.int64], a: NDArray[np.int64], b: NDArray[np.int64]
    ) -> bool:
        """Whether a spring holds what moves beside its middle."""
        spring, moves = state.table(Spring), state.table(Velocity).present
        return any(
            bool(spring[anchors][rows[moves[end]]].any())
            for end, anchors in ((a, "anchor_a"), (b, "anchor_b"))
        )

    def begin(self, state: State) -> None:
        """Take gravity, and where springs are attached to what does not move."""
        numbers, first, end = self.arrays[0], len(self._moving), HEAD + 2 * self._places
        if self._physics is not state.physics:
            uniform = (force.uniform_acceleration(state) for force in self._forces)
            gravity = sum((g for g in uniform if g is not None), start=Vector2(0.0, 0.0))
            pulled = state.bodies.inverse_mass[self._moving] > 0.0
            mass = np.where(pulled, state.table(Mass)["mass"][self._moving], 0.0)
            after = end + 4 * self._places + 2 * first  # behind velocities, pulls and inverse masses
            numbers[after : after + 2 * first] = np.outer(pulled, (gravity.x, gravity.y)).ravel()
            numbers[after + 2 * first : after + 4 * first] = np.outer(mass, (gravity.x, gravity.y)).ravel()
            numbers[WEIGHT : WEIGHT + 2] = np.array((gravity.x, gravity.y)) * float(mass.sum())
            numbers[UNIFORM : UNIFORM + 2] = gravity.x, gravity.y
            self._physics = state.physics
        transform, place = state.table(Transform), numbers[HEAD:end].reshape(-1, 2)
        for ends, springs, anchors in self._fixed:
            if len(ends):
                points = transform["position"][ends] + turned_anchors(state, ends, springs, anchors)
                held = place[first : first + len(ends)]
                if not np.array_equal(points, held):
                    held[:], numbers[KNOWN] = points, 0.0
                first += len(ends)


def put_together(flows: Sequence[SpringFlow]) -> Plain[Springs]:
    """Put the arrays of flows one behind the other, where each goes on with its part of them.

    Whole numbers begin with where in both arrays those of each flow begin and, last, end.
    """
    first = np.array((0, 2 * len(flows) + 2))
    starts = np.cumsum([first, *(tuple(map(len, flow.arrays)) for flow in flows)], axis=0)
    numbers = np.concatenate([np.zeros(0), *(flow.arrays[0] for flow in flows)])
    whole = np.concatenate([starts.ravel(), *(flow.arrays[1] for flow in flows)])
    for flow, (begin, low), (end, high) in zip(flows, starts[:-1], starts[1:], strict=True):
        flow.arrays = numbers[begin:end], whole[low:high]
    return numbers, whole


def _reciprocal(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the reciprocal of each number, and 0 of 0."""
    return np.divide(1.0, numbers, out=np.zeros_like(numbers), where=numbers > 0.0)


def _arms(
    state: State, rows: NDArray[np.int64], order: NDArray[np.int64], slots: Sequence[NDArray[np.int64]],
    moving: int,
) -> list[NDArray[np.float64]]:  # fmt: skip
    """Return where springs hold what moves, in its frame: x and y at A, and at B, of each slot."""
    spring = state.table(Spring)
    return [
        np.where((order >= 0) & (end < moving), spring[anchor][rows[order], way], 0.0)
        for end, anchor in zip(slots, ("anchor_a", "anchor_b"), strict=True)
        for way in (0, 1)
    ]
