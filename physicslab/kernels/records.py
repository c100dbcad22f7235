"""The layout of contact data, in SI units and the world's directions."""

from typing import Annotated, Any

import numpy as np
from numba import from_dtype, int64, uint32
from numpy.typing import NDArray

MANIFOLD = np.dtype(
    [
        ("entity_a", np.int64),  # 0 is the world's bounds
        ("entity_b", np.int64),
        ("wall", np.int64),  # which of the bounds (0 left, 1 bottom, 2 right, 3 top), -1 for a pair of bodies
        ("a", np.int64),  # rows
        ("b", np.int64),
        # Points in use; negative for a pair in event-driven motion, which the contact step skips.
        ("count", np.int64),
        ("normal_x", np.float64),  # unit, from A to B
        ("normal_y", np.float64),
        ("friction", np.float64),
        ("restitution", np.float64),
        ("offset_x", np.float64),  # from A's centre to B's when the separations were measured
        ("offset_y", np.float64),
        # The relative pose for which the points were found: while it hardly changes, they are kept.
        ("found", np.int64),  # 2: good to keep; 3: of a pair with a disc, good in this very pose
        ("base_x", np.float64),
        ("base_y", np.float64),
        ("base_angle_a", np.float64),
        ("base_angle_b", np.float64),
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
        ("arm_ax", np.float64),  # from A's centre to the point
        ("arm_ay", np.float64),
        ("arm_bx", np.float64),
        ("arm_by", np.float64),
        ("found_separation", np.float64),  # in the base pose
        ("separation", np.float64),  # now; negative where they overlap
        # 1 where it approaches fast and meets after this substep: an impact of the next one.
        ("ahead", np.int64),
        ("normal_mass", np.float64),  # effective masses
        ("tangent_mass", np.float64),
        ("normal_impulse", np.float64),  # in one substep, kept for warm starting
        ("tangent_impulse", np.float64),
        ("approach_speed", np.float64),  # before the impact of this step, 0 if there was none
        ("impact_normal", np.float64),  # impulses of the impacts of this step
        ("impact_tangent", np.float64),
        # On a round bend of a chain, how fast the normal that was found turns away from the point in half a
        # substep [m/s]: what slides along leaves it with this speed, and comes to the next one with it.
        ("bend", np.float64),
    ]
)
"""A contact point; the points of pair p are numbers 2 p and 2 p + 1."""

IMPACT = np.dtype(
    [
        ("time", np.float64),  # [s]
        ("entity_a", np.int64),  # 0 is the world's bounds
        ("entity_b", np.int64),
        ("wall", np.int64),  # which of the bounds, -1 for a pair of bodies
        ("normal_x", np.float64),  # unit, from A to B
        ("normal_y", np.float64),
        ("x", np.float64),  # where they met, the point with the larger impulse [m]
        ("y", np.float64),
        ("approach_speed", np.float64),  # before the impact [m/s]
        # The impulses of all points [N s], on B; the tangent is the normal turned counter-clockwise.
        ("normal_impulse", np.float64),
        ("tangent_impulse", np.float64),
        ("points", np.int64),  # 1 or 2
        ("x_2", np.float64),  # the second point and the part of the impulses there; 0 where there is one
        ("y_2", np.float64),
        ("normal_impulse_2", np.float64),
        ("tangent_impulse_2", np.float64),
        ("center_ax", np.float64),  # where both bodies were at that moment [m, rad]
        ("center_ay", np.float64),
        ("angle_a", np.float64),
        ("center_bx", np.float64),
        ("center_by", np.float64),
        ("angle_b", np.float64),
        ("before_ax", np.float64),  # how they moved before [m/s, rad/s]
        ("before_ay", np.float64),
        ("before_wa", np.float64),
        ("before_bx", np.float64),
        ("before_by", np.float64),
        ("before_wb", np.float64),
        ("after_ax", np.float64),  # and after
        ("after_ay", np.float64),
        ("after_wa", np.float64),
        ("after_bx", np.float64),
        ("after_by", np.float64),
        ("after_wb", np.float64),
        ("inverse_mass_a", np.float64),  # [1/kg]; 0 of what an impact does not move
        ("inverse_inertia_a", np.float64),  # [1/(kg m^2)]
        ("inverse_mass_b", np.float64),
        ("inverse_inertia_b", np.float64),
        ("restitution", np.float64),  # those that the materials have
        ("friction", np.float64),
        ("law", np.int64),  # NEWTON, ENERGETIC or LOWERED of physicslab.kernels.constraint.impact_law
        ("alone", np.int64),  # 0 where other pairs acted on one of the bodies at the same moment, else 1
    ]
)
"""One impact: when, where and between which bodies; their motion before and after it, and its impulses."""

Manifolds = Annotated[NDArray[np.void], from_dtype(MANIFOLD)[::1]]
"""An array of MANIFOLD (n,)."""
Points = Annotated[NDArray[np.void], from_dtype(POINT)[::1]]
"""An array of POINT (2 n,)."""
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
