"""What a flow takes while contacts and joints push is the flow's, and no error of the method."""

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from physicslab import World, load_scene
from physicslab.components import Transform
from physicslab.diagnostics.energy import Accounts, Audit
from physicslab.stepping.soft import Soft
from physicslab.systems.system import Stage, System, at

DRAGS: dict[str, dict[str, Any]] = {
    "linear": {"Drag": {"linear": 3.0}},
    "quadratic": {"Drag": {"quadratic": 2.0}},
    "strong": {"Drag": {"linear": 2000.0}},
}
FLOWN = 1e-6
"""Error of the flow itself, by substeps of order 4, in what dampers take: at most 1.4e-7 was seen."""
BOX = {"kind": "box", "width": 0.6, "height": 0.3}


class LooksAtSolving(System):
    """Does nothing, between the impulses of contacts and their relaxation: steps are made stage by stage."""

    @at(Stage.SOLVE)
    def look(self, state: World, h: float) -> None:
        """Look."""


def scene(*entities: dict[str, Any], **physics: Any) -> dict[str, Any]:
    simulation = {"contacts": "soft"}
    return {
        "format": "physicslab-scene/1", "physics": physics, "simulation": simulation, "entities": [*entities]
    }  # fmt: skip


def body(x: float, y: float, angle: float = 0.0, **also: Any) -> dict[str, Any]:
    place = {"position": [x, y], "angle": angle}
    return {"Transform": place, "Velocity": {}, "Mass": {"mass": 2.0}, "Shape": BOX, **also}


def fixed(x: float, y: float, **also: Any) -> dict[str, Any]:
    return {"Transform": {"position": [x, y]}, "Shape": {"kind": "box", "width": 20.0, "height": 1.0}, **also}


def after(document: dict[str, Any], steps: int, *others: System) -> tuple[World, Accounts]:
    world = load_scene(document)
    world.install(*others)
    audit = Audit(world)
    world.run(steps=steps)
    audit.sample(world)
    return world, audit.account


def share(account: Accounts) -> float:
    """Return the error of the method, as a share of what the dampers took."""
    return abs(account.energy["numerical"]) / abs(account.energy["damping"])


@pytest.mark.parametrize("staged", [False, True])
@pytest.mark.parametrize("drag", DRAGS)
@given(beyond=st.floats(0.05, 1.5), x=st.floats(-0.3, 0.3))
@settings(max_examples=8)
def test_what_drag_takes_while_a_limit_is_closed_is_dampings(
    drag: str, staged: bool, beyond: float, x: float
) -> None:
    pin = {"Pin": {"b": "bar", "anchor_b": [x, 0.4], "anchor_a": [x, 0.4], "lower": -3.0, "upper": -beyond}}
    world, account = after(
        scene({"id": "bar", **body(0.0, 0.0), **DRAGS[drag]}, pin), 10, *[LooksAtSolving()] * staged
    )
    assert world.component(1, Transform).angle < -0.1 * beyond  # the work of the limit itself may be zero
    assert share(account) < FLOWN


@pytest.mark.parametrize("staged", [False, True])
@pytest.mark.parametrize("drag", DRAGS)
def test_what_drag_takes_while_bodies_slide_and_rest_is_dampings(drag: str, staged: bool) -> None:
    moving = {"Velocity": {"linear": [3.0, 0.0]}, **DRAGS[drag]}
    resting = {"Material": {"restitution": 0.0, "friction": 0.3}}
    document = scene(
        body(0.0, 0.65, **{**resting, **moving}),
        body(0.0, 0.95, **{**resting, **DRAGS[drag]}),
        fixed(0.0, 0.0),
    )
    _, account = after(document, 20, *[LooksAtSolving()] * staged)
    assert account.energy["damping"] < -1e-3
    assert share(account) < FLOWN


def test_moving_bodies_apart_does_no_work_against_drag() -> None:
    document = scene(body(0.1, 0.6, 0.3, Drag={"linear": 1.0}), fixed(0.0, 0.0))
    _, account = after(document, 2)
    assert abs(account.energy["overlap"]) > 1e-2
    assert abs(account.energy["numerical"]) < 1e-9


@pytest.mark.parametrize("damping", [0.0, 5.0])
def test_what_springs_store_where_bodies_are_moved_apart_is_booked(damping: float) -> None:
    """In the compiled loop as without it; dampers and drag take nothing on that way, which has no time."""
    held = {"a": "low", "b": "high", "rest_length": 0.1, "stiffness": 300.0, "damping": damping}
    off = {"a": "low", "b": "aside", "anchor_b": [0.2, 0.1], "rest_length": 0.5, "stiffness": 200.0}
    document = scene(
        fixed(0.0, -0.5), body(0.0, 0.1, id="low", Drag={"linear": 1.0}), body(0.05, 0.22, 0.3, id="high"),
        body(0.5, 0.1, 0.1, id="aside"), {"Spring": held}, {"Spring": off},
    )  # fmt: skip
    (world, account), (_, other) = after(document, 5), after(document, 5, LooksAtSolving())
    assert isinstance(world.stepper, Soft) and not world.stepper.hooks
    assert abs(account.energy["overlap"]) > 0.01
    assert account.energy["overlap"] == pytest.approx(other.energy["overlap"], rel=1e-9)
    assert abs(account.energy["numerical"]) < 1e-5


def test_a_magnetic_field_beside_a_joint_that_is_closed_books_nothing() -> None:
    bob = {"id": "bob", **body(-3.0, 2.0), "Charge": {"charge": 1.0}}
    rope = {"Rope": {"b": "bob", "anchor_a": [0.0, 0.0], "length": 2.5}}
    _, account = after(scene(bob, rope, magnetic_field=1.2), 30)
    assert abs(account.energy["joints"]) > 0.1
    assert abs(account.energy["numerical"]) < 1e-9 * abs(account.energy["joints"])


@pytest.mark.parametrize("what", ["drag", "medium"])
def test_what_drags_by_the_square_of_the_speed_is_followed_from_rest(what: str) -> None:
    water = fixed(0.0, 5.0, Medium={"density": 0.0, "quadratic": 2.0})
    water["Shape"] = {"kind": "box", "width": 20.0, "height": 20.0}
    drag: dict[str, Any] = {"Drag": {"quadratic": 2.0}} if what == "drag" else {}
    document = scene(body(0.0, 8.0, **drag), body(5.0, 0.65), fixed(0.0, 0.0), *[water] * (what == "medium"))
    world, account = after(document, 40)
    assert world.bodies.sub_integrated[1]
    assert account.energy["damping"] < -1e-3
    assert share(account) < FLOWN


def test_a_step_that_is_begun_again_by_another_method_is_booked_once() -> None:
    capsule = {"kind": "capsule", "length": 0.24, "radius": 0.04}
    one = {"id": "one", **body(7.1, 6.4, 2.7), "Shape": {"kind": "circle", "radius": 0.35}}
    two = {"id": "two", **body(5.4, 7.6, 1.0), "Shape": capsule}
    pin = {"Pin": {"a": "one", "b": "two", "anchor_a": [1.8, -0.8], "anchor_b": [0.4, -0.1]}}
    one["Thrust"] = {"force": [0.0, 1.0], "frequency": 1e6}  # dop853 finds no step that is short enough
    document = scene(one, two, pin)
    document["simulation"] = {}
    world, account = after(document, 3)
    assert world.plan.integrator.name == "leapfrog"
    assert abs(account.momentum["numerical"].y) < 1e-9
    assert account.momentum["gravity"].y == pytest.approx(-4.0 * 9.81 * world.time, rel=1e-9)


@pytest.mark.parametrize("substeps", [2, 4])
@pytest.mark.parametrize("frame", ["world", "body"])
@given(x=st.floats(-8.0, 8.0), y=st.floats(-8.0, 4.0), turned=st.floats(0.1, 1.4))
@settings(max_examples=8)
def test_a_thrust_works_along_the_way_by_which_impacts_move_what_it_pushes(
    substeps: int, frame: str, x: float, y: float, turned: float
) -> None:
    bouncing = {"restitution": 0.7, "friction": 0.3}
    thrust = {"force": [x, y], "at": [0.1, 0.05], "torque": 0.3, "frame": frame, "frequency": 2.0}
    document = scene(
        {**body(0.0, 1.2, turned, Thrust=thrust), "Velocity": {"linear": [1.0, -2.0]}, "Material": bouncing},
        fixed(0.0, 0.0, Material=bouncing),
    )
    document["simulation"]["substeps"] = substeps
    world, account = after(document, 40)
    assert world.collisions > 0
    assert account.energy["impacts"] < -1e-2
    assert abs(account.energy["numerical"]) < -1e-9 * account.energy["impacts"]


@pytest.mark.parametrize("damping", [0.0, 0.4])
def test_each_spring_on_a_body_that_moves_at_a_given_speed_is_work_of_what_moves_it(damping: float) -> None:
    hub = {
        "Transform": {"position": [0.0, 5.0]},
        "Velocity": {"linear": [1.0, 0.3], "angular": 0.4},
        "id": "hub",
    }
    balls = [
        {**body(-1.0 + n, 4.0, Shape={"kind": "circle", "radius": 0.2}), "id": f"ball {n}"} for n in range(3)
    ]
    springs = [
        {"Spring": {"a": "hub", "b": f"ball {n}", "stiffness": 30.0, "damping": damping, "rest_length": 1.0}}
        for n in range(3)
    ]
    world, account = after(scene(hub, *balls, *springs, fixed(0.0, 0.0)), 30)
    assert any(isinstance(part.stepper, Soft) for part in world.parts)
    assert account.energy["hand"] > 1.0
    assert abs(account.energy["numerical"]) < 1e-3 * account.energy["hand"]


@pytest.mark.parametrize("staged", [False, True])
@pytest.mark.parametrize("damping", [0.5, 2.0])
def test_a_damper_beside_a_spring_too_short_for_the_flow_takes_what_it_takes(
    staged: bool, damping: float
) -> None:
    """A spring between points of welded bodies that are one has no direction, which turns as it may."""
    left, right, hung = (
        {"id": name, **body(x, y), "Shape": {"kind": "circle", "radius": 0.1}}
        for name, x, y in (("left", -0.4, 0.0), ("right", 0.4, 0.0), ("hung", 0.0, 3.0))
    )
    weld = {"Weld": {"a": "left", "b": "right", "anchor_a": [0.4, 0.0], "anchor_b": [-0.4, 0.0]}}
    short = {"a": "left", "b": "right", "anchor_a": [0.4, 0.1], "anchor_b": [-0.4, 0.1]}
    damper = {"Spring": {"a": "left", "b": "hung", "rest_length": 2.0, "stiffness": 40.0, "damping": damping}}
    document = scene(
        left, right, hung, weld, damper, {"Spring": {**short, "rest_length": 0.2, "stiffness": 100.0}}
    )
    document["simulation"]["dt"] = 1 / 240
    _, account = after(document, 60, *[LooksAtSolving()] * staged)
    assert account.energy["damping"] < -0.5
    assert share(account) < FLOWN
