"""Joints as people and programs read them: where they are, their forces, how far they are apart."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from physicslab.components import Transform
from physicslab.ecs.vector import Vector2, rotated
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
    stretch : float
        How far the points are apart that it holds together [m].
    """

    entity: int
    kind: type[Any]
    place: Vector2
    angle: float
    a: int
    b: int
    force: Vector2
    stretch: float

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
    at_a, at_b = (
        transform["position"][body] + rotated(anchor, transform["angle"][body])
        for body, anchor in ((joints.a, joints.anchor_a), (joints.b, joints.anchor_b))
    )
    found = []
    for joint in joints.joints:
        n, own = joint.first, slice(joint.first, joint.first + joint.size)
        force = joints.force[own] @ joints.axis[own]
        a, b = int(joints.a[n]), int(joints.b[n])
        angle = float(transform["angle"][b or a])
        stretch = float(np.hypot(*(at_b[n] - at_a[n])))
        ends = int(state.entity_index.entities[a]), int(state.entity_index.entities[b])
        found.append(
            JointState(joint.entity, joint.kind, Vector2(*at_a[n]), angle, *ends, Vector2(*force), stretch)
        )
    return found
