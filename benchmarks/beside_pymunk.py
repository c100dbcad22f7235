"""Time a step beside pymunk's on the same scenes, interleaved in one run.

``uv run --group peers python benchmarks/beside_pymunk.py [--repeats N]`` prints the median time a step of
both engines and the median of the ratios, pymunk / PhysicsLab: above 1, PhysicsLab is faster. dt = 1/60 s,
sleeping off; PhysicsLab takes 4 substeps, pymunk 10 iterations with a slop of 5 mm, its usual settings.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time
from collections.abc import Callable

import pymunk

from physicslab import World
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.peers.pymunk_mirror import PymunkMirror
from physicslab.prefabs import box, container, gas, pile, pyramid
from physicslab.systems.standard import standard_systems

BLOCK = 20
"""Steps that one engine takes before the other has its turn."""


def pyramid_60() -> World:
    """1,830 boxes of 1 m."""
    world = World(*standard_systems(), physics=PhysicsConfig(gravity=Vector2(0.0, -10.0)))
    box(world, (0.0, -0.5), width=200.0, height=1.0, static=True, friction=0.6)
    pyramid(world, 60)
    return world


def pile_4000() -> World:
    """4,000 discs of 0.2 m that have come to rest in a container of 30 m."""
    world = World(*standard_systems())
    container(world, width=30.0, height=20.0)
    pile(world, 4_000, columns=115)
    return world


def gas_2000() -> World:
    """2,000 elastic discs that fill 17 % of a box."""
    bounds = (-12.0, -7.5, 12.0, 7.5)
    laws = PhysicsConfig(gravity_mode="none", bounds=bounds, bounds_restitution=1.0, bounds_friction=0.0)
    world = World(*standard_systems(), physics=laws)
    gas(world, 2_000, bounds)
    return world


SCENES: dict[str, tuple[Callable[[], World], float]] = {
    "pyramid 60": (pyramid_60, 1.0),
    "pile 4000": (pile_4000, 8.0),
    "gas 2000": (gas_2000, 1.0),
}
"""Each scene, and for how long [s] both engines run it before the timing starts."""


def kinetic_energy(space: pymunk.Space) -> float:
    """Return the kinetic energy of all bodies [J]; pymunk's own figure is twice that."""
    moving = [body for body in space.bodies if body.body_type == pymunk.Body.DYNAMIC]
    energies = [
        0.5 * body.mass * body.velocity.length**2 + 0.5 * body.moment * body.angular_velocity**2
        for body in moving
    ]
    return math.fsum(energies)


def timed(step: Callable[[], None]) -> float:
    """Return the milliseconds a step takes, over one block of steps."""
    start = time.perf_counter()
    for _ in range(BLOCK):
        step()
    return (time.perf_counter() - start) * 1e3 / BLOCK


def main() -> None:
    """Run every scene and print a line for each."""
    parser = argparse.ArgumentParser(description="Time a step beside pymunk's.")
    parser.add_argument("--repeats", type=int, default=9, help="blocks of steps a scene (default: 9)")
    repeats = parser.parse_args().repeats
    print(f"{'scene':12} {'PhysicsLab':>12} {'pymunk':>12} {'ratio':>7}   ms a step; energy kept by both")
    for name, (build, add_constraints) in SCENES.items():
        world = build()
        space = PymunkMirror(world).space
        dt = world.simulation.dt
        for _ in range(round(add_constraints / dt)):
            world.step()
            space.step(dt)
        before = measure_energy(world).kinetic, kinetic_energy(space)
        ours, theirs = [], []
        for _ in range(repeats):
            ours.append(timed(world.step))
            theirs.append(timed(lambda space=space, dt=dt: space.step(dt)))  # type: ignore[misc]
        ratio = statistics.median(t / o for o, t in zip(ours, theirs, strict=True))
        after = measure_energy(world).kinetic, kinetic_energy(space)
        print(
            f"{name:12} {statistics.median(ours):12.3f} {statistics.median(theirs):12.3f} {ratio:7.2f}   "
            f"{before[0]:.6g} -> {after[0]:.6g} J, pymunk {before[1]:.6g} -> {after[1]:.6g} J"
        )


if __name__ == "__main__":
    main()
