"""Run a scene without a window, and say what came of it."""

import dataclasses
import io
import math
import sys
from argparse import Namespace
from collections.abc import Mapping
from contextlib import AbstractContextManager, nullcontext
from mimetypes import guess_type
from pathlib import Path
from typing import TextIO

from physicslab.commands import FAILED, CommandError, require_window, tell
from physicslab.commands.measured_run import MeasuredRun
from physicslab.commands.opening import check_output, check_seconds, name_of, opened
from physicslab.commands.output import Output
from physicslab.commands.progress import Progress
from physicslab.diagnostics.impact_table import ImpactTableWriter
from physicslab.diagnostics.precision import find_imprecise, words_of_digits
from physicslab.diagnostics.run_report import advice_of, find_not_finite, run_report, run_summary
from physicslab.diagnostics.trajectory import TrajectoryWriter
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.text import printable, shortened
from physicslab.files.checks import shown
from physicslab.files.json_text import json_bytes
from physicslab.files.scene import SceneError, save_last_good
from physicslab.kernels.tiers import Tiers
from physicslab.state.masses import Diverged
from physicslab.stepping.small import is_small
from physicslab.world import World


def execute(arguments: Namespace) -> int:
    """Run the scene and write the chosen outputs; a summary on stdout if nothing else goes there."""
    outputs = _outputs(arguments)
    if arguments.every is not None and "csv" not in outputs:
        raise CommandError("--every: must go with --csv, whose rows it spaces")
    if arguments.csv_for is not None and not {"csv", "ledger"} & {*outputs}:
        raise CommandError("--csv-for: must go with --csv or --ledger, whose rows it is about")
    world = opened(arguments)
    with Tiers(is_small(world)) as tiers:
        return _execute(world, arguments, outputs, tiers)


def _execute(world: World, arguments: Namespace, outputs: Mapping[str, Output], tiers: Tiers) -> int:
    """Run a world, and write the chosen outputs."""
    _configure(world, arguments)
    start = world.time
    name = name_of(world, arguments)
    label = shortened(printable(name))
    seconds = arguments.seconds if arguments.steps is None else None
    for_excel = arguments.csv_for is not None
    with _stream(outputs, "csv") as stream, _stream(outputs, "ledger") as impacts:
        keep = None if stream is None else TrajectoryWriter(stream, world, for_excel=for_excel).write
        table = None if impacts is None else ImpactTableWriter(impacts, world, for_excel=for_excel)
        try:
            run = MeasuredRun(world, name, tiers, arguments.at_most, keep, arguments.every or 0.0, table)
            run.go(seconds, arguments.steps)
        except Diverged as error:
            raise CommandError(f"{label}: {error}; {_rescue(world, name, outputs)}", FAILED) from error
    if table is not None and table.lost:
        lines = f"--ledger: {table.lost} of {table.lost + table.rows} impacts are not in it"
        tell(f"physicslab: {label}: {lines}: too many between two readings")
    report, stopped = run_report(world, run.record), run.stopped
    place = find_not_finite(report)
    if place is not None:
        where = f"{place} is not finite at t = {world.time:.9g} s: the run diverged"
        raise CommandError(f"{label}: {where}; {_rescue(world, name, outputs)}", FAILED)
    if stopped:
        report["stopped"] = stopped
    if arguments.trust:
        report["trust"] = trust = _trust(arguments, label, world.time - start)
        report["advice"] += advice_of(words_of_digits(trust))
    else:
        report["advice"] += advice_of(find_imprecise(world, run.record.audit))
    if "json" in outputs:
        outputs["json"].write(json_bytes(report))
    if "png" in outputs:
        outputs["png"].write(_picture(world))
    if not any(output.to_stdout for output in outputs.values()):
        print(run_summary({**report, "scene": label}, world.title, start))
    if stopped:
        raise CommandError(f"{label}: {stopped}", FAILED)
    return 0


def _stream(outputs: Mapping[str, Output], kind: str) -> AbstractContextManager[TextIO | None]:
    """Return the stream of an output that is written bit by bit, ``None`` where it is not wanted."""
    return outputs[kind].stream() if kind in outputs else nullcontext()


def _trust(arguments: Namespace, label: str, seconds: float) -> dict[str, object]:
    """Compute the run in other ways, and return its reliable digits."""
    from physicslab.lab.accuracy.trust import assess, trust_report  # the lab is needed here alone
    from physicslab.lab.jobs import result_of

    def load() -> World:
        world = opened(arguments, again=True)
        _configure(world, arguments)
        return world

    with Progress(f"{label}, computed in other ways", sys.stderr) as progress:
        return trust_report(result_of(assess(load, seconds), progress.show))


def _rescue(world: World, name: str, outputs: Mapping[str, Output]) -> str:
    """Save the last good state beside the JSON document, or here; return the message."""
    json = outputs.get("json")
    directory = Path() if json is None or json.to_stdout else Path(json.path).parent
    try:
        path = save_last_good(world, name, directory)
    except (OSError, SceneError) as error:
        return f"the last good state, of t = {world.time:.9g} s, could not be saved: {error}"
    return f"the last good state, of t = {world.time:.9g} s, is in {path}"


def _outputs(arguments: Namespace) -> dict[str, Output]:
    """Return the chosen outputs, all of them writable and none in the way of another."""
    wanted = {kind: getattr(arguments, kind) for kind in ("json", "csv", "ledger", "png")}
    outputs = {kind: Output(f"--{kind}", path) for kind, path in wanted.items() if path is not None}
    if "png" in outputs:
        if guess_type(outputs["png"].path)[0] not in (None, "image/png"):
            raise CommandError(f"{outputs['png'].label}: must end in .png")
        require_window("--png")
    for kind, output in outputs.items():
        check_output(output, arguments)
        for other, second in outputs.items():
            if other != kind and ((output.to_stdout and second.to_stdout) or output.is_same_as(second.path)):
                raise CommandError(f"--{kind} and --{other} cannot both go to {output.path}")
    return outputs


def _configure(world: World, arguments: Namespace) -> None:
    """Configure the world by the command line, and prepare it, so that only the run itself is timed."""
    changes = {name: getattr(arguments, name) for name in ("dt", "substeps", "integrator", "contacts")}
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
    if arguments.contacts == "rigid" and world.plan.contacts != "rigid":
        raise CommandError(f"--contacts rigid: {world.plan.contact_reason}")
    if arguments.steps is not None and not math.isfinite(arguments.steps * world.simulation.dt):
        raise CommandError(
            f"--steps {arguments.steps}: must take a finite time at {world.simulation.dt:g} s each"
        )
    if arguments.steps is None:
        check_seconds(arguments.seconds, world.simulation.dt)


def _picture(world: World) -> bytes:
    """Return a PNG of the world as it is now; pygame draws it, without a display."""
    from physicslab.view.picture.picture import save_png

    picture = io.BytesIO()
    save_png(world, picture)
    return picture.getvalue()
