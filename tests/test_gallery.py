"""The gallery: one's own scenes first, found by words and tags, with pictures at a telling moment."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, click, empty_world, sized, tap, write
from imgui_bundle import imgui

from physicslab.files.scene import load_scene, save_scene
from physicslab.lessons.catalogue import LESSONS, openings, titles
from physicslab.scenes import SCENES
from physicslab.theme import DARK
from physicslab.view.workbench import thumbnails
from physicslab.view.workbench.thumbnails import Thumbnails, tags_of


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    monkeypatch.chdir(tmp_path)
    mine = load_scene("pendulum")
    mine.title = "My clock"
    save_scene(mine, tmp_path / "clock.json")
    (tmp_path / "half.json").write_text('{"format": "physicslab-scene/1", "entities": [')
    desk = sized((1280, 900), empty_world())
    tap(desk, "l")
    desk.frames(6)
    yield desk


def cards(desk: Desk) -> list[str]:
    return [label.removeprefix("Scene: ") for label in desk.ui.places if label.startswith("Scene: ")]


@pytest.mark.parametrize("name", SCENES)
def test_the_tags_of_scenes_are_what_is_in_them(name: str) -> None:
    world = SCENES[name].build()
    world.synchronise()
    assert SCENES[name].tags == tags_of(world)


def test_ones_own_scenes_come_first_and_what_cannot_be_read_says_why(desk: Desk) -> None:
    assert set(cards(desk)[:2]) == {"My clock", "half.json"}
    assert cards(desk)[2:] == [scene.title for scene in SCENES.values()] + list(titles().values())
    assert any(words.startswith("Is not JSON") for words in desk.ui.words)


def test_each_lesson_says_what_it_is_about(desk: Desk) -> None:
    click(desk, "Tag: lesson")
    said = [one.text for one in openings().values()]
    assert len({*said}) == len(LESSONS)
    assert any(words.startswith("A ball is thrown at 12 m/s. You choose") for words in desk.ui.words)


def test_words_find_scenes_and_enter_opens_the_first(desk: Desk) -> None:
    write(desk, "CLOCK pend")
    assert cards(desk) == ["A pendulum"], "clocks are among its words; one's own is not found by its text"
    for _ in range(5):
        tap(desk, "backspace")
    assert cards(desk) == ["My clock", "A pendulum"]
    tap(desk, "return")
    assert desk.world.title == "My clock" and not desk.window.scenes.shows_gallery
    tap(desk, "l")
    assert len(cards(desk)) == len(SCENES) + len(LESSONS) + 2, "the next search begins anew"


def test_words_are_found_from_their_beginnings(desk: Desk) -> None:
    write(desk, "lock")
    assert cards(desk) == [], "not within My clock"
    for _ in range(4):
        tap(desk, "backspace")
    write(desk, "my-cl")
    assert cards(desk) == ["My clock"]


def test_scenes_are_found_in_the_language_of_the_window_by_other_words_too(desk: Desk) -> None:
    """The gallery was searched in English alone."""
    desk.window.language = "de"
    for words in ("schiefe Ebene", "reibung", "slope", "inclined", "Hänge", "haeng"):
        tap(desk, "escape")
        tap(desk, "l")
        write(desk, words)
        title = "A hanging bridge" if words.lower().startswith("h") else "Friction on a slope"
        assert title in cards(desk), words


def test_enter_that_opens_nothing_leaves_the_search_its_letters(desk: Desk) -> None:
    write(desk, "no such")
    tap(desk, "return")
    write(desk, "l")
    assert desk.window.scenes.shows_gallery and desk.sandbox.interface.toolkit.typing


def test_tags_narrow_the_cards(desk: Desk) -> None:
    click(desk, "Tag: planets")
    assert cards(desk) == [SCENES["two_planets"].title, SCENES["solar_system"].title]
    click(desk, "Tag: my own")
    assert set(cards(desk)) == {"My clock", "half.json"}
    click(desk, "Tag: all")
    assert len(cards(desk)) == len(SCENES) + len(LESSONS) + 2


def test_letters_after_a_click_on_a_tag_are_for_the_search(desk: Desk) -> None:
    click(desk, "Tag: planets")
    write(desk, "star")
    assert cards(desk) == [SCENES["solar_system"].title]


def test_arrows_go_from_the_search_to_the_cards_and_enter_opens_one(desk: Desk) -> None:
    """The first arrow left the search, and every other key was for a world that the gallery lay over."""
    for _ in range(6):
        tap(desk, "down")
        desk.frames(SETTLED)
    assert desk.ui.focused.startswith("Scene: ")
    chosen = desk.ui.focused.removeprefix("Scene: ")
    tap(desk, "return")
    desk.frames(SETTLED)
    assert desk.world.title == chosen and not desk.window.scenes.shows_gallery


def test_one_esc_closes_it(desk: Desk) -> None:
    write(desk, "r")
    tap(desk, "escape")
    assert not desk.window.scenes.shows_gallery and not desk.window.closing


def test_a_picture_is_of_the_telling_moment_and_moves_where_it_is_pointed_at(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(thumbnails, "_SHARE", 10.0)
    made, size = Thumbnails(), (120, 70)
    shown: list[pygame.Surface] = []
    for _ in range(4):
        made.begin(runs=True)
        made.known("pendulum")
        if (still := made.still("pendulum", size, DARK)) is not None:
            shown.append(still)
    assert shown and all(still is shown[0] for still in shown), "made once"
    from physicslab.view.picture.picture import picture_of

    start = picture_of(load_scene("pendulum"), size, DARK)

    def differ(one: pygame.Surface, other: pygame.Surface) -> bool:
        return bool((pygame.surfarray.array2d(one) != pygame.surfarray.array2d(other)).any())

    assert differ(shown[0], start)
    frames = []
    for _ in range(3):
        made.begin(runs=True)
        frames.append(made.moving("pendulum", size, DARK))
    first, _, last = frames
    assert first is not None and last is not None and differ(first, last)


def test_files_that_change_are_read_again(desk: Desk, tmp_path: Path) -> None:
    tap(desk, "escape")
    changed = load_scene("drop")
    changed.title = "Another"
    save_scene(changed, tmp_path / "clock.json")
    tap(desk, "l")
    desk.frames(SETTLED + 3)
    assert "Another" in cards(desk) and "My clock" not in cards(desk)


def test_beside_a_docked_graph_cards_fill_the_gallery() -> None:
    """A hint beside the search was wider than the cards: a third of the window was empty."""
    desk = sized((1280, 720), load_scene("pendulum"))
    tap(desk, "l")
    desk.frames(SETTLED)
    desk.sandbox.interface.toolkit.enter()
    wide = {window.name: window.size.x for window in imgui.get_current_context().windows}
    (cards,) = (wide[name] for name in wide if name.startswith("Scenes/cards"))
    assert cards > 0.9 * wide["Scenes"]


def test_with_large_letters_beside_graphs_there_is_room_for_cards() -> None:
    """Tags filled the gallery, and it had no card."""
    desk = sized((1280, 800), load_scene("pendulum"), text_scale=2.0)
    tap(desk, "l")
    desk.frames(SETTLED)
    desk.sandbox.interface.toolkit.enter()
    height = {window.name: window.size.y for window in imgui.get_current_context().windows}
    (cards_height,) = (height[name] for name in height if name.startswith("Scenes/cards"))
    assert cards_height > 300 and height["Scenes"] <= 800
    click(desk, "Tag")
    desk.frames(SETTLED)
    click(desk, "Tag: buoyancy")
    desk.frames(SETTLED)
    assert cards(desk) == [SCENES["floating"].title]
