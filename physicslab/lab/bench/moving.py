"""Scenes in which most bodies move: mixed shapes that pour and fall, chains, boxes under turning gravity.

Each is made from a seed, so that it is the same in every run, and states soft contacts.
"""

import math
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Spring
from physicslab.ecs.vector import Vector2
from physicslab.lab.bench.scene import BenchScene, Places, at_rest, largest_overlap, lost, overlap, within
from physicslab.lab.worlds import GRAVITY, floor, soft_space
from physicslab.prefabs import box, circle, container
from physicslab.world import World

_SIZES = (0.15, 0.3)
"""Width of a box, or diameter of a disc [m]."""
_PITCH = 0.45
"""Between the places of bodies at the start [m]: more than the diagonal of the largest box."""
_OVERLAP = 0.06
"""Deepest overlap that counts as right [m]: a quarter of a body of middle size, as bodies land on others."""
_LARGEST, _LANDING = 0.1, 0.2
"""Deepest overlap while bodies move, and while they land in a funnel at up to 20 m/s [m]: Box2D 3's."""
_KINETIC, _CREEP = 1e-3, 2e-3
"""Largest kinetic energy [J] and drift [m] of a heap that count as rest."""
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


def _columns(of_full_size: int, scale: float) -> int:
    """Return how many bodies a row has at the start."""
    return max(4, round(of_full_size * scale))


def funnel(count: int, *, floored: bool = True) -> World:
    """Return mixed bodies above two slopes of 35 degrees that leave a gap, with a container below or without.

    Lengths go by the root of the number, so that funnels of all sizes are alike; of 3,000 bodies the gap has
    2 m.
    """
    world, steep, scale = soft_space(), math.radians(35.0), math.sqrt(count / 3_000)
    columns = _columns(50, scale)
    across = 0.5 * columns * _PITCH + scale
    for side in (-1.0, 1.0):
        angle = steep if side > 0.0 else math.pi - steep
        _slope(world, Vector2(side * scale, 0.0), angle, (across - scale) / math.cos(steep))
        box(world, (side * (across + 0.5), 25.0 * scale), width=1.0, height=60.0 * scale, static=True)
    _mixed(world, count, Vector2(0.0, math.tan(steep) * across), columns=columns)
    if floored:
        container(world, (0.0, -12.0 * scale), width=60.0 * scale, height=8.0 * scale)
    return world


def heap(count: int) -> World:
    """Return mixed bodies that fall into a container."""
    world, scale = soft_space(), math.sqrt(count / 2_000)
    container(world, width=20.0 * scale, height=30.0 * scale)
    _mixed(world, count, Vector2(0.0, 0.2), columns=_columns(40, scale))
    return world


def chains(count: int, discs: int = 10) -> World:
    """Return chains of discs on springs of omega dt = 1, bent a little, that fall flat on a floor."""
    world, random = soft_space(), np.random.default_rng(1)
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


def tumbler(count: int) -> World:
    """Return boxes between four walls."""
    world, columns = soft_space(), math.ceil(math.sqrt(count))
    inside = (columns + 2) * _PITCH
    container(world, width=inside, height=inside)
    box(world, (0.0, inside + 0.5), width=inside + 2.0, height=1.0, static=True)
    _mixed(world, count, Vector2(0.0, 0.2), columns=columns, discs=False)
    return world


def _turning_gravity(t: float) -> Vector2:
    return Vector2.from_angle(_TURN * t - math.pi / 2.0, GRAVITY)


def _in_funnel(places: Places, *, count: int, floored: bool) -> NDArray[np.bool_]:
    """Return which bodies are between the walls, above the floor and not behind a slope."""
    scale, steep = math.sqrt(count / 3_000), math.radians(35.0)
    x, y = np.abs(places[:, 0]), places[:, 1]
    behind = (y > 0.0) & (x > scale + y / math.tan(steep) + 1.0 / math.sin(steep))
    outside = (y > 0.0) & (x > 0.5 * _columns(50, scale) * _PITCH + scale)  # lost bodies may fly anywhere
    if floored:
        outside |= (y < -12.0 * scale) | ((y < -4.0 * scale) & (x > 30.0 * scale))
    return ~(behind | outside)


_scene = partial(BenchScene, group="moving")
_overlaps = overlap(_OVERLAP), largest_overlap(_LARGEST)


def _funnel_scene(name: str, title: str, count: int, *, floored: bool = True, **more: Any) -> BenchScene:
    inside = partial(_in_funnel, count=count, floored=floored)
    return _scene(
        name=name, title=title, size=count, build=partial(funnel, count, floored=floored),
        quality=(overlap(_OVERLAP), largest_overlap(_LANDING), lost(inside)), **more,
    )  # fmt: skip


MOVING = (
    _funnel_scene(
        "funnel", "3,000 mixed boxes and discs in a funnel over a floor", 3_000, seconds=5.0, steps=600
    ),
    _funnel_scene(
        "funnel_open", "the same funnel without a floor: they fall on for ever", 3_000, floored=False,
        seconds=5.0, steps=600,
    ),
    _scene(
        name="heap", title="2,000 mixed boxes and discs that fall into a heap", size=2_000,
        build=partial(heap, 2_000),
        quality=(*_overlaps, *at_rest(_KINETIC, _CREEP), lost(within(10.0))),
    ),
    _scene(
        name="chains", title="200 chains of ten discs on springs, on a floor", size=2_000,
        build=partial(chains, 200), quality=(*_overlaps, lost(within(500.0))),
    ),
    _scene(
        name="tumbler", title="1,000 boxes between walls, gravity turning by 30 degrees a second", size=1_000,
        build=partial(tumbler, 1_000), gravity_at=_turning_gravity,
        quality=(*_overlaps, lost(within(7.65, top=15.3))),
    ),
)  # fmt: skip
"""Their scenes; none is run unless it is named."""

FUNNELS = tuple(
    _funnel_scene(
        f"funnel_{count}", f"a funnel of {count:,} mixed boxes and discs", count, group="funnels",
        seconds=3.0 * (count / 3_000) ** 0.25, steps=60,
    )
    for count in (1_000, 4_000, 16_000)
)  # fmt: skip
"""Funnels alike in shape, looked at when as much of each has flowed, for the growth of a step's cost."""
