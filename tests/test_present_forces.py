"""Forces that are shown before the first step and after an edit: those of a step that would begin then."""

from pathlib import Path

import numpy as np
import pytest

from physicslab import SimulationConfig, Vector2, World, box, circle, load_scene, save_scene
from physicslab.components import Rod
from physicslab.contacts.arguments import motion_of
from physicslab.diagnostics.free_body import (
    applied_forces,
    contact_forces,
    forces_on,
    joint_forces,
    net_force,
)
from physicslab.diagnostics.joints import joint_states
from physicslab.diagnostics.quantities import Reading
from physicslab.scenes import SCENES


def is_soft(world: World) -> bool:
    return any((plan.collisions, plan.contacts) == ("step", "soft") for plan in world.plans)


@pytest.mark.slow
@pytest.mark.parametrize("scene", [getattr(one, "name", one) for one in SCENES])
def test_forces_before_the_first_step_are_those_of_one(scene: str) -> None:
    world, other = load_scene(scene), load_scene(scene)
    world.synchronise()
    before = [column.copy() for column in motion_of(world)]
    shown = joint_forces(world) + contact_forces(world)
    size = max(float(np.abs(applied_forces(world)).max()), float(np.abs(shown).max()))
    assert world.steps == 0
    assert all(np.array_equal(*pair) for pair in zip(before, motion_of(world), strict=True))
    other.step((1.0 if is_soft(world) else 1e-4) * other.simulation.dt)
    for now, then in zip(motion_of(other), before, strict=True):
        now[...] = then  # joints pull along where bodies are
    assert other.forces_known
    after = joint_forces(other) + contact_forces(other)
    # In 1.7 us the strings of the cradle stretch by 3e-5.
    assert np.abs(shown - after).max() <= (0.0 if is_soft(world) else 1e-4) * size


@pytest.mark.parametrize("scene", ["seesaw", "dominoes", "ragdoll"])
def test_what_rests_in_a_file_has_the_forces_that_it_had(scene: str, tmp_path: Path) -> None:
    """They were up to 50,000 weights: in a step of 1.7 us soft contacts took all that was left of speeds."""
    world = load_scene(scene)
    world.run(seconds=6.0)
    save_scene(world, tmp_path / "rest.json")
    loaded = load_scene(tmp_path / "rest.json")
    assert is_soft(loaded)
    rows = np.flatnonzero(world.bodies.inverse_mass > 0.0)
    mass = 1.0 / world.bodies.inverse_mass[rows, None]
    there = loaded.entity_index.rows_of(
        np.array([loaded.entity(world.label(int(entity))) for entity in world.entity_index.entities[rows]])
    )
    change = (contact_forces(loaded)[there] - contact_forces(world)[rows]) / mass
    assert np.abs(change).max() < 0.05 * 9.81


def test_of_a_pendulum_at_rest_the_part_across_the_rod_is_left() -> None:
    world = load_scene("pendulum")
    joint = joint_states(world)[0]
    body = joint.b or joint.a
    net, rod = net_force(forces_on(world, body)), joint.force
    assert rod.magnitude > 1.0
    assert abs(net.dot(rod)) < 1e-6 * rod.magnitude * net.magnitude
    reading = Reading(world)
    assert (reading.value("force x", body), reading.value("force y", body)) == tuple(net)


def test_joints_and_contacts_are_where_bodies_are_and_not_a_step_ahead() -> None:
    world = World(simulation=SimulationConfig(contacts="soft"))
    box(world, (0.0, -0.5), width=90.0, height=1.0, static=True)
    crate = box(world, (0.0, 0.5), width=1.0, height=1.0, velocity=(10.0, 0.0), friction=0.0)
    one = circle(world, (0.0, 5.0), radius=0.2, velocity=(10.0, 0.0))
    other = circle(world, (0.0, 3.0), radius=0.2, velocity=(10.0, 6.0))
    rod = world.spawn(Rod(a=one, b=other))
    (joint,) = joint_states(world)
    assert is_soft(world) and not world.forces_known
    assert joint.entity == rod and joint.place == Vector2(0.0, 5.0)
    assert joint.force.x == pytest.approx(0.0, abs=1e-9 * joint.force.y), "along the rod as it is"
    places = [force.place.x for force in forces_on(world, crate) if force.kind == "normal"]
    assert places == pytest.approx([0.0], abs=0.01)


def test_an_edit_is_seen_in_the_forces_at_once() -> None:
    world = load_scene("pendulum")
    world.run(seconds=0.5)
    joint = joint_states(world)[0]
    before = joint.force
    world.edited()
    assert not world.forces_known
    now = next(one for one in joint_states(world) if one.entity == joint.entity)
    assert tuple(now.force) == pytest.approx(tuple(before), rel=1e-5)
