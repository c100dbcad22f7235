"""Time PhysicsLab beside REBOUND and SciPy at the same final error, interleaved in one run.

``uv run --group peers python benchmarks/accuracy_peers.py [PROBLEM ...] [--repeats N] [--error E]`` gives
every method the loosest setting of a ladder at which its final error is within ``E``, and then times all of
them in turn. It prints the median process time of each, the median of its ratios to PhysicsLab's ``auto``
method with the tolerance found (above 1, PhysicsLab is faster), force evaluations where they are counted, and
what one of two bodies costs. SciPy solves links on pins in angles, by equations without joints.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import rebound
from scipy.integrate import solve_ivp

from physicslab.components import Mass, Transform, Velocity
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.lab.accuracy.problem import Problem, Setting
from physicslab.lab.worlds import GRAVITY
from physicslab.world import World

COMPARED = ("kepler_e0.5", "kepler_e0.9", "figure_eight", "double_pendulum", "double_bars", "ten_links")
LINKS = {"double_pendulum": (2, 1.0, False), "double_bars": (2, 1.0, True), "ten_links": (10, 0.5, True)}
"""Chains of links of 1 m and 1 kg: how many, their angle from below at first [rad], whether they are bars."""

type Run = Callable[[Problem, float], tuple[float, float, int]]
"""Computes a problem with a step or tolerance; returns process seconds, the error, and force evaluations."""


type Law = Callable[[float, np.ndarray], np.ndarray]
"""Returns the rates of a state at a time, as SciPy reads them."""
type Put = Callable[[np.ndarray], None]
"""Puts bodies of a world where a state has them, so that the problem can compare."""


@dataclass(frozen=True)
class Method:
    """A way to compute a problem, with its settings from loose to tight."""

    name: str
    run: Run
    ladder: tuple[float, ...]
    joins: bool = False
    """Whether it can compute links on pins."""


def ours(integrator: str) -> Run:
    """Return how PhysicsLab computes a problem: by tolerance, or by the number of steps."""

    def run(problem: Problem, fineness: float) -> tuple[float, float, int]:
        setting = (
            Setting(integrator, tolerance=fineness)
            if fineness < 1.0
            else Setting(integrator, round(fineness))
        )
        world = problem.build(setting.simulation(problem))
        world.synchronise()
        start = time.process_time()
        error = problem.finish((world,))
        return time.process_time() - start, error, world.force_evaluations

    return run


def state(world: World) -> tuple[list[int], np.ndarray, np.ndarray, np.ndarray]:
    """Return entities, masses, places and velocities of a world's bodies; fixed bodies have velocity 0."""
    entities = world.batch(Transform, Mass).entities.tolist()
    rows = world.batch(Transform, Mass).rows
    return (
        entities, world.table(Mass)["mass"][rows].copy(), world.table(Transform)["position"][rows].copy(),
        world.table(Velocity)["linear"][rows].copy(),
    )  # fmt: skip


def put(world: World, entities: list[int], places: np.ndarray) -> None:
    """Put bodies where another engine has them, so that the problem can compare."""
    for entity, where in zip(entities, places, strict=True):
        if world.has(entity, Velocity):
            world.component(entity, Transform).position = where


def fixed_star(problem: Problem) -> bool:
    """Whether the problem's first body stays where it is."""
    return problem.source.startswith("kepler")


def rebounds(integrator: str) -> Run:
    """Return how REBOUND computes a problem."""

    def run(problem: Problem, fineness: float) -> tuple[float, float, int]:
        world = problem.build(Setting("auto").simulation(problem))
        world.synchronise()
        entities, masses, places, speeds = state(world)
        simulation = rebound.Simulation()
        simulation.integrator = integrator
        for i, (mass, where, how) in enumerate(zip(masses, places, speeds, strict=True)):
            # About a fixed star a body goes as a massless one does about a free star.
            heavy = mass if i == 0 or not fixed_star(problem) else 0.0
            simulation.add(m=heavy, x=where[0], y=where[1], vx=how[0], vy=how[1])
        if integrator == "ias15":
            set_tolerance(simulation, fineness)
        else:
            simulation.dt = problem.seconds / fineness
        spent, error = 0.0, 0.0
        for i, t in enumerate(problem.times):
            start = time.process_time()
            simulation.integrate(t)
            spent += time.process_time() - start
            put(world, entities, np.array([(body.x, body.y) for body in simulation.particles]))
            error = max(error, problem.error(world, i))
        return spent, error, 0

    return run


def set_tolerance(simulation: rebound.Simulation, tolerance: float) -> None:
    """Set IAS15's tolerance, which has moved between REBOUND's versions."""
    if hasattr(simulation, "ri_ias15"):
        simulation.ri_ias15.epsilon = tolerance
    else:
        simulation.integrator.epsilon = tolerance


def attracted(world: World) -> tuple[Law, np.ndarray, Put]:
    """Return the law of bodies that attract each other, with forces in numpy as one would write them."""
    entities, masses, places, speeds = state(world)
    n = len(masses)
    moves = np.array([world.has(entity, Velocity) for entity in entities], float)[:, None]
    others = ~np.eye(n, dtype=bool)

    def rates(_t: float, y: np.ndarray) -> np.ndarray:
        q = y[: 2 * n].reshape(n, 2)
        gap = q[None] - q[:, None]
        r2 = (gap * gap).sum(-1)
        pull = np.where(others, masses / np.where(others, r2 * np.sqrt(r2), 1.0), 0.0)
        return np.concatenate((y[2 * n :], (moves * (pull[:, :, None] * gap).sum(1)).ravel()))

    start = np.concatenate((places.ravel(), speeds.ravel()))
    return rates, start, lambda y: put(world, entities, y[: 2 * n].reshape(n, 2))


def linked(world: World, links: int, angle: float, bars: bool) -> tuple[Law, np.ndarray, Put]:
    """Return the law of a chain of links by their angles q from below, in numpy.

    Lagrange's equations: sum_j c_ij (cos(q_i - q_j) q_j'' + sin(q_i - q_j) q_j'^2) + w_i g sin q_i = 0.
    """
    below, share = np.arange(links - 1.0, -1.0, -1.0), 0.5 if bars else 1.0
    weights = GRAVITY * (share + below)
    coupled = share + np.minimum.outer(below, below)
    np.fill_diagonal(coupled, (1.0 / 3.0 if bars else 1.0) + below)

    def rates(_t: float, y: np.ndarray) -> np.ndarray:
        q, v = y[:links], y[links:]
        apart = q[:, None] - q
        pulls = -weights * np.sin(q) - (coupled * np.sin(apart)) @ (v * v)
        return np.concatenate((v, np.linalg.solve(coupled * np.cos(apart), pulls)))

    def put_end(y: np.ndarray) -> None:
        (s, c), v, end = (np.sin(y[:links]), np.cos(y[:links])), y[links:], world.entity("end")
        ways = np.ones(links)
        ways[-1] = share  # to the middle of the last bar, or to the mass at its end
        transform, velocity = world.component(end, Transform), world.component(end, Velocity)
        transform.position, transform.angle = (float(ways @ s), float(-ways @ c)), float(y[links - 1])
        velocity.linear, velocity.angular = (float(ways @ (v * c)), float(ways @ (v * s))), float(v[-1])

    return rates, np.concatenate((np.full(links, angle), np.zeros(links))), put_end


def scipys(problem: Problem, tolerance: float) -> tuple[float, float, int]:
    """Compute a problem with SciPy's DOP853."""
    world = problem.build(Setting("auto").simulation(problem))
    world.synchronise()
    chain = LINKS.get(problem.name)
    rates, y, put_back = attracted(world) if chain is None else linked(world, *chain)
    spent, error, t0, evaluations = 0.0, 0.0, 0.0, 0
    for i, t in enumerate(problem.times):
        start = time.process_time()
        found = solve_ivp(rates, (t0, t), y, "DOP853", rtol=max(tolerance, 2.3e-14), atol=tolerance)
        spent += time.process_time() - start
        y, evaluations = found.y[:, -1], evaluations + found.nfev
        put_back(y)
        error, t0 = max(error, problem.error(world, i)), t
    return spent, error, evaluations


def tolerances(first: int, last: int) -> tuple[float, ...]:
    """Return tolerances from 10^first down to 10^last, in half decades."""
    return tuple(10.0 ** (first - 0.5 * i) for i in range(2 * (first - last) + 1))


METHODS = (
    Method("PhysicsLab dop853", ours("dop853"), tolerances(-2, -17), joins=True),
    Method("PhysicsLab blanes_moan", ours("blanes_moan"), tuple(2.0 ** (8 + i / 2) for i in range(24))),
    Method("PhysicsLab leapfrog", ours("leapfrog"), tuple(2.0 ** (14 + i) for i in range(9))),
    Method("REBOUND ias15", rebounds("ias15"), tolerances(-1, -12)),
    Method("REBOUND leapfrog", rebounds("leapfrog"), tuple(2.0 ** (14 + i) for i in range(9))),
    Method("SciPy DOP853", scipys, tolerances(-2, -13), joins=True),
)


def enough(method: Method, problem: Problem, error: float) -> tuple[float | None, float]:
    """Return the loosest setting at which a method ends within an error, or ``None``; and its best error."""
    best = math.inf
    for fineness in method.ladder:
        _, found, _ = method.run(problem, fineness)
        best = min(best, found)
        if found <= error:
            return fineness, best
    return None, best


def compare(problem: Problem, error: float, repeats: int) -> None:
    """Print a table of the methods on one problem."""
    methods = [method for method in METHODS if problem.name not in LINKS or method.joins]
    settings = {method: enough(method, problem, error) for method in methods}
    times: dict[Method, list[float]] = {method: [] for method in methods}
    ends: dict[Method, list[Any]] = {}
    for _ in range(repeats):
        for method, (fineness, _) in settings.items():
            if fineness is not None:
                spent, *ends[method] = method.run(problem, fineness)
                times[method].append(spent)
    print(f"{problem.name}: {problem.seconds:.6g} s, final error up to {error:g}")
    first = METHODS[0]
    for method, spent_all in times.items():
        if not spent_all:
            print(f"  {method.name:<24} not reached: {settings[method][1]:.1e} at best")
            continue
        ratio = statistics.median(b / a for a, b in zip(times[first], spent_all, strict=True))
        found, evaluations = ends[method]
        print(
            f"  {method.name:<24} {1e3 * statistics.median(spent_all):9.2f} ms  {ratio:8.2f} x"
            f"  error {found:.1e}  at {settings[method][0]:.3g}"
            + (f"  {evaluations:,} evaluations" if evaluations else "")
        )


def cost_of_a_force() -> None:
    """Print what a force evaluation of two bodies costs within a compiled run."""
    problem = PROBLEMS["kepler_e0.5"]
    for name, setting in (
        ("leapfrog", Setting("leapfrog", 2**20)),
        ("blanes_moan", Setting("blanes_moan", 2**17)),
        ("dop853", Setting("dop853", tolerance=1e-17)),
    ):
        costs = []
        for _ in range(7):
            world = problem.build(setting.simulation(problem))
            world.synchronise()
            start = time.process_time()
            world.run(seconds=problem.seconds)
            costs.append((time.process_time() - start) / world.force_evaluations)
        print(f"  {name:<24} {1e9 * statistics.median(costs[1:]):9.1f} ns a force evaluation of two bodies")


def main() -> None:
    """Compare the methods on every problem."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("problems", nargs="*", metavar="PROBLEM", default=COMPARED)
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--error", type=float, default=1e-8)
    arguments = parser.parse_args()
    # REBOUND's own, where a ladder begins with steps that are too long for it.
    warnings.filterwarnings("ignore", message="At least 10 predictor corrector loops")
    cost_of_a_force()
    for name in arguments.problems:
        compare(PROBLEMS[name], arguments.error, arguments.repeats)


if __name__ == "__main__":
    main()
