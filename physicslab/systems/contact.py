"""Where near bodies touch."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from physicslab.components import Material, Shape, Transform, Velocity
from physicslab.kernels import contact
from physicslab.schedule import Stage, System, at
from physicslab.systems.broad_phase import nothing_to_touch

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["ContactSystem"]


class ContactSystem(System):
    """Finds the contact points of near pairs: normal from A to B, separation, arms, effective masses.

    Boxes that have hardly moved against each other keep their points; bodies that are fast for their size are
    swept, so that none passes through another.
    """

    kernels = (contact.find_contacts,)
    observes = False  # what it begins anew at a step is its own record

    def __init__(self) -> None:
        self._bounds = np.zeros(4)
        self._first = True

    def why_left_out(self, world: World) -> str | None:
        """Needed where two things could ever meet."""
        return nothing_to_touch(world)

    @at(Stage.PREPARE)
    def begin(self, world: World, h: float) -> None:
        """Begin a new record of impacts."""
        self._first = True
        if world.physics.bounds is not None:
            self._bounds[:] = world.physics.bounds

    @at(Stage.CONTACT)
    def find(self, world: World, h: float) -> None:
        """Find or refresh the points of every near pair."""
        transform, velocity = world.table(Transform), world.table(Velocity)
        shape, material = world.table(Shape), world.table(Material)
        contacts, bodies, physics = world.contacts, world.bodies, world.physics
        contacts.count = contact.find_contacts(
            contacts.manifolds, contacts.points, contacts.candidate_pairs, contacts.touching,
            transform["position"], transform["angle"], velocity["linear"], velocity["angular"],
            shape["kind"], shape["radius"], shape["width"], shape["height"],
            material["restitution"], material["friction"], bodies.inverse_mass, bodies.inverse_inertia,
            self._bounds, physics.bounds_restitution, physics.bounds_friction, self._first, h,
            world.method.stages.window[0],
            0.5 * physics.gravity.magnitude * h * h if physics.gravity_mode == "linear" else 0.0,
        )  # fmt: skip
        self._first = False
