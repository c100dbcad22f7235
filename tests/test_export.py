"""``physicslab export``: what a page holds, how it is framed and coloured, and what is refused."""

import base64
import html
import json
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from exporting import exported, recorded
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from physicslab import World, cli, load_scene, save_scene
from physicslab.components import (
    Drag,
    Gate,
    Graph,
    GraphLine,
    Mass,
    Rope,
    Shape,
    Spring,
    Trail,
    Transform,
    Velocity,
)  # fmt: skip
from physicslab.components.colour import rgb_of
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.export.look import style
from physicslab.export.packing import pack
from physicslab.export.parts import springs_of
from physicslab.export.recording import RunRecorder, frame_run
from physicslab.prefabs import box, circle, gas
from physicslab.systems.standard import standard_systems
from physicslab.theme import contrast


def unpacked_bytes(text: str) -> bytes:
    """Return the bytes that a text holds: RFC 1924, with a comma for ``<``, as the page reads it."""
    return base64.b85decode(text.replace(",", "<"))


def unpack(text: str, rows: int) -> NDArray[np.float32]:
    """Return the array (rows, columns) that was packed."""
    content = iter(unpacked_bytes(text))
    columns = []
    for order in content:
        values = np.zeros(rows, np.int64)
        for row in range(rows):
            number = shift = 0
            more = True
            while more:
                byte = next(content)
                number, shift, more = number | (byte & 127) << shift, shift + 7, byte > 127
            values[row] = (number >> 1) ^ -(number & 1)
        for _ in range(order):
            values = np.cumsum(values)
        bits = (values & 0xFFFFFFFF).astype(np.uint32).view(np.int32)
        columns.append((bits ^ ((bits >> 31) & 0x7FFFFFFF)).view(np.float32))
    return np.stack(columns, axis=1)


def document(page: bytes) -> dict[str, Any]:
    """Return what the player of a page with one run is given."""
    read = all_of(page)
    assert len(read["runs"]) == 1
    run: dict[str, Any] = read["runs"][0]
    return run | {"view": read["view"]}


def all_of(page: bytes) -> dict[str, Any]:
    """Return what the player of a page is given."""
    found = re.search(r'<script id="run" type="application/json">(.*?)</script>', page.decode(), re.DOTALL)
    assert found is not None
    read: dict[str, Any] = json.loads(found[1])
    return read


# ---- what a page holds -------------------------------------------------------------------------------------

BITS = arrays.arrays(np.uint32, st.tuples(st.integers(1, 12), st.integers(1, 4)))


@given(BITS)
def test_packing_keeps_every_bit(bits: NDArray[np.uint32]) -> None:
    values = bits.view(np.float32)
    assert unpack(pack(values), len(values)).view(np.uint32).tolist() == bits.tolist()


def test_smooth_motion_takes_few_bytes() -> None:
    t = np.linspace(0.0, 10.0, 601)
    columns = np.stack((np.cos(t), 3.0 * t - 4.905 * t * t, np.zeros(601)), axis=1).astype(np.float32)
    assert len(unpacked_bytes(pack(columns))) < 0.45 * columns.nbytes
    assert len(unpacked_bytes(pack(columns[:, 2:]))) == 602


@pytest.mark.parametrize("scene", ["drop", "sandbox", "two_planets"])
def test_a_page_holds_the_numbers_of_the_run(
    scene: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    read = document(exported(tmp_path / "page.html", scene, "--seconds", "1.51"))
    _, recorder = recorded(scene, 1.51)
    columns = unpack(read["data"], read["instants"])
    assert columns.tobytes() == recorder.columns.tobytes()
    assert (columns[0, 0], columns[-1, 0]) == (0.0, np.float32(1.51))
    assert (
        cli.main(["run", scene, "--seconds", "1.51", "--csv", str(tmp_path / "run.csv"), "--json", "-"]) == 0
    )
    told = json.loads(capsys.readouterr().out.partition("\n")[2])
    for body in read["bodies"]:
        state = told["entities"][body["name"]]
        kept = [*state["position"], state["angle"], *state["linear"], state["angular"]]
        if "moves" in body:
            assert recorder.motion[-1, body["moves"]].tolist() == np.array(kept, np.float32).tolist()
        else:
            assert body["pose"] == kept[:3]
    energies = dict(zip(read["energies"], columns[-1, 1:], strict=False))
    assert energies["total"] == np.float32(told["energy"]["final"])
    assert energies["gravity"] == np.float32(told["energy"]["potential_gravity"])


def swinging() -> World:
    """Return a bob on a rope that breaks after 0.394 s, with graphs of both."""
    world = World()
    bob = circle(world, (4.0, 4.0), radius=0.1, name="bob")
    rope = world.spawn(Rope(b=bob, anchor_a=(3.0, 4.0), breaks=20.0), name="rope")
    graph = world.spawn(Graph())
    for quantity, body in (("joint force", rope), ("x", bob), ("impulse y: gravity", None)):
        world.spawn(GraphLine(graph, quantity, body))
    return world


def test_a_joint_that_breaks_is_shown_until_then_and_keeps_its_name(tmp_path: Path) -> None:
    save_scene(swinging(), tmp_path / "scene.json")
    read = document(exported(tmp_path / "page.html", str(tmp_path / "scene.json"), "--seconds", "1"))
    [rope] = read["joints"]
    assert (rope["kind"], rope["b"]) == ("Rope", 0)
    assert rope["until"] == pytest.approx(0.394016, abs=1e-6)
    assert [one["name"] for one in read["quantities"]][3:] == [
        "rope: joint force",
        "bob: x",
        "impulse y: gravity",
    ]
    force = unpack(read["data"], read["instants"])[:, 1 + len(read["energies"]) + 3]
    assert (np.isfinite(force) == (np.arange(61) / 60.0 < rope["until"])).all()


def test_the_page_of_a_recorded_run_does_not_make_accounts_up() -> None:
    read = document(swinging().record(1.0).page())
    first = 1 + len(read["energies"]) + 3
    columns = unpack(read["data"], read["instants"])[:, first : first + 3]
    assert np.isfinite(columns[:, 1]).all(), "where the bob is was recorded"
    assert np.isnan(columns[:, 2]).all(), "the books of each instant were not"


def test_the_page_of_a_recorded_run_shows_a_joint_until_it_breaks() -> None:
    """It had none of the joints that broke: it was made from the world at the end."""
    run = swinging().record(1.0)
    for _ in range(2):
        read = document(run.page())
        [rope] = read["joints"]
        assert (rope["kind"], rope["until"]) == ("Rope", pytest.approx(0.394016, abs=1e-6))
        columns = unpack(read["data"], read["instants"])
        force = columns[:, 1 + len(read["energies"]) + 3]
        assert (np.isfinite(force) == (columns[:, 0] < rope["until"])).all()
        run = pickle.loads(pickle.dumps(run))


def test_the_page_of_a_run_of_another_process_has_what_crossed_its_gates() -> None:
    world = World()
    circle(world, (0.0, 3.0), radius=0.1, name="ball")
    world.spawn(Gate((-1.0, 2.0), (1.0, 2.0)))
    run = world.record(1.0)
    pages = [document(one.page())["gates"] for one in (run, pickle.loads(pickle.dumps(run)))]
    assert len(pages[0][0]["crossings"]) == 1
    assert pages[0] == pages[1]


def test_the_page_of_a_recorded_run_has_no_forces_of_soft_contacts() -> None:
    """A ball that lay on the floor had an acceleration of 9.81 m/s^2 there."""
    world = World(simulation=SimulationConfig(contacts="soft"))
    box(world, (0.0, -0.5), width=20.0, height=1.0, static=True)
    ball = circle(world, (0.0, 0.5), radius=0.3, restitution=0.6)
    world.spawn(GraphLine(world.spawn(Graph()), "acceleration y", ball))
    read = document(world.record(1.0).page())
    shown = unpack(read["data"], read["instants"])[:, 1 + len(read["energies"]) + 3]
    assert np.isnan(shown).all()


def test_every_spaces_the_instants(tmp_path: Path) -> None:
    read = document(exported(tmp_path / "page.html", "drop", "--seconds", "1", "--every", "0.25"))
    assert unpack(read["data"], read["instants"])[:, 0].tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]


def test_many_runs_have_thirty_instants_a_second(tmp_path: Path) -> None:
    vary = ("--vary", "ball.Mass.mass=1:2:2")
    read = all_of(exported(tmp_path / "page.html", "drop", "--seconds", "1", *vary))
    for run in read["runs"]:
        times = unpack(run["data"], run["instants"])[:, 0]
        assert np.abs(times - np.arange(31) / 30.0).max() < 1e-6


def test_the_view_of_a_page_holds_the_runs_of_all_its_values(tmp_path: Path) -> None:
    """A longer pendulum swung below the picture, which showed the window's view of the first one."""
    world = load_scene("pendulum")
    world.view = (-1.6, 0.5, 1.6, 3.3)
    save_scene(world, tmp_path / "scene.json")
    scene, seconds = str(tmp_path / "scene.json"), ("--seconds", "1")
    one = all_of(exported(tmp_path / "page.html", scene, *seconds))
    assert one["view"] == [*world.view]
    many = all_of(exported(tmp_path / "page.html", scene, *seconds, "--vary", "bob.Rod.length=1:3:3"))
    assert many["view"][1] < 0.0 < world.view[3] <= many["view"][3]
    for length, run in zip(
        (1.0, 2.0, 3.0), many["runs"], strict=True
    ):  # the first picture had the bob at 2 m
        columns, others = unpack(run["data"], run["instants"]), 1 + len(run["energies"])
        x, y = columns[:, others + len(run["quantities"]) :][:, :2].T
        assert np.hypot(x, y - 3.0) == pytest.approx(length, rel=1e-6)
        assert columns[:, others - 1] == pytest.approx(columns[0, others - 1], rel=1e-6), (
            "no energy was taken"
        )


def test_a_page_goes_on_from_the_time_of_its_scene(tmp_path: Path) -> None:
    world = load_scene("pendulum")
    world.run(seconds=2.0)
    save_scene(world, tmp_path / "later.json")
    read = document(exported(tmp_path / "page.html", str(tmp_path / "later.json"), "--seconds", "1"))
    assert read["start"] == 2.0 and unpack(read["data"], read["instants"])[0, 0] == 0.0


def test_bodies_springs_and_laws_are_described() -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(bounds=(-1, -2, 3, 4)))
    world.spawn(Transform((1, 2), 0.5), Shape.box(4, 1), name="wall")
    ball = world.spawn(
        Transform((0, 1)), Velocity((1, 0)), Mass(2.0), Shape.circle(0.5), Trail(3.0), Drag(0.1), name="ball"
    )
    world.spawn(Transform((5, 5)), name="mark")
    world.spawn(Transform(), Velocity((0, 1)), name="lift")
    world.spawn(Spring(a=ball, anchor_b=(0, 9)))
    recorder = RunRecorder(world)
    assert recorder.bodies(world) == [
        {
            "name": "wall", "kind": "box", "entity": 1, "pose": [1.0, 2.0, 0.5], "radius": 0.0,
            "core": [[2.0, 0.5], [-2.0, 0.5], [-2.0, -0.5], [2.0, -0.5]],
        },
        {
            "name": "ball", "kind": "circle", "entity": ball, "radius": 0.5, "core": [[0.0, 0.0]],
            "mass": 2.0, "inertia": 0.25, "trail": 3.0,
            "moves": 0,
        },
        {"name": "mark", "kind": "none", "entity": 3, "pose": [5.0, 5.0, 0.0]},
        {"name": "lift", "kind": "point", "entity": 4, "moves": 1},
    ]  # fmt: skip
    held = {"a": 1, "b": None, "anchor_a": [0.0, 0.0], "anchor_b": [0.0, 9.0], "rest": 1.0}
    assert springs_of(world) == [held]
    assert recorder.energies == ("kinetic", "gravity", "spring", "total")


def test_a_page_needs_nothing_else_and_its_texts_are_no_markup(tmp_path: Path) -> None:
    evil = '</script><script>alert(1)</script><b a="&'
    world = load_scene("drop")
    world.title, world.description = evil[:60], evil
    world.spawn(Transform((1, 1)), Velocity(), name=evil)
    save_scene(world, tmp_path / "evil.json")
    page = exported(tmp_path / "page.html", str(tmp_path / "evil.json"), "--seconds", "0.1").decode()
    assert page.count("<script") == 2 and page.count("</script>") == 2
    assert f"<title>{html.escape(evil[:60])}</title>" in page and f"<p>{html.escape(evil)}</p>" in page
    assert [body["name"] for body in document(page.encode())["bodies"]][-1] == evil
    assert "{{" not in page
    for word in ("http:", "https:", " src=", "url(", "@import", "fetch(", "XMLHttp", "WebSocket"):
        assert word not in page, word


def twenty_bodies(folder: Path) -> list[str]:
    """Return scenes of twenty bodies: on springs, and in a box with impacts all the time."""
    walls = (-1.5, -1.0, 1.5, 1.0)
    laws = PhysicsConfig(gravity_mode="none", bounds=walls, bounds_restitution=1.0, bounds_friction=0.0)
    world = World(*standard_systems(), physics=laws)
    gas(world, 20, walls)
    save_scene(world, folder / "twenty.json")
    return ["spring_chain", str(folder / "twenty.json"), "dominoes"]


def test_twenty_bodies_for_ten_seconds_take_less_than_300_kilobytes(tmp_path: Path) -> None:
    for scene in twenty_bodies(tmp_path):
        page = exported(tmp_path / "page.html", scene)
        assert sum("moves" in body for body in document(page)["bodies"]) == 20
        assert len(page) < 300_000, scene


@pytest.mark.slow
def test_the_page_is_the_same_in_however_many_processes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    vary = ["--seconds", "0.2", "--vary", "ball.Velocity.linear.x=1:5:16"]
    apart = exported(tmp_path / "apart.html", "drop", *vary)
    monkeypatch.setattr("os.cpu_count", lambda: 1)
    assert exported(tmp_path / "one.html", "drop", *vary) == apart


# ---- what is shown of it -----------------------------------------------------------------------------------


def framed(scene: str, seconds: float) -> tuple[float, float, float, float]:
    world, recorder = recorded(scene, seconds)
    return frame_run(recorder.bodies(world), recorder.motion, [])


def test_all_that_moves_is_framed() -> None:
    left, low, right, high = framed("drop", 5.0)
    assert -4.5 < left < -3.25 and 4.25 < high < 6.0 and -2.0 < low < 0.0 and 0.5 < right < 3.0


def test_what_leaves_the_ground_is_not_followed_far() -> None:
    left, low, right, high = framed("slope", 10.0)
    assert left < -7.7 and right > 4.0 and high > 2.0
    assert low > -10.0, "two blocks fall off"


def test_free_flight_is_followed() -> None:
    motion = np.zeros((61, 1, 6), np.float32)
    motion[:, 0, 0] = np.linspace(0.0, 20.0, 61)
    left, _, right, _ = frame_run([{"kind": "circle", "radius": 0.5, "moves": 0}], motion, [])
    assert left < -0.5 and 20.5 < right < 23.0


def test_what_falls_for_ever_is_not_followed() -> None:
    motion = np.zeros((601, 1, 6), np.float32)
    motion[:, 0, 1] = -4.905 * np.linspace(0.0, 100.0, 601) ** 2
    left, low, right, high = frame_run([{"kind": "circle", "radius": 0.5, "moves": 0}], motion, [])
    assert low > -50.0 and high > 0.5 and left < -0.5 and right > 0.5


def test_a_floor_of_a_kilometre_makes_no_speck_of_a_ball() -> None:
    corners = [(500.0, 0.5), (-500.0, 0.5), (-500.0, -0.5), (500.0, -0.5)]
    floor = {"kind": "box", "core": corners, "pose": [0.0, -0.5, 0.0]}
    ball = {"kind": "circle", "radius": 0.5, "moves": 0}
    motion = np.zeros((2, 1, 6), np.float32)
    left, low, right, _ = frame_run([floor, ball], motion, [])
    assert right - left < 20.0 and low < -0.5


@pytest.mark.parametrize("bodies", [[], [{"kind": "circle", "radius": 2.0, "pose": [7.0, 8.0, 0.0]}]])
def test_where_nothing_moves_there_is_a_frame_all_the_same(bodies: list[dict[str, Any]]) -> None:
    left, low, right, high = frame_run(bodies, np.zeros((2, 0, 6), np.float32), [])
    assert right > left and high > low
    for body in bodies:
        assert left < body["pose"][0] < right and low < body["pose"][1] < high


# ---- what is refused ---------------------------------------------------------------------------------------

REFUSED = [
    (["drop"], "one of the arguments --html --gif --mp4 is required"),
    (["drp", "--html", "x.html"], 'drp: no such file, and no built-in scene; did you mean "drop"?'),
    (["drop", "--html", ""], '--html "": must be a path, or - for stdout'),
    (["drop", "--html", "none/x.html"], "--html none/x.html: cannot be written: there is no directory"),
    (["drop", "--html", "/"], "--html /: cannot be written: / is a directory"),
    (["drop", "--html", "a\0b"], "--html a\\x00b: cannot be written"),
    *(
        (["drop", "--html", "x.html", option, value], f"argument {option}: '{value}': must be a finite num")
        for option in ("--seconds", "--every")
        for value in ("0", "-1", "nan", "inf", "long")
    ),
    (["drop", "--html", "x.html", "--seconds", "1e300"], "--seconds 1e+300: must be at most 1e+15 steps"),
    (
        ["gas", "--html", "x.html", "--seconds", "1000"],
        "--seconds 1000: 60,000 instants of 2,000 bodies; a page must hold at most 2,000,000 poses: fewer "
        "seconds, or a longer --every than 0.0167 s",
    ),
    (["drop", "--html", "x.html", "--seconds", "1e9"], "--seconds 1e+09: 60,000,000,000 instants of 1"),
    *(
        (["drop", "--html", "x.html", "--vary", text], line)
        for text, line in (
            ("ball.Mass.mass=1", "must be ID.Component.field=START:STOP:COUNT"),
            ("ball.Mass.mass=1:2:41", "a count from 2 to 40"),
            ("ball.Mass.mass=1:1:3", "two numbers that differ"),
            ("ball.Mass.mass=1:x:3", "must be START:STOP:COUNT"),
            ("bal.Mass.mass=1:2:3", 'there is no such entity; must be one of floor, ball; did you mean'),
            ("ball.Mas.mass=1:2:3", "unknown component Mas"),
            ("ball.Velocity.linear=1:2:3", "must be a part of it, .x or .y"),
            ("ball.Mass.mass.x=1:2:3", "must be a number, or a part of a vector"),
            ("ball.Shape.kind=1:2:3", "must be a number, or a part of a vector"),
            ("ball.Material.restitution=0:2:3", "2.0: must be a finite number from 0 to 1"),
            ("ball.Mass.mass=0:2:3", '0.0: must be a finite number > 0 kg'),
        )
    ),
    (
        ["drop", "--html", "x.html", *2 * ["--vary", "ball.Velocity.linear.x=1:2:3"]],
        "Velocity.linear: is varied twice; two sliders must be of two quantities",
    ),
    (["drop", "--html", "x.html", *3 * ["--vary", "ball.Mass.mass=1:2:3"]], "at most 2 sliders"),
    (
        ["drop", "--html", "x.html", "--seconds", "100",
         "--vary", "ball.Mass.mass=1:2:40", "--vary", "ball.Material.restitution=0:1:40"],
        "3,000 instants of 1 bodies in 1600 runs; a page must hold at most 2,000,000 poses",
    ),
    (["drop", "--gif", "x.gif", "--vary", "ball.Mass.mass=1:2:3"], "--vary: is for --html"),
    (["drop", "--html", "x.html", "--set", "ball.Mass.mass=0"], 'Mass.mass = "0": must be a finite number'),
]  # fmt: skip


@pytest.mark.parametrize(("arguments", "line"), REFUSED, ids=[ascii(row) for row in range(len(REFUSED))])
def test_bad_usage_is_refused_in_one_line_and_nothing_is_written(
    arguments: list[str], line: str, capsys: pytest.CaptureFixture[str],
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert cli.main(["export", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1 and line in err
    assert list(tmp_path.iterdir()) == []


def test_the_scene_is_not_overwritten(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = tmp_path / "scene.json"
    save_scene(load_scene("drop"), scene)
    before = scene.read_bytes()
    assert cli.main(["export", str(scene), "--html", str(scene)]) == 2
    assert capsys.readouterr().err.endswith("is the scene itself\n") and scene.read_bytes() == before


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_a_full_disk_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["export", "drop", "--seconds", "0.1", "--html", "/dev/full"]) == 1
    err = capsys.readouterr().err
    assert "--html /dev/full: cannot be written: No space left on device" in err and err.count("\n") == 1


def test_what_float32_does_not_hold_fails_with_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world = World(physics=PhysicsConfig(gravity_mode="none"))
    world.spawn(Transform((1e39, 0)), Velocity(), name="far")
    save_scene(world, tmp_path / "far.json")
    assert cli.main(["export", str(tmp_path / "far.json"), "--html", str(tmp_path / "page.html")]) == 1
    err = capsys.readouterr().err
    assert "far at t = 0 s: 1e+39 is more than a page can hold, 3.4e+38 at most; no page was written" in err
    assert not (tmp_path / "page.html").exists()


def test_a_run_that_diverges_leaves_the_old_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"))
    world.spawn(Transform(), Velocity((1e305, 0)), Mass(), name="fast")
    save_scene(world, tmp_path / "fast.json")
    page = tmp_path / "page.html"
    page.write_text("old")
    assert cli.main(["export", str(tmp_path / "fast.json"), "--html", str(page)]) == 1
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and "at t = " in err and "no page was written" in err
    assert page.read_text() == "old"


def test_the_page_goes_to_stdout_alone(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    assert cli.main(["export", "drop", "--seconds", "0.1", "--html", "-"]) == 0
    out, err = capfdbinary.readouterr()
    assert out.startswith(b"<!DOCTYPE html>") and out.endswith(b"</html>\n") and err == b""


# ---- colours -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_contrast(scheme: str) -> None:
    dark, light = (dict(re.findall(r"--([\w-]+): ([^;]+);", block)) for block in style().split("@media"))
    colours = dark if scheme == "dark" else {**dark, **light}

    def ratio(one: str, other: str) -> float:
        return contrast(rgb_of(colours[one]), rgb_of(colours[other]))

    for text in ("text", "faint"):
        assert min(ratio(text, "background"), ratio(text, "panel")) >= 4.5
    assert ratio("on-accent", "accent") >= 4.5
    for line in ("accent", "arrow", *(f"b{k}" for k in range(7))):
        assert min(ratio(line, sky) for sky in ("background", "sky_top", "sky_bottom")) >= 4.5, line
    for line in ("static", "spring", "rod", "rope"):
        assert ratio(line, "background") >= 3.0, line
