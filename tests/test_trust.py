"""How many digits can be relied on, beside how many are right."""

import json
import math
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from desk import empty_world

from physicslab.cli import main
from physicslab.components import Mass, Transform, Velocity
from physicslab.files.scene import load_scene, write_scene
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.lab.accuracy.estimate import Estimate, estimate_error
from physicslab.lab.accuracy.trust import Trust, TrustRow, _nudged, assess, assess_problem
from physicslab.prefabs import box, circle
from physicslab.world import World


def trust(load: Callable[[], World], seconds: float) -> Trust:
    *shares, found = assess(load, seconds)
    assert all(0.0 <= share <= 1.0 for share in shares if isinstance(share, float))
    assert isinstance(found, Trust)
    return found


def row(name: str) -> TrustRow:
    *_, found = assess_problem(PROBLEMS[name])
    assert isinstance(found, TrustRow)
    return found


def test_free_flight_is_right_to_rounding() -> None:
    def load() -> World:
        world = empty_world()
        circle(world, (0.0, 3.0), velocity=(1.0, 2.0))
        return world

    found = trust(load, 2.0)
    assert found.digits > 14.5 and found.horizon_s is None
    assert found.entities == {found.worst: found.digits}


def test_digits_of_a_pendulum_are_those_by_which_it_is_right() -> None:
    load = partial(load_scene, "pendulum")
    found = trust(load, 5.0)
    tight, world = load(), load()
    tight.simulation = tight.simulation.__class__(integrator="dop853", tolerance=1e-18)
    for one in (tight, world):
        one.run(seconds=5.0)
    bob = world.entity("bob")
    places = [one.component(bob, Transform).position for one in (world, tight)]
    right = -math.log10((places[0] - places[1]).magnitude / places[1].magnitude)
    assert found.digits == pytest.approx(right, abs=1.0)


def test_a_gas_has_a_horizon_and_no_digits_after_it() -> None:
    def load() -> World:
        world = empty_world(gravity=(0, 0), bounds=(-2, -2, 2, 2), bounds_restitution=1.0)
        for n in range(36):
            at = (-1.5 + 0.6 * (n % 6), -1.5 + 0.6 * (n // 6))
            circle(world, at, radius=0.15, restitution=1.0, velocity=(math.sin(7.0 * n), math.cos(5.0 * n)))
        return world

    found = trust(load, 30.0)
    assert found.horizon_s is not None and 2.0 < found.horizon_s < 30.0
    assert found.digits < 1.0


def test_what_does_not_move_has_no_digits() -> None:
    def load() -> World:
        world = empty_world()
        box(world, (0.0, 0.0), static=True)
        return world

    found = trust(load, 1.0)
    assert math.isnan(found.digits) and found.failure == "nothing moves" and found.entities == {}


def test_the_same_scene_is_trusted_alike_every_time() -> None:
    first, second = (trust(partial(load_scene, "newtons_cradle"), 1.0) for _ in range(2))
    assert first == second


def test_a_scene_with_a_body_that_keeps_its_angle_has_an_estimate() -> None:
    def load() -> World:
        world = empty_world()
        ball = circle(world, (0.0, 3.0))
        world.component(ball, Mass).fixed_rotation = True
        return world

    *_, found = estimate_error(load, 0.5)
    assert isinstance(found, Estimate) and "nudged" in found.distances


def test_zeros_are_not_nudged_and_all_else_is_by_one_rounding() -> None:
    world = empty_world()
    ball = circle(world, (0.0, 3.0), velocity=(2.0, 0.0))
    twin = _nudged(write_scene(world), 1)
    (entity,) = twin["entities"]
    (x, y), (vx, vy) = entity["Transform"]["position"], entity["Velocity"]["linear"]
    assert x == vy == 0.0
    assert abs(y - 3.0) == math.ulp(2.0) or abs(y - 3.0) == math.ulp(3.0)
    assert vx in (math.nextafter(2.0, math.inf), math.nextafter(2.0, -math.inf))
    assert world.component(ball, Velocity).linear.x == 2.0


@pytest.mark.parametrize("name", ["free_fall", "kepler_e0.5", "figure_eight", "bounce", "friction_slide"])
def test_the_true_error_is_within_a_factor_of_ten_of_the_estimate(name: str) -> None:
    ratio = row(name).ratio
    assert ratio is not None and 0.1 <= ratio <= 10.0


@pytest.mark.slow
def test_estimates_of_all_problems_are_as_good_as_they_are_said_to_be() -> None:
    ratios = [row(name).ratio for name, problem in PROBLEMS.items() if problem.search is None]
    known = [ratio for ratio in ratios if ratio is not None]
    assert len(known) == len(ratios)
    assert sum(0.1 <= ratio <= 10.0 for ratio in known) >= 0.95 * len(known)
    assert max(known) <= 100.0


def test_run_writes_what_can_be_relied_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "run.json"
    assert main(["run", "drop", "--seconds", "1", "--trust", "--json", str(path)]) == 0
    report = json.loads(path.read_text("utf-8"))
    assert set(report["trust"]) >= {"digits", "horizon_s", "entities"}
    assert report["trust"]["entities"].keys() == {"ball"} and report["trust"]["digits"] > 10.0
    assert "trust       " in capsys.readouterr().out
    assert main(["run", "drop", "--seconds", "1", "--json", str(path)]) == 0
    assert "trust" not in json.loads(path.read_text("utf-8"))


def test_trust_in_a_run_that_was_changed_is_in_the_changed_run(capsys: pytest.CaptureFixture[str]) -> None:
    digits = {}
    for substeps in ("1", "16"):
        arguments = ["run", "pendulum", "--seconds", "2", "--integrator", "leapfrog", "--substeps", substeps]
        assert main([*arguments, "--trust", "--json", "-"]) == 0
        digits[substeps] = json.loads(capsys.readouterr().out)["trust"]["digits"]
    assert digits["16"] - digits["1"] == pytest.approx(2.0 * math.log10(16.0), abs=0.5)


def test_accuracy_writes_estimates_beside_true_errors(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "trust.json"
    assert main(["accuracy", "free_fall", "kepler_e0.5", "--trust", "--json", str(path)]) == 0
    report = json.loads(path.read_text("utf-8"))
    assert [problem["name"] for problem in report["problems"]] == ["free_fall", "kepler_e0.5"]
    assert all(0.1 <= problem["ratio"] <= 10.0 for problem in report["problems"])
    assert "within a factor of 10: 2 of 2 (100%)" in capsys.readouterr().out
