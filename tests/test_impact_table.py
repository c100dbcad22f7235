"""The ledger of impacts: what its columns are, and the file that a run writes."""

from __future__ import annotations

import csv
import dataclasses
import io
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from physicslab import World, cli, load_scene
from physicslab.components import Velocity
from physicslab.contacts import report
from physicslab.diagnostics.energy import measure_account, measure_momentum
from physicslab.diagnostics.impact_table import (
    ImpactTableWriter,
    names_of,
    read_impacts,
    since_last,
    speeds_at,
)
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.kernels.constraint.impact_law import NEWTON
from physicslab.kernels.records import IMPACT
from physicslab.prefabs import box, circle
from physicslab.state.contacts import Contacts
from physicslab.systems.standard import standard_systems

WAYS: dict[str, dict[str, Any]] = {
    "soft": {"contacts": "soft", "collisions": "step"},
    "rigid": {"contacts": "rigid", "collisions": "step"},
    "exact": {"collisions": "exact"},
}


def jar(way: str, *, shapes: str = "circle", e: float = 0.9, mu: float = 0.4) -> World:
    """Return a world of bodies that bounce in bounds, without gravity."""
    physics = PhysicsConfig(
        gravity_mode="none", bounds=(-2, -2, 2, 2), bounds_restitution=e, bounds_friction=mu
    )
    world = World(*standard_systems(), physics=physics, simulation=SimulationConfig(**WAYS[way]))
    random = np.random.default_rng(5)
    for k, place in enumerate(((-1, -1), (1, -1), (0, 0.1), (-1, 1.2), (1, 1))):
        options: dict[str, Any] = {
            "velocity": tuple(random.normal(0, 3, 2)), "angular_velocity": float(random.normal(0, 3)),
            "mass": float(k + 1), "restitution": e, "friction": mu,
        }  # fmt: skip
        if shapes == "box" and k % 2:
            box(world, place, width=0.7, height=0.4, **options)
        else:
            circle(world, place, radius=0.3, **options)
    return world


def momentum_of(world: World) -> NDArray[np.float64]:
    """Return linear and angular momentum."""
    found = measure_momentum(world)
    return np.array((*found.linear, found.angular))


def outer_impulses(records: NDArray[Any]) -> NDArray[np.float64]:
    """Return the momentum and the angular momentum about the origin that rows say came from outside."""
    total = np.zeros(3)
    for r in records:
        nx, ny = r["normal_x"], r["normal_y"]
        normal, tangent = r["normal_impulse"], r["tangent_impulse"]
        parts = [(normal - r["normal_impulse_2"], tangent - r["tangent_impulse_2"], r["x"], r["y"])]
        parts.append((r["normal_impulse_2"], r["tangent_impulse_2"], r["x_2"], r["y_2"]))
        for n, t, x, y in parts:
            px, py = n * nx - t * ny, n * ny + t * nx
            sign = (1.0 if r["inverse_mass_b"] > 0.0 else 0.0) - (1.0 if r["inverse_mass_a"] > 0.0 else 0.0)
            total += sign * np.array((px, py, x * py - y * px))
    return total


# ---- what is recorded --------------------------------------------------------------------------------------


@pytest.mark.parametrize("shapes", ["circle", "box"])
@pytest.mark.parametrize("way", WAYS)
def test_momentum_of_the_rows_adds_up_to_that_of_the_world(way: str, shapes: str) -> None:
    if way == "exact" and shapes == "box":
        pytest.skip("boxes that turn are not moved in closed form")
    world = jar(way, shapes=shapes)
    world.contacts.read = True
    before = momentum_of(world)
    world.run(seconds=1.5)
    records = world.contacts.impacts
    assert len(records) == world.collisions > 15
    change = momentum_of(world) - before
    scale = np.abs(records["normal_impulse"]).sum()
    contact = world.account.sums[:, 1:].sum(axis=0) - world.account.sums[5, 1:]
    assert outer_impulses(records)[:2] == pytest.approx((change - contact)[:2], abs=1e-12 * scale)
    if way != "soft":  # what soft contacts err by in angular momentum is not that of impacts
        assert outer_impulses(records)[2] == pytest.approx(change[2], abs=1e-9 * scale)


@pytest.mark.parametrize("seed", range(12))
def test_the_rows_add_up_to_the_account_where_resting_bodies_pass_an_impact_on(seed: int) -> None:
    """A ball falls on a stack: what the bodies below and the floor take has rows as well."""
    random = np.random.default_rng(seed)
    world = World(*standard_systems(), simulation=SimulationConfig(sleeping=False, **WAYS["rigid"]))
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=1.0, friction=0.5)
    top = 0.0
    for _ in range(3):
        width, height, x = random.uniform((0.6, 0.2, -0.05), (1.0, 0.5, 0.05)).tolist()
        box(
            world, (x, top + 0.5 * height), width=width, height=height, mass=5 * height,
            restitution=float(random.choice((0.0, 0.3))), friction=float(random.uniform(0.0, 0.8)),
        )  # fmt: skip
        top += height
    place = float(random.uniform(-0.3, 0.3)), top + 0.6
    circle(world, place, radius=0.2, velocity=(0.5, -3.0), restitution=0.5, friction=0.4)
    world.contacts.read = True
    world.run(seconds=0.15)
    records, account = world.contacts.impacts, measure_account(world)
    found = read_impacts(records)
    assert len(records) == world.collisions >= 4  # the three below take part
    assert -found.energy_lost.sum() == pytest.approx(account.energy["impacts"], rel=1e-12)
    floor = records["inverse_mass_a"] == 0.0
    assert (records["normal_impulse"] * records["normal_y"])[floor].sum() == pytest.approx(
        account.momentum["impacts"].y, rel=1e-9
    )
    assert np.nanmin(found.e_found) > -1e-6 and np.nanmax(found.e_found) < 1.0 + 1e-9


@pytest.mark.parametrize("way", WAYS)
def test_records_hold_the_motion_before_and_after(way: str) -> None:
    """The change of each velocity is what the impulses cause; law, restitution and friction are there."""
    world = jar(way, shapes="circle" if way == "exact" else "box")
    world.contacts.read = True
    world.run(seconds=1.0)
    r = world.contacts.impacts
    px = r["normal_impulse"] * r["normal_x"] - r["tangent_impulse"] * r["normal_y"]
    py = r["normal_impulse"] * r["normal_y"] + r["tangent_impulse"] * r["normal_x"]
    alone = r["alone"] == 1
    assert alone.sum() > 5
    for body, sign in (("a", -1.0), ("b", 1.0)):
        for axis, impulse in (("x", px), ("y", py)):
            change = r[f"after_{body}{axis}"] - r[f"before_{body}{axis}"]
            assert change[alone] == pytest.approx(
                sign * (r[f"inverse_mass_{body}"] * impulse)[alone], abs=1e-12
            )
    assert set(r["points"].tolist()) <= {1, 2} and (r["friction"] == 0.4).all()
    assert (r["restitution"][r["law"] == NEWTON] <= 0.9).all()


@pytest.mark.parametrize("way", WAYS)
def test_derived_columns_are_those_of_a_bounce(way: str) -> None:
    world = jar(way, e=0.5, mu=0.1)
    world.contacts.read = True
    world.run(seconds=1.0)
    records = world.contacts.impacts
    found = read_impacts(records)
    one = records["law"] == NEWTON
    assert found.e_found[one] == pytest.approx(records["restitution"][one], abs=1e-9)
    assert -found.vn_before == pytest.approx(records["approach_speed"], rel=1e-9, abs=1e-9)
    held = np.abs(records["tangent_impulse"]) < 0.1 * records["normal_impulse"] * (1 - 1e-9)
    assert (found.sticks == held).all() and 0 < held.sum() < len(held)
    taken = -world.account.sums[5:7, 0].sum()
    assert found.energy_lost.sum() == pytest.approx(taken, rel=1e-12)
    assert (found.energy_lost >= -1e-12 * found.energy_lost.max()).all()


def test_impacts_of_one_substep_are_in_the_order_of_time() -> None:
    """They were in the order of pairs, so that the first that a sweep keeps was not the earliest."""
    world = World(
        physics=PhysicsConfig(gravity_mode="none"), simulation=SimulationConfig(substeps=1, **WAYS["soft"])
    )
    for height, gap in ((0.0, 0.06), (3.0, 0.03)):
        circle(world, (0.0, height), radius=0.1, static=True)
        circle(world, (0.2 + gap, height), radius=0.1, velocity=(-6.0, 0.0))
    world.contacts.read = True
    world.run(steps=2)
    assert world.impacts["time"] == pytest.approx([0.005, 0.01], rel=1e-12)


def test_the_time_since_a_pairs_last_impact() -> None:
    world = load_scene("drop")
    world.run(seconds=5.0)
    records = world.contacts.impacts
    since = since_last(records, {})
    assert math.isnan(since[0]) and since[1:] == pytest.approx(np.diff(records["time"]), abs=1e-15)
    last: dict[tuple[int, int, int], float] = {}
    parts = [since_last(records[k : k + 2], last) for k in range(0, len(records), 2)]
    assert np.array_equal(np.concatenate(parts), since, equal_nan=True)


def test_names_are_labels_and_the_walls_of_the_bounds() -> None:
    world = jar("exact")
    world.run(seconds=1.0)
    a, b = names_of(world, world.contacts.impacts)
    assert {"bounds left", "bounds top"} <= set(a) and not any("bounds" in name for name in b)
    assert all(name.startswith(("circle", "bounds")) for name in a)


def test_an_empty_ledger_has_empty_columns() -> None:
    found = read_impacts(np.zeros(0, IMPACT))
    assert all(len(getattr(found, field.name)) == 0 for field in dataclasses.fields(found))


def test_speeds_of_a_body_that_turns_are_those_of_its_point() -> None:
    record = np.zeros(1, IMPACT)
    record["normal_y"], record["before_wb"], record["center_bx"] = 1.0, 2.0, 1.0
    vn, vt = speeds_at(record, np.array([4.0]), np.array([0.5]), "before")
    assert (float(vn[0]), float(vt[0])) == (
        6.0,
        1.0,
    )  # 3 m to the right, 0.5 m up; the tangent leads to the left


def test_two_points_of_a_box_that_lands_flat_are_one_row() -> None:
    for way in ("soft", "rigid"):
        world = World(*standard_systems(), simulation=SimulationConfig(**WAYS[way]))
        world.contacts.read = True
        box(world, (0, -0.5), width=10, height=1, static=True, restitution=0.6)
        box(world, (0, 1), width=1, height=0.5, restitution=0.6)
        world.run(seconds=0.5)
        (record,) = world.contacts.impacts
        assert record["points"] == 2 and record["alone"] == 1
        assert record["normal_impulse_2"] == pytest.approx(0.5 * record["normal_impulse"], rel=1e-9)
        assert sorted((float(record["x"]), float(record["x_2"]))) == pytest.approx([-0.5, 0.5])
        found = read_impacts(world.contacts.impacts)
        lost = -measure_account(world).energy["impacts"]
        assert found.e_found[0] == pytest.approx(0.6, rel=1e-9)
        assert found.energy_lost[0] == pytest.approx(lost, rel=1e-12)


def test_discs_in_a_row_are_not_alone() -> None:
    """A disc that meets two at once: each of both pairs acts on it."""
    world = World(
        *standard_systems(), physics=PhysicsConfig(gravity_mode="none"),
        simulation=SimulationConfig(**WAYS["rigid"]),
    )  # fmt: skip
    ball = circle(world, (-1, 0), radius=0.25, velocity=(2, 0), restitution=1.0)
    for y in (-0.25, 0.25):
        circle(world, (0.5, y), radius=0.25, restitution=1.0)
    world.run(seconds=1.0)
    records = world.contacts.impacts
    assert len(records) == 2 and not records["alone"].any()
    lost = read_impacts(records).energy_lost
    assert lost.sum() == pytest.approx(0.0, abs=1e-12) and world.component(ball, Velocity).linear.x < 0.0


# ---- the ring ----------------------------------------------------------------------------------------------


def test_the_ring_of_a_contact_step_is_written_where_it_is_read_alone() -> None:
    world = load_scene("gas")
    world.run(seconds=0.1)
    assert world.collisions > 100 and world.contacts.logged == 0 and not world.contacts.log["time"].any()


def test_a_longer_ring_keeps_what_there_was() -> None:
    contacts = Contacts()
    contacts.log = np.zeros(10, IMPACT)
    for number in range(27):
        contacts.log[number % 10]["time"] = number
    contacts.logged = 27
    contacts.lengthen_log(16)
    assert len(contacts.log) == 16
    assert [contacts.log[n % 16]["time"] for n in range(17, 27)] == list(range(17, 27))
    assert contacts.impacts_since(5)["time"].tolist() == list(range(17, 27)), (
        "what it lacked was read as zeros"
    )
    contacts.logged = 20
    assert contacts.impacts["time"].tolist() == [17.0, 18.0, 19.0]


def written(world: World, steps: int, each: int) -> tuple[list[list[str]], ImpactTableWriter]:
    """Return the rows that a ledger gets, read after each of so many steps."""
    stream = io.StringIO(newline="")
    ledger = ImpactTableWriter(stream, world)
    for _ in range(steps // each):
        world.run(steps=each)
        ledger.write()
    return list(csv.reader(io.StringIO(stream.getvalue())))[1:], ledger


@pytest.mark.parametrize("ring", [100, 100_000])
def test_every_impact_is_written_however_short_the_ring(ring: int) -> None:
    world = load_scene("gas")
    world.contacts.log = np.zeros(ring, IMPACT)
    rows, ledger = written(world, 40, 1)
    assert len(rows) + ledger.lost == world.collisions == ledger.rows + ledger.lost
    if ring == 100:
        assert len(world.contacts.log) > 400, "it grows where much of it is filled"
        assert ledger.lost < 0.1 * world.collisions
    else:
        assert ledger.lost == 0


def test_more_impacts_than_the_ring_holds_are_counted() -> None:
    world = load_scene("gas")
    world.contacts.log = np.zeros(100, IMPACT)
    rows, ledger = written(world, 40, 40)
    assert len(rows) == 100 and ledger.lost == world.collisions - 100 > 0


# ---- run --ledger ------------------------------------------------------------------------------------------


def run(*arguments: str) -> int:
    """Run a command."""
    return cli.main(["run", *arguments])


def table(path: Path) -> list[dict[str, str]]:
    """Return the rows of a ledger."""
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_run_writes_its_ledger(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "impacts.csv"
    assert run("drop", "--seconds", "3", "--ledger", str(out)) == 0
    rows, printed = table(out), capsys.readouterr()
    assert not printed.err and "drop" in printed.out
    assert [row["A"] + row["B"] for row in rows] == ["floorball"] * 2
    first = rows[0]
    assert float(first["time [s]"]) == pytest.approx(math.sqrt(2 * 3.75 / 9.81), rel=1e-12)
    assert float(first["normal speed before [m/s]"]) == pytest.approx(-math.sqrt(2 * 3.75 * 9.81), rel=1e-12)
    assert float(first["restitution found"]) == pytest.approx(float(first["restitution asked"]), rel=1e-9)
    assert first["friction"] == "sticks" and first["since the pair's last [s]"] == ""
    assert float(rows[1]["since the pair's last [s]"]) > 1.0
    assert all("[" in name for name in first if "speed" in name or "impulse " in name or "energy" in name)


@pytest.mark.parametrize("contacts", ["soft", "rigid"])
def test_a_ledger_beside_all_other_documents(
    contacts: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = {name: tmp_path / f"run.{name}" for name in ("json", "csv", "ledger")}
    options = [text for name, path in paths.items() for text in (f"--{name}", str(path))]
    assert run("dominoes", "--seconds", "2", "--contacts", contacts, "--every", "0.5", *options) == 0
    capsys.readouterr()
    report = json.loads(paths["json"].read_text())
    assert len(table(paths["ledger"])) == report["collisions"] > 3
    assert len({row["time [s]"] for row in table(paths["csv"])}) == 5


def test_a_ledger_changes_no_bit_of_the_run(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    found = []
    for options in ([], ["--ledger", str(tmp_path / "x")]):
        for scene in ("gas", "billiards", "dominoes"):
            assert run(scene, "--seconds", "1", "--json", "-", *options) == 0
            found.append(json.loads(capsys.readouterr().out)["entities"])
    assert found[:3] == found[3:]


def test_a_ledger_on_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("drop", "--seconds", "1", "--ledger", "-") == 0
    rows = list(csv.reader(io.StringIO(capsys.readouterr().out)))
    assert rows[0][0] == "time [s]" and len(rows) == 2


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--ledger", "-", "--csv", "-"], "--csv and --ledger cannot both go to -"),
        (["--ledger", "/"], "--ledger /: cannot be written: / is a directory"),
        (["--ledger", "/nowhere/x.csv"], "--ledger /nowhere/x.csv: cannot be written"),
    ],
)
def test_a_ledger_that_cannot_be_written_is_refused_in_a_line(
    options: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("drop", *options) == 2
    printed = capsys.readouterr()
    assert not printed.out and printed.err.count("\n") == 1 and words in printed.err


def test_impacts_that_are_lost_are_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(Contacts, "LOGGED", 50)
    monkeypatch.setattr(report, "_MAX_RING", 50)
    out = tmp_path / "impacts.csv"
    assert run("gas", "--seconds", "0.2", "--ledger", str(out), "--json", str(tmp_path / "r")) == 0
    lines = [line for line in capsys.readouterr().err.splitlines() if "--ledger" in line]
    lost = json.loads((tmp_path / "r").read_text())["collisions"] - len(table(out))
    assert len(lines) == 1 and lost > 0 and f"{lost} of " in lines[0]


def test_a_run_that_is_stopped_keeps_its_rows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "impacts.csv"
    out.write_text("old")
    arguments = ["drop", "--seconds", "3", "--at-most", "1e-9", "--ledger", str(out)]
    assert run(*arguments) == 1
    assert out.read_text().startswith("time [s]")
    assert "stopped" in capsys.readouterr().err
