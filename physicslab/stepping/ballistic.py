"""Which worlds can have their collisions located exactly, and which benefit."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Material, Shape, Transform, Velocity
from physicslab.components.shape import CHAIN, KINDS
from physicslab.ecs.sentences import sentence
from physicslab.languages.sentence import Sentence
from physicslab.state.chain_links import links_in
from physicslab.state.solid import is_any_apart, may_touch, solid_rows
from physicslab.state.state import State
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.contact import ContactSystem
from physicslab.systems.integrate import IntegrateSystem, why_nowhere
from physicslab.systems.joint import JointSystem
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import ForceSystem

MAX_BODIES = 32
"""Number of moving bodies above which ``auto`` prefers the contact step."""
MAX_PAIRS = 20_000
"""Largest number of pairs: every impact searches all of them, which would take too long for more."""
CONTACT_STEP = (IntegrateSystem, BroadPhaseSystem, ContactSystem, ResolveSystem)
"""The systems of the contact step: what rests, or cannot be solved otherwise, is left to them."""
_CONTACT_DISTANCE = 0.01
"""Share of the smaller body's size within which bodies count as resting on each other."""


def why_not_exact(state: State, schedule: Schedule) -> str | None:
    """Return why the times of impacts cannot be located, or ``None``.

    Between impacts a body must move under a constant acceleration, and nothing but a disc may turn.
    """
    if (reason := why_never_exact(state, schedule)) is not None:
        return reason
    if len(state.batch(Held)):
        return sentence("held")
    if (nowhere := why_nowhere(state)) is not None:
        return nowhere
    rows = turning_rows(state)
    if len(rows):
        label, kind = state.label_of_row(int(rows[0])), state.table(Shape)["kind"][rows[0]]
        name = list(KINDS)[kind - 1]
        return sentence("turns", body=label, shape=Sentence(name))
    if count_pairs(state, linked=True) > MAX_PAIRS:
        return sentence("many_pairs", limit=MAX_PAIRS)
    return None


def why_never_exact(state: State, schedule: Schedule) -> str | None:
    """Return why the times of impacts cannot be located whatever the bodies are, or ``None``."""
    if state.simulation.integrator not in ("auto", "exact"):
        return sentence("other_method_asked", method=state.simulation.integrator)
    if (reason := _why_not_ballistic(state, schedule)) is not None:
        return reason
    damped = state.physics.linear_damping > 0.0 or state.physics.angular_damping > 0.0
    return sentence("damped") if damped else None


def _why_not_ballistic(state: State, schedule: Schedule) -> str | None:
    """Return what acts within a step that is neither uniform gravity nor the contact step, or ``None``."""
    for needed in CONTACT_STEP:
        if schedule.find(needed) is None:
            return sentence("system_absent_for_rest", system=needed.__name__)
    for system in schedule.running:
        if isinstance(system, ForceSystem):
            if system.uniform_alone(state) is None:
                attracts = system.attractors > 0
                return sentence("attraction") if attracts else sentence("not_uniform", system=system.name)
        elif isinstance(system, JointSystem):
            return sentence("joined")
        elif not (system.is_engine or system.leaves_motion()):
            return sentence("acts_within_step", system=system.name)
    return None


def turning_rows(state: State) -> NDArray[np.int64]:
    """Return the rows (n,) that turn, or would after an impact off their centre, and are no discs."""
    moving = state.batch(Shape, Transform, Velocity).rows
    cores: NDArray[np.int64] = moving[state.bodies.shapes.vertices[moving] > 1]
    if not len(cores):
        return cores
    turns = (state.bodies.inverse_inertia[cores] > 0.0) | (state.table(Velocity)["angular"][cores] != 0.0)
    turning: NDArray[np.int64] = cores[turns]
    return turning


def count_pairs(state: State, *, linked: bool = False) -> int:
    """Return how many pairs may meet, without making a list of what may be thousands of millions.

    A body and a chain are one, or where they are ``linked`` as many as the chain has links.
    """
    shaped = solid_rows(state)
    count, movable = len(shaped), int(np.count_nonzero(state.bodies.inverse_mass[shaped] > 0.0))
    walls = 0 if state.physics.bounds is None else 4
    if linked:
        chains = shaped[state.table(Shape)["kind"][shaped] == CHAIN].tolist()
        count += sum(len(links_in(state.bodies.shapes, chain)) - 1 for chain in chains)
    return movable * (movable - 1) // 2 + movable * (count - movable) + movable * walls


def with_links(state: State, pairs: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return pairs that may meet (n, 3), where that of a body and a chain is one for each link."""
    chain = state.table(Shape)["kind"] == CHAIN
    rows = np.where(chain[pairs[:, 0]], pairs[:, 0], pairs[:, 1])
    linked = chain[rows] & (pairs[:, 2] < 0)
    if not linked.any():
        return pairs
    counts = np.ones(len(pairs), np.int64)
    counts[linked] = [len(links_in(state.bodies.shapes, row)) for row in rows[linked].tolist()]
    every = np.repeat(pairs, counts, axis=0)
    number = np.arange(len(every)) - np.repeat(np.cumsum(counts) - counts, counts)
    every[:, 2] = np.where(np.repeat(linked, counts), -2 - number, every[:, 2])
    return every


def pairs_that_may_meet(state: State) -> NDArray[np.int64]:
    """Return every pair of rows (a, b, wall) of which one can be moved, sorted, bounds as walls of row 0."""
    shaped = solid_rows(state)
    inverse_mass = state.bodies.inverse_mass[shaped]
    i, j = np.triu_indices(len(shaped), 1)
    meets = (inverse_mass[i] > 0.0) | (inverse_mass[j] > 0.0)
    if is_any_apart(state):
        meets &= may_touch(state, shaped[i], shaped[j])
    bodies = np.stack((shaped[i[meets]], shaped[j[meets]], np.full(int(meets.sum()), -1)), axis=1)
    walled = np.zeros((0, 3), np.int64)
    if state.physics.bounds is not None:
        inner = np.repeat(shaped[inverse_mass > 0.0], 4)
        walled = np.stack((np.zeros_like(inner), inner, np.tile(np.arange(4), len(inner) // 4)), axis=1)
    return np.ascontiguousarray(np.concatenate((walled, bodies)), dtype=np.int64)


def why_not_worthwhile(state: State, schedule: Schedule) -> str | None:
    """Return why a world that qualifies is better off with the contact step, or ``None``."""
    moving = state.batch(Transform, Velocity).rows
    if len(moving) > MAX_BODIES:
        return sentence("many_bodies", limit=MAX_BODIES)
    pairs = pairs_that_may_meet(state)
    restitution = state.table(Material)["restitution"]
    other = np.where(pairs[:, 2] >= 0, state.physics.bounds_restitution, restitution[pairs[:, 0]])
    if (np.minimum(other, restitution[pairs[:, 1]]) == 0.0).any():
        return sentence("no_bounce")
    return _why_at_rest(state, schedule, moving, pairs)


def _why_at_rest(
    state: State, schedule: Schedule, moving: NDArray[np.int64], pairs: NDArray[np.int64]
) -> str | None:
    """Return whether bodies rest on each other, or all rest, judged by their axis-aligned bounding boxes."""
    if not schedule.forces:
        return None  # nothing presses bodies together
    low, high, size = _boxes(state)
    a, b, wall = pairs.T
    apart = np.maximum(low[b] - high[a], low[a] - high[b]).max(axis=1)
    if state.physics.bounds is not None:
        bounds = np.array(state.physics.bounds)
        to_wall = np.concatenate((low - bounds[:2], bounds[2:] - high), axis=1)
        apart = np.where(wall >= 0, to_wall[b, wall], apart)
        size = size.copy()
        size[0] = np.inf
    velocity = state.table(Velocity)["linear"]
    fall = float(state.physics.gravity.magnitude) * state.simulation.dt
    slow = np.hypot(*(velocity[b] - velocity[a]).T) <= fall
    touching = slow & (apart <= _CONTACT_DISTANCE * np.minimum(size[a], size[b]))
    free = state.bodies.inverse_mass > 0.0
    if (touching & free[a] & free[b]).any():
        return sentence("lying_on_each_other")
    resting = np.unique(np.concatenate((a[touching & free[a]], b[touching & free[b]])))
    if len(moving) and len(resting) == int(free[moving].sum()):
        return sentence("everything_rests")
    return None


def _boxes(state: State) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return the lowest and highest coordinates of every row (rows, 2), and its size [m]."""
    transform, of = state.table(Transform), state.bodies.shapes
    c, s = np.cos(transform["angle"]), np.sin(transform["angle"])
    half = np.zeros_like(transform["position"])
    for k in range(int(of.vertices.max(initial=0))):
        at = of.first + np.minimum(k, np.maximum(of.vertices - 1, 0))
        x, y = of.half_x * of.pool[at, 0], of.half_y * of.pool[at, 1]
        half = np.maximum(half, np.abs(np.stack((c * x - s * y, s * x + c * y), axis=1)))
    half += of.radius[:, None]
    return transform["position"] - half, transform["position"] + half, 2.0 * of.thin
