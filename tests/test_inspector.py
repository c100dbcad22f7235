"""The inspector: every field is written with units, refused where it is wrong, restored, dragged."""

from __future__ import annotations

import math
from itertools import cycle
from types import SimpleNamespace
from typing import Any

import pygame
import pytest
from desk import (
    SETTLED,
    Desk,
    bring_into_sight,
    button_down,
    button_up,
    click,
    click_at,
    empty_world,
    fill,
    middle_of,
    point,
    sized,
    tap,
    write,
)  # fmt: skip

from physicslab import World
from physicslab.components import Drag, Layer, Mass, Material, Pin, Shape, Spring, Trail, Transform, Velocity
from physicslab.diagnostics.collision import Body, Motion
from physicslab.ecs.component import Component
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene
from physicslab.history import AddComponent
from physicslab.prefabs import box, capsule, circle
from physicslab.theme import DARK
from physicslab.view.canvas.quantities import quantity, vector_quantity
from physicslab.view.workbench.collision_drawing import colours_of

REST = Motion(Vector2(), 0.0)

WRITTEN: dict[str, tuple[str, float]] = {
    "Transform.position.x": ("250 cm", 2.5),
    "Transform.position.y": ("-1 ft", -0.3048),
    "Transform.angle": ("30 deg", math.pi / 6),
    "Velocity.linear.x": ("36 km/h", 10.0),
    "Velocity.linear.y": ("-2,5", -2.5),
    "Velocity.angular": ("60 rpm", 2 * math.pi),
    "Mass.mass": ("1500 g", 1.5),
    "Mass.inertia": ("2 kg m²", 2.0),
    "Shape.radius": ("12 mm", 0.012),
    "Shape.width": ("sqrt(4) m", 2.0),
    "Shape.height": ("1 yd", 0.9144),
    "Shape.length": ("1 ft", 0.3048),
    "Material.restitution": ("30 %", 0.3),
    "Material.friction": ("1/4", 0.25),
    "Drag.linear": ("2 g/s", 0.002),
    "Drag.quadratic": ("3 kg/m", 3.0),
    "Spring.anchor_a.x": ("1 cm", 0.01),
    "Spring.anchor_a.y": ("-2 cm", -0.02),
    "Spring.anchor_b.x": ("2 m", 2.0),
    "Spring.anchor_b.y": ("3 m", 3.0),
    "Spring.rest_length": ("2*pi/4 m", math.pi / 2),
    "Spring.stiffness": ("2 kN/m", 2000.0),
    "Spring.damping": ("5 N s/m", 5.0),
    "Pin.anchor_a.x": ("1 mm", 0.001),
    "Pin.anchor_a.y": ("-3 mm", -0.003),
    "Pin.anchor_b.x": ("1.5 m", 1.5),
    "Pin.anchor_b.y": ("50 cm", 0.5),
    "Pin.lower": ("-90 deg", -math.pi / 2),
    "Pin.upper": ("2 rad", 2.0),
    "Pin.motor_speed": ("30 rpm", math.pi),
    "Pin.max_torque": ("3 N m", 3.0),
    "Pin.breaks": ("2 kN", 2000.0),
    "Pin.breaks_torque": ("10 N m", 10.0),
    "Trail.length": ("2 min", 120.0),
}
"""What is written into each field, and the number in SI that it stands for."""
OUT_OF_RANGE = {
    "Transform.position.x": "1e301", "Mass.mass": "-1", "Shape.width": "0 m", "Material.restitution": "1.01",
    "Drag.quadratic": "-1", "Spring.rest_length": "-1 cm", "Pin.anchor_a.y": "1e151", "Pin.max_torque": "-1",
}  # fmt: skip
"""Fields of each kind of number, and one that a field does not take."""
KINDS: tuple[type[Component], ...] = (Transform, Velocity, Mass, Shape, Material, Drag, Spring, Pin, Trail)


def all_fields() -> set[str]:
    keys = set()
    for kind in KINDS:
        for spec in kind.FIELDS:
            if spec.kind == "number":
                keys.add(f"{kind.__name__}.{spec.name}")
            elif spec.kind == "vector":
                keys |= {f"{kind.__name__}.{spec.name}.{axis}" for axis in "xy"}
    return keys


def bench(key: str) -> tuple[Desk, int]:
    """Return a desk with a body selected that has the field, while time stands still."""
    world = empty_world(gravity_mode="none")
    if key == "Shape.length":
        body = capsule(world, (1.0, 0.5), mass=1.0)
    else:
        make = box if key in ("Shape.width", "Shape.height") else circle
        body = make(world, (1.0, 0.5), mass=1.0)
    for extra in (Drag(), Trail(), Spring(anchor_b=(1.0, 2.5)), Pin(anchor_b=(1.0, 0.5))):
        world.add(body, extra)
    other = circle(world, (-2.0, -2.0), mass=3.0)
    world.synchronise()
    assert other != body
    desk = Desk(world)
    desk.key("space")
    desk.window.tool, desk.window.level = "select", "Measure"
    desk.window.selection.take(body)
    desk.frames(SETTLED)
    return desk, body


def held(desk: Desk, entity: int, key: str) -> float:
    """Return the number that a field holds."""
    name, field, *axis = key.split(".")
    kind = next(kind for kind in KINDS if kind.__name__ == name)
    value: Any = getattr(desk.world.component(entity, kind), field)
    return float(getattr(value, axis[0]) if axis else value)


def state(desk: Desk) -> list[dict[str, Any]]:
    world = desk.world
    return [part.values() for entity in world.entities() for part in world.components(entity)]


def field_text(desk: Desk, key: str) -> str:
    """Return what a field shows: the words that are written after its label's own place in the panel."""
    seen: dict[str, str] = {}
    ui = desk.ui
    usual = type(ui).field

    def watched(self: Any, label: str, text: str, *given: Any, **named: Any) -> tuple[str, bool]:
        seen[label] = text
        return usual(self, label, text, *given, **named)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(type(ui), "field", watched)
        desk.sandbox.interface.toolkit.wake()
        desk.frames(2)
    return seen[key]


def test_every_field_is_in_the_table() -> None:
    assert set(WRITTEN) == all_fields()


@pytest.mark.parametrize(("key", "end"), list(zip(WRITTEN, cycle(("return", "tab", "beside")), strict=False)))
def test_a_field_takes_a_number_with_a_unit(key: str, end: str) -> None:
    desk, body = bench(key)
    text, expected = WRITTEN[key]
    edits, before = desk.world.motion_edits, state(desk)
    click(desk, key)
    write(desk, text)
    assert state(desk) == before, "nothing is taken over while it is written"
    if end == "beside":
        click_at(desk, desk.pixel(-4.0, 3.0))
    else:
        tap(desk, end)
    assert held(desk, body, key) == pytest.approx(expected, rel=1e-15)
    assert desk.world.motion_edits > edits
    after = state(desk)
    assert sum(a != b for a, b in zip(before, after, strict=True)) <= (2 if "Shape" in key else 1)


@pytest.mark.parametrize(
    ("key", "text"), list(zip(OUT_OF_RANGE, cycle(("north", "1 +", "3 kg^7", "1/0")), strict=False))
)
def test_what_is_no_number_has_another_unit_or_is_out_of_range_is_refused_at_the_field(
    key: str, text: str
) -> None:
    desk, _ = bench(key)
    before, edits, shown = state(desk), desk.world.motion_edits, field_text(desk, key)
    bring_into_sight(desk, key)
    for wrong in (text, OUT_OF_RANGE[key]):
        written = set(desk.ui.words)
        fill(desk, key, wrong)
        sentences = [words for words in set(desk.ui.words) - written if len(words) > 12]
        assert sentences, f"{wrong!r} is refused with a sentence"
        assert state(desk) == before and desk.world.motion_edits == edits
        assert field_text(desk, key) == wrong, "it stays, to be mended"
        click(desk, key)
        tap(desk, "escape")
        assert field_text(desk, key) == shown, "Escape restores the number"
        assert not set(sentences) & set(desk.ui.words)
    fill(desk, key, "   ")
    assert "a number is needed" in desk.ui.words and state(desk) == before


def test_esc_after_a_refused_number_gives_up_the_number_and_then_the_body() -> None:
    desk, body = bench("Mass.mass")
    shown = field_text(desk, "Mass.mass")
    fill(desk, "Mass.mass", "-3")
    assert field_text(desk, "Mass.mass") == "-3"
    for selected in ((body,), ()):
        tap(desk, "escape")
        assert field_text(desk, "Mass.mass") == shown if selected else "Mass.mass" not in desk.ui.places
        assert desk.window.selection.entities == selected


@pytest.mark.parametrize("end", ["return", "tab", "escape"])
def test_a_field_that_is_left_as_it_is_keeps_every_figure(end: str) -> None:
    desk, body = bench("Transform.position.x")
    third = 1.0 / 3.0
    desk.world.component(body, Transform).position = Vector2(third, third)
    desk.world.component(body, Mass).mass = third
    desk.frames(SETTLED)
    edits = desk.world.motion_edits
    for key in ("Transform.position.x", "Mass.mass"):
        click(desk, key)
        tap(desk, end)
        assert held(desk, body, key) == third
        click(desk, key)
        write(desk, "7")
        tap(desk, "escape")
        assert held(desk, body, key) == third
        fill(desk, key, field_text(desk, key), end)
        assert held(desk, body, key) == third
    assert desk.world.motion_edits == edits


def test_a_click_on_another_body_takes_over_what_was_written_for_the_first() -> None:
    desk, body = bench("Mass.mass")
    (other,) = [e for e in desk.world.entities() if e != body]
    click(desk, "Mass.mass")
    write(desk, "7 kg")
    click_at(desk, desk.pixel(-2.0, -2.0))
    assert desk.window.selection.entities == (other,)
    assert held(desk, body, "Mass.mass") == 7.0 and held(desk, other, "Mass.mass") == 3.0
    assert field_text(desk, "Mass.mass") == "3"


def test_a_wrong_number_that_is_left_for_the_world_is_reported() -> None:
    desk, body = bench("Mass.mass")
    click(desk, "Mass.mass")
    write(desk, "7 m")
    click_at(desk, desk.pixel(-4.0, 3.0))
    assert held(desk, body, "Mass.mass") == 1.0
    assert desk.window.notice == "'7 m' is in m; this is in kg" and desk.window.notice_failed


def test_a_commit_is_one_edit() -> None:
    desk, _ = bench("Mass.mass")
    edits = desk.world.motion_edits
    fill(desk, "Mass.mass", "2")
    one = desk.world.motion_edits - edits
    desk.frames(20)
    assert desk.world.motion_edits - edits == one


# ---- labels ----------------------------------------------------------------------------------------------


def drag(desk: Desk, label: str, px: int, mods: int = 0) -> None:
    bring_into_sight(desk, label)
    x, y = middle_of(desk, label)
    point(desk, (x, y))
    pygame.key.set_mods(mods)
    try:
        button_down(desk, (x, y))
        for n in range(1, 5):
            point(desk, (x + px * n // 4, y), (1, 0, 0))
        desk.frames(SETTLED)
        button_up(desk, (x + px, y))
    finally:
        pygame.key.set_mods(0)


@pytest.mark.parametrize(
    ("mods", "expected"), [(0, 1.2), (pygame.KMOD_LSHIFT, 1.02), (pygame.KMOD_LCTRL, 3.0)]
)
def test_a_label_is_dragged_shift_finer_ctrl_coarser(mods: int, expected: float) -> None:
    desk, body = bench("Mass.mass")
    drag(desk, "label Mass.mass", 40, mods)
    assert held(desk, body, "Mass.mass") == pytest.approx(expected, rel=1e-6)
    drag(desk, "label Mass.mass", -4)
    assert held(desk, body, "Mass.mass") < expected


@pytest.mark.parametrize("kind", [Mass, Layer])
@pytest.mark.parametrize("runs", [False, True])
def test_a_drag_of_a_label_is_one_undo(kind: type[Mass | Layer], *, runs: bool) -> None:
    desk, body = bench("Mass.mass")
    desk.window.edits.do(AddComponent(body, Layer()))
    desk.window.pace.paused = not runs
    desk.frames(5)

    def now() -> float:
        part = desk.world.component(body, kind)
        return part.mass if isinstance(part, Mass) else part.number

    begun, before = desk.world.time, now()
    drag(desk, "label Mass.mass" if kind is Mass else "label Layer.number", 400)
    desk.frames(5)
    after = now()
    assert after > before and (desk.world.time > begun) is runs
    desk.key("z", pygame.KMOD_CTRL)
    desk.frames(1)
    assert now() == before, "back to where the drag began"
    desk.key("y", pygame.KMOD_CTRL)
    desk.frames(1)
    assert now() == after


def test_a_drag_ends_where_the_range_ends() -> None:
    desk, body = bench("Material.restitution")
    drag(desk, "label Material.restitution", 160)
    assert 0.5 < held(desk, body, "Material.restitution") <= 1.0
    drag(desk, "label Shape.radius", -40)
    assert held(desk, body, "Shape.radius") == pytest.approx(0.05)
    drag(desk, "label Shape.radius", -36)
    assert held(desk, body, "Shape.radius") == pytest.approx(0.005), "the last that it can hold"
    assert not desk.window.notice_failed


@pytest.mark.parametrize("key", [key for key in OUT_OF_RANGE if not key.endswith((".x", ".y"))])
def test_a_label_of_any_kind_of_number_can_be_dragged(key: str) -> None:
    desk, body = bench(key)
    before = held(desk, body, key)
    drag(desk, f"label {key}", 12)
    assert held(desk, body, key) == pytest.approx(before + 12 * 0.005 * max(abs(before), 1.0), rel=1e-5)


# ---- several, and components -----------------------------------------------------------------------------


def test_several_get_each_its_own_number_from_left_to_right() -> None:
    world = empty_world()
    right, left = (box(world, (x, 0.5), name=f"cart at {x}") for x in (2.0, -2.0))
    desk = sized((1280, 720), world)
    desk.window.pace.paused = True
    desk.window.selection.entities = (right, left)
    desk.frames(SETTLED)
    fill(desk, "Mass.mass", "1; 2500 g")
    fill(desk, "Velocity.linear.x", "2; -1")
    fill(desk, "Transform.angle", "0; 90")
    fill(desk, "Material.friction", "0")
    found = [[held(desk, e, key) for e in (left, right)] for key in ("Mass.mass", "Velocity.linear.x")]
    assert found == [[1.0, 2.5], [2.0, -1.0]]
    assert held(desk, right, "Transform.angle") == pytest.approx(math.pi / 2)
    assert [held(desk, e, "Material.friction") for e in (left, right)] == [0.0, 0.0]
    entries = len(desk.sandbox.history.entries)
    for wrong, words in (("1; 2; 3", "must be one number, or 2"), ("1; 0", "must be"), ("1; x", "x")):
        fill(desk, "Mass.mass", wrong)
        assert any(words in said for said in desk.ui.words), wrong
        assert [held(desk, e, "Mass.mass") for e in (left, right)] == [1.0, 2.5]
    assert len(desk.sandbox.history.entries) == entries
    tap(desk, "z", pygame.KMOD_CTRL)
    assert held(desk, left, "Material.friction") != 0.0, "an edit each"


def test_several_have_the_fields_that_all_of_them_have() -> None:
    desk, body = bench("Mass.mass")
    (other,) = [e for e in desk.world.entities() if e != body]
    wall = box(desk.world, (4, -3), static=True)
    desk.world.synchronise()
    desk.window.selection.entities = (body, other)
    desk.frames(SETTLED)
    assert "2 selected" in desk.ui.words and "Drag.linear" not in desk.ui.places
    fill(desk, "Mass.mass", "2500 g")
    fill(desk, "Transform.position.x", "1 m")
    assert [held(desk, e, "Mass.mass") for e in (body, other)] == [2.5, 2.5]
    assert [held(desk, e, "Transform.position.x") for e in (body, other)] == [1.0, 1.0]
    assert [held(desk, e, "Transform.position.y") for e in (body, other)] == [0.5, -2.0]
    desk.window.selection.entities = (body, wall)
    desk.frames(SETTLED)
    assert "Mass.mass" not in desk.ui.places and "Transform.angle" in desk.ui.places


@pytest.mark.parametrize(
    ("kind", "words"),
    [(Velocity, "Can move"), (Mass, "Has mass"), (Drag, "Air resistance"), (Trail, "Leaves a trail")],
)
def test_a_box_to_tick_takes_a_component_away_and_gives_it_back(kind: type[Component], words: str) -> None:
    desk, body = bench("Mass.mass")
    had = desk.world.has(body, kind)
    assert had
    rows = {label for label in desk.ui.places if label.startswith(f"{kind.__name__}.")}
    assert rows
    for there in (False, True):
        edits = desk.world.revision
        click(desk, words)
        assert desk.world.has(body, kind) == there and desk.world.revision > edits
        assert rows <= set(desk.ui.places) if there else not rows & set(desk.ui.places)
    desk.key("space")
    desk.frames(5)
    assert desk.world.time > 0.0 and not desk.window.error


def test_a_flag_is_ticked() -> None:
    desk, body = bench("Mass.mass")
    for there in (True, False):
        click(desk, "Keeps its angle")
        assert desk.world.component(body, Mass).fixed_rotation == there


def test_buttons_duplicate_remove_and_leave() -> None:
    desk, body = bench("Mass.mass")
    world, before = desk.world, set(desk.world.entities())
    fill(desk, "Mass.mass", "4")
    click(desk, "Duplicate")
    (copy,) = set(world.entities()) - before
    assert [*desk.window.selection.entities] == [copy]
    for kind in (Mass, Shape, Material, Velocity):
        assert world.component(copy, kind).given() == world.component(body, kind).given()
    apart = world.component(copy, Transform).position - world.component(body, Transform).position
    assert apart.magnitude >= 2 * world.component(body, Shape).radius, "beside it, not on it"
    click(desk, "Done")
    assert [*desk.window.selection.entities] == []
    desk.window.selection.take(copy)
    desk.frames(SETTLED)
    click(desk, "Delete")
    assert set(world.entities()) == before


# ---- what follows ----------------------------------------------------------------------------------------


def test_derived_figures_are_those_of_mechanics() -> None:
    world = empty_world(gravity_mode="none")
    body = circle(world, (0, 0), radius=0.5, mass=2.0, velocity=(3.0, 4.0), angular_velocity=2.0)
    desk = Desk(world)
    desk.key("space")
    desk.window.level = "Measure"
    desk.window.selection.take(body)
    desk.frames(SETTLED)
    inertia = 0.5 * 2.0 * 0.25
    rows = desk.ui.rows
    assert {"5", "53.13"} <= set(desk.ui.words), "speed and direction"
    assert rows["Momentum"] == quantity(10.0, "kg m/s")
    assert rows["as a vector"] == vector_quantity(Vector2(6, 8), "kg m/s")
    assert rows["Kinetic energy"] == quantity(0.5 * 2 * 25 + 0.5 * inertia * 4, "J")
    assert rows["of turning"] == quantity(0.5 * inertia * 4, "J")


def test_figures_follow_the_motion() -> None:
    world = empty_world(gravity=(0, -10))
    body = circle(world, (0, 30))
    desk = Desk(world)
    desk.window.selection.take(body)
    seen = []
    for _ in range(5):
        desk.frames(13)
        seen.append(desk.ui.rows["Momentum"])
    assert len(set(seen)) == 5
    tap(desk, "space")
    speed = world.component(body, Velocity).linear.magnitude
    assert desk.ui.rows["Momentum"] == quantity(speed, "kg m/s")


def test_an_angle_is_shown_in_degrees_beside() -> None:
    desk, body = bench("Transform.angle")
    fill(desk, "Transform.angle", "30 deg")
    assert held(desk, body, "Transform.angle") == pytest.approx(math.pi / 6)
    assert "30" in desk.ui.words and "°" in desk.ui.words, "degrees come first"
    desk.window.level = "Engineer"
    desk.frames(SETTLED)
    assert "rad = 30°" in desk.ui.words


def test_in_degrees_a_number_alone_is_degrees_and_many_turns_fit_into_the_field() -> None:
    desk, body = bench("Transform.angle")
    desk.window.level = "Explore"
    desk.frames(SETTLED)
    fill(desk, "Transform.angle", "45")
    assert held(desk, body, "Transform.angle") == pytest.approx(math.pi / 4)
    desk.world.component(body, Transform).angle = -18.2946
    desk.world.edited()
    for level, shown, beside in (("Explore", "31.7966", "°"), ("Engineer", "-18.2946", "rad, 31.8°")):
        desk.window.level = level
        desk.frames(SETTLED)
        assert {shown, beside} <= set(desk.ui.words)


def test_rounding_is_shown_as_0_and_kept() -> None:
    world = empty_world()
    body = box(world, (2.0, 3e-16), width=1.0, height=1.0, angle=-1.95055e-17, angular_velocity=3e-33)
    world.component(body, Velocity).linear = Vector2(4e-34, 0.0)
    desk = Desk(world)
    desk.window.pace.paused = True
    desk.window.selection.take(body)
    for level in ("Explore", "Measure"):
        desk.window.level = level
        desk.frames(SETTLED)
        assert not [words for words in desk.ui.words if "e-" in words or "10⁻" in words]
    assert desk.world.component(body, Transform).angle == -1.95055e-17


def test_the_friction_and_the_restitution_of_a_pair_are_written() -> None:
    desk = Desk(load_scene("slope"))
    desk.window.selection.take(desk.world.entity("mu = 0.5"))
    desk.frames(20)
    for level in ("Explore", "Measure"):
        desk.window.level = level
        desk.frames(SETTLED)
        assert "With slope: μ = 0.5, e = 0" in desk.ui.words


def test_a_body_has_its_colour_in_the_microscope() -> None:
    a, b = (Body(n, 1.0, 1.0, Vector2(), 0.0, REST, REST) for n in (3, 5))
    wall = Body(1, 0.0, 0.0, Vector2(), 0.0, REST, REST)
    for one, other, colours in ((a, b, (DARK.body(3), DARK.body(5))), (wall, b, (DARK.static, DARK.body(5)))):
        assert colours_of(World(), DARK, SimpleNamespace(a=one, b=other)) == colours  # type: ignore[arg-type]
    first, second = colours_of(World(), DARK, SimpleNamespace(a=a, b=a))  # type: ignore[arg-type]
    assert first == DARK.body(3) != second
