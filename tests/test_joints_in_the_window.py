"""Pins in the window: made, drawn, selected, removed, undone; in exported pages and in reports."""

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, empty_world, fill
from recording import RecordingCanvas

from physicslab.components import Mass, Pin, Rod, Shape, Transform, Velocity
from physicslab.diagnostics.joints import joint_states
from physicslab.export.parts import joints_of
from physicslab.view.controls.joining import attachments
from physicslab.view.controls.tools import remove, remove_selected, take_hold
from physicslab.world import World


def two_bars(world: World) -> tuple[int, int]:
    """Spawn two bars side by side."""
    ends = []
    for x in (0.5, 1.5):
        ends.append(world.spawn(Transform((x, 0)), Velocity(), Mass(1.0), Shape.box(1.0, 0.1)))
    return ends[0], ends[1]


def test_many_bodies_are_welded_where_they_meet_by_one_act() -> None:
    desk = Desk(empty_world())
    world, window = desk.world, desk.window
    *row, far = (
        world.spawn(Transform((x, 0)), Velocity(), Mass(1.0), Shape.box(1.0, 0.2)) for x in (0, 1.01, 2, 3, 9)
    )
    window.camera.scale = 100.0
    _, act = attachments(world, (row[0], row[2], far))["Weld together"]
    act(world, window)
    assert joint_states(world) == [] and window.notice == "No weld: none of them meets another"
    _, act = attachments(world, (*row, far))["Weld together"]
    act(world, window)
    joints = joint_states(world)
    assert {(world.entity_index.entities[one.a], world.entity_index.entities[one.b]) for one in joints} == {
        (row[0], row[1]), (row[1], row[2]), (row[2], row[3])
    }  # fmt: skip
    assert sorted(one.place.x for one in joints) == pytest.approx([0.505, 1.505, 2.5])
    window.edits.history.undo()
    assert joint_states(world) == []


def test_pins_are_made_from_the_list_drawn_selected_removed_and_undone() -> None:
    canvas = RecordingCanvas((1280, 720))
    world = empty_world()
    one, other = two_bars(world)
    desk = Desk(world, canvas)
    window = desk.window
    desk.key("space")
    desk.frames()
    for entities, words in (((one, other), "Join by a pin"), ((one,), "Pin")):
        _, act = attachments(world, entities)[words]
        act(world, window)
    desk.frames()
    joined, fixed = joint_states(world)
    assert tuple(joined.place) == pytest.approx(
        (1.0, 0.0), abs=1e-10
    )  # forces, and places, are those 1.7 us later
    assert (0 in (joined.a, joined.b), 0 in (fixed.a, fixed.b)) == (False, True)
    drawn = canvas.called("strokes")[-1]
    slots = np.array(drawn["start"])[-2:] + np.array(drawn["end"])[-2:]
    assert slots / 2 == pytest.approx(np.array([desk.pixel(1.0, 0.0), desk.pixel(0.5, 0.0)]), abs=1.0)
    plates = (np.array(drawn["colour"]) == window.theme.static).all(axis=1)
    assert plates.sum() == 1, "a bracket behind the one that is fixed"

    window.pointer = desk.pixel(1.0, 0.0)
    assert take_hold(world, window)
    assert window.selection.entities == (joined.entity,)
    desk.frames()
    desk.frames(2)
    assert desk.ui.rows["Pin force"].endswith("N") and "Stretch left" in desk.ui.rows
    remove_selected(world, window)
    window.pointer = desk.pixel(0.5, 0.0)
    remove(world, window)
    world.synchronise()
    assert joint_states(world) == []
    assert world.has(one, Transform)
    window.edits.history.undo()
    window.edits.history.undo()
    world.synchronise()
    assert [state.entity for state in joint_states(world)] == [joined.entity, fixed.entity]
    pygame.display.quit()


def test_numbers_that_a_joint_may_be_without_are_named_set_and_taken_away() -> None:
    world = empty_world()
    one, _ = two_bars(world)
    pin = world.spawn(Pin(b=one, anchor_b=(-0.5, 0.0)))
    desk = Desk(world)
    desk.window.selection.entities = (pin,)
    desk.key("space")
    desk.frames(SETTLED)
    assert "none" in desk.ui.words and "From limit" in desk.ui.words
    fill(desk, "Pin.lower", "-30 deg")
    part = world.component(pin, Pin)
    assert part.is_given("lower") and part.lower == pytest.approx(-np.pi / 6)
    assert not part.is_given("upper")
    fill(desk, "Pin.lower", "none")
    assert not world.component(pin, Pin).is_given("lower")
    desk.window.level = "Measure"
    desk.frames(SETTLED)
    fill(desk, "Pin.breaks", "100 N")
    assert world.component(pin, Pin).breaks == 100.0
    pygame.display.quit()


def test_the_force_of_a_joint_stands_at_the_cursor() -> None:
    canvas = RecordingCanvas((1280, 720))
    world = empty_world()
    bar = world.spawn(Transform((0, -1)), Velocity(), Mass(2.0), Shape.box(0.2, 0.2))
    world.spawn(Rod(b=bar, anchor_a=(0.0, 1.0)))
    desk = Desk(world, canvas)
    desk.frames(3)
    desk.window.tool = "select"
    desk.move(0.0, 0.3)
    canvas.calls.clear()
    desk.frames(2)
    assert f"Rod: {2 * 9.81:.2f} N" in canvas.words
    pygame.display.quit()


def test_a_pin_that_could_hold_nothing_is_not_made() -> None:
    desk = Desk(empty_world())
    rock = desk.world.spawn(Transform(), Shape.circle(1.0))
    desk.frames()
    assert attachments(desk.world, (rock,)) == {}
    other = desk.world.spawn(Transform((3, 0)), Shape.circle(1.0))
    assert attachments(desk.world, (rock, other)) == {}
    pygame.display.quit()


def test_the_exported_page_has_every_pin() -> None:
    world = empty_world()
    one, other = two_bars(world)
    world.spawn(Pin(a=one, anchor_a=(-0.5, 0.0)))
    world.spawn(Pin(a=one, b=other, anchor_a=(0.5, 0.0), anchor_b=(-0.5, 0.0)))
    world.synchronise()
    ends = [(joint["kind"], joint["a"], joint["b"], joint["anchor_a"]) for joint in joints_of(world)]
    assert ends == [("Pin", 0, None, [-0.5, 0.0]), ("Pin", 0, 1, [0.5, 0.0])]
