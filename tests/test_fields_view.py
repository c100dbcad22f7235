"""Fields and thrusts in the picture, and the laws of charges in the panel."""

import numpy as np
import pygame
import pytest
from desk import Desk, fill
from recording import RecordingCanvas

from physicslab import World, load_scene
from physicslab.components import Charge, Mass, Thrust, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.theme import DARK
from physicslab.view.canvas.camera import Camera
from physicslab.view.picture.fields import draw_fields, draw_flames

CAMERA = Camera((640, 480), scale=100.0)


@pytest.mark.parametrize(("field", "dots"), [(2.0, True), (-2.0, False)])
def test_a_magnetic_field_has_dots_or_crosses_that_stay_in_the_world(field: float, dots: bool) -> None:
    world, canvas = World(physics=PhysicsConfig(magnetic_field=field)), RecordingCanvas((640, 480))
    draw_fields(world, CAMERA, DARK, canvas)
    assert not canvas.called("discs") + canvas.called("lines"), "nothing there is charged"
    world.spawn(Transform(), Velocity(), Mass(1.0), Charge(1.0))
    draw_fields(world, CAMERA, DARK, canvas)
    assert (len(canvas.called("discs")), len(canvas.called("lines"))) == ((1, 0) if dots else (0, 2))
    marks = canvas.called("discs")[0]["centre"] if dots else canvas.called("lines")[0]["start"]
    assert np.unique(np.diff(np.unique(marks[:, 0]))) == pytest.approx(100.0), "a metre apart"


def test_an_electric_field_has_arrows_along_it_and_a_thrust_a_flame_against_it() -> None:
    world, canvas = (
        World(physics=PhysicsConfig(electric_field=Vector2(0.0, 3.0))),
        RecordingCanvas((640, 480)),
    )
    thrust = Thrust((2.0, 0.0), frame="body", at=(-0.5, 0.0))
    world.spawn(Transform(angle=0.5 * np.pi), Velocity(), Mass(1.0), Charge(1.0), thrust)
    draw_fields(world, CAMERA, DARK, canvas)
    shafts = canvas.called("lines")[0]
    assert np.allclose(shafts["end"] - shafts["start"], (0.0, -20.0)), "up, which is less on the screen"
    draw_flames(world, CAMERA, DARK, canvas)
    flame = canvas.called("lines")[3]
    assert flame["start"] == pytest.approx(np.array([(320.0, 290.0)])), "half a metre below the middle"
    assert flame["end"] - flame["start"] == pytest.approx(np.array([(0.0, 48.0)])), "downwards"


def test_the_panel_has_the_softening_of_planets() -> None:
    """What helps where two fall into each other could not be set in the window."""
    desk = Desk(load_scene("two_planets"))
    desk.window.level = "Engineer"
    desk.frames(3)
    fill(desk, "softening", "10 cm")
    assert desk.world.physics.softening == 0.1
    pygame.display.quit()


def test_the_panel_has_the_laws_of_charges_where_there_are_any() -> None:
    desk = Desk(load_scene("crossed_fields"))
    desk.window.level = "Engineer"
    desk.frames(3)
    fill(desk, "magnetic_field", "2 mT")
    fill(desk, "electric_field.y", "3 V/m")
    assert desk.world.physics.magnetic_field == 2e-3
    assert desk.world.physics.electric_field == Vector2(0.0, 3.0)
    pygame.display.quit()
