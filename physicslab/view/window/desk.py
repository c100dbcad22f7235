"""The window beside the world, as scene files keep it."""

from operator import attrgetter

from physicslab.state import contents
from physicslab.view.window.window import Window

_MEANINGS = (
    "The world first, few figures", "Energies, momenta and their changes", "Methods, systems and their cost",
)  # fmt: skip
LEVELS = dict(zip(contents.LEVELS, _MEANINGS, strict=True))
"""How much the panel at the right shows, with what each level is for."""
SHOWN_BY = {
    "arrows": "overlays.arrows", "centres": "overlays.centres", "grid": "grid", "impacts": "impacts.shown",
    "impulses": "overlays.impulses", "momenta": "overlays.momenta", "panel": "figures",
    "parts": "overlays.parts", "stopwatch": "shows_stopwatch",
}  # fmt: skip
"""Switches of the window that show a thing, by its word in scene files."""


def desk_of(window: Window) -> contents.Desk:
    """Return what a window shows."""
    shown = frozenset(word for word, path in SHOWN_BY.items() if attrgetter(path)(window))
    return contents.Desk(window.level, shown)


def restore_desk(window: Window, desk: contents.Desk) -> None:
    """Show what a scene says."""
    window.level = desk.level
    for word, path in SHOWN_BY.items():
        window.put(path, word in desk.shown)
