"""The order in which rows of joints are solved, and which of them at once."""

import heapq
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels.joints.blocks import ENTRY, FIRST, GIVES_WAY, GROUP, NODE, NODE_STATE, OF_NODE
from physicslab.kernels.joints.terms import HOLD, LIMIT, MOTOR
from physicslab.state.joint_rows import Row

_MOST, _OF_SINGLE = 100_000, 3
"""How many updates of a factorisation a block may take, each of 16 multiplications: more takes a millisecond
in each substep. Beyond, its joints are solved one by one, and give way as springs do. How many times as many
where each joint is one row, as a rod: an update is then one multiplication."""

type _Table = NDArray[np.int64]


class Blocks(NamedTuple):
    """Nodes of one or two rows, in blocks that are solved at once (:mod:`physicslab.kernels.joints.blocks`).

    Attributes
    ----------
    nodes : int64 array (k + 1, NODE)
        In the order in which they are eliminated; the last one ends the lists of the one before.
    terms : int64 array (m, OF_NODE)
        Those of each node.
    body : int64 array (e,)
        The body of each end of a node: those that move, each once.
    beside : int64 array (e,)
        How many joints hold that body.
    entries : int64 array (l + 1, ENTRY)
        Where the factor of the matrix is not zero below the diagonal, column by column.
    shared : int64 array (s, 2)
        Pairs of ends of an entry, of its row's node and of its column's, which are of one body.
    targets : int64 array (u,)
        The entry that changes by each two entries of a column, as that is eliminated.
    groups : int64 array (b + 1, GROUP)
        Where the nodes of each block begin, whether its rows give way, whether each node is one row.
    bounded : int64 array (p,)
        Nodes of limits and motors, block by block.
    """

    nodes: _Table
    terms: _Table
    body: _Table
    beside: _Table
    entries: _Table
    shared: _Table
    targets: _Table
    groups: _Table
    bounded: _Table

    @property
    def gives_way(self) -> NDArray[np.bool_]:
        """Whether the rows of each node (k,) give way, as too many joints hold the same bodies."""
        return np.repeat(self.groups[:-1, GIVES_WAY] != 0, np.diff(self.groups[:, FIRST]))


class _Node(NamedTuple):
    """A node: its rows, one or two, and the moving bodies that they act on, in the order of their numbers."""

    rows: Sequence[int]
    bodies: Sequence[int]


def order_rows(rows: Sequence[Row], joints: Sequence[range], moves: Sequence[bool]) -> Blocks:
    """Return the blocks for rows, which are those of ``joints``; ``moves`` tells which bodies may move.

    Joints that share a moving body are one block, in an order in which little has to be computed. A block
    that would cost too much is one for each joint instead, whose rows give way.
    """
    nodes, motors = _nodes_of(joints, rows, moves)
    held = [sorted({body for node in own for body in node.bodies}) for own in nodes]
    holding = np.array([body for own in held for body in own], np.int64)
    made = _Blocks(rows, np.bincount(holding, minlength=len(moves)))
    for group in _groups(held):
        sizes = [len(own) for own in nodes]
        most = _MOST * (_OF_SINGLE if _is_single(group, nodes) else 1)
        order = _eliminated(group, held, sizes, motors, most)
        order = order or _eliminated(group, held, sizes, range(0), most)
        if order is not None:
            made.add(order, nodes)
            continue
        for joint in group:
            made.add([(joint, [])], nodes, gives_way=True)
    return made.blocks()


def _nodes_of(
    joints: Sequence[range], rows: Sequence[Row], moves: Sequence[bool]
) -> tuple[list[list[_Node]], range]:
    """Return the nodes of each joint, those of limits first, which are mostly passed over; then each motor's.

    Also which are the motors': a row that depends on those before it gives way.
    """

    def node(own: Sequence[int]) -> _Node:
        ends = {end for row in own for term in rows[row].terms for end in term[1:3] if moves[end]}
        return _Node(own, sorted(ends))

    holding, motors = list[list[_Node]](), list[list[_Node]]()
    for joint in joints:
        held = [row for row in joint if rows[row].role == HOLD]
        limits = [[row] for row in joint if rows[row].role == LIMIT]
        pairs = [held[n : n + 2] for n in range(0, len(held), 2)]
        holding.append([node(own) for own in limits + pairs])
        motors += [[node([row])] for row in joint if rows[row].role == MOTOR]
    return holding + motors, range(len(holding), len(holding) + len(motors))


def _is_single(group: Iterable[int], nodes: Sequence[Sequence[_Node]]) -> bool:
    """Whether each node of some joints has one row."""
    return all(len(node.rows) == 1 for joint in group for node in nodes[joint])


def _groups(held: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return the joints that hold on to each other, by the bodies that each holds."""
    of: dict[int, list[int]] = {}
    for joint, own in enumerate(held):
        for body in own:
            of.setdefault(body, []).append(joint)
    groups: list[list[int]] = []
    seen: set[int] = set()
    reached: set[int] = set()
    for first in range(len(held)):
        if first in seen:
            continue
        seen.add(first)
        group = [first]
        for joint in group:
            for body in held[joint]:
                if body not in reached:
                    reached.add(body)
                    group += [other for other in of[body] if other not in seen]
                    seen.update(of[body])
        groups.append(sorted(group))
    return groups


def _eliminated(
    group: Sequence[int], held: Sequence[Sequence[int]], sizes: Sequence[int], motors: range, most: int
) -> list[tuple[int, list[int]]] | None:
    """Return the joints of a group as they are eliminated, each with the later ones that it then acts on.

    The joint with the fewest neighbours is next (Tinney & Walker, Proc. IEEE 55, 1967, 1801): trees from
    their tips on; ``motors`` come last. ``None`` where that would take more than ``most`` updates.
    """
    of: dict[int, set[int]] = {}
    for joint in group:
        for body in held[joint]:
            of.setdefault(body, set()).add(joint)
    if any(len(beside) ** 3 > 6 * most for beside in of.values()):  # at a body all act on each other
        return None
    beside = {joint: set[int]().union(*(of[body] for body in held[joint])) - {joint} for joint in group}
    waiting = [(joint in motors, len(others), joint) for joint, others in beside.items()]
    heapq.heapify(waiting)
    order: list[tuple[int, list[int]]] = []
    left, cost = set(group), 0
    while left:
        _, size, joint = heapq.heappop(waiting)
        if joint not in left or size != len(beside[joint]):
            continue
        left.discard(joint)
        later = beside.pop(joint)
        width = sizes[joint] + sum(sizes[other] for other in later)
        cost += sizes[joint] * width * width // 2
        if cost > most:
            return None
        order.append((joint, sorted(later)))
        for other in order[-1][1]:
            beside[other] |= later
            beside[other] -= {joint, other}
            heapq.heappush(waiting, (other in motors, len(beside[other]), other))
    return order


class _Blocks:
    """Blocks as they are added one after the other."""

    def __init__(self, rows: Sequence[Row], beside: _Table) -> None:
        self._rows, self._beside = rows, beside
        # The second terms stand behind all first ones, in the order of rows.
        two = [row for row in range(len(rows)) if len(rows[row].terms) > 1]
        self._second = {row: len(rows) + n for n, row in enumerate(two)}
        self._nodes: list[tuple[int, ...]] = []
        self._terms: list[tuple[int, ...]] = []
        self._body: list[int] = []
        self._entries: list[tuple[int, int]] = []
        self._shared: list[tuple[int, int]] = []
        self._targets: list[int] = []
        self._groups: list[tuple[int, ...]] = []
        self._bounded: list[int] = []

    def add(
        self,
        order: Sequence[tuple[int, Sequence[int]]],
        nodes: Sequence[Sequence[_Node]],
        *,
        gives_way: bool = False,
    ) -> None:
        """Add a block of joints in an order, each with those that are later in it and that it acts on."""
        first, place, ends = len(self._nodes), dict[int, range](), dict[int, dict[int, int]]()
        single = _is_single((joint for joint, _ in order), nodes)
        self._groups.append((first, len(self._bounded), int(gives_way), int(single)))
        for joint, _ in order:
            place[joint] = range(first, first + len(nodes[joint]))
            first = place[joint].stop
        every = [node for joint, _ in order for node in nodes[joint]]
        begin, body = self._groups[-1][0], len(self._body)
        for k, node in enumerate(every, begin):
            ends[k] = {end: body + n for n, end in enumerate(node.bodies)}
            body += len(node.bodies)
        entry: dict[tuple[int, int], int] = {}
        columns: list[tuple[int, list[int]]] = []
        for joint, later in order:
            after = sorted(k for other in later for k in place[other])
            columns += [(k, [*range(k + 1, place[joint].stop), *after]) for k in place[joint]]
        for k, below in columns:
            for i in below:
                entry[i, k] = len(self._entries) + len(entry)
        for (k, below), node in zip(columns, every, strict=True):
            self._add_node(node, ends[k])
            if self._rows[node.rows[0]].role != HOLD:
                self._bounded.append(k)
            for i in below:
                self._entries.append((i, len(self._shared)))
                self._shared += [(ends[i][end], ends[k][end]) for end in node.bodies if end in ends[i]]
            self._targets += [entry[i, j] for n, i in enumerate(below) for j in below[:n]]

    def _counts(self) -> tuple[int, ...]:
        return len(self._terms), len(self._body), len(self._entries), len(self._targets)

    def _add_node(self, node: _Node, ends: dict[int, int]) -> None:
        """Add a node, whose entries and targets come next."""
        self._nodes.append((node.rows[0], len(node.rows), *self._counts()))
        self._body += node.bodies
        for place, row in enumerate(node.rows):
            numbers = [row, self._second[row]] if row in self._second else [row]
            for number, term in zip(numbers, self._rows[row].terms, strict=True):
                self._terms.append((number, place, ends.get(term.a, -1), ends.get(term.b, -1)))

    def blocks(self) -> Blocks:
        """Return all that were added."""
        body = np.array(self._body, np.int64)
        self._nodes.append((len(self._rows), 0, *self._counts()))
        self._entries.append((0, len(self._shared)))
        self._groups.append((len(self._nodes) - 1, len(self._bounded), 0, 0))
        return Blocks(
            _table(self._nodes, NODE), _table(self._terms, OF_NODE), body, self._beside[body],
            _table(self._entries, ENTRY), _table(self._shared, 2), np.array(self._targets, np.int64),
            _table(self._groups, GROUP), np.array(self._bounded, np.int64),
        )  # fmt: skip


def _table(lines: Sequence[Sequence[int]], width: int) -> _Table:
    return np.array(lines, np.int64).reshape(-1, width)


def buffers_of(blocks: Blocks) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return arrays for the gradients of ends (e, 6), the states of nodes (k, NODE_STATE), entries (l, 8)."""
    return (
        np.zeros((len(blocks.body), 6)),
        np.zeros((len(blocks.nodes) - 1, NODE_STATE)),
        np.zeros((len(blocks.entries) - 1, 8)),
    )


NO_BLOCKS = order_rows((), (), ())
"""Those without joints."""
