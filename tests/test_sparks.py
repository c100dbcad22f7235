"""Sparks: made by impacts, drawn by the window, gone soon."""

from dataclasses import replace

import numpy as np
import pytest
from desk import FRAME, Desk, empty_world
from recording import RecordingCanvas

from physicslab.components import Velocity
from physicslab.contacts.report import ImpactReader
from physicslab.prefabs import box, circle, stack
from physicslab.theme import DARK, PROJECTOR
from physicslab.view.canvas.camera import Camera
from physicslab.view.picture.sparks import Sparks
from physicslab.world import World


def meeting(speed: float, mass: float = 1.0, restitution: float = 0.5) -> World:
    """Return a world where two balls meet head-on at the origin, a few frames from now."""
    world = empty_world(gravity=(0, 0))
    for side in (-1, 1):
        ball = circle(world, (0.3 * side, 0), radius=0.25, mass=mass, restitution=restitution)
        world.component(ball, Velocity).linear = (-0.5 * side * speed, 0)
    return world


class Watched:
    """A world and the sparks of its impacts, at 100 px per metre."""

    def __init__(self, world: World) -> None:
        self.world, self.sparks, self._impacts = world, Sparks(), ImpactReader()
        self._impacts.follow(world)

    def frames(self, count: int = 1, steps: int = 1) -> None:
        """Let frames go by, of so many steps each."""
        for _ in range(count):
            for _ in range(steps):
                self.world.step(FRAME)
            self.sparks.advance(self._impacts.new(self.world), self.world.time, 100.0)


def first_sparks(world: World, frames: int = 60) -> Sparks:
    """Step until there are sparks, or for so many frames."""
    watched = Watched(world)
    for _ in range(frames):
        watched.frames()
        if len(watched.sparks):
            break
    return watched.sparks


def test_an_impact_makes_sparks_where_it_was() -> None:
    sparks = first_sparks(meeting(4.0))
    assert 3 <= len(sparks) <= 22
    assert np.allclose(sparks.place, (0, 0), atol=0.05)


def test_a_harder_impact_makes_more_and_faster_sparks() -> None:
    soft, hard = first_sparks(meeting(2.0, mass=0.2)), first_sparks(meeting(8.0, mass=3.0))
    assert len(hard) > 2 * len(soft) > 0
    assert np.hypot(*hard.velocity.T).max() > np.hypot(*soft.velocity.T).max()


def test_an_impact_that_takes_no_energy_has_a_ring_and_no_sparks() -> None:
    watched = Watched(meeting(6.0, restitution=1.0))
    while not len(watched.sparks.rings):
        watched.frames()
        assert watched.world.steps < 60
    assert not len(watched.sparks) and np.allclose(watched.sparks.rings[0, :2], (0, 0), atol=0.05)
    canvas = RecordingCanvas((400, 300))
    watched.sparks.draw(Camera(canvas.size), DARK, canvas)
    (ring,) = canvas.called("lines")
    assert ring["colour"] == DARK.spark and 3.0 <= np.hypot(*(ring["start"] - (200, 150)).T).max() <= 16.0
    watched.frames(12)
    assert not len(watched.sparks.rings)


def test_no_spark_flies_into_a_floor() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=0.5)
    for x in range(-3, 4):
        ball = circle(world, (x, 1), radius=0.2, mass=3.0, restitution=0.2)
        world.component(ball, Velocity).linear = (1.0, -5.0)
    sparks = first_sparks(world)
    assert len(sparks) > 20 and (sparks.place[:, 1] >= -1e-6).all() and (sparks.velocity[:, 1] >= -1e-9).all()


def test_no_ring_is_drawn_into_a_floor_a_wall_or_a_ceiling() -> None:
    for side, gravity in ((1.0, -9.81), (-1.0, 9.81)):
        world = empty_world(gravity=(0.0, gravity))
        box(world, (0, -0.5 * side), width=20, height=1, static=True, restitution=1.0)
        circle(world, (0, 0.3 * side), radius=0.25, velocity=(0.0, -5.0 * side), restitution=1.0)
        watched, canvas = Watched(world), RecordingCanvas((400, 300))
        while not len(watched.sparks.rings):
            watched.frames()
        watched.sparks.draw(Camera(canvas.size), DARK, canvas)
        (ring,) = canvas.called("lines")
        above = side * (150.0 - ring["start"][:, 1])
        assert (above >= -0.5).all() and above.max() > 3.0


def test_sparks_are_light_on_dark_and_ink_on_paper() -> None:
    sparks = first_sparks(meeting(6.0, mass=3.0))
    for theme, lights in ((DARK, 1), (PROJECTOR, 0)):
        canvas = RecordingCanvas((400, 300))
        sparks.draw(Camera(canvas.size), theme, canvas)
        assert len(canvas.called("glows")) == lights and canvas.called("lines")


def test_contacts_at_rest_and_faint_ones_make_none() -> None:
    assert not len(first_sparks(meeting(0.2), frames=120))
    world = empty_world()
    box(world, (0, -0.5), width=20, height=1, static=True)
    stack(world, 3)
    world.run(seconds=1.0)
    assert world.contacts.count
    assert not len(first_sparks(world))


def test_they_move_apart_and_go_out() -> None:
    watched = Watched(meeting(6.0))
    while not len(watched.sparks):
        watched.frames()
        assert watched.world.steps < 60
    begun = len(watched.sparks)
    watched.frames()
    assert len(watched.sparks) == begun and np.hypot(*watched.sparks.place.T).max() > 0.02
    watched.frames(24)
    assert not len(watched.sparks)


@pytest.mark.parametrize("collisions", ["exact", "step"])
def test_sparks_do_not_depend_on_how_many_steps_a_frame_has(collisions: str) -> None:
    seen = []
    for steps in (1, 2, 4):
        world = meeting(5.0)
        world.simulation = replace(world.simulation, collisions=collisions)
        watched = Watched(world)
        watched.frames(12 // steps, steps)
        seen.append(watched.sparks)
    assert len(seen[0])
    for other in seen[1:]:
        assert np.allclose(seen[0].place, other.place) and np.allclose(seen[0].age, other.age)


def test_the_same_run_makes_the_same_sparks() -> None:
    one, other = first_sparks(meeting(5.0)), first_sparks(meeting(5.0))
    assert np.array_equal(one.velocity, other.velocity) and np.array_equal(one.life, other.life)
    assert len(np.unique(one.velocity)) == one.velocity.size


def test_there_are_never_too_many() -> None:
    world = empty_world(gravity=(0, 0))
    for n in range(150):
        for side in (-1, 1):
            ball = circle(world, (0.28 * side, 0.6 * n), radius=0.25, mass=5.0, restitution=0.3)
            world.component(ball, Velocity).linear = (-4 * side, 0)
    assert len(first_sparks(world)) == 400


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


def test_they_go_out_where_time_is_set_back() -> None:
    watched = Watched(meeting(6.0))
    while not len(watched.sparks):
        watched.frames()
        assert watched.world.steps < 60
    none = watched.world.contacts.impacts[:0]
    watched.sparks.advance(none, watched.world.time, 100.0)
    assert len(watched.sparks)
    watched.sparks.advance(none, 0.0, 100.0)
    assert not len(watched.sparks) and not len(watched.sparks.rings)


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
