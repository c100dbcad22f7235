"""Where near bodies touch."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material, Shape, Transform, Velocity
from physicslab.kernels.broad import near_pairs
from physicslab.kernels.narrow import contact
from physicslab.kernels.narrow.pair import CONTACT_MARGIN, SWEEP_THRESHOLD
from physicslab.kernels.wide import refresh
from physicslab.systems.broad_phase import nothing_to_touch
from physicslab.systems.schedule import Stage, System, at

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["ContactSystem"]


class ContactSystem(System):
    """Finds the contact points of near pairs: normal from A to B, separation, arms, effective masses.

    Boxes that have hardly moved against each other keep their points; bodies that are fast for their size are
    swept, so that none passes through another.
    """

    kernels = (near_pairs.activate, contact.find_contacts)
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
        contacts, bodies = world.contacts, world.bodies
        if contacts.wide.filled:
            self._refresh(world, h, self.speculative_margin(world, h))
            contacts.changed()
        contacts.in_order(len(world.entity_index))
        contacts.activate(world, h, self.speculative_margin(world, h))
        contacts.active = self.find_among(
            world, contacts.scalar, contacts.scalar_count, contacts.touching,
            bodies.awake_inverse_mass, bodies.awake_inverse_inertia, self._first, h,
        )  # fmt: skip
        self.add_constraints(world, h)

    def find_among(
        self, world: World, pairs: NDArray[np.int64], count: int, touching: NDArray[np.int64],
        inverse_mass: NDArray[np.float64], inverse_inertia: NDArray[np.float64], first: bool, h: float,
    ) -> int:  # fmt: skip
        """Find or refresh the points of ``count`` of the pairs; return how many of them touch."""
        transform, velocity = world.table(Transform), world.table(Velocity)
        shape, material = world.table(Shape), world.table(Material)
        contacts, physics = world.contacts, world.physics
        return contact.find_contacts(
            contacts.manifolds, contacts.points, pairs, count, touching,
            transform["position"], transform["angle"], velocity["linear"], velocity["angular"],
            shape["kind"], shape["radius"], shape["width"], shape["height"],
            material["restitution"], material["friction"], inverse_mass, inverse_inertia,
            self._bounds, physics.bounds_restitution, physics.bounds_friction, first, h,
            world.method.stages.window[0], self.speculative_margin(world, h),
        )  # fmt: skip

    def speculative_margin(self, world: World, h: float) -> float:
        """Return how far [m] uniform gravity may bring two bodies together within a time h."""
        physics = world.physics
        return 0.5 * physics.gravity.magnitude * h * h if physics.gravity_mode == "linear" else 0.0

    def add_constraints(self, world: World, h: float) -> None:
        """Once a step, take what has settled into blocks."""
        if self._first and world.method.collisions == "step":
            world.contacts.add_constraints(world, h)
            world.contacts.changed()
        self._first = False

    def _refresh(self, world: World, h: float, speculative_margin: float) -> None:
        """Find where settled contacts touch now; those that are settled no longer join the loose ones."""
        contacts, transform, velocity = world.contacts, world.table(Transform), world.table(Velocity)
        if self._first:
            contacts.refill(world)
        before = contacts.scalar_count
        for constraints in contacts.wide.kinds:
            contacts.scalar_count = refresh.refresh(
                *constraints.layout, contacts.manifolds, contacts.points, contacts.scalar,
                contacts.scalar_count,
                transform["position"], transform["angle"], velocity["linear"], velocity["angular"],
                self._first, h, SWEEP_THRESHOLD, CONTACT_MARGIN, speculative_margin, contact.CACHE_TOLERANCE,
                contact.CACHE_TURN_TOLERANCE,
            )  # fmt: skip
        contacts.wide.filled -= contacts.scalar_count - before
        contacts.unordered |= contacts.scalar_count > before
