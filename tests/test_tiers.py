"""Runs without a window: kernels are interpreted until compiling them costs less."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from physicslab import World
from physicslab.cli import main
from physicslab.components import Transform
from physicslab.files.scene import load_scene
from physicslab.kernels import cache, interpreter, motion, tiers
from physicslab.kernels.events.events import run_events
from physicslab.kernels.ode.classical import rk4
from physicslab.kernels.solver import soft
from physicslab.kernels.tiers import Tiers, compile_seconds
from physicslab.stepping.small import is_small

ROOT = Path(__file__).parent.parent


def run(*arguments: str, **environment: str) -> Any:
    """Return the document of a run in a process of its own."""
    done = subprocess.run(
        [sys.executable, "main.py", "run", *arguments, "--json", "-"],
        env={**os.environ, **environment}, capture_output=True, text=True, check=True, cwd=ROOT,
    )  # fmt: skip
    return json.loads(done.stdout)


def run_cold(folder: Path, *arguments: str) -> tuple[Any, set[str]]:
    """Return the document of a run with an empty cache, and the names of the kernels that it compiled."""
    kept = folder / "kernels"
    document = run(*arguments, PHYSICSLAB_KERNELS=str(kept))
    return document, {path.name.split(".")[1].split("-")[0] for path in kept.rglob("*.nbi")}


def same_results(one: Any, other: Any) -> bool:
    names = "time", "steps", "entities", "energy", "collisions", "force_evaluations"
    return all(one[name] == other[name] for name in names)


def test_one_ball_is_interpreted_with_the_bits_of_compiled_code(tmp_path: Path) -> None:
    interpreted, compiled = run_cold(tmp_path, "drop")
    assert not compiled
    assert interpreted["interpreted_steps"] == interpreted["steps"] == 600
    assert 0.0 < interpreted["interpreted_s"] < interpreted["wall_s"]
    load_scene("drop").run(seconds=10.0)  # kernels are there
    assert main(["run", "drop", "--json", str(tmp_path / "warm.json")]) == 0
    warm = json.loads((tmp_path / "warm.json").read_text())
    assert warm["interpreted_steps"] == 0 and warm["interpreted_s"] == 0.0
    assert same_results(warm, interpreted)


@pytest.mark.slow
def test_what_is_slow_is_compiled_after_its_first_part_and_ends_in_the_same_bits(tmp_path: Path) -> None:
    arguments = ("pendulum", "--seconds", "200")
    changing, compiled = run_cold(tmp_path, *arguments)
    assert "dop853" in compiled
    assert same_results(run(*arguments), changing)


def test_a_large_scene_is_compiled_at_once() -> None:
    assert is_small(load_scene("drop")) and not is_small(load_scene("pile"))
    with Tiers(False) as large:
        assert large.interpreted_s == 0.0
        assert interpreter._limit(motion.drift) == float("inf")


class Policy:
    """Tiers of which kernels have been interpreted for times that a test says."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.spent: dict[Any, float] = {}
        self.loaded: list[Any] = []
        monkeypatch.setattr(cache, "is_kept", lambda function: function is motion.kick.py_func)  # type: ignore[attr-defined]
        monkeypatch.setattr(interpreter, "spent_on", lambda jitted: self.spent.get(jitted, 0.0))
        monkeypatch.setattr(tiers, "load", self.load)
        self.tiers = Tiers(True)

    def load(self, jitted: Any) -> None:
        self.loaded.append(jitted)
        self.tiers._costs.pop(jitted)  # as if compiled

    def ask(self, *kernels: Any) -> list[Any]:
        return list(self.tiers._ask(kernels))


@pytest.fixture
def policy(monkeypatch: pytest.MonkeyPatch) -> Policy:
    made = Policy(monkeypatch)
    for jitted in (run_events, motion.drift, motion.kick, rk4):
        monkeypatch.setattr(jitted, "compiled", False)
    return made


def test_what_is_in_the_cache_is_not_interpreted(policy: Policy) -> None:
    assert policy.ask(motion.drift, motion.kick) == [motion.drift]


def test_a_kernel_may_be_interpreted_as_long_as_compiling_it_takes(policy: Policy) -> None:
    policy.ask(run_events)
    policy.tiers._compiled_any = True
    cost = compile_seconds(run_events)
    assert policy.tiers._seconds(run_events) < 0.1 * cost, "nothing is foreseen yet"
    policy.spent[run_events] = 0.01 * cost
    policy.tiers.foresee(0.1)
    assert not policy.loaded
    assert policy.tiers._seconds(run_events) == pytest.approx(0.99 * cost)
    policy.spent[run_events] = 1.01 * cost
    assert policy.tiers._seconds(run_events) < 0.0
    policy.tiers._compile_late(run_events)
    assert policy.loaded == [run_events]


def test_what_the_rest_of_a_run_would_take_longer_for_is_compiled(policy: Policy) -> None:
    policy.ask(run_events, motion.drift)
    policy.spent[run_events] = 0.06 * compile_seconds(run_events)
    policy.spent[motion.drift] = 0.04 * compile_seconds(motion.drift)
    policy.tiers.foresee(0.1)  # nine times as much is to come: less than compiling takes
    assert not policy.loaded
    policy.tiers.foresee(0.01)
    assert policy.loaded == [run_events]


def test_the_first_kernel_that_is_compiled_must_save_more(policy: Policy) -> None:
    policy.ask(motion.drift, run_events)
    policy.spent[motion.drift] = 1.1 * compile_seconds(motion.drift)
    policy.tiers.foresee(0.5)
    assert not policy.loaded
    policy.spent[run_events] = 2.0 * compile_seconds(run_events)
    policy.tiers.foresee(0.5)
    assert set(policy.loaded) == {motion.drift, run_events}


def test_forces_are_compiled_with_what_calls_them_by_address(policy: Policy) -> None:
    from physicslab.kernels.forces.packed_forces import springs

    policy.ask(rk4, motion.drift)
    policy.tiers._costs[springs] = 0.3
    policy.tiers._compile_late(rk4)
    assert policy.loaded == [rk4, springs]


def test_the_time_to_compile_is_estimated_from_all_that_a_kernel_calls() -> None:
    assert compile_seconds(motion.clear) < 0.1 < 1.0 < compile_seconds(run_events)
    assert compile_seconds(soft.advance) > compile_seconds(run_events)


def test_afterwards_kernels_are_compiled_where_they_are_called() -> None:
    overloads = dict(motion.drift.overloads)  # type: ignore[attr-defined]
    interpreter._set_aside(motion.drift)
    try:
        with Tiers(True) as small:
            small._costs[motion.drift] = 1.0
            interpreter.install(motion.drift)
            installed = motion.drift._compile_for_args  # type: ignore[attr-defined]
        assert motion.drift._compile_for_args is not installed  # type: ignore[attr-defined]
    finally:
        if overloads:
            interpreter._take_back(motion.drift, overloads)


_PROGRAM = """
import json
from physicslab import load_scene
from physicslab.components import Transform
from physicslab.kernels import KERNELS
world = load_scene("drop")
for seconds in (1.0, 0.5):
    world.run(seconds=seconds)
first = [one.__name__ for one in KERNELS if one.compiled]
world.step()
from physicslab.ensembles.runs import task_of
from physicslab.ensembles.task import Runner
free = {"id": "bob", "Transform": {}, "Velocity": {}, "Mass": {"mass": 1}}
scene = {"format": "physicslab-scene/1", "physics": {"gravity_mode": "none"}, "entities": [free]}
Runner(task_of(scene, {"bob.Mass.mass": [1.0]}, measure="bob.x", seconds=0.1)).block(0, 1)
print(json.dumps([world.component("ball", Transform).position.y, first,
                  [one.__name__ for one in KERNELS if one.compiled]]))
"""


def test_the_first_run_of_a_program_is_interpreted_and_says_so(tmp_path: Path) -> None:
    kernels = tmp_path / "kernels"
    environment = {**os.environ, "PHYSICSLAB_KERNELS": str(kernels)}
    del environment["PHYSICSLAB_INTERPRET"]
    done = subprocess.run(
        [sys.executable, "-c", _PROGRAM],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
        cwd=ROOT,
    )
    y, first, then = json.loads(done.stdout)
    assert done.stderr.count("\n") == 1 and "not compiled for this processor yet" in done.stderr
    assert "run_events" not in first and then, "an ensemble compiles before it makes rows"
    world = load_scene("drop")
    for seconds in (1.0, 0.5):
        world.run(seconds=seconds)
    world.step()
    assert world.component("ball", Transform).position.y == y


def test_a_large_scene_is_compiled_first_and_that_is_announced(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(tiers, "_compiles_first", False)
    monkeypatch.setattr(cache, "is_kept", lambda function: False)
    runs = tiers.begin_run(lambda: False)
    assert runs is not None
    try:
        assert list(runs._ask((soft.advance,))) == []
        assert re.fullmatch(r"compiling advance, once: about \d+ s", caplog.messages[-1])
        runs.is_small = lambda: True
        assert list(runs._ask((soft.advance,))) == [soft.advance]
        assert len(caplog.messages) == 2
        with Tiers(True):
            assert tiers.begin_run(lambda: True) is None, "a command decides"
    finally:
        tiers.compile_first()
    assert not runs.decides and tiers.begin_run(lambda: True) is None


def test_a_run_is_one_call_once_its_kernels_are_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tiers, "_compiles_first", False)
    world, calls = load_scene("stack"), list[int]()
    world.step()
    advance = World.advance

    def counted(world: World, h: float, steps: int) -> int:
        calls.append(steps)
        return advance(world, h, steps)

    monkeypatch.setattr(World, "advance", counted)
    runs = tiers.begin_run(lambda: True)
    assert runs is not None and runs.decides
    try:
        world.run(steps=20)
    finally:
        tiers.compile_first()
    assert calls == [20]
