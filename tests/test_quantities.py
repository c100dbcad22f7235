"""What graphs and meters show: names, units and values of quantities."""

import math

import numpy as np
import pytest
from desk import empty_world
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import GraphLine, Mass, Pin, Rod, Spring, Transform, Velocity
from physicslab.components.quantities import BODY_QUANTITIES, QUANTITIES, WORLD_QUANTITIES, why_not_of
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.diagnostics.quantities import Reading, why_undefined
from physicslab.diagnostics.trajectory import BODY_HEADER
from physicslab.ecs.quantity_text import evaluate
from physicslab.files.checks import SceneError
from physicslab.files.scene import load_scene, read_scene
from physicslab.prefabs import box, circle, pendulum
from physicslab.view.canvas.quantities import product, quotient

MOTION = st.floats(-50.0, 50.0)
UNITS = sorted({quantity.unit for quantity in QUANTITIES.values()})


@given(MOTION, MOTION, MOTION, MOTION, MOTION, st.floats(0.1, 20.0))
def test_a_body_alone_has_the_energy_and_the_momentum_of_its_world(
    x: float, y: float, vx: float, vy: float, turning: float, mass: float
) -> None:
    world = empty_world(gravity=(1.0, -9.81))
    ball = circle(world, (x, y), velocity=(vx, vy), mass=mass)
    world.component(ball, Velocity).angular = turning
    world.add(ball, Spring(anchor_b=(1.0, 2.0), stiffness=30.0))
    reading = Reading(world)
    for name in set(BODY_QUANTITIES) & set(WORLD_QUANTITIES):
        assert reading.value(name, ball) == pytest.approx(reading.value(name), rel=1e-12, abs=1e-12), name


def test_sums_over_the_world_are_those_that_reports_have() -> None:
    world = load_scene("newtons_cradle")
    world.run(seconds=0.3)
    reading, energy, momentum = Reading(world), measure_energy(world), measure_momentum(world)
    assert reading.value("total energy") == energy.total
    assert reading.value("kinetic energy of rotation") == energy.kinetic_angular
    assert reading.value("energy of springs") == energy.potential["spring"]
    assert reading.value("momentum y") == momentum.linear.y
    assert reading.value("angular momentum") == momentum.angular


def test_every_quantity_has_a_value_where_it_is_defined() -> None:
    world = load_scene("pendulum")
    world.run(seconds=0.5)
    reading = Reading(world)
    for name in WORLD_QUANTITIES:
        assert math.isfinite(reading.value(name)) == (why_undefined(world, name, None) == ""), name
    assert all(math.isfinite(reading.value(name, world.entity("bob"))) for name in BODY_QUANTITIES)
    assert {name for name, one in QUANTITIES.items() if one.of_body} == set(BODY_QUANTITIES)
    assert len({one.column for one in QUANTITIES.values()}) == len(QUANTITIES)


def test_the_acceleration_of_a_free_body_is_gravity_and_its_net_force_its_weight() -> None:
    world = empty_world(gravity=(0.0, -9.81))
    ball = circle(world, (0, 5), mass=3.0)
    reading = Reading(world)
    assert reading.value("acceleration y", ball) == pytest.approx(-9.81)
    assert reading.value("net force", ball) == pytest.approx(3.0 * 9.81)


def test_what_has_no_value_is_nan_with_a_reason() -> None:
    world = empty_world()
    floor = box(world, (0, 0), width=1, height=1, static=True)
    a, b = circle(world, (3, 0)), circle(world, (5, 0))
    point = world.spawn(Transform((0, 0)), Velocity((1, 0)))
    world.spawn(Spring(a, b))
    assert math.isnan(Reading(world).value("speed", floor))
    assert why_undefined(world, "speed", floor) == "is fixed"
    assert why_undefined(world, "momentum", point) == "has no mass"
    assert why_undefined(world, "total energy", a) == "shares the energy of a spring with others"
    assert why_undefined(world, "speed", a) == ""
    world.remove(a)
    world.synchronise()
    assert why_undefined(world, "x", a) == "gone" and math.isnan(Reading(world).value("x", a))


@given(st.floats(0.0, 1.5), st.floats(0.2, 5.0), st.floats(0.1, 20.0))
def test_the_rod_of_a_pendulum_pulls_as_weight_and_turning_ask(
    angle: float, length: float, mass: float
) -> None:
    world = empty_world(gravity=(0, -9.81))
    place = (length * math.sin(angle), -length * math.cos(angle))
    bob = world.spawn(Transform(place), Velocity((0.0, 0.0)), Mass(mass))
    rod = world.spawn(Rod(b=bob, length=length))
    world.run(seconds=0.3)
    reading = Reading(world)
    x, y = reading.value("x", bob), reading.value("y", bob)
    pull = mass * (reading.value("speed", bob) ** 2 - 9.81 * y) / length
    assert reading.value("joint force", rod) == pytest.approx(pull, rel=1e-6)
    assert reading.value("joint force x", rod) == pytest.approx(-pull * x / length, rel=1e-6, abs=1e-9 * pull)
    assert reading.value("joint torque", rod) == 0.0


def test_a_spring_pulls_by_its_extension_and_pushes_where_it_is_short() -> None:
    world = empty_world()
    a, b = circle(world, (0, 0)), circle(world, (3, 0))
    long, short = (world.spawn(Spring(a, b, rest_length=rest, stiffness=10.0)) for rest in (2.0, 3.5))
    reading = Reading(world)
    assert reading.value("spring force", long) == pytest.approx(10.0)
    assert reading.value("spring force", short) == pytest.approx(-5.0)


def test_what_carries_no_joint_or_several_has_no_force_of_one() -> None:
    world = empty_world()
    a, b = circle(world, (0, 0)), circle(world, (3, 0))
    spring = world.spawn(Spring(a, b))
    world.run(steps=1)
    world.add(a, Rod(b=b))
    assert why_undefined(world, "joint force", a) == "" and math.isfinite(
        Reading(world).value("joint force", a)
    )
    assert (
        why_undefined(world, "joint force", spring)
        == why_undefined(world, "joint force", b)
        == "has no joint"
    )
    assert why_undefined(world, "spring force", b) == "has no spring"
    world.add(a, Pin(b=b, anchor_b=(-3.0, 0.0)))
    assert why_undefined(world, "joint force", a) == "has several joints"
    assert math.isnan(Reading(world).value("joint force", a))


def _with_line(quantity: str, of: str) -> dict[str, object]:
    return {
        "format": "physicslab-scene/1",
        "entities": [
            {"id": "bob", "Transform": {"position": [0, -1]}, "Velocity": {}, "Mass": {"mass": 1}},
            {"id": "rod", "Rod": {"b": "bob"}},
            {"id": "graph", "Graph": {}},
            {"GraphLine": {"graph": "graph", "quantity": quantity, "body": of}},
        ],
    }


def test_a_line_of_a_scene_is_of_what_has_its_quantity() -> None:
    world = read_scene(_with_line("joint force", "rod"), "lines")
    (line,) = (world.component(one, GraphLine) for one in world.batch(GraphLine).entities.tolist())
    assert line.body == (rod := world.entity("rod"))
    assert why_undefined(world, "joint force", rod) == ""
    with pytest.raises(SceneError, match=r'GraphLine.body = "bob".*the id of an entity with a joint'):
        read_scene(_with_line("joint force", "bob"), "lines")
    with pytest.raises(SceneError, match=r'GraphLine.body = "rod".*the id of an entity with a Transform'):
        read_scene(_with_line("speed", "rod"), "lines")


def test_attracting_bodies_have_no_potential_energy_of_their_own() -> None:
    world = load_scene("two_planets")
    body = next(entity for entity in world.entities() if world.has(entity, Mass))
    assert why_undefined(world, "potential energy", body) == "shares the energy of gravity with others"


def test_a_pendulum_keeps_its_own_energy() -> None:
    world = empty_world(gravity=(0, -9.81))
    bob = pendulum(world, (0, 3), length=2.0, angle=0.4)
    before = Reading(world).value("total energy", bob)
    world.run(seconds=1.0)
    assert Reading(world).value("total energy", bob) == pytest.approx(before, rel=1e-4)


def test_the_table_of_run_has_the_units_of_graphs() -> None:
    assert BODY_HEADER == (
        "time [s]", "entity", "x [m]", "y [m]", "angle [rad]", "vx [m/s]", "vy [m/s]", "omega [rad/s]",
    )  # fmt: skip


def test_the_world_has_no_place_and_a_body_no_energy_of_springs() -> None:
    assert '"kinetic energy"' in (why_not_of("x", None) or "")
    assert "where there is a body" in (why_not_of("energy of springs", 1) or "")
    assert why_not_of("kinetic energy", None) is None and why_not_of("x", 1) is None


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("other", ["s", *UNITS])
def test_units_of_slopes_and_areas_have_the_dimensions_of_a_quotient_and_a_product(
    unit: str, other: str
) -> None:
    # 1 of the unit that is named is 1 of what it must be, or it is refused.
    bracketed = f"({other.replace(' ', '*')})"
    expected = evaluate(f"1 {unit}", unit), evaluate(f"1 {other}", other)
    assert expected == (1.0, 1.0)
    plain = unit.replace(" ", "*")
    for found, text in (
        (quotient(unit, other), f"({plain})/{bracketed}"),
        (product(unit, other), f"({plain})*{bracketed}"),
    ):
        value = evaluate(text.replace("rad", "1"), _without_angles(found))
        assert np.isclose(value, 1.0), (unit, other, found)


def _without_angles(unit: str) -> str:
    words = unit.replace("rad^2", "1").replace("rad", "1").replace(" ", "*")
    above, _, below = words.partition("/")
    return f"{above}/({below})" if below else above
