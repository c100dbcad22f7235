"""How fast the world runs: the brackets, and what Tab makes of them."""

import pygame
import pytest
from desk import FRAME, Desk, empty_world, tap
from test_hud import frame, recorded

from physicslab import load_scene
from physicslab.components import Transform
from physicslab.prefabs import circle
from physicslab.view.window.pace import Pace


def test_brackets_halve_and_double_the_speed_within_limits() -> None:
    pace = Pace(max_dt=0.1)
    seen = []
    for factor in [2.0] * 4 + [0.5] * 8:
        pace.choose(factor)
        seen.append(pace.speed)
    assert seen == [2, 4, 4, 4, 2, 1, 0.5, 0.25, 0.125, 0.0625, 0.0625, 0.0625]


@pytest.mark.parametrize(
    ("keys", "speed"), [("]", 2.0), ("]]", 4.0), ("[", 0.5), ("[[[[", 0.0625), ("[]", 1.0)]
)
def test_the_world_covers_so_much_time(keys: str, speed: float) -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0), velocity=(1, 0))
    desk = Desk(world)
    for key in keys:
        desk.key(key)
    desk.frames(1, elapsed=0.0)
    desk.frames(60)
    assert world.component(ball, Transform).position.x == pytest.approx(speed)
    assert world.steps == 60 * max(speed, 1.0), "above full speed there are more steps, and none is longer"


def test_tab_is_a_quarter_whatever_speed_was_chosen_and_brackets_go_on_from_there() -> None:
    desk = Desk(empty_world())
    pace = desk.window.pace
    desk.key("]")
    desk.key("tab")
    desk.frames()
    assert pace.speed == 0.25
    desk.key("tab")
    desk.frames()
    assert pace.speed == 2.0
    desk.key("tab")
    desk.key("[")
    desk.frames()
    assert pace.speed == 0.125 and not pace.slow_motion


def test_the_speed_is_announced_while_it_is_not_that_of_life() -> None:
    desk, canvas = recorded(empty_world())

    def banners() -> list[str]:
        frame(desk, canvas)
        return [words for words in canvas.words if "MOTION" in words]

    assert banners() == []
    desk.key("]")
    assert banners() == ["FAST MOTION 2x"]
    for _ in range(5):
        desk.key("[")
    assert banners() == ["SLOW MOTION 0.0625x"]


def test_a_held_body_follows_in_fast_motion() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0))
    desk = Desk(world)
    desk.key("]")
    desk.press(0, 0)
    desk.frames(2)
    desk.move(1, 1)
    desk.frames()
    place = world.component(ball, Transform).position
    assert (place.x, place.y) == pytest.approx((1.0, 1.0))


def test_time_dropped_in_fast_motion_is_shown_in_seconds_on_the_wall() -> None:
    pace = Pace(max_dt=0.1)
    pace.choose(4.0)
    pace.begin(0.1)
    due = pace.due(FRAME)
    assert due == 24
    pace.done(due - 12, FRAME)
    assert pace.dropped == pytest.approx(0.05)


def test_another_scene_begins_at_lifes_speed_and_the_same_goes_on_at_the_chosen_one() -> None:
    desk = Desk(load_scene("drop"))
    desk.window.scenes.source = "drop"
    pace = desk.window.pace
    desk.key("[")
    desk.frames(3)
    tap(desk, "r", pygame.KMOD_CTRL)
    assert pace.speed == 0.5, "once more, slowly"
    tap(desk, "tab")
    tap(desk, "n", pygame.KMOD_CTRL)
    assert desk.world.name != "drop" and pace.speed == 1.0
