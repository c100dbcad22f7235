"""What panels write while a test looks: each word with its place, and what of it can be seen."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

import pygame
import pytest
from imgui_bundle import imgui

__all__ = ["Written", "watch"]


@dataclass(frozen=True, slots=True)
class Word:
    """A piece of text: in which panel, where, and where that panel can show anything [px]."""

    panel: str
    words: str
    rect: pygame.Rect
    seen: pygame.Rect
    scrolls: bool


@dataclass(slots=True)
class Written:
    """All texts and buttons of the frame that was built last."""

    words: list[Word] = field(default_factory=list)

    def note(self, words: str, needed: float = 0.0) -> None:
        """Note the item that was built last; ``needed`` is how wide its words are [px]."""
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        window = imgui.internal.get_current_window()
        clip, size = window.inner_clip_rect, (high.x - low.x, high.y - low.y)
        rect = pygame.Rect(round(low.x), round(low.y), round(max(size[0], needed)), round(size[1]))
        seen = pygame.Rect(clip.min.x, clip.min.y, clip.max.x - clip.min.x, clip.max.y - clip.min.y)
        self.words.append(Word(window.name, words, rect, seen, window.scroll_max.y > 0.0))

    def check(self) -> None:
        """Check that nothing is cut, but for what scrolls, and that nothing lies over anything."""
        assert self.words
        for word in self.words:
            cut = word.rect.left < word.seen.left - 1 or word.rect.right > word.seen.right + 1
            if not word.scrolls:
                cut |= word.rect.top < word.seen.top - 1 or word.rect.bottom > word.seen.bottom + 1
            assert not cut, f"{word.words!r} at {word.rect} is cut by {word.panel} {word.seen}"
        for one, two in combinations(self.words, 2):
            if one.panel == two.panel:
                over = one.rect.inflate(-2, -2).colliderect(two.rect.inflate(-2, -2))
                assert not over, f"{one.words!r} lies over {two.words!r} in {one.panel}"


def watch(monkeypatch: pytest.MonkeyPatch) -> Written:
    """Note all texts and buttons from now on, frame by frame."""
    written = Written()
    new_frame, text, button = imgui.new_frame, imgui.text_unformatted, imgui.button

    def begin() -> None:
        written.words.clear()
        new_frame()

    def write(words: str) -> None:
        text(words)
        written.note(words)

    def draw(label: str, *given: Any) -> bool:
        clicked = button(label, *given)
        words = label.split("##")[0]
        written.note(words, imgui.calc_text_size(words).x)
        return clicked

    monkeypatch.setattr(imgui, "new_frame", begin)
    monkeypatch.setattr(imgui, "text_unformatted", write)
    monkeypatch.setattr(imgui, "button", draw)
    return written
