"""Time what sleeping saves: a step of settled scenes awake, asleep, and asleep with a ball beside them.

``uv run python benchmarks/sleeping.py [SCENE ...]`` lets scenes of the benchmark settle and prints for each
the time of a step [ms of CPU, the shortest of several spells] with every body awake, with every body asleep,
and with a ball that bounces far away from the sleeping ones; and that of the ball's step where it is alone.
"""

from __future__ import annotations

import argparse
from dataclasses import replace

import numpy as np

from physicslab.lab.bench.catalogue import SCENES
from physicslab.lab.case import cpu_time
from physicslab.lab.worlds import open_space
from physicslab.prefabs import box, circle
from physicslab.world import World

USUAL = ("pile_1000", "pile_4000", "pyramid_60")
AWAY = 300.0
"""Where the ball is [m]."""
SETTLING_STEPS = 6_000
"""Upper limit of the steps in which a scene settles."""


def step_ms(world: World, steps: int = 60, spells: int = 9) -> float:
    """Return the CPU time of a step [ms]."""

    def spell() -> None:
        for _ in range(steps):
            world.step()

    return 1e3 * min(cpu_time(spell)[0] for _ in range(spells)) / steps


def add_ball(world: World) -> None:
    """Spawn a ball that bounces for ever, and a floor below it."""
    box(world, (AWAY, 19.5), width=4.0, height=1.0, static=True, restitution=1.0)
    circle(world, (AWAY, 23.0), radius=0.1, restitution=1.0, mass=0.03)


def measure(name: str) -> str:
    """Return one line of the table."""
    world = SCENES[name].build()
    world.simulation = replace(world.simulation, sleeping=True)
    world.step()
    bodies = int(np.count_nonzero(world.bodies.inverse_mass))
    while world.sleep.count < bodies and world.steps < SETTLING_STEPS:
        world.step()
    settled, sleepers = world.time, world.sleep.count
    asleep = step_ms(world)
    add_ball(world)
    world.run(steps=2)
    beside = step_ms(world)
    if world.sleep.count != sleepers:
        raise RuntimeError(f"{name}: {sleepers - world.sleep.count} bodies woke beside the ball")
    world.remove(world.entities()[-1])
    world.simulation = replace(world.simulation, sleeping=False)
    world.run(steps=30)
    awake = step_ms(world, 20, 5)
    return f"{name:12}{sleepers:9}{settled:11.1f}{awake:11.3f}{asleep:11.3f}{beside:11.3f}"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", default=USUAL, help="names of the benchmark's scenes")
    print(f"{'scene':12}{'asleep':>9}{'after s':>11}{'awake ms':>11}{'asleep ms':>11}{'beside ms':>11}")
    for name in parser.parse_args().scenes:
        print(measure(name), flush=True)
    alone = open_space(sleeping=True, collisions="step")
    add_ball(alone)
    alone.run(steps=2)
    print(f"the ball alone: {step_ms(alone):.3f} ms")


if __name__ == "__main__":
    main()
