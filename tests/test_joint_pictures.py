"""Pictures of joints and springs: what hangs, what is woven, what turns; nothing for scenes without them."""

import math
from typing import Any

import numpy as np
import pytest
from desk import empty_world
from numpy.typing import NDArray
from recording import RecordingCanvas

from physicslab.components import Gear, Pin, Pulley, Rod, Rope, Slot, Spring, Weld
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, circle
from physicslab.theme import DARK, THEMES, Colour
from physicslab.view.canvas.camera import Camera
from physicslab.view.picture.joints import joint_at, joint_lines
from physicslab.view.picture.links import pulley_path, rope_paths
from physicslab.view.picture.picture import draw_world
from physicslab.view.picture.springs import coil
from physicslab.world import World

CAMERA = Camera((1280, 720))


def strokes(world: World, theme: Any = DARK) -> dict[str, Any]:
    canvas = RecordingCanvas((1280, 720))
    draw_world(world, CAMERA, theme, canvas)
    calls = canvas.called("strokes")
    return {
        name: np.concatenate([call[name] for call in calls]) for name in ("start", "end", "colour", "width")
    }


def of_colour(drawn: dict[str, Any], colour: Colour) -> tuple[NDArray[Any], NDArray[Any]]:
    chosen = (drawn["colour"] == np.array(colour, np.uint8)).all(axis=1)
    return drawn["start"][chosen], drawn["end"][chosen]


def hung(world: World, place: tuple[float, float] = (0.0, 0.0)) -> int:
    return circle(world, place, radius=0.2)


def of_every_kind() -> World:
    world = empty_world()
    ends = [box(world, (x, 0.0), width=0.4, height=0.4) for x in (-5, -4, -3, -2, -1, 0, 1, 2)]
    world.spawn(Rod(b=ends[0], anchor_a=(-5, 2)))
    world.spawn(Rope(b=ends[1], anchor_a=(-4, 2), length=2.5))
    world.spawn(Slot(b=ends[2], anchor_a=(-3, 0), lower=-1.0, motor_speed=1.0, turns=True))
    world.spawn(Weld(a=ends[3], b=ends[4], anchor_a=(0.5, 0), anchor_b=(-0.5, 0)))
    first = world.spawn(Pin(b=ends[5], anchor_a=(0, 0), lower=-1.0, upper=1.0, motor_speed=-2.0))
    second = world.spawn(Pin(b=ends[6], anchor_a=(1, 0), upper=0.5))
    world.spawn(Gear(first, second, ratio=-1.0))
    world.spawn(Pulley(a=ends[6], b=ends[7], wheel_a=(1, 2), wheel_b=(2, 2)))
    world.spawn(Spring(a=ends[7], anchor_b=(3, 2), rest_length=2.0, stiffness=20.0))
    world.synchronise()
    return world


def test_a_world_without_joints_and_springs_draws_no_stroke() -> None:
    world = empty_world()
    hung(world)
    canvas = RecordingCanvas((1280, 720))
    draw_world(world, CAMERA, DARK, canvas)
    assert not canvas.called("strokes")


@pytest.mark.parametrize("theme", THEMES, ids=lambda theme: theme.name)
def test_every_kind_is_drawn_in_every_theme_with_two_calls(theme: Any) -> None:
    world, canvas = of_every_kind(), RecordingCanvas((1280, 720))
    draw_world(world, CAMERA, theme, canvas)
    assert len(canvas.called("strokes")) == 2, "one for springs, one for joints"
    drawn = strokes(world, theme)
    assert np.isfinite(drawn["start"]).all() and (drawn["width"] > 0.0).all()
    for colour in (theme.rod, theme.rope, theme.spring, theme.pin, theme.accent):
        assert len(of_colour(drawn, colour)[0]), colour


def test_what_is_not_finite_or_far_away_is_left_out() -> None:
    world = of_every_kind()
    for kind in (Rod, Rope, Slot, Pulley, Pin):
        (entity, *_) = world.batch(kind).entities.tolist()
        world.table(kind)["anchor_b"][world.entity_index.row_of[entity]] = (1e150, 0.0)
    assert np.isfinite(strokes(world)["start"]).all()
    far = Camera((1280, 720), centre=Vector2(1e4, 0.0))
    canvas = RecordingCanvas((1280, 720))
    draw_world(of_every_kind(), far, DARK, canvas)
    assert not canvas.called("strokes")


def test_a_spring_is_a_coil_from_body_to_bracket() -> None:
    world = empty_world()
    world.spawn(Spring(a=hung(world, (0, -1)), anchor_b=(0, 1), rest_length=2.0, stiffness=30.0))
    start, end = of_colour(strokes(world), DARK.spring)
    assert np.allclose(start[0], (640, 460)) and len(start) > 10
    assert np.isclose(end, (640, 260)).all(axis=1).any()


def test_over_a_body_a_spring_is_straight() -> None:
    world = empty_world()
    world.spawn(Spring(a=hung(world, (0, -1)), anchor_b=(0, 0), rest_length=1.0, stiffness=30.0))
    start, end = of_colour(strokes(world), DARK.spring)
    on_it = np.hypot(*(end - (640, 460)).T) < 19.0
    assert np.allclose(start[on_it], (640, 460)), "a line from its middle, and its end"
    assert np.ptp(start[:, 0]) > 5.0, "a coil beside it"


def test_a_spring_that_hardly_gives_is_a_string_and_so_are_very_many() -> None:
    world = empty_world()
    world.spawn(Spring(a=hung(world, (0, -1)), anchor_b=(0, 1), rest_length=2.0, stiffness=50_000.0))
    assert len(of_colour(strokes(world), DARK.spring)[0]) == 1
    world = empty_world()
    for n in range(160):
        world.spawn(Spring(a=hung(world, (0.01 * n, 0)), anchor_b=(0.01 * n, 2), stiffness=30.0))
    assert len(of_colour(strokes(world), DARK.spring)[0]) == 160


def test_the_wire_of_a_coil_keeps_its_length() -> None:
    start, end = np.zeros((2, 2)), np.array([[200.0, 0.0], [230.0, 0.0]])
    path, is_front = coil(start, end, np.array([200.0, 200.0]))
    assert path.shape[1] == len(is_front) + 1
    length = np.hypot(*np.diff(path, axis=1).reshape(-1, 2).T).reshape(2, -1)
    turns = length[:, 1:-1].sum(axis=1)
    assert turns[1] == pytest.approx(turns[0], rel=0.02)
    assert np.abs(path[1, :, 1]).max() < np.abs(path[0, :, 1]).max(), "a stretched one is slender"


@pytest.mark.parametrize("end", [(1.0, 0.5), (-2.0, -1.0), (0.0, -1.0), (0.0, 0.0), (1e-9, 2.5)])
@pytest.mark.parametrize("pull", [Vector2(0.0, -9.81), Vector2(3.0, 0.0)])
def test_a_slack_rope_hangs_with_its_whole_length(end: tuple[float, float], pull: Vector2) -> None:
    start = np.array([(1.0, 2.0)])
    (path,) = rope_paths(start, start + np.array([end]), np.array([3.0]), pull)
    assert path[0] == pytest.approx((1.0, 2.0)) and path[-1] - path[0] == pytest.approx(end, abs=1e-9)
    steps = np.hypot(*np.diff(path, axis=0).T)
    assert steps.sum() == pytest.approx(3.0, rel=0.015)
    down = np.array((pull.x, pull.y))
    middle = path[len(path) // 2]
    assert (middle - 0.5 * (path[0] + path[-1])) @ down > 0.0, "it hangs the way things fall"


def test_a_taut_rope_is_straight_and_one_without_gravity_hangs_down_all_the_same() -> None:
    world = empty_world(gravity_mode="none")
    rope = world.spawn(Rope(b=hung(world), anchor_a=(0, 2)))
    world.synchronise()
    assert len(of_colour(strokes(world), DARK.rope)[0]) == 3, "a line and two knots"
    world.component(rope, Rope).length = 3.0
    start, _ = of_colour(strokes(world), DARK.rope)
    assert len(start) > 20 and start[:, 1].max() > 370.0


def test_the_rope_of_a_pulley_runs_over_the_upper_rims_of_its_wheels() -> None:
    ends, hubs = np.array(((0.0, 300.0), (100.0, 200.0))), np.array(((0.0, 100.0), (100.0, 100.0)))
    path = pulley_path(ends, hubs, 10.0)
    assert path[0].tolist() == [0.0, 300.0] and path[-1].tolist() == [100.0, 200.0]
    assert path[1] == pytest.approx((-10.0, 100.0)) and path[-2] == pytest.approx((110.0, 100.0))
    assert path[:, 1].min() == pytest.approx(90.0)


def test_screws_turn_with_what_they_hold_and_motors_show_their_direction() -> None:
    world = empty_world()
    wheel = circle(world, (0.0, 0.0), radius=1.0, angle=0.3)
    pin = world.spawn(Pin(b=wheel, motor_speed=2.0))
    drawn = strokes(world)
    start, end = of_colour(drawn, DARK.accent)
    first = end[0] - start[0]
    world.component(pin, Pin).motor_speed = -2.0
    start, end = of_colour(strokes(world), DARK.accent)
    assert first[1] < 0.0 < (end[0] - start[0])[1], "from the same point up, and down"
    way = drawn["end"] - drawn["start"]
    angles = np.degrees(np.arctan2(-way[:, 1], way[:, 0]))
    assert np.isclose(angles, math.degrees(0.3), atol=1e-6).any(), "the slot of the screw"


def test_joints_are_caught_by_screws_wheels_sliders_and_lines() -> None:
    world = of_every_kind()

    def at(x: float, y: float, *, lines: bool = False) -> type | None:
        entity = joint_at(world, CAMERA, CAMERA.to_screen(Vector2(x, y)), lines=lines)
        kinds = (Rod, Rope, Slot, Weld, Pin, Pulley, Gear)
        return next((kind for kind in kinds if entity is not None and world.has(entity, kind)), None)

    assert at(-5, 1, lines=True) is Rod and at(-5, 1) is None
    assert at(-4, 1.5, lines=True) is Rope
    assert (at(-3, 0), at(-1.5, 0), at(0, 0), at(1.5, 2)) == (Slot, Weld, Pin, Pulley)
    assert at(0.5, 0.0, lines=True) is Gear and at(0.3, 0.4, lines=True) is Gear, (
        "where the wheels meet, a rim"
    )
    assert at(5, 5) is None and at(5, 5, lines=True) is None
    (rod,) = world.batch(Rod).entities.tolist()
    assert joint_lines(world, CAMERA, rod).tolist() == [[[140.0, 160.0], [140.0, 360.0]]]


@pytest.mark.parametrize("ratio", [-2.0, 2.0], ids=["gear", "belt"])
def test_rims_meet_against_each_other_and_a_belt_goes_around_wheels_that_turn_alike(ratio: float) -> None:
    world = empty_world()
    wheels = [circle(world, (x, 0.0), radius=radius) for x, radius in ((0.0, 0.8), (2.0, 0.4))]
    pins = [world.spawn(Pin(b=wheel, anchor_a=(x, 0.0))) for wheel, x in zip(wheels, (0.0, 2.0), strict=True)]
    gear = world.spawn(Gear(pins[0], pins[1], ratio=ratio))
    world.synchronise()
    place = np.array(
        [tuple(CAMERA.to_world(tuple(corner))) for corner in joint_lines(world, CAMERA, gear)[:, 0]]
    )
    from_first, from_second = np.hypot(*place.T), np.hypot(*(place - (2.0, 0.0)).T)
    if ratio > 0.0:
        assert (
            np.isclose(from_first, 0.8, atol=1e-6).sum()
            == np.isclose(from_second, 0.4, atol=1e-6).sum()
            == 33
        )
        assert place[:, 0].min() == pytest.approx(-0.8) and place[:, 0].max() == pytest.approx(2.4)
    else:
        assert (
            np.isclose(from_first, 4.0 / 3.0).sum() >= 64 and np.isclose(from_second, 2.0 / 3.0).sum() >= 64
        )
