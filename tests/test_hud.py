"""HudSystem: the right figures, readable at any size of window."""

import itertools
import math
import re
from dataclasses import replace
from typing import Any

import pygame
import pytest
from desk import FRAME, SETTLED, Desk, empty_world, sized
from recording import RecordingCanvas

from physicslab.components import Transform
from physicslab.contacts.report import count_near_pairs
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.ecs.config import PhysicsConfig, WindowConfig
from physicslab.files.scene import load_scene
from physicslab.languages.language import language
from physicslab.prefabs import box, circle, pendulum
from physicslab.view.canvas.canvas import Align, Rect, TextStyle
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.canvas.quantities import quantity
from physicslab.view.workbench.figures import FrameMeter
from physicslab.world import World

SIZES = [(1280, 720), (800, 600), (1920, 1080), (1000, 1300), (720, 540), (2560, 1440)]


def recorded(world: World) -> tuple[Desk, RecordingCanvas]:
    """Return a desk that shows all figures there are; what is not in panels is recorded."""
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(world, canvas)
    desk.window.level = "Engineer"
    return desk, canvas


def row(desk: Desk, label: str) -> str:
    """Return the figure that stands beside a label in a panel."""
    return desk.ui.rows[label]


def frame(desk: Desk, canvas: RecordingCanvas) -> None:
    """Let enough time go by for new figures, and keep the last frame alone."""
    desk.frames(30)
    canvas.calls.clear()
    desk.frames()


def test_the_figures_are_those_of_the_diagnostics() -> None:
    world = empty_world(gravity=(0, 0))
    circle(world, (0, 0), mass=2.0, velocity=(3, 0), angular_velocity=4.0, radius=0.5)
    circle(world, (0.9, 0), mass=1.0, radius=0.5, velocity=(3, 0))
    desk, canvas = recorded(world)
    desk.key("space")
    frame(desk, canvas)
    energy, momentum = measure_energy(world), measure_momentum(world)
    assert row(desk, "Bodies") == "2"
    assert row(desk, "Candidate pairs") == str(count_near_pairs(world))
    assert row(desk, "Contacts") == str(world.contacts.count)
    assert row(desk, "Kinetic energy") == quantity(energy.kinetic, "J") == "15.50 J"
    assert row(desk, "linear") == "13.50 J"
    assert row(desk, "rotational") == "2.000 J"
    assert row(desk, "Total momentum") == quantity(momentum.linear.magnitude, "kg m/s") == "9.000 kg m/s"
    assert row(desk, "Gravity") == "off"


def test_pairs_and_contacts_are_shown_as_they_come() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=10, height=1, static=True)
    box(world, (0, 0.25))
    desk, canvas = recorded(world)
    desk.frames(30)
    frame(desk, canvas)
    assert row(desk, "Candidate pairs") == "1"
    assert row(desk, "Contacts") == "1"


def test_bodies_asleep_are_counted_beside_the_bodies() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=10, height=1, static=True, friction=0.5)
    box(world, (0, 0.25), friction=0.5)
    circle(world, (3, 50))
    world.simulation = replace(world.simulation, sleeping=True)
    desk, canvas = recorded(world)
    desk.frames(80)
    frame(desk, canvas)
    assert row(desk, "Bodies") == "3, 1 asleep"
    assert row(desk, "Contacts") == "1"


def test_the_frame_rate_is_smoothed() -> None:
    world = empty_world()
    meter = FrameMeter()
    for _ in range(120):
        meter.note(world, 1 / 60)
    assert meter.frame_rate == pytest.approx(60.0, rel=1e-6)
    meter.note(world, 1 / 30)
    assert 55.0 < meter.frame_rate < 60.0
    for _ in range(200):
        meter.note(world, 1 / 30)
    assert meter.frame_rate == pytest.approx(30.0, rel=0.01)


def test_every_running_system_has_its_cost_and_every_other_its_reason() -> None:
    world = empty_world()
    circle(world, (0, 0))
    desk, canvas = recorded(world)
    frame(desk, canvas)
    running = {system.name for system in world.schedule.running}
    assert {"InputSystem", "RenderSystem", "HudSystem", "GravitySystem"} <= running
    costs = desk.ui.words[desk.ui.words.index("time per frame") :]
    for name in running:
        assert costs[costs.index(name.removesuffix("System")) + 1].endswith(" ms")
    words = " ".join(desk.ui.words)
    assert world.schedule.left_out
    for out in world.schedule.left_out:
        assert f"{out.name.removesuffix('System')}: {out.reason}" in words


def test_costs_are_those_of_a_frame() -> None:
    world = empty_world()
    circle(world, (0, 0))
    desk = Desk(world, RecordingCanvas((1280, 720)))
    desk.frames()
    meter = FrameMeter()
    meter.note(world, FRAME)
    timing = world.schedule.timings["GravitySystem"]
    for _ in range(200):
        timing.nanoseconds += 2_000_000
        meter.note(world, FRAME)
    assert meter.cost["GravitySystem"] == pytest.approx(2.0, rel=0.05)


def test_the_integrator_is_shown_with_its_reason() -> None:
    world = load_scene("pendulum")
    desk, canvas = recorded(world)
    frame(desk, canvas)
    words = " ".join(desk.ui.words)
    assert world.plan.integrator.title in words
    assert world.plan.reason in words
    assert "16.7 ms in 4 substeps" in words


@pytest.mark.parametrize(
    ("physics", "words"),
    [
        (PhysicsConfig(), "9.81 m/s² down"),
        (PhysicsConfig(gravity=(0, 3)), "3 m/s² up"),  # type: ignore[arg-type]
        (PhysicsConfig(gravity=(1, -2)), "(1, -2) m/s²"),  # type: ignore[arg-type]
        (PhysicsConfig(gravity_mode="none"), "off"),
        (PhysicsConfig(gravity_mode="planet", G=2.5), "G = 2.5 N m²/kg²"),
    ],
)
def test_gravity_in_words(physics: PhysicsConfig, words: str) -> None:
    world = empty_world()
    world.physics = physics
    desk, canvas = recorded(world)
    frame(desk, canvas)
    assert row(desk, "Gravity") == words


def test_the_transport_hints_at_what_to_do_first() -> None:
    desk, canvas = recorded(empty_world())
    frame(desk, canvas)
    assert any("F1: keys" in words and "Space: pause" in words for words in desk.ui.words)


def test_banners_say_what_is_not_as_usual() -> None:
    desk, canvas = recorded(empty_world())
    frame(desk, canvas)
    quiet = {"PAUSED", "PLANET MODE", "SLOW MOTION 0.25x"}
    assert not quiet & set(canvas.words)
    for key in ("space", "tab", "o"):
        desk.key(key)
    frame(desk, canvas)
    assert quiet <= set(canvas.words)


def test_dropped_time_is_announced_and_then_forgotten() -> None:
    desk, canvas = recorded(empty_world())
    frame(desk, canvas)
    assert not any("skipped" in words for words in canvas.words)
    desk.frames(1, elapsed=0.6)  # a hitch: something is loaded
    canvas.calls.clear()
    desk.frames()
    assert not any("skipped" in words for words in canvas.words)
    desk.frames(240)
    desk.frames(8, elapsed=0.175)
    canvas.calls.clear()
    desk.frames(8)  # where nothing moves it is drawn each tenth of a second
    assert "The computer is too slow: 0.6 s were skipped" in canvas.words
    desk.frames(240)
    frame(desk, canvas)
    assert not any("skipped" in words for words in canvas.words)


def test_time_that_was_dropped_while_the_physics_was_prepared_is_no_slow_computer() -> None:
    desk, canvas = recorded(empty_world())
    desk.window.preparing = 3.0
    desk.frames(10, elapsed=0.2)
    assert any("slow motion until then (5 s)" in words for words in canvas.words)
    desk.window.preparing = 0.0  # it takes longer than was thought
    desk.frames(1, elapsed=0.2)
    assert not any("(0 s)" in words for words in canvas.words)
    desk.window.preparing = None
    canvas.calls.clear()
    desk.frames(3)
    assert not any("skipped" in words for words in canvas.words)


def test_figures_are_not_read_in_the_frame_that_shows_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both together took twice as long as any other frame, a dozen times a minute and more."""
    desk, _ = recorded(load_scene("drop"))
    desk.frames(30)
    interface, number, shown, read = desk.sandbox.interface, 0, set[int](), set[int]()
    refresh, figures = interface.toolkit.refresh, interface._figures

    def note() -> None:
        shown.add(number)
        refresh()

    monkeypatch.setattr(interface.toolkit, "refresh", note)
    for number in range(60):
        desk.frames()
        if interface._figures is not figures:
            read.add(number)
        figures = interface._figures
    assert len(read) >= 4 and len(shown) >= 4 and not read & shown


def test_panels_of_a_selected_body_are_built_five_times_a_second_while_time_runs() -> None:
    """Its forces are measured as often, and each time panels were built three times over."""
    desk, _ = recorded(load_scene("drop"))
    desk.window.selection.take(desk.world.entity("ball"))
    desk.frames(30)
    built, measured = desk.sandbox.interface.toolkit.built, desk.window.measured.number
    desk.frames(60)
    assert desk.window.measured.number >= measured + 4
    assert 4 <= desk.sandbox.interface.toolkit.built - built <= 6


def test_numbers_are_read_five_times_a_second_and_not_more_often() -> None:
    world = empty_world()
    circle(world, (0, 50))
    desk, _ = recorded(world)
    seen = []
    for _ in range(60):
        desk.frames()
        seen.append(row(desk, "Kinetic energy"))
    assert 4 <= len(list(itertools.groupby(seen))) <= 6


@pytest.mark.parametrize(("size", "scale"), [((1280, 720), 1.0), ((800, 600), 1.5)])
def test_no_orbit_leads_behind_the_banner_of_planet_mode(size: tuple[int, int], scale: float) -> None:
    world = load_scene("solar_system")
    desk = sized(size, world, scale)
    desk.window.framing.go_home(world)
    desk.frames(SETTLED)
    left, top, width, _ = desk.window.framing.room()
    banner = next(one for one in desk.window.overlays.covered if one[1] < top + desk.sandbox.interface.text)
    star, *planets = world.table(Transform)["position"][world.batch(Transform).rows]
    largest = max(math.dist(star, planet) for planet in planets)
    _, above = desk.pixel(star[0], star[1] + largest)
    assert left < banner[0] < left + width and above > banner[1] + banner[3] + 5


NUMBER = re.compile(r"-?[\d.]+(e[+-]?\d+)?")


class MeasuringCanvas(PygameCanvas):
    """Draws, and notes where each word and panel went."""

    def __init__(self, size: tuple[int, int]) -> None:
        super().__init__(pygame.Surface(size, 0, 32))
        self.words: list[tuple[str, pygame.Rect]] = []
        self.numbers: list[pygame.Rect] = []
        self.panels: list[pygame.Rect] = []

    def text(self, words: str, at: tuple[int, int], style: TextStyle, align: Align = "left") -> None:
        width, height = self.text_size(words, style)
        shift = {"left": 0, "centre": width // 2, "right": width}[align]
        rect = pygame.Rect(at[0] - shift, at[1], width, height)
        if NUMBER.fullmatch(words):  # along the edges of the picture, without a panel, below all else
            self.numbers.append(rect)
        else:
            self.words.append((words, rect))
        super().text(words, at, style, align)

    def panel(self, rect: Rect, colour: Any, outline: Any, opacity: float = 1.0) -> None:
        self.panels.append(pygame.Rect(rect))
        super().panel(rect, colour, outline, opacity)


def crowded(size: tuple[int, int], scale: float = 1.0) -> tuple[Desk, MeasuringCanvas]:
    """Return a canvas on which the HUD had as much to say as it ever has."""
    canvas = MeasuringCanvas(size)
    world = load_scene("two_planets")
    world.physics = PhysicsConfig(gravity_mode="planet", G=6.674e-11)
    world.title = "A title that goes on for longer than anyone would wish, in a window of any size"
    desk = Desk(world, canvas, WindowConfig())
    desk.window.text_scale = scale
    desk.window.grid = True  # in space it is off
    for x, y in ((-900.0, 5.0), (900.0, -700.0), (950.0, 0.0), (0.0, 880.0), (60.0, -880.0)):
        circle(world, (x, y), velocity=(-1.2345e-7, 9.87e-8))
    pendulum(world, (900.0, 600.0))
    desk.key("space")
    desk.key("tab")
    desk.frames(3, elapsed=0.5)
    desk.window.camera.look_at((0.0, 0.0, 0.0, 0.0), 100.0)
    desk.window.pace.drop(123.4)
    desk.window.notify("Saved /a/rather/long/directory/name/of/some/user/physicslab-20300101-120000.png")
    desk.window.error = (
        "Stopped: entity 12: Velocity is no longer finite at t = 1.23456789 s; a smaller dt or more substeps "
        "may help. Ctrl+Z takes back the last edit."
    )
    desk.frames(8)
    canvas.words.clear()
    canvas.numbers.clear()
    canvas.panels.clear()
    desk.frames()
    return desk, canvas


@pytest.mark.parametrize("scale", [1.0, 1.75])
@pytest.mark.parametrize("size", SIZES)
def test_no_word_is_cut_and_none_lies_over_another(size: tuple[int, int], scale: float) -> None:
    desk, canvas = crowded(size, scale)
    beside = [pygame.Rect(rect) for rect in desk.sandbox.interface.covered]
    screen = pygame.Rect(0, 0, *size)
    for words, rect in canvas.words:
        assert screen.contains(rect), f"{words!r} at {rect} leaves {size}"
        around = [panel for panel in canvas.panels if panel.contains(rect)]
        assert around, f"{words!r} at {rect} is in no panel"
        under = [panel for panel in beside if panel.colliderect(rect)]
        assert not under, f"{words!r} at {rect} is under {under}"
    room = pygame.Rect(desk.sandbox.interface.visible)
    for number in canvas.numbers:
        assert room.contains(number), f"{number} is under a panel"
        if number.top > room.bottom - 2 * number.height:
            assert not any(panel.colliderect(number) for panel in canvas.panels), f"{number} is under words"
    for first, second in itertools.combinations(canvas.numbers, 2):
        assert not first.inflate(-2, -2).colliderect(second.inflate(-2, -2))
    for (a, one), (b, two) in itertools.combinations(canvas.words, 2):
        assert not one.inflate(-2, -2).colliderect(two.inflate(-2, -2)), f"{a!r} lies over {b!r} at {size}"
    for one, two in itertools.combinations(canvas.panels, 2):
        apart = not one.colliderect(two) or one.contains(two) or two.contains(one)
        assert apart, f"panels {one} and {two} overlap at {size}"


def test_words_make_way_for_a_graph() -> None:
    canvas = MeasuringCanvas((1280, 720))
    desk = Desk(load_scene("pendulum"), canvas)
    desk.key("space")
    desk.frames(8)
    canvas.words.clear()
    desk.frames()
    (paused,) = [rect for words, rect in canvas.words if words == "PAUSED"]
    assert len(desk.window.dashboard.graphs) == 1
    assert not any(paused.colliderect(rect) for rect in desk.sandbox.interface.covered)


def test_the_same_words_make_way_again_for_a_body_that_came_in_the_meantime() -> None:
    canvas = MeasuringCanvas((1280, 720))
    desk = Desk(empty_world(gravity=(0, 0)), canvas)
    ball = circle(desk.world, (0.0, 0.0), radius=0.1)
    desk.frames()

    def paused_at() -> pygame.Rect:
        desk.key("space")
        desk.frames(8)
        canvas.words.clear()
        desk.frames()
        (found,) = [rect for words, rect in canvas.words if words == "PAUSED"]
        return found

    first = paused_at()
    desk.key("space")
    desk.frames(2)
    assert not desk.window.pace.paused
    desk.world.component(ball, Transform).position = desk.window.camera.to_world(first.center)
    assert not paused_at().colliderect(first)


def test_the_word_paused_makes_way_for_what_is_drawn_at_the_cursor() -> None:
    canvas = MeasuringCanvas((1280, 720))
    desk = Desk(empty_world(), canvas)
    desk.key("space")
    desk.frames(3)
    rect = next(rect for words, rect in canvas.words if words == "PAUSED")
    for (x, y), shown in ((rect.center, False), ((rect.centerx, rect.top - 200), True)):
        desk.move(*desk.window.camera.to_world((x, y)))
        desk.frames(2)
        canvas.words.clear()
        desk.frames()
        assert any(words == "PAUSED" for words, _ in canvas.words) == shown


def test_a_step_that_takes_long_is_told_with_its_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    desk, seconds = Desk(load_scene("drop")), itertools.count(0.0, 2.0)
    monkeypatch.setattr("physicslab.desktop.sandbox.time.thread_time", lambda: next(seconds))
    desk.frames(2)
    assert (
        desk.window.notice.startswith("Slow: the step to t = 0.0") and "much to compute" in desk.window.notice
    )
    german = language("de").reword(desk.window.notice)
    assert german.startswith("Langsam: der Schritt bis t = 0,0") and "es gibt viel zu rechnen" in german
    assert "nahe Paare" in german and german.endswith("Abhilfe: weniger Körper oder Teilschritte")


def test_a_step_in_which_kernels_are_compiled_is_not_called_slow(monkeypatch: pytest.MonkeyPatch) -> None:
    desk, seconds = Desk(load_scene("drop")), itertools.count(0.0, 2.0)
    monkeypatch.setattr("physicslab.desktop.sandbox.time.thread_time", lambda: next(seconds))
    compiling = itertools.count(0.0, 2.0)
    monkeypatch.setattr("physicslab.state.state.seconds_waited", lambda: next(compiling))
    desk.frames(2)
    assert not desk.window.notice


@pytest.mark.parametrize("size", [(1, 1), (60, 40), (200, 100), (320, 200)])
def test_a_tiny_window_does_no_harm(size: tuple[int, int]) -> None:
    crowded(size)


def test_a_resized_window_is_laid_out_again_at_once() -> None:
    canvas = RecordingCanvas((1280, 720))
    desk = Desk(empty_world(), canvas)
    desk.frames()
    canvas.size = (800, 600)
    canvas.calls.clear()
    desk.frames()
    assert max(text["at"][0] for text in canvas.called("text")) <= 800
    assert desk.window.camera.size == (800, 600)


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (0.0, "0 J"),
        (1.0, "1.000 J"),
        (-12.3456, "-12.35 J"),
        (999999.0, "999999 J"),
        (1.5e6, "1.500·10⁶ J"),
        (0.00123, "0.0012 J"),
        (1e-12, "1.000·10⁻¹² J"),
        (float("nan"), "not finite, J"),
        (float("inf"), "not finite, J"),
    ],
)
def test_quantities(value: float, words: str) -> None:
    assert quantity(value, "J") == words
