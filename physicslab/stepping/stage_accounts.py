"""Work of forces within a substep that no kernel books."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.contacts.arguments import inverse_in
from physicslab.contacts.islands import book_sleep
from physicslab.ecs.vector import Vector2
from physicslab.kernels import direct_entry
from physicslab.kernels.accounts import DAMPING, ENERGY, FIELDS, GRAVITY, HAND, OVERLAP
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.forces.force_calls import add_forces
from physicslab.kernels.solver import work
from physicslab.state.packed import StateLayout, spring_ends, turned_anchors
from physicslab.state.state import State
from physicslab.systems.drag import DragSystem
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import ForceSystem, System


class StageAccounts:
    """Books the work of forces along the way of a substep, where no kernel does.

    Work of impulses and kicks is booked within the kernels, that of sub-integrated bodies within their
    flow. A force that kicks bodies and stores no energy does its work along the way of the substep.

    Parameters
    ----------
    state : State
        Whose accounts.
    forces : sequence of ForceSystem
        The forces that act.
    flown : bool
        Whether a compiled flow moves all that forces act on which are not uniform, and books what they do.
    kicked : bool
        Whether all forces kick.

    Attributes
    ----------
    gravity : Vector2
        The sum of the accelerations [m/s^2] by forces that are the same everywhere.
    other : int
        The cause by which the kicks of other forces are booked.
    moves_against : bool
        Whether forces act that are not uniform: the kernel books another work of moving bodies apart.
    springs_alone : bool
        Whether these are springs and what resists motion, of which a kernel knows what they store elsewhere.
    """

    kernels: tuple[Any, ...] = (work.book_kick, work.book_damping, work.book_held)

    def __init__(
        self, state: State, forces: Sequence[ForceSystem], *, flown: bool = False, kicked: bool = True
    ) -> None:
        uniform = [force.uniform_acceleration(state) if force.is_engine else None for force in forces]
        self.gravity = sum((g for g in uniform if g is not None), start=Vector2(0.0, 0.0))
        others = [force for force, g in zip(forces, uniform, strict=True) if g is None]
        free = [force for force in others if force.potential is None]
        springs = any(isinstance(force, SpringSystem) for force in others)
        self.other = state.sleep.other = next((force.account for force in (*free, *others)), GRAVITY)
        self.moves_against = bool(others)
        self.springs_alone = all(isinstance(force, SpringSystem | DragSystem) for force in others)
        # Momentum is booked to one cause by kernels: what is another's is then noted by itself.
        self._storing, others = (
            [force for force in others if force.potential is not None],
            others * (not flown),
        )
        # A force that only turns velocities does no work: what its kicks change of the energy is an error.
        free = [force for force in free if force.gyration(state) is None] * (not flown)
        springs = springs and not flown
        self._apart = [force for force in others if force.account != self.other]
        self._free = free
        self._pulls = {force: np.zeros_like(state.bodies.pull) for force in (*free, *self._apart)}
        self._working = _working(state, self._storing) if kicked else {}
        self._damps = springs and _has_dampers(state)
        self._dampers = np.zeros_like(state.bodies.pull)
        bodies = state.bodies
        driven = _driven(state, others)
        self._driven = driven if driven.any() else None
        self._before_kicks = np.zeros(0)
        self._start: tuple[NDArray[np.float64], NDArray[np.float64]]
        self._met: tuple[NDArray[np.float64], NDArray[np.float64]]
        self._before = bodies.packed[2, : 2 * len(bodies.inverse_mass)].reshape(-1, 2)

    @property
    def notes_forces(self) -> bool:
        """Whether a force stores no energy, or not all its work, so that each must be noted by itself."""
        return bool(self._pulls) or self._damps or bool(self._working)

    @property
    def follows_way(self) -> bool:
        """Whether a force does work along the way of the substep that is booked here."""
        return self.notes_forces or self._driven is not None

    def begin_substep(self, state: State) -> None:
        """Note where bodies are, and how they move."""
        self._start, self._before_kicks = _places(state), _speeds(state)

    def note_force(self, system: System, before: NDArray[np.float64], state: State) -> None:
        """Note the pull of a force that is booked by itself; ``before`` (3 rows,) is that of those before."""
        if system in self._pulls:
            np.subtract(state.bodies.pull, before, out=self._pulls[system])
        if isinstance(system, ForceSystem) and system in self._working:
            self._working[system] = _places(state)
        if self._damps and isinstance(system, SpringSystem):
            self._dampers = _pull_of_dampers(state)

    def book_causes(self, state: State, h: float) -> None:
        """Book the impulses within ``h`` seconds of forces that kernels book to the cause of others."""
        kicked = (state.bodies.inverse_mass > 0.0) & ~state.bodies.sub_integrated
        turned, position = kicked & (state.bodies.inverse_inertia > 0.0), None
        for force in self._apart:
            position = state.table(Transform)["position"] if position is None else position
            n, pull = len(kicked), h * self._pulls[force]
            push, torque = pull[: 2 * n].reshape(n, 2)[kicked], pull[2 * n :][turned]
            at = position[kicked]
            spin = (at[:, 0] * push[:, 1] - at[:, 1] * push[:, 0]).sum() + torque.sum()
            given = np.array((0.0, *push.sum(axis=0), spin))
            state.account.sums[self.other] -= given
            state.account.sums[force.account] += given

    def book_kick(self, state: State, h: float, later: float) -> None:
        """Book the impulses of forces and of damping in a kick of ``h`` seconds that no kernel makes.

        The middle of the substep comes ``later`` seconds after that of the kick.
        """
        bodies, physics, velocity = state.bodies, state.physics, state.table(Velocity)
        position, (mass, inertia) = state.table(Transform)["position"], inverse_in(state)
        if state.has_forces:
            work.book_kick(
                position, bodies.force, bodies.torque, state.table(Mass)["mass"], mass, inertia,
                bodies.sub_integrated, self.gravity.x, self.gravity.y, self.other, h, state.account.sums,
            )  # fmt: skip
        if state.sleep.count:
            book_sleep(state, state.sleep.asleep, h)
        if physics.linear_damping > 0.0 or physics.angular_damping > 0.0:
            work.book_damping(
                position, velocity["linear"], velocity["angular"], bodies.force, bodies.torque, mass,
                inertia, bodies.sub_integrated, physics.linear_damping, physics.angular_damping, h, later,
                state.account.sums,
            )  # fmt: skip

    def note_places(self, state: State) -> None:
        """Note where bodies are before they are moved apart."""
        if self.moves_against:
            self._before[:] = state.table(Transform)["position"]

    def book_overlap(self, state: State) -> None:
        """Book what moving bodies apart has changed in what forces store that are not the same everywhere.

        The kernel has booked the work of all forces as if they stayed as they are along that way. A force
        that stores no energy, as drag, does none there.
        """
        position, bodies = state.table(Transform)["position"], state.bodies
        if not self.moves_against or np.array_equal(position, self._before):
            return
        way, now = position - self._before, position.copy()
        stored = sum(force.potential_energy(state) for force in self._storing)
        position[:] = self._before
        stored -= sum(force.potential_energy(state) for force in self._storing)
        position[:] = now
        weight = state.table(Mass)["mass"][:, None] * np.array((self.gravity.x, self.gravity.y))
        free = (bodies.awake_inverse_mass > 0.0)[:, None]
        state.account.sums[OVERLAP, ENERGY] += stored + float(((bodies.force - weight) * way * free).sum())

    def book_way(self, state: State) -> None:
        """Book the work of forces along the way of the substep, and that of what drives against them."""
        bodies, sums, way = state.bodies, state.account.sums, self._way(state, self._start)
        self._book_work(state, ~bodies.sub_integrated, way)
        if self._driven is not None:
            rows, pull = self._driven, bodies.pull[self._driven]
            for force in self._free:
                if force.couples_nothing:  # whatever it gives to a driven body comes to no other
                    pull -= self._pulls[force][rows]
            sums[HAND, ENERGY] -= float(pull @ way[rows])

    def book_works(self, state: State, h: float) -> None:
        """Book what forces that store energy give and take besides, by the mean velocities in ``h`` seconds.

        By the way of the bodies it would be too much where joints or overlaps put them elsewhere.
        """
        for force, (position, angle) in self._working.items():
            q = np.concatenate((position.ravel(), angle, (state.time,)))
            v = np.append(0.5 * (self._before_kicks + _speeds(state)), 0.0)
            for account, power in _powers(state, force, q, v):
                state.account.sums[account, ENERGY] += h * power

    def begin_impacts(self, state: State) -> None:
        """Note where bodies of a flow are before impacts at their own times move them."""
        self._met = _places(state)

    def book_impacts(self, state: State) -> None:
        """Book the work of forces along the way by which impacts have moved the bodies of a flow.

        A body that met at the time t is put to where it would be, had it moved from then on with its new
        velocity. Its flow knows nothing of that way.
        """
        way = self._way(state, self._met)
        if way.any():
            self._book_work(state, state.bodies.sub_integrated, way)

    @staticmethod
    def _way(state: State, start: tuple[NDArray[np.float64], NDArray[np.float64]]) -> NDArray[np.float64]:
        """Return by how much bodies have moved and turned since the ``start``, as in ``bodies.pull``."""
        (position, angle), (before, turned) = _places(state), start
        return np.concatenate(((position - before).ravel(), angle - turned))

    def _book_work(self, state: State, of: NDArray[np.bool_], way: NDArray[np.float64]) -> None:
        """Book the work along a ``way`` of forces that store no energy, on the bodies ``of`` some rows."""
        bodies, sums = state.bodies, state.account.sums
        moved = (bodies.awake_inverse_mass > 0.0) & of
        rows = np.concatenate((np.repeat(moved, 2), moved & (bodies.awake_inverse_inertia > 0.0)))
        worked = [(force.account, float(self._pulls[force][rows] @ way[rows])) for force in self._free]
        if self._damps:  # at an end that is driven, too: what drives it works against the damper
            rows = np.concatenate((np.repeat(of, 2), of))
            worked.append((DAMPING, float(self._dampers[rows] @ way[rows])))
        for account, energy in worked:
            # Damping gives no energy: what a kick gives that overshoots is an error of the method.
            sums[account, ENERGY] += min(energy, 0.0) if account == DAMPING else energy


def _places(state: State) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return copies of the positions (rows, 2) [m] and angles [rad] of all bodies."""
    transform = state.table(Transform)
    return transform["position"].copy(), transform["angle"].copy()


def _speeds(state: State) -> NDArray[np.float64]:
    """Return the velocities [m/s], and then the angular velocities [rad/s], of all bodies (3 rows,)."""
    velocity = state.table(Velocity)
    return np.concatenate((velocity["linear"].ravel(), velocity["angular"]))


def _driven(state: State, forces: Sequence[ForceSystem]) -> NDArray[np.bool_]:
    """Return the coordinates (3 rows,) that go on steadily whatever ``forces`` act on them."""
    bodies, turned = state.bodies, np.zeros(len(state.entity_index), np.bool_)
    moves = state.table(Velocity).present & ~bodies.sub_integrated & bool(forces)
    for force in forces:
        turned[force.turned(state)] = True
    shifted = moves & (bodies.inverse_mass == 0.0)
    turned = moves & (bodies.inverse_inertia == 0.0) & (turned | shifted)
    return np.concatenate((np.repeat(shifted, 2), turned))


def _working(
    state: State, forces: Sequence[ForceSystem]
) -> dict[ForceSystem, tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Return the forces that store energy, and also give or take it, with where bodies are."""
    found: dict[ForceSystem, tuple[NDArray[np.float64], NDArray[np.float64]]] = {}
    layout = StateLayout.of_rows(len(state.entity_index))
    for force in forces:
        packed = force.packed(state, layout) if type(force).packs() and force.account == FIELDS else None
        if packed is not None and packed.work_slots:
            found[force] = _places(state)
    return found


def _powers(
    state: State, force: ForceSystem, q: NDArray[np.float64], v: NDArray[np.float64]
) -> list[tuple[int, float]]:
    """Return what a force gives in a second to each account [W], at q and v of every row (3 rows + 1,)."""
    packed = force.packed(state, StateLayout.of_rows(len(state.entity_index)))
    assert packed is not None
    slots = packed.work_slots or ()
    for number, (_, slot) in enumerate(slots):
        packed.indices[slot] = len(q) + ACCOUNTS * number
    room = np.zeros(len(q) + ACCOUNTS * len(slots))
    state.compile((packed.kernel, add_forces))
    direct_entry(add_forces)(q, v, room, np.array([packed.call]))
    return [(account, float(room[packed.indices[slot]])) for account, slot in slots]


def _has_dampers(state: State) -> bool:
    """Whether a spring has a damper that kicks: what is sub-integrated books its own."""
    rows, a, b = spring_ends(state)
    kicked = state.table(Velocity).present & ~state.bodies.sub_integrated
    return bool(((state.table(Spring)["damping"][rows] > 0.0) & (kicked[a] | kicked[b])).any())


def _pull_of_dampers(state: State) -> NDArray[np.float64]:
    """Return the forces and torques of the dampers of all springs, row by row as in ``bodies.pull``."""
    (rows, a, b), spring, n = spring_ends(state), state.table(Spring), len(state.entity_index)
    transform, velocity = state.table(Transform), state.table(Velocity)
    ends = [
        (turned_anchors(state, end, rows, anchor), end, sign)
        for anchor, end, sign in (("anchor_a", a, -1.0), ("anchor_b", b, 1.0))
    ]
    apart, rate = np.zeros((len(rows), 2)), np.zeros((len(rows), 2))
    for arm, end, sign in ends:
        across = np.stack((-arm[:, 1], arm[:, 0]), axis=1)
        apart += sign * (transform["position"][end] + arm)
        rate += sign * (velocity["linear"][end] + velocity["angular"][end, None] * across)
    length = np.hypot(*apart.T)
    along = apart / np.where(length > 0.0, length, np.inf)[:, None]
    force = (spring["damping"][rows] * (rate * along).sum(axis=1))[:, None] * along
    pull = np.zeros(3 * n)
    for arm, end, sign in ends:
        np.add.at(pull[: 2 * n].reshape(n, 2), end, -sign * force)
        np.add.at(pull[2 * n :], end, -sign * (arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]))
    return pull
