"""Exported pages in a real browser, without a window and without a network."""

import json
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from browser import CHROMIUM, Browser
from exporting import exported, recorded

from physicslab import World, load_scene, save_scene
from physicslab.components import Mass, Shape, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.systems.standard import standard_systems

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
    assert background == ("rgb(15, 17, 23)" if dark else "rgb(255, 255, 255)")
    assert browser.complaints == []


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
