"""Labels of widgets: what is written on one, and what it is known by, which is not the same."""

import re

from physicslab.view.canvas.drawable_text import drawable

_UNSEEN = "\u200b"
"""A space without width: it parts two signs ``#`` that Dear ImGui would take for a mark of its own."""


def widget_label(words: str, identity: str) -> str:
    r"""Return a label of Dear ImGui that shows words and is known by an identity, whatever either holds.

    >>> widget_label("a", "b"), widget_label("a", "b\0#\udce9").isascii()
    ('a###b', True)
    """
    shown = re.sub("#(?=#)", f"#{_UNSEEN}", drawable(words))
    return f"{shown}###{ascii(identity)[1:-1].replace('#', '|23')}"
