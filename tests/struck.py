"""Random worlds in which much is struck: discs and boxes, fixed, driven and free, by each stepper."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab import World
from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.systems.standard import standard_systems

KINDS = ("step", "no forces", "rigid", "exact", "flat", "symplectic_euler")
"""What random worlds there are."""


def random_world(kind: str, random: np.random.Generator) -> World:
    """Return a world of a few bodies in a box of walls that will strike each other."""
    gravity = Vector2() if kind == "no forces" else Vector2(float(random.uniform(-3.0, 3.0)), -9.81)
    physics = PhysicsConfig(
        gravity=gravity, bounds=(-3.0, -3.0, 3.0, 3.0), bounds_restitution=float(random.random()),
        bounds_friction=float(random.choice((0.0, 0.3, 0.8))),
    )  # fmt: skip
    settings: dict[str, Any] = {"dt": 1 / 60, "sleeping": False, "contacts": "soft"}
    if kind == "rigid":
        settings["contacts"] = "rigid"
    if kind == "exact":
        settings["collisions"] = "exact"
    elif kind != "rigid":
        settings["collisions"] = "step"
    if kind == "symplectic_euler":
        settings["integrator"] = kind
    world = World(*standard_systems(), physics=physics, simulation=SimulationConfig(**settings))
    places = [(x, y) for x in (-2.0, -0.7, 0.7, 2.0) for y in (-2.0, -0.7, 0.7, 2.0)]
    for n in random.permutation(len(places))[: 4 if kind == "rigid" else 7].tolist():
        _spawn(world, kind, places[n], random)
    world.contacts.read = True
    return world


def _spawn(world: World, kind: str, place: tuple[float, float], random: np.random.Generator) -> None:
    disc = random.random() < 0.4 and kind != "flat"
    shape = (
        Shape.circle(float(random.uniform(0.1, 0.45)))
        if disc
        else Shape.box(*random.uniform(0.15, 0.8, 2).tolist())
    )
    angle = 0.0 if kind == "flat" else float(random.uniform(-3.0, 3.0))
    spin = 0.0 if kind == "flat" else float(random.normal(0.0, 3.0))
    restitution = float(random.choice((0.0, 0.3, 0.8, 1.0, random.random())))
    parts: list[Any] = [
        Transform(place, angle), shape, Material(restitution, float(random.choice((0.0, 0.2, 0.6, 1.2)))),
    ]  # fmt: skip
    chance = random.random()
    if chance > 0.12:  # else it is fixed
        across = 0.3 if kind == "flat" else 3.0
        parts.append(Velocity((random.normal(0.0, across), random.normal(0.0, 3.0)), spin))
    if chance > 0.2 or kind in ("exact", "rigid"):  # else it is driven, and infinitely heavy
        fixed = not disc and (kind == "exact" or random.random() < 0.1)
        parts.append(Mass(float(10.0 ** random.uniform(-1.0, 1.0)), fixed_rotation=fixed))
    if chance <= 0.12:
        parts = [part for part in parts if not isinstance(part, Mass)]
    world.spawn(*parts)


def impacts_of(kind: str, random: np.random.Generator, seconds: float = 3.0) -> NDArray[Any]:
    """Return the impacts of a random world, an array of IMPACT."""
    world = random_world(kind, random)
    world.run(seconds=seconds)
    impacts: NDArray[Any] = world.contacts.impacts
    return impacts
