"""Impacts of rigid bodies: restitution, friction's cone, momenta and energy, by laws written down here."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from compiled import compiled
from numpy.typing import NDArray

from physicslab import World
from physicslab.components import Mass, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.kernels.constraint import impact_law
from physicslab.prefabs import box, circle
from physicslab.stepping.rigid import Rigid
from physicslab.systems.standard import standard_systems

G = 9.81
stronge_impulse: Any = compiled(impact_law.stronge_impulse)


def laboratory(*, dt: float = 1 / 60, sleeping: bool = True, **physics: Any) -> World:
    """Return an empty world with rigid contacts."""
    config = SimulationConfig(contacts="rigid", dt=dt, sleeping=sleeping)
    return World(*standard_systems(), physics=PhysicsConfig(**physics), simulation=config)


def check_rigid(world: World) -> None:
    """Check that no step was left to soft contacts."""
    assert [s.left_to_soft for s in world.steppers.usable if isinstance(s, Rigid)] == [0]


def motion(world: World, entity: int) -> NDArray[np.float64]:
    """Return both speeds and the angular velocity."""
    found = world.component(entity, Velocity)
    return np.array((found.linear.x, found.linear.y, found.angular))


def place(world: World, entity: int) -> NDArray[np.float64]:
    """Return x, y and angle."""
    found = world.component(entity, Transform)
    return np.array((found.position.x, found.position.y, found.angle))


def inverse_masses(world: World, entity: int) -> NDArray[np.float64]:
    """Return 1/m twice and 1/I, nothing for what is fixed."""
    if not world.has(entity, Mass):
        return np.zeros(3)
    mass = world.component(entity, Mass)
    return np.array((1 / mass.mass, 1 / mass.mass, 1 / mass.inertia))


def rows(normal: NDArray[np.float64], arms: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Return the rows that make normal and tangential speed at a point of the motion of A and B, (2, 6)."""
    tangent = np.array((-normal[1], normal[0]))
    found = np.zeros((2, 6))
    for k, direction in enumerate((normal, tangent)):
        for side, sign in ((0, -1.0), (1, 1.0)):
            turn = arms[side][0] * direction[1] - arms[side][1] * direction[0]
            found[k, 3 * side : 3 * side + 3] = sign * np.array((*direction, turn))
    return found


def newton(a: NDArray[np.float64], speeds: NDArray[np.float64], e: float, mu: float) -> NDArray[np.float64]:
    """Return the impulses along normal and tangent by Newton's law and Coulomb's: one point, by cases."""
    wanted = np.array((-(1.0 + e) * speeds[0], -speeds[1]))
    sticking = np.linalg.solve(a, wanted)
    if abs(sticking[1]) <= mu * sticking[0]:
        return sticking
    for edge in (-mu, mu):
        pressed = wanted[0] / (a[0, 0] + edge * a[0, 1])
        after = speeds[1] + pressed * (a[1, 0] + edge * a[1, 1])
        if pressed > 0.0 and after * edge <= 0.0:
            return np.array((pressed, edge * pressed))
    raise AssertionError("no impulses keep both laws")


def stronge(a: NDArray[np.float64], speeds: NDArray[np.float64], e: float, mu: float) -> NDArray[np.float64]:
    """Return the impulses by Stronge's law, which ``test_energetic_impacts.py`` tests."""
    return np.array(stronge_impulse(impact_law.PointResponse(a[0, 0], a[1, 1], a[0, 1], *speeds), e, mu))


def energy_gained(a: NDArray[np.float64], speeds: NDArray[np.float64], impulse: NDArray[np.float64]) -> float:
    """Return the work of an impulse [J]."""
    return float(impulse @ speeds + 0.5 * impulse @ a @ impulse)


# ---- corners on a floor ------------------------------------------------------------------------------------


def reached(world: World, body: int, floor: int, start: NDArray[np.float64], g: float) -> tuple[Any, ...]:
    """Check the first impact of a body that was let go with ``start`` = (x, y, angle, vx, vy, spin).

    Returns e reached, energy after over before, J_t / J_n, the sliding speed after, what unit impulses cause,
    and the speeds before.
    """
    before = measure_energy(world)
    while not world.contacts.logged:
        world.step()
        assert world.time < 3.0
    check_rigid(world)
    assert world.contacts.logged == 1
    impact = world.contacts.impacts[0]
    assert (impact["entity_a"], impact["entity_b"]) == (floor, body)
    t = float(impact["time"])
    at = np.array((start[0] + start[3] * t, start[1] + start[4] * t - 0.5 * g * t * t))
    v = np.array((start[3], start[4] - g * t, start[5]))
    normal = np.array((float(impact["normal_x"]), float(impact["normal_y"])))
    assert normal == pytest.approx([0.0, 1.0], abs=1e-15)
    point = np.array((float(impact["x"]), float(impact["y"])))
    assert point[1] == pytest.approx(0.0, abs=1e-9)
    along = rows(normal, [point, point - at])[:, 3:]
    inverse = inverse_masses(world, body)
    a = (along * inverse) @ along.T
    speeds = along @ v
    assert -speeds[0] == pytest.approx(float(impact["approach_speed"]), rel=1e-9)
    impulse = np.array((float(impact["normal_impulse"]), float(impact["tangent_impulse"])))
    # The state after the step is the state after the impact, flown on.
    left = world.time - t
    after = v + inverse * (impulse @ along)
    assert motion(world, body) == pytest.approx(after - (0.0, g * left, 0.0), abs=1e-9)
    expected = at + left * after[:2] - (0.0, 0.5 * g * left * left)
    assert place(world, body)[:2] == pytest.approx(expected, abs=1e-9)
    found = measure_energy(world)
    assert found.total <= before.total + 1e-12 * max(abs(before.total), before.kinetic)
    speeds_after = speeds + a @ impulse
    ratio = 1.0 + energy_gained(a, speeds, impulse) / (0.5 * float(v**2 @ (1 / inverse)))
    return -speeds_after[0] / speeds[0], ratio, impulse[1] / impulse[0], speeds_after[1], a, speeds


@pytest.mark.parametrize("e", [0.5, 0.8, 1.0])
@pytest.mark.parametrize("mu", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("degrees", [10, 20, 30, 45])
def test_a_cube_leaves_its_corner_with_the_restitution_asked_for(degrees: float, e: float, mu: float) -> None:
    world, angle = laboratory(), math.radians(degrees)
    floor = box(world, (0, -0.5), width=20, height=1, static=True, restitution=e, friction=mu)
    y = 1.0 + 0.5 * (math.sin(angle) + math.cos(angle))
    cube = box(world, (0, y), width=1, height=1, angle=angle, restitution=e, friction=mu)
    start = np.array((0.0, y, angle, 0.0, 0.0, 0.0))
    check_reached(reached(world, cube, floor, start, G), e, mu)


@pytest.mark.parametrize(("e", "mu"), [(1.0, 0.0), (1.0, 0.3), (1.0, 1.0), (0.5, 0.3), (0.8, 1.0)])
@pytest.mark.parametrize("degrees", [20, 45, 60])
@pytest.mark.parametrize("velocity", [(0.0, -1.0), (0.8, -1.0), (-2.0, -1.0)])
def test_a_rod_leaves_its_end_with_the_restitution_asked_for(
    degrees: float, e: float, mu: float, velocity: tuple[float, float]
) -> None:
    world, angle = laboratory(gravity_mode="none"), math.radians(degrees)
    floor = box(world, (0, -0.5), width=20, height=1, static=True, restitution=e, friction=mu)
    y = 0.1 + 0.5 * (2 * math.sin(angle) + 0.02 * math.cos(angle))
    rod = box(world, (0, y), width=2, height=0.02, angle=angle, velocity=velocity, restitution=e, friction=mu)
    start = np.array((0.0, y, angle, *velocity, 0.0))
    check_reached(reached(world, rod, floor, start, 0.0), e, mu)


def check_reached(found: tuple[Any, ...], e: float, mu: float) -> None:
    """Compare with Newton's law, or with Stronge's where Newton's would make energy."""
    e_found, energy, edge, along, a, speeds = found
    assert abs(edge) <= mu * (1.0 + 1e-12)
    assert energy <= 1.0 + 1e-12
    asked = newton(a, speeds, e, mu)
    if energy_gained(a, speeds, asked) > 1e-14 * float(np.abs(asked) @ np.abs(speeds)):
        impulse = stronge(a, speeds, e, mu)
        assert e_found == pytest.approx(-(speeds + a @ impulse)[0] / speeds[0], abs=1e-9)
        assert edge == pytest.approx(impulse[1] / impulse[0], abs=1e-9)
        return
    assert e_found == pytest.approx(e, abs=1e-9)
    assert edge == pytest.approx(asked[1] / asked[0], abs=1e-9)
    # It sticks, or friction is at its limit and against the sliding.
    assert abs(along) < 1e-9 or abs(edge) == pytest.approx(mu, abs=1e-9)
    assert abs(along) < 1e-9 or along * edge <= 1e-12


@pytest.mark.parametrize("degrees", [10, 20, 30])
def test_a_cube_that_tumbles_on_gains_no_energy(degrees: float) -> None:
    world, angle = laboratory(), math.radians(degrees)
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=0.8, friction=0.5)
    cube = box(world, (0, 1.6), width=1, height=1, angle=angle, restitution=0.8, friction=0.5)
    energy = measure_energy(world).total
    for _ in range(300):
        world.step()
        after = measure_energy(world).total
        assert after <= energy + 1e-12 * energy
        energy = after
    check_rigid(world)
    assert place(world, cube)[1] == pytest.approx(0.5, abs=1e-9)
    assert not motion(world, cube).any()
    impacts = world.contacts.impacts
    assert (abs(impacts["tangent_impulse"]) <= 0.5 * impacts["normal_impulse"] * (1 + 1e-12)).all()


# ---- any two bodies in free space --------------------------------------------------------------------------


def aimed(random: np.random.Generator, number: int) -> tuple[World, list[int], float, float]:
    """Return two bodies that fly at each other: of all pairs of shapes, with spin; e and mu."""
    e = float(random.choice((0.0, 0.3, 0.8, 1.0, random.random())))
    mu = float(random.choice((0.0, 0.1, 0.5, 1.0, 1.5 * random.random())))
    world, bodies = laboratory(gravity_mode="none"), []
    heading = random.uniform(0, math.tau)
    towards = np.array((math.cos(heading), math.sin(heading)))
    for k, sign in enumerate((-1.0, 1.0)):
        offset = 0.5 * random.uniform(-1, 1) * np.array((-towards[1], towards[0]))
        start = sign * 0.9 * towards + offset
        velocity = -sign * random.uniform(0.5, 3.0) * towards + random.normal(0, 0.2, 2)
        options: Any = {
            "mass": float(10 ** random.uniform(-1, 1)), "velocity": (velocity[0], velocity[1]),
            "angular_velocity": float(random.normal(0, 4)), "angle": float(random.uniform(-3, 3)),
            "restitution": e, "friction": mu,
        }  # fmt: skip
        if (number >> k) & 1:
            bodies.append(circle(world, (start[0], start[1]), radius=random.uniform(0.2, 0.5), **options))
        else:
            width, height = random.uniform(0.3, 0.9, 2)
            bodies.append(box(world, (start[0], start[1]), width=width, height=height, **options))
    return world, bodies, e, mu


@pytest.mark.parametrize(
    "seed",
    [20260723, *(pytest.param(seed, marks=(pytest.mark.slow, pytest.mark.seeds)) for seed in range(4))],
)
def test_random_impacts_keep_all_laws(seed: int) -> None:
    """4,000 of all pairs of shapes, in four parts; 100 for every run of the tests."""
    random = np.random.default_rng(seed)
    by_energy = compared = 0
    count = 100 if seed == 20260723 else 1000
    for number in range(count):
        world, bodies, e, mu = aimed(random, number)
        world.synchronise()
        v = np.concatenate([motion(world, body) for body in bodies])
        q = np.concatenate([place(world, body) for body in bodies])
        momentum, energy = measure_momentum(world), measure_energy(world).kinetic
        for _ in range(90):
            world.step()
            if world.contacts.logged:
                break
        check_rigid(world)
        after = measure_momentum(world)
        inverse = np.concatenate([inverse_masses(world, body) for body in bodies])
        scale = float(np.abs(v[[0, 1, 3, 4]] / inverse[[0, 1, 3, 4]]).sum())
        turning = scale + float(np.abs(v[[2, 5]] / inverse[[2, 5]]).sum())
        assert after.linear.x == pytest.approx(momentum.linear.x, abs=1e-12 * scale)
        assert after.linear.y == pytest.approx(momentum.linear.y, abs=1e-12 * scale)
        assert after.angular == pytest.approx(momentum.angular, abs=1e-12 * turning), number
        assert measure_energy(world).kinetic <= energy * (1 + 1e-12), number
        if world.contacts.logged != 1:  # they have missed each other, or met twice within a step
            continue
        compared += 1
        impact = world.contacts.impacts[0]
        order = [bodies.index(int(impact[name])) for name in ("entity_a", "entity_b")]
        pick = np.concatenate([np.arange(3 * k, 3 * k + 3) for k in order])
        v, q, inverse, t = v[pick], q[pick], inverse[pick], float(impact["time"])
        normal = np.array((float(impact["normal_x"]), float(impact["normal_y"])))
        point = np.array((float(impact["x"]), float(impact["y"])))
        arms = [point - q[k : k + 2] - t * v[k : k + 2] for k in (0, 3)]
        along = rows(normal, arms)
        a, speeds = (along * inverse) @ along.T, along @ v
        impulse = np.array((float(impact["normal_impulse"]), float(impact["tangent_impulse"])))
        expected = v + inverse * (impulse @ along)
        found = np.concatenate([motion(world, bodies[k]) for k in order])
        if e > 0.0:  # else they may go on touching
            assert found == pytest.approx(expected, abs=1e-9), number
        leaving = (along @ expected)[0]
        assert impulse[0] > 0.0 and abs(impulse[1]) <= mu * impulse[0] * (1 + 1e-12), number
        assert float(impact["approach_speed"]) == pytest.approx(-speeds[0], rel=1e-9), number
        asked = newton(a, speeds, e, mu)
        if energy_gained(a, speeds, asked) <= 1e-12 * energy:
            assert impulse == pytest.approx(asked, rel=1e-9, abs=1e-9 * asked[0]), number
            assert leaving == pytest.approx(-e * speeds[0], abs=1e-9 * abs(speeds[0])), number
        else:
            by_energy += 1
            asked = stronge(a, speeds, e, mu)
            assert impulse == pytest.approx(asked, rel=1e-9, abs=1e-9 * asked[0]), number
    assert compared > 0.7 * count
    assert by_energy > 0.003 * count


def test_the_impact_of_two_free_boxes_keeps_angular_momentum() -> None:
    world = laboratory(gravity_mode="none")
    box(
        world, (-1, 0), width=0.8, height=0.6, angle=0.987, velocity=(3, 0), angular_velocity=-8.75,
        restitution=1, friction=0,
    )  # fmt: skip
    box(
        world, (0.6, -0.147), width=0.5, height=0.9, angle=2.25, mass=2, angular_velocity=6.51,
        restitution=1, friction=0,
    )  # fmt: skip
    before, energy = measure_momentum(world), measure_energy(world).kinetic
    world.run(seconds=0.3)  # they turn, and graze each other once more at 0.344 s
    check_rigid(world)
    assert world.contacts.logged == 1
    after = measure_momentum(world)
    assert after.angular == pytest.approx(before.angular, abs=1e-12)
    assert (after.linear - before.linear).magnitude < 1e-12
    assert measure_energy(world).kinetic == pytest.approx(energy, rel=1e-12)


# ---- slow ones, and several at a time ----------------------------------------------------------------------


@pytest.mark.parametrize("speed", [0.01, 0.02, 0.04, 0.08])
@pytest.mark.parametrize("falling", [False, True])
def test_slow_discs_exchange_their_speeds(speed: float, falling: bool) -> None:
    world = laboratory()
    if not falling:
        box(world, (0, -0.5), width=60, height=1, static=True, restitution=1, friction=0)
    gap = 0.01
    one, other = (
        circle(world, (x, 0.5), radius=0.5, velocity=(v, 0), restitution=1, friction=0)
        for x, v in ((-1 - gap, speed), (0, 0))
    )
    world.run(seconds=2.0)
    check_rigid(world)
    drop = 2.0 * G if falling else 0.0
    assert motion(world, one) == pytest.approx([0.0, -drop, 0.0], abs=1e-9)
    assert motion(world, other) == pytest.approx([speed, -drop, 0.0], abs=1e-9)
    assert place(world, one)[0] == pytest.approx(-1.0, abs=1e-9)
    assert place(world, other)[0] == pytest.approx(speed * 2.0 - gap, abs=1e-9)
    between = world.contacts.impacts[world.contacts.impacts["approach_speed"] < 0.1]
    assert len(between) == 1
    assert between["time"][0] == pytest.approx(gap / speed, abs=1e-9)


def test_a_row_of_discs_passes_a_blow_on() -> None:
    for gap in (0.0, 1e-3):
        world = laboratory(gravity_mode="none")
        row = [
            circle(world, (i * (1 + gap), 0), radius=0.5, restitution=1, friction=0, velocity=(v, 0))
            for i, v in enumerate((1.0, 1.0, 0.0, 0.0, 0.0))
        ]
        world.run(seconds=0.5)
        check_rigid(world)
        assert [motion(world, disc)[0] for disc in row] == pytest.approx([0, 0, 0, 1, 1], abs=1e-9)


@pytest.mark.parametrize("e", [0.3, 0.5, 0.9])
def test_a_disc_bounces_to_rest_and_rests(e: float) -> None:
    world = laboratory()
    box(world, (0, -0.5), width=60, height=1, static=True, restitution=e, friction=0)
    ball = circle(world, (0, 1.25), radius=0.25, restitution=e, friction=0)
    fall = math.sqrt(2.0 / G)
    ends = fall * (1 + e) / (1 - e)
    world.run(seconds=fall)
    world.run(seconds=0.5 * e * fall)
    flown = 0.5 * e * fall
    assert place(world, ball)[1] == pytest.approx(0.25 + e * G * fall * flown - 0.5 * G * flown**2, abs=1e-9)
    world.run(seconds=ends + 0.1 - world.time)
    check_rigid(world)
    assert place(world, ball)[1] == pytest.approx(0.25, abs=1e-9)
    assert not motion(world, ball).any()


def test_a_box_that_falls_flat_bounces_flat() -> None:
    world = laboratory()
    box(world, (0, -0.5), width=60, height=1, static=True, restitution=0.5, friction=0.5)
    crate = box(world, (0, 1.5), width=1, height=1, restitution=0.5)
    fall = math.sqrt(2.0 / G)
    world.run(seconds=fall + 0.1)
    check_rigid(world)
    assert place(world, crate) == pytest.approx(
        [0.0, 0.5 + 0.5 * G * fall * 0.1 - 0.5 * G * 0.01, 0.0], abs=1e-9
    )
    impact = world.contacts.impacts[0]
    assert impact["normal_impulse"] == pytest.approx(1.5 * G * fall, rel=1e-9)
    assert abs(impact["tangent_impulse"]) < 1e-9


def test_a_disc_that_rolls_against_a_wall_leaves_it_as_the_impact_alone_would() -> None:
    """The floor holds it from below; friction of the wall, at its limit or sticking, lifts it."""
    e, mu, r, speed = 0.5, 0.3, 0.25, 1.0
    world = laboratory()
    box(world, (0, -0.5), width=60, height=1, static=True, restitution=0, friction=mu)
    box(world, (2.5, 2), width=1, height=4, static=True, restitution=e, friction=mu)
    disc = circle(
        world, (1, r), radius=r, velocity=(speed, 0), angular_velocity=-speed / r, restitution=e, friction=mu
    )
    meets = (2.0 - r - 1.0) / speed
    world.run(seconds=meets + 0.02)
    check_rigid(world)
    blow = (1 + e) * speed
    lift = min(mu * blow, speed / 3.0)  # friction stops the spin at a third of the speed, or is at its limit
    after = world.time - meets
    assert motion(world, disc)[:2] == pytest.approx([-e * speed, lift - G * after], abs=1e-9)
    assert motion(world, disc)[2] == pytest.approx(-speed / r + 2.0 * lift / r, abs=1e-9)


@pytest.mark.parametrize(("mu", "told"), [(0.3, True), (0.0, False)])
def test_an_impact_that_goes_by_energy_is_told(mu: float, told: bool) -> None:
    """A rod that slides on its end would gain energy by Newton's law."""
    world, angle = laboratory(gravity_mode="none"), math.radians(45)
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=1.0, friction=mu)
    y = 0.1 + 0.5 * (2 * math.sin(angle) + 0.02 * math.cos(angle))
    box(world, (0, y), width=2, height=0.02, angle=angle, velocity=(0.8, -1), restitution=1.0, friction=mu)
    world.run(seconds=0.3)
    found = [warning.value for warning in find_warnings(world) if "Stronge's law" in warning.what]
    assert world.collisions and found == ([1.0] if told else [])
