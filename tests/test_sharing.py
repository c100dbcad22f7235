"""Pages of a scene from the window: chosen, made in a process of their own, given up, never lost."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, bits, click, fill, tap

from physicslab.commands import export, progress
from physicslab.commands.variations import variations
from physicslab.components import Colour, Graph, GraphLine, Mass, Note, Shape, Slider, Transform, Velocity
from physicslab.files.scene import load_scene
from physicslab.history import AddComponent, SetField, Spawn
from physicslab.history.commands import SetText
from physicslab.view.controls import share_actions
from physicslab.view.controls.lesson_actions import open_lesson
from physicslab.view.window.sharing import FROM_EDIT, FROM_START, WHOLE_LESSON, Sharing

# Takes the place of the command: writes what it is given, or waits for ever, or fails.
_WRITES = """
import pathlib, sys
given = sys.argv[1:]
assert given[0] == "export" or given[0].endswith("scene.json"), given
if "wait" in pathlib.Path(given[0]).name or "--wait" in given:
    import time; time.sleep(600)
pathlib.Path(given[given.index("--html") + 1]).write_text(" ".join(given[1:]))
"""


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    monkeypatch.chdir(tmp_path)
    desk = Desk(load_scene("drop"))
    desk.window.sharing = Sharing((sys.executable, "-c", _WRITES))
    desk.window.pace.paused = True
    desk.frames(SETTLED)
    yield desk
    desk.window.sharing.stop()


def wait(desk: Desk) -> None:
    """Wait for the page's process, which may have ended within the frames of the click already."""
    process = desk.window.sharing._process
    if process is not None:
        process.wait(60)
    desk.frames(SETTLED)
    assert not desk.window.sharing.running


def test_a_page_is_made_of_the_scene_with_the_sliders_that_were_chosen(desk: Desk, tmp_path: Path) -> None:
    before = bits(desk.world)
    tap(desk, "f8")
    assert desk.window.sharing.naming.text == "drop-1.html"
    fill(desk, "Seconds of the page", "3")
    desk.window.sharing.slid[0].path = "ball.Velocity.linear.x"
    desk.frames(SETTLED)
    click(desk, "Make the page")
    wait(desk)
    written = (tmp_path / "drop-1.html").read_text()
    assert "--seconds 103 " in written or "--seconds 3 " in written
    assert "--vary ball.Velocity.linear.x=1:5:9 --progress --html" in written
    assert "Saved" in desk.window.notice and bits(desk.world) == before


def test_it_is_said_how_far_the_only_run_of_a_page_is(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It stayed at 0 % up to the end."""
    monkeypatch.setattr(progress, "_DELAY_S", 0.0)
    monkeypatch.setattr(progress, "_INTERVAL_S", 0.0)
    task = {"scene": "drop", "set": [], "seconds": 1.0, "every": 0.1, "at_most": None}
    task["is_one_of_many"] = False
    for is_read in (True, False):
        export.make_run(json.dumps(task | {"progress": is_read}))
        shares = {int(share) for share in re.findall(r"drop: (\d+) %", capsys.readouterr().err)}
        assert len(shares) > 5 if is_read else not shares


def test_a_process_says_how_long_it_has_been_until_it_says_how_far_it_is(tmp_path: Path) -> None:
    waits = "import sys, time; time.sleep(.5); print('a: 7 %', file=sys.stderr, flush=True); time.sleep(60)"
    sharing = Sharing((sys.executable, "-c", waits))
    sharing.make(lambda scene: scene.write_text(""), tmp_path / "page.html")
    assert re.fullmatch(r"Starting, \d+ s", sharing.progress)
    while not sharing.share:
        assert sharing.ended() is None
    assert sharing.progress == "7%"
    sharing.stop()


def test_of_a_lesson_the_whole_lesson_is_offered_first(desk: Desk, tmp_path: Path) -> None:
    desk.window.sharing = Sharing()
    open_lesson(desk.world, desk.window, "incline")
    desk.frames(SETTLED)
    tap(desk, "f8")
    assert desk.window.sharing.naming.text == "incline-1.html"
    assert "Page begins: The whole lesson" in desk.ui.words or "The whole lesson" in desk.ui.words
    assert "Seconds of the page" not in desk.ui.places
    click(desk, "Make the page")
    process = desk.window.sharing._process
    assert process is not None and process.wait(600) == 0
    desk.frames(SETTLED)
    page = (tmp_path / "incline-1.html").read_text("utf-8")
    assert '<article id="lesson">' in page
    assert "Saved" in desk.window.notice and desk.window.lesson is not None


def test_without_a_lesson_a_page_has_a_run(desk: Desk) -> None:
    desk.window.sharing.begins = WHOLE_LESSON
    tap(desk, "f8")
    assert desk.window.sharing.begins == FROM_START and "Seconds of the page" in desk.ui.places


def test_what_was_built_after_the_start_is_in_a_page_and_there_after_a_restart(desk: Desk) -> None:
    desk.window.scenes.source = None
    history = desk.window.edits.history
    history.step(steps=20)
    desk.window.edits.do(Spawn([Transform((1.0, 2.0)), Velocity(), Mass(1.0)], name="late"))
    history.step(steps=10)
    desk.window.edits.do(Spawn([Note("seen")]))  # moves nothing
    tap(desk, "f8")
    assert desk.window.sharing.begins == FROM_EDIT
    with share_actions.gone_back(desk.window, FROM_EDIT):
        assert history.step_count == 20 and desk.world.entity("late")
    assert history.step_count == 30
    tap(desk, "escape")
    steps = []
    for _ in range(2):
        tap(desk, "r", pygame.KMOD_LCTRL)
        steps.append(history.step_count)
    assert steps == [20, 0]
    desk.window.sharing.choosing = True
    desk.frames(SETTLED)
    assert desk.window.sharing.begins == FROM_START, "where nothing was edited before"


def test_esc_gives_a_page_up_and_leaves_nothing(desk: Desk, tmp_path: Path) -> None:
    desk.window.sharing = Sharing((sys.executable, "-c", _WRITES.replace('"wait" in', "True or ")))
    tap(desk, "f8")
    click(desk, "Make the page")
    begun = desk.window.sharing.running and "Give it up" in desk.ui.places
    tap(desk, "escape")
    assert (begun, desk.window.sharing.running) == (True, False)
    assert not desk.window.closing and not list(tmp_path.iterdir())


def test_why_there_is_no_page_is_said_at_the_field(desk: Desk, tmp_path: Path) -> None:
    desk.window.sharing = Sharing((sys.executable, "-c", "import sys; sys.exit('physicslab: --vary: no')"))
    tap(desk, "f8")
    click(desk, "Make the page")
    wait(desk)
    assert desk.window.sharing.choosing and desk.window.sharing.naming.refused == "--vary: no"
    assert any("--vary: no" in words for words in desk.ui.words) and not list(tmp_path.iterdir())


@pytest.mark.parametrize("field", ["name", "seconds", "folder", "there"])
def test_what_cannot_be_made_is_refused_at_once(field: str, desk: Desk, tmp_path: Path) -> None:
    sharing = desk.window.sharing
    share_actions.toggle_sharing(desk.world, desk.window)
    (tmp_path / "there.html").write_text("mine")
    sharing.naming.text = {"name": " ", "folder": "none/x", "there": "there"}.get(field, "x")
    sharing.seconds = "0" if field == "seconds" else "2"
    share_actions.begin_sharing(desk.world, desk.window)
    assert sharing.naming.refused and not sharing.running and sharing.choosing
    assert (sharing.naming.replaces is not None) == (field == "there")
    assert (tmp_path / "there.html").read_text() == "mine"
    if field == "there":
        desk.frames(SETTLED)
        click(desk, "Replace it")
        wait(desk)
        assert "--seconds 2" in (tmp_path / "there.html").read_text()


def test_what_values_of_a_slider_cannot_be_is_said_beside_them(desk: Desk, tmp_path: Path) -> None:
    """And those that are offered can all be held."""
    tap(desk, "f8")
    first, second = desk.window.sharing.slid
    share_actions.choose_slid(desk.world, desk.window, first, "ball.Material.restitution")
    share_actions.choose_slid(desk.world, desk.window, second, "ball.Velocity.linear.x")
    assert first.span == "0.4:1:9", "0.8 and a half more would be 1.2"
    second.span = "1"
    desk.frames(SETTLED)
    click(desk, "Make the page")
    assert second.refused.startswith("must be from : to") and not desk.window.sharing.running
    second.span, first.span = "1:3:3", "0.4:1.2:9"
    words = '--vary: entity "ball": Material.restitution = "0.4:1.2:9": 1.2: must be a number from 0 to 1'
    desk.window.sharing = Sharing((sys.executable, "-c", f"import sys; sys.exit({words!r})"))
    desk.window.sharing.slid, desk.window.sharing.choosing = [second, first], True
    desk.window.sharing.naming.text = "a.html"
    desk.frames(SETTLED)
    click(desk, "Make the page")
    wait(desk)
    assert (first.refused, second.refused) == ("1.2: must be a number from 0 to 1", "")
    assert first.refused in desk.ui.words and not desk.window.sharing.naming.refused


def test_sliders_of_the_scene_become_those_of_the_page(desk: Desk) -> None:
    ball = desk.world.entity("ball")
    desk.world.spawn(Slider("Mass.mass", ball, 1.0, 9.0))
    desk.world.spawn(Slider("gravity", low=0.0, high=20.0))
    share_actions.toggle_sharing(desk.world, desk.window)
    first, second = desk.window.sharing.slid
    gravity = "physics.gravity.y"
    assert (first.path, first.span) == ("ball.Mass.mass", "1:9:9")
    assert (second.path, second.span) == (gravity, "0:-20:9"), "downwards"
    (slid,) = variations(desk.world, [f"{gravity}={second.span}"], [])
    assert (slid.values[0], slid.values[-1]) == (0.0, -20.0), "as the export takes it"
    offered = share_actions.varying(desk.world)
    assert offered["ball.Velocity.linear.x"] == "ball: velocity x" and offered[gravity] == "gravity y"
    assert "ball.Shape.radius" in offered and "ball.Shape.width" not in offered
    assert desk.world.component(ball, Shape).kind == "circle"
    share_actions.choose_slid(desk.world, desk.window, second, "ball.Velocity.linear.x")
    assert second.span == "0.5:1.5:9", "around the 1 m/s that it has"
    share_actions.choose_slid(desk.world, desk.window, second, gravity)
    assert second.span == "-14.7:-4.91:9"


def test_a_page_from_the_start_has_the_texts_and_instruments_that_were_added_since(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A page of a scene that was running had no title, no note, no gate and no graph."""
    scene, do, world = tmp_path / "scene.json", desk.window.edits.do, desk.world
    monkeypatch.setattr(Sharing, "make", lambda _, write, path: write(scene))
    desk.window.pace.paused = False
    desk.frames(30)
    ball, bodies = world.entity("ball"), len(world.batch(Transform))
    do(SetText("title", "Two bounces"))
    (graph,) = do(Spawn([Graph()]))
    (late,) = do(Spawn([Transform((2, 2)), Velocity(), Mass(1.0), Shape.circle(0.1)], "late"))
    do(Spawn([Note("look", (1, 1))]))
    for body in (ball, late):
        do(Spawn([GraphLine(graph, "y", body)]))
    do(AddComponent(ball, Colour("#ff0000")))
    do(SetField(ball, "Mass", "mass", 9.0))
    desk.window.pace.paused = True
    desk.frames(SETTLED)
    before, count = bits(world), len(world.entities())
    tap(desk, "f8")
    desk.window.sharing.begins = FROM_START
    tap(desk, "return")
    begun = load_scene(scene)
    assert (begun.title, begun.time, len(begun.batch(Transform))) == ("Two bounces", 0.0, bodies)
    assert begun.component("ball", Transform).position.y == 4.0
    assert begun.component("ball", Mass).mass == 1.0, "what it was then"
    assert begun.component("ball", Colour).colour == "#ff0000"
    assert len(begun.batch(Note)) == 1
    assert len(begun.batch(GraphLine)) == 1, "none of a body that came later"
    assert bits(world) == before and len(world.entities()) == count


@pytest.mark.slow
def test_the_page_of_the_program_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    desk = Desk(load_scene("drop"))
    desk.frames(60)
    there = bits(desk.world)
    desk.window.pace.paused = True
    tap(desk, "f8")
    desk.window.sharing.seconds = "0.5"
    click(desk, "Make the page")
    wait(desk)
    page = (tmp_path / "drop-1.html").read_text()
    assert '"start":0.0' in page and "A ball on a floor" in page and bits(desk.world) == there
