"""Figures of the window agree with each other and with what is so."""

from __future__ import annotations

from dataclasses import replace

import pytest
from desk import SETTLED, Desk, empty_world, point, sized, tap
from imgui_bundle import imgui

from physicslab import World, load_scene
from physicslab.components import Colour, Material, Name, Shape, Transform
from physicslab.history import SetField
from physicslab.prefabs import box
from physicslab.theme import DARK
from physicslab.view.picture.bodies import named_colour


def resting() -> tuple[Desk, int]:
    """Return a window with a box that rests on a floor, selected in a pause."""
    world = empty_world()
    world.spawn(Name("floor"), Transform((0.0, -1.5)), Shape.box(8.0, 0.5), Material(0.2, 0.5))
    body = box(world, (0.0, -0.95), width=0.6, height=0.6, mass=2.0)
    desk = sized((1280, 720), world)
    desk.frames(90)
    desk.window.pace.paused = True
    desk.window.selection.take(body)
    desk.frames(SETTLED)
    return desk, body


def test_forces_of_contacts_follow_a_weight_that_was_edited() -> None:
    desk, body = resting()
    tap(desk, "v")
    desk.frames(SETTLED)
    assert desk.ui.rows["Sum"] == "0 N"
    desk.window.edits.do(SetField(body, "Mass", "mass", 4.0))
    desk.frames(SETTLED)
    assert (desk.ui.rows["Weight"], desk.ui.rows["Normal, from floor"]) == ("39.24 N", "39.24 N")
    assert desk.ui.rows["Sum"] == "0 N"
    tap(desk, ".")
    desk.frames(SETTLED)
    assert desk.ui.rows["Sum"] == "0 N"


def test_each_energy_is_written_once() -> None:
    desk = sized((1280, 900), load_scene("drop"))
    desk.window.level = "Measure"
    desk.frames(20)
    for words in ("Kinetic energy", "Total energy", "Energy change"):
        values = [n for n, word in enumerate(desk.ui.words) if word == words]
        assert len(values) == (2 if words == "Kinetic energy" else 1), words  # it is the heading of its parts


@pytest.mark.parametrize("integrator", ["auto", "rk4", "leapfrog", "dop853"])
def test_what_a_method_costs_is_written_beside_it(integrator: str) -> None:
    world = load_scene("two_planets")
    world.simulation = replace(world.simulation, integrator=integrator)
    desk = sized((1280, 900), world)
    desk.window.level, desk.window.tool = "Engineer", "select"
    desk.frames(8)
    costs = "Solved in closed form" if integrator == "auto" else "of all forces a step"
    told = [words for words in desk.ui.words if costs in words]
    assert told
    if integrator == "rk4":
        assert "4 evaluations" in told[0] and "1/16 of the error" in told[0]


def test_what_is_written_of_a_body_has_its_own_colour() -> None:
    world = World()
    plain, green = (box(world, (float(x), 0.0)) for x in (0, 1))
    world.add(green, Colour("#00ff00"))
    world.synchronise()
    assert named_colour(world, DARK, green) == (0, 255, 0)
    assert named_colour(world, DARK, plain) == DARK.body(plain)
    world.remove(green)
    assert named_colour(world, DARK, green) == DARK.body(green)


def test_a_tip_lies_beside_the_panel_that_it_is_for() -> None:
    desk = sized((1280, 720))
    left, top, width, height = desk.ui.places["Measure"]
    point(desk, (left + width // 2, top + height // 2))
    desk.frames(60)
    desk.sandbox.interface.toolkit.enter()
    tips = [window for window in imgui.get_current_context().windows if "Tooltip" in window.name]
    (tip,) = (window for window in tips if window.active)
    assert tip.pos.x + tip.size.x <= desk.sandbox.interface.layout.side[0] + 1


def test_an_energy_below_zero_is_named_so_beside_its_colour() -> None:
    """It was called "-potential", as if there were a second kind of energy."""
    desk = sized((1280, 720), load_scene("solar_system"))
    assert {"kinetic", "potential < 0"} <= set(desk.ui.words)
