"""Bodies that fly, and bounce at the very time at which they meet.

Between impacts every body moves under a constant acceleration. The next impact is that of the pair that meets
first; at equal times, of the one that was struck longest ago, or of the first in order. Its impulse is that
of every other impact here, and only the pairs of the two bodies that were struck are asked again when they
meet. So hits at one time are taken one after the other until none approaches: a row of touching discs hands a
blow on.
"""

import math

from physicslab.kernels import Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.events.encounter import gap_of, meeting_of, touch_pair
from physicslab.kernels.events.flight import advance_to, begin, place, seen_from
from physicslab.kernels.events.flight_impact import resolve_ballistic_impacts
from physicslab.kernels.narrow.contact import effective_masses, mix
from physicslab.kernels.ode.compensated import add
from physicslab.kernels.records import Impacts, Manifold, Manifolds, Point, Points
from physicslab.kernels.solver.impact_log import write_impact
from physicslab.kernels.twins import endless

__all__ = [
    "BALLISTIC", "CAME_TO_REST", "DEEP", "DONE", "FIXED", "IN_CONTACT", "KINEMATIC", "OVERLAP", "REST",
    "TOO_MANY_IMPACTS", "WOKEN", "run_events",
]  # fmt: skip

FIXED, BALLISTIC, IN_CONTACT, KINEMATIC = 0, 1, 2, 3
"""What a row does: stays, flies, rests on others (and is not moved here), moves whatever strikes it."""
DONE, CAME_TO_REST, WOKEN, OVERLAP, TOO_MANY_IMPACTS = 0, 1, 2, 3, 4
"""Why the flights ended: the time was over; a body came to rest; one that rested was struck; bodies overlap
deeply; there were too many impacts within one step."""
REST = 1e-3
"""A bounce against a pressing force is rest where its speed is no more than what the force brings about in
this share of a step."""
DEEP = 0.01
"""Share of the smaller body's size beyond which an overlap is no matter of impacts."""
_MOST = 1_000_000
"""How many impacts there may be within one step."""
_QUIET = 1e-17
"""Share of the fastest speed that is no motion at all: what stays together has that much left."""
_SAME = 1e-12
"""Share of a step within which impacts of one pair count as one blow that goes to and fro."""
_REPEATS = 32
"""How often a pair that is not elastic may bounce within that time before it stays together."""


@inlined
def _rests(manifold: Manifold, mode: Rows, approach: float, pull: float, slowest: float) -> int:
    """Say what a meeting is: DONE for a bounce, else why the flights end; mark who rests or is woken."""
    a, b = manifold.a, manifold.b
    limit = -pull * slowest
    if mode[a] == IN_CONTACT or mode[b] == IN_CONTACT:
        kind = CAME_TO_REST if pull < 0.0 and approach <= limit else WOKEN
        if kind == CAME_TO_REST:
            _mark_in_contact(mode, a, b)
        else:
            mode[a] = BALLISTIC if mode[a] == IN_CONTACT else mode[a]
            mode[b] = BALLISTIC if mode[b] == IN_CONTACT else mode[b]
        return kind
    if not (pull < 0.0 and manifold.restitution * approach <= limit):
        return DONE
    _mark_in_contact(mode, a, b)
    return CAME_TO_REST


@inlined
def _mark_in_contact(mode: Rows, a: int, b: int) -> None:
    """Let those of two rows that fly rest."""
    for i in (a, b):
        if mode[i] == BALLISTIC:
            mode[i] = IN_CONTACT


@inlined
def _first(due: Vectors, count: int) -> int:
    """Return the pair that meets first, at equal times the one struck longest ago; -1 if none meets."""
    best, time, low, impact_count = -1, math.inf, 0.0, 0.0
    for p in range(count):
        if due[p, 0] > time or due[p, 0] == math.inf:
            continue
        earlier = due[p, 0] < time or due[p, 1] < low
        if earlier or (due[p, 1] == low and due[p, 4] < impact_count):
            best, time, low, impact_count = p, due[p, 0], due[p, 1], due[p, 4]
    return best


@inlined
def _begin_all(
    manifolds: Manifolds, count: int, paths: Vectors, mode: Rows, due: Vectors,
    position: Vectors, angle: Numbers, linear: Vectors, kind: Rows, radius: Numbers,
    width: Numbers, height: Numbers, restitution: Numbers, friction: Numbers,
    bounds: Numbers, bounds_restitution: float, bounds_friction: float,
) -> tuple[int, float]:  # fmt: skip
    """Let all flights begin; return OVERLAP if some overlap too deeply to fly, and which speed is none."""
    why, fastest = DONE, 0.0
    for i in range(len(mode)):
        begin(paths, i, position[i, 0], position[i, 1], linear[i, 0], linear[i, 1])
        fastest = max(fastest, abs(linear[i, 0]) + abs(linear[i, 1]))
    for p in range(count):
        manifold = manifolds[p]
        a, b = manifold.a, manifold.b
        due[p, 0], due[p, 1], due[p, 2], due[p, 3], due[p, 4] = math.inf, 0.0, -math.inf, 0.0, -1.0
        mix(manifold, a, b, restitution, friction, bounds_restitution, bounds_friction)
        if mode[a] == BALLISTIC or mode[b] == BALLISTIC:
            gap, size = gap_of(manifold, paths, angle, kind, radius, width, height, bounds)
            if gap < -DEEP * size:
                why = OVERLAP
                _mark_in_contact(mode, a, b)
    return why, _QUIET * fastest


@inlined
def _meet(
    p: int, manifold: Manifold, one: Point, two: Point, points: Points, paths: Vectors, mode: Rows,
    face: Rows, due: Vectors, struck_at: Vectors, angle: Numbers, angular: Numbers, kind: Rows,
    radius: Numbers, width: Numbers, height: Numbers, inverse_mass: Numbers, inverse_inertia: Numbers,
    bounds: Numbers, log: Impacts, number: int, start: float, now: float, low: float, dt: float,
) -> tuple[int, int]:  # fmt: skip
    """Do what comes of a meeting; return why flights end, DONE if they go on, and how many impacts it was."""
    a, b = manifold.a, manifold.b
    dx, dy, ux, uy, wx, wy = seen_from(paths, a, b, now, low)
    x, _, y, _ = place(paths, b, now, low)
    touch_pair(manifold, one, two, face[p], x, y, dx, dy, angle, kind, radius, width, height, bounds)
    effective_masses(manifold, points, p, inverse_mass, inverse_inertia)
    nx, ny = manifold.normal_x, manifold.normal_y
    approach = -(ux * nx + uy * ny)
    was_resting = mode[a] == IN_CONTACT or mode[b] == IN_CONTACT
    why = _rests(manifold, mode, approach, wx * nx + wy * ny, REST * dt)
    if was_resting:
        manifold.count = 0
        return why, 0
    if mode[a] != FIXED:
        advance_to(paths, a, angle, angular, now, low)
    if mode[b] != FIXED:
        advance_to(paths, b, angle, angular, now, low)
    due[p, 3] = due[p, 3] + 1.0 if now - due[p, 2] <= _SAME * dt else 0.0
    due[p, 2], due[p, 4] = now, float(number)
    e = manifold.restitution
    if why == CAME_TO_REST or (e < 1.0 and due[p, 3] > _REPEATS):
        manifold.restitution = 0.0
    normal, tangent = one.impact_normal + two.impact_normal, one.impact_tangent + two.impact_tangent
    resolve_ballistic_impacts(manifold, one, two, paths, angular, inverse_mass, inverse_inertia)
    manifold.restitution, manifold.count, manifold.found = e, 0, 0
    struck_at[p, 0], struck_at[p, 1] = x, y
    if approach <= 0.0:
        return why, 0
    write_impact(log, number, manifold, one, two, one, start + (now + low), x, y, approach, normal, tangent)
    return why, 1


@kernel
def run_events(
    manifolds: Manifolds, points: Points, count: int, paths: Vectors, mode: Rows, face: Rows, due: Vectors,
    struck_at: Vectors, position: Vectors, angle: Numbers, linear: Vectors, angular: Numbers,
    kind: Rows, radius: Numbers, width: Numbers, height: Numbers, restitution: Numbers, friction: Numbers,
    inverse_mass: Numbers, inverse_inertia: Numbers,
    bounds: Numbers, bounds_restitution: float, bounds_friction: float,
    log: Impacts, logged: int, start: float, span: float, dt: float, urgent: int,
) -> tuple[float, int, int, int]:  # fmt: skip
    """Let bodies fly and bounce for ``span`` seconds, or until one comes to rest or is woken.

    ``paths`` (rows, 12) holds the accelerations [m/s^2] in columns 8 and 9, ``mode`` what each row does;
    ``face`` (pairs,) and ``due`` (pairs, 5) are work space; ``struck_at`` (pairs, 2) is told where B was at
    the pair's last impact [m]. Impacts are logged from number ``logged`` on, with times from ``start`` [s]; a
    step has ``dt`` seconds. ``urgent`` is a pair that meets now, before all others, or -1.

    Returns
    -------
    elapsed, impacts, why, pair
        The time flown [s]; how many impacts there were; why it ended, and with which pair.
    """
    now, low, impacts, window, within, p = 0.0, 0.0, 0, 0.0, 0, -1
    why, quiet = _begin_all(
        manifolds, count, paths, mode, due, position, angle, linear, kind, radius, width, height,
        restitution, friction, bounds, bounds_restitution, bounds_friction,
    )  # fmt: skip
    if why == OVERLAP:
        return 0.0, 0, why, p
    first, second = -1, -1
    while why == DONE:
        _predict_pair(
            manifolds, count, first, second, paths, mode, face, due, angle, kind, radius, width, height,
            bounds, now, low, span - now, quiet,
        )  # fmt: skip
        p = _first(due, count)
        if urgent >= 0:
            p, due[urgent, 0], due[urgent, 1], urgent = urgent, 0.0, 0.0, -1
        if p < 0 or due[p, 0] >= span:
            now, low = span, 0.0
            break
        now, low = due[p, 0], due[p, 1]
        within = within + 1 if now < window + dt else 1
        window = window if now < window + dt else now
        if within > _MOST:
            why = TOO_MANY_IMPACTS
            break
        first, second = manifolds[p].a, manifolds[p].b
        why, new = _meet(
            p, manifolds[p], points[2 * p], points[2 * p + 1], points, paths, mode, face, due, struck_at,
            angle, angular, kind, radius, width, height, inverse_mass, inverse_inertia, bounds,
            log, logged + impacts, start, now, low, dt,
        )  # fmt: skip
        impacts += new
    for i in range(len(mode)):
        if mode[i] != FIXED:
            advance_to(paths, i, angle, angular, now, low)
            position[i, 0], position[i, 1] = paths[i, 0], paths[i, 2]
            linear[i, 0], linear[i, 1] = paths[i, 4], paths[i, 6]
    return now + low, impacts, why, p


@endless
@inlined
def _predict_pair(
    manifolds: Manifolds, count: int, first: int, second: int, paths: Vectors, mode: Rows, face: Rows,
    due: Vectors, angle: Numbers, kind: Rows, radius: Numbers, width: Numbers, height: Numbers,
    bounds: Numbers, now: float, low: float, span: float, quiet: float,
) -> None:  # fmt: skip
    """Find when the pairs of two rows meet next; of all rows, if ``first`` is -1."""
    for p in range(count):
        manifold = manifolds[p]
        a, b = manifold.a, manifold.b
        # What stays, or moves whatever strikes it, may be struck often: that changes nothing for the others.
        impact_count = (mode[a] == BALLISTIC and a in (first, second)) or (
            mode[b] == BALLISTIC and b in (first, second)
        )
        if first >= 0 and not impact_count:
            continue
        if mode[a] != BALLISTIC and mode[b] != BALLISTIC:
            due[p, 0] = math.inf
            continue
        t, face[p] = meeting_of(
            manifold, paths, angle, kind, radius, width, height, bounds, now, low, span, quiet
        )
        if t < math.inf:
            due[p, 0], due[p, 1] = add(now, low, t)
        else:
            due[p, 0], due[p, 1] = math.inf, 0.0
