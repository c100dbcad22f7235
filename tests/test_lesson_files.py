"""Files of lessons: what is read from them, and the mistakes that each kind of block refuses."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from physicslab.languages.language import language
from physicslab.lessons.answers import asked
from physicslab.lessons.blocks import KEYS, LessonError
from physicslab.lessons.catalogue import LIBRARY, find_lesson
from physicslab.lessons.check import check_lesson
from physicslab.lessons.lesson import Compare, Explain, Prose, Question, Recall, Run
from physicslab.lessons.reader import parse_lesson, read_lesson

LESSON = """---
format: physicslab-lesson/1
title: A fall
level: 1
minutes: 10
needs: speed, time
source: doe2001 = Doe (2001), A book
---
Before.

```scene
let: height = 5 m | from where it falls
let: gravity = 9.81 m/s^2
open: height = 1 m to 20 m
tools: hand, ruler
show: arrows
{"physics": {"gravity": [0, "-gravity"]},
 "entities": [{"id": "ball", "Transform": {"position": [0, "height"]}, "Velocity": {}, "Mass": {}}]}
```

## Level 2: How long?

```predict time
question: How long
  does it fall?
choice: one second
wrong: A little more [doe2001].
idea: guessed
show: height = 20 m
choice: longer
right: Yes.
when: time > 1 s
```

```run fall
until: ball.y < 0
limit: 10 s
graph: ball.y
```

```compare
quantity: time
measure: time
theory: sqrt(2 height/gravity)
holds: always
tolerance: 1e-9
case: height = 1 m | a small one
```

```explain why
question: Why?
answer: Because.
```

```check speed
question: How fast is it?
number: m/s
answer: ball.speed
tolerance: 1 %
right: Yes.
mistake: gravity*2 s
wrong: No.
```

```recall
ask: projectile/target
```
"""


def test_a_lesson_becomes_records() -> None:
    lesson = parse_lesson(LESSON, "fall.md", Path("fall.md"))
    assert (lesson.name, lesson.title, lesson.level, lesson.minutes) == ("fall", "A fall", 1, 10)
    assert lesson.needs == ("speed", "time") and lesson.language == "en"
    assert [(step.heading, step.depth) for step in lesson.steps] == [("", 1), ("How long?", 2)]
    kinds = [type(part) for part in lesson.parts()]
    assert kinds == [Prose, Question, Run, Compare, Explain, Question, Recall]
    first, check = lesson.questions()
    assert first.prompt == "How long does it fall?" and first.run is not None
    assert [reply.right for reply in first.replies] == [False, True]
    assert first.replies[0].idea == "guessed" and check.unit == "m/s"
    assert lesson.setup.opened == {"height": ("1 m", "20 m")} and lesson.setup.tools == ("hand", "ruler")
    assert lesson.quantities == ("ball.y", "ball.speed")
    assert [compare.name for compare in lesson.compares()] == ["compare_1"]


WRONG = [
    ("title: A fall\n", "", "line 1: head: title is missing"),
    ("physicslab-lesson/1", "physicslab-lesson/2", "line 2: head: format ="),
    ("level: 1", "level: 4", "line 4: head: level = \"4\": must be a whole number from 1 to 3"),
    ("minutes: 10", "minutes: soon", "line 5: head: minutes"),
    ("level: 1", "levl: 1", "line 4: head: levl: unknown key; must be one of format, title, level"),
    ("needs: speed, time", "needs: 5", "line 6: head: needs = \"5\": must be words for what is known before"),
    ("source: doe2001 =", "source: Doe =", "line 7: head: source"),
    ("needs: speed, time", "language: german!", "line 6: head: language"),
    ("needs: speed, time", "scene: drop", "must be named in the head (scene: NAME), or written here"),
    ("## Level 2:", "## Level 7:", "line 21: \"## Level 7: How long?\": a level must be 1, 2 or 3"),
    ("## Level 2:", "##", "line 21: \"## How long?\": a level must be 1, 2 or 3, as in ## Level 1: QUESTION"),
    ("## Level 2:", "## Level two:", "line 21: \"## Level two: How long?\": a level must be 1, 2 or 3"),
    ("```explain why", "```explian why", "line 50: \"explian\": unknown block; must be one of scene"),
    ("```explain why", "```explain Why?", "line 50: explain \"Why?\": a block's name"),
    ("```explain why", "```explain fall", "line 50: explain fall: the block of line 35 has this name"),
    ("ask: projectile/target\n```", "ask: projectile/target", "line 65: recall: the block has no end"),
    # scene
    ("let: height = 5 m", "let: height 5 m", "line 12: scene: let = "),
    ("let: height = 5 m", "let: m = 5", "is taken: a unit"),
    ("let: height = 5 m", "let: height = 5 parsec", "line 12: scene: let = "),
    ("open: height = 1 m to 20 m", "open: width = 1 m to 2 m", "line 14: scene: open"),
    ("open: height = 1 m to 20 m", "open: height = 20 m to 1 m", "line 14: scene: open = "),
    ("open: height = 1 m to 20 m", "open: height = 6 m to 20 m", "with height = 5 m in between"),
    ("open: height = 1 m to 20 m", "open: height = 1 kg to 20 kg", "another unit does not fit"),
    ("\"height\"]", "\"pul\"]", "'pul' is no unit and no parameter; must be one of height, gravity"),
    ("let: height = 5 m", "let: height = five", "'five' is no unit, and there are no parameters here"),
    ("tools: hand", "tools: hammer",
     "line 15: scene: tools = \"hammer, ruler\": \"hammer\": must be some of hand"),
    ("show: arrows", "show: ghosts", "line 16: scene: show"),
    ("\"height\"]", "\"hieght\"]", "line 11: scene: entity ball: Transform.position: 'hieght'"),
    ("\"height\"]", "\"gravity\"]", "this is in m"),
    ("\"Mass\": {}", "\"Mass\": {\"mass\": -1}", "line 11: scene: entity \"ball\": Mass.mass = -1"),
    ("\"entities\": [", "\"entities\": [[", "is not JSON: "),
    ("show: arrows", "set: ball.Mass = 2", 'line 16: scene: set = "ball.Mass = 2": ball.Mass = 2: must be'),
    # predict
    ("question: How long\n  does it fall?\n", "", "line 23: predict time: question is missing"),
    ("choice: longer\nright: Yes.", "choice: longer\nwrong: Yes.",
     "line 23: predict time: must have two choices"),
    ("choice: longer\nright: Yes.", "choice: longer",
     "line 30: predict time: choice = \"longer\": must have below it"),
    ("[doe2001].", "[roe2001].", "line 27: predict time: wrong = "),
    ("show: height = 20 m", "show: heigth = 20 m", "line 29: predict time: show = "),
    ("show: height = 20 m", "show: height 20 m", "must be NAME = VALUE"),
    ("show: height = 20 m", "show: height = 20 kg", "line 29: predict time: show = "),
    ("when: time > 1 s", "when: time", "line 32: predict time: when = \"time\": 'time' is no condition"),
    ("idea: guessed", "  idea: guessed\nnote: x", "line 29: predict time: note: unknown key"),
    # run
    ("until: ball.y < 0", "until: bell.y < 0",
     "line 36: run fall: until = \"bell.y < 0\": 'bell.y' is no quantity"),
    ("until: ball.y < 0", "until: ball.z < 0", "ball has x, y, angle, vx"),
    ("until: ball.y < 0\n", "", "line 35: run fall: must have seconds: TIME or until: CONDITION"),
    ("limit: 10 s", "seconds: 10 s", "must have seconds: TIME or until: CONDITION, one of both"),
    ("limit: 10 s", "limit: 12 m", "line 37: run fall: limit = \"12 m\": '12 m' is in m; this is in s"),
    ("limit: 10 s", "limit: -1", "line 37: run fall: limit = \"-1\": must be a time above 0 s"),
    ("limit: 10 s", "limit: 1e9 s",
     "line 37: run fall: limit = \"1e9 s\": 1e+09 s is too long: must be at most 1,000,000 steps"),
    ("graph: ball.y", "graph: max(ball.y", "'max(ball.y' is no number: a \")\" is missing"),
    ("graph: ball.y", "graph: ball.y)", "'ball.y)' is no number: a \"(\" is missing"),
    ("graph: ball.y", "graph: hight", "line 38: run fall: graph = \"hight\": 'hight' is unknown"),
    # compare
    ("measure: time\n", "", "line 41: compare compare_1: must have measure: EXPRESSION or along"),
    ("theory: sqrt(2 height/gravity)\n", "", "line 41: compare compare_1: theory is missing"),
    ("theory: sqrt(2 height/gravity)", "theory: sqrt(2 height/", "line 44: compare compare_1: theory = "),
    ("measure: time", "unit: secs\nmeasure: time", "unit = \"secs\": 'secs' is no unit"),
    ("measure: time", "unit: 0 s\nmeasure: time", "compare_1: unit = \"0 s\": '0 s' is no unit"),
    ("holds: always", "holds: sometimes", "line 45: compare compare_1: holds = "),
    ("tolerance: 1e-9", "tolerance: small", "line 46: compare compare_1: tolerance = "),
    ("case: height = 1 m", "case: ball.Mas.mass = 1", "line 47: compare compare_1: case = "),
    # explain, check, recall
    ("answer: Because.", "answer:", "line 52: explain why: answer is missing"),
    ("number: m/s", "number: metre", "line 57: check speed: number = \"metre\": 'metre' is no unit"),
    ("number: m/s\n", "", "line 55: check speed: must have one of choice: TEXT, number: UNIT"),
    ("tolerance: 1 %", "tolerance: 1 m", "line 59: check speed: tolerance = \"1 m\": must be a share"),
    ("mistake: gravity*2 s\n", "", "line 61: check speed: wrong: must stand below"),
    ("wrong: No.", "right: Yes.", "must have below it wrong: FEEDBACK"),
    ("ask: projectile/target", "ask: target",
     "line 66: recall recall_1: ask = \"target\": must be LESSON/CHECK"),
    ("question: Why?", "Why?", "line 51: explain why: \"Why?\": must be KEY: VALUE"),
    ("question: Why?", "question: Why?\nquestion: How?", "line 52: explain why: question is given twice"),
]  # fmt: skip


_QUOTED = re.compile(r'"(?:\\.|[^"\\])*"|\'[^\']*\'|(?:JSON|werden): .*')
_ENGLISH = re.compile(r"(?<![-\w])(?:must|the|is|are|one|with|and|or|of|line|which|lesson)(?![-.\w])")


def english_in_german(error: Exception) -> list[str]:
    """Return the English words that are left of a message in German, beside those of the file."""
    said = language("de").reword(f"Not opened: {error}")
    assert said.startswith("Nicht geöffnet: ")
    return _ENGLISH.findall(_QUOTED.sub("", said))


@pytest.mark.parametrize(("part", "instead", "words"), WRONG)
def test_a_mistake_is_refused_with_its_line(part: str, instead: str, words: str) -> None:
    assert part in LESSON
    with pytest.raises(LessonError) as refused:
        parse_lesson(LESSON.replace(part, instead, 1), "fall.md")
    message = str(refused.value)
    assert message.startswith("fall.md: ") and words in message and "\n" not in message
    assert not english_in_german(refused.value)


def test_every_kind_of_block_is_among_the_mistakes() -> None:
    named = {words.partition(": ")[2].split(" ")[0].rstrip(":") for _, _, words in WRONG}
    assert set(KEYS) <= named


@pytest.mark.parametrize("content", [b"", b"# Title\n", b"---\ntitle: x\n", b"\xff\xfe", None])
def test_what_is_no_lesson_is_refused(tmp_path: Path, content: bytes | None) -> None:
    path = tmp_path / "one.md"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(LessonError, match=r"one\.md: ") as refused:
        read_lesson(path)
    assert not english_in_german(refused.value)


def test_words_of_a_translation_alone_are_no_lesson() -> None:
    why = r"pendulum\.md: line 2: head: .* must be pendulum\.md of the folder above, with --language de"
    with pytest.raises(LessonError, match=why) as refused:
        read_lesson(LIBRARY / "de" / "pendulum.md")
    assert not english_in_german(refused.value)


GOAL = """
```check reach
question: Let it fall for 2 s.
goal: time > 2 s
solution: {case}
right: Yes.
```
"""


@pytest.mark.parametrize(
    ("case", "words"),
    [
        (
            "gravity = 1 m/s^2",
            'line 72: check reach: solution = "gravity = 1 m/s^2": must be of what is open',
        ),
        ("height = 190 m", 'line 72: check reach: solution = "height = 190 m": height must be from 1 m to'),
    ],
)
def test_a_goal_is_reached_with_what_is_open(case: str, words: str) -> None:
    with pytest.raises(LessonError, match=re.escape(words)):
        parse_lesson(LESSON + GOAL.format(case=case), "fall.md")


@pytest.mark.parametrize(
    ("part", "instead", "words"),
    [
        ("until: ball.y < 0", "until: ball.y < 0 s", "line 35: run fall: 'ball.y < 0 s': m and s cannot"),
        ("until: ball.y < 0", "until: ball.y > 9", "line 35: run fall: the run did not come to 'ball.y > 9'"),
        ("theory: sqrt(2 height/gravity)", "theory: height/gravity", "line 41: compare compare_1: "),
        (
            "measure: time",
            "unit: cm\nmeasure: time",
            "line 41: compare compare_1: 'cm': m and s cannot be compared",
        ),
        ("measure: time", "measure: period(ball.y)", "the mean is to be taken away: period(ball.x - mean("),
        (
            "holds: always",
            "holds: height > 2 m",
            "line 47: compare compare_1: case = \"height = 1 m\": 'height > 2 m' does not hold; must be",
        ),
        (
            "case: height = 1 m | a small one",
            "case: height = 1 m\nfails: height = 20 m",
            "line 48: compare compare_1: fails = \"height = 20 m\": 'always' holds; must be a case in which",
        ),
        (
            "case: height = 1 m | a small one",
            "fails: gravity = 1e-3 m/s^2",
            'line 47: compare compare_1: fails = "gravity = 1e-3 m/s^2": the run did not come to '
            "'ball.y < 0' within 10 s; must be a case in which time can be measured",
        ),
        (
            "show: height = 20 m",
            "show: gravity = 1e-3 m/s^2",
            "line 29: predict time: show = \"gravity = 1e-3 m/s^2\": the run did not come to 'ball.y < 0' "
            "within 10 s; must be a case in which the run comes to its end",
        ),
        ("answer: ball.speed", "answer: ball.x", "line 55: check speed: 'ball.x' is in m; this is in m/s"),
        ("number: m/s", "curve: m", "line 55: check speed: 'ball.speed' is in m/s; this is in m"),
    ],
)
def test_what_the_engine_cannot_check_is_refused_with_its_block(part: str, instead: str, words: str) -> None:
    with pytest.raises(LessonError, match=re.escape(words)) as refused:
        list(check_lesson(parse_lesson(LESSON.replace(part, instead, 1), "fall.md", Path("fall.md"))))
    assert not english_in_german(refused.value)


IN_MS = "unit: ms\nmeasure: time"


def test_a_comparison_is_in_its_unit() -> None:
    text = LESSON.replace("tolerance: 1e-9", "tolerance: 1 ms")
    both = (parse_lesson(text.replace("measure: time", one), "fall.md") for one in ("measure: time", IN_MS))
    rows = [next(row for row in check_lesson(one) if row.block == "compare_1") for one in both]
    assert [row.unit for row in rows] == ["s", "ms"] and all(row.passed and row.absolute for row in rows)
    for name in ("measured", "theory", "gap", "tolerance"):
        first, second = (getattr(row, name) for row in rows)
        assert second == pytest.approx(1000.0 * first, rel=1e-12), name


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        ("pendulum/mass", "pendulum has no check mass; must be one of seconds, factor"),
        ("pendulums/mass", "ask = pendulums/mass: pendulums: no such file, and no lesson of this name"),
    ],
)
def test_a_question_that_is_recalled_must_be_there(ask: str, words: str) -> None:
    lesson = parse_lesson(LESSON.replace("ask: projectile/target", f"ask: {ask}"), "fall.md")
    with pytest.raises(LessonError, match=f": line 65: recall recall_1: {re.escape(words)}") as refused:
        list(asked(lesson, find_lesson))
    assert not english_in_german(refused.value)


def test_a_scene_may_be_a_built_in_one_or_a_file_beside_the_lesson(tmp_path: Path) -> None:
    head, _, rest = LESSON.partition('{"physics"')
    text = head.replace("needs: speed, time", "scene: drop") + "```\n\n## Level 1: How far?\n"
    assert rest
    lesson = parse_lesson(text, "drop.md")
    assert any(one.get("id") == "ball" for one in lesson.setup.document["entities"])
    (tmp_path / "own.json").write_text('{"format": "physicslab-scene/1", "entities": [{"id": "x"}]}')
    own = parse_lesson(text.replace("scene: drop", "scene: own.json"), "own.md", tmp_path / "own.md")
    assert [one["id"] for one in own.setup.document["entities"]] == ["x"]


GERMAN = """---
format: physicslab-lesson-words/1
title: Ein Fall
needs: Geschwindigkeit, Zeit
---
Vorher.

```scene
let: height | aus welcher Höhe
let: gravity | Fallbeschleunigung
```

## Wie lange?

```predict time
question: Wie lange fällt er?
choice: eine Sekunde
wrong: Etwas mehr [doe2001].
idea: geraten
choice: länger
right: Ja.
```

```compare
quantity: Zeit
case: ein kleiner
```

```explain why
question: Warum?
answer: Darum.
```

```check speed
question: Wie schnell ist er?
right: Ja.
wrong: Nein.
```
"""


def test_a_translation_has_words_alone_and_keeps_the_physics() -> None:
    english, german = parse_lesson(LESSON, "fall.md"), parse_lesson(LESSON, "fall.md", words=(GERMAN, "de"))
    assert german.title == "Ein Fall" and german.needs == ("Geschwindigkeit", "Zeit")
    assert [(step.heading, step.depth) for step in german.steps] == [("", 1), ("Wie lange?", 2)]
    assert german.setup.notes["height"] == "aus welcher Höhe" and german.quantities == english.quantities
    assert german.setup.parameters["height"].text == english.setup.parameters["height"].text
    first = next(german.questions())
    assert [reply.text for reply in first.replies] == ["eine Sekunde", "länger"]
    assert first.replies[0].shown_by == next(english.questions()).replies[0].shown_by
    (compare,) = german.compares()
    assert (compare.quantity, compare.cases[0].note) == ("Zeit", "ein kleiner")
    assert compare.cases[0].values == (("height", "1 m"),)


UNTRANSLATED = [
    ("words/1", "words/2", "line 2: head: format"), ("title: Ein Fall\n", "", "line 3: head: needs = "),
    ("Vorher.", "Vorher.\n\nUnd.", "line 6: must have the paragraphs of line 9"),
    ("Vorher.\n", "", "line 7: must be text, as in line 9"),
    ("## Wie lange?\n", "", "line 14: must be a heading, as in line 21"),
    ("let: height | aus", "let: width | aus", "line 9: scene: let = "),
    ("let: height | aus welcher Höhe", "let: height |", "must have the words of line 12"),
    ("let: gravity", "let: gravity | x\nlet: gravity", "the lesson has no such words here"),
    ("predict time", "predict tiem", "line 15: must be predict time, as in line 23"),
    ("idea: geraten\n", "", "line 19: predict time: choice = \"länger\": must be idea, the words of line 28"),
    ("right: Ja.\nwrong: Nein.", "right: Ja.", "check speed: wrong is missing: the words of line 62"),
    ("[doe2001]", "", "must cite doe2001"), ("Darum.", "Darum [doe2001].", "must cite no source"),
    ("wrong: Nein.\n```", "wrong: Nein.\n```\n```explain more\nquestion: x\n```",
     "nothing of the lesson is left"),
    ("question: Warum?", "tolerance: 1 %\nquestion: Warum?", "explain why: tolerance: unknown key"),
    ("```check speed\nquestion: Wie schnell ist er?\nright: Ja.\nwrong: Nein.\n```\n", "",
     "check speed, line 55 of the lesson, is missing"),
]  # fmt: skip


@pytest.mark.parametrize(("part", "instead", "words"), UNTRANSLATED)
def test_a_translation_that_does_not_fit_is_refused_with_its_line(
    part: str, instead: str, words: str
) -> None:
    assert part in GERMAN
    with pytest.raises(LessonError) as refused:
        parse_lesson(LESSON, "fall.md", words=(GERMAN.replace(part, instead, 1), "de/fall.md"))
    message = str(refused.value)
    assert message.startswith("de/fall.md: ") and words in message and "\n" not in message
    assert not english_in_german(refused.value)


def test_words_stand_in_the_folder_of_their_language(tmp_path: Path) -> None:
    (tmp_path / "de").mkdir()
    (tmp_path / "fall.md").write_text(LESSON)
    (tmp_path / "de" / "fall.md").write_text(GERMAN)
    english, german = (read_lesson(tmp_path / "fall.md", code) for code in ("", "de"))
    assert (english.language, german.language) == ("en", "de") and english.digest == german.digest
    assert read_lesson(tmp_path / "fall.md", "fr").language == "en"
    with pytest.raises(LessonError, match="must be the code of a language"):
        read_lesson(tmp_path / "fall.md", "../x")


@pytest.mark.parametrize(("shown", "passed"), [
    ("show: height = 20 m\nwhen: time < 1.005 s", True),
    ("show: height = 4.9 m\nwhen: time < 1.005 s", False),
    ("where: height = 4.9 m\nwhen: time < 1.005 s", True),
    ("where: height = 20 m\nwhen: time < 1.005 s", False),
])  # fmt: skip
def test_the_run_that_is_shown_refutes_a_choice_or_is_where_it_is_right(shown: str, passed: bool) -> None:
    lesson = parse_lesson(LESSON.replace("show: height = 20 m", shown), "fall.md")
    rows = [
        row for row in check_lesson(lesson) if row.block == "time" and row.case.startswith("one second, ")
    ]
    assert [row.passed for row in rows] == [passed]


@pytest.mark.parametrize(("key", "height", "passed"), [
    ("show", "5 m", True), ("show", "19.62 m", False), ("where", "19.62 m", True), ("where", "5 m", False),
])  # fmt: skip
def test_so_does_that_of_a_wrong_number(key: str, height: str, passed: bool) -> None:
    mistake = "mistake: gravity*2 s\nwrong: No.\n"
    written = LESSON.replace(mistake, f"{mistake}{key}: height = {height}\n")
    rows = [row for row in check_lesson(parse_lesson(written, "fall.md")) if f", {key}: " in row.case]
    assert [row.passed for row in rows] == [passed]


def test_one_run_is_shown_to_an_answer() -> None:
    written = LESSON.replace("show: height = 20 m", "show: height = 20 m\nwhere: height = 4 m")
    with pytest.raises(LessonError, match=r"line 30: predict time: where = .*must not stand beside show"):
        parse_lesson(written, "fall.md")
