"""The commands of the contract: ``physicslab [SCENE]``, ``physicslab run SCENE``, ``physicslab scenes``."""

import os
import sys
from collections.abc import Sequence
from contextlib import suppress

import physicslab
from physicslab.commands import FAILED, USAGE, CommandError, command, require_window, tell
from physicslab.commands.interrupts import told
from physicslab.commands.parsers import WindowParser, completion, manual, parser_of
from physicslab.commands.usage import COMMANDS
from physicslab.ecs.text import printable, shortened, suggestion
from physicslab.scenes import SCENES

_LINE_LIMIT = 4_000
"""Characters of what is said on stderr: names of files and values come from outside."""
_PIPE_CLOSED = 141
"""The exit status that a shell reports for a program that a signal ended: 128 plus the signal's number."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status.

    0: done. 1: the run failed. 2: bad usage or a bad scene. 128 and more: a signal ended it, 130 that of
    Ctrl+C; 141: stdout was closed by its reader. Every error is one line on stderr.

    Parameters
    ----------
    argv : sequence of str, optional
        The arguments, without the program's name; by default those of the process.
    """
    os.environ.setdefault("PHYSICSLAB_INTERPRET", "0")  # each command decides on when to compile
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(
                errors="backslashreplace"
            )  # a terminal may not be able to show every letter of a title
    try:
        try:
            status = _dispatch(list(sys.argv[1:] if argv is None else argv))
        except SystemExit as done:  # argparse, after --help
            status = done.code if isinstance(done.code, int) else 0
        if sys.stdout is not None:
            sys.stdout.flush()
        return status
    except KeyboardInterrupt as error:  # before refusals: a package whose import it ended cannot be imported
        return _complain(*told(error))
    except CommandError as error:
        return _complain(str(error), error.status)
    except _refusals() as error:
        return _complain(str(error), USAGE)
    except ImportError as error:  # a package that is not there, or a setting with which none of this works
        return _complain(str(error), FAILED)
    except BrokenPipeError:
        _let_go_of_stdout()
        return _PIPE_CLOSED
    except OSError as error:
        _let_go_of_stdout()
        return _complain(": ".join(filter(None, (error.filename, error.strerror or str(error)))), FAILED)


def _dispatch(arguments: list[str]) -> int:
    if arguments and arguments[0] in COMMANDS:
        name, *rest = arguments
        own = parser_of(name)
        parsed, more = own.parse_known_args(rest)  # help and bad usage end here, before physics is imported
        if more:
            own.refuse(more)
        return command(name).execute(parsed)
    parser = WindowParser(_version())
    given, more = parser.parse_known_args(arguments)
    if more:
        likely = suggestion(given.scene or "", COMMANDS)
        misspelt = f"{given.scene}: is no command{likely}"
        if likely:
            parser.error(misspelt)
        parser.refuse(more)
    if given.print_completion is not None or given.print_manual:
        print(manual(_version()) if given.print_manual else completion(given.print_completion), end="")
        return 0
    return _open(given.scene)


def _refusals() -> tuple[type[Exception], ...]:
    """Return the errors that name a bad value; they are imported where something was raised."""
    from physicslab.ecs.fields import InvalidValue
    from physicslab.files.checks import SceneError

    return SceneError, InvalidValue


def _open(scene: str | None) -> int:
    """Open the window, on a scene if one is named."""
    require_window("the window")
    if scene is not None and scene.endswith(".md"):
        from physicslab.lessons.reader import read_lesson

        read_lesson(scene)
    elif scene is not None and scene not in SCENES:
        from physicslab.files.scene import load_scene

        load_scene(scene)  # a bad file is refused before a window flickers up
    from physicslab.desktop.app import NoScreen, open_window  # no command without a window imports pygame

    try:
        return open_window(scene)
    except NoScreen as error:
        raise CommandError(str(error), USAGE) from error


def _version() -> str:
    try:
        return f"physicslab {physicslab.__version__}"
    except ModuleNotFoundError:  # as importlib.metadata says of a package
        return "physicslab from a folder, which is not installed and has no version"


def _complain(message: str, status: int) -> int:
    """Print an error below what was printed before it, and return the status."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError:
        _let_go_of_stdout()
    tell(f"physicslab: {shortened(printable(message), _LINE_LIMIT)}")
    return status


def _let_go_of_stdout() -> None:
    """Redirect buffered output to nowhere, or Python would fail on it again at exit."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


if __name__ == "__main__":
    sys.exit(main())
