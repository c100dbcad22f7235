"""Scenes in which most bodies move: shapes that pour and fall, chains, boxes under turning gravity, joints.

Each is made from a seed, so that it is the same in every run, and states soft contacts. Speed must also hold
for scenes that were not used while the engine was made: those of `UNTUNED` were made after the work on the
others was done, and left so.
"""

import math
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Pin, Spring
from physicslab.ecs.vector import Vector2
from physicslab.lab.bench.scene import (
    BenchScene,
    Places,
    at_rest,
    largest_overlap,
    lost,
    overlap,
    stretched,
    within,
)
from physicslab.lab.worlds import GRAVITY, floor, soft_space
from physicslab.prefabs import box, circle, container, ragdoll, regular_polygon
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


_LARGEST_UNTUNED = 0.25
"""Deepest overlap at any time that counts as right [m], in scenes that the engine was not tuned for."""
_STEPS, _BOARDS = 30, 6
"""How many steps the stairs have, and boards the zigzag."""


def stairs(count: int) -> World:
    """Return discs and boxes in turn that fall on stairs and bounce down them into a container."""
    world, random = soft_space(), np.random.default_rng(11)
    for n in range(_STEPS):
        box(world, (n * 1.0, -0.5 * n - 5.0), width=1.0, height=10.0, static=True, friction=0.4)
    container(world, (_STEPS + 9.0, -0.5 * _STEPS - 6.0), width=20.0, height=12.0)
    for n in range(count):
        place = (1.0 + n % 40 * 0.6, 4.0 + n // 40 * 0.6)
        size = float(random.uniform(0.15, 0.4))
        if n % 2:
            circle(world, place, radius=0.5 * size, mass=size**2, restitution=0.3)
        else:
            box(world, place, width=size, height=0.7 * size, mass=0.7 * size**2, restitution=0.3)
    return world


def dominoes(count: int) -> World:
    """Return dominoes in a row, the first of which a ball hits."""
    world = soft_space()
    floor(world, width=0.4 * count + 40.0)
    for n in range(count):
        box(world, (0.35 * n, 0.5), width=0.1, height=1.0, mass=0.5, friction=0.4)
    circle(world, (-2.0, 0.7), radius=0.3, mass=3.0, velocity=(6.0, 0.0))
    return world


def struck_wall(rows: int, columns: int) -> World:
    """Return a wall of bricks in bond that heavy discs hit at 15 m/s, one after the other."""
    world = soft_space()
    floor(world, width=400.0)
    for row in range(rows):
        for column in range(columns):
            x = column * 0.6 + (0.3 if row % 2 else 0.0)
            box(world, (x, 0.15 + 0.3 * row), width=0.6, height=0.3, mass=2.0, friction=0.7)
    for n in range(5):
        start = (-8.0 - 12.0 * n, 1.0 + 1.2 * n)
        circle(world, start, radius=0.5, mass=40.0, velocity=(15.0, 3.0 + n))
    return world


def hail(count: int) -> World:
    """Return discs whose sizes differ by a factor of ten, that fall into a container."""
    world, random = soft_space(), np.random.default_rng(12)
    container(world, width=14.0, height=40.0)
    radii = np.exp(random.uniform(math.log(0.05), math.log(0.5), count))
    for n, radius in enumerate(radii.tolist()):
        place = (n % 12 * 1.1 - 6.05, 1.0 + n // 12 * 1.1)
        circle(world, place, radius=radius, mass=math.pi * radius**2, restitution=0.2)
    return world


def zigzag(count: int) -> World:
    """Return boxes that slide down boards which lead from side to side."""
    world, random = soft_space(), np.random.default_rng(13)
    container(world, (0.0, -3.5 * _BOARDS - 6.0), width=16.0, height=6.0)
    for n in range(_BOARDS):
        side = 1.0 if n % 2 else -1.0
        board = (1.5 * side, -3.5 * n)
        box(world, board, width=13.0, height=0.4, angle=0.35 * side, static=True, friction=0.2)
    sizes = random.uniform(0.15, 0.35, (count, 2)).tolist()
    for n, (width, height) in enumerate(sizes):
        place = Vector2(-5.0 + n % 20 * 0.45, 3.5 + n // 20 * 0.45)
        box(world, place, width=width, height=height, mass=width * height, friction=0.2)
    return world


_untuned = partial(BenchScene, group="untuned", seconds=5.0)
_quality_untuned = overlap(_OVERLAP), largest_overlap(_LARGEST_UNTUNED)

UNTUNED = (
    _untuned(
        name="stairs", title="1,500 discs and boxes that fall on stairs", size=1_500,
        build=partial(stairs, 1_500), quality=_quality_untuned,
    ),
    _untuned(
        name="dominoes_400", title="400 dominoes, a ball hits the first", size=400,
        build=partial(dominoes, 400), quality=_quality_untuned,
    ),
    _untuned(
        name="struck_wall", title="a wall of 800 bricks that heavy discs hit", size=800,
        build=partial(struck_wall, 20, 40), quality=(*_quality_untuned, lost(within(400.0))),
    ),
    _untuned(
        name="hail", title="1,500 discs whose sizes differ by a factor of ten", size=1_500,
        build=partial(hail, 1_500), quality=(*_quality_untuned, lost(within(7.0))),
    ),
    _untuned(
        name="zigzag", title="1,000 boxes that slide from board to board", size=1_000,
        build=partial(zigzag, 1_000), quality=_quality_untuned,
    ),
)  # fmt: skip
"""Their scenes; none is run unless it is named."""


def bridge(planks: int) -> World:
    """Return a bridge of planks of 10 kg on pins, and ten balls of 50 kg that fall on it."""
    world, half = soft_space(), 0.5 * planks * 0.5
    ends = [
        box(world, (side * (half + 2.0), -1.0), width=4.0, height=2.0, static=True) for side in (-1.0, 1.0)
    ]
    before, tip = ends[0], (2.0, 1.0)
    for n in range(planks):
        plank = box(world, (0.5 * n + 0.25 - half, 0.0), width=0.5, height=0.1, mass=10.0)
        world.spawn(Pin(before, plank, tip, (-0.25, 0.0)))
        before, tip = plank, (0.25, 0.0)
    world.spawn(Pin(ends[1], before, (-2.0, 1.0), tip))
    for n in range(10):
        circle(world, (0.2 * half * (n - 4.5), 0.6), radius=0.3, mass=50.0)
    return world


def pinned_chains(count: int, links: int) -> World:
    """Return chains of links of 0.2 m on pins that swing from level, each with ten links' mass at its end."""
    world = soft_space()
    for n in range(count):
        foot, before = (0.0, 14.0 * n), None
        for k in range(links):
            link = box(world, (0.2 * k + 0.1, foot[1]), width=0.2, height=0.06, mass=1.0)
            world.spawn(Pin(before, link, foot if before is None else (0.1, 0.0), (-0.1, 0.0)))
            before = link
        weight = circle(world, (0.2 * links, foot[1]), radius=0.15, mass=10.0)
        world.spawn(Pin(before, weight, (0.1, 0.0)))
    return world


def ragdolls(count: int) -> World:
    """Return ragdolls that fall into a container, each turned otherwise."""
    world, random = soft_space(), np.random.default_rng(21)
    container(world, width=8.0, height=4.0 + count)
    for n, angle in enumerate(random.uniform(0.0, 2.0 * math.pi, count).tolist()):
        ragdoll(world, (-2.4 + n % 3 * 2.4, 1.6 + n // 3 * 2.4), angle=angle)
    return world


def polygons(count: int) -> World:
    """Return polygons of three to eight corners that fall into a container."""
    world, random = soft_space(), np.random.default_rng(22)
    container(world, width=8.0, height=0.05 * count + 6.0)
    for n, (radius, angle) in enumerate(random.uniform((0.1, 0.0), (0.2, 6.28), (count, 2)).tolist()):
        place = -3.3 + n % 16 * 0.44, 0.4 + n // 16 * 0.44
        regular_polygon(world, place, corners=3 + n % 6, radius=radius, angle=angle, mass=3.0 * radius**2)
    return world


_jointed = partial(BenchScene, group="joints", by_default=False, seconds=4.0, steps=240)

JOINTED = (
    _jointed(
        name="bridge_60", title="a bridge of 60 planks, ten balls fall on it", size=70,
        build=partial(bridge, 60), quality=(stretched(0.05),),
    ),
    _jointed(
        name="chains_20", title="20 chains of 30 links with a weight, which swing", size=620,
        build=partial(pinned_chains, 20, 30), quality=(stretched(0.02),),
    ),
    _jointed(
        name="ragdolls_40", title="40 ragdolls that fall in a heap", size=400,
        build=partial(ragdolls, 40),
        quality=(stretched(0.02), overlap(_OVERLAP), lost(within(4.0))),
    ),
    _jointed(
        name="polygons_800", title="800 polygons that fall in a heap", size=800,
        build=partial(polygons, 800), quality=(overlap(_OVERLAP), lost(within(4.0))),
    ),
)  # fmt: skip
"""Their scenes; none is run unless it is named."""
