"""How long a segment of motion may last so that no body passes through another one unseen."""

import math

from physicslab.kernels import Numbers, inlined
from physicslab.kernels.length import length_of
from physicslab.kernels.ode.dop853_tableau import LAST
from physicslab.kernels.rigid.features import FIRST_ROW, JOINT, WALL, RigidScene
from physicslab.kernels.rigid.joint_points import fastest_change, gap_of_row
from physicslab.kernels.rigid.smooth_segment import METHODS, SHORT_LAST, Stages
from physicslab.kernels.rigid.touching import far_apart

_NODES = METHODS.sum(axis=2)
"""When the stages of both methods are, as shares of a step."""
_STRAYS = LAST + 1
"""The row of pushes that holds how far each body may be from where an even acceleration leads it [m]."""
_MAX_TURN = 0.25
"""Largest angle of a segment [rad]."""
_STRIDE = 0.2
"""Share of the smaller size that a pair may approach in a segment, beyond its gap."""


@inlined
def time_to_pass(way: float, speed: float, acceleration: float) -> float:
    """Return how long a way takes from a speed on, under an even acceleration [s]."""
    mean: float = 0.5 * (speed + math.sqrt(speed * speed + 2.0 * acceleration * way))
    return way / mean if mean > 0.0 else math.inf


@inlined
def _turning_reach(scene: RigidScene, row: int) -> float:
    """Return how far from its centre the outline of a body moves as it turns [m]."""
    reach: float = scene.shapes.reach[row] - scene.shapes.radius[row]
    return reach


@inlined
def _relative(scene: RigidScene, a: int, b: int, rates: Numbers) -> float:
    """Return the largest rate at which points of two bodies come together, of speeds or accelerations."""
    rows = scene.rows
    rate: float = length_of(rates[2 * b] - rates[2 * a], rates[2 * b + 1] - rates[2 * a + 1])
    rate += abs(rates[2 * rows + a]) * _turning_reach(scene, a)
    rate += abs(rates[2 * rows + b]) * _turning_reach(scene, b)
    return rate


@inlined
def time_apart(
    scene: RigidScene, a: int, b: int, q: Numbers, v: Numbers, nx: float, ny: float, way: float,
    stages: Stages, last: int,
) -> float:  # fmt: skip
    """Return for how long two bodies stay apart that have a ``way`` between them along (nx, ny) [s].

    They come together by their speeds along that and by turning. These change by the forces at both ends of a
    segment, and as the direction turns.
    """
    rows, reach_a, reach_b = scene.rows, _turning_reach(scene, a), _turning_reach(scene, b)
    x, y = v[2 * b] - v[2 * a], v[2 * b + 1] - v[2 * a + 1]
    arm = length_of(q[2 * b] - q[2 * a], q[2 * b + 1] - q[2 * a + 1]) + reach_a + reach_b
    spin = abs(v[2 * rows + a]) if reach_a > 0.0 else 0.0
    spin += abs(v[2 * rows + b]) if reach_b > 0.0 else 0.0
    forced = max(_relative(scene, a, b, stages.pushes[0]), _relative(scene, a, b, stages.pushes[last]))
    bent = forced + spin * (2.0 * length_of(x, y) + spin * arm)
    time: float = time_to_pass(way, abs(nx * x + ny * y) + spin * arm, bent)
    return time


@inlined
def _contacts(scene: RigidScene) -> int:
    """Return how many pairs are bodies that may touch: rows of joints come behind them."""
    n = len(scene.pairs)
    while n > 0 and scene.pairs[n - 1, 2] >= FIRST_ROW:
        n -= 1
    return n


@inlined
def _longest_before_limits(
    scene: RigidScene, first: int, q: Numbers, v: Numbers, acceleration: Numbers, allowed: Numbers
) -> float:
    """Return the same for limits, the pairs from ``first`` on."""
    longest, rows, own = math.inf, scene.rows, scene.coefficients
    for p in range(first, len(scene.pairs)):
        allowed[p] = math.inf
        if scene.pairs[p, 2] == JOINT - WALL:
            speed, push = fastest_change(rows, own, p, q, v), fastest_change(rows, own, p, q, acceleration)
            if speed > 0.0 or push > 0.0:
                allowed[p] = max(gap_of_row(rows, own, p, q), 0.0) + _STRIDE * own[p, 2]
                longest = min(longest, time_to_pass(allowed[p], speed, push))
                allowed[p] += _STRIDE * own[p, 2]
    return longest


@inlined
def longest_segment(
    scene: RigidScene, q: Numbers, v: Numbers, acceleration: Numbers, allowed: Numbers
) -> float:
    """Return for how long no pair can pass through each other unseen, and nothing turn far [s].

    If all went on as it begins. How far each pair may come together is noted in ``allowed`` [m].
    """
    longest, contacts = math.inf, _contacts(scene)
    if contacts < len(scene.pairs):
        longest = _longest_before_limits(scene, contacts, q, v, acceleration, allowed)
    for p in range(contacts):
        a, b = scene.pairs[p, 0], scene.pairs[p, 1]
        speed, push = _relative(scene, a, b, v), _relative(scene, a, b, acceleration)
        allowed[p] = math.inf
        if speed > 0.0 or push > 0.0:
            allowed[p] = max(far_apart(scene, p, q, math.inf), 0.0) + _STRIDE * scene.coefficients[p, 2]
            longest = min(longest, time_to_pass(allowed[p], speed, push))
            allowed[p] += _STRIDE * scene.coefficients[p, 2]
    for row in range(scene.rows):
        turning = 2 * scene.rows + row
        if scene.shapes.vertices[row] > 1:
            longest = min(longest, time_to_pass(_MAX_TURN, abs(v[turning]), abs(acceleration[turning])))
    return longest


@inlined
def share_of_ways(
    scene: RigidScene, v: Numbers, h: float, short: bool, stages: Stages, allowed: Numbers, fastest: Numbers
) -> float:
    """Return the largest share that two bodies may have come together of what is ``allowed`` [m].

    How fast each pair did at most is noted in ``fastest`` [m/s].

    In the segment of ``h`` seconds from speeds v that was just made. Under an even acceleration a body covers
    no more than by the mean of its speeds at both ends; what the stages are off that is added.
    """
    rows, method, last, worst = scene.rows, 1 if short else 0, SHORT_LAST if short else LAST, 0.0
    strays = stages.pushes[_STRAYS]
    for row in range(rows):
        off, turned = 0.0, 0.0
        for stage in range(1, last):
            rates, share = stages.rates[stage], _NODES[method, stage]
            for k in range(3):
                i = 2 * row + k if k < 2 else 2 * rows + row
                change = abs(rates[i] - v[i] - share * (stages.v[i] - v[i]))
                if k < 2:
                    off = max(off, change)
                else:
                    turned = max(turned, change)
        strays[row] = h * (math.sqrt(2.0) * off + turned * _turning_reach(scene, row))
    contacts = _contacts(scene)
    for p in range(contacts):
        a, b = scene.pairs[p, 0], scene.pairs[p, 1]
        first, then, off = _relative(scene, a, b, v), _relative(scene, a, b, stages.v), strays[a] + strays[b]
        fastest[p] = max(first, then) + off / h
        worst = max(worst, (0.5 * h * (first + then) + off) / allowed[p])
    for p in range(contacts, len(scene.pairs)):
        if allowed[p] < math.inf:
            own, a, b = scene.coefficients, scene.pairs[p, 0], scene.pairs[p, 1]
            rate = fastest_change(rows, own, p, stages.q, v) + fastest_change(
                rows, own, p, stages.q, stages.v
            )
            worst = max(worst, (0.5 * h * rate + strays[a] + strays[b]) / allowed[p])
    return worst
