"""Building in the window: components from a list, names, several bodies at once, springs, pins, snapping."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pygame
import pytest
from desk import (
    SETTLED,
    Desk,
    bring_into_sight,
    button_down,
    button_up,
    choose,
    click,
    click_at,
    empty_world,
    fill,
    point,
    tap,
    write,
)

from physicslab.components import (
    Drag,
    Gear,
    Mass,
    Material,
    Name,
    Pin,
    Rod,
    Shape,
    Spring,
    Trail,
    Transform,
    Velocity,
)
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.component import COMPONENTS, Component, component, field, local_components
from physicslab.ecs.vector import Vector2
from physicslab.files import entities
from physicslab.prefabs import box, circle, pendulum
from physicslab.view.window import changing
from physicslab.view.window.changing import addable, plain_kind
from physicslab.world import World


def opened(world: World, *chosen: int) -> Desk:
    """Return a desk in which time stands still and some entities are selected."""
    desk = Desk(world)
    desk.key("space")
    desk.window.tool = "select"
    desk.window.selection.entities = chosen
    desk.frames(SETTLED)
    return desk


@contextmanager
def holding(mods: int) -> Iterator[None]:
    pygame.key.set_mods(mods)
    try:
        yield
    finally:
        pygame.key.set_mods(0)


def dragged(desk: Desk, start: tuple[int, int], end: tuple[int, int]) -> None:
    """Press at a pixel, move to another one in a few steps, and let go there."""
    point(desk, start)
    button_down(desk, start)
    for n in range(1, 5):
        way = (end[0] - start[0]) * n // 4, (end[1] - start[1]) * n // 4
        point(desk, (start[0] + way[0], start[1] + way[1]), (1, 0, 0))
    button_up(desk, end)


# ---- components --------------------------------------------------------------------------------------------


def test_what_a_body_has_not_is_added_from_a_list_and_taken_away_again() -> None:
    world = empty_world(gravity_mode="none")
    body = circle(world, (0, 0))
    desk = opened(world, body)
    for kind, words in ((Drag, "Air resistance"), (Trail, "Trail"), (Spring, "Spring")):
        assert not world.has(body, kind)
        click(desk, "Add ...")
        assert any(line.startswith(f"{words}: ") for line in desk.ui.words), "with its meaning"
        click_at(desk, _middle(desk, f"add {words}"))
        assert world.has(body, kind), words
        click(desk, "Take away ...")
        click_at(desk, _middle(desk, f"no {words}"))
        assert not world.has(body, kind)
        history = desk.window.edits.history
        assert history.undo() is not None and world.has(body, kind), "each is one edit"
        assert history.undo() is not None and not world.has(body, kind)
        desk.frames(SETTLED)


def _middle(desk: Desk, label: str) -> tuple[int, int]:
    left, top, width, height = desk.ui.places[label]
    return left + width // 2, top + height // 2


def test_tables_that_name_components_name_some_that_exist() -> None:
    named = {*changing._PLAIN, *changing._MEANINGS, *entities._NEED_TRANSFORM, *entities._MAY_REST}
    assert named <= set(COMPONENTS)


def test_a_component_that_is_new_appears_by_the_words_of_its_class() -> None:
    with local_components():

        @component
        class LightPressure(Component):
            """Pushes a body away from a lamp. More is said here."""

            lamp: str = field(choices=("near", "far"), meaning="which lamp")
            strength: float = field(unit="N", above=0.0, meaning="the force at one metre")

        world = empty_world(gravity_mode="none")
        body = circle(world, (0, 0))
        desk = opened(world, body)
        assert plain_kind(LightPressure) == "Light pressure"
        click(desk, "Add ...")
        click_at(desk, _middle(desk, "add Light pressure"))
        assert world.component(body, LightPressure).values() == {"lamp": "near", "strength": 1.0}
        fill(desk, "LightPressure.strength", "2 kN")
        assert world.component(body, LightPressure).strength == 2000.0
        click(desk, "LightPressure.lamp")
        click_at(desk, _middle(desk, "LightPressure.lamp: far"))
        assert world.component(body, LightPressure).lamp == "far"


def test_a_body_without_shape_can_be_given_one() -> None:
    world = empty_world(gravity_mode="none")
    body = world.spawn(Transform((0, 0)), Velocity(), Mass(1.0))
    desk = opened(world, body)
    assert {"Shape: circle", "Shape: box"} <= set(addable(world, (body,)))
    click(desk, "Add ...")
    click_at(desk, _middle(desk, "add Shape: box"))
    assert world.component(body, Shape).kind == "box" and world.label(body) == f"box {body}"


def test_the_place_of_a_body_cannot_be_taken_away() -> None:
    world = empty_world()
    body = circle(world, (0, 0))
    desk = opened(world, body)
    click(desk, "Take away ...")
    click_at(desk, _middle(desk, "no Place"))
    assert world.has(body, Transform) and desk.window.notice_failed
    assert desk.window.notice.endswith("delete the body instead")


# ---- names, several ----------------------------------------------------------------------------------------


def test_a_body_is_named_in_the_inspector_through_the_history() -> None:
    world = empty_world()
    body, other = circle(world, (0, 0)), box(world, (3, 0), name="crate")
    desk = opened(world, body)
    assert f"circle {body}" in desk.ui.words
    fill(desk, "Name", "moon")
    assert world.label(body) == "moon" and "moon" in desk.ui.words
    assert world.component(body, Name).id == "moon"
    fill(desk, "Name", "crate")
    assert world.label(body) == "moon" and world.label(other) == "crate"
    assert any("a unique name" in words for words in desk.ui.words)
    tap(desk, "escape")
    desk.window.edits.history.undo()
    assert world.label(body) == f"circle {body}"


def test_several_bodies_show_between_which_numbers_they_are_where_they_differ_and_change_alike() -> None:
    world = empty_world(gravity_mode="none")
    one, two = circle(world, (-2, 0), mass=1.0, friction=0.3), circle(world, (2, 1), mass=5.0, friction=0.3)
    desk = opened(world, one, two)
    desk.window.level = "Measure"
    desk.frames(SETTLED)
    shown = {key: desk.ui.words.count(key) for key in ("1 to 5", "-2 to 2", "0 to 1")}
    assert all(shown.values()), "mass, and both parts of the place"
    tap(desk, "escape")
    desk.window.selection.entities = (one, two)
    desk.frames(SETTLED)
    click(desk, "Mass.mass")
    tap(desk, "return")
    assert [world.component(e, Mass).mass for e in (one, two)] == [1.0, 5.0], "nothing was written"
    fill(desk, "Mass.mass", "2 kg")
    fill(desk, "Transform.position.y", "3")
    assert [world.component(e, Mass).mass for e in (one, two)] == [2.0, 2.0]
    assert [tuple(world.component(e, Transform).position) for e in (one, two)] == [(-2.0, 3.0), (2.0, 3.0)]
    world.component(one, Mass).fixed_rotation = True
    desk.frames(20)
    click(desk, "Keeps its angle (various)")
    assert all(world.component(e, Mass).fixed_rotation for e in (one, two))
    click(desk, "Air resistance")
    assert all(world.has(e, Drag) for e in (one, two))


def test_one_that_cannot_hold_a_number_keeps_all_as_they_were() -> None:
    world = empty_world(gravity_mode="none")
    one, two = circle(world, (-2, 0)), circle(world, (2, 0))
    desk = opened(world, one, two)
    before = [world.component(e, Material).restitution for e in (one, two)]
    fill(desk, "Material.restitution", "2")
    assert any(words.startswith("must be") for words in desk.ui.words)
    fill(desk, "Material.restitution", "1 kg")
    assert "'1 kg' is in kg; this is in no unit" in desk.ui.words
    assert [world.component(e, Material).restitution for e in (one, two)] == before


# ---- springs -----------------------------------------------------------------------------------------------


def test_two_that_are_selected_are_joined_as_far_apart_as_they_are() -> None:
    world = empty_world(gravity_mode="none")
    one, two = circle(world, (-1, 0)), circle(world, (2, 0))
    desk = opened(world, one, two)
    choose(desk, "Join ...", "Join by a spring")
    (made,) = [e for e in world.entities() if world.has(e, Spring)]
    spring = world.component(made, Spring)
    assert (spring.a, spring.b) == (one, two) and spring.rest_length == pytest.approx(3.0)
    click_at(desk, desk.pixel(0.5, 0.0))
    assert desk.window.selection.entities == (made,), "a click on it selects it"
    assert desk.ui.rows["Length"] == "3.000 m" and desk.ui.rows["Spring force"] == "0 N"
    fill(desk, "Spring.stiffness", "8 N/m")
    fill(desk, "Spring.rest_length", "2 m")
    assert desk.ui.rows["Spring force"] == "8.000 N" and desk.ui.rows["Longer by"] == "1.000 m"
    click(desk, "Delete")
    assert not world.has(made, Spring) and world.has(one, Transform)


def test_a_gear_tells_its_torque_and_no_force() -> None:
    world = empty_world()
    wheels = [circle(world, (x, 0), radius=0.5) for x in (0, 1)]
    pins = [world.spawn(Pin(b=wheel, anchor_a=(x, 0))) for x, wheel in enumerate(wheels)]
    gear = world.spawn(Gear(pins[0], pins[1]))
    desk = opened(world, gear)
    assert desk.ui.rows["Gear torque"] == "0 N m" and "Gear force" not in desk.ui.rows
    desk.window.selection.entities = (pins[0],)
    desk.frames(SETTLED)
    assert desk.ui.rows["Pin force"].endswith(" N")


def test_a_body_is_hung_on_a_rod_or_from_a_spring() -> None:
    world = empty_world()
    body, weight = circle(world, (0, 0), mass=2.0), circle(world, (3, 0), mass=2.0)
    desk = opened(world, body)
    choose(desk, "Hang, pin ...", "Hang on a rod")
    (made,) = world.batch(Rod).entities.tolist()
    assert world.component(made, Rod).anchor_b == Vector2(0.0, 1.5)
    assert desk.ui.rows["Period"] == f"{2 * math.pi * math.sqrt(1.5 / 9.81):.4g} s"
    desk.window.selection.entities = (made,)
    desk.frames(SETTLED)
    assert desk.ui.rows["Rod force"] == "19.62 N" and "Rod torque" not in desk.ui.rows  # before any step
    desk.window.selection.entities = (weight,)
    desk.frames(SETTLED)
    choose(desk, "Hang, pin ...", "Hang from a spring")
    give = f"{9.81 / (4 * math.pi) ** 2:.4f} m"
    assert desk.window.notice == f"Its weight lengthens this spring by {give}"
    (spring,) = world.batch(Spring).entities.tolist()
    desk.window.selection.entities = (spring,)
    desk.frames(SETTLED)
    assert desk.ui.rows["Gives way"] == give
    fixed = box(world, (3, 3), static=True)
    desk.window.selection.entities = (fixed,)
    desk.frames(SETTLED)
    assert "Duplicate" in desk.ui.places and "Hang, pin ..." not in desk.ui.places, "it could not hang"


def test_the_erase_tool_takes_a_spring_alone() -> None:
    world = empty_world(gravity_mode="none")
    bob = pendulum(world, (0, 2), length=2.0, angle=0.0, stiffness=5000.0)
    one, two = circle(world, (2, 0)), circle(world, (4, 0))
    own = world.spawn(Spring(a=one, b=two, rest_length=2.0))
    desk = opened(world)
    desk.window.tool = "remove"
    click_at(desk, desk.pixel(3.0, 0.0))
    assert own not in world.entities() and world.has(one, Transform)
    click_at(desk, desk.pixel(0.0, 1.0))
    assert not world.has(bob, Spring) and world.has(bob, Transform)


@pytest.mark.parametrize("paused", [True, False])
def test_a_pin_is_dragged(paused: bool) -> None:
    world = empty_world(gravity_mode="none")
    bob = pendulum(world, (0, 2), length=2.0, angle=0.0, stiffness=5000.0)
    desk = opened(world)
    desk.window.tool = "circle"
    if not paused:
        desk.key("space")
    before = len(world.entities())
    dragged(desk, desk.pixel(0, 2), desk.pixel(1, 2.5))
    spring = world.component(bob, Spring)
    assert tuple(spring.anchor_b) == pytest.approx((1.0, 2.5), abs=0.02)
    assert len(world.entities()) == before, "no circle is made"
    history = desk.window.edits.history
    if paused:
        assert history.entries[-1].words.startswith("anchor_b of ")
        history.undo()
        assert tuple(world.component(bob, Spring).anchor_b) == (0.0, 2.0)
    else:
        place = tuple(spring.anchor_b)
        desk.frames(30)
        step, position = history.step_count, tuple(world.component(bob, Transform).position)
        history.seek(0)
        history.seek(step)
        assert history.difference is None
        assert tuple(world.component(bob, Transform).position) == position
        assert tuple(world.component(bob, Spring).anchor_b) == place


def test_the_end_of_a_spring_is_chosen_from_a_list_or_clicked() -> None:
    world = empty_world(gravity_mode="none")
    bob = pendulum(world, (0, 2), length=2.0, angle=0.0, stiffness=5000.0)
    crate = box(world, (3, 0), width=1.0, height=1.0, name="crate")
    desk = opened(world, bob)
    bring_into_sight(desk, "Spring.b")
    click(desk, "Spring.b")
    click_at(desk, _middle(desk, "Spring.b: crate"))
    assert world.component(bob, Spring).b == crate
    click(desk, "Spring.b click")
    click_at(desk, desk.pixel(-3.0, -3.0))
    assert world.component(bob, Spring).b is None
    assert tuple(world.component(bob, Spring).anchor_b) == (3.0, 0.0), "the point stays where it was"
    click(desk, "Spring.b click")
    click_at(desk, desk.pixel(0.0, 0.0))
    assert world.component(bob, Spring).b is None and desk.window.notice_failed, "no spring to itself"


# ---- snapping ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("way", ["menu", "alt", "ctrl"])
def test_what_is_made_snaps_to_the_grid_on_request(way: str) -> None:
    world = empty_world(gravity_mode="none")
    desk = opened(world)
    desk.window.tool = "circle"
    if way == "menu":
        desk.key("q")
        desk.frames(2)
    with holding({"alt": pygame.KMOD_LALT, "ctrl": pygame.KMOD_LCTRL, "menu": 0}[way]):
        click_at(desk, desk.pixel(1.03, 0.98))
    (made,) = world.entities()
    assert tuple(world.component(made, Transform).position) == (1.0, 1.0)
    if way != "menu":
        click_at(desk, desk.pixel(-1.03, 0.98))
        place = tuple(world.component(max(world.entities()), Transform).position)
        assert place == pytest.approx((-1.03, 0.98), abs=0.01) and place != (-1.0, 1.0)


def test_a_body_that_is_moved_snaps_to_the_edge_of_another_and_shows_where() -> None:
    world = empty_world(gravity_mode="none")
    shelf = box(world, (0, -1), width=2.0, height=0.37, static=True)
    body = box(world, (2, 1), width=0.5, height=0.5)
    desk = opened(world)
    top = -1 + 0.5 * world.component(shelf, Shape).height
    with holding(pygame.KMOD_LALT):
        start, end = desk.pixel(2, 1), desk.pixel(0.78, top + 0.25 + 0.06)
        point(desk, start)
        button_down(desk, start)
        point(desk, end, (1, 0, 0))
        point(desk, end, (1, 0, 0))
        marks = desk.window.snapping.marks
        assert {mark.axis for mark in marks} == {0, 1}
        assert any(mark.at == pytest.approx(top) for mark in marks)
        button_up(desk, end)
    position = world.component(body, Transform).position
    assert position.y == pytest.approx(top + 0.25, abs=1e-9), "it stands on the shelf"
    assert position.x == pytest.approx(0.75, abs=1e-9), "flush with its end"
    assert desk.window.edits.history.entries


def test_handles_snap_angles_and_sizes() -> None:
    world = empty_world(gravity_mode="none")
    body = box(world, (0, 0), width=1.0, height=1.0)
    box(world, (2.0, -2.0), width=1.0, height=1.0, static=True)
    desk = opened(world, body)
    handles = {one.kind: one.place for one in desk.window.handles.of(world, body, desk.window.camera)}
    with holding(pygame.KMOD_LALT):
        dragged(desk, desk.pixel(*handles["angle"]), desk.pixel(-0.8, 1.0))
    degrees = math.degrees(world.component(body, Transform).angle)
    assert degrees == pytest.approx(45.0)
    desk.window.edits.history.undo()
    desk.frames(SETTLED)
    with holding(pygame.KMOD_LALT):
        dragged(desk, desk.pixel(*handles["size"]), desk.pixel(0.97, -0.93))
    shape = world.component(body, Shape)
    assert (shape.width, shape.height) == pytest.approx((2.0, 1.8)) or shape.width == pytest.approx(2.0)


def test_shift_and_arrows_turn_what_is_selected() -> None:
    world = empty_world(gravity_mode="none")
    body = box(world, (0, 0))
    desk = opened(world, body)
    tap(desk, "left", pygame.KMOD_LSHIFT)
    assert math.degrees(world.component(body, Transform).angle) == pytest.approx(1.0)
    desk.key("q")
    desk.frames(2)
    tap(desk, "right", pygame.KMOD_LSHIFT)
    assert math.degrees(world.component(body, Transform).angle) == pytest.approx(-14.0)


# ---- the same moment ---------------------------------------------------------------------------------------


def test_arrows_and_figures_show_forces_of_the_same_step() -> None:
    world = empty_world()
    bob = pendulum(world, (0, 2), length=2.0, angle=1.2, stiffness=5000.0)
    desk = Desk(world)
    desk.window.level = "Measure"
    desk.key("v")
    desk.window.selection.take(bob)
    desk.frames(SETTLED)
    seen = set()
    for _ in range(60):
        desk.frames()
        (pull,) = [one for one in desk.window.measured.forces if one.name == "springs"]
        shown = desk.ui.rows["Springs"]
        seen.add(shown)
        assert shown.split()[0] == f"{pull.force.magnitude:.4g}" or float(shown.split()[0]) == pytest.approx(
            pull.force.magnitude, rel=1e-3
        )
    assert 3 <= len(seen) <= 8, "five measurements a second"


def test_a_warning_is_of_an_entity_and_the_hud_rings_it() -> None:
    world = empty_world()
    far = circle(world, (2e10, 0), radius=1.0)
    circle(world, (0, 0))
    (found,) = [one for one in find_warnings(world) if "far from the origin" in one.what]
    assert (found.number, found.entity) == (far, f"circle {far}")


def test_a_text_is_typed_into_a_name_key_by_key() -> None:
    world = empty_world()
    body = circle(world, (0, 0))
    desk = opened(world, body)
    click(desk, "Name")
    write(desk, "q1")
    tap(desk, "return")
    assert world.label(body) == "q1" and not desk.window.snapping.on, "keys for fields are theirs"


SETTINGS: dict[str, tuple[str, str, Callable[[World], float], float]] = {
    "dt": ("10 ms", "3 m", lambda world: world.simulation.dt, 0.01),
    "substeps": ("2*4", "8.5", lambda world: world.simulation.substeps, 8),
    "linear_damping": ("6/min", "1 m", lambda world: world.physics.linear_damping, 0.1),
}  # fmt: skip


@pytest.mark.parametrize("key", SETTINGS)
def test_settings_take_expressions_with_units(key: str) -> None:
    text, wrong, read, expected = SETTINGS[key]
    desk = opened(empty_world())
    desk.window.level = "Engineer"
    desk.frames(SETTLED)
    fill(desk, key, text)
    assert read(desk.world) == pytest.approx(expected)
    fill(desk, key, wrong)
    assert read(desk.world) == pytest.approx(expected)
    assert any("this is in" in words or words.startswith("must be") for words in desk.ui.words)


@pytest.mark.parametrize(
    ("tool", "shown"), [("capsule", "size density"), ("beam", "density"), ("block", ""), ("ramp", "")]
)
def test_what_is_made_next_has_the_numbers_that_it_is_made_by(tool: str, shown: str) -> None:
    desk = opened(empty_world())
    desk.window.tool = tool
    desk.frames(SETTLED)
    own = [name for name in ("size", "density") if f"new {name}" in desk.ui.places]
    assert " ".join(own) == shown and "new friction" in desk.ui.places


def test_what_is_made_next_takes_expressions_with_units() -> None:
    desk = opened(empty_world())
    desk.window.tool = "circle"
    desk.frames(SETTLED)
    fill(desk, "new size", "1 ft")
    fill(desk, "new density", "1e3 g/(2 m^2)")
    assert (desk.window.recipe.size, desk.window.recipe.density) == pytest.approx((0.3048, 0.5))
    fill(desk, "new density", "2 kg")
    assert desk.window.recipe.density == pytest.approx(0.5)
    assert "'2 kg' is in kg; this is in kg/m^2" in desk.ui.words
