"""A lesson as one page for a browser: made, tried by keyboard alone, and its answers graded."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from browser import CHROMIUM, Browser
from pseudo import PSEUDO

from physicslab.cli import main
from physicslab.lessons.answers import grade, read_answers
from physicslab.lessons.catalogue import find_lesson

LESSON = """---
format: physicslab-lesson/1
title: A </script><b>ball</b> falls
level: 1
minutes: 5
---

It is let go.

```scene
let: height = 5 m | from where it falls
let: gravity = 10 m/s^2
open: height = 1 m to 20 m
{"physics": {"gravity": [0, "-gravity"]}, "view": [-3, -1, 3, 6],
 "entities": [{"id": "ball", "Transform": {"position": [0, "height"]}, "Velocity": {}, "Mass": {"mass": 1}}]}
```

## Level 1: How does it fall?

```predict way
question: It falls ...
choice: faster and faster
right: So it is.
choice: steadily
wrong: It would without its weight.
idea: A fall has one speed.
show: height = 20 m
```

```predict long
question: How long does it fall?
number: s
answer: time
tolerance: 2 %
right: Indeed.
mistake: sqrt(height/gravity)
wrong: The two is missing.
```

```predict course
question: Draw its speed.
curve: m/s
answer: ball.speed
tolerance: 10 %
right: A straight line.
mistake: 7.5 m/s
wrong: It begins at rest.
```

```run fall
until: ball.y < 0
graph: ball.speed
```

```compare duration
quantity: time of the fall
measure: time
theory: sqrt(2*height/gravity)
holds: always
tolerance: 1e-6
case: as it is
case: height = 20 m
```

```compare all_along
quantity: speed
along: ball.speed
theory: gravity*time
holds: always
tolerance: 1e-6
```

```explain why
question: Why?
answer: Its weight is the same all the way.
```

```check twice
question: From where does it fall for twice as long?
number: m
answer: 20 m
tolerance: 1 %
right: Four times as high.
```

```check aim
question: Let it fall for 1.5 s to 1.6 s.
goal: time > 1.5 s and time < 1.6 s
solution: height = 12 m
right: Well aimed.
```
"""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("page")
    (folder / "fall.md").write_text(LESSON, encoding="utf-8")
    assert main(["lesson", str(folder / "fall.md"), "--page", str(folder / "fall.html")]) == 0
    return folder / "fall.html"


def document(page: Path) -> dict[str, Any]:
    text = page.read_text(encoding="utf-8")
    found = re.search(r'<script id="run" type="application/json">(.*?)</script>', text, re.DOTALL)
    assert found is not None
    read: dict[str, Any] = json.loads(found[1])
    return read


def test_every_block_is_in_it_and_nothing_breaks_out(page: Path) -> None:
    text, lesson = page.read_text(encoding="utf-8"), find_lesson(str(page.with_suffix(".md")))
    names = re.findall(r'data-kind="(\w+)" data-name="(\w+)"', text)
    assert names == [
        ("predict", "way"), ("predict", "long"), ("predict", "course"), ("run", "fall"),
        ("compare", "duration"), ("compare", "all_along"), ("explain", "why"), ("check", "twice"),
        ("check", "aim"),
    ]  # fmt: skip
    assert text.count("</script>") == 2 and "<b>ball" not in text
    assert not re.findall(r"https?:|\bsrc=|@import|url\(", text)
    told = document(page)["lesson"]
    assert told["head"]["digest"] == lesson.digest
    assert told["questions"]["long"]["answer"] == pytest.approx(1.0, rel=1e-6)
    assert told["questions"]["aim"]["reached"].count(True) >= 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["no.md", "--page", "out.html"], "no.md"), (["--page", "out.html"], "--page: must stand beside"),
        (["pendulum", "--page", "a.html", "--worksheet", "b.html"], "--page: must stand beside"),
        (["pendulum", "--check", "--page", "a.html"], "--page: must stand beside"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_in_a_line(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str], tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(["lesson", *arguments]) == 2
    told = capsys.readouterr()
    assert not told.out and told.err.count("\n") == 1 and words in told.err
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    if CHROMIUM is None:
        pytest.skip("not installed: chromium")
    with Browser() as opened:
        yield opened


def within(name: str) -> str:
    return f"it.closest('.part')?.dataset.name === '{name}'"


def shown(browser: Browser) -> list[str]:
    names = "[...document.querySelectorAll('.part[data-name]')].filter(one => one.offsetParent)"
    found: list[str] = browser.value(f"{names}.map(one => one.dataset.name)")
    return found


def answer(browser: Browser, name: str, *keys: str, sure: bool = True) -> None:
    """Tab to a question, press keys in it, say "guess", and press its button."""
    browser.tab_to(within(name))
    for key in keys:
        browser.key(key)
    if sure:
        browser.tab_to("it.name === 'sure'")
        browser.key(" ")
    browser.tab_to("it.className === 'main'")
    browser.key("Enter")


@pytest.mark.parametrize("width", [1280, 390])
def test_texts_twice_as_long_are_neither_cut_nor_upon_each_other(
    width: int, page: Path, browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in ("lessons.lesson", "export.page"):
        monkeypatch.setattr(f"physicslab.{module}.language", lambda code: PSEUDO)
    long = page.with_name("long.html")
    assert main(["lesson", str(page.with_suffix(".md")), "--page", str(long)]) == 0
    browser.open(long, width=width, height=844, still=True)
    assert "PPrreeddiicctt" in browser.value("document.body.innerHTML")
    browser.value("document.querySelectorAll('.step > *').forEach(one => { one.hidden = false; })")
    assert browser.value("document.documentElement.scrollWidth") <= width
    assert browser.crowded() == []


def test_by_keyboard_alone_from_prediction_to_grade(page: Path, browser: Browser, tmp_path: Path) -> None:
    browser.requests.clear()
    browser.open(page, still=True)
    assert browser.complaints == [] and browser.requests == [page.as_uri()]
    assert shown(browser) == ["way"]
    browser.tab_to("it.id === 'learner'")
    for key in "Ada":
        browser.key(key)
    browser.tab_to(within("way"))
    browser.tab_to("it.className === 'main'")
    browser.key("Enter")
    assert shown(browser) == ["way"], "nothing is locked in that is not answered"
    browser.key("Tab", shift=True)
    browser.value("document.activeElement.blur()")
    answer(browser, "way", " ", "ArrowDown")
    assert shown(browser) == ["way", "long"]
    browser.key("Tab", shift=True)
    answer(browser, "long", *"0,707")
    assert shown(browser) == ["way", "long", "course"]
    browser.value("document.activeElement.blur()")
    browser.tab_to(within("course"))
    for key in ["ArrowUp", *["Tab", "ArrowUp"] * 8]:
        browser.key(key)
    browser.tab_to("it.name === 'sure'")
    browser.key(" ")
    browser.tab_to("it.className === 'main'")
    browser.key("Enter")
    assert shown(browser)[-1] == "fall" and browser.value("document.getElementById('player').hidden")
    assert browser.value(within("fall").replace("it.", "document.activeElement.")), "the focus goes on"
    browser.key("Enter")
    assert browser.value("document.activeElement.id") == "play"
    assert not browser.value("player.playing"), "the user wants nothing to move by itself"
    browser.key("End")
    browser.until("lesson.seen.size === 1")
    assert shown(browser)[-3:] == ["duration", "all_along", "why"]
    said = browser.value(
        "document.querySelector('[data-name=way] .said').innerText + "
        "document.querySelector('[data-name=long] .said').innerText + "
        "document.querySelector('[data-name=duration]').innerText"
    )
    assert "It would without its weight." in said and "The two is missing." in said
    assert "0.707 s" in said.replace("0.7070", "0.707") and "\u2713" in said and "2 s" in said
    names = (
        "player.lines && [...document.querySelectorAll('#graphs td:first-child')].map(one => one.innerText)"
    )
    browser.until("document.querySelectorAll('#graphs td').length > 5")
    assert browser.value(names) == ["ball: speed", "by theory", "predicted"]
    answer(browser, "why", *"Weight", sure=False)
    answer(browser, "twice", *"20", sure=False)
    assert "Four times as high." in browser.value("document.querySelector('[data-name=twice]').innerText")
    browser.tab_to(within("aim"))
    browser.key("Enter")
    browser.value("document.activeElement.blur()")
    browser.tab_to(f"it.id === 'slider-0' && {within('aim')}")
    browser.key("End")
    browser.tab_to(f"it.className === 'main' && {within('aim')}")
    browser.key("Enter")
    assert "Not yet." in browser.value("document.querySelector('[data-name=aim]').innerText")
    assert browser.value(_ASKS), "answers would be lost"
    browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    browser.tab_to("it.id === 'save'")
    browser.key("Enter")
    file = tmp_path / "fall-answers.json"
    browser._wait(file.exists, "the file of answers")
    assert not browser.value(_ASKS), "they are saved"
    lesson = find_lesson(str(page.with_suffix(".md")))
    answers = read_answers(file, lesson, find_lesson)
    assert answers.learner == "Ada" and not answers.other_text
    graded = {row.name: row for row in grade(lesson, answers, find_lesson)}
    assert {name: row.right for name, row in graded.items()} == {
        "way": False, "long": False, "course": False, "why": None, "twice": True, "aim": False,
    }  # fmt: skip
    assert graded["long"].feedback == "The two is missing." and graded["way"].sure == "guess"
    assert graded["course"].feedback == "It begins at rest."
    assert main(["grade", str(page.with_suffix(".md")), str(file)]) == 0
    browser.open(page, still=True)
    field = browser.call("Runtime.evaluate", expression="document.getElementById('open')")["result"]
    browser.call("DOM.setFileInputFiles", files=[str(file)], objectId=field["objectId"])
    browser.until("document.getElementById('learner').value === 'Ada'")
    assert browser.value("lesson.answers") == answers.given
    assert shown(browser) == ["way", "long", "course", "fall"], "predictions are locked, the run is open"
    assert browser.complaints == [] and set(browser.requests) == {page.as_uri()}


def test_answers_of_a_file_that_cannot_be_read_are_named(
    page: Path, browser: Browser, tmp_path: Path
) -> None:
    head = document(page)["lesson"]["head"]
    browser.open(page, still=True)
    answers: dict[str, Any] = {
        "way": {"choice": 2, "sure": "sure"}, "long": {"value": "long"}, "course": {"curve": 3},
        "aim": {"values": {"height": "a mile"}}, "none": {"choice": 1}, "twice": {"value": 20.0},
    }  # fmt: skip
    field = browser.call("Runtime.evaluate", expression="document.getElementById('open')")["result"]
    for name, given, said in (
        ("some", answers, "These could not be read: long, course, aim, none"),
        ("none", [], "This file holds no answers to this lesson."),
    ):
        file = tmp_path / f"{name}.json"
        file.write_text(json.dumps({**head, "learner": "Ada", "answers": given} if given else given))
        browser.call("DOM.setFileInputFiles", files=[str(file)], objectId=field["objectId"])
        browser.until(f"document.getElementById('kept').textContent.endsWith({said!r})")
        assert sorted(browser.value("lesson.answers")) == ["twice", "way"]
    assert browser.complaints == []


_ASKS = """(() => {
  const leaving = new Event("beforeunload", { cancelable: true });
  dispatchEvent(leaving);
  return leaving.defaultPrevented;
})()"""
"""Whether the browser asks before the page is left."""


def test_every_control_has_a_name_and_the_focus_is_seen(page: Path, browser: Browser) -> None:
    browser.open(page, still=True)
    tree = browser.call("Accessibility.getFullAXTree")["nodes"]
    controls = ("button", "radio", "slider", "textbox", "combobox", "checkbox")
    named = [
        one.get("name", {}).get("value") for one in tree
        if not one["ignored"] and one["role"]["value"] in controls
    ]  # fmt: skip
    assert len(named) >= 8 and all(named)
    browser.tab_to("it.type === 'radio'")
    assert browser.value("getComputedStyle(document.activeElement).outlineStyle") == "solid"
