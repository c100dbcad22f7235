"""One problem with every method: error against work."""

from dataclasses import dataclass, field

from physicslab.integrators import INTEGRATORS, Integrator
from physicslab.lab.accuracy.measure import Row, measure, rounding_floor
from physicslab.lab.accuracy.problem import Problem, Setting, depends_on_velocity, ladder, refusal
from physicslab.lab.accuracy.verdict import measured_order, why_order_short
from physicslab.lab.jobs import Job

_LADDER_ENDS_MS = 300.0
"""The first rung that takes longer is the last."""


@dataclass(slots=True)
class Curve:
    """One method on one problem.

    Attributes
    ----------
    integrator : Integrator
        The method.
    rows : list of Row
        From coarse to fine.
    order : float, optional
        The power of the work with which its error falls, where that can be measured.
    refused : str
        Why the engine does not use it here; it then has no rows.
    exception : str
        Why the order that the method states does not hold for these forces; empty where it does.
    short : str
        Why the measured order is below the stated one, from the rows; empty where it is not.
    """

    integrator: Integrator
    rows: list[Row] = field(default_factory=list)
    order: float | None = None
    refused: str = ""
    exception: str = ""
    short: str = ""

    @property
    def best(self) -> float | None:
        """The smallest error."""
        return min((row.error for row in self.rows if row.error is not None), default=None)


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
    curves: list[Curve]
    floor: float | None
    rigid: Row | None = None

    @property
    def chosen(self) -> list[Row]:
        """The rows in which the engine chooses the method: of ``auto``, and of rigid contacts."""
        return [self.auto] if self.rigid is None else [self.auto, self.rigid]

    @property
    def best(self) -> float | None:
        """The smallest error of any method."""
        errors = [row.error for row in self.chosen] + [curve.best for curve in self.curves]
        return min((error for error in errors if error is not None), default=None)


def study(problem: Problem, *, sparse: bool = False) -> Job[Study]:
    """Compute a problem with every method; yield the share of the work that is done.

    With ``sparse``, every second rung of a ladder is left out, and never the finest.
    """
    plan = []
    for method in INTEGRATORS.values():
        refused = refusal(problem, method)
        curve = Curve(method, refused=refused, exception=_exception(problem, method))
        settings = [] if refused else list(ladder(problem, method))
        plan.append((curve, settings[1 - len(settings) % 2 :: 2] if sparse else settings))
    whole, done = 1 + sum(len(settings) for _, settings in plan), 1
    floor = rounding_floor(problem)
    auto = measure(problem, Setting("auto"), floor)
    rigid = measure(problem, Setting("auto", contacts="rigid"), floor) if problem.touches else None
    yield 1 / whole
    for curve, settings in plan:
        for setting in settings:
            curve.rows.append(measure(problem, setting, floor))
            done += 1
            yield done / whole
            if curve.rows[-1].cpu_ms > _LADDER_ENDS_MS:
                break
        if curve.rows and curve.integrator.evaluations and problem.search is None:
            _find_order(curve)
    return Study(problem, auto, [curve for curve, _ in plan], floor, rigid)


def _find_order(curve: Curve) -> None:
    """Write into a curve the order that its rows show, and why that is less than is stated."""
    even = not curve.integrator.chooses_steps
    # A method that chooses its steps is compared by the work that they took.
    efforts = [row.steps if even else row.force_evaluations for row in curve.rows]
    errors, rates = [row.error for row in curve.rows], [row.omega_max_dt for row in curve.rows]
    curve.order = measured_order(efforts, errors, even=even)
    curve.short = why_order_short(
        curve.integrator.order, efforts, errors, rates, curve.integrator.stability_limit,
        even=even, exception=curve.exception,
    )  # fmt: skip


def _exception(problem: Problem, method: Integrator) -> str:
    """Return why a method's order does not hold for the forces of a problem; empty where it does."""
    if problem.touches:
        return "bodies touch: contacts are found within steps"
    if method.positions_only and depends_on_velocity(problem):
        return "forces depend on velocities, and its kicks take those from before"
    return ""
