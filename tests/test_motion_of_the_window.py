"""The motion of the window itself: views glide, notices fade, a throw is seen before it is made."""

import numpy as np
import pygame
import pytest
from desk import FRAME, Desk, empty_world, tap
from recording import RecordingCanvas

from physicslab.components import Pin
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import circle
from physicslab.theme import DARK
from physicslab.view.canvas.camera import Camera
from physicslab.view.window.motion import GLIDE, Glide


@pytest.mark.parametrize("scale", [100.0, 250.0])
def test_the_picture_glides_to_another_view_while_places_are_read_by_the_new_one(scale: float) -> None:
    glide, shown = Glide(), Camera((800, 600), scale=100.0)
    camera = Camera((800, 600), centre=Vector2(2.0, 1.0), scale=scale)
    glide.begin(shown, 1.0)
    seen = [glide.shown(camera, 1.0 + share * GLIDE) for share in np.linspace(0.0, 0.99, 8)]
    x, scales = [one.centre.x for one in seen], [one.scale for one in seen]
    assert x[0] == pytest.approx(0.0) and scales[0] == pytest.approx(100.0)
    assert x == sorted(x) and scales == sorted(scales) and x[-1] == pytest.approx(2.0, abs=1e-3)
    assert glide.runs(1.0 + 0.5 * GLIDE) and glide.shown(camera, 1.0 + GLIDE) is camera
    assert not glide.runs(1.0 + GLIDE)


def test_a_zoom_leaves_the_place_under_the_cursor_where_it_is_all_the_way() -> None:
    glide, shown, camera = Glide(), Camera((800, 600)), Camera((800, 600))
    at = (600.0, 200.0)
    place = camera.to_world(at)
    camera.zoom(3.0, at)
    glide.begin(shown, 0.0)
    for share in (0.1, 0.4, 0.8):
        assert glide.shown(camera, share * GLIDE).to_screen(place) == pytest.approx(at, abs=1e-6)


@pytest.mark.parametrize("reduced", [False, True])
def test_keys_glide_unless_motion_is_reduced(reduced: bool) -> None:
    world = empty_world()
    circle(world, (4, 3), radius=0.3)
    desk = Desk(world)
    desk.window.reduced_motion = reduced
    desk.frames()
    desk.key("f")
    desk.frames()
    assert desk.window.glide.runs(desk.window.now) is not reduced
    eased, camera = desk.window.drawing.camera, desk.window.camera
    assert (eased.scale == camera.scale) is reduced
    desk.frames(15)
    assert desk.window.drawing.camera is camera


def test_a_notice_comes_and_goes_softly() -> None:
    desk = Desk(empty_world())
    desk.window.reduced_motion = False
    desk.window.notify("done", 0.5)
    shares = []
    for _ in range(28):
        desk.frames()
        shares.append(desk.window.notice_share)
    top = shares.index(1.0)
    assert 0.0 < shares[0] < 1.0 and shares[:top] == sorted(shares[:top]) and shares[-1] < 0.5
    desk.window.notify("at once", 0.5)
    desk.window.reduced_motion = True
    assert desk.window.notice_share == 1.0


def test_a_throw_is_seen_before_it_is_made_and_is_the_one_that_is_made() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0), radius=0.3)
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(world, canvas)
    desk.press(0.1, 0.0)
    desk.frames()
    for n in range(12):
        desk.move(0.1 + 0.05 * (n + 1), 0.0)
        canvas.calls.clear()
        desk.frames()
    arrow = next(c for c in canvas.called("lines") if c["colour"] == DARK.velocity)
    span = (arrow["end"] - arrow["start"])[0]
    assert span == pytest.approx((0.2 * 100.0 * 3.0, 0.0), rel=0.05)  # 0.05 m in each frame of 1/60 s
    assert any(words.endswith("m/s") for words in canvas.words)
    said = desk.window.hand.throw(desk.window.now)
    desk.release(0.7, 0.0)
    desk.frames()
    assert desk.world.component(ball, type(world.components(ball)[1])) is not None
    assert said.x == pytest.approx(3.0, rel=0.1)


def test_the_pivot_under_the_cursor_is_marked() -> None:
    world = empty_world()
    bob = circle(world, (0.0, -1.0), radius=0.2)
    world.spawn(Pin(a=bob, anchor_a=(0.0, 1.0)))
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(world, canvas)
    desk.window.tool, desk.window.pace.paused = "select", True
    desk.move(0.0, 0.0)
    desk.frames(2)
    canvas.calls.clear()
    desk.frames(int(0.2 / FRAME))
    assert [c for c in canvas.called("lines") if c["colour"] == DARK.accent and c["width"] == 15.0]


@pytest.mark.parametrize(("key", "words"), [("s", "Sound is"), ("f2", "Reduced motion is")])
def test_a_switch_that_no_picture_shows_is_told(key: str, words: str) -> None:
    desk = Desk(empty_world(), RecordingCanvas((1280, 720)))
    told = []
    for _ in range(2):
        tap(desk, key, pygame.KMOD_LSHIFT)
        told.append(desk.window.notice)
    assert sorted(told) == [f"{words} off", f"{words} on"]
