"""Which points touch, and what each of them does: opens, sticks or slides."""

import math

from physicslab.kernels import Numbers, always_inlined, inlined
from physicslab.kernels.forces.force_calls import accelerate
from physicslab.kernels.geometry.shapes import is_chain
from physicslab.kernels.joints.layout import ROWS
from physicslab.kernels.length import length_of
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.budget import book_speeds
from physicslab.kernels.rigid.chain_points import distance_to_chain, is_closed_on_chain
from physicslab.kernels.rigid.complementarity import (
    FITTING,
    SETTLED,
    settle_at_an_edge,
    solve_complementarity,
)
from physicslab.kernels.rigid.constraints import apply, assemble, find_free_rates, measure_all
from physicslab.kernels.rigid.detect import find_points, seen_from
from physicslab.kernels.rigid.equations import FREE, OPEN, SLIDES_BACK, SLIDES_ON, STICKS, UNKNOWN, Equations
from physicslab.kernels.rigid.features import Points, RigidScene, measure_contact
from physicslab.kernels.rigid.joined import strongest_joint
from physicslab.kernels.rigid.joint_points import OWN, UNIT, gap_of_row, measure
from physicslab.kernels.rigid.least_norm import solve_equations

TOUCH = 1e-10
"""Share of the smaller size within which a gap is closed: bodies are moved by that little."""
_REST = 1e-6
"""Tolerance of speeds, in shares of the speed of a fall over the smallest size."""
SLOW = 1e-3
"""Share of that speed below which a point does not slide: what is slower comes to rest before it should."""
NO_PUSH = 1e-12
"""Share of the largest acceleration that is rounding."""
NO_SPEED = 1e-8
"""Share of that speed that is rounding."""


@inlined
def _from_core(scene: RigidScene, row: int, other: int, q: Numbers) -> float:
    """Return how far the centre of a body is from the box about another one's core [m], 0 inside."""
    x, y = seen_from(q, scene.rows, row, q[2 * other], q[2 * other + 1])
    over_x = max(abs(x) - scene.shapes.half_x[row], 0.0)
    over_y = max(abs(y) - scene.shapes.half_y[row], 0.0)
    return length_of(over_x, over_y)


@inlined
def far_apart(scene: RigidScene, p: int, q: Numbers, enough: float) -> float:
    """Return a distance that the shapes of a pair have at least [m]; negative where they may touch.

    One above ``enough`` is not the best that can be found.
    """
    a, b, wall = scene.pairs[p, 0], scene.pairs[p, 1], scene.pairs[p, 2]
    shapes = scene.shapes
    reach = shapes.reach[b]
    if wall >= 0:
        place = q[2 * b] if wall == 0 or wall == 2 else q[2 * b + 1]
        to_wall: float = (place - scene.walls[wall] if wall < 2 else scene.walls[wall] - place) - reach
        return to_wall
    if is_chain(shapes, a):
        return distance_to_chain(scene, a, b, q, enough)
    if is_chain(shapes, b):
        return distance_to_chain(scene, b, a, q, enough)
    dx, dy = q[2 * b] - q[2 * a], q[2 * b + 1] - q[2 * a + 1]
    apart: float = math.sqrt(dx * dx + dy * dy) - reach - shapes.reach[a]
    for side in range(2):
        row, other = (a, b) if side == 0 else (b, a)
        if apart <= enough and shapes.vertices[row] > 1:
            apart = max(apart, _from_core(scene, row, other, q) - shapes.radius[row] - shapes.reach[other])
    return apart


@inlined
def _is_same(points: Points, i: int, others: Points, k: int) -> bool:
    """Whether two points are of one pair and the same features."""
    same = True
    for column in range(F.GIVEN):
        same = same and points[i, column] == others[k, column]
    return same


@inlined
def _has_vertex(points: Points, i: int, row: int, k: int) -> bool:
    """Whether point i is one of vertex k of a row."""
    other: bool = points[i, F.OTHER] == row and points[i, F.VERTEX] == k
    one: bool = points[i, F.ONE] == row and points[i, F.FEATURE] == F.CORNER + k
    return other or one


@inlined
def _is_closed(radius: Numbers, points: Points, count: int, others: Points, k: int) -> bool:
    """Whether point k of ``others`` is among ``count`` closed points.

    A vertex touches a rounded body at one point: where that comes to the end of its feature is an event.
    """
    for i in range(count):
        if points[i, F.PAIR] != others[k, F.PAIR]:
            continue
        if _is_same(points, i, others, k):
            return True
        one, other, feature = others[k, F.ONE], others[k, F.OTHER], others[k, F.FEATURE]
        if radius[one] + radius[other] > 0.0:
            if _has_vertex(points, i, other, others[k, F.VERTEX]):
                return True
            if F.CORNER <= feature < F.WALL and _has_vertex(points, i, one, feature - F.CORNER):
                return True
    return False


@inlined
def _find_open_row(
    scene: RigidScene, equations: Equations, count: int, scratch: Equations, p: int, q: Numbers, v: Numbers
) -> tuple[int, float, float]:
    """Do the same as :func:`find_open` for a row of a joint, which a motor always keeps closed."""
    gap: float = scene.coefficients[p, 2]
    closed = scene.pairs[p, 2] == F.MOTOR - F.WALL
    for i in range(count):
        closed = closed or equations.points[i, F.PAIR] == p
    if closed:
        return 0, gap, -math.inf
    find_points(scene, p, q, v, scratch.points)
    measure(scene, scratch.points, 0, q, v, scratch.measures)
    gap = min(gap, scratch.measures[0, F.GAP])
    return 1, gap, gap


@inlined
def find_open(
    scene: RigidScene, equations: Equations, count: int, scratch: Equations, p: int, q: Numbers, v: Numbers
) -> tuple[int, float, float]:
    """Find and measure the points of a pair that are not closed, unless it is more than a size apart.

    Returns how many there are, their smallest gap [m], at most the size, and a distance that the pair has at
    least [m], minus infinity where a point is closed.
    """
    gap: float = scene.coefficients[p, 2]
    if scene.pairs[p, 2] >= F.FIRST_ROW:
        return _find_open_row(scene, equations, count, scratch, p, q, v)
    apart = far_apart(scene, p, q, gap)
    if apart > gap:
        return 0, gap, apart
    n, shapes, wall = 0, scene.shapes, scene.pairs[p, 2]
    chained = wall < 0 and (is_chain(shapes, scene.pairs[p, 0]) or is_chain(shapes, scene.pairs[p, 1]))
    found, apart = find_points(scene, p, q, v, scratch.points)
    for k in range(found):
        if chained:
            closed = is_closed_on_chain(shapes, equations.points, count, scratch.points, k)
        else:
            closed = _is_closed(shapes.radius, equations.points, count, scratch.points, k)
        if closed:
            apart = -math.inf
        else:
            for column in range(F.GIVEN):
                scratch.points[n, column] = scratch.points[k, column]
            measure_contact(scene, scratch.points, n, q, v, scratch.measures)
            gap = min(gap, scratch.measures[n, F.GAP])
            n += 1
    return n, gap, min(apart, gap)


@inlined
def moved_closer(scene: RigidScene, p: int, q: Numbers, later: Numbers) -> float:
    """Return by how much the distance of a pair can have changed from one state to a later one [m].

    That of a limit changes by more than bodies move: it is not estimated.
    """
    rows, a, b = scene.rows, scene.pairs[p, 0], scene.pairs[p, 1]
    if scene.pairs[p, 2] >= F.FIRST_ROW:
        return math.inf
    x, y = later[2 * b] - q[2 * b], later[2 * b + 1] - q[2 * b + 1]
    turned = abs(later[2 * rows + b] - q[2 * rows + b]) * scene.shapes.reach[b]
    if scene.pairs[p, 2] < 0:
        x, y = x - (later[2 * a] - q[2 * a]), y - (later[2 * a + 1] - q[2 * a + 1])
        turned += abs(later[2 * rows + a] - q[2 * rows + a]) * scene.shapes.reach[a]
    moved: float = length_of(x, y) + turned
    return moved


@inlined
def _find_unit(scene: RigidScene, scratch: Equations, i: int, most: float, strongest: float) -> float:
    """Find what a force at a motor causes, and a unit of force of the size of those there are [N]."""
    own, rows, p = 0.0, scene.rows, scratch.points[i, F.PAIR]
    for side in range(2):
        body, t = scratch.points[i, F.ONE + side], F.TANGENT + 3 * side
        for k in range(3):
            place = 2 * body + k if k < 2 else 2 * rows + body
            own += scene.inverse_mass[place] * scratch.measures[i, t + k] * scratch.measures[i, t + k]
    unit: float = strongest / own if strongest > 0.0 else most
    scene.coefficients[p, OWN], scene.coefficients[p, UNIT] = own, unit
    return unit


@inlined
def find_touching(
    scene: RigidScene, equations: Equations, scratch: Equations, q: Numbers, v: Numbers, within: float,
    strongest: float,
) -> tuple[int, float]:  # fmt: skip
    """List the points that touch, or are ``within`` a share of the size of that.

    ``strongest`` is the largest acceleration there is, for which motors get their units of force.

    Returns how many there are, and the deepest overlap as a share of a size. Only as many as there is room
    for are listed.
    """
    count, deepest = 0, 0.0
    for p in range(len(scene.pairs)):
        size = scene.coefficients[p, 2]
        limit = (TOUCH + within) * size
        if scene.pairs[p, 2] >= F.FIRST_ROW:
            left = 0.0  # of a motor
            if scene.pairs[p, 2] == F.JOINT - F.WALL:
                left = gap_of_row(scene.rows, scene.coefficients, p, q)
        else:
            left = far_apart(scene, p, q, limit)
        if left > limit:
            continue
        n, _ = find_points(scene, p, q, v, scratch.points)
        for k in range(n):
            measure(scene, scratch.points, k, q, v, scratch.measures)
            gap = scratch.measures[k, F.GAP]
            deepest = max(deepest, -gap / size)
            if gap > limit:
                continue
            if count < len(equations.points):
                for column in range(F.GIVEN):
                    equations.points[count, column] = scratch.points[k, column]
                equations.measures[count, F.MU] = scene.coefficients[p, 0]
                if scratch.points[k, F.FEATURE] == F.MOTOR:
                    unit = _find_unit(scene, scratch, k, scene.coefficients[p, 0], strongest)
                    equations.measures[count, F.MU] /= unit
                equations.measures[count, F.RESTITUTION] = scene.coefficients[p, 1]
            count += 1
    return count, deepest


@inlined
def rest_limits(scene: RigidScene, acceleration: Numbers, v: Numbers) -> tuple[float, float]:
    """Return the tolerances of speeds [m/s] and of accelerations [m/s^2], below which all is zero.

    The latter is ``NO_PUSH`` times the largest acceleration.
    """
    strongest, fastest, smallest = 0.0, 0.0, math.inf
    for row in range(scene.rows):
        if scene.inverse_mass[2 * row] > 0.0:
            strongest = max(strongest, length_of(acceleration[2 * row], acceleration[2 * row + 1]))
        turning = abs(v[2 * scene.rows + row]) * scene.shapes.reach[row]
        fastest = max(fastest, length_of(v[2 * row], v[2 * row + 1]) + turning)
    if scene.joints[ROWS] > 0:  # what hangs at rest is pulled all the same
        strongest = max(strongest, strongest_joint(scene))
    for p in range(len(scene.pairs)):
        smallest = min(smallest, scene.coefficients[p, 2])
    if smallest == math.inf:
        return 0.0, 0.0
    strongest += fastest * fastest / smallest  # what moves round a corner, or spins, accelerates towards it
    return _REST * math.sqrt(strongest * smallest), NO_PUSH * strongest


@inlined
def _keep(equations: Equations, i: int, n: int) -> int:
    """Move point i to place n; return the next place."""
    for column in range(F.POINT_FIELDS):
        equations.points[n, column] = equations.points[i, column]
    for column in range(F.MEASURES):
        equations.measures[n, column] = equations.measures[i, column]
    return n + 1


@inlined
def _changed_status(equations: Equations, i: int, changed: Points) -> int:
    """Return what point i does since the event that ended the segment before, -1 if it is not of it."""
    status, noted = -1, True
    for k in range(len(changed)):
        noted = noted and changed[k, F.PAIR] >= 0
        if noted and _is_same(equations.points, i, changed, k):
            status = changed[k, F.STATUS]
    return status


@always_inlined
def _stop_across(scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers) -> None:
    """Remove speeds below the tolerance: equations of points that rest would contradict each other."""
    for i in range(count):
        equations.points[i, F.STATUS] = SLIDES_ON
        equations.vectors[FREE, 2 * i], equations.vectors[FREE, 2 * i + 1] = equations.measures[i, F.VN], 0.0
    solve_equations(equations, count, 0.0)
    book_speeds(scene, q, v, -1.0)
    apply(scene, equations, count, v)
    book_speeds(scene, q, v, 1.0)
    measure_all(scene, equations, count, q, v)


@always_inlined
def take_closed(
    scene: RigidScene, equations: Equations, count: int, changed: Points, q: Numbers, v: Numbers, rest: float
) -> int:
    """Keep the points that do not part; return how many.

    ``changed`` has the points that ended the segment before and what they do from now on, where the laws
    alone would leave that to rounding.
    """
    n = 0
    measure_all(scene, equations, count, q, v)
    for i in range(count):
        if equations.measures[i, F.VN] <= rest and _changed_status(equations, i, changed) != OPEN:
            n = _keep(equations, i, n)
    return n


@inlined
def _note_given(equations: Equations, count: int, changed: Points, rest: float) -> None:
    """Note what points may do by how they move: those of ``changed`` go on with what they began."""
    for i in range(count):
        sliding, given = equations.measures[i, F.VT], STICKS
        changed_to = _changed_status(equations, i, changed)
        if equations.measures[i, F.MU] == 0.0 or sliding > SLOW * rest:
            given = SLIDES_ON
        elif sliding < -SLOW * rest:
            given = SLIDES_BACK
        elif changed_to > STICKS:
            given = changed_to
        if changed_to == STICKS:  # a motor has its speed, however small the speeds are that are rounding
            given = STICKS
        equations.points[i, F.GIVEN] = given


@always_inlined
def hold_closed(
    scene: RigidScene, equations: Equations, count: int, changed: Points,
    q: Numbers, v: Numbers, acceleration: Numbers, rest: float, least: float,
) -> tuple[int, bool]:  # fmt: skip
    """Find what ``count`` points do, and with what forces; return how many they are, and if laws are kept."""
    n, solved = 0, True
    for attempt in range(2):
        if count == 0:
            return 0, True
        leaves = False
        for i in range(count):
            leaves = leaves or equations.measures[i, F.VN] > NO_SPEED * rest
        leaves = leaves and attempt == 0
        assemble(scene, equations, count)
        if not leaves:
            _stop_across(scene, equations, count, q, v)
        accelerate(q, v, acceleration, scene.inverse_mass, scene.damping, scene.calls)
        find_free_rates(scene, equations, count, acceleration, 0.0)
        _note_given(equations, count, changed, rest)
        found = solve_complementarity(equations, count, least, True)
        solved = found == SETTLED or (found == FITTING and settle_at_an_edge(equations, count, least))
        if not leaves:
            break
        for i in range(count):  # what has just begun to open, and goes on, keeps its speed
            opens = equations.points[i, F.STATUS] == OPEN and equations.measures[i, F.VN] > NO_SPEED * rest
            if not (solved and opens):
                n = _keep(equations, i, n)
        count, n = n, 0
    return count, solved


@always_inlined
def hold_evenly(
    scene: RigidScene, equations: Equations, count: int, changed: Points, acceleration: Numbers, rest: float,
    least: float, inverse_mass: Numbers, pulled: Numbers,
) -> int:  # fmt: skip
    """Find the forces that would hold ``count`` points of equal bodies that are pulled as these are.

    Forces that hold bodies at rest depend on their loads and not on their masses. So all are given the
    largest mass there is, and what is light between heavy bodies costs no digits. ``inverse_mass`` and
    ``pulled`` are room.
    """
    lightest = math.inf
    for row in range(scene.rows):
        if scene.inverse_mass[2 * row] > 0.0:
            lightest = min(lightest, scene.inverse_mass[2 * row])
    for i in range(3 * scene.rows):
        own = scene.inverse_mass[i if i < 2 * scene.rows else 2 * (i - 2 * scene.rows)]
        share = lightest / own if own > 0.0 else 1.0
        inverse_mass[i], pulled[i] = share * scene.inverse_mass[i], share * acceleration[i]
    even = RigidScene(
        scene.rows, inverse_mass, scene.damping, scene.calls, scene.shapes, scene.walls, scene.pairs,
        scene.coefficients, scene.accounts, scene.joint_numbers, scene.joints,
    )  # fmt: skip
    _note_given(equations, count, changed, rest)
    assemble(even, equations, count)
    find_free_rates(even, equations, count, pulled, 0.0)
    found: int = solve_complementarity(equations, count, least, True)
    return found


@inlined
def keep_pressing(equations: Equations, count: int, least: float) -> int:
    """Keep the points that press, with their forces; return how many."""
    n, forces = 0, equations.vectors
    for i in range(count):
        pressing = forces[UNKNOWN, 2 * i] * equations.a[2 * i, 2 * i]
        if equations.points[i, F.STATUS] != OPEN and pressing > least:
            forces[UNKNOWN, 2 * n] = forces[UNKNOWN, 2 * i]
            forces[UNKNOWN, 2 * n + 1] = forces[UNKNOWN, 2 * i + 1]
            n = _keep(equations, i, n)
    return n
