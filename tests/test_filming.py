"""Films made in the window: of the time line and of what comes; a file is whole or not there."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, bits, choose, click, empty_world, tap
from films import shown_pictures
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.export.gif import GifWriter
from physicslab.prefabs import circle
from physicslab.view.controls.file_actions import begin_film, toggle_film
from physicslab.view.window.filming import ALL, BACK, FORWARD, FROM_NOW


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    """Show a ball that has moved to the right by a metre, in a second."""
    monkeypatch.chdir(tmp_path)
    world = empty_world(gravity=(0, 0))
    circle(world, (0, 0), radius=0.2, velocity=(1, 0))
    desk = Desk(world)
    desk.frames(60)
    desk.window.pace.paused = True
    desk.frames(SETTLED)
    yield desk


def middle(desk: Desk, picture: NDArray[np.uint8]) -> float:
    """Return where the ball is in a picture of a film [m]."""
    coloured = picture.max(axis=2).astype(int) - picture.min(axis=2) > 60
    left, _, width, _ = desk.window.framing.room()
    pixel = left + np.flatnonzero(coloured.any(axis=0)).mean() * width / picture.shape[1]
    return float((pixel - 640.0) / 100.0)


def wait(desk: Desk) -> None:
    """Let frames go by until the film is made."""
    for _ in range(300):
        desk.frames()
        if not desk.window.filming.running:
            return
    raise AssertionError("the film has no end")


@pytest.mark.parametrize(
    ("what", "ends"),
    [(ALL, (0.0, 1.0)), (BACK, (0.0, 0.5)), (FORWARD, (0.5, 1.0))],
    ids=["all", "back", "on"],
)
def test_a_film_of_what_was_run_shows_it_without_panels(
    what: str, ends: tuple[float, float], desk: Desk, tmp_path: Path
) -> None:
    desk.sandbox.history.seek(30)
    before = bits(desk.world)
    tap(desk, "f9")
    choose(desk, "Film of", f"Film of: {what}")
    click(desk, "Make the film")
    assert desk.window.filming.running and desk.window.filming.words.endswith("F9 cancels it")
    wait(desk)
    assert bits(desk.world) == before and desk.sandbox.history.step_count == 30
    assert "Saved" in desk.window.notice and not desk.window.notice_failed
    (made,) = tmp_path.iterdir()
    film = shown_pictures(made.read_bytes())
    assert made.name == "scene-1.gif" and film.pictures[0].shape[1] == 800
    assert len(film.pictures) == round(30 * (ends[1] - ends[0])) + 1 and set(film.delays) == {3, 4}
    places = [middle(desk, picture) for picture in film.pictures]
    assert places[0] == pytest.approx(ends[0], abs=0.03) and places[-1] == pytest.approx(ends[1], abs=0.03)
    assert np.diff(places) == pytest.approx(1 / 30, abs=0.02)


def test_what_comes_is_filmed_until_the_key_is_pressed_again(desk: Desk, tmp_path: Path) -> None:
    tap(desk, "f9")
    choose(desk, "Film of", f"Film of: {FROM_NOW}")
    click(desk, "Make the film")
    desk.frames(20)  # nothing is filmed while time stands still
    tap(desk, "space")
    start = desk.sandbox.history.step_count
    while desk.sandbox.history.step_count < start + 30:
        desk.frames()
    tap(desk, "f9")
    assert "Saved scene-1.gif" in desk.window.notice
    film = shown_pictures((tmp_path / "scene-1.gif").read_bytes())
    assert abs(len(film.pictures) - 20) <= 3
    places = [middle(desk, picture) for picture in film.pictures]
    assert places[0] == pytest.approx(1.0, abs=0.04) and np.diff(places) == pytest.approx(1 / 30, abs=0.02)


def test_slow_motion_in_the_window_is_slow_in_the_film(desk: Desk, tmp_path: Path) -> None:
    desk.window.pace.choose(0.25)
    toggle_film(desk.world, desk.window)
    desk.frames(SETTLED)
    click(desk, "Make the film")
    wait(desk)
    assert len(shown_pictures((tmp_path / "scene-1.gif").read_bytes()).pictures) == 121


def full(*_: object) -> None:
    raise OSError(28, "No space left on device")


@pytest.mark.parametrize("ending", ["f9", "moved", "full", "closed"])
def test_a_film_of_the_time_line_that_is_broken_off_leaves_no_file(
    ending: str, desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    toggle_film(desk.world, desk.window)
    desk.frames(SETTLED)
    click(desk, "Make the film")
    desk.frames(3)
    assert list(tmp_path.iterdir())
    if ending == "f9":
        tap(desk, "f9")
        assert desk.sandbox.history.step_count == 60, "as before the film"
    elif ending == "moved":
        desk.sandbox.history.seek(40)
    elif ending == "full":
        monkeypatch.setattr(GifWriter, "write", full)
    else:
        desk.window.filming.end()
    desk.frames(4)
    assert not desk.window.filming.running and list(tmp_path.iterdir()) == []
    assert desk.window.notice_failed and "\n" not in desk.window.notice
    assert ("No space left on device" in desk.window.notice) == (ending == "full")
    assert len(desk.sandbox.history.entries) == 1 and desk.sandbox.history.steps_range == (0, 60)


def test_a_film_of_what_comes_is_kept_where_another_scene_is_opened(desk: Desk, tmp_path: Path) -> None:
    desk.window.filming.what = FROM_NOW
    toggle_film(desk.world, desk.window)
    desk.frames(SETTLED)
    click(desk, "Make the film")
    desk.window.scenes.next_world = empty_world()
    desk.frames(3)
    assert not desk.window.filming.running
    assert len(shown_pictures((tmp_path / "scene-1.gif").read_bytes()).pictures) == 1


def test_what_cannot_be_filmed_is_said_at_the_field(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "taken.gif").write_text("old")
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    monkeypatch.setenv("PATH", str(tmp_path))
    toggle_film(desk.world, desk.window)
    desk.frames(SETTLED)
    for name, words in (
        ("", "A name is needed"),
        ("a.png", "The name of a film ends in .gif or .mp4"),
        ("taken.gif", "taken.gif is there already"),
        ("none/a.gif", "There is no directory"),
        ("a\0b.gif", ""),
        ("a.mp4", "An MP4 film needs ffmpeg, which is not installed: pip install 'physicslab[video]'"),
    ):
        desk.window.filming.naming.text = name
        begin_film(desk.world, desk.window)
        refused = desk.window.filming.naming.refused
        assert refused.startswith(words) and refused
        assert not desk.window.filming.running and desk.window.filming.choosing
    assert sorted(path.name for path in tmp_path.iterdir()) == ["taken.gif"]
    tap(desk, "escape")
    tap(desk, "escape")
    assert not desk.window.filming.choosing and not desk.window.closing
    for _ in range(2):  # the second while a name is written
        tap(desk, "f9")
        desk.frames(SETTLED)
    assert not desk.window.filming.choosing and desk.window.notice == "No film was begun"


def test_where_nothing_was_run_there_is_nothing_to_film(desk: Desk) -> None:
    fresh = Desk(empty_world())
    fresh.window.pace.paused = True
    toggle_film(fresh.world, fresh.window)
    fresh.frames(SETTLED)
    click(fresh, "Make the film")
    assert fresh.window.filming.naming.refused.startswith("There are no steps to film")
    assert list(Path.cwd().iterdir()) == []


def test_a_window_of_another_size_goes_on_with_the_film(desk: Desk, tmp_path: Path) -> None:
    desk.window.filming.what = FROM_NOW
    toggle_film(desk.world, desk.window)
    desk.frames(SETTLED)
    click(desk, "Make the film")
    desk.window.figures = False
    desk.window.pace.paused = False
    desk.frames(10)
    toggle_film(desk.world, desk.window)
    assert "Saved" in desk.window.notice
    assert (
        len({picture.shape for picture in shown_pictures((tmp_path / "scene-1.gif").read_bytes()).pictures})
        == 1
    )
    (body,) = desk.world.entities()
    assert desk.world.has(body, Transform)
    pygame.event.clear()
