"""The equations of bodies that touch: how contact forces act on what the points measure."""

import math

from physicslab.kernels import Numbers, always_inlined, inlined
from physicslab.kernels.forces.force_calls import accelerate
from physicslab.kernels.joints.layout import ROWS
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.budget import book_speeds
from physicslab.kernels.rigid.equations import CHANGE, FREE, UNKNOWN, Equations
from physicslab.kernels.rigid.features import RigidScene, rate_along
from physicslab.kernels.rigid.joined import book_forces, lessen, measure_joints, pass_on
from physicslab.kernels.rigid.joint_points import OWN, measure
from physicslab.kernels.rigid.least_norm import REFINEMENTS, begin_equations, refine, solve_equations


@inlined
def measure_all(scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers) -> None:
    """Measure the first ``count`` points in a state, and what joints hold together."""
    if scene.joints[ROWS] > 0:
        measure_joints(scene, q, v)
    for i in range(count):
        measure(scene, equations.points, i, q, v, equations.measures)


@inlined
def _coupling(scene: RigidScene, equations: Equations, i: int, j: int) -> tuple[float, float, float, float]:
    """Return what unit forces at point j cause at point i: n n, n t, t n, t t."""
    points, measures = equations.points, equations.measures
    nn, nt, tn, tt = 0.0, 0.0, 0.0, 0.0
    for side_i in range(2):
        body = points[i, F.ONE + side_i]
        mass, inertia = scene.inverse_mass[2 * body], scene.inverse_mass[2 * scene.rows + body]
        if mass == 0.0 and inertia == 0.0:
            continue
        n, t = F.NORMAL + 3 * side_i, F.TANGENT + 3 * side_i
        nx, ny, turn_n = measures[i, n], measures[i, n + 1], inertia * measures[i, n + 2]
        tx, ty, turn_t = measures[i, t], measures[i, t + 1], inertia * measures[i, t + 2]
        for side_j in range(2):
            if points[j, F.ONE + side_j] != body:
                continue
            n, t = F.NORMAL + 3 * side_j, F.TANGENT + 3 * side_j
            nn += mass * (nx * measures[j, n] + ny * measures[j, n + 1]) + turn_n * measures[j, n + 2]
            nt += mass * (nx * measures[j, t] + ny * measures[j, t + 1]) + turn_n * measures[j, t + 2]
            tn += mass * (tx * measures[j, n] + ty * measures[j, n + 1]) + turn_t * measures[j, n + 2]
            tt += mass * (tx * measures[j, t] + ty * measures[j, t + 1]) + turn_t * measures[j, t + 2]
    return nn, nt, tn, tt


@always_inlined
def _own_response(
    scene: RigidScene, equations: Equations, i: int, nn: float, tt: float
) -> tuple[float, float]:
    """Return what unit forces cause at the row of a joint, and what stands for that where it has none."""
    if equations.points[i, F.FEATURE] == F.MOTOR:
        nn = scene.coefficients[equations.points[i, F.PAIR], OWN]
    return nn if nn > 0.0 else 1.0, tt if tt > 0.0 else 1.0


@inlined
def assemble(scene: RigidScene, equations: Equations, count: int) -> None:
    """Fill the matrix with what each unit force causes at each point."""
    a = equations.a
    for i in range(count):
        for j in range(i + 1):
            nn, nt, tn, tt = _coupling(scene, equations, i, j)
            if i == j and equations.points[i, F.FEATURE] >= F.JOINT:
                nn, tt = _own_response(scene, equations, i, nn, tt)
            n, t, other_n, other_t = 2 * i, 2 * i + 1, 2 * j, 2 * j + 1
            a[n, other_n], a[n, other_t], a[t, other_n], a[t, other_t] = nn, nt, tn, tt
            a[other_n, n], a[other_t, n], a[other_n, t], a[other_t, t] = nn, nt, tn, tt
    if scene.joints[ROWS] > 0:
        lessen(scene, equations, count)


@inlined
def apply(scene: RigidScene, equations: Equations, count: int, target: Numbers, which: int = UNKNOWN) -> None:
    """Add to velocities what the impulses found cause, or to accelerations what forces do.

    ``which`` is their row of the vectors.
    """
    rows, measures, points = scene.rows, equations.measures, equations.points
    for i in range(count):
        along, across = equations.vectors[which, 2 * i], equations.vectors[which, 2 * i + 1]
        for side in range(2):
            body, n, t = points[i, F.ONE + side], F.NORMAL + 3 * side, F.TANGENT + 3 * side
            for k in range(3):
                place = 2 * body + k if k < 2 else 2 * rows + body
                push = along * measures[i, n + k] + across * measures[i, t + k]
                target[place] += scene.inverse_mass[place] * push
    if scene.joints[ROWS] > 0:
        pass_on(scene, equations, which, count, target)


@inlined
def find_loads(scene: RigidScene, equations: Equations, count: int, loads: Numbers) -> None:
    """Add by how much the forces found would accelerate what they press, if each of them acted alone."""
    for i in range(count):
        along, across = equations.vectors[UNKNOWN, 2 * i], equations.vectors[UNKNOWN, 2 * i + 1]
        force = math.sqrt(along * along + across * across)
        for side in range(2):
            body = equations.points[i, F.ONE + side]
            turning, reach = 2 * scene.rows + body, scene.shapes.reach[body]
            loads[2 * body] += scene.inverse_mass[2 * body] * force
            loads[2 * body + 1] += scene.inverse_mass[2 * body + 1] * force
            loads[turning] += scene.inverse_mass[turning] * force * reach


@inlined
def rates_without_forces(
    scene: RigidScene, equations: Equations, i: int, acceleration: Numbers
) -> tuple[float, float]:
    """Return how the speeds of point i along its normal and its tangent change at given accelerations."""
    points, measures = equations.points, equations.measures
    opening = rate_along(scene.rows, points, measures, i, F.NORMAL, acceleration)
    sliding = rate_along(scene.rows, points, measures, i, F.TANGENT, acceleration)
    return opening + measures[i, F.BIAS_N], sliding + measures[i, F.BIAS_T]


@inlined
def find_free_rates(
    scene: RigidScene, equations: Equations, count: int, acceleration: Numbers, share: float
) -> None:
    """Find how the speeds of points change at accelerations, of which ``share`` of the forces are part."""
    for i in range(count):
        opening, sliding = rates_without_forces(scene, equations, i, acceleration)
        if equations.points[i, F.FEATURE] == F.MOTOR:  # nothing moves by what presses on it
            opening += share * equations.a[2 * i, 2 * i] * equations.vectors[UNKNOWN, 2 * i]
        equations.vectors[FREE, 2 * i], equations.vectors[FREE, 2 * i + 1] = opening, sliding


@inlined
def constrained_acceleration(
    scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers, acceleration: Numbers
) -> None:
    """Compute v' of a state in which each point goes on with what it does, and the forces of the points.

    Behind the clock, ``acceleration`` takes what causes give in a second.

    A light body between heavy ones is accelerated by the difference of large forces. So these are refined
    by what the accelerations still leave of the laws, and their changes are added to the accelerations.
    """
    accelerate(q, v, acceleration, scene.inverse_mass, scene.damping, scene.calls)
    if count > 0:
        measure_all(scene, equations, count, q, v)
        assemble(scene, equations, count)
        n, largest, residual, rank = begin_equations(equations, count, 1.0), 0.0, math.inf, 0
        for _ in range(REFINEMENTS):
            find_free_rates(scene, equations, count, acceleration, 1.0)
            for i in range(2 * count if residual == math.inf else 0):
                largest = max(largest, abs(equations.vectors[FREE, i]))
            residual, rank = refine(equations, count, n, 1.0, FREE, largest, residual, rank)
            if residual < 0.0:
                break
            apply(scene, equations, count, acceleration, CHANGE)
        book_forces(scene, equations, count, q, v, acceleration)


@always_inlined
def project(scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers) -> None:
    """Move bodies by the least that closes the gaps of closed points, and remove their speeds across.

    A point that sticks loses its sliding speed as well. Speeds below the tolerance are taken by contacts;
    what moving bodies does to energy and momentum is an error.
    """
    for turn in range(3):
        measure_all(scene, equations, count, q, v)
        assemble(scene, equations, count)
        for i in range(count):
            gap = equations.measures[i, F.GAP]
            equations.vectors[FREE, 2 * i] = gap if turn < 2 else equations.measures[i, F.VN]
            equations.vectors[FREE, 2 * i + 1] = 0.0 if turn < 2 else equations.measures[i, F.VT]
        solve_equations(equations, count, 0.0)
        if turn < 2:
            apply(scene, equations, count, q)
        else:
            book_speeds(scene, q, v, -1.0)
            apply(scene, equations, count, v)
            book_speeds(scene, q, v, 1.0)
