"""The hand that takes hold of a body, moves it, and lets it go or throws it."""

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Mass, Shape, Transform, Velocity
from physicslab.contacts.outlines import Outlines, overlap
from physicslab.contacts.report import contact_between
from physicslab.ecs.component import Component
from physicslab.ecs.config import WindowConfig
from physicslab.ecs.vector import Vector2
from physicslab.history import AddComponent, Command, RemoveComponent, SetField
from physicslab.state.joint_closing import is_joined, joined_rows, posed_places
from physicslab.view.window.placing import free_way, outlines_of, way_within
from physicslab.world import World

_ALONG, _MAX_BEHIND = 0.3, 24
"""A body is behind another where the way to it points at least so much along; so many are looked at."""
_WEIGHTS, _EARTH = 20.0, 9.81
"""The hand is as strong as so many times the weight of what it holds, and what is joined to that, on the
Earth [m/s^2]."""
_PRESSED, _COMING_OUT = 0.04, 0.3
"""Share of its size by which a body that is pushed may be overlapped; deeper, and where it cannot be pushed,
so much of the overlap is given back in a frame."""
_MARGIN = 0.01
"""Share of its size up to which it comes near at any speed."""
_PASSES = 4
"""How often the limits of several neighbours are gone through."""
_POSED = 1e-7
"""How far joints must let a body move, or turn, for it to be moved in a pause [m or rad]."""
_PULLED = 0.3
"""Share of the way to the hand that what joints hold is pulled in a step, lest what it carries swings."""
_BRAKING = 0.35
"""Share of its strength with which the hand can bring what joints hold to rest where it is."""
_THROWN = 0.5
"""Speed [m/s] from which a body that is let go counts as thrown."""
_MIN_THROW_TIME = 0.03
"""Time [s] over which a speed can be measured at all; a shorter pull is no throw."""

type Numbers = NDArray[np.float64]
"""A float64 array, of bodies (n,), or places (n, 2) [m]."""


@dataclass(frozen=True, slots=True)
class _Sample:
    time: float
    place: Vector2


def _yielding(world: World, entity: int, wanted: Vector2, coming: float) -> Vector2:
    """Return the velocity [m/s] at which the hand takes along what it holds.

    A body in the hand is infinitely heavy, and would press others through a floor. Towards each it goes no
    faster than it comes there in the time that is coming, and gives it in that time the velocity that the
    hand's strength gives to it and to what lies behind it: none to a box on a floor that is pressed down.
    If contacts push back harder than the hand is strong all the same, it comes out again.
    """
    if not world.has(entity, Shape):
        return wanted
    world.synchronise()
    rows, strength = world.batch(Transform, Shape).rows, _strength(world, entity)
    shapes, own = outlines_of(world, rows), int(np.flatnonzero(rows == world.entity_index.row_of[entity])[0])
    sizes, reaches, handles = shapes.size, shapes.reach, world.entity_index.entities
    linear, inverse = world.table(Velocity)["linear"][rows], world.bodies.inverse_mass[rows]
    moves = world.table(Velocity).present[rows]
    moves[own] = False
    limits: list[tuple[Vector2, float]] = []
    for n in _around(shapes.place, reaches, own, wanted.magnitude * coming):
        if not moves[n]:
            continue
        deep, direction = overlap(shapes, own, shapes, n)
        into = Vector2(*direction.tolist())
        speed, push = Vector2(*linear[n].tolist()).dot(into), strength * coming * float(inverse[n])
        size = float(min(sizes[own], sizes[n]))
        touches = deep > -_MARGIN * size
        if deep > _PRESSED * size or (touches and _force(world, entity, handles[rows[n]]) > strength):
            push = 0.0
        elif push > 0.0:
            reach = (max(speed, 0.0) + push) * coming
            push = strength * coming / _load(world, shapes, reaches, inverse, (own, n), into, reach)
        if deep > 0.0:
            apart = -_COMING_OUT * deep if push == 0.0 else 0.0
        else:
            apart = max(-deep - _MARGIN * size, -_COMING_OUT * deep)  # never onto it at full speed
        limits.append((into, apart / coming + speed + push))
    velocity = wanted
    for _ in range(_PASSES if len(limits) > 1 else 1):
        for into, fastest in limits:
            velocity = velocity - into * max(velocity.dot(into) - fastest, 0.0)
    return velocity


def _around(places: Numbers, reaches: Numbers, n: int, margin: float) -> list[int]:
    """Return which others are near a shape: their boxes along the axes of the world, within a margin [m]."""
    near = np.abs(places - places[n]) < reaches + reaches[n] + margin
    found: list[int] = np.flatnonzero(near.all(axis=1)).tolist()
    found.remove(n)
    return found


def _load(
    world: World, shapes: Outlines, reaches: Numbers, inverse: Numbers, pair: tuple[int, int], into: Vector2,
    reach: float,
) -> float:  # fmt: skip
    """Return the mass [kg] of the second of a pair and of all that it meets where it is pushed so far [m].

    It is infinite where that cannot move. ``reaches`` (n, 2) [m] and ``inverse`` masses (n,) [1/kg] are those
    of the shapes.
    """
    total, seen, waiting = 0.0, {pair[0]}, [pair[1]]
    bounds = world.physics.bounds
    while waiting:
        n = waiting.pop()
        if n in seen:
            continue
        seen.add(n)
        if inverse[n] == 0.0 or len(seen) > _MAX_BEHIND:
            return math.inf
        total += 1.0 / float(inverse[n])
        if bounds is not None:
            low, high = shapes.place[n] - reaches[n], shapes.place[n] + reaches[n]
            rooms = low[0] - bounds[0], low[1] - bounds[1], bounds[2] - high[0], bounds[3] - high[1]
            for room, along in zip(rooms, (-into.x, -into.y, into.x, into.y), strict=True):
                if room < reach and along > _ALONG:
                    return math.inf
        for k in _around(shapes.place, reaches, n, reach):
            if k not in seen:
                deep, direction = overlap(shapes, n, shapes, k)
                if deep > -reach and direction @ (into.x, into.y) > _ALONG:
                    waiting.append(k)
    return total


def _force(world: World, entity: int, other: Any) -> float:
    """Return how hard two bodies press against each other [N]."""
    contact = contact_between(world, entity, int(other))
    return sum(point.normal_force for point in contact.points) if contact is not None else 0.0


def _strength(world: World, entity: int) -> float:
    """Return how hard the hand can press with a body [N]."""
    return _WEIGHTS * _EARTH * world.component(entity, Mass).mass if world.has(entity, Mass) else math.inf


class Hand:
    """Holds one body at a time by the point where it was taken.

    A held body carries :class:`Held`: contacts and forces find it infinitely heavy, and it goes where the
    hand goes. Its velocity is set so that it arrives there in the time that is about to be simulated; so what
    it hits on the way is pushed, not jumped over. One that joints hold keeps its mass, and is pulled.

    Parameters
    ----------
    config : WindowConfig
        How far back the hand's path counts for a throw, and how fast a throw may be.

    Attributes
    ----------
    entity : int, optional
        The body that is held.
    throws : int
        How many were thrown.
    write : callable
        Carries out a command of the hand.
    """

    def __init__(self, config: WindowConfig) -> None:
        self._config = config
        self.write: Callable[[World, Command], object] = lambda world, command: command.carry_out(world)
        self.entity: int | None = None
        self.throws = 0
        self._before = (Vector2(), 0.0)
        self._was_moved_by_time = False
        self._loose_at: Vector2 | None = None
        self._path: deque[_Sample] = deque()

    def take(
        self, world: World, entity: int, place: Vector2, now: float, *, paused: bool = False
    ) -> bool:  # fmt: skip
        """Take hold of a body at a point of the world [m]; return whether it can be held: walls cannot.

        ``now`` is any clock [s] that runs with the hand, not with the simulation. While time stands still
        the body is held once the hand moves: a click is no edit.
        """
        self.drop(world)
        if not (world.has(entity, Transform) and world.has(entity, Velocity)):
            return False
        self._was_moved_by_time = False
        self.entity, self._loose_at = entity, place
        self._path = deque([_Sample(now, place)])
        if not paused:
            self._grip(world, entity, place)
        return True

    def _grip(self, world: World, entity: int, place: Vector2) -> None:
        """Hold a body by a point of the world [m]."""
        transform, velocity = world.component(entity, Transform), world.component(entity, Velocity)
        grip = (place - transform.position).rotated(-transform.angle)
        self._before, self._loose_at = (velocity.linear, velocity.angular), None
        world.synchronise()
        yields = world.has(entity, Mass) and is_joined(world, world.entity_index.row_of[entity])
        if not yields:
            self._set(world, entity, Velocity, "linear", Vector2())
            self._set(world, entity, Velocity, "angular", 0.0)
        self.write(world, AddComponent(entity, Held(grip, yields=yields)))
        world.edited()

    def loosen(self, world: World) -> None:
        """Let go for an edit; the body is taken again when the hand moves on, or time does.

        So what the hand did ends before the edit and what it does later begins after it: undo takes back
        the edit alone, and where the edit has put the body it stays.
        """
        if self.entity is not None and world.has(self.entity, Held):
            self._put_back_velocity(world, self.entity)
            self._loose_at = self._path[-1].place
            self.write(world, RemoveComponent(self.entity, Held.__name__))
            world.edited()

    def _take_again(self, world: World, paused: bool) -> None:
        """Take what was clicked, or let go for an edit, by the point where the hand was then."""
        entity, place = self.entity, self._loose_at
        if entity is None or place is None:
            return
        if not (world.has(entity, Transform) and world.has(entity, Velocity)):
            self.entity = None
        elif not paused or self._path[-1].place != place:
            self._grip(world, entity, place)

    def move(self, place: Vector2, now: float) -> None:
        """Note where the hand is [m]."""
        if self.entity is None:
            return
        self._path.append(_Sample(now, place))
        while len(self._path) > 1 and self._path[0].time < now - self._config.throw_window - 1e-9:
            self._path.popleft()

    def lead(self, world: World, coming: float, paused: bool) -> None:
        """Make the body follow; one that yields is pulled before each step (:meth:`pull`).

        Parameters
        ----------
        coming : float
            Time [s] that will be simulated before the next call.
        paused : bool
            Whether time stands still: the body is then put where the hand is.
        """
        self._take_again(world, paused)
        if self.entity is None or self._loose_at is not None:
            return
        if not world.has(self.entity, Held) or not world.has(self.entity, Transform):
            self.entity = None  # it was removed, or taken out of the hand
            return
        transform = world.component(self.entity, Transform)
        grip = world.component(self.entity, Held).grip.rotated(transform.angle)
        gap = self._path[-1].place - transform.position - grip
        yields = world.component(self.entity, Held).yields
        if coming > 0.0 and yields:
            return
        if coming > 0.0:
            gap = _yielding(world, self.entity, gap / coming, coming) * coming
        gap = free_way(world, self.entity, way_within(world, self.entity, gap))
        if not yields:
            self._set(world, self.entity, Velocity, "angular", 0.0)
        if coming > 0.0:
            self._set(world, self.entity, Velocity, "linear", gap / coming)
            self._was_moved_by_time = True
        elif paused:
            if not yields:
                self._set(world, self.entity, Velocity, "linear", Vector2())
            if gap:
                self._pose(world, self.entity, gap)

    def pull(self, world: World, coming: float) -> None:
        """Pull at a body in the hand that joints hold, for a step of ``coming`` seconds.

        So it follows as well where a frame takes long, and has many steps.

        The force would give the point, if it were free, a velocity towards the hand in place of the one that
        it has, from which it can stop on its way. What pulls and what brakes are each no greater than the
        hand is strong: out of reach of the hand, too, a body comes to rest. Joints, walls and floors hold as
        if it were in no hand.
        """
        entity = self.entity
        if entity is None or not world.has(entity, Held) or not world.component(entity, Held).yields:
            return
        world.synchronise()
        row, velocity = world.entity_index.row_of[entity], world.component(entity, Velocity)
        transform = world.component(entity, Transform)
        arm = world.component(entity, Held).grip.rotated(transform.angle)
        gap = self._path[-1].place - transform.position - arm
        inverse, turning = float(world.bodies.inverse_mass[row]), float(world.bodies.inverse_inertia[row])
        across, carried = arm.perpendicular, world.table(Mass)["mass"][joined_rows(world, row)].sum()
        strength = _WEIGHTS * _EARTH * float(carried)
        fastest = math.sqrt(2.0 * _BRAKING * _WEIGHTS * _EARTH * gap.magnitude)
        wanted = _limited(gap * (_PULLED / coming), min(fastest, self._config.max_throw_speed))
        moves, pull = velocity.linear + across * velocity.angular, Vector2()
        for change in (wanted, -moves):
            # Across the arm it takes less than m: (1/m + r r/I) J = change.
            lighter = across.dot(change) * turning / (inverse + turning * arm.dot(arm))
            pull += _limited((change - across * lighter) / (inverse * coming), strength)
        self._set(world, entity, Held, "pull", pull)
        self._was_moved_by_time = True

    def _pose(self, world: World, entity: int, way: Vector2) -> None:
        """Move a body by a way [m] while time stands still, and what joints hold together with it."""
        world.synchronise()
        transform, row = world.table(Transform), world.entity_index.row_of[entity]
        arm = world.component(entity, Held).grip.rotated(world.component(entity, Transform).angle)
        places = posed_places(world, row, (arm.x, arm.y), (way.x, way.y))
        if places is None:
            self._set(world, entity, Transform, "position", world.component(entity, Transform).position + way)
            world.edited()
            return
        gone = np.abs(places[0] - transform["position"]).max(axis=1)
        turned = np.abs(places[1] - transform["angle"])
        for n in np.flatnonzero(np.maximum(gone, turned) > _POSED).tolist():
            moved = int(world.entity_index.entities[n])
            self._set(world, moved, Transform, "position", Vector2(*places[0][n].tolist()))
            self._set(world, moved, Transform, "angle", float(places[1][n]))
            world.edited()

    def release(self, world: World, place: Vector2, now: float, paused: bool) -> None:
        """Let go at a point of the world [m]: the body keeps the velocity that the hand had of late.

        While time stands still nothing is thrown; a body that was only put elsewhere goes on as before.
        """
        self.move(place, now)
        if not paused:
            self._take_again(world, paused)
        if self.entity is not None and world.has(self.entity, Held):
            if paused:
                self._put_back_velocity(world, self.entity)
            elif world.component(self.entity, Held).yields:  # it has the velocity that joints let it have
                self.throws += world.component(self.entity, Velocity).linear.magnitude > _THROWN
            else:
                thrown = self._throw()
                self.throws += thrown.magnitude > _THROWN
                self._set(world, self.entity, Velocity, "linear", thrown)
                self._set(world, self.entity, Velocity, "angular", 0.0)
        self._let_go(world)

    def _put_back_velocity(self, world: World, entity: int) -> None:
        """Give a body the velocity with which it was taken; none where time ran meanwhile.

        One that yields keeps what time gave it.
        """
        if self._was_moved_by_time and world.component(entity, Held).yields:
            return
        linear, angular = (Vector2(), 0.0) if self._was_moved_by_time else self._before
        self._set(world, entity, Velocity, "linear", linear)
        self._set(world, entity, Velocity, "angular", angular)

    def drop(self, world: World) -> None:
        """Let go without a throw, as when the window is left: the body starts from rest."""
        if self.entity is not None and world.has(self.entity, Held):
            self._set(world, self.entity, Velocity, "linear", Vector2())
        self._let_go(world)

    def _let_go(self, world: World) -> None:
        if self.entity is not None and world.has(self.entity, Held):
            self.write(world, RemoveComponent(self.entity, Held.__name__))
            world.edited()
        self.entity, self._loose_at = None, None

    def _set(self, world: World, entity: int, kind: type[Component], name: str, value: Any) -> None:
        """Give a field another value; one that it has already is not written again."""
        if getattr(world.component(entity, kind), name) != value:
            self.write(world, SetField(entity, kind.__name__, name, value))

    @property
    def target(self) -> Vector2 | None:
        """Where the hand is that holds a body [m]."""
        return None if self.entity is None or not self._path else self._path[-1].place

    def throw(self, now: float) -> Vector2:
        """Return the velocity [m/s] of what is held if it were let go at a time of the window."""
        if self.target is None:
            return Vector2()
        path = self._path.copy()
        self.move(self._path[-1].place, now)
        thrown, self._path = self._throw(), path
        return thrown

    def _throw(self) -> Vector2:
        """Return the mean velocity [m/s] over the last of the hand's path, no faster than allowed."""
        first, last = self._path[0], self._path[-1]
        span = last.time - first.time
        if span < _MIN_THROW_TIME:
            return Vector2()
        return _limited((last.place - first.place) / span, self._config.max_throw_speed)


def _limited(vector: Vector2, most: float) -> Vector2:
    """Return a vector, no longer than so much."""
    return vector if vector.magnitude <= most else vector.normalized * most
