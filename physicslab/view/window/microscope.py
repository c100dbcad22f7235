"""The microscope: which impact it shows, as which observer, and what waits for the next impact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.diagnostics.collision import Collision, Result, read_collision, resolve
from physicslab.ecs.vector import Vector2
from physicslab.view.window.pace import Pace
from physicslab.world import World

__all__ = ["FRAMES", "Microscope", "SlowRun"]

FRAMES = {
    "Lab": "As the window shows it",
    "Centre of mass": "Moving with the centre of mass of both: momenta before and after are opposite",
    "A": "Moving as the centre of A did before the impact",
    "B": "Moving as the centre of B did before the impact",
}
"""Observers, and how each moves."""
_SEEN = 1.0
"""How long after an impact its mark can be clicked [s]; it is the world's time."""
_LATE = 1e-6
"""Share of a step by which an impact may lie before the step in which it was found."""


@dataclass(slots=True)
class SlowRun:
    """A part of the motion that is shown slowly: until when [s], and the pace that comes back after it."""

    until: float
    chosen: float
    slow_motion: bool
    paused: bool


class Microscope:
    """The content of the microscope for one impact.

    Attributes
    ----------
    record : array of IMPACT (), optional
        The impact; ``None`` while the microscope is closed.
    collision, result : Collision, Result
        That impact, and what the law makes of it.
    number : int
        How many impacts were shown.
    frame : str
        The observer, one of ``FRAMES``.
    shows_formula : bool, optional
        Whether the formula is written out; ``None`` as the level has it.
    waits_for : tuple of int, optional
        The bodies at whose next impact time is to stand still, all where it is empty; ``None`` where it runs.
    slow : SlowRun, optional
        The part of the motion that is being shown slowly.
    """

    def __init__(self) -> None:
        self.record: Any | None = None
        self.number = 0
        self.collision: Collision
        self.result: Result
        self.frame = "Lab"
        self.shows_formula: bool | None = None
        self.waits_for: tuple[int, ...] | None = None
        self.slow: SlowRun | None = None
        self._recent: list[NDArray[Any]] = []

    @property
    def is_open(self) -> bool:
        """Whether an impact is shown."""
        return self.record is not None

    @property
    def state(self) -> tuple[object, ...]:
        """The state that panels show."""
        return self.number, self.is_open, self.waits_for, self.slow is None, self.frame

    def show(self, record: Any) -> None:
        """Show an impact; the record is copied."""
        self.record = record.copy()
        self.number += 1
        self.collision = read_collision(record)
        self.result = resolve(self.collision)

    def close(self) -> None:
        """Show none."""
        self.record = None

    def forget(self) -> None:
        """Forget all that belongs to a world that is shown no more."""
        self.close()
        self.waits_for = self.slow = None
        self._recent = []

    @property
    def observer(self) -> Vector2:
        """The velocity of the observer [m/s]."""
        collision = self.collision
        if self.frame == "Centre of mass":
            return collision.centre_velocity
        if self.frame in ("A", "B"):
            return (collision.a if self.frame == "A" else collision.b).before.linear
        return Vector2()

    @property
    def seen(self) -> Collision:
        """The impact as the observer sees it."""
        return self.collision.seen_by(self.observer)

    # ---- marks that can be clicked -------------------------------------------------------------------------

    def note(self, impacts: NDArray[Any], time: float) -> None:
        """Take in the impacts of a frame, an array of IMPACT; their marks can be clicked for a while."""
        if self._recent and time - self._recent[0]["time"][-1] > _SEEN:
            del self._recent[0]
        if len(impacts):
            self._recent.append(impacts)

    def near(self, place: Vector2, reach: float, time: float) -> Any | None:
        """Return the recent impact nearest to a place, if it is within ``reach`` [m]; the strongest there."""
        if not self._recent:
            return None
        every = np.concatenate(self._recent)
        age = time - every["time"]
        with np.errstate(invalid="ignore"):
            apart = np.hypot(every["x"] - place.x, every["y"] - place.y)
            near = every[(age >= 0.0) & (age < _SEEN) & (apart <= reach)]
        return near[np.argmax(near["normal_impulse"])] if len(near) else None

    # ---- time that stands still, or runs slowly ------------------------------------------------------------

    def sees_impact(self, world: World, logged: int, before: float) -> bool:
        """Whether the step since the time ``before`` [s] has an impact that is waited for; it is then shown.

        ``logged`` is how many impacts there had been.
        """
        contacts = world.contacts
        if self.waits_for is None or contacts.logged <= logged:
            return False
        log = contacts.log
        new = log[np.arange(max(logged, contacts.logged - len(log)), contacts.logged) % len(log)]
        fits = new["time"] >= before - _LATE * (world.time - before)
        if self.waits_for:
            fits &= np.isin(new["entity_a"], self.waits_for) | np.isin(new["entity_b"], self.waits_for)
        new = new[fits]
        if not len(new):
            return False
        self.waits_for = None
        self.show(new[np.argmax(new["normal_impulse"])])
        return True

    def run_slowly(self, pace: Pace, speed: float, until: float) -> None:
        """Let time run slowly until a time of the world [s]; after that as it does now."""
        if self.slow is None:
            self.slow = SlowRun(until, pace.chosen, pace.slow_motion, pace.paused)
        self.slow.until = until
        pace.chosen, pace.slow_motion, pace.paused = speed, False, False

    def follow(self, pace: Pace, time: float) -> None:
        """End what is shown slowly where its time has come, or where the user has paused."""
        if self.slow is None or (time < self.slow.until and not pace.paused):
            return
        slow, self.slow = self.slow, None
        pace.chosen, pace.slow_motion = slow.chosen, slow.slow_motion
        if slow.paused:
            pace.halt()
