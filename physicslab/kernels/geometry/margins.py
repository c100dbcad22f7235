"""How near bodies are that may have contact points: shares for lists of pairs, records and points alike."""

import math

from physicslab.kernels import inlined

CONTACT_MARGIN = 0.02
"""Share of the smaller body's size within which a pair counts as near: its points are kept though they do
not touch."""
ACTIVATION_RATIO = 1.02
"""Distance within which two bodies may have contact points, as a multiple of their bounding radii's sum."""
CACHE_TOLERANCE = 0.004
"""Share of the smaller box's size that a pair of boxes may move before its points are found again."""
CACHE_TURN_TOLERANCE = 0.002
"""How far [rad] either may turn."""
TOLERANCE_WITHIN_STEP = 12.0
"""Multiple of these tolerances that counts after the first substep of a step."""
WIDE_TOLERANCE = 4.0
"""Multiple of these tolerances after which the points of a wide contact are found again, once a step."""
CORNERWISE = math.sqrt(2.0)
"""Largest ratio of the distance of two boxes to their distance along the normal of a side."""
_BOX_SHARE = 0.5 * CORNERWISE * (1.5 * CONTACT_MARGIN + WIDE_TOLERANCE * CACHE_TOLERANCE)
"""Share of its smaller side up to which a slow box is one half of a pair that has points, or keeps them."""
_TURN_SHARE = CORNERWISE * WIDE_TOLERANCE * CACHE_TURN_TOLERANCE
"""The same for points that are kept while it turns, as a share of its bounding radius."""


@inlined
def touching_distance(reach: float, radius: float, thickness: float, speculative_margin: float) -> float:
    """Return the largest distance [m] at which a body at rest may have points with the bounds.

    Two bodies may have points with each other up to the sum of theirs. ``thickness`` is half of the smaller
    extent.
    """
    share = CONTACT_MARGIN * reach
    if reach > radius:
        share = _BOX_SHARE * (2.0 * thickness) + _TURN_SHARE * reach
    return share + speculative_margin


@inlined
def touching_ahead(
    ux: float, uy: float, reach: float, radius: float, thickness: float, speculative_margin: float
) -> float:  # fmt: skip
    """Return the same for one that goes on by (ux, uy) [m]."""
    ahead = math.sqrt(ux * ux + uy * uy) * (CORNERWISE if reach > radius else 1.0)
    return ahead + touching_distance(reach, radius, thickness, speculative_margin)
