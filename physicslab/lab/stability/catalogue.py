"""Every case of the stability lab, in one explicit list."""

from __future__ import annotations

from physicslab.lab.case import Catalogue
from physicslab.lab.stability.attraction import ATTRACTION
from physicslab.lab.stability.case import run_case
from physicslab.lab.stability.chains import CHAINS
from physicslab.lab.stability.impacts import IMPACTS
from physicslab.lab.stability.ranges import RANGES
from physicslab.lab.stability.springs import SPRINGS
from physicslab.lab.stability.squeezed import SQUEEZED
from physicslab.lab.stability.standing import STANDING
from physicslab.lab.stability.steps import STEPS

__all__ = ["CASES", "run_named"]

CASES = Catalogue((*SPRINGS, *CHAINS, *STANDING, *SQUEEZED, *IMPACTS, *STEPS, *ATTRACTION, *RANGES))
"""Every case by name; families are groups."""


def run_named(name: str) -> tuple[float | None, str, float]:
    """Run the case of a name; return figure, failure and time [s]: no case can be sent to another process."""
    outcome = run_case(CASES[name])
    return outcome.figure, outcome.failure, outcome.wall_s
