"""How large the quantities of a world are: what is far smaller than that is rounding."""

import numpy as np

from physicslab.components import Mass, Transform, Velocity
from physicslab.world import World


@np.errstate(all="ignore")
def scales_of(world: World) -> dict[str, float]:
    """Return for each unit of motion, as ``"kg m^2/s"``, how large such quantities are in a world.

    They follow from the total mass, the largest coordinate, and the largest speed or what gravity adds to a
    speed in a step.

    Examples
    --------
    >>> world = World()
    >>> ball = world.spawn(Transform((0, 5)), Velocity((3, 4)), Mass(2.0))
    >>> scales = scales_of(world)
    >>> scales["m"], scales["m/s"], scales["J"]
    (5.0, 5.0, 50.0)
    """
    rows, placed = world.batch(Transform, Velocity).rows, world.batch(Transform).rows
    velocity, dt = world.table(Velocity), world.simulation.dt
    length = _largest(world.table(Transform)["position"][placed])
    speed = float(np.hypot(*velocity["linear"][rows].T).max(initial=0.0))
    if world.physics.gravity_mode == "linear":
        speed = max(speed, world.physics.gravity.magnitude * dt)
    turning = max(_largest(velocity["angular"][rows]), speed / length if length > 0.0 else 0.0)
    mass = float(world.table(Mass)["mass"][world.batch(Transform, Velocity, Mass).rows].sum())
    momentum, energy = mass * speed, mass * speed * speed
    return {
        "m": length, "rad": 1.0, "m/s": speed, "rad/s": turning, "m/s^2": speed / dt, "N": momentum / dt,
        "kg m/s": momentum, "N s": momentum, "kg m^2/s": length * momentum, "N m s": length * momentum,
        "J": energy,
    }  # fmt: skip


def _largest(values: object) -> float:
    return float(np.abs(np.asarray(values)).max(initial=0.0))
