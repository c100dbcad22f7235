"""Run what is stiff, extreme or hostile, and say what falls short."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Sequence

from physicslab.commands.command_error import FAILED, CommandError
from physicslab.commands.output import Output
from physicslab.commands.progress import Progress
from physicslab.files.checks import shown, suggestion
from physicslab.files.json_text import json_bytes
from physicslab.lab.stability.case import Case, Outcome, Verdict, run_case
from physicslab.lab.stability.catalogue import CASES, groups, names, select
from physicslab.lab.stability.document import document
from physicslab.lab.stability.tables import head_text, row_text, summary_text

__all__ = ["add_arguments", "execute"]


def add_arguments(parser: ArgumentParser) -> None:
    """Declare what the command takes."""
    parser.add_argument("cases", metavar="CASE", nargs="*", help="a case, or a group of them; all if none")
    parser.add_argument("--json", metavar="FILE", help="write every figure and verdict (- for stdout)")
    parser.add_argument("--list", action="store_true", help="name every case, with its group, and run none")
    parser.epilog = f"groups: {', '.join(groups())}; --list names the {len(CASES)} cases"


def execute(arguments: Namespace) -> int:
    """Run what was named, print a line of each, and write what was asked for."""
    if arguments.list:
        width = max(map(len, CASES))
        for group in groups():
            for case in select(group):
                print(f"{case.name:<{width}}  {group}")
        return 0
    cases = _chosen(arguments.cases)
    output = None if arguments.json is None else Output("--json", arguments.json)
    quiet = output is not None and output.to_stdout
    outcomes: list[Outcome] = []
    _show(head_text(cases), quiet)
    for outcome in _outcomes(cases):
        outcomes.append(outcome)
        _show(row_text(outcome, cases), quiet)
    _show(summary_text(outcomes), quiet)
    if output is not None:
        output.write(json_bytes(document(outcomes)))
    short = [outcome.case.name for outcome in outcomes if outcome.verdict is Verdict.SHORT]
    if short:
        raise CommandError(f"{len(short)} of {len(outcomes)} cases fall short: {', '.join(short)}", FAILED)
    return 0


def _chosen(wanted: Sequence[str]) -> list[Case]:
    """Return the cases of these names, each once; all of them where none is named.

    Raises
    ------
    CommandError
        If there is none of a name.
    """
    if not wanted:
        return list(CASES.values())
    chosen: dict[str, Case] = {}
    for name in wanted:
        found = select(name)
        if not found:
            there_is = f"there are the groups {', '.join(groups())}, and the cases that --list names"
            raise CommandError(f"{shown(name)}: is no case{suggestion(name, names())}; {there_is}")
        chosen |= {case.name: case for case in found}
    return list(chosen.values())


def _outcomes(cases: Sequence[Case]) -> Iterator[Outcome]:
    """Yield what comes of each case, and keep the terminal told how far all are."""
    progress = Progress("stability", sys.stderr)
    try:
        for i, case in enumerate(cases):
            progress.show(i / len(cases))
            outcome = run_case(case)
            progress.clear()
            yield outcome
    finally:
        progress.clear()


def _show(text: str, quiet: bool) -> None:
    if not quiet:
        print(text, flush=True)
