"""How the world is stepped, and what the next body is like: each choice with what ``auto`` took and why."""

from dataclasses import replace

from physicslab.ecs.config import COLLISIONS, CONTACTS, INTEGRATORS, PhysicsConfig, SimulationConfig
from physicslab.ecs.fields import Field
from physicslab.history import SetPhysics, SetSimulation
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.recipe import Recipe
from physicslab.view.window.window import Window
from physicslab.view.workbench.number_field import NumberFields
from physicslab.world import World

_SLEEPING = {"auto": "auto", "yes": True, "no": False}
_NUMBERS: tuple[tuple[str, str, str], ...] = (
    ("linear_damping", "Damping", "Share of the velocity that is lost a second"),
    ("angular_damping", "Damping of turns", "Share of the spin that is lost a second"),
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
        self._build_number(ui, "substeps", "Substeps", simulation.substeps, "Parts of a step", window)
        self._build_choice(ui, "integrator", "Method", simulation.integrator, INTEGRATORS, window)
        if simulation.integrator == "auto":
            ui.faint(f"auto takes {plan.integrator.name}: {plan.reason}")
        self._build_choice(ui, "collisions", "Collisions", simulation.collisions, COLLISIONS, window)
        self._build_choice(ui, "contacts", "Contacts", simulation.contacts, CONTACTS, window)
        asleep = next(name for name, value in _SLEEPING.items() if value == simulation.sleeping)
        self._build_choice(ui, "sleeping", "Sleep", asleep, tuple(_SLEEPING), window)
        for name, words, tip in _NUMBERS:
            self._build_number(ui, name, words, getattr(world.physics, name), tip, window)

    def _build_number(self, ui: Ui, name: str, words: str, value: float, tip: str, window: Window) -> None:
        config: type[Config] = PhysicsConfig if name.endswith("damping") else SimulationConfig
        spec = replace(next(field for field in config.FIELDS if field.name == name), meaning=tip)

        def commit(new: float) -> None:
            spec.check(new)
            window.do_next(_change, config, name, new)

        self._numbers.row(ui, name, words, spec, value, commit, drags=False)

    def _build_choice(
        self, ui: Ui, name: str, words: str, now: str, choices: tuple[str, ...], window: Window
    ) -> None:
        self._numbers.label(ui, name, words, Field(name, "choice"))
        chosen = ui.choice(words, now, choices)
        if chosen != now:
            value: object = _SLEEPING[chosen] if name == "sleeping" else chosen
            window.do_next(_change, SimulationConfig, name, value)


def _change(world: World, window: Window, config: type[Config], name: str, value: object) -> None:
    """Change one setting; where it is refused, nothing is changed, and the reason is shown."""
    window.edits.do(SetPhysics({name: value}) if config is PhysicsConfig else SetSimulation({name: value}))


_ZERO = {"size": "in turn"}
"""Words for a 0 that is no number: sizes that differ from one body to the next."""


class RecipePanel:
    """A row for each property of what is made next."""

    def __init__(self) -> None:
        self._numbers = NumberFields()

    def finish(self) -> str:
        """Take over what is half written in a field, and return why it is refused; empty where it is not."""
        return self._numbers.finish()

    def build(self, ui: Ui, title: str, window: Window) -> None:
        """Build them under a title."""
        ui.gap(0.2)
        ui.rule()
        ui.heading(f"Next {title.lower()}")
        for spec in Recipe.FIELDS:
            self._build_row(ui, spec, window)

    def _build_row(self, ui: Ui, spec: Field, window: Window) -> None:
        def commit(new: float) -> None:
            spec.check(new)
            window.do_next(_change_recipe, spec.name, new)

        value = getattr(window.recipe, spec.name)
        zero = _ZERO.get(spec.name, "")
        self._numbers.row(ui, f"new {spec.name}", spec.name.capitalize(), spec, value, commit, zero=zero)


def _change_recipe(world: World, window: Window, name: str, value: float) -> None:
    change = {name: value}
    window.recipe = replace(window.recipe, **change)
