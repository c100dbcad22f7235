"""Theme: one frozen record that holds every colour there is."""

import ast
import dataclasses
import itertools
import re
from pathlib import Path

import numpy as np
import pytest

import physicslab
from physicslab.view.canvas.theme import DARK, THEMES, Colour, Theme
from physicslab.view.overlay.arrows import (
    CONTACT_NORMAL,
    FORCE,
    FRICTION_IMPULSE,
    NORMAL_IMPULSE,
    VELOCITY,
)

# What the three common kinds of colour blindness make of linear RGB (Machado, Oliveira & Fernandes, 2009).
SEEN_BY = {
    "all": np.eye(3),
    "protanopes": [[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]],
    "deuteranopes": [[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]],
    "tritanopes": [[1.256, -0.077, -0.179], [-0.078, 0.931, 0.148], [0.005, 0.691, 0.304]],
}


HASHED = re.compile(r"#[0-9a-fA-F]{3,8}$")


def luminance(colour: Colour) -> float:
    """Return the relative luminance of sRGB (WCAG 2)."""
    parts = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in (p / 255 for p in colour)]
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]


def contrast(a: Colour, b: Colour) -> float:
    """Return the contrast ratio (WCAG 2)."""
    darker, lighter = sorted((luminance(a), luminance(b)))
    return (lighter + 0.05) / (darker + 0.05)


def test_a_theme_cannot_be_changed() -> None:
    assert not hasattr(DARK, "__dict__")
    with pytest.raises(dataclasses.FrozenInstanceError):
        DARK.background = (0, 0, 0)  # type: ignore[misc]


def test_no_colour_is_written_anywhere_else() -> None:
    folder = Path(physicslab.__file__).parent
    sources = [
        source for part in ("view", "systems", "desktop") for source in folder.joinpath(part).rglob("*.py")
    ]
    assert len(sources) > 60
    found = []
    for source in sources:
        if source.name == "theme.py":
            continue
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Tuple) and len(node.elts) in (3, 4):
                values = [part.value for part in node.elts if isinstance(part, ast.Constant)]
                if len(values) == len(node.elts) and all(type(v) is int and 0 <= v <= 255 for v in values):
                    found.append(f"{source.name}:{node.lineno}")
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and HASHED.match(node.value):
                found.append(f"{source.name}:{node.lineno}")
            if isinstance(node, ast.Attribute) and node.attr == "Color":
                found.append(f"{source.name}:{node.lineno}")
    assert not found


every_theme = pytest.mark.parametrize("theme", THEMES, ids=lambda theme: theme.name)
WORDS = ["text", "faint", "heading", "accent", "paused", "slow", "planet", "warning", "error", "notice"]
ARROWS = (VELOCITY, FORCE, CONTACT_NORMAL, NORMAL_IMPULSE, FRICTION_IMPULSE)


@every_theme
@pytest.mark.parametrize("name", WORDS)
def test_words_can_be_read_on_a_panel(name: str, theme: Theme) -> None:
    assert contrast(getattr(theme, name), theme.panel) >= 4.5  # WCAG 2 AA


@every_theme
def test_words_can_be_read_on_keys_and_buttons(theme: Theme) -> None:
    for words in (theme.text, theme.heading, theme.accent):
        assert contrast(words, theme.key) >= 4.5


@every_theme
@pytest.mark.parametrize("eyes", SEEN_BY)
def test_bodies_differ_for_all_eyes(eyes: str, theme: Theme) -> None:
    seen = [np.asarray(SEEN_BY[eyes]) @ np.array(rim) for rim in theme.bodies]
    for a, b in itertools.combinations(seen, 2):
        assert np.linalg.norm(a - b) > 25.0


@every_theme
def test_bodies_and_arrows_stand_out_from_the_background(theme: Theme) -> None:
    for rim in (*theme.bodies, theme.static, theme.kinematic, theme.held, theme.spring, theme.bounds):
        assert contrast(rim, theme.background) >= 3.0
    for kind in ARROWS:
        assert contrast(kind.colour(theme), theme.background) >= 3.0
    assert contrast(theme.friction_cone, theme.background) >= 3.0


def test_no_two_arrows_are_distinguished_by_colour_alone() -> None:
    assert len({kind.head for kind in ARROWS}) == len(ARROWS)


def test_another_theme_is_one_record_away() -> None:
    light = dataclasses.replace(DARK, background=(250, 250, 250))
    assert isinstance(light, Theme)
    assert light.fill((0, 0, 0)) == (120, 120, 120)
