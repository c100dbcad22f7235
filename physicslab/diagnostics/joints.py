"""Joints as people and programs read them: where they are, their forces, how far they are apart."""

import math
from dataclasses import dataclass
from typing import Any

from physicslab.components import Transform
from physicslab.ecs.vector import Vector2, rotated
from physicslab.state.joint_figures import figures_of
from physicslab.state.joint_rows import Measure
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
    size : float
        The length that its error is compared with [m]: that of its arms, and of a rod or a rope.
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
    size: float

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
        figures, size = figures_of(state, joint), _size(state, joint)
        found.append(JointState(joint.entity, kind, at, angle, *ends, *figures, size))  # type: ignore[arg-type]
    return found


def _size(state: State, joint: Joint) -> float:
    """Return the length that the error of a joint is compared with [m]."""
    joints, n = state.joints, joint.first
    arms = [joints.anchor_a[n] if joint.a else (0.0, 0.0), joints.anchor_b[n] if joint.b else (0.0, 0.0)]
    length = abs(float(joints.offset[n])) if joints.measure[n] == Measure.DISTANCE else 0.0
    reach = [float(state.bodies.shapes.reach[body]) for body in (joint.a, joint.b) if body]
    return max([length, *(math.hypot(x, y) for x, y in arms)]) or max(reach, default=0.0) or 1.0
