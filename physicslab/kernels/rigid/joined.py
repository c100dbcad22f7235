"""Joints beside rigid contacts: what the forces of points cause where joints hold bodies together.

A force at a point moves bodies by P J_c^T, with P = M^-1 - M^-1 J^T (J M^-1 J^T)^-1 J M^-1 of the rows of
joints in place of M^-1: joints answer in the same moment, impulses at once. So the laws of contacts hold
as they are, and a joint is a pair of rows that are always kept, without a cone. The rows are packed as
for smooth motion (:mod:`physicslab.kernels.joints.rows`), whose force is part of all others.
"""

from physicslab.kernels import Numbers, Vectors, inlined, kernel
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, ENERGY, HAND, JOINTS, MOTORS, PX, PY
from physicslab.kernels.joints import layout as L
from physicslab.kernels.joints.envelope import factorise, solve
from physicslab.kernels.joints.rows import book_rows, given_by_rows, measure_rows, push_by_rows
from physicslab.kernels.joints.terms import HOLD, MOTOR
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.budget import book_contacts
from physicslab.kernels.rigid.equations import UNKNOWN, Equations
from physicslab.kernels.rigid.features import Points, RigidScene, SceneTuple, named_scene

_IMMOVABLE = 1e-12
"""Share of what a force causes alone below which joints leave nothing of it."""


@inlined
def measure_joints(scene: RigidScene, q: Numbers, v: Numbers) -> None:
    """Find the gradients of all rows in a state, and factorise their equations."""
    measure_rows(q, v, scene.joint_numbers, scene.joints)
    factorise(scene.joint_numbers, scene.joints)


@inlined
def _at_row(scene: RigidScene, points: Points, measures: Vectors, i: int, r: int) -> tuple[float, float]:
    """Return how unit forces at point i, along its normal and its tangent, accelerate row r of joints."""
    along, across, states = 0.0, 0.0, L.first_state(scene.joints)
    for side in range(2):
        body = points[i, F.ONE + side]
        mass, inertia = scene.inverse_mass[2 * body], scene.inverse_mass[2 * scene.rows + body]
        n, t = F.NORMAL + 3 * side, F.TANGENT + 3 * side
        for end in range(L.ENDS):
            if scene.joints[L.FIRST + L.PLACES * r + 2 * end] != 2 * body:
                continue
            j = states + L.STATE * r + 3 * end
            jx, jy = scene.joint_numbers[j], scene.joint_numbers[j + 1]
            turn = inertia * scene.joint_numbers[j + 2]
            along += mass * (jx * measures[i, n] + jy * measures[i, n + 1]) + turn * measures[i, n + 2]
            across += mass * (jx * measures[i, t] + jy * measures[i, t + 1]) + turn * measures[i, t + 2]
    return along, across


@inlined
def lessen(scene: RigidScene, equations: Equations, count: int) -> None:
    """Take from what unit forces cause at ``count`` points, ``equations.a``, what joints hold back.

    A force that joints answer in full moves nothing, and is left as if by itself: nothing presses there.
    """
    points, measures, a = equations.points, equations.measures, equations.a
    n, states = scene.joints[L.ROWS], L.first_state(scene.joints)
    for column in range(2 * count):
        for r in range(n):
            along, across = _at_row(scene, points, measures, column // 2, r)
            scene.joint_numbers[states + L.STATE * r + L.RIGHT] = along if column % 2 == 0 else across
        solve(scene.joint_numbers, scene.joints)
        own = a[column, column]
        for row in range(column, 2 * count):
            held = 0.0
            for r in range(n):
                along, across = _at_row(scene, points, measures, row // 2, r)
                answered = scene.joint_numbers[states + L.STATE * r + L.LAMBDA]
                held += answered * (along if row % 2 == 0 else across)
            a[row, column] -= held
            a[column, row] = a[row, column]
        if a[column, column] <= _IMMOVABLE * own:
            for row in range(2 * count):
                a[row, column] = a[column, row] = 0.0
            a[column, column] = own


@inlined
def answer(scene: RigidScene, points: Points, measures: Vectors, forces: Numbers, count: int) -> None:
    """Find the forces with which joints answer the ``forces`` (2 count,) of points."""
    states = L.first_state(scene.joints)
    for r in range(scene.joints[L.ROWS]):
        total = 0.0
        for i in range(count):
            along, across = _at_row(scene, points, measures, i, r)
            total -= forces[2 * i] * along + forces[2 * i + 1] * across
        scene.joint_numbers[states + L.STATE * r + L.RIGHT] = total
    solve(scene.joint_numbers, scene.joints)


@inlined
def pass_on(scene: RigidScene, equations: Equations, which: int, count: int, target: Numbers) -> None:
    """Add to velocities or accelerations what joints answer to the forces ``which`` of points."""
    answer(scene, equations.points, equations.measures, equations.vectors[which], count)
    push_by_rows(target, scene.joint_numbers, scene.joints)


@inlined
def book_forces(
    scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers, given: Numbers
) -> None:
    """Add what the forces of points give in a second in (q, v), and joints that answer them."""
    book_contacts(scene, equations, count, q, v, given)
    if scene.joints[L.ROWS] > 0:
        answer(scene, equations.points, equations.measures, equations.vectors[UNKNOWN], count)
        book_rows(q, v, given, scene.joint_numbers, scene.joints)


@inlined
def book_impulses(
    scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers, account: Vectors
) -> None:
    """Book what joints give as they answer the impulses at points, at a moment."""
    answer(scene, equations.points, equations.measures, equations.vectors[UNKNOWN], count)
    for role in (HOLD, MOTOR):
        cause = JOINTS if role == HOLD else MOTORS
        power, px, py, spin, driven = given_by_rows(q, v, scene.joint_numbers, scene.joints, role)
        account[cause, ENERGY] += power if role == MOTOR else 0.0
        account[cause, PX] += px
        account[cause, PY] += py
        account[cause, ANGULAR_MOMENTUM] += spin
        account[HAND, ENERGY] -= driven


@inlined
def strongest_joint(scene: RigidScene) -> float:
    """Return the largest acceleration that the force of a row gives to a body by itself [m/s^2]."""
    strongest, states = 0.0, L.first_state(scene.joints)
    for r in range(scene.joints[L.ROWS]):
        force = abs(scene.joint_numbers[states + L.STATE * r + L.LAMBDA])
        for end in range(L.ENDS):
            place = scene.joints[L.FIRST + L.PLACES * r + 2 * end]
            if place < 0:
                break
            strongest = max(strongest, scene.inverse_mass[place] * force)
    return strongest


@kernel
def find_answer(
    scene: SceneTuple, points: Points, measures: Vectors, forces: Numbers, count: int, q: Numbers, v: Numbers
) -> None:
    """Find the forces with which joints answer those of points in a state (:func:`answer`)."""
    of = named_scene(scene)
    measure_joints(of, q, v)
    answer(of, points, measures, forces, count)
