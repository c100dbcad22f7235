"""Films of runs: the GIF is read back picture by picture; nothing is left where one cannot be made."""

from __future__ import annotations

import importlib.util
import io
import math
import os
import re
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from desk import bits
from films import shown_pictures, unpacked
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from physicslab import PhysicsConfig, SimulationConfig, World, circle, cli, load_scene
from physicslab.components import Note, Transform
from physicslab.diagnostics.energy import measure_account
from physicslab.export.film import Film, check_encoder
from physicslab.export.gif import GifWriter, find_palette
from physicslab.export.instants import Instants
from physicslab.kernels.lzw import CODES, pack_lzw
from physicslab.view.overlay.moving import MovingPicture

ROOT = Path(__file__).parent.parent
HAS_VIDEO = importlib.util.find_spec("imageio_ffmpeg") is not None
needs_video = pytest.mark.skipif(
    not HAS_VIDEO, reason="needs the extra: uv run --extra video pytest -m video"
)
VIDEO = pytest.param(".mp4", marks=[pytest.mark.video, needs_video])


def noise(seed: int, count: int, size: tuple[int, int] = (40, 30)) -> list[NDArray[np.uint8]]:
    """Return pictures of random pixels, of which a part changes from one to the next."""
    rng = np.random.default_rng(seed)
    pictures = [rng.integers(0, 256, (size[1], size[0], 4), np.uint8)]
    for _ in range(count - 1):
        last = pictures[-1].copy()
        last[5:20, 7:9] = rng.integers(0, 256, (15, 2, 4), np.uint8)
        pictures.append(last)
    return pictures


def gif(pictures: list[NDArray[np.uint8]], rate: float) -> bytes:
    """Return the GIF film of pictures."""
    file = io.BytesIO()
    writer = GifWriter(file, (pictures[0].shape[1], pictures[0].shape[0]), rate)
    for picture in pictures:
        writer.write(picture)
    writer.close()
    return file.getvalue()


# ---- the file ----------------------------------------------------------------------------------------------


@given(st.integers(2, 8), st.integers(1, 30_000), st.integers(1, 256), st.integers(0, 2**31))
def test_what_is_compressed_can_be_read_back(depth: int, count: int, used: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    numbers = rng.integers(0, min(used, 1 << depth), count, np.uint8)
    numbers[: count // 2] = numbers[0]  # and long runs of one number
    packed = np.empty(2 * count + 16, np.uint8)
    size = pack_lzw(numbers, depth, np.full((CODES, 256), 77, np.int16), packed)
    assert unpacked(packed[:size].tobytes(), depth) == numbers.tolist()


def test_few_colours_stay_as_they_are() -> None:
    rng = np.random.default_rng(1)
    colours = (rng.permutation(256)[:200, None] * np.array([1, 3, 7])).astype(np.uint8)
    pixels = colours[rng.integers(0, len(colours), 5000)]
    palette, chosen = find_palette(pixels, 255)
    assert np.abs(palette[chosen].astype(int) - pixels).max() <= 3


def test_many_colours_become_those_that_are_near() -> None:
    picture = MovingPicture((640, 360), (-4, -1, 4, 3)).pixels(load_scene("pyramid"))
    pixels = picture.reshape(-1, 4)[:, :3]
    assert len(np.unique(pixels, axis=0)) > 3000  # bodies are lit
    palette, chosen = find_palette(pixels, 255)
    error = np.abs(palette[chosen].astype(int) - pixels)
    assert len(palette) <= 255 and error.max() <= 32 and error.mean() < 0.9


def test_a_film_is_shown_as_it_was_made() -> None:
    pictures = noise(2, 12)
    pictures.insert(5, pictures[4])  # one in which nothing changes
    film = shown_pictures(gif(pictures, 30.0))
    assert film.loops and len(film.pictures) == 13
    assert sum(film.delays) == round(100 * 13 / 30) and set(film.delays) == {3, 4}
    for seen, made in zip(film.pictures, pictures, strict=True):
        assert np.abs(seen.astype(int) - made[:, :, :3]).mean() < 16.0  # 1,200 colours at random
    assert (film.pictures[5] == film.pictures[4]).all()


# ---- the command -------------------------------------------------------------------------------------------


def test_a_film_has_the_pictures_of_the_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "drop.gif"
    command = ["export", "drop", "--gif", str(path), "--seconds", "1", "--every", "0.1", "--size", "320x200"]
    assert cli.main(command) == 0
    said = capsys.readouterr().out
    assert "11 pictures of 320 x 200 px, 10 a second" in said
    film, world = shown_pictures(path.read_bytes()), load_scene("drop")
    assert film.delays == [10] * 11 and film.loops
    assert world.view is not None
    camera = MovingPicture((320, 200), world.view)
    for n, seen in enumerate(film.pictures):
        if n:
            world.run(steps=6)
        error = np.abs(seen.astype(int) - camera.pixels(world)[:, :, :3])
        assert seen.shape == (200, 320, 3) and error.max() <= 24 and error.mean() < 0.3
    moved = np.abs(film.pictures[-1].astype(int) - film.pictures[0]).max()
    assert moved > 50


def test_pictures_are_of_their_own_instants_where_steps_end_at_others(tmp_path: Path) -> None:
    """With steps of .02 s a ball at 30 m/s was up to .6 m ahead in some of 30 pictures a second."""
    scene, path = tmp_path / "fast.json", tmp_path / "fast.gif"
    scene.write_text(
        '{"format": "physicslab-scene/1", "physics": {"gravity_mode": "none"}, "simulation": {"dt": 0.02},'
        '"entities": [{"id": "ball", "Transform": {"position": [0, 0]}, "Velocity": {"linear": [30, 0]},'
        '"Mass": {"mass": 1}, "Shape": {"kind": "circle", "radius": 0.5}}]}'
    )
    command = ["export", str(scene), "--gif", str(path), "--seconds", "0.4", "--size", "900x300"]
    assert cli.main(command) == 0
    pictures = [picture.astype(float) for picture in shown_pictures(path.read_bytes()).pictures]
    weights = [np.abs(picture - pictures[0][0, 0]).sum(axis=(0, 2)) for picture in pictures]
    middles = np.array([weight @ np.arange(900) / weight.sum() for weight in weights])
    assert len(pictures) == 13
    assert np.diff(middles, n=2) == pytest.approx(0.0, abs=0.5)  # 30 px from one to the next


@pytest.mark.parametrize("contacts", ["rigid", "soft"])
def test_between_steps_a_body_is_on_its_path_and_the_run_keeps_its_bits(contacts: str) -> None:
    laws = PhysicsConfig(bounds=(0.0, 0.0, 10.0, 10.0), bounds_restitution=1.0)
    worlds = [World(physics=laws, simulation=SimulationConfig(dt=0.02, contacts=contacts)) for _ in "ab"]
    for world in worlds:
        circle(world, (1.0, 2.0), radius=0.5, velocity=(1.0, 0.0), restitution=1.0, friction=0.0, name="ball")
    seen: list[tuple[float, float, float]] = []

    def show(world: World) -> None:
        seen.append((world.time, *world.component("ball", Transform).position))

    instants = Instants(worlds[0], 1 / 30, show)
    assert instants.spacing == 0.0
    account = measure_account(worlds[0])
    instants.keep(worlds[0], account)
    for _ in worlds[0].stepping(seconds=1.0, stride=1):
        instants.keep(worlds[0], account)
    worlds[1].run(seconds=1.0)
    assert bits(worlds[0]) == bits(worlds[1])
    times, x, y = np.array(seen).T
    assert times == pytest.approx(np.arange(31) / 30, abs=1e-9)
    down = math.sqrt(2.0 * 1.5 / 9.81)
    after = np.abs((times + down) % (2.0 * down) - down)  # since or until the nearest top
    assert x == pytest.approx(1.0 + times, abs=1e-9)
    assert y == pytest.approx(2.0 - 0.5 * 9.81 * after**2, abs=1e-9 if contacts == "rigid" else 2e-3)


def test_a_scene_that_does_not_say_what_is_seen_is_framed_by_its_run(tmp_path: Path) -> None:
    scene, path = tmp_path / "far.json", tmp_path / "far.gif"
    scene.write_text(
        '{"format": "physicslab-scene/1", "physics": {"gravity_mode": "none"}, "entities": [{"id": "ball",'
        '"Transform": {"position": [0, 0]}, "Velocity": {"linear": [10, 0]}, "Mass": {"mass": 1},'
        '"Shape": {"kind": "circle", "radius": 1}}]}'
    )
    command = ["export", str(scene), "--gif", str(path), "--seconds", "1", "--every", "0.5"]
    assert cli.main(command) == 0
    first, *_, last = shown_pictures(path.read_bytes()).pictures
    middle = [
        float(np.abs(picture.astype(int) - 20).sum(axis=(0, 2)) @ np.arange(960)) for picture in (first, last)
    ]
    assert middle[1] > 1.02 * middle[0]  # it is seen at the end as well, further to the right


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["--gif", "no/such/place/a.gif"], "there is no directory"),
        (["--gif", "a.png"], "the name of a film ends in .gif or .mp4"),
        (["--gif", "-"], "a film does not go to stdout"),
        (["--gif", "a.gif", "--fps", "60"], "at most 50 pictures a second, not 60"),
        (["--gif", "a.gif", "--fps", "nan"], "must be a number > 0"),
        (["--gif", "a.gif", "--fps", "0.001"], "at least 0.002 pictures a second, not 0.001: see --fps"),
        (["--gif", "a.gif", "--every", "700"], "at least 0.002 pictures a second, not 0.00142857: see --fps"),
        (["--gif", "a.gif", "--fps", "1e-320"], "at least 0.002 pictures a second"),
        (["--gif", "a.gif", "--size", "0x9"], "must be WIDTHxHEIGHT"),
        (["--gif", "a.gif", "--mp4", "a.mp4"], "not allowed with"),
        (["--html", "a.html", "--fps", "30"], "is for --gif and --mp4"),
        ([], "is required"),
    ],
)
def test_what_cannot_be_filmed_is_refused_in_one_line(
    arguments: list[str], reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert cli.main(["export", "drop", *arguments]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1 and reason in said.err
    assert os.listdir(tmp_path) == []


def test_without_the_extra_one_line_says_what_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", {"pygame": 1, "imgui_bundle": 1}.get)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert cli.main(["export", "drop", "--mp4", str(tmp_path / "a.mp4")]) == 2
    said = capsys.readouterr()
    assert said.err.count("\n") == 1 and "pip install 'physicslab[video]'" in said.err
    assert os.listdir(tmp_path) == []


def test_a_full_disk_leaves_the_old_film(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    path = tmp_path / "old.gif"
    path.write_text("old")
    monkeypatch.setattr(GifWriter, "write", full)
    assert cli.main(["export", "drop", "--gif", str(path), "--seconds", "1"]) == 1
    said = capsys.readouterr()
    assert "No space left on device" in said.err and said.err.count("\n") == 1
    assert path.read_text() == "old" and os.listdir(tmp_path) == ["old.gif"]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such limit")
@pytest.mark.parametrize("ending", [".gif", VIDEO])
def test_a_limit_of_the_system_leaves_no_film(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"old{ending}"
    path.write_text("old")
    limited = (
        "import resource, signal, sys; from physicslab.cli import main; file = sys.argv[1];"
        f"command = ['export', 'pyramid', '--seconds', '3', '--{ending[1:]}'];"
        f"main([*command, file + '{ending}', '--every', '1']);"  # what is imported is kept as it is
        "resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000));"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN); sys.exit(main([*command, file]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", limited, str(path)], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and "cannot be written" in done.stderr
    assert path.read_text() == "old" and sorted(os.listdir(tmp_path)) == [path.name, path.name + ending]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such signal")
@pytest.mark.parametrize("ending", [".gif", VIDEO])
def test_an_interrupted_film_leaves_nothing(ending: str, tmp_path: Path) -> None:
    command = [
        sys.executable,
        "main.py",
        "export",
        "gas",
        "--seconds",
        "1000",
        f"--{ending[1:]}",
        f"{tmp_path}/a{ending}",
    ]
    # What is started in the background ignores this signal, and so do the programs that it starts.
    heed = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    with subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True, preexec_fn=heed) as program:
        deadline = time.monotonic() + 60.0
        while not any(path.stat().st_size > 10_000 for path in tmp_path.glob(".*-tmp")):
            assert program.poll() is None and time.monotonic() < deadline
            time.sleep(0.05)
        program.send_signal(signal.SIGINT)
        assert program.wait(20.0) == 130
        assert program.stderr is not None
        said = program.stderr.read()
    assert re.fullmatch(r"physicslab: interrupted; gas: at t = \S+ s, after \d+ of 60000 steps\n", said)
    assert os.listdir(tmp_path) == []


@pytest.mark.video
@needs_video
def test_an_mp4_film_has_the_size_the_length_and_the_colours(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "drop.mp4"
    command = ["export", "drop", "--mp4", str(path), "--seconds", "1", "--every", "0.1", "--size", "321x201"]
    assert cli.main(command) == 0 and "11 pictures of 320 x 200 px" in capsys.readouterr().out
    ffmpeg = check_encoder()
    probe = subprocess.run([ffmpeg, "-i", str(path)], capture_output=True, text=True).stderr
    assert "320x200" in probe and "h264" in probe and re.search(r"\b10 fps", probe)
    assert "Duration: 00:00:01.10" in probe
    raw = subprocess.run(
        [ffmpeg, "-loglevel", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
        capture_output=True,
    ).stdout
    pictures = np.frombuffer(raw, np.uint8).reshape(-1, 200, 320, 3)
    world = load_scene("drop")
    assert len(pictures) == 11 and world.view is not None
    made = MovingPicture((321, 201), world.view).pixels(world)[:200, :320, :3]
    assert np.abs(pictures[0].astype(int) - made).mean() < 4.0


def test_a_film_that_is_given_up_leaves_the_file_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "a.gif"
    path.write_text("old")
    film = Film(path, (40, 30), 20.0)
    film.write(noise(3, 1)[0])
    film.give_up()
    assert path.read_text() == "old" and os.listdir(tmp_path) == ["a.gif"]


def test_what_measures_is_in_the_film() -> None:
    world = load_scene("drop")
    camera = MovingPicture((320, 200), (-2, -1, 2, 3))
    before = camera.pixels(world)
    world.spawn(Note("a word", place=(0, 2)))
    changed = (camera.pixels(world) != before).any(axis=2)
    assert 20 < np.count_nonzero(changed) < 4000
