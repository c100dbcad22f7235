"""Warmup: kernels are compiled by other processes while the window stays awake."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pygame
import pytest

from physicslab.desktop import compiling
from physicslab.desktop.compiling import Compiling, Left
from physicslab.ecs.config import WindowConfig
from physicslab.kernels import motion, warm
from physicslab.kernels.warm import Progress, Warmup, is_warm, load_all
from physicslab.view.canvas.canvas import RecordingCanvas
from physicslab.view.canvas.display import Display, wants_to_leave
from physicslab.view.canvas.theme import DARK
from physicslab.view.panels.progress import draw_progress

ECHO = (sys.executable, "-c", "import sys\nfor line in sys.stdin: print(line.strip(), flush=True)")
_SLOWLY = "import sys, time\nfor line in sys.stdin: time.sleep(0.02); print(line, end='', flush=True)"
SLOW = (sys.executable, "-c", _SLOWLY)
ASLEEP = (sys.executable, "-c", "import time; time.sleep(60)")
BROKEN = (sys.executable, "-c", "import sys; sys.stdin.readline(); sys.exit(1)")


class Waiting:
    """A kernel that takes no time to load, and notes that it was."""

    declared_signature = None

    def __init__(self, name: str) -> None:
        self.__name__, self.__module__, self.compiled = name, "test", False

    def compile(self, signature: object) -> None: ...

    def disable_compile(self) -> None: ...


@pytest.fixture
def mark(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Put the mark of a full cache elsewhere."""
    monkeypatch.setattr(warm, "_mark", lambda: tmp_path / "complete")
    return tmp_path / "complete"


def wait_for(warmup: Warmup, seconds: float = 30.0) -> Progress:
    deadline = time.monotonic() + seconds
    while not warmup.finished:
        assert time.monotonic() < deadline
        warmup.poll()
        time.sleep(0.01)
    return warmup.poll()


@pytest.mark.parametrize("workers", [1, 3])
def test_every_kernel_is_given_out_once_and_the_cache_is_marked(mark: Path, workers: int) -> None:
    assert not is_warm()
    with Warmup(workers, ECHO) as warmup:
        progress = wait_for(warmup)
    assert progress.done == progress.total == len(load_all()) > 20
    assert is_warm() and mark.exists()


def test_a_worker_that_fails_ends_the_wait_without_the_mark(mark: Path) -> None:
    with Warmup(2, BROKEN) as warmup:
        progress = wait_for(warmup)
    assert progress.done == 0
    assert not is_warm()


def test_leaving_early_stops_the_workers(mark: Path) -> None:
    start = time.monotonic()
    with Warmup(2, ASLEEP) as warmup:
        assert warmup.poll().done == 0
        processes = list(warmup._processes)
    assert time.monotonic() - start < 20.0
    assert all(process.poll() is not None for process in processes)


def test_kernels_have_names_of_their_own() -> None:
    names = load_all()
    assert len(set(names)) == len(names)
    assert "physicslab.kernels.raster.paint_discs" in names


def test_the_mark_hangs_on_the_sources(tmp_path: Path) -> None:
    before = warm._mark()
    source = Path(warm.__file__)
    status = source.stat()
    os.utime(source, ns=(status.st_atime_ns, status.st_mtime_ns + 1_000_000_000))
    try:
        assert warm._mark() != before
    finally:
        os.utime(source, ns=(status.st_atime_ns, status.st_mtime_ns))
    assert warm._mark() == before


def test_a_worker_compiles_what_it_is_told() -> None:
    name = "physicslab.kernels.motion.clear"
    done = subprocess.run(
        [sys.executable, "-m", "physicslab.kernels", "worker"],
        input=f"{name}\n", capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout == f"{name}\n"


def test_the_window_shows_progress_and_stays_awake(mark: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiling, "Warmup", lambda: Warmup(1, SLOW))
    asleep = [Waiting("no kernel that is there")]
    with Display.open(WindowConfig(), "test") as display, Compiling(display) as waiting:
        waiting._wait(asleep)
        assert DARK.accent in {tuple(display.canvas.surface.get_at((x, 367)))[:3] for x in range(300, 980)}


@pytest.mark.parametrize("event", ["escape", "close"])
def test_the_user_may_leave_while_it_compiles(
    mark: Path, monkeypatch: pytest.MonkeyPatch, event: str
) -> None:
    monkeypatch.setattr(compiling, "Warmup", lambda: Warmup(1, ASLEEP))
    with Display.open(WindowConfig(), "test") as display, Compiling(display) as waiting:
        if event == "escape":
            pygame.event.post(pygame.Event(pygame.KEYDOWN, key=pygame.K_ESCAPE, mod=0))
        else:
            pygame.event.post(pygame.Event(pygame.QUIT))
        with pytest.raises(Left):
            waiting._wait([motion.clear])


@pytest.mark.parametrize("size", [(1280, 720), (480, 320), (200, 100)])
def test_the_bar_is_as_long_as_what_is_done(size: tuple[int, int]) -> None:
    canvas = RecordingCanvas(size)
    draw_progress(canvas, DARK, 0.25, "5 of 20")
    frame, filled = (call["rect"] for call in canvas.called("panel"))
    assert filled[2] == round(0.25 * frame[2])
    assert "5 of 20" in canvas.words


def test_while_it_waits_nothing_that_the_user_does_is_forgotten() -> None:
    with Display.open(WindowConfig(), "test"):
        pygame.event.clear()
        pygame.event.post(pygame.Event(pygame.MOUSEBUTTONUP, button=1, pos=(1, 1)))
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=pygame.K_p, mod=0))
        pygame.event.post(pygame.Event(pygame.KEYUP, key=pygame.K_p, mod=0))
        assert not wants_to_leave()
        kept = [event.type for event in pygame.event.get()]
        assert kept == [pygame.MOUSEBUTTONUP, pygame.KEYDOWN, pygame.KEYUP]


def test_what_is_asked_for_is_compiled_first(mark: Path) -> None:
    with Warmup(1, ECHO) as warmup:
        pass
    last = list(warmup._jobs)[-1]
    warmup.hurry([last, "no such kernel", last])
    assert warmup._jobs[0] == last
    assert sorted(set(warmup._jobs)) == sorted(warmup._jobs)


def test_what_is_waited_for_is_there_before_the_rest(mark: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The window goes on as soon as it has what it asked for, and says in a corner how far the rest is."""
    monkeypatch.setattr(compiling, "Warmup", lambda: Warmup(1, SLOW))
    with Display.open(WindowConfig(), "test") as display, Compiling(display) as waiting:
        waiting._wait([motion.clear])
        assert not waiting.finished
        waiting.advance(DARK)
        corner = {tuple(display.canvas.surface.get_at((x, 690)))[:3] for x in range(1000, 1270)}
        assert DARK.panel in corner


def test_kernels_are_loaded_in_frames_that_have_time_left(
    monkeypatch: pytest.MonkeyPatch, mark: Path
) -> None:
    mark.touch()
    asleep = [Waiting(name) for name in "abc"]
    monkeypatch.setattr(compiling, "KERNELS", asleep)
    with Display.open(WindowConfig(), "test") as display, Compiling(display) as waiting:
        monkeypatch.setattr(Display, "left", property(lambda self: 0.012))
        waiting.advance(DARK)
        assert [kernel.compiled for kernel in asleep] == [True, False, False]
        monkeypatch.setattr(Display, "left", property(lambda self: 0.001))
        for _ in range(28):
            waiting.advance(DARK)
        assert [kernel.compiled for kernel in asleep] == [True, False, False]
        waiting.advance(DARK)
        assert [kernel.compiled for kernel in asleep] == [True, True, False]


def test_the_window_knows_every_kernel_from_the_start() -> None:
    """What is in no imported module could not be loaded while there is time for it."""
    code = """
from physicslab.desktop import app
app._import("physicslab.desktop.session_window")
from physicslab.kernels import KERNELS
before = len(KERNELS)
from physicslab.kernels.warm import load_all
print(before, len(load_all()))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    before, after = done.stdout.split()
    assert before == after
