"""The tools of the lab in the window: handles, time line, undo, free-body diagrams."""

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from desk import FRAME, Desk, bits, click, click_at, empty_world, fill, sized, tap, write
from imgui_bundle import imgui
from random_edits import state_hash

from physicslab.components import Held, Mass, Shape, Transform, Velocity
from physicslab.diagnostics.free_body import (
    applied_forces,
    contact_forces,
    forces_on,
    joint_forces,
    net_force,
)
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene
from physicslab.prefabs import box, circle
from physicslab.scenes import SCENES
from physicslab.view.controls import actions, file_actions, saving
from physicslab.view.picture.bodies import body_rows
from physicslab.view.picture.extent import _reach
from physicslab.view.toolkit.ui import Ui
from physicslab.world import World

CTRL = pygame.KMOD_LCTRL


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Desk:
    monkeypatch.chdir(tmp_path)
    return Desk(empty_world(gravity=(0, 0)))


def drag(desk: Desk, start: Vector2, end: Vector2) -> None:
    """Press, move in two steps, and let go, at points of the world [m]."""
    desk.press(*start)
    desk.frames()
    for share in (0.5, 1.0):
        desk.move(*(start + (end - start) * share))
        desk.frames()
    desk.release(*end)
    desk.frames()


def handle(desk: Desk, entity: int, kind: str) -> Vector2:
    every = desk.window.handles.of(desk.world, entity, desk.window.camera)
    return next(one.place for one in every if one.kind == kind)


# Handles


def paused_on(desk: Desk, entity: int) -> None:
    desk.key("space")
    desk.window.selection.take(entity)
    desk.frames()


def test_the_arrow_of_the_velocity_is_dragged_and_is_one_edit() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0), radius=0.2)
    desk = Desk(world)
    paused_on(desk, ball)
    entries = len(desk.window.edits.history.entries)
    start = handle(desk, ball, "velocity")
    drag(desk, start, start + Vector2(0.0, 1.0))
    velocity = desk.world.component(ball, Velocity).linear
    # A metre of arrow stands for 3 m/s, beyond the 22 px that a body at rest has.
    arrow = start + Vector2(0.0, 1.0)
    expected = arrow * (3.0 * (arrow.magnitude - 0.22) / arrow.magnitude)
    assert (velocity - expected).magnitude < 0.05
    assert len(desk.window.edits.history.entries) == entries + 1
    desk.key("z", CTRL)
    desk.frames()
    assert desk.world.component(ball, Velocity).linear == Vector2()


def test_handles_give_size_and_angle(desk: Desk) -> None:
    block = box(desk.world, (0, 0), width=1.0, height=0.5)
    paused_on(desk, block)
    corner = handle(desk, block, "size")
    drag(desk, corner, corner + Vector2(0.25, -0.25))
    shape = desk.world.component(block, Shape)
    assert shape.width == pytest.approx(1.5, abs=0.03) and shape.height == pytest.approx(1.0, abs=0.03)
    above = handle(desk, block, "angle")
    drag(desk, above, Vector2(-1.0, 0.0))
    assert desk.world.component(block, Transform).angle == pytest.approx(math.pi / 2.0, abs=0.02)


def test_while_time_runs_there_are_no_handles(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0), radius=0.2)
    desk.window.selection.take(ball)
    assert desk.window.handled is None


# The hand


def test_the_hand_presses_nothing_through_a_floor_and_takes_nothing_beyond_the_walls() -> None:
    world = empty_world(bounds=(-3.0, -1.0, 3.0, 3.0))
    box(world, (0, -0.5), width=6.0, height=1.0, static=True)
    lower = box(world, (0, 0.25), width=0.5, height=0.5)
    upper = box(world, (0, 0.75), width=0.5, height=0.5)
    desk = Desk(world)
    desk.frames(20)
    desk.press(0, 0.75)
    desk.frames()
    for n in range(40):
        desk.move(0, 0.75 - 0.05 * n)
        desk.frames()
    assert world.component(lower, Transform).position.y > 0.15
    assert world.component(upper, Transform).position.y > 0.15
    desk.move(5.0, 1.0)
    desk.frames(20)
    place = world.component(upper, Transform).position
    assert place.x <= 2.75 + 1e-6 and place.y > 0.15
    desk.release(5.0, 1.0)
    desk.frames(60)
    inside = [world.component(body, Transform).position for body in (lower, upper)]
    assert all(abs(place.x) < 3.0 and place.y > 0.1 for place in inside)


# What is made


def test_nothing_is_made_where_it_would_overlap_or_beyond_the_walls() -> None:
    desk = Desk(empty_world(gravity=(0, 0), bounds=(-2.0, -2.0, 2.0, 2.0)))
    box(desk.world, (0, 0), width=1.0, height=1.0, static=True)
    why = "no room here, box 1 is in the way", "beyond the walls", "beyond the walls"
    for (x, y), reason in zip(((0.55, 0.0), (2.5, 0.0), (1.95, 1.0)), why, strict=True):
        desk.press(x, y, "right")
        desk.release(x, y, "right")
        desk.frames()
        assert len(desk.world.entities()) == 1 and reason in desk.window.notice
    desk.press(1.2, 1.2)
    desk.release(1.2, 1.2)
    desk.frames()
    assert len(desk.world.entities()) == 2


# The time line


def test_undo_redo_and_the_time_line_give_the_bits_of_the_run() -> None:
    desk = Desk(load_scene("sandbox"))
    history = desk.window.edits.history
    known = {0: state_hash(desk.world)}
    for step in range(1, 41):
        desk.frames()
        known[step] = state_hash(desk.world)
    desk.press(3.0, 3.0)
    desk.release(3.0, 3.0)
    desk.frames(20)
    assert [entry.words for entry in history.entries][1] == "made circle" and history.step_count == 60
    for step in (7, 31, 2, 40):
        actions.seek(desk.world, desk.window, step)
        if step < 40:
            assert state_hash(desk.world) == known[step]
    actions.seek(desk.world, desk.window, 60)
    end = state_hash(desk.world)
    desk.key("z", CTRL)  # what was made, and the run after it
    desk.frames(2)
    assert state_hash(desk.world) == known[40]
    desk.key("y", CTRL)
    desk.frames(2)
    assert state_hash(desk.world) == end and desk.window.pace.paused


def test_time_goes_on_from_the_past_as_it_was_until_something_is_changed() -> None:
    desk = Desk(load_scene("sandbox"))
    desk.frames(30)
    end = bits(desk.world)
    actions.seek(desk.world, desk.window, 10)
    desk.key("space")
    while desk.window.edits.history.step_count < 30:
        desk.frames()
    assert bits(desk.world) == end and not desk.window.edits.history.branches
    actions.seek(desk.world, desk.window, 10)
    desk.key("g")
    desk.frames(2)
    assert len(desk.window.edits.history.branches) == 1


def test_a_body_that_was_in_the_hand_is_let_go_where_another_future_begins() -> None:
    world = empty_world(gravity=(0, -5))
    ball = circle(world, (0, 0), radius=0.2)
    desk = Desk(world)
    desk.press(0, 0)
    desk.frames(2)
    for n in range(10):
        desk.move(0.1 * n, 0)
        desk.frames()
    desk.release(0.9, 0)
    desk.frames(5)
    actions.seek(desk.world, desk.window, 6)
    assert world.has(ball, Held)
    desk.key("g")
    desk.frames(2)
    desk.key("space")
    desk.frames(3)
    assert not world.has(ball, Held)


# Free-body diagrams


def test_forces_of_a_body_at_rest_balance_and_add_up_to_nothing() -> None:
    world = load_scene("stack")
    world.run(seconds=1.0)
    for name, load in (("box 1", 9.0), ("box 10", 0.0)):
        entity = _named(world, name)
        forces = forces_on(world, entity)
        weight = next(one for one in forces if one.name == "weight")
        assert weight.force.y == pytest.approx(-9.81, rel=1e-12)
        assert net_force(forces).magnitude < 1e-6 * 9.81 * (1.0 + load)
        pushed = [one.force.y for one in forces if one.name.startswith("normal")]
        assert max(pushed) == pytest.approx(9.81 * (1.0 + load), rel=1e-6)


def _named(world: World, name: str) -> int:
    """Return the box that is so many places from the floor."""
    bodies = [e for e in world.entities() if world.has(e, Mass)]
    bodies.sort(key=lambda e: world.component(e, Transform).position.y)
    return bodies[int(name.split()[1]) - 1]


def test_a_block_that_slides_has_friction_against_its_motion() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=100.0, height=1.0, static=True, friction=0.3)
    block = box(world, (0, 0.25), width=0.5, height=0.5, mass=2.0, friction=0.3, velocity=(3.0, 0.0))
    world.run(seconds=0.2)
    forces = forces_on(world, block)
    rubbed = sum(one.force.x for one in forces if one.kind == "friction")
    assert rubbed == pytest.approx(-0.3 * 2.0 * 9.81, rel=1e-3)
    assert net_force(forces).x == pytest.approx(-0.3 * 2.0 * 9.81, rel=1e-3)


@pytest.mark.parametrize(
    "name", ["sandbox", "slope", "newtons_cradle", "spring_chain", "two_planets", "pulleys"]
)
def test_the_forces_on_all_bodies_are_those_on_each(name: str) -> None:
    world = load_scene(name)
    world.run(seconds=0.7)
    total = applied_forces(world) + joint_forces(world) + contact_forces(world)
    for entity in world.batch(Velocity, Mass).entities.tolist():
        forces = forces_on(world, entity)
        largest = max((one.force.magnitude for one in forces), default=0.0)
        row = world.entity_index.row_of[entity]
        assert total[row].tolist() == pytest.approx(list(net_force(forces)), abs=1e-9 * largest)


# The first view

LEFT = ("slope", "rocket", "droplets", "rutherford")
"""Scenes that bodies leave: blocks slide off, a rocket flies away, molecules fly off, charges pass."""


@pytest.mark.parametrize("name", [name for name in SCENES if name not in LEFT])
def test_scenes_open_framed_for_their_first_ten_seconds(name: str) -> None:
    """All that moves stays in sight."""
    world = SCENES[name].build()
    view = world.view
    assert view is not None
    moves = world.table(Velocity)
    for _ in range(20):
        world.run(seconds=0.5)
        rows = body_rows(world)
        every = rows.all
        reach = _reach(world, every)[moves.present[every]]
        assert (reach[:, :2] >= np.array(view[:2]) - 0.05).all(), world.time
        assert (reach[:, 2:] <= np.array(view[2:]) + 0.05).all(), world.time


def test_a_scene_that_is_left_alone_is_closed_at_once_and_one_that_was_edited_asks() -> None:
    desk = Desk(load_scene("drop"))
    desk.frames(10)
    desk.key("escape")
    desk.frames()
    assert desk.window.closing
    desk = Desk(load_scene("drop"))
    desk.press(0, 2)
    desk.release(0, 2)
    desk.frames(2)
    desk.key("escape")
    desk.frames(2, FRAME)
    assert not desk.window.closing and "Once more" in desk.window.notice
    desk.key("escape")
    desk.frames()
    assert desk.window.closing


# The gallery


def test_the_gallery_has_a_card_with_a_picture_for_each_scene_and_opens_it() -> None:
    desk = Desk(load_scene("sandbox"))
    desk.key("l")
    desk.frames(3)
    titles = [scene.title for scene in SCENES.values()]
    assert all(f"Scene: {title}" in desk.ui.places for title in titles)
    desk.frames(20)
    (shown,) = desk.ui.pictures.values()
    assert len(shown) >= 6
    for surface, _, _ in shown:
        assert len(np.unique(pygame.surfarray.array2d(surface))) > 3, "something is to be seen in it"
    click(desk, f"Scene: {SCENES['drop'].title}")
    desk.frames(3)
    assert desk.world.name == "drop" and not desk.window.scenes.shows_gallery
    desk.key("l")
    desk.key("escape")
    desk.frames(8)  # a key right after the one that opens a window waits for its field
    assert not desk.window.scenes.shows_gallery and not desk.window.closing


def test_a_place_that_is_taken_or_beyond_the_walls_is_refused_in_the_inspector() -> None:
    world = empty_world(gravity=(0, 0), bounds=(-3, -3, 3, 3))
    ball = circle(world, (0, 0), radius=0.5)
    circle(world, (2, 0), radius=0.5)
    desk = Desk(world)
    desk.window.selection.take(ball)
    desk.frames(2)
    for text, said in (("1.5", "overlap"), ("-2.8", "beyond the walls")):
        fill(desk, "Transform.position.x", text)
        desk.frames(3)
        assert world.component(ball, Transform).position.x == 0.0 and said in desk.window.notice
    fill(desk, "Transform.position.x", "-2")
    desk.frames(3)
    assert world.component(ball, Transform).position.x == -2.0


def test_what_was_being_written_of_a_body_goes_with_the_scene_that_is_replaced(desk: Desk) -> None:
    world = desk.world
    body = circle(world, (0.0, 0.0), radius=0.5)
    paused_on(desk, body)
    click(desk, "Mass.mass")
    write(desk, "7")
    desk.window.scenes.next_world = empty_world(gravity=(0, 0))
    desk.frames()
    desk.press(2.0, 0.0)
    desk.frames(2)
    desk.release(2.0, 0.0)
    assert not desk.window.notice_failed
    assert world.component(body, Mass).mass != 7.0


def test_a_body_that_goes_in_the_past_is_selected_no_more(desk: Desk) -> None:
    click_at(desk, desk.pixel(1.0, 1.0))
    (body,) = desk.world.batch(Mass).entities.tolist()
    desk.frames(10)
    made = desk.sandbox.history.step_count
    desk.window.selection.take(body)
    tap(desk, "delete")
    desk.frames(10)
    actions.seek(desk.world, desk.window, made - 3)
    desk.window.selection.take(body)
    desk.window.pace.paused = False
    desk.frames(20)
    assert body not in desk.world.entities()
    assert desk.window.selection.entities == ()


@pytest.mark.parametrize("field", ["Mass.mass", "Transform.position.x"])
def test_what_was_written_is_an_edit_of_the_time_at_which_it_was_written(desk: Desk, field: str) -> None:
    desk.frames(20)
    tap(desk, "space")
    click_at(desk, desk.pixel(1.0, 1.0))
    (body,) = desk.world.batch(Mass).entities.tolist()
    desk.window.selection.take(body)
    desk.frames(4)
    last = desk.sandbox.history.steps_range[1]
    click(desk, field)
    write(desk, "0.75")
    left, top, _, height = desk.ui.places["Time line"]
    click_at(desk, (left + 12, top + height // 2))
    assert desk.sandbox.history.step_count < last
    actions.seek(desk.world, desk.window, last)
    kind, name = (Mass, "mass") if field == "Mass.mass" else (Transform, "position")
    value = getattr(desk.world.component(body, kind), name)
    assert (value if kind is Mass else value.x) == 0.75


def test_a_press_in_the_world_makes_a_body_of_the_size_that_was_just_written(desk: Desk) -> None:
    desk.window.tool = "circle"
    desk.frames(4)
    click(desk, "new size")
    write(desk, "0.11")
    before = set(desk.world.entities())
    click_at(desk, desk.pixel(1.0, 1.0))
    (made,) = set(desk.world.entities()) - before
    assert desk.world.component(made, Shape).radius == 0.11


@pytest.mark.parametrize("name", [".", "/", "x" * 400, "~no-such-user/x", "folder", "a\0b"])
def test_a_name_that_no_file_can_have_is_refused(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    (tmp_path / "folder").mkdir()
    monkeypatch.chdir(tmp_path)
    saving.begin_copy(desk.world, desk.window)
    saving.save_under(desk.world, desk.window, name)
    assert desk.window.scenes.naming is not None
    assert desk.window.scenes.naming.refused
    assert list(tmp_path.iterdir()) == [tmp_path / "folder"]


def test_an_untouched_view_follows_the_room_that_text_of_another_size_leaves() -> None:
    desk = Desk(load_scene("sandbox"))
    desk.window.framing.go_home(desk.world)
    desk.frames(2)
    desk.window.text_scale = 2.0
    desk.frames(2)
    left, _, width, _ = desk.window.framing.room()
    for x, y in ((-5.8, 0.0), (5.8, 0.0)):
        assert left <= desk.pixel(x, y)[0] <= left + width


@pytest.mark.parametrize(("size", "text"), [((1280, 720), 1.0), ((800, 600), 1.5), ((640, 480), 1.75)])
@pytest.mark.parametrize("number", [-1.5e-5, -1.234567e-12, -123456.7, -0.01234567, 98765432.1])
def test_numbers_are_short_enough_for_their_fields(
    number: float, size: tuple[int, int], text: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk = sized(size, empty_world(gravity_mode="none"), text)
    mass = abs(number)
    body = circle(desk.world, (number, -number), radius=0.5, mass=mass, velocity=(number, -number))
    desk.window.level, desk.window.pace.paused = "engineer", True
    desk.window.selection.take(body)
    shown: list[str] = []
    field = Ui.field

    def watched(ui: Ui, label: str, text: str, width: float = -1.0, **options: Any) -> tuple[str, bool]:
        if width > 0.0 and re.fullmatch(r"-?[\d.]+(e-?\d+)?|≈0", text):
            shown.append(text)
            room = width - 2.0 * imgui.get_style().frame_padding.x
            assert imgui.calc_text_size(text).x <= room, f"{label}: {text}"
        return field(ui, label, text, width, **options)

    monkeypatch.setattr(Ui, "field", watched)
    desk.frames(3)
    found = [float(one.replace("≈", "")) for one in shown]
    assert any(one == pytest.approx(number, rel=0.5) for one in found)


def test_an_edited_scene_that_another_one_replaced_comes_back_with_its_history() -> None:
    desk = Desk(load_scene("drop"))
    desk.window.scenes.source = "drop"
    desk.key("space")
    desk.frames(2)
    edited = desk.world
    click_at(desk, desk.pixel(1.0, 2.0))
    before, entries = bits(edited), len(desk.sandbox.history.entries)
    file_actions.open_scene(desk.window, "pendulum")
    desk.frames(5)
    assert desk.world is not edited and "Ctrl+Z" in desk.window.notice
    tap(desk, "z", CTRL)
    assert desk.world is edited and bits(edited) == before
    assert len(desk.sandbox.history.entries) == entries
    assert desk.window.has_unsaved
    tap(desk, "z", CTRL)
    assert "Undone: made" in desk.window.notice


def test_a_scene_that_was_left_alone_is_not_kept() -> None:
    desk = Desk(load_scene("drop"))
    desk.frames(5)
    file_actions.open_scene(desk.window, "pendulum")
    desk.frames(5)
    assert desk.window.scenes.left is None and "Ctrl+Z" not in desk.window.notice
