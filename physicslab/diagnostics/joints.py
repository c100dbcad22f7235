"""Joints as people and programs read them: where they are, their forces, how far they are apart."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from physicslab.components import Transform
from physicslab.ecs.vector import Vector2, rotated
from physicslab.state.joint_rows import Measure, Role, measured
from physicslab.state.joints import Joint
from physicslab.state.state import State


@dataclass(frozen=True, slots=True)
class JointState:
    """One joint.

    Attributes
    ----------
    entity : int
        What carries it.
    kind : component type
        Of what kind it is.
    place : Vector2
        Where it holds A [m].
    angle : float
        How B is turned [rad].
    a, b : int
        The bodies; 0 is the world.
    force : Vector2
        On B, at the end of the last step or as its mean [N].
    torque : float
        On B about its anchor, likewise [N m].
    stretch, twist : float
        How far lengths and places are from what it holds [m], and angles [rad]: the error that is left.
    largest_stretch : float
        The largest that was seen in substeps with soft contacts, and now [m].
    """

    entity: int
    kind: type[Any]
    place: Vector2
    angle: float
    a: int
    b: int
    force: Vector2
    torque: float
    stretch: float
    twist: float
    largest_stretch: float

    @property
    def is_fixed(self) -> bool:
        """Whether it holds a body to the world."""
        return not (self.a and self.b)


def joint_states(state: State) -> list[JointState]:
    """Return all joints, as the structure of the world was when it was last followed."""
    joints, transform = state.joints, state.table(Transform)
    if not joints.joints:
        return []
    joints.refresh(state.entity_index)
    found = []
    for joint in joints.joints:
        a, b, anchor = joint.a, joint.b, joints.anchor_a[joint.first]
        place = transform["position"][a] + rotated(anchor, transform["angle"][a])
        angle = float(transform["angle"][b or a])
        ends = int(state.entity_index.entities[a]), int(state.entity_index.entities[b])
        kind, at = joint.kind, Vector2(*place.tolist())
        force, torque, stretch, twist, largest = _figures(state, joint)
        found.append(JointState(joint.entity, kind, at, angle, *ends, force, torque, stretch, twist, largest))
    return found


def _figures(state: State, joint: Joint) -> tuple[Vector2, float, float, float, float]:
    """Return the force on B, the torque about its anchor, stretch, twist and the largest stretch."""
    joints, force, torque, largest = state.joints, np.zeros(2), 0.0, 0.0
    squares = {True: 0.0, False: 0.0}
    for row in range(joint.first, joint.first + joint.size):
        error = -float(joints.offset[row])
        terms = [n for n in (row, int(joints.second[row])) if n >= 0]
        for n in terms:
            one, scale = measured(joints.term(n), state.entity_index), float(joints.scale[n])
            error += scale * one.value
            pull = scale * float(joints.force[row])
            ends = (joints.a[n], (one.ax, one.ay), -1.0), (joints.b[n], (one.bx, one.by), 1.0)
            for end, gradient, sign in ends:
                if end == joint.b:
                    force += pull * np.array(gradient)
                    torque += sign * pull if joints.measure[n] == Measure.ANGLE else 0.0
        if joints.role[row] == Role.LIMIT:
            error = min(error, 0.0)
        if joints.measure[row] != Measure.ANGLE:
            largest = max(largest, float(joints.largest[row]))
        if joints.role[row] != Role.MOTOR:
            squares[bool(joints.measure[row] == Measure.ANGLE)] += error * error
    stretch, twist = math.sqrt(squares[False]), math.sqrt(squares[True])
    return Vector2(*force.tolist()), torque, stretch, twist, max(largest, stretch)
