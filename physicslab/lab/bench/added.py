"""A crowd, and one thing more far from it: how much longer a step takes for that.

A thing of a few bodies is to cost what these do: one that takes all others off the fastest way shows here.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from physicslab.components import (
    Charge,
    Drag,
    Gate,
    Layer,
    Mass,
    Medium,
    Molecule,
    Pin,
    Rod,
    Rope,
    Shape,
    Slot,
    Spring,
    Thrust,
    Trail,
    Transform,
    Velocity,
    Weld,
)
from physicslab.lab.bench.engine import Engine
from physicslab.lab.bench.moving import funnel
from physicslab.lab.bench.result import Spread, take_turns
from physicslab.lab.jobs import Job
from physicslab.world import World

BODIES = 1_500
"""Bodies of the crowd: those of a funnel."""
_FAR, _APART = (60.0, 60.0), 0.5
"""Where the thing is, and how far apart two bodies are [m]."""
_STEPS, _FALLING = 10, 6
"""Steps of a call, and how many such calls go by before the timing."""
_CALLS = 6
"""How many are timed."""


def _disc(world: World, *more: Any, across: float = 0.0, radius: float = 0.1) -> int:
    """Add a disc of about the mass of those in the crowd."""
    place = _FAR[0] + across, _FAR[1]
    return world.spawn(Transform(place), Velocity(), Mass(0.05), Shape.circle(radius), *more)


def _pair(world: World, join: Callable[[int, int], Any] | None = None) -> None:
    """Add two discs, and what joins them."""
    one, other = _disc(world), _disc(world, across=_APART)
    if join is not None:
        world.spawn(join(one, other))


def _alike(component: Callable[[], Any]) -> Callable[[World], Any]:
    """Return what adds two discs with a component each."""
    return lambda world: [_disc(world, component(), across=n * _APART) for n in range(2)]


def _in_pool(world: World, viscosity: float = 0.0) -> None:
    """Add a disc above a pool."""
    place = _FAR[0], _FAR[1] - 3.0
    world.spawn(Transform(place), Shape.box(4.0, 4.0), Medium(10.0, viscosity))
    _disc(world)


def _charged(world: World, **fields: Any) -> None:
    """Add a charge in a field."""
    world.physics = replace(world.physics, **fields)
    _disc(world, Charge(1e-2))


def _terrain(world: World) -> None:
    """Add a chain of two segments, and a disc on it."""
    world.spawn(Transform(_FAR), Shape.chain([(-3.0, 0.0), (0.0, -1.0), (3.0, 0.0)]))
    _disc(world)


ADDED: dict[str, Callable[[World], Any]] = {
    "two discs": _pair,
    "a pin": partial(_pair, join=lambda a, b: Pin(a, b, (0.25, 0.0), (-0.25, 0.0))),
    "a motor": lambda world: world.spawn(
        Pin(None, _disc(world), anchor_a=_FAR, motor_speed=3.0, max_torque=1.0)
    ),
    "a rod": partial(_pair, join=Rod),
    "a rope": partial(_pair, join=lambda a, b: Rope(a, b, length=1.0)),
    "a weld": partial(_pair, join=Weld),
    "a slot": lambda world: world.spawn(Slot(None, _disc(world), anchor_a=_FAR, axis=(1.0, 0.0))),
    "a layer": lambda world: _disc(world, Layer(2)),
    "a spring": partial(_pair, join=partial(Spring, stiffness=50.0)),
    "a stiff spring": partial(_pair, join=partial(Spring, stiffness=1e4)),
    "a damper": partial(_pair, join=partial(Spring, stiffness=50.0, damping=2.0)),
    "drag": _alike(partial(Drag, linear=0.5)),
    "a thrust": _alike(partial(Thrust, force=(0.1, 0.0))),
    "a swinging thrust": _alike(partial(Thrust, force=(0.1, 0.0), frequency=2.0)),
    "a pool": _in_pool,
    "a viscous pool": partial(_in_pool, viscosity=3.0),
    "charges": _alike(partial(Charge, 1e-6)),
    "an electric field": partial(_charged, electric_field=(1.0, 0.0)),
    "a magnetic field": partial(_charged, magnetic_field=1.0),
    "molecules": _alike(partial(Molecule, depth=1e-3, distance=0.5)),
    "a mover": lambda world: world.spawn(Transform(_FAR), Velocity((1.0, 0.0)), Shape.circle(0.1)),
    "a heavy disc": lambda world: world.spawn(Transform(_FAR), Velocity(), Mass(500.0), Shape.circle(0.1)),
    "a tiny disc": partial(_disc, radius=1e-3),
    "a terrain": _terrain,
    "a trail": lambda world: _disc(world, Trail(100)),
    "a gate": lambda world: (_disc(world), world.spawn(Gate(_FAR, (_FAR[0] + 1.0, _FAR[1])))),
}
"""All that may be added to the world of a crowd, by its name."""


@dataclass(frozen=True, slots=True)
class Added:
    """A crowd with one thing more, beside the same without.

    Attributes
    ----------
    what : str
        The thing.
    without_ms, with_ms : Spread
        A step without it and with it.
    ratio : float
        Median of the second by the first, call by call.
    stepper : str
        The stepper of most bodies.
    """

    what: str
    without_ms: Spread
    with_ms: Spread
    ratio: float
    stepper: str


def measure_added(what: str, bodies: int = BODIES) -> Job[Added]:
    """Time a crowd without and with a thing of :data:`ADDED`; yield the share that is done."""
    worlds = funnel(bodies), funnel(bodies)
    ADDED[what](worlds[1])
    engines = [Engine(world) for world in worlds]
    for n, rounds in enumerate((_FALLING, _CALLS)):
        for times in take_turns(engines, rounds, _STEPS):
            yield 0.5 * (n + len(times[0].step) / rounds)
    without, added = (np.array(spent.step) for spent in times)
    stepper = worlds[1].parts[0].stepper
    return Added(
        what, Spread.of(without), Spread.of(added), float(np.median(added / without)),
        stepper.name if stepper is not None else "",
    )  # fmt: skip
