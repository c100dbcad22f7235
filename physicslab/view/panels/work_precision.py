"""The plot of error against run time, over the whole window."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from physicslab.view.canvas.canvas import Canvas, TextStyle
from physicslab.view.canvas.quantities import power_of_ten
from physicslab.view.canvas.theme import Theme
from physicslab.view.panels.error_study import ErrorStudy, Sample
from physicslab.view.panels.panels import broken, text_size

__all__ = ["draw_work_precision"]

_FLOOR = 1e-17
"""Errors below this are drawn at it [m]: zero has no place on a logarithmic scale."""
_MARK = 5.0
"""Half the size of a mark [px]."""
_RING = tuple((math.cos(n * math.pi / 6), math.sin(n * math.pi / 6)) for n in range(13))
_MARKS = (
    ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)),
    ((0, -1.3), (1.2, 0.9), (-1.2, 0.9), (0, -1.3)),
    ((0, -1.4), (1.4, 0), (0, 1.4), (-1.4, 0), (0, -1.4)),
    ((-1.1, -1.1), (1.1, 1.1), (0, 0), (-1.1, 1.1), (1.1, -1.1)),
    _RING,
    ((0, -1.4), (0, 1.4), (0, 0), (-1.4, 0), (1.4, 0)),
    ((0, 1.3), (1.2, -0.9), (-1.2, -0.9), (0, 1.3)),
)
"""The marks of the methods in turn, as strokes: no two differ by colour alone."""


@dataclass(frozen=True, slots=True)
class _Frame:
    """The axes: where they are [px], and the powers of ten at their ends."""

    left: int
    top: int
    right: int
    bottom: int
    cost: tuple[int, int]
    error: tuple[int, int]

    def place(self, cost: float, error: float) -> tuple[float, float]:
        """Return the pixel of a run."""
        x = (math.log10(cost) - self.cost[0]) / (self.cost[1] - self.cost[0])
        y = (math.log10(error) - self.error[0]) / (self.error[1] - self.error[0])
        return self.left + x * (self.right - self.left), self.bottom - y * (self.bottom - self.top)


def draw_work_precision(study: ErrorStudy, canvas: Canvas, theme: Theme) -> None:
    """Draw what a study found: one mark a run, methods joined by lines, fast to the left, right below."""
    size = text_size(canvas)
    width, height = canvas.size
    edge = 2 * size
    canvas.panel((edge, edge, width - 2 * edge, height - 2 * edge), theme.panel, theme.key_rim)
    title, words = TextStyle(size + 4, theme.heading, bold=True), TextStyle(size, theme.faint)
    canvas.text("Error against run time", (width // 2, edge + size), title, "centre")
    foot = broken(f"{study.remark}. F5 measures again, Esc closes this.", width - 8 * size, canvas, words)
    line = canvas.text_size("Ag", words)[1]
    y = height - edge - size - line * len(foot)
    for n, part in enumerate(foot):
        canvas.text(part, (width // 2, y + n * line), words, "centre")
    methods = list(dict.fromkeys(sample.integrator for sample in study.samples))
    legend = max(canvas.text_size(method, words)[0] for method in methods) + 3 * size
    frame = _frame(
        study.samples, (edge + 5 * size, edge + 4 * size, width - edge - legend - 2 * size, y - 4 * size)
    )
    _draw_axes(frame, size, canvas, theme)
    for n, method in enumerate(methods):
        colour = theme.bodies[n % len(theme.bodies)]
        points = np.array(
            [
                frame.place(max(s.cpu_ms, 1e-3), max(s.error, _FLOOR))
                for s in study.samples
                if s.integrator == method
            ]
        )
        canvas.lines(points[:-1], points[1:], colour, 1.5, 0.8)
        beside = (frame.right + 2 * size, frame.top + n * round(1.6 * size))
        mark = np.array([(beside[0], beside[1] + 0.7 * size)])
        for spot in np.concatenate((points, mark)):
            strokes = spot + _MARK * np.array(_MARKS[n % len(_MARKS)], dtype=np.float64)
            canvas.lines(strokes[:-1], strokes[1:], colour, 2.0)
        canvas.text(method, (beside[0] + size, beside[1]), TextStyle(size, theme.text))


def _frame(samples: Sequence[Sample], rect: tuple[int, int, int, int]) -> _Frame:
    costs = [max(sample.cpu_ms, 1e-3) for sample in samples]
    errors = [max(sample.error, _FLOOR) for sample in samples]
    return _Frame(*rect, _powers(costs), _powers(errors))


def _powers(values: Sequence[float]) -> tuple[int, int]:
    """Return the powers of ten around values, at least one apart."""
    low = math.floor(math.log10(min(values)))
    return low, max(low + 1, math.ceil(math.log10(max(values))))


def _draw_axes(frame: _Frame, size: int, canvas: Canvas, theme: Theme) -> None:
    """Draw a line for every power of ten, labelled where there is room, and name the axes."""
    style = TextStyle(size - 1, theme.faint)
    half = canvas.text_size("Ag", style)[1] // 2
    every = max(1, math.ceil((frame.error[1] - frame.error[0]) * 3 * half / max(frame.bottom - frame.top, 1)))
    for power in range(frame.error[0], frame.error[1] + 1):
        y = frame.place(10.0 ** frame.cost[0], 10.0**power)[1]
        canvas.lines(np.array([(frame.left, y)]), np.array([(frame.right, y)]), theme.axis)
        if (power - frame.error[0]) % every == 0:
            canvas.text(power_of_ten(power), (frame.left - size // 2, round(y) - half), style, "right")
    for power in range(frame.cost[0], frame.cost[1] + 1):
        x = frame.place(10.0**power, 10.0 ** frame.error[0])[0]
        canvas.lines(np.array([(x, frame.top)]), np.array([(x, frame.bottom)]), theme.axis)
        canvas.text(power_of_ten(power), (round(x), frame.bottom + size // 3), style, "centre")
    middle = (frame.left + frame.right) // 2
    canvas.text("run time, ms", (middle, frame.bottom + 2 * size), TextStyle(size, theme.text), "centre")
    canvas.text(
        "error, m", (frame.left, frame.top - round(1.8 * size)), TextStyle(size, theme.text), "centre"
    )
