"""Pairs so far apart that they are not looked at again for a while.

Most near pairs do not touch, and the record of one takes several lines of the cache. In the first substep of
a call it is noted how far each is from having points; later it is looked at again only once its two bodies
together have come as far. To look again earlier would find the same, so that no bit depends on it.
"""

import math

from physicslab.kernels import Vectors, always_inlined, inlined
from physicslab.kernels.arguments import Bounds, Motion, Near
from physicslab.kernels.geometry.margins import ACTIVATION_RATIO, CORNERWISE, touching_ahead
from physicslab.kernels.geometry.shapes import Shapes, half_extents
from physicslab.kernels.near_counts import FOLLOWED, RECORDED
from physicslab.kernels.records import Manifold

LAST_X, LAST_Y, LAST_ANGLE, PATH, REACH = range(5)
"""The rows of ``Near.travels``: where each body last was [m, rad]; how far any point of it can have come in
the call [m]; that, and how far it comes at most in the substep at hand."""
SINCE, NEXT, X, Y, ANGLE, VX, VY = range(7)
"""The columns of ``Near.moments``: when a swift body had its last impact, and when it meets another next; the
place, the angle and the velocity of each body before the impacts of the substep."""
_WORTH_IT = 4
"""Number of bodies a pair that is apart from which all are followed."""
_TOUCHING, _UNKNOWN = 0xFFFFFFFF, 0xFFFFFFFE
"""In place of A's row where a pair has points, and where it is not known yet whether it has."""
_ROUNDING = 1e-12
"""Share of coordinates by which distances may be rounded."""


@inlined
def look_at_new(near: Near) -> None:
    """Let all pairs be looked at, or only those with new records where the others are followed."""
    counts = near.counts
    for p in range(counts[FOLLOWED], counts[RECORDED]):
        near.apart[p].clearance, near.apart[p].a = -math.inf, _UNKNOWN
    if counts[FOLLOWED] > 0:
        counts[FOLLOWED] = counts[RECORDED]


@inlined
def note(near: Near, p: int, a: int, b: int, clearance: float, motion: Motion) -> None:
    """Note by how much nearer two bodies would have to come to have points: ``clearance`` [m]."""
    pair, travels, position = near.apart[p], near.travels, motion.position
    rounded = abs(position[a, 0]) + abs(position[a, 1]) + abs(position[b, 0]) + abs(position[b, 1])
    if near.counts[FOLLOWED] > 0:
        clearance += travels[PATH, a] + travels[PATH, b]
    pair.clearance, pair.a, pair.b = clearance - _ROUNDING * rounded, a, b


@inlined
def begin_to_follow(near: Near, motion: Motion, apart: int) -> None:
    """Follow the bodies from where they are, if enough pairs are ``apart``."""
    rows, travels = len(motion.angle), near.travels
    if apart * _WORTH_IT < rows:
        return
    near.counts[FOLLOWED] = near.counts[RECORDED]
    for i in range(rows):
        travels[LAST_X, i], travels[LAST_Y, i] = motion.position[i, 0], motion.position[i, 1]
        travels[LAST_ANGLE, i], travels[PATH, i] = motion.angle[i], 0.0


@inlined
def follow(travels: Vectors, motion: Motion, shapes: Shapes, h: float) -> None:
    """Add up how far bodies have come, and come at most in the ``h`` seconds at hand."""
    position, angle, linear, angular = motion
    for i in range(len(angle)):
        arm = shapes.half_x[i] + shapes.half_y[i]
        x, y, turned = position[i, 0], position[i, 1], angle[i]
        way = abs(x - travels[LAST_X, i]) + abs(y - travels[LAST_Y, i])
        way += abs(turned - travels[LAST_ANGLE, i]) * arm
        travels[LAST_X, i], travels[LAST_Y, i], travels[LAST_ANGLE, i] = x, y, turned
        travels[PATH, i] += way
        ahead = h * (abs(linear[i, 0]) + abs(linear[i, 1]) + abs(angular[i]) * arm)
        travels[REACH, i] = travels[PATH, i] + ahead


@inlined
def stays_apart(near: Near, p: int) -> bool:
    """Whether a pair has no points in the substep at hand, as far as its bodies may have come."""
    pair, travels = near.apart[p], near.travels
    if p >= near.counts[FOLLOWED] or pair.clearance == -math.inf:
        return False
    return bool(pair.clearance > travels[REACH, pair.a] + travels[REACH, pair.b])


@inlined
def note_touching(near: Near, p: int) -> None:
    """Note that a pair has points."""
    near.apart[p].clearance, near.apart[p].a = -math.inf, _TOUCHING


@inlined
def _touching_ahead(before: Vectors, i: int, shapes: Shapes, h: float, speculative_margin: float) -> float:
    """Return how far [m] beyond its upright box body i might have had points, before the impacts."""
    ux, uy = before[i, VX] * h, before[i, VY] * h
    return touching_ahead(ux, uy, shapes.reach[i], shapes.radius[i], shapes.thin[i], speculative_margin)


@inlined
def is_sure_to_be_listed(
    manifold: Manifold, near: Near, shapes: Shapes, bounds: Bounds, h: float, speculative_margin: float
) -> bool:  # fmt: skip
    """Whether a pair has a record whenever near pairs were listed, as it might have met before the impacts.

    Others may have one from a list that was made for longer: that no bit depends on lists, these do not
    count. Nor does what is near a segment of a chain, which is listed by its box.
    """
    a, b, wall, before = manifold.a, manifold.b, manifold.wall, near.moments
    width_b, height_b = half_extents(shapes, b, before[b, ANGLE])
    margin = _touching_ahead(before, b, shapes, h, speculative_margin)
    if wall >= 0:
        away = before[b, X + wall % 2] - bounds.walls[wall]
        clear = (away if wall < 2 else -away) - (height_b if wall % 2 else width_b)
        return bool(clear <= margin)
    x, y = before[b, X] - before[a, X], before[b, Y] - before[a, Y]
    moved = (abs(before[b, VX] - before[a, VX]) + abs(before[b, VY] - before[a, VY])) * h
    within = ACTIVATION_RATIO * (shapes.reach[a] + shapes.reach[b]) + CORNERWISE * (
        moved + speculative_margin
    )
    if wall < -1 or x * x + y * y > within * within:
        return False
    width_a, height_a = half_extents(shapes, a, before[a, ANGLE])
    margin += _touching_ahead(before, a, shapes, h, speculative_margin)
    return bool(abs(x) <= width_a + width_b + margin and abs(y) <= height_a + height_b + margin)


@always_inlined
def may_be_thrown_together(near: Near, p: int, sweep: float) -> bool:
    """Whether a pair without points has a body that an impact has changed, and none that it has left swift.

    It counts from a ``sweep`` of impacts on: what no later one has changed was looked at before. Swift ones
    are swept again from their impact on (:mod:`physicslab.kernels.solver.meet_again`).
    """
    a, b, changed, moments = near.apart[p].a, near.apart[p].b, near.angular_before, near.moments
    if a == _UNKNOWN:
        manifold = near.manifolds[p]
        a, b = manifold.a if manifold.count == 0 else _TOUCHING, manifold.b
    if a == _TOUCHING:
        return False
    hit = max(changed[a], changed[b]) >= sweep
    return bool(hit and max(moments[a, SINCE], moments[b, SINCE]) == -math.inf)


@inlined
def note_motion(moments: Vectors, motion: Motion) -> None:
    """Note where bodies are, and how they move, before impacts, as :func:`is_sure_to_be_listed` needs it."""
    for i in range(len(moments)):
        moments[i, X], moments[i, Y] = motion.position[i, 0], motion.position[i, 1]
        moments[i, ANGLE] = motion.angle[i]
        moments[i, VX], moments[i, VY] = motion.linear[i, 0], motion.linear[i, 1]
