"""A world's scene in pymunk."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, override

import numpy as np

from physicslab.components import Mass, Material, Shape, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.lab.peers.peer import Peer

__all__ = ["PymunkMirror"]

ITERATIONS = 10
SLOP = 0.005


class PymunkMirror(Peer):
    """A world in a space of pymunk's, at its usual settings of 10 iterations and a slop of 5 mm.

    Masses, moments of inertia, outlines, springs and dampers, friction and restitution are the world's.
    """

    title, module = "pymunk", "pymunk"

    @override
    def make_space(self) -> None:
        self.space = self.engine.Space()
        self.space.iterations = ITERATIONS
        self.space.collision_slop = SLOP
        self.set_gravity(self.gravity)
        self._bodies: dict[int, Any] = {}
        materials = self.world.batch(Material).rows
        self._one_restitution = len(np.unique(self.world.table(Material)["restitution"][materials])) < 2
        self._bounds()

    def _bounds(self) -> None:
        physics = self.world.physics
        if physics.bounds is None:
            return
        xmin, ymin, xmax, ymax = physics.bounds
        corners = ((xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax))
        for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
            # pymunk's walls have a thickness; this puts their inner face on the bound.
            vector = self.engine.Vec2d
            outward = vector(end[1] - start[1], start[0] - end[0]).normalized() * 1.0
            wall = self.engine.Segment(
                self.space.static_body,
                self.engine.Vec2d(*start) + outward,
                self.engine.Vec2d(*end) + outward,
                1.0,
            )
            wall.elasticity, wall.friction = physics.bounds_restitution, physics.bounds_friction
            self.space.add(wall)

    @override
    def set_gravity(self, gravity: Vector2) -> None:
        self.space.gravity = gravity.x, gravity.y

    @override
    def add_body(self, entity: int) -> None:
        world = self.world
        pose = world.component(entity, Transform)
        if not world.has(entity, Velocity):
            body = self.engine.Body(body_type=self.engine.Body.STATIC)
        elif not world.has(entity, Mass):
            body = self.engine.Body(body_type=self.engine.Body.KINEMATIC)
        else:
            mass = world.component(entity, Mass)
            turns = world.has(entity, Shape) and not mass.fixed_rotation
            body = self.engine.Body(mass.mass, float(mass.inertia or math.inf) if turns else math.inf)
        body.position, body.angle = (pose.position.x, pose.position.y), pose.angle
        self.space.add(body)
        self._bodies[entity] = body
        if world.has(entity, Velocity):
            velocity = world.component(entity, Velocity)
            body.velocity, body.angular_velocity = (velocity.linear.x, velocity.linear.y), velocity.angular

    @override
    def add_shape(self, entity: int) -> None:
        """Add a body's outline.

        Of the values of a pair pymunk takes the product; the world takes the smaller restitution, which is
        the product where one is 0 or 1, and the root of the product of frictions.
        """
        outline = self.world.component(entity, Shape)
        body = self._bodies[entity]
        made: Any
        if outline.kind == "circle":
            made = self.engine.Circle(body, outline.radius)
        else:
            made = self.engine.Poly.create_box(body, (outline.width, outline.height))
        material = self.world.component(entity, Material)
        e = material.restitution
        made.elasticity = math.sqrt(e) if self._one_restitution else e
        made.friction = math.sqrt(material.friction)
        self.space.add(made)

    @override
    def add_spring(self, entity: int, spring: Spring) -> None:
        a = self._bodies[spring.a or entity]
        b = self._bodies[spring.b] if spring.b else self.space.static_body
        anchors = [(anchor.x, anchor.y) for anchor in (spring.anchor_a, spring.anchor_b)]
        self.space.add(
            self.engine.DampedSpring(a, b, *anchors, spring.rest_length, spring.stiffness, spring.damping)
        )

    @override
    def step(self, dt: float) -> None:
        self.space.step(dt)

    @override
    def run(self, dt: float, steps: int) -> None:
        step = self.space.step  # as a program would call it, without this class in between
        for _ in range(steps):
            step(dt)

    @override
    def positions(self) -> list[tuple[float, float]]:
        return [body.position for body in self._bodies.values()]

    @override
    def state(self, entity: int) -> Sequence[float]:
        body = self._bodies[entity]
        return (*body.position, *body.velocity, body.angle, body.angular_velocity)
