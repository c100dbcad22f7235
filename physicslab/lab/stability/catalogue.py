"""Every case, in one explicit list."""

from __future__ import annotations

from physicslab.lab.stability.attraction import ATTRACTION
from physicslab.lab.stability.bounces import BOUNCES
from physicslab.lab.stability.bullets import BULLETS
from physicslab.lab.stability.case import Case
from physicslab.lab.stability.chains import CHAINS
from physicslab.lab.stability.crowds import CROWDS
from physicslab.lab.stability.far import FAR
from physicslab.lab.stability.ranges import RANGES
from physicslab.lab.stability.slopes import SLOPES
from physicslab.lab.stability.springs import SPRINGS
from physicslab.lab.stability.stacks import STACKS
from physicslab.lab.stability.steps import STEPS

__all__ = ["CASES", "groups", "names", "select"]

CASES: dict[str, Case] = {
    case.name: case
    for case in (
        *SPRINGS, *CHAINS, *STACKS, *CROWDS, *BULLETS, *BOUNCES, *SLOPES, *STEPS, *FAR, *ATTRACTION, *RANGES,
    )
}  # fmt: skip
"""Every case by name."""


def groups() -> list[str]:
    """Return the names of the groups, in order."""
    return list(dict.fromkeys(case.group for case in CASES.values()))


def names() -> list[str]:
    """Return what can be asked for: groups, and cases."""
    return [*groups(), *CASES]


def select(name: str) -> list[Case]:
    """Return the case of a name, or those of a group; nothing if there is none.

    >>> [case.name for case in select("tiny_steps")]
    ['step_1ns_fall', 'step_1ns_stack']
    """
    if name in CASES:
        return [CASES[name]]
    return [case for case in CASES.values() if case.group == name]
