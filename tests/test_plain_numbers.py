"""Rows of numbers as people think of them: pendulums, slopes and throws; degrees; pairs of surfaces."""

import math

import pygame
import pytest
from desk import SETTLED, Desk, empty_world, fill

from physicslab.components import Rod, Rope, Shape, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, circle, pendulum
from physicslab.view.window.plain_numbers import hanging_of, slope_of
from physicslab.world import World


def bench(world: World, *chosen: int) -> Desk:
    desk = Desk(world)
    desk.key("space")
    desk.window.selection.entities = chosen
    desk.frames(SETTLED)
    return desk


def test_a_pendulum_has_length_and_angle() -> None:
    world = empty_world()
    bob = pendulum(world, (1.0, 2.0), length=1.5, angle=0.5)
    desk = bench(world, bob)
    fill(desk, "Pendulum.length", "1 m")
    fill(desk, "Pendulum.angle", "30")
    place = world.component(bob, Transform).position
    assert tuple(place) == pytest.approx((1.5, 2.0 - math.cos(math.pi / 6)), abs=1e-12)
    (rod,) = world.batch(Rod).entities.tolist()
    assert world.component(rod, Rod).length == pytest.approx(1.0, abs=1e-15)
    assert len(desk.window.edits.history.entries) == 2
    fill(desk, "Pendulum.angle", "0.5 rad")
    hanging = hanging_of(world, bob)
    assert hanging is not None and hanging.angle == pytest.approx(0.5, abs=1e-12)
    fill(desk, "Pendulum.angle", "1 +")
    assert hanging_of(world, bob) == hanging and any("is no number" in words for words in desk.ui.words)
    pygame.display.quit()


@pytest.mark.parametrize("kind", [Rod, Rope, Spring])
def test_what_hangs_is_found_whatever_it_hangs_on(kind: type) -> None:
    world = empty_world()
    bob = circle(world, (0.0, 1.0))
    lengths = {"Rope": {"length": 2.0}, "Spring": {"rest_length": 2.0}}.get(kind.__name__, {})
    world.spawn(kind(bob, None, anchor_b=(0.0, 3.0), **lengths))
    world.synchronise()
    hanging = hanging_of(world, bob)
    assert hanging is not None and hanging.angle == 0.0 and hanging.arm == Vector2(0.0, -2.0)
    world.spawn(Rod(bob, None, anchor_b=(1.0, 3.0)))
    world.synchronise()
    assert hanging_of(world, bob) is None, "held by two it is no pendulum"


@pytest.mark.parametrize("way", [(2.0, 1.0), (-2.0, 1.0), (2.0, -1.0)])
def test_a_slope_has_an_angle_and_keeps_its_foot_and_its_length(way: tuple[float, float]) -> None:
    world = empty_world()
    corners = [Vector2(1.0, 1.0), Vector2(1.0 + way[0], 1.0), Vector2(1.0, 1.0) + Vector2(*way)]
    shape = Shape.polygon(corners if way[0] * way[1] > 0.0 else corners[::-1])
    first = corners[0] if way[0] * way[1] > 0.0 else corners[-1]
    ramp = world.spawn(Transform(first - shape.vertices[0]), shape)
    desk = bench(world, ramp)
    fill(desk, "Slope", "20")
    slope = slope_of(world, ramp)
    assert slope is not None and math.degrees(slope.angle) == pytest.approx(20.0, abs=1e-9)
    assert tuple(slope.foot) == pytest.approx((1.0, 1.0), abs=1e-12)
    assert (slope.top - slope.foot).magnitude == pytest.approx(math.hypot(*way), rel=1e-12)
    pygame.display.quit()


def test_a_throw_has_speed_and_direction() -> None:
    world = empty_world()
    ball = circle(world, (0.0, 0.0))
    desk = bench(world, ball)
    fill(desk, "Throw.speed", "36 km/h")
    assert tuple(world.component(ball, Velocity).linear) == (10.0, 0.0)
    fill(desk, "Throw.direction", "60")
    assert tuple(world.component(ball, Velocity).linear) == pytest.approx((5.0, 5.0 * math.sqrt(3.0)))
    fill(desk, "Throw.direction", "180")
    assert tuple(world.component(ball, Velocity).linear) == (-10.0, 0.0), "without a rest of rounding"
    world.component(ball, Velocity).linear = Vector2(0.2, -1e-17)
    desk.frames(60)
    assert desk.ui.spoken["Throw.direction"].value == "0", "it was -2.9e-15"
    pygame.display.quit()


def test_angles_are_in_degrees_without_whole_turns_and_in_radians_for_engineers() -> None:
    world = empty_world()
    ball = circle(world, (0.0, 0.0), angle=4.0 * math.pi + 0.5)
    desk = bench(world, ball)
    for level, shown in (("Explore", "28.6479"), ("Measure", "28.6479"), ("Engineer", "13.0664")):
        desk.window.level = level
        desk.frames(SETTLED)
        assert shown in desk.ui.words, level
    pygame.display.quit()


def test_two_bodies_have_the_numbers_of_their_pair() -> None:
    world = empty_world()
    one = circle(world, (0.0, 0.0), restitution=0.9, friction=0.25)
    desk = bench(world, one, box(world, (2.0, 0.0), restitution=0.5, friction=1.0))
    assert desk.ui.rows["μ of the pair"] == "0.5" and desk.ui.rows["e of the pair"] == "0.5"
    pygame.display.quit()
