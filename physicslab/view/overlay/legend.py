"""Which overlays are shown, what is kept for them from frame to frame, and their legend."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Velocity
from physicslab.state.shapes import lengths_of
from physicslab.view.canvas.camera import Camera, Drawing
from physicslab.view.canvas.canvas import Align, Points, Rect, TextStyle
from physicslab.view.canvas.quantities import round_quantity, rounded_up
from physicslab.view.overlay import arrows
from physicslab.view.overlay.banners import broken
from physicslab.view.overlay.contact_samples import RecentImpacts
from physicslab.view.overlay.labels import Labels
from physicslab.world import World

_MEMORY = 4.0
"""Time [s] in which the memory of a strong value fades to a third."""
_SHORTEST, _LONGEST = 0.25, 1.3
"""While the longest arrow is within these shares of the wanted length, the scale stays."""
FLIP = np.array((1.0, -1.0))
"""The screen's y points down."""


class Gauge:
    """How much of a quantity a metre of arrow stands for: 1, 2 or 5 times a power of ten.

    The scale follows the strongest value of the last seconds, and stays where there is none. It depends on
    the world alone: zooming enlarges arrows together with all else, and the legend stays true.

    Parameters
    ----------
    unit : str
        Unit of the quantity.

    Attributes
    ----------
    per_metre : float
        How much one metre stands for; 0 before anything was shown.
    kept : bool
        Whether it stays as it is, so that two pictures can be compared.

    Examples
    --------
    >>> gauge = Gauge("m/s")
    >>> gauge.follow(np.array([3.0]), reach=1.5, time=0.0)
    >>> gauge.words
    '1 m = 2 m/s'
    """

    def __init__(self, unit: str) -> None:
        self.unit = unit
        self.per_metre = 0.0
        self.kept = False
        self._peak = 0.0
        self._time = 0.0

    def follow(self, values: NDArray[np.float64], reach: float, time: float) -> None:
        """Take in the magnitudes (n,) of a frame; the strongest should be about ``reach`` [m] long."""
        strongest = float(np.max(values, initial=0.0, where=np.isfinite(values)))
        if strongest == 0.0 or (self.kept and self.per_metre):
            return
        faded = self._peak * math.exp(-abs(time - self._time) / _MEMORY)  # after a restart as well
        self._peak, self._time = max(strongest, faded), time
        wanted = self._peak / reach
        if wanted > 1e-12 and not _SHORTEST * self.per_metre <= wanted <= _LONGEST * self.per_metre:
            self.per_metre = rounded_up(wanted, 1e-3)

    def draw(
        self, place: Points, value: Points, kind: arrows.ArrowKind, on: Drawing, *, parts: bool = False
    ) -> None:
        """Draw values (n, 2) at places [m] as arrows, and their ``parts`` along x and y, once scaled."""
        if self.per_metre:
            start, span = on.camera.project(place), value * FLIP * (on.camera.scale / self.per_metre)
            arrows.draw_arrows(start, span, kind, on)
            if parts:
                arrows.draw_parts(start, span, kind, on)

    @property
    def words(self) -> str:
        """The scale, as it stands in the legend."""
        return f"1 m = {round_quantity(self.per_metre, self.unit)}" if self.per_metre else "none yet"


_REACH = 0.13
"""Length of the longest arrow, as a share of the smaller side of the picture."""
_MAX_IN_CROWD = 2.0
"""Its greatest length among several bodies, in sizes of a body: no arrow is lost among the others."""
_MIN_LENGTH = 16.0
"""Its length is at least that [px]."""


_GAUGES = {
    "arrows": ("velocity", "force"), "impulses": ("impact", "rest"), "momenta": ("momentum",),
    "selection": ("body_force",),
}  # fmt: skip
"""The scales of each overlay."""


class Overlays:
    """The state of the overlays; all of it is the window's, none the world's.

    Attributes
    ----------
    arrows, impulses : bool
        Whether velocities, forces and normals are shown, and whether impulses are.
    centres, momenta, parts : bool
        Whether centres of mass are shown, momenta, and the parts of arrows along x and y.
    keeps_scales : bool
        Whether the scales of arrows stay as they are.
    awaits_prediction : bool
        Whether forces and impulses are left out: a lesson's reader is to say first what will happen.
    shows_body_forces : bool
        Whether the forces on the selection are drawn one by one.
    reach : float
        The wanted length of the strongest arrow [m], chosen when a world is shown or an overlay turned on.
    velocity, force, impact, rest : Gauge
        The scales: of velocities, forces, impulses of impacts, and impulses that hold bodies apart.
    body_force, momentum : Gauge
        The scales of the forces on the selection, and of momenta.
    force_labels : Labels
        Where their names stand.
    impacts : RecentImpacts
        The impacts of the last second.
    labels : Labels
        Where the numbers stand.
    covered : list of Rect
        Rectangles that the HUD covers [px]; labels keep clear of them.
    """

    def __init__(self) -> None:
        self.arrows = self.impulses = self.keeps_scales = False
        self.centres = self.momenta = self.parts = self.awaits_prediction = False
        self.shows_body_forces = False
        self.reach = 1.0
        self.velocity, self.force = Gauge("m/s"), Gauge("N")
        self.impact, self.rest = Gauge("N s"), Gauge("N s")
        self.body_force, self.force_labels = Gauge("N"), Labels()
        self.momentum = Gauge("kg m/s")
        self.impacts = RecentImpacts()
        self.labels = Labels()
        self.covered: list[Rect] = []

    def toggle(self, overlay: Literal["arrows", "impulses", "momenta"], world: World, camera: Camera) -> None:
        """Show or hide velocities, forces and contact normals, the impulses at contacts, or momenta."""
        is_on = not getattr(self, overlay)
        setattr(self, overlay, is_on)
        if is_on:
            self._scale(_GAUGES[overlay], world, camera)
        if overlay == "impulses":
            self.forget()

    def begin(self, world: World, camera: Camera) -> None:
        """Forget what belongs to the world that was shown before, and choose the scales for another."""
        self.forget()
        self._scale([name for names in _GAUGES.values() for name in names], world, camera)

    def toggle_scales(self) -> None:
        """Let the scales of all arrows stay as they are, or follow what is shown again."""
        self.keeps_scales = not self.keeps_scales
        for gauge in (self.velocity, self.force, self.impact, self.rest, self.body_force, self.momentum):
            gauge.kept = self.keeps_scales

    def forget(self) -> None:
        """Forget impacts and the places of labels: they belong to what was shown before."""
        self.impacts.clear()
        self.labels.clear()
        self.force_labels.clear()

    def _scale(self, names: Iterable[str], world: World, camera: Camera) -> None:
        """Choose scales again, unless they are to stay as they are."""
        if self.keeps_scales:
            return
        for name in names:
            setattr(self, name, Gauge(getattr(self, name).unit))
        shape = world.table(Shape)
        rows = world.batch(Shape, Velocity).rows
        self.reach = _REACH * min(camera.size) / camera.scale
        if len(rows) > 1:
            half, radius = lengths_of(shape, rows)
            size = 2.0 * (half.max(axis=1) + radius)
            self.reach = min(
                self.reach, max(_MAX_IN_CROWD * float(np.median(size)), _MIN_LENGTH / camera.scale)
            )


# ---- the legend: colour, head and scale of each arrow ------------------------------------------------------


_WIDTH = 19.5
"""Least width of the legend, in heights of the text."""
_MAX_SHARE = 0.3
"""Share of the world's room that it may take with all its words."""


@dataclass(frozen=True, slots=True)
class Sample:
    """A piece of what is explained: an arrow, or a line of the friction cone where ``kind`` is ``None``."""

    kind: arrows.ArrowKind | None
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
                arrows.draw_arrows(start, span, replace(sample.kind, width=sample.width), on)
            else:
                line = arrows.dashes(start, start + span)[:2] if sample.dashed else (start, start + span)
                on.canvas.lines(line[0], line[1], on.theme.friction_cone, 1.2)
        return rect


type Row = tuple[Sample, str, str]


def _rows(overlays: Overlays) -> tuple[list[Row], list[str]]:
    rows: list[Row] = []
    remarks = []
    if overlays.arrows:
        force = "after your prediction" if overlays.awaits_prediction else overlays.force.words
        rows += [
            (Sample(arrows.VELOCITY), arrows.VELOCITY.name, overlays.velocity.words),
            (Sample(arrows.FORCE), arrows.FORCE.name, force),
            (
                Sample(arrows.CONTACT_NORMAL, arrows.CONTACT_NORMAL.width),
                arrows.CONTACT_NORMAL.name,
                "direction only",
            ),
        ]
        if overlays.shows_body_forces:
            rows.insert(2, (Sample(arrows.BODY_FORCE), arrows.BODY_FORCE.name, overlays.body_force.words))
        elif not overlays.awaits_prediction:
            remarks.append("Select a body to see each of the forces on it.")
    if overlays.momenta:
        rows.append((Sample(arrows.MOMENTUM), arrows.MOMENTUM.name, overlays.momentum.words))
    if overlays.impulses:
        rows += [
            (Sample(arrows.NORMAL_IMPULSE, arrows.IMPACT_WIDTH), "Normal, impact", overlays.impact.words),
            (Sample(arrows.FRICTION_IMPULSE, arrows.IMPACT_WIDTH), "Friction, impact", overlays.impact.words),
            (Sample(arrows.NORMAL_IMPULSE, arrows.REST_WIDTH), "Normal, resting", overlays.rest.words),
            (Sample(arrows.FRICTION_IMPULSE, arrows.REST_WIDTH), "Friction, resting", overlays.rest.words),
            (Sample(None), "Friction cone μ", "sticks"),
            (Sample(None, dashed=True), "Friction cone μ", "slips"),
        ]
        remarks.append(
            "Impulses act on the body the normal enters. Impacts stay for 1 s. At rest: of one substep."
        )
    remarks.append("Two strokes across: longer than drawn.")
    return rows, remarks


def legends_of(overlays: Overlays, room: tuple[int, int], on: Drawing) -> Iterator[Legend]:
    """Yield the legend of the overlays that are on, its corner at the origin, in the forms that fit a room.

    The best comes first; without an overlay there is none. Where it would be too wide for the room [px], or
    take too much of it, scales and remarks are left out, and words become as small as they must.
    """
    if not (overlays.arrows or overlays.impulses or overlays.momenta):
        return
    width = round(_WIDTH * on.size)
    whole = _laid_out(overlays, width, on)
    if whole.size[0] <= room[0] and whole.size[0] * whole.size[1] <= _MAX_SHARE * room[0] * room[1]:
        yield whole
    brief = _laid_out(overlays, 0, on)
    if brief.size[0] > room[0]:
        brief = _laid_out(overlays, 0, replace(on, size=max(on.size * room[0] // brief.size[0], 8)))
    yield brief


def _laid_out(overlays: Overlays, width: int, on: Drawing) -> Legend:
    """Return the legend, so wide [px] or as its rows need; with names alone where that is 0."""
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
        widths = [
            sum(on.canvas.text_size(words, label)[0] for words in (name, scale)) for _, name, scale in rows
        ]
        width = max(width, inset + max(widths) + on.size + pad)
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
