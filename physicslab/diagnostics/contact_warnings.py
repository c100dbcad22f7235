"""Warnings about the model of contacts: how far soft ones may be off, and impacts that no law determines."""

from collections.abc import Iterator

import numpy as np

from physicslab.diagnostics.contact_graph import contact_graph
from physicslab.diagnostics.step_warnings import ModelWarning
from physicslab.stepping.contact_model import why_not_rigid
from physicslab.stepping.rigid import Rigid
from physicslab.world import World

RIGID_LIMIT = 64
"""Number of contacts up to which rigid ones are advised where soft ones are not exact enough."""
_LATEST = 1000
"""Number of impacts that are looked at, the last ones."""
_SAME_TIME = 1e-12
"""Share of a step within which impacts are at one moment."""
_BETTER = "a smaller simulation.dt, or fewer bodies"
_ALIGNED = 1e-9
"""Deviation of a cosine from 0 and from 1 that is rounding."""


def contact_warnings(world: World, rigid: Rigid | None) -> Iterator[ModelWarning]:
    """Yield what is wrong with the contacts of a world, which ``rigid`` advances if they may be rigid."""
    yield from _softness(world, rigid)
    if world.plan.contacts == "rigid" or world.plan.collisions == "exact":
        yield from _undetermined(world)


def rigid_setting(world: World, touching: int) -> str:
    """Return the setting for rigid contacts, nothing where they are chosen, not possible, or too many."""
    if world.plan.contacts == "rigid" or touching > RIGID_LIMIT:
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
    what = "contacts are soft; a stack that barely stands may fall, and contacts are off by about so much"
    setting = rigid_setting(world, len(graph.touching)) or _BETTER
    if off > 0.0:  # why steps were left to them has a line of its own
        why = "" if left else plan.contact_reason
        yield ModelWarning(None, what, off, "m", 0.0, setting, because=why)


def _undetermined(world: World) -> Iterator[ModelWarning]:
    """Yield the bodies of the last impacts that had one body at one moment, and how many moments there were.

    Newton's law gives what a pair does alone. Whether several impulses on one body act together, or one
    after the other, is a choice: together where pairs approach together, in turn where one passes it on.
    """
    log, logged = world.contacts.log, world.contacts.logged
    count = min(logged, len(log), _LATEST)
    records = log[np.arange(logged - count, logged) % max(len(log), 1)]
    records = records[records["restitution"] > 0.0]
    records = records[np.argsort(records["time"], kind="stable")]
    apart = _SAME_TIME * world.simulation.dt + 1e-15 * abs(world.time)
    moment = np.cumsum(np.diff(records["time"], prepend=-np.inf) > apart)
    index = np.arange(len(records))
    free_a, free_b = records["inverse_mass_a"] > 0.0, records["inverse_mass_b"] > 0.0
    of = np.concatenate((index[free_a], index[free_b]))
    body = np.concatenate((records["entity_a"][free_a], records["entity_b"][free_b]))
    other = np.concatenate((records["entity_b"][free_a], records["entity_a"][free_b]))
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
    what = (
        "meet at one moment, and no law determines which impulses act together and which in turn: "
        "the outcome is one of several (moments)"
    )
    moments = len(np.unique(moment[first[found]]))
    yield ModelWarning(names, what, float(moments), "", 0.0, "")
