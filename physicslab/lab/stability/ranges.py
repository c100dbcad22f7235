"""Masses and sizes of every magnitude in one scene, and scenes that run for long."""

import gc
import sys
from functools import cache, partial
from itertools import pairwise

import numpy as np

from physicslab.components import Velocity
from physicslab.lab.case import cpu_time
from physicslab.lab.stability.case import StabilityCase, part_of
from physicslab.lab.worlds import floor, largest, open_space, place
from physicslab.prefabs import box, circle, container, pendulum, pile
from physicslab.world import World


def _lost(world: World, bodies: list[int], steps: int) -> float:
    """Return how many bodies are below the floor at the end, and how many velocities are not finite."""
    world.run(steps=steps)
    below = sum(not place(world, body).y > -0.01 for body in bodies)
    return float(below + np.count_nonzero(~np.isfinite(world.table(Velocity)["linear"])))


def _masses() -> float:
    """Return what is lost of bodies from 1e-9 to 1e9 kg that fall on a floor and on each other."""
    world = open_space()
    floor(world, width=1e5)  # a body that is squeezed out is flung far
    exponents = range(-9, 10)
    made = [
        circle(world, (0.6 * (e % 5), 0.3 + 0.6 * n), radius=0.25, mass=10.0**e)
        for n, e in enumerate(exponents)
    ]
    made += [box(world, (-5.0, 0.25 + 0.5 * n), mass=10.0**e) for n, e in enumerate((9, 0, -9))]
    return _lost(world, made, 600)


def _sizes() -> float:
    """Return what is lost of bodies from 1 mm to 1 km that fall on a floor."""
    world = open_space()
    floor(world, width=1e5)
    made = [
        circle(world, (3.0 * radius, 1.5 * radius), radius=radius, mass=radius * radius)
        for radius in (0.0005, 0.005, 0.05, 0.5, 5.0, 50.0, 500.0)
    ]
    return _lost(world, made, 300)


def _pairs(count: int) -> int:
    """Return how many pairs the broad phase hands on, of grains of 1 mm among bodies up to 1 km."""
    world = open_space(gravity=None)
    for i, radius in enumerate((0.05, 0.5, 5.0, 50.0, 500.0)):
        circle(world, (-2.0 * radius - i, 0.0), radius=radius)
    side = round(count**0.5)
    for i in range(count):
        circle(world, (1.0 + 0.0011 * (i % side), 0.0011 * (i // side)), radius=0.0005)
    world.step()
    return int(world.contacts.candidate_pairs)


def _pair_growth() -> float:
    """Return how many times the pairs there are of four times the grains, per grain."""
    few, many = _pairs(1_000), _pairs(4_000)
    return max(many, 1) / max(few, 1) / 4.0


def _mixed() -> World:
    """Return a scene with a little of everything that lasts."""
    world = open_space(contacts="soft")
    floor(world, restitution=1.0)
    # Discs roll for ever: what they lie in keeps them from the box that should rest.
    container(world, (-6.0, 2.0), width=1.0, height=2.0)
    pile(world, 6, (-6.0, 2.1), columns=3)
    circle(world, (3.0, 2.0), radius=0.25, restitution=1.0, friction=0.0, name="bouncing")
    box(world, (5.0, 0.25), name="resting")
    pendulum(world, (8.0, 6.0))
    return world


@cache  # several cases look at one run
def _endured(steps: int) -> tuple[float, float, float]:
    """Return what a long run of the mixed scene did, compared with the time when it had settled.

    These are the blocks of memory taken for good, a step; how far the box that rests was moved [m]; and the
    time of the last tenth, of that of the second.
    """
    world = _mixed()
    resting = world.entity("resting")
    tenth = steps // 10
    world.run(steps=tenth)
    settled = place(world, resting)
    first, _ = cpu_time(lambda: world.run(steps=tenth))
    blocks, drifts = [_blocks()], []
    for _ in range(4):
        drifts.append(
            largest(world, 7 * steps // 40, lambda: (place(world, resting) - settled).magnitude, every=100)
        )
        blocks.append(_blocks())
    last, _ = cpu_time(lambda: world.run(steps=tenth))
    # A leak grows in every quarter; objects built at their first use, or by a thread of the tests, in one.
    kept = min(after - before for before, after in pairwise(blocks)) * 40 / (7 * steps)
    return max(0.0, kept), max(drifts), last / first


def _blocks() -> int:
    gc.collect()
    return sys.getallocatedblocks()


_ranges = partial(StabilityCase, group="ranges", right="finite, and nothing is lost", limit=0.0)

RANGES = (
    _ranges(
        name="masses_1e-9_1e9", title="bodies from 1e-9 to 1e9 kg on a floor and on each other, 10 s",
        figure="bodies below the floor, or nowhere", measure=_masses,
    ),
    _ranges(
        name="sizes_1mm_1km", title="discs from 1 mm to 1 km on a floor, 5 s",
        figure="bodies below the floor, or nowhere", measure=_sizes,
    ),
    _ranges(
        name="sizes_pairs", title="1,000 and 4,000 grains of 1 mm among bodies up to 1 km", limit=1.5,
        right="the broad phase is not quadratic", figure="growth of pairs a grain", measure=_pair_growth,
    ),
    *(
        StabilityCase(
            name=f"steps_{name}_{kind}", title=f"a mixed scene, {steps:,} steps", group="endurance",
            right=right, figure=figure, unit=unit, limit=limit, measure=partial(part_of, n, _endured, steps),
            long_s=3.4e-4 * steps if steps > 100_000 else 0.0,
        )
        for name, steps, figures in (("1e4", 10_000, 2), ("1e6", 1_000_000, 3))
        for n, (kind, right, figure, unit, limit) in enumerate((
            ("memory", "no memory is taken for good", "blocks kept a step", "", 0.01),
            ("drift", "what rests stays where it is", "how far it is moved", "m", 1e-6),
            ("pace", "it becomes no slower", "time of the last tenth, of the second", "", 1.2),
        )[:figures])
    ),
)  # fmt: skip
