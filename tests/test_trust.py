"""How many digits can be relied on, beside how many are right."""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from desk import empty_world

from physicslab.cli import main
from physicslab.components import Mass, Pin, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene, write_scene
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.lab.accuracy.contacts.catalogue import CONTACTS
from physicslab.lab.accuracy.contacts.study import OWN, ContactEngine
from physicslab.lab.accuracy.estimate import estimate_error
from physicslab.lab.accuracy.paths import find_horizon
from physicslab.lab.accuracy.trust import (
    Trust,
    TrustRow,
    assess,
    assess_contacts,
    assess_problem,
    moments_of,
    summarise,
)
from physicslab.lab.accuracy.variants import nudged, with_ids
from physicslab.lab.jobs import result_of
from physicslab.prefabs import box, circle
from physicslab.world import World


def trust(load: Callable[[], World], seconds: float) -> Trust:
    shares: list[float] = []
    found = result_of(assess(load, seconds), shares.append)
    assert all(0.0 <= share <= 1.0 for share in shares)
    return found


def row(name: str) -> TrustRow:
    return result_of(assess_problem(PROBLEMS[name]))


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


def test_a_slot_along_x_is_mirrored_with_its_limits() -> None:
    box: dict[str, object] = {"id": "box", "Transform": {}, "Velocity": {"linear": [10.0, 0.0]}, "Mass": {}}
    slot = {"Slot": {"b": "box", "upper": 5.0, "turns": True}}
    scene = {
        "format": "physicslab-scene/1", "physics": {"gravity": [0.0, 0.0]}, "entities": [box, slot]
    }  # fmt: skip
    found = trust(partial(load_scene, scene), 1.0)
    assert "mirrored" in found.ways
    assert found.digits > 13.0


def dropped(length: float, seconds: float) -> Vector2:
    """Return where a pendulum is that was let go level, over its length (Abramowitz and Stegun 16.4)."""
    means, halves = [(1.0, math.sqrt(0.5))], [math.sqrt(0.5)]
    while abs(halves[-1]) > 1e-15:
        a, b = means[-1]
        means.append((0.5 * (a + b), math.sqrt(a * b)))
        halves.append(0.5 * (a - b))
    phase = 2.0 ** (len(means) - 1) * means[-1][0] * math.sqrt(9.81 / length) * seconds
    for (a, _), c in zip(means[:0:-1], halves[:0:-1], strict=True):
        phase = 0.5 * (phase + math.asin(c / a * math.sin(phase)))
    sine = math.sin(phase)
    half = math.asin(math.sqrt(0.5) * math.cos(phase) / math.sqrt(1.0 - 0.5 * sine * sine))
    return Vector2(math.sin(2.0 * half), -math.cos(2.0 * half))


def test_digits_of_a_lone_point_are_of_the_rod_that_holds_it() -> None:
    length, seconds = 1e-6, 0.1  # 50 swings, 8 of them a step
    point = {"id": "bob", "Transform": {"position": [length, 0.0]}, "Velocity": {}, "Mass": {}}
    load = partial(load_scene, {"format": "physicslab-scene/1", "entities": [point, {"Rod": {"b": "bob"}}]})
    world = load()
    world.run(seconds=seconds)
    place = world.component(world.entity("bob"), Transform).position
    error = (place * (1.0 / length) - dropped(length, seconds)).magnitude
    assert 1e-13 < error < 10.0 * 10.0 ** -trust(load, seconds).digits


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

    assert "nudged" in result_of(estimate_error(load, 0.5)).paths


def test_zeros_are_not_nudged_and_all_else_is_by_one_rounding() -> None:
    world = empty_world()
    ball = circle(world, (0.0, 3.0), velocity=(2.0, 0.0))
    variant = nudged(write_scene(world), 1)
    (entity,) = variant["entities"]
    (x, y), (vx, vy) = entity["Transform"]["position"], entity["Velocity"]["linear"]
    assert x == vy == 0.0
    assert abs(y - 3.0) == math.ulp(2.0) or abs(y - 3.0) == math.ulp(3.0)
    assert vx in (math.nextafter(2.0, math.inf), math.nextafter(2.0, -math.inf))
    assert world.component(ball, Velocity).linear.x == 2.0


@pytest.mark.parametrize("name", ["free_fall", "kepler_e0.5", "figure_eight", "bounce", "friction_slide"])
def test_the_true_error_is_within_a_factor_of_ten_of_the_estimate(name: str) -> None:
    assert row(name).near


@pytest.mark.parametrize("contacts", OWN, ids=lambda engine: engine.name)
@pytest.mark.parametrize("name", ["slide_spring", "roll_hill", "seam_box", "corner_roll"])
def test_the_true_error_of_contacts_is_within_a_factor_of_ten_of_the_estimate(
    name: str, contacts: ContactEngine
) -> None:
    """The error of ``slide_spring`` does not fall with the tolerance, as that of a method of order 8 does."""
    assert result_of(assess_contacts(CONTACTS[name], contacts)).near


@pytest.mark.slow
def test_estimates_of_all_that_is_known_are_as_good_as_they_are_said_to_be(
    pytestconfig: pytest.Config,
) -> None:
    every = 1 if pytestconfig.getoption("effort") >= 1.0 else 3
    known = [name for name, problem in PROBLEMS.items() if problem.search is None][::every]
    touching = [(case, engine) for case in CONTACTS.values() for engine in OWN][::every]
    rows = [*map(row, known), *(result_of(assess_contacts(*both)) for both in touching)]
    found = summarise(rows)
    assert found.known == len(rows) > 100 // every and found.holds
    assert found.near >= 0.95 * found.known and found.largest <= 100.0


def test_a_summary_does_not_hold_where_an_estimate_is_far_too_good_or_many_are_not_near() -> None:
    def of(*ratios: float) -> bool:
        return summarise([TrustRow(PROBLEMS["free_fall"], "", 1e-6, 1e-6 * ratio) for ratio in ratios]).holds

    assert of(*[1.0] * 19, 99.0) and not of(*[1.0] * 19, 101.0)
    assert not of(*[1.0] * 18, 99.0) and not of(*[1.0] * 18, 0.01) and of(*[1.0] * 19, 1e-9)


@pytest.mark.parametrize("integrator, substeps", [("leapfrog", 1), ("leapfrog", 16), ("rk4", 2)])
def test_digits_of_the_energy_are_those_by_which_it_is_kept(integrator: str, substeps: int) -> None:
    """Nothing takes energy from a pendulum: all that its energy changes is an error."""

    def load() -> World:
        world = load_scene("pendulum")
        world.simulation = replace(world.simulation, integrator=integrator, substeps=substeps)
        return world

    found, world = trust(load, 2.0), load()
    start = measure_energy(world)
    world.run(seconds=2.0)
    end = measure_energy(world)
    scale = max(abs(end.total), end.kinetic, *map(abs, end.potential.values()))
    assert found.energy == pytest.approx(-math.log10(abs(end.total - start.total) / scale), abs=1.0)


def test_energy_that_friction_has_taken_is_a_share_of_what_there_was() -> None:
    """A disc that has come to rest has no energy left; what error is left is that of what it had."""

    def load() -> World:
        return CONTACTS["roll_groove"].build(SimulationConfig(contacts="soft"))

    assert trust(load, 2.0).energy > 4.0


def test_momentum_has_all_digits_where_it_is_kept_and_positions_have_none() -> None:
    """Two bodies on a spring whose steps are far too long for it: where they are is lost, momentum is not."""

    def load() -> World:
        world = empty_world(gravity_mode="none")
        one, other = circle(world, (-1.0, 0.0), velocity=(0.1, 0.3)), circle(world, (1.0, 0.0))
        world.spawn(Spring(one, other, rest_length=1.0, stiffness=200.0))
        world.simulation = SimulationConfig(integrator="leapfrog", substeps=1)
        return world

    found = trust(load, 20.0)
    assert found.digits < 2.0 and found.momentum > 12.0


def test_what_only_turns_has_all_digits_of_its_momentum() -> None:
    """A wheel on a brake: roundings move its centre by 1e-17 m, and that is no error of a momentum of 0."""

    def load() -> World:
        world = empty_world()
        wheel = circle(world, (0.3, 0.1), radius=0.5, mass=2.0, name="wheel")
        world.component(wheel, Velocity).angular = 8.0
        world.spawn(Pin(b="wheel", anchor_a=(0.3, 0.1), motor_speed=0.0, max_torque=1.5))
        return world

    found = trust(load, 1.0)
    assert found.digits > 14.0 and found.momentum > 14.0 and found.angular_momentum > 14.0


def test_digits_until_earlier_moments_are_more_and_the_last_are_those_of_the_end() -> None:
    load = partial(load_scene, "pendulum")
    moments = moments_of(4.0, load().simulation.dt, 8)
    assert moments == pytest.approx([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5], abs=0.01)
    found = result_of(assess(load, 4.0, moments))
    assert [look.seconds for look in found.looks] == [*moments, 4.0]
    digits = [look.digits for look in found.looks]
    assert digits == sorted(digits, reverse=True) and digits[-1] <= found.digits
    plain = trust(load, 4.0)
    assert plain.digits == pytest.approx(found.digits, abs=0.5) and plain.looks == []


def double_pendulum() -> World:
    """Return two bobs on stiff springs, let go from the horizontal: they turn over, chaotically."""
    world = empty_world(gravity=(0.0, -9.81))
    upper, lower = circle(world, (1.0, 0.0), radius=0.1), circle(world, (2.0, 0.0), radius=0.1)
    world.spawn(Spring(upper, anchor_b=(0.0, 0.0), rest_length=1.0, stiffness=2000.0))
    world.spawn(Spring(upper, lower, rest_length=1.0, stiffness=2000.0))
    return world


def test_the_horizon_is_when_one_rounding_has_grown_to_another_future() -> None:
    document = with_ids(write_scene(double_pendulum()))
    bodies = [entity["id"] for entity in document["entities"] if "Velocity" in entity]
    shares: list[float] = []
    found = result_of(find_horizon(document, bodies, 60.0), shares.append)
    assert all(0.0 <= share <= 1.0 for share in shares)
    world, variant = double_pendulum(), double_pendulum()
    for one in (world, variant):
        one.synchronise()
    places = world.table(Transform)["position"], variant.table(Transform)["position"]
    places[1][2, 0] = math.nextafter(2.0, 3.0)
    beside = variant.stepping(seconds=60.0, stride=1)
    for _ in world.stepping(seconds=60.0, stride=1):
        next(beside, None)
        if np.abs(places[0] - places[1]).max() > 0.1 * 0.1:
            break
    assert found == pytest.approx(world.time, rel=0.3)


def test_run_writes_what_can_be_relied_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "run.json"
    assert main(["run", "drop", "--seconds", "1", "--trust", "--json", str(path)]) == 0
    report = json.loads(path.read_text("utf-8"))
    assert set(report["trust"]) >= {"digits", "energy", "horizon_s", "entities"}
    assert report["trust"]["entities"].keys() == {"ball"} and report["trust"]["digits"] > 10.0
    assert report["trust"]["energy"] > 10.0
    (line,) = [line for line in capsys.readouterr().out.splitlines() if line.startswith("  trust ")]
    assert f"{report['trust']['energy']:.1f} of the energy" in line
    assert main(["run", "drop", "--seconds", "1", "--json", str(path)]) == 0
    assert "trust" not in json.loads(path.read_text("utf-8"))


def test_trust_in_a_run_that_was_changed_is_in_the_changed_run(capsys: pytest.CaptureFixture[str]) -> None:
    digits = {}
    for substeps in ("1", "16"):
        words = f"run two_planets --seconds 2 --integrator leapfrog --substeps {substeps}"
        assert main([*words.split(), "--trust", "--json", "-"]) == 0
        digits[substeps] = json.loads(capsys.readouterr().out)["trust"]["digits"]
    assert digits["16"] - digits["1"] == pytest.approx(2.0 * math.log10(16.0), abs=0.5)


def test_accuracy_writes_estimates_beside_true_errors(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "trust.json"
    assert main(["accuracy", "free_fall", "kepler_e0.5", "slide_stop", "--trust", "--json", str(path)]) == 0
    report = json.loads(path.read_text("utf-8"))
    rows = [(problem["name"], problem["method"]) for problem in report["problems"]]
    assert rows[:2] == [("free_fall", "exact"), ("kepler_e0.5", "exact")]
    assert rows[2:] == [("slide_stop", "rigid contacts"), ("slide_stop", "soft contacts")]
    assert all(problem["near"] for problem in report["problems"])
    assert report["summary"] | {"largest": 0.0} == {"known": 4, "near": 4, "largest": 0.0, "holds": True}
    assert "within a factor of 10: 4 of 4 (100%)" in capsys.readouterr().out


def test_accuracy_writes_how_the_digits_of_a_scene_become_fewer(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "trust.json"
    arguments = ["accuracy", "two_planets", "--trust", "--seconds", "3", "--json", str(path)]
    assert main(arguments) == 0
    (scene,) = json.loads(path.read_text("utf-8"))["scenes"]
    assert scene["name"] == "two_planets" and scene["horizon_s"] is None
    assert [look["seconds"] for look in scene["looks"]][-1] == 3.0 and len(scene["looks"]) == 24
    assert all(len(look["bodies"]) == 2 for look in scene["looks"])
    assert "no rounding was seen to grow to another future" in capsys.readouterr().out
