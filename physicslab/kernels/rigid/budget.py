"""Powers of contact forces, and work of impulses, by account."""

from physicslab.kernels import Numbers, inlined
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, ENERGY, PX, book
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.equations import STICKS, UNKNOWN, Equations
from physicslab.kernels.rigid.features import RigidScene
from physicslab.kernels.rigid.joint_points import motor_rate


@inlined
def book_contacts(
    scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers, given: Numbers
) -> None:
    """Add what the forces of ``count`` points give in a second, that are measured in the state (q, v).

    Booked are friction, force times sliding speed, and momentum that comes in from bodies no force moves,
    with the work of what moves all the same. Normal forces do no work: what they hold together does not part.
    Motors do, with the speed at which they turn.
    """
    rows, contacts = scene.rows, scene.accounts[F.CONTACTS]
    points, measures = equations.points, equations.measures
    friction_work, work = 0.0, 0.0
    for i in range(count):
        along, across = equations.vectors[UNKNOWN, 2 * i], equations.vectors[UNKNOWN, 2 * i + 1]
        account = contacts
        if points[i, F.FEATURE] >= F.JOINT:
            account = scene.accounts[F.JOINED]
            if points[i, F.FEATURE] == F.MOTOR:
                account = scene.accounts[F.MOTORS]
                given[account + ENERGY] += across * motor_rate(scene, points, measures, i)
        elif points[i, F.STATUS] != STICKS:
            friction_work += across * measures[i, F.VT]
        for side in range(2):
            body = points[i, F.ONE + side]
            n, t = F.NORMAL + 3 * side, F.TANGENT + 3 * side
            x, y, turning = 2 * body, 2 * body + 1, 2 * rows + body
            fx = along * measures[i, n] + across * measures[i, t]
            fy = along * measures[i, n + 1] + across * measures[i, t + 1]
            torque = along * measures[i, n + 2] + across * measures[i, t + 2]
            if scene.inverse_mass[x] > 0.0:
                book(given, account, 0.0, fx, fy, q[x] * fy - q[y] * fx)
            else:
                work -= fx * v[x] + fy * v[y]
            if scene.inverse_mass[turning] > 0.0:
                given[account + ANGULAR_MOMENTUM] += torque
            else:
                work -= torque * v[turning]
    given[scene.accounts[F.FRICTION] + ENERGY] += friction_work
    if scene.accounts[F.DRIVEN] >= 0:
        given[scene.accounts[F.DRIVEN] + ENERGY] += work


@inlined
def book_row(
    scene: RigidScene, equations: Equations, i: int, q: Numbers, old: Numbers, v: Numbers, late: float,
    acceleration: Numbers, account: Numbers, driven: Numbers,
) -> None:  # fmt: skip
    """Book the impulse of a row that has changed the speeds ``old`` to v: its work, and and momentum.

    Forces have acted for ``late`` seconds beyond its moment.
    """
    points, measures = equations.points, equations.measures
    along, across = equations.vectors[UNKNOWN, 2 * i], equations.vectors[UNKNOWN, 2 * i + 1]
    for side in range(2):
        body, n, t = points[i, F.ONE + side], F.NORMAL + 3 * side, F.TANGENT + 3 * side
        for k in range(3):
            place = 2 * body + k if k < 2 else 2 * scene.rows + body
            push = along * measures[i, n + k] + across * measures[i, t + k]
            work = push * (0.5 * (old[place] + v[place]) - late * acceleration[place])
            account[ENERGY] += work
            if scene.inverse_mass[place] == 0.0:
                driven[ENERGY] -= work
            elif k < 2:
                account[PX + k] += push
                account[ANGULAR_MOMENTUM] += q[2 * body] * push if k == 1 else -q[2 * body + 1] * push
            else:
                account[ANGULAR_MOMENTUM] += push


@inlined
def book_speeds(scene: RigidScene, q: Numbers, v: Numbers, sign: float) -> None:
    """Book the motion there is to contacts, with a sign: before they change speeds and after that."""
    contacts, energy, px, py, spin = scene.accounts[F.CONTACTS], 0.0, 0.0, 0.0, 0.0
    for row in range(scene.rows):
        x, y, turning = 2 * row, 2 * row + 1, 2 * scene.rows + row
        if scene.inverse_mass[x] > 0.0:
            ix, iy = v[x] / scene.inverse_mass[x], v[y] / scene.inverse_mass[y]
            energy += 0.5 * (ix * v[x] + iy * v[y])
            px += ix
            py += iy
            spin += q[x] * iy - q[y] * ix
        if scene.inverse_mass[turning] > 0.0:
            momentum = v[turning] / scene.inverse_mass[turning]
            energy += 0.5 * momentum * v[turning]
            spin += momentum
    book(v, contacts, sign * energy, sign * px, sign * py, sign * spin)
