"""How the world is stepped, to be changed in the window: each choice with what ``auto`` took and why."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from physicslab.ecs.config import COLLISIONS, CONTACTS, INTEGRATORS, PhysicsConfig, SimulationConfig
from physicslab.ecs.fields import Field
from physicslab.history import SetPhysics, SetSimulation
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.view.workbench.number_field import NumberFields
from physicslab.world import World

__all__ = ["SettingsPanel"]

_LABELS = 0.42
"""Share of the panel's width that labels take."""
_SLEEPING = {"auto": "auto", "yes": True, "no": False}
_NUMBERS: tuple[tuple[str, str, str], ...] = (
    ("linear_damping", "Damping", "Share of the velocity that is lost a second"),
    ("angular_damping", "Damping of turns", "Share of the turning that is lost a second"),
)

type Config = PhysicsConfig | SimulationConfig


class SettingsPanel:
    """Rows for the step, the method, collisions, contacts, sleep and damping."""

    def __init__(self) -> None:
        self._numbers = NumberFields()

    def finish(self) -> str:
        """Take over what is half written in a field, and return why it is refused; empty where it is not."""
        return self._numbers.finish()

    def build(self, ui: Ui, world: World, window: Window) -> None:
        """Build them for the world as it is."""
        simulation, plan = world.simulation, world.plan
        ui.gap(0.2)
        ui.heading("Settings")
        self._build_number(
            ui, "dt", "Step", simulation.dt, "Length of a step; the error falls with it", window
        )
        self._build_number(
            ui, "substeps", "Substeps", simulation.substeps, "Parts of a step", window, whole=True
        )
        self._build_choice(ui, "integrator", "Method", simulation.integrator, INTEGRATORS, window)
        if simulation.integrator == "auto":
            ui.faint(f"auto takes {plan.integrator.name}: {plan.reason}")
        self._build_choice(ui, "collisions", "Collisions", simulation.collisions, COLLISIONS, window)
        self._build_choice(ui, "contacts", "Contacts", simulation.contacts, CONTACTS, window)
        asleep = next(name for name, value in _SLEEPING.items() if value == simulation.sleeping)
        self._build_choice(ui, "sleeping", "Sleep", asleep, tuple(_SLEEPING), window)
        for name, words, tip in _NUMBERS:
            self._build_number(ui, name, words, getattr(world.physics, name), tip, window)

    def _build_number(
        self, ui: Ui, name: str, words: str, value: float, tip: str, window: Window, *, whole: bool = False
    ) -> None:
        config: type[Config] = PhysicsConfig if name.endswith("damping") else SimulationConfig
        spec: Field = next(field for field in config.FIELDS if field.name == name)

        def commit(new: float) -> None:
            given = round(new) if whole and new == round(new) else new
            spec.check(given)
            window.deeds.append(_changing(config, name, given))

        width = imgui.get_content_region_avail().x
        self._numbers.label(ui, name, words, _LABELS * width, None, tip, commit)
        imgui.same_line()
        unit = "" if spec.unit == "1" else spec.unit
        room = imgui.get_content_region_avail().x - imgui.calc_text_size(unit).x - (8.0 if unit else 0.0)
        refusal = self._numbers.build(ui, name, value, spec, room, commit)
        if unit:
            imgui.same_line(0.0, 0.4 * ui.size)
            ui.faint(unit, wrapped=False)
        if refusal:
            ui.text(refusal, ui.theme.error, wrapped=True)

    def _build_choice(
        self, ui: Ui, name: str, words: str, now: str, choices: tuple[str, ...], window: Window
    ) -> None:
        width = imgui.get_content_region_avail().x
        self._numbers.label(ui, name, words, _LABELS * width, None, "", _ignore)
        imgui.same_line()
        chosen = ui.choice(words, now, choices)
        if chosen != now:
            value: object = _SLEEPING[chosen] if name == "sleeping" else chosen
            window.deeds.append(_changing(SimulationConfig, name, value))


def _changing(config: type[Config], name: str, value: object) -> Callable[[World, Window], None]:
    """Return what changes one setting; where it is refused, nothing is changed, and the reason is shown."""

    def deed(world: World, window: Window) -> None:
        window.edits.do(
            SetPhysics({name: value}) if config is PhysicsConfig else SetSimulation({name: value})
        )

    return deed


def _ignore(value: float) -> None:
    """Take no number."""
