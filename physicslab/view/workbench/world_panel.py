"""The world in figures: few in plain words first, more for those who measure, all for engineers."""

from __future__ import annotations

from collections.abc import Sequence

from imgui_bundle import imgui

from physicslab.ecs.vector import Vector2
from physicslab.history import SetPhysics
from physicslab.view.canvas.quantities import quantity, without_rounding
from physicslab.view.panels.figures import WorldFigures
from physicslab.view.panels.laws import gravity_in_words, has_gravity
from physicslab.view.panels.panels import Line
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import LEVELS, Window
from physicslab.view.workbench.energy_flows import build_energies
from physicslab.world import World

__all__ = ["build_figures", "build_levels", "build_world"]

_PLANETS = {"Earth": 9.81, "Moon": 1.62, "Mars": 3.71, "Jupiter": 24.79, "none": 0.0}
"""The pull of gravity at the surface [m/s^2]; NASA's planetary fact sheets."""


def build_levels(ui: Ui, window: Window) -> None:
    """Build the choice of how much is shown."""
    width = (imgui.get_content_region_avail().x - 2 * imgui.get_style().item_spacing.x) / len(LEVELS)
    for n, (name, tip) in enumerate(LEVELS.items()):
        if n:
            imgui.same_line()
        if ui.button(name, tip, on=window.level == name, size=(width, 0.0)):
            window.level = name
    ui.gap(0.15)


def build_world(ui: Ui, world: World, figures: WorldFigures, window: Window) -> None:
    """Build the part for everyone: what this is, its energies, its gravity."""
    ui.heading(world.title or world.name or "A scene")
    if world.description:
        ui.faint(world.description)
    ui.gap(0.2)
    build_energies(ui, figures, error=window.level == "Explore")
    momentum = without_rounding(figures.momentum.linear.magnitude, figures.scales["kg m/s"])
    ui.row("Total momentum", quantity(momentum, "kg m/s"))
    ui.gap(0.2)
    _build_gravity(ui, world, window)


def _build_gravity(ui: Ui, world: World, window: Window) -> None:
    if not has_gravity(world):
        ui.row("Gravity", gravity_in_words(world))
        return
    physics = world.physics
    if physics.gravity_mode == "planet":
        now = "between bodies"
    elif physics.gravity_mode == "none" or not physics.gravity:
        now = "none"
    else:
        down = physics.gravity == Vector2(0.0, physics.gravity.y)
        now = next((name for name, g in _PLANETS.items() if down and -physics.gravity.y == g), "own")
    imgui.align_text_to_frame_padding()
    ui.faint("Gravity", wrapped=False)
    imgui.same_line()
    chosen = ui.choice("Gravity", now, [*_PLANETS, "between bodies"], "Gravity: choose a planet")
    ui.rows["Gravity"] = gravity_in_words(world)
    if chosen != now:
        window.do_next(_pull, chosen)
    ui.faint(gravity_in_words(world))


def _pull(world: World, window: Window, name: str) -> None:
    """Choose what pulls, by its name in the list."""
    if name == "between bodies":
        window.edits.do(SetPhysics({"gravity_mode": "planet"}))
    elif name == "none":
        window.edits.do(SetPhysics({"gravity_mode": "none"}))
    else:
        gravity = Vector2(0.0, -_PLANETS[name])
        window.edits.do(SetPhysics({"gravity_mode": "linear", "gravity": gravity}))


def build_figures(ui: Ui, lines: Sequence[Line]) -> None:
    """Build lines of figures as they are."""
    for line in lines:
        match line.kind:
            case "heading":
                ui.gap(0.2)
                ui.heading(line.label)
                if line.value:
                    ui.faint(line.value)
            case "gap":
                ui.gap(0.3)
            case "remark":
                ui.faint(line.label)
            case _:
                ui.row(line.label, line.value, lesser=line.kind == "detail")
