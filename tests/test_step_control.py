"""What chooses its steps is right within its tolerance, whatever is damped, and by every way to run it."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from physicslab import World, load_scene, save_scene
from physicslab.components import Drag, Mass, Material, Shape, Spring, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.fields import COORDINATE_LIMIT
from physicslab.kernels import motion
from physicslab.prefabs import box
from physicslab.state.masses import Diverged
from physicslab.systems.standard import standard_systems

ERRORS, GROWTH_WITH_DRAG = 5.0, 3000.0
"""How many errors of one tolerance, each grown as this motion lets it, add up at most; and by how much they
grow with drag: |v| v has a corner where a body turns back."""
FINEST = 1e-10
"""The tolerance below which what rounding leaves out grows as much."""


def motion_of(world: World) -> NDArray[np.float64]:
    """Return every place, angle, velocity and spin."""
    transform, velocity = world.table(Transform), world.table(Velocity)
    columns = transform["position"], transform["angle"], velocity["linear"], velocity["angular"]
    return np.concatenate([column.ravel() for column in columns])


def at_once(world: World, steps: int) -> None:
    world.run(steps=steps)


def in_parts(world: World, steps: int) -> None:
    for part in (steps // 2, steps // 3):
        world.run(steps=part)
    world.run(steps=steps - steps // 2 - steps // 3)


def with_strides(world: World, steps: int) -> None:
    for _ in world.stepping(steps=steps, stride=7):
        pass


def one_by_one(world: World, steps: int) -> None:
    for _ in range(steps):
        world.step()


WAYS = (at_once, in_parts, with_strides, one_by_one)


def damped_world(tolerance: float, damping: float, drag: float, stiffness: float) -> World:
    """Return a body of 1 kg and 1 m/s on a spring, that a field slows down."""
    world = World(
        *standard_systems(),
        physics=PhysicsConfig(linear_damping=damping, angular_damping=damping),
        simulation=SimulationConfig(dt=0.01, integrator="dop853", tolerance=tolerance),
    )
    parts = [Transform((0.3, 0.4)), Velocity((1.0, 0.0)), Mass(1.0), Shape("circle", radius=0.1)]
    spring = Spring(rest_length=0.2, stiffness=stiffness, anchor_b=(1.0, 1.0), anchor_a=(0.05, 0.0))
    world.spawn(*parts, Drag(quadratic=drag), spring, name="body")
    return world


def growth_of(damping: float, stiffness: float, end: NDArray[np.float64], size: NDArray[np.float64]) -> float:
    """Return by how much errors of one tolerance grow, of all places and velocities together.

    A spring that passes its anchor closely scatters. Velocities err by a share of the largest one.
    """
    shift, grown = 1e-7, 0.0
    for kind, name in (
        (Transform, "position"),
        (Transform, "angle"),
        (Velocity, "linear"),
        (Velocity, "angular"),
    ):
        for i in range(2 if name in ("position", "linear") else 1):
            world = damped_world(1e-13, damping, 0.0, stiffness)
            world.synchronise()
            world.table(kind)[name].reshape(-1)[-1 - i] += shift
            at_once(world, 20)
            scale = size.max() if kind is Velocity else 1.0
            grown += scale * float(np.max(np.abs(motion_of(world) - end) / size)) / shift
    return grown


@settings(max_examples=12, deadline=None)
@given(
    tolerance=st.floats(-17.0, -2.0).map(lambda power: 10.0**power),
    damping=st.one_of(st.just(0.0), st.floats(0.0, 3.5).map(lambda power: 10.0**power)),
    drag=st.sampled_from((0.0, 1.0, 1e3)),
    stiffness=st.sampled_from((0.0, 3.0, 1e3)),
)
@example(tolerance=0.01, damping=1000.0, drag=0.0, stiffness=3.0)
@example(tolerance=0.01, damping=3000.0, drag=1.0, stiffness=1000.0)
@example(tolerance=10**-4.28125, damping=195.44097700542906, drag=0.0, stiffness=0.0)
@example(tolerance=10**-6.96484375, damping=170.7740487911767, drag=1.0, stiffness=3.0)
@example(tolerance=10**-7.2, damping=0.0, drag=0.0, stiffness=1000.0)
def test_what_is_damped_is_right_at_every_tolerance(
    tolerance: float, damping: float, drag: float, stiffness: float
) -> None:
    exact = damped_world(1e-13, damping, drag, stiffness)
    exact.synchronise()
    # Places and angles to 1 m and 1 rad; velocities to the fastest on the way, at least 1 m/s.
    size = np.abs(motion_of(exact)).clip(1.0)
    for _ in exact.stepping(steps=20):
        size = np.maximum(size, np.abs(motion_of(exact)))
    size[: len(size) // 2] = 1.0
    growth = GROWTH_WITH_DRAG if drag else ERRORS * growth_of(damping, stiffness, motion_of(exact), size)
    limit = growth * max(tolerance, FINEST)
    for way in WAYS:
        world = damped_world(tolerance, damping, drag, stiffness)
        way(world, 20)
        off = np.abs(motion_of(world) - motion_of(exact)) / size
        assert off.max() <= max(limit, 1e-12), (way.__name__, off.max() / tolerance)


def test_a_tolerance_beyond_which_no_step_is_bounded_is_refused() -> None:
    with pytest.raises(ValueError, match=r"tolerance = 0.1: must be .*0.01"):
        SimulationConfig(tolerance=0.1)


def orbit(tolerance: float) -> World:
    """Return a small body at the far end of an orbit of eccentricity 0.5, and 100 s of it a run."""
    world = World(
        *standard_systems(),
        physics=PhysicsConfig(gravity_mode="planet", G=1.0),
        simulation=SimulationConfig(dt=1 / 60, integrator="dop853", tolerance=tolerance),
    )
    world.spawn(Transform(), Velocity(), Mass(1.0))
    world.spawn(Transform((-1.5, 0.0)), Velocity((0.0, -((1 / 3) ** 0.5))), Mass(1e-30))
    return world


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-8])
def test_an_orbit_keeps_its_shape_at_every_tolerance(tolerance: float) -> None:
    world = orbit(tolerance)
    for _ in range(5):
        world.run(seconds=20.3)
        sun, planet = (world.component(body, Transform).position for body in world.entities())
        reach = math.hypot(planet.x - sun.x, planet.y - sun.y)
        assert 0.5 - tolerance < reach < 1.5 + tolerance


def flyby() -> World:
    """Return a body that passes a mass at a distance of 5e-7 m and turns about, from 20 m away."""
    world = orbit(1e-17)
    world.remove(world.entities()[1])
    world.spawn(Transform((-20.0, 1e-3)), Velocity((1.0, 0.0)), Mass(1e-30), name="comet")
    return world


def test_a_sudden_passage_is_followed() -> None:
    world = flyby()
    world.run(seconds=20.0)
    # The hyperbola: worked out by mpmath with 40 digits.
    exact = -3.23257631463955, -0.007054640076945216
    place = world.component(world.entity("comet"), Transform).position
    assert max(abs(place.x - exact[0]), abs(place.y - exact[1])) < 1e-9


def touching(contacts: str, collisions: str) -> World:
    """Return discs and a box that fall, bounce and come to rest on a floor."""
    world = World(
        *standard_systems(), simulation=SimulationConfig(contacts=contacts, collisions=collisions, dt=0.02)
    )
    box(world, (0, -0.5), width=20, height=1, static=True)
    for k in range(3):
        world.spawn(
            Transform((0.9 * k, 0.6 + 0.3 * k)), Velocity((0.3 - k, -1.0), 2.0), Mass(1.0 + k),
            Shape("circle", radius=0.4),
        )  # fmt: skip
    return world


@pytest.mark.parametrize(
    ("contacts", "collisions"), [("soft", "step"), ("rigid", "step"), ("soft", "exact"), ("auto", "exact")]
)
def test_every_way_to_run_gives_the_same_bits(contacts: str, collisions: str) -> None:
    found = []
    for way in WAYS:
        world = touching(contacts, collisions)
        way(world, 60)
        found.append(motion_of(world).tobytes())
    assert len(set(found)) == 1


def test_a_saved_flight_goes_on_with_the_same_bits(tmp_path: Path) -> None:
    world = touching("soft", "exact")
    world.run(steps=5)
    save_scene(world, tmp_path / "flight.json")
    again = load_scene(tmp_path / "flight.json")
    for going in (world, again):
        going.run(steps=8)
    assert motion_of(again).tobytes() == motion_of(world).tobytes()


def test_rigid_steps_after_soft_ones_have_the_same_bits_by_every_way() -> None:
    """Deep overlaps are left to soft contacts: what these leave in records is not read by later ones."""
    found = []
    for way in WAYS:
        world = World(
            *standard_systems(),
            physics=PhysicsConfig(G=0.114, softening=0.844, angular_damping=100.0),
            simulation=SimulationConfig(substeps=8, contacts="rigid", collisions="exact", sleeping=True),
        )
        rough, smooth = Material(restitution=0.8, friction=0.6), Material(restitution=0.3, friction=0.6)
        crate, disc = Shape("box", width=0.844, height=0.844), Shape("circle", radius=0.824)
        thrown = Velocity((-8.35, 12.7)), Mass(0.225)
        e0 = world.spawn(Transform((-0.551, 0.868)), *thrown, crate, rough)
        held = Spring(rest_length=0, stiffness=2080000.0, anchor_a=(0.236, 0.415), anchor_b=(-0.0348, -0.122))
        slides = Velocity((-9.53, 0.5)), Mass(0.0879)
        world.spawn(Transform((-0.665, 0.0813)), *slides, disc, smooth, held)
        floor = Material(restitution=0.0, friction=10.0)
        world.spawn(Transform((0.0, -0.422)), Shape("box", width=59.7, height=0.844), floor)
        pulled = Spring(
            a=e0, rest_length=0, stiffness=6.95, anchor_a=(-0.35, 0.223), anchor_b=(0.447, -0.585)
        )
        world.spawn(pulled)
        way(world, 30)
        found.append(motion_of(world).tobytes())
    assert len(set(found)) == 1


@pytest.mark.parametrize("damping", [1e4, 1e6])
def test_strong_damping_beside_rigid_contacts_takes_speed_and_gives_none(damping: float) -> None:
    world = touching("rigid", "step")
    world.physics = replace(world.physics, linear_damping=damping, angular_damping=damping)
    for _ in range(3):
        world.step()
        assert np.abs(world.table(Velocity)["linear"]).max() <= 9.81 / damping * 1.01


@pytest.mark.parametrize("method", ["leapfrog", "rk4", "blanes_moan", "implicit_midpoint"])
def test_finer_steps_are_not_worse(method: str) -> None:
    """Each halving takes an error to less than half of it, down to rounding."""

    def after(dt: float) -> NDArray[np.float64]:
        world = World(*standard_systems(), simulation=SimulationConfig(dt=dt, substeps=1, integrator=method))
        world.spawn(Transform((1.2, 0.0)), Velocity(), Mass(1.0), Spring(rest_length=1.0, stiffness=40.0))
        world.run(seconds=1.0)
        return motion_of(world)

    exact = World(*standard_systems(), simulation=SimulationConfig(integrator="dop853"))
    exact.spawn(Transform((1.2, 0.0)), Velocity(), Mass(1.0), Spring(rest_length=1.0, stiffness=40.0))
    exact.run(seconds=1.0)
    errors = [float(np.abs(after(0.05 / 2**k) - motion_of(exact)).max()) for k in range(6)]
    assert all(fine <= max(0.5 * coarse, 1e-12) for coarse, fine in pairwise(errors))


def test_what_no_file_may_hold_ends_a_run() -> None:
    assert motion.FARTHEST == COORDINATE_LIMIT
    world = World(*standard_systems())
    world.spawn(Transform((9e299, 0.0)), Velocity((1e307, 0.0)), Mass(1.0), name="far")
    with pytest.raises(Diverged, match=r"far: Transform is beyond 1e\+300 m"):
        world.run(seconds=1.0)
    assert np.abs(world.table(Transform)["position"]).max() < COORDINATE_LIMIT


def scene_file(folder: Path, change: Callable[[dict[str, object]], None]) -> Path:
    scene: dict[str, object] = {"format": "physicslab-scene/1", "simulation": {}, "entities": []}
    change(scene)
    path = folder / "scene.json"
    path.write_text(json.dumps(scene), encoding="utf-8")
    return path


def test_a_step_of_endless_length_is_refused(tmp_path: Path) -> None:
    path = scene_file(tmp_path, lambda scene: scene.update(simulation={"dt": 1e308}))
    with pytest.raises(ValueError, match=r"simulation.dt = 1e\+308: must be .*1e\+100"):
        load_scene(path)
