"""SDL's events as Dear ImGui takes them."""

from __future__ import annotations

import pygame
from imgui_bundle import imgui

__all__ = ["AWAY", "feed"]

_BUTTONS = {pygame.BUTTON_LEFT: 0, pygame.BUTTON_RIGHT: 1, pygame.BUTTON_MIDDLE: 2}
_KEYS = {
    pygame.K_TAB: imgui.Key.tab, pygame.K_LEFT: imgui.Key.left_arrow, pygame.K_RIGHT: imgui.Key.right_arrow,
    pygame.K_UP: imgui.Key.up_arrow, pygame.K_DOWN: imgui.Key.down_arrow,
    pygame.K_PAGEUP: imgui.Key.page_up, pygame.K_PAGEDOWN: imgui.Key.page_down,
    pygame.K_HOME: imgui.Key.home, pygame.K_END: imgui.Key.end, pygame.K_DELETE: imgui.Key.delete,
    pygame.K_BACKSPACE: imgui.Key.backspace, pygame.K_SPACE: imgui.Key.space,
    pygame.K_RETURN: imgui.Key.enter, pygame.K_KP_ENTER: imgui.Key.enter, pygame.K_ESCAPE: imgui.Key.escape,
    pygame.K_a: imgui.Key.a, pygame.K_c: imgui.Key.c, pygame.K_v: imgui.Key.v, pygame.K_x: imgui.Key.x,
    pygame.K_y: imgui.Key.y, pygame.K_z: imgui.Key.z,
}  # fmt: skip
"""The keys that matter to text and menus."""
_HELD = {getattr(pygame, f"KMOD_{key}"): imgui.Key[f"mod_{key.lower()}"] for key in ("CTRL", "SHIFT", "ALT")}
AWAY = (pygame.WINDOWFOCUSLOST, pygame.WINDOWMINIMIZED, pygame.WINDOWHIDDEN)
"""Events after which no button counts as held."""


def feed(io: imgui.IO, event: pygame.Event) -> None:
    """Hand an event to Dear ImGui; those that it has no use for are left out."""
    match event.type:
        case pygame.MOUSEMOTION:
            io.add_mouse_pos_event(*map(float, event.pos))
        case pygame.MOUSEBUTTONDOWN | pygame.MOUSEBUTTONUP if event.button in _BUTTONS:
            io.add_mouse_pos_event(*map(float, event.pos))
            io.add_mouse_button_event(_BUTTONS[event.button], event.type == pygame.MOUSEBUTTONDOWN)
        case pygame.MOUSEWHEEL:
            across = float(getattr(event, "precise_x", getattr(event, "x", 0.0)))
            io.add_mouse_wheel_event(-across, float(getattr(event, "precise_y", event.y)))
        case pygame.KEYDOWN | pygame.KEYUP:
            mod = getattr(event, "mod", 0)
            for mask, key in _HELD.items():
                io.add_key_event(key, bool(mod & mask))
            if event.key in _KEYS:
                io.add_key_event(_KEYS[event.key], event.type == pygame.KEYDOWN)
        case pygame.TEXTINPUT:
            io.add_input_characters_utf8(event.text)
        case _ if event.type in AWAY:
            io.add_focus_event(False)
