"""What a screen reader is told: names, values, places and actions of controls, the scene, and notices."""

from types import SimpleNamespace
from typing import Any

import pygame
import pytest
from desk import SETTLED, Desk, click, sized

from physicslab.desktop import screen_reader
from physicslab.desktop.screen_reader import ScreenReader
from physicslab.diagnostics.description import describe
from physicslab.files.scene import load_scene
from physicslab.view.controls.lesson_actions import choose_language


class Named:
    """Stands for an enumeration of the package: every name is itself."""

    def __getattr__(self, name: str) -> str:
        return name


class Node:
    """Keeps what it is told."""

    def __init__(self, role: str) -> None:
        self.said: dict[str, Any] = {"role": role}

    def __getattr__(self, name: str) -> Any:
        return lambda value: self.said.__setitem__(name.removeprefix("set_"), value)


class Adapter:
    """Stands for the adapter of the system, with a reader that asks always."""

    def __init__(self, began: Any, asks: Any, ended: Any) -> None:
        self.told, self.asks, self.in_front = began(), asks, False

    def update_if_active(self, make: Any) -> None:
        self.told = make()

    def update_window_focus_state(self, in_front: bool) -> None:
        self.in_front = in_front

    def set_root_window_bounds(self, outer: Any, inner: Any) -> None:
        self.bounds = outer


KIT = SimpleNamespace(
    unix=SimpleNamespace(Adapter=Adapter), Node=Node, Role=Named(), Action=Named(), Toggled=Named(),
    Live=Named(), Rect=lambda *corners: corners, Tree=lambda root: root,
    TreeUpdate=lambda focus: SimpleNamespace(focus=focus, nodes=[], tree=None),
)  # fmt: skip


@pytest.fixture
def reader(monkeypatch: pytest.MonkeyPatch) -> ScreenReader:
    monkeypatch.setattr(screen_reader, "_PERIOD", 0.0)
    monkeypatch.setattr(screen_reader, "_SCENE_PERIOD", 0.0)
    return ScreenReader(KIT)


def told(reader: ScreenReader, desk: Desk) -> dict[str, dict[str, Any]]:
    """Return what is told of the last frame, by the names of nodes."""
    reader.follow(desk.world, desk.window, desk.ui)
    nodes = dict(reader._adapter.told.nodes)
    assert set(nodes[1].said["children"]) == set(nodes) - {1}
    return {node.said["label"]: node.said | {"number": number} for number, node in nodes.items()}


def test_every_control_is_told_with_its_name_value_and_place(reader: ScreenReader) -> None:
    desk = sized((1280, 720), load_scene("carts"))
    desk.frames(SETTLED)
    found = told(reader, desk)
    assert set(desk.ui.places) <= set(found), "each has a name"
    for label, (left, top, width, height) in desk.ui.places.items():
        assert found[label]["bounds"] == (left, top, left + width, top + height)
        assert found[label]["add_action"] == "CLICK"
    assert found["Select"]["role"] == "BUTTON" and found["Select"]["toggled"] == "TRUE"
    assert found["Time line"]["role"] == "SLIDER" and found["Time line"]["value"].endswith(" s")
    assert found["Gravity"] | {"role": "COMBO_BOX", "value": "Earth"} == found["Gravity"]
    assert found["Carts on a track - PhysicsLab"]["role"] == "WINDOW"
    assert found[describe(desk.world)]["role"] == "DOCUMENT"


def test_what_a_reader_presses_is_clicked(reader: ScreenReader) -> None:
    desk = sized((1280, 720), load_scene("carts"))
    desk.frames(SETTLED)
    number = told(reader, desk)["Pause"]["number"]
    for action in ("FOCUS", "CLICK"):
        reader._adapter.asks(SimpleNamespace(action=action, target=number))
        reader.follow(desk.world, desk.window, desk.ui)
        desk.frames(3)
        assert desk.window.pace.paused == (action == "CLICK")
    assert told(reader, desk)["Play"]["role"] == "BUTTON"
    reader._adapter.asks(SimpleNamespace(action="CLICK", target=10_000))
    reader.follow(desk.world, desk.window, desk.ui)


def test_names_are_in_the_language_of_the_window_and_notices_are_live(reader: ScreenReader) -> None:
    desk = sized((1280, 720), load_scene("carts"))
    choose_language(desk.world, desk.window, "de")
    desk.window.notify("Copied")
    desk.frames(3)
    found = told(reader, desk)
    assert {"Auswählen", "Datei"} <= set(found)
    assert describe(desk.world, "de") in found
    (notice,) = (one for one in found.values() if one["role"] == "STATUS")
    assert notice["live"] == "POLITE" and notice["label"] == desk.ui.said("Copied")


def test_a_control_keeps_its_number_while_others_come_and_go(reader: ScreenReader) -> None:
    desk = sized((1280, 720), load_scene("carts"))
    desk.frames(SETTLED)
    before = told(reader, desk)
    click(desk, "File")
    desk.frames(3)
    after = told(reader, desk)
    assert "Save" in after and after["Pause"]["number"] == before["Pause"]["number"]
    assert len({one["number"] for one in after.values()}) == len(after)


def test_without_the_package_nothing_is_done(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(screen_reader, "_installed", lambda: None)
    desk = sized((1280, 720))
    ScreenReader().follow(desk.world, desk.window, desk.ui)
    assert not pygame.event.peek(pygame.MOUSEBUTTONDOWN)
