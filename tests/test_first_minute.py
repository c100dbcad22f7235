"""The first minute: cards that are gone once used, a tour that waits for each act, the search of commands."""

from __future__ import annotations

from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, click, empty_world, sized, tap, write

from physicslab.components import Mass, Shape, Spring, Transform, Velocity
from physicslab.desktop.preferences import load_preferences, save_preferences
from physicslab.languages.language import language
from physicslab.scenes import SCENES
from physicslab.view.controls import commands
from physicslab.view.controls.file_actions import open_from_list
from physicslab.view.controls.saving import scene_words
from physicslab.view.controls.tour import STEPS
from physicslab.view.window.tour import Tour
from physicslab.view.window.window import Window

CTRL = pygame.KMOD_CTRL
SIZE = (1280, 720)


def found(desk: Desk) -> list[str]:
    """Return what the search shows, the best first."""
    return [label.removeprefix("Found: ") for label in desk.ui.places if label.startswith("Found: ")]


def search(desk: Desk, text: str) -> list[str]:
    tap(desk, "k", CTRL)
    write(desk, text)
    desk.frames(SETTLED)
    return found(desk)


# ---- cards -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("size", "scale"), [(SIZE, 1.0), ((800, 600), 1.5), ((640, 480), 1.75)])
def test_the_cards_lie_within_the_room_of_the_world(size: tuple[int, int], scale: float) -> None:
    desk = sized(size, text_scale=scale)
    desk.window.shows_cards = True
    desk.frames(SETTLED)
    left, top, width, height = desk.sandbox.interface.layout.visible
    room = pygame.Rect(left, top, width, height)
    for label in ("Play", "Learn", "Build", "Close"):
        assert room.contains(pygame.Rect(desk.ui.places[label])), label


def test_keys_and_clicks_reach_the_world_beside_the_cards() -> None:
    desk = sized(SIZE)
    desk.window.shows_cards = True
    desk.frames(SETTLED)
    tap(desk, "space")
    assert desk.window.pace.paused
    desk.press(0.0, -1.0)
    desk.frames()
    desk.release(0.0, -1.0)
    desk.frames(SETTLED)
    assert len(desk.world.batch(Shape)) == 1 and desk.window.shows_cards


def test_each_card_opens_what_it_names() -> None:
    desk = sized(SIZE)
    for card in ("Play", "Learn", "Build"):
        desk.window.shows_cards = True
        desk.frames(SETTLED)
        click(desk, card)
        assert not desk.window.shows_cards, card
        assert desk.window.scenes.shows_gallery == (card == "Learn")
        desk.window.scenes.shows_gallery = False
    assert desk.window.scenes.source is None and desk.world.time == 0.0 and len(desk.world.batch(Shape)) == 1


def test_escape_closes_the_cards_and_the_help_brings_them_back() -> None:
    desk = sized(SIZE)
    desk.window.shows_cards = True
    desk.frames(SETTLED)
    tap(desk, "escape")
    assert not (desk.window.shows_cards or desk.window.closing)
    click(desk, "Help")
    click(desk, "First steps")
    assert desk.window.shows_cards


def test_the_cards_go_with_the_scene_that_they_are_over() -> None:
    desk = sized(SIZE)
    for starts_again in (True, False):
        desk.window.shows_cards = True
        desk.window.scenes.next_world, desk.window.scenes.starts_again = empty_world(), starts_again
        desk.frames()
        assert desk.window.shows_cards is starts_again


def test_cards_that_were_used_are_remembered(tmp_path: Path) -> None:
    desk, path = sized(SIZE), tmp_path / "preferences.json"
    for welcomed in (False, True):
        desk.window.welcomed = welcomed
        save_preferences(path, desk.window)
        again = Window(desk.window.canvas)
        load_preferences(path, again)
        assert again.welcomed is welcomed


# ---- the tour ----------------------------------------------------------------------------------------------


def shown(desk: Desk) -> str:
    desk.frames(SETTLED)
    return "" if desk.window.tour is None else STEPS[desk.window.tour.number].title


def pull(desk: Desk, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Drag with the left button from one place of the world to another [m]."""
    desk.press(*start)
    for share in (0.3, 0.7, 1.0):
        desk.move(*(a + share * (b - a) for a, b in zip(start, end, strict=True)))
        desk.frames()
    desk.release(*end)
    desk.frames(SETTLED)


def test_the_tour_goes_on_by_acts_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    world = empty_world(bounds=(-8.0, -3.0, 8.0, 5.0))
    ball = world.spawn(Transform((0.0, 2.0)), Velocity(), Mass(1.0), Shape(kind="circle", radius=0.5))
    desk = sized(SIZE, world)
    desk.frames(SETTLED)

    def place() -> tuple[float, float]:
        at = desk.world.component(ball, Transform).position
        return at.x, at.y

    def waits(title: str) -> None:
        """See that a step is shown, and that neither time nor a key of no other act ends it."""
        assert shown(desk) == title
        desk.frames(30)
        tap(desk, "t")
        tap(desk, "t")
        assert shown(desk) == title, "neither time nor another key is its act"

    tap(desk, "f1", CTRL)
    waits("Throw")
    desk.drag(place(), (2.0, 0.0), 8)
    waits("Pause")
    tap(desk, "space")
    waits("Draw")
    click(desk, "Box")
    pull(desk, (-4.0, 1.0), (-3.0, 2.0))
    assert len(desk.world.batch(Shape)) == 2
    waits("Spring")
    click(desk, "Spring")
    pull(desk, (-3.5, 1.5), (-3.5, 4.0))
    assert len(desk.world.batch(Spring)) == 1
    waits("Gravity")
    tap(desk, "g")
    waits("Microscope")
    tap(desk, "z")
    assert shown(desk) == "Microscope", "the list alone is not its act"
    click(desk, next(label for label in desk.ui.places if label.startswith("Impact ")))
    assert desk.window.microscope.is_open
    waits("Undo")
    tap(desk, "z", CTRL)
    waits("Save")
    tap(desk, "s", CTRL)
    assert shown(desk) == "Save", "a name is not a file yet"
    tap(desk, "return")
    assert shown(desk) == "" and list(tmp_path.glob("*.json"))


def test_the_tour_waits_in_another_scene_for_what_is_done_there() -> None:
    desk = sized(SIZE)
    desk.window.tour = Tour([step.title for step in STEPS].index("Gravity"))
    assert shown(desk) == "Gravity"
    click(desk, "Scenes")
    click(desk, "Two planets")
    assert desk.world.name == "two_planets" and shown(desk) == "Gravity"
    tap(desk, "escape")
    assert shown(desk) == "" and not desk.window.closing


# ---- the search --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "best"),
    [("pause", "Pause"), ("gvty", "Gravity"), ("redo", "Redo"), ("cradle", "Newton's cradle"),
     ("kinetic", "Graph: kinetic energy"), ("BALL floor", "A ball on a floor"), ("gear", "Gear")],
)  # fmt: skip
def test_a_few_letters_find_a_command(text: str, best: str) -> None:
    for code in ("en", "de"):
        assert commands.find(text, list(commands.commands()), language(code))[0].words == best


def test_another_language_is_found_by_its_own_name() -> None:
    desk = sized((1280, 720))
    tap(desk, "k", pygame.KMOD_CTRL)
    write(desk, "deutsch")
    desk.frames(SETTLED)
    tap(desk, "return")
    desk.frames(SETTLED)
    assert desk.window.language == "de" and "Datei" in desk.ui.words
    desk.window.do_next(open_from_list, source="drop")
    desk.frames(SETTLED)
    assert scene_words(desk.world, desk.window) == "Ein Ball auf dem Boden"


@pytest.mark.parametrize(
    ("text", "best"),
    [("rückgängig", "Undo"), ("ruckgangig", "Undo"), ("RUECKGAENGIG", "Undo"), ("kasten", "Box"),
     ("bewegungs", "Graph: kinetic energy"), ("löschen", "Erase"), ("loeschen", "Erase")],
)  # fmt: skip
def test_words_of_the_language_that_is_shown_find_a_command(text: str, best: str) -> None:
    every = list(commands.commands())
    assert commands.find(text, every, language("de"))[0].words == best
    assert best not in [one.words for one in commands.find(text, every, language("en"))]


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_is_found_by_its_own_name(name: str) -> None:
    """By ``drop`` the ball on a floor was not found."""
    found = commands.find(name, list(commands.commands()), language("en"))
    assert SCENES[name].title in [one.words for one in found[:3]]


@pytest.mark.parametrize(("text", "code"), [("free fall", "en"), ("freier fall", "de"), ("free fall", "de")])
def test_a_scene_is_found_by_other_words_for_what_it_shows(text: str, code: str) -> None:
    found = commands.find(text, list(commands.commands()), language(code))
    assert "A ball on a floor" in [one.words for one in found]


@pytest.mark.parametrize("text", ["collision push", "who pushes", "stößt stärker", "collision"])
def test_a_lesson_is_found_by_its_title_in_both_languages(text: str) -> None:
    """In a German window lessons had no English titles."""
    desk = sized(SIZE)
    desk.window.language = "de"
    found = commands.find(text, list(commands.commands(desk.window)), language("de"))
    assert "Wer stößt bei einem Zusammenstoß stärker?" in [one.words for one in found]


def test_a_sharp_s_is_found_by_two() -> None:
    sharp = [commands.Command("Schließen", "", "", lambda world, window: None)]
    assert all(commands.find(text, sharp, language("de")) == sharp for text in ("schliess", "schließ"))


def test_what_is_nowhere_is_not_found_and_half_input_changes_nothing() -> None:
    desk = sized(SIZE)
    before = desk.window.edits.history.position
    assert search(desk, "xqz") == [] and "Nothing is called so" in desk.ui.words
    tap(desk, "return")
    assert desk.window.is_open("search")
    tap(desk, "escape")
    assert not desk.window.is_open("search")
    assert desk.window.edits.history.position == before and not desk.window.closing


def test_arrows_mark_a_line_and_enter_does_it() -> None:
    desk = sized(SIZE)
    lines = search(desk, "pause")
    assert lines[:2] == ["Pause", "Pause at the next impact"]
    tap(desk, "down")
    assert desk.window.search is not None and desk.window.search.row == 1
    tap(desk, "up")
    tap(desk, "return")
    assert desk.window.pace.paused and desk.window.search is None


def test_a_click_opens_a_scene_that_was_found() -> None:
    desk = sized(SIZE)
    assert search(desk, "two planets")[0] == "Two planets"
    click(desk, "Found: Two planets")
    assert desk.world.name == "two_planets" and desk.window.search is None


def test_a_quantity_that_is_found_is_plotted() -> None:
    desk = sized(SIZE)
    assert search(desk, "total energy")[0] == "Graph: total energy"
    tap(desk, "return")
    (graph,) = desk.window.dashboard.graphs
    assert [line.key for line in graph.lines] == [(None, "total energy")]


def test_every_command_does_its_work_or_says_why_not() -> None:
    names = [command.words for command in commands.commands()]
    assert len(names) > 150
    assert {"Search"}.isdisjoint(names)
