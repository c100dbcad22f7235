"""Every case of the stability lab, in one explicit list."""

from __future__ import annotations

from physicslab.lab.case import Catalogue
from physicslab.lab.stability.attraction import ATTRACTION
from physicslab.lab.stability.bounces import BOUNCES
from physicslab.lab.stability.bullets import BULLETS
from physicslab.lab.stability.chains import CHAINS
from physicslab.lab.stability.crowds import CROWDS
from physicslab.lab.stability.extremes import EXTREMES
from physicslab.lab.stability.far import FAR
from physicslab.lab.stability.ranges import RANGES
from physicslab.lab.stability.slopes import SLOPES
from physicslab.lab.stability.springs import SPRINGS
from physicslab.lab.stability.squeezed import SQUEEZED
from physicslab.lab.stability.stacks import STACKS
from physicslab.lab.stability.steps import STEPS
from physicslab.lab.stability.towers import TOWERS

__all__ = ["CASES"]

CASES = Catalogue(
    (
        *SPRINGS,
        *CHAINS,
        *STACKS,
        *TOWERS,
        *CROWDS,
        *SQUEEZED,
        *BULLETS,
        *BOUNCES,
        *SLOPES,
        *STEPS,
        *EXTREMES,
        *FAR,
        *ATTRACTION,
        *RANGES,
    )
)
"""Every case by name; families are groups."""
