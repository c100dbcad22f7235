"""The arguments of the kernels of the contact stages, taken from a state."""

import numpy as np

from physicslab.components import Material, Transform, Velocity
from physicslab.kernels.arguments import (
    ActingTuple,
    BoundsTuple,
    InverseTuple,
    MaterialsTuple,
    MotionTuple,
    NearTuple,
)  # fmt: skip
from physicslab.kernels.constraint.soft_joints import MEASURED, JointsTuple
from physicslab.kernels.geometry.shapes import ShapesTuple
from physicslab.state.state import State


def motion_of(state: State) -> MotionTuple:
    """Return positions, angles and velocities."""
    transform, velocity = state.table(Transform), state.table(Velocity)
    return (transform["position"], transform["angle"], velocity["linear"], velocity["angular"])


def shapes_of(state: State) -> ShapesTuple:
    """Return the table of shapes."""
    return state.bodies.plain_shapes


def materials_of(state: State) -> MaterialsTuple:
    """Return restitutions and frictions."""
    material = state.table(Material)
    return (material["restitution"], material["friction"])


def inverse_in(state: State) -> InverseTuple:
    """Return the inverse masses that are simulated: those of sleeping bodies are zero."""
    return (state.bodies.awake_inverse_mass, state.bodies.awake_inverse_inertia)


def acting_in(state: State) -> ActingTuple:
    """Return the forces of this substep."""
    bodies = state.bodies
    return (bodies.pull, state.has_forces, bodies.unkicked, state.uniform_forces)


def joints_in(state: State) -> JointsTuple:
    """Return the rows of joints."""
    joints = state.joints
    joints.refresh(state.entity_index)
    if len(joints.measured) != len(joints):
        joints.measured = np.zeros((len(joints), MEASURED))
    return (
        joints.a, joints.b, joints.block, joints.anchor_a, joints.anchor_b, joints.axis, joints.impulse,
        joints.measured,
    )  # fmt: skip


def bounds_of(state: State) -> BoundsTuple:
    """Return the bounds of the world; all zero where there are none, which then have no pairs."""
    physics = state.physics
    walls = np.array(physics.bounds or (0.0, 0.0, 0.0, 0.0))
    return (walls, physics.bounds_restitution, physics.bounds_friction)


def near_in(state: State) -> NearTuple:
    """Return the near pairs."""
    contacts, rows = state.contacts, len(state.entity_index)
    if len(contacts.rotations) != rows:
        contacts.rotations = np.full((rows, 3), np.nan)
        contacts.linear_before, contacts.angular_before = np.zeros((rows, 2)), np.zeros(rows)
    if len(contacts.noted) < len(contacts.points):
        contacts.noted = np.zeros((len(contacts.points), 4))
    return (
        contacts.counts, contacts.manifolds, contacts.points, contacts.scalar, contacts.touching,
        contacts.wide.discs.slots, contacts.wide.boxes.slots,
        contacts.proximity, contacts.activation_distance, state.entity_index.entities,
        contacts.rotations, state.account.table, contacts.noted, contacts.linear_before,
        contacts.angular_before,
    )  # fmt: skip


def speculative_margin(state: State, h: float) -> float:
    """Return how far [m] uniform gravity may bring two bodies together within a time h [s]."""
    physics = state.physics
    return 0.5 * physics.gravity.magnitude * h * h if physics.gravity_mode == "linear" else 0.0
