"""Completion for shells, the manual page, and what help imports."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from physicslab import cli
from physicslab.commands.parsers import SHELLS
from physicslab.commands.usage import COMMANDS
from physicslab.kernels.keys import LEVELS

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
        ("physicslab", "newt", "newtons_cradle"),
        ("physicslab accuracy", "newt", "newtons_cradle"),
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


WITHOUT_NUMBA = """
import sys
from physicslab.cli import main
from physicslab.commands.usage import COMMANDS

for line in (*([name, "--help"] for name in COMMANDS), ["scenes"]):
    assert main(line) == 0, line
    assert {"numba", "importlib.metadata"}.isdisjoint(sys.modules), line
for line in (["--help"], ["--version"]):
    assert main(line) == 0, line
    assert "numba" not in sys.modules, line
for name in COMMANDS:
    assert main([name, "--no-such-option"]) == 2
    assert "numba" not in sys.modules, name
"""


def test_nothing_is_said_of_commands_that_waits_for_numba() -> None:
    done = subprocess.run([sys.executable, "-c", WITHOUT_NUMBA], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("physicslab: ") == len(COMMANDS)


def test_kernels_are_compiled_for_the_processors_that_the_command_names(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert f"{{{','.join(('native', *LEVELS))}}}" in printed(capsys, "kernels", "--help")
