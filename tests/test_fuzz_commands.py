"""Any command line: done, refused in one line, or failed with one that says where."""

from __future__ import annotations

import io
import itertools
import json

import pytest
from deadline import deadline
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from physicslab.cli import main

_WORDS = st.sampled_from(
    [
        "0", "1", "-1", "2.5", "1e308", "5e-324", "1e-3", "nan", "inf", "-inf", "9" * 5000, "", " ",
        "--", "-", "\x00", "\udcff", "a\nb", "x" * 5000, "/dev/zero", "/", "drop", "two_planets", "auto",
        "leapfrog", "exact", "dop853",
    ]
)  # fmt: skip
_OPTIONS = st.sampled_from(
    ["--seconds", "--steps", "--dt", "--substeps", "--integrator", "--js", "--tolerance"]
)


@st.composite
def lines(draw: st.DrawFn) -> list[str]:
    """Draw a command line that writes to stdout alone and, if it is allowed, runs for little."""
    command = draw(st.sampled_from(["run", "run", "run", "run", "scenes", "accuracy", "stability", "bench"]))
    if command != "run":
        # A word is always wrong or cheap here: what these commands do without one takes minutes.
        return [command, draw(st.sampled_from(["\0", "", "x" * 5000, "\ud800", "a\nb", "/dev/zero", "--x"]))]
    scene = draw(st.sampled_from(["drop", "two_planets", "pendulum"]) | _WORDS)
    line = [command, scene, "--json", "-"]
    for option in draw(st.lists(_OPTIONS, max_size=2)):
        line += [option, draw(_WORDS)]
    return line if "--seconds" in line or "--steps" in line else [*line, "--steps", "2"]


def _is_long(line: list[str]) -> bool:
    """Whether it requests, in words that are allowed, more steps than a test can wait for."""
    long = {"1e308", "5e-324", "9" * 5000}
    return any(
        option in ("--seconds", "--dt") and value in long | {"1e-3"}
        for option, value in itertools.pairwise(line)
    )


@settings(suppress_health_check=list(HealthCheck))
@given(lines())
def test_a_command_line_is_done_or_refused_in_one_line(line: list[str]) -> None:
    if _is_long(line) and "--steps" not in line:
        return
    with pytest.MonkeyPatch.context() as patch:
        out, err = _Captured(), _Captured()
        patch.setattr("sys.stdout", out.text)
        patch.setattr("sys.stderr", err.text)
        with deadline(line):
            status = main(line)
    said = err.read()
    assert status in (0, 1, 2), (line, status, said)
    if status == 0:
        assert said == "", said
        if line[0] == "run":
            json.loads(out.read(), parse_constant=_refuse)
    else:
        assert len(said.splitlines()) == 1 and said.startswith("physicslab: "), (line, said)
        assert len(said) < 12_000 and "Traceback" not in said


def _refuse(word: str) -> None:
    raise AssertionError(f"{word} in JSON")


class _Captured:
    """A stream of text with bytes beneath, as a process has."""

    def __init__(self) -> None:
        self._bytes = io.BytesIO()
        self.text = io.TextIOWrapper(self._bytes, encoding="utf-8")

    def read(self) -> str:
        self.text.flush()
        return self._bytes.getvalue().decode("utf-8")
