"""The named forces on a body add up to m a, and the impulses of a step to its change of momentum."""

from __future__ import annotations

from typing import Any

import pytest
from desk import Desk, bits, empty_world

from physicslab import World, load_scene
from physicslab.components import Drag, Mass, Material, Pin, Rod, Rope, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.free_body import forces_on, last_step, net_force
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.history import SetField
from physicslab.systems.standard import standard_systems


def movable(world: World) -> list[int]:
    return [entity for entity in world.entities() if world.has(entity, Mass)]


@pytest.mark.parametrize("scene", ["stack", "slope", "drop"])
def test_at_rest_sliding_and_falling_forces_are_m_a_to_rounding(scene: str) -> None:
    world = load_scene(scene)
    for _ in range(80):
        world.step()
    for entity in movable(world):
        step, forces = last_step(world, entity), forces_on(world, entity)
        assert step is not None
        largest = max(one.force.magnitude for one in forces)
        assert (net_force(forces) - step.inertia).magnitude < 1e-7 * largest
        assert step.difference.magnitude < 1e-7 * largest * step.dt


def test_impacts_are_among_the_impulses_and_not_in_m_a() -> None:
    world = empty_world()
    world.spawn(Transform((0.0, -0.5)), Shape.box(8.0, 1.0), Material(0.8, 0.3))
    ball = world.spawn(
        Transform((0.0, 0.55)), Velocity((1.0, -4.0)), Mass(2.0), Shape.circle(0.5), Material(0.8, 0.3)
    )
    world.contacts.read = True
    world.step()
    step = last_step(world, ball)
    assert step is not None
    (name,) = (name for name in step.impulses if name.startswith("impact"))
    assert step.impulses[name].y == pytest.approx(1.8 * 2.0 * 4.1, rel=0.02)
    assert step.difference.magnitude < 1e-12 * step.change.magnitude
    assert step.inertia.y == pytest.approx(-2.0 * 9.81, rel=1e-9)


@pytest.mark.parametrize("contacts", ["rigid", "soft"])
@pytest.mark.parametrize("joint", [Rod, Rope, Pin])
@pytest.mark.parametrize("beside", [False, True])
def test_the_impulse_of_a_joint_is_all_of_it(joint: Any, contacts: Any, beside: bool) -> None:
    world = World(*standard_systems(), simulation=SimulationConfig(contacts=contacts, dt=1e-3))
    bob = world.spawn(Transform((1.0, 0.0)), Velocity((0.0, -2.0)), Mass(1.5), Shape.circle(0.1))
    if beside:  # so that the step is not that of forces alone
        world.spawn(Transform((3.0, 0.0)), Velocity((0.0, -2.0)), Mass(1.5), Shape.circle(0.1))
        world.spawn(Transform((2.0, -9.0)), Shape.box(9.0, 1.0))
    places = {"anchor_a": (-1.0, 0.0), "anchor_b": (0.0, 0.0)} if joint is Pin else {}
    world.spawn(joint(a=bob, **places), name="held")
    for _ in range(300):
        world.step()
    step = last_step(world, bob)
    assert step is not None
    (pull,) = (impulse for name, impulse in step.impulses.items() if name != "weight")
    assert pull.magnitude > 5.0 * step.dt
    assert step.difference.magnitude < 0.01 * pull.magnitude


def test_damping_drag_and_springs_are_accounted_for_to_the_order_of_the_step() -> None:
    def left(dt: float) -> float:
        world = World(
            *standard_systems(), physics=PhysicsConfig(linear_damping=0.7),
            simulation=SimulationConfig(dt=dt, integrator="leapfrog"),
        )  # fmt: skip
        ball = world.spawn(Transform((1.0, 0.0)), Velocity((0.0, 2.0)), Mass(1.5), Drag(0.4, 0.2))
        world.spawn(Spring(ball, anchor_b=Vector2(), rest_length=0.5, stiffness=30.0))
        for _ in range(round(0.5 / dt)):
            world.step()
        step = last_step(world, ball)
        assert step is not None and {"weight", "springs", "air", "damping"} <= step.impulses.keys()
        return step.difference.magnitude / step.dt

    coarse, fine = left(0.02), left(0.005)
    assert coarse < 0.05 * 30.0 * 0.5
    assert fine < coarse / 5.0  # springs are of second order, leapfrog's kicks under drag of first


def test_to_read_what_the_last_step_did_changes_no_step_of_islands() -> None:
    def fallen(*, read: bool) -> bytes:
        world = empty_world()
        balls = [
            world.spawn(Transform((x, 0.0)), Velocity(), Mass(1.0), Shape.circle(0.3)) for x in (0.0, 500.0)
        ]
        for _ in range(4):
            world.step()
            assert len(world.islands.members) == 2
            assert not read or all(last_step(world, ball) is not None for ball in balls)
        return bits(world)

    assert fallen(read=True) == fallen(read=False)


def test_there_is_no_last_step_before_the_first_after_a_long_run_and_of_what_nothing_moves() -> None:
    world = load_scene("drop")
    (ball,) = movable(world)
    assert last_step(world, ball) is None
    world.step()
    assert last_step(world, ball) is not None
    floor = next(entity for entity in world.entities() if not world.has(entity, Mass))
    assert last_step(world, floor) is None


def test_the_panel_shows_the_sum_m_a_and_the_difference_and_at_rest_none() -> None:
    desk = Desk(load_scene("stack"))
    desk.window.level = "Engineer"
    desk.window.selection.take(movable(desk.world)[0])
    desk.frames(120)
    desk.window.pace.paused = True
    desk.frames(10)
    rows = desk.ui.rows
    assert rows["Sum"] == rows["m a"] == rows["Difference"] == "0 N"
    assert rows["Sum of impulses"] == rows["Not accounted for"] == "0 N s"
    assert rows["Weight"] == "9.810 N"
    assert any(words.startswith("Impulses in the last step") for words in desk.ui.words)


def test_after_an_edit_there_is_no_last_step_to_compare_with() -> None:
    desk = Desk(load_scene("drop"))
    (ball,) = movable(desk.world)
    desk.window.level = "Measure"
    desk.window.selection.take(ball)
    desk.frames(20)
    desk.window.pace.paused = True
    desk.frames(5)
    assert "m a" in desk.ui.rows and "Sum of impulses" not in desk.ui.rows
    desk.window.edits.do(SetField(ball, "Velocity", "linear", Vector2(3.0, 3.0)))
    desk.frames(10)
    assert "m a" not in desk.ui.rows and "Sum" in desk.ui.rows
