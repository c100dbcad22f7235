"""The axes of a plot in the language of the window."""

import ctypes

from imgui_bundle import implot

from physicslab.languages.language import Language

_AXES = 3
"""Axes that a plot may have in each direction."""


def finish_axes(language: Language) -> list[str]:
    """End the set-up of a plot's axes: their ticks have the decimal mark of a language.

    ImPlot formats the numbers itself and Python can give it no formatter, so the mark is put into the
    finished texts; one of several bytes in UTF-8 would not fit there, and leaves them as they are.

    Returns
    -------
    list of str
        The texts of the ticks that are shown.
    """
    implot.setup_finish()
    plot = implot.internal.get_current_plot()
    axes = [axis for n in range(_AXES) for axis in (plot.x_axis(n), plot.y_axis(n)) if axis.enabled]
    mark = language.say(".").encode()
    shown: list[str] = []
    for axis in axes:
        letters = axis.ticker.text_buffer.buf
        if mark != b"." and len(mark) == 1:
            text = ctypes.string_at(letters.data_address(), letters.size())
            ctypes.memmove(letters.data_address(), text.replace(b".", mark), len(text))
        shown += [axis.ticker.get_text(n) for n in range(axis.ticker.tick_count())]
    return shown
