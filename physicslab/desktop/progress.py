"""The window while it loads, and while kernels are compiled."""

from physicslab.theme import Theme
from physicslab.view.canvas.canvas import Canvas, TextStyle

PAUSE = 0.05
"""Time [s] between two looks at whether what is shown here has changed, or the user has done anything."""
_WIDTH, _HEIGHT = 460, 14
_MARGIN = 10
"""Around the panel in the corner [px]."""


def draw_loading(canvas: Canvas, theme: Theme, remark: str) -> None:
    """Draw the name of the program, and a remark."""
    width, height = canvas.size
    canvas.clear(theme.sky_top, theme.sky_bottom, theme.grain)
    canvas.text(
        "PhysicsLab", (width // 2, height // 2 - 110), TextStyle(34, theme.heading, bold=True), "centre"
    )
    if remark:
        canvas.text(remark, (width // 2, height // 2 + 28), TextStyle(14, theme.faint), "centre")


def _draw_bar(
    canvas: Canvas, theme: Theme, left: int, top: int, width: int, share: float, height: int = _HEIGHT
) -> None:
    canvas.panel((left, top, width, height), theme.panel, theme.outline)
    canvas.panel((left, top, round(width * share), height), theme.accent, theme.accent)


def draw_waiting(canvas: Canvas, theme: Theme, share: float, remark: str) -> None:
    """Draw over the world that it waits for something that is not compiled yet."""
    width, height = canvas.size
    panel = min(_WIDTH, width - 40)
    left, top, middle = (width - panel) // 2, height // 2 - 60, width // 2
    canvas.panel((left, top, panel, 120), theme.panel, theme.outline)
    title = TextStyle(16, theme.text)
    canvas.text("Paused: this part is still being compiled.", (middle, top + 16), title, "centre")
    _draw_bar(canvas, theme, left + 30, top + 52, panel - 60, share)
    canvas.text(remark, (middle, top + 80), TextStyle(14, theme.faint), "centre")


def draw_corner(canvas: Canvas, theme: Theme, share: float, corner: tuple[int, int], size: int) -> None:
    """Draw how far compiling has come, below and left of a corner [px], in letters of a size [px]."""
    words, style = f"Compiling: {share:.0%}", TextStyle(size, theme.faint)
    width, height = canvas.text_size("Compiling: 100%", style)
    left, top = corner[0] - width - 3 * _MARGIN, corner[1] + _MARGIN
    canvas.panel((left, top, width + 2 * _MARGIN, height + 2 * _MARGIN), theme.panel, theme.outline)
    canvas.text(words, (left + _MARGIN, top + _MARGIN // 2), style)
    _draw_bar(canvas, theme, left + _MARGIN, top + height + _MARGIN, width, share, _MARGIN // 2)


def draw_progress(canvas: Canvas, theme: Theme, share: float, remark: str) -> None:
    """Draw a bar filled to a share (0 to 1), what it is about, and a remark."""
    width, height = canvas.size
    bar = min(_WIDTH, width - 80)
    left, top, middle = (width - bar) // 2, height // 2, width // 2
    draw_loading(canvas, theme, "")
    title, faint = TextStyle(16, theme.text), TextStyle(14, theme.faint)
    canvas.text("First start: compiling the physics for this computer.", (middle, top - 50), title, "centre")
    _draw_bar(canvas, theme, left, top, bar, share)
    canvas.text(remark, (middle, top + 28), faint, "centre")
    canvas.text("This is done once and kept. Esc quits.", (middle, top + 56), faint, "centre")
