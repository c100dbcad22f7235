"""The sandbox as a whole: frames of any length, a world that diverges, the window's loop."""

import itertools
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from types import SimpleNamespace

import pygame
import pytest
from desk import FRAME, Desk, bits, empty_world
from recording import RecordingCanvas

from physicslab import cli
from physicslab.components import Transform, Velocity
from physicslab.desktop import app
from physicslab.desktop.app import open_window
from physicslab.desktop.progress import draw_loading
from physicslab.desktop.sandbox import Sandbox
from physicslab.ecs.config import WindowConfig
from physicslab.files.scene import SceneError, load_scene
from physicslab.kernels import warm
from physicslab.prefabs import box, circle
from physicslab.systems.system import Stage, System, at
from physicslab.theme import DARK, Theme
from physicslab.view.canvas import display
from physicslab.view.canvas.canvas import Canvas
from physicslab.view.canvas.display import Display
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.window.window import Window
from physicslab.world import World


@pytest.mark.parametrize("name", ["sandbox", "newtons_cradle", "two_planets"])
def test_the_frame_rate_changes_no_bit(name: str) -> None:
    outcomes = set()
    for frames in ([1 / 60] * 120, [1 / 30] * 60, [1 / 144] * 288, [0.004, 0.05, 0.071] * 16):
        desk = Desk(load_scene(name), RecordingCanvas((1280, 720)))
        for elapsed in frames:
            desk.frames(1, elapsed)
        desk.frames(1, 2.0 - sum(frames))
        outcomes.add((bits(desk.world), desk.world.steps, desk.world.time))
    assert len(outcomes) == 1
    assert desk.world.steps == 120


def test_a_long_frame_is_clamped_and_what_is_dropped_is_shown() -> None:
    world = empty_world()
    circle(world, (0, 0))
    desk = Desk(world)
    desk.frames(1, elapsed=3.0)
    assert world.steps == 6  # max_dt is 0.1 s
    assert desk.window.pace.dropped == pytest.approx(2.9)


class Sluggish(System):
    """Makes the clock go on by a while in every step."""

    def __init__(self) -> None:
        self.now = 0.0

    def clock(self) -> float:
        return self.now

    @at(Stage.FINISH)
    def dawdle(self, world: World, h: float) -> None:
        self.now += 0.06


def test_a_world_too_heavy_runs_slowly_and_leaves_the_window_awake() -> None:
    sluggish = Sluggish()
    world = empty_world()
    world.install(sluggish)
    circle(world, (0, 0))
    sandbox = Sandbox(world, Window(RecordingCanvas((800, 600))), clock=sluggish.clock)
    sandbox.frame(0.1)
    assert world.steps == 2  # of six
    assert sandbox.window.pace.dropped == pytest.approx(4 * FRAME)


def test_slow_motion_is_as_smooth_as_full_speed() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0), velocity=(1, 0))
    desk = Desk(world)
    desk.key("tab")
    places = []
    for _ in range(12):
        desk.frames()
        places.append(world.component(ball, Transform).position.x)
    steps = [after - before for before, after in itertools.pairwise(places)]
    assert steps == pytest.approx([0.25 * FRAME] * 11)


def test_a_world_that_diverges_is_paused_and_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    world = empty_world()
    ball = circle(world, (0, 0), name="ball")
    desk = Desk(world)
    desk.frames(2)
    world.table(Velocity)["linear"][world.entity_index.row_of[ball]] = float("nan")
    desk.frames(3)
    assert desk.window.pace.due(FRAME) == 0
    assert "ball" in desk.window.error and "no longer finite" in desk.window.error
    desk.key("space")  # the last good state goes on
    desk.frames(3)
    assert (desk.window.pace.paused, desk.window.error) == (False, "")
    world.table(Velocity)["linear"][world.entity_index.row_of[ball]] = float("nan")
    desk.frames(3)
    assert desk.window.error and desk.window.pace.due(FRAME) == 0
    desk.key("r")
    desk.key("space")
    desk.frames(3)
    assert desk.window.error == "" and world.steps > 2


def test_a_scene_opens_at_100_px_per_metre_if_it_fits_and_smaller_if_not() -> None:
    small, large = empty_world(), empty_world()
    circle(small, (3, 2))
    circle(small, (2, 0))
    box(large, (0, 0), width=80, height=1)
    canvas = RecordingCanvas((1280, 720))
    for world, scale in ((small, 100.0), (large, 1280 * 0.86 / 80)):
        window = Window(canvas)
        Sandbox(world, window)
        assert window.camera.scale <= scale
    assert Window(canvas).camera.scale == 100.0


def test_a_view_that_was_not_touched_follows_the_size_of_the_window() -> None:
    canvas = RecordingCanvas((1280, 720))
    world = load_scene("sandbox")
    sandbox = Sandbox(world, Window(canvas))
    camera = sandbox.window.camera
    sandbox.frame(FRAME)
    canvas.size = (640, 360)
    sandbox.frame(FRAME)
    assert camera.size == (640, 360) and camera.scale < 60.0
    camera.pan(30, 0)
    scale, centre = camera.scale, camera.centre
    canvas.size = (1280, 720)
    sandbox.frame(FRAME)
    assert (camera.scale, camera.centre) == (scale, centre)


def test_installed_twice_is_refused() -> None:
    world = empty_world()
    window = Window(RecordingCanvas((800, 600)))
    Sandbox(world, window)
    with pytest.raises(ValueError, match="twice"):
        Sandbox(world, window)


_MOST_FRAMES = 1000


@pytest.fixture
def each_frame(
    monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Callable[[Callable[[Display, int], None]], None]]:
    """Have something done whenever a frame is shown of a real window that nobody has opened before."""
    monkeypatch.setattr(warm, "is_warm", lambda: True)
    for name in ("XDG_STATE_HOME", "LOCALAPPDATA"):
        monkeypatch.setenv(name, str(tmp_path_factory.mktemp("state")))
    show, shown = Display.show, [0]

    def install(deed: Callable[[Display, int], None]) -> None:
        def watched(display: Display) -> float:
            shown[0] += 1
            assert shown[0] <= _MOST_FRAMES, "the window does not close"
            deed(display, shown[0])
            return show(display)

        monkeypatch.setattr(Display, "show", watched)

    yield install
    pygame.quit()


def press(key: int) -> None:
    pygame.event.post(pygame.Event(pygame.KEYDOWN, key=key, mod=0, unicode="", scancode=0))


type EachFrame = Callable[[Callable[[Display, int], None]], None]


def test_the_window_opens_on_the_playground_and_escape_closes_it(each_frame: EachFrame) -> None:
    captions: list[str] = []
    pressed: list[int] = []

    def deed(display: Display, frame: int) -> None:
        captions.append(pygame.display.get_caption()[0])
        assert pygame.display.get_window_size() == (1280, 720)
        if frame >= 10 and frame % 4 == 0:
            pressed.append(frame)
            press(pygame.K_ESCAPE)

    each_frame(deed)
    assert open_window(None) == 0
    # The first puts the cards of the first minute away; the second may have been meant for them.
    assert len(pressed) == 3
    assert captions[0] == "PhysicsLab" and captions[-1] == "Sandbox - PhysicsLab"
    assert not pygame.display.get_init()


@pytest.mark.parametrize(
    ("screen", "size"), [((800, 600), (800, 600)), ((1366, 768), (1280, 720)), ((320, 1200), (640, 720))]
)
def test_the_window_is_no_larger_than_the_screen(
    screen: tuple[int, int], size: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its edges, with menus and panels, were beyond those of a small one."""
    monkeypatch.setattr(display, "_INVISIBLE", ())
    monkeypatch.setattr(pygame.display, "get_desktop_sizes", lambda: [screen])
    with Display.open(WindowConfig(), "small") as opened:
        assert opened.canvas.size == size


def test_f12_keeps_a_screenshot(
    each_frame: EachFrame, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)

    def deed(display: Display, frame: int) -> None:
        if frame in (3, 5):
            press(pygame.K_F12)
        if frame == 8:
            press(pygame.K_ESCAPE)

    each_frame(deed)
    assert open_window("drop") == 0
    pictures = list(tmp_path.glob("physicslab-*.png"))
    assert len(pictures) == 2
    assert pygame.image.load(pictures[0]).get_size() == (1280, 720)


def test_a_screenshot_that_cannot_be_saved_is_no_crash(
    each_frame: EachFrame, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(display: Display, directory: Path) -> Path:
        raise PermissionError(13, "Permission denied", str(directory))

    monkeypatch.setattr(Display, "save_screenshot", refuse)

    def deed(display: Display, frame: int) -> None:
        press(pygame.K_F12 if frame == 2 else pygame.K_ESCAPE)

    each_frame(deed)
    assert open_window("drop") == 0


def test_a_bad_scene_is_refused_before_a_window_opens(monkeypatch: pytest.MonkeyPatch) -> None:
    def no_window(*arguments: object) -> None:
        raise AssertionError("a window was opened")

    monkeypatch.setattr(pygame.display, "set_mode", no_window)
    assert cli.main(["no_such_scene"]) == 2
    with pytest.raises(SceneError, match="no such file"):
        load_scene("no_such_scene")


def test_no_screen_is_an_os_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SDL_VIDEODRIVER", "no such driver")
    pygame.quit()
    with pytest.raises(OSError, match="no window can be opened"):
        open_window("drop")


def test_frames_are_due_at_fixed_times_and_a_late_one_delays_all_that_follow(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now, waits = [100.0], []

    def sleep(seconds: float) -> None:
        waits.append(seconds)
        now[0] += seconds + 0.003  # it wakes late, as schedulers do

    clock = SimpleNamespace(perf_counter=lambda: now[0], sleep=sleep)
    monkeypatch.setattr("physicslab.view.canvas.display.time", clock)
    display = Display(PygameCanvas(pygame.Surface((8, 8))), fps=50)
    elapsed = []
    for work in (0.004, 0.004, 0.017, 0.05, 0.004):
        now[0] += work
        elapsed.append(display.wait())
    assert waits == pytest.approx([0.016, 0.013, 0.0, 0.0, 0.013])
    assert elapsed == pytest.approx([0.023, 0.02, 0.02, 0.053, 0.02])


STARTS = """
import sys, types
from physicslab.view.canvas.display import Display
show, seen = Display.show, []

def watched(display):
    seen.append("numba" in sys.modules)
    if len(seen) == 1:
        pixels = display.canvas.surface
        seen.append(len({tuple(pixels.get_at((x, 270))) for x in range(500, 780)}) > 2)
    return show(display)

Display.show = watched
sys.modules["physicslab.desktop.session_window"] = None  # nothing is to be run in it
import physicslab.cli
try:
    physicslab.cli.main(["drop"])
except ImportError:
    pass
print(seen[:2])
"""


def test_the_window_is_there_before_numba_is_imported() -> None:
    done = subprocess.run([sys.executable, "-c", STARTS], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[False, True]"


def test_the_package_alone_imports_neither_numba_nor_pygame() -> None:
    code = "import sys, physicslab; print(sorted({'numba', 'numpy', 'pygame'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


@pytest.mark.parametrize(
    "content", ['{"language": "de", "colours": "projector", "text": 2.0}', '{"language": "de"', "[1]"]
)
def test_what_is_said_while_it_loads_is_in_the_chosen_language_and_size(
    content: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "preferences.json"
    path.write_text(content)
    said: list[tuple[str, str, int]] = []

    def load(canvas: Canvas, theme: Theme, remark: str, size: int) -> None:
        draw_loading(canvas, theme, remark, size)
        said.append((theme.name, canvas.language.reword("Loading, 3 s"), size))

    monkeypatch.setattr("physicslab.desktop.appearance.preferences_path", lambda: path)
    monkeypatch.setattr(app, "draw_loading", load)
    monkeypatch.setattr(app, "_import", lambda *_: time.sleep(0.1))
    with Display.open(WindowConfig(), "test") as display:
        assert app._load(display, "physicslab.desktop.session_window", app._Workers(ExitStack()))
    chosen = content.endswith("}")
    words = "Wird geladen, 3 s" if chosen else "Loading, 3 s"
    assert set(said) == {("projector" if chosen else DARK.name, words, 30 if chosen else 15)}
    assert path.read_text() == content, "a file that cannot be read is put aside where it can be said"
