"""The interface of a system: its work, at its stages, and its declarations."""

import math
from collections.abc import Callable, Mapping
from enum import Enum
from functools import cache
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.ecs.component import Component
from physicslab.ecs.sentences import listed, sentence
from physicslab.ecs.vector import Vector2
from physicslab.kernels.accounts import FIELDS
from physicslab.kernels.forces.force_calls import add_forces
from physicslab.languages.sentence import Sentence
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State

ROUNDING = 2.0**-50
"""How far a force of several roundings may be off, as a share of its parts."""


class Stage(Enum):
    """The moments at which systems run. An integrator's ``substep`` puts those of a substep in order."""

    INPUT = "once a frame: input of the user"
    PREPARE = "once a step: values that hold for all of it"
    FORCE = "forces and torques are added up"
    KICK = "forces change velocities"
    DRIFT = "velocities change positions"
    BROAD_PHASE = "near pairs of bodies are found"
    CONTACT = "contact points are found"
    IMPACT = "approaching bodies bounce"
    PREDICT = "velocities of sub-integrated bodies are predicted for the contacts, and restored"
    SOLVE = "contact impulses keep bodies apart, correcting overlap"
    RELAX = "contact impulses again, so that the correction leaves no velocity behind"
    FINISH = "once a step: records of it"
    RENDER = "once a frame: the world is drawn"
    HUD = "once a frame: the figures are drawn over it"

    __hash__ = object.__hash__  # Enum's own hashes the name, in Python, at every look-up


OF_FRAMES = frozenset({Stage.INPUT, Stage.RENDER, Stage.HUD})
"""The stages that belong to frames, and not to steps."""
AROUND = frozenset({Stage.PREPARE, Stage.FINISH})
"""The stages around a step: a system that is called there looks at every step."""


def at[M: Callable[..., None]](stage: Stage) -> Callable[[M], M]:
    """Mark a system's method to be called as ``method(state, h)`` at ``stage``.

    ``h`` is the time [s] that the call covers: the substep, a part of it, or the step.

    Raises
    ------
    TypeError
        If ``stage`` is no Stage.
    """
    if not isinstance(stage, Stage):
        raise TypeError(f"@at takes a Stage, got {stage!r}: write @at(Stage.FORCE), or another of them")

    def mark(method: M) -> M:
        method.stage = stage  # type: ignore[attr-defined]
        return method

    return mark


class System:
    """One thing that happens to a world, and when.

    To write one:

    1. Subclass ``System`` (or :class:`ForceSystem`) in a file of ``physicslab/systems``.
    2. Name the components it works on in ``needs``. While no entity has all of them, the system is left out.
    3. Mark a method ``@at(Stage. ...)``. It gets the world's :class:`~physicslab.state.state.State` and the
       time that the call covers, and reads and writes columns: ``state.batch(Velocity, Mass).rows`` are
       row numbers, ``state.table(Velocity)["linear"]`` a column.
    4. Return in :meth:`why_left_out` the reason if a world does not need it otherwise; reports show it.
    5. Add it to the list in ``physicslab/systems/standard.py``, in the order in which it runs within its
       stage.

    A system that is called at ``PREPARE`` or ``FINISH`` looks at every step, so steps are made one by one;
    one that is called within a step keeps the compiled loop of whole steps from running. Both are read off
    its marks, and shown as the stepper's reason.

    Attributes
    ----------
    needs : tuple of component types
        An entity must have all of them for the system to have work.
    kernels : tuple of kernels
        Kernels that the system calls at its stages; compiled before the first call.
    engine : bool
        Whether compiled steppers do this very class's work themselves. It is not inherited: a subclass may
        do other work.
    sampled : bool
        Whether it only reads the motion, and takes the steps that one call made from ``state.samples``: then
        a run may make many steps in a call although the system is called at ``FINISH``.
    """

    needs: ClassVar[tuple[type[Any], ...]] = ()
    kernels: ClassVar[tuple[Any, ...]] = ()
    engine: ClassVar[bool] = False
    sampled: ClassVar[bool] = False

    @property
    def name(self) -> str:
        """The name under which cost and reasons are reported."""
        return type(self).__name__

    def attach(self, state: State) -> None:
        """Look at the world's new content; called whenever it changed, before :meth:`why_left_out`."""

    def why_left_out(self, state: State) -> str | None:
        """Return why this scene does not need the system, or ``None`` if it does."""
        if self.needs and not len(state.batch(*self.needs)):
            absent = [needed for needed in self.needs if not len(state.batch(needed))] or self.needs
            return _absent(tuple(needed.__name__ for needed in absent))
        return None

    def kernels_for(self, state: State) -> tuple[Any, ...]:
        """Return which of ``kernels`` the world needs as it is; what it does not need is not waited for."""
        return self.kernels

    def fresh(self) -> "System":
        """Return another one with the same settings, for a world of its own."""
        return type(self)()

    def keep(self) -> tuple[NDArray[Any], ...]:
        """Return copies of the arrays that the system goes on from, if it keeps any from step to step.

        So a world can go back to a moment (:mod:`physicslab.history`). The columns of components are
        kept in any case.
        """
        return ()

    def restore(self, kept: tuple[NDArray[Any], ...]) -> None:
        """Go on from what :meth:`keep` returned, in its shapes; the entities are those of then."""

    @property
    def is_engine(self) -> bool:
        """Whether compiled steppers do this system's work themselves."""
        return bool(vars(type(self)).get("engine", False))

    @classmethod
    def acts_within_step(cls) -> bool:
        """Whether the system is called within a step, and not around it or once a frame alone."""
        return not cls.marked().keys() <= OF_FRAMES | AROUND

    @classmethod
    def observes(cls) -> bool:
        """Whether it is called around every step, or, as none of the engine's, at the impacts of each."""
        return not AROUND.isdisjoint(cls.marked()) or (not cls.engine and Stage.IMPACT in cls.marked())

    @classmethod
    def leaves_motion(cls) -> bool:
        """Whether it acts in no step, but around it or at its impacts."""
        return cls.marked().keys() <= OF_FRAMES | AROUND | {Stage.IMPACT}

    @classmethod
    @cache  # the steppers of a world are chosen again whenever its laws are edited
    def marked(cls) -> Mapping[Stage, str]:
        """Return the stages of the system, each with the name of its method.

        A method that overrides a marked one keeps its stage. Two at one stage have no order, and are refused.
        """
        found: dict[Stage, str] = {}
        for base in reversed(cls.__mro__):
            for name, attribute in vars(base).items():
                stage = getattr(attribute, "stage", None)
                if not isinstance(stage, Stage):
                    continue
                if found.setdefault(stage, name) != name:
                    both = f"{found[stage]} and {name}"
                    raise TypeError(f"{cls.__name__}: {both} are both at {stage}; let one call the other")
        return found


@cache
def _absent(components: tuple[str, ...]) -> Sentence:
    """Return the reason for a system whose components no entity has; a small world has a dozen of them."""
    return sentence("no_component", components=listed("and", components))


class ForceSystem(System):
    """A system that adds to ``state.bodies.force`` [N] and ``.torque`` [N m] at ``Stage.FORCE``.

    A force is given in one of two ways. In Python: a method marked ``@at(Stage.FORCE)`` adds to both columns.
    Compiled: :meth:`packed` names a kernel and the numbers that it reads; every integrator calls it, and so
    does the contact step, so the law is written once.

    It must also return the energy that its force stores, so that the total stays right when a force is added.
    """

    columns: ClassVar[tuple[tuple[type[Component], str], ...]] = ()
    """Fields of what it acts on that it depends on, apart from the state of motion: :meth:`settings`, and
    :meth:`inputs`, are then made of them."""
    account: ClassVar[int] = FIELDS
    """The account of the momentum that the force gives, and of its work where it stores no energy
    (:mod:`physicslab.kernels.accounts`)."""
    potential: ClassVar[str | None] = None
    """The name under which the energy is reported; ``None`` for a force that stores none."""
    rounding: ClassVar[float] = 0.0
    """The finest tolerance of steps that ``auto`` takes: below it, the force's own rounding shows."""
    bends: ClassVar[bool] = False
    """Whether it is continuous where it is not smooth (:meth:`why_singular`): fixed steps miss little."""
    turns: ClassVar[bool] = False
    """Whether a compiled force adds torques, at ``layout.turn``; one in Python may add them in any case."""
    couples_nothing: ClassVar[bool] = False
    """Whether each body feels it by itself, so that it couples no motions (:meth:`couples`)."""
    is_everywhere: ClassVar[bool] = False
    """Whether it is the same where everything that moves is moved by the same distance."""

    def potential_energy(self, state: State) -> float:
        """Return the energy stored [J]; zero for a force that stores none."""
        return 0.0

    def strongest_rate(self, state: State) -> float:
        """Return the largest of :meth:`rates` [rad/s]; 0 where there are none."""
        rates = self.rates(state)
        return 0.0 if rates is None else float(rates.max(initial=0.0))

    def rounding_floor(self, state: State) -> float:
        """Return how far rounding puts off the acceleration of what it holds at rest [m/s^2, rad/s^2].

        By a force that others may cancel, or by its parts that cancel each other.
        """
        return 0.0

    def summation(self, state: State) -> str:
        """Return how the force is summed, where its accuracy depends on that; shown beside the figures."""
        return ""

    def rates(self, state: State) -> NDArray[np.float64] | None:
        """Return for each row the fastest angular frequency [rad/s] or rate of decay [1/s] it is given.

        ``None`` for a force that is the same for all bodies. Where it is not, and contacts act as well, the
        bodies it acts on are moved by a method that follows it, instead of a kick a substep.
        """
        return None

    def depends_on_velocity(self, state: State) -> bool:
        """Return whether the force depends on velocities, as drag does, for the choice of a method.

        A force in Python is taken to, unless it overrides this: a method that is made for positions alone
        would then lose its order. One that is packed is taken not to.
        """
        return not type(self).packs()

    def depends_on_time(self, state: State) -> bool:
        """Return whether the force depends on the time; one in Python is taken to, unless it overrides this.

        Resting bodies may then begin to move by themselves.
        """
        return not type(self).packs()

    def gyration(self, state: State) -> NDArray[np.float64] | None:
        """Return for each row the rate [rad/s] at which the force turns its velocity clockwise.

        For a force that does nothing else, as a magnetic field: a splitting method then turns velocities
        exactly while bodies drift, keeps its order, and the force does no work. ``None`` for others.
        """
        return None

    def why_singular(self, state: State) -> str | None:
        """Return why bodies may come where the force is not smooth, which fixed steps miss; or ``None``."""
        return None

    def uniform_acceleration(self, state: State) -> Vector2 | None:
        """Return the acceleration [m/s^2] that the force gives to every body with Mass alike, if it does so.

        Between impacts bodies then move in closed form, and compiled steps need not call the force.
        """
        return None

    def uniform_alone(self, state: State) -> Vector2 | None:
        """Return :meth:`uniform_acceleration` of a force that is compiled and turns nothing besides."""
        return self.uniform_acceleration(state) if type(self).packs() and not self.turns else None

    @property
    def crowd(self) -> int:
        """How many bodies collide by this force, so that many small steps suit them; 0 where none do."""
        return 0

    @property
    def attractors(self) -> int:
        """How many bodies attract each other by this force; 0 for one that is no attraction of pairs."""
        return 0

    def settings(self, state: State) -> bytes:
        """Return the numbers, bit by bit, that the force has apart from the state of motion.

        If they change, the method that moves the bodies is chosen again.
        """
        rows = state.batch(*self.needs).rows if self.columns else ()
        return b"".join(state.table(kind)[name][rows].tobytes() for kind, name in self.columns)

    def couples(self, state: State) -> NDArray[np.int64] | None:
        """Return the pairs of rows (n, 2) whose motions the force couples.

        ``None`` stands for any of :meth:`coupled_rows` with any.
        """
        return np.zeros((0, 2), np.int64) if self.couples_nothing else None

    def coupled_rows(self, state: State) -> NDArray[np.int64]:
        """Return the rows (n,) of which it couples any with any, if it does; all, unless it says fewer."""
        return np.arange(len(state.entity_index))

    def regions(self, state: State) -> NDArray[np.float64] | None:
        """Return the boxes (n, 4) within which it acts: xmin, ymin, xmax, ymax [m]; ``None`` is everywhere.

        They depend on the numbers of :meth:`inputs` alone.
        """
        return None

    def turned(self, state: State) -> NDArray[np.int64]:
        """Return the rows of the bodies that a compiled force turns: their angles are then followed.

        Those of all entities that it needs, where it says that it ``turns``; a force may return fewer.
        """
        return state.batch(*self.needs).rows if self.turns else np.zeros(0, np.int64)

    def packed(self, state: State, layout: StateLayout) -> PackedForce | None:
        """Return the force as compiled integrators call it, with the numbers of the scene as they are now.

        A row whose ``layout.place`` is -1 takes no part; where :meth:`couples` is ``None``, none of
        :meth:`coupled_rows` has that.
        Where that of its angle, ``layout.turn``, is -1, no force turns it.
        ``None`` where there is no such kernel: the method at ``Stage.FORCE`` is called instead, from Python.
        """
        return None

    def seen(self, layout: StateLayout) -> StateLayout:
        """Return a layout as :meth:`packed` is given it: the angles are for a force that ``turns`` bodies."""
        return layout if self.turns else layout.without_angles(self.name)

    def needs_origin(self, state: State) -> bool:
        """Whether the force is another where everything that moves is moved by the same distance."""
        return not self.is_everywhere

    def inputs(self, state: State, layout: StateLayout) -> bytes | None:
        """Return, bit by bit, all that :meth:`packed` depends on besides the layout, the laws and masses.

        While that stays the same the force is not packed again; ``None`` for one to be packed at every step.
        """
        return self.settings(state) if self.columns else None

    @classmethod
    @cache
    def marked(cls) -> Mapping[Stage, str]:
        """Return the stages of the system; a force that is packed is added by its kernel."""
        found = dict(super().marked())
        if cls.packed is not ForceSystem.packed:
            found.setdefault(Stage.FORCE, "add_packed")
        return found

    @classmethod
    def packs(cls) -> bool:
        """Whether :meth:`packed` is of this class's force, and not of one that it overrides."""
        method = cls.marked()[Stage.FORCE]
        for base in cls.__mro__:
            if base is ForceSystem:
                return False
            if "packed" in vars(base) or method in vars(base):
                return "packed" in vars(base)
        return False

    _packed_for: tuple[str, int] = ("", -1)
    _packed_of: tuple[Any, ...] | None = None
    _packed: PackedForce
    _layout: StateLayout
    _calls: NDArray[np.int64]

    def add_packed(self, state: State, h: float) -> None:
        """Add the packed force at the present state."""
        bodies = state.bodies
        add_forces(bodies.packed[0], bodies.packed[1], bodies.pull, self.calls(state))

    def energy_found(self, state: State) -> float:
        """Return the energy [J] that the packed force leaves as the first of its parameters, at present."""
        self.calls(state)
        transform = state.table(Transform)
        q = np.concatenate((transform["position"].ravel(), transform["angle"], (state.time,)))
        room = np.zeros((2, len(q)))
        add_forces(q, room[0], room[1], self._calls)
        return float(self._packed.parameters[0])

    def note_rate(self, state: State) -> None:
        """Note the fastest rate that the packed force met since the last call, if it measures that."""
        if self._packed_of is None or self._packed.max_rate_slot is None:
            return
        met = self._packed.parameters[-1:]
        rate = math.sqrt(met.item())
        state.fastest_rates[self.name] = max(rate, state.fastest_rates.get(self.name, 0.0))
        met[0] = 0.0

    def calls(self, state: State) -> NDArray[np.int64]:
        """Return the addresses (1, 3) of the packed force; what it is made of is looked at once a step."""
        moment = state.context, state.generation
        if self._packed_for != moment:
            self._pack(state)
            self._packed_for = moment
        return self._calls

    def _pack(self, state: State) -> None:
        """Pack the force for every row, where anything that it is made of was changed."""
        bodies, structure = state.bodies, (state.context, state.entity_index.revision, state.revision)
        if self._packed_of is None or self._packed_of[:3] != structure:
            self._layout = StateLayout.of_rows(len(state.entity_index))
        numbers = self.inputs(state, self._layout)
        masses = bodies.inverse_mass.tobytes(), bodies.inverse_inertia.tobytes()
        made_of = (*structure, state.physics, numbers, *masses)
        if numbers is None or made_of != self._packed_of:
            force = self.packed(state, self.seen(self._layout))
            assert force is not None
            state.compile((force.kernel, add_forces))
            self._packed, self._calls, self._packed_of = force, np.array([force.call]), made_of
