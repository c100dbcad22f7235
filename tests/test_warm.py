"""Warmup: kernels are compiled by other processes while the window stays awake."""

import math
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pygame
import pytest
from recording import RecordingCanvas

from physicslab.desktop import app, compiling
from physicslab.desktop.compiling import Compiling, Left
from physicslab.desktop.progress import draw_corner, draw_progress
from physicslab.ecs.config import WindowConfig
from physicslab.kernels import cache, keys, motion, warm
from physicslab.kernels.program import own_command
from physicslab.kernels.warm import WORKER, Progress, Warmup, is_warm, load_all, mark_warm, name_of
from physicslab.theme import DARK
from physicslab.view.canvas.display import Display, forget_clicks, wants_to_leave

ECHO = (sys.executable, "-c", "import sys\nfor line in sys.stdin: print(line.strip(), flush=True)")
_SLOWLY = "import sys, time\nfor line in sys.stdin: time.sleep(0.02); print(line, end='', flush=True)"
SLOW = (sys.executable, "-c", _SLOWLY)
SLOWER = (sys.executable, "-c", _SLOWLY.replace("0.02", "0.6"))
ASLEEP = (sys.executable, "-c", "import time; time.sleep(60)")
BROKEN = (sys.executable, "-c", "import sys; sys.stdin.readline(); sys.exit(1)")


class Waiting:
    """A kernel that takes no time to load, and notes that it was."""

    declared_signature = None

    def __init__(self, name: str, module: str = "test") -> None:
        self.__name__, self.__module__, self.compiled = name, module, False
        self.py_func = motion.clear.py_func  # type: ignore[attr-defined]

    def compile(self, signature: object) -> None: ...

    def disable_compile(self) -> None: ...


@pytest.fixture
def mark(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Let the cache be an empty folder, whatever is written there is a full one; return its mark."""
    monkeypatch.setattr(cache, "_directory", tmp_path)
    monkeypatch.setattr(warm, "mark_warm", lambda: cache.mark().write_text(""))
    return cache.mark()


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


@pytest.mark.skipif(os.name == "nt", reason="there a program is ended without signals")
def test_a_worker_that_is_ended_while_it_compiles_says_nothing(tmp_path: Path) -> None:
    environment = {**os.environ, "PHYSICSLAB_KERNELS": str(tmp_path)}
    with subprocess.Popen(
        own_command("kernels", WORKER),
        env=environment,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as worker:
        assert worker.stdin is not None and worker.stdout is not None and worker.stderr is not None
        print("physicslab.kernels.motion.clear", file=worker.stdin, flush=True)
        assert worker.stdout.readline()
        print("physicslab.kernels.solver.soft.advance", file=worker.stdin, flush=True)
        time.sleep(0.5)
        worker.terminate()
        assert worker.wait(20.0) == -signal.SIGTERM
        assert worker.stderr.read() == ""


def test_a_worker_that_fails_ends_the_wait_without_the_mark(mark: Path) -> None:
    with Warmup(2, BROKEN) as warmup:
        progress = wait_for(warmup)
    assert progress.done == 0
    assert not is_warm()


def test_leaving_early_stops_the_workers(mark: Path) -> None:
    with Warmup(2, ASLEEP) as warmup:
        assert warmup.poll().done == 0
        processes = list(warmup._processes)
    assert all(process.poll() for process in processes), "each was ended; asleep to its end it returns 0"


def test_kernels_have_names_of_their_own() -> None:
    names = load_all()
    assert len(set(names)) == len(names)
    assert "physicslab.kernels.raster.paint_rounded" in names


def plant(root: Path, names: Iterable[str]) -> None:
    """Put empty files where the compiled kernels of these names would be."""
    load_all()
    for jitted in warm._own():
        if name_of(jitted) in names:
            function = jitted.py_func
            folder = root / keys.folder_of(jitted.__module__)
            folder.mkdir(exist_ok=True)
            line = function.__code__.co_firstlineno
            (folder / f"{folder.name}.{function.__qualname__}-{line}.py312.nbi").touch()


def test_the_mark_says_that_every_kernel_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "_directory", tmp_path)
    names = load_all()
    plant(tmp_path, names[1:])
    mark_warm()
    assert not is_warm()
    plant(tmp_path, names)
    assert not is_warm()
    mark_warm()
    assert is_warm()
    shutil.rmtree(tmp_path / keys.folder_of("physicslab.kernels.raster"))
    assert not is_warm()


def test_the_mark_depends_on_the_sources(monkeypatch: pytest.MonkeyPatch) -> None:
    before = cache.mark()
    other = keys.current_folders() | {"motion": "motion-0"}
    monkeypatch.setattr(keys, "current_folders", lambda level: other)
    assert cache.mark() != before


def test_what_is_kept_is_not_compiled_again(mark: Path) -> None:
    """After an edit most of the cache is still right."""
    names = load_all()
    plant(mark.parent, names[2:])
    with Warmup(3, ECHO) as warmup:
        progress = wait_for(warmup)
        assert len(warmup._processes) <= 2
    assert progress.done == progress.total == len(names)


needs_priorities = pytest.mark.skipif(
    not hasattr(os, "setpriority"), reason="no priorities of processes here"
)


@needs_priorities
def test_the_first_kernel_is_compiled_alone_then_all_yield(
    mark: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On two processors a second compiler would take half of one from the first, or from the window."""
    given: list[tuple[int, int]] = []
    monkeypatch.setattr(os, "setpriority", lambda kind, process, value: given.append((process, value)))
    with Warmup(3, ECHO) as warmup:
        (first,) = list(warmup._processes)
        assert not given
        wait_for(warmup)
        assert len(warmup._processes) == 3 and warmup._processes[0] is first
        own = os.getpriority(os.PRIO_PROCESS, 0)
        lowered = {(process.pid, own + warm._NICENESS) for process in warmup._processes}
        assert set(given) == lowered


class CountingDisplay:
    """A display that counts how often it is shown."""

    def __init__(self) -> None:
        self.canvas, self.shown, self.left = RecordingCanvas((640, 480)), 0, 0.0
        self.density = 1.0

    def show(self) -> float:
        self.shown += 1
        return 0.0


def test_the_bar_is_drawn_where_it_changes(mark: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """To draw it 60 times a second took as much of the processor as the compilers."""
    workers = Warmup(1, SLOWER)
    monkeypatch.setattr(compiling, "wants_to_leave", lambda: False)
    display: Any = CountingDisplay()
    names = load_all()
    with workers, Compiling(display, workers) as waiting:
        start = time.monotonic()
        waiting._wait([Waiting(names[0].rpartition(".")[2], names[0].rpartition(".")[0])])
        seconds = time.monotonic() - start
    assert seconds > 0.5  # in which there were 30 frames
    assert display.shown <= 3 + waiting._progress.done + seconds


def test_a_window_that_loads_is_drawn_where_it_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(app, "_import", lambda *_: time.sleep(0.4))
    monkeypatch.setattr(app, "wants_to_leave", lambda: False)
    display: Any = CountingDisplay()
    workers: Any = None
    assert app._load(display, "nothing", workers)
    assert 1 <= display.shown <= 3
    monkeypatch.setattr(app, "wants_to_leave", lambda: True)
    assert not app._load(display, "nothing", workers)


@pytest.mark.parametrize("complete", [False, True])
def test_the_first_worker_starts_before_the_rest_is_imported(
    mark: Path, monkeypatch: pytest.MonkeyPatch, complete: bool
) -> None:
    if complete:
        mark.touch()
    imported: list[bool] = []
    monkeypatch.setattr(warm, "own_command", lambda *_: ASLEEP)
    monkeypatch.setattr(app, "import_module", lambda name: imported.append(workers.warmup is not None))
    with ExitStack() as at_end:
        workers: app._Workers = app._Workers(at_end)
        app._import("nothing", workers)
        assert imported[0] == (not complete)
        processes = [] if workers.warmup is None else list(workers.warmup._processes)
        assert len(processes) == (0 if complete else 1)
    assert all(process.poll() is not None for process in processes), "they end with the window"


def test_a_worker_compiles_what_it_is_given() -> None:
    name = "physicslab.kernels.motion.clear"
    done = subprocess.run(
        own_command("kernels", WORKER),
        input=f"{name}\n", capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout == f"{name}\n"


@pytest.mark.skipif(os.name != "posix", reason="signals to groups of processes")
def test_a_worker_ends_without_a_word(mark: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """One that was still importing told on stderr of the signal that ended it, or of Ctrl+C's."""
    says = "import signal, time; signal.signal(signal.SIGTERM, lambda *_: exit('ended by SIGTERM'))"
    with Warmup(1, (sys.executable, "-c", f"{says}; print(input(), flush=True); time.sleep(60)")) as warmup:
        (process,) = warmup._processes
        assert os.getpgid(process.pid) != os.getpgrp(), "it would get what a terminal sends"
        assert warmup._answers.get(timeout=30)
    assert process.returncode == -signal.SIGKILL and capfd.readouterr().err == ""


def test_the_window_shows_progress_and_stays_awake(mark: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    workers = Warmup(1, SLOW)
    asleep = [Waiting("no kernel that is there")]
    with Display.open(WindowConfig(), "test") as display, workers, Compiling(display, workers) as waiting:
        waiting._wait(asleep)
        assert DARK.accent in {tuple(display.canvas.surface.get_at((x, 367)))[:3] for x in range(300, 980)}


@pytest.mark.parametrize("event", ["escape", "close"])
def test_the_user_may_leave_while_it_compiles(
    mark: Path, monkeypatch: pytest.MonkeyPatch, event: str
) -> None:
    workers = Warmup(1, ASLEEP)
    with Display.open(WindowConfig(), "test") as display, workers, Compiling(display, workers) as waiting:
        if event == "escape":
            pygame.event.post(pygame.Event(pygame.KEYDOWN, key=pygame.K_ESCAPE, mod=0))
        else:
            pygame.event.post(pygame.Event(pygame.QUIT))
        with pytest.raises(Left):
            waiting._wait([motion.clear])


@pytest.mark.parametrize("size", [(1280, 720), (480, 320), (200, 100)])
@pytest.mark.parametrize("letters", [15, 40])
def test_the_bar_is_as_long_as_what_is_done(size: tuple[int, int], letters: int) -> None:
    canvas = RecordingCanvas(size)
    draw_progress(canvas, DARK, 0.25, "5 of 20", letters)
    frame, filled = (call["rect"] for call in canvas.called("panel"))
    assert filled[2] == round(0.25 * frame[2])
    assert "5 of 20" in canvas.words


@pytest.mark.parametrize("size", [12, 24])
def test_how_far_compiling_is_stands_within_the_world_beside_panels(size: int) -> None:
    """It lay over the panel at the right, in letters of one size."""
    canvas = RecordingCanvas((1280, 800))
    draw_corner(canvas, DARK, 0.54, (1000, 60), size)
    left, top, width, height = canvas.called("panel")[0]["rect"]
    assert left + width <= 1000 and top >= 60 and height > 1.5 * size and width > 6 * size
    assert "Compiling: 54%" in canvas.words


def test_while_it_waits_nothing_that_the_user_does_is_forgotten() -> None:
    with Display.open(WindowConfig(), "test"):
        pygame.event.clear()
        pygame.event.post(pygame.Event(pygame.MOUSEBUTTONUP, button=1, pos=(1, 1)))
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=pygame.K_p, mod=0))
        pygame.event.post(pygame.Event(pygame.KEYUP, key=pygame.K_p, mod=0))
        assert not wants_to_leave() and pygame.event.peek(pygame.MOUSEBUTTONUP)
        forget_clicks()  # before the first picture: there was nothing to click on
        assert [event.type for event in pygame.event.get()] == [pygame.KEYDOWN, pygame.KEYUP]


def test_what_is_needed_is_compiled_first(mark: Path) -> None:
    with Warmup(1, ECHO) as warmup:
        pass
    *_, cheap, last = sorted(warmup._jobs, key=lambda name: -warmup._costs[name])
    dear, waited = max(warmup._jobs, key=warmup._costs.__getitem__), list(warmup._jobs)[-3]
    spent = {dear: 1.0, cheap: 1.0, last: 0.0, "no such kernel": 1.0}
    warmup.hurry(spent)
    warmup.hurry({waited: math.inf})
    assert [warmup._next() for _ in range(4)] == [waited, cheap, dear, last]
    assert sorted(set(warmup._jobs)) == sorted(warmup._jobs)


def test_what_is_waited_for_is_there_before_the_rest(mark: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The window goes on as soon as it has what it asked for, and says in a corner how far the rest is."""
    workers = Warmup(1, SLOW)
    with Display.open(WindowConfig(), "test") as display, workers, Compiling(display, workers) as waiting:
        waiting._wait([motion.clear])
        assert not waiting.finished
        waiting.advance(DARK)
        corner = {tuple(display.canvas.surface.get_at((x, 14)))[:3] for x in range(1000, 1270)}
        assert DARK.panel in corner


def test_a_worker_that_ends_before_it_is_given_anything_is_no_error(mark: Path) -> None:
    warmup = Warmup(1, (sys.executable, "-c", "pass"))
    process = subprocess.Popen(
        (sys.executable, "-c", "pass"), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
    )
    process.wait()
    warmup._employ(process)
    assert process.stdin is not None and process.stdin.closed


def test_a_frame_that_loads_a_kernel_makes_fewer_steps(mark: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    workers = Warmup(1, ASLEEP)
    monkeypatch.setattr(Compiling, "_is_kept", lambda *_: True)
    monkeypatch.setattr(Display, "left", property(lambda self: 0.0))
    with Display.open(WindowConfig(), "test") as display, workers, Compiling(display, workers) as started:
        waiting: list[Any] = [Waiting("a"), Waiting("b")]
        started.scenes.kernels = list(waiting)
        usual = started.time_for_steps(0.1)
        started.advance(DARK)
        assert not waiting[0].compiled, "it comes in the next frame"
        assert started.time_for_steps(0.1) < usual < 0.1
        started.advance(DARK)
        assert waiting[0].compiled and not waiting[1].compiled
        started.advance(DARK)
        assert waiting[1].compiled
        started.advance(DARK)
        assert started.time_for_steps(0.1) == 0.1


def test_kernels_are_loaded_in_frames_that_have_time_left(
    monkeypatch: pytest.MonkeyPatch, mark: Path
) -> None:
    mark.touch()
    asleep = [Waiting(name) for name in "abc"]
    monkeypatch.setattr(compiling, "KERNELS", asleep)
    with Display.open(WindowConfig(), "test") as display, Compiling(display, None) as waiting:
        monkeypatch.setattr(Display, "left", property(lambda self: 0.012))
        waiting.advance(DARK)
        assert [kernel.compiled for kernel in asleep] == [True, False, False]
        monkeypatch.setattr(Display, "left", property(lambda self: 0.001))
        for _ in range(28):
            waiting.advance(DARK)
        assert [kernel.compiled for kernel in asleep] == [True, False, False]
        waiting.advance(DARK)
        assert [kernel.compiled for kernel in asleep] == [True, True, False]


def test_the_window_lists_every_kernel_from_the_start() -> None:
    """What is in no imported module could not be loaded while there is time for it."""
    code = """
from contextlib import ExitStack
from physicslab.desktop import app
with ExitStack() as at_end:
    app._import("physicslab.desktop.session_window", app._Workers(at_end))
from physicslab.kernels import KERNELS
before = len(KERNELS)
from physicslab.kernels.warm import load_all
print(before, len(load_all()))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    before, after = done.stdout.split()
    assert before == after
