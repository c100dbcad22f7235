"""Play a recording without a window, and say where its bits first differ."""

import time
from argparse import Namespace
from typing import Any

from physicslab.commands import FAILED, CommandError
from physicslab.commands.opening import stopped_at
from physicslab.commands.output import JsonOutput
from physicslab.ecs.text import printable, shortened
from physicslab.history.recording import load
from physicslab.history.replay import Played, play
from physicslab.kernels.tiers import Tiers
from physicslab.state.masses import Diverged
from physicslab.stepping.small import is_small
from physicslab.world import World


def execute(arguments: Namespace) -> int:
    """Play the recording to its end; exit 1 where a column of a step has other bits than in the recording."""
    label = shortened(printable(arguments.file), 200)
    output = JsonOutput(arguments.json, arguments.file, "the recording")
    world, line = load(arguments.file)
    first: Played | None = None
    stopped, began = "", time.perf_counter() - world.compile_s
    with Tiers(is_small(world)):
        try:
            for played in play(world, line, label):
                if played.columns and first is None:
                    first = played
                seconds = time.perf_counter() - world.compile_s - began
                if (
                    arguments.at_most is not None
                    and seconds >= arguments.at_most
                    and played.step < line.steps
                ):
                    stopped = stopped_at(arguments.at_most, world.time, played.step, line.steps)
                    break
        except Diverged as error:
            raise CommandError(f"{label}: {error}", FAILED) from error
    output.write(_report(world, line.steps, len(line.entries), first, stopped))
    if first is not None:
        columns = " and ".join(first.columns)
        where = f"step {first.step} of {line.steps}, t = {first.time:.9g} s"
        raise CommandError(f"{label}: bits differ from {where} on, first in {columns}", FAILED)
    if stopped:
        raise CommandError(f"{label}: {stopped}, all bits as recorded so far", FAILED)
    if output.leaves_stdout:
        print(f"{label}: {line.steps} steps, t = {world.time:.9g} s, all bits as recorded")
    return 0


def _report(world: World, steps: int, entries: int, first: Played | None, stopped: str) -> dict[str, Any]:
    report: dict[str, Any] = {
        "format": "physicslab-replay/1", "entries": entries, "steps": steps, "time": world.time,
        "same": first is None,
    }  # fmt: skip
    if stopped:
        report["stopped"] = stopped
    if first is not None:
        report["first_difference"] = {"step": first.step, "time": first.time, "columns": list(first.columns)}
    return report
