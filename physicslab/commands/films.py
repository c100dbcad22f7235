"""Films of a run: GIF and MP4, drawn without a window."""

import argparse
import os
from argparse import Namespace

from physicslab.commands.command_error import FAILED, CommandError
from physicslab.commands.measured_run import MeasuredRun
from physicslab.commands.output import Output, reason_of
from physicslab.commands.scene_argument import check_output, check_seconds, name_of, opened
from physicslab.ecs.text import printable, shortened
from physicslab.export.film import Film
from physicslab.export.framing import Box, extent_of_run
from physicslab.export.mp4 import NoEncoder
from physicslab.export.recording import NotShown, RunRecorder
from physicslab.kernels.tiers import Tiers
from physicslab.state.masses import Diverged
from physicslab.stepping.small import is_small
from physicslab.world import World

_EVERY_S = 1.0 / 30.0
_SMALLEST, _LARGEST = 16, 4096


def film_size(text: str) -> tuple[int, int]:
    """Return width and height [px] of ``960x540``."""
    try:
        width, height = map(int, text.lower().split("x"))
    except ValueError:
        width = height = 0
    if not all(_SMALLEST <= number <= _LARGEST for number in (width, height)):
        allowed = f"WIDTHxHEIGHT, each from {_SMALLEST} to {_LARGEST} px"
        raise argparse.ArgumentTypeError(f"{text!r}: must be {allowed}")
    return width, height


def make_film(option: str, path: str, arguments: Namespace) -> None:
    """Run the scene, and write the film of it.

    Raises
    ------
    CommandError
        If it cannot be written, or the run fails; no file is left then.
    """
    output = Output(option, path)
    if output.to_stdout:
        raise CommandError(f"{option} -: must be a path: a film does not go to stdout")
    check_output(output, arguments)
    world = opened(arguments)
    dt, seconds = world.simulation.dt, arguments.seconds
    check_seconds(seconds, dt)
    every = max(arguments.every or _EVERY_S, dt)
    rate = arguments.fps or 1.0 / every
    try:
        Film.check(path, rate)
    except NoEncoder as error:
        raise CommandError(f"{option}: {error}") from error
    except ValueError as error:
        raise CommandError(f"{output.label}: {error}") from error
    name = name_of(world, arguments)
    count, stopped = _run(world, name, output, every, rate, arguments)
    if stopped:
        raise CommandError(f"{shortened(printable(name))}: {stopped}: the film ends there", FAILED)
    size = f"{os.path.getsize(path) / 1000:,.0f} kB"
    width, height = arguments.size
    shown = f"{count:,} pictures of {width} x {height} px, {rate:.4g} a second"
    print(f"{printable(path)}: {seconds:g} s of the scene, {shown}, {size}")


def _run(
    world: World, name: str, output: Output, every: float, rate: float, arguments: Namespace
) -> tuple[int, str]:
    """Make the film; return how many pictures it has, and where the run was stopped, if it was."""
    from physicslab.view.overlay.moving import MovingPicture

    try:
        with Tiers(is_small(world)) as tiers:
            extent = world.view or _extent(name, every, arguments, tiers)
            picture = MovingPicture(arguments.size, extent)
            with Film(output.path, arguments.size, rate) as film:
                run = MeasuredRun(
                    world, name, tiers, arguments.at_most,
                    lambda now, _: film.write(picture.pixels(now)), every,
                )  # fmt: skip
                run.go(arguments.seconds, None)
    except (Diverged, NotShown) as error:
        raise CommandError(f"{shortened(printable(name))}: {error}; no film was written", FAILED) from error
    except OSError as error:
        label = shortened(printable(output.path), 200)
        raise CommandError(f"{label}: cannot be written: {reason_of(error)}", FAILED) from error
    return film.count, run.stopped


def _extent(name: str, every: float, arguments: Namespace, tiers: Tiers) -> Box:
    """Return where a run takes place of which the scene does not say it: it is made once before.

    Each of the two has the time that one may take.
    """
    world = opened(arguments)
    recorder = RunRecorder(world)
    run = MeasuredRun(world, name, tiers, arguments.at_most, recorder.write, every)
    run.go(arguments.seconds, None)
    return extent_of_run(world, recorder)
