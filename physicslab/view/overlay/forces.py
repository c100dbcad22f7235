"""Velocities, forces and contact normals as arrows, and the free-body diagram of the selection."""

from collections.abc import Sequence

import numpy as np

from physicslab.components import Transform, Velocity
from physicslab.diagnostics import free_body
from physicslab.diagnostics.present_forces import with_present_forces
from physicslab.ecs.vector import Vector2
from physicslab.languages.sentence import Sentence
from physicslab.view.canvas.camera import Drawing
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.quantities import quantity
from physicslab.view.overlay import arrows
from physicslab.view.overlay.contact_samples import resting_of
from physicslab.view.overlay.labels import Label
from physicslab.view.overlay.legend import FLIP, Gauge, Overlays
from physicslab.world import World

NORMAL_LENGTH = 26.0
"""Length of the arrows of contact normals, which are directions only [px]; shorter in a crowd."""


def draw_vectors(world: World, overlays: Overlays, on: Drawing) -> None:
    """Draw the velocity of each body that moves, the sum of the forces on it, and the normals of contacts.

    Forces are left out while a prediction is awaited.
    """
    applied = free_body.applied_forces(world)
    force = applied + free_body.joint_forces(world) + free_body.contact_forces(world)
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
    if not overlays.awaits_prediction:
        overlays.force.draw(world.table(Transform)["position"][pulled], force, arrows.FORCE, on)
    overlays.velocity.draw(position, linear, arrows.VELOCITY, on, parts=overlays.parts)
    contacts = resting_of(with_present_forces(world))
    contacts = contacts[contacts["normal"] > 0.0]
    start = on.camera.project(contacts["place"])
    length = min(NORMAL_LENGTH, max(0.5 * overlays.reach * on.camera.scale, arrows.MIN_LENGTH))
    arrows.draw_arrows(start, contacts["direction"] * FLIP * length, arrows.CONTACT_NORMAL, on)


# ---- the free-body diagram ---------------------------------------------------------------------------------


_PERIOD = 0.2
"""Time [s] after which forces are measured again while time runs: faster digits cannot be read."""


class Measured:
    """The measurements of one body.

    Attributes
    ----------
    forces : tuple of NamedForce
        Those on it; none where no body is measured.
    step : LastStep, optional
        Causes of its change of momentum in the last step, where known.
    number : int
        How often was measured: what shows the figures is built again where it has grown.
    """

    def __init__(self) -> None:
        self.forces: tuple[free_body.NamedForce, ...] = ()
        self.step: free_body.LastStep | None = None
        self.number = 0
        self._of: tuple[object, ...] = ()
        self._steps, self._until, self._place = -1, 0.0, Vector2()

    @property
    def net(self) -> Vector2:
        """The sum of the forces [N]."""
        return free_body.net_force(self.forces)

    def follow(self, world: World, entity: int | None, now: float, *, paused: bool) -> None:
        """Measure again where it is time for that, or where time stands still and something has changed.

        Parameters
        ----------
        entity : int, optional
            Whose forces are shown; ``None`` where none are.
        now : float
            Time [s] that the window has been open.
        """
        if entity is None or not world.has(entity, Transform):
            self.forces, self.step, self._of = (), None, ()
            return
        of = world, entity, world.motion_edits
        changed = of != self._of or (paused and world.steps != self._steps)
        if not changed and (now < self._until or world.steps == self._steps):
            return
        self._of, self._steps, self._until = of, world.steps, now + _PERIOD
        self.forces = free_body.forces_on(world, entity)
        self.step = free_body.last_step(world, entity, self.forces)
        self._place = world.component(entity, Transform).position
        self.number += 1

    def moved(self, world: World, entity: int) -> Vector2:
        """Return how far the body has come since it was measured [m]: arrows go with it."""
        return world.component(entity, Transform).position - self._place


# ---- drawing -----------------------------------------------------------------------------------------------


_WIDTH = arrows.BODY_FORCE.width
_KINDS = {
    "field": arrows.BODY_FORCE,
    "joint": arrows.BODY_FORCE,
    "normal": arrows.ArrowKind("Normal force", "normal_impulse", arrows.Head.DIAMOND, _WIDTH),
    "friction": arrows.ArrowKind("Friction", "friction_impulse", arrows.Head.OPEN, _WIDTH, dashed=True),
}
_REACH = 0.16
"""Length of the longest arrow, as a share of the smaller side of the picture."""


def draw_free_body(
    forces: Sequence[free_body.NamedForce], moved: Vector2, time: float, overlays: Overlays,
    covered: Sequence[Rect], on: Drawing,
) -> list[Rect]:  # fmt: skip
    """Draw the forces on a body as arrows that end with their names and sizes; one scale for all of them.

    Parameters
    ----------
    forces : sequence of NamedForce
        As they were measured last.
    moved : Vector2
        How far the body has come since [m].
    time : float
        Time of the world [s].
    covered : sequence of Rect
        Rectangles that names keep clear of [px].

    Returns
    -------
    list of Rect
        Where the names are [px].
    """
    gauge: Gauge = overlays.body_force
    sizes = np.array([one.force.magnitude for one in forces])
    gauge.follow(sizes, _REACH * min(on.camera.size) / on.camera.scale, time)
    if not len(forces) or not gauge.per_metre:
        return []
    labels = [_draw(one, moved, n, gauge, on) for n, one in enumerate(forces)]
    return list(overlays.force_labels.draw(labels, covered, on).values())


def _draw(one: free_body.NamedForce, moved: Vector2, number: int, gauge: Gauge, on: Drawing) -> Label:
    """Draw one arrow, and return its label."""
    start = on.camera.project(np.array([(one.place.x + moved.x, one.place.y + moved.y)]))
    span = np.array([(one.force.x, -one.force.y)]) * (on.camera.scale / gauge.per_metre)
    arrows.draw_arrows(start, span, _KINDS[one.kind], on)
    x, y = (start + span)[0].tolist()
    words = Sentence("{force}: {size}", force=one.name, size=quantity(one.force.magnitude, "N"))
    return Label((number, hash(one.name)), (x, y), [words])
