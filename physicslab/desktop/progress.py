"""The window while it loads, and while kernels are compiled."""

from dataclasses import replace

from physicslab.theme import Theme
from physicslab.view.canvas.canvas import Canvas, TextStyle

PAUSE = 0.05
"""Time [s] between two looks at whether what is shown here has changed, or the user has done anything."""
_WIDTH, _HEIGHT = 30, 1
"""Width and height of the bar, in heights of the text."""
_MARGIN = 10
"""Around the panel in the corner [px]."""


def draw_loading(canvas: Canvas, theme: Theme, remark: str, size: int) -> None:
    """Draw the name of the program, and a remark, in letters of a size [px]."""
    width, height = canvas.size
    canvas.clear(theme.sky_top, theme.sky_bottom, theme.grain)
    name = TextStyle(round(2.3 * size), theme.heading, bold=True)
    canvas.text("PhysicsLab", (width // 2, height // 2 - round(7.3 * size)), name, "centre")
    if remark:
        place = width // 2, height // 2 + round(1.9 * size)
        canvas.text(remark, place, TextStyle(size - 1, theme.faint), "centre")


def _draw_bar(
    canvas: Canvas, theme: Theme, left: int, top: int, width: int, share: float, height: int
) -> None:
    canvas.panel((left, top, width, height), theme.panel, theme.outline)
    canvas.panel((left, top, round(width * share), height), theme.accent, theme.accent)


def _fitting(canvas: Canvas, words: str, style: TextStyle, room: int) -> TextStyle:
    """Return the style with letters as small as it takes for words to fit into a width [px]."""
    wide = max(canvas.text_size(words, style)[0], 1)
    return replace(style, size=max(style.size * min(room, wide) // wide, 1))


def draw_waiting(canvas: Canvas, theme: Theme, share: float, remark: str, size: int) -> None:
    """Draw over the world that it waits for something that is not compiled yet."""
    width, height = canvas.size
    panel = min(_WIDTH * size, width - 40)
    left, top, middle = (width - panel) // 2, height // 2 - 4 * size, width // 2
    canvas.panel((left, top, panel, 8 * size), theme.panel, theme.outline)
    words, room = "Paused: this part is still being compiled.", panel - 2 * size
    title = _fitting(canvas, words, TextStyle(size + 1, theme.text), room)
    canvas.text(words, (middle, top + size), title, "centre")
    _draw_bar(
        canvas, theme, left + 2 * size, top + round(3.5 * size), panel - 4 * size, share, _HEIGHT * size
    )
    canvas.text(remark, (middle, top + round(5.3 * size)), TextStyle(size - 1, theme.faint), "centre")


def draw_corner(canvas: Canvas, theme: Theme, share: float, corner: tuple[int, int], size: int) -> None:
    """Draw how far compiling has come, below and left of a corner [px], in letters of a size [px]."""
    words, style = f"Compiling: {share:.0%}", TextStyle(size, theme.faint)
    width, height = canvas.text_size("Compiling: 100%", style)
    left, top = corner[0] - width - 3 * _MARGIN, corner[1] + _MARGIN
    canvas.panel((left, top, width + 2 * _MARGIN, height + 2 * _MARGIN), theme.panel, theme.outline)
    canvas.text(words, (left + _MARGIN, top + _MARGIN // 2), style)
    _draw_bar(canvas, theme, left + _MARGIN, top + height + _MARGIN, width, share, _MARGIN // 2)


def draw_progress(canvas: Canvas, theme: Theme, share: float, remark: str, size: int) -> None:
    """Draw a bar filled to a share (0 to 1), what it is about, and a remark, in letters of a size [px]."""
    width, height = canvas.size
    bar = min(_WIDTH * size, width - 80)
    left, top, middle = (width - bar) // 2, height // 2, width // 2
    draw_loading(canvas, theme, "", size)
    _draw_bar(canvas, theme, left, top, bar, share, _HEIGHT * size)
    for words, down, letters, colour in (
        ("First start: compiling the physics for this computer.", -3.3, size + 1, theme.text),
        (remark, 1.9, size - 1, theme.faint),
        ("This is done once and kept. Esc quits.", 3.7, size - 1, theme.faint),
    ):
        style = _fitting(canvas, words, TextStyle(letters, colour), width - 20)
        canvas.text(words, (middle, top + round(down * size)), style, "centre")
