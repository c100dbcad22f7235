"""One problem with every method: error against work."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from physicslab.components import Transform, Velocity
from physicslab.integrators import INTEGRATORS, Integrator
from physicslab.lab.accuracy.measure import Measurement, finish, measure
from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.settings import Setting, ladder, refusal, sees_velocity
from physicslab.lab.accuracy.verdict import Verdict, measured_order, verdict, why_order_short
from physicslab.lab.case import Job, attempt

__all__ = ["Curve", "Row", "Study", "rounding_floor", "study"]

_LADDER_ENDS_S = 0.3
"""The first rung that takes longer is the last."""


@dataclass(frozen=True, slots=True)
class Row:
    """One measurement and its verdict."""

    measurement: Measurement
    verdict: Verdict


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
        return min(
            (row.measurement.error for row in self.rows if row.measurement.error is not None), default=None
        )


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
        What rigid contacts do with it, in steps of that length; ``None`` where nothing touches.
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
        errors = [row.measurement.error for row in self.chosen] + [curve.best for curve in self.curves]
        return min((error for error in errors if error is not None), default=None)


def study(problem: Problem, *, sparse: bool = False) -> Job[Study]:
    """Compute a problem with every method; yield the share of the work that is done, then the result.

    Where ``sparse``, every second rung of a ladder is left out, and never the finest.
    """
    plan = []
    for method in INTEGRATORS.values():
        refused = refusal(problem, method)
        curve = Curve(method, refused=refused, exception=_exception(problem, method))
        settings = [] if refused else list(ladder(problem, method))
        plan.append((curve, settings[1 - len(settings) % 2 :: 2] if sparse else settings))
    whole = 1 + sum(len(settings) for _, settings in plan)
    floor = rounding_floor(problem)
    auto = _row(problem, Setting("auto"), floor)
    rigid = _row(problem, Setting("auto", contacts="rigid"), floor) if problem.touches else None
    yield 1 / whole
    done = 1
    for curve, settings in plan:
        for setting in settings:
            curve.rows.append(_row(problem, setting, floor))
            done += 1
            yield done / whole
            if curve.rows[-1].measurement.cpu_s > _LADDER_ENDS_S:
                break
        measured = [row.measurement for row in curve.rows]
        # A method that chooses its steps is compared by the work that they took.
        efforts = [m.evaluations if curve.integrator.chooses_steps else m.steps for m in measured]
        if curve.rows and curve.integrator.evaluations and problem.search is None:
            even = not curve.integrator.chooses_steps
            errors, rates = [m.error for m in measured], [m.watched.rate_dt for m in measured]
            curve.order = measured_order(efforts, errors, even=even)
            curve.short = why_order_short(
                curve.integrator.order, efforts, errors, rates, curve.integrator.stability_limit,
                even=even, exception=curve.exception,
            )  # fmt: skip
    yield Study(problem, auto, [curve for curve, _ in plan], floor, rigid)


def _exception(problem: Problem, method: Integrator) -> str:
    """Return why a method's order does not hold for the forces of a problem; empty where it does."""
    if problem.touches:
        return "bodies touch: contacts are found within steps"
    if method.positions_only and sees_velocity(problem):
        return "forces depend on velocities, and its kicks take those from before"
    return ""


def _row(problem: Problem, setting: Setting, floor: float | None) -> Row:
    found = measure(problem, setting)
    worth = verdict(found.error, problem.good, problem.excellent, floor=floor, chaotic=problem.chaotic)
    if worth in (Verdict.EXCELLENT, Verdict.GOOD) and found.watched.collisions:
        worth = Verdict.SHORT  # right by chance: collisions are missing, or too many
    return Row(found, worth)


def rounding_floor(problem: Problem) -> float | None:
    """Return how much the error changes when the start moves by one rounding; ``None`` where bodies touch.

    Every coordinate and speed is moved to the next float up, and down, and the run is made as ``auto`` does.
    No method that computes in floats can be relied on to do better than a few times this.
    """
    if problem.touches:
        return None
    errors = []
    for way in (0.0, -math.inf, math.inf):
        world = problem.build(Setting("auto").simulation(problem))
        world.synchronise()
        for column in (world.table(Transform)["position"], world.table(Velocity)["linear"]):
            column[:] = np.where((column == 0.0) | (way == 0.0), column, np.nextafter(column, way))
        error, _ = attempt(partial(finish, problem, world))
        if error is None:
            return None
        errors.append(error)
    return max(abs(error - errors[0]) for error in errors)
