"""Paths of bodies at some moments of a run, with energy and momentum; the horizon of a motion."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.contact_warnings import contact_graph
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.ecs.vector import rotated
from physicslab.files.reader import read_scene
from physicslab.lab.accuracy.variants import ROUNDING, Document
from physicslab.lab.jobs import Job
from physicslab.state.masses import Diverged
from physicslab.state.packed import spring_ends
from physicslab.state.shapes import lengths_of
from physicslab.world import World

_MIRROR = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, -1.0])
_PATIENCE_S = 0.1
"""How long a run that may be given up goes on before the clock is looked at [s]."""
_WHOLE = 10**9
"""A stride that no run is longer than: the steps between two moments are made at once."""


class OutOfTime(ArithmeticError):
    """A run took longer than it may."""


@dataclass(frozen=True, slots=True)
class Path:
    """A run, at k moments.

    Attributes
    ----------
    states : array of floats
        Columns x, y [m], angle [rad], vx, vy [m/s], spin [rad/s] of n bodies (k, n, 6).
    energy, energy_scale : array of floats
        The total energy [J], and the largest of it and its parts since the start (k,).
    momentum : array of floats
        That of the whole world [kg m/s] (k, 2).
    momentum_scale : array of floats
        The largest sum of the sizes of the momenta of bodies since the start, or what it would be if each
        had moved by its size since then [kg m/s] (k,).
    angular, angular_scale : arrays of floats
        The same of the angular momentum about the origin [kg m^2/s] (k,).
    speeds, spins : arrays of floats
        The largest speed [m/s] and spin [rad/s] of each body since the start (k, n).
    overlaps : array of floats
        How deep each body overlaps another [m] (k, n).
    """

    states: NDArray[np.float64]
    energy: NDArray[np.float64]
    energy_scale: NDArray[np.float64]
    momentum: NDArray[np.float64]
    momentum_scale: NDArray[np.float64]
    angular: NDArray[np.float64]
    angular_scale: NDArray[np.float64]
    speeds: NDArray[np.float64]
    spins: NDArray[np.float64]
    overlaps: NDArray[np.float64]

    @property
    def end(self) -> NDArray[np.float64]:
        """The states at the last moment (n, 6)."""
        found: NDArray[np.float64] = self.states[-1]
        return found

    @property
    def places(self) -> NDArray[np.float64]:
        """Positions of bodies [m] (k, n, 2)."""
        return self.states[:, :, :2]

    def mirrored(self) -> Path:
        """Return it with left and right exchanged."""
        return replace(
            self, states=self.states * _MIRROR, momentum=self.momentum * _MIRROR[:2], angular=-self.angular
        )


def differences(
    states: NDArray[np.float64], others: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return how far apart states (..., n, 6) are: places [m], velocities [m/s], angles and spins [rad/s]."""
    off = states - others
    places, velocities = (np.hypot(off[..., n], off[..., n + 1]) for n in (0, 3))
    return places, velocities, np.abs(off[..., 2]), np.abs(off[..., 5])


def rows_of(world: World, bodies: Sequence[str]) -> list[int]:
    """Return the rows of bodies by their names; those that are not there are left out."""
    world.synchronise()
    batch = world.batch(Transform, Velocity)
    entities, rows = batch.entities.tolist(), batch.rows.tolist()
    found = {world.label(entity): row for entity, row in zip(entities, rows, strict=True)}
    return [found[name] for name in bodies if name in found]


def run_path(
    world: World, bodies: Sequence[str], moments: Sequence[float], budget_s: float = math.inf
) -> Path:
    """Run a world, and return its path.

    Parameters
    ----------
    bodies : sequence of str
        Which bodies, by their names.
    moments : sequence of floats
        When it is looked at, after its start [s], in order; it is run to the last.
    budget_s : float
        How long that may take [s], compiling left out.

    Raises
    ------
    OutOfTime
        If it takes longer.
    """
    rows = rows_of(world, bodies)
    patience = _PATIENCE_S if math.isfinite(budget_s) else math.inf
    began = time.perf_counter() - world.compile_s  # kernels may have to be compiled first
    looks, reached = [_look(world, rows)], 0.0
    for moment in moments:
        for _ in world.stepping(seconds=moment - reached, stride=_WHOLE, patience=patience):
            if time.perf_counter() - began - world.compile_s > budget_s:
                raise OutOfTime(f"given up after {budget_s:.3g} s, at t = {world.time:.3g} s")
        reached = moment
        looks.append(_look(world, rows))
    states, energy, energy_scale, momentum, momentum_scale, angular, angular_scale, overlaps = (
        np.array([look[n] for look in looks]) for n in range(8)
    )
    speeds, spins = np.hypot(states[..., 3], states[..., 4]), np.abs(states[..., 5])
    energy_scale, momentum_scale, angular_scale, speeds, spins = (
        np.maximum.accumulate(scale)[1:]
        for scale in (energy_scale, momentum_scale, angular_scale, speeds, spins)
    )
    sizes, elapsed = sizes_of(world, bodies), np.array(moments)
    weighed = np.isin(rows, world.batch(Transform, Velocity, Mass).rows)
    masses = np.where(weighed, world.table(Mass)["mass"][rows], 0.0)
    momentum_scale = np.maximum(momentum_scale, masses @ sizes / elapsed)
    angular_scale = np.maximum(angular_scale, masses @ sizes**2 / elapsed)
    return Path(
        states[1:], energy[1:], energy_scale, momentum[1:], momentum_scale, angular[1:], angular_scale,
        speeds, spins, overlaps[1:],
    )  # fmt: skip


def _look(
    world: World, rows: list[int]
) -> tuple[NDArray[np.float64], float, float, list[float], float, float, float, NDArray[np.float64]]:
    """Return what a path has of a world as it is now, in its order."""
    transform, velocity = world.table(Transform), world.table(Velocity)
    columns = (transform["position"], transform["angle"], velocity["linear"], velocity["angular"])
    energy, momentum = measure_energy(world), measure_momentum(world)
    batch = world.batch(Transform, Velocity, Mass)
    each = world.table(Mass)["mass"][batch.rows] * np.hypot(*velocity["linear"][batch.rows].T)
    reach = np.hypot(*transform["position"][batch.rows].T)
    turning = world.table(Mass)["inertia"][batch.rows] * np.abs(velocity["angular"][batch.rows])
    return (
        np.column_stack([column[rows] for column in columns]),
        energy.total,
        max(map(abs, (energy.total, energy.kinetic, *energy.potential.values()))),
        list(momentum.linear),
        float(np.sum(each)),
        momentum.angular,
        float(np.sum(reach * each + np.where(np.isfinite(turning), turning, 0.0))),
        _overlaps(world)[rows],
    )


def _overlaps(world: World) -> NDArray[np.float64]:
    """Return how deep the body in each row overlaps another [m] (rows,)."""
    graph, deepest = contact_graph(world), np.zeros(len(world.table(Transform)["angle"]))
    for side in (graph.a, graph.b):
        np.maximum.at(deepest, side[graph.touching], graph.depth)
    return deepest


_DISPLACED = 1e-10
"""By what share of its size each body is displaced in the variant that shows how errors grow."""
_PARTED = 0.1
"""Two runs in which a body is so many of its sizes apart have parted: they are different futures."""
_LOOKS = 400
"""How often two runs are compared."""


def sizes_of(world: World, bodies: Sequence[str]) -> NDArray[np.float64]:
    """Return half the extent of each body (n,) [m]; of one without a shape that of the whole scene.

    To that belong the points at which springs and joints hold bodies: a pendulum is as large as its rod.
    """
    half, radius = lengths_of(world.table(Shape), np.array(rows_of(world, bodies), np.int64))
    sizes = radius + np.hypot(half[:, 0], half[:, 1])
    places = _places(world)
    middle = places.sum(axis=0) / max(len(places), 1)
    whole = float(np.abs(places - middle).max(initial=0.0)) or 1.0
    return np.where(sizes > 0.0, sizes, whole)


def _places(world: World) -> NDArray[np.float64]:
    """Return where bodies are, and where springs and joints hold them or are fixed (n, 2) [m]."""
    world.joints.refresh(world.entity_index)
    (springs, first, second), joints, transform = spring_ends(world), world.joints, world.table(Transform)
    spring = world.table(Spring)
    ends = np.concatenate((first, second, joints.a, joints.b))
    anchors = np.concatenate(
        (spring["anchor_a"][springs], spring["anchor_b"][springs], joints.anchor_a, joints.anchor_b)
    )
    held = transform["position"][ends] + rotated(anchors, transform["angle"][ends])
    return np.concatenate((transform["position"][world.batch(Transform).rows], held))


def find_horizon(document: Document, bodies: Sequence[str], seconds: float) -> Job[float | None]:
    """Find the time at which a rounding has become another future; yield the share of the work that is done.

    That is the time from the start [s] at which an error of one rounding has grown to a tenth of a body's
    size, at the rate at which a larger one does; ``None`` where none does within the run.

    Parameters
    ----------
    document : Document
        The scene, with ids.
    bodies : sequence of str
        Those that can move.
    seconds : float
        How long it is run [s].
    """
    world, variant = read_scene(document), read_scene(document)
    rows, other = rows_of(world, bodies), rows_of(variant, bodies)
    if not rows:
        return None
    sizes = sizes_of(world, bodies)
    ways = np.random.default_rng(0).choice((-1.0, 1.0), (len(bodies), 2))
    variant.table(Transform)["position"][other] += _DISPLACED * sizes[:, None] * ways
    stride = max(1, round(seconds / world.simulation.dt) // _LOOKS)
    start = world.time
    beside = variant.stepping(seconds=seconds, stride=stride)
    try:
        for _ in world.stepping(seconds=seconds, stride=stride):
            next(beside, None)
            apart = world.table(Transform)["position"][rows] - variant.table(Transform)["position"][other]
            if (np.hypot(*apart.T) > _PARTED * sizes).any():
                rate = math.log(_PARTED / _DISPLACED) / (world.time - start)
                return math.log(_PARTED / ROUNDING) / rate
            yield (world.time - start) / seconds
    except Diverged:
        return None
    return None
