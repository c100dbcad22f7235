"""The near pairs of a world as columns: bodies, overlaps and normals, and mass ratios under load."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Velocity
from physicslab.world import World

_COSINE_ABOVE = 0.5
"""Between gravity and the normal: from here on one body lies on the other, and not beside it."""


@dataclass(frozen=True, slots=True)
class ContactGraph:
    """Near pairs, and those of them that touch.

    Attributes
    ----------
    a, b : int64 arrays (pairs,)
        Rows of the bodies; 0 for the world's bounds.
    size : float64 array (pairs,)
        Of the smaller body [m].
    touching : int64 array (touching,)
        Which pairs touch.
    depth : float64 array (touching,)
        How deep these overlap [m]; negative where they are apart.
    normal : float64 array (touching, 2)
        Unit vectors from A to B.
    """

    a: NDArray[np.int64]
    b: NDArray[np.int64]
    size: NDArray[np.float64]
    touching: NDArray[np.int64]
    depth: NDArray[np.float64]
    normal: NDArray[np.float64]

    def lighter(self, world: World, pair: int) -> int:
        """Return the lighter body of a pair."""
        return self._larger(world, pair, world.bodies.inverse_mass)

    def faster(self, world: World, pair: int) -> int:
        """Return the faster body of a pair."""
        return self._larger(world, pair, np.hypot(*world.table(Velocity)["linear"].T))

    def _larger(self, world: World, pair: int, values: NDArray[np.float64]) -> int:
        """Return the body of a pair whose value (rows,) is larger; B where they are equal."""
        a, b = self.a[pair], self.b[pair]
        return int(world.entity_index.entities[a if values[a] > values[b] else b])

    def sharing_a_body(self, chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return which of the ``chosen`` pairs have a body in common with another of them (pairs,)."""
        if not chosen.any():
            return chosen
        rows = int(max(self.a.max(), self.b.max())) + 1
        count = np.bincount(self.a[chosen], minlength=rows) + np.bincount(self.b[chosen], minlength=rows)
        count[0] = 0  # the bounds, which are near many bodies
        return chosen & ((count[self.a] > 1) | (count[self.b] > 1))

    def mass_ratios(self, world: World) -> NDArray[np.float64]:
        """Return the mass ratio of each touching pair in which the heavier body lies on the lighter; else 0.

        Only pairs count whose lighter body touches a third, which supports it. Where planets attract each
        other no direction is down, and every pair with such a lighter body counts; where no force acts,
        nothing carries anything.
        """
        a, b = self.a[self.touching], self.b[self.touching]
        inverse = world.bodies.inverse_mass
        free = (inverse[a] > 0.0) & (inverse[b] > 0.0)
        ratio = np.zeros(len(a))
        if not (free.any() and world.has_forces):
            return ratio
        mass = world.table(Mass)["mass"]
        ratio[free] = np.maximum(mass[a[free]] / mass[b[free]], mass[b[free]] / mass[a[free]])
        light = np.where(mass[a] < mass[b], a, b)
        count = np.bincount(np.concatenate((a, b)))
        ratio[count[light] < 2] = 0.0
        if world.physics.gravity_mode == "linear" and world.physics.gravity:
            down = np.array(tuple(world.physics.gravity.normalized))
            towards_light = np.where(light == b, 1.0, -1.0) * (self.normal @ down)
            ratio[towards_light < _COSINE_ABOVE] = 0.0
        return ratio


def contact_graph(world: World) -> ContactGraph:
    """Return the near pairs of the last step."""
    contacts = world.contacts
    manifolds = contacts.manifolds[: contacts.recorded]
    contacts.sync()
    touching = np.flatnonzero(contacts.manifolds["count"][: contacts.recorded] > 0)
    held = manifolds[touching]
    separation = contacts.points["separation"]
    first, second = separation[2 * touching], separation[2 * touching + 1]
    depth = -np.where(held["count"] > 1, np.minimum(first, second), first)
    depth[held["count"] <= 0] = 0.0
    size = np.where(manifolds["size"] > 0.0, manifolds["size"], np.inf)  # 0 where nothing was measured yet
    return ContactGraph(
        manifolds["a"].copy(), manifolds["b"].copy(), size, touching.copy(), depth,
        np.stack((held["normal_x"], held["normal_y"]), axis=1),
    )  # fmt: skip
