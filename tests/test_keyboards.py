"""Keyboards of other systems and scripts: what keys count as, what they write, what menus call them."""

from unittest.mock import patch

import pygame
import pytest
from hypothesis import given
from hypothesis import strategies as st
from imgui_bundle import ImVec2, imgui

from physicslab.languages import language
from physicslab.languages.language import Language
from physicslab.view.canvas import keyboard
from physicslab.view.canvas.keyboard import usual_event
from physicslab.view.controls.controls import CONTROLS
from physicslab.view.toolkit.toolkit import Toolkit

CYRILLIC = dict(zip("йцукенгшщзхъфывапролджэячсмитьбю", "qwertyuiop[]asdfghjkl;'zxcvbnm,.", strict=True))
GREEK = dict(zip("ςερτυθιοπασδφγηξκλζχψωβνμ", "wertyuiopasdfghjklzxcvbnm", strict=True))
PLACES = {
    letter: getattr(pygame, f"KSCAN_{letter.upper()}") for letter in "abcdefghijklmnopqrstuvwxyz"
} | {
    "[": pygame.KSCAN_LEFTBRACKET, "]": pygame.KSCAN_RIGHTBRACKET, ";": pygame.KSCAN_SEMICOLON,
    "'": pygame.KSCAN_APOSTROPHE, ",": pygame.KSCAN_COMMA, ".": pygame.KSCAN_PERIOD,
}  # fmt: skip
MODS = st.integers(0, 0xFFFF)


def pressed(key: int, place: int = 0, mod: int = 0, printed: str = "") -> pygame.Event:
    return pygame.Event(pygame.KEYDOWN, key=key, scancode=place, mod=mod, unicode=printed)


@pytest.mark.parametrize(("script", "layout"), [("Cyrillic", CYRILLIC), ("Greek", GREEK)])
def test_letters_of_other_scripts_are_the_latin_ones_in_their_places(
    script: str, layout: dict[str, str]
) -> None:
    for letter, latin in layout.items():
        event = usual_event(pressed(ord(letter), PLACES[latin], printed=letter))
        assert pygame.key.name(event.key) == latin and event.unicode == letter, script


@given(st.integers(0, 0x40000200), st.integers(0, 300))
def test_keys_with_names_of_their_own_stay(key: int, place: int) -> None:
    event = pressed(key, place)
    found = usual_event(event)
    if key < 0x250 or key > 0x10FFFF:  # Latin letters, and keys that print nothing
        assert found is event
    assert found.key == key or chr(found.key).isascii()
    assert usual_event(found) is found, "once is enough"


@given(MODS, st.characters())
def test_on_other_systems_held_keys_stay_but_for_alt_gr(mod: int, printed: str) -> None:
    with patch.object(keyboard, "ON_MAC", False):
        found = usual_event(pressed(pygame.K_8, mod=mod, printed=printed)).mod
    both = mod & pygame.KMOD_CTRL and mod & pygame.KMOD_ALT
    if both and printed.isprintable():
        assert found == mod & ~(pygame.KMOD_CTRL | pygame.KMOD_ALT)
    else:
        assert found == mod


@given(MODS)
def test_on_macos_cmd_is_ctrl(mod: int) -> None:
    with patch.object(keyboard, "ON_MAC", True):
        found = usual_event(pressed(pygame.K_s, mod=mod)).mod
    assert bool(found & pygame.KMOD_CTRL) == bool(mod & (pygame.KMOD_CTRL | pygame.KMOD_META))
    assert not found & pygame.KMOD_META
    others = ~(pygame.KMOD_CTRL | pygame.KMOD_META)
    assert found & others == mod & others


def test_events_of_the_mouse_and_of_text_are_not_touched() -> None:
    for event in (pygame.Event(pygame.TEXTINPUT, text="ф"), pygame.Event(pygame.MOUSEMOTION, pos=(1, 2))):
        with patch.object(keyboard, "ON_MAC", True):
            assert usual_event(event) is event


@pytest.mark.parametrize("code", ["en", "de"])
def test_on_macos_every_text_calls_ctrl_cmd(code: str) -> None:
    with patch.object(language, "ON_MAC", False):
        own = Language(code)
    with patch.object(language, "ON_MAC", True):
        mac = Language(code)
    usual = "Strg" if code == "de" else "Ctrl"
    said = [mac.reword(control.label) for control in CONTROLS if control.label.startswith("Ctrl")]
    assert len(said) > 15 and all(label.startswith("Cmd+") for label in said)
    tip = "Undo one thing: the last edit, the last throw, or the run since Play (Ctrl+Z)"
    assert mac.reword(tip) == own.reword(tip).replace(usual, "Cmd") != own.reword(tip)
    assert mac.say("Ctrl+{key}", key="K") == "Cmd+K" and mac.reword("Controls") == own.reword("Controls")


@pytest.mark.parametrize("on_mac", [False, True])
def test_fields_of_panels_hear_ctrl_on_each_system(on_mac: bool) -> None:
    """Dear ImGui takes Cmd for Ctrl by itself on macOS, from a key that already is."""
    toolkit = Toolkit()
    io = imgui.get_io()
    io.config_mac_osx_behaviors = on_mac
    held = pygame.KMOD_LMETA if on_mac else pygame.KMOD_LCTRL
    with patch.object(keyboard, "ON_MAC", on_mac):
        event = usual_event(pressed(pygame.K_c, pygame.KSCAN_C, held))
    toolkit.walked = True  # keys are for panels
    assert toolkit.take(event)
    imgui.get_io().display_size = ImVec2(100.0, 100.0)
    imgui.new_frame()
    assert imgui.get_io().key_ctrl and not imgui.get_io().key_super
    imgui.end_frame()
