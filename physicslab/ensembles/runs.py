"""One scene, many runs: the rows of a space, on all processors or a cluster."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from physicslab.ecs.fields import InvalidValue
from physicslab.ensembles.measures import Measure, Measures
from physicslab.ensembles.result import EnsembleResult, check_format
from physicslab.ensembles.sink import Sink, parts_folder
from physicslab.ensembles.space import Given, check_whole, space_of
from physicslab.ensembles.task import Task
from physicslab.ensembles.workers import KINDS, MOST_WORKERS, Workers
from physicslab.files.checks import SceneError, shown
from physicslab.files.json_text import json_bytes
from physicslab.files.replace import check_writable, reason_of
from physicslab.files.scene import load_scene
from physicslab.files.writer import write_scene
from physicslab.state.run import BODY_COLUMNS, Columns, library
from physicslab.stepping.run import run_length
from physicslab.world import World

_TAKEN = ("wall_s", "failure", "replica")


def ensemble(
    scene: str | os.PathLike[str] | Mapping[str, Any] | World, space: Mapping[str, Given], *,
    measure: Measure | Mapping[str, Measure], seconds: float | None = None, steps: int | None = None,
    until: str | None = None, samples: int | None = None, seed: int = 0, replicas: int = 1,
    jitter: float | str | Mapping[str, float | str] = 0.0, executor: str | Executor = "processes",
    workers: int | None = None, out: str | os.PathLike[str] | None = None,
    progress: Callable[[float], object] | bool = False,
) -> EnsembleResult:  # fmt: skip
    """Run a scene once for each row of a space, and measure each run.

    Parameters
    ----------
    scene : str, path, dict or World
        The scene to run; a world as it is now.
    space : mapping of str to list or tuple
        Fields (``ball.Mass.mass``, ``ball.Velocity.linear.x``, ``physics.gravity.y``) and their values, in SI
        or as texts with units. A list or an array is a grid, of which every combination is run;
        ``("uniform", a, b)``, ``("normal", mean, deviation)`` and ``("sobol", a, b)`` are drawn for each
        sample; ``("rows", values)`` has a value for each.
    measure : str, callable, or mapping of str to either
        Measures of a run by the names of their columns: an expression of its figures
        (:mod:`physicslab.ensembles.measures`), or an importable function of the world at its end.
    seconds, steps : float or int
        How long a run is: one of the two.
    until : str, optional
        A condition with which a run ends, as of :meth:`World.record`; within ``seconds``, or it failed.
    samples : int, optional
        How many are drawn, for each combination of the grids.
    seed : int
        The seed of what is drawn. A row's numbers depend on it and on the row's place alone.
    replicas : int
        How many runs of each row there are.
    jitter : float, str, or mapping of str to either
        By which deviation [SI] the numbers of all but the first differ: one for all that is varied, or one
        for each field.
    executor : str or concurrent.futures.Executor
        ``"processes"``, ``"threads"``, ``"serial"``, or one of your own.
    workers : int, optional
        How many; by default one for each processor.
    out : path, optional
        A file (``.npz``, ``.csv``, ``.parquet``) for the columns. Until it is whole, its rows are in a folder
        beside it, and what is run again goes on there; once it is, a key beside it tells that no run is left.
    progress : callable or bool
        Called with the share that is done, from 0 to 1; ``True`` shows a bar with the time that is left, in a
        terminal or a notebook (needs tqdm, which comes with the extra ``notebook``).

    Returns
    -------
    EnsembleResult
        Its ``columns`` are a dict of arrays.

    Raises
    ------
    SceneError
        If anything of this cannot be; nothing is begun then.

    Examples
    --------
    >>> result = ensemble("drop", {"ball.Material.restitution": [0.5, 0.7, 0.9]},
    ...                   measure={"height": "ball.position.y"}, seconds=1.2, executor="serial")
    >>> result.columns["height"].round(3).tolist()
    [1.126, 1.685, 1.964]
    """
    task = task_of(
        scene, space, measure=measure, seconds=seconds, steps=steps, until=until, samples=samples, seed=seed,
        replicas=replicas, jitter=jitter,
    )  # fmt: skip
    if workers is not None:
        workers = check_whole("workers", workers, 1, MOST_WORKERS)
    if executor not in KINDS and not isinstance(executor, Executor):
        raise SceneError(f"executor {shown(executor)}: must be one of {', '.join(KINDS)}, or an Executor")
    with _told(progress, len(task.space)) as tell:
        return run_task(task, Workers(executor, workers), None if out is None else Path(out), tell)


@contextmanager
def _told(
    progress: Callable[[float], object] | bool, rows: int
) -> Iterator[Callable[[float], object] | None]:
    """Give what is told of the share that is done, if anything is."""
    if not isinstance(progress, bool):
        yield progress
    elif not progress:
        yield None
    else:
        with library("tqdm.auto", "progress=True").tqdm(total=rows, unit=" runs") as bar:
            yield lambda share: bar.update(round(share * rows) - bar.n)


def task_of(
    scene: str | os.PathLike[str] | Mapping[str, Any] | World, space: Mapping[str, Given], *,
    measure: Measure | Mapping[str, Measure], seconds: float | None = None, steps: int | None = None,
    until: str | None = None, samples: int | None = None, seed: int = 0, replicas: int = 1,
    jitter: float | str | Mapping[str, float | str] = 0.0,
) -> Task:  # fmt: skip
    """Return what :func:`ensemble` of the same arguments runs, all of it checked."""
    world = scene if isinstance(scene, World) else load_scene(scene)
    document = json_bytes(write_scene(world))
    measures = measure if isinstance(measure, Mapping) else {_name_of(measure): measure}
    takes = all(isinstance(one, str) or callable(one) for one in measures.values())
    if not (measures and takes and all(isinstance(name, str) and name for name in measures)):
        words = "must be an expression, a function of the world, or a dict of them by their names"
        raise SceneError(f"measure {shown(measure)}: {words}")
    trial = load_scene(write_scene(world))
    rows = space_of(trial, space, samples, seed, replicas, jitter)
    taken = {*_TAKEN, *(axis.name for axis in rows.axes)}
    for name in measures:
        if name in taken:
            raise SceneError(f"measure {shown(name)}: is the name of another column")
    tried = Measures(trial, measures)
    run_length(trial, seconds, steps)
    if until is not None:
        _check_until(trial, until, tried)
    return Task(document, rows, dict(measures), seconds, steps, until)


def check_condition(world: World, until: str) -> None:
    """Refuse a condition that a world has not."""
    try:
        world.record(0.0, until=until)
    except InvalidValue as error:
        raise SceneError(f"until {shown(until)}: must be {error.allowed}") from error


def _check_until(world: World, until: str, measures: Measures) -> None:
    """Refuse a condition that a world has not, and measures that runs until one have not."""
    check_condition(world, until)
    if measures.needs_path and not measures.path_is_motion:
        words = ", ".join(BODY_COLUMNS)
        raise SceneError(f"measure: with until, what looks at the whole run must be of {words} of what moves")


def run_task(
    task: Task, workers: Workers, out: Path | None, progress: Callable[[float], object] | None
) -> EnsembleResult:
    """Make the runs that are not there yet, and return all results.

    Raises
    ------
    SceneError
        If the results cannot be written.
    """
    if out is not None:
        _check_out(out)
    sink = Sink(task, out)
    done, rows = 0, len(task.space)
    with sink.alone():
        try:
            with workers:
                for block in workers.blocks(task, sink.missing()):
                    sink.put(block)
                    done += len(block.values)
                    if progress is not None:
                        progress((done + sink.found) / rows)
        except KeyboardInterrupt as error:
            kept = "" if out is None else "; the same call goes on there"
            error.add_note(f"after {done + sink.found:,} of {rows:,} runs{kept}")
            raise
        finally:
            sink.flush()
        if progress is not None and not done:
            progress(1.0)
        columns, failures = _joined(task, sink)
        sink.write(columns, failures)
    return EnsembleResult(Columns(columns), failures, task, sink.found)


def _check_out(out: Path) -> None:
    """Refuse a file to which the results cannot go, or beside which their parts cannot."""
    check_format(out)
    if out.exists() and not out.is_dir() and not out.is_file():
        raise SceneError(f"out {out}: is a pipe or a device; must be a plain file, which is read again")
    for path in (out, parts_folder(out)):
        try:
            check_writable(path / "part" if path != out and os.path.lexists(path) else out)
        except (OSError, ValueError) as error:
            raise SceneError(f"out {path}: cannot be written: {reason_of(error)}") from error


def _joined(task: Task, sink: Sink) -> tuple[dict[str, Any], dict[int, str]]:
    """Return the columns of all parts, and the failures."""
    rows = len(task.space)
    columns: dict[str, Any] = task.space.columns(0, rows)
    values, wall_s = np.empty((len(task.measures), rows)), np.empty(rows)
    failures: dict[int, str] = {}
    for part in sink.results():
        span = slice(part.first, part.first + len(part.done))
        values[:, span], wall_s[span] = part.values.T, part.wall_s
        failures |= part.failures
    columns |= dict(zip(task.measures, values, strict=True))
    reasons = np.full(rows, "", object)
    for row, why in failures.items():
        reasons[row] = why
    return {**columns, "wall_s": wall_s, "failure": reasons}, dict(sorted(failures.items()))


def _name_of(measure: Measure) -> str:
    return measure if isinstance(measure, str) else getattr(measure, "__name__", "")
