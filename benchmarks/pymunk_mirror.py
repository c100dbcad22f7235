"""Build a world's scene in pymunk, and bring what pymunk makes of it back into the world's tables."""

from __future__ import annotations

import math

import numpy as np
import pymunk

from physicslab import World
from physicslab.bodies import Diverged
from physicslab.components import Drag, Mass, Material, Shape, Spring, Transform, Velocity
from physicslab.vector import Vector2

ITERATIONS = 10
SLOP = 0.005


class CannotBuild(Exception):
    """pymunk has nothing of the kind that a scene holds."""


class Mirror:
    """A world's bodies, as they are when it is made, in a space of pymunk's.

    10 iterations and a slop of 5 mm, its usual settings, and the same masses, moments of inertia, outlines,
    springs and dampers, friction and restitution.
    """

    def __init__(self, world: World) -> None:
        world.synchronise()
        self._world = world
        self.space = pymunk.Space()
        self.space.iterations = ITERATIONS
        self.space.collision_slop = SLOP
        physics = world.physics
        if physics.gravity_mode == "planet" or world.batch(Drag).entities.size:
            raise CannotBuild("no such force")
        gravity = physics.gravity if physics.gravity_mode == "linear" else Vector2()
        self.space.gravity = gravity.x, gravity.y
        self._bounds()
        self._bodies: dict[int, pymunk.Body] = {}
        materials = world.batch(Material).rows
        values = np.unique(world.table(Material)["restitution"][materials])
        self._one_restitution = len(values) < 2
        for entity in world.batch(Transform).entities.tolist():
            self._add_body(entity)
        for entity in world.batch(Spring).entities.tolist():
            self._add_spring(entity)
        moving = world.batch(Transform, Velocity)
        self._rows = moving.rows.copy()
        self._moving = [self._bodies[entity] for entity in moving.entities.tolist()]

    def _bounds(self) -> None:
        physics = self._world.physics
        if physics.bounds is None:
            return
        xmin, ymin, xmax, ymax = physics.bounds
        corners = ((xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax))
        for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
            # pymunk's walls have a thickness; this puts their inner face on the bound.
            outward = pymunk.Vec2d(end[1] - start[1], start[0] - end[0]).normalized() * 1.0
            wall = pymunk.Segment(
                self.space.static_body, pymunk.Vec2d(*start) + outward, pymunk.Vec2d(*end) + outward, 1.0
            )
            wall.elasticity, wall.friction = physics.bounds_restitution, physics.bounds_friction
            self.space.add(wall)

    def _add_body(self, entity: int) -> None:
        world = self._world
        pose = world.component(entity, Transform)
        if not world.has(entity, Velocity):
            body = pymunk.Body(body_type=pymunk.Body.STATIC)
        elif not world.has(entity, Mass):
            body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        else:
            mass = world.component(entity, Mass)
            turns = world.has(entity, Shape) and not mass.fixed_rotation
            body = pymunk.Body(mass.mass, float(mass.inertia or math.inf) if turns else math.inf)
        body.position, body.angle = (pose.position.x, pose.position.y), pose.angle
        self.space.add(body)
        self._bodies[entity] = body
        if world.has(entity, Velocity):
            velocity = world.component(entity, Velocity)
            body.velocity, body.angular_velocity = (velocity.linear.x, velocity.linear.y), velocity.angular
        if world.has(entity, Shape):
            self._add_shape(entity, body)

    def _add_shape(self, entity: int, body: pymunk.Body) -> None:
        """Add a body's outline.

        Of the values of a pair pymunk takes the product; the world takes the smaller restitution, which is
        the product where one is 0 or 1, and the root of the product of frictions.
        """
        outline = self._world.component(entity, Shape)
        made: pymunk.Shape
        if outline.kind == "circle":
            made = pymunk.Circle(body, outline.radius)
        else:
            made = pymunk.Poly.create_box(body, (outline.width, outline.height))
        material = self._world.component(entity, Material)
        e = material.restitution
        made.elasticity = math.sqrt(e) if self._one_restitution else e
        made.friction = math.sqrt(material.friction)
        self.space.add(made)

    def _add_spring(self, entity: int) -> None:
        spring = self._world.component(entity, Spring)
        a = self._bodies[spring.a or entity]
        b = self._bodies[spring.b] if spring.b else self.space.static_body
        anchors = [(anchor.x, anchor.y) for anchor in (spring.anchor_a, spring.anchor_b)]
        self.space.add(
            pymunk.DampedSpring(a, b, *anchors, spring.rest_length, spring.stiffness, spring.damping)
        )

    def bring_back(self) -> None:
        """Write where the bodies are, and how they move, into the world's tables.

        Raises
        ------
        Diverged
            If a number of a body is not finite.
        """
        world, rows = self._world, self._rows
        state = np.array(
            [(*body.position, *body.velocity, body.angle, body.angular_velocity) for body in self._moving]
        ).reshape(-1, 6)
        if not np.isfinite(state).all():
            raise Diverged("NaN")
        transform, velocity = world.table(Transform), world.table(Velocity)
        transform["position"][rows], velocity["linear"][rows] = state[:, :2], state[:, 2:4]
        transform["angle"][rows], velocity["angular"][rows] = state[:, 4], state[:, 5]
