"""Sparks that fly where bodies strike each other; the world knows nothing of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Numbers, Points
from physicslab.view.canvas.theme import Theme
from physicslab.world import World

__all__ = ["Sparks"]

_MOST = 400
"""How many sparks there are at the most; the oldest make room."""
_FEWEST_EACH, _MOST_EACH = 3, 18
"""How many an impact makes."""
_LIFE = 0.4
"""How long a spark lasts at the most [s]."""
_WEAK = 25.0
"""Speed of approach [px/s] below which an impact makes none: it can hardly be seen."""
_IMPULSE = 3.0
"""Impulse [N s] of an impact whose sparks are about two thirds as many and as fast as can be."""
_SLOWEST, _FASTEST = 110.0, 460.0
"""Speed of the fastest spark of an impact [px/s], for the weakest and the strongest."""
_FAN = 0.7
"""How far sparks stray from the plane of contact [rad]."""
_DRAG = 4.5
"""Rate at which sparks slow down [1/s]."""
_TAIL = 0.035
"""Time of flight that is seen as a streak [s]."""


class Sparks:
    """Sparks in flight. What they do follows from the contacts alone: the same run makes the same sparks.

    Attributes
    ----------
    place, velocity : float64 arrays (n, 2)
        Where they are [m] and how fast they fly [m/s], oldest first.
    age, life, strength : float64 arrays (n,)
        Time they have flown and may fly [s]; how strong the impact was, 0 to 1.
    """

    def __init__(self) -> None:
        self.clear()

    def __len__(self) -> int:
        return len(self.age)

    def clear(self) -> None:
        """Put them all out."""
        self.place, self.velocity = np.zeros((0, 2)), np.zeros((0, 2))
        self.age, self.life, self.strength = np.zeros(0), np.zeros(0), np.zeros(0)

    def advance(self, world: World, h: float, scale: float) -> None:
        """Let a step of the world go by, and strike sparks where it had impacts.

        Parameters
        ----------
        h : float
            The time simulated [s].
        scale : float
            Pixels per metre: sparks are as large as they look.
        """
        if len(self):
            self.place += h * self.velocity
            self.velocity *= np.exp(-_DRAG * h)
            self.age += h
            self._keep(self.age < self.life)
        self._resolve_impacts(world, scale)

    def _keep(self, kept: NDArray[np.bool_] | slice) -> None:
        self.place, self.velocity = self.place[kept], self.velocity[kept]
        self.age, self.life, self.strength = self.age[kept], self.life[kept], self.strength[kept]

    def _resolve_impacts(self, world: World, scale: float) -> None:
        contacts = world.contacts
        near = contacts.manifolds[: contacts.recorded]
        impact_count = np.flatnonzero(near["impact_count"] > 0)
        if not len(impact_count):
            return
        point = (2 * impact_count[:, None] + (0, 1)).ravel()
        points = contacts.points[point]
        point = point[(points["impact_normal"] > 0.0) & (points["approach_speed"] * scale > _WEAK)]
        points, pairs = contacts.points[point], near[point // 2]
        place = world.table(Transform)["position"][pairs["b"]]
        place = place + np.stack((points["arm_bx"], points["arm_by"]), axis=1)
        strength = 1.0 - np.exp(-points["impact_normal"] / _IMPULSE)
        # No more impacts than there is room for, the strongest first; then back in order.
        chosen = np.sort(np.argsort(-strength, kind="stable")[: _MOST // _FEWEST_EACH])
        chosen = chosen[np.isfinite(place[chosen]).all(axis=1)]
        count = np.rint(_FEWEST_EACH + (_MOST_EACH - _FEWEST_EACH) * strength[chosen]).astype(np.int64)
        source = np.repeat(chosen, count)
        seed = _seeds(pairs["entity_a"], pairs["entity_b"], point % 2, world.steps)[source]
        normal = np.stack((pairs["normal_x"], pairs["normal_y"]), axis=1)[source]
        self._add(place[source], normal, strength[source], seed, scale)

    def _add(
        self, place: Points, normal: Points, strength: Numbers, seed: NDArray[np.uint64], scale: float
    ) -> None:
        side, stray, pace, life = _chances(seed, 4)
        angle = np.arctan2(normal[:, 1], normal[:, 0]) + np.where(side < 0.5, 0.5, -0.5) * np.pi
        angle += _FAN * (2.0 * stray - 1.0)
        speed = (_SLOWEST + (_FASTEST - _SLOWEST) * strength) * (0.3 + 0.7 * pace) / scale
        velocity = speed[:, None] * np.stack((np.cos(angle), np.sin(angle)), axis=1)
        self.place, self.velocity = np.append(self.place, place, 0), np.append(self.velocity, velocity, 0)
        self.age, self.life = (
            np.append(self.age, 0.0 * life),
            np.append(self.life, _LIFE * (0.5 + 0.5 * life)),
        )
        self.strength = np.append(self.strength, strength)
        self._keep(slice(-_MOST, None))

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


def _seeds(
    a: NDArray[np.int64], b: NDArray[np.int64], point: NDArray[np.int64], steps: int
) -> NDArray[np.uint64]:
    """Return a number for each impact that nothing but what struck what, where and when decides."""
    seed = _scrambled(a.astype(np.uint64))
    for part in (b, point, np.full(len(a), steps)):
        seed = _scrambled(seed ^ part.astype(np.uint64))
    return seed


def _scrambled(number: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return numbers that look random (splitmix64: Steele, Lea & Flood, 2014)."""
    number = number + np.uint64(0x9E3779B97F4A7C15)
    number = (number ^ (number >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    number = (number ^ (number >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return number ^ (number >> np.uint64(31))


def _chances(seed: NDArray[np.uint64], count: int) -> tuple[Numbers, ...]:
    """Return ``count`` arrays of numbers from 0 to 1; the place in the array decides as well as the seed."""
    seed = _scrambled(seed ^ np.arange(len(seed), dtype=np.uint64))
    made: list[Numbers] = []
    for _ in range(count):
        seed = _scrambled(seed)
        made.append((seed >> np.uint64(11)).astype(np.float64) * 2.0**-53)
    return tuple(made)
