"""Rows of an ensemble that a stepper makes one after the other, with nothing chosen in between."""

from typing import Any

import numpy as np
import pytest

from physicslab.diagnostics.impact_table import read_impacts
from physicslab.ensembles import rollout
from physicslab.ensembles.runs import task_of
from physicslab.ensembles.task import Runner

BALL: dict[str, Any] = {"Velocity": {}, "Mass": {}, "Shape": {"kind": "circle", "radius": 0.2}}
ORBIT: dict[str, Any] = {
    "format": "physicslab-scene/1",
    "physics": {"gravity_mode": "planet", "G": 1.0},
    "simulation": {"dt": 0.01},
    "entities": [
        {"id": "sun", "Transform": {}, "Velocity": {}, "Mass": {"mass": 1.0}},
        {"id": "earth", "Transform": {"position": [1, 0]}, "Velocity": {"linear": [0, 1]},
         "Mass": {"mass": 0.1}},
    ],
}  # fmt: skip
SPRING: dict[str, Any] = {
    "format": "physicslab-scene/1",
    "entities": [
        {"id": "bob", "Transform": {"position": [0.5, -1]}, "Velocity": {}, "Mass": {},
         "Drag": {"linear": 0.1}},
        {"Spring": {"a": "bob", "anchor_b": [0, 1], "rest_length": 1, "stiffness": 40}},
    ],
}  # fmt: skip
PENDULUM: dict[str, Any] = {
    "format": "physicslab-scene/1",
    "entities": [
        {"id": "upper", "Transform": {"position": [0.5, 0]}, "Velocity": {}, "Mass": {}},
        {"id": "lower", "Transform": {"position": [1.5, 0]}, "Velocity": {}, "Mass": {}},
        {"Rod": {"b": "upper", "anchor_a": [0, 0], "length": 0.5}},
        {"Rod": {"a": "upper", "b": "lower", "length": 1.0}},
    ],
}  # fmt: skip
BOX: dict[str, Any] = {
    "format": "physicslab-scene/1",
    "physics": {"gravity": [0, 0], "bounds": [-1, -1, 1, 1], "bounds_restitution": 1.0},
    "entities": [{"id": "ball", "Transform": {}, **BALL, "Material": {"restitution": 1.0, "friction": 0.3}}],
}  # fmt: skip
TWO: dict[str, Any] = BOX | {
    "entities": [*BOX["entities"], {"id": "other", "Transform": {"position": [0.6, 0.1]}, **BALL}]
}
BLOCK: dict[str, Any] = {
    "format": "physicslab-scene/1",
    "entities": [
        {"id": "floor", "Transform": {"position": [0, -2]}, "Shape": {"kind": "box", "width": 9, "height": 1},
         "Material": {"restitution": 0.5}},
        {"id": "ball", "Transform": {}, "Velocity": {}, "Mass": {"fixed_rotation": True},
         "Shape": {"kind": "box", "width": 1, "height": 1}, "Material": {"restitution": 0.5}},
    ],
}  # fmt: skip
E, M = "ball.Material.restitution", "ball.Mass.mass"
TOGETHER: dict[str, tuple[Any, dict[str, Any], float]] = {
    "drop": ("drop", {E: ("uniform", 0.2, 0.99), "ball.Velocity.linear.x": ("uniform", -3, 3)}, 1.0),
    "rest of a step": ("drop", {"ball.Transform.position.y": ("uniform", 0.3, 5)}, 0.7777),
    "masses": ("drop", {M: ("uniform", 0.5, 2), "ball.Velocity.angular": ("uniform", -9, 9)}, 1.5),
    "box": (BOX, {"ball.Velocity.linear.x": ("uniform", -9, 9), "ball.Velocity.angular": [0.0, 5.0]}, 2.3),
    "orbit": (ORBIT, {"earth.Velocity.linear.y": ("uniform", 0.3, 1.3)}, 7.0),
    "spring": (SPRING, {"bob.Transform.position.x": ("uniform", -2, 2)}, 3.01),
    "pendulum": (PENDULUM, {"lower.Velocity.linear.y": ("uniform", -5, 5)}, 1.0),
}
"""Scenes, what is varied in them and how long they run [s]: every run is calls of one stepper."""
PARTLY: dict[str, tuple[Any, dict[str, Any], float]] = {
    "a box that turns or not": (BLOCK, {"ball.Velocity.angular": [0.0, 2.0]}, 0.8),
    "some come to rest": ("drop", {E: ("uniform", 0.0, 0.9)}, 2.5),
    "two that may meet": (TWO, {"ball.Velocity.linear.x": ("uniform", 1, 3)}, 1.5),
    "one falls straight in": (ORBIT, {"earth.Velocity.linear.y": [0.0, 0.5, 1.0]}, 1.0),
    "a radius": ("drop", {"ball.Shape.radius": ("uniform", 0.1, 0.3)}, 1.0),
    "a law": ("drop", {"physics.gravity.y": ("uniform", -12, -3)}, 1.0),
}
"""The same where others are to make some or all of the runs."""


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many rows of each block were made together."""
    found: list[int] = []
    run = rollout.Rollout.run

    def counted(*arguments: Any) -> Any:
        ends, impacts, done = run(*arguments)
        found.append(int(np.count_nonzero(done)))
        return ends, impacts, done

    monkeypatch.setattr(rollout.Rollout, "run", counted)
    return found


@pytest.mark.parametrize("case", TOGETHER | PARTLY)
def test_rows_made_together_have_the_bits_of_fresh_worlds(case: str, made: list[int]) -> None:
    scene, space, seconds = (TOGETHER | PARTLY)[case]
    body = next(iter(space)).partition(".")[0] if "physics" not in str(space) else "ball"
    measure = {name: f"{body}.{name}" for name in rollout.MOTION} | {"sum": f"{body}.x + 2 {body}.y"}
    drawn = any(isinstance(values, tuple) for values in space.values())
    task = task_of(scene, space, samples=10 if drawn else None, seed=3, measure=measure, seconds=seconds)
    block = Runner(task).block(0, len(task.space))
    assert not block.failures
    if case in TOGETHER:
        assert made == [len(task.space)]
    else:
        assert sum(made) < len(task.space)
    for row, values in enumerate(block.values):
        world = task.world(row)
        world.run(seconds=seconds)
        columns = world.record(0.0).columns
        ends = [float(columns[f"{body}.{name}"][-1]) for name in rollout.MOTION]
        assert values.tolist() == [*ends, ends[0] + 2.0 * ends[1]], row


def test_a_block_goes_on_where_one_row_cannot_be(made: list[int]) -> None:
    space = {M: ("normal", 1, 1), "ball.Velocity.linear.x": ("uniform", 2, 4)}
    measure = {"y": "ball.y", "root": "(ball.x / 1 m)^0.5"}
    task = task_of("drop", space, samples=40, seed=8, measure=measure, seconds=1.0)
    block, columns = Runner(task).block(0, 40), task.space.columns(0, 40)
    refused = np.flatnonzero(columns[M] <= 0.0).tolist()
    assert refused and made == [40 - len(refused)]
    y, root = block.values.T
    assert np.flatnonzero(np.isnan(y)).tolist() == refused
    assert block.failures[refused[0]].startswith('space: entity "ball": Mass.mass = -')
    undefined = [row for row in np.flatnonzero(np.isnan(root)).tolist() if row not in refused]
    assert undefined and sorted(block.failures) == sorted(refused + undefined)
    assert "no real number" in block.failures[undefined[0]]


@pytest.mark.parametrize("case", ["drop", "rest of a step", "box", "some come to rest", "two that may meet"])
def test_impacts_of_rows_made_together_have_the_bits_of_fresh_worlds(case: str, made: list[int]) -> None:
    scene, space, seconds = (TOGETHER | PARTLY)[case]
    columns = ("time", "x", "speed", "energy_lost")
    ends = [f"{which}_impact.{name}" for which in ("first", "last") for name in columns]
    measure = {name: name for name in ("collisions", *ends)}
    task = task_of(scene, space, samples=12, seed=4, measure=measure, seconds=seconds)
    runner = Runner(task)
    block = runner.block(0, len(task.space))
    assert (made == [len(task.space)]) == (case in TOGETHER)
    for row, values in enumerate(block.values):
        world = task.world(row)
        world.run(seconds=seconds)
        found = world.contacts.impacts
        assert values[0] == world.collisions == len(found)
        if not len(found):
            assert np.isnan(values[1:]).all()
            continue
        speeds = -read_impacts(found).vn_before, read_impacts(found).energy_lost
        for k, number in ((0, 0), (1, -1)):
            true = [found["time"][number], found["x"][number], *(each[number] for each in speeds)]
            assert values[1 + 4 * k : 5 + 4 * k].tolist() == true, row


@pytest.mark.parametrize("measure", ["max(ball.y)", "account.impacts"])
def test_a_measure_of_more_than_the_end_is_made_row_by_row(measure: str, made: list[int]) -> None:
    task = task_of("drop", {E: [0.5, 0.9]}, measure={"it": measure, "y": "ball.y"}, seconds=1.2)
    block = Runner(task).block(0, 2)
    assert not made and not block.failures and np.isfinite(block.values).all()
