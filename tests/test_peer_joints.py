"""Joints of a world in other engines."""

from __future__ import annotations

import math
import os
from pathlib import Path

import pytest

from physicslab.components import Mass, Pin, Pulley, Rod, Rope, Shape, Slot, Transform, Velocity, Weld
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.peers.box2d3_built import built_box2d
from physicslab.lab.peers.mirrors import Box2D3Mirror, Box2DMirror, PymunkMirror
from physicslab.lab.peers.peer import CannotBuild, Peer
from physicslab.world import World

pytestmark = pytest.mark.peers
SIDE = math.sqrt(0.5)


def bar(gravity: float = -10.0) -> tuple[World, int]:
    """Return a world with a bar of 1 m that lies level beside the origin."""
    world = World(physics=PhysicsConfig(gravity=Vector2(0.0, gravity)))
    return world, world.spawn(Transform((0.5, 0.0)), Velocity(), Mass(1.0), Shape.box(1.0, 0.1))


def after(engine: type[Peer], world: World, entity: int, seconds: float) -> tuple[float, ...]:
    """Return x, y, vx, vy, angle and angular velocity in an engine after a while."""
    peer = engine(world)
    peer.run(1.0 / 240.0, round(240.0 * seconds))
    return tuple(peer.state(entity))


@pytest.fixture(scope="module", params=[PymunkMirror, Box2DMirror, Box2D3Mirror, None])
def engine(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> type[Peer]:
    """Each engine; the last is Box2D 3 in C, from the sources that ``BOX2D_SOURCES`` names."""
    if request.param is None:
        if not os.environ.get("BOX2D_SOURCES"):
            pytest.skip("BOX2D_SOURCES names no checkout of Box2D 3")
        return built_box2d(Path(os.environ["BOX2D_SOURCES"]), tmp_path_factory.mktemp("box2d"))
    engine: type[Peer] = request.param
    return engine


class TestJoints:
    def test_a_pin_with_a_limit_holds_a_bar_there(self, engine: type[Peer]) -> None:
        world, entity = bar()
        world.spawn(Pin(b=entity, anchor_b=(-0.5, 0.0), lower=-0.5))
        x, y, _, _, angle, _ = after(engine, world, entity, 2.0)
        assert angle == pytest.approx(-0.5, abs=0.02)
        assert (x, y) == pytest.approx((0.5 * math.cos(angle), 0.5 * math.sin(angle)), abs=0.01)

    def test_a_motor_turns_at_its_speed(self, engine: type[Peer]) -> None:
        world, entity = bar(gravity=0.0)
        world.spawn(Pin(b=entity, anchor_b=(-0.5, 0.0), motor_speed=3.0, max_torque=2.0))
        *_, angle, rate = after(engine, world, entity, 1.0)
        inertia = float(world.component(entity, Mass).inertia or 0.0) + 0.25
        assert rate == pytest.approx(3.0, abs=1e-3)
        assert angle == pytest.approx(3.0 * (1.0 - 0.5 * 3.0 * inertia / 2.0), abs=0.03)

    def test_a_rod_keeps_its_length(self, engine: type[Peer]) -> None:
        world, entity = bar()
        world.spawn(Rod(b=entity, anchor_a=(-1.5, 0.0)))
        x, y, vx, vy, _, _ = after(engine, world, entity, 0.5)
        assert math.hypot(x + 1.5, y) == pytest.approx(2.0, abs=5e-3)
        assert 0.5 * (vx * vx + vy * vy) == pytest.approx(-10.0 * y, rel=0.03)

    def test_a_rope_is_slack_and_then_taut(self, engine: type[Peer]) -> None:
        world, entity = bar()
        world.spawn(Rope(b=entity, anchor_a=(0.5, 0.0), length=1.0))
        assert after(engine, world, entity, 0.2)[1] == pytest.approx(-0.2, abs=0.02)
        assert after(engine, world, entity, 3.0)[1] == pytest.approx(-1.0, abs=0.02)

    def test_a_slot_guides_along_its_axis(self, engine: type[Peer]) -> None:
        world, entity = bar()
        world.spawn(Slot(b=entity, anchor_a=(0.5, 0.0), axis=(2.0, -2.0), lower=-1.0, upper=1.0))
        x, y, _, _, angle, _ = after(engine, world, entity, 0.4)
        assert (x - 0.5, y) == pytest.approx((0.4, -0.4), abs=0.02) and angle == pytest.approx(0.0, abs=5e-3)
        x, y = after(engine, world, entity, 3.0)[:2]
        assert (x - 0.5, y) == pytest.approx((SIDE, -SIDE), abs=0.02)

    def test_a_weld_keeps_the_angle(self, engine: type[Peer]) -> None:
        world, entity = bar()
        world.spawn(Weld(b=entity, anchor_b=(-0.5, 0.0)))
        assert after(engine, world, entity, 1.0)[4] == pytest.approx(0.0, abs=0.02)

    def test_what_there_is_not_is_refused(self, engine: type[Peer]) -> None:
        world, entity = bar()
        world.spawn(Pulley(a=entity, b=None, wheel_a=(0.5, 1.0), wheel_b=(2.0, 1.0), anchor_b=(2.0, 0.0)))
        with pytest.raises(CannotBuild, match="no pulley"):
            engine(world)
        world, entity = bar()
        world.spawn(Pin(b=entity, anchor_b=(-0.5, 0.0), breaks=10.0))
        with pytest.raises(CannotBuild, match="no joint that breaks"):
            engine(world)
