"""The benchmark: what it measures, prints and writes. How fast anything is, is never asserted."""

import contextlib
import dataclasses
import itertools
import json
import math
from pathlib import Path
from typing import Any

import pytest
from desk import bits

from physicslab import cli
from physicslab.components import Velocity
from physicslab.ecs.vector import Vector2
from physicslab.lab.bench import random_scenes
from physicslab.lab.bench.added import ADDED, measure_added
from physicslab.lab.bench.catalogue import SCENES, gas_scene, pile_scene
from physicslab.lab.bench.costs import UNUSED, measure_memory, measure_unused
from physicslab.lab.bench.engine import Engine, missing_peers
from physicslab.lab.bench.measure import measure_scene
from physicslab.lab.bench.moving import funnel
from physicslab.lab.bench.random_scenes import random_scene
from physicslab.lab.bench.result import TURN, SceneResult, exponent, growths, take_turns
from physicslab.lab.bench.scene import BenchScene, Moment, Quality, energy_gained
from physicslab.lab.bench.targets import Check
from physicslab.lab.case import Catalogue
from physicslab.lab.jobs import result_of
from physicslab.lab.peers.mirrors import PymunkMirror
from physicslab.lab.peers.peer import find_contacts
from physicslab.lab.report import machine_text
from physicslab.prefabs import circle
from physicslab.state.masses import Diverged
from physicslab.world import World


def tiny(scene: BenchScene, **changes: Any) -> BenchScene:
    return dataclasses.replace(scene, seconds=0.1, steps=3, **changes)


def measured(scene: BenchScene) -> SceneResult:
    shares: list[float] = []
    result = result_of(measure_scene(scene), shares.append)
    assert shares and all(0.0 < share <= 1.0 for share in shares)
    return result


@pytest.fixture
def small_scenes(monkeypatch: pytest.MonkeyPatch) -> None:
    scenes = [tiny(pile_scene(count)) for count in (5, 10, 20)]
    scenes += [tiny(gas_scene(10)), tiny(SCENES["circles_10"])]
    monkeypatch.setattr("physicslab.commands.bench.SCENES", Catalogue(scenes))


def test_the_exponent_is_that_of_a_power_law() -> None:
    sizes = [1_000, 2_000, 4_000, 8_000, 16_000]
    assert exponent(sizes, [3e-5 * n**1.07 for n in sizes]) == pytest.approx(1.07, abs=1e-12)
    off = [3e-5 * n**1.5 * factor for n, factor in zip(sizes, (1.1, 0.9, 1.1, 0.9, 1.1), strict=True)]
    assert exponent(sizes, off) == pytest.approx(1.5, abs=0.1)


def test_growth_is_drawn_from_three_sizes_and_more() -> None:
    results = [measured(tiny(pile_scene(count))) for count in (5, 10, 20)]
    (growth,) = growths(results)
    assert (growth.group, growth.engine, growth.sizes) == ("piles", "PhysicsLab", (5, 10, 20))
    assert math.isfinite(growth.exponent)
    assert growths(results[:2]) == []


def test_a_scene_is_timed_and_looked_at() -> None:
    result = measured(tiny(gas_scene(20)))
    ours = result.ours
    assert ours.step_ms and ours.step_and_read_ms and ours.first_seconds_ms and not ours.failure
    assert 0.0 < ours.step_ms.median <= ours.step_ms.p90
    assert (ours.times_ours, ours.times_ours_with_read) == (1.0, 1.0)
    assert ours.quality["energy change"] == pytest.approx(0.0, abs=1e-9)
    assert result.right
    assert {"IntegrateSystem", "BroadPhaseSystem", "ContactSystem", "ResolveSystem"} <= set(result.systems)


def test_fast_and_wrong_does_not_count() -> None:
    wrong = Quality("wrong", "m", 0.5, lambda world, start: 1.0)
    nothing = Quality("nothing", "m", 0.5, lambda world, start: math.nan)
    for quality in (wrong, nothing):
        assert not measured(tiny(gas_scene(10), quality=(quality,))).right
    reached = Check("x", "faster", figure=9.0, limit=4.0, at_least=True)
    assert (reached.met, reached.verdict) == (True, "met")
    assert dataclasses.replace(reached, right=False).verdict == "not met: quality"
    assert dataclasses.replace(reached, at_least=False).verdict == "not met"


def test_every_engine_takes_every_place_in_the_order_and_as_many_steps() -> None:
    calls: list[str] = []

    class Noted(Engine):
        def __init__(self, name: str) -> None:
            super().__init__(World())
            self.name = name

        def step(self) -> None:
            calls.append(self.name)

        def read(self) -> object:
            return None

    *_, times = take_turns([Noted("a"), Noted("b"), Noted("c")], 12 * TURN + 1)
    assert [len(spent.step) for spent in times] == [len(spent.read) for spent in times] == [12 * TURN + 1] * 3
    turns = ["".join(names) for names in itertools.batched(calls[: 36 * TURN], TURN)]
    assert all(len(set(turn)) == 1 for turn in turns)
    orders = ["".join(turn[0] for turn in order) for order in itertools.batched(turns, 3)]
    assert sorted(orders) == sorted(2 * ["abc", "acb", "bac", "bca", "cab", "cba"])
    assert calls[36 * TURN :] == ["a", "b", "c"]


def test_what_a_scene_does_not_use_changes_no_bit() -> None:
    found = result_of(measure_unused("ten", UNUSED["circles_10"][0], 10))
    assert found.same_bits
    assert set(found.left_out) >= {"SpringSystem", "DragSystem", "TrailSystem"}


@pytest.mark.parametrize("what", ADDED)
def test_one_thing_more_is_timed_in_a_crowd_and_far_from_it(what: str) -> None:
    world = funnel(20)
    before = len(world.entities())
    ADDED[what](world)
    assert len(world.entities()) > before
    assert result_of(measure_added(what, 20)).ratio > 0.0


def test_a_body_takes_memory() -> None:
    memory = measure_memory((50, 200), steps=2)
    assert 0.0 < memory.columns < memory.spawned


def test_every_scene_is_built_awake_with_its_number_of_bodies() -> None:
    scene = SCENES["pyramid_30"]
    world = scene.build()
    assert not world.simulation.sleeping
    assert len(world.entities()) == scene.size + 1 == 466
    assert [scene.name for scene in SCENES.select("gases")] == [
        "gas_1000", "gas_2000", "gas_4000", "gas_8000", "gas_16000",
    ]  # fmt: skip
    assert SCENES.select("nothing") == []


@pytest.mark.usefixtures("small_scenes")
def test_the_command_prints_tables(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["bench", "piles", "gas_10", "circles_10"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith(machine_text(peers=False)), "nothing but the report"
    assert "ms of CPU time a step" in out and "quality:" in out and "growth of a step's cost" in out
    assert [line.split()[0] for line in err.splitlines() if line] == [
        "pile_5:", "pile_10:", "pile_20:", "gas_10:", "circles_10:",
    ]  # fmt: skip
    (growth,) = (line for line in out.splitlines() if line.startswith("piles"))
    assert len(growth.split()) == 6, "the group, the engine, a cost for each size, the exponent"


@pytest.mark.usefixtures("small_scenes")
def test_the_document_alone_goes_to_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["bench", "piles", "circles_10", "--json", "-"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    found = json.loads(out, parse_constant=lambda word: pytest.fail(f"{word} in JSON"))
    assert list(found) == [
        "format", "machine", "scenes", "growth", "unused", "added", "bytes_per_body", "targets"
    ]  # fmt: skip
    assert found["format"] == "physicslab-bench/1"
    assert {"cpu", "python", "numpy", "numba"} <= set(found["machine"])
    assert [scene["name"] for scene in found["scenes"]] == ["pile_5", "pile_10", "pile_20", "circles_10"]
    (engine,) = found["scenes"][0]["engines"]
    assert engine["name"] == "PhysicsLab"
    assert set(engine["step_ms"]) == {"median", "p90", "p99", "mean"}
    (growth,) = found["growth"]
    assert (growth["group"], growth["sizes"]) == ("piles", [5, 10, 20])


@pytest.mark.plot
@pytest.mark.usefixtures("small_scenes")
def test_the_plot_is_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["bench", "piles", "--plot", str(tmp_path)]) == 0
    assert (tmp_path / "bench.png").read_bytes().startswith(b"\x89PNG")


def test_a_run_that_diverges_is_reported_at_the_end(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def diverge(engine: Engine) -> None:
        raise Diverged("entity 5: Transform is no longer finite")

    monkeypatch.setattr(Engine, "step", diverge)
    assert cli.main(["bench", "pyramid_30", "--json", "-"]) == 1
    out, err = capsys.readouterr()
    assert err == "physicslab: pyramid_30: entity 5: Transform is no longer finite\n"
    assert json.loads(out)["scenes"][0]["engines"][0]["failure"]


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["pile_4001"], '"pile_4001": is no scene; did you mean "pile_4000"?'),
        (
            ["qqqq"],
            '"qqqq": is no scene; the groups are pyramids, piles, gases, ten_discs, moving, funnels, '
            "untuned, joints, edits; ",
        ),
        (["pile_1000", "--json", "none/x.json"], "--json none/x.json: cannot be written"),
    ],
)
def test_bad_usage_is_refused_in_one_line(
    arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["bench", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("physicslab: ") and line in err and err.count("\n") == 1


def test_absent_peers_are_named_with_what_installs_them(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class Absent(PymunkMirror):
        title, module = "Absent", "no_such_engine"

    assert set(missing_peers()) <= {"pymunk", "Box2D 2.3", "Box2D 3"}
    monkeypatch.setattr("physicslab.lab.bench.engine.PEERS", (Absent,))
    assert cli.main(["bench", "--peers"]) == 2
    out, err = capsys.readouterr()
    assert (out, err) == (
        "",
        "physicslab: --peers: Absent is not installed: uv sync --group peers, or "
        "uv run --group peers physicslab bench --peers\n",
    )


@pytest.mark.peers
@pytest.mark.usefixtures("small_scenes")
def test_peers_are_timed_beside(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["bench", "pile_20", "circles_10", "--peers", "--json", "-"]) == 0
    found = json.loads(capsys.readouterr().out)
    for scene in found["scenes"]:
        assert [engine["name"] for engine in scene["engines"]] == [
            "PhysicsLab",
            "pymunk",
            "Box2D 2.3",
            "Box2D 3",
        ]
        for engine in scene["engines"]:
            assert engine["step_ms"]["median"] > 0.0 and engine["times_ours"] > 0.0
            assert engine["quality"]["deepest overlap"] >= 0.0


@pytest.mark.peers
@pytest.mark.usefixtures("small_scenes")
def test_large_scenes_are_run_without_peers_unless_they_are_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for module in ("commands.bench", "lab.bench.tables"):
        monkeypatch.setattr(f"physicslab.{module}.PEER_SIZE_LIMIT", 10)
    assert cli.main(["bench", "piles", "--peers"]) == 0
    out, err = capsys.readouterr()
    assert ["pymunk" in line for line in err.splitlines() if line] == [True, True, False]
    assert "beyond 10, which take others minutes, PhysicsLab alone" in out
    assert cli.main(["bench", "pile_20", "--peers"]) == 0
    assert "pymunk" in capsys.readouterr().err
    monkeypatch.setattr("physicslab.commands.bench._SIZE_LIMITS", {"Box2D 2.3": 5})
    assert cli.main(["bench", "piles", "--peers"]) == 0
    five, ten, _ = (line for line in capsys.readouterr().err.splitlines() if line)
    assert "Box2D 2.3" in five and "Box2D 2.3" not in ten and "Box2D 3" in ten


# ---- scenes drawn at random --------------------------------------------------------------------------------


def test_a_random_scene_is_the_same_wherever_it_is_drawn() -> None:
    small = [number for number in range(60) if random_scene(3, number)[0].size <= 40]
    for number in small[:4]:
        (scene, features), (again, _) = random_scene(3, number), random_scene(3, number)
        one, other = scene.build(), again.build()
        assert bits(one) == bits(other)
        assert features and (scene.name, scene.group) == (f"3:{number}", again.group)
    assert bits(random_scene(4, small[0])[0].build()) != bits(random_scene(3, small[0])[0].build())


def test_random_scenes_are_of_every_family_and_of_all_sizes() -> None:
    drawn = [random_scene(1, number) for number in range(200)]
    assert {scene.group for scene, _ in drawn} == set(random_scenes._FAMILIES)
    sizes = [scene.size for scene, _ in drawn]
    assert min(sizes) < 20 and max(sizes) > 5_000 and 150 < sorted(sizes)[100] < 700
    seen = {feature for _, features in drawn for feature in features}
    assert {"springs", "dampers", "arms", "drag", "mover", "no gravity", "masses > 10", "sizes > 3"} <= seen


def test_nothing_overlaps_deeply_where_it_is_drawn() -> None:
    for number in range(40):
        scene, _ = random_scene(2, number)
        if scene.size <= 60:
            world = scene.build()
            find_contacts(world)
            assert world.contacts.max_penetration < 0.05, scene.name


def test_the_command_runs_random_scenes_and_says_what_they_have(capsys: pytest.CaptureFixture[str]) -> None:
    number = next(number for number in range(99) if random_scene(5, number)[0].size <= 20)
    assert cli.main(["bench", "--random", "1", "--seed", f"5:{number}", "--json", "-"]) == 0
    document = json.loads(capsys.readouterr().out)
    (scene,) = document["scenes"]
    assert (document["format"], scene["name"]) == ("physicslab-bench-random/1", f"5:{number}")
    assert scene["path"] and scene["features"] and scene["systems_ms"]["beside systems"] >= 0.0


def test_energy_that_comes_from_nothing_is_seen_as_a_share_of_the_motion() -> None:
    world = World()
    body = circle(world, (0.0, 0.0), radius=0.1, mass=2.0, velocity=(3.0, 0.0))
    before = Moment.of(world)
    for speed in (3.0, 1.0, 2.0, 1.0):
        world.component(body, Velocity).linear = Vector2(speed, 0.0)
        before.follow(world)
    assert energy_gained(0.1).measure(world, before) == pytest.approx((4.0 - 1.0) / 9.0)


def test_what_rests_by_the_first_look_has_not_gained_without_end() -> None:
    world = World()
    body = circle(world, (0.0, 0.0), radius=0.1, mass=2.0, velocity=(3.0, 0.0))
    before = Moment.of(world)
    for speed in (0.0, 1e-3, 0.0):
        world.component(body, Velocity).linear = Vector2(speed, 0.0)
        before.follow(world)
    assert energy_gained(0.1).measure(world, before) == pytest.approx(1e-6 / 9.0)


def test_a_random_scene_gains_no_energy_unless_something_drives_it() -> None:
    drawn = [random_scene(1, number) for number in range(60)]
    for scene, features in drawn:
        assert ("energy gained" in {quality.name for quality in scene.quality}) == ("mover" not in features)


def test_contacts_are_found_in_a_world_of_many_islands() -> None:
    """Those of its islands came in between, without room for colours: memory was written beyond it."""
    world = World()
    for n in range(128):  # and one far away
        circle(world, (0.199 * (n % 16) + 1000.0 * (n // 127), 0.199 * (n // 16)), radius=0.1)
    world.synchronise()
    assert len(world.parts) > 1
    find_contacts(world)
    assert all(len(kind.used) == len(world.entity_index) for kind in world.contacts.wide.kinds)


@pytest.mark.parametrize(
    "given",
    [["--seed", "x"], ["--seed", "1:"], ["--random", "0"], ["--random", "1", "heap"], ["--like-quality"]],
)
def test_random_scenes_that_cannot_be_are_refused(given: list[str]) -> None:
    with contextlib.suppress(SystemExit):
        assert cli.main(["bench", *given]) == 2
