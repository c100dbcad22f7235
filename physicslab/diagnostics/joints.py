"""Joints as people and programs read them: where they are, their forces, how far they are apart."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from physicslab.components import Gear, Transform
from physicslab.diagnostics.present_forces import with_present_forces
from physicslab.ecs.vector import Vector2, rotated
from physicslab.state.joint_figures import figures_of
from physicslab.world import World


@dataclass(frozen=True, slots=True)
class JointState:
    """One joint.

    Attributes
    ----------
    entity : int
        The entity that carries it.
    kind : component type
        Its kind.
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
    def has_force(self) -> bool:
        """Whether a force says what it bears: not for a gear that turns bodies by a torque alone."""
        return self.kind is not Gear or self.force != Vector2(0.0, 0.0)

    @property
    def has_torque(self) -> bool:
        """Whether a torque says so, beside the force or alone."""
        return self.torque != 0.0 or not self.has_force


def joint_states(world: World) -> list[JointState]:
    """Return all joints, with the forces of the last step, or of one that would begin now."""
    state = with_present_forces(world)
    joints, transform = state.joints, state.table(Transform)
    if not joints.joints:
        return []
    figures = figures_of(state)
    first, a, b = (np.array([joint[k] for joint in joints.joints], np.int64) for k in (2, 4, 5))
    angle, entities = transform["angle"], state.entity_index.entities
    places = (transform["position"][a] + rotated(joints.anchor_a[first], angle[a])).tolist()
    angles, forces = angle[np.where(b > 0, b, a)].tolist(), figures.force.tolist()
    ends, numbers = np.stack((entities[a], entities[b]), axis=1), np.stack(figures[1:], axis=1)
    every = zip(joints.joints, places, angles, ends.tolist(), forces, numbers.tolist(), strict=True)
    return [
        JointState(one.entity, one.kind, Vector2(*at), turned, *both, Vector2(*force), *own)  # type: ignore[call-arg]
        for one, at, turned, both, force, own in every
    ]
