"""Theme: one frozen record that holds every colour there is."""

import ast
import dataclasses
import itertools
import re
from pathlib import Path

import numpy as np
import pygame
import pytest
from desk import empty_world, sized
from imgui_bundle import imgui

import physicslab
from physicslab.components.colour import rgb_of
from physicslab.components.made_of import SUBSTANCES
from physicslab.components.quantities import ENERGY_CAUSES
from physicslab.theme import DARK, LEGIBLE, LIGHT, THEMES, Colour, Theme, contrast
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Finish, Look
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.controls.tools import TOOLS
from physicslab.view.overlay.arrows import CONTACT_NORMAL, FORCE, FRICTION_IMPULSE, NORMAL_IMPULSE, VELOCITY
from physicslab.view.picture.backdrop import draw_backdrop
from physicslab.view.workbench.menus import ICON_BODIES, ICON_COLOURS
from physicslab.view.workbench.world_panel import _colour

# What the three common kinds of colour blindness make of linear RGB (Machado, Oliveira & Fernandes, 2009).
SEEN_BY = {
    "all": np.eye(3),
    "protanopes": [[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]],
    "deuteranopes": [[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]],
    "tritanopes": [[1.256, -0.077, -0.179], [-0.078, 0.931, 0.148], [0.005, 0.691, 0.304]],
}


HASHED = re.compile(r"#[0-9a-fA-F]{3,8}$")


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
    for rim in (*theme.bodies, theme.static, theme.kinematic, theme.held, theme.spring):
        assert contrast(rim, theme.background) >= 3.0
    for kind in ARROWS:
        assert contrast(kind.colour(theme), theme.background) >= 3.0
    assert contrast(theme.friction_cone, theme.background) >= 3.0


def test_no_two_arrows_are_distinguished_by_colour_alone() -> None:
    assert len({kind.head for kind in ARROWS}) == len(ARROWS)


@pytest.mark.parametrize("theme", THEMES, ids=lambda theme: theme.name)
def test_ticks_and_carets_are_seen_on_what_they_stand_on(theme: Theme) -> None:
    """Dear ImGui has its own dark colours where none are given: a ticked box was black on the light theme."""
    desk = sized((640, 480))
    desk.window.theme = theme
    desk.frames(2)
    desk.sandbox.interface.toolkit.enter()
    kinds = imgui.Col_
    for kind, under in (
        (kinds.check_mark, kinds.checkbox_selected_bg),
        (kinds.input_text_cursor, kinds.frame_bg),
    ):
        of, on = (
            (round(255 * one.x), round(255 * one.y), round(255 * one.z))
            for one in (imgui.get_style().color_(kind), imgui.get_style().color_(under))
        )
        assert contrast(of, on) >= 3.0
    assert imgui.get_style().color_(kinds.checkbox_selected_bg) == imgui.get_style().color_(kinds.frame_bg)


def test_another_theme_is_one_record_away() -> None:
    light = dataclasses.replace(DARK, background=(250, 250, 250))
    assert isinstance(light, Theme)
    assert light.fill((0, 0, 0)) == (45, 45, 45)
    assert not LIGHT.is_dark and DARK.is_dark


def painted(theme: Theme, rim: Colour) -> Colour:
    """Return the mean colour inside a box of a moving body, as it is painted."""
    canvas = PygameCanvas(pygame.Surface((60, 60), 0, 32))
    fill, edge = (np.array([colour], np.uint8) for colour in (theme.fill(rim), rim))
    look = Look(fill, edge, np.array([Finish.LIT], np.int64))
    canvas.boxes(np.array([[30.0, 30.0]]), np.array([[50.0, 50.0]]), np.zeros(1), look)
    red, green, blue = pygame.surfarray.array3d(canvas.surface)[8:52, 8:52].mean(axis=(0, 1)).tolist()
    return red, green, blue


@every_theme
def test_bodies_as_they_are_painted_stand_out_from_the_sky(theme: Theme) -> None:
    assert 0.75 <= theme.fill_share <= 0.85
    for rim in theme.bodies:
        for sky in (theme.sky_top, theme.sky_bottom):
            assert contrast(painted(theme, rim), sky) >= 4.5


@every_theme
def test_coordinates_can_be_read_over_sky_and_over_ground(theme: Theme) -> None:
    canvas, camera = PygameCanvas(pygame.Surface((120, 900), 0, 32)), Camera((120, 900))
    draw_backdrop(empty_world(bounds=(-9, -9, 9, 9)), camera, theme, canvas, grid=False)
    camera.look_at((0.0, -14.0, 0.0, -14.0), 100.0)
    for _ in range(2):  # first the sky alone, then as much of the ground
        behind = {tuple(colour) for colour in pygame.surfarray.array3d(canvas.surface)[60].tolist()}
        assert min(contrast(theme.coordinate, (r, g, b)) for r, g, b in behind) >= LEGIBLE
        draw_backdrop(empty_world(bounds=(-9, -9, 9, 9)), camera, theme, canvas, grid=False)


@every_theme
def test_rims_of_bodies_stand_out_all_around_from_sky_and_ground(theme: Theme) -> None:
    """The law: fills are lit and dim, so that the rim, at least 2 px wide, has the contrast everywhere."""
    greys = [(n, n, n) for n in range(0, 256, 15)]
    strong = list(itertools.product((0, 128, 255), (0, 128, 255), (0, 128, 255)))
    materials = [rgb_of(substance.colour) for substance in SUBSTANCES.values()]
    chosen = [theme.edge(colour) for colour in (*greys, *strong, *materials)]
    for rim in (*theme.bodies, theme.kinematic, theme.held, *chosen):
        assert min(contrast(rim, sky) for sky in (theme.sky_top, theme.sky_bottom)) >= LEGIBLE
    for rim in (*theme.bodies, theme.kinematic, theme.held):
        assert min(contrast(rim, theme.earth), contrast(rim, theme.within_fluid)) >= LEGIBLE
    assert min(contrast(theme.within_fluid, sky) for sky in (theme.sky_top, theme.sky_bottom)) >= 1.25
    canvas = PygameCanvas(pygame.Surface((60, 60), 0, 32))
    canvas.clear(theme.sky_top, theme.sky_bottom)
    for n, rim in enumerate(theme.bodies):
        fill, edge = (np.array([colour], np.uint8) for colour in (theme.fill(rim), rim))
        look = Look(fill, edge, np.array([Finish.LIT], np.int64))
        canvas.discs(np.array([[30.0, 30.0]]), np.array([20.0]), np.zeros(1), look)
        for x, y in ((30, 11), (30, 48), (11, 30), (48, 30)):
            red, green, blue, _ = canvas.surface.get_at((x, y))
            assert contrast((red, green, blue), theme.sky_top) >= LEGIBLE, n


@every_theme
def test_grid_and_axes_are_seen_and_stay_behind(theme: Theme) -> None:
    for sky in (theme.sky_top, theme.sky_bottom):
        assert 1.3 <= contrast(theme.grid, sky) < 1.8 <= contrast(theme.axis, sky) < 3.0


def test_icons_of_tools_have_the_colours_of_their_things() -> None:
    assert {*ICON_COLOURS, *ICON_BODIES} <= set(TOOLS)
    for theme in THEMES:
        for name in ICON_COLOURS.values():
            assert contrast(getattr(theme, name), theme.key) >= 2.2  # an icon beside its word
        for number in ICON_BODIES.values():
            assert contrast(theme.bodies[number], theme.key) >= 3.0


@pytest.mark.parametrize("theme", THEMES, ids=lambda theme: theme.name)
def test_causes_of_energy_can_be_told_apart(theme: Theme) -> None:
    """What a hand, edits, a thrust and joints gave had one colour."""
    paints = [_colour(name, theme) for name in ENERGY_CAUSES]
    assert all(np.linalg.norm(np.subtract(*two)) > 15.0 for two in itertools.combinations(paints, 2))
