"""What of a world is not to be trusted as it is stepped, and which setting would help.

The limits are measured, and each says how. Nothing here runs within a step: a look costs some 50 us for a few
bodies and below a millisecond for thousands, and is taken ten times a second or once a measurement.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from physicslab.components import Shape, Spring, Transform, Velocity
from physicslab.components.shape import BOX
from physicslab.diagnostics.contact_graph import ContactGraph, contact_graph
from physicslab.diagnostics.warning_records import Advice, WorstAdvice
from physicslab.state.packed import spring_ends
from physicslab.systems.system import ForceSystem

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["Advice", "WorstAdvice", "advise"]

_RESOLVED = 0.3
"""omega h of a fixed step, as a share of the method's limit: with leapfrog the energy of such an oscillation
swings by a tenth."""
_FOLLOWED = 1.0
"""omega h of the implicit rule, which is stable beyond: the phase is 8 % off there."""
_AUTO_FOLLOWS = 500.0
"""omega dt up to which ``auto`` divides a step until it follows an oscillation."""
_MOST_SUBSTEPS = 10_000
_DEEP = 0.2
"""Overlap as a share of the smaller body. A stack of ten equal boxes stays below 0.005, 300 kg on 1 kg below
0.08, a pile of 900 bodies that lands has 0.16 for a moment; what is pressed through another passes 0.3."""
_FAST = 1.0
"""Relative speed times the substep, in sizes of the smaller body, among several neighbours. One impact is
right at any speed, for the motion is swept; but a body meets one neighbour a substep: of 20 discs of e = 1
in walls none is lost in 300 steps at 1, three at 2, twelve at 5."""
_TURNING = 0.25
"""Angle that a box turns by in a substep [rad] near others. Places are swept, corners are not: a spinning box
dropped on a floor lands 8 % off at 0.25, 25 % off at 0.5, anywhere at 1; energy never grows, up to 5."""
_HEAVY = 3000.0
"""Mass ratio of a body that lies on a lighter one. On top of ten boxes of 1 m a body a thousand times as
heavy sinks by 2 cm in 10 s, three thousand times by 4 cm, ten thousand times by 38 cm: substeps, which are
made shorter for such loads, have reached their least length."""
_FAR = 1e9
"""Coordinate in sizes of a body: float64 keeps places there to 1e-7 of the body, and a tower to 1e-3."""


def advise(world: World) -> tuple[Advice, ...]:
    """Return what is not to be trusted of a world as it is now: the worst of each kind.

    Nothing is changed; the figures are those of the last step.
    """
    found = [*_refusals(world), *_division(world), *_rates(world), *_distance(world)]
    if world.plan.collisions == "step":
        near = contact_graph(world)
        found += [*_overlap(world, near), *_loads(world, near), *_speeds(world, near), *_turning(world, near)]
    return tuple(found)


def _refusals(world: World) -> Iterator[Advice]:
    """Yield what was asked for and could not be had."""
    method = world.plan
    if method.refused:
        yield Advice(None, method.refused, None, "", None, 'simulation.integrator = "auto"')
    if world.simulation.collisions == "exact" and method.collisions == "step":
        yield Advice(None, method.collision_reason, None, "", None, 'simulation.collisions = "auto"')


def _division(world: World) -> Iterator[Advice]:
    if world.step_divisions > 1:
        what = "steps were asked for that are longer than the scene's, and are divided into so many"
        yield Advice(None, what, float(world.step_divisions), "", 1.0, "a shorter step")


def _rates(world: World) -> Iterator[Advice]:
    """Yield a force too fast for the steps that are made."""
    method, dt = world.plan, world.simulation.dt
    integrator = method.integrator if method.smooth else method.split_forces or method.stages
    if method.collisions == "exact" or integrator.chooses_steps or math.isinf(integrator.order):
        return
    rates = [
        (system.strongest_rate(world), system)
        for system in world.schedule.running
        if isinstance(system, ForceSystem)
    ]
    rate, system = max(rates, key=lambda pair: pair[0], default=(0.0, None))
    if system is None or not math.isfinite(rate):
        return
    parts = method.substeps * (2 * method.split_steps if method.split_forces else 1)
    value, bounded = rate * dt / parts, math.isinf(integrator.stability_limit)
    limit = _FOLLOWED if bounded else _RESOLVED * integrator.stability_limit
    if value <= limit:
        return
    entity = _stiffest(world) if Spring in system.needs else None
    source = "" if entity else f"{system.name.removesuffix('System')}: "
    if bounded:
        what = "is too fast to be followed (omega h): what it does between steps is not shown"
    elif value > integrator.stability_limit:
        what = "is too stiff for the step (omega h): it flies apart"
    else:
        what = "is resolved coarsely (omega h): its energy swings"
    yield Advice(entity, source + what, value, "", limit, _shorter(world, rate, limit, followed=bounded))


def _shorter(world: World, rate: float, limit: float, *, followed: bool) -> str:
    """Return the setting with which a rate [rad/s] is followed by the present method, or by ``auto``."""
    simulation = world.simulation
    if followed and simulation.integrator == "auto":
        return f"simulation.dt = {_below(_AUTO_FOLLOWS / rate):.2g}"
    needed = math.ceil(rate * simulation.dt / limit)
    if needed <= _MOST_SUBSTEPS:
        return f"simulation.substeps = {needed}"
    return f"simulation.dt = {_below(limit * simulation.substeps / rate):.2g}"


def _below(value: float) -> float:
    """Round down to two digits, so that what is shown still helps."""
    digits = 10.0 ** (math.floor(math.log10(value)) - 1)
    return math.floor(value / digits) * digits


def _stiffest(world: World) -> str | None:
    """Return the name of the spring with the fastest oscillation or decay of its own."""
    rows, a, b = spring_ends(world)
    if not len(rows):
        return None
    spring, inverse = world.table(Spring), world.bodies.inverse_mass
    give = inverse[a] + inverse[b]
    rates = np.maximum(np.sqrt(spring["stiffness"][rows] * give), spring["damping"][rows] * give)
    return world.label(int(world.entity_index.entities[rows[np.argmax(rates)]]))


def _distance(world: World) -> Iterator[Advice]:
    """Yield the body that is furthest out for its size."""
    batch = world.batch(Transform, Shape)
    if not len(batch):
        return
    shape, rows = world.table(Shape), batch.rows
    reach = np.abs(world.table(Transform)["position"][rows]).max(axis=1)
    box = shape["kind"][rows] == BOX
    size = np.where(box, np.minimum(shape["width"][rows], shape["height"][rows]), 2.0 * shape["radius"][rows])
    worst = int(np.argmax(reach / size))
    limit = _FAR * float(size[worst])
    if reach[worst] >= limit:
        what = "is so far from the origin that its contacts cannot be resolved"
        name = world.label(int(batch.entities[worst]))
        yield Advice(name, what, float(reach[worst]), "m", limit, "a place nearer to the origin")


def _overlap(world: World, near: ContactGraph) -> Iterator[Advice]:
    if not len(near.touching):
        return
    share = near.depth / near.size[near.touching]
    worst = int(np.argmax(share))
    if share[worst] > _DEEP:
        name = near.lighter(world, int(near.touching[worst]))
        size = float(near.size[near.touching[worst]])
        what = "is pressed into another body further than contacts hold"
        yield Advice(name, what, float(near.depth[worst]), "m", _DEEP * size, "")


def _loads(world: World, near: ContactGraph) -> Iterator[Advice]:
    """Yield the heaviest body that lies on a lighter one, which something holds from below."""
    ratio = near.loads(world)
    if len(ratio) and ratio.max() > _HEAVY:
        name = near.lighter(world, int(near.touching[np.argmax(ratio)]))
        what = "carries a body so much heavier that contacts do not hold it (mass ratio)"
        yield Advice(name, what, float(ratio.max()), "", _HEAVY, "")


def _speeds(world: World, near: ContactGraph) -> Iterator[Advice]:
    """Yield the fastest body that has several neighbours."""
    h = world.simulation.dt / world.simulation.substeps
    linear = world.table(Velocity)["linear"]
    apart = linear[near.b] - linear[near.a]
    sizes = np.hypot(apart[:, 0], apart[:, 1]) * h / near.size
    sizes[~near.crowded(sizes > _FAST)] = 0.0
    if len(sizes) and sizes.max() > _FAST:
        worst = int(np.argmax(sizes))
        setting = _more_substeps(world, float(sizes[worst]) / _FAST)
        what = "passes so many sizes of a body in a substep, and impacts after the first may be missed"
        yield Advice(near.faster(world, worst), what, float(sizes[worst]), "", _FAST, setting)


def _turning(world: World, near: ContactGraph) -> Iterator[Advice]:
    """Yield the box that spins fastest near others."""
    h = world.simulation.dt / world.simulation.substeps
    kind = world.table(Shape)["kind"]
    involved = np.zeros(len(kind), np.bool_)
    involved[near.a] = involved[near.b] = True
    rows = np.flatnonzero(involved & (kind == BOX))
    angles = np.abs(world.table(Velocity)["angular"][rows]) * h
    if len(angles) and angles.max() > _TURNING:
        setting = _more_substeps(world, float(angles.max()) / _TURNING)
        what = "turns so far in a substep that its corners strike by chance"
        name = world.label(int(world.entity_index.entities[rows[np.argmax(angles)]]))
        yield Advice(name, what, float(angles.max()), "rad", _TURNING, setting)


def _more_substeps(world: World, factor: float) -> str:
    needed = math.ceil(world.simulation.substeps * factor)
    return f"simulation.substeps = {needed}" if needed <= _MOST_SUBSTEPS else "a smaller simulation.dt"
