"""Measures of all terms of joints in a state of motion, for reports."""

from physicslab.kernels import Numbers, Rows, Vectors, kernel
from physicslab.kernels.joints.terms import TermEnd, measure_term

VALUE, AX, AY, TURN_A, BX, BY, TURN_B, FIGURES = range(8)
"""The figures of a term, as :class:`physicslab.kernels.joints.terms.MeasuredTerm` has them."""


@kernel
def measure_terms(
    measure: Rows, a: Rows, b: Rows, anchor_a: Vectors, anchor_b: Vectors, axis: Vectors, position: Vectors,
    angle: Numbers, found: Vectors,
) -> None:  # fmt: skip
    """Set ``found`` (m, FIGURES) to what terms (m,) measure and to their gradients, where bodies are."""
    for n in range(len(measure)):
        i, j = a[n], b[n]
        one = measure_term(
            measure[n],
            TermEnd(position[i, 0], position[i, 1], angle[i], 0.0, 0.0, 0.0, anchor_a[n, 0], anchor_a[n, 1]),
            TermEnd(position[j, 0], position[j, 1], angle[j], 0.0, 0.0, 0.0, anchor_b[n, 0], anchor_b[n, 1]),
            axis[n, 0], axis[n, 1],
        )  # fmt: skip
        found[n, VALUE], found[n, AX], found[n, AY], found[n, TURN_A] = one.value, one.ax, one.ay, one.turn_a
        found[n, BX], found[n, BY], found[n, TURN_B] = one.bx, one.by, one.turn_b
