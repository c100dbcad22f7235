"""Joints: heavy loads at their ends, motors and pulleys at stops, contradictions; ragdolls."""

import math
import statistics
from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np

from physicslab.components import Gear, Mass, Pin, Pulley, Rod, Shape, Slot, Transform, Velocity, Weld
from physicslab.diagnostics.energy import measure_energy
from physicslab.diagnostics.joints import joint_states
from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import StabilityCase, part_of
from physicslab.lab.worlds import energy_change, floor, largest, open_space
from physicslab.prefabs import box, circle, container, ragdoll
from physicslab.world import World

_LINK = 0.5
"""The length of a link [m]."""


def _soft() -> World:
    """Return a world with soft contacts, far above a floor."""
    world = open_space(contacts="soft")
    floor(world, Vector2(0.0, -500.0))
    return world


def _bars(
    world: World, links: int, heavy: float = 1.0, light: float = 1.0, kind: type[Any] = Pin
) -> tuple[World, int]:
    """Add level bars, the first held by the world; return that, and the ``heavy`` last one [kg]."""
    last: int | None = None
    for i in range(links):
        mass = heavy if i == links - 1 else light
        parts = Transform(((i + 0.5) * _LINK, 0.0)), Velocity(), Mass(mass), Shape.box(_LINK, 0.05)
        bar, at = world.spawn(*parts), (0.0 if last is None else 0.5 * _LINK, 0.0)
        world.spawn(kind(a=last, b=bar, anchor_a=at, anchor_b=(-0.5 * _LINK, 0.0)))
        last = bar
    assert last is not None
    return world, last


def _gap(world: World, seconds: float) -> float:
    """Return the largest distance of points that joints hold together, in lengths of a link."""
    world.run(seconds=seconds)
    return max(joint.largest_stretch for joint in joint_states(world)) / _LINK


def _chain(links: int, heavy: float, light: float = 1.0) -> float:
    return _gap(_bars(_soft(), links, heavy, light)[0], 3.0)


def _cantilever() -> float:
    """Return by what share of its length the end of ten bars sags."""
    world, last = _bars(_soft(), 10, kind=Weld)
    world.run(seconds=3.0)
    return abs(world.component(last, Transform).position.y) / (10 * _LINK)


def _bridge() -> float:
    """Return the largest gap of a bridge of 30 planks on which a ball of a ton falls from half a metre."""
    world, last = _bars(_soft(), 30, 10.0, 10.0)
    world.spawn(Pin(b=last, anchor_a=(30 * _LINK, 0.0), anchor_b=(0.5 * _LINK, 0.0)))
    circle(world, (15 * _LINK, 1.5), radius=1.0, mass=1000.0)
    return _gap(world, 4.0)


def _blocked() -> float:
    """Return how far a motor of 10 kN pushes a carriage of 1 kg beyond its stop [m]."""
    world = _soft()
    carriage = world.spawn(Transform(), Velocity(), Mass(1.0), Shape.box(0.5, 0.5))
    world.spawn(Slot(b=carriage, upper=0.2, motor_speed=5.0, max_force=1e4))
    return largest(world, 600, lambda: world.component(carriage, Transform).position.x - 0.2)


def _gears() -> float:
    """Return the error of the speed of the last wheel of a train of 1 to 1,000, as a share."""
    world, pins, wheels = _soft(), list[int](), list[int]()
    for n in range(4):
        place = Transform((3.0 * n, 0.0))
        wheels.append(world.spawn(place, Velocity(), Mass(1.0), Shape.circle(1.0)))
        pins.append(world.spawn(Pin(b=wheels[n], anchor_a=(3.0 * n, 0.0))))
        if n:
            world.spawn(Gear(first=pins[n - 1], second=pins[n], ratio=-10.0))
    world.add(pins[0], Pin(b=wheels[0], motor_speed=0.1, max_torque=1e9))
    world.run(seconds=5.0)
    return abs(world.component(wheels[3], Velocity).angular / -100.0 - 1.0)


def _pulley() -> float:
    """Return by what share the energy grows of a weight that is pulled up into its wheel, which it passes."""
    world = _soft()
    ends = [world.spawn(Transform((x, -0.5)), Velocity(), Mass(m)) for x, m in ((-1.0, 10.0), (1.0, 0.1))]
    world.spawn(Pulley(a=ends[0], b=ends[1], wheel_a=(-1.0, 0.0), wheel_b=(1.0, 0.0)))
    before, fallen = measure_energy(world).total, 10.0 * 9.81 * 0.5
    return largest(world, 300, lambda: (measure_energy(world).total - before) / fallen)


def _short_rod(make: Callable[[], World]) -> float:
    """Return how far the bob of a pendulum of a micrometre gets from its hinge [m]."""
    world = make()
    bob = world.spawn(Transform((1e-6, 0.0)), Velocity(), Mass(1.0), Shape.circle(0.1))
    world.spawn(Rod(b=bob))
    return largest(world, 300, lambda: world.component(bob, Transform).position.magnitude)


def _contradicted(contacts: str) -> float:
    """Return how fast a bar is at last whose two pins are farther apart than its holes [m/s]."""
    world = open_space(contacts=contacts)
    floor(world, Vector2(0.0, -5.0))
    bar = world.spawn(Transform(), Velocity(), Mass(1.0), Shape.box(1.0, 0.1))
    for side in (-1.0, 1.0):
        world.spawn(Pin(b=bar, anchor_a=(0.6 * side, 0.0), anchor_b=(0.5 * side, 0.0)))
    world.run(seconds=5.0)
    velocity = world.table(Velocity)
    return float(np.abs(velocity["linear"]).max() + np.abs(velocity["angular"]).max())


def _sheet(kind: type[Any], size: int, share: float, hung: set[int]) -> float:
    """Return the largest gain of energy of a square sheet of boxes, of what lifts it by its own size.

    Boxes of 1 kg, ``share`` of their distance wide, are joined to those beside them, and below the ``hung``
    columns of the first row to the world.
    """
    world, made, half = _soft(), dict[tuple[int, int], int](), 0.5 * _LINK * share
    for i, j in np.ndindex(size, size):
        parts = Transform((_LINK * i, -_LINK * j)), Velocity(), Mass(1.0), Shape.box(2.0 * half, 2.0 * half)
        made[i, j] = world.spawn(*parts)
        beside = [((i - 1, j), Vector2(half, 0.0))] if i else []
        beside += [((i, j - 1), Vector2(0.0, -half))] if j or i in hung else []
        for other, arm in beside:
            a = made.get(other)
            at = arm if a is not None else Vector2(_LINK * i, half + _LINK * (1.0 - share))
            world.spawn(kind(a=a, b=made[i, j], anchor_a=at, anchor_b=-arm))
    before, lifted = measure_energy(world).total, size * size * 9.81 * size * _LINK
    return largest(world, 240, lambda: (measure_energy(world).total - before) / lifted)


def _wheel() -> float:
    """Return the largest gain of energy of a wheel of rods that falls on a floor, of what lifts it there."""
    world, spokes, radius, high = open_space(contacts="soft"), 150, 3.0, 6.0
    floor(world, Vector2(0.0, -radius - high))
    hub = circle(world, (0.0, 0.0), radius=0.5)
    for n in range(spokes):
        tip = circle(world, Vector2.from_angle(2.0 * math.pi * n / spokes, radius), radius=0.02, mass=1.0)
        world.spawn(Rod(a=hub, b=tip))
    before, lifted = measure_energy(world).total, spokes * 9.81 * high
    return largest(world, 240, lambda: (measure_energy(world).total - before) / lifted)


def _carried(ratio: float, high: float) -> float:
    """Return the largest gain of energy of a light box with a heavy one welded on, of its lift by 1 m.

    The light one is let go ``high`` above a floor [m].
    """
    world = open_space(contacts="soft")
    floor(world, Vector2())
    light = box(world, (0.0, high + 0.5), width=1.0, height=1.0, mass=1.0)
    heavy = box(world, (0.0, high + 1.5), width=1.0, height=1.0, mass=ratio)
    world.spawn(Weld(a=light, b=heavy, anchor_a=(0.0, 0.5), anchor_b=(0.0, -0.5)))
    before = measure_energy(world).total
    return largest(world, 240, lambda: (measure_energy(world).total - before) / (ratio * 9.81))


def _unequal() -> float:
    """Return the change of energy of a double pendulum of 1 kg and 10^9 kg, of what its fall exchanges."""
    world, _ = _bars(open_space(), 2, 1e9)
    return energy_change(world, world.stepping(seconds=5.0))


_case = partial(StabilityCase, group="joints")
_link = partial(
    _case, right="its links stay together", figure="largest gap, in lengths of a link", limit=0.01
)

JOINTS = (
    *(
        _link(
            name=f"chain_{name}", measure=partial(_chain, 100, heavy),
            title=f"chain of 100 bars of 1 kg let go level, {heavy:,.0f} kg at the end, soft, 3 s",
        )
        for name, heavy in (("100kg", 100.0), ("10t", 10_000.0))
    ),
    _link(
        name="joint_1e9", title="bar of 10^-3 kg between a pin and a bar of 10^6 kg, let go level, soft, 3 s",
        measure=partial(_chain, 2, 1e6, 1e-3),
    ),
    _case(
        name="cantilever", title="cantilever of 10 welded bars, soft, 3 s", right="it stays straight",
        figure="sag of its end, in its length", limit=0.01, measure=_cantilever,
    ),
    _link(
        name="bridge_ball", title="bridge of 30 planks of 10 kg, 1,000 kg fall on it, soft, 4 s",
        measure=_bridge,
    ),
    _case(
        name="motor_blocked", title="motor of 10 kN against the stop of a slot, 1 kg, soft, 10 s", unit="m",
        right="the carriage stays at the stop", figure="way beyond it", limit=1e-6, measure=_blocked,
    ),
    _case(
        name="gears_1000", title="train of gears, 1 to 1,000, driven at 0.1 rad/s, soft, 5 s",
        right="the last wheel turns 1,000 times as fast", figure="error of its speed", limit=1e-6,
        measure=_gears,
    ),
    _case(
        name="pulley_stop", title="pulley: 10 kg pull 0.1 kg up into the wheel, soft, 5 s",
        right="no energy comes from it", figure="largest gain of energy", limit=1e-6, measure=_pulley,
    ),
    *(
        _case(
            name=f"rod_1um_{name}", title=f"pendulum of a micrometre let go level, {words}, 5 s", unit="m",
            right="the bob stays at its hinge", figure="largest distance", limit=limit,
            measure=partial(_short_rod, make),
        )
        for name, words, make, limit in (
            ("smooth", "nothing touches", open_space, 1.000001e-6), ("soft", "soft", _soft, 1e-3),
        )
    ),
    *(
        _case(
            name=name, title=f"{title}, soft, 4 s", right="no energy comes from it",
            figure="largest gain of energy, of what lifts it by its size", limit=1e-3, measure=measure,
        )
        for name, title, measure in (
            ("sheet_welded", "144 boxes welded to those beside them, hung from the upper row",
             partial(_sheet, Weld, 12, 1.0, set(range(12)))),
            ("sheet_of_rods", "1,024 boxes, rods between those beside each other, hung from two corners",
             partial(_sheet, Rod, 32, 0.25, {0, 31})),
            ("wheel_of_rods", "hub with 150 rods to discs of 1 kg falls by 6 m on a floor", _wheel),
        )
    ),
    *(
        _case(
            name=name, title=f"1,000 kg welded on a box of 1 kg that {words} a floor, soft, 4 s",
            right="no energy comes from it", figure="largest gain of energy, of what lifts it by 1 m",
            limit=5e-3, measure=partial(_carried, 1000.0, high),
        )
        for name, words, high in (
            ("welded_on_light", "stands on", 0.0), ("welded_on_light_falls", "falls by 0.3 m on", 0.3),
        )
    ),
    _case(
        name="pins_unequal", title="double pendulum of bars of 1 and 1e9 kg let go level, 5 s",
        right="the energy stays", figure="largest change of energy", limit=1e-8, measure=_unequal,
    ),
    *(
        _case(
            name=f"pins_contradict_{contacts}", unit="m/s", limit=1e-3,
            title=f"bar whose pins are 20 % farther apart than its holes, {contacts} contacts, 5 s",
            right="it comes to rest", figure="speed at last", measure=partial(_contradicted, contacts),
        )
        for contacts in ("soft", "rigid")
    ),
)  # fmt: skip


_DOLLS, _STARTS = 6, 5


def ragdoll_heap(count: int, apart: float = 1.4) -> World:
    """Return ragdolls of 71 kg that lie so far [m] over each other and fall into a pit of 4 m."""
    world = open_space()
    container(world, width=4.0, height=3.0)
    for n in range(count):
        ragdoll(world, (0.3 * (n % 3 - 1), 1.0 + apart * n), angle=1.5 if n % 2 else -1.5)
    return world


@cache  # two cases look at the same runs
def _heaps() -> tuple[float, float]:
    """Return the largest gap of heaps of ragdolls [m], and the median of their mean speeds at last [m/s].

    They begin from heights a centimetre apart: in one of four such a limb still rocks at the end.
    """
    widest, speeds = 0.0, []
    for start in range(_STARTS):
        world = ragdoll_heap(_DOLLS, 1.4 + 0.01 * start)
        world.run(seconds=8.0)
        speed = world.table(Velocity)["linear"][world.batch(Transform, Velocity).rows]
        widest = max(widest, *(joint.largest_stretch for joint in joint_states(world)))
        speeds.append(math.sqrt(float(np.mean(np.sum(speed * speed, axis=1)))))
    return widest, statistics.median(speeds)


_ragdolls = partial(
    StabilityCase, group="joints",
    title=f"{_STARTS} heaps of {_DOLLS} ragdolls of 10 parts that fall up to 8 m, 8 s",
)  # fmt: skip

ASSEMBLIES = (
    _ragdolls(
        name="ragdolls_gap", unit="m", right="they stay together", figure="largest gap", limit=0.02,
        measure=partial(part_of, 0, _heaps),
    ),
    _ragdolls(
        name="ragdolls_rest", unit="m/s", right="they come to rest", figure="median of mean speeds at last",
        limit=0.1, measure=partial(part_of, 1, _heaps),
    ),
)  # fmt: skip
