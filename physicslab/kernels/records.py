"""The layout of contact data, in SI units and the world's directions."""

from typing import Annotated, Any

import numpy as np
from numba import from_dtype, int64, uint32
from numpy.typing import NDArray


def _floats(*names: str) -> list[tuple[str, type[np.float64]]]:
    return [(name, np.float64) for name in names]


MANIFOLD = np.dtype(
    [
        ("entity_a", np.int64),  # 0 is the world's bounds
        ("entity_b", np.int64),
        ("wall", np.int64),  # which of the bounds (0 left, 1 bottom, 2 right, 3 top), -1 for a pair of bodies
        ("a", np.int64),  # rows
        ("b", np.int64),
        # Points in use; negative for a pair in event-driven motion, which the contact step skips.
        ("count", np.int64),
        *_floats("normal_x", "normal_y"),  # unit, from A to B
        *_floats("friction", "restitution"),
        *_floats("offset_x", "offset_y"),  # from A's centre to B's when the separations were measured
        # The relative pose for which the points were found: while it hardly changes, they are kept.
        ("found", np.int64),  # 2: good to keep; 3: of a pair with a disc, good in this very pose
        *_floats("base_x", "base_y", "base_angle_a", "base_angle_b"),
        ("gap", np.float64),  # of boxes in that pose, where they had no points: they have none while it lasts
        ("base_sizes", np.float64),  # of both boxes, mixed into one number
        ("impact_count", np.int64),  # impacts of this step
        # 1 where the normal is that of the moment within this substep at which they meet, 2 where they are
        # known not to meet within it, 0 where normal and separation are those of now.
        ("swept", np.int64),
        ("size", np.float64),  # of the smaller body
        ("slot", np.int64),  # twice the number of its slot, plus the kind of block; -1 for a scalar pair
    ]
)
"""A pair that the broad phase found near each other, and where it touches."""

POINT = np.dtype(
    [
        ("feature", np.int64),  # which corner or face the point belongs to: matches points from step to step
        *_floats("arm_ax", "arm_ay", "arm_bx", "arm_by"),  # from the centres of A and of B to the point
        ("found_separation", np.float64),  # in the base pose
        ("separation", np.float64),  # now; negative where they overlap
        # 1 where it approaches fast and meets after this substep: an impact of the next one.
        ("ahead", np.int64),
        *_floats("normal_mass", "tangent_mass"),  # effective masses
        *_floats("normal_impulse", "tangent_impulse"),  # in one substep, kept for warm starting
        ("approach_speed", np.float64),  # before the impact of this step, 0 if there was none
        *_floats("impact_normal", "impact_tangent"),  # impulses of the impacts of this step
        # On a round bend of a chain, how fast the normal that was found turns away from the point in half a
        # substep [m/s]: what slides along leaves it with this speed, and comes to the next one with it.
        ("bend", np.float64),
    ]
)
"""A contact point; the points of pair p are numbers 2 p and 2 p + 1."""

CONSTRAINT = np.dtype(
    [
        ("a", np.uint64),  # rows
        ("b", np.uint64),
        ("count", np.int64),  # of its points
        *_floats("normal_x", "normal_y", "friction"),
        *_floats("mass_a", "inertia_a", "mass_b", "inertia_b"),  # inverse [1/kg, 1/(kg m^2)]
        ("between", np.float64),  # how a normal impulse at one point changes the approach of the other [1/kg]
    ]
)
"""A contact as sweeps solve it (:mod:`physicslab.kernels.solver.constraints`)."""

CONSTRAINT_POINT = np.dtype(
    [
        *_floats("normal_arm_a", "normal_arm_b", "tangent_arm_a", "tangent_arm_b"),  # of moments [m]
        # How its normal impulse answers: the fields of physicslab.kernels.wide.solve.ContactSpring.
        *_floats("gain", "closing", "push", "limit", "given", "give"),
        ("tangent_mass", np.float64),
        *_floats("between", "across"),  # how much less impulse it takes for each N s of the other's
        # How its own normal impulse and the other's change the speed at which it slides [1/kg].
        *_floats("turning", "turned_by_other"),
        *_floats("normal_impulse", "tangent_impulse"),
        # After those before bodies moved: the impulses, the speeds along the normal and of sliding.
        *_floats("noted_normal", "noted_tangent", "noted_speed", "noted_sliding"),
    ]
)
"""A point of one; those of contact k are numbers 2 k and 2 k + 1."""

APART = np.dtype([("clearance", np.float64), ("a", np.uint32), ("b", np.uint32)])
"""How much nearer two rows would have to come to have points [m]; -infinity where that is not known."""

IMPACT = np.dtype(
    [
        ("time", np.float64),  # [s]
        ("entity_a", np.int64),  # 0 is the world's bounds
        ("entity_b", np.int64),
        ("wall", np.int64),  # which of the bounds, -1 for a pair of bodies
        *_floats("normal_x", "normal_y"),  # unit, from A to B
        *_floats("x", "y"),  # where they met, the point with the larger impulse [m]
        ("approach_speed", np.float64),  # before the impact [m/s]
        # The impulses of all points [N s], on B; the tangent is the normal turned counter-clockwise.
        *_floats("normal_impulse", "tangent_impulse"),
        ("points", np.int64),  # 1 or 2
        # The second point and the part of the impulses there; 0 where there is one.
        *_floats("x_2", "y_2", "normal_impulse_2", "tangent_impulse_2"),
        # Where both bodies were at that moment [m, rad]; how they moved before it, and after [m/s, rad/s].
        *_floats("center_ax", "center_ay", "angle_a", "center_bx", "center_by", "angle_b"),
        *_floats("before_ax", "before_ay", "before_wa", "before_bx", "before_by", "before_wb"),
        *_floats("after_ax", "after_ay", "after_wa", "after_bx", "after_by", "after_wb"),
        # [1/kg], [1/(kg m^2)]; 0 of what an impact does not move.
        *_floats("inverse_mass_a", "inverse_inertia_a", "inverse_mass_b", "inverse_inertia_b"),
        *_floats("restitution", "friction"),  # those that the materials have
        ("law", np.int64),  # NEWTON, ENERGETIC or LOWERED of physicslab.kernels.constraint.impact_law
        ("alone", np.int64),  # 0 where other pairs acted on one of the bodies at the same moment, else 1
    ]
)
"""One impact: when, where and between which bodies; their motion before and after it, and its impulses."""

Manifolds = Annotated[NDArray[np.void], from_dtype(MANIFOLD)[::1]]
"""An array of MANIFOLD (n,)."""
Points = Annotated[NDArray[np.void], from_dtype(POINT)[::1]]
"""An array of POINT (2 n,)."""
ConstraintRecords = Annotated[NDArray[np.void], from_dtype(CONSTRAINT)[::1]]
"""An array of CONSTRAINT (n,)."""
ConstraintPoints = Annotated[NDArray[np.void], from_dtype(CONSTRAINT_POINT)[::1]]
"""An array of CONSTRAINT_POINT (2 n,)."""
Aparts = Annotated[NDArray[np.void], from_dtype(APART)[::1]]
"""An array of APART (n,)."""
Impacts = Annotated[NDArray[np.void], from_dtype(IMPACT)[::1]]
"""An array of IMPACT (n,)."""
Pairs = Annotated[NDArray[np.int64], int64[:, ::1]]
"""An int64 array (n, 3): rows a < b, and the wall or -1."""
Couples = Annotated[NDArray[np.uint32], uint32[::1]]
"""A uint32 array (2 n,): rows a < b, one after the other."""
Manifold = Any
"""One record of MANIFOLD; in compiled code its fields are attributes."""
Point = Any
"""One record of POINT."""
Constraint = Any
"""One record of CONSTRAINT."""
ConstraintPoint = Any
"""One record of CONSTRAINT_POINT."""
