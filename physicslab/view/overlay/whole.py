"""Bodies as a whole: their centre of mass, their momenta, and the parts of arrows along x and y."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform, Velocity
from physicslab.view.canvas.camera import Drawing
from physicslab.view.canvas.canvas import TextStyle, draw_spots
from physicslab.view.overlay import arrows
from physicslab.view.overlay.legend import Overlays
from physicslab.world import World

_RADIUS = 7.0
"""Radius of the mark of a centre of mass [px]."""


def draw_wholes(world: World, chosen: Sequence[int], overlays: Overlays, on: Drawing) -> None:
    """Draw what is on of centres of mass and momenta: of all that moves, and of several ``chosen`` bodies."""
    rows = world.batch(Transform, Velocity, Mass).rows
    if not len(rows):
        return
    mass, linear = world.table(Mass)["mass"][rows], world.table(Velocity)["linear"][rows]
    place = world.table(Transform)["position"][rows]
    momentum = mass[:, None] * linear
    if overlays.momenta:
        size = np.hypot(momentum[:, 0], momentum[:, 1])
        overlays.momentum.follow(size, overlays.reach, world.time)
        overlays.momentum.draw(place, momentum, arrows.MOMENTUM, on, parts=overlays.parts)
    if overlays.centres:
        groups = [("centre of mass", np.ones(len(rows), np.bool_))]
        picked = np.isin(world.entity_index.entities[rows], chosen)
        if 1 < picked.sum() < len(rows):
            groups.append(("of the selected", picked))
        for words, part in groups:
            share = mass[part] / mass[part].sum()
            centre, total = share @ place[part], momentum[part].sum(axis=0)
            if np.isfinite(centre).all():
                _draw_centre(centre, words, on)
                if overlays.momenta:
                    middle, whole = centre[None], total[None]
                    overlays.momentum.draw(middle, whole, arrows.MOMENTUM, on, parts=overlays.parts)


def _draw_centre(centre: NDArray[np.float64], words: str, on: Drawing) -> None:
    """Draw the mark of a centre of mass, a disc in quarters, with its words beside."""
    at = on.camera.project(centre[None])
    if not (np.abs(at) < 1e6).all():
        return
    theme, canvas = on.theme, on.canvas
    draw_spots(canvas, at, _RADIUS, theme.background, theme.heading)
    for turn in (0.25 * np.pi, 1.25 * np.pi):
        way = 0.45 * _RADIUS * np.array((np.cos(turn), -np.sin(turn)))
        canvas.lines(at + way, at + way, theme.heading, 0.8 * _RADIUS)
    style = TextStyle(max(on.size - 2, 10), theme.text)
    (width, height), pad = canvas.text_size(words, style), style.size // 3
    left, top = round(at[0, 0] + _RADIUS + 5), round(at[0, 1]) - height
    canvas.panel((left - pad, top, width + 2 * pad, height), theme.panel, theme.outline, theme.panel_opacity)
    canvas.text(words, (left, top), style)
