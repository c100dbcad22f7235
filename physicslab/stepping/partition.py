"""Which bodies of a world are one island: those that forces couple, and those that may meet soon.

All of it is local: whether two bodies are joined depends on these two alone, so that islands here are the
same whatever there is elsewhere.
"""

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Drag, Mass, Material, Shape, Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.kernels.broad.clusters import label_clusters
from physicslab.kernels.broad.island_gaps import steps_apart
from physicslab.kernels.solver.impulse import HEAVY_RATIO
from physicslab.state.state import State
from physicslab.stepping.ballistic import CONTACT_STEP, turning_rows, why_never_exact
from physicslab.stepping.contact_model import why_all_soft
from physicslab.stepping.stepper import falls_far
from physicslab.systems.accelerate import AccelerateSystem
from physicslab.systems.drag import DragSystem
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import why_nowhere
from physicslab.systems.schedule import Schedule
from physicslab.systems.standard import PHYSICS_SYSTEMS

type Rows = NDArray[np.int64]
"""Numbers of rows (n,)."""

MAX_BODIES = 12
"""Number of bodies with a Shape above which an island has none of its own steppers: all such are together."""
MAX_ISLANDS = 32
"""Number of islands above which a world is not divided: each costs a call of a stepper."""
FAR_S = 1.0
"""Bodies that could not meet within so long [s] are divided, if none of ``FAR_RADII`` is between them."""
FAR_RADII = 4.0
"""Distance, in radii of both, up to which they stay one island in any case."""
NEAR_S, NEAR_STEPS = 0.1, 4.0
"""Islands that could meet within so long [s], or so many steps, become one."""
_FOLLOWED = GravitySystem, DragSystem
"""Forces on each body by itself that the compiled loop of substeps follows."""


class Partition(NamedTuple):
    """The islands of a world, each as sorted rows of movable bodies; one alone has a reason."""

    groups: tuple[Rows, ...]
    reason: str = ""


def movable_in(state: State) -> NDArray[np.bool_]:
    """Return which rows (rows,) belong to one island each; what else is somewhere belongs to every one."""
    present = state.table(Transform).present & state.table(Velocity).present
    movable: NDArray[np.bool_] = present & (state.bodies.inverse_mass > 0.0)
    return movable


def why_whole(state: State, schedule: Schedule) -> str | None:
    """Return why a world cannot be divided, whatever is where, or ``None``."""
    for system in schedule.running:
        if type(system) not in (AccelerateSystem, *PHYSICS_SYSTEMS) and system.acts_within_step():
            return sentence("acts_within_step", system=system.name)
    if (nowhere := why_nowhere(state)) is not None:
        return nowhere
    found = [schedule.find(needed) is not None for needed in CONTACT_STEP]
    if not found[0]:
        return sentence("nothing_integrates")
    if any(found[1:]) and not all(found):
        return sentence("contact_systems_absent")
    rows = np.flatnonzero(movable_in(state))
    if _all_shaped_alike(state, schedule, rows) and why_all_soft(state, schedule) is not None:
        return sentence("islands_all_soft")
    return _why_coupled(state, schedule)


def _all_shaped_alike(state: State, schedule: Schedule, rows: Rows) -> bool:
    """Whether all of some bodies can touch others, and steps of none take longer than those of others."""
    return bool(state.table(Shape).present[rows].all()) and not _take_longer(state, schedule, rows)


def _take_longer(state: State, schedule: Schedule, rows: Rows) -> bool:
    """Whether steps of some bodies may take longer than those of others: in more substeps, or by Python.

    They may need more for their masses, where anything but drag acts, or as one is small for its fall. Python
    follows forces on each body by itself, or books their work, in each substep; springs and drag the compiled
    loop follows.
    """
    presses = any(type(force) is not DragSystem for force in schedule.forces)
    smallest = 2.0 * float(state.bodies.shapes.thin[rows].min(initial=np.inf))
    if (presses and _are_unequal(state, rows)) or falls_far(state, state.simulation.dt, smallest) > 1:
        return True
    own = [force for force in schedule.forces if force.couples_nothing and type(force) not in _FOLLOWED]
    return any(np.isin(rows, state.batch(*force.needs).rows).any() for force in own)


def _are_unequal(state: State, rows: Rows) -> bool:
    """Whether masses of some bodies are so unlike that a heavy one on a light one may need more substeps."""
    inverse = state.bodies.inverse_mass[rows]
    return bool(inverse.max(initial=0.0) > HEAVY_RATIO * inverse.min(initial=np.inf))


def _why_coupled(state: State, schedule: Schedule) -> str | None:
    """Return which force acts on what no island has for its own, or between all bodies, or ``None``."""
    given = state.table(Transform).present & ~movable_in(state)
    driven = given & state.table(Velocity).present
    for force in schedule.forces:
        pairs = force.couples(state)
        if pairs is None:
            return sentence("couples_all", system=force.name)
        a, b = pairs.T
        # Row 0, the world, is fixed.
        if ((driven[a] & (given[b] | (b == 0))) | (driven[b] & (given[a] | (a == 0)))).any():
            return sentence("couples_driven", system=force.name)
    if (driven & state.table(Drag).present & state.table(Mass).present).any():
        return sentence("drag_on_held")
    return None


def is_one(state: State, schedule: Schedule) -> bool:
    """Whether a world is one island wherever its bodies are: they are few, or all coupled."""
    rows = np.flatnonzero(movable_in(state))
    if len(rows) < 2 or why_whole(state, schedule) is not None:
        return True
    return not join(np.arange(len(rows)), _couples(state, schedule, rows).tolist()).any()


def islands_of(state: State, schedule: Schedule) -> list[list[int]]:
    """Return the entities of each island of a world where its bodies are; none where it is one."""
    if why_whole(state, schedule) is not None:
        return []
    groups, _ = groups_of(state, schedule, np.flatnonzero(movable_in(state)))
    entities = state.entity_index.entities
    return [entities[group].tolist() for group in groups] if len(groups) > 1 else []


def groups_of(state: State, schedule: Schedule, rows: Rows) -> Partition:
    """Return into which islands some movable bodies are to be divided."""
    if len(rows) < 2:
        return Partition((rows,), sentence("one_body"))
    labels = _labels(state, schedule, rows)
    groups = [rows[labels == label] for label in dict.fromkeys(labels.tolist())]
    if len(groups) == 1:
        return Partition((rows,), sentence("all_near"))
    soft = why_all_soft(state, schedule) is not None
    flies = np.zeros(len(state.entity_index), np.bool_) if soft else _may_fly(state, schedule)
    most = 0 if soft else _most_apart(state, [group for group in groups if not flies[group].all()])
    own = _advanced_apart(state, schedule, groups, flies, most)
    if len(own) > MAX_ISLANDS:
        return Partition((rows,), sentence("many_islands", limit=MAX_ISLANDS))
    if len(own) == 1:
        if soft:
            return Partition((rows,), sentence("islands_all_soft"))
        if most < MAX_BODIES:
            return Partition((rows,), sentence("costly_islands", limit=MAX_BODIES))
        return Partition((rows,), sentence("large_islands", limit=MAX_BODIES))
    return Partition(tuple(sorted(own, key=lambda group: int(group[0]))))


def _may_fly(state: State, schedule: Schedule) -> NDArray[np.bool_]:
    """Return which rows (rows,) may fly in closed form between impacts, which takes next to no time."""
    flies = np.zeros(len(state.entity_index), np.bool_)
    if why_never_exact(state, schedule) is None:
        flies = state.table(Material)["restitution"] > 0.0
        flies[turning_rows(state)] = False
    return flies


def _most_apart(state: State, groups: Sequence[Rows]) -> int:
    """Return up to how many bodies islands are apart that may have rigid contacts: ``MAX_BODIES``, or fewer.

    A step of these takes as long as the cube of their number, up to 20 ms: all islands together are to take
    no longer than one of ``MAX_BODIES``, unless rigid ones are asked for.
    """
    if state.simulation.contacts == "rigid":
        return MAX_BODIES
    shaped, cost, most = state.table(Shape).present, 0, 0
    sizes = Counter(int(np.count_nonzero(shaped[group])) for group in groups)
    for size, count in sorted(sizes.items()):
        cost += count * size**3 if size <= MAX_BODIES else 0
        if cost > MAX_BODIES**3:
            return most
        most = size
    return MAX_BODIES


def _advanced_apart(
    state: State, schedule: Schedule, groups: Sequence[Rows], flies: NDArray[np.bool_], most: int
) -> list[Rows]:  # fmt: skip
    """Return islands, of which those are together that would not be advanced better on their own.

    These are those of more than ``most`` bodies that can touch something, unless each ``flies``. Where none
    is better off alone, those whose steps take longer are together by themselves, unless they are most.
    """
    shaped = state.table(Shape).present
    own, loaded, rest = list[Rows](), list[Rows](), list[Rows]()
    for group in groups:
        touching = np.count_nonzero(shaped[group])
        free = touching < len(group) or flies[group].all()
        if touching <= most or (free and touching <= MAX_BODIES):
            own.append(group)
        else:
            apart = most == 0 and touching <= MAX_BODIES and _take_longer(state, schedule, group)
            (loaded if apart else rest).append(group)
    if sum(map(len, loaded)) >= sum(map(len, rest)):
        loaded, rest = [], loaded + rest
    return own + [np.sort(np.concatenate(several)) for several in (loaded, rest) if several]


def _labels(state: State, schedule: Schedule, rows: Rows) -> Rows:
    """Return a number for each of the bodies, the same for those that are one island."""
    reach = state.bodies.shapes.reach[rows]
    speed = np.hypot(*state.table(Velocity)["linear"][rows].T)
    soon = max(FAR_S, 2.5 * NEAR_STEPS * state.simulation.dt)
    reach = reach + np.maximum(FAR_RADII * reach, speed * soon + 0.25 * _gravity(state) * soon * soon)
    position, labels = state.table(Transform)["position"][rows], np.arange(len(rows))
    shaped = state.table(Shape).present[rows]
    spread = np.ptp(position, axis=0)
    if shaped.all() and np.hypot(*spread) <= 2.0 * reach.min():
        return np.zeros(len(rows), np.int64)
    state.compile((label_clusters,))
    axis = int(np.argmax(spread))
    order = np.argsort(position[:, axis], kind="stable")
    label_clusters(order[shaped[order]], axis, position, reach, labels)
    coupled = labels[_couples(state, schedule, rows)]
    return join(labels, coupled.tolist()) if len(coupled) else labels


def _couples(state: State, schedule: Schedule, rows: Rows) -> Rows:
    """Return which of some bodies forces and joints hold together, as pairs of places among them (n, 2)."""
    place = np.full(len(state.entity_index), -1)
    place[rows] = np.arange(len(rows))
    pairs = [couples for force in schedule.forces if (couples := force.couples(state)) is not None]
    ends: Rows = place[np.concatenate([state.joints.edges, *pairs])]
    return ends[(ends >= 0).all(axis=1)]


def join(labels: Rows, pairs: Iterable[Iterable[int]]) -> Rows:
    """Return labels (n,) in which those of each pair are one."""
    root = dict.fromkeys(labels.tolist())
    parent = {label: label for label in root}

    def find(label: int) -> int:
        while parent[label] != label:
            parent[label] = label = parent[parent[label]]
        return label

    for one, other in pairs:
        low, high = sorted((find(one), find(other)))
        parent[high] = low
    return np.array([find(label) for label in labels.tolist()], np.int64)


def _gravity(state: State) -> float:
    """Return how fast uniform gravity accelerates bodies [m/s^2]."""
    return state.physics.gravity.magnitude if state.physics.gravity_mode == "linear" else 0.0


def meetings(state: State, islands: Sequence[Rows], stored: Sequence[float], h: float) -> tuple[Rows, int]:
    """Return labels, the same for islands that may meet soon, and for how many steps no others will.

    Parameters
    ----------
    state : State
        The whole world.
    islands : sequence of int64 arrays (n,)
        The rows of the bodies of each that can touch others.
    stored : sequence of float
        The energy in springs and fields of each [J].
    h : float
        The length of steps [s].
    """
    rows, inverse_mass = np.concatenate(islands), state.bodies.inverse_mass
    first = np.cumsum([0, *map(len, islands)])
    shaped, velocity = state.table(Shape).present, state.table(Velocity)
    speed = np.hypot(*velocity["linear"][rows].T)
    driven = shaped & velocity.present & (inverse_mass == 0.0)
    pushed = np.hypot(*velocity["linear"][driven].T) + np.abs(velocity["angular"][driven])
    fastest = np.maximum.reduceat(speed, first[:-1]) + 2.0 * float(pushed.max(initial=0.0))
    for n, energy in enumerate(stored):
        if energy > 0.0:
            fastest[n] += math.sqrt(2.0 * energy * float(inverse_mass[islands[n]].max()))
    labels, soon = np.arange(len(islands)), max(NEAR_S, NEAR_STEPS * h)
    state.compile((steps_apart,))
    steps = steps_apart(
        first, state.table(Transform)["position"][rows], state.bodies.shapes.reach[rows],
        speed, fastest, _gravity(state), soon, h, labels,
    )  # fmt: skip
    return labels, steps
