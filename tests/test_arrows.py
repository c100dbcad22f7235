"""Velocities, forces and normals as arrows, and the legend that explains them."""

import itertools
import math
from typing import Any

import numpy as np
import pygame
import pytest
from desk import Desk, empty_world
from recording import RecordingCanvas
from test_hud import MeasuringCanvas

from physicslab.components import Velocity
from physicslab.diagnostics.free_body import applied_forces
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene
from physicslab.languages.language import language
from physicslab.prefabs import box, circle
from physicslab.state import contents
from physicslab.theme import DARK, Colour
from physicslab.view.canvas.camera import Camera, Drawing
from physicslab.view.overlay.arrows import (
    CONTACT_NORMAL,
    FORCE,
    FRICTION_IMPULSE,
    MIN_LENGTH,
    NORMAL_IMPULSE,
    VELOCITY,
    dashes,
    draw_arrows,
    max_length,
)
from physicslab.view.overlay.forces import NORMAL_LENGTH
from physicslab.view.overlay.legend import Gauge, legends_of
from physicslab.world import World

KINDS = (VELOCITY, FORCE, CONTACT_NORMAL, NORMAL_IMPULSE, FRICTION_IMPULSE)


def lines_in(canvas: RecordingCanvas, colour: Colour) -> list[dict[str, Any]]:
    """Return the lines of a colour; of arrows, first their shafts, then their heads."""
    return [call for call in canvas.called("lines") if call["colour"] == colour]


def shown(world: World, *keys: str, frames: int = 1, paused: bool = True) -> tuple[Desk, RecordingCanvas]:
    """Press keys, let frames go by, and keep what the last one drew in the middle of the picture."""
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(world, canvas)
    for key in (*keys, *(["space"] if paused else [])):
        desk.key(key)
    desk.frames(frames)
    canvas.calls.clear()
    desk.frames()
    return desk, canvas


def test_kinds_differ_in_head_and_in_colour() -> None:
    assert len({kind.head for kind in KINDS}) == len(KINDS)
    assert len({kind.colour(DARK) for kind in KINDS}) == len(KINDS)


def test_nothing_is_shown_by_default() -> None:
    world = empty_world()
    circle(world, (0, 0), velocity=(3, 0))
    _, canvas = shown(world)
    assert not any(lines_in(canvas, kind.colour(DARK)) for kind in KINDS)
    assert "Velocity" not in canvas.words


def test_velocity_arrows_are_as_long_as_the_legend_says() -> None:
    world = empty_world(gravity=(0, 0))
    circle(world, (0, 0), velocity=(1.5, 2.0))
    circle(world, (1, 1))
    desk, canvas = shown(world, "v")
    scale = desk.window.overlays.velocity.per_metre
    shafts, heads, _, _ = lines_in(canvas, DARK.velocity)  # of the body, and of the legend's sample
    assert shafts["start"] == pytest.approx(np.array([[640.0, 360.0]]))
    expected = np.array([[640.0 + 150.0 / scale, 360.0 - 200.0 / scale]])
    assert shafts["end"] == pytest.approx(expected)
    assert (heads["start"] == pytest.approx(expected[0])) or expected[0] in heads["start"]
    assert {"Velocity", f"1 m = {scale:g} m/s"} <= set(canvas.words)


def test_a_zoom_leaves_the_scale_as_it_was() -> None:
    world = empty_world(gravity=(0, 0))
    circle(world, (0, 0), velocity=(2.0, 0.0))
    desk, canvas = shown(world, "v")
    before = desk.window.overlays.velocity.per_metre
    desk.window.camera.scale = 50.0
    canvas.calls.clear()
    desk.frames(8)
    assert desk.window.overlays.velocity.per_metre == before
    shaft = lines_in(canvas, DARK.velocity)[0]
    assert shaft["end"][0, 0] - shaft["start"][0, 0] == pytest.approx(2.0 / before * 50.0)


def test_arrows_that_a_scene_shows_are_scaled_for_it() -> None:
    """They had the scale of the scene before, and were less than a pixel long where much is seen."""
    world = empty_world(gravity=(0, 0))
    circle(world, (0, 0), velocity=(2.0, 0.0))
    world.view, world.desk = (-500.0, -500.0, 500.0, 500.0), contents.Desk("explore", frozenset({"arrows"}))
    desk, _ = shown(empty_world())
    desk.sandbox.show(world)
    desk.frames(8)
    assert 30.0 < 2.0 / desk.window.overlays.velocity.per_metre * desk.window.camera.scale < 150.0


def test_scales_are_kept_on_request() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0), velocity=(2.0, 0.0))
    desk, canvas = shown(world, "v")
    before = desk.window.overlays.velocity.per_metre
    desk.key("a")
    world.component(ball, Velocity).linear = Vector2(200.0, 0.0)
    desk.frames(8)
    assert desk.window.overlays.velocity.per_metre == before
    desk.key("v")
    desk.key("v")
    canvas.calls.clear()
    desk.frames(8)
    assert desk.window.overlays.velocity.per_metre == before and "scale, kept" in canvas.words
    desk.key("a")
    desk.frames(8)
    assert desk.window.overlays.velocity.per_metre > 10.0 * before


def test_forces_are_those_of_the_present_state() -> None:
    world = load_scene("spring_chain")
    desk, canvas = shown(world, "v", frames=30, paused=False)
    rows = world.batch(Velocity).rows
    rows = rows[world.bodies.inverse_mass[rows] > 0.0]
    force = applied_forces(world)[rows] * (1.0, -1.0) * desk.window.camera.scale
    force /= desk.window.overlays.force.per_metre
    length = np.hypot(force[:, 0], force[:, 1])
    drawn = (length >= MIN_LENGTH) & (length <= max_length(canvas))
    shafts = lines_in(canvas, DARK.force)[0]
    spans = shafts["end"] - shafts["start"]
    for span in force[drawn]:
        assert np.isclose(spans, span, atol=1e-9).all(axis=1).any()


def test_what_rests_has_no_net_force_and_what_slides_has_that_of_its_acceleration() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=10, height=1, static=True, friction=0.5)
    box(world, (-1, 0.25), width=0.5, height=0.5, mass=2.0, friction=0.5)
    box(world, (1, 0.25), width=0.5, height=0.5, mass=2.0, friction=0.5, velocity=(3, 0))
    desk, canvas = shown(world, "v", frames=12, paused=False)
    scale = desk.window.camera.scale / desk.window.overlays.force.per_metre
    shaft = lines_in(canvas, DARK.force)[0]
    assert len(shaft["end"]) == 1
    span = shaft["end"][0] - shaft["start"][0]
    assert span == pytest.approx(np.array((-0.5 * 2.0 * 9.81 * scale, 0.0)), rel=1e-2, abs=0.5)


def test_forces_are_shown_after_an_edit_in_pause_too() -> None:
    world = empty_world()
    circle(world, (0, 0))
    desk, canvas = shown(world, "v", frames=8)
    circle(world, (2, 0))
    canvas.calls.clear()
    desk.frames(8)
    assert len(lines_in(canvas, DARK.force)[0]["start"]) == 2


def test_normals_stand_on_contacts_and_point_into_the_body() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=10, height=1, static=True)
    circle(world, (1, 0.25), radius=0.25)
    _, canvas = shown(world, "v", frames=30, paused=False)
    shaft = lines_in(canvas, DARK.contact_normal)[0]
    ((x, y),) = shaft["start"]
    assert (x, y) == pytest.approx((740.0, 360.0), abs=0.3)
    assert shaft["end"] - shaft["start"] == pytest.approx(np.array([[0.0, -NORMAL_LENGTH]]), abs=1e-6)
    assert "direction only" in canvas.words


def test_short_arrows_are_left_out_and_long_ones_marked() -> None:
    canvas = RecordingCanvas((1280, 720))
    limit = max_length(canvas)
    span = np.array(
        [(MIN_LENGTH * 0.9, 0.0), (50.0, 0.0), (0.0, 3.0 * limit), (math.nan, 0.0), (math.inf, 0.0)]
    )
    draw_arrows(np.full((5, 2), 300.0), span, VELOCITY, Drawing(canvas, Camera(canvas.size), DARK, 12))
    shafts, heads = lines_in(canvas, DARK.velocity)
    assert shafts["end"].tolist() == [[350.0, 300.0], [300.0, 300.0 + limit]]
    assert len(heads["start"]) == 2 * 3 + 2
    canvas.calls.clear()
    draw_arrows(np.full((1, 2), 300.0), span[1:2], VELOCITY, Drawing(canvas, Camera(canvas.size), DARK, 12))
    assert len(lines_in(canvas, DARK.velocity)[1]["start"]) == 3


def test_a_crowd_is_drawn_finer() -> None:
    canvas = RecordingCanvas((1280, 720))
    for count in (10, 400):
        draw_arrows(
            np.full((count, 2), 300.0),
            np.full((count, 2), 20.0),
            VELOCITY,
            Drawing(canvas, Camera(canvas.size), DARK, 12),
        )
    few, _, many, _ = lines_in(canvas, DARK.velocity)
    assert few["width"] > many["width"] and len(many["start"]) == 400


def test_a_broken_line_ends_where_the_line_does() -> None:
    start, end = np.array([(0.0, 0.0), (0.0, 0.0)]), np.array([(30.0, 0.0), (0.0, 2.0)])
    froms, tos, whose = dashes(start, end)
    assert np.hypot(*(tos - froms).T).max() <= 5.0 + 1e-9
    assert whose.tolist() == [0, 0, 0, 0, 1]
    assert {(30.0, 0.0), (0.0, 2.0)} <= {tuple(to) for to in tos.tolist()}


def test_a_gauge_is_round_and_does_not_flicker() -> None:
    gauge = Gauge("m/s")
    scales = []
    for n in range(300):
        gauge.follow(np.array([4.0 + 0.9 * math.sin(0.3 * n)]), reach=1.0, time=n / 60)
        scales.append(gauge.per_metre)
    assert set(scales) == {5.0}
    gauge.follow(np.array([math.inf, math.nan]), reach=1.0, time=5.0)
    assert gauge.per_metre == 5.0
    gauge.follow(np.array([0.01]), reach=1.0, time=60.0)
    assert gauge.per_metre == 0.01
    gauge.follow(np.array([6000.0]), reach=1.0, time=600.0)
    gauge.follow(np.array([4.0]), reach=1.0, time=0.1)
    assert gauge.per_metre == 5.0, "begun again after a fall of ten minutes"
    gauge.follow(np.zeros(0), reach=1.0, time=60.0)
    assert gauge.per_metre == 5.0, "a scene with nothing in it has no scale of its own, 1e-5 m/s a metre"


@pytest.mark.parametrize("size", [(1280, 720), (800, 600), (1920, 1080)])
def test_the_legend_lies_over_nothing(size: tuple[int, int]) -> None:
    """With arrows, with impulses too, with these alone, and with both and other banners."""
    canvas = MeasuringCanvas(size)
    desk = Desk(load_scene("bounces"), canvas)
    for keys, frames in (("v", 70), ("e", 20), ("v", 20), ("vo[[[[", 20)):
        for key in keys:
            desk.key(key)
        desk.frames(frames)
        canvas.words.clear()
        canvas.panels.clear()
        desk.frames()
        screen = pygame.Rect(0, 0, *size)
        for words, rect in canvas.words:
            assert screen.contains(rect), f"{words!r} at {rect} leaves {size}"
        for (a, one), (b, two) in itertools.combinations(canvas.words, 2):
            assert not one.inflate(-2, -2).colliderect(two.inflate(-2, -2)), f"{a!r} lies over {b!r}"
        for one, two in itertools.combinations(canvas.panels, 2):
            assert not one.colliderect(two) or one.contains(two) or two.contains(one)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_legend_lies_where_the_fewest_bodies_are(side: float) -> None:
    canvas = MeasuringCanvas((1280, 720))
    desk = Desk(empty_world(gravity_mode="none"), canvas)
    desk.frames(10)
    left, top, width, _ = desk.sandbox.interface.visible
    for n in range(3):  # under that upper corner of the world
        pixel = left + (80 + 60 * n if side < 0.0 else width - 80 - 60 * n), top + 60
        circle(desk.world, desk.window.camera.to_world(pixel), radius=0.2)
    desk.key("v")
    desk.frames(20)
    canvas.words.clear()
    desk.frames()
    (legend,) = [rect for words, rect in canvas.words if words == "Net force"]
    assert (legend.centerx - left - 0.5 * width) * side < 0.0 or legend.top > top + 110


def test_the_legend_is_brief_where_all_its_words_would_cover_bodies() -> None:
    """Beside a docked graph it covered the balls that fell."""
    canvas = MeasuringCanvas((1280, 720))
    desk = Desk(empty_world(gravity_mode="none"), canvas)
    desk.frames(10)
    left, top, width, height = desk.sandbox.interface.visible
    for down in range(10, height, 40):
        circle(desk.world, desk.window.camera.to_world((left + 0.5 * width, top + down)), radius=0.1)
    for n in range(height // 40):
        for across in (225, width - 225):
            circle(desk.world, desk.window.camera.to_world((left + across, top + 10 + 40 * n)), radius=0.1)
    desk.key("v")
    desk.frames(20)
    canvas.words.clear()
    desk.frames()
    words = [words for words, _ in canvas.words]
    assert "Net force" in words
    assert not any("strokes across" in line for line in words)


def test_the_words_of_a_row_of_the_legend_lie_apart_in_german() -> None:
    """Of a lesson that waits for a prediction they lay over each other."""
    canvas = MeasuringCanvas((1280, 720))
    canvas.language = language("de")
    desk = Desk(empty_world(), canvas)
    overlays = desk.window.overlays
    overlays.arrows = overlays.awaits_prediction = True
    whole = next(iter(legends_of(overlays, (800, 600), Drawing(canvas, Camera(canvas.size), DARK, 15))))
    said = {text: (place, canvas.text_size(text, style)[0]) for text, place, style, _ in whole.texts}
    (left, y), width = said["Net force"]
    (right, same), length = said["after your prediction"]
    assert y == same and left + width < right - length


def test_the_legend_has_the_scale_of_the_forces_on_the_selection() -> None:
    """They have a scale of their own: a weight of 30 N stood beside "1 m = 50 N" and was 1.5 m long."""
    canvas = MeasuringCanvas((1280, 720))
    desk = Desk(empty_world(), canvas)
    body = circle(desk.world, (0.0, 0.0), radius=0.5)
    desk.key("v")
    desk.frames(3)
    assert "Forces on the selection" not in [words for words, _ in canvas.words]
    desk.window.selection.take(body)
    desk.frames(3)
    words = [words for words, _ in canvas.words]
    assert words[words.index("Forces on the selection") + 1] == desk.window.overlays.body_force.words
