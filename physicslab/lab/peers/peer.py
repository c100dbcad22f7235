"""Another engine that holds a world's scene; its state can be copied back into the world's tables."""

import importlib
import math
import warnings
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Charge, Drag, Mass, Material, Shape, Spring, Thrust, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.state.joint_rows import KINDS
from physicslab.state.masses import Diverged
from physicslab.systems.system import Stage
from physicslab.world import World


class CannotBuild(Exception):
    """An engine has nothing of the kind that a scene holds."""


@dataclass(frozen=True, slots=True)
class PeerBody:
    """A body as other engines take it.

    Attributes
    ----------
    kind : str
        ``"static"``, ``"kinematic"`` or ``"dynamic"``.
    place, linear : pair of floats
        Where it is [m], and its velocity [m/s].
    angle, angular : float
        Its angle [rad], and its angular velocity [rad/s].
    mass, inertia : float
        Mass and inertia of a dynamic one [kg], [kg m^2]; the second is 0 where it does not turn.
    """

    kind: Literal["static", "kinematic", "dynamic"]
    place: tuple[float, float]
    angle: float
    linear: tuple[float, float] = (0.0, 0.0)
    angular: float = 0.0
    mass: float = 0.0
    inertia: float = 0.0


@dataclass(frozen=True, slots=True)
class PeerJoint:
    """A joint as other engines take it.

    Attributes
    ----------
    kind : str
        ``"rod"``, ``"rope"``, ``"pin"``, ``"slot"`` or ``"weld"``.
    ends : pair
        The engine's own bodies.
    anchors : pair of pairs of floats
        Where it holds them, each in its body's frame [m].
    collide : bool
        Whether the two touch each other.
    length : float
        Length of a rod or a rope [m].
    angle : float, optional
        That of B less that of A [rad] of a weld, and of a slot in which B does not turn.
    axis : pair of floats
        The direction of a slot in A's frame, of length 1.
    lower, upper : float
        The limits of a pin [rad] or a slot [m], infinite where there are none.
    speed, strongest : float, float
        The motor of a pin [rad/s], [N m] or a slot [m/s], [N]; the second is 0 where there is none.
    """

    kind: Literal["rod", "rope", "pin", "slot", "weld"]
    ends: tuple[Any, Any]
    anchors: tuple[tuple[float, float], tuple[float, float]]
    collide: bool
    length: float = 0.0
    angle: float | None = None
    axis: tuple[float, float] = (1.0, 0.0)
    lower: float = -math.inf
    upper: float = math.inf
    speed: float = 0.0
    strongest: float = 0.0

    @property
    def is_limited(self) -> bool:
        """Whether it has a limit."""
        return self.lower > -math.inf or self.upper < math.inf


class Peer(ABC):
    """A world's bodies, as they are when this is made, in another engine.

    Masses, moments of inertia, outlines, springs, joints, friction and restitution are the world's.

    Parameters
    ----------
    world : World
        Where the bodies are taken from.
    finer : int
        How many times as short as usual its steps are.

    Attributes
    ----------
    title, module : str
        The engine's name, and that of its package.
    world : World
        Where the bodies came from, and where :meth:`write_back` writes their state.
    finer : int
        How many times as short as usual its steps are.
    moving : list of int
        The entities that can move.
    space : Any
        The engine's own world.
    ground : Any
        The fixed body in it, for springs without a second body.
    step_name, settings : str, tuple of int
        The function that steps it, and the settings that follow the step.

    Raises
    ------
    CannotBuild
        If the engine has nothing of the kind that the world holds.
    ImportError
        If the engine is not installed.
    """

    title: ClassVar[str]
    module: ClassVar[str]
    space: Any
    ground: Any
    step_name: ClassVar[str] = "step"
    settings: ClassVar[tuple[int, ...]] = ()

    def __init__(self, world: World, finer: int = 1) -> None:
        self.finer = finer
        with warnings.catch_warnings():
            # Box2D's binding has types without modules, of which Python 3.12 warns; as an error it crashes.
            warnings.simplefilter("ignore", DeprecationWarning)
            self.engine: Any = importlib.import_module(self.module)  # here: most users have no peers
        world.synchronise()
        self.world = world
        if world.physics.gravity_mode == "planet" or any(
            len(world.batch(force)) for force in (Charge, Thrust)
        ):
            raise CannotBuild("no such force")
        self.gravity = world.physics.gravity if world.physics.gravity_mode == "linear" else Vector2()
        self.make_space()
        self._bodies: dict[int, Any] = {}
        for entity in world.batch(Transform).entities.tolist():
            body = self._body(entity)
            made = self._bodies[entity] = self.add_body(body)
            if world.has(entity, Shape):
                surface = world.component(entity, Material) if world.has(entity, Material) else Material()
                shape = world.component(entity, Shape)
                if shape.kind == "chain":
                    raise CannotBuild("no chain")
                self.add_shape(made, shape, surface)
            if body.kind == "dynamic":  # after its shape, which changes its mass
                self.weigh(made, body.mass, body.inertia)
        for entity in world.batch(Drag).entities.tolist():
            drag = world.component(entity, Drag)
            if drag.quadratic:
                raise CannotBuild("no drag by the square of speed")
            self.add_drag(self._bodies[entity], drag.linear / world.component(entity, Mass).mass)
        for entity in world.batch(Spring).entities.tolist():
            spring = world.component(entity, Spring)
            ends = [self._bodies[end] if end else self.ground for end in (spring.a or entity, spring.b)]
            self.add_spring(spring, ends, entity)
        for kind in KINDS:
            for entity in world.batch(kind).entities.tolist():
                self.add_joint(self._joint(entity, world.component(entity, kind)))
        moving = world.batch(Transform, Velocity)
        self._rows, self.moving = moving.rows.copy(), moving.entities.tolist()

    def _body(self, entity: int) -> PeerBody:
        """Return a body of the world."""
        world = self.world
        pose = world.component(entity, Transform)
        place = (pose.position.x, pose.position.y), pose.angle
        if not world.has(entity, Velocity):
            return PeerBody("static", *place)
        velocity = world.component(entity, Velocity)
        motion = (velocity.linear.x, velocity.linear.y), velocity.angular
        if not world.has(entity, Mass):
            return PeerBody("kinematic", *place, *motion)
        mass = world.component(entity, Mass)
        turns = world.has(entity, Shape) and not mass.fixed_rotation
        return PeerBody("dynamic", *place, *motion, mass.mass, float(mass.inertia or 0.0) if turns else 0.0)

    def _joint(self, entity: int, joint: Any) -> PeerJoint:
        """Return a joint of the world, which an entity carries."""
        kind: Any = type(joint).__name__.lower()
        if kind not in ("rod", "rope", "pin", "slot", "weld"):
            raise CannotBuild(f"no {kind}")
        carrier = entity if self.world.has(entity, Transform) else 0
        numbers: dict[str, Any] = {}
        if kind in ("rod", "rope"):
            numbers["length"] = joint.length
        elif kind == "weld" or (kind == "slot" and not joint.turns):
            numbers["angle"] = joint.angle
        if kind in ("pin", "slot"):
            numbers |= {name: getattr(joint, name) for name in ("lower", "upper") if joint.is_given(name)}
            if joint.is_given("motor_speed"):
                most = "max_torque" if kind == "pin" else "max_force"
                strongest = getattr(joint, most) if joint.is_given(most) else math.inf
                numbers |= {"speed": joint.motor_speed, "strongest": strongest}
        if kind == "slot":
            axis = joint.axis.normalized
            numbers["axis"] = (axis.x, axis.y)
        if any(joint.is_given(name) for name in ("breaks", "breaks_torque") if hasattr(joint, name)):
            raise CannotBuild("no joint that breaks")
        first, second = (self._bodies[end] if end else self.ground for end in (joint.a or carrier, joint.b))
        anchors = (joint.anchor_a.x, joint.anchor_a.y), (joint.anchor_b.x, joint.anchor_b.y)
        return PeerJoint(kind, (first, second), anchors, joint.collide, **numbers)

    @abstractmethod
    def make_space(self) -> None:
        """Begin with the bounds of the world and nothing else."""

    def set_gravity(self, gravity: Vector2) -> None:
        """Replace uniform gravity [m/s^2]."""
        self.space.gravity = gravity.x, gravity.y

    @abstractmethod
    def add_body(self, body: PeerBody) -> Any:
        """Add a body without its outline, and return it."""

    @abstractmethod
    def add_shape(self, body: Any, shape: Shape, material: Material) -> None:
        """Add a body's outline and surface."""

    def weigh(self, body: Any, mass: float, inertia: float) -> None:  # noqa: B027 (not all need it)
        """Set the mass [kg] and inertia [kg m^2] of a dynamic body, the second 0 where it does not turn."""

    def add_drag(self, body: Any, rate: float) -> None:
        """Slow a body by a share of its velocity a second [1/s]."""
        raise CannotBuild("no drag of single bodies")

    @abstractmethod
    def add_spring(self, spring: Spring, ends: Sequence[Any], entity: int) -> None:
        """Add a spring between two bodies, which an entity carries."""

    @abstractmethod
    def add_joint(self, joint: PeerJoint) -> None:
        """Add a joint."""

    def step(self, dt: float) -> None:
        """Advance by one step [s]."""
        self.run(dt, 1)

    def run(self, dt: float, steps: int) -> None:
        """Advance by so many steps [s]."""
        step = getattr(self.space, self.step_name)
        for _ in range(steps * self.finer):
            step(dt / self.finer, *self.settings)

    @abstractmethod
    def positions(self) -> object:
        """Return where every body is [m], as a user of the engine reads it: in Python in a loop."""

    @abstractmethod
    def state(self, entity: int) -> Sequence[float]:
        """Return a body's place [m], velocity [m/s], angle [rad] and angular velocity [rad/s]."""

    def states(self) -> NDArray[np.float64]:
        """Return the state of every body that can move (n, 6)."""
        return np.array([self.state(entity) for entity in self.moving]).reshape(-1, 6)

    def restitutions(self, *, bounds: bool = True) -> set[float]:
        """Return the restitutions that there are, of bodies and, where ``bounds``, of these."""
        physics, rows = self.world.physics, self.world.batch(Material).rows
        found: set[float] = set(self.world.table(Material)["restitution"][rows].tolist())
        return {*found, physics.bounds_restitution} if bounds and physics.bounds is not None else found

    def walls(self) -> list[tuple[float, float, float, float]]:
        """Return the bounds of the world as lines [m]: x, y of one end, x, y of the other."""
        if self.world.physics.bounds is None:
            return []
        xmin, ymin, xmax, ymax = self.world.physics.bounds
        corners = ((xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax))
        return [(*start, *end) for start, end in zip(corners, corners[1:] + corners[:1], strict=True)]

    def frequency(self, entity: int, spring: Spring) -> tuple[float, float]:
        """Return a spring's frequency [Hz] and share of critical damping, by which Box2D takes springs.

        Raises
        ------
        CannotBuild
            If it is a damper alone.
        """
        if spring.stiffness == 0.0:
            raise CannotBuild("no damper alone")
        ends = (spring.a or entity, spring.b)
        free = [
            self.world.component(end, Mass).mass
            for end in ends
            if end and self.world.has(end, Mass) and self.world.has(end, Velocity)
        ]
        mass = 1.0 / sum(1.0 / weight for weight in free)
        rate = math.sqrt(spring.stiffness / mass)
        return rate / (2.0 * math.pi), spring.damping / (2.0 * mass * rate)

    def write_back(self) -> None:
        """Write where the bodies are, and how they move, into the world's tables.

        Raises
        ------
        Diverged
            If a number of a body is not finite.
        """
        state = self.states()
        if not np.isfinite(state).all():
            raise Diverged("NaN")
        rows, transform, velocity = self._rows, self.world.table(Transform), self.world.table(Velocity)
        transform["position"][rows], velocity["linear"][rows] = state[:, :2], state[:, 2:4]
        transform["angle"][rows], velocity["angular"][rows] = state[:, 4], state[:, 5]


def find_contacts(world: World) -> None:
    """Find the contacts of a world from where its bodies are now; none is followed from an earlier pose."""
    world.synchronise()
    with world.active():
        world.contacts.fetch()  # else those of islands would be put in place of what is found, on the way
        world.contacts.clear()
        for stage in (Stage.BROAD_PHASE, Stage.CONTACT):
            world.schedule.run(stage, world, 0.0)
