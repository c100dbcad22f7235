"""Scenes of joints and polygons: a bridge, chains that swing, heaps of ragdolls and of polygons."""

import math
from functools import partial

import numpy as np

from physicslab.components import Pin
from physicslab.lab.bench.scene import BenchScene, lost, overlap, stretched, within
from physicslab.lab.worlds import soft_space
from physicslab.prefabs import box, circle, container, ragdoll, regular_polygon
from physicslab.world import World

_OVERLAP = 0.06
"""Deepest overlap that counts as right [m], as in heaps of other shapes."""


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


def chains(count: int, links: int) -> World:
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


_scene = partial(BenchScene, group="joints", by_default=False, seconds=4.0, steps=240)

JOINTED = (
    _scene(
        name="bridge_60", title="a bridge of 60 planks, ten balls fall on it", size=70,
        build=partial(bridge, 60), quality=(stretched(0.05),),
    ),
    _scene(
        name="chains_20", title="20 chains of 30 links with a weight, which swing", size=620,
        build=partial(chains, 20, 30), quality=(stretched(0.02),),
    ),
    _scene(
        name="ragdolls_40", title="40 ragdolls that fall in a heap", size=400,
        build=partial(ragdolls, 40),
        quality=(stretched(0.02), overlap(_OVERLAP), lost(within(4.0))),
    ),
    _scene(
        name="polygons_800", title="800 polygons that fall in a heap", size=800,
        build=partial(polygons, 800), quality=(overlap(_OVERLAP), lost(within(4.0))),
    ),
)  # fmt: skip
"""Their scenes; none is run unless it is named."""
