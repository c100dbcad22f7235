"""Impulses: conservation laws, Coulomb's law, restitution, spin, and what never happens."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from kept_contacts import kept_contacts

from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.contacts.memory import restore_contacts
from physicslab.contacts.report import contact_between
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.systems.standard import standard_systems
from physicslab.world import World

NO_GRAVITY = PhysicsConfig(gravity_mode="none")


MODEL = {"contacts": "soft"}


@pytest.fixture(params=["soft", "auto"], scope="module", autouse=True)
def contacts(request: pytest.FixtureRequest) -> str:
    """Make laboratories with each model of contacts: what is tested here holds with both."""
    MODEL["contacts"] = request.param
    return MODEL["contacts"]


def laboratory(physics: PhysicsConfig = NO_GRAVITY, integrator: str = "auto") -> World:
    simulation = SimulationConfig(integrator=integrator, contacts=MODEL["contacts"])
    return World(*standard_systems(), physics=physics, simulation=simulation)


def disc(
    world: World,
    place: tuple[float, float],
    velocity: tuple[float, float] = (0, 0),
    *,
    mass: float = 1.0,
    radius: float = 0.25,
    spin: float = 0.0,
    e: float = 1.0,
    mu: float = 0.0,
) -> int:
    return world.spawn(
        Transform(place), Velocity(velocity, spin), Mass(mass), Shape.circle(radius), Material(e, mu)
    )


def floor(world: World, e: float = 0.0, mu: float = 0.0) -> int:
    return world.spawn(Transform((0, -0.5)), Shape.box(200, 1), Material(e, mu))


@pytest.mark.parametrize("integrator", ["leapfrog", "symplectic_euler"])
def test_head_on_unequal_masses_keep_momentum_and_energy(integrator: str) -> None:
    world = laboratory(integrator=integrator)
    a = disc(world, (-2, 0), (3, 0), mass=1.7)
    b = disc(world, (2, 0), (-1, 0), mass=0.6)
    energy, momentum = measure_energy(world).total, measure_momentum(world).linear
    world.run(seconds=2.0)
    assert measure_energy(world).total == pytest.approx(energy, rel=1e-12)
    assert measure_momentum(world).linear.x == pytest.approx(momentum.x, rel=1e-12)
    assert world.component(a, Velocity).linear.x == pytest.approx((1.1 * 3 - 1.2) / 2.3, rel=1e-12)
    assert world.component(b, Velocity).linear.x == pytest.approx((-1.1 * -1 + 3.4 * 3) / 2.3, rel=1e-12)
    assert world.component(a, Velocity).angular == 0.0
    assert world.collisions == 1


speeds = st.floats(-5, 5)


@settings(max_examples=60)
@given(
    st.floats(0.1, 10), st.floats(0.1, 10), speeds, speeds, speeds, st.floats(-0.45, 0.45),
    st.floats(-20, 20), st.floats(0, 1), st.floats(0, 1),
)  # fmt: skip
def test_oblique_impacts_keep_both_momenta_and_never_gain_energy(
    mass_a: float,
    mass_b: float,
    vx: float,
    vy: float,
    vb: float,
    miss: float,
    spin: float,
    e: float,
    mu: float,
) -> None:
    world = laboratory()
    disc(world, (-2, 0), (4 + vx / 2, vy), mass=mass_a, e=e, mu=mu, spin=spin)
    disc(world, (0, miss), (-1, vb), mass=mass_b, e=e, mu=mu)
    energy, momentum = measure_energy(world).total, measure_momentum(world)
    world.run(seconds=2.0)
    assume(world.collisions > 0)
    after = measure_momentum(world)
    scale = mass_a * 7 + mass_b * 6
    assert (after.linear - momentum.linear).magnitude <= 1e-12 * scale
    assert abs(after.angular - momentum.angular) <= 1e-11 * scale * 2
    assert measure_energy(world).total <= energy * (1 + 1e-12)


def test_equal_smooth_discs_leave_at_a_right_angle() -> None:
    world = laboratory()
    a = disc(world, (-1, 0.2), (2, 0))
    b = disc(world, (0, 0))
    world.run(seconds=2.0)
    va, vb = world.component(a, Velocity).linear, world.component(b, Velocity).linear
    assert va.dot(vb) == pytest.approx(0.0, abs=1e-12)
    # The line of centres at contact fixes both directions: sin = 0.2 / 0.5.
    assert math.atan2(-vb.y, vb.x) == pytest.approx(math.asin(0.4), abs=1e-9)


def test_a_separating_pair_only_has_its_overlap_corrected() -> None:
    world = laboratory()
    a = disc(world, (0, 0), (-1, 0))
    b = disc(world, (0.49, 0), (1, 0))
    world.step()
    assert world.component(a, Velocity).linear == Vector2(-1, 0)
    assert world.component(b, Velocity).linear == Vector2(1, 0)
    assert world.collisions == 0


@pytest.mark.parametrize("e", [1.0, 0.8, 0.5])
@pytest.mark.parametrize("shape", [Shape.circle(0.25), Shape.box(0.5, 0.5)], ids=["circle", "box"])
def test_bounces_rise_to_e_squared_of_the_height(e: float, shape: Shape) -> None:
    world = laboratory(PhysicsConfig())
    floor(world, e)
    made = Shape.circle(shape.radius) if shape.kind == "circle" else Shape.box(shape.width, shape.height)
    ball = world.spawn(Transform((0, 5.25)), Velocity(), Mass(1), made, Material(e, 0.5))
    pose, velocity = world.component(ball, Transform), world.component(ball, Velocity)
    apexes: list[float] = []
    before = 0.0
    while len(apexes) < 3:
        world.step()
        if before > 0 >= velocity.linear.y:
            apexes.append(pose.position.y - 0.25 + velocity.linear.y**2 / (2 * 9.81))
        before = velocity.linear.y
    expected = [5 * e ** (2 * k) for k in (1, 2, 3)]
    assert apexes == pytest.approx(expected, rel=1e-3)
    assert pose.angle == pytest.approx(0.0, abs=1e-9)


def test_an_elastic_ball_keeps_its_energy_for_a_minute() -> None:
    world = laboratory(PhysicsConfig())
    floor(world, 1.0)
    disc(world, (0, 2.25))
    energy = measure_energy(world).total
    world.run(seconds=60.0)
    assert world.collisions == pytest.approx(60 / (2 * math.sqrt(4 / 9.81)), abs=1)
    assert measure_energy(world).total == pytest.approx(energy, rel=1e-9)


@pytest.mark.parametrize("mu", [0.2, 0.6])
def test_a_sliding_box_stops_after_v_squared_over_2_mu_g(mu: float) -> None:
    world = laboratory(PhysicsConfig())
    floor(world, 0, mu)
    box = world.spawn(Transform((0, 0.5)), Velocity((4, 0)), Mass(2), Shape.box(1, 1), Material(0, mu))
    world.run(seconds=5.0)
    assert world.component(box, Transform).position.x == pytest.approx(16 / (2 * mu * 9.81), rel=0.002)
    assert world.component(box, Velocity).linear.magnitude < 1e-9


def test_a_slipping_disc_ends_up_rolling_at_two_thirds() -> None:
    world = laboratory(PhysicsConfig())
    floor(world, 0, 0.3)
    ball = disc(world, (0, 0.5), (6, 0), radius=0.5, mass=3, e=0, mu=0.3)
    world.run(seconds=3.0)
    velocity = world.component(ball, Velocity)
    assert velocity.linear.x == pytest.approx(4.0, rel=1e-6)
    assert velocity.angular == pytest.approx(-velocity.linear.x / 0.5, rel=1e-6)


@pytest.mark.parametrize(("angle", "slides"), [(0.95, False), (1.05, True)])
def test_a_block_holds_just_under_the_friction_angle_and_slides_just_over(angle: float, slides: bool) -> None:
    mu = 0.5
    tilt = math.atan(mu) * angle
    g = 9.81
    world = laboratory(PhysicsConfig(gravity=Vector2.from_angle(tilt - math.pi / 2, g)))
    floor(world, 0, mu)
    block = world.spawn(Transform((0, 0.25)), Velocity(), Mass(1), Shape.box(1, 0.5), Material(0, mu))
    world.run(seconds=1.0)
    start, speed = world.component(block, Transform).position.x, world.component(block, Velocity).linear.x
    world.run(seconds=2.0)
    moved = world.component(block, Transform).position.x - start
    if slides:
        acceleration = g * (math.sin(tilt) - mu * math.cos(tilt))
        assert moved == pytest.approx(speed * 2 + acceleration * 2, rel=0.01)
    else:
        assert abs(moved) < 1e-4


def test_friction_spins_a_disc_by_its_lever_arm() -> None:
    """A disc falling on a rough floor with a sideways speed: the impulses of one impact, by hand."""
    world = laboratory(PhysicsConfig())
    ground = floor(world, 0.5, 0.2)
    ball = disc(world, (0, 0.26), (3, -2), mass=2, e=0.5, mu=0.2)
    velocity = world.component(ball, Velocity)
    world.run(steps=1)
    down = math.sqrt(4 + 2 * 9.81 * 0.01)
    normal = 1.5 * 2 * down
    contact = contact_between(world, ground, ball)
    assert contact is not None
    (point,) = contact.points
    assert point.approach_speed == pytest.approx(down, rel=1e-9)
    assert point.impact_normal == pytest.approx(normal, rel=1e-9)
    assert point.impact_tangent == pytest.approx(
        0.2 * normal, rel=1e-9
    )  # B of the pair is the ball: pushed back
    assert velocity.linear.x == pytest.approx(3 - 0.2 * normal / 2, rel=1e-9)
    assert velocity.angular == pytest.approx(-0.2 * normal * 0.25 / (0.5 * 2 * 0.25**2), rel=1e-9)


@pytest.mark.parametrize("direction", [1, -1])
def test_a_row_of_equal_balls_passes_the_speed_on(direction: int) -> None:
    world = laboratory()
    balls = [disc(world, (0.5 * k, 0), (0, 0)) for k in range(5)]
    first, last = (balls[0], balls[-1]) if direction > 0 else (balls[-1], balls[0])
    world.component(first, Velocity).linear = (2.0 * direction, 0)
    world.run(seconds=1.0)
    left = [world.component(ball, Velocity).linear.x for ball in balls]
    assert left == [2.0 * direction if ball == last else 0.0 for ball in balls]


@pytest.mark.parametrize("speed", [50, 500, 1e5, 1e6])
@pytest.mark.parametrize("moving", [False, True], ids=["static", "moving"])
@pytest.mark.parametrize("kind", ["circle", "box"])
@pytest.mark.parametrize("e", [0.0, 0.5])
def test_nothing_passes_through_a_thin_wall(speed: float, moving: bool, kind: str, e: float) -> None:
    world = laboratory()
    shape = Shape.circle(0.05) if kind == "circle" else Shape.box(0.1, 0.1)
    bullet = world.spawn(Transform((-3, 0)), Velocity((speed, 0)), Mass(1), shape, Material(e, 0))
    parts = (Velocity((-1, 0)), Mass(10)) if moving else ()
    wall = world.spawn(Transform((0, 0)), Shape.box(0.005, 2), Material(e, 0), *parts)
    energy = measure_energy(world).total
    for _ in range(30):
        world.step()
        assert world.component(bullet, Transform).position.x < world.component(wall, Transform).position.x
    assert measure_energy(world).total <= energy * (1 + 1e-9)


def test_a_fast_disc_that_misses_moves_on() -> None:
    world = laboratory()
    disc(world, (-3, 1.2), (500, 0), radius=0.1)
    world.spawn(Transform((0, 0)), Shape.box(0.1, 2), Material(1, 0))
    world.run(seconds=0.1)
    assert world.component(1, Velocity).linear == Vector2(500, 0)
    assert world.component(1, Transform).position.x == pytest.approx(47.0)


def test_bounds_reflect_have_friction_and_keep_everything_in() -> None:
    world = laboratory(
        PhysicsConfig(gravity_mode="none", bounds=(0, 0, 4, 4), bounds_restitution=1, bounds_friction=0)
    )
    ball = disc(world, (1, 2), (-3, 0.5), mu=0.5)
    crate = world.spawn(Transform((3, 2)), Velocity((0, 40)), Mass(1), Shape.box(0.5, 0.5), Material(1, 0))
    for _ in range(200):
        world.step()
        for entity in (ball, crate):
            x, y = world.component(entity, Transform).position
            assert 0.0 < x < 4.0 and 0.0 < y < 4.0
    assert measure_energy(world).total == pytest.approx(0.5 * 9.25 + 0.5 * 1600, rel=1e-9)
    rough = laboratory(PhysicsConfig(bounds=(0, 0, 4, 4), bounds_friction=0.4, bounds_restitution=0))
    ball = disc(rough, (1, 0.25), (2, 0), e=0, mu=0.4)
    rough.run(seconds=0.9)
    assert rough.component(ball, Velocity).linear.x == pytest.approx(4 / 3, rel=1e-3)


def test_a_held_body_pushes_and_nothing_pushes_it_back() -> None:
    from physicslab.components import Held

    world = laboratory()
    hand = disc(world, (0, 0), (1, 0), mass=0.001)
    world.add(hand, Held())
    heavy = disc(world, (1, 0), mass=1000, e=0)
    world.run(seconds=1.0)
    assert world.component(hand, Velocity).linear == Vector2(1, 0)
    assert world.component(heavy, Velocity).linear.x == pytest.approx(1.0, rel=1e-9)


def test_overlapping_discs_come_apart_without_exploding() -> None:
    world = laboratory()
    for _ in range(40):
        disc(world, (0, 0), e=0.5, mu=0.3, radius=0.1)
    fastest = 0.0
    for _ in range(300):
        world.step()
        fastest = max(fastest, float(np.abs(world.table(Velocity)["linear"]).max()))
    assert fastest < 1.0
    assert world.contacts.max_penetration < 0.01


def stack(world: World, count: int, gap: float = 0.0, e: float = 0.0) -> list[int]:
    floor(world, e, 0.6)
    return [
        world.spawn(
            Transform((0, 0.5 + k * (1 + gap))), Velocity(), Mass(1), Shape.box(1, 1), Material(e, 0.6)
        )
        for k in range(count)
    ]


def settled(world: World, boxes: list[int], seconds: float = 10.0) -> tuple[float, float, float]:
    """Run, and return the largest drift sideways [m], the largest sink [m] and the energy left [J]."""
    before = [world.component(box, Transform).position for box in boxes]
    world.run(seconds=seconds)
    moved = [world.component(box, Transform).position - at for box, at in zip(boxes, before, strict=True)]
    return max(abs(m.x) for m in moved), max(-m.y for m in moved), measure_energy(world).kinetic


def test_a_stack_of_ten_boxes_stands() -> None:
    world = laboratory(PhysicsConfig(gravity=Vector2(0, -10)))
    drift, sink, energy = settled(world, stack(world, 10))
    assert drift <= 0.002
    assert sink <= 0.035
    assert energy < 1e-4


def test_a_pyramid_of_465_boxes_stands() -> None:
    world = laboratory(PhysicsConfig(gravity=Vector2(0, -10)))
    floor(world, 0, 0.6)
    boxes = [
        world.spawn(
            Transform(((i - (29 - row) / 2) * 1.1, 0.5 + row)),
            Velocity(),
            Mass(1),
            Shape.box(1, 1),
            Material(0, 0.6),
        )
        for row in range(30)
        for i in range(30 - row)
    ]
    drift, sink, energy = settled(world, boxes)
    assert len(boxes) == 465
    assert drift <= 0.05
    assert sink <= 0.10
    assert energy < 1e-3


@pytest.mark.parametrize("e", [0.5, 0.9])
def test_a_stack_of_bouncing_boxes_comes_to_rest(e: float) -> None:
    world = laboratory(PhysicsConfig(gravity=Vector2(0, -10)))
    drift, sink, energy = settled(world, stack(world, 8, gap=0.02, e=e))
    assert drift < 0.02
    assert sink < 8 * 0.02 + 0.03
    assert energy < 1e-3


def test_a_gas_of_2000_keeps_its_energy_and_stays_inside() -> None:
    bounds = (0.0, 0.0, 20.0, 20.0)
    world = laboratory(
        PhysicsConfig(gravity_mode="none", bounds=bounds, bounds_restitution=1, bounds_friction=0)
    )
    generator = np.random.default_rng(1)
    for k in range(2000):
        heading = Vector2.from_angle(generator.uniform(0, 2 * math.pi), generator.uniform(1, 3))
        disc(world, ((k % 45 + 0.5) * 20 / 45, (k // 45 + 0.5) * 20 / 45), (heading.x, heading.y), radius=0.1)
    energy = measure_energy(world).total
    world.run(steps=600)
    assert measure_energy(world).total == pytest.approx(energy, rel=1e-9)
    position = world.table(Transform)["position"][1:]
    assert position.min() > 0.0 and position.max() < 20.0
    assert world.collisions > 10_000


def test_the_same_scene_gives_the_same_bits() -> None:
    def final() -> bytes:
        world = laboratory(PhysicsConfig(gravity=Vector2(0, -10)))
        stack(world, 6, gap=0.05, e=0.4)
        disc(world, (-3, 2), (6, 1), mu=0.4)
        world.run(seconds=3.0)
        return bytes(world.table(Transform)["position"].tobytes() + world.table(Velocity)["linear"].tobytes())

    assert final() == final()


def test_what_the_solver_keeps_survives_export() -> None:
    """A world rebuilt from components and exported contacts goes on with the same bits."""
    world = laboratory(PhysicsConfig(gravity=Vector2(0, -10), bounds=(-10, -10, 10, 10)))
    entities = [*stack(world, 5, gap=0.03, e=0.3), disc(world, (-3, 2), (6, 1), mu=0.4, e=0.4)]
    world.run(seconds=1.3)
    again = laboratory(world.physics)
    floor(again, 0.3, 0.6)
    for entity in entities:
        pose, velocity = world.component(entity, Transform), world.component(entity, Velocity)
        shape, material = world.component(entity, Shape), world.component(entity, Material)
        again.spawn(
            Transform(pose.position, pose.angle), Velocity(velocity.linear, velocity.angular),
            Mass(world.component(entity, Mass).mass), Shape(shape.kind, shape.radius, shape.width,
            shape.height), Material(material.restitution, material.friction),
        )  # fmt: skip
    restore_contacts(again.contacts, kept_contacts(world.contacts))
    for _ in range(120):
        world.step()
        again.step()
    for component, name in ((Transform, "position"), (Transform, "angle"), (Velocity, "linear")):
        assert world.table(component)[name].tobytes() == again.table(component)[name].tobytes()


def test_free_flight_is_exact_in_a_scene_with_contacts_too() -> None:
    world = laboratory(PhysicsConfig(bounds=(-1e5, -1e6, 1e5, 1e5)))
    floor(world, 0, 0.5)
    world.spawn(Transform((0, 0.5)), Velocity(), Mass(1), Shape.box(1, 1), Material(0, 0.5))
    flier = disc(world, (150, 20), (7, 30))
    world.run(steps=1000)
    t = 1000 / 60
    x, y = world.component(flier, Transform).position
    assert world.contacts.count > 0
    assert x == pytest.approx(150 + 7 * t, rel=1e-12)
    assert y == pytest.approx(20 + 30 * t - 9.81 * t * t / 2, rel=1e-12)


def test_what_is_beyond_the_bounds_is_put_back_inside() -> None:
    world = laboratory(PhysicsConfig(bounds=(-5, -5, 5, 5)))
    ball = disc(world, (100, 0), e=0.5)
    world.step()
    assert world.component(ball, Transform).position.x < 5.0
    assert world.component(ball, Velocity).linear.magnitude < 1.0


def test_coincident_boxes_come_apart_slowly() -> None:
    world = laboratory()
    for _ in range(10):
        world.spawn(Transform(), Velocity(), Mass(1), Shape.box(1, 1), Material(0, 0.5))
    for _ in range(300):
        world.step()
        assert float(np.abs(world.table(Velocity)["linear"]).max()) < 2.0
    assert world.contacts.max_penetration < 0.05
