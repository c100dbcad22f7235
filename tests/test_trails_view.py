"""Trails in the window: key T, and what is drawn."""

from typing import Any

import numpy as np
import pygame
import pytest
from desk import FRAME, Desk, bits, empty_world
from recording import RecordingCanvas

from physicslab.components import Trail, Velocity
from physicslab.files.scene import load_scene
from physicslab.history import AddComponent, RemoveComponent, SetField
from physicslab.prefabs import box, circle
from physicslab.systems.frame.render import RenderSystem
from physicslab.systems.system import Stage
from physicslab.systems.trail import TrailSystem
from physicslab.theme import DARK, mixed
from physicslab.view.window.changing import take
from physicslab.view.window.window import Window
from physicslab.view.workbench.world_view import WorldView
from physicslab.world import World


def worn(world: World) -> list[int]:
    return [entity for entity in world.entities() if world.has(entity, Trail)]


def drawn_trails(world: World) -> dict[str, Any]:
    """Return the pieces of all trails, which are drawn at once."""
    canvas = RecordingCanvas((1280, 720))
    window = Window(canvas)
    world.install(RenderSystem(WorldView(window).draw))
    world.frame(Stage.RENDER, FRAME)
    (trails,) = canvas.called("strokes")
    return trails


def test_t_gives_moving_bodies_trails_and_takes_them_away() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0))
    box(world, (0, -3), width=8, height=1, static=True)
    desk = Desk(world)
    desk.frames(2)
    assert worn(world) == []
    desk.key("t")
    desk.frames(2)
    assert worn(world) == [ball]
    desk.key("t")
    desk.frames(2)
    assert worn(world) == []


def test_what_is_spawned_meanwhile_gets_a_trail_too() -> None:
    world = empty_world()
    desk = Desk(world)
    desk.key("t")
    desk.frames()
    desk.press(1, 1)
    desk.release(1, 1)
    desk.press(-1, 1, "right")
    desk.release(-1, 1, "right")
    desk.frames(3)
    assert len(worn(world)) == 2
    desk.key("r")
    desk.frames()
    desk.press(0, 0)
    desk.release(0, 0)
    desk.frames(3)
    assert len(worn(world)) == 1
    system = world.schedule.find(TrailSystem)
    assert isinstance(system, TrailSystem) and len(system.entities) == 1


def test_trails_of_the_scene_come_back_as_long_as_they_were() -> None:
    world = load_scene("two_planets")
    lengths = {entity: world.component(entity, Trail).length for entity in worn(world)}
    desk = Desk(world)
    desk.key("t")
    desk.frames(2)
    assert lengths and not worn(world)
    desk.key("t")
    desk.frames(2)
    assert {entity: world.component(entity, Trail).length for entity in worn(world)} == lengths


def test_trails_are_as_they_were_set_last_wherever_undo_goes() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0))
    desk = Desk(world)
    desk.frames(2)
    history = desk.window.edits.history

    def press(key: str, mod: int = 0) -> None:
        desk.key(key, mod)
        desk.frames(3)

    press("t")
    history.do(SetField(ball, "Velocity", "linear", (1.0, 0.0)))
    press("z", pygame.KMOD_LCTRL)
    assert worn(desk.world) == [ball]
    press("y", pygame.KMOD_LCTRL)
    press("t")
    for key in ("z", "y"):
        press(key, pygame.KMOD_LCTRL)
        assert worn(desk.world) == []
    history.do(AddComponent(ball, Trail()))
    desk.frames(2)
    assert worn(desk.world) == [ball], "one that is given to a body stays"


def test_an_edit_of_a_trail_that_the_switch_gave_is_done_again_where_there_is_none() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0))
    desk = Desk(world)
    desk.frames(2)
    desk.window.trails.toggle(desk.world)
    desk.window.edits.do(SetField(ball, "Trail", "length", 2.0))
    desk.window.edits.do(RemoveComponent(ball, "Trail"))
    for key, mod in (("z", pygame.KMOD_LCTRL), ("z", pygame.KMOD_LCTRL), ("t", 0), ("y", pygame.KMOD_LCTRL)):
        desk.key(key, mod)
        desk.frames(3)
    desk.key("y", pygame.KMOD_LCTRL)
    desk.frames(3)
    history = desk.window.edits.history
    assert worn(desk.world) == [] and history.position == len(history.entries)


def test_the_switch_gives_trails_to_what_moves_alone() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0))
    desk = Desk(world)
    desk.window.trails.toggle(desk.world)
    take(desk.world, desk.window, (ball,), Trail)
    assert worn(desk.world) == [ball] and "T turns that off" in desk.window.notice
    take(desk.world, desk.window, (ball,), Velocity)
    desk.frames(2)
    assert worn(desk.world) == []


def test_a_trail_is_drawn_from_where_the_body_was_and_fades() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (-3, 0), radius=0.2)
    world.component(ball, Velocity).linear = (3, 0)
    world.add(ball, Trail(1.0))
    world.run(seconds=2.0)
    trails = drawn_trails(world)
    rim = DARK.bodies[ball % len(DARK.bodies)]
    starts, ends = trails["start"], trails["end"]
    assert np.allclose(starts[0], (640, 360), atol=6.0) and np.allclose(ends[-1], (940, 360), atol=1e-6)
    assert np.allclose(starts[1:], ends[:-1])
    far = np.abs(trails["colour"].astype(int) - DARK.background).sum(axis=1).tolist()
    assert far == sorted(far) and far[0] < 0.1 * far[-1]
    assert trails["width"][-1] > 4.0 * trails["width"][0] >= 4.0 * 0.7
    assert tuple(trails["colour"][-1]) == mixed(DARK.background, rim, 0.85 * (1 - 0.5 / 16))


def test_trails_lie_behind_bodies() -> None:
    world = load_scene("two_planets")
    world.run(seconds=1.0)
    canvas = RecordingCanvas((1280, 720))
    world.install(RenderSystem(WorldView(Window(canvas)).draw))
    world.frame(Stage.RENDER, FRAME)
    names = [name for name, _ in canvas.calls]
    assert names.count("strokes") == 1 and names[-1] == "discs"


@pytest.mark.filterwarnings("error")
def test_a_thousand_trails_are_drawn_in_few_pieces() -> None:
    world = empty_world(gravity=(0, 0))
    for n in range(1000):
        ball = circle(world, (0.1 * (n % 40) - 2, 0.1 * (n // 40) - 2), radius=0.01)
        world.component(ball, Velocity).linear = (np.cos(n), np.sin(n))
        world.add(ball, Trail())
    world.run(seconds=2.0)
    assert 5_000 < len(drawn_trails(world)["start"]) < 18_000


@pytest.mark.filterwarnings("error")
def test_a_body_that_is_lost_or_at_rest_draws_nothing_odd() -> None:
    world = empty_world(gravity=(0, 0))
    still, lost = circle(world, (0, 0)), circle(world, (1, 1))
    world.add(still, Trail())
    world.add(lost, Trail())
    world.component(lost, Velocity).linear = (1e12, 0)
    world.run(steps=10)
    trails = drawn_trails(world)
    assert np.isfinite(trails["start"]).all() and np.abs(trails["end"]).max(initial=0.0) < 1e7


def test_trails_and_sparks_change_no_bit_of_the_world() -> None:
    alone, watched = load_scene("billiards"), load_scene("billiards")
    desk = Desk(watched)
    desk.key("t")
    for n in range(300):
        alone.step()
        desk.frames()
        if n % 40 == 20:
            desk.key("t")
    assert watched.steps == alone.steps == 300
    assert bits(watched) == bits(alone)
