"""Run stiff, extreme and hostile cases: which pass, which fall short."""

from argparse import Namespace

from physicslab.commands import FAILED, CommandError
from physicslab.commands.lab import LabRun, chosen_cases, list_cases, unknown_name
from physicslab.lab.jobs import ProcessEnded, in_processes
from physicslab.lab.stability import case
from physicslab.lab.stability.catalogue import CASES, run_named, runs_of


def execute(arguments: Namespace) -> int:
    """Run what was named, print a line of each, and write the outputs that were chosen."""
    if arguments.list:
        return list_cases(CASES)
    cases = chosen_cases(arguments.names or CASES, CASES, _unknown)
    run, aligned = LabRun("stability", arguments), case.columns(cases)
    outcomes: list[case.Outcome] = []
    run.show(case.head_text(aligned))
    found = run.shown(in_processes(run_named, [one.name for one in cases], runs_of(cases)))
    try:
        for one, figures in zip(cases, found, strict=True):
            outcomes.append(case.Outcome(one, *figures))
            run.show(case.row_text(outcomes[-1], aligned))
    except ProcessEnded as error:
        raise CommandError(f"{cases[len(outcomes)].name}: {error}", FAILED) from None
    run.show(case.summary_text(outcomes))
    run.write(case.document(outcomes))
    if short := case.short_names(outcomes):
        raise CommandError(f"{len(short)} of {len(outcomes)} cases fall short: {', '.join(short)}", FAILED)
    return 0


def _unknown(name: str) -> case.StabilityCase | None:
    known = f"there are the groups {', '.join(CASES.families)}, and the cases that --list names"
    raise unknown_name(name, "case", CASES.names, known)
