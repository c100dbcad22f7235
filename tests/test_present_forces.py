"""Forces that are shown before the first step and after an edit: those of a step that would begin then."""

import numpy as np
import pytest

from physicslab import World, load_scene
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


def net_forces(world: World) -> np.ndarray:
    total = applied_forces(world) + joint_forces(world) + contact_forces(world)
    return total[world.bodies.inverse_mass > 0.0]


@pytest.mark.slow
@pytest.mark.parametrize("scene", [getattr(one, "name", one) for one in SCENES])
def test_forces_before_the_first_step_are_those_after_a_very_short_one(scene: str) -> None:
    world, other = load_scene(scene), load_scene(scene)
    world.synchronise()
    before = [column.copy() for column in motion_of(world)]
    shown = net_forces(world)
    assert world.steps == 0
    assert all(np.array_equal(*pair) for pair in zip(before, motion_of(world), strict=True))
    other.step(1e-4 * other.simulation.dt)
    assert other.forces_known
    after = net_forces(other)
    size = max(float(np.abs(applied_forces(world)).max()), float(np.abs(after).max()))
    assert np.abs(shown - after).max() <= 1e-4 * size  # in 1.7 us the strings of the cradle stretch by 3e-5


def test_of_a_pendulum_at_rest_the_part_across_the_rod_is_left() -> None:
    world = load_scene("pendulum")
    joint = joint_states(world)[0]
    body = joint.b or joint.a
    net, rod = net_force(forces_on(world, body)), joint.force
    assert rod.magnitude > 1.0
    assert abs(net.dot(rod)) < 1e-6 * rod.magnitude * net.magnitude
    reading = Reading(world)
    assert (reading.value("force x", body), reading.value("force y", body)) == tuple(net)


def test_an_edit_is_seen_in_the_forces_at_once() -> None:
    world = load_scene("pendulum")
    world.run(seconds=0.5)
    joint = joint_states(world)[0]
    before = joint.force
    world.edited()
    assert not world.forces_known
    now = next(one for one in joint_states(world) if one.entity == joint.entity)
    assert tuple(now.force) == pytest.approx(tuple(before), rel=1e-5)
