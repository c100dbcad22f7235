"""Where the counts of near pairs are, in the array that kernels keep them in."""

COUNTED = 16
(
    PROXIMITY, RECORDED, SCALAR, SLEEPING, ACTIVE, LEFT, WIDE_COUNT, DISC_BLOCKS, BOX_BLOCKS, UNORDERED,
    LOGGED, LOWERED, ENERGETIC, OUTSIDE, ROUND, FOLLOWED,
) = range(COUNTED)  # fmt: skip
"""Counts that kernels keep: near pairs without records; those with records; of these the scalar ones, those
that sleep, those that touch, those that impacts have left to the solver; slots in use; blocks of discs and of
boxes; whether scalar pairs are out of order; all impacts logged so far; and those whose
restitution was lowered, or that obeyed Stronge's law, as friction would have made energy by Newton's; whether
in the step at hand a body was beyond the bounds, or wedged between fixed bodies; the round, from 1 on, in
which bodies that are still swift after an impact are swept again, 0 where none is; how many of the first
records it is known of within the step how far apart they are (:mod:`physicslab.kernels.geometry.apart`)."""
BEYOND_BOUNDS, WEDGED = 1, 2
"""What ``OUTSIDE`` is made of."""
