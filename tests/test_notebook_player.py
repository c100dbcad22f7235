"""The player in notebooks: a widget whose time and play button Python sees; without it a frame."""

import html
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from browser import CHROMIUM, Browser

from physicslab import Run, World, circle, load_scene
from physicslab.components import Transform
from physicslab.export import notebook

_VIEW = "application/vnd.jupyter.widget-view+json"
_HOST = """<body style="margin: 0"><div id="cell"></div><script type="module">
const state = STATE, heard = {};
const model = {
  get: name => state[name],
  set: (name, value) => { if (state[name] !== value) { state[name] = value; heard[`change:${name}`]?.(); } },
  save_changes: () => { window.saved = { time: state.time, playing: state.playing }; },
  on: (change, call) => { heard[change] = call; },
  off: change => { delete heard[change]; },
};
const source = new Blob([state._esm], { type: "text/javascript" });
const { default: widget } = await import(URL.createObjectURL(source));
const close = widget.render({ model, el: document.getElementById("cell") });
window.player = { state, heard, set: model.set, close };
</script></body>"""
"""What a notebook does for a widget of anywidget, without a kernel."""
_WIDTH, _HEIGHT = 900, 540


@pytest.fixture(scope="module")
def run() -> Run:
    world = World()
    circle(world, (0, 0), radius=0.5, velocity=(0, 8), mass=1.0, name="ball")
    world.run(seconds=0.5)
    return world.record(1.5)


@pytest.fixture
def shown(run: Run, tmp_path: Path) -> Iterator[Browser]:
    """Yield a browser that shows the widget of the run, at rest."""
    pytest.importorskip("anywidget")
    if CHROMIUM is None:
        pytest.skip("not installed: chromium")
    state = json.dumps({**run.widget.get_state(), "layout": None}).replace("<", "\\u003c")
    host = tmp_path / "host.html"
    host.write_text(_HOST.replace("STATE", state), encoding="utf-8")
    with Browser() as browser:
        browser.open(host, width=_WIDTH, height=_HEIGHT)
        browser.until("window.saved")
        yield browser
        loaded = {request.partition(":")[0] for request in browser.requests}
        assert loaded <= {"file", "blob", "about"} and browser.complaints == []


@pytest.mark.notebook
def test_a_click_on_play_moves_the_bodies_and_python_sees_it(
    run: Run, shown: Browser, tmp_path: Path
) -> None:
    assert shown.value("saved") == {"time": 0.5, "playing": False}, "of a run that begins at 0.5 s"
    still, play = shown.picture(), _place_of("play", run, tmp_path)
    shown.click(*play)
    shown.until("saved.playing && saved.time > 0.9")
    assert shown.picture() != still
    shown.click(*play)
    shown.until("!saved.playing")
    time = shown.value("saved.time")
    assert min(abs(run.times - time)) < 1e-6, "at rest it shows an instant of the run"
    paused = shown.picture()
    assert shown.value("new Promise(done => setTimeout(done, 300, saved.time))") == time
    assert shown.picture() == paused


@pytest.mark.notebook
def test_python_sets_the_time_and_plays(shown: Browser) -> None:
    pictures = [shown.picture()]
    for time in (1.25, 0.75):
        shown.value("delete window.saved")
        shown.value(f"player.set('time', {time})")
        shown.until(f"window.saved?.time === {time}")
        pictures.append(shown.picture())
    assert len(set(pictures)) == 3
    shown.value("player.set('playing', true)")
    shown.until("saved.playing && saved.time > 1")
    shown.value("player.set('playing', false)")
    shown.until("!saved.playing")
    shown.value("player.set('time', 99)")
    shown.until("saved.time === 2 && player.state.time === 2")  # it ends there
    shown.value("player.close()")
    assert shown.value("Object.keys(player.heard).length") == 0


@pytest.mark.notebook
def test_a_kernel_shows_the_widget_and_the_frame_beside_it(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    kernel = pytest.importorskip("ipykernel")
    monkeypatch.delitem(sys.modules, "ipykernel")
    assert run._repr_mimebundle_() == ({}, {}), "no kernel"
    monkeypatch.setitem(sys.modules, "ipykernel", kernel)
    data, _ = run._repr_mimebundle_(include=None)
    assert list(data) == [_VIEW] and data[_VIEW]["model_id"] == run.widget.model_id
    seen: list[Any] = []
    run.widget.observe(lambda change: seen.append((change["name"], change["new"])), ["time", "playing"])
    run.widget.set_state({"time": 1.0, "playing": True})
    assert sorted(seen) == [("playing", True), ("time", 1.0)]


def test_without_anywidget_a_notebook_shows_the_page(monkeypatch: pytest.MonkeyPatch) -> None:
    notebook._widget_class.cache_clear()
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.setitem(sys.modules, "ipykernel", sys)  # only whether it is there is looked at
    run = load_scene("drop").record(0.1)
    assert run._repr_mimebundle_() == ({}, {})
    with pytest.raises(ImportError, match=r"a widget needs anywidget: pip install 'physicslab\[notebook\]'"):
        _ = run.widget
    assert html.unescape(run._repr_html_().split('"')[1]).encode() == run.page()


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="not installed: chromium")
def test_a_world_is_shown_as_it_is_with_nothing_to_play(tmp_path: Path) -> None:
    world = load_scene("newtons_cradle")
    world.run(seconds=0.5)
    page = html.unescape(world._repr_html_().split('"')[1])
    (tmp_path / "world.html").write_text(page, encoding="utf-8")
    with Browser() as browser:
        browser.open(tmp_path / "world.html", width=_WIDTH, height=_HEIGHT)
        x, y = world.component("ball 1", Transform).position
        assert browser.value("player.at('ball 1', 0)")[:2] == pytest.approx([x, y], abs=1e-6)
        assert browser.value("document.getElementById('play').offsetParent") is None
        assert browser.value("player.times.length") == 1 and browser.complaints == []
    assert world.time == 0.5


def _place_of(name: str, run: Run, folder: Path) -> tuple[float, float]:
    """Return where a button of the page is [px]: no page sees into a frame that is shut off."""
    (folder / "page.html").write_bytes(run.page())
    with Browser() as browser:
        browser.open(folder / "page.html", width=_WIDTH, height=_HEIGHT)
        box = browser.value(f"document.getElementById({name!r}).getBoundingClientRect().toJSON()")
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
