"""The commands of the contract: ``physicslab [SCENE]``, ``physicslab run SCENE``, ``physicslab scenes``."""

import argparse
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib.metadata import PackageNotFoundError
from typing import NoReturn

import physicslab
from physicslab.commands import COMMANDS, FAILED, USAGE, CommandError, command, require_window
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.text import printable, shortened
from physicslab.files.checks import SceneError
from physicslab.scenes import SCENES

_LINE_LIMIT = 4_000
"""Characters of what is said on stderr: names of files and values come from outside."""
_INTERRUPTED = 130
_PIPE_CLOSED = 141
"""What a shell reports of a program that a signal ended: 128 and the signal's number."""


class _Parser(argparse.ArgumentParser):
    """Refuses bad usage in one line, and takes no option by half its name."""

    def __init__(self, prog: str, description: str | None) -> None:
        super().__init__(prog=prog, description=description, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        raise CommandError(f"{message} (see {self.prog} --help)")


class _WindowParser(_Parser):
    """Lists the commands in its help alone, a line each; a window does not wait for their import."""

    def format_help(self) -> str:
        self.usage = "physicslab [SCENE] | physicslab COMMAND ... (physicslab COMMAND --help says more)"
        width = max(map(len, COMMANDS))
        summaries = ((command(name).__doc__ or "").splitlines()[0] for name in COMMANDS)
        lines = (f"  {name:<{width}}  {said}" for name, said in zip(COMMANDS, summaries, strict=True))
        return super().format_help() + "\n".join(["\ncommands:", *lines, ""])


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status.

    0: done. 1: the run failed. 2: bad usage or a bad scene. 130: interrupted. 141: stdout was closed
    by its reader. Every error is one line on stderr.

    Parameters
    ----------
    argv : sequence of str, optional
        The arguments, without the program's name; by default those of the process.
    """
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(
                errors="backslashreplace"
            )  # a terminal may not be able to show every letter of a title
    try:
        status = _dispatch(list(sys.argv[1:] if argv is None else argv))
        if sys.stdout is not None:
            sys.stdout.flush()
        return status
    except SystemExit as done:  # argparse, after --help
        return done.code if isinstance(done.code, int) else 0
    except CommandError as error:
        return _complain(str(error), error.status)
    except (SceneError, InvalidValue) as error:
        return _complain(str(error), USAGE)
    except ImportError as error:  # a package that is not there, or a setting with which none of this works
        return _complain(str(error), FAILED)
    except KeyboardInterrupt:
        return _complain("interrupted", _INTERRUPTED)
    except BrokenPipeError:
        _let_go_of_stdout()
        return _PIPE_CLOSED
    except OSError as error:
        _let_go_of_stdout()
        return _complain(": ".join(filter(None, (error.filename, error.strerror or str(error)))), FAILED)


def _dispatch(arguments: list[str]) -> int:
    if arguments and arguments[0] in COMMANDS:
        name, *rest = arguments
        named = command(name)
        parser = _Parser(f"physicslab {name}", named.__doc__)
        named.add_arguments(parser)
        return named.execute(parser.parse_args(rest))
    return _open(arguments)


def _open(arguments: list[str]) -> int:
    """Open the window, on a scene if one is named."""
    parser = _WindowParser("physicslab", "Open the desktop sandbox, or do one of the commands.")
    words = "a built-in scene's name, or a path; or that of a lesson, which ends in .md"
    parser.add_argument("scene", metavar="SCENE", nargs="?", help=words)
    parser.add_argument("--version", action="version", version=_version())
    scene = parser.parse_args(arguments).scene
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
    except PackageNotFoundError:
        return "physicslab from a folder, which is not installed and has no version"


def _complain(message: str, status: int) -> int:
    print(f"physicslab: {shortened(printable(message), _LINE_LIMIT)}", file=sys.stderr)
    return status


def _let_go_of_stdout() -> None:
    """Redirect buffered output to nowhere, or Python would fail on it again at exit."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


if __name__ == "__main__":
    sys.exit(main())
