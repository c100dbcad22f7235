"""The systems of a frame, each alone in a world without a window: given what they read and draw with."""

from __future__ import annotations

from collections.abc import Sequence

from physicslab.files.scene import load_scene
from physicslab.systems.frame.hud import HudSystem
from physicslab.systems.frame.input import InputSystem
from physicslab.systems.frame.render import RenderSystem
from physicslab.systems.system import Stage
from physicslab.world import World


def test_layers_are_drawn_in_their_order_with_the_impacts_since_the_last_picture() -> None:
    world, drawn = load_scene("drop"), list[tuple[str, int]]()
    world.install(
        RenderSystem(
            lambda world, impacts: drawn.append(("below", len(impacts))),
            lambda world, impacts: drawn.append(("above", len(impacts))),
        )
    )
    world.synchronise()
    world.run(seconds=1.0)
    world.frame(Stage.RENDER, 1 / 60)
    world.frame(Stage.RENDER, 1 / 60)
    (first, count), *others = drawn
    assert first == "below" and count == len(world.contacts.impacts) > 0
    assert others == [("above", count), ("below", 0), ("above", 0)]


def test_readings_are_taken_as_often_as_they_are_wanted_and_before_layers() -> None:
    calls: list[str] = []
    now = [0.0]
    hud = HudSystem[World](
        lambda: now[0],
        {
            lambda world, elapsed: calls.append("always"): 0.0,
            lambda world, elapsed: calls.append("often"): 0.1,
            lambda world, elapsed: calls.append("seldom"): 10.0,
        },
        lambda world, elapsed: calls.append("drawn"),
    )
    world = World(hud)
    world.frame(Stage.HUD, 0.05)
    assert calls == ["always", "often", "seldom", "drawn"]
    calls.clear()
    for now[0] in (0.05, 0.15):
        world.frame(Stage.HUD, 0.05)
    assert calls == ["always", "drawn", "always", "often", "drawn"]
    calls.clear()
    other = World(hud)
    other.frame(Stage.HUD, 0.05)
    assert calls == ["always", "often", "seldom", "drawn"], "another world is read at once"


class Noted:
    """Notes what it is called for."""

    def __init__(self) -> None:
        self.calls: list[object] = []

    def begin(self, world: World, events: Sequence[str], elapsed: float) -> None:
        self.calls.append((list(events), elapsed))

    def handle(self, world: World, event: str) -> None:
        self.calls.append(event)

    def end(self, world: World) -> None:
        self.calls.append("end")


def test_events_are_handed_on_one_by_one_whatever_they_come_from() -> None:
    noted = Noted()
    world = World(InputSystem(lambda: ["press", "release"], noted))
    world.frame(Stage.INPUT, 0.5)
    assert noted.calls == [(["press", "release"], 0.5), "press", "release", "end"]
