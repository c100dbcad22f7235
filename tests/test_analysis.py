"""What measures depend on, and fields found from data: beside answers that are known."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab import SceneError, World, box, circle, ensemble, load_scene
from physicslab.cli import main
from physicslab.components import Drag, Name, Spring, Transform
from physicslab.ensembles import fit, sensitivity, sobol_indices

VX, VY, G = "ball.Velocity.linear.x", "ball.Velocity.linear.y", "physics.gravity.y"
E, STIFFNESS = "ball.Material.restitution", "spring.Spring.stiffness"


def oscillator() -> World:
    world = World()
    ball = circle(world, (1.0, 0.0), radius=0.1, mass=2.0, name="ball")
    world.spawn(Spring(a=ball, rest_length=0.0, stiffness=8.0, anchor_b=(0.0, 0.0)), name="spring")
    world.physics = world.physics.__class__(gravity_mode="none")
    return world


# ---- derivatives -------------------------------------------------------------------------------------------


def test_derivatives_of_an_oscillation_are_those_of_the_formula() -> None:
    found = sensitivity(oscillator(), [STIFFNESS, "ball.Mass.mass"], measure="ball.x", seconds=3.0)["ball.x"]
    w, t = 2.0, 3.0  # x = cos(w t), w = sqrt(k / m)
    by_w = -t * math.sin(w * t)
    assert found[STIFFNESS].value == pytest.approx(by_w * 0.5 / (2.0 * w), rel=1e-8)
    assert found["ball.Mass.mass"].value == pytest.approx(-by_w * w / 4.0, rel=1e-8)


@given(st.floats(-3.0, 3.0), st.floats(0.05, 0.8))
def test_a_derivative_by_gravity_is_half_the_square_of_the_time(speed: float, seconds: float) -> None:
    found = sensitivity("drop", {G: 0.1, VX: 0.5}, measure="ball.y", seconds=seconds)["ball.y"]
    assert found[G].value == pytest.approx(0.5 * seconds**2, rel=1e-9) and found[VX].value == 0.0


def test_runs_until_a_condition_give_the_derivative_of_when_it_begins_to_hold() -> None:
    found = sensitivity("drop", [G], measure="time", seconds=2.0, until="ball.y <= 3")["time"][G]
    fall = math.sqrt(2.0 * 1.0 / 9.81)  # from 4 m to 3 m
    assert found.value == pytest.approx(fall / (2.0 * 9.81), rel=1e-8)
    with pytest.raises(SceneError, match="does not begin to hold"):
        sensitivity("drop", [G], measure="time", seconds=0.2, until="ball.y <= 3")


def test_at_the_end_of_its_range_a_field_is_moved_to_one_side() -> None:
    """A restitution of 1 was refused as 1.0005, and a drag of 0 as -0.0005."""
    world = World()
    ball = circle(world, (0.0, 2.0), radius=0.1, velocity=(1.0, 0.0), restitution=1.0, friction=0.0, name="b")
    box(world, (0.0, -0.5), width=9.0, height=1.0, static=True, restitution=1.0)
    world.add(ball, Drag())
    drag, fields = "b.Drag.linear", ["b.Material.restitution", "b.Drag.linear"]
    found = sensitivity(world, fields, measure={"vy": "b.vy", "x": "b.x"}, seconds=1.0)
    assert found["vy"]["b.Material.restitution"].value == pytest.approx(math.sqrt(2 * 9.81 * 1.9), rel=1e-9)
    assert found["x"][drag].value == pytest.approx(-0.5, rel=1e-9) and found["x"][drag].error < 1e-7


def test_where_an_impact_comes_or_goes_the_error_says_that_there_is_no_derivative() -> None:
    touched = math.sqrt(2.0 * 3.75 / 9.81)
    found = sensitivity("drop", {G: 0.5}, measure="collisions", seconds=touched)["collisions"][G]
    assert found.error >= 0.1 * abs(found.value) > 0.0


@pytest.mark.parametrize(
    "field", ["ball.Mass.mas", "ball.Shape.kind", "bal.Mass.mass", VX.rpartition(".")[0]]
)
def test_what_is_no_number_is_refused(field: str) -> None:
    with pytest.raises(SceneError, match=r"fields: entity|must be a number"):
        sensitivity("drop", [field], measure="ball.y", seconds=0.1)


def test_steps_are_numbers_or_texts_and_above_zero() -> None:
    found = [sensitivity("drop", fields, measure="ball.y", seconds=0.5) for fields in (G, {G: "10 cm/s^2"})]
    assert all(one["ball.y"][G].value == pytest.approx(0.125, rel=1e-9) for one in found)
    for fields, line in (
        ([], "fields: must name at least one field"), ({G: 0.0}, "a step must be > 0"),
        ({G: "1 kg"}, "'1 kg' is in kg"),
    ):  # fmt: skip
        with pytest.raises(SceneError, match=line):
            sensitivity("drop", fields, measure="ball.y", seconds=0.1)


# ---- spread ------------------------------------------------------------------------------------------------


def test_the_spread_of_a_measure_is_that_of_its_column_without_runs_that_failed() -> None:
    result = ensemble(
        "drop", {VY: [0.0, 1.0, 2.0, 1e9]}, measure={"y": "ball.y", "t": "first_impact.time"}, seconds=0.5,
        executor="serial",
    )  # fmt: skip
    spread, y = result.spread(), result.columns["y"]
    assert spread["y"]["count"] == 4 and spread["y"]["mean"] == y.mean()
    assert (spread["y"]["least"], spread["y"]["greatest"]) == (y.min(), y.max())
    assert spread["t"]["count"] == 0 and math.isnan(spread["t"]["mean"])
    assert result.units == {VY: "m/s", "y": "m", "t": "s"}


# ---- Sobol's indices ---------------------------------------------------------------------------------------


@pytest.mark.peers
def test_indices_of_a_sum_are_shares_of_its_variance() -> None:
    space = {VX: ("uniform", 0.0, 2.0), VY: ("uniform", 0.0, 1.0), E: ("uniform", 0.2, 0.9)}
    measure = {"sum": "ball.x / (1 m) + ball.y / (1 m)"}
    found = sobol_indices("drop", space, measure=measure, seconds=0.5, samples=512, executor="serial")["sum"]
    # both are moved by v t, so that variances are as the squares of the widths
    assert found.first[VX] == pytest.approx(0.8, abs=0.05) and found.total[VY] == pytest.approx(0.2, abs=0.05)
    assert found.first[E] == found.total[E] == 0.0
    flight = sobol_indices(
        "drop", {VX: ("uniform", 0.5, 2.0), E: ("uniform", 0.2, 0.9)}, measure="time", until="ball.x >= -2",
        seconds=9.0, samples=64, executor="serial",
    )["time"]  # fmt: skip
    assert flight.total[VX] == pytest.approx(1.0, abs=0.1) and abs(flight.total[E]) < 1e-12
    mass = {"bob.Mass.mass": ("uniform", 1.0, 5.0)}  # it had 113 % of what rounding leaves of the time
    swing = sobol_indices(
        "pendulum", mass, measure="when(bob.x < 0)", seconds=3.0, samples=16, executor="serial"
    )
    assert [one.total["bob.Mass.mass"] for one in swing.values()] == [0.0]
    with pytest.raises(SceneError, match="a power of two"):
        sobol_indices("drop", space, measure=measure, seconds=0.5, samples=100)
    with pytest.raises(SceneError, match='must be \\("uniform"'):
        sobol_indices("drop", {VX: [1, 2]}, measure=measure, seconds=0.5)  # type: ignore[dict-item]


# ---- fits --------------------------------------------------------------------------------------------------


@pytest.mark.peers
def test_a_fit_finds_the_fields_of_which_data_come_and_how_sure_they_are(tmp_path: Path) -> None:
    world, noise = oscillator(), np.random.default_rng(3)
    times, places = np.linspace(0.1, 6.0, 60), []
    for t in times.tolist():
        world.run(seconds=t - world.time)
        places.append(world.component("ball", Transform).position.x)
    data = {"time": times, "ball.x": np.array(places)}
    start: dict[str, float | str] = {STIFFNESS: 6.5, "ball.Transform.position.x": "0.8 m"}
    exact = fit(oscillator(), start, data)
    assert exact.values[STIFFNESS] == pytest.approx(8.0, rel=1e-9)
    assert exact.rest < 1e-9
    pulls = []
    for _ in range(8):
        shaken = {**data, "ball.x": data["ball.x"] + noise.normal(0.0, 0.01, 60)}
        found = fit(oscillator(), start, shaken)
        pulls.append((found.values[STIFFNESS] - 8.0) / found.errors[STIFFNESS])
        assert found.rest == pytest.approx(0.01, rel=0.4) and found.covariance.shape == (2, 2)
    assert np.sqrt(np.mean(np.square(pulls))) < 2.2  # chi^2 of 8 is above 8 * 2.2^2 once in 10^5
    path = tmp_path / "seen.csv"
    rows = "\n".join(f"{t},{x}" for t, x in zip(times, places, strict=True))
    path.write_text(f"time,ball.x\n{rows}\n", encoding="utf-8")
    assert fit(oscillator(), start, path).values == exact.values
    path.write_text(f"time [s],ball.x [m]\n{rows}\n", encoding="utf-8")
    assert fit(oscillator(), start, path).values == exact.values
    path.write_text(f"time [s],ball.x [cm]\n{rows}\n", encoding="utf-8")
    with pytest.raises(SceneError, match=r'column "ball\.x \[cm\]": must be in m$'):
        fit(oscillator(), start, path)


@pytest.mark.peers
@pytest.mark.parametrize("name", ["ball", "ball [2]"])
def test_a_fit_reads_what_a_recorded_run_has_saved(name: str, tmp_path: Path) -> None:
    path, recorded, world = tmp_path / "run.csv", oscillator(), oscillator()
    for one in (recorded, world):
        one.add(one.entity("ball"), Name(name))
    recorded.record(2.0, every=0.1).save(path)
    assert fit(world, {STIFFNESS: 7.0}, path).values[STIFFNESS] == pytest.approx(8.0, rel=1e-9)


@pytest.mark.peers
def test_a_fit_takes_moments_at_which_a_condition_begins_to_hold() -> None:
    fall = math.sqrt(2.0 * 3.75 / 9.81)  # to the floor, and then 2 e times as long from bounce to bounce
    bounces = fall * np.cumsum([1.0, 2 * 0.7, 2 * 0.7**2])
    found = fit(
        "drop", {G: -9.0, E: 0.8}, {"time": bounces, "ball.x": [math.nan] * 3}, until="ball.vy > 0", seconds=5
    )
    assert found.values == pytest.approx({G: -9.81, E: 0.7}, rel=1e-9) and found.rest < 1e-12
    assert found.model["time"] == pytest.approx(bounces, rel=1e-12)
    rises = {"time": math.pi * (np.arange(7) + 0.75)}  # x = cos(2 t), above 0 at the start too
    swing = fit(oscillator(), {STIFFNESS: 7.5}, rises, until="ball.x > 0", seconds=30)
    assert swing.values[STIFFNESS] == pytest.approx(8.0, rel=1e-9)


@pytest.mark.peers
@pytest.mark.parametrize(
    ("data", "more", "message"),
    [
        ({"time": [0.1, 9.0]}, {"until": "ball.vy > 0", "seconds": 1.0}, "begins to hold 1 times within 1 s"),
        ({"time": [0.1]}, {"until": "ball.vy > 0", "seconds": 0.1}, "does not begin to hold within 0.1 s"),
        ({"time": [0.1]}, {"until": "ball.vy"}, "until, seconds: must be given together"),
        ({"time": [0.1], "ball.x": [1.0]}, {"seconds": 1.0}, "until, seconds: must be given together"),
        ({"time": [0.1]}, {"until": "ball.q > 1", "seconds": 1.0}, "'ball.q' is no quantity"),
        ({}, {"until": "ball.vy > 0", "seconds": 1.0}, "must have a column of a quantity"),
    ],
)
def test_moments_that_cannot_be_fitted_are_refused(
    data: dict[str, list[float]], more: dict[str, Any], message: str
) -> None:
    with pytest.raises(SceneError, match=message):
        fit("drop", {G: -9.0}, data, **more)


@pytest.mark.peers
@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"ball.x": [1.0]}, "must have a column time"),
        ({"time": [0.0, 1.0], "ball.x": [1.0]}, "as many numbers"),
        ({"time": [1.0, 0.5], "ball.x": [1.0, 1.0]}, "ascend"),
        ({"time": [1.0], "ball.z": [1.0]}, "column 'ball.z' is no quantity"),
        ({"time": [1.0], "ball.x": [math.nan]}, "has 0 numbers for 1 fields"),
        ({"time": [1.0], "ball.x": ["1 m"]}, 'column "ball.x": must be numbers, in SI'),
        ([1.0], "must be the path of a CSV file, or a dict of columns"),
        ("nothing.csv", r"data nothing.csv: cannot be read: No such file or directory$"),
    ],
)
def test_data_that_cannot_be_fitted_are_refused(data: Any, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        fit(oscillator(), {STIFFNESS: 6.0}, data)


# ---- maps --------------------------------------------------------------------------------------------------


@pytest.mark.plot
def test_a_map_is_written_by_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "map.PNG"
    vary = ["--vary", f"{VX}=0:3:4", "--vary", f"{VY}=0:3:3"]
    command = ["sweep", "drop", "--measure", "x=ball.x", "--seconds", "0.5", "--map", str(path)]
    assert main([*command, *vary, "--workers", "1"]) == 0 and path.read_bytes().startswith(b"\x89PNG")
    assert main([*command, *vary[:2]]) == 2
    assert "map: must have two lists of numbers" in capsys.readouterr().err


def test_a_map_needs_two_lists() -> None:
    result = ensemble(load_scene("drop"), {VX: [0, 1]}, measure="ball.x", seconds=0.1, executor="serial")
    with pytest.raises(SceneError, match="two lists of numbers"):
        result.map()


@pytest.mark.peers
def test_fields_that_the_data_leave_open_have_an_infinite_error() -> None:
    measured = {"time": [0.1, 0.2, 0.3], "ball.y": [3.951, 3.804, 3.559]}
    alone = fit("drop", {"ball.Mass.mass": 1.0, "physics.gravity.y": -9.0}, measured)
    assert alone.errors["ball.Mass.mass"] == np.inf and 0.0 < alone.errors["physics.gravity.y"] < 0.1


@pytest.mark.peers
def test_without_a_number_to_spare_the_data_do_not_say_how_sure_a_field_is() -> None:
    """One number and one field, which goes through it, had an error of 1e-15."""
    alone = fit("drop", {G: -9.0}, {"time": [0.5], "ball.y": [2.8]})
    assert alone.values[G] == pytest.approx(-9.6) and alone.errors[G] == np.inf
    with pytest.raises(SceneError, match=r"start \[.*\]: must be a dict of fields"):
        fit("drop", [G], {"time": [0.5], "ball.y": [2.8]})  # type: ignore[arg-type]
