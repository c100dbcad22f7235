"""The scene that a command runs: opened with what ``--set`` gives, named, and kept from being overwritten."""

from argparse import Namespace
from pathlib import Path

from physicslab.commands.assignments import assign
from physicslab.commands.command_error import CommandError
from physicslab.commands.numbers import STEP_LIMIT
from physicslab.commands.output import Output
from physicslab.files.scene import load_scene
from physicslab.scenes import SCENES
from physicslab.world import World


def opened(arguments: Namespace) -> World:
    """Return the scene that was named, with the fields that were set."""
    world = load_scene(arguments.scene)
    assign(world, arguments.set)
    return world


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
