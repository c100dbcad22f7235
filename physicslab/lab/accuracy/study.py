"""One problem with every method: error against work."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from physicslab.integrators import INTEGRATORS, Integrator
from physicslab.lab.accuracy.measure import Row, measure, rounding_floor
from physicslab.lab.accuracy.problem import Problem, Setting, depends_on_velocity, ladder, refusal
from physicslab.lab.accuracy.verdict import measured_order, why_order_short
from physicslab.lab.case import Verdict
from physicslab.lab.jobs import Job
from physicslab.lab.peers.peer import CannotBuild

_ENDS_MS = 300.0
"""The first rung that takes longer is the last."""


class Measured(Protocol):
    """A row of a curve: it has an error, ``None`` where the run failed."""

    error: float | None


@dataclass(slots=True)
class Curve[Method, Found: Measured]:
    """One method on one problem, or one engine on one contact case.

    Attributes
    ----------
    method : Integrator or ContactEngine
        Which.
    rows : list of Row or of ContactRow
        From coarse to fine.
    order : float, optional
        The power of the work, or of the step, with which its error falls, where that can be measured.
    refused : str
        Why it is not used here; it then has no rows.
    short : str
        Why the measured order of a method is below the stated one, from the rows; empty where it is not.
    verdict : Verdict, optional
        The verdict on our own models of contacts.
    """

    method: Method
    rows: list[Found] = field(default_factory=list)
    order: float | None = None
    refused: str = ""
    short: str = ""
    verdict: Verdict | None = None

    @property
    def errors(self) -> list[float | None]:
        """The errors, from coarse to fine."""
        return [row.error for row in self.rows]

    @property
    def largest(self) -> float | None:
        """The largest error; ``None`` where a run failed or measured no error."""
        found = [error for error in self.errors if error is not None]
        return max(found, default=None) if len(found) == len(self.rows) else None


def climb[Found: Measured](
    plan: Sequence[tuple[Curve[Any, Found], Sequence[Any]]], measure: Callable[[Any, Any], Found],
    is_last: Callable[[Found], bool],
) -> Job[None]:  # fmt: skip
    """Fill curves with rows; yield the share of the work that is done.

    Parameters
    ----------
    plan : sequence of pairs
        Each curve with its rungs, from coarse to fine.
    measure : callable
        Takes a curve's method and a rung, and returns the row. May raise
        :class:`~physicslab.lab.peers.peer.CannotBuild`, or ``ImportError`` where an engine is not installed.
    is_last : callable
        Whether a curve ends with a row, before its last rung.
    """
    whole, done = sum(len(rungs) for _, rungs in plan), 0
    for curve, rungs in plan:
        for n, rung in enumerate(rungs, 1):
            try:
                curve.rows.append(measure(curve.method, rung))
            except (CannotBuild, ImportError) as error:
                curve.refused = "not installed" if isinstance(error, ImportError) else str(error)
                break
            yield (done + n) / whole
            if is_last(curve.rows[-1]):
                break
        done += len(rungs)


MethodCurve = Curve[Integrator, Row]


@dataclass(slots=True)
class Study:
    """One problem with every method.

    Attributes
    ----------
    problem : Problem
        Which.
    auto : Row
        What ``auto`` does with it, in steps of the default length.
    curves : list of Curve
        One for each method.
    floor : float, optional
        How much the error changes when the start moves by one rounding.
    rigid : Row, optional
        The row of rigid contacts, in steps of that length; ``None`` where nothing touches.
    """

    problem: Problem
    auto: Row
    curves: list[MethodCurve]
    floor: float | None
    rigid: Row | None = None

    @property
    def chosen(self) -> list[Row]:
        """The rows in which the engine chooses the method: of ``auto``, and of rigid contacts."""
        return [self.auto] if self.rigid is None else [self.auto, self.rigid]

    @property
    def rows(self) -> list[Row]:
        """All rows: those in which the engine chooses the method, then those of each method."""
        return [*self.chosen, *(row for curve in self.curves for row in curve.rows)]

    @property
    def best(self) -> float | None:
        """The smallest error of any method."""
        return min((row.error for row in self.rows if row.error is not None), default=None)


def study(problem: Problem, *, sparse: bool = False) -> Job[Study]:
    """Compute a problem with every method; yield the share of the work that is done.

    With ``sparse``, every second rung of a ladder is left out, and never the finest.
    """
    plan = []
    for method in INTEGRATORS.values():
        curve = MethodCurve(method, refused=refusal(problem, method))
        settings = [] if curve.refused else list(ladder(problem, method))
        plan.append((curve, settings[1 - len(settings) % 2 :: 2] if sparse else settings))
    floor = rounding_floor(problem)
    auto = measure(problem, Setting("auto"), floor)
    rigid = measure(problem, Setting("auto", contacts="rigid"), floor) if problem.touches else None
    yield from climb(plan, lambda _, rung: measure(problem, rung, floor), lambda row: row.cpu_ms > _ENDS_MS)
    for curve, _ in plan:
        if curve.rows and curve.method.evaluations and problem.search is None:
            _find_order(curve, _exception(problem, curve.method))
    return Study(problem, auto, [curve for curve, _ in plan], floor, rigid)


def _find_order(curve: MethodCurve, exception: str) -> None:
    """Write into a curve the order that its rows show, and why that is less than is stated."""
    method, even = curve.method, not curve.method.chooses_steps
    # A method that chooses its steps is compared by the work that they took.
    efforts = [row.steps if even else row.force_evaluations for row in curve.rows]
    rates = [row.omega_max_dt for row in curve.rows]
    curve.order = measured_order(efforts, curve.errors, even=even)
    curve.short = why_order_short(
        method.order, efforts, curve.errors, rates, method.stability_limit, even=even, exception=exception
    )


def _exception(problem: Problem, method: Integrator) -> str:
    """Return why a method's order does not hold for the forces of a problem; empty where it does."""
    if problem.touches:
        return "bodies touch: contacts are found within steps"
    if method.positions_only and depends_on_velocity(problem):
        return "forces depend on velocities, and its kicks take those from before"
    return ""
