"""Stronge's energetic law of impact at one point, for where Newton's law with friction would make energy.

The normal impulse grows from nothing (Darboux, Keller). While the point slides, the tangential impulse grows
by mu times as much, against the sliding; once that has stopped, the point sticks, or slides the other way
where friction cannot hold it. Velocities are linear in the normal impulse in each of these parts. It grows
until the normal force has given back e^2 times the work that it took until the approach ended (Stronge, Proc.
R. Soc. A 431 (1990) 169; Wang & Mason, J. Appl. Mech. 59 (1992) 635; Stewart, SIAM Rev. 42 (2000) 3).
Friction acts against the sliding at any moment: energy never grows.
"""

import math

from physicslab.kernels import inlined

__all__ = ["energetic_blow"]

_HELD = 1e-15
"""Share of the normal response that is left to a point that sticks, against rounding."""


@inlined
def energetic_blow(
    kn: float, kt: float, between: float, v: float, sliding: float, restitution: float, friction: float
) -> tuple[float, float]:
    """Return the normal and the tangential impulse of a point that approaches [N s].

    A normal impulse changes its approach ``v`` < 0 [m/s] by ``kn`` and its ``sliding`` [m/s] by ``between``,
    a tangential one by ``between`` and ``kt`` [1/kg].
    """
    # The tangential impulse for each unit of the normal one, before and after the sliding stops.
    before = -friction if sliding > 0.0 else friction
    after = min(max(-between / kt, -friction), friction)
    slowed, stopped = between + kt * before, 0.0
    rise1, rise2 = kn + between * before, max(kn + between * after, _HELD * kn)
    if slowed * sliding < 0.0:
        stopped = -sliding / slowed
    elif sliding != 0.0 and rise1 > 0.0:
        stopped = math.inf
    if rise1 > 0.0 and v + rise1 * stopped >= 0.0:  # the approach ends while it slides
        left = v + rise1 * stopped
        if left >= -restitution * v:
            normal = -(1.0 + restitution) * v / rise1
            return normal, before * normal
        given = (restitution * restitution * v * v - left * left) / rise1
        normal = given / (left + math.sqrt(left * left + rise2 * given))
        return stopped + normal, before * stopped + after * normal
    left = v + rise1 * stopped
    taken = left * left / rise2 - (v + left) * stopped
    normal = (restitution * math.sqrt(rise2 * taken) - left) / rise2
    return stopped + normal, before * stopped + after * normal
