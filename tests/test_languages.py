"""Catalogues: every text of the program has its translation, with the same gaps, and none is left over."""

import ast
import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pygame
import pytest
from desk import SETTLED, click, sized, tap
from pseudo import PSEUDO, Doubled
from window_texts import is_known, tables, without_translation, written

import physicslab
from physicslab.files.scene import load_scene
from physicslab.languages.catalogue import FOLDER, SOURCE, languages, messages, translations
from physicslab.languages.language import Language, language
from physicslab.lessons.catalogue import find_lesson
from physicslab.lessons.lesson import Question
from physicslab.lessons.worksheet import worksheet
from physicslab.view.canvas.canvas import Rect
from physicslab.view.controls.lesson_actions import go_to_step, open_lesson
from physicslab.view.controls.tools import PALETTE
from physicslab.view.overlay import banners
from physicslab.view.overlay.banners import Message

PACKAGE = Path(physicslab.__path__[0])
SAYING = {"say": 1, "say_count": 2}
"""What translates, and how many texts it takes."""
GAP = re.compile(r"\{[a-z_]+\}")


@cache
def said() -> dict[tuple[str, ...], str]:
    """Return all texts that the program says, each with where it is."""
    found: dict[tuple[str, ...], str] = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        source = path.read_text(encoding="utf-8")
        if ".say" not in source:
            continue
        for node in ast.walk(ast.parse(source)):
            if (
                isinstance(node, ast.Call)
                and isinstance(node.func, ast.Attribute)
                and node.func.attr in SAYING
            ):
                texts = node.args[: SAYING[node.func.attr]]
                where = f"{path.relative_to(PACKAGE)}:{node.lineno}"
                assert all(isinstance(one, ast.Constant) for one in texts), f"{where}: say takes whole texts"
                found[tuple(str(ast.literal_eval(one)) for one in texts)] = where
    return found


def own(code: str) -> dict[tuple[str, ...], list[str]]:
    return messages((FOLDER / f"{code}.po").read_text(encoding="utf-8"), f"{code}.po")


@pytest.mark.parametrize("code", languages()[1:])
def test_every_text_has_a_translation_and_none_is_left_over(code: str) -> None:
    assert without_translation("de", ["A text that is new", "Undo", "No run: {}"]) == ["A text that is new"]
    assert is_known("Undo") and not is_known("A text that is nowhere")
    assert ("How sure?",) in said() and ("{n} minute", "{n} minutes") in said()
    texts, catalogue = said(), own(code)
    head = catalogue.pop(("",))[0]
    assert "charset=UTF-8" in head
    assert not {text: where for text, where in texts.items() if text not in catalogue}, "without translation"
    left_over = [source for source in catalogue if source not in texts and not is_known(source[-1])]
    assert not left_over, "of no text of the program"
    number = int(re.findall(r"nplurals=(\d)", head)[0])
    for source, target in catalogue.items():
        assert len(target) == (number if len(source) > 1 else 1) and all(target), source
        assert all(set(GAP.findall(one)) == set(GAP.findall(source[-1])) for one in target), source


@pytest.mark.parametrize("code", languages()[1:])
@pytest.mark.parametrize("table", tables())
def test_every_text_of_a_table_of_the_window_has_a_translation(code: str, table: str) -> None:
    assert not without_translation(code, tables()[table])


@pytest.mark.parametrize("code", languages()[1:])
def test_hardly_a_text_that_the_view_writes_is_without_translation(code: str) -> None:
    """Those left are identities of widgets, and sentences that are put together of parts."""
    texts = written()
    assert len(without_translation(code, texts)) <= 0.03 * len(texts)


@pytest.mark.parametrize("keys", [(), ("f1",), ("f3",), ("z",), ("ctrl+k",), ("ctrl+l",)])
def test_texts_twice_as_long_keep_widgets_apart_and_within_the_window(
    keys: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("physicslab.view.workbench.interface.language", lambda code: PSEUDO)
    desk = sized((1280, 720), load_scene("drop"))
    for key in keys:
        tap(desk, key.removeprefix("ctrl+"), pygame.KMOD_CTRL if "ctrl+" in key else 0)
    desk.frames(SETTLED)
    assert "FFiillee" in desk.ui.words
    rects = {label: pygame.Rect(place) for label, place in desk.ui.places.items()}
    assert not [label for label, one in rects.items() if one.left < 0 or one.right > 1280]
    fixed = [
        rects[label] for label in ("File", "Help", "Select", "Box", "Note", "Erase", "Speed", "Time line")
    ]
    assert all(one.inflate(-2, -2).collidelist([two for two in fixed if two is not one]) < 0 for one in fixed)
    assert all(desk.ui.places[tool.title][2] > 100 for tool in PALETTE)


PREDICTED: dict[str, dict[str, object]] = {
    "choice": {"choice": 1},
    "number": {"value": "1"},
    "curve": {"curve": [[0.0, 1.0], [1.0, 1.0]]},
}


@pytest.mark.parametrize("name", ["terminal_velocity", "billiards"])
def test_texts_twice_as_long_stay_within_the_panel_of_a_lesson(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("physicslab.view.workbench.interface.language", lambda code: PSEUDO)
    desk = sized((1280, 720))
    desk.window.do_next(open_lesson, name)
    desk.frames(SETTLED)
    lesson = desk.window.lesson
    assert lesson is not None and "YYoouurr nnaammee" in desk.ui.words
    seen = 0
    for step in range(len(lesson.lesson.steps)):
        desk.window.do_next(go_to_step, step)
        desk.frames(SETTLED)
        for part in lesson.shown(step):
            if isinstance(part, Question) and part.kind == "predict":
                found = [place for label, place in desk.ui.places.items() if part.name in label]
                assert found and all(x >= 0 and x + width <= 1280 for x, _, width, _ in found), part.name
                assert not lesson.answer(part.name, part, {**PREDICTED[part.form], "sure": "sure"})
                seen += 1
        desk.frames(SETTLED)
        outside = [label for label, (x, _, width, _) in desk.ui.places.items() if x < 0 or x + width > 1280]
        assert not outside
    assert seen >= 3


NOTICES = (
    'Not opened: fall.md: line 4: head: level = "4": must be a whole number from 1 to 3',
    "No run: the run did not come to 'ball.y < 0' within 60 s",
    "Answers cannot be kept: Permission denied",
)


@pytest.mark.parametrize("size", [(1280, 720), (800, 600)])
@pytest.mark.parametrize("notice", NOTICES)
def test_notices_twice_as_long_are_whole_and_apart(
    notice: str, size: tuple[int, int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[tuple[list[Message], list[pygame.Rect]]] = []
    draw = banners.draw_messages

    def spy(messages: list[Message], *arguments: Any) -> list[Rect]:
        rects = draw(messages, *arguments)
        drawn.append((messages, [pygame.Rect(rect) for rect in rects]))
        return rects

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(banners, "draw_messages", spy)
    monkeypatch.setattr("physicslab.view.workbench.interface.language", lambda code: PSEUDO)
    desk = sized(size)
    desk.window.do_next(open_lesson, "billiards")
    desk.frames(SETTLED)
    desk.window.notify(notice, 60.0, failed=True)
    desk.frames(SETTLED)
    messages, rects = drawn[-1]
    whole = PSEUDO.reword(notice).split()
    assert any("".join(message.lines).replace(" ", "") == "".join(whole) for message in messages)
    assert len(rects) == len(messages) == 2, "the notice, and that time stands still"
    room = pygame.Rect(desk.window.framing.room())
    assert all(room.contains(rect) for rect in rects) and not rects[0].colliderect(rects[1])


@pytest.mark.parametrize("code", languages()[1:])
def test_no_translation_is_another_text_of_the_program(code: str) -> None:
    """Or it would be translated once more, where words that are said already are written."""
    again = language(code)
    said_twice = {one: again.reword(one) for target in own(code).values() for one in target if "{" not in one}
    assert not {one: twice for one, twice in said_twice.items() if again.decimal(one) != twice}


def test_a_finished_sentence_is_said_in_another_language_with_what_is_in_its_gaps() -> None:
    german = language("de")
    assert german.reword("No run: 2.5 s") == "Kein Lauf: 2,5 s"
    assert german.reword("Circle: drag from its middle, or click.\nKey: Del") == (
        "Kreis: von der Mitte aus ziehen, oder klicken.\nTaste: Entf"
    )
    assert german.reword("new box") == german.reword("New box") == "Neuer Kasten"
    assert german.reword("pause") == german.reword("Pause") == "Pause"
    assert [german.reword(words) for words in ("sticks", "slips")] == ["haftet", "rutscht"]
    taken = "Taken: friction 1 J, impacts 37.4 J, damping 2 J, resting contacts 3 J"
    assert german.reword(taken) == (
        "Abgeführt: Reibung 1 J, Stöße 37,4 J, Dämpfung 2 J, ruhende Kontakte 3 J"
    )
    said = german.reword("pendulum-0.5.json (0.5, -1.25) 1.013 m")
    assert said == german.reword(said) == "pendulum-0.5.json (0,5; -1,25) 1,013 m"
    assert [german.reword(words) for words in ("", ".", "ball", "v1.2.3")] == ["", ".", "ball", "v1.2.3"]


def test_the_window_is_in_the_language_that_is_chosen_and_widgets_keep_their_identity() -> None:
    desk = sized((1280, 720), load_scene("pendulum"))
    english = set(desk.ui.places)
    click(desk, "View")
    click(desk, "Language")
    click(desk, "Deutsch")
    desk.frames(SETTLED)
    assert desk.window.language == "de" and english <= set(desk.ui.places)
    assert {"Datei", "Ansicht", "Gesamtenergie", "Ein Pendel"} <= set(desk.ui.words)
    assert "Total energy" in desk.ui.rows and "," in desk.ui.rows["Total energy"]


def test_numbers_dates_and_plurals_are_those_of_the_language() -> None:
    german, english = language("de"), language()
    assert german.decimal("0.5 m to 1.25 m, 3.") == "0,5 m to 1,25 m, 3."
    assert english.decimal("0.5 m") == "0.5 m" and language("xx").say("How sure?") == "How sure?"
    assert [german.say_count("{n} minute", "{n} minutes", n) for n in (0, 1, 2)] == [
        "0 Minuten", "1 Minute", "2 Minuten",
    ]  # fmt: skip
    assert english.say_count("{n} minute", "{n} minutes", 1) == "1 minute"
    assert languages()[0] == SOURCE and "de" in languages()


def test_the_pseudo_language_doubles_texts_and_keeps_gaps() -> None:
    doubled = Language("qps", Doubled())
    assert doubled.say("given: {answer}", answer="7") == "ggiivveenn: 7"
    assert doubled.say_count("{n} minute", "{n} minutes", 2) == "2 mmiinnuutteess"


def test_a_worksheet_in_the_pseudo_language_has_no_word_of_the_program_undoubled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("physicslab.languages.language.translations", lambda code: Doubled())
    page = worksheet(replace(find_lesson("rolling"), language="qps"), find_lesson)
    for word in ("Predict", "Run", "Compare", "Explain", "Check", "Recall", "Sources", "value", "case"):
        assert f">{word}<" not in page and f">{Doubled().gettext(word)}<" in page
    assert not re.findall(
        r"\b(Name|Date|level|needs|minutes|How|Make|holds|over)\b:? ", page.split("<h2>")[0]
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('msgid "a"\nmsgstr "b"\nmsgid "a"\nmsgstr "c"', "one.po: line 5: 'a' stands twice"),
        ('msgid "a"\nmsg "b"', "one.po: line 2: "), ('msgid "a', "one.po: line 1: "),
    ],
)  # fmt: skip
def test_what_is_no_catalogue_is_refused(text: str, words: str) -> None:
    with pytest.raises(ValueError, match="line") as refused:
        messages(text, "one.po")
    assert words in str(refused.value)


def test_lines_of_a_catalogue_go_on() -> None:
    found = messages('# note\n\nmsgid ""\n"a "\n"b"\nmsgstr "\\"c\\" "\n"d\\n"\n', "one.po")
    assert found == {("a b",): ['"c" d\n']}
    assert translations("de").gettext("How sure?") == "Wie sicher bist du?"
