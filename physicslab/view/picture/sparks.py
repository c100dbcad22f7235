"""Sparks and rings where bodies hit each other: a matter of the window, not of the world."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.diagnostics.impact_table import read_impacts
from physicslab.ecs.vector import rotated
from physicslab.theme import Theme
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Numbers
from physicslab.view.picture.pen import divided

_MAX_SPARKS = 400
"""The oldest sparks make room for new ones beyond that number."""
_MIN_PER_IMPACT, _MAX_PER_IMPACT = 3, 22
"""How many sparks an impact makes that takes some energy."""
_LEAST_LOSS = 1e-3
"""Energy lost [J] in an impact below which there are no sparks: one that is elastic has none."""
_MAX_LIFE = 0.4
"""How long the longest-lived spark is seen [s]."""
_MIN_APPROACH = 25.0
"""Speed of approach [px/s] up to which an impact makes none: it can hardly be seen."""
_TYPICAL_LOSS = 4.0
"""Energy lost [J] in an impact whose sparks are about two thirds as many and as fast as can be."""
_WEAK_SPEED, _STRONG_SPEED = 110.0, 460.0
"""Speed of the fastest spark of an impact [px/s], for the weakest and the strongest impact."""
_FAN = 0.8
"""How far sparks stray from the plane of contact, away from a body that is fixed [rad]."""
_DRAG = 4.5
"""Rate at which sparks slow down [1/s]."""
_TAIL = 0.035
"""Time of flight that is seen as a streak [s]."""
_GLOW = 7.0
"""Radius of the light of a spark [px]."""
_BRIGHT, _LIT = 0.7, 60
"""Light of a new spark, and how many have it whole: more of them share it, or they hide a pile."""
_MAX_RINGS, _RING_LIFE = 40, 0.16
"""How many rings are seen at once, and for how long each [s]."""
_RING_FROM, _RING_TO, _RING_LINES = 3.0, 15.0, 24
"""Radius of a ring as it begins and ends [px], and how many lines it is drawn as."""


class Sparks:
    """Sparks in flight. They depend on the impacts alone: the same run makes the same sparks.

    Attributes
    ----------
    place, velocity : float64 arrays (n, 2)
        Where they are [m] and how fast they fly [m/s], those of older impacts first.
    age, life, strength : float64 arrays (n,)
        Time they have flown and may fly [s]; how much energy the impact took, 0 to 1.
    rings : float64 array (k, 5)
        Where impacts were [m], when [s], from which angle on a ring is drawn and how far around [rad]: all of
        it between bodies that move, and half of it away from one that is fixed.
    """

    def __init__(self) -> None:
        self._time = 0.0
        self.clear()

    def __len__(self) -> int:
        return len(self.age)

    def clear(self) -> None:
        """Put them all out."""
        self.place, self.velocity = np.zeros((0, 2)), np.zeros((0, 2))
        self.age, self.life, self.strength = np.zeros(0), np.zeros(0), np.zeros(0)
        self.rings = np.zeros((0, 5))

    def advance(self, impacts: NDArray[Any], time: float, scale: float) -> None:
        """Let sparks fly on to a time of the world, and add those of new impacts.

        Parameters
        ----------
        impacts : array of IMPACT (n,)
            The impacts since the last call; each spark has flown since its impact.
        time : float
            The time of the world [s]. Where it was set back, what was in flight is gone.
        scale : float
            Pixels per metre: sparks are as large as they look.
        """
        if time < self._time:
            self.clear()
        if not (len(impacts) or len(self) or len(self.rings)):
            self._time = time
            return
        elapsed = np.full(len(self), time - self._time)
        self._time = time
        seen = _seen(impacts, scale)
        rings = seen["x"], seen["y"], seen["time"], *_arcs(seen)
        self.rings = np.concatenate((self.rings, np.stack(rings, axis=1)))
        young = (self.rings[:, 2] <= time) & (time - self.rings[:, 2] < _RING_LIFE)
        self.rings = self.rings[young][-_MAX_RINGS:]
        impact, of_impact, strength = _sources(seen)
        direction, speed, life = _chances(impact, of_impact)
        normal = np.stack((impact["normal_x"], impact["normal_y"]), axis=1)
        pace = (_WEAK_SPEED + (_STRONG_SPEED - _WEAK_SPEED) * strength) * speed / scale
        place = np.stack((impact["x"], impact["y"]), axis=1)
        self.place = np.concatenate((self.place, place))
        self.velocity = np.concatenate((self.velocity, pace[:, None] * rotated(normal, direction)))
        self.age = np.concatenate((self.age, np.zeros(len(impact))))
        self.life = np.concatenate((self.life, _MAX_LIFE * life))
        self.strength = np.concatenate((self.strength, strength))
        self._fly(np.concatenate((elapsed, np.maximum(time - impact["time"], 0.0))))

    def _fly(self, elapsed: Numbers) -> None:
        """Let each fly for a time [s], slowed down; what is older than it may be is gone."""
        slowed = np.exp(-_DRAG * elapsed)
        self.place += ((1.0 - slowed) / _DRAG)[:, None] * self.velocity
        self.velocity *= slowed[:, None]
        self.age += elapsed
        kept = np.flatnonzero(self.age < self.life)[-_MAX_SPARKS:]
        self.place, self.velocity = self.place[kept], self.velocity[kept]
        self.age, self.life, self.strength = self.age[kept], self.life[kept], self.strength[kept]

    def draw(self, camera: Camera, theme: Theme, canvas: Canvas) -> None:
        """Draw each as a streak along its flight that fades as it grows old; and the rings."""
        self._draw_rings(camera, theme, canvas)
        if not len(self):
            return
        flown = np.minimum(self.age, _TAIL)[:, None]
        start = camera.project(self.place - flown * self.velocity)
        end = camera.project(self.place)
        fresh = np.clip(1.0 - self.age / self.life, 0.0, 1.0)
        inside = ((end > 0.0) & (end < camera.size)).all(axis=1) & (fresh > 0.0)
        bold = self.strength > 0.5
        if theme.is_dark and inside.any():
            count = int(inside.sum())
            light = _BRIGHT * min(1.0, _LIT / count) * fresh[inside]
            canvas.glows(end[inside], np.full(count, _GLOW), theme.spark, light)
        for part, width in ((inside & ~bold, 1.6), (inside & bold, 2.4)):
            if part.any():
                canvas.lines(start[part], end[part], theme.spark, width, fresh[part])

    def _draw_rings(self, camera: Camera, theme: Theme, canvas: Canvas) -> None:
        """Draw a ring around each point of impact that grows and fades."""
        age = (self._time - self.rings[:, 2]) / _RING_LIFE
        centre = camera.project(self.rings[:, :2])
        inside = ((centre > -_RING_TO) & (centre < np.array(camera.size) + _RING_TO)).all(axis=1)
        centre, age, (begin, around) = centre[inside], age[inside], self.rings[inside, 3:].T
        if not len(centre):
            return
        turns = begin[:, None] + around[:, None] * np.linspace(0.0, 1.0, _RING_LINES + 1)
        radius = _RING_FROM + (_RING_TO - _RING_FROM) * np.sqrt(age)
        way = np.stack((np.cos(turns), -np.sin(turns)), axis=2)
        corners = centre[:, None, :] + radius[:, None, None] * way
        opacity = np.repeat(0.6 * (1.0 - age), _RING_LINES)
        start, end = corners[:, :-1].reshape(-1, 2), corners[:, 1:].reshape(-1, 2)
        canvas.lines(start, end, theme.spark, 1.4, opacity)


def _seen(impacts: NDArray[Any], scale: float) -> NDArray[Any]:
    """Return those of the impacts that are fast enough to be seen, at a scale [px/m]."""
    finite = np.isfinite(impacts["x"]) & np.isfinite(impacts["y"])
    return impacts[finite & (impacts["approach_speed"] * scale > _MIN_APPROACH)]


def _arcs(impacts: NDArray[Any]) -> tuple[Numbers, Numbers]:
    """Return from which angle on the ring of each impact is drawn, and how far around [rad]."""
    fixed_a, fixed_b = impacts["inverse_mass_a"] == 0.0, impacts["inverse_mass_b"] == 0.0
    free = np.arctan2(impacts["normal_y"], impacts["normal_x"]) + np.where(fixed_b, np.pi, 0.0)
    half = np.where(fixed_a == fixed_b, np.pi, 0.5 * np.pi)
    return free - half, 2.0 * half


def _sources(impacts: NDArray[Any]) -> tuple[NDArray[Any], NDArray[np.int64], Numbers]:
    """Return for each new spark its impact, its number among those of that impact, and its strength.

    With more impacts than there is room for sparks, the strongest make some.
    """
    strongest = np.argsort(-impacts["normal_impulse"] * impacts["approach_speed"], kind="stable")
    impacts = impacts[np.sort(strongest[: _MAX_SPARKS // _MIN_PER_IMPACT])]
    lost = read_impacts(impacts).energy_lost
    impacts, lost = impacts[lost > _LEAST_LOSS], lost[lost > _LEAST_LOSS]
    strength = 1.0 - np.exp(-lost / _TYPICAL_LOSS)
    count = np.rint(_MIN_PER_IMPACT + (_MAX_PER_IMPACT - _MIN_PER_IMPACT) * strength).astype(np.int64)
    source, nth = divided(count)
    return impacts[source], nth, strength[source]


def _chances(impacts: NDArray[Any], of_impact: NDArray[np.int64]) -> tuple[Numbers, Numbers, Numbers]:
    """Return for each spark the angle to the normal [rad], and its speed and life as shares of the largest.

    They look random and depend only on the pair, the place and the time of the impact: not on the frames.
    """
    seed = _scrambled(of_impact.astype(np.uint64))
    for part in ("entity_a", "entity_b", "time", "x", "y"):
        seed = _scrambled(seed ^ np.ascontiguousarray(impacts[part]).view(np.uint64))
    made: list[Numbers] = []
    for _ in range(4):
        seed = _scrambled(seed)
        made.append((seed >> np.uint64(11)).astype(np.float64) * 2.0**-53)
    side, stray, speed, life = made
    # Away from the plane of contact on the side that is free; between two that move, close to the plane.
    fixed_a, fixed_b = impacts["inverse_mass_a"] == 0.0, impacts["inverse_mass_b"] == 0.0
    away = np.where(fixed_a == fixed_b, 0.5 * (2.0 * stray - 1.0), np.where(fixed_a, stray, -stray))
    angle = np.where(side < 0.5, 1.0, -1.0) * (0.5 * np.pi - _FAN * away)
    return angle, 0.3 + 0.7 * speed, 0.5 + 0.5 * life


def _scrambled(number: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return numbers that look random (splitmix64: Steele, Lea & Flood, 2014)."""
    number = number + np.uint64(0x9E3779B97F4A7C15)
    number = (number ^ (number >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    number = (number ^ (number >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return number ^ (number >> np.uint64(31))
