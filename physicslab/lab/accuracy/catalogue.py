"""Every problem, in one explicit list; and those that the engine cannot be asked, with the reason."""

from __future__ import annotations

from physicslab.lab.accuracy.ballistic import BALLISTIC
from physicslab.lab.accuracy.chaos import CHAOS
from physicslab.lab.accuracy.friction import FRICTION
from physicslab.lab.accuracy.impacts import IMPACTS
from physicslab.lab.accuracy.orbits import ORBITS
from physicslab.lab.accuracy.oscillators import OSCILLATORS
from physicslab.lab.accuracy.problem import LeftOut, Problem
from physicslab.lab.accuracy.slopes import SLOPES
from physicslab.lab.accuracy.stiff import STIFF

__all__ = ["LEFT_OUT", "PROBLEMS", "families", "names", "select"]

PROBLEMS: dict[str, Problem] = {
    problem.name: problem
    for problem in (*BALLISTIC, *OSCILLATORS, *STIFF, *ORBITS, *CHAOS, *IMPACTS, *FRICTION, *SLOPES)
}
"""Every problem by name, from the simplest on."""

_NO_RODS = "the engine has no rigid rods: a pendulum in it hangs on a spring (see elastic_pendulum)"

LEFT_OUT = (
    LeftOut("pendulum_period", _NO_RODS),
    LeftOut("pendulum_state", _NO_RODS),
    LeftOut("atwood", "the engine has no ropes over pulleys"),
    LeftOut("plummer100", "its figures do not tell the hundred places it starts from; see crowd100"),
    LeftOut("galperin_n5", "314,159 collisions, of which only the number is on record"),
)
"""Reference problems that are not among these, and why."""


def families() -> list[str]:
    """Return the names of problems, those of one family under the name that they share."""
    return list(dict.fromkeys(problem.source for problem in PROBLEMS.values()))


def names() -> list[str]:
    """Return what can be asked for: problems, and families of them by the name that they share."""
    return list(
        dict.fromkeys(name for problem in PROBLEMS.values() for name in (problem.source, problem.name))
    )


def select(name: str) -> list[Problem]:
    """Return the problem of a name, or the family of problems that share it; nothing if there is none."""
    if name in PROBLEMS and PROBLEMS[name].source == name:
        return [problem for problem in PROBLEMS.values() if problem.source == name]
    if name in PROBLEMS:
        return [PROBLEMS[name]]
    return [problem for problem in PROBLEMS.values() if problem.source == name]
