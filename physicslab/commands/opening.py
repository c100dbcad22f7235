"""The scene that a command line names, opened; how long it may run, and what is said of it."""

from argparse import Namespace
from collections.abc import Iterable
from pathlib import Path

from physicslab.commands import CommandError, tell
from physicslab.commands.output import Output
from physicslab.commands.usage import STEP_LIMIT
from physicslab.ecs.text import printable
from physicslab.files.assignments import assign
from physicslab.files.scene import load_scene
from physicslab.scenes import SCENES
from physicslab.world import World


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
        tell(f"not taken: {printable(loss)}")


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


def place_of(time: float, done: int, whole: int) -> str:
    """Return in words how far a run has come."""
    return f"at t = {time:.9g} s, after {done} of {whole} steps"


def stopped_at(budget: float, time: float, done: int, whole: int) -> str:
    """Return in words where a command was stopped by it."""
    return f"stopped after {budget:g} s of wall clock (--at-most) {place_of(time, done, whole)}"
