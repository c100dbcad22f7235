"""Groups: walls and dominoes by a drag or a number, discs that are poured while the button is held."""

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, empty_world
from test_drawing import draw, words

from physicslab.components import Shape, Transform
from physicslab.prefabs import box
from physicslab.world import World


@pytest.fixture
def desk() -> Desk:
    world = empty_world()
    box(world, (0.0, -1.5), width=20.0, height=1.0, static=True)
    made = Desk(world)
    made.key("space")
    made.frames()
    return made


def shapes(world: World) -> list[Shape]:
    """Return the shapes of all bodies but the floor."""
    return [world.component(entity, Shape) for entity in world.batch(Shape).entities.tolist()[1:]]


def places(world: World) -> np.ndarray:
    return world.table(Transform)["position"][world.batch(Shape).rows[1:]]


@pytest.mark.parametrize("typed", ["", "40"])
def test_dominoes_stand_on_the_floor_along_a_line(desk: Desk, typed: str) -> None:
    draw(desk, "dominoes", (-4.0, -0.9), (-1.0, -0.85), typed)
    found = places(desk.world)
    assert len(found) == (40 if typed else 13)
    assert np.diff(found[:, 0]) == pytest.approx(0.25, abs=1e-3)
    assert found[0, 1] == pytest.approx(-0.75, abs=0.01), "on the floor, though it was begun above it"
    desk.key("space")
    desk.frames(60)
    assert np.abs(desk.world.table(Transform)["angle"]).max() < 0.02, "they stand"
    desk.window.edits.history.undo()
    desk.window.edits.history.undo()
    assert len(desk.world.entities()) == 1


@pytest.mark.parametrize("typed", ["", "5 x 6"])
def test_a_wall_has_as_many_bricks_as_fit_or_as_were_typed(desk: Desk, typed: str) -> None:
    draw(desk, "wall", (-2.0, -0.95), (0.4, -0.2), typed)
    columns, rows = (5, 6) if typed else (6, 4)
    assert len(shapes(desk.world)) == columns * rows + rows // 2
    widths = np.array([shape.width for shape in shapes(desk.world)])
    assert widths.sum() == pytest.approx(0.4 * columns * rows, rel=0.02)
    desk.key("space")
    before = places(desk.world)
    desk.frames(60)
    assert np.abs(places(desk.world) - before).max() < 0.01, "it stands"


def test_discs_are_poured_while_the_button_is_held(desk: Desk) -> None:
    desk.window.tool = "brush"
    desk.press(0.0, 1.0)
    desk.frames(30)
    assert words(desk) == "60 discs", "two a frame"
    desk.move(1.0, 1.0)
    desk.frames(30)
    assert len(desk.world.entities()) == 1
    desk.release(1.0, 1.0)
    desk.frames()
    found = places(desk.world)
    assert len(found) == 120
    apart = np.hypot(*(found[:, None] - found[None]).transpose(2, 0, 1))[np.triu_indices(120, 1)]
    assert apart.min() >= 2.0 * 0.12
    desk.window.edits.history.undo()
    assert len(desk.world.entities()) == 1, "one undo"


def test_as_many_discs_are_poured_as_were_typed_and_none_within_another(desk: Desk) -> None:
    draw(desk, "brush", (0.0, 0.5), (0.3, 0.5), "500")
    found = places(desk.world)
    assert len(found) == 500 and found[:, 1].min() >= -1.0 + 0.12
    pygame.display.quit()


@pytest.mark.parametrize(
    ("tool", "button", "typed", "made"),
    [("brush", "left", "500", 500), ("dominoes", "left", "40", 40), ("circle", "right", "1 x 2", 1)],
)
def test_enter_while_the_button_is_held_makes_what_was_typed(
    desk: Desk, tool: str, button: str, typed: str, made: int
) -> None:
    """Of 500 discs one was made, and a box that the right button drew became a circle of the tool in hand."""
    desk.window.tool = tool
    desk.press(-4.0, 0.5, button)
    desk.move(-3.0, 0.6)
    desk.frames()
    for letter in typed:
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=ord(letter), mod=0, unicode=letter, scancode=0))
    desk.key("return")
    desk.frames(SETTLED)
    found = shapes(desk.world)
    desk.release(-3.0, 0.6, button)
    desk.frames(SETTLED)
    assert len(found) == len(shapes(desk.world)) == made
    assert {shape.kind for shape in found} == {"circle" if tool == "brush" else "box"}


def test_too_many_are_not_made(desk: Desk) -> None:
    draw(desk, "wall", (-2.0, -0.95), (0.4, -0.15), "100 x 100")
    assert desk.window.notice == "Wall: 100 x 100: at most 2,000 in all"
    assert shapes(desk.world) == [], "neither what was typed nor, in its place, something else"


@pytest.mark.parametrize(
    ("tool", "things"), [("chain", "links"), ("wall", "bricks"), ("dominoes", "dominoes")]
)
def test_a_drag_across_kilometres_makes_none_and_says_so(desk: Desk, tool: str, things: str) -> None:
    desk.window.camera.zoom(1e-3, (480, 300))
    draw(desk, tool, (-2000.0, -900.0), (2000.0, 900.0))
    assert f"{things}; at most 2,000 are made" in desk.window.notice
    assert shapes(desk.world) == []
