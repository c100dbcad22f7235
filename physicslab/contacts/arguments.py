"""The arguments of the kernels of the contact stages, taken from a state; one stage by them."""

import numpy as np

from physicslab.components import Material, Transform, Velocity
from physicslab.kernels import Plain
from physicslab.kernels.arguments import ActingTuple, Bounds, Inverse, Materials, Motion, Near, Softness
from physicslab.kernels.broad.leaving import FatBoxes, blank_boxes
from physicslab.kernels.geometry.shapes import ShapesTuple
from physicslab.kernels.joints.blocks import Joints
from physicslab.kernels.near_counts import FOLLOWED
from physicslab.kernels.records import APART, CONSTRAINT, CONSTRAINT_POINT
from physicslab.kernels.solver import soft
from physicslab.state.samples import NOTHING_SAMPLED
from physicslab.state.state import State


def motion_of(state: State) -> Plain[Motion]:
    """Return positions, angles and velocities."""
    transform, velocity = state.table(Transform), state.table(Velocity)
    return (transform["position"], transform["angle"], velocity["linear"], velocity["angular"])


def shapes_of(state: State) -> ShapesTuple:
    """Return the table of shapes."""
    return state.bodies.plain_shapes


def materials_of(state: State) -> Plain[Materials]:
    """Return restitutions and frictions."""
    material = state.table(Material)
    return (material["restitution"], material["friction"])


def inverse_in(state: State) -> Plain[Inverse]:
    """Return the inverse masses that are simulated: those of sleeping bodies are zero."""
    return (state.bodies.awake_inverse_mass, state.bodies.awake_inverse_inertia)


def acting_in(state: State) -> ActingTuple:
    """Return the forces of this substep."""
    bodies = state.bodies
    return (bodies.pull, state.has_forces, bodies.unkicked, state.uniform_forces)


def joints_in(state: State) -> Plain[Joints]:
    """Return the rows of joints."""
    state.joints.refresh(state.entity_index)
    return state.joints.plain


def bounds_of(state: State) -> Plain[Bounds]:
    """Return the bounds of the world; all zero where there are none, which then have no pairs."""
    physics = state.physics
    walls = np.array(physics.bounds or (0.0, 0.0, 0.0, 0.0))
    return (walls, physics.bounds_restitution, physics.bounds_friction)


def near_in(state: State) -> Plain[Near]:
    """Return the near pairs."""
    contacts, rows = state.contacts, len(state.entity_index)
    if len(contacts.rotations) != rows:
        contacts.rotations = np.full((rows, 3), np.nan)
        contacts.linear_before, contacts.angular_before = np.zeros((rows, 2)), np.zeros(rows)
        contacts.moments, contacts.travels = np.full((rows, 7), -np.inf), np.zeros((5, rows))
        contacts.stirred = np.zeros(rows, np.int64)
    if len(contacts.noted) < len(contacts.points):
        contacts.noted = np.zeros((len(contacts.points), 4))
        contacts.apart = np.zeros(len(contacts.manifolds), APART)
        # These are written before they are read.
        contacts.constraints = np.empty(len(contacts.manifolds), CONSTRAINT)
        contacts.constraint_points = np.empty(len(contacts.points), CONSTRAINT_POINT)
    return (
        contacts.counts, contacts.manifolds, contacts.points, contacts.scalar, contacts.touching,
        contacts.wide.discs.slots, contacts.wide.boxes.slots,
        contacts.proximity, contacts.activation_distance, state.entity_index.entities,
        contacts.rotations, state.account.table, contacts.noted, contacts.linear_before,
        contacts.angular_before, contacts.moments, contacts.apart, contacts.travels, contacts.stirred,
        contacts.constraints, contacts.constraint_points,
    )  # fmt: skip


def speculative_margin(state: State, h: float) -> float:
    """Return how far [m] uniform gravity may bring two bodies together within a time h [s]."""
    physics = state.physics
    return 0.5 * physics.gravity.magnitude * h * h if physics.gravity_mode == "linear" else 0.0


_NOTHING = np.zeros(0)
_NO_VECTORS = np.zeros((0, 2))


def do_stage(
    state: State, part: int, h: float, *, softness: Plain[Softness] = (0.0, 0.0, 0.0), first: bool = False,
    near: Plain[Near] | None = None, inverse: Plain[Inverse] | None = None,
    fat: Plain[FatBoxes] | None = None,
) -> tuple[int, int]:  # fmt: skip
    """Do one part of a substep, as the loop of whole steps does it.

    Returns why the loop ended, and how many impacts there were.

    Parameters
    ----------
    state : State
        The state that gives all other arguments.
    part : int
        One of those for contacts and joints in :mod:`physicslab.kernels.solver.soft`.
    h : float
        The time that it covers [s].
    softness : tuple of three floats
        The contact spring.
    first : bool
        Whether it is in the first substep of a step.
    near, inverse : tuples of arrays, optional
        Pairs that take part, and the inverse masses of bodies.
    fat : tuple of arrays, optional
        The fat boxes, where pairs are listed.
    """
    state.compile((soft.advance,))
    near, inverse, contacts = near or near_in(state), inverse or inverse_in(state), state.contacts
    none = np.zeros(0, np.bool_)
    course = np.array([part]), np.array([[1.0], [0.0], [0.0]]), *state.window, -1.0, True
    loaded = int(state.bodies.unequal and state.has_forces)
    last = max(state.substeps, 1) - 1  # of those a step
    plan = (
        last + 1, state.simulation.iterations or 0, h, h, state.moment, h, last if first else -1, h, loaded
    )  # fmt: skip
    bodies = state.bodies
    masses = _NOTHING, _NOTHING, bodies.inverse_mass, bodies.inverse_inertia
    gravity = *masses, 0.0, 0.0, speculative_margin(state, h), 0
    packed = _NO_VECTORS, np.zeros((0, 3), np.int64)
    rows = np.zeros(0, np.int64)
    sleepers = False, 0, none, _NOTHING, _NOTHING, none, none, rows, _NO_VECTORS, False
    why, *_, impacts, _, contacts.impulse_dt = soft.advance(
        1, last, 0, plan, course, -1, motion_of(state), _NOTHING, shapes_of(state), materials_of(state),
        inverse, bodies.sub_integrated, acting_in(state), gravity, packed, (_NOTHING, rows), sleepers,
        (0.0, 0.0), fat or blank_boxes(0), bounds_of(state), near, joints_in(state), contacts.opened,
        softness, contacts.impulse_dt, contacts.step_log, np.zeros(soft.COSTS, np.int64), NOTHING_SAMPLED,
    )  # fmt: skip
    if part == soft.FIND:
        near[0][FOLLOWED] = 0  # what acts before the next part may change shapes
    return int(why), int(impacts)
