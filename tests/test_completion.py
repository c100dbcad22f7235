"""Completion for shells, the manual page, and what help imports."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from physicslab import cli
from physicslab.commands import COMMANDS, command
from physicslab.commands.parsers import SHELLS, summary_of

MANUAL = Path(__file__).parent.parent / "docs" / "physicslab.1"
COMPLETE = """
source {script}
COMP_WORDS=({words} "{last}"); COMP_CWORD={place}
_shtab_physicslab; echo "${{COMPREPLY[@]}}"
"""


def printed(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert cli.main(arguments) == 0
    return capsys.readouterr().out


@pytest.mark.parametrize("shell", SHELLS)
def test_there_is_a_completion_for_each_shell(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    text = printed(capsys, "--print-completion", shell)
    assert all(name in text for name in COMMANDS)


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")
@pytest.mark.parametrize(
    ("words", "last", "found"),
    [
        ("physicslab", "exp", "export"),
        ("physicslab run", "newt", "newtons_cradle"),
        ("physicslab run drop", "--subs", "--substeps"),
    ],
)
def test_bash_completes(
    words: str, last: str, found: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "completion"
    script.write_text(printed(capsys, "--print-completion", "bash"))
    text = COMPLETE.format(script=script, words=words, last=last, place=len(words.split()))
    done = subprocess.run(["bash", "-c", text], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert found in done.stdout.split(), done.stderr


def test_the_manual_is_that_of_the_commands(capsys: pytest.CaptureFixture[str]) -> None:
    words = "physicslab --print-manual > docs/physicslab.1 writes it again"
    assert printed(capsys, "--print-manual") == MANUAL.read_text("utf-8"), words


def test_a_summary_is_the_first_line_of_the_help() -> None:
    for name in COMMANDS:
        assert summary_of(name) == (command(name).__doc__ or "").splitlines()[0]


@pytest.mark.parametrize("argument", ["--help", "--version", "scenes"])
def test_little_is_said_without_waiting_for_numba(argument: str) -> None:
    code = (
        f"import sys; from physicslab.cli import main; main(['{argument}']); sys.exit('numba' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], stdout=subprocess.DEVNULL).returncode == 0
