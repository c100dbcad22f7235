"""Panels and what lies over the world: all of it fits, at every size of the window and of its text."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import pygame
import pytest
from desk import SETTLED, Desk, empty_world, fill, sized, tap
from imgui_bundle import imgui

from physicslab.components import Transform
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene
from physicslab.prefabs import box, circle
from physicslab.view.canvas.canvas import Rect, overlap
from physicslab.view.controls.lesson_actions import choose_language
from physicslab.view.overlay import banners

SIZES = [(800, 600), (1280, 720), (1920, 1080)]


def scrolls(desk: Desk) -> bool:
    """Whether the panel at the right has more than it can show."""
    desk.sandbox.interface.toolkit.enter()
    return bool(imgui.internal.find_window_by_name("side").scroll_max.y > 0.0)


@pytest.mark.parametrize("make", [circle, box])
def test_the_numbers_of_a_body_fit_the_usual_window(make: Callable[..., int]) -> None:
    world = empty_world()
    body = make(world, (0, 0), velocity=Vector2(1.0, 2.0), angular_velocity=3.0)
    desk = sized((1280, 720), world)
    desk.window.selection.take(body)
    desk.frames(SETTLED)
    assert "Kinetic energy" in desk.ui.rows and "Delete" in desk.ui.places and not scrolls(desk)


@pytest.mark.parametrize("scale", [1.0, 1.75, 2.0])
@pytest.mark.parametrize("size", SIZES)
def test_the_legend_lies_in_the_world_beside_the_panels(size: tuple[int, int], scale: float) -> None:
    desk = sized(size, load_scene("stack"), scale)
    for keys in ("e", "v", "e"):
        tap(desk, keys)
        desk.frames(20)
        visible = pygame.Rect(desk.sandbox.interface.visible)
        panels = {tuple(rect) for rect in desk.sandbox.interface.covered}
        over = [pygame.Rect(rect) for rect in desk.window.overlays.covered if tuple(rect) not in panels]
        legend = min(over, key=lambda rect: (rect.top, rect.left))
        assert visible.contains(legend), "none of it is under a panel"
        assert legend.w * legend.h <= 0.5 * visible.w * visible.h, "most of the world is seen"


@pytest.mark.parametrize(("size", "scale"), [((800, 600), 1.0), ((800, 600), 1.5), ((1280, 720), 1.5)])
@pytest.mark.parametrize("name", ["pulleys", "carts"])
def test_words_meters_and_legend_over_the_world_overlap_nowhere(
    name: str, size: tuple[int, int], scale: float
) -> None:
    desk = sized(size, load_scene(name), scale)
    tap(desk, "space")
    desk.window.notify("Undone: made a circle", 60.0)
    for keys in ("[", "v"):
        tap(desk, keys)
        desk.frames(3)
        over = [pygame.Rect(rect) for rect in desk.window.overlays.covered if rect[2] and rect[3]]
        assert len(over) > 7, "panels, meters, scale bar, and words"
        for one, two in itertools.combinations(over, 2):
            assert not one.colliderect(two), f"{one} lies over {two}"


def test_a_size_of_zero_is_written_as_what_it_means() -> None:
    desk = sized((1280, 720))
    assert "in turn" in desk.ui.words and desk.window.recipe.size == 0.0
    fill(desk, "new size", "0.2")
    assert desk.window.recipe.size == 0.2 and "0.2" in desk.ui.words and "in turn" not in desk.ui.words
    fill(desk, "new size", "0")
    assert desk.window.recipe.size == 0.0 and "in turn" in desk.ui.words
    fill(desk, "new friction", "0")
    assert desk.window.recipe.friction == 0.0 and desk.ui.words.count("in turn") == 1


@pytest.mark.parametrize(("x", "aside"), [(0.0, True), (3.0, False)])
def test_a_notice_covers_no_moving_body(x: float, aside: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """It lies in the middle, and beside it where a body is there."""
    drawn: list[list[pygame.Rect]] = []
    draw = banners.draw_messages

    def spy(*arguments: Any) -> list[Rect]:
        rects = draw(*arguments)
        drawn.append([pygame.Rect(rect) for rect in rects])
        return rects

    monkeypatch.setattr(banners, "draw_messages", spy)
    desk = sized((1280, 720), empty_world(gravity=(0, 0)))
    desk.window.pace.paused = True
    left, top, width, height = desk.sandbox.interface.visible
    foot = desk.window.camera.to_world((left + width // 2, top + height - 25))
    body = circle(desk.world, (foot.x + x, foot.y), radius=0.2)
    desk.frames(SETTLED)
    (pause,) = drawn[-1]
    place = desk.window.camera.to_screen(desk.world.component(body, Transform).position)
    assert not pause.inflate(20, 20).collidepoint(place)
    assert (abs(pause.centerx - (left + width // 2)) > 20) == aside
    desk.window.camera.pan(-desk.window.camera.scale * x, 0.0)
    desk.frames(SETTLED)
    (pause,) = drawn[-1]
    place = desk.window.camera.to_screen(desk.world.component(body, Transform).position)
    assert not pause.inflate(20, 20).collidepoint(place), "nor where the view has moved"


def test_no_banner_lies_behind_a_meter(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half of the second one's words were behind the meter below it."""
    drawn: list[list[Rect]] = []
    draw = banners.draw_banners

    def spy(*arguments: Any) -> list[Rect]:
        drawn.append(draw(*arguments))
        return drawn[-1]

    monkeypatch.setattr(banners, "draw_banners", spy)
    desk = sized((1280, 720), load_scene("carts"), 1.5)
    for key in ("[", "o", "z"):
        tap(desk, key)
    desk.frames(SETTLED)
    desk.frames(9, elapsed=0.175)
    assert drawn[-1] and not any(
        overlap(one, other) for one in drawn[-1] for other in desk.sandbox.interface.covered
    )


def test_more_sky_than_ground_is_shown_where_bodies_fall_down() -> None:
    """In a narrow room as much was seen below the ground as above the walls."""
    for down in (-9.81, 9.81):
        desk = sized((800, 600), empty_world(bounds=(-6.0, 0.0, 6.0, 6.0), gravity=(0.0, down)))
        desk.window.framing.fit(desk.world)
        (_, top, _, height), camera = desk.window.framing.room(), desk.window.camera
        above = camera.to_screen(Vector2(0.0, 6.0))[1] - top
        below = top + height - camera.to_screen(Vector2(0.0, 0.0))[1]
        assert below > 20.0 and (above > 2.0 * below if down < 0.0 else above == pytest.approx(below))


def test_a_small_window_with_large_text_leaves_half_to_the_world_and_cuts_no_label() -> None:
    world = load_scene("pendulum")
    desk = sized((800, 600), world, 1.5)
    choose_language(desk.world, desk.window, "de")
    desk.window.selection.take(world["bob"])
    desk.window.level = "Measure"
    desk.frames(SETTLED)
    layout, ui = desk.sandbox.interface.layout, desk.ui
    assert layout.visible[2] >= 400 and ui.places["Rope"][2] < 2.0 * ui.size
    for key, words in (("Velocity.linear", "Geschwindigkeit"), ("Mass.inertia", "Trägheitsmoment")):
        assert ui.places[f"label {key}"][2] >= ui.width(words)
    desk = sized((1280, 720), text_scale=1.5)
    assert desk.ui.places["Rope"][2] > 5.0 * desk.ui.size
