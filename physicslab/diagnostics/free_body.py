"""The forces on one body by name, as a free-body diagram shows them, and their sum on every body."""

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform, Velocity
from physicslab.contacts.arguments import motion_of
from physicslab.contacts.islands import impulse_spans
from physicslab.contacts.report import ContactPoint, contacts_of
from physicslab.diagnostics.present_forces import with_present_forces
from physicslab.ecs.vector import Vector2, rotated
from physicslab.languages.sentence import Sentence
from physicslab.state import joint_figures
from physicslab.state.joints import Joint
from physicslab.state.masses import quiet
from physicslab.stepping.forces import forces_by_system
from physicslab.world import World

type Kind = Literal["field", "joint", "normal", "friction"]

_DAMPING, _WALL = Sentence("damping"), Sentence("the wall")
_NAMES = {
    "GravitySystem": "weight", "SpringSystem": "springs", "DragSystem": "air", "CoulombSystem": "charges",
    "ElectricFieldSystem": "electric field", "MagneticFieldSystem": "magnetic field",
    "MediumSystem": "fluid", "MoleculeSystem": "molecules",
}  # fmt: skip
"""Names of forces, by their system."""
_LONGEST = 1.5
"""How long the last step may have been, in steps of the scene: what is longer was not one step."""
_LEAST_SHARE = 1e-12
"""Forces below this share of the largest are rounding, and left out."""


class Pair(NamedTuple):
    """A contact of a body: the other body in words, and the friction and restitution of the pair."""

    other: str
    friction: float
    restitution: float


@dataclass(frozen=True, slots=True)
class NamedForce:
    """One force on a body.

    Attributes
    ----------
    name : str
        Its name in words.
    force : Vector2
        The force [N]: of a contact the mean of the last substep, impacts left out.
    place : Vector2
        Where it acts [m].
    kind : str
        ``"field"``, ``"joint"``, or for a contact ``"normal"`` or ``"friction"``.
    pair : Pair, optional
        The pair of surfaces of a normal force.
    """

    name: str
    force: Vector2
    place: Vector2
    kind: Kind
    pair: Pair | None = None


def forces_on(world: World, entity: int) -> tuple[NamedForce, ...]:
    """Return the forces on a body as they are now, by what brings them about; of one that cannot move none.

    Springs and gravity are those of the present state of motion, contacts and soft joints those of the last
    substep; before the first step, and after an edit, those of a step that would begin now.
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
    damping = world.physics.linear_damping
    if damping > 0.0:
        velocity, mass = world.component(entity, Velocity).linear, world.component(entity, Mass).mass
        found.append(NamedForce(_DAMPING, -damping * mass * velocity, centre, "field"))
    now = with_present_forces(world)
    row = now.entity_index.row_of[entity]
    for number, pull in joint_figures.forces_on(now, row).items():
        joint = now.joints.joints[number]
        at = _end(now, joint, row)
        found.append(NamedForce(_joint_name(world, joint), Vector2(*pull.tolist()), at, "joint"))
    for contact in contacts_of(now, entity):
        on_b = contact.b == entity
        other = world.label(contact.a if on_b else contact.b) if contact.a and contact.b else _WALL
        sign = 1.0 if on_b else -1.0
        normal, tangent = contact.normal, contact.normal.perpendicular
        total_n = sum(point.normal_force for point in contact.points)
        total_t = sum(point.tangent_force for point in contact.points)
        by_normal = Sentence("normal, from {body}", body=other)
        by_friction = Sentence("friction, from {body}", body=other)
        place, pair = _place(contact.points), Pair(other, contact.friction, contact.restitution)
        found.append(NamedForce(by_normal, sign * total_n * normal, place, "normal", pair))
        found.append(NamedForce(by_friction, sign * total_t * tangent, place, "friction"))
    largest = max((one.force.magnitude for one in found), default=0.0)
    return tuple(one for one in found if one.force.magnitude > _LEAST_SHARE * largest)


def _joint_name(world: World, joint: Joint) -> str:
    """Return the name of a joint in words; of one that is a component of a body, its kind: ``"rod"``."""
    is_body = world.has(joint.entity, Transform)
    return Sentence(joint.kind.__name__.lower()) if is_body else world.label(joint.entity)


@dataclass(frozen=True, slots=True)
class LastStep:
    """Changes of the momentum of a body in the last step, by cause.

    Attributes
    ----------
    dt : float
        How long it was [s].
    impulses : dict of str to Vector2
        The impulse of each force, contact and impact by name [N s].
    change : Vector2
        The change of momentum [kg m/s].
    struck : Vector2
        The part of the impulses that is of impacts [N s].
    """

    dt: float
    impulses: dict[str, Vector2]
    change: Vector2
    struck: Vector2

    @property
    def difference(self) -> Vector2:
        """The change of momentum that the impulses do not account for [N s].

        Impulses of springs, drag and damping are the mean of those before and after the step times its
        length, those of contacts and joints the last substep's: where forces change within it, the sum is no
        exact one.
        """
        return self.change - sum(self.impulses.values(), Vector2())

    @property
    def inertia(self) -> Vector2:
        """Mass times the mean acceleration in that step, without impacts [N]."""
        return (self.change - self.struck) / self.dt


def last_step(world: World, entity: int, present: tuple[NamedForce, ...] | None = None) -> LastStep | None:
    """Return the changes of the momentum of a body in the last step; ``None`` if they are not known.

    ``present`` are the forces on it as they are now, where they are known already.

    It is not of what cannot move, after a longer run than one step, after an edit, and after going to another
    place of the history. Impacts are those of the world's log (``contacts.read``).
    """
    checkpoint, dt = world.checkpoint, world.time - world.checkpoint.time
    if not (world.forces_known and 0.0 < dt <= _LONGEST * world.simulation.dt):
        return None
    present = forces_on(world, entity) if present is None else present
    row = world.entity_index.row_of[entity]
    inverse = float(world.bodies.inverse_mass[row])
    if inverse == 0.0:
        return None
    now, before = Vector2(*motion_of(world)[2][row].tolist()), Vector2(*checkpoint.columns[2][row].tolist())
    impulses: dict[str, Vector2] = {}
    for name, force in _fields_before(world).items():
        if force[row].any():
            impulses[_field_name(world, name)] = 0.5 * dt * Vector2(*force[row].tolist())
    for one in present:
        share = 0.5 * dt if one.kind == "field" and one.name != _DAMPING else dt
        impulses[one.name] = impulses.get(one.name, Vector2()) + share * one.force
    if _DAMPING in impulses:
        impulses[_DAMPING] = -dt * world.physics.linear_damping / inverse * 0.5 * (now + before)
    struck = _impacts(world, entity)
    for name, impulse in struck.items():
        impulses[name] = impulses.get(name, Vector2()) + impulse
    return LastStep(dt, impulses, (now - before) / inverse, sum(struck.values(), Vector2()))


def _fields_before(world: World) -> dict[str, NDArray[np.float64]]:
    """Return the force of each system on each row (n, 2) [N] as it was before the last step."""
    columns = motion_of(world)
    with world.active():
        world.synchronise()
        now = [column.copy() for column in columns]
        try:
            world.checkpoint.restore(columns)  # of which nothing is told: it is no edit for islands to follow
            return forces_by_system(world, world.schedule)
        finally:
            for column, kept in zip(columns, now, strict=True):
                column[...] = kept


def _impacts(world: World, entity: int) -> dict[str, Vector2]:
    """Return the impulses of the impacts of the last step on a body [N s], by the other body."""
    found = dict[str, Vector2]()
    for record in world.contacts.impacts_since(world.checkpoint.counts[2]):
        a, b = int(record["entity_a"]), int(record["entity_b"])
        if entity not in (a, b):
            continue
        normal = Vector2(float(record["normal_x"]), float(record["normal_y"]))
        on_b = (
            float(record["normal_impulse"]) * normal + float(record["tangent_impulse"]) * normal.perpendicular
        )
        other = a if entity == b else b
        name = Sentence("impact, with {body}", body=world.label(other) if other else _WALL)
        found[name] = found.get(name, Vector2()) + (on_b if entity == b else -on_b)
    return found


def net_force(forces: tuple[NamedForce, ...]) -> Vector2:
    """Return the sum of forces [N]."""
    return sum((one.force for one in forces), Vector2())


def applied_forces(world: World) -> NDArray[np.float64]:
    """Return the sum of all forces on each row (n, 2) [N] but those of contacts and joints, at present."""
    return sum(_fields(world).values(), np.zeros_like(world.bodies.force))


def joint_forces(world: World) -> NDArray[np.float64]:
    """Return the forces of joints on each row (n, 2) [N], as in :func:`forces_on`."""
    now = with_present_forces(world)
    total = joint_figures.forces_on_all(now)
    total[0] = 0.0
    return _by_row(world, now, total)


def contact_forces(world: World) -> NDArray[np.float64]:
    """Return the forces of contacts and bounds on each row (n, 2) [N], as in :func:`forces_on`."""
    now = with_present_forces(world)
    contacts = now.contacts
    contacts.sync()
    total = np.zeros_like(now.bodies.force)
    pairs = np.flatnonzero(contacts.manifolds["count"][: contacts.recorded] > 0)
    spans = impulse_spans(now, pairs)
    pairs, spans = pairs[spans > 0.0], spans[spans > 0.0]
    if not len(pairs):
        return _by_row(world, now, total)
    near = contacts.manifolds[pairs]
    normal, tangent = np.zeros(len(pairs)), np.zeros(len(pairs))
    for k in range(2):
        points, used = contacts.points[2 * pairs + k], k < near["count"]
        normal += np.where(used, points["normal_impulse"], 0.0)
        tangent += np.where(used, points["tangent_impulse"], 0.0)
    x, y = near["normal_x"], near["normal_y"]
    on_b = np.stack((normal * x - tangent * y, normal * y + tangent * x), axis=1) / spans[:, None]
    np.add.at(total, near["b"], on_b)
    bodies = near["entity_a"] > 0  # the others are the world's bounds
    np.subtract.at(total, near["a"][bodies], on_b[bodies])
    return _by_row(world, now, total)


def _by_row(world: World, now: World, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return values (rows, 2) of the rows of ``now`` by those that the same entities have in a world."""
    if now is world:
        return values
    rows = now.entity_index.rows_of(world.entity_index.entities)
    return np.where(rows[:, None] > 0, values[rows], 0.0)


@quiet
def _fields(world: World) -> dict[str, NDArray[np.float64]]:
    with world.active():
        world.synchronise()
        return forces_by_system(world, world.schedule)


def _field_name(world: World, system: str) -> str:
    if system == "GravitySystem" and world.physics.gravity_mode == "planet":
        return Sentence("gravity of the others")
    return Sentence(_NAMES.get(system, system.removesuffix("System").lower()))


def _end(world: World, joint: Joint, row: int) -> Vector2:
    """Return where a joint holds a body [m]."""
    joints, transform = world.joints, world.table(Transform)
    anchor = joints.anchor_a[joint.first] if row == joints.a[joint.first] else joints.anchor_b[joint.first]
    return Vector2(*(transform["position"][row] + rotated(anchor, transform["angle"][row])).tolist())


def _place(points: tuple[ContactPoint, ...]) -> Vector2:
    """Return where the normal forces of a contact act together [m]."""
    total = sum(point.normal_force for point in points)
    if total <= 0.0:
        return sum((point.position for point in points), Vector2()) / len(points)
    return sum((point.position * (point.normal_force / total) for point in points), Vector2())
