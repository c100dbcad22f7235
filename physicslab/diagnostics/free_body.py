"""The forces on one body by name, as a free-body diagram shows them, and their sum on every body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform, Velocity
from physicslab.contacts.report import ContactPoint, contacts_of
from physicslab.ecs.vector import Vector2
from physicslab.state.masses import quiet
from physicslab.stepping.forces import forces_by_system
from physicslab.world import World

__all__ = ["NamedForce", "applied_forces", "contact_forces", "forces_on", "net_force"]

type Kind = Literal["field", "normal", "friction"]

_NAMES = {"GravitySystem": "weight", "SpringSystem": "springs", "DragSystem": "air"}
"""What forces are called, by the system that they come from."""
_ROUNDING = 1e-12
"""Forces below this share of the largest are rounding, and left out."""


@dataclass(frozen=True, slots=True)
class NamedForce:
    """One force on a body.

    Attributes
    ----------
    name : str
        What it is, in words.
    force : Vector2
        The force [N]: of a contact the mean of the last substep, impacts left out.
    place : Vector2
        Where it acts [m].
    kind : str
        ``"field"``, or for a contact ``"normal"`` or ``"friction"``.
    """

    name: str
    force: Vector2
    place: Vector2
    kind: Kind


def forces_on(world: World, entity: int) -> tuple[NamedForce, ...]:
    """Return the forces on a body as they are now, by what brings them about; of one that cannot move none.

    Springs and gravity are those of the present state of motion, contacts those of the last substep.
    """
    moves = world.has(entity, Velocity) and world.has(entity, Mass) and world.has(entity, Transform)
    if not moves:
        return ()
    centre = world.component(entity, Transform).position
    row = world.entity_index.row_of[entity]
    found = [
        NamedForce(_field_name(world, name), Vector2(*force[row].tolist()), centre, "field")
        for name, force in _fields(world).items()
    ]
    for contact in contacts_of(world, entity):
        on_b = contact.b == entity
        other = world.label(contact.a if on_b else contact.b) if contact.a and contact.b else "the wall"
        sign = 1.0 if on_b else -1.0
        normal, tangent = contact.normal, contact.normal.perpendicular
        total_n = sum(point.normal_force for point in contact.points)
        total_t = sum(point.tangent_force for point in contact.points)
        place = _place(contact.points)
        found.append(NamedForce(f"normal, from {other}", sign * total_n * normal, place, "normal"))
        found.append(NamedForce(f"friction, from {other}", sign * total_t * tangent, place, "friction"))
    largest = max((one.force.magnitude for one in found), default=0.0)
    return tuple(one for one in found if one.force.magnitude > _ROUNDING * largest)


def net_force(forces: tuple[NamedForce, ...]) -> Vector2:
    """Return the sum of forces [N]."""
    return sum((one.force for one in forces), Vector2())


def applied_forces(world: World) -> NDArray[np.float64]:
    """Return the sum of all forces but those of contacts on each row (n, 2) [N], at the present state."""
    return sum(_fields(world).values(), np.zeros_like(world.bodies.force))


def contact_forces(world: World) -> NDArray[np.float64]:
    """Return what contacts and bounds exert on each row (n, 2) [N], as :func:`forces_on` has it."""
    contacts = world.contacts
    contacts.sync()
    total = np.zeros_like(world.bodies.force)
    pairs = np.flatnonzero(contacts.manifolds["count"][: contacts.recorded] > 0)
    if not len(pairs) or contacts.impulse_dt <= 0.0:
        return total
    near = contacts.manifolds[pairs]
    normal, tangent = np.zeros(len(pairs)), np.zeros(len(pairs))
    for k in range(2):
        points, used = contacts.points[2 * pairs + k], k < near["count"]
        normal += np.where(used, points["normal_impulse"], 0.0)
        tangent += np.where(used, points["tangent_impulse"], 0.0)
    x, y = near["normal_x"], near["normal_y"]
    on_b = np.stack((normal * x - tangent * y, normal * y + tangent * x), axis=1) / contacts.impulse_dt
    np.add.at(total, near["b"], on_b)
    bodies = near["entity_a"] > 0  # the others are the world's bounds
    np.subtract.at(total, near["a"][bodies], on_b[bodies])
    return total


@quiet
def _fields(world: World) -> dict[str, NDArray[np.float64]]:
    with world.active():
        world.synchronise()
        return forces_by_system(world, world.schedule)


def _field_name(world: World, system: str) -> str:
    if system == "GravitySystem" and world.physics.gravity_mode == "planet":
        return "gravity of the others"
    return _NAMES.get(system, system.removesuffix("System").lower())


def _place(points: tuple[ContactPoint, ...]) -> Vector2:
    """Return where the normal forces of a contact act together [m]."""
    total = sum(point.normal_force for point in points)
    if total <= 0.0:
        return sum((point.position for point in points), Vector2()) / len(points)
    return sum((point.position * (point.normal_force / total) for point in points), Vector2())
