"""Motion of few rigid bodies that touch: smooth segments between located events.

While no contact opens, closes, begins to slide or stops, bodies are a constrained system: contact forces
follow from the equations of motion, and any Runge-Kutta method integrates it. An event ends such a segment;
it is located to rounding, and what happens then - an impact, another set of forces - begins the next
(Pfeiffer & Glocker, Multibody Dynamics with Unilateral Contacts, 1996). Nothing is remembered between
steps.
"""

import math

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels.forces.force_calls import accelerate
from physicslab.kernels.joints.layout import ROWS
from physicslab.kernels.ode.dop853_tableau import LAST
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid import smooth_segment, touching
from physicslab.kernels.rigid.budget import book_speeds
from physicslab.kernels.rigid.complementarity import NOT_FOUND, SETTLED, solve_complementarity
from physicslab.kernels.rigid.constraints import apply, find_loads, measure_all, project
from physicslab.kernels.rigid.equations import FREE, OPEN, SLIDES_BACK, SLIDES_ON, STICKS, UNKNOWN, Equations
from physicslab.kernels.rigid.features import GIVEN, MU, PAIR, STATUS, VN, VT, Points, RigidScene
from physicslab.kernels.rigid.impacts import approaches
from physicslab.kernels.rigid.joined import book_forces
from physicslab.kernels.rigid.least_norm import solve_equations
from physicslab.kernels.rigid.passing import longest_segment, share_of_ways
from physicslab.kernels.rigid.segment_end import (
    ALLOWED,
    FASTEST,
    HOLDS,
    PRESSES,
    SLIDES,
    locate_event,
    note_start,
)
from physicslab.kernels.rigid.smooth_segment import Stages

DONE, STOPPED, NO_FORCES, UNRESOLVED, TOO_MANY = range(5)
"""Why the motion cannot go on: it can; sliding was stopped by impulses, so that all has to be found again; no
contact forces keep all laws; an impact has no solution; more points touch than there is room for."""
_SAME_MOMENT = 1e-9
"""Share of its load within which a point that sticks reaches the limit of friction with another one."""
_BALANCED, _FITTED = 1e-11, 1e-8
"""Share of the loads of a body that forces which hold it may leave: of equations, and of pivots."""
_NO_TIME = 0.01
"""Largest speed that forces give in the moment of the impulses, as a share of that treated as zero."""
_SHORTENINGS = 60
"""How often a segment is shortened for its error."""
_SHORTEST = 1e-9
"""Share of the time that is left below which a segment is not shortened."""
_BEYOND = 1.1
"""Multiple of the time to the first event, by how all begins, that a segment is to last."""
_SHORT = 0.1
"""Share of the longest segment below which a method of order 5 is tried; its curve shows if it is exact."""


@inlined
def _note_changes(
    kind: int, index: int, equations: Equations, count: int, changed: Points, rest: float
) -> None:
    """Note what points do from now on, where the laws alone would leave that to rounding.

    Several can reach the same limit in one moment, as the corners of a box do that begins to slide; and what
    has just begun to slide goes on. A motor that has reached its speed keeps it, if it can.
    """
    n, forces = 0, equations.vectors
    limit = _SAME_MOMENT * abs(forces[UNKNOWN, 2 * index]) if kind <= HOLDS else 0.0
    for i in range(count if kind <= SLIDES else 0):
        if kind == SLIDES and not (i == index and equations.points[i, F.FEATURE] == F.MOTOR):
            continue
        pressing, rubbing = forces[UNKNOWN, 2 * i], forces[UNKNOWN, 2 * i + 1]
        left = equations.measures[i, F.MU] * pressing - abs(rubbing)
        status, now = -1, equations.points[i, F.STATUS]
        if kind == SLIDES:
            status = STICKS
        elif kind == PRESSES and i == index:
            status = OPEN
        elif kind == HOLDS and (i == index or (now == STICKS and left <= limit)):
            status = SLIDES_ON if rubbing < 0.0 else SLIDES_BACK
        elif now > STICKS and abs(equations.measures[i, F.VT]) <= touching.SLOW * rest:
            status = now
        if status >= 0:
            for column in range(F.GIVEN):
                changed[n, column] = equations.points[i, column]
            changed[n, F.STATUS] = status
            n += 1
    if n < len(changed):
        changed[n, F.PAIR] = -1


@inlined
def _is_slow(scene: RigidScene, v: Numbers, rest: float) -> bool:
    """Whether nothing moves."""
    slow = True
    for i in range(3 * scene.rows):
        way = scene.shapes.reach[i - 2 * scene.rows] if i >= 2 * scene.rows else 1.0
        slow = slow and way * abs(v[i]) <= (touching.SLOW * rest if scene.inverse_mass[i] > 0.0 else 0.0)
    return slow


@inlined
def _is_balanced(
    scene: RigidScene, equations: Equations, closed: int, share: float, acceleration: Numbers, least: float,
    loads: Numbers,
) -> bool:  # fmt: skip
    """Whether the forces found leave no acceleration, but for a ``share`` of what each alone would cause.

    Forces that cancel leave their rounding, which is much for what is light between heavy bodies. ``loads``
    is room.
    """
    for i in range(3 * scene.rows):
        loads[i] = abs(acceleration[i])
    find_loads(scene, equations, closed, loads)
    apply(scene, equations, closed, acceleration)
    for i in range(3 * scene.rows):
        way = scene.shapes.reach[i - 2 * scene.rows] if i >= 2 * scene.rows else 1.0
        if scene.inverse_mass[i] == 0.0:
            continue
        if not way * abs(acceleration[i]) <= 10.0 * least + share * way * loads[i]:  # nor if it is NaN
            return False
    return True


@inlined
def touch(
    of: RigidScene, equations: Equations, room: Equations, acceleration: Numbers, place: Numbers, v: Numbers,
    within: float,
) -> tuple[int, int, float, float, bool]:  # fmt: skip
    """Find which points touch at ``place``, or are ``within`` a share of a size.

    Returns why the motion cannot go on (DONE if it can), how many points touch, the tolerance of speeds
    [m/s], the deepest overlap as a share of a size, and whether any point approaches there.
    """
    accelerate(place, v, acceleration, of.inverse_mass, of.damping, of.calls)
    rest, least = touching.rest_limits(of, acceleration, v)
    count, deepest = touching.find_touching(of, equations, room, place, v, within, least / touching.NO_PUSH)
    if count > len(equations.points):
        return TOO_MANY, 0, rest, deepest, False
    return DONE, count, rest, deepest, _any_approaches(of, equations, count, place, v, rest)


@inlined
def _any_approaches(
    scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers, rest: float
) -> bool:
    """Whether any point approaches faster than rounding."""
    measure_all(scene, equations, count, q, v)
    approaching = False
    for i in range(count):
        approaching = approaching or approaches(equations.measures[i, F.VN], rest)
    return approaching


@always_inlined
def _make_smooth(
    scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers, h: float, left: float,
    tolerance: float, stages: Stages, start: Vectors,
) -> tuple[float, int]:  # fmt: skip
    """Make a segment of ``h`` seconds, or less where its error or its ways demand it.

    Returns how long it is, and how many trials there were.
    """
    for trial in range(_SHORTENINGS):
        error = smooth_segment.make_segment(scene, equations, count, q, v, h, tolerance, stages)
        share = 1.0
        if error <= 1.0:
            share = share_of_ways(scene, v, h, False, stages, start[ALLOWED], start[FASTEST])
        if max(error, share) <= 1.0 or h <= _SHORTEST * left:
            return h, trial + 1
        h *= max(0.1, 0.9 * (math.pow(error, -0.125) if error > 1.0 else 1.0 / share))
    return h, _SHORTENINGS


@always_inlined
def advance_segment(
    of: RigidScene, points: Equations, count: int, scratch: Equations, at: Stages, start: Vectors,
    changed: Points, q: Numbers, v: Numbers, left: float, tolerance: float, rest: float, foreseen: bool,
) -> tuple[float, int, bool]:  # fmt: skip
    """Advance from where :func:`begin_motion` left it to the next event, for ``left`` seconds at most.

    Where that is to be ``foreseen``, for little more than the time at which the next gap should close: the
    curve of a short segment is exact. Returns the time that passed [s], how many force evaluations the
    segment took, its beginning included, and whether there was an event.
    """
    soonest = note_start(of, points, count, scratch, q, v, at.acceleration, start)
    evaluations, kind, index = 4, -1, -1
    limit = longest_segment(of, q, v, at.acceleration, start[ALLOWED])
    h = min(limit, left, _BEYOND * soonest if foreseen else left)
    short = h < _SHORT * limit
    for _ in range(2):
        if short:
            smooth_segment.make_stages(of, points, count, q, v, h, True, at)
            evaluations += smooth_segment.SHORT_LAST
            short = share_of_ways(of, v, h, True, at, start[ALLOWED], start[FASTEST]) <= 1.0
        if not short:
            h, segments = _make_smooth(of, points, count, q, v, h, left, tolerance, at, start)
            evaluations += segments * LAST
        passed, kind, index, more = locate_event(
            of, points, count, scratch, start, at, q, v, h, tolerance, rest, short
        )
        evaluations += more * LAST
        if passed >= 0.0:
            break
        short = False
    _note_changes(kind, index, points, count if kind >= 0 else 0, changed, rest)
    for i in range(len(q)):
        q[i], v[i] = at.q[i], at.v[i]
    return passed, evaluations, kind >= 0


@inlined
def begin_motion(
    of: RigidScene, points: Equations, count: int, at: Stages, changed: Points, q: Numbers, v: Numbers,
    steady: bool,
) -> tuple[int, int, float, bool]:  # fmt: skip
    """Find what each of ``count`` points that touch does, and with what force; begin a segment of motion.

    ``changed`` has the points that ended the segment before; ``steady`` whether forces depend on the state of
    motion alone. Returns why the motion cannot go on (DONE if it can), the number of closed points, the
    tolerance of speeds [m/s], and whether nothing moves or accelerates.
    """
    accelerate(q, v, at.acceleration, of.inverse_mass, of.damping, of.calls)
    rest, least = touching.rest_limits(of, at.acceleration, v)
    count = touching.take_closed(of, points, count, changed, q, v, rest)
    slow, held = steady and _is_slow(of, v, rest), False
    if slow and of.joints[ROWS] == 0:  # joints hold bodies of the masses that they have
        found = touching.hold_evenly(of, points, count, changed, at.acceleration, rest, least, at.v, at.q)
        share = _BALANCED if found == SETTLED else _FITTED
        held = found != NOT_FOUND and _is_balanced(of, points, count, share, at.acceleration, least, at.q)
    if not held:
        count, solved = touching.hold_closed(of, points, count, changed, q, v, at.acceleration, rest, least)
        if not solved:
            stopped = stop_sliding(of, points, count, changed, q, v, rest)
            return STOPPED if stopped else NO_FORCES, 0, rest, False
        # A light body on top of a heavy one is held to more digits by its own mass.
        held = slow and _is_balanced(of, points, count, _BALANCED, at.acceleration, least, at.q)
    closed = touching.keep_pressing(points, count, least)
    if held:
        book_speeds(of, q, v, -1.0)
        for i in range(3 * of.rows):
            v[i] = 0.0
        book_forces(of, points, closed, q, v, at.acceleration)
        return DONE, closed, rest, True
    if closed > 0:
        project(of, points, closed, q, v)
    smooth_segment.begin_segment(of, points, closed, q, v, at)
    return DONE, closed, rest, False


@always_inlined
def stop_sliding(
    scene: RigidScene, equations: Equations, count: int, changed: Points, q: Numbers, v: Numbers, rest: float
) -> bool:
    """Let impulses act at ``count`` closed points whose free rates are known; return whether any slides less.

    No contact forces go on with the sliding, though nothing approaches: points that slide have their friction
    given, and what they press may then press them the more (Painleve's paradox; piles that come to rest have
    it often). Impulses keep all laws: those of a short step in the limit of no time (a tangential impact, or
    an impact without collision; Genot & Brogliato, Eur. J. Mech. A/Solids 18 (1999) 653). In that limit no
    body moves, so nothing overlaps.

    The state of each point is found with the speeds that forces would give in a moment, the impulses without
    these. The points of ``changed`` are forgotten.
    """
    points, measures, vectors, largest = equations.points, equations.measures, equations.vectors, 0.0
    for i in range(2 * count):
        largest = max(largest, abs(vectors[FREE, i]))
    moment = _NO_TIME * rest / largest if largest > 0.0 else 0.0
    for i in range(count):
        points[i, GIVEN] = STICKS if measures[i, MU] > 0.0 else SLIDES_ON
        vectors[FREE, 2 * i] = measures[i, VN] + moment * vectors[FREE, 2 * i]
        vectors[FREE, 2 * i + 1] = measures[i, VT] + moment * vectors[FREE, 2 * i + 1]
    found = solve_complementarity(equations, count, 0.0, True)
    if found == NOT_FOUND:
        return False
    for i in range(count):
        vectors[FREE, 2 * i], vectors[FREE, 2 * i + 1] = measures[i, VN], measures[i, VT]
    if found == SETTLED:
        solve_equations(equations, count, 1.0)
    apply(scene, equations, count, v)
    measure_all(scene, equations, count, q, v)
    stopped: bool = changed[0, PAIR] >= 0
    changed[0, PAIR] = -1
    for i in range(count):
        before, after = vectors[FREE, 2 * i + 1], measures[i, VT]
        back = after if before < 0.0 else -after
        stopped = stopped or (abs(before) > touching.SLOW * rest and back >= -touching.SLOW * rest)
        # Impulses act along the mean of the speeds before and after.
        points[i, STATUS], measures[i, VT] = SLIDES_ON, 0.5 * (before + after)
    book_forces(scene, equations, count, q, v, v)
    return stopped
