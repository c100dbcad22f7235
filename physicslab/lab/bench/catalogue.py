"""Every scene of the benchmark, in one explicit list."""

import math
from dataclasses import replace
from functools import partial
from pathlib import Path

from physicslab.components import Mass, Name, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene
from physicslab.lab.bench.moving import FUNNELS, JOINTED, MOVING, UNTUNED
from physicslab.lab.bench.scene import (
    BenchScene,
    at_rest,
    energy_change,
    lost,
    overlap,
    sideways,
    sink,
    within,
)
from physicslab.lab.case import Catalogue
from physicslab.lab.worlds import soft_space
from physicslab.prefabs import box, container, gas, pile, pyramid
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import System
from physicslab.world import World

SIZES = (1_000, 2_000, 4_000, 8_000, 16_000)
"""Bodies of the piles and gases."""
PEER_SIZE_LIMIT = 4_000
"""Bodies of the largest scene that other engines run unless it is named: piles of more take them minutes."""
_STEPS_OF_LARGE = {8_000: 150, 16_000: 100}
_SOFT = SimulationConfig(sleeping=False, collisions="step", contacts="soft")
_OVERLAP = 0.02
"""Deepest overlap that counts as right [m]: a tenth of a disc."""
_ENERGY = 1e-3
"""Largest change of a gas's energy that counts as right, as a share of it."""
_KINETIC, _CREEP = 1e-6, 2e-3
"""Largest kinetic energy a body [J] and drift [m] of bodies that count as being at rest."""
_NAMED = {"piles": (2_000, 8_000), "gases": (4_000, 8_000)}
"""Sizes that are run only where they are named: three others of the group show how the cost grows."""
_MOVE = 1e-3
"""By how much a body is moved, to and fro [m]."""
_PITCH = 0.25
"""From one disc of a pile to the next at the start [m]: that of the prefab."""


def _boxes(base: int) -> World:
    """Return a pyramid of boxes of 1 m on a floor."""
    world = soft_space(gravity=10.0)
    box(world, (0.0, -0.5), width=200.0, height=1.0, static=True, friction=0.6)
    pyramid(world, base)
    return world


def _columns(count: int) -> int:
    return max(3, round(1.82 * math.sqrt(count)))


def _pile_width(count: int) -> float:
    """Return the width of a pile's container [m]."""
    return _PITCH * _columns(count) + 1.25


def discs(count: int, systems: tuple[System, ...] | None = None) -> World:
    """Return discs of 0.2 m in a container, three times as wide as high for any number.

    ``systems`` are every physics system there is, where none are given.
    """
    columns = _columns(count)
    world = World(*(systems or standard_systems()), simulation=_SOFT)
    height = _PITCH * math.ceil(count / columns)
    container(world, width=_pile_width(count), height=height + 11.0)
    pile(world, count, columns=columns)
    return world


def _gas_box(count: int) -> tuple[float, float]:
    """Return half the width and half the height of a gas's box [m]."""
    scale = math.sqrt(count / 2_000)
    return 12.0 * scale, 7.5 * scale


def _gas(count: int) -> World:
    """Return elastic discs that fill 17 % of a box, for any number."""
    half, top = _gas_box(count)
    bounds = (-half, -top, half, top)
    laws = PhysicsConfig(gravity_mode="none", bounds=bounds, bounds_restitution=1.0, bounds_friction=0.0)
    world = soft_space(physics=laws)
    gas(world, count, bounds)
    return world


def ten_discs(systems: tuple[System, ...] | None = None, simulation: SimulationConfig = _SOFT) -> World:
    """Return ten discs in a small container, which come to rest on each other."""
    world = World(*(systems or standard_systems()), simulation=simulation)
    container(world, width=1.3, height=2.0)
    pile(world, 10, columns=5)
    return world


def _pyramid_scene(base: int, drift: float, sunk: float) -> BenchScene:
    count = base * (base + 1) // 2
    return BenchScene(
        name=f"pyramid_{base}", title=f"pyramid of {count:,} boxes", group="pyramids", size=count,
        build=partial(_boxes, base),
        quality=(sideways(drift), sink(sunk), *at_rest(_KINETIC * count, _CREEP)),
    )  # fmt: skip


def pile_scene(count: int) -> BenchScene:
    """Return the pile of so many discs."""
    inside = within(0.5 * _pile_width(count))
    return BenchScene(
        name=f"pile_{count}", title=f"pile of {count:,} discs", group="piles", size=count,
        build=partial(discs, count), steps=_STEPS_OF_LARGE.get(count, 300),
        by_default=count not in _NAMED["piles"],
        quality=(overlap(_OVERLAP), *at_rest(_KINETIC * count, _CREEP), lost(inside)),
    )  # fmt: skip


def gas_scene(count: int) -> BenchScene:
    """Return the gas of so many discs."""
    half, top = _gas_box(count)
    return BenchScene(
        name=f"gas_{count}", title=f"gas of {count:,} elastic discs", group="gases", size=count,
        build=partial(_gas, count), steps=_STEPS_OF_LARGE.get(count, 300),
        by_default=count not in _NAMED["gases"],
        quality=(energy_change(_ENERGY), lost(within(half, floor=-top, top=top))),
    )  # fmt: skip


_TEN_DISCS = BenchScene(
    name="circles_10", title="ten discs at rest, many steps in one call", group="ten_discs", size=10,
    build=ten_discs, steps=6_000, compiled_runs=True,
    quality=(overlap(_OVERLAP), *at_rest(_KINETIC * 10, _CREEP), lost(within(0.65))),
)  # fmt: skip
_STEPPED = replace(
    _TEN_DISCS, name="circles_10_stepped", title="the same ten discs, step by step", steps=3_000,
    compiled_runs=False,
)  # fmt: skip
_IN_WINDOW = replace(
    _STEPPED, name="circles_10_window", title="the same ten discs, step by step in a window", in_window=True
)
_AUTO = replace(
    _TEN_DISCS, name="circles_10_auto", title="the ten discs with contacts and collisions of a scene file",
    build=partial(ten_discs, simulation=SimulationConfig(contacts="auto")), steps=2_000,
)  # fmt: skip


def _edited(world: World) -> int:
    """Return the body that is edited: the last of those that move, which lies on top."""
    return int(world.batch(Transform, Velocity).entities[-1])


def _rename(world: World, step: int) -> None:
    """Give a body another name, on which no motion depends."""
    world.add(_edited(world), Name(f"disc {step % 2}"))


def _weigh(world: World, step: int) -> None:
    """Make a body a tenth heavier, and lighter again."""
    world.component(_edited(world), Mass).mass *= 1.1 if step % 2 == 0 else 1.0 / 1.1


def _move(world: World, step: int) -> None:
    """Move a body aside, and back."""
    place = world.component(_edited(world), Transform)
    place.position = place.position + Vector2(_MOVE if step % 2 == 0 else -_MOVE, 0.0)


_edits = partial(
    BenchScene, group="edits", size=1_000, build=partial(discs, 1_000), quality=(overlap(_OVERLAP),)
)

SCENES = Catalogue(
    (
        _pyramid_scene(30, drift=0.05, sunk=0.10),
        _pyramid_scene(60, drift=0.13, sunk=0.29),  # Box2D v3's figures, in C
        *map(pile_scene, SIZES),
        *map(gas_scene, SIZES),
        _TEN_DISCS,
        _STEPPED,
        _IN_WINDOW,
        _AUTO,
        *MOVING,
        *FUNNELS,
        *UNTUNED,
        *JOINTED,
        # A pile at rest, edited before every step as a user or a script would do it.
        _edits(name="edit_name", title="1,000 discs at rest, one renamed before every step", edit=_rename),
        _edits(name="edit_mass", title="the same, the mass of one set", edit=_weigh),
        _edits(name="edit_position", title="the same, one moved by a millimetre", edit=_move),
    )
)
"""Every scene by name; families are groups."""


def by_default() -> list[BenchScene]:
    """Return the scenes that are run where none is named."""
    return [scene for scene in SCENES.values() if scene.by_default]


def opened(name: str) -> BenchScene:
    """Return a built-in scene or a scene file, to be timed from its first step on, without sleeping.

    Raises
    ------
    SceneError
        If it cannot be read.
    """

    def build() -> World:
        world = load_scene(name)
        world.simulation = replace(world.simulation, sleeping=False)
        return world

    world = build()
    world.synchronise()
    return BenchScene(
        name=Path(name).stem, title=world.title or name, group="opened", size=len(world.batch(Velocity)),
        build=build, seconds=0.0,
    )  # fmt: skip
