"""Sparks that fly where bodies hit each other: a matter of the window, not of the world."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Numbers, Points
from physicslab.view.canvas.theme import Theme

_MAX_SPARKS = 400
"""The oldest sparks make room for new ones beyond that number."""
_MIN_PER_IMPACT, _MAX_PER_IMPACT = 3, 18
"""How many sparks an impact makes."""
_MAX_LIFE = 0.4
"""How long the longest-lived spark is seen [s]."""
_MIN_APPROACH = 25.0
"""Speed of approach [px/s] up to which an impact makes none: it can hardly be seen."""
_TYPICAL_IMPULSE = 3.0
"""Impulse [N s] of an impact whose sparks are about two thirds as many and as fast as can be."""
_WEAK_SPEED, _STRONG_SPEED = 110.0, 460.0
"""Speed of the fastest spark of an impact [px/s], for the weakest and the strongest impact."""
_FAN = 0.7
"""How far sparks stray from the plane of contact [rad]."""
_DRAG = 4.5
"""Rate at which sparks slow down [1/s]."""
_TAIL = 0.035
"""Time of flight that is seen as a streak [s]."""


class Sparks:
    """Sparks in flight. They depend on the impacts alone: the same run makes the same sparks.

    Attributes
    ----------
    place, velocity : float64 arrays (n, 2)
        Where they are [m] and how fast they fly [m/s], those of older impacts first.
    age, life, strength : float64 arrays (n,)
        Time they have flown and may fly [s]; how strong the impact was, 0 to 1.
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

    def advance(self, impacts: NDArray[Any], time: float, scale: float) -> None:
        """Let sparks fly on to a time of the world, and add those of new impacts.

        Parameters
        ----------
        impacts : array of IMPACT (n,)
            The impacts since the last call; each spark has flown since its impact.
        time : float
            The time of the world [s].
        scale : float
            Pixels per metre: sparks are as large as they look.
        """
        elapsed = np.full(len(self), max(time - self._time, 0.0))
        self._time = time
        impact, of_impact, strength = _sources(impacts, scale)
        direction, speed, life = _chances(impact, of_impact)
        normal = np.stack((impact["normal_x"], impact["normal_y"]), axis=1)
        pace = (_WEAK_SPEED + (_STRONG_SPEED - _WEAK_SPEED) * strength) * speed / scale
        place = np.stack((impact["x"], impact["y"]), axis=1)
        self.place = np.concatenate((self.place, place))
        self.velocity = np.concatenate((self.velocity, pace[:, None] * _turned(normal, direction)))
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
        """Draw each as a streak along its flight that fades as it grows old."""
        if not len(self):
            return
        flown = np.minimum(self.age, _TAIL)[:, None]
        start = camera.project(self.place - flown * self.velocity)
        end = camera.project(self.place)
        fresh = np.clip(1.0 - self.age / self.life, 0.0, 1.0)
        inside = ((end > 0.0) & (end < camera.size)).all(axis=1) & (fresh > 0.0)
        bold = self.strength > 0.5
        for part, width in ((inside & ~bold, 1.6), (inside & bold, 2.4)):
            if part.any():
                canvas.lines(start[part], end[part], theme.spark, width, fresh[part])


def _sources(impacts: NDArray[Any], scale: float) -> tuple[NDArray[Any], NDArray[np.int64], Numbers]:
    """Return for each new spark its impact, its number among those of that impact, and its strength.

    With more impacts than there is room for sparks, the strongest make some.
    """
    finite = np.isfinite(impacts["x"]) & np.isfinite(impacts["y"])
    impacts = impacts[finite & (impacts["approach_speed"] * scale > _MIN_APPROACH)]
    strength = 1.0 - np.exp(-impacts["normal_impulse"] / _TYPICAL_IMPULSE)
    chosen = np.sort(np.argsort(-strength, kind="stable")[: _MAX_SPARKS // _MIN_PER_IMPACT])
    number = _MIN_PER_IMPACT + (_MAX_PER_IMPACT - _MIN_PER_IMPACT) * strength[chosen]
    count = np.rint(number).astype(np.int64)
    source = np.repeat(chosen, count)
    first = np.repeat(np.cumsum(count) - count, count)
    return impacts[source], np.arange(len(source)) - first, strength[source]


def _turned(normal: Points, angle: Numbers) -> Points:
    """Return unit vectors (n, 2), turned counter-clockwise by angles [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    x, y = normal[:, 0], normal[:, 1]
    turned: Points = np.stack((c * x - s * y, s * x + c * y), axis=1)
    return turned


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
    angle = np.where(side < 0.5, 0.5, -0.5) * np.pi + _FAN * (2.0 * stray - 1.0)
    return angle, 0.3 + 0.7 * speed, 0.5 + 0.5 * life


def _scrambled(number: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return numbers that look random (splitmix64: Steele, Lea & Flood, 2014)."""
    number = number + np.uint64(0x9E3779B97F4A7C15)
    number = (number ^ (number >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    number = (number ^ (number >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return number ^ (number >> np.uint64(31))
