"""Ensembles beside loops over other engines, in one run: runs a second and core, by the time of processors.

``uv run --group peers --group cluster python benchmarks/ensembles.py``

- A ball falls on a floor and bounces, with another restitution, or mass, in each run, for 1 s: a loop of
  ``load_scene`` and ``run``, the rows of an ensemble, and pymunk by joblib. Rows of which the end or impacts
  are measured are made together; an account has them made one by one.
- Two bodies go once around each other, from another speed in each run: the rows of an ensemble, and REBOUND
  (IAS15) by joblib.

Both take turns, so that other work on the machine costs them alike; joblib works in one process here, as the
rows do, so that its starting costs nothing.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pymunk
import rebound
from joblib import Parallel, delayed

from physicslab import load_scene
from physicslab.ensembles.runs import task_of
from physicslab.ensembles.task import Runner

ROUNDS, RUNS = 6, 200
ORBIT: dict[str, Any] = {
    "format": "physicslab-scene/1",
    "physics": {"gravity_mode": "planet", "G": 1.0},
    "simulation": {"dt": 0.01},
    "entities": [
        {"id": "sun", "Transform": {}, "Velocity": {}, "Mass": {"mass": 1.0}},
        {"id": "earth", "Transform": {"position": [1, 0]}, "Velocity": {"linear": [0, 1]},
         "Mass": {"mass": 1e-3}},
    ],
}  # fmt: skip
YEAR = 2.0 * math.pi


def plain(restitutions: list[float]) -> list[float]:
    """Return the heights after 1 s by a loop of fresh worlds."""
    found = []
    for _ in restitutions:
        world = load_scene("drop")
        world.run(seconds=1.0)
        found.append(world.time)
    return found


def pymunk_drop(restitution: float) -> float:
    """Return the height of a ball after 1 s in steps of 1/240 s."""
    space = pymunk.Space()
    space.gravity = 0, -9.81
    floor = pymunk.Poly(space.static_body, [(-10, -1), (10, -1), (10, 0), (-10, 0)])
    floor.elasticity, floor.friction = 1.0, 0.5
    ball = pymunk.Body(1.0, pymunk.moment_for_circle(1.0, 0, 0.25))
    ball.position, ball.velocity = (-3, 4), (1, 0)
    disc = pymunk.Circle(ball, 0.25)
    disc.elasticity, disc.friction = restitution, 0.5
    space.add(floor, ball, disc)
    for _ in range(240):
        space.step(1 / 240)
    return float(ball.position.y)


def rebound_orbit(speed: float) -> float:
    """Return where a planet is after a year."""
    simulation = rebound.Simulation()
    simulation.add(m=1.0)
    simulation.add(m=1e-3, x=1.0, vy=speed)
    simulation.integrate(YEAR)
    return float(simulation.particles[1].x)


def rows_of(
    scene: Any, field: str, low: float, high: float, measure: str, seconds: float
) -> Callable[[int], object]:
    """Return what makes the rows of an ensemble, as a worker does."""
    task = task_of(scene, {field: ("uniform", low, high)}, samples=10**6, measure=measure, seconds=seconds)
    runner = Runner(task)
    return lambda number: runner.block(number * RUNS, (number + 1) * RUNS)


def by_joblib(one: Callable[[float], float], low: float, high: float) -> Callable[[int], object]:
    """Return what makes as many runs with joblib, in this process."""
    values = np.random.default_rng(1).uniform(low, high, RUNS).tolist()
    return lambda number: Parallel(n_jobs=1)(delayed(one)(value) for value in values)


def main() -> None:
    """Time all of them in turn, and print the medians."""
    loop, bounce, weight = [0.5] * (RUNS // 10), "ball.Material.restitution", "ball.Mass.mass"
    kinds: dict[str, tuple[Callable[[int], object], int]] = {
        "drop, load_scene and run": (lambda number: plain(loop), len(loop)),
        "drop, rows": (rows_of("drop", bounce, 0.5, 0.9, "ball.y", 1.0), RUNS),
        "drop, rows of masses": (rows_of("drop", weight, 0.5, 0.9, "ball.y", 1.0), RUNS),
        "drop, rows of impact counts": (rows_of("drop", bounce, 0.5, 0.9, "collisions", 1.0), RUNS),
        "drop, rows of first impacts": (rows_of("drop", bounce, 0.5, 0.9, "first_impact.time", 1.0), RUNS),
        "drop, rows one by one": (rows_of("drop", bounce, 0.5, 0.9, "account.impacts", 1.0), RUNS),
        "drop, pymunk by joblib": (by_joblib(pymunk_drop, 0.5, 0.9), RUNS),
        "orbit, rows": (rows_of(ORBIT, "earth.Velocity.linear.y", 0.9, 1.1, "earth.x", YEAR), RUNS),
        "orbit, REBOUND by joblib": (by_joblib(rebound_orbit, 0.9, 1.1), RUNS),
    }
    took: dict[str, list[float]] = {name: [] for name in kinds}
    for number in range(ROUNDS + 1):
        for name, (work, runs) in kinds.items():
            began = time.process_time()
            work(number)
            took[name].append((time.process_time() - began) / runs)
    for name, each in took.items():
        median = float(np.median(each[1:]))  # the first compiles
        print(f"{name:28} {1e6 * median:7.0f} us a run, {1 / median:6.0f} runs a second and core")


if __name__ == "__main__":
    main()
