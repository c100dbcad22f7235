"""Bodies and joints that are drawn: by a drag, by clicks, and by numbers that are typed beside the cursor."""

import itertools
import math
from typing import Any

import numpy as np
import pygame
import pytest
from desk import Desk, empty_world, tap, write

from physicslab import load_scene
from physicslab.components import (
    Colour,
    Gear,
    MadeOf,
    Mass,
    Material,
    Pin,
    Pulley,
    Rod,
    Rope,
    Shape,
    Slot,
    Spring,
    Transform,
    Velocity,
    Weld,
)
from physicslab.ecs.quantity_text import InvalidText
from physicslab.ecs.vector import Vector2
from physicslab.languages.language import language
from physicslab.prefabs import box, circle
from physicslab.view.controls import measure, polygons, preview
from physicslab.view.controls.joining import attachments
from physicslab.view.controls.tools import DIGITS, DRAWING, TOOLS, key_of
from physicslab.view.window.sketch import Grip
from physicslab.world import World

type Place = tuple[float, float]


@pytest.fixture
def desk() -> Desk:
    made = Desk(empty_world(gravity=(0, 0)))
    made.key("space")
    made.frames()
    return made


def draw(desk: Desk, tool: str, start: Place, end: Place, typed: str = "") -> None:
    desk.window.tool = tool
    desk.press(*start)
    desk.frames()
    desk.move(*end)
    for letter in typed:
        pygame.event.post(
            pygame.Event(pygame.KEYDOWN, key=pygame.K_UNKNOWN, mod=0, unicode=letter, scancode=0)
        )
    desk.frames()
    desk.release(*end)
    desk.frames()


def only(world: World, kind: type) -> Any:
    (entity,) = world.batch(kind).entities.tolist()
    return world.component(entity, kind)


def words(desk: Desk) -> str:
    return preview.reading(desk.world, DRAWING[desk.window.tool].draws, desk.window)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("tool", "end", "place", "angle", "sizes"),
    [
        ("circle", (1.0, 0.0), (0.0, 0.0), 0.0, {"radius": 1.0}),
        ("box", (2.0, -1.0), (1.0, -0.5), 0.0, {"width": 2.0, "height": 1.0}),
        ("block", (0.0, 2.0), (0.0, 1.0), 0.5 * math.pi, {"width": 2.0, "height": 0.2}),
        ("beam", (-2.0, -2.0), (-1.0, -1.0), 0.25 * math.pi, {"width": math.sqrt(8.0), "height": 0.2}),
        ("capsule", (2.0, 0.0), (1.0, 0.0), 0.0, {"length": 1.6, "radius": 0.2}),
    ],
)
def test_a_body_is_as_large_and_lies_as_it_was_drawn(
    desk: Desk, tool: str, end: Place, place: Place, angle: float, sizes: dict[str, float]
) -> None:
    draw(desk, tool, (0.0, 0.0), end)
    shape, body = only(desk.world, Shape), only(desk.world, Transform)
    assert {name: getattr(shape, name) for name in sizes} == pytest.approx(sizes, abs=0.01)
    assert tuple(body.position) == pytest.approx(place, abs=0.01)
    assert math.remainder(body.angle - angle, math.pi) == pytest.approx(0.0, abs=1e-9)
    assert bool(desk.world.batch(Mass).entities.tolist()) == (tool != "block")
    desk.window.edits.history.undo()
    assert desk.world.entities() == [], "one undo"


@pytest.mark.parametrize(("below", "made"), [(5.0, True), (20.0, False)])
def test_a_box_that_is_drawn_a_few_pixels_into_the_floor_lies_on_it(
    desk: Desk, below: float, made: bool
) -> None:
    desk.world.spawn(Transform((0.0, -1.5)), Shape.box(20.0, 1.0))
    draw(desk, "box", (-1.0, 0.0), (1.0, -1.0 - below / desk.window.camera.scale))
    boxes = desk.world.batch(Velocity).entities.tolist()
    assert bool(boxes) == made
    for one in boxes:
        foot = desk.world.component(one, Transform).position.y - 0.5 * desk.world.component(one, Shape).height
        assert foot == pytest.approx(-1.0, abs=1e-9)


def test_a_pendulum_is_drawn_from_its_pin_to_its_bob(desk: Desk) -> None:
    draw(desk, "pendulum", (0.0, 1.0), (1.0, 0.0))
    (bob,) = desk.world.batch(Velocity).entities.tolist()
    assert tuple(desk.world.component(bob, Transform).position) == pytest.approx((1.0, 0.0), abs=1e-9)


def test_a_click_makes_one_of_the_last_size_and_a_short_drag_is_a_click(desk: Desk) -> None:
    draw(desk, "circle", (0.0, 0.0), (0.5, 0.0))
    draw(desk, "circle", (2.0, 0.0), (2.05, 0.0))
    desk.window.tool = "box"
    draw(desk, "circle", (-2.0, 0.0), (-2.0, 0.0))
    assert desk.world.table(Shape)["radius"][desk.world.batch(Shape).rows] == pytest.approx(0.5)


def test_the_size_stands_at_the_cursor_and_numbers_typed_take_its_place(desk: Desk) -> None:
    desk.window.tool = "beam"
    desk.press(0.0, 0.0)
    desk.move(1.0, 1.0)
    desk.frames()
    assert words(desk) == "1.41 m, 45.0°"
    desk.release(1.0, 1.0)
    desk.frames()
    desk.window.edits.history.undo()
    draw(desk, "beam", (0.0, 0.0), (1.0, 1.0), "2 m, 30 deg")
    shape, body = only(desk.world, Shape), only(desk.world, Transform)
    assert shape.width == pytest.approx(2.0, rel=1e-12)
    assert body.angle == pytest.approx(math.pi / 6.0, rel=1e-12)


@pytest.mark.parametrize("typed", ["20 deg", "3 kg, 20 deg"])
def test_an_angle_is_known_by_its_unit(typed: str, desk: Desk) -> None:
    draw(desk, "beam", (0.0, 0.0), (2.0, 0.0), typed)
    assert only(desk.world, Transform).angle == pytest.approx(math.pi / 9.0, rel=1e-12)
    assert only(desk.world, Shape).width == pytest.approx(2.0, abs=0.01)


def test_numbers_in_another_order_are_refused(desk: Desk) -> None:
    draw(desk, "beam", (0.0, 0.0), (2.0, 0.0), "20 deg, 2 m")
    assert desk.world.entities() == [] and "in this order: m, deg" in desk.window.notice


def test_mass_and_speed_are_typed_with_the_size_and_known_by_their_units(desk: Desk) -> None:
    draw(desk, "box", (0.0, 0.0), (1.0, 0.5), "0.8 x 0.4, 2 kg, -7.2 km/h")
    shape = only(desk.world, Shape)
    assert (shape.width, shape.height) == pytest.approx((0.8, 0.4), rel=1e-12)
    assert only(desk.world, Mass).mass == 2.0 and tuple(only(desk.world, Velocity).linear) == (-2.0, 0.0)
    draw(desk, "circle", (-3.0, 0.0), (-2.5, 0.0), "3 kg")
    assert made(desk, Mass).mass == 3.0 and made(desk, Shape).radius == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize("tool", ["circle", "box"])
@pytest.mark.parametrize("by_key", [True, False])
def test_a_click_makes_a_body_of_the_last_size_and_of_the_mass_that_is_typed(
    desk: Desk, tool: str, by_key: bool
) -> None:
    """It was refused: "a length is above 0"."""
    desk.window.tool = tool
    desk.move(0.0, 0.0)
    desk.press(0.0, 0.0)
    desk.frames()
    for letter in "3 kg; 2 m/s":
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=0, mod=0, unicode=letter, scancode=0))
    desk.frames()
    assert words(desk) == "3 kg; 2 m/s_"
    if by_key:
        desk.key("return")
    desk.frames()
    desk.release(0.0, 0.0)
    desk.frames()
    assert only(desk.world, Mass).mass == 3.0 and tuple(only(desk.world, Velocity).linear) == (2.0, 0.0)
    assert only(desk.world, Transform).position == Vector2() and only(desk.world, Shape).reach > 0.1


def test_numbers_that_cannot_be_meant_are_refused_and_not_left_out(desk: Desk) -> None:
    draw(desk, "circle", (0.0, 0.0), (0.5, 0.0), "0.4 m, 30 deg")
    assert (
        desk.world.entities() == [] and "1 number at most" in desk.window.notice and desk.window.notice_failed
    )
    draw(desk, "circle", (0.0, 0.0), (0.5, 0.0), "0.4 m, ")
    assert only(desk.world, Shape).radius == pytest.approx(0.4, rel=1e-12)


def test_tab_and_backspace_are_of_the_numbers_while_something_is_drawn(desk: Desk) -> None:
    ball = circle(desk.world, (1.0, 1.0), radius=0.25)
    desk.window.tool = "beam"
    desk.press(0.0, 0.0)
    desk.move(1.0, 1.0)
    desk.frames()
    unknown = pygame.K_UNKNOWN
    for key, letter in ((pygame.K_BACKSPACE, ""), (pygame.K_TAB, ""), (unknown, "9"), (unknown, "0")):
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=key, mod=0, unicode=letter, scancode=0))
    desk.frames()
    assert words(desk).endswith("1.41 m, 90.0°") and desk.world.has(ball, Shape)
    assert not desk.window.pace.slow_motion


def test_the_parts_of_one_hollow_polygon_have_one_colour(desk: Desk) -> None:
    desk.window.tool = "polygon"
    for x, y in ((0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0), (0.0, 0.0)):
        desk.press(x, y)
        desk.frames()
        desk.release(x, y)
        desk.frames()
    parts = desk.world.batch(Shape).entities.tolist()
    assert len(parts) > 1 and len({desk.world.component(part, Colour).colour for part in parts}) == 1


def test_letters_that_are_typed_end_nothing_that_is_being_drawn(desk: Desk) -> None:
    desk.press(0.0, 0.0)
    desk.move(1.0, 0.0)
    desk.frames()
    for letter in "2 m/s":
        code = pygame.K_UNKNOWN if letter in " /" else pygame.key.key_code(letter)
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=code, mod=0, unicode=letter, scancode=0))
        pygame.event.post(pygame.Event(pygame.KEYUP, key=code, mod=0, unicode=letter, scancode=0))
        desk.frames()
    assert desk.window.sketch.typed == "2 m/s"


def test_numbers_of_each_measure_lead_to_a_way_and_back() -> None:
    way = Vector2(-3.0, -4.0)
    assert tuple(measure.LENGTH.written("10", way)) == pytest.approx((-6.0, -8.0))
    assert tuple(measure.LENGTH.written("; 90", way)) == pytest.approx((0.0, 5.0))
    assert tuple(measure.HANGING.written("200 cm; 0.5 rad", way)) == pytest.approx(
        (2.0 * math.sin(0.5), -2.0 * math.cos(0.5))
    )
    assert tuple(measure.RADIUS.written("1,5", way)) == pytest.approx((-0.9, -1.2))
    assert tuple(measure.CORNERS.written("2 x 0.5", way)) == pytest.approx((-2.0, -0.5))
    for refused in ("0", "-1", "two", "1; 2; 3", "1 s"):
        with pytest.raises(InvalidText):
            measure.LENGTH.written(refused, way)
    assert measure.HANGING.said(Vector2(0.0, -2.0)) == "2.00 m, 0.0°"


@pytest.mark.parametrize("how", ["escape", "focus", "button"])
def test_what_is_being_drawn_is_given_up(desk: Desk, how: str) -> None:
    desk.press(0.0, 0.0)
    desk.move(1.0, 0.0)
    desk.frames()
    if how == "escape":
        desk.key("escape")
    elif how == "focus":
        pygame.event.post(pygame.Event(pygame.WINDOWFOCUSLOST))
    else:
        desk._held.clear()
        desk.move(1.5, 0.0)
    desk.frames()
    desk.release(2.0, 0.0)
    desk.frames()
    assert desk.world.entities() == [] and desk.window.tool == "circle"


def test_nothing_is_drawn_where_there_is_no_room(desk: Desk) -> None:
    rock = box(desk.world, (2.0, 0.0), static=True)
    draw(desk, "circle", (0.0, 0.0), (3.0, 0.0))
    assert desk.world.entities() == [rock] and "no room" in desk.window.notice


def test_the_right_button_draws_a_box_whatever_tool_is_in_hand(desk: Desk) -> None:
    desk.window.tool = "select"
    desk.press(0.0, 0.0, "right")
    desk.move(1.0, 1.0)
    desk.frames()
    desk.release(1.0, 1.0, "right")
    desk.frames()
    assert only(desk.world, Shape).kind == "box"


def test_a_box_that_enter_made_while_the_right_button_is_held_opens_no_menu(desk: Desk) -> None:
    desk.press(0.0, 0.0, "right")
    desk.frames()
    for letter in "2kg":
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=ord(letter), mod=0, unicode=letter, scancode=0))
    desk.key("return")
    desk.frames(2)
    assert only(desk.world, Mass).mass == 2.0
    desk.release(0.0, 0.0, "right")
    desk.frames(60)
    assert desk.window.context is None


def test_a_spring_is_drawn_by_two_clicks_as_well(desk: Desk) -> None:
    ball = circle(desk.world, (0.0, 0.0))
    draw(desk, "spring", (2.0, 0.0), (2.0, 0.0))
    assert words(desk) == "... to the other end"
    draw(desk, "spring", (0.02, 0.0), (0.02, 0.0))
    spring = only(desk.world, Spring)
    assert spring.a == ball and not spring.anchor_a, "near the middle it is the middle"
    assert not desk.window.sketch.grips


def test_a_pin_joins_the_two_bodies_under_it_or_one_with_the_world(desk: Desk) -> None:
    one, other = box(desk.world, (0.0, 0.0), width=2.0), box(desk.world, (1.5, 0.0), width=2.0)
    draw(desk, "pin", (0.75, 0.1), (0.75, 0.1))
    pin = only(desk.world, Pin)
    assert {pin.a, pin.b} == {one, other}
    assert tuple(pin.anchor_a + pin.anchor_b) == pytest.approx((0.0, 0.2), abs=0.01)
    draw(desk, "pin", (-0.8, 0.0), (-0.8, 0.0))
    pin = desk.world.component(desk.world.batch(Pin).entities.tolist()[-1], Pin)
    assert (pin.a, pin.b) == (None, one)
    draw(desk, "pin", (0.0, 2.0), (0.0, 2.0))
    assert "holds a body" in desk.window.notice


def clicks(desk: Desk, tool: str, *places: Place) -> None:
    for place in places:
        draw(desk, tool, place, place)


def made(desk: Desk, kind: type) -> Any:
    return desk.world.component(desk.world.batch(kind).entities.tolist()[-1], kind)


def test_rods_and_ropes_are_drawn_between_bodies_and_points(desk: Desk) -> None:
    one, other = circle(desk.world, (0.0, 0.0)), circle(desk.world, (2.0, 0.0))
    draw(desk, "rod", (0.0, 0.0), (2.0, 0.0))
    rod = made(desk, Rod)
    assert (rod.a, rod.b, rod.length) == (one, other, 2.0)
    draw(desk, "rope", (0.0, 2.0), (0.0, 0.08))
    rope = made(desk, Rope)
    assert (rope.a, rope.b) == (one, None) and rope.length == pytest.approx(2.0, abs=0.01)
    assert tuple(rope.anchor_a) == (0.0, 0.0), "near the middle it is the middle"
    for tool, ends in (("rod", ((3.0, 2.0), (4.0, 2.0))), ("rope", ((3.0, 2.0), (4.0, 2.0)))):
        draw(desk, tool, *ends)
        assert "holds a body" in desk.window.notice
    assert len(desk.window.edits.history.entries) == 2, "one entry for each"


def test_a_slot_without_a_way_is_refused_in_words() -> None:
    # Far from the origin a way of metres is nothing: its end is where it begins, to rounding.
    desk = Desk(empty_world())
    box(desk.world, (0.0, 0.0))
    slot = DRAWING["slot"].draws
    assert slot is not None and slot.join is not None
    grips = [Grip(None, Vector2(0.1, 0.0))] * 2
    assert slot.join(desk.world, desk.window, grips) == "No slot: its way has no length"


def test_a_slot_goes_the_way_that_was_drawn_in_the_frame_of_what_is_below() -> None:
    world = empty_world(gravity=(0, 0))
    table = box(world, (0.0, 0.0), width=3.0, height=1.0, angle=0.5 * math.pi)
    top = circle(world, (0.0, 0.5), radius=0.2)
    desk = Desk(world)
    desk.key("space")
    draw(desk, "slot", (0.0, 0.5), (0.0, 1.5))
    slot = made(desk, Slot)
    assert (slot.a, slot.b) == (table, top)
    assert tuple(slot.axis) == pytest.approx((1.0, 0.0), abs=1e-9)


def test_motors_and_welds_are_put_down_by_a_click(desk: Desk) -> None:
    wheel = circle(desk.world, (0.0, 0.0), radius=0.5)
    clicks(desk, "motor", (0.0, 0.0))
    motor = made(desk, Pin)
    assert (motor.a, motor.b, motor.motor_speed) == (None, wheel, 3.0)
    one, other = box(desk.world, (2.0, 0.0), width=1.0), box(desk.world, (3.02, 0.0), width=1.0)
    clicks(desk, "weld", (2.51, 0.0))
    weld = made(desk, Weld)
    assert {weld.a, weld.b} == {one, other}
    rock = box(desk.world, (-3.0, 0.0), static=True)
    clicks(desk, "weld", (-3.0, 0.0))
    assert "neither of its ends" in desk.window.notice and desk.world.has(rock, Transform)


def test_a_pulley_is_drawn_by_two_drags_or_four_clicks(desk: Desk) -> None:
    for n in range(2):
        one, other = box(desk.world, (0.0, 0.0)), box(desk.world, (2.0, 0.5))
        if n:
            clicks(desk, "pulley", (0.0, 0.0), (0.0, 2.0), (2.0, 0.5), (2.0, 2.0))
        else:
            draw(desk, "pulley", (0.0, 0.0), (0.0, 2.0))
            assert words(desk) == "Drag from the other body to its wheel"
            draw(desk, "pulley", (2.0, 0.5), (2.0, 2.0))
        pulley = made(desk, Pulley)
        assert (pulley.a, pulley.b) == (one, other) and pulley.length == pytest.approx(3.5, abs=0.01)
        assert tuple(pulley.wheel_a + pulley.wheel_b) == pytest.approx((2.0, 4.0), abs=0.01)
        for entity in desk.world.entities():
            desk.world.remove(entity)


def test_a_pulley_may_begin_at_its_free_end(desk: Desk) -> None:
    """It was refused after four points."""
    body = box(desk.world, (0.0, 0.0))
    clicks(desk, "pulley", (2.0, 0.5), (2.0, 2.0), (0.0, 0.0), (0.0, 2.0))
    pulley = made(desk, Pulley)
    assert (pulley.a, pulley.b) == (body, None) and tuple(pulley.wheel_a) == pytest.approx(
        (0.0, 2.0), abs=0.01
    )


def test_a_gear_couples_two_pinned_wheels_by_their_radii(desk: Desk) -> None:
    for x, radius in ((0.0, 0.8), (1.2, 0.4)):
        circle(desk.world, (x, 0.0), radius=radius)
        clicks(desk, "pin", (x, 0.0))
    clicks(desk, "gear", (0.3, 0.1), (1.3, 0.1))
    gear = made(desk, Gear)
    assert (gear.first, gear.second) == tuple(desk.world.batch(Pin).entities.tolist())
    assert gear.ratio == pytest.approx(-2.0)
    desk.world.remove(desk.world.batch(Gear).entities.tolist()[0])
    clicks(desk, "belt", (0.3, 0.1), (1.3, 0.1))
    assert made(desk, Gear).ratio == pytest.approx(2.0), "they turn the same way"
    circle(desk.world, (-3.0, 0.0))
    clicks(desk, "gear", (0.3, 0.1), (-3.0, 0.0))
    assert "pin them first" in desk.window.notice
    clicks(desk, "belt", (-3.0, 0.0))
    assert "A belt couples" in desk.window.notice and not desk.window.sketch.grips, "at once"


def test_a_refusal_of_a_typed_mass_repeats_it(desk: Desk) -> None:
    desk.window.tool = "box"
    desk.press(0.0, 1.0)
    desk.frames()
    desk.move(1.0, 2.0)
    desk.frames()
    write(desk, "1 m, 1 m, -2 kg")
    desk.release(1.0, 2.0)
    desk.frames(2)
    assert "mass = -2" in desk.window.notice and not desk.world.entities()
    assert language("de").reword(desk.window.notice).startswith("Kasten: ")


def test_two_that_are_selected_are_joined_in_every_way(desk: Desk) -> None:
    one, other = circle(desk.world, (0.0, 0.0)), circle(desk.world, (2.0, 0.0))
    for bodies in ((one,), (one, other)):
        for label, (tip, act) in attachments(desk.world, bodies).items():
            before = len(desk.world.entities())
            act(desk.world, desk.window)
            count = len(desk.world.entities()) - before
            assert tip and count == (0 if label == "Couple by a gear" else 1), (label, desk.window.notice)
            for entity in desk.world.entities()[before:]:
                desk.world.remove(entity)


def test_digits_take_up_the_tools(desk: Desk) -> None:
    for key, name in DIGITS.items():
        desk.key(key.removeprefix("shift+"), pygame.KMOD_SHIFT if "shift" in key else 0)
        desk.frames()
        assert desk.window.tool == name and key_of(TOOLS[name]) == key.capitalize()


@pytest.mark.parametrize("tool", DRAWING)
def test_what_is_drawn_has_a_ghost_or_a_line_and_is_named(desk: Desk, tool: str) -> None:
    circle(desk.world, (0.0, 0.0))
    desk.window.tool = tool
    drawn = TOOLS[tool].draws
    assert drawn is not None and (drawn.build is None) != (drawn.join is None)
    for place in ((0.0, 0.0), (2.0, 1.0)):
        desk.move(*place)
        desk.frames()
    if drawn.is_open:
        assert preview.ghost(desk.world, drawn, desk.window) is None and words(desk) == drawn.prompts[0]
    elif drawn.build is not None:
        shown = preview.ghost(desk.world, drawn, desk.window)
        assert shown is not None and shown[1] and (len(shown[0].place) or drawn.name == "binary")
    else:
        assert words(desk) == drawn.prompts[0]


# ---- polygons ----------------------------------------------------------------------------------------------


def test_a_polygon_is_closed_at_its_first_corner(desk: Desk) -> None:
    clicks(desk, "polygon", (0.0, 0.0), (2.0, 0.0), (0.0, 1.5))
    assert not desk.world.entities()
    clicks(desk, "polygon", (0.04, 0.04))
    shape, body = only(desk.world, Shape), only(desk.world, Transform)
    assert shape.kind == "polygon" and len(shape.vertices) == 3
    assert tuple(body.position) == pytest.approx((2.0 / 3.0, 0.5), abs=0.01), "its centre of mass"
    assert made(desk, Mass).mass == pytest.approx(5.0 * 1.5, rel=0.02)
    assert not desk.window.sketch.grips


def test_a_polygon_is_closed_at_its_last_corner_too_as_enter_does(desk: Desk) -> None:
    clicks(desk, "polygon", (0.0, 0.0), (2.0, 0.0))
    tap(desk, "return")
    assert not desk.world.entities() and len(desk.window.sketch.grips) == 3, "two corners enclose nothing"
    desk.window.sketch.cancel()
    clicks(desk, "polygon", (0.0, 0.0), (2.0, 0.0), (0.0, 1.5))
    tap(desk, "return")
    assert len(only(desk.world, Shape).vertices) == 3 and not desk.window.sketch.grips


def test_the_order_of_corners_does_not_matter_and_hollow_ones_are_welded_parts(desk: Desk) -> None:
    clicks(desk, "polygon", (0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0))
    assert len(only(desk.world, Shape).vertices) == 4
    clicks(desk, "polygon", (-3.0, 0.0), (-1.0, 0.0), (-2.5, 0.2), (-3.0, 2.0), (-3.0, 0.0))
    assert len(desk.world.batch(Shape)) == 3 and len(desk.world.batch(Weld)) == 1
    assert "no polygon" not in desk.window.notice
    desk.window.edits.history.undo()
    assert len(desk.world.entities()) == 1, "one undo"
    clicks(desk, "polygon", (-3.0, 0.0), (-2.0, 0.0), (-1.0, 0.0), (-3.0, 0.0))
    clicks(desk, "polygon", (-3.0, -2.0), (-2.0, -1.0), (-2.0, -2.0), (-3.0, -1.0), (-3.0, -2.0))
    assert "does not cross" in desk.window.notice and len(desk.world.entities()) == 1


def stroke(desk: Desk, places: list[Place]) -> None:
    desk.window.tool = "polygon"
    desk.press(*places[0])
    desk.frames()
    for place in places[1:]:
        desk.move(*place)
        desk.frames()
    desk.release(*places[-1])
    desk.frames()


def test_a_polygon_is_drawn_with_one_stroke(desk: Desk) -> None:
    around = [(math.cos(0.1 * n), math.sin(0.1 * n)) for n in range(63)]
    stroke(desk, around)
    shape = only(desk.world, Shape)
    assert shape.kind == "polygon" and len(shape.vertices) == 8, "as many as it may have"
    assert polygons.area(shape.vertices) == pytest.approx(2.9, abs=0.15)


def test_a_square_drawn_by_hand_is_one_and_a_bow_is_several_in_its_place(desk: Desk) -> None:
    sides = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]
    path = [
        (a[0] + (b[0] - a[0]) * n / 10 + 0.004 * (n % 2), a[1] + (b[1] - a[1]) * n / 10)
        for a, b in itertools.pairwise(sides)
        for n in range(10)
    ]
    stroke(desk, path)
    assert len(only(desk.world, Shape).vertices) == 4
    bow = [(0.1 * n - 3.0, 0.15 * abs(n - 10)) for n in range(21)]
    bow += [(0.1 * n - 3.0, 0.15 * abs(n - 10) + 0.6) for n in range(20, -1, -1)]
    stroke(desk, bow)
    masses = desk.world.table(Mass)["mass"][desk.world.batch(Mass).rows]
    assert len(masses) == 3 and masses[1:].sum() == pytest.approx(5.0 * 2.0 * 0.6, rel=0.03)
    assert len(made(desk, Shape).vertices) == 4, "without the tremble of the hand"


def test_a_straight_stroke_is_an_edge(desk: Desk) -> None:
    stroke(desk, [(0.1 * n, 0.0) for n in range(11)])
    assert len(desk.window.sketch.grips) == 2


def test_a_ramp_has_the_length_and_the_angle_of_its_slope(desk: Desk) -> None:
    draw(desk, "ramp", (0.0, 0.0), (1.0, 0.2), "2 m, 20 deg")
    shape = only(desk.world, Shape)
    width, height = np.ptp(np.array([tuple(vertex) for vertex in shape.vertices]), axis=0)
    assert (width, height) == pytest.approx((2 * math.cos(math.pi / 9), 2 * math.sin(math.pi / 9)))
    assert not len(desk.world.batch(Velocity))
    (ramp,) = desk.world.entities()
    assert desk.world.label(ramp) == f"ramp {ramp}"  # it was called a polygon
    assert only(desk.world, Material).restitution == desk.window.recipe.restitution > 0.0


def test_a_box_takes_an_angle_beside_its_sides(desk: Desk) -> None:
    draw(desk, "ramp", (0.0, 0.0), (1.0, 0.2), "3 m, 20 deg")
    slope = only(desk.world, Transform).position
    draw(desk, "box", (slope.x, slope.y + 0.9), (slope.x + 0.3, slope.y + 1.1), "0.4 m, 0.2 m, 20 deg, 500 g")
    box = desk.world.batch(Mass).entities.tolist()[0]
    shape = desk.world.component(box, Shape)
    assert (shape.width, shape.height, desk.world.component(box, Mass).mass) == (0.4, 0.2, 0.5)
    assert desk.world.component(box, Transform).angle == pytest.approx(math.pi / 9)
    draw(desk, "box", (-4.0, 2.0), (-3.0, 2.5))
    *_, last = desk.world.batch(Mass).entities.tolist()
    assert desk.world.component(last, Transform).angle == 0.0


def test_what_is_drawn_holds_and_nothing_that_was_not_given_is_set() -> None:
    desk = Desk(empty_world(gravity=(0.0, -9.81)))
    desk.move(0.5, 2.0)
    desk.key("p")
    desk.frames(20)
    (bob,) = desk.world.entities()
    assert desk.world.component(bob, Rod).given()["breaks"] is None


def test_a_chain_has_as_many_links_as_fit_and_hangs_from_its_first_point(desk: Desk) -> None:
    draw(desk, "chain", (0.0, 2.0), (0.0, 0.0), "1.5 m, 0 deg")
    pins = [desk.world.component(entity, Pin) for entity in desk.world.batch(Pin).entities.tolist()]
    assert len(pins) == 8 and pins[0].a is None and pins[1].a == pins[0].b
    assert tuple(pins[0].anchor_a) == pytest.approx((0.0, 2.0))
    lengths = desk.world.table(Shape)["length"][desk.world.batch(Shape).rows]
    assert lengths == pytest.approx(1.5 / 8.0)
    desk.window.edits.history.undo()
    assert desk.world.entities() == []


def test_what_is_drawn_next_is_made_of_what_was_chosen(desk: Desk) -> None:
    desk.window.recipe = desk.window.recipe.of("ice")
    draw(desk, "circle", (0.0, 0.0), (1.0, 0.0))
    assert only(desk.world, MadeOf).material == "ice" and only(desk.world, Colour).colour == "#a5dcf2"
    assert only(desk.world, Mass).mass == pytest.approx(9.17 * math.pi, rel=0.03)
    desk.window.recipe = desk.window.recipe.of("")
    draw(desk, "circle", (-3.0, 0.0), (-2.5, 0.0))
    assert len(desk.world.batch(MadeOf)) == 1


@pytest.mark.parametrize("button", ["left", "right"])
def test_a_press_beside_a_panel_makes_nothing(desk: Desk, button: str) -> None:
    desk.window.camera.look_at((0.0, 0.0, 0.0, 0.0), 100.0)
    desk.frames(3)
    edge = max(rect[0] + rect[2] for rect in desk.sandbox.interface.covered if rect[0] == 0 and rect[2] < 300)
    for away, count in ((6, 0), (20, 1)):
        x, y = desk.window.camera.to_world((edge + away, 400))
        desk.move(x, y)
        desk.press(x, y, button)
        desk.release(x, y, button)
        desk.frames()
        assert len(desk.world.entities()) == count
        assert ("farther from the panel" in desk.window.notice) == (not count)
        desk.frames(200)


def test_the_press_that_brings_the_window_to_the_front_makes_nothing(desk: Desk) -> None:
    pygame.event.post(pygame.Event(pygame.WINDOWFOCUSGAINED))
    draw(desk, "circle", (0.0, 0.0), (0.0, 0.0))
    assert desk.world.entities() == []
    desk.frames(10)
    draw(desk, "circle", (0.0, 0.0), (0.0, 0.0))
    assert len(desk.world.entities()) == 1


def test_files_with_instruments_open_with_select_in_hand() -> None:
    desk = Desk(empty_world())
    assert desk.window.tool == "circle"
    for scene, tool in (("drop", "circle"), ("pendulum", "select")):
        desk.window.scenes.next_world = load_scene(scene)
        desk.frames()
        assert desk.window.tool == tool
    desk.key("n", pygame.KMOD_CTRL)
    desk.frames(2)
    assert desk.window.tool == "circle", "a new scene is to be drawn in"
    pygame.display.quit()
