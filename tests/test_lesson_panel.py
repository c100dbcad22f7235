"""The panel of a lesson: predictions that are locked in, runs, comparisons, answers that are kept, locks."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from operator import attrgetter
from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, bits, click, empty_world, fill, middle_of, point, sized, tap, write
from recording import RecordingCanvas
from test_arrows import lines_in

from physicslab.components import Mass, Transform
from physicslab.files.scene import load_scene
from physicslab.lessons.answers import grade, read_answers
from physicslab.lessons.catalogue import find_lesson
from physicslab.lessons.lesson import Lesson, Run
from physicslab.lessons.live_run import record_run
from physicslab.lessons.setup import Case
from physicslab.prefabs import circle
from physicslab.view.controls.controls import CONTROLS
from physicslab.view.controls.lesson_actions import choose_language, open_lesson
from physicslab.view.overlay.arrows import FORCE
from physicslab.view.window.lesson import OpenLesson, Trial

FALL = """---
format: physicslab-lesson/1
title: A fall
level: 1
minutes: 10
---

```scene
let: height = 5 m | from where it falls
let: gravity = 9.81 m/s^2
open: height = 1 m to 20 m
tools: hand, ruler
show: arrows
{"physics": {"gravity": [0, "-gravity"]},
 "entities": [{"id": "ball", "Transform": {"position": [0, "height"]}, "Velocity": {}, "Mass": {}}]}
```

## Level 1: How fast?

```predict faster
question: It falls ...
choice: steadily
wrong: It becomes faster.
idea: A body falls at a speed of its own.
show: height = 2 m | Twice as high, and not twice as fast
choice: faster and faster
right: Yes.
```

```predict speed
question: How fast is it after 0.1 s?
number: m/s
answer: ball.speed
tolerance: 2 %
```

```predict path
question: Draw its height.
curve: m
answer: ball.y
tolerance: 20 %
```

```run fall
seconds: 0.1 s
graph: ball.y
```

```compare speeds
quantity: speed
measure: ball.speed
theory: gravity*time
holds: always
tolerance: 1e-9
case: height = 2 m
```

```explain why
question: Why?
answer: Its weight.
```

```check reach
question: Let it come down to 1 m or lower.
goal: ball.y < 1 m
solution: height = 1 m
right: It does.
```
"""
CTRL = pygame.KMOD_CTRL


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Desk:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "fall.md").write_text(FALL)
    return sized((1280, 1900))


def opened(desk: Desk, name: str = "fall.md") -> OpenLesson:
    desk.window.do_next(open_lesson, name)
    desk.frames(SETTLED)
    lesson = desk.window.lesson
    assert lesson is not None, desk.window.notice
    return lesson


def sure(desk: Desk, name: str) -> None:
    click(desk, f"Sure {name}: unsure")
    click(desk, f"Lock in {name}")


def predicted(desk: Desk) -> OpenLesson:
    """Open the lesson, and answer all that is asked before its run."""
    lesson = opened(desk)
    click(desk, "faster: steadily")
    sure(desk, "faster")
    fill(desk, "Answer speed", "1,2", "tab")
    sure(desk, "speed")
    fill(desk, "Points path", "0 5; 0.1 4.95", "tab")
    sure(desk, "path")
    return lesson


def run(desk: Desk, label: str = "Run fall") -> None:
    click(desk, label)
    for _ in range(60):
        desk.frames()
        if desk.window.lesson is not None and not desk.window.lesson.running:
            break
    desk.frames(SETTLED)


def test_a_run_is_shut_until_all_is_predicted(desk: Desk) -> None:
    lesson = opened(desk)
    assert "Run fall" not in desk.ui.places
    tap(desk, "space")
    desk.frames(5)
    assert desk.world.time == 0.0 and "prediction" in desk.window.notice
    click(desk, "Lock in faster")
    assert lesson.given == {}, "neither an answer nor how sure"
    predicted(desk)
    assert lesson.given == {} and desk.window.lesson is not None
    assert desk.window.lesson.given["speed"] == {"value": "1,2", "sure": "unsure"}
    tap(desk, "space")
    desk.frames(20)
    assert desk.world.time > 0.0 and desk.window.lesson.made(desk.window.lesson.trial.run)  # type: ignore[union-attr]


def test_forces_are_shown_once_all_is_predicted(desk: Desk) -> None:
    canvas = RecordingCanvas((1280, 720))
    seen = Desk(empty_world(), canvas)
    lesson = opened(seen)
    seen.window.selection.take(seen.world.entity("ball"))

    def drawn() -> tuple[int, bool, bool]:
        seen.frames()
        canvas.calls.clear()
        seen.frames()
        arrows = lines_in(canvas, FORCE.colour(seen.window.theme))
        return len(arrows), "after your prediction" in canvas.words, bool(seen.window.measured.forces)

    before, later, named = drawn()
    assert later and not named
    for name, answer in (
        ("faster", {"choice": 2}),
        ("speed", {"value": "1"}),
        ("path", {"curve": [[0, 5], [0.1, 4]]}),
    ):
        question = next(one for one in lesson.lesson.questions("predict") if one.name == name)
        assert lesson.answer(name, question, {**answer, "sure": "sure"}) == ""
    after, later, named = drawn()
    assert after > before and named and not later


def test_the_first_page_shows_no_forces_before_the_predictions_of_the_next(desk: Desk) -> None:
    """The net force stood on the ball beside the question which forces act on it."""
    lesson = opened(desk, "projectile")
    assert not any(isinstance(part, Run) for part in lesson.lesson.steps[0].parts) and lesson.waits
    for one in lesson.lesson.predictions(next(p for p in lesson.lesson.parts() if isinstance(p, Run))):
        lesson.given[one.name] = {"choice": 2, "sure": "sure"}
    assert not lesson.waits


def test_sources_are_named_by_their_authors(desk: Desk, tmp_path: Path) -> None:
    source = "source: doe2001 = Doe, Roe and Poe (2001), On heaps, Annals 3, 141"
    text = FALL.replace("minutes: 10", f"minutes: 10\n{source}").replace(
        "## Level 1", "So says [doe2001].\n\n## Level 1"
    )
    (tmp_path / "fall.md").write_text(text)
    opened(desk)
    assert "So says (Doe et al. 2001)." in desk.ui.words


def test_what_helps_to_see_and_hear_is_not_shut(desk: Desk) -> None:
    opened(desk)
    for key, state in (("shift+s", "sounds.on"), ("shift+f2", "reduced_motion"), ("f3", "shows_words")):
        control = next(one for one in CONTROLS if one.key == key)
        before = attrgetter(state)(desk.window)
        assert control.is_open(desk.window)
        control.pressed(desk.world, desk.window)
        assert attrgetter(state)(desk.window) is not before, key


def test_a_decimal_comma_is_no_sign_of_thousands_where_it_is_the_decimal_mark(desk: Desk) -> None:
    lesson = opened(desk)
    lesson.lesson = replace(lesson.lesson, language="de")
    click(desk, "faster: steadily")
    sure(desk, "faster")
    fill(desk, "Answer speed", "1,234", "tab")
    sure(desk, "speed")
    assert lesson.given["speed"]["value"] == "1.234"


def test_prediction_theory_and_measurement_stand_beside_each_other(desk: Desk) -> None:
    lesson = predicted(desk)
    run(desk)
    said = "\n".join(desk.ui.words)
    assert "A body falls at a speed of its own" in said and "Not so" in said
    assert said.count("0.9810 m/s") >= 2 and "1.200 m/s" in said, "theory, measurement and prediction"
    assert "predicted" in desk.ui.words and "measured" in desk.ui.words
    click(desk, "Run speeds 2")
    desk.frames(20)
    assert lesson.trial is not None and lesson.trial.case.text == "height = 2 m"
    assert desk.world.component(desk.world.entity("ball"), Transform).position.y < 2.0
    click(desk, "Show faster")
    desk.frames(20)
    assert lesson.trial.case.values == (("height", "2 m"),)
    at = desk.ui.words.index("Twice as high, and not twice as fast")
    assert "as run" in desk.ui.words[at:], "its graph is below what it shows, beside the usual run"
    compare = next(iter(lesson.lesson.compares()))
    usual, rows = lesson.lesson.setup.values().named("height"), len(lesson.rows(compare))
    assert usual is not None
    for text, more in ((f"{100.0 * usual.value:g} cm", 0), ("1.7 m", 1), ("170 cm", 1)):
        case = Case("own", (("height", text),))
        lesson._made[compare.run.line, case.values] = Trial(lesson.lesson, compare.run, case)
        assert len(lesson.rows(compare)) == rows + more, "a row for each set of values"


def test_answers_are_a_file_that_grade_reads_and_that_is_taken_up_again(desk: Desk, tmp_path: Path) -> None:
    lesson = predicted(desk)
    run(desk)
    fill(desk, "Your name", "Ada", "tab")
    click(desk, "Explain why")
    write(desk, "weight")
    click(desk, "Say why")
    fill(desk, "reach: height", "1 m", "tab")
    run(desk, "Run own reach")
    file = lesson.path
    answers = read_answers(file, lesson.lesson, find_lesson)
    assert answers.learner == "Ada" and not answers.other_text
    graded = {one.name: one for one in grade(lesson.lesson, answers, find_lesson)}
    assert graded["reach"].right and graded["path"].right and not graded["speed"].right
    assert graded["why"].given == "weight"
    click(desk, "Leave the lesson")
    assert opened(desk).given == lesson.given
    (tmp_path / "fall.md").write_text(FALL.replace("How fast?", "How fast is it?"))
    assert "changed" in opened(desk).told
    file.write_text(json.dumps({"format": "physicslab-answers/9"}))
    again = opened(desk)
    assert again.path != file and again.path.name in again.told and again.given == {}


def test_what_is_open_in_a_lesson_and_nothing_is_lost_when_it_is_left(desk: Desk) -> None:
    circle(desk.world, (0.0, 1.0), radius=0.5)
    desk.window.tool = "box"
    tap(desk, "g")
    before, world = bits(desk.world), desk.world
    changes = desk.window.edits.history.changes
    opened(desk)
    assert desk.world is not world and desk.window.overlays.arrows and desk.window.has_unsaved
    gravity = desk.world.physics.gravity
    for key in ("g", "t", "x", "5"):
        tap(desk, key)
    assert desk.world.physics.gravity == gravity and desk.window.tool == "select"
    assert {"Ruler", "Select"} < set(desk.ui.places) and "Circle" not in desk.ui.places
    count = len(desk.world.batch(Mass))
    for button in ("left", "right"):
        desk.press(0.0, 1.0, button)
        desk.frames(2)
        desk.release(0.0, 1.0, button)
        desk.frames(SETTLED)
    assert len(desk.world.batch(Mass)) == count
    tap(desk, "z", CTRL)
    tap(desk, "escape")
    desk.frames(SETTLED)
    assert desk.window.lesson is None and desk.world is world and bits(world) == before
    assert desk.window.tool == "box" and desk.window.edits.history.changes.is_like(changes)
    tap(desk, "z", CTRL)
    assert desk.world.physics.gravity is not None


def test_another_scene_ends_a_lesson_and_undo_brings_the_one_before_back(desk: Desk) -> None:
    tap(desk, "g")
    world = desk.world
    opened(desk)
    desk.window.scenes.next_world = load_scene("drop")
    desk.frames(SETTLED)
    assert desk.window.lesson is None and desk.world is not world
    tap(desk, "z", CTRL)
    assert desk.world is world


def test_the_hand_leaves_a_measurement_alone(desk: Desk) -> None:
    lesson = predicted(desk)
    click(desk, "Run fall")
    assert lesson.running
    ball = desk.world.component(desk.world.entity("ball"), Transform).position
    desk.press(ball.x, ball.y)
    desk.frames(1)
    assert desk.window.hand.entity is None
    desk.frames(10)
    desk.release(ball.x, ball.y)
    desk.frames(SETTLED)
    ball = desk.world.component(desk.world.entity("ball"), Transform).position
    desk.window.pace.paused = False
    desk.press(ball.x, ball.y)
    desk.frames(1)
    assert desk.window.hand.entity is not None, "free again after it"


def test_a_run_has_the_steps_of_a_check_at_any_speed(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "fall.md").write_text(FALL.replace("seconds: 0.1 s", "seconds: 0.107 s"))
    lesson = predicted(desk)
    click(desk, "Run fall")
    desk.window.pace.slow_motion = True  # its shorter steps would have another error
    while lesson.running:
        desk.frames()
    fall = next(part for part in lesson.lesson.parts() if isinstance(part, Run))
    checked = record_run(lesson.lesson.setup, fall, lesson.lesson.quantities)
    assert lesson.trial is not None and lesson.trial.ended
    assert lesson.trial.live.record.times == pytest.approx(checked.record.times, rel=1e-12)
    assert lesson.trial.live.world.time == pytest.approx(0.107, rel=1e-12)


def test_a_curve_is_drawn_with_the_mouse(desk: Desk) -> None:
    lesson = opened(desk)
    for name, answer in (("faster", {"choice": 2}), ("speed", {"value": "1"})):
        question = next(one for one in lesson.lesson.questions() if one.name == name)
        lesson.answer(name, question, {**answer, "sure": "guess"})
    desk.frames(SETTLED)
    left, top, width, height = desk.ui.places["Draw path"]
    places = [(left + width // 10, top + height // 4), (left + 9 * width // 10, top + height // 2)]
    point(desk, places[0])
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONDOWN, button=1, pos=places[0], touch=False))
    desk.frames(2)
    point(desk, places[1], (1, 0, 0))
    desk.frames(2)
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONUP, button=1, pos=places[1], touch=False))
    desk.frames(2)
    sure(desk, "path")
    curve = lesson.given["path"]["curve"]
    assert curve[0][1] > curve[-1][1] > 0.0 and len(curve) > 50
    assert curve[0][0] == pytest.approx(0.01, abs=0.002) and curve[-1][0] == pytest.approx(0.09, abs=0.002)


def test_keys_alone_answer_a_prediction(desk: Desk) -> None:
    lesson = opened(desk)
    for _ in range(12):
        tap(desk, "f6")
        if "Lesson" in desk.sandbox.interface._walk._panel:
            break
    tab_to(desk, "faster: faster and faster", "Sure faster: sure", "Lock in faster")
    assert lesson.given["faster"] == {"choice": 2, "sure": "sure"}
    desk.frames(SETTLED)
    assert desk.ui.focused == "Answer speed", "the keys go on to what has opened"
    write(desk, "1")
    tab_to(desk, "Sure speed: sure", "Lock in speed")
    while desk.ui.focused != "Points path":
        tap(desk, "tab")
    write(desk, "0 1; 0.1 1")
    tab_to(desk, "Sure path: sure", "Lock in path")
    desk.frames(SETTLED)
    assert desk.ui.focused == "Run fall"
    tap(desk, "return")
    desk.frames(SETTLED)
    assert lesson.running or lesson.trial is not None


def test_f6_onto_a_field_begins_to_write_in_it(desk: Desk) -> None:
    opened(desk)
    for _ in range(12):
        tap(desk, "f6")
        if "Lesson" in desk.sandbox.interface._walk._panel:
            break
    desk.frames(SETTLED)
    assert desk.ui.focused == "Your name" and desk.sandbox.interface.toolkit.typing


def tab_to(desk: Desk, *labels: str) -> None:
    """Go on by Tab to some widgets in turn, and press Enter on each."""
    for label in labels:
        for _ in range(12):
            if desk.ui.focused == label:
                break
            tap(desk, "tab")
        assert desk.ui.focused == label
        tap(desk, "return")


def test_a_file_of_a_lesson_is_dropped_and_a_bad_one_is_refused(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "bad.md").write_text("nothing")
    for name in ("bad.md", "fall.md"):
        pygame.event.post(pygame.Event(pygame.DROPFILE, file=str(tmp_path / name)))
        desk.frames(SETTLED)
        assert (desk.window.lesson is None) == (name == "bad.md")
        assert ("line 1" in desk.window.notice) == (name == "bad.md")


def test_lessons_are_in_the_menu_and_found_by_the_search(desk: Desk) -> None:
    click(desk, "Lessons")
    click(desk, "How far does a ball fly?")
    assert desk.window.lesson is not None and desk.window.lesson.lesson.name == "projectile"
    tap(desk, "escape")
    tap(desk, "k", CTRL)
    write(desk, "how far")
    desk.frames(SETTLED)
    assert "Found: How far does a ball fly?" in desk.ui.places
    assert middle_of(desk, "Found: How far does a ball fly?")


def test_learn_shows_lessons_and_a_card_opens_one(desk: Desk) -> None:
    desk.window.shows_cards = True
    desk.frames(SETTLED)
    click(desk, "Learn")
    desk.frames(SETTLED)
    assert "Scene: How far does a ball fly?" in desk.ui.places
    assert "Scene: Sandbox" not in desk.ui.places
    click(desk, "Scene: How far does a ball fly?")
    assert desk.window.lesson is not None and not desk.window.shows_cards


def test_a_lesson_is_read_in_another_language_and_keeps_its_answers(desk: Desk) -> None:
    lesson = opened(desk, "pendulum")
    lesson.given["mass"] = {"choice": 2, "sure": "sure"}
    lesson.write()
    click(desk, "View")
    click(desk, "Language")
    click(desk, "Deutsch")
    desk.frames(SETTLED)
    again = desk.window.lesson
    assert again is not None and again is not lesson and again.given == lesson.given and not again.told
    assert "Wovon hängt die Schwingungsdauer eines Pendels ab?" in desk.ui.words


def test_graphs_of_a_lesson_have_decimal_commas_in_german(desk: Desk) -> None:
    choose_language(desk.world, desk.window, "de")
    lesson = predicted(desk)
    run(desk)
    assert lesson.trial is not None and lesson.trial.ended
    numbers = [one for one in desk.ui.words if re.fullmatch(r"-?\d+[.,]\d+", one)]
    assert numbers and not [one for one in numbers if "." in one]


def test_an_earlier_lesson_is_read_once_and_not_in_each_frame(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opening = FALL.partition("## Level")[0]
    (tmp_path / "again.md").write_text(
        opening + "## Level 1: Again\n\n```recall\nask: pendulum/factor\n```\n"
    )
    read: list[str] = []

    def reads(name: str, language: str) -> Lesson:
        read.append(name)
        return find_lesson(name, language)

    monkeypatch.setattr("physicslab.view.controls.lesson_actions.find_lesson", reads)
    lesson = opened(desk, "again.md")
    lesson.go_to(len(lesson.lesson.steps) - 1)
    desk.frames(SETTLED)
    assert find_lesson("pendulum").title in desk.ui.words and read == ["again.md", "pendulum"]
