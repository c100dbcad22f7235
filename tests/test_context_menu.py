"""The menu of a place, by the right button or by its key; copies in a row, a grid, around a circle."""

import math
from collections.abc import Callable

import pygame
import pytest
from desk import SETTLED, Desk, choose, click, click_at, empty_world, fill, tap, write

from physicslab.components import (
    Colour,
    Gear,
    Layer,
    MadeOf,
    Pin,
    Rod,
    Rope,
    Shape,
    Spring,
    Transform,
    Velocity,
    Weld,
)
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, circle
from physicslab.view.controls.context import open_context
from physicslab.view.window.copying import CIRCLE, GRID, Copying


@pytest.fixture
def desk() -> Desk:
    world = empty_world(gravity=(0, 0))
    circle(world, (0.0, 0.0), radius=0.3)
    made = Desk(world)
    tap(made, "space")
    return made


def open_at(desk: Desk, x: float, y: float) -> None:
    """Hold the right button at a place of the world [m] until a menu opens."""
    desk.move(x, y)
    desk.press(x, y, "right")
    desk.frames(30)
    desk.release(x, y, "right")
    desk.frames(SETTLED)


def test_a_button_that_is_held_in_a_pause_keeps_the_window_awake(desk: Desk) -> None:
    """Frames come with events alone where nothing moves: none would open the menu, or pour on."""
    for tool, button in (("circle", "right"), ("brush", "left")):
        desk.window.tool = tool
        desk.frames(10, 1.0)
        assert desk.sandbox.is_still()
        desk.press(2.0, 1.0, button)
        desk.frames(10)
        assert not desk.sandbox.is_still()
        desk.release(2.0, 1.0, button)


def test_the_right_button_gives_up_nothing_that_is_being_drawn(desk: Desk) -> None:
    """A menu opened over the drag, and what was drawn was gone."""
    desk.window.tool = "circle"
    desk.move(2.0, 1.0)
    desk.press(2.0, 1.0)
    desk.frames(2)
    desk.move(2.5, 1.0)
    desk.frames(2)
    desk.press(2.5, 1.0, "right")
    desk.frames(40)
    assert desk.window.context is None and desk.window.sketch.grips
    desk.release(2.5, 1.0, "right")
    desk.release(2.5, 1.0)
    desk.frames(SETTLED)
    assert len(desk.world.batch(Shape)) == 2
    desk.window.tool = "polygon"
    for x in (-2.0, -1.0):
        click_at(desk, desk.pixel(x, 1.5))
    click_at(desk, desk.pixel(-1.5, 2.5), "right")
    assert len(desk.window.sketch.grips) == 2 and len(desk.world.batch(Shape)) == 2


def test_the_right_button_held_opens_a_menu_and_a_short_click_makes_a_box(desk: Desk) -> None:
    open_at(desk, 2.0, 1.0)
    assert "Circle here" in desk.ui.places
    assert len(desk.world.entities()) == 1
    click(desk, "Circle here")
    last = desk.world.entities()[-1]
    assert tuple(desk.world.component(last, Transform).position) == pytest.approx((2.0, 1.0), abs=0.01)
    click_at(desk, desk.pixel(-2.0, 1.0), "right")
    last = desk.world.entities()[-1]
    assert desk.world.component(last, Shape).kind == "box" and desk.window.context is None
    click_at(desk, desk.pixel(0.0, 0.0), "right")
    assert "Material" in desk.ui.places, "on a body a box has no room: a short click opens its menu"
    click_at(desk, desk.pixel(3.0, -1.0))
    assert desk.window.context is None and len(desk.world.entities()) == 3, "a click beside it closes it"


def test_what_the_menu_of_a_body_does_is_one_edit_each(desk: Desk) -> None:
    world, (ball,) = desk.world, desk.world.entities()
    steps: tuple[tuple[tuple[str, ...], Callable[[], bool]], ...] = (
        (("Hold it",), lambda: not world.has(ball, Velocity)),
        (("Let it move",), lambda: world.has(ball, Velocity)),
        (
            ("Glue to the world",),
            lambda: world.component(ball, Weld).b == ball or len(world.batch(Weld)) == 1,
        ),
        (("Material", "of ice"), lambda: world.component(ball, MadeOf).material == "ice"),
        (("Colour", "Red"), lambda: world.component(ball, Colour).colour == "#e14f3c"),
        (("Layer", "Layer 2"), lambda: world.component(ball, Layer).number == 2),
        (("Layer", "Touches all"), lambda: not world.has(ball, Layer)),
        (("Duplicate it",), lambda: len(world.batch(Shape)) == 2),
    )
    for label, done in steps:
        desk.window.selection.clear()
        before = len(desk.window.edits.history.entries)
        open_at(desk, 0.0, 0.0)
        choose(desk, *label)
        assert done(), label
        assert len(desk.window.edits.history.entries) == before + 1, label
    open_at(desk, 0.0, 0.0)
    click(desk, "Remove it")
    assert not world.has(ball, Transform)


def test_springs_have_a_menu_and_the_key_opens_it(desk: Desk) -> None:
    (ball,) = desk.world.entities()
    spring = desk.world.spawn(Spring(ball, None, anchor_b=(0.0, 2.0), rest_length=2.0))
    desk.move(0.0, 1.0)
    desk.frames()
    tap(desk, "f10", pygame.KMOD_SHIFT)
    assert desk.window.selection.entities == (spring,) and "Material" not in desk.ui.places
    click(desk, "Remove it")
    assert not desk.world.has(spring, Spring) and desk.world.has(ball, Transform)


def test_the_force_of_a_spring_is_plotted_from_its_menu(desk: Desk) -> None:
    (ball,) = desk.world.entities()
    spring = desk.world.spawn(Spring(ball, None, anchor_b=(0.0, 2.0), rest_length=2.0))
    desk.move(0.0, 1.0)
    desk.frames()
    tap(desk, "f10", pygame.KMOD_SHIFT)
    click(desk, "Plot its force")
    ((line,),) = (graph.lines for graph in desk.window.dashboard.graphs)
    assert line.key == (spring, "spring force")


def test_a_joint_has_a_motor_limits_and_a_strength_in_its_menu(desk: Desk) -> None:
    world = desk.world
    (ball,) = world.entities()
    pin = world.spawn(Pin(None, ball, anchor_a=(1.0, 1.0), anchor_b=(1.0, 1.0)))
    world.component(ball, Velocity).linear = Vector2(0.0, 3.0)
    world.run(steps=2)

    def choose_of(menu: str, words: str) -> None:
        desk.move(1.0, 1.0)
        desk.frames()
        tap(desk, "f10", pygame.KMOD_SHIFT)
        assert desk.window.selection.entities == (pin,)
        choose(desk, menu, words)

    held = world.component(pin, Pin)
    choose_of("Breaks", "Breaks: At 3 times its force now")
    assert held.breaks > 0.0
    choose_of("Motor", "Motor: 2 rad/s")
    assert held.motor_speed == 2.0
    choose_of("Motor", "Motor: back")
    assert held.motor_speed == -2.0
    choose_of("Motor", "Motor: Off")
    assert not held.is_given("motor_speed")
    angle = world.component(ball, Transform).angle
    choose_of("Limits", "Limits: 45° to either side of here")
    choose_of("Limits", "Limits: 15° to either side of here")
    assert (held.lower, held.upper) == pytest.approx((angle - math.pi / 12, angle + math.pi / 12))
    choose_of("Limits", "Limits: None")
    assert not held.is_given("lower") and not held.is_given("upper")
    assert len(desk.window.edits.history.entries) == 7, "one undo each"
    choose_of("Breaks", "Breaks: Never")
    assert not held.is_given("breaks")


def test_copies_are_made_where_there_is_room(desk: Desk) -> None:
    box(desk.world, (2.4, 0.0), static=True)
    desk.window.selection.entities = tuple(desk.world.entities()[:1])
    desk.frames()
    tap(desk, "d", pygame.KMOD_SHIFT | pygame.KMOD_CTRL)
    fill(desk, "copies count", "6")
    fill(desk, "copies distance", "80 cm")
    click(desk, "Make copies")
    rows = desk.world.batch(Shape).rows
    found = desk.world.table(Transform)["position"][rows, 0].tolist()
    assert sorted(found) == pytest.approx([0.0, 0.8, 1.6, 2.4, 3.2, 4.0]), "one place was taken"
    assert "for 1 there is no room" in desk.window.notice
    assert len(desk.window.edits.history.entries) == 1, "one undo"


def test_enter_in_the_panel_of_copies_takes_over_a_number_and_then_makes_them(desk: Desk) -> None:
    """It went to the name of the body in the panel at the right."""
    desk.window.selection.entities = tuple(desk.world.entities()[:1])
    desk.frames()
    tap(desk, "d", pygame.KMOD_SHIFT | pygame.KMOD_CTRL)
    write(desk, "3")
    tap(desk, "return")
    assert len(desk.world.batch(Shape)) == 1
    tap(desk, "return")
    assert len(desk.world.batch(Shape)) == 3 and desk.window.copying is None


def test_the_panel_of_copies_goes_with_what_they_are_of(desk: Desk) -> None:
    """It stayed after a new scene was opened, over the place where something is drawn there."""
    desk.window.selection.entities = tuple(desk.world.entities()[:1])
    desk.frames()
    tap(desk, "d", pygame.KMOD_SHIFT | pygame.KMOD_CTRL)
    assert "Make copies" in desk.ui.places
    desk.window.selection.clear()
    desk.frames(SETTLED)
    assert "Make copies" not in desk.ui.places and desk.window.copying is None


def test_the_copy_of_a_mechanism_works_like_its_original(desk: Desk) -> None:
    world = desk.world
    world.remove(world.entities()[0])
    hub = circle(world, (-3.0, 1.0), radius=0.2, mass=1.0)
    rim = circle(world, (-2.0, 1.0), radius=0.2, mass=2.0)
    bob = circle(world, (-2.0, 0.0), radius=0.1, mass=0.5)
    motor = world.spawn(Pin(None, hub, anchor_a=(-3.0, 1.0), motor_speed=2.0, max_torque=5.0))
    other = world.spawn(Pin(None, rim, anchor_a=(-2.0, 1.0)))
    world.spawn(Gear(motor, other, ratio=-2.0))
    world.add(bob, Spring(None, rim, stiffness=30.0, rest_length=0.5))
    world.spawn(Rope(bob, None, anchor_b=(-2.0, 3.0)))
    outsider = circle(world, (-4.0, 1.0), radius=0.2)
    world.spawn(Rod(hub, outsider))
    desk.window.selection.entities = (hub, rim, bob)
    tap(desk, "d", pygame.KMOD_CTRL)
    copied = desk.window.selection.entities
    assert len(copied) == 3 and not set(copied) & {hub, rim, bob}
    counts = {kind: len(world.batch(kind)) for kind in (Pin, Gear, Spring, Rope, Rod)}
    assert counts == {Pin: 4, Gear: 2, Spring: 2, Rope: 2, Rod: 1}, "the rod leads to what is not copied"
    world.remove(outsider)
    away = [world.component(one, Transform).position.x for one in (hub, copied[0])]
    world.run(seconds=1.0)
    for one, two in zip((hub, rim, bob), copied, strict=True):
        first, second = world.component(one, Transform), world.component(two, Transform)
        assert second.position.y == pytest.approx(first.position.y, abs=1e-8)
        assert second.position.x - first.position.x == pytest.approx(away[1] - away[0], abs=1e-8)
        assert second.angle == pytest.approx(first.angle, abs=1e-8)
    assert abs(world.component(hub, Transform).angle) > 1.0, "the motor turned it"
    desk.window.selection.entities = copied
    tap(desk, "c", pygame.KMOD_CTRL)
    tap(desk, "v", pygame.KMOD_CTRL)
    assert len(world.batch(Gear)) == 3 and len(world.batch(Spring)) == 3


def test_offsets_of_a_grid_and_a_circle() -> None:
    grid = Copying(GRID, count=3, rows=2, distance=2.0, upward=0.5).offsets
    assert [tuple(one) for one in grid] == [(2.0, 0.0), (4.0, 0.0), (0.0, 0.5), (2.0, 0.5), (4.0, 0.5)]
    ring = Copying(CIRCLE, count=4, radius=1.0).offsets
    assert [part for one in ring for part in one] == pytest.approx([-1.0, 1.0, -2.0, 0.0, -1.0, -1.0])
    assert len(Copying(GRID, count=2000, rows=2000).offsets) == 1999


def test_the_menu_of_several_is_for_all_of_them(desk: Desk) -> None:
    other = circle(desk.world, (1.0, 0.0), radius=0.3)
    desk.frames()
    desk.window.selection.entities = (desk.world.entities()[0], other)
    desk.window.pointer = desk.pixel(0.0, 0.0)
    open_context(desk.world, desk.window)
    desk.frames(SETTLED)
    choose(desk, "Material", "of steel")
    assert len(desk.world.batch(MadeOf)) == 2
