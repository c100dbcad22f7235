"""A body of any shape."""

from typing import TypedDict, Unpack

from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.world import World

type Pair = Vector2 | tuple[float, float]
"""A vector, or its two components."""


class BodyOptions(TypedDict, total=False):
    """Options of any body.

    Attributes
    ----------
    mass : float
        Its mass [kg]; 1 by default.
    velocity, angular_velocity : vector, float
        How it moves [m/s], [rad/s] counter-clockwise; not at all.
    angle : float
        How far it has turned [rad]; 0.
    restitution, friction : float
        Its surface, as in :class:`Material`; 0 and 0.5.
    fixed_rotation : bool
        Whether it keeps its angle whatever the torque.
    static : bool
        Whether it stays where it is; mass and velocity are then ignored.
    name : str
        Its id in scene files and reports.
    """

    mass: float
    velocity: Pair
    angular_velocity: float
    angle: float
    restitution: float
    friction: float
    fixed_rotation: bool
    static: bool
    name: str | None


def body(world: World, shape: Shape, position: Pair, **options: Unpack[BodyOptions]) -> int:
    """Spawn a body with its centre at ``position`` [m], with :class:`BodyOptions`; return its entity.

    Raises
    ------
    InvalidValue
        If a value is out of its range.
    TypeError
        If there is no such option.
    """
    known = BodyOptions.__annotations__
    unknown = options.keys() - known.keys()
    if unknown:
        raise TypeError(f"a body has no option {min(unknown)!r}; it has {', '.join(known)}")
    still = [
        Transform(position, options.get("angle", 0.0)),
        shape,
        Material(options.get("restitution", 0.0), options.get("friction", 0.5)),
    ]
    name = options.get("name")
    if options.get("static", False):
        return world.spawn(*still, name=name)
    velocity = Velocity(options.get("velocity", (0.0, 0.0)), options.get("angular_velocity", 0.0))
    mass = Mass(options.get("mass", 1.0), fixed_rotation=options.get("fixed_rotation", False))
    return world.spawn(*still, velocity, mass, name=name)
