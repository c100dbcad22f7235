"""The legend of the overlays' arrows: colour, head and scale of each."""

from dataclasses import dataclass, replace

import numpy as np

from physicslab.view.canvas.canvas import Align, Rect, TextStyle
from physicslab.view.canvas.drawing import Drawing
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
from physicslab.view.overlay.banners import broken
from physicslab.view.overlay.impulses import IMPACT_WIDTH, REST_WIDTH
from physicslab.view.overlay.overlays import Overlays

_WIDTH = 19.5
"""Width of the legend, in heights of the text."""
_MAX_SHARE = 0.3
"""Share of the world's room that it may take with all its words."""


@dataclass(frozen=True, slots=True)
class Sample:
    """A piece of what is explained: an arrow, or a line of the friction cone where ``kind`` is ``None``."""

    kind: ArrowKind | None
    width: float = 2.0
    dashed: bool = False


@dataclass(frozen=True, slots=True)
class Legend:
    """The legend, laid out with its corner at the origin and ready to be drawn.

    Attributes
    ----------
    size : tuple of two ints
        Its width and height [px].
    texts : tuple
        Words, place of their top left or top right [px], style, and on which side that is.
    samples : tuple
        The samples before them, each with the middle of its left end, and its length [px].
    """

    size: tuple[int, int]
    texts: tuple[tuple[str, tuple[int, int], TextStyle, Align], ...]
    samples: tuple[tuple[Sample, tuple[float, float], float], ...]

    def draw(self, left: int, top: int, on: Drawing) -> Rect:
        """Draw it with its corner at a place, and return where it is [px]."""
        rect = (left, top, *self.size)
        on.canvas.panel(rect, on.theme.panel, on.theme.outline, on.theme.panel_opacity)
        for words, (x, y), style, side in self.texts:
            on.canvas.text(words, (left + x, top + y), style, side)
        for sample, (across, down), length in self.samples:
            start, span = np.array([(left + across, top + down)]), np.array([(length, 0.0)])
            if sample.kind is not None:
                draw_arrows(start, span, sample.kind, on, width=sample.width)
            else:
                line = dashes(start, start + span)[:2] if sample.dashed else (start, start + span)
                on.canvas.lines(line[0], line[1], on.theme.friction_cone, 1.2)
        return rect


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


def legend_of(overlays: Overlays, room: tuple[int, int], on: Drawing) -> Legend | None:
    """Return the legend of the overlays that are on, its corner at the origin; ``None`` if none is.

    Where it would be too wide for the room [px], or take too much of it, scales and remarks are left out, and
    words become as small as they must.
    """
    if not (overlays.arrows or overlays.impulses):
        return None
    width = round(_WIDTH * on.size)
    legend = _laid_out(overlays, width, on)
    if width <= room[0] and width * legend.size[1] <= _MAX_SHARE * room[0] * room[1]:
        return legend
    brief = _laid_out(overlays, 0, on)
    if brief.size[0] <= room[0]:
        return brief
    return _laid_out(overlays, 0, replace(on, size=max(on.size * room[0] // brief.size[0], 8)))


def _laid_out(overlays: Overlays, width: int, on: Drawing) -> Legend:
    """Return the legend, so wide [px]; with names alone where that is 0."""
    rows, remarks = _rows(overlays)
    pad, sample_length = round(0.7 * on.size), 2.4 * on.size
    label, value = TextStyle(on.size - 1, on.theme.text), TextStyle(on.size - 1, on.theme.faint)
    title, small = (
        TextStyle(on.size, on.theme.heading, bold=True),
        TextStyle(max(on.size - 2, 10), on.theme.faint),
    )
    heights = {style: on.canvas.text_size("Ag", style)[1] for style in (label, title, small)}
    inset, y = round(pad + sample_length + 0.6 * on.size), pad
    texts: list[tuple[str, tuple[int, int], TextStyle, Align]] = []
    if width:
        kept = "scale, kept" if overlays.keeps_scales else "scale"
        texts.append((kept, (width - pad, y + heights[title] - heights[small]), small, "right"))
        texts.append(("Arrows", (pad, y), title, "left"))
        y += heights[title]
    else:
        rows, remarks = list({name: (sample, name, "") for sample, name, _ in rows}.values()), []
        width = inset + max(on.canvas.text_size(name, label)[0] for _, name, _ in rows) + pad
    samples = []
    for sample, name, scale in rows:
        texts.append((name, (inset, y), label, "left"))
        if scale:
            texts.append((scale, (width - pad, y), value, "right"))
        samples.append((sample, (float(pad), y + 0.5 * heights[label]), sample_length))
        y += heights[label]
    y += pad - pad // 2 if remarks else 0
    for line in (line for remark in remarks for line in broken(remark, width - 2 * pad, on.canvas, small)):
        texts.append((line, (pad, y), small, "left"))
        y += heights[small]
    return Legend((width, y + pad), tuple(texts), tuple(samples))
