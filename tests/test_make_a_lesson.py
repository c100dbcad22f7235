"""A lesson that is made of a scene: its file is a lesson, and what cannot be in one is said at its field."""

from collections.abc import Iterator
from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, choose, click, fill, tap
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import Velocity
from physicslab.files.scene import load_scene
from physicslab.languages.language import language
from physicslab.lessons.check import check_lesson
from physicslab.lessons.lesson import Explain, Run
from physicslab.lessons.live_run import LiveRun
from physicslab.lessons.reader import parse_lesson, read_lesson
from physicslab.lessons.writer import FORMS, Draft, Opened, identifier, lesson_text, name_bodies
from physicslab.prefabs import circle
from physicslab.scenes import SCENES
from physicslab.world import World

FALL = "sqrt(v0^2 + 2*gravity*(4 m - ball.y))"


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    monkeypatch.chdir(tmp_path)
    desk = Desk(load_scene("drop"))
    desk.window.pace.paused = True
    desk.frames(SETTLED)
    tap(desk, "l", pygame.KMOD_LCTRL)
    yield desk
    desk.frames()


def drop(**chosen: object) -> Draft:
    draft = Draft("Down", "en", "0.5", "ball.speed", "speed", "m/s", "How fast?", opened=[])
    for name, value in chosen.items():
        setattr(draft, name, value)
    return draft


@pytest.mark.parametrize("scene", [name for name in SCENES if name not in ("pile", "gas")])
def test_every_scene_can_be_a_lesson(scene: str) -> None:
    world = load_scene(scene)
    text = lesson_text(name_bodies(world), drop(measured="world.kinetic", unit="J"))
    lesson = parse_lesson(text, "scene.md")
    assert lesson.quantities == ("world.kinetic",)
    made = lesson.setup.world()
    assert made.entities() and made.physics.gravity == world.physics.gravity
    named, was = made.batch(Velocity), world.batch(Velocity)
    assert [made.component(e, Velocity).linear for e in named.entities.tolist()] == [
        world.component(e, Velocity).linear for e in was.entities.tolist()
    ]


def test_what_is_opened_is_a_parameter_and_the_theory_is_checked() -> None:
    opened = [Opened("ball.Velocity.linear.x", "v0", "0 m/s", "3 m/s")]
    draft = drop(theory=FALL, tolerance="1e-9", answer="Energy stays.", opened=opened)
    lesson = parse_lesson(lesson_text(name_bodies(load_scene("drop")), draft), "drop.md")
    assert lesson.setup.opened == {"v0": ("0 m/s", "3 m/s")}
    rows = list(check_lesson(lesson))
    assert [row.passed for row in rows] == [True, True] and rows[1].measured == pytest.approx(
        5.0059, abs=1e-4
    )


def test_bodies_get_names_that_formulas_can_read() -> None:
    world = World()
    for name in (None, "red ball", "m", "time"):
        circle(world, (len(world.entities()), 0), name=name)
    named = name_bodies(world)
    assert [named.label(entity) for entity in named.entities()] == ["circle_1", "red_ball", "m_2", "time_2"]
    assert identifier("red ball", {"red_ball"}) == "red_ball_2"


_WORDS = st.text(max_size=40).filter(str.strip)


@given(title=_WORDS, question=_WORDS, why=_WORDS, answer=_WORDS, form=st.sampled_from(FORMS))
def test_words_come_back_as_they_were_typed(
    title: str, question: str, why: str, answer: str, form: str
) -> None:
    """In one line, and without the characters that no line can have."""
    choices = [["up", "No."], ["down", "Yes."], ["", ""]]
    draft = drop(title=title, question=question, why=why, answer=answer, form=form, choices=choices)
    text = lesson_text(name_bodies(load_scene("drop")), draft)
    found = next(iter(parse_lesson(text, "drop.md").questions()))
    (explained,) = (part for part in parse_lesson(text, "drop.md").parts() if isinstance(part, Explain))
    assert found.form == form and found.prompt == _line(text, "question: ")
    assert explained.answer == _line(text.partition("```explain")[2], "answer: ")
    if form == "choice":
        assert [(reply.text, reply.right) for reply in found.replies] == [("down", False), ("up", True)]


def _line(text: str, key: str) -> str:
    return text.partition(key)[2].partition("\n")[0]


def test_a_teacher_makes_a_lesson_in_the_window_and_it_opens(desk: Desk, tmp_path: Path) -> None:
    choose(desk, "Opened 1", "Opened 1: ball: velocity x")
    fill(desk, "Name of 1", "v0")
    fill(desk, "Seconds of the lesson", "0.5")
    fill(desk, "theory of the lesson", FALL)
    fill(desk, "answer of the lesson", "Energy stays.")
    click(desk, "Make the lesson")
    desk.frames(SETTLED)
    assert desk.window.lesson is not None and desk.window.lesson.lesson.title == "A ball on a floor"
    assert "measured 5.006 m/s, theory 5.006 m/s" in desk.window.notice
    lesson = read_lesson(tmp_path / "drop-1.md")
    assert lesson.setup.opened["v0"] == ("0.5 m/s", "1.5 m/s")
    assert all(row.passed for row in check_lesson(lesson))


def test_what_is_proposed_lies_around_the_value_with_which_the_lesson_begins(desk: Desk) -> None:
    """Half a second later the ball is elsewhere: the range of that moment would be refused."""
    tap(desk, "l", pygame.KMOD_LCTRL)
    desk.window.pace.paused = False
    desk.frames(30)
    desk.window.pace.paused = True
    tap(desk, "l", pygame.KMOD_LCTRL)
    time = desk.world.time
    assert time > 0.3
    choose(desk, "Opened 1", "Opened 1: ball: position y")
    desk.frames(2)
    opened = desk.window.making.draft.opened[0]
    assert (opened.low, opened.high) == ("2 m", "6 m") and desk.world.time == time
    click(desk, "Make the lesson")
    desk.frames(SETTLED)
    assert desk.window.lesson is not None


def test_a_theory_that_does_not_hold_is_said_in_the_language_of_the_window(desk: Desk) -> None:
    fill(desk, "Seconds of the lesson", "0.5")
    fill(desk, "theory of the lesson", "sqrt(2*gravity*5 m)")
    click(desk, "Make the lesson")
    desk.frames(SETTLED)
    assert desk.window.notice == (
        "Saved drop-1.md: measured 5.006 m/s, theory 9.905 m/s: further apart than it says"
    )
    assert language("de").reword(desk.window.notice) == (
        "drop-1.md gespeichert: gemessen 5,006 m/s, Theorie 9,905 m/s: weiter auseinander als angegeben"
    )


@pytest.mark.parametrize(
    ("field", "text", "said"),
    [
        ("theory", "sqrt(2*gravity", "is no number"),
        ("theory", "2*speed", "'speed' is unknown"),
        ("theory", "3 kg", "m/s"),
        ("seconds", "never", "'never' is unknown"),
        ("measured", "bal.x", "must begin with one of"),
        ("unit", "stones", "stones"),
        ("question", " ", "must be a question"),
    ],
)
def test_what_cannot_be_is_said_at_its_field(
    desk: Desk, tmp_path: Path, field: str, text: str, said: str
) -> None:
    making = desk.window.making
    making.draft.theory = "gravity*time"
    setattr(making.draft, field, text)
    desk.frames(SETTLED)
    click(desk, "Make the lesson")
    assert making.choosing and any(said in words for words in desk.ui.words), making.refused
    assert desk.window.lesson is None and not list(tmp_path.iterdir())


def test_a_file_that_is_there_is_kept_until_the_user_says_so(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "drop-1.md").write_text("mine")
    desk.window.making.draft.seconds = "0.5"
    desk.frames(SETTLED)
    click(desk, "Make the lesson")
    assert desk.window.making.naming.refused == "drop-1.md is there already"
    assert (tmp_path / "drop-1.md").read_text() == "mine"
    click(desk, "Replace it")
    assert desk.window.lesson is not None and read_lesson(tmp_path / "drop-1.md").minutes == 20


def test_a_lesson_of_a_scene_that_has_run_begins_at_zero() -> None:
    world = load_scene("drop")
    world.run(seconds=0.25)
    lesson = parse_lesson(lesson_text(name_bodies(world), drop(measured="time", unit="s")), "scene.md")
    run = next(part for part in lesson.parts() if isinstance(part, Run))
    live = LiveRun(lesson.setup, run, lesson.quantities)
    live.world.step()
    while not live.sample():
        live.world.step(live.next_step)
    assert live.record.times[0] == 0.0 and live.world.time == pytest.approx(0.5, rel=1e-12)
