"""Impulses at contacts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from physicslab.components import Transform, Velocity
from physicslab.kernels.solver import impact, impulse
from physicslab.kernels.wide import slots
from physicslab.systems.broad_phase import nothing_to_touch
from physicslab.systems.schedule import Stage, System, at

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["ResolveSystem"]

_LIGHT_LOAD = 12.0
"""So many times its own weight a body carries without further ado."""


class ResolveSystem(System):
    """Bounces what approaches, keeps apart what rests, rubs what slides.

    Parameters
    ----------
    hertz, damping_ratio : float
        The contact spring that takes overlap away: frequency [Hz] (a quarter of the substep rate at the most)
        and damping ratio.
    max_push : float
        Fastest [m/s] that overlap is taken away.
    slop : float
        Overlap that is left alone, as a share of the smaller body's size.
    """

    kernels = (
        impact.resolve_impacts,
        impulse.solve,
        impulse.relax,
        impulse.separate,
        impulse.worst_load_ratio,
    )

    def __init__(
        self, hertz: float = 45.0, damping_ratio: float = 2.0, max_push: float = 1.5, slop: float = 0.0005
    ) -> None:
        self.hertz, self.damping_ratio, self.max_push, self.slop = hertz, damping_ratio, max_push, slop

    def why_left_out(self, world: World) -> str | None:
        """Needed where two things could ever meet."""
        return nothing_to_touch(world)

    def substep_factor(self, world: World) -> int:
        """Where bodies carry far heavier ones, the contact spring must be stiffer, and substeps shorter.

        Its stiffness goes by the lighter body: what carries a hundred times its weight sinks in by as much
        more. A frequency that is higher by the root of that takes it back.
        """
        contacts, bodies = world.contacts, world.bodies
        if not (contacts.count and world.has_forces and bodies.unequal):
            return 1
        contacts.sync()
        load = impulse.worst_load_ratio(
            contacts.manifolds, contacts.recorded, bodies.force, bodies.awake_inverse_mass
        )
        parts = 1
        while parts < impulse.MAX_SUBSTEP_FACTOR and parts * parts * _LIGHT_LOAD < load:
            parts *= 2
        return parts

    @at(Stage.IMPACT)
    def resolve_impacts(self, world: World, h: float) -> None:
        """Bounce the pairs that meet within the substep."""
        contacts, bodies = world.contacts, world.bodies
        transform, velocity = world.table(Transform), world.table(Velocity)
        start, end = world.method.stages.window
        contacts.left = 0
        while contacts.active:
            impacts, contacts.left = impact.resolve_impacts(
                contacts.manifolds, contacts.points, contacts.touching, contacts.active,
                transform["position"], transform["angle"], velocity["linear"], velocity["angular"],
                bodies.force, bodies.awake_inverse_mass, bodies.awake_inverse_inertia, world.has_forces,
                h, start * h, end * h,
            )  # fmt: skip
            world.collisions += impacts
            if not (impacts and self._wake(world, h)):
                break

    def _wake(self, world: World, h: float) -> bool:
        """After impacts, let settled contacts that may bounce take part in them; return whether any does."""
        contacts, bodies, velocity = world.contacts, world.bodies, world.table(Velocity)
        before = contacts.active
        if contacts.wide.filled:
            for constraints in contacts.wide.kinds:
                contacts.scalar_count, contacts.active = slots.wake(
                    *constraints.layout, contacts.manifolds, contacts.points, contacts.scalar,
                    contacts.scalar_count,
                    contacts.touching, contacts.active, velocity["linear"], velocity["angular"],
                    bodies.force, bodies.awake_inverse_mass, h,
                )  # fmt: skip
            contacts.wide.filled -= contacts.active - before
            contacts.unordered |= contacts.active > before
        return contacts.active > before

    @at(Stage.SOLVE)
    def solve(self, world: World, h: float) -> None:
        """Find the impulses that keep bodies apart, taking some of the overlap away."""
        contacts, bodies, velocity = world.contacts, world.bodies, world.table(Velocity)
        if contacts.left or contacts.wide.filled:
            # What an instant left behind is mostly rounding, which is not to be blown up.
            warm_start_scale = (
                h / max(contacts.impulse_dt, h / impulse.MAX_SUBSTEP_FACTOR)
                if contacts.impulse_dt > 0.0
                else 1.0
            )
            contacts.impulse_dt = h
            substep_factor = world.substeps / world.simulation.substeps
            impulse.solve(
                contacts.manifolds, contacts.points, contacts.touching, contacts.active,
                *contacts.wide.discs.solved, *contacts.wide.boxes.solved,
                velocity["linear"], velocity["angular"],
                bodies.awake_inverse_mass, bodies.awake_inverse_inertia,
                bodies.force, world.has_forces, h, warm_start_scale, world.simulation.iterations or 1,
                self.hertz * substep_factor, self.damping_ratio, self.slop,
            )  # fmt: skip

    @at(Stage.RELAX)
    def relax(self, world: World, h: float) -> None:
        """Take back the velocity that came from taking overlap away."""
        contacts, bodies, velocity = world.contacts, world.bodies, world.table(Velocity)
        if contacts.left or contacts.wide.filled:
            impulse.relax(
                contacts.manifolds, contacts.points, contacts.touching, contacts.active,
                *contacts.wide.discs.solved, *contacts.wide.boxes.solved,
                velocity["linear"], velocity["angular"],
                bodies.awake_inverse_mass, bodies.awake_inverse_inertia,
                h, world.simulation.iterations or 1,
            )  # fmt: skip
            impulse.separate(
                contacts.manifolds, contacts.points, contacts.touching, contacts.active,
                world.table(Transform)["position"], bodies.awake_inverse_mass, self.max_push * h,
            )  # fmt: skip
