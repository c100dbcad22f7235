"""Forces are packed again where something that they are made of was changed, and only there."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from desk import bits

from physicslab.components import Drag, Mass, Shape, Spring, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig
from physicslab.files.json_text import json_text
from physicslab.files.scene import read_scene, write_scene
from physicslab.state.packed import way_and_size
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.spring import SpringSystem
from physicslab.systems.standard import standard_systems
from physicslab.world import World


def linked() -> World:
    """Return a body with drag attached to an anchor of a fixed one, which is turned; nothing can touch."""
    world = World(*standard_systems(), physics=PhysicsConfig(linear_damping=0.1))
    world.spawn(Transform((0.0, 3.0), 0.3), name="fixed")
    bob = world.spawn(Transform((1.0, 0.0)), Velocity((0.2, 0.0)), Mass(2.0), Drag(0.1, 0.05), name="bob")
    ends: dict[str, Any] = {"a": bob, "b": world.entity("fixed"), "anchor_b": (0.5, 0.2)}
    world.spawn(Spring(rest_length=2.0, stiffness=40.0, damping=0.3, **ends), name="rope")
    return world


def kicked() -> World:
    """Return the same where bodies could touch, so that the forces of every row are packed, for kicks."""
    world = linked()
    world.simulation = replace(world.simulation, integrator="leapfrog", contacts="soft", collisions="step")
    for x in (-100.0, 100.0):
        world.spawn(Transform((x, 0.0)), Velocity(), Mass(1.0), Shape.circle(0.5))
    return world


def planets() -> World:
    """Return two planets and a fixed sun."""
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="planet", G=2.0))
    world.spawn(Transform((0.0, 0.0)), Mass(50.0), name="sun")
    world.spawn(Transform((3.0, 0.0)), Velocity((0.0, 5.0)), Mass(1.0), name="bob")
    world.spawn(Transform((0.0, -5.0)), Velocity((4.0, 0.0)), Mass(0.1))
    return world


def laws(**change: Any) -> Callable[[World], None]:
    def edit(world: World) -> None:
        world.physics = replace(world.physics, **change)

    return edit


def column(kind: type[Any], name: str, field: str, value: Any) -> Callable[[World], None]:
    def edit(world: World) -> None:
        setattr(world.component(world.entity(name), kind), field, value)

    return edit


@pytest.mark.parametrize(
    ("build", "edit"),
    [
        (linked, laws(linear_damping=0.4)),
        (linked, laws(gravity=(1.0, -3.0))),
        (linked, column(Transform, "fixed", "angle", 1.2)),
        (linked, column(Transform, "fixed", "position", (0.5, 2.0))),
        (linked, column(Spring, "rope", "anchor_b", (-0.5, 0.1))),
        (linked, column(Spring, "rope", "stiffness", 60.0)),
        (linked, column(Spring, "rope", "damping", 0.0)),
        (linked, column(Drag, "bob", "quadratic", 0.5)),
        (linked, column(Mass, "bob", "mass", 3.0)),
        (kicked, laws(gravity=(1.0, -3.0))),
        (kicked, column(Transform, "fixed", "angle", 1.2)),
        (kicked, column(Spring, "rope", "stiffness", 60.0)),
        (kicked, column(Drag, "bob", "quadratic", 0.5)),
        (kicked, column(Mass, "bob", "mass", 3.0)),
        (planets, column(Mass, "sun", "mass", 70.0)),
        (planets, column(Mass, "bob", "mass", 2.0)),
        (planets, column(Transform, "sun", "position", (0.1, 0.0))),
        (planets, laws(G=3.0)),
        (planets, laws(softening=0.5)),
    ],
)
def test_an_edit_between_steps_acts_as_in_a_world_that_begins_with_it(
    build: Callable[[], World], edit: Callable[[World], None]
) -> None:
    world = build()
    for _ in range(3):
        world.step()
    before = bits(world)
    edit(world)
    fresh = read_scene(json.loads(json_text(write_scene(world))))
    for _ in range(3):
        world.step()
        fresh.step()
    assert bits(world) == bits(fresh) != before


@pytest.mark.parametrize(
    ("build", "kind"), [(linked, SpringSystem), (kicked, SpringSystem), (planets, GravitySystem)]
)
def test_what_is_unchanged_is_not_packed_again(
    build: Callable[[], World], kind: type[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    world, packed, calls = build(), kind.packed, []

    def counted(self: Any, *arguments: Any) -> Any:
        calls.append(self)
        return packed(self, *arguments)

    world.run(steps=1)
    monkeypatch.setattr(kind, "packed", counted)
    for _ in range(5):
        world.step()
    assert not calls
    world.physics = replace(world.physics, linear_damping=0.2)
    world.step()
    assert len(calls) == 1


def test_an_angle_of_rounding_that_turns_is_no_move() -> None:
    assert way_and_size(np.array((3.0, 1.0, 8e-16)), np.array((3.0, 1.0, -1e-16))) == (0.0, 0.0)
    assert way_and_size(np.array((3.0, 1.0, 8e-16)), np.array((3.0, 1.5, -1e-16))) == (0.5, 1.0)
