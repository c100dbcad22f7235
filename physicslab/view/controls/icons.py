"""The icons of tools and buttons: letters of the font of icons that panels have."""

from __future__ import annotations

__all__ = ["ICONS"]

ICONS = {
    "select": "\uf25a", "circle": "\uf111", "box": "\uf0c8", "block": "\uf068", "pendulum": "\uf5cd",
    "chain": "\uf0c1", "spring": "\uf83e", "remove": "\uf12d", "ruler": "\uf545",
    "protractor": "\uf568", "gate": "\uf11e", "note": "\uf249", "pan": "\uf0b2",
    "more": "\uf141", "stack": "\uf5fd", "pyramid": "\uf5ee", "heap": "\uf1ce", "pit": "\uf5ee",
    "binary": "\uf753", "play": "\uf04b", "pause": "\uf04c", "step": "\uf051", "back": "\uf048",
    "restart": "\uf2f9", "undo": "\uf0e2", "redo": "\uf01e",
}  # fmt: skip
"""Each icon by its name; most names are those of tools."""
