"""Bodies that attract each other, on their orbits. The world must be in planet mode."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from physicslab.components import Mass, Trail, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.state.contents import Contents


@dataclass(frozen=True, slots=True)
class Planet:
    """A planet of :func:`planets`.

    Attributes
    ----------
    name : str
        Its id.
    mass : float
        [kg].
    distance : float
        From the star [m].
    angle : float
        Where it starts, counter-clockwise from the x axis [rad].
    """

    name: str
    mass: float
    distance: float
    angle: float = 0.0


def binary(
    world: Contents, masses: tuple[float, float] = (1.0, 1.0), *, separation: float = 2.0,
    eccentricity: float = 0.0, names: tuple[str | None, str | None] = (None, None), trail: float = 5.0,
) -> list[int]:  # fmt: skip
    """Spawn two point masses on Kepler orbits about the origin, which they circle with no momentum in total.

    They start where they are farthest apart, on the x axis, and go round counter-clockwise.

    Parameters
    ----------
    masses : tuple of two floats
        [kg].
    separation : float
        Their largest distance [m].
    eccentricity : float
        Eccentricity of both orbits; 0 is a circle, and it must be below 1.
    names : tuple of two strings, optional
        Their ids.
    trail : float
        How long a trail they draw [s].

    Raises
    ------
    ValueError
        If the eccentricity is not from 0 to below 1, or the separation is not above 0.
    """
    if not separation > 0.0:
        raise ValueError(f"separation = {separation!r}: must be a number > 0 m")
    if not 0.0 <= eccentricity < 1.0:
        raise ValueError(f"eccentricity = {eccentricity!r}: must be a number from 0 to below 1")
    total = sum(masses)
    # The vis-viva equation at the apoapsis r = a (1 + e): v^2 = G M (1 - e) / r.
    speed = math.sqrt(world.physics.G * total * (1.0 - eccentricity) / separation)
    shares = (-masses[1] / total, masses[0] / total)
    made: list[int] = []
    for share, mass, name in zip(shares, masses, names, strict=True):
        place, velocity = Transform((share * separation, 0.0)), Velocity((0.0, share * speed))
        made.append(world.spawn(place, velocity, Mass(mass), Trail(trail), name=name))
    return made


def planets(world: Contents, star: float, orbiting: Sequence[Planet], *, trail: float = 5.0) -> list[int]:
    """Spawn a star and planets around it, as point masses with no momentum in total; return the star first.

    Each planet has the speed of a circular orbit about the star alone; the others' pull makes it less of a
    circle.

    Parameters
    ----------
    star : float
        Mass of the star [kg], which starts at the origin.
    orbiting : sequence of Planet
        Planets that go round it, counter-clockwise.
    trail : float
        How long a trail they draw [s].

    Raises
    ------
    ValueError
        If a distance is not above 0.
    """
    recoil, moving = Vector2(), []
    for planet in orbiting:
        if not planet.distance > 0.0:
            raise ValueError(f"{planet.name}: distance = {planet.distance!r}: must be a number > 0 m")
        speed = math.sqrt(world.physics.G * (star + planet.mass) / planet.distance)
        velocity = Vector2.from_angle(planet.angle, speed).perpendicular
        recoil -= velocity * planet.mass
        moving.append((planet, velocity))
    # The star compensates the momentum of the planets: speeds are relative to it, momentum is not.
    drift = recoil / (star + sum(planet.mass for planet in orbiting))
    made = [world.spawn(Transform(), Velocity(drift), Mass(star), Trail(trail), name="star")]
    for planet, velocity in moving:
        place = Transform(Vector2.from_angle(planet.angle, planet.distance))
        made.append(
            world.spawn(place, Velocity(velocity + drift), Mass(planet.mass), Trail(trail), name=planet.name)
        )
    return made
