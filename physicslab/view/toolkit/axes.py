"""The axes of a plot in the language of the window, and the room within them."""

import math
from collections.abc import Iterator

from imgui_bundle import imgui, implot

from physicslab.languages.language import Language
from physicslab.theme import Colour
from physicslab.view.canvas.quantities import rounded_up
from physicslab.view.toolkit.style import as_vector

_AXES = 3
"""Axes that a plot may have in each direction."""
_ROUNDING = 1e-9
"""Share of a step by which a tick may lie beyond an end."""
_DECIMALS = 6
"""Decimals, and figures before the point, up to which a number is written without a power of ten, and beyond
which it is where that is not longer."""
_APART = (3.5, 1.6)
"""Least distance between ticks across and along, in heights of the text."""
WEIGHT = 0.13
"""Width of a line, in heights of the text."""


def finish_axes(language: Language) -> list[str]:
    """End the set-up of a plot's axes: ticks have as many decimals as their step, and a language's mark.

    ImPlot writes the numbers of its own ticks with a point, each with the figures that it has.

    Returns
    -------
    list of str
        The texts of the ticks that are drawn.
    """
    plot, size = implot.internal.get_current_plot(), imgui.get_font_size()
    axes = {
        implot.ImAxis_(n + _AXES * is_vertical): plot.y_axis(n) if is_vertical else plot.x_axis(n)
        for n in range(_AXES)
        for is_vertical in (False, True)
    }
    used = {name: axis for name, axis in axes.items() if axis.enabled}
    for name, axis in used.items():
        if axis.show_default_ticks:
            most = max(round(axis.pixel_size() / (size * _APART[axis.vertical])), 2)
            low, high = axis.range.min, axis.range.max
            is_log = axis.scale == implot.Scale_.log10
            ticks = dict(_powers(low, high) if is_log else _ticks(low, high, most))
            implot.setup_axis_ticks(name, list(ticks), [language.decimal(one) for one in ticks.values()])
    implot.setup_finish()
    return [axis.ticker.get_text(n) for axis in used.values() for n in range(axis.ticker.tick_count())]


def _ticks(low: float, high: float, most: int) -> Iterator[tuple[float, str]]:
    """Yield up to so many round numbers within a range, and their texts.

    >>> [text for _, text in _ticks(-0.21, 0.4, 4)], [text for _, text in _ticks(-12.5, -12.4989, 3)]
    (['-0.2', '0.0', '0.2', '0.4'], ['-12.5000', '-12.4995', '-12.4990'])
    >>> [text for _, text in _ticks(0.0, 1.6e7, 4)], [text for _, text in _ticks(0.0, 9e3, 3)]
    (['0', '5e6', '10e6', '15e6'], ['0', '5000'])
    >>> [text for _, text in _ticks(2e6, 2e6 + 1.0, 2)], [text for _, text in _ticks(999990.0, 1e6, 2)]
    (['2000000.0', '2000000.5', '2000001.0'], ['999990', '999995', '1000000'])
    """
    if not (math.isfinite(high - low) and high > low):
        return
    step = rounded_up((high - low) / most)
    decimals = -math.floor(math.log10(step * (1.0 + _ROUNDING)))
    largest, behind, power = max(-low, high), max(decimals, 0), f"e{-decimals}"
    is_plain = decimals <= _DECIMALS and largest < 10.0**_DECIMALS
    is_plain = is_plain or len(f"{largest:.{behind}f}") <= len(f"{largest * 10.0**decimals:.0f}{power}")
    scale, behind, power = (1.0, behind, "") if is_plain else (10.0**decimals, 0, power)
    for k in range(math.ceil(low / step - _ROUNDING), math.floor(high / step + _ROUNDING) + 1):
        yield k * step, f"{k * step * scale:z.{behind}f}{power if k else ''}"


def _powers(low: float, high: float) -> Iterator[tuple[float, str]]:
    """Yield the powers of ten within a range, and their texts.

    >>> [text for _, text in _powers(0.02, 250.0)]
    ['0.1', '1', '10', '100']
    """
    for power in range(math.ceil(math.log10(low)), math.floor(math.log10(high)) + 1):
        yield 10.0**power, f"{10.0**power:g}"


def pad_plot(size: float) -> None:
    """Leave room around plots: half of a number beside its axis, in which the last tick is written [px]."""
    implot.get_style().plot_padding = imgui.ImVec2(1.1 * size, 0.3 * size)


def plot_rect() -> tuple[int, int, int, int]:
    """Return the left, the top, the width and the height of the plot that is built, within its axes [px]."""
    corner, size = implot.get_plot_pos(), implot.get_plot_size()
    return round(corner.x), round(corner.y), round(size.x), round(size.y)


def line_look(colour: Colour, weight: float, opacity: float = 1.0) -> implot.Spec:
    """Return the look of a line so many pixels wide."""
    spec = implot.Spec()
    spec.line_color, spec.line_weight = as_vector(colour, opacity), weight
    return spec
