"""Hand: takes hold of a body, leads it, throws it."""

import math
from dataclasses import replace

import pytest
from desk import FRAME, empty_world

from physicslab.components import Drag, Held, Mass, Pin, Rod, Rope, Thrust, Transform, Velocity
from physicslab.diagnostics.energy import measure_account
from physicslab.diagnostics.joint_warnings import joint_warnings
from physicslab.ecs.config import SimulationConfig, WindowConfig
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, circle
from physicslab.view.window.hand import Hand
from physicslab.view.window.placing import way_within
from physicslab.world import World


@pytest.fixture
def world() -> World:
    return empty_world(gravity=(0, 0))


def lead(hand: Hand, world: World, path: list[Vector2], now: float = 0.0) -> float:
    """Lead what is held along a path, a point a frame, in running time; return the time of the last."""
    for place in path:
        now += FRAME
        hand.move(place, now)
        hand.lead(world, FRAME, paused=False)
        hand.pull(world, FRAME)
        world.step(FRAME)
    return now


def test_the_grip_follows_exactly_whatever_the_angle(world: World) -> None:
    plank = box(world, (1, 1), width=2, height=0.5, angle=0.7, angular_velocity=3.0)
    hand = Hand(WindowConfig())
    assert hand.take(world, plank, Vector2(1.5, 1.4), 0.0)
    grip = world.component(plank, Held).grip
    for target in (Vector2(2, 2), Vector2(-3, 0.5), Vector2(-3, 0.5)):
        lead(hand, world, [target])
        pose = world.component(plank, Transform)
        assert (pose.position + grip.rotated(pose.angle) - target).magnitude < 1e-12
        assert pose.angle == 0.7


def test_a_held_body_is_infinitely_heavy(world: World) -> None:
    ball = circle(world, (0, 0))
    Hand(WindowConfig()).take(world, ball, Vector2(), 0.0)
    world.synchronise()
    assert world.bodies.inverse_mass[world.entity_index.row_of[ball]] == 0.0


def test_the_hand_pushes_and_does_not_jump_over(world: World) -> None:
    ball = circle(world, (0, 0), radius=0.2)
    other = circle(world, (1, 0), radius=0.2)
    hand = Hand(WindowConfig())
    hand.take(world, ball, Vector2(), 0.0)
    lead(hand, world, [Vector2(0.1 * n, 0) for n in range(1, 13)])
    assert world.component(other, Transform).position.x > 1.5
    assert world.component(other, Velocity).linear.x > 3.0


@pytest.mark.parametrize("velocity", [Vector2(3, 0), Vector2(-4, 7), Vector2(0.5, -0.25)])
def test_a_throw_has_the_velocity_of_the_hand(world: World, velocity: Vector2) -> None:
    ball = circle(world, (0, 0))
    hand = Hand(WindowConfig())
    hand.take(world, ball, Vector2(), 0.0)
    path = [velocity * (n * FRAME) for n in range(1, 30)]
    now = lead(hand, world, path)
    hand.release(world, path[-1], now, paused=False)
    assert (world.component(ball, Velocity).linear - velocity).magnitude < 0.02 * velocity.magnitude
    assert hand.entity is None and not world.has(ball, Held)


def test_only_the_last_150_ms_count(world: World) -> None:
    ball = circle(world, (0, 0))
    hand = Hand(WindowConfig())
    hand.take(world, ball, Vector2(), 0.0)
    fast = [Vector2(10 * n * FRAME, 0) for n in range(1, 40)]
    slow = [fast[-1] + Vector2(0, 2 * n * FRAME) for n in range(1, 11)]
    now = lead(hand, world, fast + slow)
    hand.release(world, slow[-1], now, paused=False)
    assert (world.component(ball, Velocity).linear - Vector2(0, 2)).magnitude < 0.04


def test_a_hand_at_rest_throws_nothing(world: World) -> None:
    ball = circle(world, (0, 0), velocity=(5, 5))
    hand = Hand(WindowConfig())
    hand.take(world, ball, Vector2(), 0.0)
    now = lead(hand, world, [Vector2(0.5, 0)] * 12)
    hand.release(world, Vector2(0.5, 0), now, paused=False)
    assert world.component(ball, Velocity).linear == Vector2(0, 0)


def test_a_single_jerk_is_no_throw(world: World) -> None:
    ball = circle(world, (0, 0))
    hand = Hand(WindowConfig())
    hand.take(world, ball, Vector2(), 0.0)
    now = lead(hand, world, [Vector2(0.3, 0)])
    hand.release(world, Vector2(0.3, 0), now, paused=False)
    assert world.component(ball, Velocity).linear == Vector2(0, 0)


def test_throws_are_capped_in_their_own_direction(world: World) -> None:
    ball = circle(world, (0, 0))
    hand = Hand(WindowConfig(max_throw_speed=30.0))
    hand.take(world, ball, Vector2(), 0.0)
    path = [Vector2(60, 80) * (n * FRAME) for n in range(1, 12)]
    now = lead(hand, world, path)
    hand.release(world, path[-1], now, paused=False)
    thrown = world.component(ball, Velocity).linear
    assert thrown.magnitude == pytest.approx(30.0)
    assert thrown.angle == pytest.approx(math.atan2(80, 60))


def test_while_paused_the_body_is_put_where_the_hand_is_and_goes_on_as_before(world: World) -> None:
    ball = circle(world, (0, 0), velocity=(1, 2), angular_velocity=3.0)
    hand = Hand(WindowConfig())
    hand.take(world, ball, Vector2(), 0.0)
    hand.move(Vector2(4, 4), FRAME)
    hand.lead(world, 0.0, paused=True)
    assert world.component(ball, Transform).position == Vector2(4, 4)
    hand.release(world, Vector2(4, 4), 2 * FRAME, paused=True)
    velocity = world.component(ball, Velocity)
    assert (velocity.linear, velocity.angular) == (Vector2(1, 2), 3.0)


def test_a_frame_without_a_step_moves_nothing(world: World) -> None:
    ball = circle(world, (0, 0))
    hand = Hand(WindowConfig())
    hand.take(world, ball, Vector2(), 0.0)
    hand.move(Vector2(4, 4), FRAME)
    hand.lead(world, 0.0, paused=False)
    assert world.component(ball, Transform).position == Vector2(0, 0)
    assert world.component(ball, Velocity).linear == Vector2(0, 0)


def test_walls_cannot_be_held(world: World) -> None:
    wall = box(world, (0, 0), static=True)
    hand = Hand(WindowConfig())
    assert not hand.take(world, wall, Vector2(), 0.0)
    assert hand.entity is None and not world.has(wall, Held)


def test_taking_another_lets_the_first_go(world: World) -> None:
    first, second = circle(world, (0, 0)), circle(world, (2, 0))
    hand = Hand(WindowConfig())
    hand.take(world, first, Vector2(), 0.0)
    hand.take(world, second, Vector2(2, 0), 0.0)
    assert not world.has(first, Held) and world.has(second, Held)


def test_a_body_that_vanishes_is_no_longer_held(world: World) -> None:
    ball = circle(world, (0, 0))
    hand = Hand(WindowConfig())
    hand.take(world, ball, Vector2(), 0.0)
    world.remove(ball)
    hand.lead(world, FRAME, paused=False)
    assert hand.entity is None
    hand.release(world, Vector2(), 0.1, paused=False)
    hand.drop(world)


def test_dropped_is_not_thrown(world: World) -> None:
    ball = circle(world, (0, 0))
    hand = Hand(WindowConfig())
    hand.take(world, ball, Vector2(), 0.0)
    lead(hand, world, [Vector2(0.2 * n, 0) for n in range(1, 12)])
    hand.drop(world)
    assert world.component(ball, Velocity).linear == Vector2(0, 0)
    assert not world.has(ball, Held)


def test_a_planet_without_a_shape_can_be_held(world: World) -> None:
    planet = world.spawn(Transform((1, 0)), Velocity(), Mass(3))
    hand = Hand(WindowConfig())
    assert hand.take(world, planet, Vector2(1, 0), 0.0)
    lead(hand, world, [Vector2(2, 0)])
    assert world.component(planet, Transform).position.x == pytest.approx(2.0)


def tower(contacts: str) -> tuple[World, list[int]]:
    """Return boxes on a floor, two side by side and one on both, the last of them, at rest."""
    world = empty_world(bounds=(-3.0, 0.0, 3.0, 4.0))
    world.simulation = replace(world.simulation, contacts=contacts)
    boxes = [box(world, (x, y), width=0.5, height=0.5) for x, y in ((-0.26, 0.25), (0.26, 0.25), (0.0, 0.75))]
    world.run(seconds=0.5)
    return world, boxes


def test_what_is_too_large_for_the_walls_is_held_in_their_middle_and_stays_there() -> None:
    world = empty_world(bounds=(-3.0, 0.0, 3.0, 9.0))
    beam = box(world, (1.0, 3.0), width=7.0, height=1.0)
    world.synchronise()
    for way in (Vector2(0.5, 0.0), Vector2(-9.0, 2.0)):
        assert tuple(way_within(world, beam, way)) == pytest.approx((-1.0, way.y))
    assert tuple(way_within(world, beam, Vector2(-1.0, 7.0))) == pytest.approx((-1.0, 5.5))


@pytest.mark.parametrize("contacts", ["soft", "rigid"])
@pytest.mark.parametrize(("pull", "frames"), [(0.65, 120), (2.3, 36)])
def test_a_pull_into_what_cannot_give_way_does_no_work_and_throws_nothing(
    contacts: str, pull: float, frames: int
) -> None:
    world, boxes = tower(contacts)
    places = [world.component(body, Transform).position for body in boxes]
    hand = Hand(WindowConfig())
    hand.take(world, boxes[-1], places[-1], 0.0)
    before = measure_account(world).energy["hand"]
    path = [places[-1] - Vector2(0.0, pull * min(n / frames, 1.0)) for n in range(1, frames + 60)]
    lead(hand, world, path)
    assert abs(measure_account(world).energy["hand"] - before) < 0.01
    for body, place in zip(boxes, places, strict=True):
        assert (world.component(body, Transform).position - place).magnitude < 1e-3
        assert world.component(body, Velocity).linear.magnitude < 1e-3, "it does not tremble"


def test_what_the_hand_pushes_gets_no_more_than_its_strength(world: World) -> None:
    ball, heavy = circle(world, (0, 0), radius=0.2, mass=1.0), circle(world, (1, 0), radius=0.2, mass=1000.0)
    hand = Hand(WindowConfig())
    hand.take(world, ball, Vector2(), 0.0)
    lead(hand, world, [Vector2(0.1 * n, 0) for n in range(1, 61)])
    assert 0.0 < world.component(heavy, Velocity).linear.x < 20.0 * 9.81 / 1000.0


@pytest.mark.parametrize("contacts", ["auto", "soft"])
def test_what_acts_on_a_body_in_the_hand_alone_is_no_work_of_the_hand(contacts: str) -> None:
    world = World(simulation=SimulationConfig(contacts=contacts))
    rocket, _ = circle(world, (0.0, 3.0), velocity=(0.7, 0.3)), circle(world, (1.0, 5.0))
    for part in (Thrust((3.0, 2.0), 0.5), Drag(1.0), Held()):
        world.add(rocket, part)
    world.run(steps=20)
    account = measure_account(world).energy
    for cause in ("hand", "thrust", "damping", "numerical"):
        assert abs(account[cause]) < 1e-12, cause


@pytest.mark.parametrize("joint", ["pin", "rod", "rope"])
def test_in_a_pause_a_body_goes_where_its_joints_let_it(joint: str) -> None:
    world = empty_world()
    bob = box(world, (0.0, -2.0), width=0.4, height=0.4)
    made = {"pin": Pin(b=bob, anchor_b=(0.0, 2.0)), "rod": Rod(b=bob), "rope": Rope(b=bob)}
    world.spawn(made[joint])
    hand = Hand(WindowConfig())
    hand.take(world, bob, Vector2(0.0, -2.0), 0.0, paused=True)
    for _ in range(20):
        hand.move(Vector2(3.0, 0.0), 0.1)
        hand.lead(world, 0.0, paused=True)
    hand.release(world, Vector2(3.0, 0.0), 0.2, paused=True)
    place = world.component(bob, Transform)
    assert place.position.magnitude == pytest.approx(2.0, abs=1e-6)
    assert tuple(place.position) == pytest.approx((2.0, 0.0), abs=0.02)
    assert place.angle == pytest.approx(math.pi / 2 if joint == "pin" else 0.0, abs=0.02)
    assert not list(joint_warnings(world))


@pytest.mark.parametrize("joint", ["pin", "rod", "rope"])
def test_while_time_runs_a_body_goes_where_its_joints_let_it_and_is_thrown_so(joint: str) -> None:
    """It was infinitely heavy in the hand, and torn off."""
    world = empty_world()
    bob = box(world, (0.0, -2.0), width=0.4, height=0.4)
    made = {"pin": Pin(b=bob, anchor_b=(0.0, 2.0)), "rod": Rod(b=bob), "rope": Rope(b=bob)}
    world.spawn(made[joint])
    hand, place = Hand(WindowConfig()), world.component(bob, Transform)
    hand.take(world, bob, Vector2(0.0, -2.0), 0.0)
    now = 0.0
    for corner in (Vector2(4.0, 0.0), Vector2(0.0, -3.0), Vector2(-1.5, -1.0)):
        for _ in range(90):
            now = lead(hand, world, [corner], now)
            assert place.position.magnitude < 2.0 + 1e-6
            assert joint == "rope" or place.position.magnitude == pytest.approx(2.0, abs=1e-6)
    aim = Vector2(-1.5, -1.0) if joint == "rope" else Vector2(-1.5, -1.0).normalized * 2.0
    assert (place.position - aim).magnitude < 0.1
    hand.release(world, Vector2(-1.5, -1.0), now, paused=False)
    assert world.component(bob, Velocity).linear.magnitude < 0.5 and not world.has(bob, Held)
    account = measure_account(world).energy
    assert account["hand"] == pytest.approx(sum(account.values()) - account["joints"], abs=1e-9)
    assert abs(account["numerical"]) < 1e-9 and (joint == "rope" or abs(account["joints"]) < 1e-9)


def test_in_a_pause_a_wheel_on_a_pin_turns_with_the_hand() -> None:
    world = empty_world()
    wheel = circle(world, (0.0, 0.0), radius=1.0)
    world.spawn(Pin(b=wheel))
    hand = Hand(WindowConfig())
    hand.take(world, wheel, Vector2(0.8, 0.0), 0.0, paused=True)
    for _ in range(60):
        hand.move(Vector2(0.0, 3.0), 0.1)
        hand.lead(world, 0.0, paused=True)
    place = world.component(wheel, Transform)
    assert place.position.magnitude < 1e-6 and place.angle == pytest.approx(math.pi / 2, abs=0.02)


def test_in_a_pause_what_hangs_on_a_body_comes_along() -> None:
    world = empty_world()
    upper, lower = (circle(world, (0.0, y), radius=0.1) for y in (0.0, -1.0))
    world.spawn(Rod(a=upper, b=lower))
    hand = Hand(WindowConfig())
    hand.take(world, upper, Vector2(), 0.0, paused=True)
    hand.move(Vector2(0.0, 2.0), 0.1)
    hand.lead(world, 0.0, paused=True)
    assert tuple(world.component(upper, Transform).position) == (0.0, 2.0)
    assert tuple(world.component(lower, Transform).position) == pytest.approx((0.0, 1.0))
