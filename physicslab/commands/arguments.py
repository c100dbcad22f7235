"""Arguments of several commands: a scene, and numbers, each refused with the allowed range."""

import argparse
import math
import sys
from argparse import Namespace
from collections.abc import Iterable
from pathlib import Path

from physicslab.commands import CommandError
from physicslab.commands.output import Output
from physicslab.ecs.text import printable
from physicslab.files.assignments import assign
from physicslab.files.scene import load_scene
from physicslab.scenes import SCENES
from physicslab.world import World

STEP_LIMIT = 10**15
"""More than any run will do; beyond it, times could no longer be counted exactly."""


def add_assignments(parser: argparse.ArgumentParser) -> None:
    """Declare the option ``--set``, which may be given any number of times."""
    words = (
        "set a field before the run: a number in SI units or with a unit of its own (2 kg, 30 deg, 5 km/h), "
        "[x, y], [[x, y], ...], true, false, null or a word; of the laws, physics.field or simulation.field; "
        "repeat it for more fields"
    )
    parser.add_argument("--set", metavar="ID.Component.field=VALUE", action="append", default=[], help=words)


def add_budget(parser: argparse.ArgumentParser) -> None:
    """Declare the wall-clock time after which a command stops."""
    budget = "stop after so many seconds of wall clock, compiling left out: exit 1, with the results so far"
    parser.add_argument("--at-most", metavar="SECONDS", type=positive_duration, help=budget)


def stopped_at(budget: float, time: float, done: int, whole: int) -> str:
    """Return in words where a command was stopped by it."""
    place = f"at t = {time:.9g} s, after {done} of {whole} steps"
    return f"stopped after {budget:g} s of wall clock (--at-most) {place}"


def duration(text: str) -> float:
    """Return a time [s] that is finite and not negative."""
    return _seconds(text, 0.0, ">= 0")


def positive_duration(text: str) -> float:
    """Return a time [s] that is finite and greater than 0."""
    return _seconds(text, math.ulp(0.0), "> 0")


def count(text: str) -> int:
    """Return a whole number that is not negative."""
    return _whole(text, 0)


def positive_count(text: str) -> int:
    """Return a whole number of at least 1."""
    return _whole(text, 1)


def _seconds(text: str, least: float, range_: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not least <= seconds < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r}: must be a finite number {range_} s")
    return seconds


def _whole(text: str, least: int) -> int:
    try:
        number = int(text)
    except ValueError:
        number = least - 1
    if not least <= number <= STEP_LIMIT:
        raise argparse.ArgumentTypeError(
            f"{text!r}: must be a whole number >= {least}, at most {STEP_LIMIT:g}"
        )
    return number


def opened(arguments: Namespace, *, again: bool = False) -> World:
    """Return the scene that was named, with the fields that were set; say once what of it is not taken."""
    losses: list[str] = []
    world = load_scene(arguments.scene, losses)
    if not again:
        tell_losses(losses)
    assign(world, arguments.set)
    return world


def tell_losses(losses: Iterable[str]) -> None:
    """Name on stderr what of a file has no place in a scene, a line each."""
    for loss in losses:
        print(f"not taken: {printable(loss)}", file=sys.stderr)


def name_of(world: World, arguments: Namespace) -> str:
    """Return what the scene is called, in a report and in the names of files."""
    return world.name or Path(arguments.scene).stem


def check_output(output: Output, arguments: Namespace) -> None:
    """Refuse an output that is the scene itself."""
    if arguments.scene not in SCENES:
        output.refuse_same(arguments.scene, "the scene")


def check_seconds(seconds: float, dt: float) -> None:
    """Refuse a time of more steps than can be counted."""
    if seconds / dt > STEP_LIMIT:
        raise CommandError(f"--seconds {seconds:g}: must be at most {STEP_LIMIT:g} steps of dt")
