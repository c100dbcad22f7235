"""Prefabs: what they spawn, where, and that it behaves as they say."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab import InvalidValue, Vector2, World
from physicslab.components import Mass, Material, Pin, Shape, Spring, Trail, Transform, Velocity
from physicslab.diagnostics.energy import Audit, measure_momentum
from physicslab.diagnostics.joints import joint_states
from physicslab.ecs.config import PhysicsConfig
from physicslab.files.scene import write_scene
from physicslab.prefabs import (
    Planet,
    binary,
    box,
    chain,
    circle,
    container,
    gas,
    pendulum,
    pile,
    planets,
    pyramid,
    ragdoll,
    stack,
)
from physicslab.systems.standard import standard_systems


def place(world: World, entity: int) -> tuple[float, float]:
    """Return where an entity is."""
    x, y = world.component(entity, Transform).position
    return x, y


def space(**physics: object) -> World:
    """Return an empty world of the standard systems."""
    return World(*standard_systems(), physics=PhysicsConfig(**physics))  # type: ignore[arg-type]


def test_a_circle_has_the_given_properties() -> None:
    world = World()
    ball = circle(
        world, (1, 2), radius=0.5, mass=3, velocity=(4, 5), angular_velocity=6, angle=7,
        restitution=0.8, friction=0.9, name="ball",
    )  # fmt: skip
    assert world.label(ball) == "ball"
    assert world.component(ball, Shape).values() == Shape.circle(0.5).values()
    assert world.component(ball, Transform).values() == {"position": Vector2(1.0, 2.0), "angle": 7.0}
    assert world.component(ball, Velocity).values() == {"linear": Vector2(4.0, 5.0), "angular": 6.0}
    assert world.component(ball, Material).values() == {"restitution": 0.8, "friction": 0.9}
    world.synchronise()
    assert world.component(ball, Mass).inertia == 0.5 * 3 * 0.5**2


def test_a_box_may_be_static_or_keep_its_angle() -> None:
    world = World()
    floor = box(world, Vector2(0, -1), width=20, height=1, static=True, mass=5)
    assert not world.has(floor, Velocity) and not world.has(floor, Mass)
    crate = box(world, (0, 0), fixed_rotation=True)
    assert world.component(crate, Mass).fixed_rotation
    assert world.component(crate, Shape).values() == Shape.box(0.5, 0.5).values()


def test_wrong_options_are_refused_by_name() -> None:
    world = World()
    with pytest.raises(TypeError, match="a body has no option 'density'; it has mass, velocity"):
        circle(world, (0, 0), density=2)  # type: ignore[call-arg]
    with pytest.raises(InvalidValue, match=r"Mass\.mass = 0: must be a finite number > 0 kg"):
        circle(world, (0, 0), mass=0)
    with pytest.raises(InvalidValue, match=r"Shape\.radius"):
        circle(world, (0, 0), radius=-1)
    assert world.entities() == []


def test_a_container_holds_what_falls_in() -> None:
    world = space()
    floor, left, right = container(world, width=3, height=4)
    balls = pile(world, 30, (0, 1), columns=6, radius=0.2)
    world.run(seconds=2)
    for ball in balls:
        x, y = place(world, ball)
        assert -1.5 < x < 1.5 and 0.15 < y < 4
    assert place(world, left)[0] == -place(world, right)[0] == -2.0
    assert place(world, floor) == (0.0, -0.5)


def test_a_stack_stands_on_its_base() -> None:
    world = World()
    boxes = stack(world, 4, (1, 2), width=2, height=0.5, gap=0.1)
    places = [place(world, entity) for entity in boxes]
    assert [x for x, _ in places] == [1.0, 1.0, 1.0, 1.0]
    assert [y for _, y in places] == pytest.approx([2.25, 2.85, 3.45, 4.05])


@given(st.integers(1, 12))
def test_a_pyramid_is_symmetric_and_complete(base: int) -> None:
    world = World()
    boxes = pyramid(world, base, (3, 1), size=0.5, gap=0.05)
    assert len(boxes) == base * (base + 1) // 2
    places = [place(world, entity) for entity in boxes]
    assert math.fsum(x for x, _ in places) / len(boxes) == pytest.approx(3.0)
    assert places[-1] == pytest.approx((3.0, 1.0 + 0.5 * (base - 0.5)))
    if base > 1:
        assert places[1][0] - places[0][0] == pytest.approx(0.55)


SCATTERED: list[Callable[[World, int], list[int]]] = [
    lambda world, seed: gas(world, 50, (-2, -1, 3, 4), radius=0.15, seed=seed),
    lambda world, seed: pile(world, 50, (0, 0), columns=7, radius=0.2, gap=0.1, seed=seed),
]


@pytest.mark.parametrize("scatter", SCATTERED, ids=["gas", "pile"])
def test_what_is_scattered_never_overlaps_and_repeats_with_its_seed(
    scatter: Callable[[World, int], list[int]],
) -> None:
    for seed in range(5):
        world, again, other = World(), World(), World()
        discs = scatter(world, seed)
        radius = world.component(discs[0], Shape).radius
        centres = np.array([place(world, disc) for disc in discs])
        distances = np.linalg.norm(centres[:, None] - centres[None], axis=2)[np.triu_indices(50, 1)]
        assert distances.min() >= 2.0 * radius - 1e-12
        scatter(again, seed)
        scatter(other, seed + 1)
        assert write_scene(again) == write_scene(world) != write_scene(other)


def test_a_gas_stays_in_its_region_and_between_its_speeds() -> None:
    world = World()
    for disc in gas(world, 200, (-2, -1, 3, 4), radius=0.1, slowest=2, fastest=5):
        x, y = place(world, disc)
        assert -1.9 <= x <= 2.9 and -0.9 <= y <= 3.9
        assert 2.0 <= world.component(disc, Velocity).linear.magnitude <= 5.0
    with pytest.raises(ValueError, match=r"100 discs of radius 0\.5 m have no room in"):
        gas(world, 100, (0, 0, 4, 4), radius=0.5)
    with pytest.raises(ValueError, match="count = 0"):
        gas(world, 0, (0, 0, 4, 4))


def test_a_pendulum_hangs_at_its_length_and_swings_with_its_period() -> None:
    world = space(gravity=Vector2(0.0, -9.81))
    bob = pendulum(world, (1, 5), length=2, angle=0.05)
    x, y = place(world, bob)
    assert (x, y) == pytest.approx((1 + 2 * math.sin(0.05), 5 - 2 * math.cos(0.05)))
    crossings: list[float] = []
    before = x
    for _ in world.stepping(seconds=6):
        now = place(world, bob)[0]
        if before > 1.0 >= now:
            crossings.append(world.time - world.simulation.dt * (1.0 - now) / (before - now))
        before = now
    assert crossings[1] - crossings[0] == pytest.approx(2 * math.pi * math.sqrt(2 / 9.81), rel=2e-3)
    with pytest.raises(ValueError, match=r"damping = 1\.0: needs a stiffness"):
        pendulum(world, (0, 0), damping=1.0)


def test_a_chain_hangs_together_without_force_at_the_start() -> None:
    world = space(gravity_mode="none")
    balls = chain(world, 5, (0, 0), (6, 0), hold_end=True)
    assert [place(world, ball)[0] for ball in balls] == pytest.approx([1, 2, 3, 4, 5])
    springs = [world.component(entity, Spring) for entity in world.entities() if world.has(entity, Spring)]
    assert len(springs) == 6
    world.run(seconds=0.5)
    assert [place(world, ball)[0] for ball in balls] == pytest.approx([1, 2, 3, 4, 5], abs=1e-12)
    scalar = chain(world, 3, (0, 5), (0, 2))
    assert [place(world, ball)[1] for ball in scalar] == pytest.approx([4, 3, 2])
    with pytest.raises(ValueError, match="count = 0"):
        chain(world, 0, (0, 0), (1, 0))


def test_a_binary_goes_round_on_an_ellipse_without_momentum() -> None:
    world = space(gravity_mode="planet", G=2.0)
    heavy, light = binary(world, (3.0, 1.0), separation=4.0, eccentricity=0.5, trail=2.0)
    assert world.component(light, Trail).length == 2.0
    assert measure_momentum(world).linear.magnitude < 1e-15
    audit, distances = Audit(world), []
    a = 4.0 / 1.5
    period = 2 * math.pi * math.sqrt(a**3 / (2.0 * 4.0))
    for _ in world.stepping(seconds=period):
        audit.sample(world)
        distances.append(math.dist(place(world, heavy), place(world, light)))
    assert min(distances) == pytest.approx(a * 0.5, rel=1e-3)
    assert max(distances) == pytest.approx(4.0, rel=1e-3)
    assert place(world, light) == pytest.approx((3.0, 0.0), abs=0.05)
    assert audit.change < 1e-4
    with pytest.raises(ValueError, match="eccentricity = 1"):
        binary(world, eccentricity=1)
    with pytest.raises(ValueError, match="separation = 0"):
        binary(world, separation=0)


def test_planets_keep_their_distance_and_the_star_takes_their_momentum() -> None:
    world = space(gravity_mode="planet")
    star, inner, outer = planets(world, 4.0, [Planet("a", 0.01, 1.0), Planet("b", 0.01, 3.0, 2.0)])
    assert [world.label(entity) for entity in (star, inner, outer)] == ["star", "a", "b"]
    assert measure_momentum(world).linear.magnitude < 1e-15
    assert not world.has(star, Shape)
    for _ in world.stepping(seconds=5):
        assert math.dist(place(world, star), place(world, inner)) == pytest.approx(1.0, rel=0.05)
        assert math.dist(place(world, star), place(world, outer)) == pytest.approx(3.0, rel=0.05)
    with pytest.raises(ValueError, match="c: distance = 0"):
        planets(world, 1.0, [Planet("c", 1.0, 0)])


def test_a_ragdoll_is_whole_and_bends_within_its_limits() -> None:
    world = World()
    parts = ragdoll(world, (3, 4), size=0.5, angle=1.0)
    world.synchronise()
    pins = [world.component(pin, Pin) for pin in world.batch(Pin).entities.tolist()]
    assert len(parts) == 10 and len(pins) == 9
    assert sum(world.component(part, Mass).mass for part in parts) == pytest.approx(71.0 / 4.0)
    assert max(max(joint.stretch, joint.twist) for joint in joint_states(world)) < 1e-12
    assert all(pin.is_given("lower") and pin.is_given("upper") for pin in pins)
