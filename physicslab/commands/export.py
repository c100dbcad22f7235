"""Export a run as a page of HTML that plays it in any browser, or as a film (GIF, MP4)."""

import json
import os
import sys
from argparse import Namespace
from collections.abc import Sequence
from typing import Any

from physicslab.commands import FAILED, CommandError, require_window
from physicslab.commands.measured_run import MeasuredRun
from physicslab.commands.opening import check_output, check_seconds, name_of, opened
from physicslab.commands.output import Output
from physicslab.commands.progress import Progress
from physicslab.commands.usage import POSES
from physicslab.commands.variations import Variation, combinations, variations
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.text import printable, shortened
from physicslab.export.film import Film, NoEncoder
from physicslab.export.instants import Instants
from physicslab.export.page import page, run_document
from physicslab.export.recording import Box, NotShown, RunRecorder, extent_of_run
from physicslab.files.replace import reason_of
from physicslab.files.scene import SceneError
from physicslab.kernels.tiers import Tiers
from physicslab.lab.jobs import ProcessEnded, in_processes
from physicslab.state.joint_closing import close_joints
from physicslab.state.masses import Diverged
from physicslab.stepping.small import is_small
from physicslab.world import World

_FILM_EVERY_S = 1.0 / 30.0


def make_film(option: str, path: str, arguments: Namespace) -> None:
    """Run the scene, and write the film of it.

    Raises
    ------
    CommandError
        If it cannot be written, or the run fails; no file is left then.
    """
    require_window(option)
    output = Output(option, path)
    if output.to_stdout:
        raise CommandError(f"{option} -: must be a path: a film does not go to stdout")
    check_output(output, arguments)
    world = opened(arguments)
    dt, seconds = world.simulation.dt, arguments.seconds
    check_seconds(seconds, dt)
    every = max(arguments.every or _FILM_EVERY_S, dt)
    rate = arguments.fps or 1.0 / every
    try:
        Film.check(path, rate)
    except NoEncoder as error:
        raise CommandError(f"{option}: {error}") from error
    except ValueError as error:
        raise CommandError(f"{output.label}: {error}") from error
    name = name_of(world, arguments)
    film, stopped = _run(world, name, output, every, rate, arguments)
    if stopped:
        raise CommandError(f"{shortened(printable(name))}: {stopped}: the film ends there", FAILED)
    size = f"{os.path.getsize(path) / 1000:,.0f} kB"
    pictures = "1 picture" if film.count == 1 else f"{film.count:,} pictures"
    width, height = film.size
    shown = f"{pictures} of {width} x {height} px, {rate:.4g} a second"
    print(f"{printable(path)}: {seconds:g} s of the scene, {shown}, {size}")


def _run(
    world: World, name: str, output: Output, every: float, rate: float, arguments: Namespace
) -> tuple[Film, str]:
    """Make the film; return it, and where the run was stopped, if it was."""
    from physicslab.view.overlay.moving import MovingPicture

    try:
        with Tiers(is_small(world)) as tiers:
            extent = world.view or _extent(name, every, arguments, tiers)
            picture = MovingPicture(arguments.size, extent)
            with Film(output.path, arguments.size, rate) as film:
                instants = Instants(world, every, lambda now: film.write(picture.pixels(now)))
                keep, spacing = instants.keep, instants.spacing
                run = MeasuredRun(world, name, tiers, arguments.at_most, keep, spacing)
                run.go(arguments.seconds, None)
    except (Diverged, NotShown) as error:
        raise CommandError(f"{shortened(printable(name))}: {error}; no film was written", FAILED) from error
    except OSError as error:
        label = shortened(printable(output.path), 200)
        raise CommandError(f"{label}: cannot be written: {reason_of(error)}", FAILED) from error
    return film, run.stopped


def _extent(name: str, every: float, arguments: Namespace, tiers: Tiers) -> Box:
    """Return where a run takes place of which the scene does not say it: it is made once before.

    Each of the two has the time that one may take.
    """
    world = opened(arguments)
    recorder = RunRecorder(world)
    run = MeasuredRun(world, name, tiers, arguments.at_most, recorder.write, every)
    run.go(arguments.seconds, None)
    return extent_of_run(world, recorder)


_EVERY_S, _EVERY_OF_MANY_S = 1.0 / 60.0, 1.0 / 30.0
"""Time between two instants of a page, and of one that holds many runs [s]."""
_SIZE = (960, 540)
"""Width and height of a film [px]."""


def execute(arguments: Namespace) -> int:
    """Run the scene, and write the page or the film."""
    for option in ("gif", "mp4"):
        path = getattr(arguments, option)
        if path is not None:
            if arguments.vary:
                raise CommandError("--vary: is for --html: a film has no sliders")
            arguments.size = arguments.size or _SIZE
            make_film(f"--{option}", path, arguments)
            return 0
    for option in ("fps", "size"):
        if getattr(arguments, option) is not None:
            raise CommandError(
                f"--{option}: is for --gif and --mp4; a page has a size and a speed of its own"
            )
    arguments.every = arguments.every or (_EVERY_OF_MANY_S if arguments.vary else _EVERY_S)
    make_page(arguments)
    return 0


def make_page(arguments: Namespace) -> None:
    """Run the scene, once or for each value that is varied, and write the page.

    Raises
    ------
    CommandError
        If the page cannot be written, or a run fails that is the only one.
    """
    output = Output("--html", arguments.html)
    check_output(output, arguments)
    world = opened(arguments)
    varied = variations(world, arguments.vary, arguments.set)
    tasks = [{"set": [*arguments.set, *texts]} for texts in combinations(varied)]
    _check_size(world, len(tasks), arguments)
    shared = {key: getattr(arguments, key) for key in ("scene", "seconds", "every", "at_most")}
    shared["is_one_of_many"] = len(tasks) > 1
    shared["progress"] = arguments.progress and len(tasks) == 1  # of many it is said how many are made
    label = shortened(printable(name_of(world, arguments)))
    names = [json.dumps(shared | task) for task in tasks]
    runs = _runs(names, Progress(label, sys.stderr, always=arguments.progress))
    made = [run for run in runs if "document" in run]
    if not made:
        raise CommandError(f"{label}: {runs[0]['failure']}; no page was written", FAILED)
    documents = [run.get("document") or {"failure": run["failure"]} for run in runs]
    content = page(world, name_of(world, arguments), documents, [one.varied for one in varied])
    output.write(content)
    stopped = next((run["stopped"] for run in made if run["stopped"]), "")
    if stopped:
        raise CommandError(f"{label}: {stopped}: the page ends there", FAILED)
    if not output.to_stdout:
        _tell(output, documents, varied, arguments, len(content))


def _tell(
    output: Output, documents: Sequence[Any], varied: Sequence[Variation], arguments: Namespace, size: int
) -> None:
    """Say what the page holds."""
    shown = next(document for document in documents if "instants" in document)
    moving = sum("moves" in body for body in shown["bodies"])
    bodies = "1 body that moves" if moving == 1 else f"{moving:,} bodies that move"
    failed = sum("failure" in document for document in documents)
    runs = f", {len(documents)} runs" if varied else ""
    runs += f" of which {failed} failed" if failed else ""
    length = f"{arguments.seconds:g} s, {shown['instants']:,} instants{runs}"
    print(f"{printable(output.path)}: {length}, {bodies}, {size / 1000:,.0f} kB")


def _runs(names: Sequence[str], progress: Progress) -> list[dict[str, Any]]:
    """Make all runs, in processes where there are many; return what came of each."""
    found: list[dict[str, Any]] = []
    with progress:
        try:
            for done in in_processes(make_run, names, [[name] for name in names]):
                if isinstance(done, dict):
                    found.append(done)
                progress.show(len(found) / len(names) if isinstance(done, dict) else done)
        except ProcessEnded as error:
            raise CommandError(str(error), FAILED) from None
    return found


def make_run(task: str) -> dict[str, Any]:
    """Make a run, which a JSON text describes; return its document and notes, or its error."""
    arguments = Namespace(**json.loads(task))
    try:
        world = opened(arguments, again=True)
        if arguments.set:
            world.synchronise()
            close_joints(world)  # or the first picture has the rod's former length, and its energy
        name = name_of(world, arguments)
        recorder = RunRecorder(world)
        with Tiers(is_small(world)) as tiers:
            run = MeasuredRun(
                world, name, tiers, arguments.at_most, recorder.write, arguments.every,
                always=arguments.progress,
            )  # fmt: skip
            run.go(arguments.seconds, None)
    except (Diverged, NotShown, CommandError, SceneError, InvalidValue) as error:
        return {"failure": str(error)}
    notes, many = _notes(world, run), arguments.is_one_of_many
    return {"document": run_document(world, recorder, notes, is_one_of_many=many), "stopped": run.stopped}


def _check_size(world: World, runs: int, arguments: Namespace) -> None:
    """Refuse a run of which no browser would show a page."""
    dt, seconds = world.simulation.dt, arguments.seconds
    check_seconds(seconds, dt)
    instants = seconds / max(arguments.every, dt)
    bodies = max(RunRecorder(world).moving, 1)
    if instants * bodies * runs > POSES:
        times = f" in {runs} runs" if runs > 1 else ""
        raise CommandError(
            f"--seconds {seconds:g}: {instants:,.0f} instants of {bodies:,} bodies{times}; a page must hold "
            f"at most {POSES:,} poses: fewer seconds, or a longer --every than "
            f"{max(arguments.every, dt):.3g} s"
        )


def _notes(world: World, run: MeasuredRun) -> list[str]:
    """Return how the run was computed, and what of it is not to be trusted, a line each."""
    simulation, audit = world.simulation, run.record.audit
    causes = f"energy changed by {' and '.join(audit.causes)}, " if audit.causes else ""
    energy = f"{causes}error of the energy {audit.error:.2g} of what is exchanged"
    methods = " and ".join(dict.fromkeys(plan.integrator.name for plan in world.plans))
    method = f"{methods}, {run.record.steps} steps of {simulation.dt:.6g} s"
    advice = [f"Not to be trusted: {found}." for found in run.record.warnings.all]
    return [f"Computed by {method}, {simulation.substeps} substeps each; {energy}.", *advice]
