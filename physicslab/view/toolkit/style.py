"""The theme as Dear ImGui and ImPlot take it, and the fonts of panels."""

import importlib.util
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import ImVec2, ImVec4, imgui, implot

from physicslab.theme import Colour, Theme, mixed
from physicslab.view.canvas.system_font import system_fonts


@dataclass(frozen=True, slots=True)
class Fonts:
    """The letters of panels, plain and bold; both have icons."""

    plain: imgui.ImFont
    bold: imgui.ImFont


def add_fonts() -> Fonts:
    """Load the fonts into the context that is current."""
    package = importlib.util.find_spec("imgui_bundle")
    assert package is not None and package.submodule_search_locations
    folder = Path(package.submodule_search_locations[0]) / "assets" / "fonts"
    return Fonts(_font(folder, "Regular"), _font(folder, "Bold"))


def _font(folder: Path, weight: str) -> imgui.ImFont:
    atlas = imgui.get_io().fonts
    font = atlas.add_font_from_file_ttf(str(folder / "Roboto" / f"Roboto-{weight}.ttf"), 16.0)
    raised = imgui.ImFontConfig()
    raised.merge_mode = True  # for raised figures, which Roboto has in part
    atlas.add_font_from_file_ttf(str(folder / "Inconsolata-Medium.ttf"), 16.0, raised)
    icons = imgui.ImFontConfig()
    icons.merge_mode = True
    icons.glyph_min_advance_x = 16.0
    icons.glyph_offset = ImVec2(0.0, 1.0)
    atlas.add_font_from_file_ttf(str(folder / "Font_Awesome_6_Free-Solid-900.otf"), 13.0, icons)
    for far in system_fonts():  # their letters are made when they are first written
        others = imgui.ImFontConfig()
        others.merge_mode = True
        atlas.add_font_from_file_ttf(str(far), 19.0, others)
    return font


def packed(colour: Colour, opacity: float = 1.0) -> int:
    """Return a colour as draw lists take it."""
    red, green, blue = colour
    return red | green << 8 | blue << 16 | round(255 * opacity) << 24


def as_vector(colour: Colour, opacity: float = 1.0) -> ImVec4:
    """Return a colour as styles and plots take it."""
    return imgui.color_convert_u32_to_float4(packed(colour, opacity))


def bar_height(text: int) -> int:
    """Return how high buttons and the menu bar are [px], for text of a height [px]."""
    return text + 2 * _padding(text)


def _padding(text: float) -> int:
    return round(0.25 * text)


def apply_theme(theme: Theme, size: float) -> None:
    """Give panels and plots the colours of a theme, and room in proportion to their text, so many px high."""
    style, unit, kinds = imgui.get_style(), size / 16.0, imgui.Col_
    style.font_size_base = size
    style.window_rounding, style.child_rounding, style.popup_rounding = 8 * unit, 8 * unit, 6 * unit
    style.frame_rounding = style.grab_rounding = style.tab_rounding = 5 * unit
    style.window_border_size = style.popup_border_size = 1.0
    style.frame_padding = ImVec2(round(8 * unit), _padding(size))
    style.item_spacing = ImVec2(round(8 * unit), round(4 * unit))
    style.item_inner_spacing = ImVec2(round(6 * unit), round(4 * unit))
    style.window_padding = ImVec2(round(12 * unit), round(10 * unit))
    style.cell_padding = ImVec2(round(4 * unit), round(2 * unit))
    style.scrollbar_size, style.grab_min_size = round(9 * unit), round(12 * unit)
    style.window_menu_button_position = imgui.Dir.none
    style.indent_spacing, style.window_title_align = round(14 * unit), ImVec2(0.0, 0.5)
    lit, lit_more = mixed(theme.key, theme.accent, 0.22), mixed(theme.key, theme.accent, 0.4)
    for kind, colour, opacity in (
        (kinds.window_bg, theme.panel, 1.0), (kinds.popup_bg, theme.panel, 1.0),
        (kinds.child_bg, theme.panel, 0.0), (kinds.menu_bar_bg, theme.panel, 1.0),
        (kinds.border, theme.outline, 1.0), (kinds.text, theme.text, 1.0),
        (kinds.text_disabled, theme.faint, 1.0), (kinds.frame_bg, theme.key, 1.0),
        (kinds.frame_bg_hovered, lit, 1.0), (kinds.frame_bg_active, lit_more, 1.0),
        (kinds.title_bg, theme.panel, 1.0), (kinds.title_bg_active, theme.panel, 1.0),
        (kinds.title_bg_collapsed, theme.panel, 1.0),
        (kinds.button, theme.key, 1.0), (kinds.button_hovered, lit, 1.0),
        (kinds.button_active, lit_more, 1.0), (kinds.header, theme.key, 1.0),
        (kinds.header_hovered, lit, 1.0), (kinds.header_active, lit_more, 1.0),
        (kinds.slider_grab, theme.accent, 1.0), (kinds.slider_grab_active, theme.accent, 1.0),
        (kinds.check_mark, theme.accent, 1.0), (kinds.checkbox_selected_bg, theme.key, 1.0),
        (kinds.input_text_cursor, theme.text, 1.0), (kinds.table_header_bg, theme.key, 1.0),
        (kinds.separator, theme.outline, 1.0),
        (kinds.scrollbar_bg, theme.panel, 0.0), (kinds.scrollbar_grab, theme.key_rim, 1.0),
        (kinds.tab, theme.panel, 1.0), (kinds.tab_hovered, lit, 1.0), (kinds.tab_selected, theme.key, 1.0),
        (kinds.tab_dimmed, theme.panel, 1.0), (kinds.tab_dimmed_selected, theme.key, 1.0),
        (kinds.tab_selected_overline, theme.accent, 1.0),
        (kinds.tab_dimmed_selected_overline, theme.outline, 1.0),
        (kinds.docking_preview, theme.accent, 0.6), (kinds.docking_empty_bg, theme.background, 0.0),
        (kinds.separator_hovered, theme.accent, 1.0), (kinds.separator_active, theme.accent, 1.0),
        (kinds.plot_histogram, theme.accent, 1.0), (kinds.text_selected_bg, theme.accent, 0.35),
        (kinds.table_row_bg_alt, theme.key, 0.35), (kinds.nav_cursor, theme.accent, 1.0),
        (kinds.resize_grip, theme.key, 0.0), (kinds.modal_window_dim_bg, theme.background, 0.6),
    ):  # fmt: skip
        style.set_color_(kind, as_vector(colour, opacity))
    plot, colours = implot.get_style(), implot.Col_
    plot.fit_padding = ImVec2(0.0, 0.08)  # or a line that stays at its largest lies under the frame
    for name, colour, opacity in (
        (colours.frame_bg, theme.panel, 0.0), (colours.plot_bg, theme.background, 1.0),
        (colours.plot_border, theme.outline, 1.0), (colours.legend_bg, theme.panel, 0.85),
        (colours.legend_border, theme.outline, 1.0), (colours.legend_text, theme.text, 1.0),
        (colours.axis_text, theme.faint, 1.0), (colours.axis_grid, theme.axis, 1.0),
        (colours.inlay_text, theme.text, 1.0), (colours.title_text, theme.text, 1.0),
    ):  # fmt: skip
        plot.set_color_(name, as_vector(colour, opacity))
