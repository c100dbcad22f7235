"""Short steps of fixed length with impulses, where events accumulate or no contact forces are found.

Moreau's midpoint rule: half a drift, the forces of the middle as an increment of velocity, impulses of all
points that touch there, the other half of the drift (Moreau, Unilateral Contact and Dry Friction in Finite
Freedom Dynamics, 1988; Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235). Impulses of resting contacts
exist where forces do not (Painleve's paradox), and no number of events within a step matters; its error is
of order one.
"""

import math

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels.accounts import ENERGY, HAND, MOTORS
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.forces.force_calls import accelerate
from physicslab.kernels.joints.layout import ENDS, FIRST, PLACES, ROWS
from physicslab.kernels.length import length_of
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.budget import book_row
from physicslab.kernels.rigid.complementarity import NOT_FOUND, solve_complementarity
from physicslab.kernels.rigid.constraints import apply, assemble, measure_all
from physicslab.kernels.rigid.detect import find_points
from physicslab.kernels.rigid.equations import FREE, SLIDES_ON, UNKNOWN, Equations
from physicslab.kernels.rigid.features import RigidScene
from physicslab.kernels.rigid.joined import book_impulses
from physicslab.kernels.rigid.smooth_segment import Stages

_SEPARATIONS = 2
"""How often bodies that overlap are moved apart: gaps are not linear in angles."""


@inlined
def move(q: Numbers, v: Numbers, h: float) -> None:
    """Move everything for ``h`` seconds at the speeds that it has."""
    for i in range(len(q)):
        q[i] += h * v[i]


@inlined
def kick(of: RigidScene, acceleration: Numbers, q: Numbers, v: Numbers, h: float) -> float:
    """Change speeds by the forces of ``h`` seconds; return the largest acceleration of a body [m/s^2]."""
    largest = 0.0
    accelerate(q, v, acceleration, of.inverse_mass, of.damping, of.calls)
    move(v, acceleration, h)
    for row in range(of.rows):
        if of.inverse_mass[2 * row] > 0.0:
            largest = max(largest, length_of(acceleration[2 * row], acceleration[2 * row + 1]))
    return largest


@always_inlined
def drive(
    of: RigidScene, points: Equations, acceleration: Numbers, old: Numbers, q: Numbers, v: Numbers, h: float,
    account: Vectors,
) -> None:  # fmt: skip
    """Let motors with a cap act for ``h`` seconds, one after the other, each by what it takes or its cap.

    ``acceleration`` is what forces have caused in that time, ``old`` room for speeds.
    """
    for p in range(len(of.pairs)):
        if of.pairs[p, 2] != F.MOTOR - F.WALL:
            continue
        find_points(of, p, q, v, points.points)
        measure_all(of, points, 1, q, v)
        assemble(of, points, 1)
        most = h * of.coefficients[p, 0]
        points.vectors[UNKNOWN, 0] = 0.0
        points.vectors[UNKNOWN, 1] = max(-most, min(most, -points.measures[0, F.VT] / points.a[1, 1]))
        for i in range(len(v)):
            old[i] = v[i]
        apply(of, points, 1, v)
        book_row(of, points, 0, q, old, v, 0.5 * h, acceleration, account[MOTORS], account[HAND])
        if of.joints[ROWS] > 0:
            book_impulses(of, points, 1, q, v, account)


@inlined
def separate(of: RigidScene, points: Equations, count: int, q: Numbers, v: Numbers) -> bool:
    """Move bodies that overlap apart, by the least that it takes; return whether that can be done.

    The ``count`` points that touch are pushed and never pulled, and friction plays no part.
    """
    for _ in range(_SEPARATIONS):
        measure_all(of, points, count, q, v)
        for i in range(count):
            points.measures[i, F.MU], points.points[i, F.GIVEN] = 0.0, SLIDES_ON
            points.vectors[FREE, 2 * i], points.vectors[FREE, 2 * i + 1] = points.measures[i, F.GAP], 0.0
        assemble(of, points, count)
        if solve_complementarity(points, count, 0.0, True) == NOT_FOUND:
            return False
        apply(of, points, count, q)
    return True


@inlined
def _find_islands(scene: RigidScene, equations: Equations, count: int, island: Numbers) -> None:
    """Give all bodies that points or joints connect one number: the lowest row of them."""
    for row in range(scene.rows):
        island[row] = row
    changed, n = True, scene.joints[ROWS]
    while changed:
        changed = False
        for k in range(n * ENDS * ENDS):
            ends = FIRST + PLACES * (k // (ENDS * ENDS))
            at_one = scene.joints[ends + 2 * (k // ENDS % ENDS)]
            at_other = scene.joints[ends + 2 * (k % ENDS)]
            if at_one < 0 or at_other < 0:
                continue
            one, other = at_one // 2, at_other // 2
            moving = scene.inverse_mass[2 * one] > 0.0 and scene.inverse_mass[2 * other] > 0.0
            if moving and island[one] != island[other]:
                island[one] = island[other] = min(island[one], island[other])
                changed = True
        for i in range(count):
            one, other = equations.points[i, F.ONE], equations.points[i, F.OTHER]
            moving = scene.inverse_mass[2 * one] > 0.0 and scene.inverse_mass[2 * other] > 0.0
            wall = F.WALL <= equations.points[i, F.FEATURE] < F.JOINT
            if moving and not wall and island[one] != island[other]:
                island[one] = island[other] = min(island[one], island[other])
                changed = True


@inlined
def take_work(
    of: RigidScene, points: Equations, count: int, room: Stages, before: Numbers, q: Numbers, v: Numbers,
    pay: bool,
) -> tuple[float, float]:  # fmt: skip
    """Return the energy that a short move from ``before`` to ``q`` adds, by its work against forces [J].

    Where it is to ``pay`` for it, what was added is taken from the kinetic energy of the bodies that hang
    together by the ``count`` points: all their speeds are lowered by one factor, so that what slides and what
    rests does so still. Work beyond their energy is returned; then by how much the energy has
    changed, be it that it was less. Work against forces that store none, as a thrust, adds nothing.
    """
    rows, island, push, way, change = of.rows, room.v, room.acceleration, room.rates[1], 0.0
    for i in range(len(q)):  # the speed of a move that takes a second
        way[i] = q[i] - before[i]
    accelerate(before, way, room.q, of.inverse_mass, of.damping, of.calls)
    accelerate(q, way, push, of.inverse_mass, of.damping, of.calls)
    for account in range(
        3 * rows + 1, len(q), ACCOUNTS
    ):  # behind the clock: what forces that store none give
        change += 0.5 * (room.q[account + ENERGY] + push[account + ENERGY])
    added = 0.0 if pay else change
    _find_islands(of, points, count, island)
    for first in range(rows):
        work, energy = 0.0, 0.0
        for row in range(rows):
            for k in range(3 if island[row] == first else 0):
                i = 2 * row + k if k < 2 else 2 * rows + row
                if of.inverse_mass[i] > 0.0:
                    work -= 0.5 * (room.q[i] + push[i]) * way[i] / of.inverse_mass[i]
                    energy += 0.5 * v[i] * v[i] / of.inverse_mass[i]
        if pay and work > 0.0:
            share = math.sqrt(max(1.0 - work / energy, 0.0)) if energy > 0.0 else 0.0
            work = max(work - energy, 0.0)
            for row in range(rows):
                if island[row] == first:
                    v[2 * row], v[2 * row + 1] = share * v[2 * row], share * v[2 * row + 1]
                    v[2 * rows + row] *= share
        change += work
        if not pay or work > 0.0:
            added += work
    return added, change
