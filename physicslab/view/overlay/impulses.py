"""The educational overlay: what every contact did to the bodies, as the resolver has it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Numbers, Points, Rect
from physicslab.view.canvas.theme import Theme
from physicslab.view.overlay.arrows import FRICTION_IMPULSE, NORMAL_IMPULSE, dashes, draw_arrows, longest
from physicslab.view.overlay.contact_samples import ContactSamples, resting_of, sliding
from physicslab.view.overlay.impacts import Impacts
from physicslab.view.overlay.labels import Key, Label
from physicslab.view.overlay.overlays import Overlays
from physicslab.view.panels.gauge import Gauge
from physicslab.view.panels.quantities import quantity
from physicslab.world import World

__all__ = ["IMPACT_WIDTH", "LABELLED", "REST_WIDTH", "draw_impulses", "said_of"]

LABELLED = 12
"""How many contacts have their numbers written beside them: the strongest."""
IMPACT_WIDTH, REST_WIDTH = 3.0, 1.6
"""How thick arrows are drawn [px]: an impact's, and those of resting contact."""
_LOYALTY = 1.5
"""So much stronger must another contact be to take the place of one whose numbers are shown."""

_ROUNDING = 1e-9
"""Friction of so small a share of the normal impulse is rounding, and written as 0."""


def draw_impulses(
    world: World, overlays: Overlays, camera: Camera, theme: Theme, canvas: Canvas, text_size: int
) -> None:
    """Draw the impulses of the impacts of the last second, and of what rests, with cones and numbers."""
    impacts = overlays.impacts.recent(world.time)
    impacts = impacts[np.argsort(impacts["time"], kind="stable")]  # the newest on top
    resting = _without(resting_of(world), impacts)
    resting = resting[resting["normal"] > 0.0]
    fresh = Impacts.freshness(impacts, world.time)
    overlays.impact.follow(impacts["normal"], overlays.reach, world.time)
    overlays.rest.follow(resting["normal"], overlays.reach, world.time)
    _draw_touches(resting, overlays.rest, REST_WIDTH, 0.9, camera, theme, canvas)
    _draw_touches(impacts, overlays.impact, IMPACT_WIDTH, fresh, camera, theme, canvas)
    worth_saying = [
        *_strongest(impacts, fresh, overlays.impact, True, camera),
        *_strongest(resting, np.ones(len(resting)), overlays.rest, False, camera),
    ]
    worth_saying.sort(key=lambda one: -one.weight * (_LOYALTY if overlays.labels.known(one.key) else 1.0))
    chosen = [one for one in worth_saying if not _under(one.at, overlays.covered)][:LABELLED]
    labels = [Label(one.key, one.at, said_of(one.touch, one.impact_count, one.slips)) for one in chosen]
    overlays.labels.draw(labels, overlays.covered, text_size, canvas, theme)


def _under(at: tuple[float, float], covered: Sequence[Rect]) -> bool:
    """Whether a place of the picture is covered."""
    return any(x <= at[0] < x + width and y <= at[1] < y + height for x, y, width, height in covered)


def _without(touches: ContactSamples, others: ContactSamples) -> ContactSamples:
    """Return the touches at other points than ``others``."""
    place = ["a", "b", "point"]
    kept: ContactSamples = touches[~np.isin(touches[place], others[place])] if len(others) else touches
    return kept


def _draw_touches(
    touches: ContactSamples,
    gauge: Gauge,
    width: float,
    opacity: float | Numbers,
    camera: Camera,
    theme: Theme,
    canvas: Canvas,
) -> None:
    """Draw cones, then friction, then normal impulses, all from the points of contact."""
    if not len(touches) or not gauge.per_metre:
        return
    start = camera.project(touches["place"])
    normal = touches["direction"] * (1.0, -1.0)  # the screen's y points down
    tangent = np.stack((normal[:, 1], -normal[:, 0]), axis=1)  # counter-clockwise, as seen
    scale = camera.scale / gauge.per_metre
    _draw_cones(start, normal, tangent, touches, scale, opacity, theme, canvas)
    friction_impulse = tangent * (touches["tangent"] * scale)[:, None]
    draw_arrows(start, friction_impulse, FRICTION_IMPULSE, canvas, theme, opacity=opacity, width=width)
    push = normal * (touches["normal"] * scale)[:, None]
    draw_arrows(start, push, NORMAL_IMPULSE, canvas, theme, opacity=opacity, width=width)


def _draw_cones(
    start: Points,
    normal: Points,
    tangent: Points,
    touches: ContactSamples,
    scale: float,
    opacity: float | Numbers,
    theme: Theme,
    canvas: Canvas,
) -> None:
    """Draw both sides of friction cones, as high as the normal impulse; broken where the contact slips."""
    height = np.minimum(touches["normal"] * scale, longest(canvas))
    shown = (touches["friction"] > 0.0) & (height >= 8.0)
    slips = sliding(touches)
    share = np.full(len(touches), 0.75) * opacity
    for chosen, broken in ((shown & ~slips, False), (shown & slips, True)):
        if not chosen.any():
            continue
        reach = height[chosen, None]
        aside = touches["friction"][chosen, None] * tangent[chosen]
        froms = np.concatenate((start[chosen], start[chosen]))
        sides = normal[chosen] + aside, normal[chosen] - aside
        tos = froms + np.concatenate([side * reach for side in sides])
        shares = np.tile(share[chosen], 2)
        if broken:
            froms, tos, whose = dashes(froms, tos)
            shares = shares[whose]
        canvas.lines(froms, tos, theme.friction_cone, 1.2, shares)


@dataclass(frozen=True, slots=True)
class _Candidate:
    """A touch whose numbers may be written: how much it stands out, where it is [px], what it is."""

    weight: float
    key: Key
    at: tuple[float, float]
    touch: np.void
    impact_count: bool
    slips: bool


def _strongest(
    touches: ContactSamples, fresh: NDArray[np.float64], gauge: Gauge, impact_count: bool, camera: Camera
) -> list[_Candidate]:
    """Return the touches in the picture that stand out most."""
    if not len(touches):
        return []
    with np.errstate(invalid="ignore"):
        at = camera.project(touches["place"])
        inside = (at >= 0.0) & (at < np.array(camera.size))
    weight = np.where(inside[:, 0] & inside[:, 1], touches["normal"] * fresh / (gauge.per_metre or 1.0), 0.0)
    chosen = np.argsort(-weight, kind="stable")[: 2 * LABELLED]
    chosen = chosen[weight[chosen] > 0.0]
    touches, slips = touches[chosen], sliding(touches[chosen]).tolist()
    keys = zip(touches["a"].tolist(), touches["b"].tolist(), touches["point"].tolist(), strict=True)
    places = ((x, y) for x, y in at[chosen].tolist())
    every = zip(weight[chosen].tolist(), keys, places, touches, slips, strict=True)
    return [
        _Candidate(much, key, place, touch, impact_count, slip) for much, key, place, touch, slip in every
    ]


def said_of(touch: np.void, impact_count: bool, slips: bool) -> list[str]:
    """Return the numbers of a touch in SI units, a line each."""
    lines = [f"impact at {quantity(float(touch['speed']), 'm/s')}"] if impact_count else []
    lines.append(f"normal {quantity(float(touch['normal']), 'N s')}")
    if touch["friction"] > 0.0:
        friction_impulse = abs(float(touch["tangent"]))
        friction_impulse = friction_impulse if friction_impulse > _ROUNDING * touch["normal"] else 0.0
        lines.append(f"friction {quantity(friction_impulse, 'N s')}")
        lines.append(f"{'slips' if slips else 'sticks'}, μ = {float(touch['friction']):.3g}")
    else:
        lines.append("μ = 0")
    return lines
