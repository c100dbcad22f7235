"""The educational overlay: the impulses of every contact, as the solver found them."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from physicslab.languages.sentence import Sentence
from physicslab.view.canvas.camera import Drawing
from physicslab.view.canvas.canvas import Numbers, Points, Rect
from physicslab.view.canvas.quantities import quantity
from physicslab.view.overlay import arrows, contact_samples
from physicslab.view.overlay.contact_samples import ContactSamples
from physicslab.view.overlay.labels import Key, Label
from physicslab.view.overlay.legend import Gauge, Overlays
from physicslab.world import World

LABELLED = 12
"""How many contacts have their numbers written beside them: the strongest."""
CROWD, LABELLED_IN_CROWD = 30, 4
"""The largest number of impacts drawn at a time: more would hide the bodies."""
_KEEP_RATIO = 1.5
"""A contact must be that many times as strong as one whose numbers are shown to take its place."""

_ZERO_FRICTION_SHARE = 1e-9
"""Friction of so small a share of the normal impulse is rounding, and written as 0."""


def draw_impulses(world: World, overlays: Overlays, written: Collection[int], on: Drawing) -> list[Label]:
    """Draw impulses of impacts of the last second and of what rests, with cones; return their numbers.

    Resting contacts have numbers only for the bodies in ``written``, the points of a pair added up: a heap
    would be hidden under them.
    """
    impacts = overlays.impacts.recent(world.time)
    impacts = impacts[np.argsort(impacts["time"], kind="stable")]  # the newest on top
    resting = _without(contact_samples.resting_of(world), impacts, overlays.impacts.same_place)
    resting = resting[resting["normal"] > 0.0]
    fresh = contact_samples.RecentImpacts.freshness(impacts, world.time)
    overlays.impact.follow(impacts["normal"], overlays.reach, world.time)
    overlays.rest.follow(resting["normal"], overlays.reach, world.time)
    _draw_impulses_of(resting, overlays.rest, arrows.REST_WIDTH, 0.9, on)
    _draw_impulses_of(impacts, overlays.impact, arrows.IMPACT_WIDTH, fresh, on)
    ends = np.array(sorted(written), np.int64)
    of_written = _by_pair(resting[np.isin(resting["a"], ends) | np.isin(resting["b"], ends)])

    def rank(one: _Candidate) -> float:
        return -one.weight * (_KEEP_RATIO if overlays.labels.known(one.key) else 1.0)

    met = _strongest(impacts, fresh, overlays, True, on)
    met = sorted(met, key=rank)[: LABELLED if len(impacts) <= CROWD else LABELLED_IN_CROWD]
    held = _strongest(of_written, np.ones(len(of_written)), overlays, False, on)
    chosen = sorted([*met, *held], key=rank)[:LABELLED]
    return [Label(one.key, one.at, _words_of(one)) for one in chosen]


def _seen(at: Points, size: tuple[int, int], covered: Sequence[Rect]) -> NDArray[np.bool_]:
    """Return which places lie in the picture and under no panel."""
    with np.errstate(invalid="ignore"):
        seen: NDArray[np.bool_] = ((at >= 0.0) & (at < np.array(size))).all(axis=1)
        for left, top, width, height in covered:
            low, high = (left, top), (left + width, top + height)
            seen &= ~((at >= low) & (at < high)).all(axis=1)
    return seen


def _without(resting: ContactSamples, impacts: ContactSamples, distance: float) -> ContactSamples:
    """Return the resting contacts but those nearer than ``distance`` [m] to an impact of the same pair."""
    if not len(impacts):
        return resting
    candidates = np.flatnonzero(np.isin(resting[["a", "b"]], impacts[["a", "b"]]))
    hidden = contact_samples.same_place(resting[candidates], impacts, distance).any(axis=1)
    return np.delete(resting, candidates[hidden])


def _by_pair(resting: ContactSamples) -> ContactSamples:
    """Return one sample for each pair: the sums of the impulses at its points, where they act together."""
    _, first, pair = np.unique(resting[["a", "b"]], return_index=True, return_inverse=True)
    added = resting[first]
    for name in ("normal", "tangent"):
        added[name] = np.bincount(pair, resting[name], len(first))
    for axis in range(2):
        moments = np.bincount(pair, resting["normal"] * resting["place"][:, axis], len(first))
        added["place"][:, axis] = moments / added["normal"]
    added["point"] = 0
    return added


def _draw_impulses_of(
    samples: ContactSamples, gauge: Gauge, width: float, opacity: float | Numbers, on: Drawing
) -> None:
    """Draw cones, then friction, then normal impulses, all from the points of contact."""
    if not len(samples) or not gauge.per_metre:
        return
    start = on.camera.project(samples["place"])
    normal = samples["direction"] * (1.0, -1.0)  # the screen's y points down
    tangent = np.stack((normal[:, 1], -normal[:, 0]), axis=1)  # counter-clockwise, as seen
    scale = on.camera.scale / gauge.per_metre
    _draw_cones((start, normal, tangent), samples, scale, opacity, on)
    friction_impulse = tangent * (samples["tangent"] * scale)[:, None]
    arrows.draw_arrows(start, friction_impulse, replace(arrows.FRICTION_IMPULSE, width=width), on, opacity)
    push = normal * (samples["normal"] * scale)[:, None]
    arrows.draw_arrows(start, push, replace(arrows.NORMAL_IMPULSE, width=width), on, opacity)


def _draw_cones(
    axes: tuple[Points, Points, Points], samples: ContactSamples, scale: float, opacity: float | Numbers,
    on: Drawing,
) -> None:  # fmt: skip
    """Draw both sides of friction cones, as high as the normal impulse; broken where the contact slips."""
    start, normal, tangent = axes
    height = np.minimum(samples["normal"] * scale, arrows.max_length(on.canvas))
    shown = (samples["friction"] > 0.0) & (height >= 8.0)
    slips = contact_samples.sliding(samples)
    share = np.full(len(samples), 0.75) * opacity
    for chosen, broken in ((shown & ~slips, False), (shown & slips, True)):
        if not chosen.any():
            continue
        reach = height[chosen, None]
        aside = samples["friction"][chosen, None] * tangent[chosen]
        froms = np.concatenate((start[chosen], start[chosen]))
        sides = normal[chosen] + aside, normal[chosen] - aside
        tos = froms + np.concatenate([side * reach for side in sides])
        shares = np.tile(share[chosen], 2)
        if broken:
            froms, tos, line = arrows.dashes(froms, tos)
            shares = shares[line]
        on.canvas.lines(froms, tos, on.theme.friction_cone, 1.2, shares)


@dataclass(frozen=True, slots=True)
class _Candidate:
    """A contact whose numbers may be written: how much it stands out, where it is [px], what it is."""

    weight: float
    key: Key
    at: tuple[float, float]
    sample: np.void
    is_impact: bool
    slips: bool


def _strongest(
    samples: ContactSamples, fresh: Numbers, overlays: Overlays, is_impact: bool, on: Drawing
) -> list[_Candidate]:
    """Return the samples that stand out most of those that can be seen."""
    if not len(samples):
        return []
    at, gauge = on.camera.project(samples["place"]), overlays.impact if is_impact else overlays.rest
    strength = samples["normal"] * fresh / (gauge.per_metre or 1.0)
    weight = np.where(_seen(at, on.camera.size, overlays.covered), strength, 0.0)
    chosen = np.argsort(-weight, kind="stable")[: 2 * LABELLED]
    chosen = chosen[weight[chosen] > 0.0]
    samples, slips = samples[chosen], contact_samples.sliding(samples[chosen]).tolist()
    keys = zip(samples["a"].tolist(), samples["b"].tolist(), samples["point"].tolist(), strict=True)
    places = ((x, y) for x, y in at[chosen].tolist())
    every = zip(weight[chosen].tolist(), keys, places, samples, slips, strict=True)
    return [_Candidate(much, key, place, touch, is_impact, slip) for much, key, place, touch, slip in every]


def _words_of(one: _Candidate) -> list[str]:
    """Return the numbers of a contact in SI units, a line each; of what rests also the mean forces."""
    sample, rate = one.sample, 1.0 / float(one.sample["span"]) if one.sample["span"] > 0.0 else 0.0
    lines = [f"impact at {quantity(float(sample['speed']), 'm/s')}"] if one.is_impact else []
    lines.append(f"normal {_impulse(float(sample['normal']), rate)}")
    if sample["friction"] > 0.0:
        friction_impulse = abs(float(sample["tangent"]))
        friction_impulse = (
            friction_impulse if friction_impulse > _ZERO_FRICTION_SHARE * sample["normal"] else 0.0
        )
        lines.append(f"friction {_impulse(friction_impulse, rate)}")
        how, mu = Sentence("slips" if one.slips else "sticks"), f"{float(sample['friction']):.3g}"
        lines.append(Sentence("{how}, μ = {mu}", how=how, mu=mu))
    else:
        lines.append("μ = 0")
    return lines


def _impulse(value: float, rate: float) -> str:
    """Return an impulse; with a ``rate`` [1/s] the force that it comes to before it."""
    words = quantity(value, "N s")
    return f"{quantity(rate * value, 'N')} ({words})" if rate else words
