"""A world's scene in Box2D 3, by its Python binding ``pyb2d3``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, override

from physicslab.components import Mass, Material, Shape, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.lab.peers.peer import CannotBuild, Peer

__all__ = ["Box2D3Mirror"]

SUBSTEPS = 4


class Box2D3Mirror(Peer):
    """A world in one of Box2D 3's, each step in its usual 4 substeps, with its usual contact stiffness.

    Masses, moments of inertia, outlines, springs, friction and restitution are the world's. Of a pair's
    restitutions Box2D takes the larger, the world the smaller: they must all be alike.
    """

    title, module = "Box2D 3", "pyb2d3"

    @override
    def make_space(self) -> None:
        if len(self.restitutions()) > 1:
            raise CannotBuild("no restitutions that differ")
        self.space = self.engine.World(gravity=(self.gravity.x, self.gravity.y))
        self.space.sleeping_enabled = False
        self._ground = self.space.create_static_body()
        physics = self.world.physics
        surface = self.engine.surface_material(
            friction=physics.bounds_friction, restitution=physics.bounds_restitution
        )
        for x, y, to_x, to_y in self.walls():
            wall = self.engine.segment((x, y), (to_x, to_y))
            self._ground.create_shape(self.engine.shape_def(material=surface), wall)
        self._bodies: dict[int, Any] = {}

    @override
    def set_gravity(self, gravity: Vector2) -> None:
        self.space.gravity = gravity.x, gravity.y

    @override
    def add_body(self, entity: int) -> None:
        world = self.world
        pose = world.component(entity, Transform)
        rotation = self.engine.Rot()
        rotation.c, rotation.s = math.cos(pose.angle), math.sin(pose.angle)  # its own are approximate
        place = {"position": (pose.position.x, pose.position.y), "rotation": rotation}
        if not world.has(entity, Velocity):
            self._bodies[entity] = self.space.create_static_body(**place)
            return
        velocity = world.component(entity, Velocity)
        motion = {
            "linear_velocity": (velocity.linear.x, velocity.linear.y),
            "angular_velocity": velocity.angular,
        }
        if not world.has(entity, Mass):
            self._bodies[entity] = self.space.create_kinematic_body(**place, **motion)
            return
        turns = world.has(entity, Shape) and not world.component(entity, Mass).fixed_rotation
        self._bodies[entity] = self.space.create_dynamic_body(**place, **motion, fixed_rotation=not turns)
        self._weigh(entity)

    @override
    def add_shape(self, entity: int) -> None:
        outline, material = self.world.component(entity, Shape), self.world.component(entity, Material)
        engine = self.engine
        if outline.kind == "circle":
            made = engine.circle(center=(0.0, 0.0), radius=outline.radius)
        else:
            made = engine.box(0.5 * outline.width, 0.5 * outline.height)
        surface = engine.surface_material(friction=material.friction, restitution=material.restitution)
        self._bodies[entity].create_shape(engine.shape_def(density=1.0, material=surface), made)
        if self.world.has(entity, Mass):
            self._weigh(entity)  # again: a shape changes the mass of its body

    def _weigh(self, entity: int) -> None:
        mass = self.world.component(entity, Mass)
        data = self.engine.MassData()
        data.mass, data.center = mass.mass, (0.0, 0.0)
        data.rotational_inertia = float(mass.inertia or 0.0)
        self._bodies[entity].mass_data = data

    @override
    def add_spring(self, entity: int, spring: Spring) -> None:
        bodies = [self._bodies[end] if end else self._ground for end in (spring.a or entity, spring.b)]
        hertz, damping = self.frequency(entity, spring)
        self.space.create_distance_joint(
            body_a=bodies[0], body_b=bodies[1],
            local_anchor_a=(spring.anchor_a.x, spring.anchor_a.y),
            local_anchor_b=(spring.anchor_b.x, spring.anchor_b.y),
            length=spring.rest_length, enable_spring=True, hertz=hertz,
            damping_ratio=damping, collide_connected=True,
        )  # fmt: skip

    @override
    def step(self, dt: float) -> None:
        self.space.step(dt, SUBSTEPS)

    @override
    def run(self, dt: float, steps: int) -> None:
        step = self.space.step
        for _ in range(steps):
            step(dt, SUBSTEPS)

    @override
    def positions(self) -> list[tuple[float, float]]:
        return [tuple(body.position) for body in self._bodies.values()]

    @override
    def state(self, entity: int) -> Sequence[float]:
        body = self._bodies[entity]
        place, linear = body.position, body.linear_velocity
        angle = math.atan2(body.rotation.s, body.rotation.c)
        return place[0], place[1], linear[0], linear[1], angle, body.angular_velocity
