"""Parts of a substep: the stages of the integrator as parts of the compiled loop, or of Python."""

from collections.abc import Callable

from physicslab.ecs.sentences import sentence
from physicslab.kernels.solver import soft
from physicslab.state.state import State
from physicslab.stepping.accounting import acts_unbooked, run_measured
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.split_forces import SplitForces, SplitPart
from physicslab.stepping.stage_accounts import StageAccounts
from physicslab.systems.accelerate import AccelerateSystem
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.contact import ContactSystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.joint import JointSystem
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.sleep import SleepSystem
from physicslab.systems.system import ForceSystem, Stage, System

_BOOKED = sentence("way_booked")
_NOTHING_TOUCHES = sentence("system_by_system")

type Hook = Callable[[State, float], None]
"""Called with the length of the substep [s]."""

_COMPILED: dict[Stage, tuple[type[System], int]] = {
    Stage.DRIFT: (IntegrateSystem, soft.DRIFT), Stage.KICK: (AccelerateSystem, soft.KICK),
    Stage.BROAD_PHASE: (BroadPhaseSystem, soft.PAIRS), Stage.CONTACT: (ContactSystem, soft.FIND),
    Stage.IMPACT: (ResolveSystem, soft.IMPACTS), Stage.SOLVE: (ResolveSystem, soft.SOLVE),
    Stage.RELAX: (ResolveSystem, soft.RELAX),
}  # fmt: skip
"""The system whose work at a stage the loop does, and as which part of the substep."""


class SubstepParts:
    """The parts of a substep for the systems of a world, in the order of the integrator's stages.

    Engine systems are compiled. Where another acts, or a force in Python, its stage is handed over:
    all systems of that stage are called, in their order.

    Parameters
    ----------
    state : State
        Whose bodies.
    schedule : Schedule
        The systems.
    plan : StepPlan
        The stages, and what moves bodies on springs.

    Attributes
    ----------
    parts : list of int
        Kind of each part (:mod:`physicslab.kernels.solver.soft`).
    times : list of tuple
        For each its share of the substep, how far positions have drifted before it, and by how much the
        middle of the substep comes later than that of a kick [substeps].
    hooks : dict
        What Python does at a part.
    calls : dict
        How often a substep calls each system whose work the loop does.
    reasons : list of str
        Why the loop comes back in every substep, if it does.
    compiled : bool
        Whether the loop does what engine systems do.
    split : SplitForces, optional
        The flow of bodies on springs and in drag, if not kicks.
    forces : list of ForceSystem
        Those that kick bodies, or that contacts reckon with.
    accounts : StageAccounts
        The bookings of parts that Python does.
    edits : bool
        Whether Python at one of them may change anything: it runs systems of others, or forces in Python.
    uniform, packs : bool
        Whether no forces act but uniform ones that are compiled; or others, all of them compiled.
    """

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._schedule = schedule
        self.split: SplitForces | None = None
        if plan.split_forces is not None:
            self.split = SplitForces(state, schedule.forces, plan.split_forces, plan.split_steps)
        # A force that turns velocities is left to the flow: a contact has no speed to expect from it.
        turned = [f for f in schedule.forces if f.gyration(state) is not None] if self.split else []
        self.forces = [force for force in schedule.forces if force not in turned]
        flown = self.split is not None and any(part.springs is not None for part in self.split.parts)
        self.accounts = StageAccounts(state, self.forces, flown=flown, kicked=self.split is None)
        self._run: Callable[[Stage, State, float], None] = schedule.run
        # Where a system of one's own moves the bodies itself, its error is that of the method.
        if schedule.find(IntegrateSystem) is not None and any(map(acts_unbooked, schedule.running)):
            self._run = lambda stage, state, h: run_measured(stage, schedule, state, h)
        self.compiled = schedule.find(ContactSystem) is not None or flown
        self._sleeps = schedule.find(SleepSystem) is not None
        self.uniform, self.packs = True, False
        self.reasons: list[str] = []
        self.parts: list[int] = []
        self.times: list[tuple[float, float, float]] = []
        self.hooks: dict[int, Hook] = {}
        self.edits = False
        self.calls: dict[System, int] = {}
        self._drifted = self._kicked = 0.0
        if self.accounts.follows_way:
            self._hook(lambda state, h: self.accounts.begin_substep(state))
            self.reasons.append(_BOOKED)
        for stage, share in plan.stages.substep:
            reason = self._add(state, stage, share)
            if reason and reason not in self.reasons:
                self.reasons.append(reason)

    def _part(self, what: int, share: float = 0.0) -> None:
        """Add a part; what is kicked in ``share`` of a substep is seen from the middle of that."""
        later = 0.5 - self._kicked - 0.5 * share
        self.parts.append(what)
        self.times.append((share, self._drifted, later))

    def _hook(self, call: Hook, share: float = 0.0) -> None:
        """Add a part that is Python's."""
        self.hooks[len(self.parts)] = call
        self._part(soft.HOOK, share)

    def _add(self, state: State, stage: Stage, share: float) -> str:
        """Add a stage of the substep; return why some of it is Python's, if it is."""
        systems, split, accounts, reason = self._schedule.at(stage), self.split, self.accounts, ""
        if stage is Stage.RELAX and accounts.follows_way:
            self._hook(lambda state, h: accounts.book_way(state))
        if stage is Stage.FORCE:
            reason = self._add_forces(state, systems, share)
        elif stage is Stage.PREDICT:
            if self.compiled:
                self._part(soft.PREDICT, share)
            elif split is not None:
                self._hook(lambda state, h: split.predict(state, share * h))
        elif systems:
            flown = stage is Stage.IMPACT and split is not None and accounts.notes_forces
            if flown:
                self._hook(lambda state, h: accounts.begin_impacts(state))
            reason = self._add_systems(state, stage, systems, share)
            if flown:
                self._hook(lambda state, h: accounts.book_impacts(state))
        if stage is Stage.RELAX and accounts.notes_forces:
            self._hook(accounts.book_works)
        if split is not None and stage is Stage.DRIFT:
            flow = soft.SPRINGS
            for part in split.parts:
                self._hook(_drift(part, share), share)
                if part.springs is not None:
                    self.parts[-1] = flow
                    flow += 1
                else:
                    reason = reason or sentence("sub_integrated")
        self._drifted += share if stage is Stage.DRIFT else 0.0
        self._kicked += share if stage is Stage.KICK else 0.0
        return reason

    def _add_systems(self, state: State, stage: Stage, systems: tuple[System, ...], share: float) -> str:
        """Add the work of the systems of a stage."""
        kind, part = _COMPILED[stage]
        also = SleepSystem if stage is Stage.CONTACT else kind
        others = [system for system in systems if type(system) not in (kind, also, JointSystem)]
        accounts, run = self.accounts, self._run
        if self.compiled and not others:
            self._part(part, share)
            self._count(systems)
            if stage is Stage.IMPACT:
                self._part(soft.PAIRS_AGAIN, share)
                self._part(soft.LATER_IMPACTS, share)
            if stage is Stage.CONTACT and not state.event_driven:
                self._part(soft.WIDEN, share)
            if stage is Stage.CONTACT and self._sleeps:
                self._part(soft.WAKE, share)
            if stage is Stage.RELAX and accounts.moves_against:
                if self.packs and accounts.springs_alone:
                    self._part(soft.OVERLAP)
                else:
                    self.hooks[len(self.parts)] = lambda state, h: accounts.book_overlap(state)
                    self._part(soft.MOVED)
            return ""
        if stage is Stage.KICK:
            later = 0.5 - self._kicked - 0.5 * share
            self._hook(lambda state, h: accounts.book_kick(state, share * h, later * h))
        elif stage is Stage.RELAX:
            self._hook(lambda state, h: accounts.note_places(state))
        self._hook(lambda state, h: run(stage, state, share * h), share)
        self.edits = True
        if stage is Stage.RELAX:
            self._hook(lambda state, h: accounts.book_overlap(state))
        return sentence("acts_within_step", system=others[0].name) if others else _NOTHING_TOUCHES

    def _add_forces(self, state: State, systems: tuple[System, ...], share: float) -> str:
        """Add what adds up the forces."""
        first, forces = systems[:1], systems[1:]
        engine = all(type(system) is AccelerateSystem for system in first)
        if not systems or (engine and not forces and not state.has_forces):
            return ""
        plain = [force for force in forces if isinstance(force, ForceSystem)]
        same = engine and len(plain) == len(forces)
        plain = [force for force in plain if force in self.forces]
        self.uniform = same and all(
            force.is_engine and force.uniform_acceleration(state) is not None for force in plain
        )
        self.packs = same and not self.uniform and not self.accounts.notes_forces
        self.packs &= all(
            type(force).packs() and type(force).marked()[Stage.FORCE] == "add_packed" for force in plain
        )
        if self.compiled and (self.uniform or self.packs):
            self._part(soft.UNIFORM if self.uniform else soft.PACKED, share)
            self._count(systems)
            return ""
        accounts, schedule, run = self.accounts, self._schedule, self._run
        if accounts.notes_forces:
            self._hook(lambda state, h: schedule.run_forces(state, share * h, accounts.note_force), share)
            self._hook(lambda state, h: accounts.book_causes(state, share * h))
        else:
            self._hook(lambda state, h: run(Stage.FORCE, state, share * h), share)
        if not self.compiled:
            return _NOTHING_TOUCHES
        python = [one.name for one in forces if not (isinstance(one, ForceSystem) and one.packs())]
        self.edits |= bool(python)
        return sentence("computed_in_python", system=python[0]) if python else _BOOKED

    def _count(self, systems: tuple[System, ...]) -> None:
        """Count a call of each system in every substep."""
        for system in systems:
            self.calls[system] = self.calls.get(system, 0) + 1


def _drift(part: SplitPart, share: float) -> Hook:
    """Return what moves a part of the sub-integrated bodies for a share of the substep."""
    return lambda state, h: part.drift(state, share * h)
