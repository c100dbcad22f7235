"""Which bodies are near each other."""

import math

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Layer, Shape, Transform, Velocity
from physicslab.components.shape import CHAIN
from physicslab.contacts.arguments import do_stage, motion_of, shapes_of, speculative_margin
from physicslab.contacts.near_pairs import partition
from physicslab.ecs.sentences import sentence
from physicslab.kernels import direct_entry
from physicslab.kernels.broad import chains, filters, grid, leaving, near_pairs
from physicslab.kernels.broad.fat_boxes import HIT_SHARE, fat_boxes
from physicslab.kernels.broad.leaving import AHEAD, BODIES, CELL, SMALLS, FatBoxes, blank_boxes
from physicslab.kernels.geometry.shapes import OWN
from physicslab.kernels.solver import soft
from physicslab.kernels.wide import slots
from physicslab.state.shapes import REGISTER
from physicslab.state.solid import filters_of, is_any_apart, may_touch, solid_rows
from physicslab.state.state import State
from physicslab.systems.system import Stage, System, at

_MAX_LOOKAHEAD = 8.0
"""Largest factor by which the margin of a moving body is increased, for substeps as configured."""
_LOOKAHEAD_OF_FEW, _MANY = 2.0, 256
"""Factor for fewer bodies than that: listing their pairs takes as long as calling the loop once more, surplus
pairs take little. Of 17 random scenes of 11 to 260 bodies 14 take .79 to .97 of the time with it and with
margins that do not shrink with substeps, 3 take .99 to 1.13; five of 286 to 843 take .90 to 1.47."""
_FEW, _FURTHER, _FURTHER_APART = 64, 2.0, 4.0
"""Number of bodies up to which all pairs are listed again, for that takes no longer than to find the new
ones; and by which factor they are listed further ahead, where joints or layers keep some apart by the second.
Ten scenes of 15 to 45 joined bodies take .80 to .97 of the time with it, 48 others .97 on average."""


def nothing_to_touch(state: State) -> str | None:
    """Return why no two things in this world can ever meet, or ``None`` if they can."""
    shapes, moving = len(solid_rows(state)), len(state.batch(Shape, Transform, Velocity))
    if not shapes:
        return sentence("no_shape")
    if not moving:
        return sentence("shapes_stay")
    if state.physics.bounds is not None:
        return None
    if shapes == 1:
        return sentence("one_shape")
    if is_any_apart(state) and shapes <= _FEW and not _may_any_touch(state):
        return sentence("joined_or_in_layers" if len(state.batch(Layer)) else "all_joined")
    return None


def _may_any_touch(state: State) -> bool:
    """Whether any two bodies may meet that no joint and no layer keeps from touching each other."""
    shaped = solid_rows(state)
    i, j = np.triu_indices(len(shaped), 1)
    a, b = shaped[i], shaped[j]
    moves = state.table(Velocity).present
    return bool((may_touch(state, a, b) & (moves[a] | moves[b])).any())


def _lookahead(state: State) -> tuple[float, float]:
    """Return for how long [s] boxes are made ahead, and for how many substeps more.

    Among few or many sleeping bodies a new list takes longer than the surplus pairs of an old one.
    """
    few = len(state.entity_index) < _MANY
    least = _LOOKAHEAD_OF_FEW if few else 1.0
    if len(state.entity_index) <= _FEW:
        least *= _FURTHER_APART if is_any_apart(state) else _FURTHER
    awake = int(np.count_nonzero(state.bodies.awake_inverse_mass))
    ahead = min(max(least, state.sleep.count / max(1, awake)), _MAX_LOOKAHEAD)
    simulation = state.simulation
    return (ahead * simulation.dt / simulation.substeps, 0.0) if few else (0.0, ahead)


def _sparse(state: State) -> bool:
    """Whether records are few beside bodies: a list of all pairs is then cheap, and is to hold for long."""
    return bool(leaving.SPARSE * state.contacts.recorded < len(state.entity_index))


class BroadPhaseSystem(System):
    """Keeps the list of near pairs: those whose fat boxes overlap, found with a uniform grid.

    The list is valid, and nothing is done, until a body leaves the fat box that was made for it. Then its
    box grows, and its new pairs are added, by the compiled loop of substeps; when many have left, all boxes
    and pairs are found again.

    Attributes
    ----------
    fat : tuple of arrays
        The fat boxes, which bodies have left theirs since all were made, and the index to find their
        neighbours, as :class:`~physicslab.kernels.broad.leaving.FatBoxes` names them.
    bounds : float64 array (4,)
        Bounds of the world: xmin, ymin, xmax, ymax [m]; zero without any.
    crowded : bool
        Whether pairs were left out, since too many bodies are on one spot.
    """

    engine = True
    kernels = (
        fat_boxes, leaving.index_bodies, grid.find_pairs,
        near_pairs.partition, near_pairs.carry_over, near_pairs.sort_scalar, slots.list_scalar,
    )  # fmt: skip

    def __init__(self) -> None:
        self.fat = blank_boxes(0)
        self.crowded = False
        self._couples: NDArray[np.uint32] = np.zeros(512, np.uint32)
        self._pairs: NDArray[np.int64] = np.zeros((512, 3), np.int64)
        self.bounds: NDArray[np.float64] = np.zeros(4)
        self.chains: NDArray[np.int64] = np.zeros(0, np.int64)
        self._listed_for: tuple[object, ...] = ()
        self._filtered: tuple[object, int] = None, -1

    def attach(self, state: State) -> None:
        """Mark the list as stale where bodies came, went or changed, or contacts are found in another way.

        The other laws do not change what is near what.
        """
        ways = state.event_driven, state.rigid_contacts
        listed_for = (state.entity_index.revision, state.physics.bounds, state.simulation, *ways)
        if listed_for != self._listed_for:
            self._listed_for = listed_for
            state.contacts.stale = True
        self.bounds[:] = state.physics.bounds or 0.0
        self.chains = np.flatnonzero(state.table(Shape)["kind"] == CHAIN)
        if len(self.chains):
            state.compile((chains.add_chains,))

    def why_left_out(self, state: State) -> str | None:
        """Needed where two things could ever meet."""
        reason = nothing_to_touch(state)
        if reason is not None:
            state.contacts.clear()
        return reason

    def follow_rows(self, state: State) -> None:
        """Make room for every row; where the list is stale, invalidate every fat box."""
        rows = len(state.entity_index)
        if len(self.fat[1]) != rows:
            self.fat, state.contacts.stale = blank_boxes(rows), True
        if state.contacts.stale:
            self.fat[0][3] = np.nan

    @at(Stage.BROAD_PHASE)
    def search(self, state: State, h: float) -> None:
        """Update the list of near pairs, where it is not valid any more."""
        self.follow_rows(state)
        while do_stage(state, soft.PAIRS, h, fat=self.fat)[0] == soft.PAIRS_STALE:
            if not self.index_bodies(state):
                self.list_pairs(state, h)
                break

    def index_bodies(self, state: State) -> bool:
        """Sort bodies by their cells, where those that leave their fat boxes can have their new pairs listed.

        The compiled loop does that itself with the index. Returns False where all pairs are to be listed
        again: it was not possible with the index that there is, or none is worth it.
        """
        fat, vertices = FatBoxes(*self.fat), state.bodies.shapes.vertices
        if len(vertices) <= _FEW or _sparse(state) or self.crowded or state.contacts.stale:
            return False
        if len(self.chains) or fat.counts[SMALLS] >= 0:  # the search for new pairs knows nothing of chains
            return False
        fat.counts[SMALLS], fat.counts[BODIES], fat.spans[CELL] = direct_entry(leaving.index_bodies)(
            fat.boxes, vertices, fat.first, fat.body, fat.home_x, fat.home_y
        )
        fat.spans[AHEAD:] = _lookahead(state)
        return True

    def list_pairs(self, state: State, h: float) -> None:
        """List all near pairs again, for which there is no index then."""
        filtered = state.joints.apart, state.entity_index.revision
        if self._filtered[0] is not filtered[0] or self._filtered[1] != filtered[1]:
            self._filtered, self.fat = filtered, (*self.fat[:9], *filters_of(state))
        awake, margin = state.bodies.awake_inverse_mass, speculative_margin(state, h)
        seconds, substeps = _lookahead(state)
        ahead = seconds + substeps * h
        share, fat = math.inf if _sparse(state) else HIT_SHARE, FatBoxes(*self.fat)
        make = direct_entry(fat_boxes)
        make(motion_of(state), shapes_of(state), awake, fat.ways, fat.boxes, ahead, share, margin)
        inverse_mass = state.bodies.inverse_mass
        bounded = state.physics.bounds is not None
        vertices = state.bodies.shapes.vertices
        if len(self.chains):
            vertices = vertices.copy()
            vertices[self.chains] = 0
        found, walls = self._count_pairs(vertices, inverse_mass, bounded)
        if len(self.chains):
            walls = self._add_chains(state, found, walls)
        if is_any_apart(state):
            state.compile((filters.keep_touching,))
            found = direct_entry(filters.keep_touching)(*self.fat[9:], self._couples, found)
        fat.moved[:] = False
        fat.counts[:] = 0, -1, 0
        partition(state, self._couples, found, self._pairs, walls, fat.ways)

    def _add_chains(self, state: State, found: int, walls: int) -> int:
        """Add the pairs of bodies and segments of chains to those of the bounds; return how many both are."""
        shape, (position, angle, _, _) = state.table(Shape), motion_of(state)
        solid = self.chains[state.bodies.shapes.vertices[self.chains] > 0]
        segments = REGISTER.kinds[OWN + shape["vertices"][solid], 0] - 1
        while True:
            count = chains.add_chains(
                solid, segments, position, angle, shapes_of(state), self.fat[1], self.fat[0],
                state.bodies.inverse_mass, self._pairs, walls,
            )  # fmt: skip
            if found + count <= len(self._pairs):
                break
            larger = np.zeros((2 * (found + count), 3), np.int64)
            larger[:walls] = self._pairs[:walls]
            self._pairs = larger
        if is_any_apart(state):
            added = self._pairs[walls:count]
            added = added[may_touch(state, added[:, 0], added[:, 1])]
            self._pairs[walls : walls + len(added)] = added
            count = walls + len(added)
        return count

    def _count_pairs(
        self, vertices: NDArray[np.int64], inverse_mass: NDArray[np.float64], bounded: bool
    ) -> tuple[int, int]:
        """Find the pairs, with more room where it is too little; return how many of bodies, of walls."""
        while True:
            found, walls, self.crowded = direct_entry(grid.find_pairs)(
                self.fat[1],
                self.fat[0],
                vertices,
                inverse_mass,
                bounded,
                self.bounds,
                self._pairs,
                self._couples,
            )
            if 2 * found <= len(self._couples) and found + walls <= len(self._pairs):
                return found, walls
            self._couples = np.zeros(4 * found, np.uint32)
            self._pairs = np.zeros((2 * (found + walls), 3), np.int64)
