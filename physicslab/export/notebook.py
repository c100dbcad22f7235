"""The player of a run in a notebook: a frame with its page, and a widget whose state Python sees and sets."""

import html
from functools import cache
from typing import Any

from physicslab.export.page import player_part

_FRAME = '<iframe srcdoc="{}" style="width: 100%; height: 540px; border: 0" sandbox="allow-scripts"></iframe>'


def frame(page: bytes) -> str:
    """Return HTML that shows a page, which cannot reach what is around it."""
    return _FRAME.format(html.escape(page.decode()))


def widget(page: bytes, start: float) -> Any:
    """Return the player of a page as a widget, at rest at its ``start`` [s].

    Raises
    ------
    ImportError
        Without anywidget.
    """
    return _widget_class()(frame=frame(page), time=start)


@cache
def _widget_class() -> Any:
    try:
        import anywidget
        import traitlets
    except ImportError as error:
        raise ImportError("a widget needs anywidget: pip install 'physicslab[notebook]'") from error

    class PlayerWidget(anywidget.AnyWidget):  # type: ignore[misc]
        """The player; ``time`` [s] and ``playing`` follow it, and it follows them."""

        _esm = player_part("widget.js")
        frame = traitlets.Unicode().tag(sync=True)
        time = traitlets.Float().tag(sync=True)
        playing = traitlets.Bool(False).tag(sync=True)

    return PlayerWidget
