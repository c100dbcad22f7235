"""The stability lab: every case passes, and what is written of them. Long cases are left to the command."""

import dataclasses
import json
import math

import pytest

from physicslab import cli
from physicslab.lab.stability.case import Case, Verdict, run_case
from physicslab.lab.stability.catalogue import CASES, select
from physicslab.state.masses import Diverged


@pytest.mark.parametrize(
    "case", [pytest.param(case, id=case.name) for case in CASES.values() if not case.long]
)
def test_the_case_passes(case: Case) -> None:
    outcome = run_case(case)
    assert outcome.verdict is Verdict.PASSED, f"{outcome.figure} > {case.limit}; {outcome.failure}"


def test_every_case_says_what_is_right() -> None:
    for case in CASES.values():
        assert case.title and case.group and case.right and case.figure, case.name
        assert math.isfinite(case.limit) and case.limit >= 0.0, case.name


def case_of(figure: float) -> Case:
    return Case(
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
    assert select("spring_1_rest") == [CASES["spring_1_rest"]]
    assert select("dampers") == [case for case in CASES.values() if case.group == "dampers"]
    assert select("nothing") == []


def test_the_command_prints_a_line_each_and_a_summary(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["stability", "dampers", "damper_1e6"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    head, *rows, last = out.splitlines()
    assert head.split()[:4] == ["case", "figure", "limit", "verdict"]
    named = [case.name for case in select("dampers")]
    assert [row.split()[0] for row in rows] == named
    assert all("passed" in row for row in rows)
    assert last.startswith(f"{len(named)} of {len(named)} cases passed, in ")


def test_the_document_alone_goes_to_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["stability", "damper_1e6", "--json", "-"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    found = json.loads(out, parse_constant=lambda word: pytest.fail(f"{word} in JSON"))
    assert list(found) == ["format", "passed", "falls_short", "cases"]
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
