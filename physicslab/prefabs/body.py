"""Bodies: boxes, circles, and bodies of any shape."""

from collections.abc import Callable, Sequence
from functools import wraps
from typing import TypedDict, Unpack

from physicslab.components import Colour, MadeOf, Mass, Material, Shape, Transform, Velocity
from physicslab.components.made_of import SUBSTANCES
from physicslab.ecs.component import Component
from physicslab.ecs.text import no_such
from physicslab.ecs.vector import Vector2
from physicslab.state.contents import Contents

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
    material : str
        Its material, one of :data:`SUBSTANCES`, whose surface and colour it has unless they are given.
    colour : str
        As in :class:`Colour`.
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
    material: str
    colour: str
    name: str | None


def body(world: Contents, shape: Shape, position: Pair, **options: Unpack[BodyOptions]) -> int:
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
        raise TypeError(
            no_such("a body", "option", min(unknown), known, (spec.name for spec in Shape.FIELDS))
        )
    made = SUBSTANCES.get(options.get("material", ""))
    restitution, friction = (0.0, 0.5) if made is None else (made.restitution, made.friction)
    colour = options.get("colour", "" if made is None else made.colour)
    still: list[Component] = [
        Transform(position, options.get("angle", 0.0)),
        shape,
        Material(options.get("restitution", restitution), options.get("friction", friction)),
    ]
    still += [MadeOf(options["material"])] if "material" in options else []
    still += [Colour(colour)] if colour else []
    name = options.get("name")
    if options.get("static", False):
        return world.spawn(*still, name=name)
    velocity = Velocity(options.get("velocity", (0.0, 0.0)), options.get("angular_velocity", 0.0))
    mass = Mass(options.get("mass", 1.0), fixed_rotation=options.get("fixed_rotation", False))
    return world.spawn(*still, velocity, mass, name=name)


def _all_else_by_name[**P](make: Callable[P, int]) -> Callable[P, int]:
    """Return the same function; where it is given more than a world and a position, it says how."""

    @wraps(make)
    def checked(*args: P.args, **given: P.kwargs) -> int:
        if len(args) > 2:
            name, shown = make.__name__, ", ".join(map(repr, args[1:]))
            raise TypeError(f"{name}(world, {shown}): a position is one pair, as (0, 5); name all else")
        return make(*args, **given)

    return checked


@_all_else_by_name
def box(
    world: Contents, position: Pair, *, width: float = 0.5, height: float = 0.5,
    **options: Unpack[BodyOptions],
) -> int:  # fmt: skip
    """Spawn a rectangle of given extents [m] with its centre at ``position`` [m]; return its entity.

    Examples
    --------
    >>> from physicslab import World
    >>> world = World()
    >>> floor = box(world, (0, -0.5), width=20, height=1, static=True, name="floor")
    >>> world.component(floor, Shape).width
    20.0
    """
    return body(world, Shape.box(width, height), position, **options)


@_all_else_by_name
def capsule(
    world: Contents, position: Pair, *, length: float = 0.5, radius: float = 0.2,
    **options: Unpack[BodyOptions],
) -> int:  # fmt: skip
    """Spawn a capsule, whose round ends have centres ``length`` [m] apart, at ``position`` [m].

    Returns
    -------
    entity : int
        Its middle is at ``position``, and without an angle it lies along x.

    Examples
    --------
    >>> from physicslab import World
    >>> world = World()
    >>> pill = capsule(world, (0, 2), length=1, radius=0.25)
    >>> world.component(pill, Shape).length
    1.0
    """
    return body(world, Shape.capsule(length, radius), position, **options)


@_all_else_by_name
def circle(world: Contents, position: Pair, *, radius: float = 0.25, **options: Unpack[BodyOptions]) -> int:
    """Spawn a disc of a given radius [m] with its centre at ``position`` [m]; return its entity.

    Examples
    --------
    >>> from physicslab import World
    >>> world = World()
    >>> ball = circle(world, (0, 5), radius=0.1, mass=0.5, restitution=0.8, name="ball")
    >>> world.component(ball, Shape).radius
    0.1
    """
    return body(world, Shape.circle(radius), position, **options)


def polygon(
    world: Contents, position: Pair, vertices: Sequence[Pair], *, radius: float = 0.0,
    **options: Unpack[BodyOptions],
) -> int:  # fmt: skip
    """Spawn a convex polygon of 3 to 8 vertices [m], rounded by a radius [m]; return its entity.

    Vertices are counter-clockwise, from anywhere: its centre of mass is put at ``position`` [m].

    Examples
    --------
    >>> from physicslab import World
    >>> world = World()
    >>> wedge = polygon(world, (0, 0.5), [(0, 0), (3, 0), (0, 1.5)], name="wedge")
    >>> world.component(wedge, Shape).vertices[0]
    Vector2(x=-1.0, y=-0.5)
    """
    return body(world, Shape.polygon(vertices, radius), position, **options)
