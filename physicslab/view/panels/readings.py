"""The lines of the HUD."""

from __future__ import annotations

from physicslab.diagnostics.account_words import ACCOUNT_WORDS, flows
from physicslab.diagnostics.energy import summation
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.quantities import percentage, quantity, vector_quantity, without_rounding
from physicslab.view.panels.figures import FrameMeter, WorldFigures
from physicslab.view.panels.panels import Line
from physicslab.world import World

__all__ = ["cost_lines", "impulse_lines", "left_out_lines", "measure_lines", "method_lines"]


def measure_lines(world: World, figures: WorldFigures) -> list[Line]:
    """Return how it moves, and what should not change."""
    momentum, scales = figures.momentum, figures.scales
    linear = Vector2(*(without_rounding(part, scales["kg m/s"]) for part in momentum.linear))
    angular = without_rounding(momentum.angular, scales["kg m^2/s"])
    return [
        *_energy_lines(figures),
        *_error_lines(figures),
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
        lines += [Line(name, figures.joules(stored), "detail") for name, stored in energy.potential.items()]
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


def _error_lines(figures: WorldFigures) -> list[Line]:
    if figures.known is None:
        return []
    return [
        Line("Position error", quantity(figures.error, "m")),
        Line(f"against {figures.known.what}", kind="detail"),
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
    simulation = world.simulation
    parts = "substep" if simulation.substeps == 1 else "substeps"
    return [
        Line(kind="gap"),
        Line("Integrator", f"{simulation.dt * 1e3:.3g} ms in {simulation.substeps} {parts}", "heading"),
        *(_island_lines(world) or _plan_lines(world)),
        *_division_lines(world),
        *(Line(f"{_plain(name)} is computed by Python: slower", kind="remark") for name in world.interpreted),
        *([] if world.islands.members else _stepper_lines(world)),
    ]


def _plan_lines(world: World) -> list[Line]:
    method = Line(world.plan.integrator.title, kind="remark")
    return [method, Line(f"because: {world.plan.reason}", kind="remark")]


def _island_lines(world: World) -> list[Line]:
    """Say what advances the largest islands, where there are several."""
    if not world.islands.members:
        return []
    shown = world.parts[:_ISLANDS]
    lines = [Line(f"{len(world.parts)} islands, each by its own stepper", kind="remark")]
    for part in shown:
        count = int((part.bodies.inverse_mass > 0.0).sum())
        title = part.steppers.main(part).title
        lines.append(Line(f"{count} {'body' if count == 1 else 'bodies'}: {title}", kind="remark"))
    return lines


def _division_lines(world: World) -> list[Line]:
    if world.step_divisions <= 1:
        return []
    return [Line(f"the last step was divided into {world.step_divisions}", kind="remark")]


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
    return lines + [Line(f"because: {'; '.join(reasons)}", kind="remark")] * bool(reasons)


def _plain(name: str) -> str:
    return name.removesuffix("System")


def cost_lines(world: World, meter: FrameMeter) -> list[Line]:
    """Return what each system takes a frame."""
    running = [system.name for system in world.schedule.running]
    costs = {name: meter.cost.get(name, 0.0) for name in running}
    lines = [Line("Running", "time per frame", "heading")]
    lines += [Line(_plain(name), f"{cost:.2f} ms") for name, cost in costs.items()]
    return [*lines, Line("Together", f"{sum(costs.values()):.2f} ms")]


def left_out_lines(world: World) -> list[Line]:
    """Return what the world does not need, and why."""
    if not world.schedule.left_out:
        return []
    lines = [Line(kind="gap"), Line("Left out", kind="heading")]
    lines += [Line(f"{_plain(out.name)}: {out.reason}", kind="remark") for out in world.schedule.left_out]
    return lines
