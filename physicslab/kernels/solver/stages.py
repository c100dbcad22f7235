"""The stages of a substep at contacts: all of them are called by the fused loop of whole steps.

Systems call them one by one through :mod:`physicslab.kernels.solver.entries`.
"""

from physicslab.kernels import Numbers, Rows, fused, inlined
from physicslab.kernels.broad.near_pairs import activate, sort_scalar
from physicslab.kernels.narrow.contact import CACHE_TOLERANCE, CACHE_TURN_TOLERANCE, find_contacts
from physicslab.kernels.narrow.pair import CONTACT_MARGIN, SWEEP_THRESHOLD
from physicslab.kernels.solver import impulse
from physicslab.kernels.solver.arguments import (
    Acting,
    Bounds,
    Inverse,
    Log,
    Materials,
    Motion,
    Near,
    Sizes,
    Softness,
)
from physicslab.kernels.solver.impact import resolve_impacts
from physicslab.kernels.solver.impulse import MAX_SUBSTEP_FACTOR
from physicslab.kernels.wide.layout import BOX, DISC
from physicslab.kernels.wide.refresh import refresh
from physicslab.kernels.wide.slots import (
    ACTIVE,
    BOX_BLOCKS,
    DISC_BLOCKS,
    LEFT,
    LOGGED,
    PROXIMITY,
    RECORDED,
    SCALAR,
    UNORDERED,
    WIDE_COUNT,
    wake,
)

__all__ = ["find_touching", "press", "relax", "resolve_all_impacts"]

Solved = tuple[Numbers, int, Rows, Rows, Rows, Numbers, int, Rows, Rows, Rows]
"""Blocks of discs and of boxes: data, how many, their order, rows of A and B."""


@inlined
def find_touching(
    near: Near, motion: Motion, sizes: Sizes, materials: Materials, inverse: Inverse, bounds: Bounds,
    first: bool, h: float, start: float, speculative_margin: float,
) -> None:  # fmt: skip
    """Find where wide contacts touch now, activate proximity pairs, then find where scalar ones touch.

    The substep spans ``h`` seconds from ``start`` h before or after now. ``first`` marks the first substep of
    a step; ``speculative_margin`` is how far [m] the forces may bring two bodies together within it.
    """
    counts, manifolds, points, scalar = near.counts, near.manifolds, near.points, near.scalar
    if counts[WIDE_COUNT] > 0:
        before = counts[SCALAR]
        for kind in (DISC, BOX):
            data, a, b, pair, colour, used, _ = near.discs if kind == DISC else near.boxes
            counts[SCALAR] = refresh(
                kind, data, counts[DISC_BLOCKS if kind == DISC else BOX_BLOCKS], a, b, pair, colour, used,
                manifolds, points, scalar, counts[SCALAR],
                motion.position, motion.angle, motion.linear, motion.angular, first, h,
                SWEEP_THRESHOLD, CONTACT_MARGIN, speculative_margin, CACHE_TOLERANCE, CACHE_TURN_TOLERANCE,
            )  # fmt: skip
        came = counts[SCALAR] - before
        counts[WIDE_COUNT] -= came
        if came > 0:
            counts[UNORDERED] = 1
    if counts[UNORDERED] != 0:
        sort_scalar(manifolds, scalar, counts[SCALAR], len(motion.angle))
        counts[UNORDERED] = 0
    counts[PROXIMITY], counts[RECORDED], counts[SCALAR] = activate(
        near.proximity, near.activation_distance, counts[PROXIMITY], manifolds, points, counts[RECORDED],
        scalar, counts[SCALAR], near.entities, motion.position, motion.linear, h, speculative_margin,
    )  # fmt: skip
    counts[ACTIVE] = find_contacts(
        manifolds, points, scalar, counts[SCALAR], near.touching,
        motion.position, motion.angle, motion.linear, motion.angular,
        sizes.kind, sizes.radius, sizes.width, sizes.height, materials.restitution, materials.friction,
        inverse.mass, inverse.inertia, bounds.walls, bounds.restitution, bounds.friction,
        first, h, start, speculative_margin,
    )  # fmt: skip


@inlined
def resolve_all_impacts(
    near: Near, motion: Motion, inverse: Inverse, acting: Acting, log: Log, h: float, start: float, end: float
) -> int:
    """Bounce what meets between ``start`` and ``end`` [s] from now; return how many impacts there were.

    Wide contacts that this wakes take part.
    """
    counts, impacts = near.counts, 0
    counts[LEFT] = 0
    while counts[ACTIVE] > 0:
        came, counts[LEFT] = resolve_impacts(
            near.manifolds, near.points, near.touching, counts[ACTIVE],
            motion.position, motion.angle, motion.linear, motion.angular,
            acting.force, inverse.mass, inverse.inertia, acting.any, h, start, end,
            log.impacts, counts[LOGGED], log.time,
        )  # fmt: skip
        impacts += came
        counts[LOGGED] += came if len(log.impacts) > 0 else 0
        before = counts[ACTIVE]
        if came > 0 and counts[WIDE_COUNT] > 0:
            for kind in (DISC, BOX):
                data, a, b, pair, colour, used, _ = near.discs if kind == DISC else near.boxes
                counts[SCALAR], counts[ACTIVE] = wake(
                    kind, data, counts[DISC_BLOCKS if kind == DISC else BOX_BLOCKS], a, b, pair, colour, used,
                    near.manifolds, near.points, near.scalar, counts[SCALAR], near.touching, counts[ACTIVE],
                    motion.position, motion.angle, motion.linear, motion.angular, acting.force,
                    inverse.mass, h,
                )  # fmt: skip
        if counts[ACTIVE] == before:
            break
        counts[WIDE_COUNT] -= counts[ACTIVE] - before
        counts[UNORDERED] = 1
    return impacts


@inlined
def _warm_start_scale(h: float, impulse_dt: float) -> float:
    """Return the ratio of a substep to the time over which the points' impulses act.

    It is limited: the impulses of a very short time are mostly rounding, which must not be magnified.
    """
    return h / max(impulse_dt, h / MAX_SUBSTEP_FACTOR) if impulse_dt > 0.0 else 1.0


@fused
def _solved(near: Near) -> Solved:
    """Return the arrays of the blocks that the solver takes."""
    discs, boxes = near.discs, near.boxes
    return (
        discs[0], near.counts[DISC_BLOCKS], discs[6], discs[1], discs[2],
        boxes[0], near.counts[BOX_BLOCKS], boxes[6], boxes[1], boxes[2],
    )  # fmt: skip


@inlined
def press(
    near: Near, motion: Motion, inverse: Inverse, acting: Acting, softness: Softness,
    h: float, impulse_dt: float, iterations: int,
) -> float:  # fmt: skip
    """Find the impulses that keep bodies apart and correct some of the overlap.

    ``impulse_dt`` is the time [s] over which the points' impulses act; returns the new one.
    """
    if near.counts[LEFT] + near.counts[WIDE_COUNT] == 0:
        return impulse_dt
    impulse.solve(
        near.manifolds, near.points, near.touching, near.counts[ACTIVE], *_solved(near),
        motion.linear, motion.angular, inverse.mass, inverse.inertia, acting.force, acting.any,
        h, _warm_start_scale(h, impulse_dt), iterations,
        softness.hertz, softness.damping_ratio, softness.slop,
    )  # fmt: skip
    return h


@inlined
def relax(
    near: Near, motion: Motion, inverse: Inverse, softness: Softness, h: float, iterations: int
) -> None:
    """Remove the velocity that came from correcting overlap, ``h`` seconds after :func:`press`."""
    if near.counts[LEFT] + near.counts[WIDE_COUNT] == 0:
        return
    impulse.relax(
        near.manifolds, near.points, near.touching, near.counts[ACTIVE], *_solved(near),
        motion.linear, motion.angular, inverse.mass, inverse.inertia, h, iterations,
    )  # fmt: skip
    impulse.separate(
        near.manifolds, near.points, near.touching, near.counts[ACTIVE],
        motion.position, inverse.mass, softness.max_push * h,
    )  # fmt: skip
