"""Answers to lessons: what is read and refused, and how they are graded."""

import json
from pathlib import Path
from typing import Any

import pytest

from physicslab.cli import main
from physicslab.files.checks import SceneError
from physicslab.lessons.answers import Graded, grade, read_answers
from physicslab.lessons.catalogue import find_lesson
from physicslab.lessons.lesson import Lesson
from physicslab.lessons.reader import parse_lesson

LESSON = """---
format: physicslab-lesson/1
title: A fall
level: 1
minutes: 10
---

```scene
let: height = 5 m
let: gravity = 9.81 m/s^2
open: height = 1 m to 20 m
{"physics": {"gravity": [0, "-gravity"]},
 "entities": [{"id": "ball", "Transform": {"position": [0, "height"]}, "Velocity": {}, "Mass": {}}]}
```

```run
seconds: 0.5 s
```

```check which
question: Where?
choice: Up
wrong: No.
idea: Things rise.
choice: Down
right: Yes.
```

```check speed
question: How fast?
number: m/s
answer: ball.speed
tolerance: 1 %
right: Yes.
mistake: 1 m/s
wrong: A guess.
```

```check slope
question: How steep?
number: deg
answer: atan(1)
tolerance: 1 %
```

```check low
question: Below 1 m
goal: ball.y < 1 m
solution: height = 2 m
right: Yes.
```

```predict path
question: Draw it.
curve: dm
answer: ball.y
tolerance: 5 %
right: Yes.
mistake: height*(1 - time/(2 s))
wrong: A straight line.
idea: Evenly.
```

```explain why
question: Why?
answer: Because.
```

```recall
ask: projectile/same_range
```
"""
ANSWERS: dict[str, Any] = {
    "which": {"choice": 2}, "speed": {"value": "17.7 km/h", "sure": "sure"}, "slope": {"value": 45},
    "low": {"values": {"height": "2.2 m"}}, "path": {"curve": [[0, 50], [0.25, 47], [0.5, 37.7]]},
    "why": {"text": "Gravity."}, "projectile/same_range": {"value": "70 deg"},
}  # fmt: skip


def graded(tmp_path: Path, changes: dict[str, Any], **head: Any) -> dict[str, Graded]:
    lesson: Lesson = parse_lesson(LESSON, "fall.md", Path("fall.md"))
    document = {"format": "physicslab-answers/1", "lesson": "fall", "answers": {**ANSWERS, **changes}, **head}
    path = tmp_path / "answers.json"
    path.write_text(json.dumps(document))
    answers = read_answers(path, lesson, find_lesson)
    return {row.name: row for row in grade(lesson, answers, find_lesson)}


def test_right_answers_are_right(tmp_path: Path) -> None:
    rows = graded(tmp_path, {})
    assert {name: row.right for name, row in rows.items()} == {**dict.fromkeys(ANSWERS, True), "why": None}
    assert rows["why"].given == "Gravity." and rows["why"].expected == "Because."
    assert rows["speed"].sure == "sure" and rows["slope"].expected == "45°"
    assert rows == graded(tmp_path, {})


def test_wrong_answers_have_the_feedback_that_fits(tmp_path: Path) -> None:
    rows = graded(
        tmp_path,
        {
            "which": {"choice": 1}, "speed": {"value": 1}, "low": {"values": {"height": "9 m"}},
            "path": {"curve": [[0, 50], [0.5, 50]]}, "slope": {"value": "1 deg"},
        },
    )  # fmt: skip
    assert [rows[name].right for name in ("which", "speed", "low", "path", "slope")] == [False] * 5
    assert rows["which"].idea == "Things rise." and rows["speed"].feedback == "A guess."
    straight = graded(tmp_path, {"path": {"curve": [[0, 50], [0.5, 37.5]]}})["path"]
    assert (straight.right, straight.idea) == (False, "Evenly.") and not rows["path"].feedback
    assert rows["low"].given == "height = 9 m"
    assert straight.expected.startswith("0 s: 50 dm; 0.1 s: 49.5 dm; ") and straight.expected.endswith(
        "37.7 dm"
    )
    assert straight.given == "a curve that is 18.8 % of the span away"


def test_values_that_are_not_open_are_no_solution(tmp_path: Path) -> None:
    for values in ({"gravity": "99 m/s^2"}, {"height": "0.5 m"}, {"height": "2 kg"}):
        row = graded(tmp_path, {"low": {"values": values}})["low"]
        assert row.right is False and row.feedback


@pytest.mark.parametrize(
    ("head", "changes", "words"),
    [
        ({"format": "physicslab-answers/2"}, {}, 'format = "physicslab-answers/2": must be'),
        ({"format": "other"}, {}, "format"), ({"lesson": "rise"}, {}, 'lesson = "rise": must be "fall"'),
        ({"colour": 1}, {}, "unknown key"), ({"answers": []}, {}, "answers = []"),
        ({"learner": 3}, {}, "learner = 3"), ({}, {"wich": {"choice": 1}}, 'did you mean "which"?'),
        ({}, {"which": {"choice": 3}}, "from 1 to 2"), ({}, {"which": {"value": 3}}, "unknown key"),
        ({}, {"which": {"choice": True}}, "from 1 to 2"), ({}, {"speed": {"value": "2 kg"}}, "is in kg"),
        ({}, {"speed": {"value": None}}, "a number is needed"),
        ({}, {"speed": {"value": float("nan")}}, "value"),
        ({}, {"why": {"text": 3}}, "a text"), ({}, {"low": {"values": {"height": 3}}}, "as text"),
        ({}, {"path": {"curve": [[0, 1], [0, 2]]}}, "later than"),
        ({}, {"path": {"curve": [[0, 1]]}}, "two points"),
        ({}, {"which": {"choice": 1, "sure": "yes"}}, "one of guess, unsure, sure, certain"),
    ],
)  # fmt: skip
def test_what_is_no_answer_is_refused(
    tmp_path: Path, head: dict[str, Any], changes: dict[str, Any], words: str
) -> None:
    with pytest.raises(SceneError) as refused:
        graded(tmp_path, changes, **head)
    assert words in str(refused.value) and "answers.json" in str(refused.value)


def test_the_report_is_the_same_twice(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lesson, answers = tmp_path / "fall.md", tmp_path / "a.json"
    lesson.write_text(LESSON)
    document = {
        "format": "physicslab-answers/1", "lesson": "fall", "learner": "Ada", "digest": "0",
        "answers": ANSWERS,
    }  # fmt: skip
    answers.write_text(json.dumps(document))
    said = []
    for _ in range(2):
        assert main(["grade", str(lesson), str(answers), "--json", str(tmp_path / "g.json")]) == 0
        said.append((capsys.readouterr().out, (tmp_path / "g.json").read_bytes()))
    assert said[0] == said[1]
    assert "Ada: 5 of 5 questions right" in said[0][0] and "changed since" in said[0][0]
    assert json.loads(said[0][1])["checks_right"] == 5
    assert main(["grade", str(lesson), str(answers), "--json", str(answers)]) == 2
