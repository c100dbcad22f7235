"""Warnings of forces: what has no direction in one place, lost thrust and idle charges."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Charge, Held, Mass, Molecule, Thrust, Transform
from physicslab.diagnostics.step_warnings import ModelWarning
from physicslab.ecs.sentences import sentence
from physicslab.systems.coulomb import CoulombSystem
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.molecule import MoleculeSystem
from physicslab.systems.spring import SpringSystem
from physicslab.world import World

_RESOLVED, _SQUARED = 1e-15, 1e-150
"""Share of their largest coordinate, and distance [m], below which two places are one: its square is 0."""
_COULOMB = 8.9875517862e9
"""The constant of Coulomb's law in vacuum [N m^2/C^2] (CODATA 2022)."""
_SLOPE = 0.7548776662466927
"""Places are sorted along a direction in which no grid or line of bodies lies."""


def field_warnings(world: World) -> Iterator[ModelWarning]:
    """Yield what acts on each other in one place, a push on what cannot move, an idle charge."""
    yield from _coincident(world)
    springs = world.schedule.find(SpringSystem)
    for row in () if springs is None else springs.directionless(world)[:1]:
        spring = int(world.entity_index.entities[row])
        yield ModelWarning.about(world, spring, sentence("ends_in_one_place"), setting=sentence("apart"))
    thrust = world.batch(Thrust, Transform)
    lost = thrust.entities[world.bodies.inverse_mass[thrust.rows] == 0.0]
    lost = [entity for entity in lost.tolist() if not world.has(entity, Held)]
    if lost:
        what = sentence("idle_thrust")
        yield ModelWarning.about(world, lost[0], what, setting=sentence("velocity_and_mass"))
    charges, laws = world.batch(Charge, Transform), world.physics
    charged = charges.entities[world.table(Charge)["charge"][charges.rows] != 0.0]
    if len(charged) and not (laws.coulomb_constant or laws.magnetic_field or laws.electric_field.magnitude):
        what, setting = sentence("idle_charge"), f"physics.coulomb_constant = {_COULOMB:.5g}"
        yield ModelWarning.about(world, int(charged[0]), what, setting=setting)


def _coincident(world: World) -> Iterator[ModelWarning]:
    """Yield the first pair, for each law that has no force between two in one place."""
    rules = (
        (GravitySystem, Mass, "mass", sentence("law_of_gravity")),
        (CoulombSystem, Charge, "charge", sentence("coulomb")),
        (MoleculeSystem, Molecule, "depth", sentence("molecule_force")),
    )
    softened = world.physics.softening > 0.0
    for system, kind, weight, law in rules:
        force = world.schedule.find(system)
        if force is None or not (force.attractors > 1 or force.crowd > 1) or (softened and not force.crowd):
            continue
        rows = world.batch(kind, Transform).rows
        rows = rows[(world.table(kind)[weight][rows] != 0.0) & ~world.table(Held).present[rows]]
        pair = _in_one_place(world.table(Transform)["position"][rows])
        if pair is None or not world.bodies.inverse_mass[rows[list(pair)]].any():
            continue
        one, other = (int(world.entity_index.entities[rows[n]]) for n in pair)
        setting = sentence("apart") if force.crowd else sentence("apart_or_softened")
        warning = ModelWarning.about(world, one, sentence("one_place", law=law), setting=setting)
        yield replace(warning, because=sentence("too_near", body=world.label(other)))


def _in_one_place(position: NDArray[np.float64]) -> tuple[int, int] | None:
    """Return two of the places (n, 2) that are nearer to each other than numbers resolve, if any are."""
    if len(position) < 2:
        return None
    along = position[:, 0] + _SLOPE * position[:, 1]
    order = np.argsort(along, kind="stable")
    along, sorted_places = along[order], position[order]
    same = np.maximum(_RESOLVED * np.abs(sorted_places).max(axis=1), _SQUARED)
    for shift in range(1, len(order)):
        near = np.flatnonzero(along[shift:] - along[:-shift] <= 2.0 * same[shift:])
        if not len(near):
            return None
        apart = np.abs(sorted_places[near + shift] - sorted_places[near]).max(axis=1)
        found = near[apart <= same[near + shift]]
        if len(found):
            return int(order[found[0]]), int(order[found[0] + shift])
    return None
