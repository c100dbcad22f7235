"""Scenes that the engine was not tuned for: made after the work on moving scenes was done, and left so.

A speed must also hold for scenes that were not used while the engine was made.
"""

import math
from functools import partial

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.lab.bench.scene import BenchScene, largest_overlap, lost, overlap, within
from physicslab.lab.worlds import floor, soft_space
from physicslab.prefabs import box, circle, container
from physicslab.world import World

_OVERLAP, _LARGEST = 0.06, 0.25
"""Deepest overlap that counts as right at the end, and at any time [m]."""
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


_scene = partial(BenchScene, group="untuned", seconds=5.0)
_quality = overlap(_OVERLAP), largest_overlap(_LARGEST)

UNTUNED = (
    _scene(
        name="stairs", title="1,500 discs and boxes that fall on stairs", size=1_500,
        build=partial(stairs, 1_500), quality=_quality,
    ),
    _scene(
        name="dominoes_400", title="400 dominoes, a ball hits the first", size=400,
        build=partial(dominoes, 400), quality=_quality,
    ),
    _scene(
        name="struck_wall", title="a wall of 800 bricks that heavy discs hit", size=800,
        build=partial(struck_wall, 20, 40), quality=(*_quality, lost(within(400.0))),
    ),
    _scene(
        name="hail", title="1,500 discs whose sizes differ by a factor of ten", size=1_500,
        build=partial(hail, 1_500), quality=(*_quality, lost(within(7.0))),
    ),
    _scene(
        name="zigzag", title="1,000 boxes that slide from board to board", size=1_000,
        build=partial(zigzag, 1_000), quality=_quality,
    ),
)  # fmt: skip
"""Their scenes; none is run unless it is named."""
