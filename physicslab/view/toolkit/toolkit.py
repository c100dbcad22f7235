"""Dear ImGui in the window: its context, what it is told of mouse and keys, and what it draws."""

import weakref
from collections.abc import Callable

import pygame
from imgui_bundle import ImVec2, imgui, implot

from physicslab.theme import Theme
from physicslab.view.canvas.canvas import Rect, is_within
from physicslab.view.toolkit.pictures import Pictures
from physicslab.view.toolkit.style import Fonts, add_fonts, apply_theme

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
_HELD = {pygame.KMOD_SHIFT: imgui.Key.mod_shift, pygame.KMOD_ALT: imgui.Key.mod_alt}
_AWAY = (pygame.WINDOWFOCUSLOST, pygame.WINDOWMINIMIZED, pygame.WINDOWHIDDEN)
"""Events after which no button counts as held."""
_SETTLING = 3
"""Frames that Dear ImGui takes to follow an event: sizes and hovering are those of the frame before."""
_ONLY_WHERE_TAKEN = (
    pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP, pygame.MOUSEWHEEL, pygame.KEYDOWN,
)  # fmt: skip
"""Events that Dear ImGui gets only where they are for panels: Tab would go to the first field."""
_FOR_WINDOWS = (*range(pygame.K_F1, pygame.K_F12 + 1), pygame.K_LALT)
"""Keys that write nothing, but open panels and go from one to the next: they are never for a panel."""
_FOR_FILES = (pygame.K_n, pygame.K_o, pygame.K_q, pygame.K_s)
"""Keys that are for files of scenes, or quit, while Ctrl is held, whatever is being written."""
_NOWHERE = -3.0e38
"""The reported position of the mouse while it is not for panels."""


def is_for_files(event: pygame.Event) -> bool:
    """Whether a key saves or opens a scene, makes a new one, or quits."""
    return event.key in _FOR_FILES and bool(getattr(event, "mod", 0) & pygame.KMOD_CTRL)


class Toolkit:
    """A context of Dear ImGui: panels are built when something may have changed, and shown in every frame.

    Attributes
    ----------
    covered : list of Rect
        Where panels, menus and tips lie [px], as of the last frame that was built.
    fonts : Fonts
        Its letters.
    built : int
        How many times panels were built.
    pictures : Pictures
        Pictures of them.
    walked : bool
        Whether keys go through the widgets of a panel.
    """

    def __init__(self) -> None:
        self._context = imgui.create_context()
        imgui.set_current_context(self._context)
        self._plots = implot.create_context()
        self.enter()
        io = imgui.get_io()
        io.set_ini_filename(None)
        io.set_log_filename("")
        io.config_flags |= imgui.ConfigFlags_.docking_enable | imgui.ConfigFlags_.nav_enable_keyboard
        flags = imgui.BackendFlags_
        io.backend_flags |= flags.renderer_has_textures | flags.renderer_has_vtx_offset
        io.config_debug_highlight_id_conflicts = False
        self.fonts: Fonts = add_fonts()
        self.covered: list[Rect] = []
        self.built = 0
        self.pictures = Pictures()
        self._look: tuple[Theme, float, tuple[int, int]] | None = None
        self._elapsed = 0.0
        self._unsettled = _SETTLING
        self._pointer = (_NOWHERE, _NOWHERE)
        self._pressed_on: dict[int, bool] = {}  # whether each button that is held went down on a panel
        self.walked = False
        weakref.finalize(self, _end, self._context, self._plots, self.pictures)

    def enter(self) -> None:
        """Make its context the one that calls of Dear ImGui and ImPlot are for."""
        imgui.set_current_context(self._context)
        implot.set_current_context(self._plots)

    @property
    def typing(self) -> bool:
        """Whether keys go to a field of a panel."""
        self.enter()
        return bool(imgui.get_io().want_text_input)

    @property
    def has_keys(self) -> bool:
        """Whether keys go to a field, an open menu, or through the widgets of panels."""
        return self.walked or self.typing or self.has_popup()

    @property
    def dragging(self) -> bool:
        """Whether a mouse button is held that went down on a panel."""
        return any(self._pressed_on.values())

    def covers(self, place: tuple[float, float], around: int = 0) -> bool:
        """Whether a panel lies at a place of the screen, or as near to it as that [px]."""
        return any(
            is_within(place, (left - around, top - around, width + 2 * around, height + 2 * around))
            for left, top, width, height in self.covered
        )

    def take(self, event: pygame.Event) -> bool:
        """Let panels have an event first; return whether the world is not to see it.

        A button that goes down on a panel belongs to it until it is let go, and so it is with the world.
        """
        taken = self._is_for_panels(event)
        self.enter()
        io = imgui.get_io()
        if event.type == pygame.MOUSEMOTION and not taken and not imgui.is_mouse_pos_valid():
            return False  # it was in the world before, too
        self._unsettled = _SETTLING
        if taken and event.type == pygame.KEYDOWN and event.key == pygame.K_ESCAPE and self.has_popup():
            imgui.internal.close_popup_to_level(0, True)
        elif taken or event.type not in _ONLY_WHERE_TAKEN:
            _feed(io, event)
        elif event.type == pygame.MOUSEBUTTONDOWN:
            imgui.set_window_focus()  # what was written in a field is taken over
            io.add_mouse_pos_event(_NOWHERE, _NOWHERE)
        elif event.type == pygame.MOUSEMOTION:
            io.add_mouse_pos_event(_NOWHERE, _NOWHERE)
        return taken

    def _is_for_panels(self, event: pygame.Event) -> bool:
        match event.type:
            case pygame.MOUSEBUTTONDOWN:
                on_panel = self.covers(event.pos) or self.has_popup()
                self._pressed_on[event.button] = on_panel
                return on_panel
            case pygame.MOUSEBUTTONUP:
                return self._pressed_on.pop(event.button, False)
            case pygame.MOUSEMOTION:
                if self._pressed_on:
                    return self.dragging
                return self.covers(event.pos)
            case pygame.MOUSEWHEEL:
                return self.covers(self._pointer)
            case pygame.KEYDOWN | pygame.KEYUP if event.key in _FOR_WINDOWS or is_for_files(event):
                return False
            case pygame.KEYDOWN | pygame.KEYUP | pygame.TEXTINPUT:
                return self.has_keys
            case _ if event.type in _AWAY:
                self._pressed_on.clear()
        return False

    def follow_pointer(self, place: tuple[float, float]) -> None:
        """Note where the cursor is [px]: events of the wheel do not say so."""
        self._pointer = place

    def has_popup(self) -> bool:
        """Whether a menu is open: a click beside it closes it, and does nothing else."""
        self.enter()
        flags = imgui.PopupFlags_
        return bool(imgui.is_popup_open("", flags.any_popup_id | flags.any_popup_level))

    @property
    def unsettled(self) -> bool:
        """Whether there is something to do for panels in the next frame whatever happens."""
        return self._unsettled > 0 or bool(self.pictures.due)

    def wake(self) -> None:
        """Have panels built in the next frames: something changed."""
        self._unsettled = _SETTLING

    def refresh(self) -> None:
        """Have panels built in the next frame: figures are others, and nothing is elsewhere."""
        self._unsettled = max(self._unsettled, 1)

    def frame(
        self, size: tuple[int, int], theme: Theme, text_size: float, elapsed: float, build: Callable[[], None]
    ) -> bool:
        """Build panels if something may have changed since; return whether they were built.

        Parameters
        ----------
        size : tuple of two ints
            Width and height of the window [px].
        text_size : float
            Height of text [px].
        elapsed : float
            Time [s] since the last frame.
        build : callable
            Calls Dear ImGui for each panel.
        """
        self._elapsed += elapsed
        looks_new = self._look != (theme, text_size, size)
        if looks_new:
            self._unsettled = _SETTLING
        self.pictures.paint_next()
        if self._unsettled <= 0:
            return False
        self._unsettled -= 1
        self.enter()
        if looks_new:
            self._look = (theme, text_size, size)
            apply_theme(theme, text_size)
        io = imgui.get_io()
        io.display_size = ImVec2(*map(float, size))
        io.delta_time = max(self._elapsed, 1e-4)
        self._elapsed = 0.0
        imgui.new_frame()
        try:
            build()
        finally:
            imgui.render()
        self.built += 1
        self.pictures.take(imgui.get_draw_data(), self._pointer, at_once=looks_new)
        self.covered = _covered()
        if io.want_text_input or imgui.is_any_item_active():
            self._unsettled = max(self._unsettled, 1)  # the mark in a field blinks, a key repeats
        return True

    def arrangement(self) -> str:
        """Return where windows lie, in words of Dear ImGui."""
        self.enter()
        return str(imgui.save_ini_settings_to_memory())

    def arrange(self, arrangement: str) -> None:
        """Dock windows and put them where they were, or each where it is at first if that is empty."""
        self.enter()
        imgui.internal.clear_ini_settings()
        imgui.load_ini_settings_from_memory(arrangement)
        self.wake()

    def picture_of(self, ending: str) -> pygame.Surface | None:
        """Return a panel as it was painted last, by the end of its name; ``None`` if it is not shown."""
        assert self._look is not None
        return self.pictures.of(ending, self._look[0].panel)


def _covered() -> list[Rect]:
    """Return where panels lie that take the mouse, from the back to the front."""
    rects: list[Rect] = []
    for window in imgui.get_current_context().windows:
        if window.hidden or not window.active:
            continue
        rect = round(window.pos.x), round(window.pos.y), round(window.size.x), round(window.size.y)
        node = window.dock_node_as_host
        if node is not None and node.is_dock_space():
            rects += _beside(rect, node.central_node)
        elif not window.flags & (imgui.WindowFlags_.no_mouse_inputs | imgui.WindowFlags_.child_window):
            rects.append(rect)
    return rects


def _beside(rect: Rect, middle: imgui.internal.DockNode) -> list[Rect]:
    """Return what of a rectangle lies around its middle, with the edges that can be dragged [px]."""
    (left, top, width, height), node = rect, middle.rect()
    x, y, right, bottom = round(node.min.x), round(node.min.y), round(node.max.x), round(node.max.y)
    sides = (
        (left, top, x - left, height), (right, top, left + width - right, height),
        (x, top, right - x, y - top), (x, bottom, right - x, top + height - bottom),
    )  # fmt: skip
    return [side for side in sides if side[2] > 0 and side[3] > 0]


def _end(context: imgui.internal.Context, plots: implot.internal.Context, pictures: Pictures) -> None:
    """End a context; memory may be cleared at any time, as while another builds its panels."""
    before, plots_before = imgui.get_current_context(), implot.get_current_context()
    imgui.set_current_context(context)
    for texture in imgui.get_platform_io().textures:
        texture.set_tex_id(0)
        texture.set_status(imgui.ImTextureStatus.destroyed)
    pictures.forget()
    implot.destroy_context(plots)
    imgui.destroy_context(context)
    if before is not None and before is not context:
        imgui.set_current_context(before)
    if plots_before is not None and plots_before is not plots:
        implot.set_current_context(plots_before)


def _feed(io: imgui.IO, event: pygame.Event) -> None:
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
            # On macOS Dear ImGui exchanges the two, and its events of keys are exchanged already.
            ctrl = imgui.Key.mod_super if io.config_mac_osx_behaviors else imgui.Key.mod_ctrl
            io.add_key_event(ctrl, bool(mod & pygame.KMOD_CTRL))
            for mask, key in _HELD.items():
                io.add_key_event(key, bool(mod & mask))
            if event.key in _KEYS:
                io.add_key_event(_KEYS[event.key], event.type == pygame.KEYDOWN)
        case pygame.TEXTINPUT:
            io.add_input_characters_utf8(event.text)
        case _ if event.type in _AWAY:
            io.add_focus_event(False)


# ---- keys that go through the widgets of panels in place of the mouse --------------------------------------


_MENUS = "##MainMenuBar"
"""The window that Dear ImGui has the menus in; the mark of the keys is put on a menu where they are built."""
_FLAGS = imgui.WindowFlags_
_ARROWS = (pygame.K_LEFT, pygame.K_RIGHT, pygame.K_UP, pygame.K_DOWN)
_OUT_OF_A_LINE = {pygame.K_UP: imgui.Dir.up, pygame.K_DOWN: imgui.Dir.down}
_ENTER = (pygame.K_RETURN, pygame.K_KP_ENTER)
_INERT = _FLAGS.no_nav_inputs | _FLAGS.tooltip | _FLAGS.popup


class Walk:
    """Which panel has the keys: Tab and arrows go through its widgets, Esc gives them back to the world.

    Parameters
    ----------
    toolkit : Toolkit
        The builder of panels; it takes keys for them while ``toolkit.walked``.
    """

    def __init__(self, toolkit: Toolkit) -> None:
        self._toolkit = toolkit
        self._panel = ""
        self._begins = self._ends = self._from_field = self._goes_on = False
        self._without_mark = 0

    def begin(self, keys_go_to: str) -> None:
        """Let keys go to the menus, to the fields of the panel at the right, or to the next panel."""
        if not keys_go_to:
            return
        named = {"menu": _MENUS, "fields": "side"}
        self._panel = named.get(keys_go_to) or self._next()
        self._begins = self._toolkit.walked = True
        self._from_field = False
        self._toolkit.wake()

    def _next(self) -> str:
        """Return the name of the panel to the right of the one that has the keys, or below it."""
        self._toolkit.enter()
        windows = sorted(imgui.get_current_context().windows, key=lambda one: (one.pos.x, one.pos.y))
        names = [str(one.name) for one in windows if _has_widgets(one)]
        walked = names.index(self._panel) + 1 if self._toolkit.walked and self._panel in names else 0
        return names[walked % len(names)] if names else ""

    def follow(self, event: pygame.Event) -> None:
        """Begin where Tab or an arrow leaves a field, and end at a click or Esc; before panels take it.

        Enter in a field gives the keys back, too, where they came to the panel by a field alone.
        """
        toolkit, key = self._toolkit, getattr(event, "key", 0)
        if event.type == pygame.MOUSEBUTTONDOWN:
            toolkit.walked = self._goes_on = False
        elif event.type == pygame.KEYDOWN and key in _ARROWS and toolkit.has_popup():
            window = imgui.get_current_context().nav_window
            if window is not None and window.root_window_popup_tree.name == _MENUS:
                self._panel, toolkit.walked = _MENUS, True  # of a menu that the mouse opened, too
                self._goes_on = key in _ARROWS[:2]
        elif event.type == pygame.KEYDOWN and toolkit.typing and (key == pygame.K_TAB or _leaves_field(key)):
            window = imgui.get_current_context().nav_window
            if window is not None:  # None where a press in the world has just ended the writing
                self._panel = str(window.root_window.name)
                self._from_field = self._from_field or not toolkit.walked
                toolkit.walked = True
        elif event.type == pygame.KEYDOWN and key in _ENTER and toolkit.walked and toolkit.typing:
            self._ends = self._from_field and not event.mod & pygame.KMOD_CTRL
        elif event.type == pygame.KEYDOWN and key == pygame.K_ESCAPE and toolkit.has_keys:
            self._ends = not toolkit.has_popup()

    def mark(self) -> None:
        """Put the mark of the keys on a widget of a panel that has them from now on; before it is built."""
        panel = imgui.internal.find_window_by_name(self._panel)
        if self._begins and panel is not None and self._panel != _MENUS:
            imgui.internal.focus_window(panel)
            imgui.internal.nav_init_window(panel, True)
            imgui.set_nav_cursor_visible(True)
        self._begins = False

    def end(self, *, is_alone: bool) -> None:
        """Give the keys back to the world after Esc, a line of a menu, or once what had them is gone.

        It is called after panels are built.

        Where the world ``is_alone`` in front and has them, their mark goes, and the tip of what it was on.
        """
        toolkit, context = self._toolkit, imgui.get_current_context()
        if self._goes_on and not toolkit.has_popup() and not context.nav_move_forward_to_next_frame:
            self._goes_on = False  # the mark is on the title of the next menu
            for is_down in (True, False):
                imgui.get_io().add_key_event(imgui.Key.down_arrow, is_down)
            toolkit.wake()
        panel, in_menus = context.nav_window, toolkit.walked and self._panel == _MENUS
        left = in_menus and not toolkit.has_popup() and panel is not None and panel.name != _MENUS
        has_mark = not toolkit.walked or in_menus or context.nav_id_is_alive or toolkit.has_popup()
        self._without_mark = 0 if has_mark else self._without_mark + 1
        if self._ends or left or self._without_mark >= _SETTLING:  # it takes some frames to come to a panel
            imgui.set_window_focus()
            self._ends = self._from_field = toolkit.walked = False
        if is_alone and not toolkit.has_keys:
            imgui.set_nav_cursor_visible(False)


def _leaves_field(key: int) -> bool:
    """Whether an arrow goes from the field that is written in to the widget above or below it."""
    kept = imgui.get_current_context().active_id_using_nav_dir_mask  # it moves within more than one line
    return key in _OUT_OF_A_LINE and not kept & (1 << _OUT_OF_A_LINE[key])


def _has_widgets(window: imgui.internal.Window) -> bool:
    """Whether a window is in sight that keys can go through the widgets of, as they cannot of a tip."""
    nested = window.flags & _FLAGS.child_window and not window.dock_id
    hidden = window.hidden or not window.active or window.name == _MENUS
    return not (hidden or nested or window.flags & _INERT)
