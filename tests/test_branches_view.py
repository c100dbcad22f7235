"""What was done before the past was changed: listed, marked on the time line, gone to and back."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, bits, click, empty_world, tap

from physicslab.cli import main
from physicslab.components import Transform
from physicslab.files.scene import load_scene
from physicslab.history import SetField
from physicslab.prefabs import circle
from physicslab.view.controls import actions, saving


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    """Show a ball that was sent to the right for a second, and then to the left from 0.5 s on."""
    monkeypatch.chdir(tmp_path)
    world = empty_world(gravity=(0, 0))
    circle(world, (0, 0), radius=0.2, velocity=(1, 0))
    desk = Desk(world)
    desk.frames(60)
    actions.seek(desk.world, desk.window, 30)
    desk.window.edits.do(SetField(desk.world.entities()[0], "Velocity", "linear", (-1, 0)))
    desk.window.pace.paused = False
    desk.frames(60)
    desk.window.pace.paused = True
    desk.frames(SETTLED)
    yield desk


def x_at_the_end(desk: Desk) -> float:
    actions.seek(desk.world, desk.window, desk.sandbox.history.steps_range[1])
    (body,) = desk.world.entities()
    return float(desk.world.component(body, Transform).position.x)


def test_a_branch_is_listed_in_plain_words_and_a_click_goes_to_it_and_back(desk: Desk) -> None:
    tap(desk, "u")
    line = next(label for label in desk.ui.places if label.startswith("1. At "))
    assert line == "1. At 0.50 s: ran 0.5 s" and "Other branches" in desk.ui.words
    there, before = bits(desk.world), x_at_the_end(desk)
    click(desk, line)
    assert desk.window.pace.paused and desk.sandbox.history.step_count == 30
    assert x_at_the_end(desk) == pytest.approx(1.0) and before == pytest.approx(-0.5)
    desk.frames(SETTLED)
    back = next(label for label in desk.ui.places if label.startswith("1. At "))
    assert back.startswith("1. At 0.50 s: linear of")
    click(desk, back)
    actions.seek(desk.world, desk.window, desk.sandbox.history.steps_range[1])
    assert bits(desk.world) == there and desk.sandbox.history.difference is None


def test_a_key_goes_to_the_branch_and_back_and_says_where_none_is(desk: Desk) -> None:
    there = bits(desk.world)
    tap(desk, "b", pygame.KMOD_CTRL)
    assert x_at_the_end(desk) == pytest.approx(1.0) and "branch" in desk.window.notice
    tap(desk, "b", pygame.KMOD_CTRL)
    x_at_the_end(desk)
    assert bits(desk.world) == there
    other = Desk(empty_world())
    tap(other, "b", pygame.KMOD_CTRL)
    assert "no other branch" in other.window.notice


def test_the_time_line_has_a_mark_where_a_branch_leaves(desk: Desk) -> None:
    mark, line = pygame.Rect(desk.ui.places["Branch 1"]), pygame.Rect(desk.ui.places["Time line"])
    first, last = desk.sandbox.history.steps_range
    share = (mark.centerx - line.left) / line.width
    assert line.contains(mark.inflate(-2, 0)) and abs(share - 30 / (last - first)) < 0.02
    assert desk.window.canvas.surface.get_at(mark.center)[:3] == desk.window.theme.accent  # type: ignore[attr-defined]


def test_what_was_done_is_kept_as_a_file_that_replay_plays(
    desk: Desk, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    there = bits(desk.world)
    tap(desk, "r", pygame.KMOD_CTRL | pygame.KMOD_SHIFT)
    tap(desk, "r", pygame.KMOD_CTRL | pygame.KMOD_SHIFT)
    made = sorted(path.name for path in tmp_path.iterdir())
    assert made == ["scene-1.replay", "scene-2.replay"] and "physicslab replay" in desk.window.notice
    assert bits(desk.world) == there
    assert main(["replay", made[0]]) == 0
    assert "all bits as recorded" in capsys.readouterr().out


def test_a_recording_that_cannot_be_saved_is_a_sentence_and_nothing_is_lost(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    there, entries = bits(desk.world), desk.sandbox.history.entries
    monkeypatch.setattr("physicslab.history.recording.replace_file", full)
    actions.save_recording(desk.world, desk.window)
    assert desk.window.notice == "The recording could not be saved: No space left on device"
    assert desk.window.notice_failed and list(tmp_path.iterdir()) == []
    assert bits(desk.world) == there and desk.sandbox.history.entries == entries
    monkeypatch.setattr("physicslab.view.controls.saving.create_file", full)
    saving.save(desk.world, desk.window)
    saving.save(desk.world, desk.window)  # under the name that is offered
    assert desk.window.scenes.naming is not None
    assert desk.window.scenes.naming.refused == "The scene could not be saved: No space left on device"


@pytest.mark.parametrize("cut", [0.0, 0.3, 0.999])
def test_a_recording_cut_off_is_refused_in_one_line(
    cut: float, desk: Desk, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    actions.save_recording(desk.world, desk.window)
    whole = (tmp_path / "scene-1.replay").read_bytes()
    (tmp_path / "part.replay").write_bytes(whole[: int(cut * len(whole))])
    assert main(["replay", "part.replay"]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1 and said.err.startswith("physicslab: part.replay: ")
    before = bits(desk.world)
    pygame.event.post(pygame.Event(pygame.DROPFILE, file=str(tmp_path / "part.replay")))
    desk.frames(3)
    assert desk.window.notice.startswith("Not opened: ") and "\n" not in desk.window.notice
    assert cut == 0.0 or desk.window.notice.endswith("is a recording: physicslab replay plays it")
    assert bits(desk.world) == before
    assert load_scene("drop").name == "drop"
