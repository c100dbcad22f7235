"""Estimates of errors beside what is known of random scenes, and of scenes in which they were not honest."""

import json
import math
from pathlib import Path
from random import Random

import numpy as np
import pytest

from physicslab.cli import main
from physicslab.components import Transform, Velocity
from physicslab.files.reader import read_scene
from physicslab.lab.accuracy import estimate
from physicslab.lab.accuracy.honesty.extrapolation import moved
from physicslab.lab.accuracy.honesty.scene import body, still, written
from physicslab.lab.accuracy.honesty.study import FAMILIES, HonestRow, assess_known, share_of
from physicslab.lab.accuracy.tables import honest_text
from physicslab.lab.accuracy.trust import Trust, assess
from physicslab.lab.accuracy.variants import VARIANTS, Document
from physicslab.lab.jobs import result_of
from physicslab.world import World


def trusted(document: Document, seconds: float) -> tuple[Trust, World]:
    """Return what is claimed of a scene, and the scene at its end."""
    found = result_of(assess(lambda: read_scene(document), seconds))
    world = read_scene(document)
    world.run(seconds=seconds)
    assert not found.failure
    return found, world


def place(world: World, name: str) -> np.ndarray:
    return np.array(tuple(world.component(world.entity(name), Transform).position))


def drawn(family: str, seed: int) -> HonestRow:
    row = result_of(assess_known(family, seed))
    assert not row.failure
    return row


@pytest.mark.parametrize(
    ("family", "seed"),
    [("springs", 2), ("flybys", 8), ("edges", 1), ("belts", 5), ("falls", 0), ("falls", 17), ("stacks", 2)],
)
def test_the_estimate_of_a_random_scene_is_honest(family: str, seed: int) -> None:
    row = drawn(family, seed)
    assert max(row.ratios) <= 3.0 and not row.too_large


@pytest.mark.slow
def test_estimates_of_random_scenes_are_honest_in_99_of_100(pytestconfig: pytest.Config) -> None:
    seeds = round(20 * pytestconfig.getoption("effort"))
    rows = [drawn(family, seed) for family in FAMILIES for seed in range(seeds)]
    found = share_of(rows)
    print(honest_text(rows))
    assert found.known == len(rows) and found.holds
    assert min(found.honest) >= 0.98 * found.known and found.too_large <= 0.02 * found.known


def swing(stiffness: float) -> Document:
    spring = {"a": "b", "anchor_b": [0.0, 0.0], "rest_length": 1.0, "stiffness": stiffness}
    return written([body("b", (1.0, 0.0), velocity=(0.0, 7.5)), {"id": "s", "Spring": spring}], 1 / 60)


@pytest.mark.parametrize("stiffness", [1e3, 1e4])
def test_a_variant_of_half_the_step_has_half_the_inner_step(stiffness: float) -> None:
    """``auto`` makes steps of blanes_moan by omega h: in half the step it would make the same."""
    document = swing(stiffness)
    found, world = trusted(document, 2.0)
    (true,) = moved(document, 2.0)
    off = np.hypot(*(place(world, "b") - true[:2])) / np.hypot(*true[:2])
    assert off > 1e-12, "an error of the method, and not of rounding"
    assert 10.0**-found.digits == pytest.approx(off, rel=9.0) and 10.0**-found.digits > off / 3.0
    world = read_scene(document)
    world.synchronise()
    half = next(variant for variant in VARIANTS if variant.name == "half step").make(document, world)
    assert half is not None and half.plan.integrator is world.plan.integrator
    assert half.plan.substeps == world.plan.substeps and half.simulation.dt == 0.5 * world.simulation.dt


@pytest.mark.parametrize(
    ("size", "gravity", "dt"), [(1.0, 1000.0, 0.1), (0.1, 9.81, 1.0), (1e-5, 9.81, 1 / 60)]
)
def test_what_falls_through_a_floor_is_not_claimed_to_be_right(
    size: float, gravity: float, dt: float
) -> None:
    floor, at = still("floor", (0.0, -0.5 * size), (100.0 * size, size)), (0.0, 0.5 * size)
    for thing in (body("d", at, size=(size, size)), body("d", at, radius=0.5 * size)):
        document = written([floor, thing], dt, {"gravity": [0.0, -gravity]})
        found, world = trusted(document, 5.0 * dt)
        off = abs(place(world, "d")[1] / size - 0.5)
        assert 10.0**-found.digits >= min(off, 1.0) / 3.0


def test_digits_of_velocities_are_those_by_which_they_are_right() -> None:
    document = swing(100.0)
    document["simulation"] |= {"integrator": "leapfrog"}
    found, world = trusted(document, 2.0)
    (true,) = moved(document, 2.0)
    velocity = world.component(world.entity("b"), Velocity).linear
    off = math.dist(velocity, true[3:5]) / np.hypot(*true[3:5])
    assert found.velocities["b"] == pytest.approx(-math.log10(off), abs=1.0)
    assert found.angles == found.spins == {"b": pytest.approx(15.05, abs=0.1)}


def test_another_method_agrees_with_the_closed_form() -> None:
    spring = {"a": "b", "anchor_b": [0.0, 0.0], "rest_length": 0.0, "stiffness": 4.0, "damping": 0.0}
    document = written(
        [body("b", (1.0, 0.0)), {"id": "s", "Spring": spring}], 1 / 60, {"gravity_mode": "none"}
    )
    (found,) = moved(document, 0.7)
    assert found[0] == pytest.approx(math.cos(1.4), abs=1e-16)
    assert found[3] == pytest.approx(-2.0 * math.sin(1.4), abs=1e-15)


def test_ways_that_take_too_long_are_left_out_and_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(estimate, "_RUNS_AT_LEAST", 0.0)
    found = result_of(assess(lambda: read_scene(swing(100.0)), 1.0, budget_s=0.0))
    assert "ends in time" in found.failure
    assert any(words.startswith("half step: given up after 0 s, at t = ") for words in found.left_out)
    assert any(words.startswith("6 of 6 starts moved") for words in found.left_out)


def test_a_share_is_honest_up_to_three_and_counts_what_is_far_too_large() -> None:
    rows = [HonestRow("falls", n, (ratio, 0.1, 0.1, 5.0)) for n, ratio in enumerate([1.0] * 99 + [3.1])]
    found = share_of([*rows, HonestRow("falls", 100, failure="it fell over")])
    assert found.known == 100 and found.honest == [99, 100, 100, 0] and found.holds and found.worst == 3.1
    assert not share_of(rows[-99:]).holds
    table = honest_text(rows)
    assert "99 of 100 positions (99.0%)" in table and "wanted 99 of 100: met" in table


def advice(path: Path, capsys: pytest.CaptureFixture[str], document: Document, *options: str) -> str:
    path.write_text(json.dumps(document))
    assert main(["run", str(path), "--seconds", "1", "--json", "-", *options]) == 0
    return "; ".join(found["what"] for found in json.loads(capsys.readouterr().out)["advice"])


def test_advice_names_causes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "scene.json"
    assert "oscillates with omega h = 0.4" in advice(path, capsys, swing(1e4))
    assert "omega h" not in advice(path, capsys, swing(1e4), "--integrator", "dop853")
    loose = swing(1e4)
    loose["simulation"] |= {"integrator": "dop853", "tolerance": 1e-2}
    assert "simulation.tolerance = 0.01 lets each step be off" in advice(path, capsys, loose)
    floor, cube = still("floor", (0.0, -0.05), (10.0, 0.1)), body("cube", (0.0, 0.05), size=(0.1, 0.1))
    assert advice(path, capsys, written([floor, cube], 1 / 60)) == ""
    long = written([floor, body("cube", (0.0, 0.06), size=(0.1, 0.1))], 1.0)
    assert advice(path, capsys, long) == "", "it is held, though it falls 49 times its size in a step"
    soft = written([floor, cube], 1 / 60, contacts="soft")
    assert advice(path, capsys, soft) == "", "it was asked for"
    soft["simulation"] |= {"contacts": "auto", "collisions": "step"}
    assert advice(path, capsys, soft).count("contacts are soft") == 1
    leapfrog = swing(1e3)
    leapfrog["simulation"] |= {"integrator": "leapfrog"}
    assert "--trust): it changes with the length of the step" in advice(path, capsys, leapfrog, "--trust")


def test_every_family_has_scenes_that_can_be_read() -> None:
    for family, make in FAMILIES.items():
        known = make(Random(f"{family} 0"))
        world = read_scene(known.document)
        assert known.seconds > 0.0 and len(world.batch(Velocity)) >= 1
