"""A world as islands, each advanced by the best stepper for it in a world of its own.

Bodies that forces couple, or that may meet, are one island (:mod:`physicslab.stepping.partition`); what is
fixed, or moves at a given speed, belongs to every one. While there are several, each is a world that holds
the columns of its bodies, follows edits of the whole world, and writes back how its bodies move. So the bits
of an island are those that it has alone.
"""

import math
import weakref
from collections.abc import Sequence
from typing import Any

import numpy as np

from physicslab.components import Transform, Velocity
from physicslab.contacts.arguments import motion_of
from physicslab.contacts.kept import KeptContacts, carry_sleep
from physicslab.ecs.sentences import sentence
from physicslab.kernels.clock import time_after
from physicslab.state.masses import Diverged
from physicslab.state.remainders import Remainders
from physicslab.state.state import State
from physicslab.stepping import partition
from physicslab.stepping.accounting import kept_joints, restore_joints
from physicslab.stepping.breaks import Overloaded
from physicslab.stepping.island import (
    Island,
    KeptIsland,
    Make,
    Part,
    Rows,
    blank_world,
    copy_joints,
    in_order,
    join_logs,
    kept_of,
    make_island,
    rows_changed,
)
from physicslab.stepping.select import Steppers
from physicslab.stepping.stepper import Advance
from physicslab.stepping.undo import go_back
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import Stage

EXAMINED_S, FEW_EXAMINED = 2.0, 2
"""At each multiple of this time [s] it is looked whether an island has come apart; only at each so many of
these, if it has the best steppers already, as few bodies do."""
_NONE = np.zeros(0, np.int64)
_LATE, _NEVER = 1e-9, 1 << 60
"""Share of that time by which the clock, a sum of rounded steps, may be late; steps that are never made."""


class Islands:
    """The islands of one world: none while it is one, which its own steppers then advance.

    Parameters
    ----------
    schedule : Schedule
        The systems of the world.
    make : callable, optional
        Makes the world of an island, of systems, laws and settings. Without it a world is never divided.

    Attributes
    ----------
    members : tuple of Island
        The islands, in the order of their first bodies; empty while the world is one.
    why_one : str
        The reason, if it is.
    due, paused, joined : bool
        Whether all are to be found again before the next step; whether they are not, as a world that is being
        restored knows them; whether they have become one, for which steppers must be chosen.
    apart_until : float
        Until when [s] none can meet another; by it steps are made in calls, and accounts are rounded.
    """

    name: str = "islands"
    title: str = "Islands, each by a stepper of its own"
    leaps: bool = False
    keeps_balance: bool = False
    leaves_forces: bool = False
    samples: bool = True
    yields: bool = False

    def __init__(self, schedule: Schedule, make: Make | None) -> None:
        self._schedule, self._make = schedule, make
        self.members: tuple[Island, ...] = ()
        self.why_one: str = sentence("one_island")
        self.due, self.paused, self.joined = make is not None, False, False
        self._comes_apart, self.divisible, self.apart_until, self._left = False, True, -math.inf, b""
        self._examined = self._bodies = 0
        self._entities: Rows | None = None
        self._driven = _NONE
        self._kernels: tuple[Any, ...] = ()
        self._kernels_of: list[Steppers] = []

    # ---- as a stepper --------------------------------------------------------------------------------------

    @property
    def reason(self) -> str:
        """The reason for several steppers."""
        return sentence("islands", count=len(self.members))

    @property
    def kernels(self) -> tuple[Any, ...]:
        """Kernels that the steppers of all islands call."""
        steppers = [island.world.steppers for island in self.members]
        if steppers != self._kernels_of:
            mains = (island.world.steppers.main(island.state) for island in self.members)
            self._kernels = tuple(dict.fromkeys(kernel for stepper in mains for kernel in stepper.kernels))
            self._kernels_of = steppers
        return self._kernels

    def holds(self, state: State) -> bool:
        """Return True: edits are followed at each step."""
        return True

    def ready(self, state: State, h: float) -> bool:
        """Whether there are several islands."""
        return bool(self.members)

    def repeat(self, state: State, h: float, steps: int) -> Advance:
        """Make steps as in the last call."""
        return self.advance(state, h, steps)

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Make the steps, or those until all is one island.

        Where one fails, those before it are counted; islands are then found again.
        """
        opened = state.account.is_open
        if any(island.touches and island.state.joints.breakable for island in self.members):
            steps = 1  # where a joint breaks, the call is made again, which contacts are not the same after
        try:
            return self._advance(state, h, steps)
        except BaseException as error:
            self.forget(state)
            if steps == 1 or not isinstance(error, Diverged):
                raise
        go_back(state)
        return self._advance_singly(state, h, steps, opened)

    def _advance_singly(self, state: State, h: float, steps: int, opened: bool) -> Advance:
        """Make the steps one by one up to that which fails, with islands found again."""
        start, made = state.time, 0
        self.follow(state)
        try:
            while made < steps and self.members:
                state.account.is_open = opened
                done = self._advance(state, h, 1).steps
                made, state.time = made + done, time_after(state.time, h, done)
                state.checkpoint.take(motion_of(state), state.counts)
                state.account.begin_step()
                self.follow(state)
        except BaseException:
            self.forget(state)
            state.steps += made
            raise
        finally:
            state.time, state.account.is_open = start, opened
        return Advance(made)

    def _advance(self, state: State, h: float, steps: int) -> Advance:
        if self._schedule.observer is not None:  # it may have written at the beginning of the step
            self._take_edits(state)
        if h > state.simulation.dt:
            self._join_near(state, h)
        start, made, parts = state.time, 0, 1
        state.substeps = state.simulation.substeps
        smooth = [island for island in self.members if not island.touches]
        smooth.sort(key=lambda island: not island.state.joints.breakable)  # these may make fewer steps
        try:
            for island in smooth:
                wanted, steps = steps, island.go(state, start, h, steps, self._also(island))
                if steps < wanted and island is not smooth[0]:
                    raise Overloaded(steps + 1)
            while made < steps and self.members:
                touching = [island for island in self.members if island.touches]
                count = min(self.steps_ahead(state, h), steps - made) if touching else steps - made
                logged = [island.state.contacts.logged for island in touching]
                for island in touching:
                    island.go(state, state.time, h, count, self._also(island))
                parts = max(parts, *(island.state.step_divisions for island in self.members))
                join_logs(state, [island.state for island in touching], logged)
                made, state.time = made + count, time_after(state.time, h, count)
                self._write_back(state)
                if made < steps and not self._join_near(state, h):
                    self._examine(state)
        finally:
            state.time = start
        return Advance(made, parts)

    def steps_ahead(self, state: State, h: float) -> int:
        """Return how many steps of ``h`` seconds are made at most before islands are looked for again."""
        if not self._comes_apart:
            return _NEVER
        every = FEW_EXAMINED if not self.members and self._bodies <= partition.MAX_BODIES else 1
        until = (self._examined // every + 1) * every * EXAMINED_S - _LATE
        steps = math.ceil((until - state.time) / h)
        if self.members:
            apart = max(0.0, self.apart_until - state.time)
            steps = min(steps, math.floor(apart / h + 0.5))
        return max(1, steps)

    def _take_edits(self, state: State) -> None:
        """Let the islands follow what was changed in the whole world since the last step."""
        self._follow_rows(state)
        now = b"".join(state.entity_index.physical_columns())
        if now == self._left:
            return
        changed, self._left = rows_changed(state.entity_index.physical_columns(), self._left), now
        for island in self.members:
            island.take(state, changed)
        self.apart_until = -math.inf
        self._join_near(state, state.simulation.dt)

    def _also(self, island: Island) -> Rows:
        """Return the rows that no force moves, for the island that writes them for all: the first."""
        return self._driven if island is self.members[0] else _NONE

    def _write_back(self, state: State) -> None:
        """Write the motion of all islands, and of what no force moves, into the whole world."""
        motion = motion_of(state)
        for island in self.members:
            island.write_back(state, motion, self._also(island))
            copy_joints(island.state, state)
        state.sleep.count = int(np.count_nonzero(state.sleep.asleep))
        self._left = b"".join(state.entity_index.physical_columns())
        own, whole = weakref.ref(self), weakref.ref(state)

        def show() -> None:
            islands, of = own(), whole()
            if islands is not None and of is not None and islands.members:
                islands.contacts(of).show(of)

        state.contacts.source = show
        self._schedule.defer(self._settle)

    def _settle(self) -> None:
        """Let the islands note the costs that they have deferred."""
        for island in self.members:
            _ = island.world.schedule.timings

    def _follow_rows(self, state: State) -> None:
        """Find driven rows, and those of all islands where rows of the whole world are numbered again."""
        if self._entities is not state.entity_index.entities:
            self._entities = state.entity_index.entities
            for island in self.members:
                island.follow_rows(state)
        moves = state.table(Transform).present & state.table(Velocity).present
        self._driven = np.flatnonzero(moves & ~partition.movable_in(state))

    # ---- which they are ------------------------------------------------------------------------------------

    def follow(self, state: State) -> None:
        """Divide what has come apart, and join what is near; nothing is done twice in one state."""
        if self._make is None or self.paused:
            return
        if self.due:
            self.due, self._examined = False, _period(state)
            self._divide(state)
            return
        if self.members:
            self._take_edits(state)
        if not self._join_near(state, state.simulation.dt):
            self._examine(state)

    def are_settled(self, state: State, h: float) -> bool:
        """Whether it is not time to look for them before the next step of ``h`` seconds."""
        if self.due or (self.members and state.time >= self.apart_until - 0.5 * h):
            return False
        return not self._comes_apart or _period(state) == self._examined

    def goes_on(self, state: State) -> bool:
        """Whether there are several still."""
        return bool(self.members)

    def _divide(self, state: State) -> None:
        """Find all islands of a world that is one."""
        rows = self._survey(state)
        if self.why_one:
            return
        groups, self.why_one = partition.groups_of(state, self._schedule, rows)
        if len(groups) > 1:
            entities = state.entity_index.entities
            self.members = tuple(self._island(state, entities[group], [state]) for group in groups)
            self._begin(state)

    def _survey(self, state: State) -> Rows:
        """Find whether a world that is one may be divided; return the rows of its bodies."""
        self.apart_until, rows = -math.inf, np.flatnonzero(partition.movable_in(state))
        few, self._bodies = len(rows) < 2, len(rows)
        self.why_one = sentence("one_body") if few else partition.why_whole(state, self._schedule) or ""
        self._comes_apart = not self.why_one and self._schedule.runs(Stage.CONTACT)
        return rows

    def _begin(self, state: State) -> None:
        """Go on with islands that were found or joined."""
        self._entities = None
        self._follow_rows(state)
        self._comes_apart = any(island.touches for island in self.members)
        # The last digits of smooth motion depend on where it is divided.
        self.divisible, self.apart_until = all(island.touches for island in self.members), -math.inf
        self._write_back(state)

    def _examine(self, state: State) -> bool:
        """Divide islands that have come apart, where it is time to look; return whether any were."""
        period = _period(state)
        if period == self._examined or not self._comes_apart:
            return False
        self._examined = period
        few_too = period % FEW_EXAMINED == 0
        if not self.members:
            if few_too or self._bodies > partition.MAX_BODIES:
                self._divide(state)
            return bool(self.members)
        found = [
            partition.groups_of(island.state, island.world.schedule, island.own).groups
            if island.touches and (few_too or len(island.own) > partition.MAX_BODIES)
            else (island.own,)
            for island in self.members
        ]
        if not len(self.members) < sum(map(len, found)) <= partition.MAX_ISLANDS:
            return False
        members: list[Island] = []
        for island, groups in zip(self.members, found, strict=True):
            entities, sources = island.state.entity_index.entities, [island.state]
            apart = [entities[group] for group in groups] if len(groups) > 1 else []
            members += [self._island(state, part, sources) for part in apart] or [island]
        self.members = in_order(members)
        self._begin(state)
        return True

    def _join_near(self, state: State, h: float) -> bool:
        """Join islands whose bodies may meet soon, in steps of ``h`` seconds; return whether any were."""
        touching = [island for island in self.members if island.touches]
        if not touching or (state.time < self.apart_until - 0.5 * h and h <= state.simulation.dt):
            return False
        rows, stored = [island.shaped for island in touching], [island.stored() for island in touching]
        labels, steps = partition.meetings(state, rows, stored, h)
        self.apart_until = state.time + steps * h
        if (labels == np.arange(len(labels))).all():
            return False
        members = [island for island in self.members if not island.touches]
        all_one = not members and not labels.any()
        for label in dict.fromkeys(labels.tolist()):
            group = [touching[n] for n in np.flatnonzero(labels == label)]
            if len(group) > 1 and not all_one:
                entities = np.sort(np.concatenate([island.entities for island in group]))
                group = [self._island(state, entities, [island.state for island in group])]
            members += group
        self.members = in_order(members)
        if all_one:
            self.give_back(state)
            self.joined, self.why_one = True, sentence("came_near")
        else:
            self._begin(state)
        return True

    # ---- making and keeping them ---------------------------------------------------------------------------

    def _island(self, state: State, entities: Rows, sources: Sequence[State]) -> Island:
        """Return an island of some bodies, of which ``sources`` have contacts, sleep and remainders."""
        return make_island(state, self.blank(state), entities, sources)

    def blank(self, state: State) -> Part:
        """Return a world without bodies that can become an island of a state."""
        assert self._make is not None
        return blank_world(state, self._schedule, self._make)

    def adopt(self, state: State, members: Sequence[Island]) -> None:
        """Go on with islands that were made elsewhere; without any the world is one."""
        self.due, self.paused, self._examined = False, False, _period(state)
        self._survey(state)
        self.members = in_order(members)
        if self.members:
            self._begin(state)

    def keep(self, state: State) -> list[KeptIsland] | None:
        """Return what a file keeps of the islands; ``None`` where a loaded world would find the same."""
        kept = [kept_of(state, island) for island in self.members]
        return None if all(one.is_fresh(state) for one in kept) and self._are_found(state) else kept

    def hold(self, state: State) -> bool:
        """Whether a world made as this one is now would have the same islands, with the same steppers."""
        return self._are_found(state) and all(island.chooses_the_same() for island in self.members)

    def _are_found(self, state: State) -> bool:
        """Whether they are those that are found where bodies are."""
        return partition.islands_of(state, self._schedule) == [one.entities.tolist() for one in self.members]

    def restore(self, state: State, kept: Sequence[KeptIsland]) -> None:
        """Go on with the islands of a file, whose contacts, rests and remainders the state has."""
        bodies = np.array(sorted(body for one in kept for body in one.bodies), np.int64)
        if len(kept) and not np.array_equal(bodies, state.entity_index.entities[partition.movable_in(state)]):
            self.find_again()  # what moves was edited in the file
            return
        members = list[Island]()
        for one in kept:
            members.append(self._island(state, np.array(sorted(one.bodies), np.int64), [state]))
            one.give_back(members[-1])
        self.adopt(state, members)

    def contacts(self, state: State, *, rescaled: bool = True) -> KeptContacts:
        """Return the contacts of all islands.

        Their impulses are ``rescaled`` to act over one time, so that one rate makes forces of them.
        """
        kept = [KeptContacts.of(island.state.contacts) for island in self.members]
        return KeptContacts.joined(kept, state.contacts.counts, rescaled=rescaled)

    def give_back(self, state: State) -> None:
        """Let the world be one again, with all that its islands know."""
        if self.members:
            self.contacts(state).restore(state)
            for island in self.members:
                carry_sleep(island.state, state)
            parts = [island.state for island in self.members]
            restore_joints(state, [kept for part in parts for kept in kept_joints(part)], *parts)
            state.remainders = Remainders.joined([island.state.remainders for island in self.members])
        state.contacts.source, self.members, self._left = None, (), b""

    @property
    def divides(self) -> bool:
        """Whether the world may be divided: that of an island is not."""
        return self._make is not None

    def find_again(self) -> None:
        """Let all islands be found before the next step."""
        self.due = self._make is not None

    def forget(self, state: State) -> None:
        """Let the world be one, as it is; islands are found again before its next step."""
        state.contacts.source, self.members, self._left = None, (), b""
        self.find_again()


def _period(state: State) -> int:
    """Return how often it was time to look for islands."""
    return math.floor((state.time + _LATE) / EXAMINED_S) if math.isfinite(state.time) else 0
