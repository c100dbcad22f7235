"""The badge: how many digits of what the window shows can be relied on, found by another process."""

import json
import sys
import time
from pathlib import Path
from typing import Any

import pygame
import pytest
from desk import SETTLED, Desk, choose, click, empty_world, sized, tap

from physicslab.components import Transform, Velocity
from physicslab.files.scene import load_scene
from physicslab.history import SetField
from physicslab.lab.accuracy.trust import assess, moments_of
from physicslab.lab.jobs import result_of
from physicslab.prefabs import circle, pendulum
from physicslab.view.window import trust_watch
from physicslab.view.window.trust_watch import BODIES_LIMIT, TrustWatch
from physicslab.view.workbench.trust_badge import BADGE

PROGRAM = """
import json, pathlib, sys, time
scene, trust, _, seconds, progress, option, report = sys.argv[1:]
assert (trust, progress, option) == ("--trust", "--progress", "--json")
scene, seconds, report = json.loads(pathlib.Path(scene).read_text()), float(seconds), pathlib.Path(report)
place = pathlib.Path(__file__).parent
with (place / "runs.txt").open("a") as runs:
    print(json.dumps([scene.get("time", 0.0), seconds, scene["physics"].get("gravity")]), file=runs)
bodies = [entity for entity in scene["entities"] if "Velocity" in entity]
def write(horizon=None, digits=lambda share: 12.5 - 6.0 * share, failure=""):
    looks = [dict(seconds=seconds * n / 10, digits=digits(n / 10), energy=13.2, momentum=0.4,
                  bodies=[digits(n / 10) + k for k in range(len(bodies))],
                  velocities=[3.5 + k for k in range(len(bodies))], angles=[14.5] * len(bodies),
                  spins=[2.5] * len(bodies), angular_momentum=1.4) for n in range(1, 11)]
    report.write_text(json.dumps({{"scenes": [dict(looks=looks, horizon_s=horizon, failure=failure)]}}))
{deed}
"""


def lab(tmp_path: Path, deed: str) -> TrustWatch:
    """Return a watch whose laboratory is a program of the test."""
    program = tmp_path / "lab.py"
    program.write_text(PROGRAM.format(deed=deed))
    return TrustWatch((sys.executable, str(program)))


def runs(tmp_path: Path) -> list[Any]:
    """Return of each run when its scene began, for how long it was run, and gravity."""
    path = tmp_path / "runs.txt"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def watched(tmp_path: Path, deed: str = "write()", *, bodies: int = 1) -> Desk:
    """Return a desk with a pendulum and more, whose digits are checked."""
    world = empty_world(gravity=(0.0, -9.81))
    pendulum(world, (0, 0))
    for n in range(1, bodies):
        circle(world, (3.0 * n, 0.0), radius=0.1)
    desk = Desk(world)
    desk.window.trust = lab(tmp_path, deed)
    desk.sandbox.frame(0.0)
    desk.window.trust.toggle()
    return desk


def until(desk: Desk, what: str) -> None:
    """Let frames go by until the badge shows some words."""
    deadline = time.monotonic() + 60.0
    while what not in desk.ui.words and time.monotonic() < deadline:
        time.sleep(0.01)
        desk.frames(2)
    assert what in desk.ui.words


def test_nothing_is_checked_before_it_is_wanted_and_a_line_of_the_badge_wants_it(tmp_path: Path) -> None:
    world = empty_world(gravity=(0.0, -9.81))
    pendulum(world, (0, 0))
    desk = Desk(world)
    desk.window.trust = lab(tmp_path, "write()")
    desk.frames(60)
    assert "Digits?" in desk.ui.words and not desk.window.trust.running and runs(tmp_path) == []
    choose(desk, BADGE, "Check digits")
    assert [desk.window.trust.wanted] == [True]
    until(desk, "11 digits")
    click(desk, BADGE)
    assert desk.ui.rows["Positions"] == "11 digits" and desk.ui.rows["Energy"] == "13 digits"
    assert desk.ui.rows["Horizon"] == "none found"
    assert [desk.ui.rows[name] for name in ("Velocities", "Angles", "Spins", "Turning")] == [
        "3 digits", "14 digits", "2 digits", "1 digit"
    ]  # fmt: skip
    click(desk, "Check digits")
    assert not desk.window.trust.wanted
    desk.frames(SETTLED)
    assert "Digits?" in desk.ui.words and "11 digits" not in desk.ui.words


def test_keys_reach_it(tmp_path: Path) -> None:
    desk = watched(tmp_path)
    desk.window.trust.toggle()
    for key in ("f10", "left", "return"):
        tap(desk, key)
    assert desk.ui.focused == "Check digits"
    tap(desk, "return")
    assert desk.window.trust.wanted


def test_how_far_it_is_is_shown_and_no_figure_before_it_has_ended(tmp_path: Path) -> None:
    words = "sys.stderr.write('\\racc: 7 %\\x1b[K\\racc: 42 %\\x1b[K'); sys.stderr.flush(); time.sleep(600)"
    desk = watched(tmp_path, words)
    desk.frames(SETTLED)
    assert "to be checked" in desk.ui.words
    until(desk, "checking 42%")
    assert not any("digit" in words and "?" not in words for words in desk.ui.words)
    desk.window.trust.stop()


def test_digits_are_those_until_now_and_are_found_for_more_as_time_goes_on(tmp_path: Path) -> None:
    desk = watched(tmp_path)
    until(desk, "11 digits")
    (first,) = runs(tmp_path)
    assert first[0] == 0.0 and 10.0 < first[1] < 15.0
    watch = desk.window.trust
    found = [watch.finding(moment) for moment in (0.1, 0.5 * first[1], first[1])]
    assert [one and round(one.digits, 3) for one in found] == [11.9, 9.5, 6.5]
    while desk.world.time < 0.7 * first[1]:
        desk.frames(6)
    assert len(runs(tmp_path)) == 1
    deadline = time.monotonic() + 60.0
    while len(runs(tmp_path)) < 2 and time.monotonic() < deadline:
        desk.frames(2)
        time.sleep(0.01)
        assert watch.finding(desk.world.time) is not None, "what was found stays meanwhile"
    second = runs(tmp_path)[1]
    assert second[0] == 0.0 and second[1] >= desk.world.time
    watch.stop()


def test_a_figure_that_does_not_reach_until_now_shows_until_when_it_does(tmp_path: Path) -> None:
    desk = watched(tmp_path)
    until(desk, "11 digits")
    watch, (bob,) = desk.window.trust, desk.world.batch(Velocity).entities.tolist()
    desk.window.selection.take(bob)
    watch._command = (sys.executable, "-c", "import time; time.sleep(600)")
    end = watch._findings[-1].until
    while desk.world.time <= end + 0.1:
        desk.frames(20)
    assert watch.running and f"6 digits until {end:.3g} s" in desk.ui.words
    assert desk.ui.rows["Position"] == f"6 digits until {end:.3g} s"
    watch.stop()


def test_an_edit_drops_what_was_found_and_begins_again_from_there(tmp_path: Path) -> None:
    desk = watched(tmp_path)
    until(desk, "11 digits")
    before = len(runs(tmp_path))
    (bob,) = desk.world.batch(Velocity).entities.tolist()
    desk.window.edits.do(SetField(bob, "Mass", "mass", 2.0))
    desk.frames()
    edited = desk.world.time
    assert desk.window.trust.finding(edited) is None and not desk.window.trust.running
    desk.frames(SETTLED)
    assert "11 digits" not in desk.ui.words and "to be checked" in desk.ui.words
    until(desk, "11 digits")
    assert desk.window.trust.since == edited
    assert runs(tmp_path)[before][0] == edited, "the scene as it was after the edit, not as it is now"


def test_digits_of_a_scene_that_is_opened_count_from_its_start(tmp_path: Path) -> None:
    desk = watched(tmp_path)
    desk.frames(20)
    world = desk.window.scenes.next_world = load_scene("two_planets")
    desk.frames(20)
    assert desk.world is world and world.time > 0.0 and desk.window.trust.since == 0.0


def test_an_edit_ends_the_process_that_is_under_way(tmp_path: Path) -> None:
    desk = watched(tmp_path, "time.sleep(600)")
    until(desk, "checking 0%")
    process, place = desk.window.trust._process, desk.window.trust._place
    assert process is not None and place is not None
    tap(desk, "g")
    process.wait(10.0)
    deadline = time.monotonic() + 10.0
    while Path(place.name).exists() and time.monotonic() < deadline:
        time.sleep(0.01)
    assert not Path(place.name).exists()
    until(desk, "checking 0%")
    desk.window.trust.stop()


def test_while_a_body_is_held_nothing_is_checked(tmp_path: Path) -> None:
    desk = watched(tmp_path)
    desk.frames()
    (bob,) = desk.world.batch(Velocity).entities.tolist()
    desk.press(*desk.world.component(bob, Transform).position)
    desk.frames(90)
    assert runs(tmp_path) == [] and desk.window.hand.entity is not None
    desk.release(0.5, -1.0)
    until(desk, "11 digits")
    assert runs(tmp_path)[0][0] == desk.window.trust.since > 1.0


def test_after_the_horizon_it_is_one_of_many_futures_and_what_is_still_true_is_listed(tmp_path: Path) -> None:
    desk = watched(tmp_path, "write(horizon=2.0, digits=lambda share: 0.2)")
    until(desk, "no digit")
    until(desk, "one of many possible futures")
    assert desk.world.time > 2.0
    click(desk, BADGE)
    assert any("Still true: energy (13 digits), averages" in words for words in desk.ui.words)
    assert desk.ui.rows["Horizon"] == "t = 2 s"


def test_the_inspector_has_the_digits_of_the_selected_body_until_the_next_edit(tmp_path: Path) -> None:
    desk = watched(tmp_path, bodies=3)
    first, _, third = sorted(desk.world.batch(Velocity).entities.tolist())
    desk.window.selection.take(third)
    desk.frames(SETTLED)
    assert "good to 13 digits" not in desk.ui.rows.values()
    until(desk, "11 digits")
    desk.frames(SETTLED)
    assert desk.ui.rows["Position"] == "good to 13 digits"
    desk.window.selection.take(first)
    desk.frames(SETTLED)
    assert desk.ui.rows["Position"] == "good to 11 digits"
    assert [desk.ui.rows[name] for name in ("Velocity", "Angle", "Spin")] == [
        "good to 3 digits", "good to 14 digits", "good to 2 digits"
    ]  # fmt: skip
    desk.window.edits.do(SetField(first, "Mass", "mass", 2.0))
    desk.frames(SETTLED)
    assert "Position" not in desk.ui.rows


def test_many_bodies_are_left_out_with_the_reason(tmp_path: Path) -> None:
    desk = watched(tmp_path, bodies=BODIES_LIMIT + 1)
    desk.frames(45)
    assert "digits: left out" in desk.ui.words and runs(tmp_path) == []
    click(desk, BADGE)
    assert any(f"{BODIES_LIMIT + 1:,} bodies can move" in words for words in desk.ui.words)


def test_a_failure_is_shown_in_its_own_words_and_not_tried_again(tmp_path: Path) -> None:
    desk = watched(tmp_path, "sys.exit('physicslab: too strange')")
    until(desk, "digits: not found")
    desk.frames(90)
    assert len(runs(tmp_path)) == 1
    click(desk, BADGE)
    assert any("physicslab: too strange" in words for words in desk.ui.words)


def test_a_scene_that_fails_has_no_digits(tmp_path: Path) -> None:
    desk = watched(tmp_path, "write(failure='it diverged')")
    until(desk, "digits: not found")
    assert desk.window.trust.failure == "it diverged"


def test_what_takes_too_long_is_given_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trust_watch, "_PATIENCE_S", 0.5)
    desk = watched(tmp_path, "time.sleep(600)")
    until(desk, "digits: not found")
    assert desk.window.trust.failure == "given up after 0.5 s" and not desk.window.trust.running


@pytest.mark.parametrize("deed, shown", [
    ("write()", "11 digits"),
    ("write(horizon=0.0)", "many futures"),  # the menus leave no room for more
])  # fmt: skip
def test_it_lies_within_a_small_window_with_large_text(tmp_path: Path, deed: str, shown: str) -> None:
    desk = sized((800, 600), text_scale=1.75)
    desk.window.trust = lab(tmp_path, deed)
    pendulum(desk.world, (0, 0))
    desk.window.trust.toggle()
    until(desk, shown)
    badge, last = pygame.Rect(desk.ui.places[BADGE]), pygame.Rect(desk.ui.places["Help"])
    assert pygame.Rect(0, 0, 800, 600).contains(badge) and not badge.colliderect(last)
    click(desk, BADGE)
    opened = pygame.Rect(desk.sandbox.interface.covered[-1])
    assert pygame.Rect(0, 0, 800, 600).contains(opened) and "Positions" in desk.ui.rows


def test_the_real_laboratory_finds_the_digits_that_a_run_has() -> None:
    desk = Desk(load_scene("two_planets"))
    watch = desk.window.trust
    tap(desk, "space")
    watch.toggle()
    deadline = time.monotonic() + 120.0
    while not watch._findings and not watch.failure and time.monotonic() < deadline:
        desk.frames()
        time.sleep(0.02)
    assert watch.failure == "" and watch.since == 0.0
    seconds = watch._findings[-1].until
    dt = desk.world.simulation.dt
    found = result_of(assess(lambda: load_scene("two_planets"), seconds, moments_of(seconds, dt, 24)))
    assert [one.until for one in watch._findings] == [look.seconds for look in found.looks]
    assert watch._findings[-1].bodies == tuple(found.looks[-1].bodies)
