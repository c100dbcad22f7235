"""A world in which nothing moves is drawn a few times a second, and at once when something is done."""

from __future__ import annotations

import pygame
from desk import FRAME, Desk, empty_world, point, sized

from physicslab.components import Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene
from physicslab.prefabs import circle


def drawn(desk: Desk, frames: int = 60) -> int:
    return sum(desk.sandbox.frame(FRAME) for _ in range(frames))


def at_rest() -> Desk:
    desk = sized((640, 480), load_scene("stack"))
    desk.frames(120)
    return desk


def test_what_rests_is_drawn_less_often_while_time_runs() -> None:
    desk = at_rest()
    steps = desk.world.steps
    assert drawn(desk) <= 20
    assert desk.world.steps == steps + 60
    shown = desk.ui.words
    drawn(desk, 30)
    assert desk.ui.words != shown, "the clock goes on"


def test_what_moves_is_drawn_in_every_frame() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0), velocity=Vector2(0.05, 0))
    desk = sized((640, 480), world)
    desk.frames(120)
    assert drawn(desk) == 60
    world.component(ball, Velocity).linear = Vector2(0, 0)
    desk.frames(120)
    assert drawn(desk) < 30


def test_what_is_done_is_seen_at_once() -> None:
    desk = at_rest()
    left, top, *_ = desk.sandbox.interface.room()
    point(desk, (left + 30, top + 30))
    desk.frames(120)
    for kind, more in (
        (pygame.MOUSEMOTION, {"pos": (left + 40, top + 40), "rel": (0, 0), "buttons": (0, 0, 0)}),
        (pygame.KEYDOWN, {"key": pygame.K_v, "mod": 0, "unicode": "v"}),
        (pygame.MOUSEWHEEL, {"x": 0, "y": 1, "precise_y": 1.0, "flipped": False}),
    ):
        desk.frames(3)
        pygame.event.post(pygame.Event(kind, **more))
        assert drawn(desk, 1) == 1
        assert drawn(desk, 59) >= 50, "and in every frame for a while"
        assert drawn(desk) < 30


def test_an_edit_is_seen_at_once() -> None:
    desk = at_rest()
    body = max(entity for entity in desk.world.entities() if desk.world.has(entity, Velocity))
    drawn(desk, 3)
    transform = desk.world.component(body, Transform)
    transform.position = transform.position + Vector2(0.0, 0.5)
    assert drawn(desk, 3) == 3
