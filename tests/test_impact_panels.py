"""The table of impacts and the microscope, used as users do."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, choose, click, empty_world, middle_of, point, sized, tap

from physicslab import World
from physicslab.components import Mass, Material, Name, Rod, Shape, Transform, Velocity
from physicslab.diagnostics.collision import read_collision, resolve
from physicslab.prefabs import box, circle
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.controls.controls import CONTROLS
from physicslab.view.toolkit.paper import Paper
from physicslab.view.window.impacts import FRAMES, LIMIT, ImpactList
from physicslab.view.workbench.collision_words import AGREES, law_steps, story

SHIFT = pygame.KMOD_SHIFT


def bouncing() -> World:
    """Return a ball that bounces on a floor, and one beside it that does so later."""
    world = empty_world()
    world.spawn(Name("floor"), Transform((0.0, -1.5)), Shape.box(8.0, 0.5), Material(0.9, 0.3))
    for name, x, y in (("ball", -1.0, 0.0), ("late", 1.0, 1.0)):
        world.spawn(
            Name(name),
            Transform((x, y)),
            Velocity((0.4, 0.0)),
            Mass(2.0),
            Shape.circle(0.25),
            Material(0.8, 0.3),
        )
    return world


def shown(size: tuple[int, int] = (1280, 800), text: float = 1.0) -> Desk:
    return sized(size, bouncing(), text)


def words(desk: Desk) -> str:
    return " ".join(desk.ui.words)


# ---- the table ---------------------------------------------------------------------------------------------


def test_the_table_has_the_impacts_from_before_it_was_opened_but_for_those_taken_back() -> None:
    desk = shown()
    tap(desk, "z")
    assert "There was no impact so far" in words(desk) and "0 impacts" in words(desk)
    tap(desk, "z")
    desk.frames(150)
    known = desk.world.contacts.impacts
    assert len(known) >= 2
    desk.window.pace.paused = True
    tap(desk, "z")
    records = desk.window.impacts.records
    assert records["time"].tolist() == known["time"].tolist()
    assert f"{len(records)} impacts" in words(desk) and "Impact 1" in desk.ui.places
    cells = {f"{known['friction'][0]:.4g}", f"{known['restitution'][0]:.4g}"}
    assert cells <= set(desk.ui.words), "mu and e of the pair"


def test_a_click_on_a_heading_sorts_and_a_second_one_turns_the_order_round() -> None:
    desk = shown()
    tap(desk, "z")
    desk.frames(200)
    desk.window.pace.paused = True
    desk.frames(4)
    impacts = desk.window.impacts
    click(desk, "Sort by normal")
    first = impacts.records["normal_impulse"][impacts.order(())]
    assert impacts.sorted_by == "normal_impulse" and (np.diff(first) <= 0.0).all() and len(first) > 3
    click(desk, "Sort by normal")
    assert (np.diff(impacts.records["normal_impulse"][impacts.order(())]) >= 0.0).all()


def test_the_table_shows_impacts_of_what_is_selected_alone() -> None:
    desk = shown()
    tap(desk, "z")
    desk.frames(200)
    late = desk.world.entity("late")
    desk.window.selection.take(late)
    click(desk, "Only the selection")
    rows = desk.window.impacts.records[desk.window.impacts.order((late,))]
    assert len(rows) and (rows["entity_b"] == late).all()
    desk.window.selection.take(desk.world.entity("floor"))
    desk.frames(30)
    assert len(desk.window.impacts.order(desk.window.selection.entities)) == len(desk.window.impacts.records)


def test_a_row_opens_the_microscope_at_its_moment() -> None:
    desk = shown()
    tap(desk, "z")
    desk.frames(200)
    time = float(desk.window.impacts.records["time"][0])
    click(desk, "Impact 1")
    assert desk.window.microscope.is_open and desk.window.pace.paused
    assert desk.window.microscope.collision.time == time
    assert time <= desk.world.time < time + 1.0 / 60.0 + 1e-9
    assert "ball" in words(desk) and "Collision microscope" in words(desk)


def test_what_is_run_again_is_listed_once_and_what_was_undone_no_longer() -> None:
    desk = shown()
    tap(desk, "z")
    desk.frames(200)
    before = desk.window.impacts.records.copy()
    history = desk.window.edits.history
    desk.window.pace.paused = True  # the next impact is true, and soon
    history.seek(10)
    desk.frames(4)
    assert len(desk.window.impacts.records) == len(before)
    history.seek(history.steps_range[1])
    desk.frames(4)
    assert sorted(desk.window.impacts.records["time"].tolist()) == sorted(before["time"].tolist())
    history.undo()
    desk.frames(4)
    assert len(desk.window.impacts.records) == 0


def test_a_table_that_is_opened_in_the_past_has_all_impacts_of_the_line() -> None:
    desk = shown()
    desk.frames(200)
    known = desk.world.contacts.impacts
    desk.window.edits.history.seek(40)
    desk.window.pace.paused = True
    tap(desk, "z")
    for _ in range(100):  # the line is run again in pieces, by the time that a frame leaves
        desk.frames(3)
        if len(desk.window.impacts.records) == len(known):
            break
    assert desk.window.impacts.records["time"].tolist() == known["time"].tolist()
    assert known["time"].max() > desk.world.time


def test_the_table_is_saved_with_the_columns_of_the_ledger(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    desk = shown()
    tap(desk, "z")
    desk.frames(150)
    count = len(desk.window.impacts.records)
    click(desk, "CSV of impacts")
    (path,) = tmp_path.glob("*impacts*.csv")
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("time [s],A,B,") and "restitution found" in lines[0]
    assert len(lines) >= count + 1
    assert ",floor,ball," in lines[1]


def test_a_hundred_thousand_rows_are_scrolled_through_and_sorted() -> None:
    desk = shown()
    tap(desk, "z")
    desk.frames(120)
    impacts = desk.window.impacts
    few = impacts.records.copy()
    many = np.tile(few, LIMIT // len(few) + 1)[:LIMIT]
    many["time"] = np.linspace(0.0, desk.world.time, LIMIT)
    many["energy_lost"] = np.random.default_rng(1).random(LIMIT)
    desk.window.pace.paused = True
    impacts._put(many)
    desk.frames(4)
    seen = [label for label in desk.ui.places if label.startswith("Impact ") and label != "Impacts"]
    assert 5 <= len(seen) < 60  # those in sight alone are built
    click(desk, "Sort by energy lost")
    assert (np.diff(impacts.records["energy_lost"][impacts.order(())]) <= 0.0).all()
    place = middle_of(desk, "Impact 3")
    point(desk, place)
    for _ in range(3):
        pygame.event.post(pygame.Event(pygame.MOUSEWHEEL, x=0, y=-5, precise_x=0.0, precise_y=-5.0))
        desk.frames(4)
    assert "Impact 3" not in desk.ui.places
    assert any(int(label.split()[1]) > 12 for label in desk.ui.places if label.startswith("Impact "))


def test_new_rows_are_put_into_the_order_that_there_is() -> None:
    table = np.dtype([("time", float), ("entity_a", int), ("entity_b", int), ("normal_impulse", float)])
    impacts, random = ImpactList(), np.random.default_rng(3)
    impacts.sorted_by = "normal_impulse"
    for start in range(0, 60, 20):
        new = np.zeros(20, table)
        new["time"] = start + np.arange(20.0) + 1.0
        new["normal_impulse"] = random.integers(0, 9, 20)
        if start:
            impacts._append(new)
        else:
            impacts._put(new)
        order = impacts.order(())
        assert order.tolist() == np.argsort(impacts.records["normal_impulse"], kind="stable").tolist()


# ---- the microscope ----------------------------------------------------------------------------------------


def looking(desk: Desk) -> Any:
    """Let time run until something is struck; return what the microscope then shows."""
    desk.window.microscope.waits_for = ()
    desk.frames(200)
    assert desk.window.microscope.is_open
    return desk.window.microscope


@pytest.mark.parametrize("way", [(2.0, 0.0), (0.0, 2.0), (1.5, 1.2)], ids=["level", "upright", "aslant"])
def test_words_of_its_drawings_lie_on_no_arrow_and_on_no_other_word(
    way: tuple[float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[Paper] = []
    write = Paper.write

    def note(sketch: Paper) -> None:
        write(sketch)
        drawn.append(sketch)

    monkeypatch.setattr(Paper, "write", note)
    world = empty_world(gravity=(0, 0))
    for name, at, speed, mass in (("A", 0.0, 1.0, 1.0), ("B", 1.0, 0.0, 2.0)):
        velocity = (speed * way[0], speed * way[1])
        place = (at * way[0], at * way[1] + 0.1 * at)
        world.spawn(
            Name(name),
            Transform(place),
            Velocity(velocity),
            Mass(mass),
            Shape.circle(0.3),
            Material(0.3, 0.3),
        )
    desk = sized((1280, 720), world)
    looking(desk)
    for desk.window.text_scale in (1.0, 1.5):
        desk.frames(SETTLED)
        drawn.clear()
        tap(desk, "f")  # panels are built again
        assert any(sketch.arrows for sketch in drawn)
        for sketch in drawn:
            for n, rect in enumerate(map(pygame.FRect, sketch.taken)):
                wide = rect.inflate(desk.ui.size - 1.0, 0.0)  # "B" beside "vA" was read as one word
                assert not any(wide.colliderect(other) for other in sketch.taken[:n])
                around = rect.inflate(10.0, 10.0)  # heads are 11 px wide
                assert not any(around.clipline(*start, *end) for start, end in sketch.arrows)
                assert not any(rect.clipline(*start, *end) for start, end in sketch.axes)


def test_time_stands_still_at_the_next_impact_of_what_is_selected() -> None:
    desk = shown()
    late = desk.world.entity("late")
    desk.window.selection.take(late)
    desk.window.pace.paused = True
    tap(desk, "z", SHIFT)
    assert (desk.window.microscope.waits_for, desk.window.pace.paused) == ((late,), False)
    desk.frames(300)
    collision = desk.window.microscope.collision
    assert (desk.window.microscope.waits_for, desk.window.pace.paused) == (None, True)
    assert late in (collision.a.entity, collision.b.entity)
    assert collision.time <= desk.world.time <= collision.time + 1.0 / 60.0
    desk.window.selection.clear()  # and once more, of anything
    tap(desk, "z", SHIFT)
    assert desk.window.microscope.waits_for == ()
    tap(desk, "z", SHIFT)
    assert desk.window.microscope.waits_for is None


def test_it_stands_still_in_the_past_as_well_at_the_impact_that_was_there() -> None:
    desk = shown()
    desk.frames(200)
    history = desk.window.edits.history
    last = history.steps_range[1]
    history.seek(5)
    desk.window.pace.paused = True
    click_control(desk, "pause at the next impact")
    desk.frames(200)
    assert desk.window.pace.paused and desk.window.microscope.is_open
    assert desk.window.microscope.collision.time <= desk.world.time
    assert history.step_count < last and history.steps_range[1] == last  # no branch was begun


def click_control(desk: Desk, does: str) -> None:
    """Choose the line of a menu that a control has."""
    control = next(control for control in CONTROLS if control.does == does)
    choose(desk, "Instruments", control.title)


def test_time_runs_slowly_through_the_impact_and_then_as_before() -> None:
    desk = shown()
    microscope = looking(desk)
    end, struck = desk.world.time, microscope.collision.time
    last = desk.window.edits.history.steps_range[1]
    click(desk, "Slowly through it")
    assert desk.window.pace.speed < 0.1 and desk.world.time < struck
    start = desk.world.time
    desk.frames(60)
    assert 0.0 < desk.world.time - start < 0.1  # in a second
    desk.frames(600)
    assert desk.window.pace.paused and desk.window.pace.speed == 1.0
    assert desk.world.time == pytest.approx(max(end, struck + 0.12), abs=0.02)
    assert desk.window.edits.history.steps_range[1] >= last  # what was run is what was shown


def test_undo_ends_what_runs_slowly() -> None:
    desk = shown()
    looking(desk)
    click(desk, "Slowly through it")
    tap(desk, "z", pygame.KMOD_CTRL)
    desk.frames(2)
    assert desk.window.pace.paused and desk.window.pace.speed == 1.0
    assert desk.window.microscope.slow is None


def test_a_click_on_an_impact_in_the_picture_opens_it_and_does_nothing_else() -> None:
    desk = shown()
    looking(desk)
    record: Any = desk.window.microscope.record
    place = float(record["x"]), float(record["y"])
    desk.window.microscope.close()
    desk.frames(4)
    bodies = len(desk.world.entities())
    desk.press(*place)
    desk.frames(2)
    desk.release(*place)
    desk.frames(4)
    assert desk.window.microscope.is_open and desk.window.microscope.collision.time == record["time"]
    assert len(desk.world.entities()) == bodies


def test_a_click_on_a_moving_body_is_for_the_body() -> None:
    desk = shown()
    looking(desk)
    place = desk.world.component(desk.world.entity("ball"), Transform).position
    desk.window.microscope.close()
    desk.window.pace.paused = False
    desk.window.tool = "select"
    desk.press(place.x, place.y - 0.23)
    desk.frames(1)
    assert not desk.window.microscope.is_open
    desk.release(place.x, place.y)


def test_earlier_and_later_go_from_impact_to_impact() -> None:
    desk = shown()
    tap(desk, "z")
    desk.frames(300)
    times = np.unique(desk.window.impacts.records["time"])
    assert len(times) >= 3
    click(desk, "Impact 1")
    click(desk, "Later")
    assert desk.window.microscope.collision.time == times[1]
    assert times[1] <= desk.world.time <= times[1] + 1.0 / 60.0
    click(desk, "Earlier")
    assert desk.window.microscope.collision.time == times[0]
    click(desk, "Earlier")
    assert desk.window.microscope.collision.time == times[0]
    assert "No earlier impact" in desk.window.notice


def test_the_formula_is_one_click_away_and_open_for_engineers() -> None:
    desk = shown((1280, 1400))
    looking(desk)
    assert "1/m_n = " not in words(desk)
    desk.window.microscope.shows_more = True
    desk.frames(4)
    click(desk, "The law with its numbers")
    assert "1/m_n = " in words(desk) and "solver agrees with the law" in words(desk)
    desk.window.microscope.shows_formula = None
    desk.window.level = "Engineer"
    desk.frames(4)
    assert "1/m_n = " in words(desk)


def test_every_figure_beside_the_solvers_is_the_same() -> None:
    desk = shown()
    microscope = looking(desk)
    steps = law_steps(microscope.collision, microscope.result)
    assert max(step.difference for step in steps) < AGREES
    compared = [step for step in steps if step.solver]
    assert len(compared) >= 4  # both impulses, and the motion of B
    assert all(step.value.split("= ")[-1] == step.solver for step in compared)
    for step in steps:
        assert step.value.split()[-1] in ("kg", "m/s", "s", "rad/s", "1/kg"), step.value


def test_what_happened_is_told_in_words() -> None:
    desk = shown()
    collision = looking(desk).collision
    told = " ".join(story(collision, desk.window.microscope.result, ("floor", "ball")))
    assert "ball (B) hit floor (A)" in told and "80.0 % of that speed" in told
    assert "same moment" not in told
    crowd = read_collision(_changed(desk.window.microscope.record, alone=0))
    assert "same moment" in " ".join(story(crowd, desk.window.microscope.result, ("floor", "ball")))


def test_momentum_that_a_joint_takes_is_told_and_that_of_free_bodies_is_kept() -> None:
    for held in (True, False):
        world = empty_world(gravity=(0, 0))
        bob = world.spawn(Transform((0, 0)), Velocity(), Mass(1.0), Shape.circle(0.2), Material(0.5, 0.0))
        world.spawn(Transform((-1, 0)), Velocity((2, 0)), Mass(1.0), Shape.circle(0.2), Material(0.5, 0.0))
        if held:
            world.spawn(Rod(b=bob, anchor_a=(1.0, 1.0)))
        desk = sized((1280, 800), world)
        looking(desk)
        desk.frames(3)
        assert desk.ui.rows["Momentum before"] == "(2.000, 0) kg m/s"
        assert (desk.ui.rows["Momentum after"] == "(2.000, 0) kg m/s") is not held
        assert ("From joints and others" in desk.ui.rows) is held


def _changed(record: Any, **fields: Any) -> Any:
    made = record.copy()
    for name, value in fields.items():
        made[name] = value
    return made


@pytest.mark.parametrize("frame", FRAMES)
def test_each_observer_finds_the_same_loss(frame: str) -> None:
    desk = shown()
    microscope = looking(desk)
    lost = desk.ui.rows["Lost in the bounce"]
    microscope.shows_more = True
    desk.frames(4)
    click(desk, f"Seen by: {frame}")
    assert microscope.frame == frame
    assert desk.ui.rows["Lost in the bounce"] == lost
    if frame == "B":
        assert "B before 0 m/s" in words(desk)


@pytest.mark.parametrize(("size", "text"), [((1280, 800), 1.0), ((800, 600), 1.75), ((640, 480), 1.0)])
def test_it_fits_into_the_window_and_all_of_it_can_be_reached(size: tuple[int, int], text: float) -> None:
    desk = shown(size, text)
    looking(desk)
    for label in ("Earlier", "Slowly through it", "Pause at the next impact"):
        left, top, width, height = desk.ui.places[label]
        assert left >= 0 and top >= 0 and left + width <= size[0] and top + height <= size[1], label


def test_escape_closes_the_microscope_and_then_the_table() -> None:
    desk = shown()
    tap(desk, "z")
    looking(desk)
    tap(desk, "escape")
    assert not desk.window.microscope.is_open and desk.window.impacts.shown
    tap(desk, "escape")
    assert not desk.window.impacts.shown


def test_another_scene_closes_the_microscope() -> None:
    desk = shown()
    looking(desk)
    desk.window.scenes.next_world = bouncing()
    desk.frames(4)
    assert not desk.window.microscope.is_open


def test_slow_motion_in_the_past_shows_each_step_for_several_frames() -> None:
    """The past was played at full speed, however slowly time was to run."""
    desk = shown()
    desk.frames(120)
    last = desk.window.edits.history.steps_range[1]
    desk.window.edits.history.seek(20)
    desk.window.pace.choose(0.25)
    start = desk.world.time
    desk.frames(40)
    assert desk.world.time - start == pytest.approx(10.0 / 60.0, abs=1.01 / 60.0)
    assert desk.window.edits.history.steps_range[1] == last


def test_the_picture_of_the_microscope_has_both_bodies() -> None:
    desk = sized((1280, 800), bouncing())
    looking(desk)
    assert isinstance(desk.window.canvas, PygameCanvas)
    desk.window.microscope.shows_more = True
    desk.frames(4)
    for label in ("vB", "vB'", "pB", "pB'", "J", "n", "t"):
        assert label in desk.ui.words, label


def test_a_resting_pair_that_an_impact_goes_through_has_no_share_of_its_speed() -> None:
    world = empty_world()
    world.simulation = dataclasses.replace(world.simulation, contacts="rigid")
    box(world, (0, -0.5), width=8, height=1, static=True, restitution=0.5)
    for place in range(3):
        box(world, (0.02 * place, 0.2 + 0.4 * place), width=0.8, height=0.4, restitution=0.0, friction=0.4)
    circle(world, (0.1, 2.0), radius=0.2, velocity=(0.0, -3.0), restitution=0.0)
    world.contacts.read = True
    while not world.collisions:
        world.step()
    records = world.contacts.impacts
    assert len(records) == 4  # the ball on the top, and the three contacts below
    for record in records:
        collision = read_collision(record)
        told = story(collision, resolve(collision), ("below", "above"))
        rested = record["normal_y"] * (record["before_by"] - record["before_ay"]) > -1e-6
        assert ("touched, and an impact of others went through" in told[0]) == rested
        assert told[1] == "They do not bounce (e = 0)."
