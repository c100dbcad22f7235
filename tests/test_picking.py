"""Picking: which body is under the cursor."""

import math

import pytest
from desk import empty_world

from physicslab.components import Mass, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, circle
from physicslab.view.canvas.camera import Camera
from physicslab.view.controls.picking import body_at
from physicslab.world import World


@pytest.fixture
def camera() -> Camera:
    return Camera((1280, 720))


def at(world: World, camera: Camera, x: float, y: float) -> int | None:
    world.synchronise()
    return body_at(world, camera, camera.to_screen(Vector2(x, y)))


def test_nothing_in_an_empty_world(camera: Camera) -> None:
    assert at(empty_world(), camera, 0, 0) is None


def test_a_circle_is_hit_inside_its_radius(camera: Camera) -> None:
    world = empty_world()
    ball = circle(world, (1, 1), radius=0.5)
    assert at(world, camera, 1.35, 1.35) == ball
    assert at(world, camera, 1.36, 1.36) is None  # the corner of its square
    assert at(world, camera, 1.0, 0.49) is None


def test_a_turned_box_is_hit_where_it_is(camera: Camera) -> None:
    world = empty_world()
    plank = box(world, (0, 0), width=4, height=0.2, angle=math.pi / 4)
    assert at(world, camera, 1.3, 1.3) == plank
    assert at(world, camera, 1.3, 1.6) is None
    assert at(world, camera, 1.5, 0) is None


def test_what_is_drawn_last_is_on_top(camera: Camera) -> None:
    world = empty_world()
    ball = circle(world, (0, 0), radius=0.5)
    upper = circle(world, (0.2, 0), radius=0.5)
    box(world, (0, 0), width=3, height=3)
    floor = box(world, (0, 0), width=9, height=9, static=True)
    assert at(world, camera, 0.2, 0) == upper
    assert at(world, camera, -0.4, 0) == ball
    assert at(world, camera, 4, 4) == floor


def test_a_planet_without_a_shape_is_caught_within_a_few_pixels(camera: Camera) -> None:
    world = empty_world()
    planet = world.spawn(Transform((2, 2)), Velocity(), Mass(1))
    camera.scale = 1.0
    assert at(world, camera, 7, 2) == planet
    assert at(world, camera, 12, 2) is None


def test_a_body_that_is_small_on_the_screen_is_still_caught(camera: Camera) -> None:
    world = empty_world()
    crumb = circle(world, (0, 0), radius=0.01)
    other = circle(world, (0.1, 0), radius=0.01)
    assert at(world, camera, 0.03, 0.03) == crumb
    assert at(world, camera, 0.07, 0.0) == other


def test_things_that_are_no_bodies_are_not_hit(camera: Camera) -> None:
    world = empty_world()
    world.spawn(Transform((0, 0)))
    assert at(world, camera, 0, 0) is None


@pytest.mark.filterwarnings("error")
def test_a_lost_body_does_no_harm(camera: Camera) -> None:
    world = empty_world()
    lost, ball = circle(world, (0, 0)), circle(world, (3, 0))
    world.synchronise()
    world.table(Transform)["position"][world.entity_index.row_of[lost]] = math.nan
    assert at(world, camera, 0, 0) is None
    assert at(world, camera, 3, 0) == ball
