"""Warnings about the model of contacts: how far soft ones may be off, and impacts that no law determines."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Velocity
from physicslab.diagnostics.step_warnings import ModelWarning
from physicslab.ecs.sentences import sentence
from physicslab.stepping.contact_model import why_not_rigid
from physicslab.stepping.plan import WITHOUT_END
from physicslab.stepping.rigid import Rigid
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
        Size of the smaller body [m].
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

    def carrying(self, world: World) -> Iterator[tuple[int, float]]:
        """Yield bodies that stand on others, each with the mass welded on it as a multiple of its own.

        A whole whose heaviest body stands on something itself is left out.
        """
        wholes, masses = world.joints.wholes, world.table(Mass)["mass"]
        if not wholes or world.physics.gravity_mode != "linear" or not world.physics.gravity:
            return
        along = self.normal @ np.array(tuple(world.physics.gravity.normalized))
        a, b = self.a[self.touching], self.b[self.touching]
        standing = {*a[along > _COSINE_ABOVE].tolist(), *b[along < -_COSINE_ABOVE].tolist()}
        members: dict[int, list[int]] = {}
        for entity, whole in wholes.items():
            members.setdefault(whole, []).append(world.entity_index.row_of.get(entity, 0))
        for rows in members.values():
            heaviest = max(rows, key=lambda row: float(masses[row]))
            if heaviest not in standing and (world.bodies.inverse_mass[rows] > 0.0).all():
                for row in sorted(standing.intersection(rows)):
                    yield int(world.entity_index.entities[row]), float(masses[heaviest] / masses[row])


def contact_graph(world: World) -> ContactGraph:
    """Return the near pairs of the last step."""
    contacts = world.contacts
    contacts.sync()
    manifolds = contacts.manifolds[: contacts.recorded]
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


RIGID_LIMIT = 64
"""Number of contacts up to which rigid ones are advised where soft ones are not exact enough."""
_LATEST = 1000
"""Number of impacts that are looked at, the last ones."""
_SAME_TIME = 1e-12
"""Share of a step within which impacts are at one moment."""
_BETTER = sentence("smaller_dt_or_fewer")
_ALIGNED = 1e-9
"""Deviation of a cosine from 0 and from 1 that is rounding."""


def contact_warnings(world: World, rigid: Rigid | None) -> Iterator[ModelWarning]:
    """Yield what is wrong with the contacts of a world, which ``rigid`` advances if they may be rigid."""
    yield from _softness(world, rigid)
    if world.plan.contacts == "rigid" or world.plan.collisions == "exact":
        yield from _undetermined(world)


def rigid_setting(world: World, touching: int) -> str:
    """Return the setting for rigid contacts, nothing where they are chosen, not possible, or too many."""
    tried = world.plan.contacts == "rigid" or world.plan.contact_reason == WITHOUT_END
    if tried or touching > RIGID_LIMIT:
        return ""
    return 'simulation.contacts = "rigid"' if why_not_rigid(world, world.schedule) is None else ""


def _softness(world: World, rigid: Rigid | None) -> Iterator[ModelWarning]:
    """Yield the possible error of soft contacts, if they were not chosen.

    A contact that closes is found with the error of a fall within a substep, and under a load it gives way.
    """
    plan, simulation = world.plan, world.simulation
    chosen = simulation.contacts == "auto" and plan.contacts == "soft" and plan.collisions == "step"
    left = rigid is not None and rigid.left_to_soft > 0
    graph = contact_graph(world) if chosen or left else None
    if graph is None or not (len(graph.touching) or world.collisions):
        return
    forces = np.hypot(*world.bodies.force.T) * world.bodies.inverse_mass
    h = simulation.dt / simulation.substeps
    off = max(float(forces.max(initial=0.0)) * h * h, float(graph.depth.max(initial=0.0)))
    setting = rigid_setting(world, len(graph.touching)) or _BETTER
    if off > 0.0:  # why steps were left to them has a line of its own
        why = "" if left else plan.contact_reason
        yield ModelWarning(None, sentence("soft_contacts"), off, "m", 0.0, setting, because=why)


def _undetermined(world: World) -> Iterator[ModelWarning]:
    """Yield the bodies of the last impacts that had one body at one moment, and how many moments there were.

    Newton's law gives what a pair does alone. Whether several impulses on one body act together, or one
    after the other, is a choice: together where pairs approach together, in turn where one passes it on.
    Bodies welded together count as one.
    """
    records = world.contacts.impacts_since(world.contacts.logged - _LATEST)
    records = records[records["restitution"] > 0.0]
    records = records[np.argsort(records["time"], kind="stable")]
    apart = _SAME_TIME * world.simulation.dt + 1e-15 * abs(world.time)
    moment = np.cumsum(np.diff(records["time"], prepend=-np.inf) > apart)
    index = np.arange(len(records))
    free_a, free_b = records["inverse_mass_a"] > 0.0, records["inverse_mass_b"] > 0.0
    of = np.concatenate((index[free_a], index[free_b]))
    wholes = world.joints.wholes
    one, two = (
        np.array([wholes.get(entity, entity) for entity in records[end].tolist()], np.int64)
        for end in ("entity_a", "entity_b")
    )
    body, other = np.concatenate((one[free_a], two[free_b])), np.concatenate((two[free_a], one[free_b]))
    order = np.lexsort((of, body, moment[of]))
    of, body, other = of[order], body[order], other[order]
    first, second = of[:-1], of[1:]
    shared = (moment[first] == moment[second]) & (body[:-1] == body[1:]) & (other[:-1] != other[1:])
    cosine = np.abs(
        records["normal_x"][first] * records["normal_x"][second]
        + records["normal_y"][first] * records["normal_y"][second]
    )
    rubs = np.maximum(records["friction"][first], records["friction"][second]) > 0.0
    alone = ~(free_a & free_b)
    flat = alone[first] & alone[second] & (cosine > 1.0 - _ALIGNED)
    shared &= ~flat & (rubs | (cosine > _ALIGNED))
    found = np.flatnonzero(shared)
    if not len(found):
        return
    k = int(found[-1])
    bodies = [int(number) for number in (body[k], other[k], other[k + 1]) if number]
    names = ", ".join(dict.fromkeys(world.label(number) for number in bodies))
    moments = len(np.unique(moment[first[found]]))
    yield ModelWarning(names, sentence("undetermined"), float(moments), limit=0.0)
