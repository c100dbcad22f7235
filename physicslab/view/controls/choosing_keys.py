"""Keys of one's own choice: each thing to do has its usual key until it is given another."""

from collections.abc import Mapping

import pygame

from physicslab.view.controls.controls import CONTROLS, KEYS, Control
from physicslab.view.controls.keyboard import ARROWS
from physicslab.view.window.window import Window
from physicslab.world import World

_STAY = ("escape", "return", "menu", *ARROWS)
"""Keys of what is the same in every program."""
_CAPS = {"delete": "Del", "escape": "Esc", "return": "Enter", "backspace": "Backspace", "page up": "Page Up"}
_HELD = ("ctrl+", "shift+")


def is_open(control: Control) -> bool:
    """Whether a control may get another key."""
    return bool(control.key) and control.action is not None and control.key not in _STAY


def label_of(control: Control, window: Window) -> str:
    """Return the key of a control, as it is written on its cap."""
    key = window.keys.chosen.get(control.does)
    return control.label if key is None else cap(key)


def cap(key: str) -> str:
    """Return the name of a key as people write it.

    >>> cap("ctrl+shift+d"), cap("delete"), cap("f2"), cap("+")
    ('Ctrl+Shift+D', 'Del', 'F2', '+')
    """
    held = [part for part in _HELD if part in key and key != part]
    name = key
    for part in held:
        name = name.removeprefix(part)
    return "".join(part.capitalize() for part in held) + _CAPS.get(name, name.title())


def usual(keys: tuple[str, ...], window: Window) -> tuple[str, ...]:
    """Return the usual keys in whose place some were pressed; none where theirs has another key now."""
    chosen = window.keys.chosen
    if not chosen:
        return keys
    for control in CONTROLS:
        if chosen.get(control.does) == keys[0]:
            return (control.key,)
    away = {control.key for control in CONTROLS if control.does in chosen}
    return tuple(key for key in keys if key not in away)


def why_not(key: str, does: str, chosen: Mapping[str, str]) -> str:
    """Return why a key cannot be chosen for what does something, in words for people; empty where it can."""
    for control in CONTROLS:
        own = chosen.get(control.does, control.key)
        if control.does != does and key in (own, *control.also):
            return f"{cap(key)} already does: {control.does}"
    usual_of = next((control.key for control in CONTROLS if control.does == does), "")
    known = {control.key for control in CONTROLS}
    if key != usual_of and key in KEYS and key not in known:
        return f"{cap(key)} moves things or takes a tool"
    return ""


def choose_key(world: World, window: Window, key: str) -> None:
    """Give a key to what asks for one; Esc leaves it as it is, Backspace brings the usual one back."""
    keys, does = window.keys, window.keys.asks
    usual_of = next(control.key for control in CONTROLS if control.does == does)
    if key == "escape":
        keys.asks = ""
        return
    others = {other: name for other, name in keys.chosen.items() if other != does}
    wanted = usual_of if key == "backspace" else key
    reason = why_not(wanted, does, others)
    if reason:
        window.notify(f"{reason}. Press another key, or Esc", 6.0, failed=True)
        return
    keys.asks = ""
    keys.chosen = others if wanted == usual_of else {**others, does: wanted}


def bring_usual(world: World, window: Window) -> None:
    """Let every key do what it usually does."""
    window.keys.chosen, window.keys.asks = {}, ""


def read_choice(found: object) -> tuple[dict[str, str], str]:
    """Return the keys of a file of preferences that can be, and what is wrong with the others, in a line."""
    chosen: dict[str, str] = {}
    if not isinstance(found, dict):
        return chosen, f"keys = {found!r:.40}: must be an object"
    wrong = ""
    for does, key in found.items():
        control = next((one for one in CONTROLS if one.does == does and is_open(one)), None)
        reason = "nothing with a key of its own does that" if control is None else ""
        if not reason and not _is_key(key):
            reason = "must be the name of a key"
        reason = reason or why_not(key, does, {name: own for name, own in found.items() if name != does})
        if reason:
            wrong = wrong or f'keys["{does:.40}"] = {key!r:.40}: {reason}'
        else:
            chosen[does] = key
    return chosen, wrong


def _is_key(name: object) -> bool:
    if not isinstance(name, str):
        return False
    plain = name.removeprefix("ctrl+").removeprefix("shift+")
    try:
        return plain == "+" or pygame.key.key_code(plain) != 0
    except (ValueError, pygame.error):
        return False
