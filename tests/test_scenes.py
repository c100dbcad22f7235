"""The built-in scenes: each holds what it says and does what it is there to show."""

import math

import numpy as np
import pytest

from physicslab import World, load_scene
from physicslab.components import Mass, Shape, Transform, Velocity
from physicslab.diagnostics.energy import Audit, measure_account, measure_energy, measure_momentum
from physicslab.diagnostics.joints import joint_states
from physicslab.ecs.text import printable
from physicslab.ecs.vector import Vector2
from physicslab.scenes import SCENES


def place(world: World, name: str) -> Vector2:
    return world.component(world.entity(name), Transform).position


def velocity(world: World, name: str) -> Vector2:
    return world.component(world.entity(name), Velocity).linear


def x(world: World, name: str) -> float:
    """Return an entity's horizontal place."""
    return place(world, name).x


def speeds(world: World) -> list[float]:
    """Return the horizontal velocities of all bodies."""
    world.synchronise()
    velocities: list[float] = world.table(Velocity)["linear"][1:, 0].tolist()
    return velocities


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_is_there_with_its_texts(name: str) -> None:
    world = load_scene(name)
    assert (world.name, name.isidentifier()) == (name, True)
    assert world.title and len(world.description) > 30
    assert SCENES[name].teaches
    assert printable(world.title + world.description) == world.title + world.description
    assert world.entities()


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_runs_and_stays_finite(name: str) -> None:
    world = load_scene(name)
    world.run(seconds=0.5)
    assert world.time == 0.5
    assert math.isfinite(measure_energy(world).total)


def test_planets_keep_the_third_law_that_their_scene_tells_of() -> None:
    world, turned, nearest, farthest = (
        load_scene("solar_system"),
        np.zeros(5),
        np.full(5, np.inf),
        np.zeros(5),
    )
    before, since = None, 0.0
    for _ in world.stepping(seconds=100.0, stride=6):
        star, *planets = world.table(Transform)["position"][world.batch(Mass).rows]
        x, y = (np.array(planets) - star).T
        angle, distance = np.arctan2(y, x), np.hypot(x, y)
        if before is None:
            since = world.time
        else:
            turned += np.mod(angle - before, 2.0 * math.pi)
        before, nearest, farthest = angle, np.minimum(nearest, distance), np.maximum(farthest, distance)
    period = 2.0 * math.pi * (world.time - since) / turned
    star_mass = world.component(world.entity("star"), Mass).mass
    law = 4.0 * math.pi**2 / (world.physics.G * star_mass)
    assert period**2 / (0.5 * (nearest + farthest)) ** 3 == pytest.approx(law, rel=1e-3)


def test_the_measured_scenes_are_what_the_measurements_say() -> None:
    pyramid = load_scene("pyramid")
    pyramid.synchronise()
    assert len(pyramid.batch(Mass)) == 465
    assert (pyramid.physics.gravity.y, pyramid.simulation.dt, pyramid.simulation.substeps) == (
        -10.0,
        1 / 60,
        4,
    )
    gas = load_scene("gas")
    gas.synchronise()
    assert len(gas.batch(Mass)) == 2000
    assert gas.physics.bounds is not None
    left, bottom, right, top = gas.physics.bounds
    share = float(np.sum(np.pi * gas.table(Shape)["radius"] ** 2)) / ((right - left) * (top - bottom))
    assert 0.15 < share < 0.20
    pile = load_scene("pile")
    pile.synchronise()
    assert len(pile.batch(Mass)) == 1000


def test_what_a_scene_does_not_need_is_left_out() -> None:
    def run(name: str) -> tuple[set[str], set[str]]:
        world = load_scene(name)
        world.run(steps=1)
        schedule = world.schedule
        return {system.name for system in schedule.running}, {left.name for left in schedule.left_out}

    touching = {"BroadPhaseSystem", "ContactSystem", "SleepSystem", "ResolveSystem"}
    running, left_out = run("two_planets")
    assert left_out >= {"SpringSystem", "DragSystem", *touching}
    assert running >= {"GravitySystem", "IntegrateSystem", "TrailSystem"} and not running & left_out
    running, left_out = run("pendulum")
    assert left_out >= {"DragSystem", *touching, "TrailSystem"}
    assert running >= {"GravitySystem", "JointSystem", "IntegrateSystem"} and not running & left_out


def test_two_planets_have_and_keep_no_momentum() -> None:
    world = load_scene("two_planets")
    audit = Audit(world)
    for _ in world.stepping(seconds=10):
        audit.sample(world)
        assert measure_momentum(world).linear.magnitude < 1e-12
    assert audit.change < 1e-4


def test_the_cradle_lets_out_as_many_balls_as_come_in() -> None:
    world = load_scene("newtons_cradle")
    world.run(seconds=1.0)
    first = speeds(world)
    assert first[4] > 3.0 and max(map(abs, first[:4])) < 0.05
    world.run(seconds=1.75)
    back = speeds(world)
    assert back[0] < -3.0 and max(map(abs, back[1:])) < 0.05


def test_the_stack_stands() -> None:
    world = load_scene("stack")
    world.run(seconds=3.0)
    top = world.component(world.entities()[-1], Transform).position
    assert abs(top.x) < 0.01 and 9.4 < top.y <= 9.5


def test_blocks_slide_where_friction_is_less_than_the_slope() -> None:
    world = load_scene("slope")
    names = [f"mu = {friction}" for friction in (0.1, 0.2, 0.5, 0.8)]
    before = [x(world, name) for name in names]
    world.run(seconds=1.0)
    moved = [
        (start - x(world, name)) / math.cos(math.radians(20))
        for start, name in zip(before, names, strict=True)
    ]
    for way, friction in zip(moved[:2], (0.1, 0.2), strict=True):
        slide = 0.5 * 9.81 * (math.sin(math.radians(20)) - friction * math.cos(math.radians(20)))
        assert way == pytest.approx(slide, rel=0.01)
    assert max(map(abs, moved[2:])) < 0.01


def test_bounces_reach_the_square_of_the_restitution() -> None:
    world = load_scene("bounces")
    names = [f"e = {e}" for e in ("0", "0.25", "0.5", "0.75", "1")]
    heights: dict[str, list[float]] = {name: [] for name in names}
    bodies = {name: world.component(world.entity(name), Transform) for name in names}
    for _ in world.stepping(seconds=2.2):
        for name, transform in bodies.items():
            heights[name].append(transform.position.y - 0.3)
    for name, e in zip(names, (0.0, 0.25, 0.5, 0.75, 1.0), strict=True):
        floor = int(np.argmin(heights[name][:70]))
        assert max(heights[name][floor : floor + 75]) / 3.7 == pytest.approx(e * e, abs=0.01)


def test_the_last_domino_falls() -> None:
    world = load_scene("dominoes")
    last = world.component(world.entities()[-1], Transform)
    world.run(seconds=1.0)
    assert abs(last.angle) < 0.01
    world.run(seconds=6.0)
    assert last.angle < -1.0


def test_the_gas_keeps_its_energy() -> None:
    world = load_scene("gas")
    before = measure_energy(world).kinetic
    world.run(seconds=1.0)
    assert world.collisions > 1000
    assert measure_energy(world).kinetic == pytest.approx(before, rel=1e-9)


def test_two_double_pendulums_part_though_they_begin_alike() -> None:
    world = load_scene("double_pendulum")

    def apart() -> float:
        left, right = (
            world.component(world.entity(f"{side} lower"), Transform) for side in ("left", "right")
        )
        return (right.position - left.position - Vector2(4.4, 0.0)).magnitude

    world.run(seconds=1.0)
    assert apart() < 0.02
    world.run(seconds=9.0)
    assert apart() > 0.5
    assert abs(measure_account(world).energy["numerical"]) < 1e-9


def test_the_bridge_carries_what_falls_on_it() -> None:
    world = load_scene("bridge")
    world.run(seconds=4.0)
    heights = [world.component(world.entity(f"{mass} kg"), Transform).position.y for mass in (5, 20, 60)]
    assert min(heights) > -1.5
    world.synchronise()
    assert max(joint.stretch for joint in joint_states(world)) < 0.002


def test_the_piston_keeps_to_the_kinematics_of_its_crank() -> None:
    world = load_scene("piston")
    world.run(seconds=1.3)
    turned = math.radians(60.0) + 1.3 * math.pi
    way = 0.5 * math.cos(turned) + math.sqrt(1.4**2 - (0.5 * math.sin(turned)) ** 2)
    assert x(world, "piston") == pytest.approx(way, abs=1e-10)


def test_weights_on_pulleys_fall_as_slowly_as_their_scene_says() -> None:
    world = load_scene("pulleys")
    world.run(seconds=1.0)
    for name, start, acceleration in (("right 1", 1.4, 0.2 / 2.2), ("right 2", 0.8, 0.4 / 6.4)):
        fallen = start - world.component(world.entity(name), Transform).position.y
        assert fallen == pytest.approx(0.5 * acceleration * 9.81, abs=1e-11)


def test_carts_keep_their_momentum_and_part_by_their_restitution() -> None:
    world = load_scene("carts")
    world.run(seconds=2.0)
    first, second = (velocity(world, f"cart {n}").x for n in (1, 2))
    assert 1.0 * first + 2.0 * second == pytest.approx(2.0, abs=1e-12)
    assert second - first == pytest.approx(0.8 * 2.0, abs=1e-12)


def test_only_the_seesaw_that_the_law_of_the_lever_says_is_in_balance() -> None:
    world = load_scene("seesaw")
    world.run(seconds=1.0)
    tilts = {
        name: world.component(world.entity(f"plank {name}"), Transform).angle
        for name in ("too near", "in balance", "too far")
    }
    assert tilts["too near"] < -0.2 and tilts["too far"] > 0.2 and abs(tilts["in balance"]) < 1e-4


def test_the_pen_of_the_linkage_draws_a_line_for_half_of_each_turn() -> None:
    world = load_scene("four_bar")
    pen = world.component(world.entity("pen"), Transform)
    line = []
    for _ in world.stepping(seconds=4.0):
        line += [pen.position.x] if abs(pen.position.y - 1.602) < 0.002 else []
    assert len(line) >= 120 and max(line) - min(line) > 1.7


def test_trains_of_gears_with_the_same_ends_turn_alike() -> None:
    world = load_scene("gear_train")
    world.run(seconds=1.0)
    spins = world.table(Velocity)["angular"][world.batch(Velocity).rows]
    assert spins == pytest.approx([1.0, -4.0, 3.0, 1.0, -2.4, 1.5, -3.0], abs=1e-11)


def test_the_crane_stops_its_trolley_and_not_its_ball() -> None:
    world = load_scene("crane")
    world.run(seconds=2.3)
    assert abs(velocity(world, "trolley").x) < 1e-3
    ball, swung = velocity(world, "ball"), place(world, "ball").y - 1.4
    assert 0.5 * ball.magnitude**2 + 9.81 * swung == pytest.approx(0.5 * 1.6**2, rel=0.01)


def test_the_car_climbs_as_far_as_its_motors_carry_it_and_does_not_tip() -> None:
    world, steepest, farthest = load_scene("car"), 0.0, 0.0
    car = world.component(world.entity("car"), Transform)
    for _ in world.stepping(seconds=20.0):
        steepest, farthest = max(steepest, abs(car.angle)), max(farthest, car.position.x)
    assert steepest < 1.0 and 7.0 < farthest < 11.0
    assert car.position.x > 5.0, "it stays on the last hill"


def test_the_catapult_throws_its_stone_at_three_times_the_speed_of_its_weight() -> None:
    world = load_scene("catapult")
    arm = world.component(world.entity("arm"), Velocity)
    world.run(seconds=0.7)
    assert velocity(world, "stone").magnitude == pytest.approx(3.0 * 0.7 * abs(arm.angular), rel=0.05)
    world.run(seconds=1.1)
    assert x(world, "stone") > 2.0


def test_the_ragdoll_falls_down_the_stairs_in_one_piece_and_lies_at_their_foot() -> None:
    world = load_scene("ragdoll")
    world.run(seconds=6.0)
    rows, energy = world.batch(Velocity).rows, measure_energy(world)
    # A limb that hangs over may swing on: its pin has no friction. It is given nothing.
    assert energy.kinetic < 0.05
    world.run(seconds=2.0)
    assert measure_energy(world).total < energy.total + 1e-3
    assert world.table(Transform)["position"][rows, 0].mean() > 2.0, "at the foot of the stairs"
    world.synchronise()
    assert max(joint.stretch for joint in joint_states(world)) < 0.005
