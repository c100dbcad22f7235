"""Every case of the stability lab, in one explicit list."""

from collections.abc import Hashable, Sequence

from physicslab.lab.case import Catalogue
from physicslab.lab.stability.case import StabilityCase, run_case
from physicslab.lab.stability.contacts import SQUEEZED, STANDING
from physicslab.lab.stability.forces import ATTRACTION, CHAINS, FIELDS
from physicslab.lab.stability.impacts import IMPACTS
from physicslab.lab.stability.joints import ASSEMBLIES, JOINTS
from physicslab.lab.stability.ranges import RANGES
from physicslab.lab.stability.shapes import SHAPES
from physicslab.lab.stability.springs import SPRINGS
from physicslab.lab.stability.steps import STEPS

CASES = Catalogue(
    (
        *SPRINGS, *CHAINS, *JOINTS, *ASSEMBLIES, *FIELDS, *STANDING, *SQUEEZED, *SHAPES, *IMPACTS, *STEPS,
        *ATTRACTION, *RANGES,
    )
)  # fmt: skip
"""Every case by name; families are groups."""


def runs_of(cases: Sequence[StabilityCase]) -> list[list[str]]:
    """Return the names of cases by the run at which they look, the longest run first."""
    runs: dict[Hashable, list[StabilityCase]] = {}
    for case in cases:
        runs.setdefault(case.run, []).append(case)
    longest = max(runs.values(), key=lambda run: run[0].long_s, default=[])
    ordered = sorted(runs.values(), key=lambda run: run is not longest)
    return [[case.name for case in run] for run in ordered]


def run_named(name: str) -> tuple[float | None, str, float]:
    """Run the case of a name; return figure, failure and time [s]: no case can be sent to another process."""
    outcome = run_case(CASES[name])
    return outcome.figure, outcome.failure, outcome.wall_s
