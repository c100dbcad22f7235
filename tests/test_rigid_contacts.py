"""Rigid contacts at rest, sliding, rolling and turning over: closed forms, or an integrator of its own."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from physicslab import World, cli, load_scene
from physicslab.components import Spring, Transform, Velocity
from physicslab.contacts.report import list_contacts
from physicslab.diagnostics.energy import measure_energy
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.scene import save_scene
from physicslab.prefabs import box, circle
from physicslab.stepping.rigid import Rigid
from physicslab.systems.standard import standard_systems

G = 9.81


def laboratory(simulation: dict[str, Any] | None = None, **physics: Any) -> World:
    """Return an empty world with rigid contacts; gravity is 9.81 m/s^2 where not given."""
    config = SimulationConfig(contacts="rigid", **(simulation or {}))
    return World(*standard_systems(), physics=PhysicsConfig(**physics), simulation=config)


def floored(e: float = 0.0, mu: float = 0.5, **options: Any) -> World:
    """Return a world with a floor whose top is at 0."""
    world = laboratory(**options)
    box(world, (0, -0.5), width=100, height=1, static=True, restitution=e, friction=mu, name="floor")
    return world


def rigid_of(world: World) -> Rigid:
    """Return the stepper of rigid contacts."""
    return next(stepper for stepper in world.steppers.usable if isinstance(stepper, Rigid))


def run(world: World, seconds: float) -> None:
    """Advance, and check that no step was left to soft contacts."""
    world.run(seconds=seconds)
    assert rigid_of(world).left_to_soft == 0, rigid_of(world).why_soft
    assert world.stepper is not None and world.stepper.name == "rigid"


def place(world: World, entity: int) -> NDArray[np.float64]:
    """Return x, y and angle."""
    found = world.component(entity, Transform)
    return np.array((found.position.x, found.position.y, found.angle))


def motion(world: World, entity: int) -> NDArray[np.float64]:
    """Return both speeds and the angular velocity."""
    found = world.component(entity, Velocity)
    return np.array((found.linear.x, found.linear.y, found.angular))


def pressed_on(world: World, entity: int) -> NDArray[np.float64]:
    """Return the force of contacts on a body [N], as the report of contacts has it."""
    force = np.zeros(2)
    for contact in list_contacts(world):
        if entity in (contact.a, contact.b):
            sign = 1.0 if entity == contact.b else -1.0
            normal = np.array((contact.normal.x, contact.normal.y))
            for point in contact.points:
                across = point.tangent_impulse * np.array((-normal[1], normal[0]))
                force += sign * (point.normal_impulse * normal + across) / world.contacts.impulse_dt
    return force


# ---- at rest -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("count", "size", "seconds"),
    [
        (1, 1.0, 2.0), (10, 1.0, 2.0), (20, 1.0, 2.0), (10, 0.1, 10.0), (10, 0.05, 10.0), (10, 0.02, 10.0),
        (5, 0.01, 10.0),
    ],
)  # fmt: skip
def test_a_stack_stands_where_it_was_put(count: int, size: float, seconds: float) -> None:
    world = floored(mu=0.6)
    cubes = [
        box(world, (0, size * (i + 0.5)), width=size, height=size, friction=0.6, mass=1.0 + 0.1 * i)
        for i in range(count)
    ]
    run(world, seconds)
    for i, cube in enumerate(cubes):
        assert place(world, cube) == pytest.approx([0.0, size * (i + 0.5), 0.0], abs=1e-9)
        assert not motion(world, cube).any()
    weights = G * np.array([1.0 + 0.1 * i for i in range(count)])
    assert -pressed_on(world, world.entity("floor"))[1] == pytest.approx(weights.sum(), rel=1e-9)
    for cube, weight in zip(cubes, weights, strict=True):
        assert pressed_on(world, cube) == pytest.approx([0.0, weight], abs=1e-9 * weights.sum())


def test_finer_steps_stand_as_well() -> None:
    for dt in (1 / 30, 1 / 240, 1 / 960):
        world = floored(mu=0.6, simulation={"dt": dt})
        cubes = [box(world, (0, i + 0.5), width=1, height=1, friction=0.6) for i in range(10)]
        run(world, 0.5)
        assert place(world, cubes[-1]) == pytest.approx([0.0, 9.5, 0.0], abs=1e-9)


def test_a_stack_that_is_not_in_line_stands() -> None:
    world = floored(mu=0.6)
    shifts = (0.0, 0.1, -0.15, 0.05)
    cubes = [box(world, (x, i + 0.5), width=1, height=1, friction=0.6) for i, x in enumerate(shifts)]
    run(world, 2.0)
    for i, (cube, x) in enumerate(zip(cubes, shifts, strict=True)):
        assert place(world, cube) == pytest.approx([x, i + 0.5, 0.0], abs=1e-9)


@pytest.mark.parametrize(("left", "right"), [(45, 45), (30, 60), (5, 85)])
def test_forces_in_a_groove_are_those_of_statics(left: float, right: float) -> None:
    world, disc = groove(left, right, 0.0)
    run(world, 1.0)
    assert place(world, disc) == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    a, b = math.radians(left), math.radians(right)
    expected = G * np.array((math.sin(b), math.sin(a))) / math.sin(a + b)
    dt = world.contacts.impulse_dt
    found = [contact.points[0].normal_impulse / dt for contact in list_contacts(world)]
    assert found == pytest.approx(expected, rel=1e-9)


# ---- sliding and rolling -----------------------------------------------------------------------------------


def inclined(degrees: float, mu: float) -> tuple[World, int, NDArray[np.float64], NDArray[np.float64]]:
    """Return a block on an incline that falls to the right: world, block, where it is, which way is down."""
    world, angle = laboratory(), math.radians(degrees)
    along, normal = (
        np.array((math.cos(angle), -math.sin(angle))),
        np.array((math.sin(angle), math.cos(angle))),
    )
    box(world, (0, 0), width=40, height=1, angle=-angle, static=True, friction=mu)
    start = 0.75 * normal
    block = box(world, (start[0], start[1]), width=0.5, height=0.5, angle=-angle, friction=mu)
    return world, block, start, along


@pytest.mark.parametrize("mu", [0.0, 0.1, 0.4, 0.57])
def test_a_block_slides_down_an_incline(mu: float) -> None:
    world, block, start, along = inclined(30, mu)
    angle = math.radians(30)
    rate = G * (math.sin(angle) - mu * math.cos(angle))
    run(world, 1.0)
    assert place(world, block) == pytest.approx([*(start + 0.5 * rate * along), -angle], abs=1e-9)
    assert motion(world, block) == pytest.approx([*(rate * along), 0.0], abs=1e-9)


@pytest.mark.parametrize("mu", [0.58, 0.6, 0.9])
def test_a_block_that_friction_holds_does_not_creep(mu: float) -> None:
    world, block, start, _ = inclined(30, mu)
    run(world, 0.1)
    held = place(world, block)
    assert held[:2] == pytest.approx(start, abs=1e-14)
    run(world, 1.0)
    assert np.array_equal(place(world, block), held)
    assert not motion(world, block).any()
    assert pressed_on(world, block) == pytest.approx([0.0, G], abs=1e-9)


@pytest.mark.parametrize(("size", "mu", "speed"), [(0.5, 0.3, 3.0), (0.5, 0.6, 3.0), (1.0, 0.3, -2.0)])
def test_a_block_slides_to_a_stop(size: float, mu: float, speed: float) -> None:
    world = floored(mu=mu)
    block = box(world, (0, size / 2), width=size, height=size, friction=mu, velocity=(speed, 0))
    run(world, 0.3)
    way = speed * 0.3 - 0.5 * math.copysign(mu * G, speed) * 0.09
    assert place(world, block) == pytest.approx([way, size / 2, 0.0], abs=1e-9)
    run(world, 1.7)
    assert place(world, block) == pytest.approx([speed * abs(speed) / (2 * mu * G), size / 2, 0.0], abs=1e-9)
    assert not motion(world, block).any()


@pytest.mark.parametrize(
    ("speed", "spin", "mu"), [(3.0, 0.0, 0.3), (0.0, 20.0, 0.2), (2.0, 30.0, 0.5), (-4.0, 3.0, 0.7)]
)
def test_a_disc_slides_and_then_rolls(speed: float, spin: float, mu: float) -> None:
    r = 0.25
    world = floored(mu=mu)
    disc = circle(world, (0, r), radius=r, friction=mu, velocity=(speed, 0), angular_velocity=spin)
    slip = speed + r * spin
    push = -math.copysign(mu * G, slip)
    rolls_at = abs(slip) / (3 * mu * G)
    for t in (0.5 * rolls_at, 2.0):
        run(world, t - world.time)
        sliding = min(t, rolls_at)
        v, turning = speed + push * sliding, spin + 2 * push * sliding / r
        x = speed * sliding + 0.5 * push * sliding**2 + v * (t - sliding)
        angle = spin * sliding + push * sliding**2 / r + turning * (t - sliding)
        assert place(world, disc) == pytest.approx([x, r, angle], abs=1e-9)
        assert motion(world, disc) == pytest.approx([v, 0.0, turning], abs=1e-9)


@pytest.mark.parametrize(
    ("mu", "rolls"), [(0.0, False), (0.1, False), (0.19, False), (0.2, True), (1.0, True)]
)
def test_a_disc_goes_down_an_incline(mu: float, rolls: bool) -> None:
    world, angle, r = laboratory(), math.radians(30), 0.25
    along, normal = (
        np.array((math.cos(angle), -math.sin(angle))),
        np.array((math.sin(angle), math.cos(angle))),
    )
    box(world, (0, 0), width=40, height=1, angle=-angle, static=True, friction=mu)
    start = (0.5 + r) * normal
    disc = circle(world, (start[0], start[1]), radius=r, friction=mu)
    run(world, 1.0)
    rate = G * (math.sin(angle) / 1.5 if rolls else math.sin(angle) - mu * math.cos(angle))
    turning = -rate / r if rolls else -2 * mu * G * math.cos(angle) / r
    assert place(world, disc) == pytest.approx([*(start + 0.5 * rate * along), 0.5 * turning], abs=1e-9)


@pytest.mark.parametrize("mu", [0.2, 0.4])
@pytest.mark.parametrize("height", [0.1, 0.4])
def test_a_block_on_a_plate_begins_to_slide_when_friction_cannot_carry_it(mu: float, height: float) -> None:
    """A spring slows the plate more and more, which has a smooth floor; both corners let go at one time."""
    world, speed, stiffness, plate_mass = floored(mu=0.0), 2.0, 30.0, 4.0
    plate = box(world, (0, 0.1), width=3, height=0.2, mass=plate_mass, velocity=(speed, 0), friction=mu)
    block = box(world, (0, 0.2 + height / 2), width=0.4, height=height, velocity=(speed, 0), friction=mu)
    world.spawn(Spring(plate, anchor_b=(-4, 0.1), rest_length=4.0, stiffness=stiffness))
    together = math.sqrt(stiffness / (plate_mass + 1.0))
    lets_go = math.asin(mu * G / (together * speed)) / together
    run(world, 0.7 * lets_go)
    x = speed / together * math.sin(together * world.time)
    assert place(world, plate)[0] == pytest.approx(x, abs=1e-9)
    assert place(world, block)[0] == pytest.approx(x, abs=1e-9)
    seconds = lets_go + 0.15
    run(world, seconds - world.time)
    x, v = speed / together * math.sin(together * lets_go), speed * math.cos(together * lets_go)
    assert place(world, block) == pytest.approx(
        [x + v * 0.15 - 0.5 * mu * G * 0.15**2, 0.2 + height / 2, 0.0], abs=1e-9
    )
    alone, middle = math.sqrt(stiffness / plate_mass), mu * G / stiffness
    expected = middle + (x - middle) * math.cos(alone * 0.15) + v / alone * math.sin(alone * 0.15)
    assert place(world, plate) == pytest.approx([expected, 0.1, 0.0], abs=1e-9)


@pytest.mark.parametrize(("offset", "mu"), [(0.05, 0.1), (0.2, 0.1), (0.2, 0.2), (0.2, 0.3), (0.2, 0.5)])
def test_a_box_on_a_seesaw_holds_and_then_slides(offset: float, mu: float) -> None:
    """Both corners reach the limit of friction in one moment; until then no energy is lost."""
    world = laboratory()
    circle(world, (0, -0.5), radius=0.5, static=True, friction=mu)
    plank = box(world, (0, 0.05), width=2, height=0.1, mass=2, friction=mu)
    load = box(world, (offset, 0.25), width=0.3, height=0.3, friction=mu)
    energy = measure_energy(world).total
    start = energy
    for _ in range(50):
        run(world, 1 / 60)
        after = measure_energy(world).total
        assert after <= energy + 1e-10
        energy = after
        lean = place(world, plank)[2]
        if abs(math.tan(lean)) < 0.3 * mu:
            assert energy == pytest.approx(start, abs=1e-9)
        assert place(world, load)[2] == pytest.approx(lean, abs=1e-9)


def groove(left: float, right: float, mu: float, spin: float = 0.0) -> tuple[World, int]:
    """Return a disc at the origin that two planes hold, inclined by as many degrees."""
    world, r = laboratory(), 0.25
    for degrees in (-left, right):
        a = math.radians(degrees)
        box(
            world, (-(r + 0.5) * -math.sin(a), -(r + 0.5) * math.cos(a)), width=4, height=1,
            angle=a, static=True, friction=mu,
        )  # fmt: skip
    return world, circle(world, (0, 0), radius=r, friction=mu, angular_velocity=spin)


@pytest.mark.parametrize(
    ("left", "right", "mu", "spin"),
    [(45, 45, 0.5, 20.0), (45, 45, 0.1, -20.0), (30, 60, 0.3, 15.0), (60, 30, 0.2, 10.0)],
)
def test_a_disc_spins_down_in_a_groove(left: float, right: float, mu: float, spin: float) -> None:
    world, disc = groove(left, right, mu, spin)
    turn = math.copysign(1.0, spin)
    a, b = math.radians(left), math.radians(right)
    directions = []
    for nx, ny in ((math.sin(a), math.cos(a)), (-math.sin(b), math.cos(b))):
        directions.append((nx - turn * mu * ny, ny + turn * mu * nx))
    forces = np.linalg.solve(np.array(directions).T, np.array((0.0, G)))
    assert (forces > 0.0).all()
    slowing = 2.0 * mu * forces.sum() / 0.25
    run(world, 0.5 * abs(spin) / slowing)
    assert motion(world, disc)[2] == pytest.approx(0.5 * spin, abs=1e-8)
    run(world, 2.0)
    assert place(world, disc) == pytest.approx([0.0, 0.0, spin * abs(spin) / (2.0 * slowing)], abs=1e-8)


# ---- turning over, and round things ------------------------------------------------------------------------


def integrate(
    rate: Callable[[NDArray[np.float64]], NDArray[np.float64]], y: NDArray[np.float64], t: float, steps: int
) -> NDArray[np.float64]:
    """Return y(t) of y' = rate(y), by Runge and Kutta's method of order four."""
    h = t / steps
    for _ in range(steps):
        k1 = rate(y)
        k2 = rate(y + 0.5 * h * k1)
        k3 = rate(y + 0.5 * h * k2)
        k4 = rate(y + h * k3)
        y = y + h / 6.0 * (k1 + 2 * k2 + 2 * k3 + k4)
    return y


@pytest.mark.parametrize(("width", "height"), [(1.0, 1.0), (0.5, 1.5)])
@pytest.mark.parametrize("lean", [-0.1, 0.05, 0.3])
def test_a_box_pivots_about_its_corner(width: float, height: float, lean: float) -> None:
    world = floored(mu=2.0)
    arm, inner = 0.5 * math.hypot(width, height), math.atan(width / height)
    start = np.array((arm * math.sin(lean), arm * math.cos(lean)))
    crate = box(world, (start[0], start[1]), width=width, height=height, angle=-(inner + lean), friction=2.0)
    run(world, 0.4)
    stiffness = G * arm / ((width**2 + height**2) / 3.0)
    lean, speed = integrate(
        lambda y: np.array((y[1], stiffness * math.sin(y[0]))), np.array((lean, 0.0)), 0.4, 4000
    )
    assert place(world, crate) == pytest.approx(
        [arm * math.sin(lean), arm * math.cos(lean), -(inner + lean)], abs=1e-8
    )
    assert motion(world, crate)[2] == pytest.approx(-speed, abs=1e-8)


@pytest.mark.parametrize(("width", "height"), [(1.0, 2.0), (1.0, 1.0), (0.5, 3.0)])
def test_a_box_topples_on_an_incline_just_beyond_its_angle(width: float, height: float) -> None:
    for beyond in (-1e-6, 1e-6):
        world, angle = laboratory(), math.atan(width / height) + beyond
        normal = np.array((math.sin(angle), math.cos(angle)))
        box(world, (0, 0), width=40, height=1, angle=-angle, static=True, friction=9.0)
        start = (0.5 + height / 2) * normal
        crate = box(world, (start[0], start[1]), width=width, height=height, angle=-angle, friction=9.0)
        run(world, 0.5)
        if beyond < 0.0:
            assert not motion(world, crate).any()
        else:
            assert motion(world, crate)[2] < -1e-7


def test_a_smooth_slide_round_a_planet_keeps_its_speed() -> None:
    world = laboratory(gravity_mode="planet")
    planet = circle(world, (0, 0), radius=5, mass=1000, friction=0)
    speed = 0.5 * math.sqrt(1000 / 5.5)
    disc = circle(world, (0, 5.5), radius=0.5, mass=1e-3, friction=0, velocity=(-speed, 0))
    for _ in range(10):
        run(world, 0.5)
        relative = motion(world, disc) - motion(world, planet)  # the planet gives way a little
        away = place(world, disc) - place(world, planet)
        assert np.hypot(*relative[:2]) == pytest.approx(speed, abs=1e-8)
        assert np.hypot(*away[:2]) == pytest.approx(5.5, abs=1e-9)
        turned = math.atan2(-away[0], away[1])
        assert turned == pytest.approx(math.remainder(speed / 5.5 * world.time, math.tau), abs=1e-8)


def test_a_disc_rolls_over_a_hill() -> None:
    """It leaves where it has to: rolling without slipping, cos a = 4 / 7 from rest at the top."""
    world, big, r = laboratory(), 3.0, 0.5
    circle(world, (0, 0), radius=big, static=True, friction=100.0)
    lean = 0.1
    disc = circle(world, ((big + r) * math.sin(lean), (big + r) * math.cos(lean)), radius=r, friction=100.0)
    stiffness = G / (1.5 * (big + r))
    seconds = 1.5
    run(world, seconds)
    lean, speed = integrate(
        lambda y: np.array((y[1], stiffness * math.sin(y[0]))), np.array((lean, 0.0)), seconds, 4000
    )
    assert math.cos(lean) > 4.0 / 7.0
    assert place(world, disc)[:2] == pytest.approx(
        [(big + r) * math.sin(lean), (big + r) * math.cos(lean)], abs=1e-8
    )
    assert motion(world, disc)[2] == pytest.approx(-speed * (big + r) / r, abs=1e-8)


# ---- seams, mirror images ----------------------------------------------------------------------------------


def tiled(mu: float, tiles: bool) -> World:
    """Return a world with a floor of tiles of 1 m, or of one piece."""
    world = laboratory()
    if tiles:
        for i in range(20):
            box(world, (i - 3.5, -0.5), width=1, height=1, static=True, friction=mu)
    else:
        box(world, (6, -0.5), width=20, height=1, static=True, friction=mu)
    return world


@pytest.mark.parametrize(
    ("width", "height", "mu", "speed", "seconds"),
    [(1.0, 0.1, 0.3, 5.0, 2.5), (0.5, 0.05, 0.0, 5.0, 1.0), (0.3, 0.3, 0.3, 4.0, 2.0)],
)
def test_seams_of_tiles_are_not_felt(
    width: float, height: float, mu: float, speed: float, seconds: float
) -> None:
    found = []
    for tiles in (True, False):
        world = tiled(mu, tiles)
        plank = box(world, (0, height / 2), width=width, height=height, friction=mu, velocity=(speed, 0))
        run(world, seconds)
        found.append(place(world, plank))
    way = speed**2 / (2 * mu * G) if mu else speed * seconds
    assert found[0] == pytest.approx([way, height / 2, 0.0], abs=1e-9)
    assert found[0] == pytest.approx(found[1], abs=1e-9)


@pytest.mark.parametrize(("mu", "spin"), [(0.0, 0.0), (0.5, -20.0)])
def test_a_disc_feels_no_seams(mu: float, spin: float) -> None:
    world = tiled(mu, True)
    disc = circle(world, (0, 0.25), radius=0.25, friction=mu, velocity=(5, 0), angular_velocity=spin)
    run(world, 1.5)
    assert place(world, disc) == pytest.approx([7.5, 0.25, 1.5 * spin], abs=1e-9)


def test_mirror_images_of_boxes_that_fall_stay_mirror_images() -> None:
    found = []
    for side in (1.0, -1.0):
        world = floored(e=0.5, mu=0.6)
        boxes = [
            box(
                world, (side * x, y), width=1, height=1, angle=side * angle, restitution=0.5, friction=0.6
            )
            for x, y, angle in ((0.1, 0.57, 0.02), (-0.1, 1.62, 0.04))
        ]  # fmt: skip
        run(world, 1.0)
        found.append([place(world, body) * (side, 1.0, side) for body in boxes])
    assert found[0][0] == pytest.approx(found[1][0], abs=1e-9)
    assert found[0][1] == pytest.approx(found[1][1], abs=1e-9)


def test_the_order_of_entities_does_not_matter() -> None:
    starts = [(0.1, 0.57, 0.02), (-0.1, 1.62, 0.04), (1.5, 0.8, 0.3)]
    found = []
    for order in ((0, 1, 2), (2, 1, 0), (1, 2, 0)):
        world = floored(e=0.3, mu=0.6)
        bodies = {}
        for i in order:
            x, y, angle = starts[i]
            bodies[i] = box(world, (x, y), width=1, height=1, angle=angle, restitution=0.3, friction=0.6)
        run(world, 1.0)
        found.append(np.array([place(world, bodies[i]) for i in range(3)]))
    assert found[0] == pytest.approx(found[1], abs=1e-9)
    assert found[0] == pytest.approx(found[2], abs=1e-9)


# ---- ways to go on -----------------------------------------------------------------------------------------


def tumbling() -> World:
    """Return a world with boxes and a disc that fall, slide and roll."""
    world = floored(e=0.4, mu=0.5)
    for i, (x, y, angle) in enumerate(((0.0, 0.9, 0.3), (0.2, 2.1, -0.1))):
        box(
            world, (x, y), width=1, height=0.8, angle=angle, velocity=(0.5, 0), restitution=0.4,
            name=f"box{i}",
        )  # fmt: skip
    circle(world, (1.6, 0.3), radius=0.3, velocity=(-1, 0), angular_velocity=3, restitution=0.4, name="disc")
    return world


def bits(world: World) -> list[bytes]:
    """Return all numbers of the motion."""
    return [
        np.concatenate((place(world, world.entity(name)), motion(world, world.entity(name)))).tobytes()
        for name in ("box0", "box1", "disc")
    ]


def test_a_run_steps_and_a_saved_scene_have_the_same_bits(tmp_path: Path) -> None:
    whole = tumbling()
    run(whole, 1.0)
    stepped = tumbling()
    for _ in range(60):
        stepped.step()
    assert bits(stepped) == bits(whole)
    first = tumbling()
    for _ in range(23):
        first.step()
    save_scene(first, tmp_path / "scene.json")
    second = load_scene(tmp_path / "scene.json")
    for _ in range(37):
        first.step()
        second.step()
    assert bits(first) == bits(whole)
    assert bits(second) == bits(whole)


def test_a_run_tells_why_contacts_are_not_rigid(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world = floored(simulation={"integrator": "leapfrog"})
    box(world, (0, 0.25))
    save_scene(world, tmp_path / "scene.json")
    assert cli.main(["run", str(tmp_path / "scene.json"), "--steps", "3", "--json", "-"]) == 0
    report = json.loads(capsys.readouterr().out)
    reasons = {left["name"]: left["reason"] for left in report["steppers_left_out"]}
    assert reasons["rigid"].startswith("rigid was asked for, and leapfrog")
    assert report["stepper"]["name"] != "rigid"


def test_a_step_that_rigid_contacts_cannot_make_is_left_to_soft_ones() -> None:
    world = floored()
    boxes = [box(world, (0, y), width=1, height=1) for y in (0.4, 1.3)]
    world.step()
    assert rigid_of(world).left_to_soft == 1
    told = find_warnings(world)
    assert [one.what for one in told if one.because] == ["steps were left to soft contacts"]
    assert 'simulation.contacts = "rigid"' not in {one.setting for one in told}, "they are"
    assert rigid_of(world).why_soft == "bodies overlap by 0.1 of their size"
    assert world.stepper is not None and world.stepper.name != "rigid"
    world.run(seconds=5.0)
    assert place(world, boxes[0])[1] == pytest.approx(0.5, abs=1e-3)
    assert place(world, boxes[1])[1] == pytest.approx(1.5, abs=2e-3)
