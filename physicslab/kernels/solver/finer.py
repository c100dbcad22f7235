"""How many times as many substeps a world needs: for heavy loads on light bodies, and for links that whip.

A contact sinks in by F h^2 / (m k), with the effective mass m of its pair and the stiffness k of contacts. A
body that turns by w h in a substep leaves the straight way of an anchor at r by r (w h)^2 / 2. Both are to be
small shares, of the smaller body and of the joint's longer arm, and shrink with h^2. Where contacts are few,
and solved nearly to the end, a heavy body is to move a light one as a converged solution would: its load is
then compared with that of the light body, before the impulses have grown to it.
"""

import math

from physicslab.kernels import Numbers, Plain, Vectors, inlined, kernel
from physicslab.kernels import wide_layout as L
from physicslab.kernels.arguments import Inverse, Motion, Near, Plan, Softness, named_near
from physicslab.kernels.geometry.shapes import Shapes, ShapesTuple, half_extents, named_shapes
from physicslab.kernels.joints.blocks import ENDS, FIRST, TERM, TERMS, Joints
from physicslab.kernels.length import length_of
from physicslab.kernels.near_counts import ACTIVE, DISC_BLOCKS, RECORDED, WIDE_COUNT
from physicslab.kernels.records import Manifold
from physicslab.kernels.solver.impulse import (
    HEAVY_RATIO,
    LOADED_SWEEPS,
    MAX_SUBSTEP_FACTOR,
    MAX_SWEEPS,
    stiffened,
    sweeps_of,
)

SUNK = 0.1
"""Share of the smaller body by which a load may press it in: half of what there is a warning from."""
UNLIMITED = 1e30
"""Share of its size by which a body may be pressed in where that has no limit."""
_HARDER, _STIFFER = 0.01, 8.0
"""Share of the contacts of a crowd that may be pressed harder than its substeps would hold, and how many
times as hard."""
_LIGHT_LOAD, _HARDLY_SUNK = 12.0, 1e-3
"""Multiple of its own load that a body carries where few contacts are swept most often, and the share of its
size by which the load may press it in whatever that multiple is, as where its own load is next to nothing."""
_THROUGH_ONE = 1.0 / 3.0
"""Share of a heavy body's weight that is taken to press on each light one that joints hold at it: not all of
it goes through a hand that lies on the floor."""
_LEFT = 5e-4
"""Share of its arm by which an anchor may leave its way in a substep, in blocks of unequal masses. A heap of
six ragdolls, started six times 1e-6 apart, comes apart by 16 mm each time; with 1e-3 by 16 to 25 mm."""


@inlined
def _press_of_slot(slots: L.Slots, i: int) -> float:
    """Return the impulse of a slot over its effective mass and the size of its smaller body [1/s]."""
    data = slots.data
    impulse = data[i + L.ONE + L.IMPULSE]
    if slots.kind == L.BOX:
        impulse += data[i + L.TWO + L.IMPULSE]
    press: float = impulse * (data[i + L.MASS_A] + data[i + L.MASS_B]) / data[i + L.SIZE]
    return press


@inlined
def _press_of(near: Near, p: int, inverse_mass: Numbers) -> float:
    """Return the same of a scalar pair."""
    manifold, impulse = near.manifolds[p], 0.0
    for j in range(2 * p, 2 * p + manifold.count):
        impulse += near.points[j].normal_impulse
    press: float = impulse * (inverse_mass[manifold.a] + inverse_mass[manifold.b]) / manifold.size
    return press


@inlined
def _count(pressed: tuple[int, float], press: float, allowed: float) -> tuple[int, float]:
    """Return how many contacts are pressed harder than allowed, and the hardest, with one more."""
    return pressed[0] + (1 if press > allowed else 0), max(pressed[1], press)


@inlined
def _pressed(near: Near, inverse_mass: Numbers, allowed: float) -> tuple[int, float]:
    """Return how many contacts are pressed harder than ``allowed`` [1/s], and how hard the hardest is."""
    found = 0, 0.0
    for k in range(near.counts[ACTIVE]):
        found = _count(found, _press_of(near, near.touching[k], inverse_mass), allowed)
    for slots in (near.discs, near.boxes):
        rows = L.rows_of(slots.kind)
        for k in range(near.counts[DISC_BLOCKS + slots.kind]):
            for i in range(k * rows, k * rows + L.WIDE):
                found = _count(found, _press_of_slot(slots, i), allowed)
    return found


@inlined
def _normal_of(near: Near, manifold: Manifold) -> tuple[float, float]:
    """Return the normal of a pair now: a slot's is newer than that of the record."""
    if manifold.slot < 0:
        return manifold.normal_x, manifold.normal_y
    kind, slot = manifold.slot % 2, manifold.slot // 2
    data = near.discs.data if kind == L.DISC else near.boxes.data
    at = slot // L.WIDE * L.rows_of(kind) + slot % L.WIDE
    return data[at + L.NORMAL_X], data[at + L.NORMAL_Y]


@inlined
def _hold(held: Vectors, manifold: Manifold, nx: float, ny: float, force: Vectors, weak: float) -> None:
    """Add how hard each body of a pair holds the other, of an effective mass of one over ``weak``."""
    a, b = manifold.a, manifold.b
    if weak > 0.0:
        forwards = force[a, 0] * nx + force[a, 1] * ny
        backwards = -force[b, 0] * nx - force[b, 1] * ny
        held[a, 0] += max(0.0, forwards) / weak
        held[b, 0] += max(0.0, backwards) / weak


@inlined
def _heaviest_load(near: Near, inverse_mass: Numbers, force: Vectors, sunk: float) -> float:
    """Return the largest ratio of the load on a body by a far heavier one to its own weight.

    By the present forces on both: a heavy body beside or below a light one is no load. All bodies that hold a
    heavy one share its load as springs do, by their effective masses. Weight is by the larger acceleration of
    the two. ``sunk`` is how far an acceleration presses bodies in [s^2].
    """
    largest, held = 0.0, near.linear_before  # nothing is noted in it at the end of a step
    for i in range(len(held)):
        held[i, 0] = 0.0
    for shared in (False, True):
        for p in range(near.counts[RECORDED]):
            manifold = near.manifolds[p]
            if manifold.count <= 0:
                continue
            heavy, light, sign = manifold.a, manifold.b, 1.0
            if inverse_mass[heavy] > inverse_mass[light]:
                heavy, light, sign = light, heavy, -1.0
            x, y, weak = force[heavy, 0], force[heavy, 1], inverse_mass[heavy] + inverse_mass[light]
            nx, ny = _normal_of(near, manifold)
            press = sign * (x * nx + y * ny)
            if not shared:
                _hold(held, manifold, nx, ny, force, weak)
            elif press > 0.0 and inverse_mass[light] > HEAVY_RATIO * inverse_mass[heavy] > 0.0:
                press *= press / weak / held[heavy, 0]
                if press * weak * sunk > _HARDLY_SUNK * manifold.size:
                    own = length_of(force[light, 0], force[light, 1])
                    own = max(own, length_of(x, y) * inverse_mass[heavy] / inverse_mass[light])
                    largest = max(largest, press / own)
    return largest


@inlined
def _is_near_another(body: int, motion: Motion, shapes: Shapes, block: Vectors, dt: float) -> bool:
    """Whether the box around a body may meet that around one of another block in two steps, as they move.

    By places alone, and not by listed pairs: when these were listed must change nothing.
    """
    half_x, half_y = half_extents(shapes, body, motion.angle[body])
    half_x, half_y = half_x + shapes.thin[body], half_y + shapes.thin[body]
    for other in range(len(motion.angle)):
        if shapes.vertices[other] != 0 and block[other, 0] != block[body, 0]:
            x = abs(motion.position[other, 0] - motion.position[body, 0]) - half_x
            y = abs(motion.position[other, 1] - motion.position[body, 1]) - half_y
            x -= 2.0 * dt * abs(motion.linear[other, 0] - motion.linear[body, 0])
            y -= 2.0 * dt * abs(motion.linear[other, 1] - motion.linear[body, 1])
            reach = shapes.reach[other]
            if x <= reach and y <= reach:
                other_x, other_y = half_extents(shapes, other, motion.angle[other])
                if x <= other_x and y <= other_y:
                    return True
    return False


@inlined
def _carried_load(
    near: Near, joints: Joints, motion: Motion, shapes: Shapes, inverse_mass: Numbers, force: Vectors,
    sunk: float, dt: float, borne: float,
) -> float:  # fmt: skip
    """Return the same for a far heavier body that joints hold at a light one which is near something.

    A share of the weight of the heaviest body of a block is taken to press on each of its light ones, and
    before they touch too: with substeps that become short only then, what has landed jumps up again. Loads
    up to ``borne`` are not looked for.
    """
    largest, heaviest, label = borne, near.angular_before, near.linear_before
    for i in range(len(heaviest)):  # nothing is noted in these at the end of a step
        heaviest[i], label[i, 0] = -1.0, 0.0
    for block in range(len(joints.groups) - 1):
        first, end = joints.groups[block, FIRST], joints.groups[block + 1, FIRST]
        body, least = -1, math.inf
        for e in range(joints.nodes[first, ENDS], joints.nodes[end, ENDS]):
            inverse = inverse_mass[joints.body[e]]
            if inverse > 0.0:
                label[joints.body[e], 0] = 1.0 + block
                if inverse < least:
                    body, least = joints.body[e], inverse
        for e in range(joints.nodes[first, ENDS], joints.nodes[end, ENDS]):
            if inverse_mass[joints.body[e]] > HEAVY_RATIO * least:
                heaviest[joints.body[e]] = body
    for light in range(len(heaviest)):
        heavy = int(heaviest[light])
        if heavy >= 0 and shapes.vertices[light] != 0:
            press = length_of(force[heavy, 0], force[heavy, 1])
            if press * inverse_mass[light] * sunk > _HARDLY_SUNK * 2.0 * shapes.thin[light]:
                own = length_of(force[light, 0], force[light, 1])
                own = max(own, press * inverse_mass[heavy] / inverse_mass[light])
                load = _THROUGH_ONE * press / own
                if load > largest and _is_near_another(light, motion, shapes, label, dt):
                    largest = load
    return largest


@inlined
def _fastest_whip(joints: Joints, angular: Numbers, inverse_mass: Numbers) -> float:
    """Return the largest r w^2 / R [1/s^2] of bodies that turn by w about an anchor at r.

    R is the longer of the two arms of the joint. Blocks whose masses do not differ much are left out.
    """
    largest = 0.0
    nodes, terms, body = joints.nodes, joints.terms, joints.body
    for block in range(len(joints.groups) - 1):
        first, end = joints.groups[block, FIRST], joints.groups[block + 1, FIRST]
        lightest, heaviest = 0.0, math.inf
        for e in range(nodes[first, ENDS], nodes[end, ENDS]):
            inverse = inverse_mass[body[e]]
            if inverse > 0.0:
                lightest, heaviest = max(lightest, inverse), min(heaviest, inverse)
        if lightest <= HEAVY_RATIO * heaviest:
            continue
        for t in range(nodes[first, TERMS], nodes[end, TERMS]):
            n = terms[t, TERM]
            a, b = angular[joints.a[n]], angular[joints.b[n]]
            arm_a = length_of(joints.anchor_a[n, 0], joints.anchor_a[n, 1])
            arm_b = length_of(joints.anchor_b[n, 0], joints.anchor_b[n, 1])
            arm = max(arm_a, arm_b)
            if arm > 0.0:
                largest = max(largest, (arm_a * a * a + arm_b * b * b) / arm)
    return largest


@inlined
def _times_too_hard(near: Near, inverse_mass: Numbers, allowed: float, crowd: bool) -> float:
    """Return how many times as hard as ``allowed`` [1/s] contacts are pressed.

    It is the hardest of a few; in a ``crowd``, all but :data:`_HARDER` of them: their springs
    are as stiff as their load needs, up to :data:`_STIFFER` times.
    """
    number, over, hardest = near.counts[ACTIVE] + near.counts[WIDE_COUNT], 0.5, 0.0
    left, count = _HARDER * number if crowd else 0.0, number
    while count > left and over < MAX_SUBSTEP_FACTOR * MAX_SUBSTEP_FACTOR:
        over *= 2.0
        count, hardest = _pressed(near, inverse_mass, over * allowed)
    return max(min(over, hardest / allowed), hardest / allowed / _STIFFER)


@inlined
def factor_for(
    near: Near, joints: Joints, motion: Motion, shapes: Shapes, inverse: Inverse, force: Vectors, plan: Plan,
    softness: Softness, impulse_dt: float,
) -> int:  # fmt: skip
    """Return the factor for the next step, by the impulses of the last substep and the present speeds.

    It is 1, 2, 3, 4, 6, 8 or the largest, which is for loads that longer substeps would not carry at all.
    """
    h, rows, over = plan.own_h, len(joints.impulse), 0.0
    sweeps, sunk = sweeps_of(near, rows, plan.iterations, True), h * h / (softness.push * softness.stiffness)
    if impulse_dt > 0.0:
        crowd = sweeps <= LOADED_SWEEPS
        allowed = impulse_dt * SUNK / sunk * (stiffened(sweeps) if crowd else 1.0)
        over = _times_too_hard(near, inverse.mass, allowed, crowd)
    if sweeps > LOADED_SWEEPS:
        settled = sweeps / MAX_SWEEPS
        load = _heaviest_load(near, inverse.mass, force, sunk)
        if rows > 0:
            borne = max(load, _LIGHT_LOAD / (settled * settled))
            load = _carried_load(near, joints, motion, shapes, inverse.mass, force, sunk, plan.dt, borne)
        over = max(over, load * settled * settled / _LIGHT_LOAD)
    if rows > 0:
        over = max(over, 0.5 * _fastest_whip(joints, motion.angular, inverse.mass) * h * h / _LEFT)
    factor, last = 1, 1
    while factor < MAX_SUBSTEP_FACTOR and factor * factor < over:
        factor, last = factor + 1 if factor < 4 else 2 * last, factor  # 1, 2, 3, 4, 6, 8
        factor = MAX_SUBSTEP_FACTOR if factor > 8 else factor  # what is heaviest gets all there are
    return factor


@kernel
def needed_factor(
    near: Plain[Near], joints: Plain[Joints], motion: Plain[Motion], shapes: ShapesTuple,
    inverse: Plain[Inverse], force: Vectors, plan: Plain[Plan], softness: Plain[Softness], impulse_dt: float,
) -> int:  # fmt: skip
    """Return the factor for the next step (:func:`factor_for`)."""
    return factor_for(
        named_near(near), Joints(*joints), Motion(*motion), named_shapes(shapes), Inverse(*inverse), force,
        Plan(*plan), Softness(*softness), impulse_dt,
    )  # fmt: skip
