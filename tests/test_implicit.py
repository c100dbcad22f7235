"""The implicit midpoint rule: bounded however stiff, and the same whatever the order of the coordinates."""

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from physicslab.components import Drag, Mass, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.integrators import implicit_midpoint
from physicslab.kernels.forces import springs
from physicslab.ode.system import OdeSystem
from physicslab.systems.standard import standard_systems
from physicslab.world import World

MIDPOINT = SimulationConfig(integrator="implicit_midpoint")


def net(side: int, stiffness: float, **physics: object) -> World:
    """Return a square net of springs that hangs from its two upper corners, its bodies in disorder."""
    world = World(*standard_systems(), physics=PhysicsConfig(**physics), simulation=MIDPOINT)  # type: ignore[arg-type]
    places = [(x, y) for x in range(side) for y in range(side)]
    np.random.default_rng(3).shuffle(places)
    knot = {}
    for x, y in places:
        fixed = y == side - 1 and x in (0, side - 1)
        moves = () if fixed else (Velocity(), Mass(0.1))
        knot[x, y] = world.spawn(Transform((0.5 * x, 0.5 * y)), *moves)
    for x, y in knot:
        for other in ((x + 1, y), (x, y + 1)):
            if other in knot:
                spring = Spring(knot[x, y], knot[other], rest_length=0.5, stiffness=stiffness)
                world.spawn(spring)
    return world


@pytest.mark.parametrize("z", [0.1, 1.0, 1.9, 10.0, 100.0])
def test_a_spring_of_any_stiffness_keeps_its_energy(z: float) -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"), simulation=MIDPOINT)
    h = MIDPOINT.dt / MIDPOINT.substeps
    world.spawn(Transform((1, 0)), Velocity(), Mass(1), Spring(rest_length=0, stiffness=(z / h) ** 2))
    before = measure_energy(world).total
    world.run(steps=250)
    assert measure_energy(world).total == pytest.approx(before, rel=1e-9)


def test_a_damper_however_strong_brings_to_rest_and_never_past_it() -> None:
    for c in (1e3, 1e6, 1e12):
        world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"), simulation=MIDPOINT)
        spring = Spring(rest_length=0, stiffness=0, damping=c)
        body = world.spawn(Transform((1, 0)), Velocity((1, 0)), Mass(1), spring)
        world.run(seconds=1.0)
        assert abs(world.component(body, Velocity).linear.x) <= 1.0


def test_a_stiff_net_stays_together_and_gains_nothing() -> None:
    world = net(8, 1e5)
    before = measure_energy(world).total
    for _ in world.stepping(seconds=2.0, stride=10):
        assert measure_energy(world).total <= before + 0.02 * 64 * 0.1 * 9.81
    assert np.isfinite(world.table(Transform)["position"]).all()
    assert np.abs(world.table(Transform)["position"]).max() < 6.0


def test_the_order_of_the_coordinates_changes_the_work_and_not_the_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ends, works = [], []
    for banded in (True, False):
        world = net(5, 1e4)
        if not banded:
            monkeypatch.setattr(implicit_midpoint, "_banded", _whole)
        world.run(seconds=0.5)
        ends.append(world.table(Transform)["position"].copy())
        works.append(world.force_evaluations)
    assert ends[0] == pytest.approx(ends[1], abs=1e-8)
    assert works[0] < 0.8 * works[1]


def _whole(state: object, ode: OdeSystem) -> tuple[object, int]:
    count = ode.layout.moving_count
    return np.arange(count), count - 1


def test_neighbours_stand_close_together_in_the_order() -> None:
    world = net(8, 1e4)
    world.synchronise()
    ode = OdeSystem(world, world.schedule.forces)
    order, band = implicit_midpoint._banded(world, ode)
    assert sorted(order.tolist()) == list(range(ode.layout.moving_count))
    assert band < 40 < ode.layout.moving_count


@pytest.mark.parametrize("stiffness", [1e6, 1e9])
def test_a_pendulum_on_a_stiff_rod_swings_on(stiffness: float) -> None:
    world = World(*standard_systems(), simulation=MIDPOINT)
    bob = world.spawn(
        Transform((1, 1)), Velocity(), Mass(1), Spring(anchor_b=(0, 1), rest_length=1, stiffness=stiffness)
    )
    before = measure_energy(world).total
    for _ in world.stepping(seconds=10.0, stride=60):
        energy = measure_energy(
            world
        )  # the rod is straight at the middles of steps; its ends store what is left
        assert energy.kinetic + energy.potential["gravity"] == pytest.approx(before, abs=0.01 * 9.81)
        length = world.component(bob, Transform).position - Vector2(0, 1)
        assert length.magnitude == pytest.approx(1.0, abs=1e-4)


def alone(world: World, stiffness: float) -> None:
    """Add a body that is let go with its spring stretched, and pushed sideways."""
    spring = Spring(rest_length=1, stiffness=stiffness)
    world.spawn(Transform((0, -1.01)), Velocity((0.01, 0)), Mass(1), spring)


def pair(world: World, stiffness: float) -> None:
    """Add two bodies on a stretched spring that turn about each other."""
    a = world.spawn(Transform((0, 0)), Velocity((0, 1)), Mass(1))
    b = world.spawn(Transform((1.01, 0)), Velocity((0.3, -1)), Mass(2))
    world.spawn(Spring(a, b, rest_length=1, stiffness=stiffness))


def held_by_its_rim(world: World, stiffness: float) -> None:
    """Add a body that turns, on a stretched spring that does not end at its middle."""
    spring = Spring(anchor_a=(0, 0.5), rest_length=1, stiffness=stiffness)
    world.spawn(Transform((0, -1.51)), Velocity((0.5, 0), 2), Mass(1, 0.1), spring)


def links(world: World, stiffness: float) -> None:
    """Add ten masses that are let go level, a heavy one last, each on a spring to the one before."""
    before = None
    for i in range(10):
        ball = world.spawn(Transform((0.2 * (i + 1), 0)), Velocity((0, -1)), Mass(0.1 if i < 9 else 10))
        world.add(ball, Spring(None, before, rest_length=0.2, stiffness=stiffness))
        before = ball


@pytest.mark.parametrize("stiffness", [1e6, 1e8, 1e12])
@pytest.mark.parametrize("fill", [alone, pair, held_by_its_rim, links])
def test_stiff_springs_that_turn_as_they_swing_keep_their_energy(
    fill: Callable[[World, float], None], stiffness: float
) -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"), simulation=MIDPOINT)
    fill(world, stiffness)
    before = measure_energy(world).total
    for _ in world.stepping(steps=300, stride=7):
        assert measure_energy(world).total == pytest.approx(before, rel=1e-6)


def test_a_pair_on_a_stiff_spring_keeps_its_momenta() -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"), simulation=MIDPOINT)
    pair(world, 1e12)
    before = measure_momentum(world)
    world.run(steps=300)
    after = measure_momentum(world)
    assert (after.linear.x, after.linear.y) == pytest.approx((before.linear.x, before.linear.y), abs=1e-9)
    assert after.angular == pytest.approx(before.angular, abs=1e-6)


@pytest.mark.parametrize("seed", range(5))
def test_the_pull_over_a_span_does_the_work_that_the_energy_loses(seed: int) -> None:
    random = np.random.default_rng(seed)
    (dx, dy, vx, vy), (span, rest, k) = random.normal(size=4), random.uniform(0.1, 2.0, size=3)
    fx, fy, *_ = springs.mean_spring_pull.py_func(dx, dy, vx, vy, span, rest, k, 0.0)  # type: ignore[attr-defined]
    start, end = (math.hypot(dx + s * span * vx, dy + s * span * vy) for s in (-0.5, 0.5))
    gained = 0.5 * k * ((end - rest) ** 2 - (start - rest) ** 2)
    assert span * (fx * vx + fy * vy) == pytest.approx(gained, rel=1e-12, abs=1e-13)


def test_over_no_time_the_pull_is_that_of_the_instant() -> None:
    state = (0.3, -0.7, 0.2, 0.9)
    mean = springs.mean_spring_pull.py_func(*state, 0.0, 1.0, 40.0, 3.0)  # type: ignore[attr-defined]
    assert mean == pytest.approx(springs.spring_pull.py_func(*state, 1.0, 40.0, 3.0))  # type: ignore[attr-defined]


def test_a_damper_whose_length_passes_through_zero_keeps_the_order() -> None:
    """A body swings through the point that holds it, on a spring that dampens it."""

    def after(dt: float, method: str) -> NDArray[np.float64]:
        world = World(
            *standard_systems(), physics=PhysicsConfig(gravity_mode="none"),
            simulation=SimulationConfig(dt=dt, substeps=1, integrator=method),
        )  # fmt: skip
        spring = Spring(rest_length=0, stiffness=100.0, damping=2.0)
        world.spawn(Transform((1.0, 0.0)), Velocity(), Mass(1.0), spring)
        world.run(seconds=0.75)
        return np.concatenate((world.table(Transform)["position"], world.table(Velocity)["linear"])).ravel()

    exact = after(0.75, "exact")
    errors = [np.abs(after(0.75 / n, "implicit_midpoint") - exact).max() for n in (75, 150, 300, 600)]
    assert all(fine < 0.3 * coarse for coarse, fine in itertools.pairwise(errors)), errors


def falling(speed: float, component: object, **physics: object) -> World:
    """Return a world of one point of 1 kg that falls at a speed [m/s], 1 m below where springs are fixed."""
    world = World(*standard_systems(), physics=PhysicsConfig(**physics), simulation=MIDPOINT)  # type: ignore[arg-type]
    world.spawn(Transform((0, -1)), Velocity((0, -speed)), Mass(1), component)
    return world


@pytest.mark.parametrize("rate", [0.1, 10.0, 1e3, 1e6, 1e12])
@pytest.mark.parametrize("speed", [0.0, 1.0])
@pytest.mark.parametrize("kind", ["drag", "quadratic", "damper", "damping"])
def test_what_resists_leads_to_the_limit_velocity_and_never_past_it(
    kind: str, speed: float, rate: float
) -> None:
    if kind == "damping":
        world = falling(speed, Drag(linear=0.0), linear_damping=rate)
    else:
        brake = {
            "drag": Drag(linear=rate),
            "quadratic": Drag(quadratic=rate),
            "damper": Spring(rest_length=0, stiffness=0, damping=rate),
        }
        world = falling(speed, brake[kind])
    limit = math.sqrt(9.81 / rate) if kind == "quadratic" else 9.81 / rate
    side = math.copysign(1.0, speed - limit)
    fell = []
    for _ in world.stepping(steps=120):
        fell.append(-float(world.table(Velocity)["linear"][1, 1]))
    assert all(side * (v - limit) >= -1e-12 for v in fell)
    assert all(side * (b - a) <= 1e-12 for a, b in itertools.pairwise(fell))
    if rate > 100.0:
        assert fell[-1] == pytest.approx(limit, rel=1e-3)


def test_decay_is_by_the_approximant_of_second_order() -> None:
    world = falling(1.0, Drag(linear=30.0), gravity_mode="none")
    z = 30.0 * MIDPOINT.dt / MIDPOINT.substeps
    world.step()
    expected = -1.0 / (1.0 + z + 0.5 * z * z) ** MIDPOINT.substeps
    assert world.table(Velocity)["linear"][1, 1] == pytest.approx(expected, rel=1e-12)


def test_a_spin_that_is_damped_hard_stops() -> None:
    world = falling(0.0, Spring(anchor_a=(0, 0.5), stiffness=0), gravity_mode="none", angular_damping=1e6)
    world.component(1, Velocity).angular = 3.0
    world.step()
    assert 0.0 <= world.table(Velocity)["angular"][1] < 1e-9


@pytest.mark.parametrize("damping", [1e3, 1e6, 1e9, 1e12])
@pytest.mark.parametrize("held", [(0.0, 0.0), (0.0, 0.2)])
def test_a_bob_swings_on_at_the_end_of_a_damper(damping: float, held: tuple[float, float]) -> None:
    world = World(*standard_systems(), simulation=MIDPOINT)
    spring = Spring(anchor_a=held, anchor_b=(0, 1), rest_length=1, stiffness=1e6, damping=damping)
    world.spawn(Transform((0.8, 0.4 - held[1])), Velocity(), Mass(1, 0.1), spring)
    before, length = measure_energy(world).total, []
    for _ in world.stepping(seconds=3.0, stride=4):
        assert before - 0.02 <= measure_energy(world).total <= before + 1e-5
        spot, turn = world.table(Transform)["position"][1], world.table(Transform)["angle"][1]
        length.append(math.hypot(spot[0] - held[1] * math.sin(turn), spot[1] + held[1] * math.cos(turn) - 1))
    assert length == pytest.approx([1.0] * len(length), abs=1e-4)


def test_a_chain_of_dampers_stops_stretching_and_keeps_its_momentum() -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"), simulation=MIDPOINT)
    balls = [world.spawn(Transform((i, 0)), Velocity((i % 3, 0)), Mass(1.0 + i)) for i in range(10)]
    for a, b in itertools.pairwise(balls):
        world.spawn(Spring(a, b, rest_length=1, stiffness=0, damping=1e9))
    before, mass = measure_momentum(world).linear.x, sum(1.0 + i for i in range(10))
    centre = sum((1.0 + i) * i for i in range(10)) / mass
    world.step()
    at, v = world.table(Transform)["position"][1:11, 0], world.table(Velocity)["linear"][1:11, 0]
    assert v == pytest.approx(np.full(10, before / mass), abs=1e-4)
    weights = np.arange(1.0, 11.0)
    assert weights @ at / mass == pytest.approx(centre + before / mass * MIDPOINT.dt, abs=1e-12)
