"""Few bodies that touch or have limits: laws of contacts solved to rounding, events located in time."""

import time
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material, Shape, Transform, Velocity
from physicslab.components.material import friction_of_pair, restitution_of_pair
from physicslab.components.shape import CHAIN
from physicslab.contacts.arguments import shapes_of
from physicslab.contacts.near_pairs import list_all
from physicslab.ecs.sentences import sentence
from physicslab.kernels import direct_entry
from physicslab.kernels.accounts import CONTACT, FRICTION, HAND, JOINTS, MOTORS
from physicslab.kernels.broad import near_pairs
from physicslab.kernels.clock import time_after
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid import joined, step
from physicslab.kernels.rigid.features import PAIR
from physicslab.kernels.rigid.point_records import write_points
from physicslab.kernels.solver.impulse import MAX_SUBSTEP_FACTOR
from physicslab.kernels.wide import slots
from physicslab.ode.system import OdeSystem
from physicslab.state.chain_links import segment_of_link
from physicslab.state.contacts import Contacts
from physicslab.state.joint_figures import is_overloaded
from physicslab.state.masses import check_finite
from physicslab.state.samples import Samples
from physicslab.state.state import State
from physicslab.stepping.accounting import put_together
from physicslab.stepping.ballistic import pairs_that_may_meet
from physicslab.stepping.breaks import Overloaded
from physicslab.stepping.flow import NotSmooth
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.rigid_motion import MadeStep, RigidMotion
from physicslab.stepping.rigid_rows import RigidRows
from physicslab.stepping.stepper import Advance, Stepper, divisions
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import Stage

_IN_A_ROW = MAX_SUBSTEP_FACTOR - 1
"""Steps in a row that may be made by impulses, where soft contacts may go on after them. In 36 heaps of 6 to
12 bodies what lands takes up to 7, what is wedged 10 to 106, each as long as two frames of a window; ten
discs that settle in a pit take 14. They are counted where soft contacts keep their factor, up to its
largest."""


class Rigid(Stepper):
    """Advances bodies as a constrained system, from event to event.

    Nothing is remembered between steps: what touches follows from the state. So a step that changed no bit of
    it is not made again while all that it depends on stays the same. A step that it cannot make is left to
    the next stepper, with soft contacts.

    Attributes
    ----------
    left_to_soft : int
        How many steps were.
    why_soft : str
        Why, at the last of them.
    by_impulses : int
        How many steps were made by impulses in short steps, at least from some time on.
    why_impulses : str
        Why, at the last of them.
    energy_added : float
        By moving bodies apart that overlapped, as soft contacts or a scene had left them [J].
    energetic_impacts : int
        How many impacts obeyed Stronge's law, as Newton's would have made energy.
    restitutions_lowered : int
        How often impacts of several points got lower restitutions, as Newton's law would have made energy.
    """

    name: str = "rigid"
    title: str = "Rigid contacts, events at their exact times"
    samples: bool = True
    yields: bool = True
    kernels: tuple[Any, ...] = (
        step.make_step, write_points, near_pairs.carry_over, slots.list_scalar,
    )  # fmt: skip

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._schedule = schedule
        self.reason = plan.contact_reason
        self._impacts_alone, self._goes_on = plan.collisions == "exact", False
        self._rows = rows = RigidRows(state)
        causes = [FRICTION, CONTACT, *([HAND] if _is_anything_driven(state) else [])]
        causes += [JOINTS, MOTORS] if len(rows) else []
        self._ode = OdeSystem(state, schedule.smooth_forces, every_row=True, also=tuple(causes))
        contacts = pairs_that_may_meet(state)
        self._pairs = np.concatenate((contacts, rows.pairs))
        chain = state.table(Shape)["kind"] == CHAIN
        self._records = RigidRecords(contacts, chain[contacts[:, 0]] | chain[contacts[:, 1]])
        self._refused, self.left_to_soft, self.why_soft = -1, 0, ""
        # Soft joints err less than impulses in 32 parts, and take a hundredth of the time.
        self._gives_up = bool(len(state.joints)) and state.simulation.contacts == "auto"
        self._made_of: object = None
        self._resting: tuple[object, ...] | None = None
        self._laws: tuple[Any, ...] = ()
        self._scene: tuple[Any, ...] = ()
        self._unmoved: NDArray[np.int64] = np.zeros(0, np.int64)
        self.energetic_impacts = self.restitutions_lowered = self.by_impulses = 0
        self.why_impulses, self.energy_added = "", 0.0
        engine = [system for system in schedule.running if system.is_engine and system.acts_within_step()]
        within = dict.fromkeys((*engine, *schedule.forces))
        self._within = [system.name for system in within if not isinstance(system, IntegrateSystem)]
        steady = not any(force.depends_on_time(state) for force in schedule.smooth_forces)
        self._motion = RigidMotion(self._ode, len(self._pairs), steady, rows)

    @classmethod
    def why_not(cls, state: State, schedule: Schedule, plan: StepPlan) -> str | None:
        """Return why contacts are soft, or ``None``."""
        return None if plan.contacts == "rigid" else plan.contact_reason

    def holds(self, state: State) -> bool:
        """Whether no number was changed that the layout of the forces, or which joints act, depends on."""
        return not self._ode.outdated(state) and self._rows.holds(state)

    def ready(self, state: State, h: float) -> bool:
        """Whether the coming step is not one that it has just refused."""
        return self._refused != state.steps

    def goes_on(self, state: State) -> bool:
        """Whether no force is one in Python, which may depend on anything, and the next step is its own."""
        return self._goes_on and not self._ode.interpreted

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Make the steps, or those before the first that it cannot make and is not ready for.

        In a scene of impacts it ends where no body is held by another: the next step may be a flight.
        """
        began, parts = time.perf_counter_ns(), divisions(state, h)
        if self._ode.gather(state, unedited=self.is_repeated):
            self._ode.set_going()
        else:
            put_together(state, self._schedule.forces, self._ode)
            self._scene = self._present_scene(state)
        scene = self._scene
        figures, last, made, at = self._figures(state, h), None, 0, state.time
        rests = figures is not None and figures == self._resting
        while made < steps and (self._goes_on or not made):
            if rests:
                count = steps - made if self._goes_on else 1
                for _ in range(count):
                    self._motion.rest(h)
                if state.samples is not None:
                    self._sample(state.samples, at, count * h)
                made += count
                break
            if state.simulation.contacts == "auto" and state.contacts.substep_factor > _IN_A_ROW:
                if made:
                    break  # the next call begins where it gives up
                raise NotSmooth(self.why_impulses)
            step = self._step(scene, state, at, h, parts)
            if step.by_impulses and self._gives_up:
                if made:
                    break
                raise NotSmooth(step.by_impulses)
            if step.refused:
                self._refused, self.why_soft = state.steps + made, step.refused
                self.left_to_soft += 1
                break
            last, made, wedged = step, made + 1, step.by_impulses and not step.rests
            state.contacts.substep_factor = state.contacts.substep_factor + 1 if wedged else 1
            rests = step.rests and figures is not None
            self._goes_on = not self._impacts_alone or self._records.hold(step)
            if state.joints.breakable and made < steps:
                self._check_loads(scene, state, step, made)
            if state.samples is not None:
                self._sample(state.samples, at, h)
            at = time_after(at, h)
        self._resting = None
        if made:
            self._ode.scatter(state, 0.0)
            if last is not None:
                self._records.write(state, last, h / parts)
                self._find_joint_forces(scene, state, last)
            if rests:
                self._resting = self._figures(state, h, state.steps + made)
            spent = time.perf_counter_ns() - began
            self._schedule.note_loop(IntegrateSystem.__name__, made, spent, self._within)
            check_finite(state, state.time + h * made)
            state.substeps = state.simulation.substeps
            self._schedule.run_others(ResolveSystem, Stage.IMPACT, state, h)
        return Advance(made, parts)

    def _check_loads(self, scene: tuple[Any, ...], state: State, last: MadeStep, made: int) -> None:
        """Raise where a joint bears less than its load at the end of the ``last`` of the steps made."""
        q, n = self._ode.q, len(self._ode.layout.moving)
        self._find_joint_forces(scene, state, last)
        if is_overloaded(state, None, (q[: 2 * n].reshape(n, 2), q[2 * n : 3 * n])):
            raise Overloaded(made)

    def _figures(self, state: State, h: float, steps: int | None = None) -> tuple[object, ...] | None:
        """Return all that a step of ``h`` seconds depends on; ``None`` if it may on more.

        ``steps`` is how many are made by then, by default as many as now: contacts are as this stepper has
        left them.
        """
        ode = self._ode
        if ode.laws is None:
            return None
        motion = ode.q[: ode.layout.clock].tobytes(), ode.v[: ode.layout.clock].tobytes()
        return *motion, ode.laws, self._made_of, h, state.steps if steps is None else steps

    def _sample(self, samples: Samples, time: float, span: float) -> None:
        """Take the samples that are due within ``span`` s from a time [s] on, all of the packed state."""
        places, after = samples.due(time, span)
        if not len(places):
            return
        into, n = samples.put(places, time + after), len(self._ode.layout.moving)
        for packed, first in ((self._ode.q, 0), (self._ode.v, 3)):
            into[:, :, first : first + 2] = packed[: 2 * n].reshape(n, 2)[samples.rows]
            into[:, :, first + 2] = packed[2 * n : 3 * n][samples.rows]

    def _step(self, scene: tuple[Any, ...], state: State, at: float, h: float, parts: int) -> MadeStep:
        """Make a step from time ``at`` in parts; where one cannot be made, all is as before the step."""
        q, v, impacts, added = self._ode.q, self._ode.v, 0, 0.0
        before, logged, booked = (q.copy(), v.copy()), state.contacts.logged, state.account.sums.copy()
        clock = self._ode.layout.clock
        for part in range(parts):
            moment = at + part * h / parts
            q[clock], v[clock] = moment, 1.0  # the clock goes by one second a second
            step = self._motion.step(scene, state, moment, h / parts)
            together = self._ode.hold_together()
            if not (step.refused or step.by_impulses) and self._ode.was_apart(together):
                step.refused = sentence("contradiction")
            state.force_evaluations += step.evaluations
            if step.by_impulses and not (step.refused or self._gives_up) and parts == 1:
                self._motion.rest_held(step, state.account.sums, before, booked, h, scene[7][:, 2].min())
                state.contacts.logged = logged if step.rests else state.contacts.logged
            self.energetic_impacts += step.energetic
            self.restitutions_lowered += step.lowered
            if step.refused or (step.by_impulses and self._gives_up):
                q[:], v[:] = before
                state.contacts.logged, state.account.sums[:] = logged, booked
                return step
            if step.by_impulses:
                self.by_impulses, self.why_impulses = self.by_impulses + 1, step.by_impulses
            impacts, added = impacts + step.impacts, added + step.energy_added
        step.rests &= parts == 1 and all(
            now[:clock].tobytes() == then[:clock].tobytes() for now, then in zip((q, v), before, strict=True)
        )
        state.collisions += impacts
        self.energy_added += added
        step.impacts = impacts
        return step

    def _present_scene(self, state: State) -> tuple[Any, ...]:
        """Return what the kernels take of the state, beside the state of motion."""
        material, velocity = state.table(Material), state.table(Velocity)
        bodies, ode = state.bodies, self._ode
        integers, lengths, pool = shapes_of(state)
        columns = (
            velocity.present, material["friction"], material["restitution"], bodies.inverse_mass,
            bodies.inverse_inertia, integers, lengths,
        )  # fmt: skip
        inputs = state.physics, ode.slots, [column.tobytes() for column in columns]
        if inputs != self._made_of:
            self._made_of, present = inputs, velocity.present
            self._unmoved = np.flatnonzero(~np.concatenate((np.repeat(present, 2), present)))
            self._laws = self._laws_of(state, *columns[1:3])
        ode.v[self._unmoved] = 0.0
        walls, coefficients, bare_lengths, accounts = self._laws
        shapes = integers, lengths if bare_lengths is None else bare_lengths, pool
        return (
            len(bodies.inverse_mass), ode.inverse_mass, ode.damping, ode.damped_calls, shapes, walls,
            self._pairs, coefficients, accounts, *ode.joints,
        )  # fmt: skip

    def _laws_of(
        self, state: State, friction: NDArray[np.float64], restitution: NDArray[np.float64]
    ) -> tuple[Any, ...]:
        """Return the walls, the coefficients of all pairs, the lengths of shapes, and where accounts are.

        These lengths are others than the shapes' own where a body without a shape reaches as far as its
        radius of gyration; else ``None``.
        """
        physics, bodies, slots = state.physics, state.bodies, self._ode.slots
        size = 2.0 * bodies.shapes.thin
        a, b, wall = self._pairs[: len(self._pairs) - len(self._rows)].T
        walled = wall >= 0
        coefficients = np.empty((len(a), 3))
        of_a = np.where(walled, physics.bounds_friction, friction[a])
        coefficients[:, 0] = friction_of_pair(of_a, friction[b])
        of_a = np.where(walled, physics.bounds_restitution, restitution[a])
        coefficients[:, 1] = restitution_of_pair(of_a, restitution[b])
        coefficients[:, 2] = np.where(walled, size[b], np.minimum(size[a], size[b]))
        walls: NDArray[np.float64] = np.array(physics.bounds or (0.0, 0.0, 0.0, 0.0))
        bare, lengths = (bodies.shapes.vertices == 0) & (bodies.inverse_inertia > 0.0), None
        if bare.any():
            lengths = shapes_of(state)[1].copy()
            lengths[3, bare] = np.sqrt(bodies.inverse_mass[bare] / bodies.inverse_inertia[bare])
        accounts = np.array([slots.get(cause, -1) for cause in (FRICTION, CONTACT, HAND, JOINTS, MOTORS)])
        return walls, self._rows.behind(coefficients), lengths, accounts

    def _find_joint_forces(self, scene: tuple[Any, ...], state: State, made: MadeStep) -> None:
        """Find the forces of joints at the end of a step, their answer to those of contacts among them."""
        joints, ode = state.joints, self._ode
        if len(joints):
            ode.find_joint_forces(state)
            joined.find_answer(scene, made.points, made.measures, made.forces, made.closed, ode.q, ode.v)
            ode.add_joint_forces(state)
            contacts = len(self._pairs) - len(self._rows)
            for i in range(made.closed):
                number = int(made.points[i, PAIR]) - contacts
                if number >= 0:
                    row, force = self._rows.force_of(number, *made.forces[2 * i : 2 * i + 2])
                    joints.force[row] = force
            joints.impulse[:] = joints.force * state.contacts.impulse_dt  # should soft contacts have to go on


def _is_anything_driven(state: State) -> bool:
    """Whether anything moves, or may be moved, that no force moves: then contacts with it do work."""
    velocity, bodies = state.table(Velocity), state.bodies
    turned = (bodies.inverse_inertia == 0.0) & (velocity["angular"] != 0.0)
    return bool((velocity.present & ((bodies.inverse_mass == 0.0) | turned)).any())


class RigidRecords:
    """Writes the points that are closed, and the impacts of a step, into the records of their pairs.

    Parameters
    ----------
    pairs : int64 array (n, 3)
        The pairs that may meet.
    chained : bool array (n,)
        Whether one of a pair is a chain: it has a record for each segment that is touched.
    """

    def __init__(self, pairs: NDArray[np.int64], chained: NDArray[np.bool_]) -> None:
        self._pairs = pairs  # rows of joints, which are points as well, come behind them
        self._chained = chained

    def write(self, state: State, made: MadeStep, h: float) -> None:
        """Write the closed points and the impacts of a step of ``h`` seconds."""
        contacts = state.contacts
        # Blank: what soft steps before have left would depend on where a run was parted.
        contacts.recorded = 0
        if contacts.wide.filled:
            contacts.wide.reset(len(state.entity_index))
        pairs, number = self._list(state, made)
        list_all(state, pairs, len(pairs))
        contacts.impulse_dt = h / state.simulation.substeps
        contacts.active = direct_entry(write_points)(
            made.points, made.measures, made.forces, number, contacts.impulse_dt,
            state.table(Transform)["position"], contacts.manifolds, contacts.points, contacts.touching,
        )  # fmt: skip
        if made.impacts:
            write_impacts(state, made.impacts, numbers_of_pairs(contacts))
        contacts.stale = True  # for the contact step, should it have to go on

    def hold(self, made: MadeStep) -> bool:
        """Whether a body is surely held by another: one of the first two points of a pair presses."""
        of, forces = made.points[: made.closed, F.PAIR].tolist(), made.forces[: 2 * made.closed : 2].tolist()
        return any(
            force > 0.0 and pair < len(self._pairs) and of[:i].count(pair) < 2
            for i, (pair, force) in enumerate(zip(of, forces, strict=True))
        )

    def _key(self, state: State, made: MadeStep, i: int) -> tuple[int, ...]:
        """Return the pair of a point of a chain and its segment."""
        a, b, _ = self._pairs[made.points[i, F.PAIR]].tolist()
        feature, shapes = int(made.points[i, F.FEATURE]), state.bodies.shapes
        link, row = (F.LINK - feature, F.ONE) if feature < 0 else (int(made.points[i, F.VERTEX]), F.OTHER)
        return a, b, -2 - segment_of_link(shapes, int(made.points[i, row]), link)

    def _list(self, state: State, made: MadeStep) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the pairs to record, in order, with segments of chains that are touched.

        And which of them each closed point (closed,) belongs to, -1 for rows of joints.
        """
        of = made.points[: made.closed, F.PAIR]
        known = of < len(self._pairs)
        if not self._chained.any():
            return self._pairs, np.where(known, of, -1)
        keys = {
            i: self._key(state, made, i) if self._chained[of[i]] else tuple(self._pairs[of[i]].tolist())
            for i in np.flatnonzero(known).tolist()
        }
        touched = {key for key in keys.values() if key[2] < -1}
        entities = state.entity_index.entities
        ends = {
            (int(entities[a]), int(entities[b])): (a, b) for a, b, _ in self._pairs[self._chained].tolist()
        }
        for impact in state.contacts.impacts_since(state.contacts.logged - made.impacts):
            if impact["wall"] < -1:
                touched.add((*ends[int(impact["entity_a"]), int(impact["entity_b"])], int(impact["wall"])))
        listed = sorted([*map(tuple, self._pairs[~self._chained].tolist()), *touched])
        place = {pair: n for n, pair in enumerate(listed)}
        number = np.array([place[keys[i]] if i in keys else -1 for i in range(made.closed)], np.int64)
        return np.array(listed, np.int64).reshape(-1, 3), number


def write_impacts(state: State, impacts: int, numbers: dict[tuple[int, int, int], int]) -> None:
    """Write the last impacts of a step into the records of their pairs, at the first point of each.

    Parameters
    ----------
    state : State
        The records, which have no impacts yet, and the log.
    impacts : int
        How many there were in the step.
    numbers : dict
        The number of the record of each pair (:func:`numbers_of_pairs`).
    """
    contacts = state.contacts
    records, position = contacts.manifolds[: contacts.recorded], state.table(Transform)["position"]
    log = contacts.impacts_since(contacts.logged - impacts)
    pairs = np.array([numbers[key] for key in _pairs_of(log)])
    np.add.at(records["impact_count"], pairs, 1)
    points = contacts.points[: 2 * len(records) : 2]
    np.maximum.at(points["approach_speed"], pairs, log["approach_speed"])
    np.add.at(points["impact_normal"], pairs, log["normal_impulse"])
    np.add.at(points["impact_tangent"], pairs, log["tangent_impulse"])
    latest = dict(zip(pairs.tolist(), range(len(log)), strict=True))
    for p, n in latest.items():
        record, point, impact = records[p], points[p], log[n]
        if not record["count"]:
            record["normal_x"], record["normal_y"] = impact["normal_x"], impact["normal_y"]
            place = np.array((impact["x"], impact["y"]))
            point["arm_ax"], point["arm_ay"] = place - position[record["a"]]
            point["arm_bx"], point["arm_by"] = place - position[record["b"]]


def numbers_of_pairs(contacts: Contacts) -> dict[tuple[int, int, int], int]:
    """Return the number of each record by the entities and the wall of its pair."""
    return {key: p for p, key in enumerate(_pairs_of(contacts.manifolds[: contacts.recorded]))}


def _pairs_of(records: NDArray[Any]) -> Iterator[tuple[int, int, int]]:
    """Return the entities and the wall of each record."""
    return zip(
        records["entity_a"].tolist(), records["entity_b"].tolist(), records["wall"].tolist(), strict=True
    )
