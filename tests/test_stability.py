"""The stability lab: every case passes, and what is written of them. The longest are left to the command."""

import dataclasses
import json
import math
import os
import signal
from typing import Any

import pytest

from physicslab import cli
from physicslab.lab.case import Verdict
from physicslab.lab.jobs import ProcessEnded, in_processes
from physicslab.lab.stability.case import StabilityCase, run_case
from physicslab.lab.stability.catalogue import CASES, runs_of
from physicslab.state.masses import Diverged

SLOW = {
    "steps_1e4_memory", "cradle_amplitude", "cradle_amplitude_damped", "crowd_1000_speed", "net_energy",
    "step_10s_spring_touching", "chain_touching_energy", "chain_touching_bounded",
    "tower_15x15cm_rigid", "dt_1e-06_x1_rigid", "ragdolls_gap", "ragdolls_rest",
}  # fmt: skip
"""Cases that take more than a second of processor time each."""
SHORT = {
    "wedges_100_depth_soft": "they come 0.4 m in a substep",
}  # fmt: skip
"""Cases that fall short so far, and why: they stand in the table of docs/stability.md."""


TESTED = [case for case in CASES.values() if not case.long_s and case.name not in SHORT]


def parameter(case: StabilityCase) -> Any:
    """Return a case as a parameter of a test, with its mark."""
    return pytest.param(case, id=case.name, marks=[pytest.mark.slow] if case.name in SLOW else [])


def test_slow_cases_are_cases() -> None:
    assert CASES.keys() >= SLOW
    assert CASES.keys() >= SHORT.keys()


@pytest.mark.parametrize("case", [parameter(case) for case in TESTED])
def test_the_case_passes(case: StabilityCase) -> None:
    outcome = run_case(case)
    assert outcome.verdict is Verdict.PASSED, f"{outcome.figure} > {case.limit}; {outcome.failure}"


def test_every_case_says_what_is_right() -> None:
    for case in CASES.values():
        assert case.title and case.group and case.right and case.figure, case.name
        assert math.isfinite(case.limit) and case.limit >= 0.0, case.name


def case_of(figure: float) -> StabilityCase:
    return StabilityCase(
        name="x", title="X", group="g", right="r", figure="f", limit=1.0, unit="m", measure=lambda: figure
    )


def test_the_limit_itself_passes_and_more_falls_short() -> None:
    assert run_case(case_of(1.0)).verdict is Verdict.PASSED
    assert run_case(case_of(math.nextafter(1.0, 2.0))).verdict is Verdict.SHORT


def test_a_run_that_diverges_falls_short_with_the_reason() -> None:
    def diverge() -> float:
        raise Diverged("ball: Transform is no longer finite")

    outcome = run_case(dataclasses.replace(case_of(0.0), measure=diverge))
    assert (outcome.figure, outcome.verdict) == (None, Verdict.SHORT)
    assert outcome.failure == "ball: Transform is no longer finite"


@pytest.mark.parametrize("figure", [math.nan, math.inf])
def test_what_is_not_finite_falls_short(figure: float) -> None:
    outcome = run_case(case_of(figure))
    assert (outcome.figure, outcome.verdict) == (None, Verdict.SHORT)


def test_a_name_is_that_of_a_case_or_of_a_group() -> None:
    assert CASES.select("spring_1_rest") == [CASES["spring_1_rest"]]
    assert CASES.select("dampers") == [case for case in CASES.values() if case.group == "dampers"]
    assert CASES.select("nothing") == []


def test_the_command_prints_a_line_each_and_a_summary(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("first", "second"):
        monkeypatch.setitem(CASES, name, dataclasses.replace(case_of(0.5), name=name))
    assert cli.main(["stability", "g", "damper_1e6", "second"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    head, *rows, last = out.splitlines()
    assert head.split()[:4] == ["case", "figure", "limit", "verdict"]
    assert [row.split()[0] for row in rows] == ["first", "second", "damper_1e6"], "each of them once"
    assert all("passed" in row for row in rows)
    assert last.startswith("3 of 3 cases passed, in ")


def test_the_document_alone_goes_to_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["stability", "damper_1e6", "--json", "-"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    found = json.loads(out, parse_constant=lambda word: pytest.fail(f"{word} in JSON"))
    assert list(found) == ["format", "machine", "passed", "falls_short", "cases"]
    assert (found["format"], found["passed"], found["falls_short"]) == ("physicslab-stability/1", 1, [])
    (case,) = found["cases"]
    assert list(case) == [
        "name", "title", "group", "right", "measured", "unit", "figure", "limit", "verdict", "failure",
        "wall_s",
    ]  # fmt: skip
    assert (case["name"], case["unit"], case["limit"], case["verdict"]) == (
        "damper_1e6",
        "m/s",
        1e-9,
        "passed",
    )
    assert 0.0 <= case["figure"] <= 1e-9


def test_a_case_that_falls_short_is_named_at_the_end(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(CASES, "x", case_of(math.nan))
    assert cli.main(["stability", "damper_1e6", "x", "--json", "-"]) == 1
    out, err = capsys.readouterr()
    assert err == "physicslab: 1 of 2 cases fall short: x\n"
    found = json.loads(out, parse_constant=lambda word: pytest.fail(f"{word} in JSON"))
    assert found["falls_short"] == ["x"]
    assert found["cases"][1]["figure"] is None


def _square_or_end(name: str) -> int:
    """Return the square of a number, or end the process: what another process is given."""
    if name == "end":
        os.kill(os.getpid(), signal.SIGKILL)
    return int(name) ** 2


def test_many_cases_are_spread_over_processes_and_their_results_come_in_order(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    names = [str(n) for n in range(16)]
    runs = [[name] for name in names]
    found = list(in_processes(_square_or_end, names, [["15", "3"], *runs[:3], *runs[4:15]]))
    assert [one for one in found if isinstance(one, int)] == [n * n for n in range(16)]
    assert all(0.0 <= share <= 1.0 for share in found if isinstance(share, float))
    with pytest.raises(ProcessEnded):
        list(in_processes(_square_or_end, [*names[:-1], "end"], [*runs[:-1], ["end"]]))


def test_cases_that_share_a_run_are_one_job_and_the_longest_begins_first() -> None:
    runs = runs_of(list(CASES.values()))
    assert runs[0] == ["steps_1e6_memory", "steps_1e6_drift", "steps_1e6_pace"]
    assert ["crowd_5000_speed", "crowd_5000_apart"] in runs
    assert sorted(name for run in runs for name in run) == sorted(CASES)
