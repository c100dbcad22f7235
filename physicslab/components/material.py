"""The surface of a body: restitution and friction."""

from typing import Any

import numpy as np

from physicslab.ecs.component import Component, Number, component, field


@component
class Material(Component):
    """The properties of a surface in contact: a pair uses e = min(e_a, e_b) and mu = sqrt(mu_a mu_b)."""

    restitution: Number = field(
        default=0.0, minimum=0.0, maximum=1.0, meaning="share of the approach speed given back"
    )
    friction: Number = field(default=0.5, minimum=0.0, meaning="Coulomb friction coefficient")


def friction_of_pair(one: Any, other: Any) -> Any:
    """Return mu of two surfaces, the root of both multiplied: of numbers, or of arrays (n,)."""
    return np.sqrt(one * other)


def restitution_of_pair(one: Any, other: Any) -> Any:
    """Return e of two surfaces, the smaller one: of numbers, or of arrays (n,)."""
    return np.minimum(one, other)
