"""Configuration: frozen, checked, and refused by name."""

import math
from dataclasses import FrozenInstanceError, fields
from typing import Any

import numpy as np
import pytest

from physicslab.ecs.config import PhysicsConfig, SimulationConfig, WindowConfig, field_names
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.vector import Vector2


def test_defaults() -> None:
    physics, simulation = PhysicsConfig(), SimulationConfig()
    assert (physics.gravity_mode, physics.gravity, physics.bounds) == ("linear", Vector2(0, -9.81), None)
    assert (simulation.dt, simulation.substeps, simulation.integrator) == (1 / 60, 4, "auto")
    assert WindowConfig().size == (1280, 720)


def test_frozen_and_without_room_for_more() -> None:
    for config in (PhysicsConfig(), SimulationConfig(), WindowConfig()):
        with pytest.raises(FrozenInstanceError):
            setattr(config, fields(config)[0].name, 1)
        with pytest.raises((AttributeError, TypeError)):
            config.other = 1  # type: ignore[union-attr]


def test_values_are_stored_as_what_they_are_read_as() -> None:
    given: dict[str, Any] = {"gravity": [1, 2], "G": 2, "bounds": [0, 0, 4, 3]}
    physics = PhysicsConfig(**given)
    assert physics.gravity == Vector2(1, 2)
    assert type(physics.G) is float
    assert physics.bounds == (0.0, 0.0, 4.0, 3.0)
    substeps: Any = np.int64(8)
    assert type(SimulationConfig(substeps=substeps).substeps) is int


REFUSED: list[tuple[type[Any], str, Any, str]] = [
    (PhysicsConfig, "gravity_mode", "sideways", 'one of "linear", "planet", "none"'),
    (PhysicsConfig, "gravity", 5, "two finite numbers [x, y] m/s^2"),
    (PhysicsConfig, "gravity", (0, math.nan), "two finite numbers [x, y] m/s^2"),
    (PhysicsConfig, "G", None, "a finite number N m^2/kg^2"),
    (PhysicsConfig, "G", math.inf, "a finite number N m^2/kg^2"),
    (PhysicsConfig, "softening", -1, "a finite number >= 0 m"),
    (PhysicsConfig, "softening_law", "hard", 'one of "clamp", "plummer"'),
    (PhysicsConfig, "linear_damping", -0.1, "a finite number >= 0 1/s"),
    (PhysicsConfig, "bounds", [0, 0, 1], "null or four finite numbers [xmin, ymin, xmax, ymax] m"),
    (PhysicsConfig, "bounds", [0, 0, 0, 1], "with xmin < xmax and ymin < ymax"),
    (PhysicsConfig, "bounds", [0, 0, math.inf, 1], "null or four finite numbers"),
    (PhysicsConfig, "bounds", "wide", "null or four finite numbers"),
    (PhysicsConfig, "bounds", np.array(5.0), "null or four finite numbers"),
    (PhysicsConfig, "bounds_restitution", 1.1, "a finite number from 0 to 1"),
    (SimulationConfig, "dt", 0, "a finite number from 1e-100 to 1e+100 s"),
    (SimulationConfig, "dt", "fast", "a finite number from 1e-100 to 1e+100 s"),
    (SimulationConfig, "substeps", 0, "a whole number from 1 to 10000"),
    (SimulationConfig, "substeps", 2.0, "a whole number from 1 to 10000"),
    (SimulationConfig, "substeps", True, "a whole number from 1 to 10000"),
    (SimulationConfig, "iterations", 0, "a whole number from 1 to 1000 or null"),
    (SimulationConfig, "integrator", "rk5", '"leapfrog"'),
    (SimulationConfig, "sleeping", 1, '"auto", true or false'),
    (SimulationConfig, "collisions", "some", 'one of "auto", "step", "exact"'),
]


@pytest.mark.parametrize(("config", "name", "value", "allowed"), REFUSED)
def test_a_bad_value_is_refused_by_name(config: type[Any], name: str, value: Any, allowed: str) -> None:
    with pytest.raises(InvalidValue) as refused:
        config(**{name: value})
    assert str(refused.value).startswith(f"{config.section}.{name} = {value!r}: must be ")
    assert allowed in refused.value.allowed


@pytest.mark.parametrize("config", [PhysicsConfig, SimulationConfig])
def test_every_field_is_described(config: Any) -> None:
    described = {spec.name for spec in config.FIELDS}
    assert described == set(field_names(config))
    assert all(spec.meaning for spec in config.FIELDS)
