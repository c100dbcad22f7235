"""Points of rigid contacts, written into the records of their pairs."""

from physicslab.kernels import Numbers, Rows, Vectors, kernel
from physicslab.kernels.records import Manifolds
from physicslab.kernels.records import Points as PointRecords
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.features import Points


@kernel
def write_points(
    points: Points, measures: Vectors, forces: Numbers, number: Rows, span: float, position: Vectors,
    manifolds: Manifolds, records: PointRecords, touching: Rows,
) -> int:  # fmt: skip
    """Write points into the records of the pairs of some ``number`` (n,), -1 for none; two a pair at most.

    ``forces`` act for ``span`` seconds in a substep of soft contacts. The pairs that have points are put into
    ``touching``; returns how many these are.
    """
    active = 0
    for i in range(len(number)):
        p = number[i]
        if p < 0 or manifolds[p].count == 2:
            continue
        manifold = manifolds[p]
        a, b, k = manifold.a, manifold.b, manifold.count
        if k == 0:
            touching[active] = p
            active += 1
        sign = 1.0 if points[i, F.ONE] == a else -1.0
        manifold.count = k + 1
        manifold.normal_x, manifold.normal_y = 0.0 + sign * measures[i, F.NX], 0.0 + sign * measures[i, F.NY]
        manifold.friction, manifold.restitution = measures[i, F.MU], measures[i, F.RESTITUTION]
        record = records[2 * p + k]
        x, y = measures[i, F.PX], measures[i, F.PY]
        record.arm_ax, record.arm_ay = x - position[a, 0], y - position[a, 1]
        record.arm_bx, record.arm_by = x - position[b, 0], y - position[b, 1]
        record.separation = measures[i, F.GAP]
        record.normal_impulse = forces[2 * i] * span
        record.tangent_impulse = forces[2 * i + 1] * span
    return active
