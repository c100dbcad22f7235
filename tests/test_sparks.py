"""Sparks: struck by impacts, drawn by the window, gone soon."""

import numpy as np
import pytest
from desk import FRAME, Desk, empty_world

from physicslab.components import Velocity
from physicslab.prefabs import box, circle, stack
from physicslab.view.canvas.canvas import RecordingCanvas
from physicslab.view.canvas.theme import DARK
from physicslab.view.picture.sparks import Sparks
from physicslab.world import World


def meeting(speed: float, mass: float = 1.0) -> World:
    """Return a world where two balls meet head-on at the origin, a few frames from now."""
    world = empty_world(gravity=(0, 0))
    for side in (-1, 1):
        ball = circle(world, (0.3 * side, 0), radius=0.25, mass=mass, restitution=1.0)
        world.component(ball, Velocity).linear = (-0.5 * side * speed, 0)
    return world


def impact_count(world: World, steps: int = 60) -> Sparks:
    """Step until there are sparks, or for so many steps."""
    sparks = Sparks()
    for _ in range(steps):
        world.step(FRAME)
        sparks.advance(world, FRAME, 100.0)
        if len(sparks):
            break
    return sparks


def test_an_impact_strikes_sparks_where_it_was() -> None:
    sparks = impact_count(meeting(4.0))
    assert 3 <= len(sparks) <= 18
    assert np.allclose(sparks.place, (0, 0), atol=0.05)


def test_a_harder_impact_makes_more_and_faster_sparks() -> None:
    soft, hard = impact_count(meeting(2.0, mass=0.2)), impact_count(meeting(8.0, mass=3.0))
    assert len(hard) > 2 * len(soft) > 0
    assert np.hypot(*hard.velocity.T).max() > np.hypot(*soft.velocity.T).max()


def test_contacts_at_rest_and_faint_ones_make_none() -> None:
    assert not len(impact_count(meeting(0.2), steps=120))
    world = empty_world()
    box(world, (0, -0.5), width=20, height=1, static=True)
    stack(world, 3)
    world.run(seconds=1.0)
    assert world.contacts.count
    assert not len(impact_count(world, steps=60))


def test_they_fly_apart_and_go_out() -> None:
    world = meeting(6.0)
    sparks = impact_count(world)
    begun = len(sparks)
    world.step(FRAME)
    sparks.advance(world, FRAME, 100.0)
    assert len(sparks) == begun and np.hypot(*sparks.place.T).max() > 0.02
    for _ in range(24):
        world.step(FRAME)
        sparks.advance(world, FRAME, 100.0)
    assert not len(sparks)


def test_the_same_run_makes_the_same_sparks() -> None:
    one, other = impact_count(meeting(5.0)), impact_count(meeting(5.0))
    assert np.array_equal(one.velocity, other.velocity) and np.array_equal(one.life, other.life)
    assert len(np.unique(one.velocity)) == one.velocity.size


def test_there_are_never_too_many() -> None:
    world = empty_world(gravity=(0, 0))
    for n in range(150):
        for side in (-1, 1):
            ball = circle(world, (0.28 * side, 0.6 * n), radius=0.25, mass=5.0, restitution=1.0)
            world.component(ball, Velocity).linear = (-4 * side, 0)
    assert len(impact_count(world)) == 400


def test_they_stand_still_with_the_world_and_r_puts_them_out() -> None:
    desk = Desk(meeting(4.0))
    while not len(desk.window.sparks):
        desk.frames()
        assert desk.world.steps < 60
    desk.key("space")
    desk.frames()
    place, age = desk.window.sparks.place.copy(), desk.window.sparks.age.copy()
    desk.frames(30)
    assert np.array_equal(desk.window.sparks.place, place)
    assert np.array_equal(desk.window.sparks.age, age)
    desk.key("r")
    desk.frames()
    assert not len(desk.window.sparks)


@pytest.mark.parametrize("zoom", [0.1, 1.0, 30.0])
def test_they_are_drawn_in_the_colour_of_the_theme(zoom: float) -> None:
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(meeting(4.0), canvas)
    while not len(desk.window.sparks):
        desk.frames()
        assert desk.world.steps < 60
    desk.window.camera.scale = 100.0 * zoom
    canvas.calls.clear()
    desk.frames()
    drawn = [call for call in canvas.called("lines") if call["colour"] == DARK.spark]
    assert drawn and all(((call["opacity"] > 0.0) & (call["opacity"] <= 1.0)).all() for call in drawn)
