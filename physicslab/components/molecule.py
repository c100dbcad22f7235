"""Molecules: bodies that attract each other at short distances and repel each other at shorter ones."""

from physicslab.ecs.component import Component, Number, component, field
from physicslab.ecs.fields import LENGTH_LIMIT


@component
class Molecule(Component):
    """Acts on every other molecule by the force of Lennard and Jones, as noble gases do.

    The energy of two is depth ((distance / r)^12 - 2 (distance / r)^6): least at ``distance``, by ``depth``.
    For unlike ones the depth is the geometric mean of both, the distance the arithmetic one.
    """

    depth: Number = field(default=1.0, unit="J", minimum=0.0, meaning="energy that parts two that rest")
    distance: Number = field(
        default=0.3, unit="m", above=0.0, limit=LENGTH_LIMIT, meaning="at which two of them rest"
    )
