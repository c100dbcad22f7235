"""A world's scene in pymunk, Box2D 2.3 and Box2D 3, by their Python bindings."""

import math
from abc import abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar, override

from physicslab.components import Material, Shape, Spring
from physicslab.lab.peers.peer import CannotBuild, Peer, PeerBody, PeerJoint

STRONG = 1e30
"""The force of a motor that takes as much as it needs [N], [N m]: floats of Box2D are of 32 bits."""
FAST = 20.0
"""A body that starts faster [m/s] is one of Box2D's bullets, which do not pass through moving bodies."""


class PymunkMirror(Peer):
    """A world in a space of pymunk's, at its usual settings of 10 iterations and a slop of 5 mm.

    The slop is less where steps are shorter.
    """

    title, module = "pymunk", "pymunk"

    @override
    def make_space(self) -> None:
        engine, physics = self.engine, self.world.physics
        self.space = engine.Space()
        self.space.iterations, self.space.collision_slop = 10, 0.005 / self.finer
        self.set_gravity(self.gravity)
        self.ground = self.space.static_body
        self._one_restitution = len(self.restitutions(bounds=False)) < 2
        for x, y, to_x, to_y in self.walls():
            # pymunk's walls have a thickness; this puts their inner face on the bound.
            outward = engine.Vec2d(to_y - y, x - to_x).normalized()
            ends = engine.Vec2d(x, y) + outward, engine.Vec2d(to_x, to_y) + outward
            wall = engine.Segment(self.ground, *ends, 1.0)
            wall.elasticity, wall.friction = physics.bounds_restitution, physics.bounds_friction
            self.space.add(wall)

    @override
    def add_body(self, body: PeerBody) -> Any:
        kinds = self.engine.Body
        if body.kind == "dynamic":
            made = kinds(body.mass, body.inertia or math.inf)
        else:
            made = kinds(body_type=kinds.STATIC if body.kind == "static" else kinds.KINEMATIC)
        made.position, made.angle = body.place, body.angle
        self.space.add(made)
        if body.kind != "static":
            made.velocity, made.angular_velocity = body.linear, body.angular
        return made

    @override
    def add_shape(self, body: Any, shape: Shape, material: Material) -> None:
        """Add a body's outline.

        pymunk takes the product of a pair's values; the world takes the smaller restitution, which is
        the product where one is 0 or 1, and the root of the product of frictions.
        """
        if shape.kind == "circle":
            made = self.engine.Circle(body, shape.radius)
        elif shape.kind == "capsule":
            made = self.engine.Segment(body, *map(tuple, shape.core), shape.radius)
        else:
            made = self.engine.Poly(body, list(map(tuple, shape.core)), radius=shape.rounding)
        e = material.restitution
        made.elasticity = math.sqrt(e) if self._one_restitution else e
        made.friction = math.sqrt(material.friction)
        self.space.add(made)

    @override
    def add_drag(self, body: Any, rate: float) -> None:
        """Let Python change the body's velocity, as pymunk has no damping of single bodies."""
        update = self.engine.Body.update_velocity
        body.velocity_func = lambda moved, gravity, damping, dt: update(
            moved, gravity, damping * math.exp(-rate * dt), dt
        )

    @override
    def add_spring(self, spring: Spring, ends: Sequence[Any], entity: int) -> None:
        anchors = tuple(spring.anchor_a), tuple(spring.anchor_b)
        numbers = spring.rest_length, spring.stiffness, spring.damping
        self.space.add(self.engine.DampedSpring(*ends, *anchors, *numbers))

    @override
    def add_joint(self, joint: PeerJoint) -> None:
        engine, ends = self.engine, joint.ends
        held = (*ends, *joint.anchors)
        match joint.kind:
            case "rod":
                made = [engine.PinJoint(*held)]
                made[0].distance = joint.length
            case "rope":
                made = [engine.SlideJoint(*held, 0.0, joint.length)]
            case "pin":
                made = [engine.PivotJoint(*held)]
                if joint.is_limited:
                    made.append(engine.RotaryLimitJoint(*ends, joint.lower, joint.upper))
                if joint.strongest:
                    made.append(engine.SimpleMotor(*ends, -joint.speed))  # of A against B
                    made[-1].max_force = joint.strongest
            case "slot":
                if joint.strongest or not joint.lower < joint.upper < math.inf > -joint.lower:
                    raise CannotBuild("no motor in a groove, and none without ends")
                (x, y), (along, up) = joint.anchors[0], joint.axis
                groove = ((x + way * along, y + way * up) for way in (joint.lower, joint.upper))
                made = [engine.GrooveJoint(*ends, *groove, joint.anchors[1])]
            case "weld":
                made = [engine.PivotJoint(*held)]
        if joint.angle is not None:
            made.append(engine.GearJoint(*ends, joint.angle, 1.0))
        for part in made:
            part.collide_bodies = joint.collide
        self.space.add(*made)

    @override
    def positions(self) -> list[tuple[float, float]]:
        return [body.position for body in self._bodies.values()]

    @override
    def state(self, entity: int) -> Sequence[float]:
        body = self._bodies[entity]
        return (*body.position, *body.velocity, body.angle, body.angular_velocity)


def _smaller_restitution(engine: Any) -> Any:
    """Return a listener that takes the smaller restitution of a pair, as the world does; Box2D the larger."""

    class SmallerRestitution(engine.b2ContactListener):  # type: ignore[misc]
        def PreSolve(self, contact: Any, _old: object) -> None:  # noqa: N802
            contact.restitution = min(contact.fixtureA.restitution, contact.fixtureB.restitution)

    return SmallerRestitution()


class _Box2D(Peer):
    """A world in Box2D, whose versions have the same joints under other names.

    Attributes
    ----------
    turn : float
        The largest limit of a pin that it takes [rad].
    """

    turn: ClassVar[float] = STRONG

    @abstractmethod
    def join(self, kind: str, **numbers: Any) -> None:
        """Add a joint of a kind, with numbers by the names of version 3."""

    @abstractmethod
    def tie(self, length: float, held: dict[str, Any]) -> None:
        """Add a rope of a length [m] between what is held."""

    @override
    def add_spring(self, spring: Spring, ends: Sequence[Any], entity: int) -> None:
        hertz, damping = self.frequency(entity, spring)
        held = _held(ends, (tuple(spring.anchor_a), tuple(spring.anchor_b)), True)
        self.join("distance", length=spring.rest_length, hertz=hertz, damping_ratio=damping, **held)

    @override
    def add_joint(self, joint: PeerJoint) -> None:
        held = _held(joint.ends, joint.anchors, joint.collide)
        bounds = {
            "enable_limit": joint.is_limited, "enable_motor": joint.strongest > 0.0,
            "motor_speed": joint.speed,
        }  # fmt: skip
        most = self.turn if joint.kind == "pin" else STRONG
        lower, upper = max(joint.lower, -most), min(joint.upper, most)
        strongest = min(joint.strongest, STRONG)
        match joint.kind:
            case "rod":
                self.join("distance", length=joint.length, **held)
            case "rope":
                self.tie(joint.length, held)
            case "pin":
                reach = {"reference_angle": 0.0, "lower_angle": lower, "upper_angle": upper}
                self.join("revolute", max_motor_torque=strongest, **reach, **held, **bounds)
            case "slot":
                if joint.angle is None:
                    raise CannotBuild("no slot in which a body turns")
                reach = {"lower_translation": lower, "upper_translation": upper}
                self.join(
                    "prismatic", local_axis_a=joint.axis, reference_angle=joint.angle,
                    max_motor_force=strongest, **reach, **held, **bounds,
                )  # fmt: skip
            case "weld":
                self.join("weld", reference_angle=joint.angle, **held)


def _held(ends: Sequence[Any], anchors: tuple[Any, Any], collide: bool) -> dict[str, Any]:
    """Return the bodies that a joint holds and where, by the names of version 3."""
    return {
        "body_a": ends[0], "body_b": ends[1], "local_anchor_a": anchors[0], "local_anchor_b": anchors[1],
        "collide_connected": collide,
    }  # fmt: skip


class Box2DMirror(_Box2D):
    """A world in one of Box2D's, at its usual settings of 8 and 3 iterations."""

    title, module = "Box2D 2.3", "Box2D"
    step_name, settings = "Step", (8, 3)

    @override
    def make_space(self) -> None:
        self.space = self.engine.b2World(gravity=tuple(self.gravity), doSleep=False)
        if len(self.restitutions()) > 1:  # a call into Python for each contact would be most of a step
            self._listener = _smaller_restitution(self.engine)
            self.space.contactListener = self._listener
        self.ground = self.space.CreateStaticBody()
        physics, corners = self.world.physics, [wall[:2] for wall in self.walls()]
        if corners:
            self.ground.CreateFixture(
                shape=self.engine.b2ChainShape(vertices_chain=[*corners, corners[0]]),
                friction=physics.bounds_friction, restitution=physics.bounds_restitution,
            )  # fmt: skip

    @override
    def add_body(self, body: PeerBody) -> Any:
        place = {"position": body.place, "angle": body.angle}
        motion = {
            "linearVelocity": body.linear, "angularVelocity": body.angular,
            "bullet": math.hypot(*body.linear) > FAST,
        }  # fmt: skip
        if body.kind == "static":
            return self.space.CreateStaticBody(**place)
        if body.kind == "kinematic":
            return self.space.CreateKinematicBody(**place, **motion)
        # Set for each body as well: the binding's world lets them sleep after a while in spite of doSleep.
        fixed = body.inertia == 0.0
        return self.space.CreateDynamicBody(**place, **motion, fixedRotation=fixed, allowSleep=False)

    @override
    def add_shape(self, body: Any, shape: Shape, material: Material) -> None:
        if shape.kind == "circle":
            made = self.engine.b2CircleShape(radius=shape.radius)
        elif shape.rounding:
            raise CannotBuild("no rounded corners")
        else:
            made = self.engine.b2PolygonShape(vertices=list(map(tuple, shape.core)))
        body.CreateFixture(
            shape=made, density=1.0, friction=material.friction, restitution=material.restitution
        )

    @override
    def weigh(self, body: Any, mass: float, inertia: float) -> None:
        body.massData = self.engine.b2MassData(mass=mass, I=inertia, center=(0.0, 0.0))

    @override
    def join(self, kind: str, **numbers: Any) -> None:
        """Add a joint; its numbers have other names here."""
        names = {name: name.title().replace("_", "") for name in numbers} | {"hertz": "FrequencyHz"}
        named = {names[name][0].lower() + names[name][1:]: number for name, number in numbers.items()}
        getattr(self.space, f"Create{kind.title()}Joint")(**named)

    @override
    def tie(self, length: float, held: dict[str, Any]) -> None:
        self.join("rope", max_length=length, **held)

    @override
    def positions(self) -> list[tuple[float, float]]:
        return [body.position.tuple for body in self._bodies.values()]

    @override
    def state(self, entity: int) -> Sequence[float]:
        body = self._bodies[entity]
        place, linear = body.position, body.linearVelocity
        return place.x, place.y, linear.x, linear.y, body.angle, body.angularVelocity


class Box2D3Mirror(_Box2D):
    """A world in one of Box2D 3's, each step in its usual 4 substeps, with its usual contact stiffness.

    Box2D takes the larger restitution of a pair, the world the smaller: they must all be alike.
    """

    title, module = "Box2D 3", "pyb2d3"
    settings = (4,)
    turn = 0.99 * math.pi

    @override
    def make_space(self) -> None:
        if len(self.restitutions()) > 1:
            raise CannotBuild("no restitutions that differ")
        self.space = self.engine.World(gravity=tuple(self.gravity))
        self.space.sleeping_enabled = False
        self.ground = self.space.create_static_body()
        physics = self.world.physics
        for x, y, to_x, to_y in self.walls():
            surface = self._surface(physics.bounds_friction, physics.bounds_restitution)
            self.ground.create_shape(surface, self.engine.segment((x, y), (to_x, to_y)))

    def _surface(self, friction: float, restitution: float) -> Any:
        material = self.engine.surface_material(friction=friction, restitution=restitution)
        return self.engine.shape_def(density=1.0, material=material)

    @override
    def add_body(self, body: PeerBody) -> Any:
        rotation = self.engine.Rot()
        rotation.c, rotation.s = math.cos(body.angle), math.sin(body.angle)  # its own are approximate
        place = {"position": body.place, "rotation": rotation}
        motion = {"linear_velocity": body.linear, "angular_velocity": body.angular}
        if body.kind == "static":
            return self.space.create_static_body(**place)
        if body.kind == "kinematic":
            return self.space.create_kinematic_body(**place, **motion)
        return self.space.create_dynamic_body(**place, **motion, fixed_rotation=body.inertia == 0.0)

    @override
    def add_shape(self, body: Any, shape: Shape, material: Material) -> None:
        if shape.kind == "circle":
            made = self.engine.circle(center=(0.0, 0.0), radius=shape.radius)
        elif shape.kind == "capsule":
            made = self.engine.capsule(*map(tuple, shape.core), shape.radius)
        else:
            made = self.engine.polygon(list(map(tuple, shape.core)), radius=shape.rounding)
        body.create_shape(self._surface(material.friction, material.restitution), made)

    @override
    def weigh(self, body: Any, mass: float, inertia: float) -> None:
        data = self.engine.MassData()
        data.mass, data.center, data.rotational_inertia = mass, (0.0, 0.0), inertia
        body.mass_data = data

    @override
    def join(self, kind: str, **numbers: Any) -> None:
        spring = {"enable_spring": True} if "hertz" in numbers else {}
        getattr(self.space, f"create_{kind}_joint")(**numbers, **spring)

    @override
    def tie(self, length: float, held: dict[str, Any]) -> None:
        """Add a spring without stiffness, which stops at its limit."""
        bounds = {"enable_limit": True, "min_length": 0.0, "max_length": length}
        self.join("distance", length=length, hertz=0.0, **bounds, **held)

    @override
    def positions(self) -> list[tuple[float, float]]:
        return [tuple(body.position) for body in self._bodies.values()]

    @override
    def state(self, entity: int) -> Sequence[float]:
        body = self._bodies[entity]
        place, linear = body.position, body.linear_velocity
        angle = math.atan2(body.rotation.s, body.rotation.c)
        return place[0], place[1], linear[0], linear[1], angle, body.angular_velocity
