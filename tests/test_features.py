"""The sandbox window, row by row: what each input does, driven by SDL's events against a real world."""

import math

import numpy as np
import pygame
import pytest
from desk import FRAME, Desk, empty_world
from recording import RecordingCanvas
from test_arrows import lines_in
from test_hud import row

from physicslab.components import Held, Rod, Shape, Trail, Transform, Velocity
from physicslab.contacts.report import count_near_pairs
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.ecs.config import WindowConfig
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, circle
from physicslab.theme import DARK, Colour
from physicslab.view.canvas.quantities import quantity
from physicslab.world import World


@pytest.fixture
def desk() -> Desk:
    return Desk(empty_world(gravity=(0, 0)))


def watched(world: World, *keys: str) -> tuple[Desk, RecordingCanvas]:
    """Return a desk whose canvas takes note, with some keys pressed."""
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(world, canvas)
    for key in keys:
        desk.key(key)
    return desk, canvas


def last_frame(desk: Desk, canvas: RecordingCanvas) -> None:
    """Read the figures again, and keep what one frame draws."""
    desk.frames(8)
    canvas.calls.clear()
    desk.frames()


def collision(offset: float = 0.0) -> World:
    """Return a world where two balls meet after two steps, head-on or not."""
    world = empty_world(gravity=(0, 0))
    a = {"radius": 0.25, "mass": 2.0, "restitution": 0.8, "friction": 0.5}
    circle(world, (-0.35, 0), velocity=(4, 0), **a)  # type: ignore[arg-type]
    circle(world, (0.35, offset), velocity=(-2, 0), **a)  # type: ignore[arg-type]
    return world


def place(desk: Desk, entity: int) -> Vector2:
    return desk.world.component(entity, Transform).position


def velocity(desk: Desk, entity: int) -> Vector2:
    return desk.world.component(entity, Velocity).linear


# The window


def test_the_window_is_1280_by_720_at_60_frames_and_100_px_per_metre() -> None:
    config = WindowConfig()
    assert (config.size, config.fps, config.pixels_per_metre) == ((1280, 720), 60, 100.0)


# Left click


def test_left_click_on_a_body_drags_it_infinitely_heavy(desk: Desk) -> None:
    ball, other = circle(desk.world, (0, 0), radius=0.2), circle(desk.world, (1, 0), radius=0.2, mass=1e6)
    desk.press(0, 0)
    desk.frames()
    assert desk.world.has(ball, Held)
    assert desk.world.bodies.inverse_mass[desk.world.entity_index.row_of[ball]] == 0.0
    for n in range(1, 13):
        desk.move(0.1 * n, 0)
        desk.frames()
        assert place(desk, ball).x == pytest.approx(0.1 * n, abs=0.006)  # the cursor is on a whole pixel
    assert velocity(desk, other).x > 3.0


def test_left_click_on_empty_space_spawns_a_circle(desk: Desk) -> None:
    desk.press(1.5, -0.5)
    desk.release(1.5, -0.5)
    desk.frames()
    (ball,) = desk.world.entities()
    assert desk.world.component(ball, Shape).kind == "circle"
    assert place(desk, ball) == Vector2(1.5, -0.5)


# Left release


@pytest.mark.parametrize("speed", [(3.0, 0.0), (-2.4, 1.8), (0.6, -4.2)])
def test_left_release_throws_at_the_velocity_of_the_cursor(desk: Desk, speed: tuple[float, float]) -> None:
    ball = circle(desk.world, (0, 0))
    desk.drag((0, 0), speed, frames=30)
    desk.frames()
    assert not desk.world.has(ball, Held)
    assert (velocity(desk, ball) - Vector2(*speed)).magnitude < 0.02 * math.hypot(*speed)


def test_left_release_throws_no_faster_than_the_cap() -> None:
    desk = Desk(empty_world(gravity=(0, 0)), config=WindowConfig(max_throw_speed=5.0))
    ball = circle(desk.world, (-6, -3))
    desk.drag((-6, -3), (32.0, 24.0), frames=12)
    desk.frames()
    assert velocity(desk, ball).magnitude == pytest.approx(5.0)
    assert velocity(desk, ball).angle == pytest.approx(math.atan2(3, 4), abs=0.01)


def test_left_release_after_150_ms_of_rest_throws_nothing(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    desk.press(0, 0)
    for n in range(20):
        desk.move(0.1 * n, 0)
        desk.frames()
    desk.frames(9)
    desk.release(1.9, 0)
    desk.frames()
    assert velocity(desk, ball) == Vector2(0, 0)


# The hand in odd places


@pytest.mark.parametrize("scale", [4.0, 100.0, 2500.0])
@pytest.mark.parametrize("paused", [False, True])
def test_dragging_works_at_any_zoom_paused_or_not(desk: Desk, scale: float, paused: bool) -> None:
    desk.window.camera.look_at((3.0, -2.0, 3.0, -2.0), scale)
    size = 100.0 / scale
    ball = circle(desk.world, (3, -2), radius=0.2 * size)
    if paused:
        desk.key("space")
    desk.press(3 + 0.1 * size, -2)
    desk.frames()
    desk.move(3 + 1.1 * size, -2 + 1.5 * size)
    desk.frames()
    assert (place(desk, ball) - Vector2(3 + size, -2 + 1.5 * size)).magnitude < 1e-9 * size
    desk.release(3 + 1.1 * size, -2 + 1.5 * size)
    desk.frames()
    assert not desk.world.has(ball, Held)


def test_dragging_takes_the_topmost_of_bodies_that_overlap(desk: Desk) -> None:
    box(desk.world, (0, 0), width=1, height=1)
    below, above = circle(desk.world, (0, 0), radius=0.3), circle(desk.world, (0.1, 0), radius=0.3)
    desk.key("space")
    desk.press(0.05, 0)
    desk.frames()
    desk.move(0.06, 0)  # while time stands still a body is held once the hand moves
    desk.frames()
    assert desk.world.has(above, Held) and not desk.world.has(below, Held)


@pytest.mark.parametrize("out", [(-8.0, 0.0), (8.0, 1.0), (0.0, 5.0), (-2.0, -5.0)])
def test_dragging_goes_on_across_the_edge_and_a_release_out_there_lets_go(
    desk: Desk, out: tuple[float, float]
) -> None:
    ball = circle(desk.world, (0, 0))
    desk.press(0, 0)
    desk.frames()
    for n in range(1, 11):
        desk.move(0.1 * n * out[0], 0.1 * n * out[1])
        desk.frames()
    assert (place(desk, ball) - Vector2(*out)).magnitude < 0.01
    desk.release(*out)
    desk.frames()
    assert not desk.world.has(ball, Held) and velocity(desk, ball).magnitude > 1.0
    assert desk.world.entities() == [ball]


@pytest.mark.parametrize("paused", [False, True])
@pytest.mark.parametrize("event", [pygame.WINDOWFOCUSLOST, pygame.WINDOWMINIMIZED, pygame.WINDOWHIDDEN])
def test_leaving_the_window_never_leaves_a_body_stuck(desk: Desk, event: int, paused: bool) -> None:
    ball = circle(desk.world, (0, 0))
    if paused:
        desk.key("space")
    desk.press(0, 0)
    desk.move(0.5, 0)
    desk.frames(3)
    pygame.event.post(pygame.Event(event))
    desk.frames()
    assert not desk.world.has(ball, Held)
    desk.release(0.5, 0)  # reported late
    desk.frames()
    assert desk.world.entities() == [ball] and velocity(desk, ball) == Vector2(0, 0)
    desk.press(0.5, 0)
    desk.frames()
    desk.move(0.51, 0)
    desk.frames()
    assert desk.world.has(ball, Held)


# Right click and the keys


def test_right_click_spawns_a_rectangle(desk: Desk) -> None:
    desk.press(-2, 1, "right")
    desk.release(-2, 1, "right")
    desk.frames()
    (block,) = desk.world.entities()
    assert desk.world.component(block, Shape).kind == "box" and place(desk, block) == Vector2(-2, 1)


def test_p_spawns_a_pendulum_at_the_cursor() -> None:
    desk = Desk(empty_world())
    desk.move(0.5, 2.0)
    desk.key("p")
    desk.frames()
    (bob,) = desk.world.entities()
    assert desk.world.component(bob, Rod).anchor_b == Vector2(0.5, 2.0)
    before = place(desk, bob)
    desk.frames(20)
    assert (place(desk, bob) - before).magnitude > 0.1


def test_space_pauses_and_resumes(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0), velocity=(1, 0))
    desk.key("space")
    desk.frames(30)
    assert place(desk, ball) == Vector2(0, 0) and desk.world.time == 0.0
    desk.key("space")
    desk.frames(30)
    assert place(desk, ball).x == pytest.approx(30 * FRAME)


def test_r_clears_bodies_springs_trails_and_sparks() -> None:
    world = collision()
    desk, canvas = watched(world, "t", "p")
    desk.frames(4)
    assert world.batch(Rod).entities.size and world.batch(Trail).entities.size and len(desk.window.sparks)
    desk.key("r")
    last_frame(desk, canvas)
    assert world.entities() == [] and not len(desk.window.sparks)
    assert not canvas.called("strokes") and not lines_in(canvas, DARK.spark)


def test_g_turns_linear_gravity_off_and_on() -> None:
    desk = Desk(empty_world())
    ball = circle(desk.world, (0, 0))
    desk.key("g")
    desk.frames(6)
    assert velocity(desk, ball) == Vector2(0, 0)
    desk.key("g")
    desk.frames(6)
    assert velocity(desk, ball).y == pytest.approx(-9.81 * 6 * FRAME)


def test_o_is_the_inverse_square_gravity_of_planets() -> None:
    pull = []
    for distance in (1.0, 2.0):
        desk = Desk(empty_world())
        circle(desk.world, (0, 0), radius=0.1, mass=3.0)
        ball = circle(desk.world, (distance, 0), radius=0.1, mass=1.0)
        desk.key("o")
        desk.frames()
        assert desk.world.physics.gravity_mode == "planet"
        pull.append(-velocity(desk, ball).x)
    assert pull[0] == pytest.approx(4.0 * pull[1], rel=2e-3) and pull[0] > 0.0


def test_tab_is_slow_motion_at_a_quarter(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0), velocity=(1, 0))
    desk.key("tab")
    desk.frames(60)
    assert place(desk, ball).x == pytest.approx(0.25)


def test_v_shows_velocity_force_and_contact_normals() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=10, height=1, static=True)
    ball = circle(world, (0, 0.25), radius=0.25, velocity=(1, 0))
    circle(world, (3, 2), radius=0.25)  # the net force on the other is none
    desk, canvas = watched(world, "v")
    last_frame(desk, canvas)
    legend = 2  # lines of its sample of each kind: a shaft and a head
    ends: dict[Colour, tuple[float, float]] = {}
    for colour in (DARK.velocity, DARK.force, DARK.contact_normal):
        shaft, *rest = lines_in(canvas, colour)
        assert len(rest) == 1 + legend
        dx, dy = (shaft["end"] - shaft["start"])[0].tolist()
        ends[colour] = dx, dy
    metre = desk.window.camera.scale / desk.window.overlays.velocity.per_metre
    assert ends[DARK.velocity] == pytest.approx((velocity(desk, ball).x * metre, 0.0), abs=1.0)
    assert ends[DARK.force][0] == pytest.approx(0.0) and ends[DARK.force][1] > 0.0  # down
    assert ends[DARK.contact_normal][0] == pytest.approx(0.0, abs=1e-6) and ends[DARK.contact_normal][1] < 0.0
    desk.key("v")
    last_frame(desk, canvas)
    assert not any(lines_in(canvas, colour) for colour in ends)


def test_t_shows_trails_that_fade_toward_the_background() -> None:
    world = empty_world(gravity=(0, 0))
    circle(world, (-3, 0), velocity=(3, 0))
    circle(world, (0, 2))
    desk, canvas = watched(world, "t")
    desk.frames(60)
    last_frame(desk, canvas)
    (trail,) = canvas.called("strokes")
    contrast = np.abs(trail["colour"].astype(int) - DARK.background).sum(axis=1)
    assert (np.diff(contrast) >= 0).all() and contrast[0] < 0.5 * contrast[-1]
    assert np.hypot(*(trail["end"][-1] - trail["start"][0])) > 200.0
    assert trail["end"][:, 1] == pytest.approx(360.0)  # and none behind the body at rest
    desk.key("t")
    last_frame(desk, canvas)
    assert not canvas.called("strokes")


def test_e_shows_impulses_with_the_speed_of_approach() -> None:
    desk, canvas = watched(collision(offset=0.2), "e")
    last_frame(desk, canvas)
    (touch,) = desk.window.overlays.impacts.recent(desk.world.time)
    assert len(lines_in(canvas, DARK.normal_impulse)) > 4 and len(lines_in(canvas, DARK.friction_impulse)) > 4
    assert f"impact at {quantity(float(touch['speed']), 'm/s')}" in canvas.words
    assert 5.0 < touch["speed"] < 6.0
    desk.key("e")
    last_frame(desk, canvas)
    assert not lines_in(canvas, DARK.normal_impulse)


def test_escape_quits(desk: Desk) -> None:
    assert not desk.window.closing
    desk.key("escape")
    desk.frames()
    assert desk.window.closing


# Also


def test_collisions_make_sparks() -> None:
    desk, canvas = watched(collision())
    desk.frames(2)
    canvas.calls.clear()
    desk.frames(2)
    assert len(desk.window.sparks) >= 3
    (streaks,) = lines_in(canvas, DARK.spark)[-1:]
    assert np.hypot(*(streaks["end"] - (640.0, 360.0)).T).max() < 60.0
    desk.frames(40)
    assert not len(desk.window.sparks)


def test_the_palette_varies_what_is_spawned() -> None:
    desk, canvas = watched(empty_world(gravity=(0, 0)))
    for n in range(len(DARK.bodies)):
        desk.press(n - 3, 0)
        desk.release(n - 3, 0)
    last_frame(desk, canvas)
    (discs,) = canvas.called("discs")
    assert {tuple(rim) for rim in discs["look"].rim.tolist()} == set(DARK.bodies)


def test_the_hud_shows_what_there_is() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=10, height=1, static=True)
    circle(world, (-1, 0.25), radius=0.25, mass=2.0, velocity=(1, 0), angular_velocity=-4.0)
    circle(world, (2, 3))
    desk, _ = watched(world)
    desk.window.level = "Engineer"
    desk.frames(20)
    desk.key("space")  # so that the figures are of now
    desk.frames(30)
    energy, momentum = measure_energy(world), measure_momentum(world)
    assert energy.kinetic == energy.kinetic_linear + energy.kinetic_angular and energy.kinetic_angular > 0.0
    assert row(desk, "Frame rate") == "60 FPS"
    assert row(desk, "Bodies") == "3"
    assert row(desk, "Candidate pairs") == str(count_near_pairs(world))
    assert row(desk, "Contacts") == str(world.contacts.count) == "1"
    assert row(desk, "Kinetic energy") == quantity(energy.kinetic, "J")
    assert row(desk, "Total momentum") == quantity(momentum.linear.magnitude, "kg m/s")


@pytest.mark.parametrize(
    ("key", "banner"), [("space", "PAUSED"), ("tab", "SLOW MOTION 0.25x"), ("o", "PLANET MODE")]
)
def test_a_banner_says_what_is_not_as_usual(key: str, banner: str) -> None:
    desk, canvas = watched(empty_world())
    last_frame(desk, canvas)
    assert banner not in canvas.words
    desk.key(key)
    last_frame(desk, canvas)
    assert banner in canvas.words
    desk.key(key)
    last_frame(desk, canvas)
    assert banner not in canvas.words
