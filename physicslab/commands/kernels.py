"""Compile the physics for this computer ahead of time, or share what is compiled with others of its kind."""

import platform
import sys
from argparse import Namespace
from pathlib import Path

import physicslab
from physicslab.commands import FAILED, CommandError, tell
from physicslab.commands.interrupts import end_at_once
from physicslab.commands.output import Output
from physicslab.commands.progress import Progress
from physicslab.ecs.text import printable
from physicslab.files.plain import open_plain
from physicslab.files.replace import reason_of
from physicslab.kernels import cache_directory
from physicslab.kernels.archive import ArchiveError, pack, unpack, wheel
from physicslab.kernels.cache import mark
from physicslab.kernels.keys import platform_key, use_processor
from physicslab.kernels.warm import Warmup, is_warm, load_all, mark_warm, work

_LOOK_EVERY_S = 0.1
_WARNING = (
    "physicslab: compiled kernels are programs: import none from people whose programs you would not run"
)


def execute(arguments: Namespace) -> int:
    """Compile all kernels, or write or read an archive of them."""
    if arguments.worker:
        end_at_once()
        return work()
    if (arguments.action is None) != (arguments.file is None):
        raise CommandError(f"kernels {arguments.action}: FILE is missing (see physicslab kernels --help)")
    if arguments.cpu != "native":
        if arguments.action not in ("export", "wheel"):
            raise CommandError(f"--cpu {arguments.cpu}: must go with export or wheel")
        if platform.machine() not in ("x86_64", "AMD64"):
            raise CommandError(
                f"--cpu {arguments.cpu}: this is {platform.machine()}, of which there are no kinds"
            )
        cache_directory()
        use_processor(arguments.cpu)
    if arguments.action == "import":
        return _import(arguments.file)
    if arguments.action == "wheel":
        return _wheel(Path(arguments.file))
    output = None if arguments.action is None else Output("kernels export", arguments.file)
    _fill()
    if output is not None:
        return _export(output)
    print(f"{len(load_all())} kernels are compiled, and kept in {printable(str(mark().parent))}")
    return 0


def _fill() -> None:
    """Have every kernel compiled that the cache does not hold."""
    if is_warm():
        return
    with Progress("compiling kernels", sys.stderr) as line, Warmup() as warmup:
        while not warmup.finished:
            progress = warmup.poll(_LOOK_EVERY_S)
            line.show(progress.done / progress.total)
    if not is_warm():
        raise CommandError("not every kernel could be compiled", FAILED)


def _export(output: Output) -> int:
    _write(output, pack())
    return 0


def _wheel(folder: Path) -> int:
    """Write a wheel into a folder, by the name that installers go by."""
    if not folder.is_dir():  # before anything is compiled
        raise CommandError(f"kernels wheel {printable(str(folder))}: must be a folder that is there")
    _fill()
    name, content = wheel(physicslab.__version__)
    _write(Output("kernels wheel", str(folder / name)), content)
    return 0


def _write(output: Output, content: bytes) -> None:
    """Write an archive, and say which computers it fits."""
    output.write(content)
    if not output.to_stdout:
        kind = ", ".join(f"{name} {value}" for name, value in platform_key().items())
        print(f"{len(content) / 1e6:.1f} MB written to {printable(output.path)}")
        print(f"They fit computers with {kind}")


def _import(file: str) -> int:
    try:
        open_plain(file, file, "an archive of kernels").close()
        unpack(Path(file))
    except ArchiveError as error:
        raise CommandError(f"{file}: {error}") from error
    except (OSError, ValueError) as error:  # ValueError: a null character in the name
        raise CommandError(f"{file}: {reason_of(error)}") from error
    tell(_WARNING)
    mark_warm()
    complete = "all kernels are there" if is_warm() else "some kernels are missing: those will be compiled"
    print(f"imported; {complete}")
    return 0
