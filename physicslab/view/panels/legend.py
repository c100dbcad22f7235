"""What the arrows of the overlays mean: colour, head and scale of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from physicslab.view.canvas.canvas import Canvas, TextStyle
from physicslab.view.canvas.theme import Theme
from physicslab.view.overlay.arrows import (
    CONTACT_NORMAL,
    FORCE,
    FRICTION_IMPULSE,
    NORMAL_IMPULSE,
    VELOCITY,
    ArrowKind,
    dashes,
    draw_arrows,
)
from physicslab.view.overlay.impulses import IMPACT_WIDTH, REST_WIDTH
from physicslab.view.overlay.overlays import Overlays
from physicslab.view.panels.panels import Line, Panel, lay_out

__all__ = ["Legend", "legend_of"]


@dataclass(frozen=True, slots=True)
class Sample:
    """A piece of what is explained: an arrow, or a line of the friction cone where ``kind`` is ``None``."""

    kind: ArrowKind | None
    width: float = 2.0
    dashed: bool = False


@dataclass(frozen=True, slots=True)
class Legend:
    """The legend, laid out and ready to be drawn.

    Attributes
    ----------
    panel : Panel
        The words.
    samples : tuple
        What is drawn before them: a sample, the middle of its left end, and its length [px].
    """

    panel: Panel
    samples: tuple[tuple[Sample, tuple[float, float], float], ...]

    def moved(self, left: int, top: int) -> Legend:
        """Return it with its corner at another place [px]."""
        dx, dy = left - self.panel.rect[0], top - self.panel.rect[1]
        texts = tuple(
            (words, (x + dx, y + dy), style, side) for words, (x, y), style, side in self.panel.texts
        )
        samples = tuple((sample, (x + dx, y + dy), length) for sample, (x, y), length in self.samples)
        return Legend(Panel((left, top, *self.panel.rect[2:]), texts), samples)

    def draw(self, canvas: Canvas, theme: Theme) -> None:
        """Draw it."""
        self.panel.show("legend", canvas, theme)
        for sample, place, length in self.samples:
            start, span = np.array([place]), np.array([(length, 0.0)])
            if sample.kind is not None:
                draw_arrows(start, span, sample.kind, canvas, theme, width=sample.width)
            elif sample.dashed:
                froms, tos, _ = dashes(start, start + span)
                canvas.lines(froms, tos, theme.friction_cone, 1.2)
            else:
                canvas.lines(start, start + span, theme.friction_cone, 1.2)


type Row = tuple[Sample, str, str]


def _rows(overlays: Overlays) -> tuple[list[Row], list[str]]:
    rows: list[Row] = []
    remarks = []
    if overlays.arrows:
        rows += [
            (Sample(VELOCITY), VELOCITY.name, overlays.velocity.words),
            (Sample(FORCE), FORCE.name, overlays.force.words),
            (Sample(CONTACT_NORMAL, CONTACT_NORMAL.width), CONTACT_NORMAL.name, "direction only"),
        ]
        remarks.append("Select a body to see each of the forces on it.")
    if overlays.impulses:
        rows += [
            (Sample(NORMAL_IMPULSE, IMPACT_WIDTH), "Normal, impact", overlays.impact.words),
            (Sample(FRICTION_IMPULSE, IMPACT_WIDTH), "Friction, impact", overlays.impact.words),
            (Sample(NORMAL_IMPULSE, REST_WIDTH), "Normal, resting", overlays.rest.words),
            (Sample(FRICTION_IMPULSE, REST_WIDTH), "Friction, resting", overlays.rest.words),
            (Sample(None), "Friction cone μ", "sticks"),
            (Sample(None, dashed=True), "Friction cone μ", "slips"),
        ]
        remarks.append(
            "Impulses act on the body the normal enters. Impacts stay for 1 s. At rest: of one substep."
        )
    remarks.append("Two strokes across: longer than drawn.")
    return rows, remarks


def legend_of(overlays: Overlays, width: int, size: int, canvas: Canvas, theme: Theme) -> Legend | None:
    """Return the legend of the overlays that are on, its corner at the origin; ``None`` if none is."""
    if not (overlays.arrows or overlays.impulses):
        return None
    rows, remarks = _rows(overlays)
    pad = round(0.7 * size)
    scale = "scale, kept" if overlays.keeps_scales else "scale"
    heading = lay_out([Line("Arrows", scale, "heading")], 0, 0, width, size, canvas, theme)
    label, value = TextStyle(size - 1, theme.text), TextStyle(size - 1, theme.faint)
    row_height = canvas.text_size("Ag", label)[1]
    texts, samples, y = list(heading.texts), [], heading.rect[3] - pad
    sample_length = 2.4 * size
    for sample, name, scale in rows:
        texts.append((name, (round(pad + sample_length + 0.6 * size), y), label, "left"))
        texts.append((scale, (width - pad, y), value, "right"))
        samples.append((sample, (float(pad), y + 0.5 * row_height), sample_length))
        y += row_height
    remarked = lay_out(_remarks(remarks), 0, y - pad // 2, width, size, canvas, theme)
    texts += remarked.texts
    return Legend(Panel((0, 0, width, y - pad // 2 + remarked.rect[3]), tuple(texts)), tuple(samples))


def _remarks(words: Sequence[str]) -> list[Line]:
    return [Line(remark, kind="remark") for remark in words]
