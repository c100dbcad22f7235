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
_NUMBERS = {
    "dt": ("Step", "Length of a step; the error falls with it"), "substeps": ("Substeps", "Parts of a step"),
    "linear_damping": ("Damping", "Share of the velocity that is lost a second"),
    "angular_damping": ("Damping of turns", "Share of the spin that is lost a second"),
}  # fmt: skip
_CHOICES = {
    "integrator": ("Method", INTEGRATORS), "collisions": ("Collisions", COLLISIONS),
    "contacts": ("Contacts", CONTACTS), "sleeping": ("Sleep", tuple(_SLEEPING)),
}  # fmt: skip
_ROWS = ("dt", "substeps", *_CHOICES, "linear_damping", "angular_damping")


def build_settings(ui: Ui, numbers: NumberFields, world: World, window: Window) -> None:
    """Build a row for each of the step, the method, collisions, contacts, sleep and damping."""
    ui.gap(0.2)
    ui.heading("Settings")
    for name in _ROWS:
        held = world.physics if name.endswith("damping") else world.simulation
        now = getattr(held, name)
        if name in _NUMBERS:
            _build_number(ui, numbers, window, held, name)
            continue
        words, choices = _CHOICES[name]
        numbers.label(ui, name, words, Field(name, "choice"))
        now = next(word for word, value in _SLEEPING.items() if value == now) if name == "sleeping" else now
        chosen = ui.choice(words, now, choices)
        if chosen != now:
            window.do_next(_change, held, name, _SLEEPING[chosen] if name == "sleeping" else chosen)
        if name == "integrator" and now == "auto":
            ui.faint(f"auto takes {world.plan.integrator.name}: {world.plan.reason}")


def _build_number(
    ui: Ui, numbers: NumberFields, window: Window, held: PhysicsConfig | SimulationConfig, name: str
) -> None:
    words, tip = _NUMBERS[name]
    spec = replace(next(field for field in held.FIELDS if field.name == name), meaning=tip)

    def commit(new: float) -> None:
        spec.check(new)
        window.do_next(_change, held, name, new)

    numbers.row(ui, name, words, spec, getattr(held, name), commit, drags=False)


def _change(
    world: World, window: Window, held: PhysicsConfig | SimulationConfig, name: str, value: object
) -> None:
    """Change one setting; where it is refused, nothing is changed, and the reason is shown."""
    command = SetPhysics if isinstance(held, PhysicsConfig) else SetSimulation
    window.edits.do(command({name: value}))


_ZERO = {"size": "in turn"}
"""Words for a 0 that is no number: sizes that differ from one body to the next."""


def build_recipe(ui: Ui, numbers: NumberFields, title: str, window: Window) -> None:
    """Build a row for each property of what is made next, under a title."""
    ui.rule(0.2)
    ui.heading(f"Next {title.lower()}")
    for spec in Recipe.FIELDS:

        def commit(new: float, spec: Field = spec) -> None:
            spec.check(new)
            window.do_next(lambda _, window: window.put("recipe", replace(window.recipe, **{spec.name: new})))

        zero, value = _ZERO.get(spec.name, ""), getattr(window.recipe, spec.name)
        numbers.row(ui, f"new {spec.name}", spec.name.capitalize(), spec, value, commit, zero=zero)
