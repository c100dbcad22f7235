"""A world's scene in Box2D (2.3, by its Python binding)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, override

from physicslab.components import Mass, Material, Shape, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.lab.peers.peer import Peer

__all__ = ["Box2DMirror"]

VELOCITY_ITERATIONS, POSITION_ITERATIONS = 8, 3
FAST = 20.0
"""A body that starts faster [m/s] is one of Box2D's bullets, which do not pass through moving bodies."""


def _smaller_restitution(engine: Any) -> Any:
    """Return a listener that takes the smaller restitution of a pair, as the world does; Box2D the larger."""

    class SmallerRestitution(engine.b2ContactListener):  # type: ignore[misc]
        def PreSolve(self, contact: Any, _old: object) -> None:  # noqa: N802
            contact.restitution = min(contact.fixtureA.restitution, contact.fixtureB.restitution)

    return SmallerRestitution()


class Box2DMirror(Peer):
    """A world in one of Box2D's, at its usual settings of 8 and 3 iterations.

    Masses, moments of inertia, outlines, springs and their dampers, friction and restitution are the world's.
    """

    title, module = "Box2D 2.3", "Box2D"

    @override
    def make_space(self) -> None:
        self.space = self.engine.b2World(gravity=(self.gravity.x, self.gravity.y), doSleep=False)
        if len(self.restitutions()) > 1:  # a call into Python for each contact would be most of a step
            self._listener = _smaller_restitution(self.engine)
            self.space.contactListener = self._listener
        self._ground = self.space.CreateStaticBody()
        self._bodies: dict[int, Any] = {}
        physics = self.world.physics
        if physics.bounds is not None:
            xmin, ymin, xmax, ymax = physics.bounds
            corners = [(xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax), (xmin, ymin)]
            self._ground.CreateFixture(
                shape=self.engine.b2ChainShape(vertices_chain=corners),
                friction=physics.bounds_friction, restitution=physics.bounds_restitution,
            )  # fmt: skip

    @override
    def set_gravity(self, gravity: Vector2) -> None:
        self.space.gravity = gravity.x, gravity.y

    @override
    def add_body(self, entity: int) -> None:
        world = self.world
        pose = world.component(entity, Transform)
        place = {"position": (pose.position.x, pose.position.y), "angle": pose.angle}
        if not world.has(entity, Velocity):
            self._bodies[entity] = self.space.CreateStaticBody(**place)
            return
        velocity = world.component(entity, Velocity)
        motion = {
            "linearVelocity": (velocity.linear.x, velocity.linear.y),
            "angularVelocity": velocity.angular,
            "bullet": velocity.linear.magnitude > FAST,
        }
        if not world.has(entity, Mass):
            self._bodies[entity] = self.space.CreateKinematicBody(**place, **motion)
            return
        turns = world.has(entity, Shape) and not world.component(entity, Mass).fixed_rotation
        # Set for each body as well: the binding's world lets them sleep after a while in spite of doSleep.
        self._bodies[entity] = self.space.CreateDynamicBody(
            **place, **motion, fixedRotation=not turns, allowSleep=False
        )
        self._weigh(entity)

    @override
    def add_shape(self, entity: int) -> None:
        outline, material = self.world.component(entity, Shape), self.world.component(entity, Material)
        if outline.kind == "circle":
            made = self.engine.b2CircleShape(radius=outline.radius)
        else:
            made = self.engine.b2PolygonShape(box=(0.5 * outline.width, 0.5 * outline.height))
        body = self._bodies[entity]
        body.CreateFixture(
            shape=made, density=1.0, friction=material.friction, restitution=material.restitution
        )
        if body.type == self.engine.b2_dynamicBody:
            self._weigh(entity)  # again: a fixture changes the mass of its body

    def _weigh(self, entity: int) -> None:
        mass = self.world.component(entity, Mass)
        self._bodies[entity].massData = self.engine.b2MassData(
            mass=mass.mass, I=float(mass.inertia or 0.0), center=(0.0, 0.0)
        )

    @override
    def add_spring(self, entity: int, spring: Spring) -> None:
        bodies = [self._bodies[end] if end else self._ground for end in (spring.a or entity, spring.b)]
        hertz, damping = self.frequency(entity, spring)
        self.space.CreateDistanceJoint(
            bodyA=bodies[0], bodyB=bodies[1],
            localAnchorA=(spring.anchor_a.x, spring.anchor_a.y),
            localAnchorB=(spring.anchor_b.x, spring.anchor_b.y),
            length=spring.rest_length, frequencyHz=hertz, dampingRatio=damping,
            collideConnected=True,
        )  # fmt: skip

    @override
    def step(self, dt: float) -> None:
        self.space.Step(dt, VELOCITY_ITERATIONS, POSITION_ITERATIONS)

    @override
    def run(self, dt: float, steps: int) -> None:
        step = self.space.Step
        for _ in range(steps):
            step(dt, VELOCITY_ITERATIONS, POSITION_ITERATIONS)

    @override
    def positions(self) -> list[tuple[float, float]]:
        return [body.position.tuple for body in self._bodies.values()]

    @override
    def state(self, entity: int) -> Sequence[float]:
        body = self._bodies[entity]
        place, linear = body.position, body.linearVelocity
        return place.x, place.y, linear.x, linear.y, body.angle, body.angularVelocity
