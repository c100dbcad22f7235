"""A step of rigid contacts: from event to event, and by impulses where events accumulate."""

import math
import sys
from typing import NamedTuple

from physicslab.kernels import (
    Numbers,
    Plain,
    Rows,
    Vectors,
    always_inlined,
    inlined,
    inlined_by_numba,
    kernel,
)
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, ENERGY, OVERLAP, PX, PY
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.joints.layout import ROWS
from physicslab.kernels.length import length_of
from physicslab.kernels.records import Impacts
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid import motion
from physicslab.kernels.rigid.equations import UNKNOWN, Equations
from physicslab.kernels.rigid.features import Points, RigidScene, SceneTuple, named_scene
from physicslab.kernels.rigid.impacts import resolve_simultaneous_impacts
from physicslab.kernels.rigid.smooth_segment import Stages
from physicslab.kernels.rigid.time_stepping import drive, kick, move, separate, take_work

STALLED, NOT_FINITE, SQUARES_NOT_FINITE, TOO_FAST, OVERLAPS = range(motion.TOO_MANY + 1, motion.TOO_MANY + 6)
"""Why else a step ends: events follow each other without time; a segment, or squares of speeds are not
finite; short steps are too long for what is fast; bodies overlap too deeply."""
CLOSED, IMPACTS, EVALUATIONS, ENERGETIC, LOWERED, WORK, LOGGED, COUNTED = range(8)
"""Counts of a step: points that are closed at its end, impacts, force evaluations, impacts that obeyed
Stronge's law, restitutions that were lowered, its work, and impacts ever logged."""
_TOLERANCE = 1e-13
"""Error of a smooth segment, as a share of the largest coordinate and speed."""
_WORK_OF_A_SEGMENT = 8
"""Units of work of a segment of motion, beside its force evaluations and half a unit for each pair near."""
_RESTING = 2.0
"""In speeds that a short step gives: what is no faster than that comes to rest."""
REPEATS, _SHORT_REPEATS = 8, 3
"""How often contacts are found again after impacts at one time, and within a short step."""
_MAX_STALLED = 60
"""Largest number of events in a row without time between them."""
_NO_TIME = 1e-13
"""Share of a step that is no time."""
_MAX_SHORT_STEPS = 320
"""Largest number of steps by impulses: fast bodies must not pass through each other."""
_SLOW = 2.0
"""Multiple of what forces add to a speed in a short step up to which an approach is treated as zero."""
_OVERLAP = 1e-3
"""Largest overlap that is moved apart at the start of a step, as a share of a size; soft contacts leave
half."""
_SEPARATE = 1e-11
"""Largest overlap that stays, as a share of a size."""
_NEAR = 4.0
"""Multiple of an overlap within which other gaps are looked at, as bodies that move apart may press into
them."""
_LEAST = sys.float_info.min
"""Size [m] by which rounding can be divided."""
_COORDINATE_ROUNDING = 4e-15
"""Share of the largest coordinate that is rounding."""
_SEPARATIONS = 12
"""How often bodies are moved apart, as that can press them into others."""


class Course(NamedTuple):
    """Everything that a step works on.

    Bodies, two sets of equations, stages; ``changed`` points of the last event; what a segment starts from
    (STARTS, n); a state to measure overlaps from (2, n); points, measures and forces at the end; q and v;
    entities, the log of impacts, the account, counts (COUNTED,).
    """

    scene: RigidScene
    equations: Equations
    room: Equations
    stages: Stages
    changed: Points
    start: Vectors
    before: Vectors
    points: Points
    measures: Vectors
    forces: Numbers
    q: Numbers
    v: Numbers
    entities: Rows
    log: Impacts
    account: Vectors
    counts: Rows


RoomTuple = tuple[
    Plain[Equations], Plain[Equations], Plain[Stages], Points, Vectors, Vectors, Points, Vectors, Numbers,
    Rows,
]  # fmt: skip


@inlined_by_numba
def named_course(
    scene: SceneTuple, room: RoomTuple, q: Numbers, v: Numbers, entities: Rows, log: Impacts, account: Vectors
) -> Course:
    """Give names to tuples."""
    return Course(
        named_scene(scene), Equations(*room[0]), Equations(*room[1]), Stages(*room[2]),
        room[3], room[4], room[5], room[6], room[7], room[8], q, v, entities, log, account, room[9],
    )  # fmt: skip


@kernel
def make_step(
    scene: SceneTuple, room: RoomTuple, q: Numbers, v: Numbers, entities: Rows, log: Impacts,
    account: Vectors, at: float, h: float, longest: float, steady: bool, driven: bool, most_events: int,
    most_work: int,
) -> tuple[int, float, float]:  # fmt: skip
    """Make a step of ``h`` seconds from time ``at`` on, or the part of it that goes by events.

    With a ``longest`` short step [s] above 0 it is made by impulses instead. ``steady`` tells whether forces
    depend on the state of motion alone, ``driven`` whether there are motors with a largest force. Returns why
    it ended (DONE, or why the motion cannot go on), how far that led [s], and the deepest overlap as a share
    of a size where that is why, else the energy that moving bodies apart has added [J].
    """
    of = named_course(scene, room, q, v, entities, log, account)
    of.changed[0, F.PAIR] = -1
    if longest > 0.0:
        return _go_by_impulses(of, at, h, longest, steady, driven)
    for place in range(LOGGED):
        of.counts[place] = 0
    return _go_by_events(of, at, h, steady, most_events, most_work)


@always_inlined
def _go_by_events(
    of: Course, at: float, h: float, steady: bool, most_events: int, most_work: int
) -> tuple[int, float, float]:
    """Go from event to event."""
    done, stalled, foreseen, rows = 0.0, 0, True, 1 + of.scene.joints[ROWS]
    why, added = _move_apart(of, _OVERLAP, False)
    if why != motion.DONE:
        return why, 0.0, added
    for _ in range(most_events):
        why, rest, still = _begin(of, at + done, steady)
        if why != motion.DONE:
            return why, done, added
        closed = of.counts[CLOSED]
        if still:
            _go_on_at_rest(of, h - done)
        if done >= h or still:
            _keep_points(of, of.equations, closed)
            return motion.DONE, h, added
        segment, evaluations, foreseen = motion.advance_segment(
            of.scene, of.equations, closed, of.room, of.stages, of.start, of.changed, of.q, of.v, h - done,
            _TOLERANCE, rest, foreseen,
        )  # fmt: skip
        of.counts[EVALUATIONS] += evaluations
        work = _WORK_OF_A_SEGMENT + len(of.scene.pairs) // 2
        of.counts[WORK] += work + evaluations * (1 + 2 * closed) * rows // 4
        stalled = stalled + 1 if segment <= _NO_TIME * h else 0
        done = h if segment == h - done else done + segment
        if not math.isfinite(segment):
            return NOT_FINITE, done, added
        if stalled > _MAX_STALLED or of.counts[WORK] > most_work:
            break
    return STALLED, done, added


@always_inlined
def _go_by_impulses(
    of: Course, at: float, left: float, longest: float, steady: bool, driven: bool
) -> tuple[int, float, float]:
    """Go on by short steps with impulses, for the ``left`` seconds."""
    h, end, made, total = longest, at + left, 0, 0.0
    of.counts[CLOSED] = 0
    while left > 0.0:
        short = min(longest, _time_to_pass(of))
        if made == 0 or short < h:
            if left > _MAX_SHORT_STEPS * short:
                return TOO_FAST, 0.0, total
            h = left / math.ceil(left / short)
        if left > (_MAX_SHORT_STEPS - made) * h:
            return TOO_FAST, 0.0, total
        made += 1
        last = left <= 1.5 * h
        h = left if last else h
        move(of.q, of.v, 0.5 * h)
        gained = h * kick(of.scene, of.stages.acceleration, of.q, of.v, h)
        if driven:
            drive(of.scene, of.equations, of.stages.acceleration, of.stages.v, of.q, of.v, h, of.account)
        of.counts[EVALUATIONS] += 1
        of.counts[CLOSED] = 0
        why = _resist(of, end - left + 0.5 * h, h, _SLOW * gained)
        if why != motion.DONE:
            return why, 0.0, total
        move(of.q, of.v, 0.5 * h)
        left = 0.0 if last else left - h
        # A body as slow as a short step makes it comes to rest; moved each time, it would not.
        if not last and _largest(of, of.v) <= _RESTING * gained:
            continue
        why, added = _move_apart(of, math.inf, True)
        if why != motion.DONE:
            return why, 0.0, added
        total += added
    for i in range(len(of.forces)):
        of.forces[i] /= h
    # The forces at the end; where there are none, the mean ones of the last impulses.
    why, _, _ = _begin(of, end, steady)
    if why == motion.DONE:
        _keep_points(of, of.equations, of.counts[CLOSED])
    return motion.DONE, left, total


@inlined
def _keep_points(of: Course, equations: Equations, count: int) -> None:
    """Keep the first ``count`` points, their measures and forces."""
    for i in range(count):
        for column in range(F.POINT_FIELDS):
            of.points[i, column] = equations.points[i, column]
        for column in range(F.MEASURES):
            of.measures[i, column] = equations.measures[i, column]
        for k in range(2 * i, 2 * i + 2):
            of.forces[k] = equations.vectors[UNKNOWN, k]


@inlined
def _begin(of: Course, at: float, steady: bool) -> tuple[int, float, bool]:
    """Let what approaches bounce, stop what cannot slide on, and begin a segment of motion.

    Returns why the motion cannot go on (DONE if it can), the tolerance of speeds [m/s], and whether nothing
    moves or accelerates; the number of closed points is counted.
    """
    for _ in range(_MAX_STALLED):
        why, count, _ = meet(of, of.q, 0.0, 0.0, REPEATS, at)
        if why != motion.DONE:
            return why, 0.0, False
        why, closed, rest, still = motion.begin_motion(
            of.scene, of.equations, count, of.stages, of.changed, of.q, of.v, steady
        )
        if why != motion.STOPPED:
            of.counts[CLOSED] = closed
            return why, rest, still
    of.counts[CLOSED] = 0
    return motion.NO_FORCES, 0.0, False


@inlined
def meet(
    of: Course, place: Numbers, tolerance: float, rate: float, repeats: int, time: float
) -> tuple[int, int, int]:
    """Find which points touch at a place, and let those that approach bounce; repeat both.

    An impact can change which faces two boxes turn to each other. Speeds up to ``tolerance`` [m/s] are
    treated as zero; points that would touch in 1 / ``rate`` seconds do. Returns why the motion cannot go on,
    how many points touch, and how many the last impulses act at.
    """
    counts, count, last = of.counts, 0, 0
    for _ in range(repeats):
        why, count, rest, _, approaching = motion.touch(
            of.scene, of.equations, of.room, of.stages.acceleration, place, of.v, 0.0
        )
        if why != motion.DONE or not approaching:
            return why, count, last
        new, solved, energetic, lowered, last, rounds = resolve_simultaneous_impacts(
            of.scene, of.equations, count, of.room, of.q, of.v, of.stages.v, of.stages.acceleration,
            max(rest, tolerance), rate, of.entities, of.log, counts[LOGGED], time, of.account,
        )  # fmt: skip
        counts[LOGGED] += new
        counts[IMPACTS] += new
        counts[ENERGETIC] += energetic
        counts[LOWERED] += lowered
        counts[WORK] += rounds * (500 + count * count * count * count) // 500 // 4
        if not solved:
            return motion.UNRESOLVED, count, last
    return motion.DONE, count, last


@inlined
def _resist(of: Course, time: float, h: float, tolerance: float) -> int:
    """Find the impulses in the middle of a short step of ``h`` seconds; return why that failed.

    They act at all points that would touch by its end, or bounce. Speeds up to ``tolerance`` [m/s]
    are treated as zero.
    """
    soon = of.stages.q
    for _ in range(_SHORT_REPEATS):
        for i in range(len(of.q)):
            soon[i] = of.q[i]
        move(soon, of.v, h)
        why, _, points = meet(of, soon, tolerance, 2.0 / h, 1, time)
        if why != motion.DONE or points == 0:
            return why
        of.counts[CLOSED] = points
        _keep_points(of, of.room, points)
    return motion.DONE


@always_inlined
def _go_on_at_rest(of: Course, span: float) -> None:
    """Book what holds bodies at rest, and what pulls at them, for ``span`` seconds: they do no work."""
    first = 3 * of.scene.rows + 1
    for i in range(first, len(of.v)):
        if (i - first) % ACCOUNTS >= PX:
            of.v[i] += span * of.stages.acceleration[i]


@inlined
def _largest(of: Course, values: Numbers) -> float:
    """Return the largest magnitude of coordinates or speeds (n,) of all rows."""
    largest = 0.0
    for i in range(3 * of.scene.rows):
        largest = max(largest, abs(values[i]))
    return largest


@inlined
def _smallest_size(scene: RigidScene) -> float:
    """Return the smallest size of what may touch [m]."""
    smallest = math.inf
    for p in range(len(scene.pairs)):
        smallest = min(smallest, scene.coefficients[p, 2])
    return smallest


@always_inlined
def _time_to_pass(of: Course) -> float:
    """Return how long a short step may be in which nothing passes a quarter of the smallest size [s].

    A step changes the velocity, and moves by what it is then.
    """
    v, rows, fastest = of.v, of.scene.rows, 0.0
    for row in range(rows):
        spin = abs(v[2 * rows + row]) * of.scene.shapes.reach[row]
        fastest = max(fastest, length_of(v[2 * row], v[2 * row + 1]) + spin)
    push = kick(of.scene, of.stages.acceleration, of.q, of.v, 0.0)
    way = 0.25 * _smallest_size(of.scene)
    total = fastest + math.sqrt(fastest * fastest + 4.0 * push * way)
    return 2.0 * way / total if total > 0.0 else math.inf


@inlined
def _move_apart(of: Course, allowed: float, pay: bool) -> tuple[int, float]:
    """Move bodies apart that overlap; return why that is not possible, DONE if it is, and a number.

    An overlap beyond the share ``allowed`` of a size is left, and refused: it is that number. Else that is
    the energy that this has added, less what the bodies ``pay`` for it with their speeds [J].
    """
    deepest, moved = 0.0, False
    smallest = max(_smallest_size(of.scene), _LEAST)
    rounding = _COORDINATE_ROUNDING * _largest(of, of.q) / smallest
    for _ in range(_SEPARATIONS):
        why, count, rest, deepest, _ = motion.touch(
            of.scene, of.equations, of.room, of.stages.acceleration, of.q, of.v, _NEAR * deepest
        )
        if why != motion.DONE:
            return why, 0.0
        if not math.isfinite(rest):  # every speed would be treated as zero
            return SQUARES_NOT_FINITE, 0.0
        if deepest <= max(_SEPARATE, rounding):
            return motion.DONE, _book_overlap(of, count, pay) if moved else 0.0
        if not moved:
            moved = True
            for i in range(len(of.q)):
                of.before[0, i], of.before[1, i] = of.q[i], of.v[i]
        if deepest > allowed or not separate(of.scene, of.equations, count, of.q, of.v):
            break
    return OVERLAPS, deepest


@inlined
def _book_overlap(of: Course, count: int, pay: bool) -> float:
    """Book that bodies were moved apart, or let them pay; return the energy that it added [J]."""
    place, speed, book = of.before[0], of.before[1], of.account[OVERLAP]
    added, change = take_work(of.scene, of.equations, count, of.stages, place, of.q, of.v, pay)
    book[ENERGY] += change
    px, py, spin = _momenta(of.scene, of.q, of.v)
    px_before, py_before, spin_before = _momenta(of.scene, place, speed)
    book[PX] += px - px_before
    book[PY] += py - py_before
    book[ANGULAR_MOMENTUM] += spin - spin_before
    return added


@inlined
def _momenta(scene: RigidScene, q: Numbers, v: Numbers) -> tuple[float, float, float]:
    """Return momentum (x, y) and angular momentum about the origin of what forces move."""
    px, py, orbit, spin = 0.0, 0.0, 0.0, 0.0
    for row in range(scene.rows):
        inverse_mass, inverse_inertia = scene.inverse_mass[2 * row], scene.inverse_mass[2 * scene.rows + row]
        if inverse_mass > 0.0:
            x, y = v[2 * row] / inverse_mass, v[2 * row + 1] / inverse_mass
            px += x
            py += y
            orbit += q[2 * row] * y - q[2 * row + 1] * x
        if inverse_inertia > 0.0:
            spin += v[2 * scene.rows + row] / inverse_inertia
    return px, py, orbit + spin
