"""Velocities, forces and contact normals, as arrows."""

import numpy as np

from physicslab.components import Transform, Velocity
from physicslab.diagnostics.free_body import applied_forces, contact_forces
from physicslab.view.canvas.drawing import Drawing
from physicslab.view.overlay.arrows import CONTACT_NORMAL, FORCE, MIN_LENGTH, VELOCITY, draw_arrows
from physicslab.view.overlay.contact_samples import resting_of
from physicslab.view.overlay.overlays import Overlays
from physicslab.world import World

NORMAL_LENGTH = 26.0
"""Length of the arrows of contact normals, which are directions only [px]; shorter in a crowd."""


def draw_vectors(world: World, overlays: Overlays, on: Drawing) -> None:
    """Draw the velocity of each body that moves, the sum of the forces on it, and the normals of contacts."""
    applied = applied_forces(world)
    force = applied + contact_forces(world)
    rows = world.batch(Transform, Velocity).rows
    position = world.table(Transform)["position"][rows]
    linear = world.table(Velocity)["linear"][rows]
    pulled = rows[world.bodies.inverse_mass[rows] > 0.0]
    force, applied = force[pulled], applied[pulled]
    # The velocity that contacts remove is the scale of the rest: a rounding of it is no force, and no motion.
    strength = np.hypot(applied[:, 0], applied[:, 1])
    sizes = np.concatenate((np.hypot(force[:, 0], force[:, 1]), strength))
    overlays.force.follow(sizes, overlays.reach, world.time)
    pull = strength * world.bodies.inverse_mass[pulled] * world.simulation.dt
    speed = np.concatenate((np.hypot(linear[:, 0], linear[:, 1]), pull))
    overlays.velocity.follow(speed, overlays.reach, world.time)
    flip = np.array((1.0, -1.0))  # the screen's y points down
    if overlays.force.per_metre:
        start = on.camera.project(world.table(Transform)["position"][pulled])
        span = force * flip * (on.camera.scale / overlays.force.per_metre)
        draw_arrows(start, span, FORCE, on)
    if overlays.velocity.per_metre:
        span = linear * flip * (on.camera.scale / overlays.velocity.per_metre)
        draw_arrows(on.camera.project(position), span, VELOCITY, on)
    contacts = resting_of(world)
    contacts = contacts[contacts["normal"] > 0.0]
    start = on.camera.project(contacts["place"])
    length = min(NORMAL_LENGTH, max(0.5 * overlays.reach * on.camera.scale, MIN_LENGTH))
    draw_arrows(start, contacts["direction"] * flip * length, CONTACT_NORMAL, on)
