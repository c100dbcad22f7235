"""Run a scene without a window, and say what came of it."""

from __future__ import annotations

import dataclasses
import io
import math
import os
import sys
import time
from argparse import ArgumentParser, Namespace
from collections.abc import Mapping
from contextlib import nullcontext
from pathlib import Path

from physicslab.commands.command_error import FAILED, CommandError
from physicslab.commands.numbers import STEP_LIMIT, count, duration, positive_count, positive_duration
from physicslab.commands.output import Output
from physicslab.commands.progress import Progress
from physicslab.commands.step_watch import StepWatch
from physicslab.desktop.rescue import save_last_good
from physicslab.diagnostics.energy import Drift
from physicslab.diagnostics.overflow import find_overflow
from physicslab.diagnostics.run_report import RunRecord, find_not_finite, run_report, run_summary
from physicslab.diagnostics.trajectory import TrajectoryWriter
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import INTEGRATORS
from physicslab.ecs.text import printable, shortened
from physicslab.files.checks import shown
from physicslab.files.json_text import json_bytes
from physicslab.files.scene import SceneError, load_scene
from physicslab.scenes import SCENES
from physicslab.state.masses import Diverged
from physicslab.world import World

__all__ = ["add_arguments", "execute"]

_DEFAULT_S = 10.0
_SAMPLES = 500
"""How often a run without contacts is measured: what lies between is one compiled loop."""
_LOOKS = 100
"""How often warnings are looked for in a run: with thousands of contacts that takes a third of a step."""
_BUDGETED = 100_000
"""Into how many parts, at most, a run with a budget is divided: after each, it can be stopped."""


def add_arguments(parser: ArgumentParser) -> None:
    """Declare what the command takes."""
    add = parser.add_argument
    add("scene", metavar="SCENE", help="a built-in scene's name, or a path")
    length = parser.add_mutually_exclusive_group()
    seconds = f"how long, in the scene's time ({_DEFAULT_S:g}); the last step may be shorter"
    length.add_argument("--seconds", metavar="T", type=duration, help=seconds)
    length.add_argument("--steps", metavar="N", type=count, help="how long, in steps")
    add("--dt", metavar="S", type=positive_duration, help="length of a step, in place of the scene's")
    add("--substeps", metavar="N", type=positive_count, help="parts of a step, in place of the scene's")
    add("--integrator", metavar="NAME", help=f"one of {', '.join(INTEGRATORS)}")
    budget = "stop after so many seconds of wall clock, compiling left out: exit 1, with what was reached"
    add("--at-most", metavar="SECONDS", type=positive_duration, help=budget)
    add("--json", metavar="FILE", help="write energies, momenta, costs and the final state (- for stdout)")
    add(
        "--csv",
        metavar="FILE",
        help="write every body's state at the start and after each step (- for stdout)",
    )
    add("--png", metavar="FILE", help="draw the final state, without a window (- for stdout)")


def execute(arguments: Namespace) -> int:
    """Run the scene and write what was asked for; a summary on stdout if nothing else goes there."""
    outputs = _outputs(arguments)
    world = load_scene(arguments.scene)
    _configure(world, arguments)
    name = world.name or Path(arguments.scene).stem
    label = shortened(printable(name))
    with outputs["csv"].stream() if "csv" in outputs else nullcontext() as stream:
        trajectory = None if stream is None else TrajectoryWriter(stream)
        try:
            record, stopped = _run(world, name, arguments, trajectory)
        except Diverged as error:
            raise CommandError(f"{label}: {error}; {_rescue(world, name, outputs)}", FAILED) from error
    report = run_report(world, record)
    place = find_not_finite(report)
    if place is not None:
        where = f"{place} is not finite at t = {world.time:.9g} s: the run diverged"
        raise CommandError(f"{label}: {where}; {_rescue(world, name, outputs)}", FAILED)
    if stopped:
        report["stopped"] = stopped
    if "json" in outputs:
        outputs["json"].write(json_bytes(report))
    if "png" in outputs:
        outputs["png"].write(_picture(world))
    if not any(output.to_stdout for output in outputs.values()):
        print(run_summary({**report, "scene": label}, world.title))
    if stopped:
        raise CommandError(f"{label}: {stopped}", FAILED)
    return 0


def _rescue(world: World, name: str, outputs: Mapping[str, Output]) -> str:
    """Save the last good state beside the document that was asked for, or here; return what came of it."""
    json = outputs.get("json")
    directory = Path() if json is None or json.to_stdout else Path(json.path).parent
    try:
        path = save_last_good(world, name, directory)
    except (OSError, SceneError) as error:
        return f"the last good state, of t = {world.time:.9g} s, could not be saved: {error}"
    return f"the last good state, of t = {world.time:.9g} s, is in {path}"


def _outputs(arguments: Namespace) -> dict[str, Output]:
    """Return the outputs that were asked for, all of them writable and none in the way of another."""
    wanted = {kind: getattr(arguments, kind) for kind in ("json", "csv", "png")}
    outputs = {kind: Output(f"--{kind}", path) for kind, path in wanted.items() if path is not None}
    for kind, output in outputs.items():
        if arguments.scene not in SCENES and output.is_same_as(arguments.scene):
            raise CommandError(f"--{kind} {output.path}: is the scene itself")
        for other, second in outputs.items():
            if other != kind and ((output.to_stdout and second.to_stdout) or output.is_same_as(second.path)):
                raise CommandError(f"--{kind} and --{other} cannot both go to {output.path}")
    return outputs


def _configure(world: World, arguments: Namespace) -> None:
    """Configure the world by the command line, and prepare it, so that only the run itself is timed."""
    changes = {name: getattr(arguments, name) for name in ("dt", "substeps", "integrator")}
    changes = {name: value for name, value in changes.items() if value is not None}
    scene = shown(arguments.scene)
    try:
        world.simulation = dataclasses.replace(world.simulation, **changes)
        world.synchronise()
    except InvalidValue as error:
        if error.component == world.simulation.section and error.field in changes:
            raise CommandError(f"--{error.field} {shown(error.value)}: must be {error.allowed}") from error
        raise CommandError(f"{scene}: {error}") from error
    if world.plan.refused and arguments.integrator is not None:
        raise CommandError(f"--integrator {arguments.integrator}: {world.plan.refused}")
    if arguments.steps is not None and not math.isfinite(arguments.steps * world.simulation.dt):
        raise CommandError(
            f"--steps {arguments.steps}: must take a finite time at {world.simulation.dt:g} s each"
        )
    seconds = _DEFAULT_S if arguments.seconds is None else arguments.seconds
    if arguments.steps is None and seconds / world.simulation.dt > STEP_LIMIT:
        raise CommandError(f"--seconds {seconds:g}: must be at most {STEP_LIMIT:g} steps of dt")


def _run(
    world: World, name: str, arguments: Namespace, trajectory: TrajectoryWriter | None
) -> tuple[RunRecord, str]:
    """Advance the world; between steps, outside the time that is counted, measure and record.

    Returns
    -------
    record : RunRecord
        What was gathered.
    stopped : str
        Where the run was stopped because its time was up; empty if it was not.
    """
    record, watch = RunRecord(name, Drift(world)), StepWatch(world)
    _check_sums(world, record)
    seconds = _DEFAULT_S if arguments.seconds is None and arguments.steps is None else arguments.seconds
    length = arguments.steps * world.simulation.dt if seconds is None else seconds
    label = shortened(printable(name))
    start, progress = world.time, Progress(label, sys.stderr)
    clock = _Stopwatch(world)
    whole = round(length / world.simulation.dt)
    parts = _SAMPLES if arguments.at_most is None else _BUDGETED
    stride = 1 if trajectory is not None else max(1, whole // parts)
    stepping = world.stepping(seconds=seconds, steps=arguments.steps, stride=stride)
    measure_every = 1 if trajectory is not None else max(1, whole // (stride * _SAMPLES))
    look_every = max(1, whole // (stride * _LOOKS))
    samples, stopped = 0, ""
    try:
        while True:
            if trajectory is not None:
                trajectory.write(world)
            before = clock.seconds
            done = None if stopped else next(stepping, None)
            taken = clock.seconds - before
            record.wall_s += taken
            ended = done is None
            if ended or samples % measure_every == 0:
                _measure(world, record)
            if ended or samples % look_every == 0:
                record.warnings.add(find_warnings(world))
            if done is None:
                record.warnings.add(watch.warnings)
                return record, stopped
            samples += 1
            for line in (watch.note(done - record.steps, taken), watch.note_impacts()):
                if line and sys.stderr is not None:
                    progress.clear()
                    print(f"physicslab: {label}: {line}", file=sys.stderr, flush=True)
            record.steps = done
            progress.show((world.time - start) / length)
            if arguments.at_most is not None and clock.seconds >= arguments.at_most:
                stopped = _where_stopped(world, record, arguments.at_most, start + length, whole)
    finally:
        progress.clear()


class _Stopwatch:
    """The time since it was made, without that in which kernels were compiled or loaded.

    Parameters
    ----------
    world : World
        Which counts what compiling takes.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._start = time.perf_counter() - world.compile_s

    @property
    def seconds(self) -> float:
        """How long it has been [s]."""
        return time.perf_counter() - self._world.compile_s - self._start


def _where_stopped(world: World, record: RunRecord, at_most: float, end: float, whole: int) -> str:
    """Return in words where a run was stopped; nothing where it was at its end."""
    if world.time >= end:
        return ""
    steps = f"after {record.steps} of {whole} steps"
    return f"stopped after {at_most:g} s of wall clock (--at-most) at t = {world.time:.9g} s, {steps}"


def _measure(world: World, record: RunRecord) -> None:
    record.drift.sample(world)
    record.max_penetration = max(record.max_penetration, world.contacts.max_penetration)
    record.divided = max(record.divided, world.step_divisions)
    _check_sums(world, record)


def _check_sums(world: World, record: RunRecord) -> None:
    """Stop a run whose energy or momentum is no longer finite, naming what and when."""
    overflow = find_overflow(world, record.drift.latest)
    if overflow is not None:
        raise Diverged(f"{overflow} at t = {world.time:.9g} s")


def _picture(world: World) -> bytes:
    """Return a PNG of the world as it is now; pygame draws it, without a display."""
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # its greeting goes to stdout
    from physicslab.view.picture.picture import save_png

    picture = io.BytesIO()
    save_png(world, picture)
    return picture.getvalue()
