"""Keys as the program knows them, whatever the system and the layout of the keyboard."""

import sys
import unicodedata

import pygame

ON_MAC = sys.platform == "darwin"
_LETTERS = {4 + n: letter for n, letter in enumerate("abcdefghijklmnopqrstuvwxyz")}
_DIGITS = {30 + n: digit for n, digit in enumerate("1234567890")}
_SIGNS = {45: "-", 46: "=", 47: "[", 48: "]", 51: ";", 52: "'", 53: "`", 54: ",", 55: ".", 56: "/"}
_LATIN = _LETTERS | _DIGITS | _SIGNS
"""Names of keys by their places, the scancodes of USB, on a keyboard with Latin letters."""
_ALT_GR = pygame.KMOD_CTRL | pygame.KMOD_ALT
"""What Windows reports while AltGr is held."""
_LARGEST = 0x10FFFF
"""Keys above it print nothing, and have numbers of SDL's own."""


def usual_event(event: pygame.Event) -> pygame.Event:
    """Return an event of a key as all else reads it; any other event as it is.

    Letters of other scripts, as Cyrillic and Greek, become the Latin one in their place; what they print
    stays, so text is written with them. On macOS Cmd is Ctrl. AltGr, with which a key prints what it does not
    alone, is no Ctrl and no Alt.
    """
    if event.type not in (pygame.KEYDOWN, pygame.KEYUP):
        return event
    own = getattr(event, "mod", 0)
    mod = _held(own, getattr(event, "unicode", ""))
    key = _latin(event.key, getattr(event, "scancode", 0))
    if (key, mod) == (event.key, own):
        return event
    return pygame.Event(event.type, {**event.dict, "key": key, "mod": mod})


def held_keys() -> int:
    """Return which keys are held beside others now, as ``KMOD_`` bits."""
    return _held(pygame.key.get_mods(), "")


def _held(mod: int, printed: str) -> int:
    if ON_MAC and mod & pygame.KMOD_META:
        mod = mod & ~pygame.KMOD_META | pygame.KMOD_LCTRL
    is_alt_gr = mod & pygame.KMOD_CTRL and mod & pygame.KMOD_ALT and printed.isprintable() and printed
    return mod & ~_ALT_GR if is_alt_gr else mod


def _latin(key: int, place: int) -> int:
    letter = chr(key) if 127 < key <= _LARGEST else ""
    if letter.isalpha() and not unicodedata.name(letter, "").startswith("LATIN") and place in _LATIN:
        return ord(_LATIN[place])
    return key
