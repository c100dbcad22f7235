"""Motors of any strength against what other joints hold: they are blocked, and nothing comes apart."""

from typing import Any

import numpy as np
import pytest

from physicslab import World, load_scene
from physicslab.components import Transform, Velocity
from physicslab.diagnostics.energy import Audit
from physicslab.diagnostics.warnings import find_warnings

BAR = {"kind": "box", "width": 1.0, "height": 0.2}
A: dict[str, Any] = {"id": "a", "Transform": {}, "Velocity": {}, "Mass": {}, "Shape": BAR}
B: dict[str, Any] = {**A, "id": "b", "Transform": {"position": [1.2, 0.0]}}
BYSTANDER = {**A, "id": "stone", "Transform": {"position": [0.0, 5.0]}}
"""What could touch, so that contacts are reckoned with."""


def pin(number: int, y: float, **also: Any) -> dict[str, Any]:
    joint = {"a": "a", "b": "b", "anchor_a": [0.6, y], "anchor_b": [-0.6, y], **also}
    return {"id": f"pin{number}", "Pin": joint}


WELD = {"id": "weld", "Weld": {"b": "a", "anchor_a": [0.0, 0.0]}}
AT = {"anchor_a": [0.3, 0.0], "anchor_b": [0.3, 0.0]}
DRIVEN = {"id": "drive", "Pin": {"b": "a", **AT, "motor_speed": 3.0}}
BLOCKED = {
    "weld": [A, WELD, DRIVEN],
    "driven first": [A, DRIVEN, WELD],
    "two pins": [A, B, pin(1, 0.1, motor_speed=3.0), pin(2, -0.1)],
    "two motors": [A, B, pin(1, 0.1, motor_speed=3.0), pin(2, -0.1, motor_speed=-2.0)],
    "gear": [
        A, B, pin(1, 0.1, motor_speed=3.0), pin(2, -0.1),
        {"id": "gear", "Gear": {"first": "pin1", "second": "pin2", "ratio": -3.0}},
    ],
}  # fmt: skip


def made(entities: list[dict[str, Any]], contacts: str) -> World:
    return load_scene(
        {
            "format": "physicslab-scene/1",
            "physics": {"gravity": [0.0, 0.0]},
            "simulation": {"contacts": contacts},
            "entities": entities,
        }
    )


@pytest.mark.parametrize("contacts", ["auto", "rigid", "soft"])
@pytest.mark.parametrize("name", BLOCKED)
def test_a_motor_gives_way_to_what_joints_hold(name: str, contacts: str) -> None:
    world = made([*BLOCKED[name], *[BYSTANDER] * (contacts != "auto")], contacts)
    audit, before = Audit(world), world.table(Transform)["position"].copy()
    world.run(steps=60)
    audit.sample(world)
    assert np.abs(world.table(Transform)["position"] - before).max() < 1e-12
    assert np.abs(world.table(Velocity)["angular"]).max() < 1e-12
    assert abs(audit.account.energy["motors"]) < 1e-9


GEARED = [
    A, B, {"id": "one", "Pin": {"b": "a", "anchor_a": [0.0, 0.0], "motor_speed": 3.0}},
    {"id": "two", "Pin": {"b": "b", "anchor_a": [1.2, 0.0], "motor_speed": 3.0}},
    {"id": "gear", "Gear": {"first": "one", "second": "two", "ratio": -2.0}},
]  # fmt: skip


@pytest.mark.parametrize("contacts", ["auto", "soft"])
@pytest.mark.parametrize(("joined", "motors"), [(GEARED, ["one", "two"]), (BLOCKED["weld"], ["drive"])])
def test_a_motor_that_does_nothing_is_told(
    joined: list[dict[str, Any]], motors: list[str], contacts: str
) -> None:
    """Also where the rest of its joint is held twice."""
    world = made([*joined, *[BYSTANDER] * (contacts != "auto")], contacts)
    world.run(steps=20)
    told = [one.entity for one in find_warnings(world) if "a motor that does nothing" in str(one.what)]
    assert len(told) == 1
    assert told[0] in motors


def test_the_angle_of_what_cannot_turn_is_not_held_twice() -> None:
    point: dict[str, Any] = {"id": "point", "Transform": {}, "Velocity": {}, "Mass": {}}
    world = made([point, {"Slot": {"b": "point", "axis": [0.0, 1.0]}}], "auto")
    world.run(steps=2)
    assert not list(find_warnings(world))
