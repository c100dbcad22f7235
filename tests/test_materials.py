"""Named materials and colours: one choice is one edit of mass, surface and colour, and files keep it."""

import math
from pathlib import Path

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, empty_world
from recording import RecordingCanvas

from physicslab.components import Colour, MadeOf, Mass, Material, Velocity
from physicslab.components.made_of import SUBSTANCES, look_of
from physicslab.ecs.component import InvalidValue
from physicslab.files.reader import read_scene
from physicslab.files.writer import write_scene
from physicslab.prefabs import box, capsule, circle
from physicslab.theme import mixed
from physicslab.view.canvas.canvas import Finish
from physicslab.view.picture.bodies import body_colour
from physicslab.view.window.materials import choose_material, materials


def test_a_material_sets_mass_surface_and_colour_in_one_edit() -> None:
    world = empty_world()
    ball, bar = circle(world, (0.0, 0.0), radius=0.5), capsule(world, (2.0, 0.0), length=1.0, radius=0.25)
    floor = box(world, (0.0, -2.0), width=4.0, height=1.0, static=True)
    desk = Desk(world)
    window = desk.window
    desk.frames()
    choose_material(world, window, (ball, bar, floor), "steel")
    steel = SUBSTANCES["steel"]
    areas = {ball: math.pi * 0.25, bar: 0.5 + math.pi / 16.0}
    for entity, area in areas.items():
        assert world.component(entity, Mass).mass == pytest.approx(78.5 * area, rel=1e-12)
    for entity in (ball, bar, floor):
        surface = world.component(entity, Material)
        assert (surface.restitution, surface.friction) == (steel.restitution, steel.friction)
        assert world.component(entity, Colour).rgb == (0x8F, 0xA3, 0xB8)
        assert world.component(entity, MadeOf).material == "steel"
    assert not world.has(floor, Velocity)
    window.edits.history.undo()
    assert world.component(ball, Mass).mass == 1.0
    assert not world.has(ball, Colour) and not world.has(ball, MadeOf)
    pygame.display.quit()


def test_a_material_of_ones_own_has_what_the_first_body_has_that_is_made_of_it() -> None:
    desk = Desk(empty_world())
    world, window = desk.world, desk.window
    first = circle(world, (0.0, 0.0), radius=0.5, mass=3.0, restitution=0.25, friction=0.125)
    other = box(world, (2.0, 0.0), width=1.0, height=2.0)
    desk.frames()
    choose_material(world, window, (first,), "cheese")
    assert world.component(first, Mass).mass == 3.0
    choose_material(world, window, (other,), "cheese")
    assert world.component(other, Mass).mass == pytest.approx(3.0 / (math.pi * 0.25) * 2.0)
    assert world.component(other, Material).restitution == 0.25
    assert "cheese" in materials(world) and look_of("cheese") == "plain"
    again = read_scene(write_scene(world))
    assert again.component(other, MadeOf).material == "cheese"
    pygame.display.quit()


def test_the_panel_lists_the_materials() -> None:
    world = empty_world()
    ball = circle(world, (0.0, 0.0), radius=0.5)
    desk = Desk(world)
    desk.window.selection.entities = (ball,)
    desk.key("space")
    desk.frames(SETTLED)
    assert "unspecified" in desk.ui.words
    choose_material(world, desk.window, (ball,), "ice")
    desk.frames(SETTLED)
    assert "ice" in desk.ui.words
    pygame.display.quit()


def test_a_body_is_drawn_in_its_colour() -> None:
    canvas = RecordingCanvas((1280, 720))
    world = empty_world()
    one = circle(world, (0.0, 0.0), radius=0.5)
    circle(world, (2.0, 0.0), radius=0.5)
    world.add(one, Colour("#ff0080"))
    desk = Desk(world, canvas)
    desk.frames()
    look, theme = next(drawn["look"] for drawn in canvas.called("discs")), desk.window.theme
    assert look.fill[0].tolist() == [255, 0, 128]
    assert look.rim[0].tolist() == list(mixed((255, 0, 128), theme.shine, 0.4)), "its rim is lighter"
    assert look.rim[1].tolist() == list(theme.body(2)) and look.fill[1].tolist() == list(
        theme.fill(theme.body(2))
    )
    assert body_colour(world, theme, one) == (255, 0, 128)
    world.add(one, MadeOf("steel"))
    canvas.calls.clear()
    desk.frames()
    assert next(drawn["look"] for drawn in canvas.called("discs")).finish.tolist() == [
        Finish.STEEL,
        Finish.LIT,
    ]
    pygame.display.quit()


def test_colours_fade_as_they_are_mixed_one_by_one() -> None:
    theme = Desk(empty_world()).window.theme
    colours = np.array(theme.bodies, np.uint8)
    assert theme.faded(colours, theme.fill_share).tolist() == [list(theme.fill(one)) for one in theme.bodies]
    pygame.display.quit()


@pytest.mark.parametrize("text", ["red", "#12345", "#12345G", "#FFFFFF", ""])
def test_a_colour_is_six_digits(text: str) -> None:
    with pytest.raises(InvalidValue, match="#rrggbb"):
        Colour(text)


@pytest.mark.parametrize("one", SUBSTANCES.values(), ids=SUBSTANCES)
def test_the_table_holds_what_components_can_hold(one: object) -> None:
    substance = SUBSTANCES[one.name]  # type: ignore[attr-defined]
    Colour(substance.colour)
    Material(substance.restitution, substance.friction)
    assert substance.areal_density == substance.density / 100.0 and substance.source
    row = f"| {substance.density:g} | {substance.restitution:g} | {substance.friction:g} |"
    assert row in (Path(__file__).parents[1] / "docs" / "shapes.md").read_text("utf-8")
