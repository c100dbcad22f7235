"""The model of contacts while a user drags, throws, adds, removes and changes laws: no jump, and a reason."""

from __future__ import annotations

import json
from collections.abc import Callable

import numpy as np
import pytest
from desk import Desk
from numpy.typing import NDArray

from physicslab.components import Held, Mass, Transform, Velocity
from physicslab.files.json_text import json_text
from physicslab.files.scene import load_scene, read_scene, write_scene
from physicslab.prefabs import box, circle
from physicslab.view.workbench.figures import method_lines
from physicslab.world import World

FLOOR, LOWEST, TOP = 1, 2, 11
"""Entities of the built-in stack."""
SOFT = "because: more than 12 bodies can touch"
JUMP = 1e-3
"""Largest motion of what rests where the model changes [m]: a stack of ten sinks by 0.56 mm where contacts
are soft, and is lifted by as much where they become rigid."""


@pytest.fixture
def desk() -> Desk:
    desk = Desk(load_scene("stack"))
    desk.window.camera.look_at((0.0, 5.0, 0.0, 5.0), 50.0)
    desk.frames(10)
    return desk


def places(world: World, entities: range = range(LOWEST, TOP + 1)) -> NDArray[np.float64]:
    """Return x, y and the angle of bodies."""
    found = [world.component(entity, Transform) for entity in entities if world.has(entity, Transform)]
    return np.array([(*transform.position, transform.angle) for transform in found])


def said(world: World) -> str:
    """Return what the figures in the window say of the method."""
    return "\n".join(line.label for line in method_lines(world))


def click(desk: Desk, x: float, y: float, button: str = "left") -> None:
    desk.press(x, y, button)
    desk.release(x, y, button)
    desk.frames()


def test_a_thirteenth_body_and_its_removal_change_the_model_and_nothing_that_rests_jumps(desk: Desk) -> None:
    world = desk.world
    assert "contacts are rigid: the step follows events" in said(world) and "few bodies touch" in said(world)
    start = places(world)
    for n, x in enumerate((4.5, 6.0, 7.5), start=11):
        click(desk, x, 2.0, "right" if n == 13 else "left")
        assert world.plan.contacts == ("soft" if n == 13 else "rigid")
    assert SOFT in said(world)
    for _ in range(60):
        desk.frames()
        assert np.abs(places(world) - start).max() < JUMP
    desk.move(7.5, 0.5)
    desk.key("delete")
    for _ in range(60):
        desk.frames()
        assert np.abs(places(world) - start).max() < JUMP
    assert world.plan.contacts == "rigid" and SOFT not in said(world)
    assert world.stepper is not None and world.stepper.name == "rigid"


def test_a_body_is_dragged_thrown_and_comes_to_rest(desk: Desk) -> None:
    world = desk.world
    start = places(world)
    desk.press(0.0, 9.5)
    desk.frames()
    assert world.has(TOP, Held)
    for step in range(1, 41):
        desk.move(0.0, 9.5 + 0.02 * step)
        desk.frames()
        assert world.plan.contacts == "rigid"
        assert np.abs(places(world, range(LOWEST, TOP)) - start[:-1]).max() < 1e-9, "nothing else moves"
    for step in range(1, 31):
        desk.move(0.1 * step, 10.3)
        desk.frames()
    desk.release(3.0, 10.3)
    desk.frames()
    assert 5.0 < world.component(TOP, Velocity).linear.x < 6.1, "0.1 m a frame, until the button was let go"
    desk.frames(600)
    assert np.abs(places(world, range(LOWEST, TOP)) - start[:-1]).max() < 1e-9, "nothing else moves"


def test_a_body_that_is_pressed_into_others_does_no_harm(desk: Desk) -> None:
    """What is held cannot be stopped: the boxes below it are driven into each other and out to the sides."""
    world = desk.world
    desk.press(0.0, 9.5)
    desk.frames()
    for step in range(60):
        desk.move(0.0, 9.5 - 0.1 * step)
        desk.frames()
    desk.release(0.0, 3.6)
    for _ in range(300):
        desk.frames()
        assert np.isfinite(places(world)).all() and not desk.window.pace.paused
    speeds = [world.component(entity, Velocity).linear.magnitude for entity in range(LOWEST, TOP + 1)]
    assert max(speeds) < 60.0
    deepest: float = world.contacts.max_penetration
    assert deepest < 1e-2


def test_a_pause_stands_still_and_goes_on_with_the_same_bits(desk: Desk) -> None:
    other = load_scene("stack")
    other.run(steps=desk.world.steps)
    for world in (desk.world, other):
        world.component(TOP, Velocity).linear = (2.0, 1.0)
    desk.frames(20)
    desk.key("space")
    desk.frames(20)
    desk.key("space")
    desk.frames(20)
    other.run(steps=desk.world.steps - other.steps)
    assert 45 <= desk.world.steps < 55
    assert np.array_equal(places(desk.world), places(other))


@pytest.mark.parametrize("key", ["g", "o"])
def test_laws_are_changed_and_changed_back(desk: Desk, key: str) -> None:
    """Without gravity, and as planets of 1 kg, boxes on each other hardly move in a second."""
    world = desk.world
    start = places(world)
    for _ in range(2):
        desk.key(key)
        for _ in range(60):
            before = places(world)
            desk.frames()
            assert np.abs(places(world) - before).max() < 0.1
            assert world.plan.contacts == "rigid"
    assert np.abs(places(world) - start).max() < 0.5


def tumbling() -> World:
    world = load_scene("slope")
    for n in range(4):
        box(world, (0.8 * n - 2.0, 3.0 + n), width=0.6, height=0.4, angle=0.4 * n, restitution=0.3)
    for n in range(3):
        circle(world, (0.7 * n, 8.0), radius=0.2, restitution=0.5)
    return world


def change_nothing(world: World) -> None:
    world.run(steps=20)


def remove_some(world: World) -> None:
    for entity in world.entities()[-2:]:
        world.remove(entity)


def remove_and_add(world: World) -> None:
    remove_some(world)
    world.run(steps=3)
    box(world, (1.0, 7.0), width=0.5, height=0.5, angle=0.2)


def go_soft_and_back(world: World) -> None:
    extra = [circle(world, (0.5 * n, 12.0), radius=0.1) for n in range(8)]
    world.run(steps=20)
    assert world.plan.contacts == "soft"
    for entity in extra:
        world.remove(entity)


def hold_and_let_go(world: World) -> None:
    body = world.entities()[-1]
    world.add(body, Held())
    world.component(body, Velocity).linear = (1.0, -1.0)
    world.run(steps=10)
    world.discard(body, Held)


@pytest.mark.parametrize(
    "change", [change_nothing, remove_some, remove_and_add, go_soft_and_back, hold_and_let_go]
)
def test_a_file_that_is_written_after_a_change_goes_on_with_the_same_bits(
    change: Callable[[World], None],
) -> None:
    world = tumbling()
    world.run(steps=40)
    change(world)
    world.run(steps=2)
    loaded = read_scene(json.loads(json_text(write_scene(world))))
    assert world.plan.contacts == "rigid"
    loaded.run(steps=90)
    for _ in range(90):
        world.step()
    ends = []
    for one in (world, loaded):
        assert one.plan == world.plan  # soft where most of these steps were made by impulses
        moving = [entity for entity in one.entities() if one.has(entity, Mass)]
        ends.append([(one.component(e, Transform), one.component(e, Velocity)) for e in moving])
    for (place, velocity), (other, its) in zip(*ends, strict=True):
        assert (tuple(place.position), place.angle) == (tuple(other.position), other.angle)
        assert (tuple(velocity.linear), velocity.angular) == (tuple(its.linear), its.angular)
