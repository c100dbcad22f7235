"""Fields that hold a text: in columns, in files, history and recordings, other processes and the window."""

from __future__ import annotations

import copy
import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, click, empty_world, tap, write
from hypothesis import example, given
from hypothesis import strategies as st

from physicslab import SceneError, World
from physicslab.components import Note, Transform
from physicslab.ecs.component import Component, InvalidValue, component, field, local_components
from physicslab.ecs.text import code_of, has_width, is_line, text_of
from physicslab.files.assignments import assign
from physicslab.files.json_text import json_bytes
from physicslab.files.reader import FORMAT, read_scene
from physicslab.files.scene import load_scene, save_scene
from physicslab.files.writer import write_scene
from physicslab.history import History, SetField, Spawn

with local_components():

    @component
    class Sign(Component):
        """A component with a text on one line, of the usual length."""

        words: str = field(default="none", meaning="what is on it")
        number: int = field(default=0, meaning="which it is")


def _may_stand(text: str) -> bool:
    return all(map(is_line, text.split("\n"))) and (not text or has_width(text))


TEXTS = st.text(max_size=400).filter(lambda text: text.count("\n") < 8 and _may_stand(text))
HELD_BY_NONE = (
    "a\tb", "\x1b[2J", "\ud800", "\u2028", "a\rb", "\u200b", " ", "x" * 401, "\n" * 8 + "x",
    None, 3, b"x", ["x"], True,
)  # fmt: skip


# ---- columns -----------------------------------------------------------------------------------------------


@given(TEXTS)
@example("")
def test_a_text_is_read_as_it_was_written(text: str) -> None:
    note = Note(text)
    assert note.text == text
    world = World()
    entity = world.spawn(note)
    assert world.component(entity, Note).text == text
    world.remove(entity)
    assert note.text == text  # the handle keeps its last values


def test_the_column_holds_a_code_and_zero_for_nothing() -> None:
    world = World()
    first, second, third = (world.spawn(Note(text)) for text in ("here", "", "here"))
    other = world.spawn(Transform())
    world.synchronise()
    column, row_of = world.table(Note)["text"], world.entity_index.row_of
    assert column.dtype == np.int64
    assert column[row_of[first]] == column[row_of[third]] == code_of("here") > 0
    assert column[row_of[second]] == column[row_of[other]] == 0


@given(st.lists(st.text()))
def test_codes_and_texts_belong_together(texts: list[str]) -> None:
    codes = [code_of(text) for text in texts]
    assert [text_of(code) for code in codes] == texts
    assert len(set(codes)) == len(set(texts))


@pytest.mark.parametrize("value", HELD_BY_NONE)
def test_what_is_no_text_to_be_seen_is_refused(value: object) -> None:
    note = Note("before")
    with pytest.raises(
        InvalidValue, match=r"Note\.text = .*: must be a text of at most 8 lines, at most 400"
    ):
        note.text = value  # type: ignore[assignment]
    assert note.text == "before"


def test_one_line_of_the_usual_length_where_nothing_else_is_given() -> None:
    assert Sign().words == "none"
    assert Sign("x" * 200).words == "x" * 200
    for value in ("x" * 201, "a\nb"):
        with pytest.raises(InvalidValue, match=r"a text on one line, at most 200 characters"):
            Sign(value)


def test_a_copy_by_pickle_holds_the_text() -> None:
    note = Note("of another process")
    packed = pickle.dumps(note)
    assert b"of another process" in packed
    assert pickle.loads(packed).text == copy.copy(note).text == note.text


# ---- files -------------------------------------------------------------------------------------------------


@given(st.lists(TEXTS, max_size=4))
def test_files_hold_the_text_itself(texts: list[str]) -> None:
    world = World()
    for text in texts:
        world.spawn(Note(text, (1, 2)))
    document = json.loads(json_bytes(write_scene(world)))
    assert [entity["Note"].get("text", "") for entity in document["entities"]] == texts
    again = read_scene(document)
    assert [again.component(entity, Note).text for entity in again.entities()] == texts
    assert write_scene(again) == document


@pytest.mark.parametrize("value", [*HELD_BY_NONE[:9], None, 3, ["x"], {"a": 1}, True])
def test_a_file_with_anything_else_is_refused_by_a_line(value: object) -> None:
    document = {"format": FORMAT, "entities": [{"id": "here", "Note": {"text": value}}]}
    with pytest.raises(SceneError) as refused:
        read_scene(document, "notes.json")
    line = str(refused.value)
    assert line.startswith('notes.json: entity "here": Note.text = ')
    assert line.endswith(
        ": must be a text of at most 8 lines, at most 400 characters, that can be seen, or empty"
    )
    assert line.isprintable()


def test_a_text_is_set_from_the_command_line() -> None:
    world = World()
    world.spawn(Note("before"), name="here")
    assign(world, ["here.Note.text=2 kg = mass"])
    assert world.component(world.entity("here"), Note).text == "2 kg = mass"
    with pytest.raises(SceneError, match=r'entity "here": Note\.text = .*: must be a text'):
        assign(world, [f"here.Note.text={'x' * 401}"])


# ---- history -----------------------------------------------------------------------------------------------


def test_undo_and_seek_bring_a_text_back() -> None:
    history = History(World())
    (entity,) = history.do(Spawn([Note("one")]))
    history.do(SetField(entity, "Note", "text", "two\nlines"))
    assert history.entries[-1].words == f"text of note {entity}: two lines"
    history.step(0.01, steps=3)
    for words in ("ran 0.03 s", f"text of note {entity}: two lines"):
        assert history.undo() == words
    assert history.world.component(entity, Note).text == "one"
    history.redo()
    assert history.world.component(entity, Note).text == "two\nlines"
    history.undo()
    history.undo()
    assert not history.world.entities()
    history.redo()
    assert history.world.component(entity, Note).text == "one"


REPLAYED = """
import sys
from physicslab.ecs.text import code_of
from physicslab.components import Note
from physicslab.history import History
for number in range(1000):
    code_of(f"of this process {number}")
history = History.load(sys.argv[1])
first, last = history.steps_range
seen = []
for step in (0, last, 0, last):
    history.seek(step)
    seen.append([history.world.component(entity, Note).text for entity in history.world.entities()])
    seen.append(history.difference)
print(ascii(seen))
"""


def test_a_recording_holds_its_texts_in_another_process(tmp_path: Path) -> None:
    history = History(World())
    (entity,) = history.do(Spawn([Note("caf\u00e9"), Transform()]))
    history.step(0.01, steps=3)
    history.do(SetField(entity, "Note", "text", "a\nb"))
    history.step(0.01, steps=3)
    history.save(tmp_path / "run.json")
    command = [sys.executable, "-c", REPLAYED, str(tmp_path / "run.json")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ascii([["caf\u00e9"], None, ["a\nb"], None] * 2)


def test_a_saved_scene_holds_its_texts(tmp_path: Path) -> None:
    world = World()
    world.spawn(Note("\u2220 = 30\u00b0\n\u0430\u0431\u0432"), name="here")
    save_scene(world, tmp_path / "notes.json")
    again = load_scene(tmp_path / "notes.json")
    assert again.component(again.entity("here"), Note).text == "\u2220 = 30\u00b0\n\u0430\u0431\u0432"


# ---- the inspector -----------------------------------------------------------------------------------------


def _inspected(text: str) -> tuple[Desk, Any]:
    world = empty_world()
    entity = world.spawn(Note(text), Transform())
    desk = Desk(world)
    desk.frames(SETTLED)
    desk.window.pace.paused = True
    desk.window.selection.entities = (entity,)
    desk.frames(SETTLED)
    return desk, lambda: desk.world.component(entity, Note).text


def _write_over(desk: Desk, text: str, end: str) -> None:
    click(desk, "Note.text")
    tap(desk, "a", pygame.KMOD_CTRL)
    write(desk, text)
    tap(desk, end)


def test_ctrl_enter_begins_another_line() -> None:
    desk, text = _inspected("")
    click(desk, "Note.text")
    write(desk, "one")
    tap(desk, "return", pygame.KMOD_CTRL)
    write(desk, "two")
    tap(desk, "return")
    assert text() == "one\ntwo"


def test_the_inspector_shows_a_text_and_changes_it_once() -> None:
    desk, text = _inspected("before")
    assert "before" in desk.ui.words
    _write_over(desk, "behind it", "return")
    assert text() == "behind it"
    desk.window.edits.history.undo()
    assert text() == "before"


def test_escape_restores_the_text() -> None:
    desk, text = _inspected("before")
    _write_over(desk, "behind it", "escape")
    assert text() == "before"


def test_a_text_too_long_is_refused_at_its_field() -> None:
    desk, text = _inspected("before")
    click(desk, "Note.text")
    pygame.event.post(pygame.Event(pygame.TEXTINPUT, text="x" * 401))
    desk.frames(2)
    tap(desk, "return")
    assert text() == "before"
    assert any(words.startswith("must be a text of at most 8 lines") for words in desk.ui.words)
