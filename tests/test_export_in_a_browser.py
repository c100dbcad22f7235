"""Exported pages in a real browser, without a window and without a network."""

import io
import json
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pygame
import pytest
from browser import CHROMIUM, Browser
from exporting import exported, recorded
from pseudo import PSEUDO

from physicslab import World, load_scene, save_scene
from physicslab.components import (
    Charge,
    Colour,
    Gate,
    Graph,
    GraphLine,
    Mass,
    Medium,
    Note,
    Rod,
    Rope,
    Shape,
    Thrust,
    Transform,
    Velocity,
    Weld,
)
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.assignments import assign
from physicslab.prefabs import box, circle
from physicslab.systems.standard import standard_systems
from physicslab.theme import DARK, LIGHT, Theme
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.picture.picture import draw_world

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="not installed: chromium")
SIZES = [(1280, 720), (390, 844)]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as opened:
        yield opened


@pytest.fixture
def page(tmp_path: Path, browser: Browser) -> Path:
    browser.requests.clear()
    browser.complaints.clear()
    exported(tmp_path / "page.html", "sandbox", "--seconds", "2")
    return tmp_path / "page.html"


def test_it_plays_without_a_network_and_without_a_complaint(page: Path, browser: Browser) -> None:
    browser.open(page)
    browser.until("player.time > 0.2")
    assert browser.value("player.playing")
    shown = browser.picture()
    browser.until("player.time > 0.6")
    assert browser.picture() != shown, "it moves"
    assert browser.requests == [page.as_uri()]
    assert browser.complaints == []


def test_its_numbers_are_those_of_the_run_to_the_bit(page: Path, browser: Browser) -> None:
    browser.open(page, still=True)
    world, recorder = recorded("sandbox", 2.0)
    assert browser.value("player.times.length") == recorder.count
    for body in recorder.bodies(world):
        if "moves" in body:
            shown = browser.value(
                f"Array.from(player.times, (_, frame) => player.at({json.dumps(body['name'])}, frame))"
            )
            assert np.array(shown, np.float32).tobytes() == recorder.motion[:, body["moves"]].tobytes()
    totals = browser.value("Array.from(player.lines.find(line => line.name === 'total').values)")
    assert np.array(totals, np.float32).tolist() == recorder.columns[:, len(recorder.energies)].tolist()


def test_keys_and_buttons(page: Path, browser: Browser) -> None:
    browser.open(page, still=True)
    assert not browser.value("player.playing"), "the user wants nothing to move by itself"
    browser.key("ArrowRight")
    browser.key("ArrowRight", shift=True)
    assert browser.value("player.time") == pytest.approx(11 / 60, rel=1e-6)
    browser.key("ArrowLeft")
    assert browser.value("player.time") == pytest.approx(10 / 60, rel=1e-6)
    browser.key("End")
    assert browser.value("player.time") == 2.0
    browser.key("Home")
    assert browser.value("player.time") == 0.0
    for key, name in (("t", "trails"), ("v", "arrows"), ("n", "names"), ("g", "grid"), ("l", "loop")):
        pressed = f"document.getElementById('{name}').ariaPressed === 'true'"
        before = browser.value(pressed)
        browser.key(key)
        assert browser.value(pressed) is not before
    browser.key("5")
    assert browser.value("document.getElementById('speed').value") == "4"
    browser.key(" ")
    browser.until("player.time === 2 && !player.playing")  # not in a loop any more
    browser.value("document.getElementById('play').click()")
    assert browser.value("player.playing && player.time < 2")
    browser.key("b")
    assert browser.value("player.selected") == "floor"


def test_a_clicked_body_shows_its_values(page: Path, browser: Browser) -> None:
    browser.open(page, still=True)
    browser.value("player.seek(player.times[60])")
    x, y, _, vx, vy, spin = browser.value("player.at('bob', 60)")
    browser.click(*browser.value(f"player.pixel({x}, {y})"))
    browser.until("player.selected === 'bob' && document.getElementById('values').rows.length > 9")
    cells = (
        "[...document.getElementById('values').rows].map(row => [...row.cells].map(cell => cell.textContent))"
    )
    shown = {name: value.replace("\u2212", "-") for name, value in browser.value(cells)}
    amounts = {name: float(value.split()[0]) for name, value in shown.items()}
    assert amounts["position x"] == pytest.approx(x, rel=1e-6) and shown["position x"].endswith(" m")
    assert amounts["speed"] == pytest.approx(math.hypot(vx, vy), rel=1e-6)
    inertia = 0.5 * 2.0 * 0.28**2
    kinetic = 0.5 * 2.0 * (vx * vx + vy * vy) + 0.5 * inertia * spin * spin
    assert amounts["kinetic energy"] == pytest.approx(kinetic, rel=1e-6)
    assert amounts["potential, 0 at the origin"] == pytest.approx(2.0 * 9.81 * y, rel=1e-6)
    assert shown["kinetic energy"].endswith(" J")


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_texts_twice_as_long_are_neither_cut_nor_upon_each_other(
    width: int, height: int, tmp_path: Path, browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("physicslab.export.page.language", lambda code: PSEUDO)
    exported(tmp_path / "page.html", "sandbox", "--seconds", "0.5")
    browser.open(tmp_path / "page.html", width=width, height=height, still=True)
    browser.key("b")
    assert "PPllaayy" in browser.value("document.body.innerHTML")
    assert browser.value("document.documentElement.scrollWidth") <= width
    assert browser.crowded() == []


@pytest.mark.parametrize("dark", [True, False], ids=["dark", "light"])
@pytest.mark.parametrize(("width", "height"), SIZES)
def test_nothing_is_cut_off_and_the_scheme_is_followed(
    width: int, height: int, dark: bool, page: Path, browser: Browser
) -> None:
    browser.open(page, width=width, height=height, dark=dark, still=True)
    browser.key("b")
    browser.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert browser.value("document.documentElement.scrollWidth") <= width
    assert browser.value(
        "document.querySelector('aside').scrollWidth <= document.querySelector('aside').clientWidth"
    )
    if width > 820:
        assert browser.value("document.documentElement.scrollHeight") <= height
        assert (
            browser.value(
                "document.getElementById('stage').clientWidth * document.getElementById('stage').clientHeight"
            )
            > 0.5 * width * height
        )
    cut = browser.value(
        "[...document.querySelectorAll('button')].filter(one => one.scrollWidth > one.clientWidth)"
        ".map(one => one.id)"
    )
    assert cut == []
    small = browser.value(
        "[...document.querySelectorAll('button, select')].filter(one => one.offsetHeight < "
        f"{36 if width > 820 else 44}).map(one => one.id)"
    )
    assert small == []
    background = browser.value("getComputedStyle(document.body).backgroundColor")
    assert background == f"rgb{(DARK if dark else LIGHT).background}"
    assert browser.complaints == []


@pytest.mark.parametrize("theme", [DARK, LIGHT], ids=lambda theme: theme.name)
def test_bodies_have_the_colours_and_the_light_of_the_window(
    theme: Theme, tmp_path: Path, browser: Browser
) -> None:
    world = World(physics=PhysicsConfig(bounds=(-6.0, 0.0, 6.0, 6.0)))
    ball = circle(world, (-3.0, 1.0), radius=1.0)
    chosen = circle(world, (3.0, 1.0), radius=1.0)
    world.add(chosen, Colour("#b05030"))
    box(world, (0.0, 1.0), width=2.0, height=2.0)
    box(world, (0.0, 4.5), width=2.0, height=1.0, static=True)
    save_scene(world, tmp_path / "bodies.json")
    exported(tmp_path / "page.html", str(tmp_path / "bodies.json"), "--seconds", "0.1")
    browser.open(tmp_path / "page.html", dark=theme is DARK, still=True)
    browser.value("(document.getElementById('grid').click(), player.seek(0))")
    shown = pygame.image.load(io.BytesIO(browser.picture()), "page.png")
    width, height = browser.value("[world.clientWidth, world.clientHeight]")
    at = browser.value("world.getBoundingClientRect().toJSON()")
    extent = tuple(browser.value("player.book.view"))
    painted, camera = pygame.Surface((width, height), 0, 32), Camera((width, height))
    camera.look_at(extent, camera.fitting_scale(extent, margin=0.0))
    draw_world(world, camera, theme, PygameCanvas(painted), grid=False)
    # Above, at the middle and below in bodies, beside them, in the sky, in the ground.
    reach = world.component(ball, Shape).radius
    places = [(x, 1.0 + up * reach) for x in (-3.15, 3.15, 0.7) for up in (0.8, 0.1, -0.8)]
    for x, y in [*places, (-5.5, 5.5), (5.5, 1.0), (0.3, 4.7)]:
        u, v = camera.project(np.array([(x, y)]))[0]
        window = np.array(painted.get_at((int(u), int(v)))[:3], float)
        page = np.array(shown.get_at((int(at["x"] + u), int(at["y"] + v)))[:3], float)
        assert np.abs(window - page).max() <= 8 + theme.grain, (x, y, window, page)


def test_a_finger_drags_and_two_zoom(page: Path, browser: Browser) -> None:
    browser.open(page, width=390, height=844, still=True)
    place = "JSON.stringify([player.pixel(0, 0), player.pixel(1, 0)])"

    def touch(kind: str, *points: tuple[float, float]) -> None:
        browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y} for x, y in points])

    (x0, y0), (x1, _) = json.loads(browser.value(place))
    touch("touchStart", (200, 250))
    touch("touchMove", (230, 250))
    touch("touchMove", (250, 270))
    touch("touchEnd")
    (x, y), (right, _) = json.loads(browser.value(place))
    assert (x - x0, y - y0) == pytest.approx((20, 20), abs=31) and x - x0 > 15
    assert right - x == pytest.approx(x1 - x0)
    touch("touchStart", (150, 250), (250, 250))
    touch("touchMove", (100, 250), (300, 250))
    touch("touchEnd")
    (x, _), (right, _) = json.loads(browser.value(place))
    assert right - x > 1.4 * (x1 - x0)


@pytest.mark.parametrize("scene", ["nothing", "still", "long"])
def test_odd_scenes_open(scene: str, tmp_path: Path, browser: Browser) -> None:
    steps = SimulationConfig(dt=1.0 if scene == "long" else 1 / 60)
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"), simulation=steps)
    if scene == "still":
        world.spawn(Transform((3, 4)), Shape.box(1, 1), name="wall")
    elif scene == "long":
        world.spawn(Transform((1e9, 0)), Velocity((1e4, 0)), Mass(), name="probe")
    save_scene(world, tmp_path / "scene.json")
    every = ["--seconds", "1000", "--every", "10"] if scene == "long" else ["--seconds", "0.5"]
    exported(tmp_path / "page.html", str(tmp_path / "scene.json"), *every)
    browser.complaints.clear()
    browser.open(tmp_path / "page.html")
    browser.until("player.time > 0")
    assert browser.complaints == []


def test_a_name_that_looks_like_markup_is_text(tmp_path: Path, browser: Browser) -> None:
    world = load_scene("drop")
    world.spawn(Transform((1, 1)), Velocity(), name="<img src=x onerror=alert(1)>")
    save_scene(world, tmp_path / "scene.json")
    exported(tmp_path / "page.html", str(tmp_path / "scene.json"), "--seconds", "0.5")
    browser.requests.clear()
    browser.complaints.clear()
    browser.open(tmp_path / "page.html", still=True)
    browser.key("b", shift=True)
    assert browser.value("player.selected") == "<img src=x onerror=alert(1)>"
    assert browser.value("document.images.length") == 0 and browser.complaints == []


# ---- pages with sliders ------------------------------------------------------------------------------------


def test_a_slider_moved_by_the_mouse_shows_the_run_of_its_value(tmp_path: Path, browser: Browser) -> None:
    vary = ["--vary", "ball.Velocity.linear.x=1:5:5", "--vary", "ball.Material.restitution=0:0.8:3"]
    exported(tmp_path / "page.html", "drop", "--seconds", "1", *vary)
    browser.requests.clear()
    browser.complaints.clear()
    browser.open(tmp_path / "page.html", still=True)
    browser.value("player.seek(1)")
    assert browser.value("player.chosen") == [2, 1], "the middle of each"
    for which, chosen, speed, restitution in ((0, [4, 1], "5", "0.4"), (1, [4, 2], "5", "0.8")):
        box = f"document.getElementById('slider-{which}').getBoundingClientRect()"
        right, middle = browser.value(f"[{box}.right - 3, {box}.y + {box}.height / 2]")
        browser.click(right, middle)
        browser.until(f"JSON.stringify(player.chosen) === '{json.dumps(chosen, separators=(',', ':'))}'")
        world = load_scene("drop")
        for part, field, value in (
            ("Velocity", "linear", f"[{speed},0]"),
            ("Material", "restitution", restitution),
        ):
            assign(world, [f"ball.{part}.{field}={value}"])
        world.run(seconds=1.0)
        transform = world.component(world.entity("ball"), Transform)
        shown = browser.value("player.at('ball', player.times.length - 1)")[:2]
        assert shown == np.array([*transform.position], np.float32).tolist()
        assert browser.value("player.time") == 1.0, "the moment stays"
    browser.key("ArrowLeft")
    browser.until("player.chosen[1] === 1")
    assert browser.requests == [(tmp_path / "page.html").as_uri()] and browser.complaints == []


def test_a_value_that_no_run_can_have_says_why_and_shows_no_other_run(
    tmp_path: Path, browser: Browser
) -> None:
    exported(tmp_path / "page.html", "drop", "--seconds", "0.2", "--vary", "ball.Shape.radius=0:0.5:3")
    browser.complaints.clear()
    browser.open(tmp_path / "page.html", still=True)
    browser.value("document.getElementById('slider-0').focus()")
    browser.key("ArrowLeft")
    browser.until("document.getElementById('failure').textContent.includes('Shape.radius')")
    assert browser.value("getComputedStyle(document.getElementById('world')).visibility") == "hidden"
    browser.key("ArrowRight")
    browser.until("document.getElementById('failure').textContent === ''")
    assert browser.value("getComputedStyle(document.getElementById('world')).visibility") == "visible"
    assert browser.complaints == []


def test_notes_gates_graphs_joints_and_fields_are_shown(tmp_path: Path, browser: Browser) -> None:
    world = World(
        *standard_systems(), physics=PhysicsConfig(magnetic_field=1.0, electric_field=Vector2(0, 1))
    )
    bodies = [circle(world, (0.6 * n, 2.0), radius=0.2, velocity=(0, -1)) for n in range(6)]
    world.add(bodies[0], Charge(1.0))
    world.add(bodies[1], Colour("#ff8000"))
    world.add(bodies[2], Thrust((0, 3)))
    pool = box(world, (0, -3), width=8, height=2, static=True)
    world.add(pool, Medium(1000.0))
    for joint in (
        Rod(a=bodies[3], anchor_b=(1.8, 4.0)),
        Rope(a=bodies[4], b=bodies[5]),
        Weld(a=bodies[1], b=bodies[2]),
    ):
        world.spawn(joint)
    world.spawn(Note("Watch\nthis", (0, 3)))
    world.spawn(Gate((-1, 1.8), (4, 1.8)), name="light")
    graph = world.spawn(Graph())
    world.spawn(GraphLine(graph, "speed", bodies[1]))
    save_scene(world, tmp_path / "scene.json")
    exported(tmp_path / "page.html", str(tmp_path / "scene.json"), "--seconds", "0.5")
    browser.complaints.clear()
    browser.open(tmp_path / "page.html", still=True)
    browser.key("End")
    browser.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    words = browser.value("document.body.innerText")
    assert "Graph 1 (m/s)" in words and "circle 2: speed" in words and "through light" in words
    assert "momentum y" in words and "kg m\u00b2/s" in words
    assert browser.value("player.run.bodies[1].paint") == "#ff8000"
    assert browser.value("player.run.texts.map(note => note.text)") == ["Watch\nthis"]
    kinds = ["Rod", "Rope", "Weld"]
    assert sorted(browser.value("player.run.joints.map(joint => joint.kind)")) == kinds
    assert browser.complaints == [] and len(browser.picture()) > 10_000
