"""Windows of files: to save, open and film, the gallery of scenes, and what a session has left."""

from collections.abc import Callable
from pathlib import Path

from imgui_bundle import imgui

from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.text import printable
from physicslab.export.film import ENDINGS
from physicslab.files.scene import SceneError
from physicslab.languages.sentence import Sentence
from physicslab.view.canvas.canvas import Rect
from physicslab.view.controls import saving
from physicslab.view.controls.file_actions import begin_film
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.filming import ALL, BACK, FORWARD, FROM_NOW
from physicslab.view.window.naming import Naming
from physicslab.view.window.scenes import working_folder
from physicslab.view.window.window import Window
from physicslab.world import World

_SAVE, _FILM = 24.0, 22.0
"""Widths of the fields, in heights of the text."""
_KINDS = {"GIF, for any browser and mail": ENDINGS[0], "MP4, small and sharp": ENDINGS[1]}


def build_name(ui: Ui, label: str, naming: Naming, width: float, close: Callable[[], object]) -> bool:
    """Build the field of a name, and why it is refused; return whether Enter was pressed.

    Esc in the field closes the window.
    """
    if imgui.is_key_pressed(imgui.Key.escape):
        close()
    if imgui.is_window_appearing() or (naming.entered and naming.refused):
        imgui.set_keyboard_focus_here()
        naming.entered = False
    text, _ = ui.field(label, naming.text, width * ui.size, wrong=bool(naming.refused))
    entered = imgui.is_item_focused() and imgui.is_key_pressed(imgui.Key.enter)
    naming.entered |= entered
    ui.refusal(naming.refused)
    naming.write(text)
    return bool(entered)


def build_answers(
    ui: Ui, naming: Naming, labels: tuple[str, str], entered: bool, write: Callable[..., object],
    close: Callable[[], object], tip: str = "",
) -> None:  # fmt: skip
    """Build what writes the file of a name, as Enter does, what writes over another, and what does neither.

    Parameters
    ----------
    labels : two str
        Labels of the first and of the last.
    write : callable
        Called with the world, the window and the file that is to be written over, if there is one.
    """
    over = naming.replaces
    if over is not None:
        ui.button("Replace it", f"Write over {printable(str(over))}", write, over)
        imgui.same_line()
    if ui.button(labels[0], tip, enabled=over is None) or (entered and over is None):
        ui.do_next(write)
    imgui.same_line()
    if ui.button(labels[1]):
        close()


def build_save(ui: Ui, world: World, window: Window) -> None:
    """Build the field and its buttons, in a window of its own."""
    close, naming = window.closing_of("scenes.naming"), window.scenes.naming
    assert naming is not None
    with ui.floating("Save a copy" if naming.copies else "Save", window.framing.middle, close):
        with ui.wrapping(_SAVE * ui.size):
            folder = printable(str(working_folder()))
            ui.faint(Sentence("In {folder}, unless a path is written", folder=folder), wrapped=False)
        entered = build_name(ui, "File name", naming, _SAVE, close)

        def write(world: World, window: Window, over: Path | None = None) -> None:
            saving.save_under(world, window, naming.text, over)

        build_answers(ui, naming, ("Save", "Cancel"), entered, write, close)


def recent_label(number: int, path: Path) -> str:
    """Return the words of a line of the list of files, which are numbered from 1."""
    return f"{number}. {printable(path.name)}"


def build_film(ui: Ui, world: World, window: Window) -> None:
    """Build the choices, the field and the buttons, in a window of its own."""
    filming, width, close = window.filming, _FILM * ui.size, window.closing_of("filming.choosing")
    naming = filming.naming
    with ui.floating("Film", window.framing.middle, close):
        what = ui.choice("Film of", filming.what, (ALL, BACK, FORWARD, FROM_NOW), width=width)
        if what != filming.what:
            filming.what, naming.refused = what, ""
        ending = Path(naming.text).suffix.lower()
        now = next((kind for kind, other in _KINDS.items() if other == ending), next(iter(_KINDS)))
        kind = ui.choice("Film as", now, tuple(_KINDS), width=width)
        if kind != now:
            naming.write(f"{Path(naming.text).stem}{_KINDS[kind]}")
        entered = build_name(ui, "Film name", naming, _FILM, close)
        tip = "It plays as fast as time runs in the window now"
        build_answers(ui, naming, ("Make the film", "Cancel"), entered, begin_film, close, tip)


# ---- what a session that ended without closing has left ----------------------------------------------------


def restore_session(world: World, window: Window) -> None:
    """Open what the session on offer has left; where that fails, all stays as it is."""
    try:
        window.scenes.next_world = window.scenes.recovery.restore()
    except (SceneError, InvalidValue, OSError) as error:
        window.notify(f"Not restored: {error}", 8.0, failed=True)
    else:
        window.pace.paused = True
        window.notify("Restored, and paused: Space goes on")


def discard_session(world: World, window: Window) -> None:
    """Remove what the session on offer has left."""
    window.scenes.recovery.discard()


_OFFERS = {"Restore it": restore_session, "Discard": discard_session}
_PAD = 6
"""Room around the words [px]."""


def build_recovery(ui: Ui, window: Window, free: Rect) -> int:
    """Build words and two buttons at the top of what is free, and return how high they are [px].

    They stand in one line where that is wide enough. Keys stay with the scene that runs.
    """
    left, top, width, _ = free
    style, words = imgui.get_style(), window.scenes.recovery.words
    room = width - 2 * _PAD
    gap, line = style.item_spacing, imgui.get_frame_height()
    buttons = [ui.width(label) + 2 * style.frame_padding.x for label in _OFFERS]
    in_line = ui.width(words) + sum(buttons) + len(buttons) * gap.x <= room
    beside = sum(buttons) + gap.x <= room
    if in_line:
        height = line
    else:
        rows = 1 if beside else len(buttons)
        height = ui.height(words, room) + rows * (line + gap.y)
    with ui.panel("recovery", (left, top, width, round(height) + 2 * _PAD), padded=False):
        if in_line:
            imgui.align_text_to_frame_padding()
        ui.text(words, ui.theme.notice, wrapped=not in_line)
        for n, (label, action) in enumerate(_OFFERS.items()):
            if in_line or (beside and n):
                imgui.same_line()
            ui.button(label, "", action)
    return round(height) + 2 * _PAD
