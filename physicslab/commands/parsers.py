"""The parsers of the command line, and what is made of all of them: completion for shells, and a manual."""

import inspect
from argparse import SUPPRESS, Action, ArgumentParser
from collections.abc import Iterator, Sequence
from typing import Any, NoReturn

from physicslab.commands import CommandError, require
from physicslab.commands.usage import COMMANDS
from physicslab.ecs.text import suggestion
from physicslab.scenes import SCENES

SHELLS = ("bash", "zsh", "tcsh")
"""Shells for which a completion can be written."""
_DESCRIPTION = "Open the desktop sandbox, or do one of the commands."
_SCENES = {
    "bash": f"""_physicslab_scene() {{ compgen -W "{" ".join(SCENES)}" -- "$1"; compgen -f -- "$1"; }}
_shtab_physicslab_pos_0_COMPGEN=_physicslab_scene""",
    "zsh": f"""_physicslab_scene() {{ compadd {" ".join(SCENES)}; _files }}""",
    "tcsh": "",
}
"""How each shell completes a scene: a built-in name, or a file; in bash also in the place of a command."""


class Parser(ArgumentParser):
    """Refuses bad usage in one line, and takes no option by half its name."""

    def __init__(self, prog: str, description: str | None) -> None:
        super().__init__(prog=prog, description=description, allow_abbrev=False)

    def _get_values(self, action: Action, arg_strings: list[str]) -> Any:
        """Return the value of an argument: ``--option=--`` has one, which older versions of argparse drop."""
        if action.option_strings and arg_strings == ["--"]:
            value = self._get_value(action, *arg_strings)
            self._check_value(action, value)
            return value
        return super()._get_values(action, arg_strings)

    def _print_message(self, message: str, file: Any = None) -> None:
        """Write help, and let it be known where it cannot be written."""
        if file is not None:
            file.write(message)

    def refuse(self, arguments: Sequence[str]) -> NoReturn:
        """Refuse arguments that the command does not have, with the option that a misspelt one may mean."""
        names = (one.partition("=")[0] for one in arguments if one.startswith("-"))
        known = list(self._option_string_actions)
        likely = (suggestion(name, [one for one in known if one.startswith(name)] or known) for name in names)
        self.error(f"unrecognized arguments: {' '.join(arguments)}{next(filter(None, likely), '')}")

    def error(self, message: str) -> NoReturn:
        """Refuse it."""
        raise CommandError(f"{message} (see {self.prog} --help)")


class WindowParser(Parser):
    """Parses what opens the window, and lists the commands in its help."""

    def __init__(self, version: str) -> None:
        super().__init__("physicslab", _DESCRIPTION)
        words = "a built-in scene's name, or a path; or that of a lesson, which ends in .md"
        self.add_argument("scene", metavar="SCENE", nargs="?", help=words)
        self.add_argument("--version", action="version", version=version)
        words = (
            "write what completes these commands in a shell: bash, zsh or tcsh (needs the extra completion)"
        )
        self.add_argument("--print-completion", metavar="SHELL", choices=SHELLS, help=words)
        self.add_argument("--print-manual", action="store_true", help="write the manual page, for man")

    def format_help(self) -> str:
        """Return the help."""
        self.usage = "physicslab [SCENE] | physicslab COMMAND ... (physicslab COMMAND --help says more)"
        width = max(map(len, COMMANDS))
        lines = (f"  {name:<{width}}  {summary_of(name)}" for name in COMMANDS)
        return super().format_help() + "\n".join(["\ncommands:", *lines, ""])


def summary_of(name: str) -> str:
    """Return the first line of a command's help."""
    return (COMMANDS[name].__doc__ or "").splitlines()[0]


def parser_of(name: str) -> Parser:
    """Return the parser of a command."""
    parser = Parser(f"physicslab {name}", COMMANDS[name].__doc__)
    COMMANDS[name](parser)
    return parser


def completion(shell: str) -> str:
    """Return what completes all commands in a shell.

    Raises
    ------
    CommandError
        If the package that writes it is not installed.
    """
    require("--print-completion", "completion", "shtab")
    import shtab

    whole = ArgumentParser("physicslab", description=_DESCRIPTION)
    parts = whole.add_subparsers()
    for name in COMMANDS:
        part = parts.add_parser(name, help=summary_of(name))
        COMMANDS[name](part)
        for action in part._actions:
            if not action.option_strings and action.metavar in ("SCENE", "PROBLEM"):
                action.complete = {"bash": "_physicslab_scene", "zsh": "_physicslab_scene", "tcsh": "f"}  # type: ignore[attr-defined]
            elif action.metavar in ("FILE", "DIR"):
                action.complete = shtab.FILE if action.metavar == "FILE" else shtab.DIRECTORY  # type: ignore[attr-defined]
    return shtab.complete(whole, shell, preamble={shell: _SCENES[shell]})  # type: ignore[arg-type]


def manual(version: str) -> str:
    """Return the manual page in roff."""
    lines = [
        f'.TH PHYSICSLAB 1 "" "{_roff(version)}" "User Commands"',
        ".SH NAME", "physicslab \\- a 2D physics sandbox that reports its own errors",
        ".SH SYNOPSIS", "physicslab [SCENE]", ".br", "physicslab COMMAND ...",
        ".SH DESCRIPTION", _roff(_DESCRIPTION), *_options(WindowParser(version)),
        ".SH COMMANDS",
    ]  # fmt: skip
    for name in COMMANDS:
        parser = parser_of(name)
        usage = " ".join(parser.format_usage().removeprefix("usage: ").split())
        about = inspect.cleandoc(parser.description or "").split("\n\n")
        lines += [f".SS {name}", _roff(usage)]
        lines += [line for text in about for line in (".PP", _roff(" ".join(text.split())))]
        lines += [*_options(parser), *([".PP", _roff(parser.epilog)] if parser.epilog else [])]
    lines += [".SH EXIT STATUS", "0: done. 1: the run failed. 2: bad usage or a bad scene."]
    lines += ["128 and more: a signal ended it, whose number is the rest."]
    return "\n".join(lines) + "\n"


def _options(parser: ArgumentParser) -> Iterator[str]:
    """Yield the paragraphs of a parser's arguments."""
    formatter = parser._get_formatter()
    for action in parser._actions:
        if action.help == SUPPRESS:
            continue
        yield from (".TP", f"\\fB{_roff(_named(action))}\\fR", _roff(formatter._expand_help(action)))


def _named(action: Action) -> str:
    """Return an argument as it is given."""
    values = action.metavar if isinstance(action.metavar, str) else action.dest
    names = ", ".join(action.option_strings)
    return " ".join(filter(None, (names, values if action.nargs != 0 else "")))


def _roff(text: str) -> str:
    """Return a text in which nothing is taken for a request."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return f"\\&{text}" if text[:1] in (".", "'") else text
