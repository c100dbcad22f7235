"""End to end: ``python main.py`` in a real window on a virtual screen, with a real mouse and keyboard."""

import time

import numpy as np
import pygame
import pytest
from numpy.typing import NDArray
from screens import Screen, Seen, needs_screen
from screens import screen as screen

pytestmark = needs_screen


def test_a_user_spawns_drags_throws_and_quits(screen: Screen) -> None:
    program = screen.launch()
    try:
        middle = (slice(560, 720), slice(330, 480))
        left = (slice(360, 460), slice(250, 350))

        def differs(part: tuple[slice, slice], other: NDArray[np.int64], by: int) -> Seen:
            return lambda picture: bool(np.abs(picture[part] - other[part]).sum() > by)

        full = screen.picture()
        screen.do("key", "r")
        screen.do("key", "g")
        screen.do("mousemove", 40, 600)  # below the tools: over the world a ghost would be at the cursor
        screen.until(differs((slice(400, 1000), slice(300, 640)), full, 50_000), "an empty world")
        time.sleep(0.5)
        empty = screen.picture()
        screen.do("mousemove", 640, 400)
        screen.do("click", 1)
        screen.until(differs(middle, empty, 10_000), "a circle where the click was")

        screen.do("mousedown", 1)
        words: list[object] = []
        for x in range(640, 400, -8):
            words += ["mousemove", x, 300, "sleep", 0.02]
        screen.do(*words)
        screen.until(differs(left, empty, 10_000), "the circle dragged to the left")
        gone = screen.until(lambda picture: not differs(middle, empty, 2_000)(picture), "the middle empty")
        assert differs(left, empty, 10_000)(gone)
        screen.do("mouseup", 1)

        screen.do("mousemove", 40, 600)
        screen.do("key", "r")
        screen.until(lambda picture: not differs(left, empty, 2_000)(picture), "an empty world again")
        screen.do("mousemove", 400, 500)
        screen.do("click", 3)
        screen.until(differs((slice(370, 430), slice(470, 530)), empty, 5_000), "a box")
        screen.do("mousedown", 1)
        words = []
        for x in range(400, 900, 12):
            words += ["mousemove", x, 500, "sleep", 0.01]
        screen.do(*words, "mouseup", 1)
        first = screen.picture()
        path = (slice(None), slice(380, 620))
        screen.until(differs(path, first, 5_000), "a throw going on by itself")

        screen.do("key", "r")
        screen.do("mousemove", 640, 300)
        before = screen.picture()
        screen.do("key", "p")
        pendulum = (slice(640, 800), slice(300, 460))
        hung = screen.until(differs(pendulum, before, 5_000), "a pendulum that hangs from the cursor")
        screen.do("key", "o")
        banner = (slice(300, 1000), slice(28, 280))  # below the cards of the first minute
        planets = screen.until(differs(banner, hung, 2_000), "the banner of planet mode")
        screen.do("key", "v")
        legend = (slice(112, 370), slice(140, 360))  # lower where a busy machine has another banner
        screen.until(differs(legend, planets, 20_000), "the legend of the arrows")
        paused = screen.picture()
        screen.do("mousemove", 133, 698)  # the button for pause
        screen.do("click", 1)
        screen.until(differs((slice(300, 900), slice(600, 672)), paused, 2_000), "the word of a pause")

        screen.do("key", "F12")
        screen.until(lambda _: any(screen.folder.glob("physicslab-*.png")), "a screenshot in the folder")
        time.sleep(0.5)
        (shot,) = screen.folder.glob("physicslab-*.png")
        assert pygame.image.load(shot).get_size() == (1280, 720)
        screen.do("key", "Escape")  # there are unsaved edits: it is asked for twice
        assert program.poll() is None
        screen.leave(program)
    finally:
        program.kill()
        program.communicate()


def test_a_resized_window_shows_more_of_the_world(screen: Screen) -> None:
    program = screen.launch("pyramid")
    try:
        (window,) = screen.windows()
        assert screen.do("getwindowname", window).strip() == "A pyramid of 465 boxes - PhysicsLab"
        screen.do("windowsize", window, 900, 620)
        screen.until(
            lambda picture: bool(picture[905:].max() == 0 and picture[700:880, 20:120].max() > 200),
            "nothing drawn outside, and the right panel, which moved along",
        )
        screen.do("key", "Escape")
        assert program.wait(timeout=20) == 0
    finally:
        program.kill()
        program.communicate()


@pytest.mark.slow
def test_what_a_crash_has_left_is_offered_and_restored(screen: Screen) -> None:
    sessions = screen.folder / "state" / "physicslab" / "sessions"
    program = screen.launch("stack")
    screen.until(lambda _: any(sessions.glob("*.json")), "the state, after ten seconds")
    program.kill()
    program.communicate()
    program = screen.launch("drop")
    try:
        (window,) = screen.windows()
        assert screen.do("getwindowname", window).strip() == "A ball on a floor - PhysicsLab"
        screen.do("mousemove", 403, 40)  # the button that restores, at the top of the world
        screen.do("click", 1)
        stack = "A tower of ten boxes - PhysicsLab"
        screen.until(lambda _: screen.do("getwindowname", window).strip() == stack, "the stack again")
        screen.do("key", "Escape")
        assert program.wait(timeout=20) == 0
        assert not list(sessions.iterdir())
    finally:
        program.kill()
        program.communicate()
