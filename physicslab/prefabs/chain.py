"""Hanging things: chains of balls on springs, pendulums on rods or springs."""

from physicslab.components import Rod, Spring, Transform
from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import Pair, circle
from physicslab.state.contents import Contents


def chain(
    world: Contents, count: int, start: Pair, end: Pair, *, hold_end: bool = False, radius: float = 0.1,
    mass: float = 0.1, stiffness: float = 500.0, damping: float = 0.5,
) -> list[int]:  # fmt: skip
    """Spawn ``count`` balls on a line, joined by springs, the first to a fixed point; return them in order.

    Parameters
    ----------
    start, end : vector
        The fixed point, and where the line ends [m]: at the last ball, or a spring beyond it if ``hold_end``.
    hold_end : bool
        Whether the end is a fixed point too.
    radius, mass : float
        Radius [m] and mass [kg] of each ball.
    stiffness, damping : float
        Stiffness [N/m] and damping [N s/m] of each spring; all are at their rest length.

    Raises
    ------
    ValueError
        If ``count`` is less than 1.
    """
    if count < 1:
        raise ValueError(f"count = {count!r}: must be a whole number >= 1")
    first, last = Vector2(*start), Vector2(*end)
    link = (last - first) / (count + 1 if hold_end else count)
    balls: list[int] = []
    for i in range(1, count + 1):
        ball = circle(world, first + link * i, radius=radius, mass=mass)
        # Each ball carries the spring to the one before it, the first ball that to the fixed point.
        before, anchor = (balls[-1], Vector2()) if balls else (None, first)
        world.add(ball, Spring(None, before, (0.0, 0.0), anchor, link.magnitude, stiffness, damping))
        balls.append(ball)
    if hold_end:
        world.spawn(Spring(balls[-1], None, (0.0, 0.0), last, link.magnitude, stiffness, damping))
    return balls


def pendulum(
    world: Contents, anchor: Pair, *, length: float = 2.0, angle: float = 0.5, radius: float = 0.2,
    stiffness: float | None = None, damping: float = 0.0, mass: float = 1.0, restitution: float = 0.0,
    friction: float = 0.5, name: str | None = None,
) -> int:  # fmt: skip
    """Spawn a disc that hangs from a fixed point on a rod, or on a spring; return its entity.

    The end is at the bob's centre, so that it swings without being turned. A rod and a spring push, too.

    Parameters
    ----------
    anchor : vector
        The point of the world it hangs from [m].
    length : float
        Length of the rod, or rest length of the spring: the bob's distance at the start [m].
    angle : float
        Where the bob is at the start: from straight down, counter-clockwise [rad].
    radius : float
        Radius of the bob [m].
    stiffness, damping : float, optional
        Those of a spring in place of the rod [N/m, N s/m]; its stretch is the bob's weight by the stiffness.
    mass, restitution, friction, name : optional
        Mass of the bob [kg], the numbers of its surface, its id.

    Raises
    ------
    ValueError
        If there is a damping and no stiffness.
    """
    if stiffness is None and damping:
        raise ValueError(f"damping = {damping!r}: needs a stiffness, for a spring in place of the rod")
    length, angle = Spring(rest_length=length).rest_length, Transform(angle=angle).angle  # texts have units
    hanging = Vector2(0.0, -length).rotated(angle)
    bob = circle(
        world, Vector2(*anchor) + hanging,
        radius=radius, mass=mass, restitution=restitution, friction=friction, name=name,
    )  # fmt: skip
    if stiffness is None:
        world.add(bob, Rod(anchor_b=anchor, length=length))
    else:
        world.add(bob, Spring(anchor_b=anchor, rest_length=length, stiffness=stiffness, damping=damping))
    return bob
