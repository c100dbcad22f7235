"""What the README and the documents say is so: worked examples work, files that are named are there."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from physicslab.view.controls.controls import CONTROLS

ROOT = Path(__file__).parent.parent
README = ROOT / "README.md"
CONTRIBUTING = ROOT / "docs" / "contributing.md"
BLOCK = re.compile(r"^```(python|diff)\n# (\S+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
EXAMPLES = [match.groups() for match in BLOCK.finditer(CONTRIBUTING.read_text(encoding="utf-8"))]
NEW = {path for kind, path, _ in EXAMPLES if kind == "python"}
FOR_ALL = ("tests/test_integrate.py", "tests/test_scenes.py", "tests/test_toolbar.py")
"""Tests that hold for every method, scene and control: those of the examples too."""


def kept(text: str) -> str:
    """Return the part of a line that is written out, where ``...`` stands for its beginning or end."""
    if text.lstrip().startswith("..."):
        return text.lstrip().removeprefix("...").lstrip()
    return text.removesuffix("...")


def changed(source: str, diff: str) -> str:
    """Return a source with one change made, whose old lines must be there once."""
    lines = [(line[:1], kept(line[1:])) for line in diff.splitlines()]
    before = "\n".join(text for sign, text in lines if sign in " -")
    after = "\n".join(text for sign, text in lines if sign in " +")
    assert source.count(before) == 1, f"{before!r} must be there once, and is {source.count(before)} times"
    return source.replace(before, after)


def run_tests(place: Path, chosen: str, *files: str) -> None:
    """Run some tests of a copy of the program, in a process of its own."""
    ours = {"PYTHONPATH": str(place), "PYTHONDONTWRITEBYTECODE": "1"}
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST_")} | ours
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", chosen, *files]
    done = subprocess.run(
        command, cwd=place, env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture
def copy(tmp_path: Path) -> Iterator[Path]:
    """Return a copy of the program and its tests, to be changed."""
    for name in ("physicslab", "tests"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "conftest.py", tmp_path)
    (tmp_path / "pytest.ini").write_text("[pytest]\nfilterwarnings = error\nmarkers = slow\n")
    yield tmp_path
    shutil.rmtree(tmp_path)


def test_the_worked_examples_of_contributing_work(copy: Path) -> None:
    added: list[str] = []
    for kind, name, text in EXAMPLES:
        path = copy / name
        if kind == "python":
            assert not path.exists(), f"{name} exists by now: choose another name in docs/contributing.md"
            path.write_text(text, encoding="utf-8")
            added += [name] * name.startswith("tests/")
            continue
        if name in NEW and "-    @at" in text:  # an example is about to be replaced: see that it works first
            assert added
            run_tests(copy, "test_", *added)
        path.write_text(changed(path.read_text(encoding="utf-8"), text), encoding="utf-8")
    assert len(added) == 6
    chosen = " or ".join((*(Path(name).stem for name in added), "yoshida4", "balloons", "every_control"))
    run_tests(copy, chosen, *added, *FOR_ALL)


def test_a_change_is_refused_whose_old_lines_are_not_there_once() -> None:
    assert changed("a = [1]\nb = 2\n", " b = 2\n+c = 3\n") == "a = [1]\nb = 2\nc = 3\n"
    assert changed("a = [1]\n", "-a = [...\n+a = [0, ...\n") == "a = [0, 1]\n"
    for source in ("", "b = 2\nb = 2\n"):
        with pytest.raises(AssertionError, match="must be there once"):
            changed(source, " b = 2\n+c = 3\n")


@pytest.mark.parametrize("path", [README, *sorted((ROOT / "docs").rglob("*.md"))], ids=lambda path: path.name)
def test_files_that_a_document_names_are_there(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    named = set(re.findall(r"`((?:physicslab|tests|benchmarks|docs)/[\w/.]*)`", text)) - NEW
    assert [name for name in sorted(named) if not (ROOT / name).exists()] == []
    linked = set(re.findall(r"\]\((?!https?:|#)([^)#\s]+)", text))
    assert [name for name in sorted(linked) if not (path.parent / name).exists()] == []


def test_the_readme_is_short_and_has_every_key() -> None:
    text = README.read_text(encoding="utf-8")
    assert 150 <= len(text.splitlines()) <= 200
    keys = " ".join(re.findall(r"^\| (.+?) \| ", text, re.MULTILINE)).lower()
    words = set(re.findall(r"[^\s,]+", keys))
    absent = [c.label for c in CONTROLS if not any(word.startswith(c.label.lower()) for word in words)]
    assert absent == []
