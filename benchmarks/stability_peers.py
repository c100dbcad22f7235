"""Run the cases of the stability lab in pymunk and Box2D as well, and print their figures beside ours.

``uv run --group peers python benchmarks/stability_peers.py [CASE ...] [--long] [--json FILE]`` runs every
case whose scene they have the parts for (or those named, or those of a group), each four times: by
PhysicsLab, by pymunk with the scene's own steps, by pymunk with each step divided into four, as PhysicsLab
divides its own, and by Box2D. Scene, figure and limit are the case's; only the engine that steps the case's
world differs. A run whose state is not finite is shown as ``NaN``; bullets that are behind their wall at the
end are counted as ``through``.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any
from unittest.mock import patch
from weakref import WeakKeyDictionary

import Box2D
import pymunk

from physicslab import World
from physicslab.components import Transform
from physicslab.diagnostics.joints import joint_states
from physicslab.lab.peers.mirrors import Box2DMirror, PymunkMirror
from physicslab.lab.peers.peer import CannotBuild, Peer, find_contacts
from physicslab.lab.stability.case import StabilityCase, run_case
from physicslab.lab.stability.catalogue import CASES

SUBSTEPS = 4
NOT_COMPARABLE = {
    "planets": "no such force",
    "sizes_pairs": "measures PhysicsLab's broad phase",
    "steps_1e4_memory": "measures Python's memory",
    "steps_1e6_memory": "measures Python's memory",
    "steps_1e6_pace": "times PhysicsLab",
    **{name: "looks at PhysicsLab's contacts" for name in CASES if re.fullmatch("wedges_.*_depth_.*", name)},
}
"""Groups and cases that cannot measure another engine."""


@dataclass(frozen=True)
class Found:
    """The result of a case in one engine.

    Attributes
    ----------
    figure : float, optional
        What was measured; ``None`` where there is none.
    word : str
        The verdict, or why there is none.
    """

    figure: float | None
    word: str

    @property
    def text(self) -> str:
        """The figure and the verdict."""
        return f"{self.word}" if self.figure is None else f"{self.figure:.4g} {self.word}"


@contextmanager
def stepped_by(peer: type[Peer], substeps: int) -> Iterator[list[Peer]]:
    """Let another engine advance every world that is stepped meanwhile; yield its mirrors of them."""
    mirrors: WeakKeyDictionary[World, Peer] = WeakKeyDictionary()
    made: list[Peer] = []

    def advance(world: World, dt: float, steps: int) -> None:
        if world not in mirrors:
            mirrors[world] = peer(world)
            made.append(mirrors[world])
            # The reason for PhysicsLab's own method does not hold for another engine.
            world.plan = replace(world.plan, reason=peer.__name__)
        mirror = mirrors[world]
        for _ in range(steps):
            for _ in range(substeps):
                mirror.step(dt / substeps)
            if world.joints.joints:
                mirror.write_back()
                note_gaps(world)
        mirror.write_back()
        world.time += steps * dt
        world.steps += steps

    def step(world: World, dt: float | None = None) -> None:
        advance(world, world.simulation.dt if dt is None else dt, 1)

    def stepping(
        world: World, *, seconds: float | None = None, steps: int | None = None, stride: int = 1
    ) -> Iterator[int]:
        dt = world.simulation.dt
        count = round((seconds or 0.0) / dt) if steps is None else steps
        done = 0
        while done < count:
            due = min(stride, count - done)
            advance(world, dt, due)
            done += due
            yield done
        find_contacts(world)

    def run(world: World, *, seconds: float | None = None, steps: int | None = None) -> None:
        for _ in stepping(world, seconds=seconds, steps=steps, stride=10**9):
            pass

    with patch.multiple(World, step=step, stepping=stepping, run=run):
        yield made


def note_gaps(world: World) -> None:
    """Keep the largest distance of the points that a joint holds together, as PhysicsLab's solver does."""
    for joint, state in zip(world.joints.joints, joint_states(world), strict=True):
        world.joints.largest[joint.first] = max(world.joints.largest[joint.first], state.stretch)


def passed(mirror: Peer) -> bool:
    """Whether the last body, which came from the left, is on the right of the first."""
    first, *_, last = mirror.world.batch(Transform).rows
    x = mirror.world.table(Transform)["position"][:, 0]
    return bool(x[last] > x[first])


def ours(case: StabilityCase) -> Found:
    """Return the figure of a case in PhysicsLab."""
    outcome = run_case(case)
    return Found(outcome.figure, str(outcome.verdict) if outcome.figure is not None else "stopped")


def theirs(peer: type[Peer], substeps: int = 1) -> Callable[[StabilityCase], Found]:
    """Return a function that measures a case in another engine."""

    def measure(case: StabilityCase) -> Found:
        try:
            with stepped_by(peer, substeps) as mirrors:
                outcome = run_case(case)
        except CannotBuild as error:
            return Found(None, str(error))
        if outcome.figure is None:
            return Found(None, "NaN")
        if case.group == "bullets" and outcome.figure > 0.0:
            return Found(outcome.figure, f"{outcome.verdict}, {sum(map(passed, mirrors))} through")
        return Found(outcome.figure, str(outcome.verdict))

    return measure


def apart(measure: Callable[[StabilityCase], Found], case: StabilityCase, seconds: float) -> Found:
    """Measure in a process of its own, which an engine may abort on numbers that it cannot handle."""
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(duplex=False)
    process = context.Process(target=lambda: there.send(measure(case)))
    process.start()
    there.close()
    try:
        return here.recv() if here.poll(seconds) else Found(None, f"no end in {seconds:g} s")
    except EOFError:
        return Found(None, "aborted")
    finally:
        process.kill()
        process.join()


def chosen(names: list[str], long: bool) -> list[StabilityCase]:
    """Return the cases to run; two that differ by how PhysicsLab finds collisions are one."""
    wanted = [case for name in names for case in CASES.select(name)] if names else list(CASES.values())
    return [
        case for case in wanted
        if case.group not in NOT_COMPARABLE and case.name not in NOT_COMPARABLE
        and not (case.name.endswith("_step") and case.name.removesuffix("_step") in CASES)
        and (long or names or not case.long_s)
    ]  # fmt: skip


def main() -> None:
    """Run the cases and print a line for each."""
    parser = argparse.ArgumentParser(description="Run the stability lab's cases in pymunk and Box2D as well.")
    parser.add_argument("cases", metavar="CASE", nargs="*", help="a case, or a group of them; all if none")
    parser.add_argument("--long", action="store_true", help="also those that take minutes")
    parser.add_argument("--seconds", type=float, default=900.0, help="how long a run may take (default: 900)")
    parser.add_argument("--json", metavar="FILE", type=Path, help="write every figure and verdict")
    arguments = parser.parse_args()
    engines = {
        "ours": ours, "pymunk": theirs(PymunkMirror),
        f"pymunk, {SUBSTEPS} substeps": theirs(PymunkMirror, SUBSTEPS), "Box2D": theirs(Box2DMirror),
    }  # fmt: skip
    print(f"pymunk {pymunk.version}, Box2D {Box2D.__version__}")
    print("| case | limit |", *(f"{name} |" for name in engines))
    print("|---" * (2 + len(engines)) + "|", flush=True)
    rows: list[dict[str, Any]] = []
    for case in chosen(arguments.cases, arguments.long):
        found = {name: apart(measure, case, arguments.seconds) for name, measure in engines.items()}
        if all(result.word == "no such force" for name, result in found.items() if name != "ours"):
            continue
        limit = f"{case.limit:.4g} {case.unit}".rstrip()
        print(f"| {case.name} | {limit} |", *(f"{result.text} |" for result in found.values()), flush=True)
        figures = {name: asdict(result) for name, result in found.items()}
        rows.append({"name": case.name, "unit": case.unit, "limit": case.limit, **figures})
    if arguments.json is not None:
        arguments.json.write_text(
            json.dumps({"pymunk": pymunk.version, "box2d": Box2D.__version__, "cases": rows}, indent=2) + "\n"
        )


if __name__ == "__main__":
    main()
