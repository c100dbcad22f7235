"""Every contact case, in one explicit list."""

from physicslab.lab.accuracy.contacts.sliding import ROLLING, SLIDING, THRESHOLDS
from physicslab.lab.accuracy.contacts.striking import ALIKE, STRIKING
from physicslab.lab.case import Catalogue

CONTACTS = Catalogue((*SLIDING, *ROLLING, *THRESHOLDS, *STRIKING, *ALIKE))
"""Every case by name; families are groups."""

CONVERGENCE = (
    "rest_1", "rest_10", "slide_incline", "slide_stop", "slide_spring", "roll_slip", "roll_groove",
    "pivot_cube", "corner_cube", "corner_rod",
)  # fmt: skip
"""The cases whose order in the step is looked at: their answers are known, and do not depend on chance."""
