"""Event-driven motion: bodies that move freely, and bounce at the exact time at which they meet.

Between impacts every body moves under a constant acceleration. The next impact is that of the pair that meets
first; at equal times, of the one whose last impact is longest ago, or of the first in order. Its impulse is
that of all impacts here; afterwards only the pairs of its two bodies are predicted again. Impacts at one time
are resolved one after the other until no pair approaches: a row of touching discs passes an impulse on. Where
two pairs with one body meet at one time the order would decide: the motion ends there for others to resolve.
"""

import math
from typing import NamedTuple

from physicslab.kernels import Plain, Rows, Vectors, always_inlined, inlined, kernel
from physicslab.kernels.accounts import IMPACTS
from physicslab.kernels.arguments import Bounds, Inverse, Materials, Motion, Sampled, take_sample
from physicslab.kernels.clock import next_time
from physicslab.kernels.constraint.pair import PairInverseMass, frame_of, inverse_mass_of
from physicslab.kernels.events.encounter import bend_of, gap_of, meeting_of, time_apart, touch_pair
from physicslab.kernels.events.path import advance_to, begin, place, seen_from
from physicslab.kernels.events.path_impact import path_velocity, resolve_ballistic_impacts
from physicslab.kernels.geometry.contact import effective_masses, mix
from physicslab.kernels.geometry.shapes import Shapes, ShapesTuple, named_shapes
from physicslab.kernels.ode.compensated import add
from physicslab.kernels.python_fallback import endless
from physicslab.kernels.records import Impacts, Manifolds, Points
from physicslab.kernels.solver.impact_log import ImpactPoints, Pose, book_impact, pair_of, write_impact

FIXED, BALLISTIC, KINEMATIC = range(3)
"""Modes of a row: fixed; moving freely; moving and not deflected."""
DONE, CAME_TO_REST, OVERLAP, TOO_MANY_IMPACTS, TOGETHER = range(5)
"""Why the motion ended: the time was over; a body came to rest; bodies overlap deeply; there were too many
impacts within one step; a body meets two others at once."""
REST = 1e-5
"""Share of a step: a bounce against a pressing force is rest if the force causes its speed in that time."""
DEEP = 0.01
"""Share of the smaller body's size beyond which an overlap is not resolved by impacts."""
_SHORT = 1e-6
"""Share of a step too short to be handed over: a body that comes to rest in it flies on to the end."""
_MAX_IMPACTS = 1_000_000
"""Largest number of impacts within one step."""
_MIN_SPEED_RATIO = 1e-17
"""Share of the fastest speed that is treated as zero: bodies that stay together keep about as much."""
_SAME_TIME = 1e-12
"""Share of a step within which impacts of one pair count as simultaneous."""
_AHEAD = 64.0
"""Steps for which pairs are at most taken as apart before they are looked at again."""
_NEARER = 1e-11
"""Share of the farthest place within that time by which pairs are taken as nearer than they seem apart."""
_BEHIND = 1.0 - 1e-9
"""The least cosine of the angle between what pushes a body and what is behind it."""
_MAX_REPEATS = 32
"""Largest number of bounces of an inelastic pair within that time; then it stays together."""


class Flight(NamedTuple):
    """State of ballistic motion: the pairs, the bodies, and when each pair meets.

    Records and points of the pairs, and how many there are; paths, modes and motions of the bodies; of each
    pair the face, the first step in which it may meet, and when it meets in this one; then shapes, masses and
    bounds, and the account that impacts and gravity add to.
    """

    manifolds: Manifolds
    points: Points
    pairs: int
    paths: Vectors
    mode: Rows
    motion: Motion
    face: Rows
    apart: Rows
    due: Vectors
    shapes: Shapes
    inverse: Inverse
    bounds: Bounds
    account: Vectors


@inlined
def _first(due: Vectors, count: int) -> int:
    """Return the pair that meets first, at equal times that with the oldest last impact; -1 if none."""
    best, time, low, last_impact = -1, math.inf, 0.0, 0.0
    for p in range(count):
        if due[p, 0] > time or due[p, 0] == math.inf:
            continue
        earlier = due[p, 0] < time or due[p, 1] < low
        if earlier or (due[p, 1] == low and due[p, 4] < last_impact):
            best, time, low, last_impact = p, due[p, 0], due[p, 1], due[p, 4]
    return best


@always_inlined
def _begin_all(flight: Flight, step: int, span: float, left: int) -> tuple[int, float, float]:
    """Begin all paths of a step, of which ``left`` are to come.

    Returns OVERLAP if bodies overlap too deeply, else DONE; the tolerance of speeds [m/s]; and the
    distance that rounding may make until pairs that are apart are looked at again [m].
    """
    paths, mode, due, (position, angle, linear, _) = flight.paths, flight.mode, flight.due, flight.motion
    why, fastest, farthest, shapes, time = DONE, 0.0, 0.0, flight.shapes, min(float(left), _AHEAD) * span
    for i in range(len(mode)):
        begin(paths, i, position[i, 0], position[i, 1], linear[i, 0], linear[i, 1])
        speed = abs(linear[i, 0]) + abs(linear[i, 1])
        fastest = max(fastest, speed)
        way = time * (speed + time * (abs(paths[i, 8]) + abs(paths[i, 9])))
        size = shapes.radius[i] + 2.0 * (shapes.half_x[i] + shapes.half_y[i])
        farthest = max(farthest, abs(position[i, 0]) + abs(position[i, 1]) + size + way)
    rounding = _NEARER * farthest
    for p in range(flight.pairs):
        if flight.apart[p] > step:
            continue
        manifold = flight.manifolds[p]
        a, b = manifold.a, manifold.b
        due[p, 0], due[p, 1], due[p, 2], due[p, 3], due[p, 4] = math.inf, 0.0, -math.inf, 0.0, -1.0
        if mode[a] != BALLISTIC and mode[b] != BALLISTIC:
            flight.apart[p] = step + left
            continue
        flight.apart[p] = _first_step(flight, p, step, 0.0, span, left, rounding)
        if flight.apart[p] > step:
            continue
        gap, size = gap_of(manifold, paths, angle, flight.shapes, flight.bounds.walls)
        if gap < -DEEP * size:
            why = OVERLAP
    return why, _MIN_SPEED_RATIO * fastest, rounding


@always_inlined
def _first_step(
    flight: Flight, p: int, step: int, now: float, span: float, left: int, rounding: float
) -> int:
    """Return the first of the ``left`` steps from ``step`` on in which a pair may meet, seen from ``now``."""
    steps = min(float(left), _AHEAD)
    time = now + time_apart(
        flight.manifolds[p], flight.paths, flight.motion.angle, flight.shapes, flight.bounds.walls, now,
        rounding,
    )  # fmt: skip
    return step + int(min(time / span, steps))


@inlined
def _inverse_mass(flight: Flight, p: int, row: int, within: float, now: float) -> float:
    """Return the inverse mass of a body of pair p: none if it rests on what is fixed behind it.

    Else what is heavy, and pushes it there, would lose the share of a light mass at each of its impacts.
    """
    mode, due, mine = flight.mode, flight.due, flight.manifolds[p]
    for k in range(flight.pairs):
        if k == p or due[k, 3] <= _MAX_REPEATS or now - due[k, 2] > within:
            continue
        a, b = flight.manifolds[k].a, flight.manifolds[k].b
        if (a == row and mode[b] == FIXED) or (b == row and mode[a] == FIXED):
            other = flight.manifolds[k]
            along = mine.normal_x * other.normal_x + mine.normal_y * other.normal_y
            if (along if (a == row) != (mine.a == row) else -along) > _BEHIND:
                return 0.0
    return float(flight.inverse.mass[row])


@inlined
def _bounce(
    flight: Flight, p: int, log: Impacts, number: int, time: float, approach: float,
    mass: PairInverseMass[float],
) -> None:  # fmt: skip
    """Resolve an impact of a pair whose paths begin now, and book it; write it, if they do ``approach``."""
    manifold, point = flight.manifolds[p], flight.points[2 * p]
    paths, angle, angular = flight.paths, flight.motion.angle, flight.motion.angular
    a, b = manifold.a, manifold.b
    before = path_velocity(paths, angular, a, b)
    impulses, law = resolve_ballistic_impacts(manifold, frame_of(manifold, point), paths, angular, mass)
    points = ImpactPoints(frame_of(manifold, point), frame_of(manifold, point), impulses)
    after = path_velocity(paths, angular, a, b)
    pose = Pose(paths[a, 0], paths[a, 2], angle[a], paths[b, 0], paths[b, 2], angle[b])
    book_impact(flight.account, points, pose, before, after, mass, IMPACTS)
    if approach > 0.0:
        write_impact(
            log, number, pair_of(manifold), time, approach, points, pose, before, after, mass, law, True
        )


@inlined
def _meets_two(flight: Flight, p: int, within: float) -> bool:
    """Whether a body of pair p that moves freely meets another one at the same time."""
    mode, due, mine = flight.mode, flight.due, flight.manifolds[p]
    for k in range(flight.pairs):
        if k == p or not due[k, 0] - due[p, 0] <= within:
            continue
        a, b = flight.manifolds[k].a, flight.manifolds[k].b
        for i in (mine.a, mine.b):
            if mode[i] == BALLISTIC and i in (a, b):
                return True
    return False


@always_inlined
def _meet(
    flight: Flight, p: int, materials: Materials, log: Impacts, number: int, start: float, now: float,
    low: float, span: float,
) -> tuple[int, int]:  # fmt: skip
    """Resolve a meeting; return why the motion ends, DONE if it goes on, and how many impacts it was.

    A bounce that a pressing force ends soon is left, and one at the same time as another of the same body.
    """
    manifold, point = flight.manifolds[p], flight.points[2 * p]
    paths, mode, due, angle, angular = (
        flight.paths, flight.mode, flight.due, flight.motion.angle, flight.motion.angular,
    )  # fmt: skip
    a, b = manifold.a, manifold.b
    mix(manifold, materials, flight.bounds)
    seen = seen_from(paths, a, b, now, low)
    x, _, y, _ = place(paths, b, now, low)
    touch_pair(manifold, point, flight.face[p], x, y, seen, angle, flight.shapes, flight.bounds.walls)
    effective_masses(manifold, flight.points, p, flight.inverse)
    nx, ny = manifold.normal_x, manifold.normal_y
    approach = -(seen.ux * nx + seen.uy * ny)
    pull, sliding = seen.wx * nx + seen.wy * ny, nx * seen.uy - ny * seen.ux
    pull += bend_of(manifold, flight.face[p], flight.shapes) * sliding * sliding
    if pull < 0.0 and manifold.restitution * approach <= -pull * REST * span:
        manifold.count = 0
        return CAME_TO_REST, 0
    if _meets_two(flight, p, _SAME_TIME * span):
        manifold.count = 0
        return TOGETHER, 0
    if mode[a] != FIXED:
        advance_to(paths, a, angle, angular, now, low, flight.account)
    if mode[b] != FIXED:
        advance_to(paths, b, angle, angular, now, low, flight.account)
    due[p, 3] = due[p, 3] + 1.0 if now - due[p, 2] <= _SAME_TIME * span else 0.0
    due[p, 2], due[p, 4] = now, float(number)
    e, mass = manifold.restitution, inverse_mass_of(flight.inverse, a, b)
    if e < 1.0 and due[p, 3] > _MAX_REPEATS:
        manifold.restitution = 0.0
        mass_a = _inverse_mass(flight, p, a, _SAME_TIME * span, now)
        mass = PairInverseMass(
            mass_a, mass.inertia_a, _inverse_mass(flight, p, b, _SAME_TIME * span, now), mass.inertia_b
        )
    _bounce(flight, p, log, number, start + (now + low), approach, mass)
    manifold.restitution, manifold.count, manifold.found = e, 0, 0
    return DONE, 1 if approach > 0.0 else 0


@always_inlined
def _end_all(flight: Flight, now: float, low: float) -> None:
    """Move all bodies to where they are at the time ``now + low``."""
    paths, (position, angle, linear, angular) = flight.paths, flight.motion
    for i in range(len(flight.mode)):
        if flight.mode[i] != FIXED:
            advance_to(paths, i, angle, angular, now, low, flight.account)
            position[i, 0], position[i, 1] = paths[i, 0], paths[i, 2]
            linear[i, 0], linear[i, 1] = paths[i, 4], paths[i, 6]


@kernel
def run_events(
    manifolds: Manifolds, points: Points, count: int, paths: Vectors, mode: Rows, face: Rows, apart: Rows,
    due: Vectors, motion: Plain[Motion], shapes: ShapesTuple,
    materials: Plain[Materials], inverse: Plain[Inverse], bounds: Plain[Bounds],
    account: Vectors, log: Impacts, logged: int, start: float, span: float, steps: int,
    sampled: Plain[Sampled],
) -> tuple[int, int, int, int, float]:  # fmt: skip
    """Move bodies from impact to impact for ``steps`` times ``span`` s, or until one rests or meets two.

    All paths begin again after ``span`` seconds, so that steps made at once have the bits of single ones.

    Parameters
    ----------
    manifolds, points, count : records (pairs,), (2 pairs,), int
        The pairs that may meet.
    paths : float64 array (rows, 13)
        For each row the remainders of its place and velocity, which are carried on, the acceleration [m/s^2]
        in columns 8 and 9, and in column 12 the mass [kg] that gravity pulls.
    mode : int64 array (rows,)
        The mode of each row.
    face, apart, due : int64 arrays (pairs,), float64 array (pairs, 5)
        Room.
    motion, shapes, materials, inverse, bounds : tuples of arrays
        As :mod:`physicslab.kernels.arguments` has them.
    account : float64 array (CAUSES, 4)
        To which the work and the momentum of impacts and gravity are added.
    log, logged : impact records (n,), int
        Impacts are logged from number ``logged`` on, with times from ``start`` [s].
    sampled : tuple
        The samples that are due.

    Returns
    -------
    made, impacts, latest, why, flown
        How many whole steps were made, how many impacts there were, and how many in the last of them; why it
        ended, and how far into the next step [s] all bodies are where it did.
    """
    now, low, impacts, earlier, made, why = 0.0, 0.0, 0, 0, 0, DONE
    flight = Flight(
        manifolds, points, count, paths, mode, Motion(*motion), face, apart, due,
        named_shapes(shapes), Inverse(*inverse), Bounds(*bounds), account,
    )  # fmt: skip
    mixed, samples = Materials(*materials), Sampled(*sampled)
    apart[:count] = 0
    while made < steps:
        earlier = impacts
        why, min_speed, rounding = _begin_all(flight, made, span, steps - made)
        if why == OVERLAP:
            return made, impacts, 0, why, 0.0
        now, low, within, first, second = 0.0, 0.0, 0, -1, -1
        while why == DONE:
            _predict_pairs(flight, first, second, now, low, span, min_speed, made, steps - made, rounding)
            p = _first(due, count)
            if p < 0 or due[p, 0] >= span:
                now, low = span, 0.0
                break
            now, low = due[p, 0], due[p, 1]
            within += 1
            if within > _MAX_IMPACTS:
                why = TOO_MANY_IMPACTS
                break
            first, second = manifolds[p].a, manifolds[p].b
            why, new = _meet(flight, p, mixed, log, logged + impacts, start, now, low, span)
            impacts += new
        if why == CAME_TO_REST and span - now <= _SHORT * span:
            why, now, low = DONE, span, 0.0
        _end_all(flight, now, low)
        if why != DONE:
            return made, impacts, 0, why, now
        made, start = made + 1, next_time(start, span)
        take_sample(flight.motion, samples, made)
    return made, impacts, impacts - earlier, why, 0.0


@endless
@always_inlined
def _predict_pairs(
    flight: Flight, first: int, second: int, now: float, low: float, span: float, min_speed: float,
    step: int, left: int, rounding: float,
) -> None:  # fmt: skip
    """Predict when the pairs of two rows meet next in this step; of all rows, if ``first`` is -1."""
    mode, due = flight.mode, flight.due
    for p in range(flight.pairs):
        if first < 0 and flight.apart[p] > step:
            continue
        manifold = flight.manifolds[p]
        a, b = manifold.a, manifold.b
        # Impacts on fixed and kinematic bodies do not change the meetings of their other pairs.
        affected = (mode[a] == BALLISTIC and a in (first, second)) or (
            mode[b] == BALLISTIC and b in (first, second)
        )
        if first >= 0 and not affected:
            continue
        if mode[a] != BALLISTIC and mode[b] != BALLISTIC:
            due[p, 0] = math.inf
            continue
        if flight.apart[p] > step:
            flight.apart[p] = _first_step(flight, p, step, now, span, left, rounding)
            if flight.apart[p] > step:
                continue
        t, flight.face[p] = meeting_of(
            manifold, flight.paths, flight.motion.angle, flight.shapes, flight.bounds.walls, now, low,
            span - now, min_speed,
        )  # fmt: skip
        if t < math.inf:
            due[p, 0], due[p, 1] = add(now, low, t)
        else:
            due[p, 0], due[p, 1] = math.inf, 0.0
