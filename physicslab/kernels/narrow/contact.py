"""The narrow phase: where near pairs touch, or would within a substep."""

import math

from physicslab.kernels import Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.broad.near_pairs import ACTIVATION_RATIO
from physicslab.kernels.narrow.pair import CONTACT_MARGIN, touch_boxes, touch_wall, touch_with_circle
from physicslab.kernels.records import Manifold, Manifolds, Points

__all__ = [
    "CACHE_TOLERANCE",
    "CACHE_TURN_TOLERANCE",
    "effective_masses",
    "find_contacts",
    "follow_pose",
    "mix",
]

CACHE_TOLERANCE = 0.004
"""Share of the smaller box's size that a pair of boxes may move before its points are found again."""
CACHE_TURN_TOLERANCE = 0.002
"""How far [rad] either may turn."""


@inlined
def follow_pose(
    manifold: Manifold, points: Points, p: int, dx: float, dy: float, turn_a: float, turn_b: float
) -> None:
    """Update the separations of kept points for how far the pair has moved and turned, to second order."""
    for j in range(2 * p, 2 * p + manifold.count):
        point = points[j]
        ax = turn_a * (-point.arm_ay - 0.5 * turn_a * point.arm_ax)
        ay = turn_a * (point.arm_ax - 0.5 * turn_a * point.arm_ay)
        bx = turn_b * (-point.arm_by - 0.5 * turn_b * point.arm_bx)
        by = turn_b * (point.arm_bx - 0.5 * turn_b * point.arm_by)
        along = (dx + bx - ax) * manifold.normal_x + (dy + by - ay) * manifold.normal_y
        point.separation = point.found_separation + along


@inlined
def effective_masses(
    manifold: Manifold, points: Points, p: int, inverse_mass: Numbers, inverse_inertia: Numbers
) -> None:
    """Compute 1 / (1/m_a + 1/m_b + (r_a x n)^2 / I_a + (r_b x n)^2 / I_b), for normal and tangent."""
    a, b = manifold.a, manifold.b
    nx, ny = manifold.normal_x, manifold.normal_y
    linear = inverse_mass[a] + inverse_mass[b]
    for j in range(2 * p, 2 * p + manifold.count):
        point = points[j]
        turn_a, turn_b = point.arm_ax * ny - point.arm_ay * nx, point.arm_bx * ny - point.arm_by * nx
        point.normal_mass = 1.0 / (
            linear + inverse_inertia[a] * turn_a * turn_a + inverse_inertia[b] * turn_b * turn_b
        )
        turn_a, turn_b = point.arm_ax * nx + point.arm_ay * ny, point.arm_bx * nx + point.arm_by * ny
        point.tangent_mass = 1.0 / (
            linear + inverse_inertia[a] * turn_a * turn_a + inverse_inertia[b] * turn_b * turn_b
        )


@kernel
def find_contacts(
    manifolds: Manifolds,
    points: Points,
    scalar: Rows,
    count: int,
    touching: Rows,
    position: Vectors,
    angle: Numbers,
    linear: Vectors,
    angular: Numbers,
    kind: Rows,
    radius: Numbers,
    width: Numbers,
    height: Numbers,
    restitution: Numbers,
    friction: Numbers,
    inverse_mass: Numbers,
    inverse_inertia: Numbers,
    bounds: Numbers,
    bounds_restitution: float,
    bounds_friction: float,
    first: bool,
    h: float,
    start: float,
    speculative_margin: float,
) -> int:
    """Find or refresh the contact points of the near pairs that are ``scalar``; return how many have any.

    Their numbers are written to ``touching``, in order. A pair of boxes that has hardly moved keeps its
    points. The substep spans ``h`` seconds from ``start`` h before or after now: a pair that meets within it
    has points with the normal of that moment and the separation, along it, of now. Pairs whose count is
    negative are moved by event-driven stepping, and passed over. ``first`` marks the first substep of a
    step, in which records of impacts are cleared; ``speculative_margin`` is how far [m] the forces may bring
    two bodies together within the substep.
    """
    found, held = 0, count
    for number in range(count):
        p = scalar[number]
        manifold = manifolds[p]
        if manifold.count < 0:
            continue
        a, b = manifold.a, manifold.b
        one, two = points[2 * p], points[2 * p + 1]
        if first and manifold.impact_count > 0:
            manifold.impact_count = 0
            one.approach_speed = one.impact_normal = one.impact_tangent = 0.0
            two.approach_speed = two.impact_normal = two.impact_tangent = 0.0
        dx, dy = position[b, 0] - position[a, 0], position[b, 1] - position[a, 1]
        ux, uy = (linear[b, 0] - linear[a, 0]) * h, (linear[b, 1] - linear[a, 1]) * h
        a_box, b_box = kind[a] == 2, kind[b] == 2
        had_points = manifold.count > 0
        if not (a_box or b_box or had_points or manifold.wall >= 0):
            # Most near circles are too far apart for this substep: skip those without a call.
            reach = ACTIVATION_RATIO * (radius[a] + radius[b]) + abs(ux) + abs(uy) + speculative_margin
            if dx * dx + dy * dy > reach * reach:
                continue
        elif manifold.wall >= 0 and not (b_box or had_points):
            # The same for circles near the bounds.
            away = position[b, manifold.wall % 2] - bounds[manifold.wall]
            clear = (away if manifold.wall < 2 else -away) - radius[b]
            if clear > ACTIVATION_RATIO * CONTACT_MARGIN * radius[b] + abs(ux) + abs(uy) + speculative_margin:
                continue
        manifold.offset_x, manifold.offset_y = dx, dy
        if (a_box and b_box) or (manifold.wall >= 0 and b_box):
            size = min(width[b], height[b])
            sizes = width[b] + 2.0 * height[b]
            if a_box:
                size = min(size, min(width[a], height[a]))
                sizes += 3.0 * width[a] + 5.0 * height[a]
            moved_x, moved_y = dx - manifold.base_x, dy - manifold.base_y
            turn_a, turn_b = angle[a] - manifold.base_angle_a, angle[b] - manifold.base_angle_b
            travel = abs(ux) + abs(uy)
            known = manifold.found == 2 and manifold.base_sizes == sizes
            if known and not had_points:
                # A lower bound of their gap now, however they have moved since.
                turned = abs(turn_a) * (width[a] + height[a]) + abs(turn_b) * (width[b] + height[b])
                nearest = manifold.gap - abs(moved_x) - abs(moved_y) - 0.5 * turned - 0.0025 * size
                if nearest > CONTACT_MARGIN * size + travel + speculative_margin:
                    continue
            if (
                known
                and had_points
                and abs(moved_x) + abs(moved_y) <= CACHE_TOLERANCE * size
                and abs(turn_a) <= CACHE_TURN_TOLERANCE
                and abs(turn_b) <= CACHE_TURN_TOLERANCE
                and travel <= 0.5 * CONTACT_MARGIN * size
            ):
                follow_pose(manifold, points, p, moved_x, moved_y, turn_a, turn_b)
                if inverse_mass[a] > 0.0 and inverse_mass[b] > 0.0:
                    touching[found] = p
                    found += 1
                else:
                    held -= 1
                    touching[held] = p
                if first:
                    effective_masses(manifold, points, p, inverse_mass, inverse_inertia)
                    mix(manifold, a, b, restitution, friction, bounds_restitution, bounds_friction)
                continue
            manifold.base_x, manifold.base_y = dx, dy
            manifold.base_angle_a, manifold.base_angle_b = angle[a], angle[b]
            manifold.base_sizes = sizes
            manifold.found = 2 if travel <= 0.5 * CONTACT_MARGIN * size else 1
        cb, sb = (math.cos(angle[b]), math.sin(angle[b])) if b_box else (1.0, 0.0)
        half_bx, half_by = 0.5 * width[b], 0.5 * height[b]
        if manifold.wall >= 0:
            spin = abs(angular[b]) * h * math.sqrt(half_bx * half_bx + half_by * half_by)
            touch_wall(
                manifold, one, two, position[b, 0], position[b, 1], ux, uy, spin, speculative_margin, b_box,
                cb, sb,
                half_bx, half_by, radius[b], bounds,
            )  # fmt: skip
        else:
            ca, sa = (math.cos(angle[a]), math.sin(angle[a])) if a_box else (1.0, 0.0)
            half_ax, half_ay = 0.5 * width[a], 0.5 * height[a]
            if a_box and b_box:
                touch_boxes(
                    manifold,
                    one,
                    two,
                    dx,
                    dy,
                    ux,
                    uy,
                    start,
                    speculative_margin,
                    ca,
                    sa,
                    half_ax,
                    half_ay,
                    cb,
                    sb,
                    half_bx,
                    half_by,
                )
            else:
                touch_with_circle(
                    manifold, one, dx, dy, ux, uy, start, speculative_margin, a_box, ca, sa, half_ax,
                    half_ay, radius[a],
                    b_box, cb, sb, half_bx, half_by, radius[b],
                )  # fmt: skip
        if manifold.count > 0:
            effective_masses(manifold, points, p, inverse_mass, inverse_inertia)
            if first or not had_points:
                mix(manifold, a, b, restitution, friction, bounds_restitution, bounds_friction)
            if inverse_mass[a] > 0.0 and inverse_mass[b] > 0.0:
                touching[found] = p
                found += 1
            else:
                held -= 1
                touching[held] = p
        elif had_points:
            one.feature = two.feature = 0
            one.normal_impulse = two.normal_impulse = one.tangent_impulse = two.tangent_impulse = 0.0
    # Pairs with fixed bodies were written from the end, the last first.
    at_end = count - held
    for k in range(at_end // 2):
        touching[held + k], touching[count - 1 - k] = touching[count - 1 - k], touching[held + k]
    for k in range(at_end):
        touching[found + k] = touching[held + k]
    return found + at_end


@inlined
def mix(
    manifold: Manifold,
    a: int,
    b: int,
    restitution: Numbers,
    friction: Numbers,
    bounds_restitution: float,
    bounds_friction: float,
) -> None:
    """Combine the materials of a pair: e = min, mu = the geometric mean."""
    walled = manifold.wall >= 0
    manifold.restitution = min(bounds_restitution if walled else restitution[a], restitution[b])
    manifold.friction = math.sqrt((bounds_friction if walled else friction[a]) * friction[b])
