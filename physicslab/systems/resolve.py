"""Impulses at contacts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from physicslab.components import Transform, Velocity
from physicslab.kernels import impact, impulse
from physicslab.schedule import Stage, System, at
from physicslab.systems.broad_phase import nothing_to_touch

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["ResolveSystem"]


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

    kernels = (impact.strike, impulse.solve, impulse.relax, impulse.separate)

    def __init__(
        self, hertz: float = 45.0, damping_ratio: float = 2.0, max_push: float = 1.0, slop: float = 0.0005
    ) -> None:
        self.hertz, self.damping_ratio, self.max_push, self.slop = hertz, damping_ratio, max_push, slop

    def why_left_out(self, world: World) -> str | None:
        """Needed where two things could ever meet."""
        return nothing_to_touch(world)

    @at(Stage.IMPACT)
    def strike(self, world: World, h: float) -> None:
        """Bounce the pairs that meet within the substep."""
        contacts, bodies = world.contacts, world.bodies
        transform, velocity = world.table(Transform), world.table(Velocity)
        start, end = world.method.stages.window
        if contacts.count:
            impacts, contacts.left = impact.strike(
                contacts.manifolds, contacts.points, contacts.touching, contacts.count,
                transform["position"], transform["angle"], velocity["linear"], velocity["angular"],
                bodies.force, bodies.inverse_mass, bodies.inverse_inertia, world.has_forces,
                h, start * h, end * h,
            )  # fmt: skip
            world.collisions += impacts

    @at(Stage.SOLVE)
    def solve(self, world: World, h: float) -> None:
        """Find the impulses that keep bodies apart, taking some of the overlap away."""
        contacts, bodies, velocity = world.contacts, world.bodies, world.table(Velocity)
        if contacts.count and contacts.left:
            impulse.solve(
                contacts.manifolds, contacts.points, contacts.touching, contacts.count,
                velocity["linear"], velocity["angular"], bodies.inverse_mass, bodies.inverse_inertia,
                bodies.force, world.has_forces, h, world.simulation.iterations or 1,
                self.hertz, self.damping_ratio, self.slop,
            )  # fmt: skip

    @at(Stage.RELAX)
    def relax(self, world: World, h: float) -> None:
        """Take back the velocity that came from taking overlap away."""
        contacts, bodies, velocity = world.contacts, world.bodies, world.table(Velocity)
        if contacts.count and contacts.left:
            impulse.relax(
                contacts.manifolds, contacts.points, contacts.touching, contacts.count,
                velocity["linear"], velocity["angular"], bodies.inverse_mass, bodies.inverse_inertia,
                h, world.simulation.iterations or 1,
            )  # fmt: skip
            impulse.separate(
                contacts.manifolds, contacts.points, contacts.touching, contacts.count,
                world.table(Transform)["position"], bodies.inverse_mass, self.max_push * h,
            )  # fmt: skip
