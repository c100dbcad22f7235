"""Which entity it is by which an energy or a momentum is no longer finite, while its state still is."""

import math

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_momentum
from physicslab.state.account import Energy
from physicslab.state.packed import spring_ends
from physicslab.world import World


@np.errstate(all="ignore")
def find_overflow(world: World, energy: Energy) -> str | None:
    """Return what of a world has left the range of numbers, naming entity, component and value; or ``None``.

    Parameters
    ----------
    world : World
        Its state is finite; products of its numbers may not be.
    energy : Energy
        Its energy as it is now.

    Returns
    -------
    str or None
        For instance ``"ball: Velocity.linear = [1e+200, 0] m/s: its kinetic energy is not finite"``.
    """
    momentum = measure_momentum(world)
    sums = energy.total, *momentum.linear, momentum.angular
    if all(map(math.isfinite, sums)):
        return None
    position, linear = world.table(Transform)["position"], world.table(Velocity)["linear"]
    angular, mass = world.table(Velocity)["angular"], world.table(Mass)["mass"]
    inertia, free = world.table(Mass)["inertia"], world.bodies.inverse_mass > 0.0
    fast, spin = np.hypot(linear[:, 0], linear[:, 1]), np.abs(angular)
    arm = np.hypot(position[:, 0], position[:, 1])
    terms: tuple[tuple[str, str, NDArray[np.float64], NDArray[np.float64], str], ...] = (
        ("Velocity.linear", "m/s", 0.5 * mass * fast * fast, linear, "kinetic energy"),
        ("Velocity.angular", "rad/s", 0.5 * inertia * spin * spin, angular, "kinetic energy of rotation"),
        ("Velocity.linear", "m/s", mass * fast, linear, "momentum"),
        ("Transform.position", "m", mass * fast * arm, position, "angular momentum about the origin"),
        ("Velocity.angular", "rad/s", inertia * spin, angular, "angular momentum"),
    )
    for field, unit, values, column, noun in terms:
        values = np.where(free, values, 0.0)
        row = int(np.argmax(~np.isfinite(values)))
        if not math.isfinite(values[row]):
            return _line(world, row, field, column[row], unit, f"its {noun} is not finite")
        if not math.isfinite(values.sum()):
            row = int(np.argmax(values))
            what = f"with it the {noun} of all is not finite"
            return _line(world, row, field, column[row], unit, what)
    return _potential(world, energy)


def _potential(world: World, energy: Energy) -> str:
    """Return whose potential energy it is: the spring that is longest, or the body that is furthest out."""
    names = [name for name, stored in energy.potential.items() if not math.isfinite(stored)]
    what = f"the potential energy of {' and '.join(names) or 'all forces'} is not finite"
    if "spring" in names:
        rows, a, b = spring_ends(world)
        ends = world.table(Transform)["position"]
        apart = ends[b] - ends[a]
        lengths = np.hypot(apart[:, 0], apart[:, 1])
        spring = world.table(Spring)
        stored = spring["stiffness"][rows] * (lengths + spring["rest_length"][rows]) ** 2
        row = int(rows[np.argmax(np.nan_to_num(stored, nan=np.inf))])
        return _line(world, row, "Spring.stiffness", spring["stiffness"][row], "N/m", what)
    position = world.table(Transform)["position"]
    weight = np.where(world.bodies.inverse_mass > 0.0, np.abs(position).max(axis=1), -1.0)
    weight *= np.maximum(world.table(Mass)["mass"], 1.0)
    row = int(np.argmax(weight))
    return _line(world, row, "Transform.position", position[row], "m", what)


def _line(
    world: World, row: int, field: str, value: NDArray[np.float64] | float, unit: str, what: str
) -> str:
    words = ", ".join(f"{number:.6g}" for number in np.atleast_1d(value).tolist())
    words = f"[{words}]" if np.ndim(value) else words
    return f"{world.label_of_row(row)}: {field} = {words} {unit}: {what}"
