"""Where actions are found: the menus at the top, the tools at the left, and the help, which lists keys."""

from bisect import bisect
from collections.abc import Callable, Sequence
from itertools import accumulate
from pathlib import Path

from imgui_bundle import ImVec2, imgui

from physicslab.ecs.text import printable
from physicslab.files.listing import scene_files
from physicslab.languages.catalogue import languages
from physicslab.lessons.catalogue import titles
from physicslab.scenes import SCENES
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.drawable_text import shortened
from physicslab.view.controls import actions, file_actions
from physicslab.view.controls.choosing_keys import bring_usual, is_open, label_of
from physicslab.view.controls.controls import CONTROLS, Control
from physicslab.view.controls.joining import JOINTS
from physicslab.view.controls.lesson_actions import LANGUAGES, choose_language, open_lesson
from physicslab.view.controls.saving import scene_words
from physicslab.view.controls.spawning import BODIES, GROUPS
from physicslab.view.controls.tool import ICONS, Tool
from physicslab.view.controls.tools import DRAWING, MORE_TOOLS, PALETTE, TOOL_GROUPS, key_of
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui
from physicslab.view.toolkit.windows import NARROW, widget_label
from physicslab.view.window.window import Window
from physicslab.view.workbench.file_panels import recent_label
from physicslab.view.workbench.trust_badge import badge_width, build_badge
from physicslab.world import World

_MAX_TITLE = 60


def build_menu_bar(ui: Ui, world: World, window: Window) -> None:
    """Build the menus, and the title of the scene at the right; menus without room are in a last one."""
    if not imgui.begin_main_menu_bar():
        return
    names = list(_MENUS)
    if ui.keys_go_to == "menu":
        _begin_walk(names[0])
    beside = _beside(ui, names)
    for name in names[:beside]:
        _build_menu(ui, name, world, window)
    if beside < len(names):
        with ui.menu(_MORE) as is_open:
            for name in names[beside:] if is_open else ():
                _build_menu(ui, name, world, window)
    _build_right(ui, world, window)
    imgui.end_main_menu_bar()


def _build_menu(ui: Ui, name: str, world: World, window: Window) -> None:
    with ui.menu(name) as is_open:
        if is_open:
            build = _MENUS[name]
            if isinstance(build, tuple):
                _build_controls(ui, build, world, window)
            else:
                build(ui, world, window)


def _beside(ui: Ui, names: Sequence[str]) -> int:
    """Return for how many menus there is room in the bar, beside one for the others if that is not all."""
    room, between = imgui.get_content_region_avail().x, 2.0 * imgui.get_style().item_spacing.x
    ends = list(accumulate(ui.width(name) + between for name in names))
    if ends[-1] <= room:
        return len(names)
    return max(bisect(ends, room - ui.width(_MORE) - between), 1)


def _build_right(ui: Ui, world: World, window: Window) -> None:
    """Build the badge at the right, and the title of the scene where there is room for both."""
    title = shortened(ui.said(printable(scene_words(world, window))), _MAX_TITLE)
    room, width = imgui.get_content_region_avail().x, imgui.calc_text_size(title).x
    beside = room - width - ui.size
    is_titled = badge_width(ui, world, window) <= beside
    build_badge(ui, world, window, beside if is_titled else room)
    if is_titled:
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x - width)
        ui.faint(title, wrapped=False)


def _begin_walk(menu: str) -> None:
    """Put the mark of the keys on a menu."""
    bar = imgui.internal
    bar.focus_window(bar.get_current_window())
    bar.set_nav_id(imgui.get_id(widget_label(menu, menu)), bar.NavLayer.menu, 0, bar.ImRect())
    imgui.set_nav_cursor_visible(True)


def _build_controls(ui: Ui, groups: tuple[str, ...], world: World, window: Window) -> None:
    for n, group in enumerate(groups):
        if n:
            ui.rule()
        for control in CONTROLS:
            if control.group == group:
                on, keys = control.on(world, window), label_of(control, window)
                enabled = control.is_open(window)
                ui.item(control.title, control.pressed, keys=keys, on=on, enabled=enabled, tip=control.tip)
        if group == "file":
            with ui.menu("Recent files") as shown:
                if shown:
                    _build_recent(ui, window)
        if group == "view":
            with ui.menu("Language") as shown:
                for code in languages() if shown else ():
                    ui.item(LANGUAGES.get(code, code), choose_language, code, on=window.language == code)


def _build_recent(ui: Ui, window: Window) -> None:
    """Build a line for each of the files that were opened or saved last."""
    there = window.scenes.recent.there
    if not there:
        ui.faint("None was opened or saved yet", wrapped=False)
    for number, path in enumerate(there, start=1):
        ui.item(recent_label(number, path), file_actions.open_from_list, path, tip=printable(str(path)))


def _build_tools(ui: Ui, world: World, window: Window) -> None:
    """Build a line for each tool that draws: bodies, joints, groups of bodies."""
    groups = (BODIES, JOINTS, GROUPS)
    for n, group in enumerate(groups):
        if n:
            ui.rule()
        for tool in (DRAWING[drawn.name] for drawn in group):
            ui.item(
                f"Draw {tool.title}", actions.choose_tool, tool, shown=_words(ui, tool), keys=key_of(tool),
                on=window.tool == tool.name, tip=tool.usage, enabled=_is_open(window, tool),
            )  # fmt: skip


def _is_open(window: Window, tool: Tool) -> bool:
    """Whether a tool can be taken: a lesson shuts those that it does not name."""
    return window.lesson is None or window.lesson.opens_tool(tool.name)


def _build_scenes(ui: Ui, world: World, window: Window) -> None:
    """Build a line for each scene in the working directory, and for each that is built in."""
    try:
        files = scene_files(Path.cwd())
    except OSError as error:
        files = []
        ui.faint(f"Files could not be listed: {error}")
    if files:
        ui.faint("Files in the working directory")
    for path in files:
        ui.item(printable(path.name), file_actions.open_from_list, path, identity=str(path))
    if files:
        ui.rule()
    for name, scene in SCENES.items():
        is_shown, action = world.title == scene.title, file_actions.open_from_list
        ui.item(scene.title, action, name, identity=name, on=is_shown, tip=scene.description)


def _build_lessons(ui: Ui, world: World, window: Window) -> None:
    """Build a line for each lesson that comes with the program."""
    _build_controls(ui, ("lesson", "teach"), world, window)
    ui.rule()
    now = "" if window.lesson is None else window.lesson.lesson.name
    for name, title in titles(window.language).items():
        ui.item(title, open_lesson, name, identity=name, on=name == now)


_MENUS: dict[str, tuple[str, ...] | Callable[[Ui, World, Window], None]] = {
    "File": ("file", "quit"), "Scenes": _build_scenes, "Lessons": _build_lessons, "Edit": ("edit",),
    "Draw": _build_tools, "World": ("laws",), "Instruments": ("measure",), "View": ("show", "view", "window"),
    "Help": ("help",),
}  # fmt: skip
"""Which groups of controls each menu shows, or what builds it."""
_MORE = "..."


# ---- help --------------------------------------------------------------------------------------------------


_MAX_COLUMNS = 4
"""How many columns there may be, if they fit."""
_SHARE = 0.94
"""How much of the window's width they may take."""
_GAP = "   "


def build_help(ui: Ui, world: World, window: Window) -> None:
    """Build the window of keys, in columns, where they can be given to other things."""
    lines = [(ui.said(_keys(control, window)), f"{ui.said(control.does)}{_GAP}") for control in CONTROLS]
    room = _SHARE * window.canvas.size[0]
    columns = next((n for n in range(_MAX_COLUMNS, 1, -1) if _width(lines, n) <= room), 1)
    with ui.floating("Keys and buttons", window.framing.middle, window.closing_of("help"), docks=True):
        rows = -(-len(lines) // columns)
        if imgui.begin_table("keys", 2 * columns, imgui.TableFlags_.sizing_fixed_fit):
            for n in range(rows):
                imgui.table_next_row()
                for control, (keys, does) in zip(CONTROLS[n::rows], lines[n::rows], strict=True):
                    imgui.table_next_column()
                    _build_key(ui, window, control, keys)
                    imgui.table_next_column()
                    if window.keys.open:
                        imgui.align_text_to_frame_padding()
                    ui.text(does)
            imgui.end_table()
        if ui.checkbox("Choose keys", window.keys.open, "Then click a key, and press another"):
            window.keys.open, window.keys.asks = not window.keys.open, ""
        imgui.same_line()
        if window.keys.asks:
            ui.text("Press the new key. Backspace: the usual one, Esc: leave it", ui.theme.accent)
        elif window.keys.chosen:
            ui.button("All usual keys", "Every key does what it usually does", bring_usual)
        else:
            ui.faint("F1 or Esc closes this")


def _build_key(ui: Ui, window: Window, control: Control, keys: str) -> None:
    """Build the key of a control: a button where another can be chosen."""
    if not (window.keys.open and is_open(control)):
        if window.keys.open:
            imgui.align_text_to_frame_padding()
        ui.text(keys, ui.theme.accent)
    elif ui.button(
        f"Key of {control.does}", shown=label_of(control, window), on=window.keys.asks == control.does
    ):
        window.keys.asks = control.does


def _keys(control: Control, window: Window) -> str:
    others = [key.capitalize() for key in control.also if key.isalpha()]
    return ", ".join(dict.fromkeys([label_of(control, window), *others]))


def _width(lines: Sequence[tuple[str, str]], columns: int) -> float:
    """Return how wide a table of so many columns is [px]."""
    rows, style = -(-len(lines) // columns), imgui.get_style()
    width = 2 * style.window_padding.x
    for n in range(columns):
        for words in zip(*lines[n * rows : (n + 1) * rows], strict=True):
            width += max(imgui.calc_text_size(text).x for text in words) + 2 * style.cell_padding.x
    return float(width)


# ---- the tools at the left: what the mouse does in the world -----------------------------------------------


_LOWEST = 1.1
"""Height of a button at least, in heights of the text."""
_BETWEEN = 0.5
"""Distance between groups of tools where there is room for it, in heights of the text."""
_YIELDING = ("protractor", "note", "rope", "gate", "polygon", "block", "ruler")
"""Tools that are not in sight where there is little room, the first ones first."""


def palette_width(ui: Ui) -> float:
    """Return how wide the tools are with their names [px]."""
    widest = max(ui.width(_words(ui, tool)) for tool in PALETTE)
    return widest + 2.0 * imgui.get_style().frame_padding.x + 2.0 * NARROW


def build_palette(ui: Ui, rect: Rect, window: Window, *, names: bool) -> None:
    """Build a button for each tool, with its icon and perhaps its name; the tool in hand is marked."""
    with ui.panel("palette", rect, padded=False):
        across = imgui.get_style().frame_padding.x
        imgui.push_style_var(imgui.StyleVar_.button_text_align, ImVec2(0.0, 0.5))
        imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(across, 0.0))  # low ones cut no letter
        room, gap = imgui.get_content_region_avail(), imgui.get_style().item_spacing.y
        least = _LOWEST * ui.size
        shown = [tool for tool in _shown(int((room.y + gap) / (least + gap)) - 1) if _is_open(window, tool)]
        buttons = len(shown) + 1
        height = min(1.9 * ui.size, max((room.y - (buttons - 1) * gap) // buttons, least))
        behind = [tool for tool in (*PALETTE, *MORE_TOOLS) if tool not in shown and _is_open(window, tool)]
        size = room.x, height
        spare = (room.y - buttons * height - (buttons - 1) * gap) / len(TOOL_GROUPS)
        between = min(_BETWEEN * ui.size, spare - gap)
        group = TOOL_GROUPS[0]
        for tool in shown:
            if tool not in group:
                group = next(one for one in TOOL_GROUPS if tool in one)
                if between > 0.0:
                    imgui.dummy(ImVec2(0.0, between))
            ui.button(
                tool.title, _tip(tool), actions.choose_tool, tool,
                shown=_words(ui, tool) if names else tool.icon, on=window.tool == tool.name, size=size,
            )  # fmt: skip
            if window.tool != tool.name:
                _colour_icon(ui, tool)
        hidden = next((tool for tool in behind if tool.name == window.tool), None)
        words = f"{ICONS['more']}  {ui.said('More')}" if hidden is None else _words(ui, hidden)
        words, tip = words if names else words.split()[0], "More to put into the world"
        if not behind:
            imgui.pop_style_var(2)
            return
        with ui.list("More", tip, shown=words, on=hidden is not None, size=size) as is_open:
            for tool in behind if is_open else ():
                ui.item(
                    tool.title, actions.choose_tool, tool, shown=_words(ui, tool), keys=key_of(tool),
                    on=window.tool == tool.name, tip=tool.usage,
                )  # fmt: skip
        imgui.pop_style_var(2)


ICON_COLOURS = {
    "spring": "spring", "rope": "rope", "block": "static", "pendulum": "rod", "rod": "rod", "pin": "rod",
    "ruler": "velocity", "protractor": "velocity", "gate": "velocity", "note": "paused", "remove": "error",
}  # fmt: skip
"""The colours of icons: those of the things in the picture, or of what is measured and taken away."""
ICON_BODIES = {"circle": 0, "box": 1, "polygon": 4}
"""Those of bodies, by their number among the theme's."""


def _colour_icon(ui: Ui, tool: Tool) -> None:
    """Paint the icon of the button that was built last in the colour of its thing."""
    theme = ui.theme
    if tool.name in ICON_BODIES:
        colour = theme.bodies[ICON_BODIES[tool.name]]
    elif tool.name in ICON_COLOURS:
        colour = getattr(theme, ICON_COLOURS[tool.name])
    else:
        return
    low, high, text = imgui.get_item_rect_min(), imgui.get_item_rect_max(), imgui.get_text_line_height()
    place = ImVec2(low.x + imgui.get_style().frame_padding.x, 0.5 * (low.y + high.y - text))
    imgui.get_window_draw_list().add_text(place, packed(colour), tool.icon)


def _shown(room: int) -> list[Tool]:
    """Return the tools for which there is room in sight; the others are behind one more button."""
    out_of_sight = _YIELDING[: max(len(PALETTE) - room, 0)]
    return [tool for tool in PALETTE if tool.name not in out_of_sight]


def _tip(tool: Tool) -> str:
    return f"{tool.usage}\nKey: {key_of(tool)}" if key_of(tool) else tool.usage


def _words(ui: Ui, tool: Tool) -> str:
    return f"{tool.icon}  {ui.said(tool.title)}"
