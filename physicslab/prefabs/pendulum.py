"""A bob on a stiff spring."""

from physicslab.components import Spring
from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import Pair
from physicslab.prefabs.circle import circle
from physicslab.world import World


def pendulum(
    world: World,
    anchor: Pair,
    *,
    length: float = 2.0,
    angle: float = 0.5,
    radius: float = 0.2,
    stiffness: float = 5_000.0,
    damping: float = 0.0,
    mass: float = 1.0,
    restitution: float = 0.0,
    friction: float = 0.5,
    name: str | None = None,
) -> int:
    """Spawn a disc that hangs from a fixed point by a spring, stiff enough for a rod; return its entity.

    The bob's centre is the spring's end, so that it swings without being turned. The spring pushes too.

    Parameters
    ----------
    anchor : vector
        The point of the world it hangs from [m].
    length : float
        Rest length of the spring, and the bob's distance at the start [m].
    angle : float
        Where the bob is at the start: from straight down, counter-clockwise [rad].
    radius : float
        Of the bob [m].
    stiffness, damping : float
        Of the spring [N/m], [N s/m]; it gives way by about the bob's weight over the stiffness.
    mass, restitution, friction, name : optional
        Of the bob: [kg], the numbers of its surface, its id.
    """
    hanging = Vector2(0.0, -length).rotated(angle)
    bob = circle(
        world, Vector2(*anchor) + hanging,
        radius=radius, mass=mass, restitution=restitution, friction=friction, name=name,
    )  # fmt: skip
    world.add(bob, Spring(anchor_b=anchor, rest_length=length, stiffness=stiffness, damping=damping))
    return bob
