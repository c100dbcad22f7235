"""What the next body is like that is made with the mouse."""

from __future__ import annotations

from dataclasses import replace

from physicslab.ecs.fields import Field
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.recipe import Recipe
from physicslab.view.window.window import Window
from physicslab.view.workbench.number_field import NumberFields
from physicslab.world import World

__all__ = ["RecipePanel"]

_ZERO = {"size": "in turn"}
"""What 0 means where it is no number: sizes that differ from one body to the next."""


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
            window.do_next(_change, spec.name, new)

        value = getattr(window.recipe, spec.name)
        zero = _ZERO.get(spec.name, "")
        self._numbers.row(ui, f"new {spec.name}", spec.name.capitalize(), spec, value, commit, zero=zero)


def _change(world: World, window: Window, name: str, value: float) -> None:
    change = {name: value}
    window.recipe = replace(window.recipe, **change)
