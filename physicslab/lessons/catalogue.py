"""The lessons that come with the program, in their order."""

import atexit
import re
from contextlib import ExitStack
from functools import cache
from importlib.resources import as_file, files
from pathlib import Path
from typing import NamedTuple

from physicslab.ecs.text import printable, suggestion
from physicslab.lessons.blocks import LessonError
from physicslab.lessons.lesson import Lesson
from physicslab.lessons.reader import read_lesson

_CITATION = re.compile(r" \[\w+\]")
_KEPT = ExitStack()
atexit.register(_KEPT.close)
LIBRARY = _KEPT.enter_context(as_file(files(__package__) / "library"))
"""Where their files are; those of an archive are unpacked."""
LESSONS = (
    "projectile", "terminal_velocity", "incline", "atwood", "rolling", "collision", "centre_of_mass",
    "bounces", "billiards", "cradle", "ballistic_pendulum", "pendulum", "damped_spring", "coupled_pendulums",
    "kepler", "error", "pi",
)  # fmt: skip
"""Their names; ``library/NAME.md`` is the file, ``library/de/NAME.md`` its words in German."""


class Opening(NamedTuple):
    """The beginning of a lesson: its title, its first sentences, and what one has to know before."""

    title: str
    text: str
    needs: str


@cache
def openings(language: str = "") -> dict[str, Opening]:
    """Return the beginnings of all of them by their names, in a language if it is there."""
    found = {}
    for name in LESSONS:
        words = LIBRARY / language / f"{name}.md"
        text = (words if words.is_file() else LIBRARY / f"{name}.md").read_text(encoding="utf-8")
        _, head, body = text.split("---\n", 2)
        values = dict(line.split(": ", 1) for line in head.splitlines() if not line.startswith(" "))
        first = " ".join(body.strip().partition("\n\n")[0].split())
        found[name] = Opening(values["title"], _CITATION.sub("", first), values["needs"])
    return found


def titles(language: str = "") -> dict[str, str]:
    """Return the titles of all of them by their names, in a language if it is there."""
    return {name: one.title for name, one in openings(language).items()}


def lesson_in(name_or_path: str, language: str) -> Lesson:
    """Return a lesson in a language, as :func:`find_lesson`, and refuse one that it does not have."""
    lesson = find_lesson(name_or_path, language)
    if language and lesson.language != language:
        path = lesson.path.parent / language / lesson.path.name
        raise LessonError(f"{printable(str(path))}: no such file: {lesson.name} is not there in {language}")
    return lesson


@cache
def _own(name: str, language: str) -> Lesson:
    """Return a lesson of the program; it is read once, as its file stays the same."""
    return read_lesson(LIBRARY / f"{name}.md", language)


def find_lesson(name_or_path: str, language: str = "") -> Lesson:
    """Return a lesson by its name, or from a file; its words in a language if it has them.

    Raises
    ------
    LessonError
        If there is none, or anything in it is not allowed.

    Examples
    --------
    >>> find_lesson("projectile").title
    'How far does a ball fly?'
    """
    if name_or_path in LESSONS:
        return _own(name_or_path, language)
    if not Path(name_or_path).exists() and not name_or_path.endswith(".md"):
        likely = suggestion(name_or_path, LESSONS) or f"; the lessons are {', '.join(LESSONS)}"
        raise LessonError(f"{name_or_path}: no such file, and no lesson of this name{likely}")
    return read_lesson(name_or_path, language)
