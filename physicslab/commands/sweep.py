"""Run a scene many times with other values, on all processors, and keep what is measured of each run."""

import sys
from argparse import Namespace
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from physicslab.commands import FAILED, CommandError, require, require_window
from physicslab.commands.opening import check_output, check_seconds, name_of, opened
from physicslab.commands.output import Output
from physicslab.commands.progress import Progress
from physicslab.commands.usage import SAMPLE_FORM
from physicslab.commands.variations import refuse_set, vary
from physicslab.ecs.text import printable, shortened
from physicslab.ensembles.cluster import Dask
from physicslab.ensembles.map_picture import map_grids
from physicslab.ensembles.result import EnsembleResult
from physicslab.ensembles.runs import run_task, task_of
from physicslab.ensembles.space import check_whole
from physicslab.ensembles.task import Task
from physicslab.ensembles.workers import MOST_WORKERS, Workers
from physicslab.files.checks import shown
from physicslab.files.replace import reason_of
from physicslab.world import World

_MOST_VALUES = 1_000_000
_SHOWN_FAILURES = 3


def execute(arguments: Namespace) -> int:
    """Make the runs that are missing, and write the rows."""
    _refuse_contradictions(arguments)
    if not arguments.measure and arguments.open is None:
        raise CommandError("--measure: must be given: what is kept of each run")
    if arguments.seed is not None and not arguments.sample:
        raise CommandError("--seed: must go with --sample, whose numbers it chooses")
    output = _output(arguments)
    world = opened(arguments)
    check_seconds(arguments.seconds, world.simulation.dt)
    space = _space(world, arguments)
    task = task_of(
        world, space, measure=_measures(arguments), seconds=arguments.seconds, until=arguments.until,
        samples=arguments.samples, seed=arguments.seed or 0,
    )  # fmt: skip
    if arguments.open is not None:
        return _open(task, arguments.open)
    picture = _map(arguments, task)
    label = shortened(printable(name_of(world, arguments)))
    out = None if output is None else Path(output.path)
    try:
        with Progress(label, sys.stderr, foresees=True) as progress, _workers(arguments) as workers:
            result = run_task(task, workers, out, progress.show)
    except OSError as error:
        raise CommandError(f"{label}: {reason_of(error)}", FAILED) from error
    if picture is not None:
        picture.write(result.map())
    _tell(result, label, output)
    if len(result.failures) == len(result):
        raise CommandError(f"{label}: every run failed", FAILED)
    return 0


def _refuse_contradictions(arguments: Namespace) -> None:
    """Refuse what ``--open`` does not use, and a picture whose name does not say what it is."""
    if arguments.open is not None:
        for name in ("out", "map", "measure", "workers", "dask", "until"):
            if getattr(arguments, name) not in (None, []):
                raise CommandError(f"--{name}: must go without --open, which makes no run")
    if arguments.map is not None and Path(arguments.map).suffix.lower() != ".png":
        raise CommandError(f"--map {shortened(printable(arguments.map))}: must end in .png")


def _map(arguments: Namespace, task: Task) -> Output | None:
    """Return where the picture goes, which can be drawn and written."""
    if arguments.map is None:
        return None
    require("--map", "plot", "matplotlib")
    map_grids(task.space)
    return Output("--map", arguments.map)


def _output(arguments: Namespace) -> Output | None:
    """Return where the rows go, which can be written."""
    if arguments.out is None:
        return None
    output = Output("--out", arguments.out)
    if output.to_stdout:
        raise CommandError("--out -: must be a path, whose ending names the format")
    check_output(output, arguments)
    return output


def _space(world: World, arguments: Namespace) -> dict[str, Any]:
    """Return the fields that differ from run to run, and their values."""
    space: dict[str, Any] = {}
    for text in arguments.vary:
        place, values = vary(world, text, _MOST_VALUES)
        _once(space, place.path, "--vary")
        space[place.path] = list(values)
    for text in arguments.sample:
        path, sign, law = text.rpartition("=")
        parts = tuple(part.strip() for part in law.split(":"))
        if not sign or len(parts) != 3 or parts[0] not in ("uniform", "normal", "sobol"):
            raise CommandError(
                f"--sample {shown(text)}: must be {SAMPLE_FORM}, LAW one of uniform, normal, sobol"
            )
        _once(space, path.strip(), "--sample")
        space[path.strip()] = parts
    refuse_set(world, arguments.set, space)
    if not space:
        raise CommandError("--vary: must be given, or --sample: what differs from run to run")
    return space


def _once(space: dict[str, Any], path: str, option: str) -> None:
    if path in space:
        raise CommandError(f"{option}: {printable(path)}: is given twice; a field must be given once")


def _measures(arguments: Namespace) -> dict[str, str]:
    """Return the measures by their columns."""
    found: dict[str, str] = {}
    for text in arguments.measure or ["time"]:
        name, sign, expression = text.partition("=")
        named = bool(sign) and name.strip().isidentifier() and not expression.startswith("=")
        key, value = (name.strip(), expression.strip()) if named else (text.strip(), text.strip())
        if key in found:
            raise CommandError(f"--measure {shown(text)}: is given twice")
        found[key] = value
    return found


@contextmanager
def _workers(arguments: Namespace) -> Iterator[Workers]:
    """Give who makes the runs: processes of this machine, or a cluster."""
    if arguments.dask is None:
        if arguments.workers is not None:
            check_whole("--workers", arguments.workers, 1, MOST_WORKERS)
        yield Workers("processes", arguments.workers)
        return
    with Dask(arguments.dask) as cluster:
        try:
            yield Workers(cluster, None)
        except BrokenExecutor as error:
            words = "the scheduler is gone; with --out, the same command goes on where this one has stopped"
            raise CommandError(f"--dask {shown(arguments.dask)}: {words}", FAILED) from error


def _open(task: Task, row: int) -> int:
    """Open the window on the scene of a row."""
    if row >= len(task.space):
        raise CommandError(f"--open {row}: must be a row from 0 to {len(task.space) - 1}")
    require_window("--open")
    from physicslab.desktop.app import NoScreen, open_window  # no command without a window imports pygame

    try:
        return open_window(task.world(row))
    except NoScreen as error:
        raise CommandError(str(error)) from error


def _tell(result: EnsembleResult, label: str, output: Output | None) -> None:
    """Say what came of it."""
    failed = f", {len(result.failures):,} of them with a failure" if result.failures else ""
    where = label if output is None else printable(output.path)
    found = f"; {result.found:,} were there already" if result.found else ""
    print(f"{where}: {len(result):,} runs{failed}{found}")
    for row, why in [*result.failures.items()][:_SHOWN_FAILURES]:
        print(f"  row {row}: {why}")
    if output is None:
        for line in _summary(result):
            print(line)


def _summary(result: EnsembleResult) -> list[str]:
    """Return least, mean and greatest of each measure, as far as runs gave it a value."""
    return [
        f"  {name}: least {one['least']:.6g}, mean {one['mean']:.6g}, greatest {one['greatest']:.6g}"
        if one["count"]
        else f"  {name}: no run gave it a value"
        for name, one in result.spread().items()
    ]
