"""Centres of mass, momenta, and the parts of arrows along x and y."""

import numpy as np
import pygame
import pytest
from desk import Desk, empty_world
from recording import RecordingCanvas

from physicslab.components import Velocity
from physicslab.prefabs import box, circle
from physicslab.theme import DARK


def two() -> tuple[Desk, RecordingCanvas, list[int]]:
    """Return a paused window with 1 kg at x = -1 m and 3 kg at x = 1 m, of 2 and -1 m/s, and a wall."""
    world = empty_world(gravity=(0, 0))
    bodies = [circle(world, (x, 0), radius=0.1, mass=mass) for x, mass in ((-1.0, 1.0), (1.0, 3.0))]
    for body, velocity in zip(bodies, ((2.0, 0.5), (-1.0, 0.0)), strict=True):
        world.component(body, Velocity).linear = velocity
    box(world, (5, 0), width=1, height=1, static=True)
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(world, canvas)
    desk.window.pace.paused = True
    desk.frames()
    return desk, canvas, bodies


def shown(desk: Desk, canvas: RecordingCanvas) -> None:
    canvas.calls.clear()
    desk.frames()


def test_the_centre_of_mass_is_that_of_all_and_of_the_selected() -> None:
    desk, canvas, bodies = two()
    desk.key("c", pygame.KMOD_SHIFT)
    shown(desk, canvas)
    (mark,) = [call for call in canvas.called("discs") if tuple(call["look"].rim[0]) == DARK.heading]
    assert mark["centre"] == pytest.approx(desk.window.camera.project(np.array([(0.5, 0.0)])))
    assert "centre of mass" in canvas.words
    third = circle(desk.world, (0, 2), radius=0.1, mass=4.0)
    desk.window.selection.entities = tuple(bodies)
    shown(desk, canvas)
    marks = [call for call in canvas.called("discs") if tuple(call["look"].rim[0]) == DARK.heading]
    places = np.concatenate([call["centre"] for call in marks])
    expected = desk.window.camera.project(np.array([(0.25, 1.0), (0.5, 0.0)]))
    assert places == pytest.approx(expected) and "of the selected" in canvas.words and third


def test_momenta_are_in_proportion_and_the_total_is_their_sum() -> None:
    desk, canvas, _ = two()
    desk.key("v", pygame.KMOD_SHIFT)
    shown(desk, canvas)
    shafts = next(call for call in canvas.called("lines") if call["colour"] == DARK.planet)
    span = shafts["end"] - shafts["start"]
    metre = desk.window.camera.scale / desk.window.overlays.momentum.per_metre
    assert span == pytest.approx(metre * np.array([(2.0, -0.5), (-3.0, 0.0)]))
    desk.key("c", pygame.KMOD_SHIFT)
    shown(desk, canvas)
    long = [c for c in canvas.called("lines") if c["colour"] == DARK.planet and len(c["start"]) == 1]
    assert (long[0]["end"] - long[0]["start"]) == pytest.approx(metre * np.array([(-1.0, -0.5)]))


def test_parts_of_velocities_go_along_x_and_y() -> None:
    desk, canvas, _ = two()
    desk.key("v")
    desk.key("x", pygame.KMOD_SHIFT)
    shown(desk, canvas)
    fine = [c for c in canvas.called("lines") if c["colour"] == DARK.velocity and c["width"] == 1.3]
    shaft = fine[0]
    assert np.abs((shaft["end"] - shaft["start"])[:, 1]).max() < 1e-9, "first those along x"
