"""The figures of a world, measured a few times a second, and the lines in which panels show them."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from physicslab.components import Held, Mass, Transform, Velocity
from physicslab.contacts.report import count_near_pairs
from physicslab.diagnostics.energy import ACCOUNT_WORDS, STORED_WORDS, Audit, flows, summation
from physicslab.diagnostics.reference_solution import ReferenceSolution, reference_solution
from physicslab.diagnostics.scales import scales_of
from physicslab.ecs.sentences import listed
from physicslab.ecs.vector import Vector2
from physicslab.languages.sentence import Sentence, proper
from physicslab.state.account import Momentum
from physicslab.view.canvas.quantities import (
    percentage,
    quantity,
    vector_quantity,
    vector_without_rounding,
    without_rounding,
)
from physicslab.view.picture.bodies import body_rows
from physicslab.world import World

_SMOOTHING = 0.5
"""Time [s] over which frame rate and costs are averaged."""


class EnergyWatch:
    """Watches the accounts of a world, and its motion from one edit to the next where that is known exactly.

    A change by the user is booked as an edit and is no error of the simulation; the exact solution begins
    again with it.

    Attributes
    ----------
    since : float
        Time of the world [s] at the last edit.
    known : ReferenceSolution, optional
        The exact solution since then, where there is one.
    """

    def __init__(self) -> None:
        self.since = 0.0
        self.known: ReferenceSolution | None = None
        self._audit: Audit | None = None
        self._begin: object = None
        self._time = math.inf
        self._seen: tuple[World, int] | None = None

    def follow(self, world: World) -> None:
        """Begin again if the world was edited; to be called in every frame, so that nothing is missed."""
        if self._seen != (world, world.motion_edits):
            self.known = reference_solution(world)
            self._seen, self.since = (world, world.motion_edits), world.time

    def sample(self, world: World) -> Audit:
        """Read the accounts as they are now; the audit begins again with them, or where time went back."""
        self.follow(world)
        if len(world.batch(Held)):
            self._seen = None  # a hand moves bodies all the time: no solution is known
        account = world.account
        begin = world, account.start, account.since
        if self._audit is None or account.start is None or begin != self._begin or world.time < self._time:
            self._audit, self._begin = Audit(world, whole=True), begin
        else:
            self._audit.sample(world)
        self._time = world.time
        return self._audit


class WorldFigures:
    """The figures of a world as it is now.

    Attributes
    ----------
    bodies, asleep, contacts : int
        How many bodies there are and sleep, and pairs that touch.
    energy : Energy
        Kinetic and potential [J].
    audit : Audit
        Energy by cause since the accounts of the world began, and the error.
    held, driven : bool
        Whether a hand holds a body, which then has that body's energy, and whether bodies are driven.
    since : float
        Time of the world [s] at the last edit.
    momentum : Momentum
        Linear [kg m/s], and angular about the origin [kg m^2/s].
    known : ReferenceSolution, optional
        The exact solution since the last edit, where there is one.
    error : float
        How far the body that is furthest off is from that [m].
    scales : dict of str to float
        How large quantities are here, by unit.
    frame_rate : float
        Frames per second of late.
    """

    def __init__(self, world: World, watch: EnergyWatch, frame_rate: float = 0.0) -> None:
        contacts, moving = world.contacts, world.batch(Transform, Velocity).rows
        self.bodies, self.asleep = len(body_rows(world).all), world.sleep.count
        self._world, self.contacts = world, contacts.count
        self.audit = watch.sample(world)
        self.energy, now = self.audit.latest, self.audit.account.now
        self.momentum = Momentum(Vector2(now.px, now.py), now.spin)
        self.held = len(world.batch(Held)) > 0
        self.driven = not world.table(Mass).present[moving].all()
        self.known, self.since = watch.known, watch.since
        self.error = 0.0 if self.known is None else self.known.error(world)
        self.scales, self.frame_rate = scales_of(world), frame_rate

    @cached_property
    def candidate_pairs(self) -> int:
        """Number of pairs near each other when it is first read: counting takes time, one level shows it."""
        return count_near_pairs(self._world)

    def joules(self, energy: float) -> str:
        """Return an energy in words; what is rounding beside the energies exchanged is 0."""
        return quantity(without_rounding(energy, max(self.scales["J"], self.audit.exchanged)), "J")


class FrameMeter:
    """Averages frame rate and costs over the last half second or so.

    Attributes
    ----------
    cost : dict of str to float
        Time of each system in a frame [ms], by name.
    """

    def __init__(self) -> None:
        self.cost: dict[str, float] = {}
        self._frame_time = 0.0
        self._before: dict[str, int] = {}
        self._world: World | None = None

    @property
    def frame_rate(self) -> float:
        """Frames per second; 0 before the first."""
        return 1.0 / self._frame_time if self._frame_time > 0.0 else 0.0

    def note(self, world: World, elapsed: float) -> None:
        """Count a frame, ``elapsed`` seconds after the last."""
        if elapsed <= 0.0:  # the first frame
            return
        share = 1.0 - math.exp(-elapsed / _SMOOTHING)
        if self._frame_time == 0.0:
            self._frame_time = elapsed
        self._frame_time += (elapsed - self._frame_time) * share
        if world is not self._world:
            self._world, self._before, self.cost = world, {}, {}
        for name, timing in world.schedule.timings.items():
            spent = (timing.nanoseconds - self._before.get(name, timing.nanoseconds)) / 1e6
            self._before[name] = timing.nanoseconds
            self.cost[name] = self.cost.get(name, spent) + (spent - self.cost.get(name, spent)) * share


# ---- lines -------------------------------------------------------------------------------------------------


type Kind = Literal["heading", "figure", "detail", "remark", "gap"]


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a panel.

    Attributes
    ----------
    label, value : str
        The words at the left, and those at the right.
    kind : str
        ``"heading"``; ``"figure"``; ``"detail"``, a lesser figure; ``"remark"``, words that may take several
        lines; ``"gap"``, some space.
    """

    label: str = ""
    value: str = ""
    kind: Kind = "figure"


def measure_lines(world: World, figures: WorldFigures) -> list[Line]:
    """Return how it moves, and what should not change."""
    momentum, scales = figures.momentum, figures.scales
    linear = vector_without_rounding(momentum.linear, scales["kg m/s"])
    angular = without_rounding(momentum.angular, scales["kg m^2/s"])
    return [
        *_energy_lines(figures),
        *([] if figures.known is None else _error_lines(figures, figures.known)),
        Line("Total momentum", quantity(linear.magnitude, "kg m/s")),
        Line("as a vector", vector_quantity(linear, "kg m/s"), "detail"),
        Line("Angular momentum", quantity(angular, "kg m²/s")),
        *(Line(remark, kind="remark") for remark in [summation(world)] if remark),
    ]


def _energy_lines(figures: WorldFigures) -> list[Line]:
    energy, audit = figures.energy, figures.audit
    lines = [
        Line("Kinetic energy", figures.joules(energy.kinetic)),
        Line("linear", figures.joules(energy.kinetic_linear), "detail"),
        Line("rotational", figures.joules(energy.kinetic_angular), "detail"),
    ]
    if energy.potential:
        lines.append(Line("Potential energy", figures.joules(energy.stored)))
        lines += [
            Line(STORED_WORDS.get(name, name), figures.joules(stored), "detail")
            for name, stored in energy.potential.items()
        ]
    return [
        *lines,
        Line("Total energy", figures.joules(energy.total)),
        Line("Energy change", figures.joules(audit.account.change)),
        *(Line(f"by {ACCOUNT_WORDS[name]}", quantity(value, "J"), "detail")
          for name, value in flows(audit.notable)),
        Line("Error of the method", quantity(audit.account.energy["numerical"], "J")),
        Line("largest so far", quantity(audit.largest_error, "J"), "detail"),
        Line("largest, as a share", percentage(audit.error), "detail"),
        Line("counted since", f"{audit.account.since:.2f} s", "detail"),
    ]  # fmt: skip


def _error_lines(figures: WorldFigures, known: ReferenceSolution) -> list[Line]:
    return [
        Line("Position error", quantity(figures.error, "m")),
        Line(f"against {known.what}", kind="detail"),
        Line("since the last edit", f"at {figures.since:.2f} s", "detail"),
    ]


def impulse_lines(figures: WorldFigures) -> list[Line]:
    """Return what gave momentum and angular momentum to the world."""
    account = figures.audit.account
    linear = [(name, value) for name, value in account.momentum.items() if value.magnitude != 0.0]
    turning = [(name, value) for name, value in account.angular_momentum.items() if value != 0.0]
    return [
        Line(kind="gap"),
        Line("Impulses from outside", "by cause", "heading"),
        *(Line(ACCOUNT_WORDS[name], vector_quantity(value, "N s")) for name, value in linear),
        Line("Angular impulses", "about the origin", "heading"),
        *(Line(ACCOUNT_WORDS[name], quantity(value, "N m s")) for name, value in turning),
    ]


_ISLANDS = 3
"""Number of islands whose steppers are shown."""


def method_lines(world: World) -> list[Line]:
    """Return how the world is stepped, and why so."""
    simulation, python = world.simulation, world.schedule.interpreted
    parts = "substep" if simulation.substeps == 1 else "substeps"
    divided = f"the last step was divided into {world.step_divisions}"
    return [
        Line(kind="gap"),
        Line("Integrator", f"{simulation.dt * 1e3:.3g} ms in {simulation.substeps} {parts}", "heading"),
        *(_island_lines(world) or _plan_lines(world)),
        *([Line(divided, kind="remark")] if world.step_divisions > 1 else []),
        *(Line(f"{_plain(name)} is computed by Python: slower", kind="remark") for name in python),
        *([] if world.islands.members else _stepper_lines(world)),
    ]


def _plan_lines(world: World) -> list[Line]:
    method = Line(world.plan.integrator.title, kind="remark")
    return [method, Line(_because([world.plan.reason]), kind="remark")]


def _island_lines(world: World) -> list[Line]:
    """Say what advances the largest islands, where there are several."""
    if not world.islands.members:
        return []
    lines = [Line(f"{len(world.parts)} islands, each by its own stepper", kind="remark")]
    for part in world.parts[:_ISLANDS]:
        count = int((part.bodies.inverse_mass > 0.0).sum())
        title = part.steppers.main(part).title
        lines.append(Line(f"{count} {'body' if count == 1 else 'bodies'}: {title}", kind="remark"))
    return lines


def _stepper_lines(world: World) -> list[Line]:
    """Say which stepper makes the steps, and why so."""
    if world.stepper is None:
        return []
    plan = world.plan
    if plan.collisions == "step" and world.simulation.contacts == "auto":
        reasons = [plan.contact_reason]  # in few words: the figures must fit into the window
    else:
        reasons = [plan.collision_reason] if plan.collisions != "none" else []
        if world.stepper.reason not in (plan.reason, *reasons):
            reasons.append(world.stepper.reason)
    lines = [Line(world.stepper.title, kind="remark")]
    return [*lines, Line(_because(reasons), kind="remark")] if reasons else lines


def _because(reasons: list[str]) -> Sentence:
    return Sentence("because: {reason}", reason=listed("both", reasons))


def _plain(name: str) -> str:
    return name.removesuffix("System")


def cost_lines(world: World, meter: FrameMeter) -> list[Line]:
    """Return what each system takes a frame."""
    running = [system.name for system in world.schedule.running]
    costs = {name: meter.cost.get(name, 0.0) for name in running}
    lines = [Line("Running", "time per frame", "heading")]
    lines += [Line(proper(_plain(name)), f"{cost:.2f} ms") for name, cost in costs.items()]
    return [*lines, Line("Together", f"{sum(costs.values()):.2f} ms")]


def left_out_lines(world: World) -> list[Line]:
    """Return what the world does not need, and why."""
    if not world.schedule.left_out:
        return []
    lines = [Line(kind="gap"), Line("Left out", kind="heading")]
    lines += [
        Line(Sentence("{system}: {reason}", system=_plain(out.name), reason=out.reason), kind="remark")
        for out in world.schedule.left_out
    ]
    return lines
