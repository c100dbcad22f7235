"""Menus from which a quantity of a body, or of the world, is chosen."""

from collections.abc import Callable, Iterable
from contextlib import nullcontext

from physicslab.components import Transform, Velocity
from physicslab.components.quantities import BODY_QUANTITIES, QUANTITIES, WORLD_QUANTITIES
from physicslab.view.canvas.quantities import written_unit
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.record import Key
from physicslab.view.window.window import Window
from physicslab.world import World

_OFFERED = 24
"""Bodies that a menu lists beside those that are selected or shown already."""


def _grouped(names: Iterable[str]) -> dict[str, list[str]]:
    """Return names by the group in which a menu has them."""
    groups: dict[str, list[str]] = {}
    for name in names:
        groups.setdefault(QUANTITIES[name].group, []).append(name)
    return groups


_OF_WORLD, _OF_BODY = _grouped(WORLD_QUANTITIES), _grouped(BODY_QUANTITIES)


def unit_of(key: Key) -> str:
    """Return the unit of a quantity, as people write it."""
    return written_unit(QUANTITIES[key[1]].unit)


def scale_of(key: Key, scales: dict[str, float]) -> float:
    """Return how large a quantity is where it is not rounding; 0 of accounts, whose rounding is shown."""
    quantity = QUANTITIES[key[1]]
    return 0.0 if quantity.group else scales.get(quantity.unit, 0.0)


def named_key(key: Key, window: Window) -> str:
    """Return what a quantity is called, with its body: ``"ball: speed"``."""
    return f"{window.dashboard.label(key[0])}: {key[1]}"


def build_quantities(
    ui: Ui, world: World, window: Window, shown: Iterable[Key], choose: Callable[[Key], None]
) -> None:
    """Build a menu for the world and for each body, with a line for each of its quantities.

    Parameters
    ----------
    shown : iterable of Key
        What is marked: it is chosen already.
    choose : callable
        Called with what is clicked.
    """
    marked = set(shown)
    for body in (None, *_offered(world, window, marked)):
        name = "The world" if body is None else world.label(body)
        with ui.menu(name, f"quantities of {body}") as is_open:
            if not is_open:
                continue
            for group, quantities in (_OF_WORLD if body is None else _OF_BODY).items():
                with ui.menu(group) if group else nullcontext(True) as is_unfolded:
                    for quantity in quantities if is_unfolded else ():
                        key = (body, quantity)
                        if ui.item(f"{quantity} [{unit_of(key)}]", on=key in marked):
                            choose(key)


def _offered(world: World, window: Window, marked: set[Key]) -> list[int]:
    """Return the bodies of a menu: those that are shown or selected, those that move, and others."""
    chosen = [*(body for body, _ in sorted(marked, key=str)), *window.selection.entities]
    moving, placed = world.batch(Transform, Velocity), world.batch(Transform)
    offered = [*moving.entities[:_OFFERED].tolist(), *placed.entities[:_OFFERED].tolist()]
    there = set(placed.entities.tolist())
    bodies = dict.fromkeys(body for body in (*chosen, *offered[:_OFFERED]) if body in there)
    return [body for body in bodies if body is not None]
