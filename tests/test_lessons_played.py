"""Every lesson is played in the window from beginning to end, by mouse and keys, each in one language.

tests/test_lessons.py shows that it has the same parts and runs in each, tests/test_languages.py that longer
texts fit.
"""

from itertools import cycle
from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, click, fill, sized

from physicslab.languages.catalogue import languages
from physicslab.lessons.catalogue import LESSONS
from physicslab.lessons.lesson import Compare, Explain, Prose, Question, Recall, Run
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.controls.lesson_actions import choose_language, open_lesson
from physicslab.view.window.lesson import OpenLesson

MOST_ACTS = 60


def now(desk: Desk) -> OpenLesson:
    lesson = desk.window.lesson
    assert lesson is not None
    return lesson


def answer(desk: Desk, part: Question, name: str) -> None:
    """Put an answer into its place: the first choice, a number, a straight curve."""
    if part.form == "choice":
        click(desk, f"{name}: {part.replies[0].text}")
    elif part.form == "number":
        fill(desk, f"Answer {name}", "1", "tab")
    elif part.form == "curve":
        fill(desk, f"Points {name}", "0 1; 1 1", "tab")


def wait_for_run(desk: Desk, name: str) -> None:
    pace = desk.window.pace
    usual, pace.max_dt = pace.max_dt, 2.0  # pictures are few, steps are those of each run
    pace.choose(pace.MAX_SPEED)
    for _ in range(4000):
        desk.frames(1, elapsed=pace.max_dt)
        if not now(desk).running:
            break
    pace.return_to_life()
    pace.max_dt = usual
    trial = now(desk).trial
    assert trial is not None and trial.ended and not trial.failure, name
    desk.frames(SETTLED)


def act(desk: Desk, lesson: OpenLesson, part: object) -> None:
    """Do what a part of a lesson asks for."""
    match part:
        case Question(kind="predict"):
            answer(desk, part, part.name)
            click(desk, f"Sure {part.name}: unsure")
            click(desk, f"Lock in {part.name}")
        case Run():
            click(desk, f"Run {part.name}")
            wait_for_run(desk, part.name)
        case Question(form="goal"):
            click(desk, f"Run own {part.name}")
            wait_for_run(desk, part.name)
        case Question():
            answer(desk, part, part.name)
            click(desk, f"Check {part.name}")
        case Explain():
            fill(desk, f"Explain {part.name}", "So it is", "tab")
            click(desk, f"Say {part.name}")
        case Recall():
            click(desk, f"Pass {part.name}")
        case other:
            raise AssertionError(other)
    desk.frames(2)


def keep_picture(desk: Desk, path: Path) -> None:
    """Write what the window shows to a file."""
    assert isinstance(desk.window.canvas, PygameCanvas)
    path.parent.mkdir(parents=True, exist_ok=True)
    pygame.image.save(desk.window.canvas.surface, path)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "code"), [*zip(LESSONS, cycle(languages()), strict=False)])
def test_a_lesson_is_played_to_its_end(
    name: str, code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    folder = request.config.getoption("--pictures")
    pictures = None if folder is None else folder.resolve() / f"{name}-{code}"
    monkeypatch.chdir(tmp_path)
    desk = sized((1280, 720))
    choose_language(desk.world, desk.window, code)
    desk.window.do_next(open_lesson, name)
    desk.frames(SETTLED)
    assert now(desk).lesson.language == code
    for number in range(MOST_ACTS):
        if pictures is not None:
            keep_picture(desk, pictures / f"{number:02d}.png")
        lesson = now(desk)
        if "Leave the lesson" in desk.ui.places:
            break
        if "Next step" in desk.ui.places:
            click(desk, "Next step")
            desk.frames(SETTLED)
            continue
        part = next(one for one in lesson.shown(lesson.step) if not lesson.is_past(one))
        assert not isinstance(part, Prose | Compare)
        act(desk, lesson, part)
        desk.frames(SETTLED)
    else:
        raise AssertionError(f"{name} does not end: step {now(desk).step + 1}")
    lesson = now(desk)
    asked = [one for one in lesson.lesson.parts() if isinstance(one, Question | Explain)]
    assert {one.name for one in asked} <= set(lesson.given), "each was answered"
    assert (tmp_path / f"{lesson.lesson.name}-answers.json").exists()
