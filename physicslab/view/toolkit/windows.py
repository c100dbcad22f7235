"""Windows of panels: fixed at the edges, floating, or docked to the sides of the world."""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import NamedTuple

import pygame
from imgui_bundle import ImVec2, imgui

from physicslab.languages.language import Language, language
from physicslab.theme import Theme
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.drawable_text import drawable
from physicslab.view.canvas.quantities import with_powers
from physicslab.view.toolkit.pictures import Overlay
from physicslab.view.toolkit.style import Fonts

_FLAGS = imgui.WindowFlags_
_FIXED = (
    _FLAGS.no_title_bar | _FLAGS.no_resize | _FLAGS.no_move | _FLAGS.no_collapse | _FLAGS.no_saved_settings
    | _FLAGS.no_bring_to_front_on_focus | _FLAGS.no_nav_focus | _FLAGS.no_focus_on_appearing
)  # fmt: skip
_FLOATING = _FLAGS.no_collapse | _FLAGS.always_auto_resize
_ONLY_SIDES = (
    imgui.DockNodeFlags_.passthru_central_node | imgui.DockNodeFlags_.no_docking_over_central_node
    | imgui.internal.DockNodeFlagsPrivate_.no_close_button
)  # fmt: skip
"""The middle stays in sight, and takes the mouse."""
_BESIDE = _FLAGS.no_focus_on_appearing
_APART = _FLAGS.no_saved_settings | _FLAGS.no_docking
_DIRECTIONS = {"right": imgui.Dir.right, "left": imgui.Dir.left, "below": imgui.Dir.down}
LEAST_WORLD = 17.0
"""Width that windows leave to the world where text or window have another size."""
_MAX_SHARE = 0.5
"""Share of the width, and of the height, that docked windows take at most of the room without them."""
_WORTHWHILE = 0.25
"""Share of it that is enough for a window of its own; where there is less, it is one more tab of another."""
NARROW = 6.0
"""Padding of panels that hold buttons alone [px]."""
_TITLE = 6.0
"""Height of what a floating window has above what fills it, at most, in heights of the text."""
_SECTION, _WINDOW = re.compile(r"^(?=\[)", re.MULTILINE), re.compile(r"^\[Window\]\[(.*)\]$", re.MULTILINE)
"""A part of where windows lie begins with that; one of a window with its name."""
_UNSEEN = "\u200b"
"""A space without width: it parts two signs ``#`` that Dear ImGui would take for a mark of its own."""


def keep_inside(low: ImVec2, room: ImVec2) -> None:
    """Move the window that is being built into a room [px] from a corner on, unless it is docked."""
    place, size = imgui.get_window_pos(), imgui.get_window_size()
    x = max(min(place.x, low.x + room.x - size.x), low.x)
    y = max(min(place.y, low.y + room.y - size.y), low.y)
    if (x, y) != (place.x, place.y) and not imgui.is_window_docked():
        imgui.set_window_pos(ImVec2(x, y))


def widget_label(words: str, identity: str) -> str:
    r"""Return a label of Dear ImGui that shows words and is known by an identity, whatever either holds.

    >>> widget_label("a", "b"), widget_label("a", "b\0#\udce9").isascii()
    ('a###b', True)
    """
    shown = re.sub("#(?=#)", f"#{_UNSEEN}", drawable(words))
    return f"{shown}###{ascii(identity)[1:-1].replace('#', '|23')}"


_KEPT = 4096
"""How many texts are kept as they are drawn: a panel writes the same ones a few times a second."""


@lru_cache(_KEPT)
def _said(own: Language, words: str) -> str:
    return with_powers(drawable(own.reword(words)))


def _identity(name: str) -> str:
    """Return the part of a window's name by which Dear ImGui knows it."""
    return name.rpartition("###")[2]


class Spoken(NamedTuple):
    """The kind of a widget, as ``"button"``, and its value in words; ``"on"`` or ``"off"`` for a switch."""

    role: str
    value: str


class Windows:
    """The windows of one frame, and what is noted of the widgets in them.

    Parameters
    ----------
    fonts : Fonts
        The letters.
    theme : Theme
        The colours; the toolkit has them too.

    Attributes
    ----------
    spoken : dict of str to Spoken
        Widgets in words, by their labels, for people who hear them.
    places : dict of str to Rect
        Where each button, field and line of a menu is [px], by its words.
    words : list of str
        All that is written, in its order.
    rows : dict of str to str
        The value beside each label.
    keys_go_to : str
        The receiver of keys in this frame: ``"menu"`` or ``"fields"``.
    writes_at_once : bool
        Whether keys have just come to a panel: where a field has them it is written in without Enter.
    scenes : int
        How many scenes were shown: what is half written or dragged in a widget is for one of them.
    focused : str
        The widget that keys go to, by its words.
    room : Rect
        The part of the window left for the world; windows open within it [px].
    language : Language
        The language of all words; widgets are found by the program's own words whatever it is.
    do_next : callable
        Has an action done next; further arguments are the action's.
    pictures : dict of lists of tuples
        Overlays by the draw list they lie on: a surface, its corner, and the part in which it is seen [px].
    """

    def __init__(self, fonts: Fonts, theme: Theme) -> None:
        self.fonts, self.theme = fonts, theme
        self.places: dict[str, Rect] = {}
        self.spoken: dict[str, Spoken] = {}
        self.words: list[str] = []
        self.rows: dict[str, str] = {}
        self.pictures: dict[str, list[Overlay]] = {}
        self.keys_go_to = self.focused = ""
        self.writes_at_once = False
        self.scenes = 0
        self._sides = 0  # the dock space
        self._is_narrow = False
        self._raised: dict[str, object] = {}  # what each window showed when it was put in front
        self._put: set[str] = set()  # windows that were docked, as they stood nowhere before
        self._placed: set[str] = set()  # windows with a place in the arrangement, by their identities
        self.room: Rect = (0, 0, 1 << 20, 1 << 20)
        self.language = language()
        self.do_next: Callable[..., object] = lambda action, *arguments: None

    def begin(self, theme: Theme, room: Rect = (0, 0, 1 << 20, 1 << 20), *, is_narrow: bool = False) -> None:
        """Forget the frame before; where the world ``is_narrow`` windows stand below it, not at its sides."""
        self.theme, self.room, self._is_narrow = theme, room, is_narrow
        self.places, self.words, self.rows, self.pictures, self.focused = {}, [], {}, {}, ""
        self.spoken = {}

    def rearrange(self, arrangement: str) -> None:
        """Note that windows lie as in an arrangement; others, even those that open later, as at first."""
        self._placed = set(_WINDOW.findall(arrangement))

    def _when_put(self, name: str) -> imgui.Cond_:
        """Return when a window is put where it is at first."""
        if _identity(name) in self._placed:
            return imgui.Cond_.first_use_ever
        self._placed.add(_identity(name))
        return imgui.Cond_.always

    def arranged(self, arrangement: str) -> str:
        """Return where windows lie, without those that were shown in another arrangement alone.

        Dear ImGui would have them float over the world from the next start on.
        """
        shown = (window.name for window in imgui.get_current_context().windows if window.was_active)
        self._placed |= set(map(_identity, shown))
        parts = _SECTION.split(arrangement)
        return "".join(
            part for part in parts if (found := _WINDOW.match(part)) is None or found[1] in self._placed
        )

    def said(self, words: str) -> str:
        """Return words in the language of the window, as they can be drawn."""
        return (_said if type(words) is str else _said.__wrapped__)(self.language, words)

    def written(self, words: str) -> str:
        """Return words as :meth:`said` does, and note that they are written."""
        self.words.append(self.said(words))
        return self.words[-1]

    def _titled(self, title: str) -> str:
        """Return the name of a window whose title is shown in the language of the window."""
        said = self.said(title)
        return title if said == title else widget_label(said, title)

    @property
    def size(self) -> float:
        """Height of the text [px]."""
        return float(imgui.get_font_size())

    @contextmanager
    def panel(self, name: str, rect: Rect, *, padded: bool = True, rounded: bool = False) -> Iterator[None]:
        """Begin a panel that stays where it is put; its corners are round where it lies over the world."""
        left, top, width, height = rect
        imgui.set_next_window_pos(ImVec2(left, top))
        imgui.set_next_window_size(ImVec2(max(width, 1), max(height, 1)))
        if not rounded:
            imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
        if not padded:
            imgui.push_style_var(imgui.StyleVar_.window_padding, ImVec2(NARROW, NARROW))
        imgui.begin(name, None, _FIXED)
        try:
            yield
        finally:
            imgui.end()
            imgui.pop_style_var(2 - padded - rounded)

    def dock(self, rect: Rect) -> Rect:
        """Let windows be docked to the sides of a part of the display; return what they leave of it [px]."""
        imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
        imgui.push_style_var(imgui.StyleVar_.window_padding, ImVec2(0.0, 0.0))
        imgui.set_next_window_pos(ImVec2(*rect[:2]))
        imgui.set_next_window_size(ImVec2(*rect[2:]))
        unseen = _FLAGS.no_background | _FLAGS.no_mouse_inputs | _FLAGS.no_docking | _FLAGS.no_nav
        imgui.begin("sides", None, _FIXED | unseen)
        imgui.pop_style_var(2)
        self._sides = imgui.get_id("sides")
        imgui.dock_space(self._sides, ImVec2(0.0, 0.0), _ONLY_SIDES)
        imgui.end()
        node = imgui.internal.dock_builder_get_central_node(self._sides)
        return round(node.pos.x), round(node.pos.y), round(node.size.x), round(node.size.y)

    def stand_beside(
        self, name: str, side: str, share: float, least: float, *,
        again: bool = False, keeps_side: bool = False,
    ) -> None:  # fmt: skip
        """Have the window that is begun next docked at a side of the world, if it never was elsewhere.

        Parameters
        ----------
        name : str
            The name with which it is begun.
        side : str
            ``"right"``, ``"left"`` or ``"below"``; where the world is narrow it is below all the same.
        share : float
            How much of the world's room it takes, as long as half of the width and of the height is left.
        least : float
            The least height of a window above or below it, or width of one beside it, in heights of the text:
            where there is less, both are in the same place, as tabs. At a side it is its own width, too.
        again : bool
            Whether it is docked there though it was elsewhere.
        keeps_side : bool
            Whether it stands at its side in a narrow world too, where both have the least that they need.
        """
        when = imgui.Cond_.always if again else self._when_put(name)
        internal = imgui.internal
        titled = self._titled(name)
        before = internal.find_window_by_name(titled)
        known = before or internal.find_window_settings_by_id(internal.im_hash_str(titled))
        world = internal.dock_builder_get_central_node(self._sides)
        fits = keeps_side and world is not None and world.size.x >= (least + LEAST_WORLD) * self.size
        side = "below" if self._is_narrow and not fits else side
        if known is not None and when != imgui.Cond_.always:
            if before is None or before.was_active or not before.dock_id or self._side_of(before) != side:
                return
            last = self._last_at(side)
            if last is None or last.id_ == before.dock_id:
                return
            when = imgui.Cond_.always  # it comes back where others stand by now: as one more of them
        imgui.set_next_window_dock_id(self._node(side, share, least * self.size), when)
        self._put.add(name)

    def _side_of(self, thing: imgui.internal.Window | imgui.internal.DockNode) -> str:
        """Return at which side of the world something lies."""
        world = imgui.internal.dock_builder_get_central_node(self._sides)
        if thing.pos.y >= world.pos.y + world.size.y:
            return "below"
        return "right" if thing.pos.x > world.pos.x + 0.5 * world.size.x else "left"

    def _last_at(self, side: str = "") -> imgui.internal.DockNode | None:
        """Return the place that one more window shares at a side, or at any side; none without windows."""
        last = None
        for window in imgui.get_current_context().windows:
            node = imgui.internal.dock_builder_get_node(window.dock_id) if window.dock_id else None
            if node is None or not (window.active or window.was_active):
                continue
            if self._side_of(node) == (side or self._side_of(node)) and (
                last is None or (node.pos.y, node.pos.x) >= (last.pos.y, last.pos.x)
            ):
                last = node
        return last

    def _node(self, side: str, share: float, least: float) -> int:
        """Return the place at a side for one more window; ``least`` is in pixels."""
        internal, is_below = imgui.internal, side == "below"
        world, last = internal.dock_builder_get_central_node(self._sides), self._last_at(side)
        if last is not None:
            if (last.size.x if is_below else last.size.y) < 2.0 * least:
                return last.id_
            across = imgui.Dir.right if is_below else imgui.Dir.down
            return int(internal.dock_builder_split_node_py(last.id_, across, 0.5)[0])
        whole = internal.dock_builder_get_node(self._sides).size
        room, all_of_it = (world.size.y, whole.y) if is_below else (world.size.x, whole.x)
        wanted = max(share * room, 0.0 if is_below else least)
        taken = min(wanted, room - (1.0 - _MAX_SHARE) * all_of_it)
        last = self._last_at()
        if last is not None and taken < min(wanted, _WORTHWHILE * all_of_it):
            return last.id_
        share = taken / max(room, 1.0)
        return int(internal.dock_builder_split_node_py(world.id_, _DIRECTIONS[side], share)[0])

    def raise_tab(self, shows: object = None) -> None:
        """Put the window in front of its tabs, where it shows another thing than before."""
        window = imgui.internal.get_current_window_read()
        if self._raised.get(window.name, self) != shows or window.appearing:
            self._raised[str(window.name)] = shows
            if window.dock_node is not None and window.dock_node.tab_bar is not None:
                window.dock_node.tab_bar.next_selected_tab_id = window.tab_id
                before = imgui.get_current_context().nav_window
                if before is not None and before.dock_id == window.dock_id:
                    imgui.set_window_focus()  # the one that was clicked last would stay in front

    @contextmanager
    def floating(
        self, title: str, middle: tuple[float, float], close: Callable[[], object], *, docks: bool = False
    ) -> Iterator[None]:
        """Begin a window with a title, within the display; ``close`` is called where it is clicked away.

        One that ``docks`` can be docked to the sides of the world, and comes back where it was.
        """
        free = imgui.get_main_viewport()  # without the menu bar
        low, room = free.work_pos, free.work_size
        if title not in self._put:  # a place would take it out of where it is docked
            when = self._when_put(title) if docks else imgui.Cond_.appearing
            imgui.set_next_window_pos(ImVec2(*middle), when, ImVec2(0.5, 0.5))
        imgui.set_next_window_size_constraints(ImVec2(0.0, 0.0), room)
        name = self._titled(title)
        _, stays = imgui.begin(name, True, (_FLOATING | _BESIDE) if docks else (_FLOATING | _APART))
        keep_inside(low, room)
        self.written(title)
        if docks:
            self.raise_tab(self._raised.get(name))
        try:
            yield
        finally:
            imgui.end()
        if not stays:
            close()

    @contextmanager
    def child(self, name: str, size: ImVec2) -> Iterator[bool]:
        """Begin a part of a window that is scrolled by itself; the yielded value says whether it is seen."""
        yield bool(imgui.begin_child(name, size, imgui.ChildFlags_.nav_flattened))
        imgui.end_child()

    @contextmanager
    def wrapping(self, width: float) -> Iterator[None]:
        """Break words at a width [px] from the left edge of the window."""
        imgui.push_text_wrap_pos(width)
        yield
        imgui.pop_text_wrap_pos()

    def fitted(self, width: float, height: float) -> tuple[float, float]:
        """Return a size for what is in a floating window, so that it lies over no other panel [px]."""
        _, _, across, down = self.room
        around = 2.0 * imgui.get_style().window_padding.x + self.size
        return max(min(width, across - around), 1.0), max(
            min(height, down - around - _TITLE * self.size), 1.0
        )

    def extent(self, width: float, height: float) -> ImVec2:
        """Return a size [px] for what fills a floating window: of a docked one all its room."""
        if imgui.is_window_docked():
            return imgui.get_content_region_avail()
        return ImVec2(*self.fitted(width, height))

    def picture(self, surface: pygame.Surface, corner: tuple[int, int], clip: pygame.Rect) -> None:
        """Lay a picture over the panel that is being built, as far as it lies within ``clip``."""
        owner = str(imgui.get_window_draw_list()._owner_name)
        self.pictures.setdefault(owner, []).append((surface, corner, clip))

    def held(self, label: str) -> str:
        """Return a label without words for what is written or dragged in, which ends with the scene."""
        return widget_label("", f"{label} of scene {self.scenes}")
