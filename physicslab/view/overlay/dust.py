"""Dust where bodies slide: a matter of the window, not of the world."""

import numpy as np

from physicslab.theme import Theme
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas
from physicslab.view.overlay.contact_samples import resting_of
from physicslab.world import World

_LEAST_SLIP = 0.4
"""Speed along a surface [m/s] from which there is dust."""
_MAX_CONTACTS, _MAX_PUFFS = 300, 120
"""Contacts above which there is none, as it could not be told apart, and how much there is at once."""
_LIFE, _APART = 0.45, 0.04
"""How long a puff is seen, and the time between two of a contact [s]."""
_SMALL, _LARGE, _DENSE = 2.0, 8.0, 0.22
"""Radius of a puff as it begins and ends [px], and its opacity as it begins."""


class Dust:
    """Puffs that stay where a surface was rubbed, grow and fade; there are none without friction."""

    def __init__(self) -> None:
        self.clear()

    def __len__(self) -> int:
        return len(self.puffs)

    def clear(self) -> None:
        """Let all of it settle."""
        self.puffs = np.zeros((0, 3))  # where [m] and when [s]
        self._due = -np.inf

    def advance(self, world: World) -> None:
        """Let puffs grow old, and add those of contacts that slide now."""
        time = world.time
        if time < self._due - _APART or time < self.puffs[:, 2].max(initial=-np.inf):
            self.clear()  # the clock was set back
        self.puffs = self.puffs[time - self.puffs[:, 2] < _LIFE]
        if time < self._due or not 0 < world.contacts.count <= _MAX_CONTACTS:
            return
        self._due = time + _APART
        found = resting_of(world)
        slides = np.isfinite(found["slip"]) & (found["slip"] > _LEAST_SLIP)
        place = found["place"][slides & (np.abs(found["tangent"]) > 0.0)]
        new = np.column_stack((place, np.full(len(place), time)))
        self.puffs = np.concatenate((self.puffs, new))[-_MAX_PUFFS:]

    def draw(self, time: float, camera: Camera, theme: Theme, canvas: Canvas) -> None:
        """Draw all puffs at a time of the world [s]."""
        if not len(self.puffs):
            return
        age = np.clip((time - self.puffs[:, 2]) / _LIFE, 0.0, 1.0)
        centre = camera.project(self.puffs[:, :2])
        inside = ((centre > 0.0) & (centre < camera.size)).all(axis=1)
        for low, high in ((0.0, 0.25), (0.25, 0.5), (0.5, 0.75), (0.75, 1.0)):
            part = inside & (age >= low) & (age < high)
            if part.any():
                width = 2.0 * (_SMALL + (_LARGE - _SMALL) * 0.5 * (low + high))
                lifted = centre[part] - (0.0, 0.3 * width)
                canvas.lines(lifted, lifted, theme.static, width, _DENSE * (1.0 - age[part]))
