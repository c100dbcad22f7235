"""Scenes in which most bodies move: mixed shapes that pour and fall, chains, boxes under turning gravity.

Each is made from a seed, so that it is the same in every run.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from physicslab.components import Spring
from physicslab.ecs.vector import Vector2
from physicslab.lab.bench.quality import overlap
from physicslab.lab.bench.scene import BenchScene
from physicslab.lab.worlds import GRAVITY, floor, open_space
from physicslab.prefabs import box, circle, container
from physicslab.world import World

__all__ = ["MOVING"]

_SIZES = (0.15, 0.3)
"""Width of a box, or diameter of a disc [m]."""
_PITCH = 0.45
"""Between the places of bodies at the start [m]: more than the diagonal of the largest box."""
_OVERLAP = 0.06
"""Deepest overlap that counts as right [m]: a quarter of a body of middle size, as bodies land on others."""
_TURN = math.radians(30.0)
"""How fast gravity turns [rad/s]."""


def _mixed(world: World, count: int, foot: Vector2, *, columns: int, discs: bool = True) -> None:
    """Spawn bodies in loose rows from ``foot`` upwards, every second of them a disc where ``discs``.

    Sizes and angles are random; the mass goes by the area, 1 kg/m^2.
    """
    random = np.random.default_rng(1)
    sizes, angles = random.uniform(*_SIZES, (count, 2)), random.uniform(0.0, 2.0 * math.pi, count)
    for i, ((width, height), angle) in enumerate(zip(sizes.tolist(), angles.tolist(), strict=True)):
        place = foot + Vector2((i % columns - (columns - 1) / 2.0) * _PITCH, (i // columns + 0.5) * _PITCH)
        if discs and i % 2:
            circle(world, place, radius=width / 2.0, mass=math.pi * width**2 / 4.0, angle=angle)
        else:
            box(world, place, width=width, height=height, mass=width * height, angle=angle)


def _slope(world: World, foot: Vector2, angle: float, length: float) -> None:
    """Spawn a static board whose upper side rises from ``foot`` at an angle [rad]."""
    along = Vector2.from_angle(angle)
    below = along.perpendicular * (-0.5 if math.cos(angle) > 0.0 else 0.5)
    box(world, foot + along * (length / 2.0) + below, width=length, height=1.0, angle=angle, static=True)


def _funnel(count: int, *, floored: bool) -> World:
    """Return mixed bodies above two slopes of 35 degrees, which leave a gap of 2 m."""
    world, steep, columns = open_space(collisions="step", contacts="soft"), math.radians(35.0), 50
    across = 0.5 * columns * _PITCH + 1.0
    for side in (-1.0, 1.0):
        angle = steep if side > 0.0 else math.pi - steep
        _slope(world, Vector2(side, 0.0), angle, (across - 1.0) / math.cos(steep))
        box(world, (side * (across + 0.5), 25.0), width=1.0, height=60.0, static=True)
    _mixed(world, count, Vector2(0.0, math.tan(steep) * across), columns=columns)
    if floored:
        container(world, (0.0, -12.0), width=60.0, height=8.0)
    return world


def _heap(count: int) -> World:
    """Return mixed bodies that fall into a container."""
    world = open_space(collisions="step", contacts="soft")
    container(world, width=20.0, height=30.0)
    _mixed(world, count, Vector2(0.0, 0.2), columns=40)
    return world


def _chains(count: int, discs: int = 10) -> World:
    """Return chains of discs on springs of omega dt = 1, bent a little, that fall flat on a floor."""
    world, random = open_space(collisions="step", contacts="soft"), np.random.default_rng(1)
    link, mass = 0.25, 0.1
    stiffness = mass / world.simulation.dt**2
    floor(world, width=2.0 * count * discs * link)
    for i in range(count):
        before, left = None, (i - count / 2.0) * (discs + 1) * link
        for j, (dx, dy) in enumerate(random.uniform(-0.02, 0.02, (discs, 2)).tolist()):
            disc = circle(world, (left + j * link + dx, 0.2 + dy), radius=0.1, mass=mass)
            if before is not None:
                world.add(disc, Spring(None, before, rest_length=link, stiffness=stiffness))
            before = disc
    return world


def _tumbler(count: int) -> World:
    """Return boxes between four walls."""
    world, columns = open_space(collisions="step", contacts="soft"), math.ceil(math.sqrt(count))
    inside = (columns + 2) * _PITCH
    container(world, width=inside, height=inside)
    box(world, (0.0, inside + 0.5), width=inside + 2.0, height=1.0, static=True)
    _mixed(world, count, Vector2(0.0, 0.2), columns=columns, discs=False)
    return world


def _turning_gravity(t: float) -> Vector2:
    return Vector2.from_angle(_TURN * t - math.pi / 2.0, GRAVITY)


_scene = partial(BenchScene, group="moving", quality=(overlap(_OVERLAP),), by_default=False)

MOVING = (
    _scene(
        name="funnel", title="3,000 mixed boxes and discs in a funnel, from which they fall for ever",
        size=3_000, build=partial(_funnel, 3_000, floored=False), seconds=5.0, steps=600,
    ),
    _scene(
        name="funnel_floor", title="the same funnel over a floor", size=3_000,
        build=partial(_funnel, 3_000, floored=True), seconds=5.0, steps=600,
    ),
    _scene(
        name="heap", title="2,000 mixed boxes and discs that fall into a heap", size=2_000,
        build=partial(_heap, 2_000),
    ),
    _scene(
        name="chains", title="200 chains of ten discs on springs, on a floor", size=2_000,
        build=partial(_chains, 200),
    ),
    _scene(
        name="tumbler", title="1,000 boxes between walls, gravity turning by 30 degrees a second", size=1_000,
        build=partial(_tumbler, 1_000), gravity_at=_turning_gravity,
    ),
)  # fmt: skip
"""Their scenes; none is run unless it is named."""
