"""How many digits of what the window shows can be relied on, found by another process."""

import time
from dataclasses import dataclass
from typing import Any

from physicslab.components import Held, Transform, Velocity
from physicslab.files.checks import SceneError
from physicslab.files.writer import SceneText, WorldSnapshot
from physicslab.view.window.lab_process import LabProcess, own_command
from physicslab.world import World

_COMMAND = own_command("accuracy")
BODIES_LIMIT = 500
"""Bodies that can move, with more of which digits are not checked."""
RUNS = 20
"""About how often the scene is computed for it."""
_AHEAD_S, _AHEAD = 10.0, 1.5
"""Digits are found for so much more time than has passed since the last edit [s], or so many times that."""
_LEFT = 0.8
"""The share of the time they were found for after which they are found for more."""
_SETTLED_S = 0.5
"""How long nothing must have been edited [s] before it is begun."""
_LOOK_S = 0.1
"""How often it is looked at how far it is [s]."""
_PATIENCE_S = 120.0
"""After how long it is given up [s]."""
_SAME_S = 1e-9
"""Times that differ by less are the same [s]."""
_WRITING_S = 0.001
"""How long writing the scene may take in a frame [s]."""


@dataclass(frozen=True, slots=True)
class Finding:
    """The reliable digits from the last edit to a moment.

    Attributes
    ----------
    until : float
        That moment: time of the world [s].
    digits, energy, momentum, angular_momentum : float
        The fewest digits of any position, of the energy and of the momenta.
    bodies, velocities, angles, spins : tuples of floats
        Those of each body's position, velocity, angle and angular velocity.
    """

    until: float
    digits: float
    energy: float
    momentum: float
    angular_momentum: float
    bodies: tuple[float, ...]
    velocities: tuple[float, ...]
    angles: tuple[float, ...]
    spins: tuple[float, ...]


class TrustWatch(LabProcess):
    """Has digits checked from the last edit on, again as time goes on, and from the beginning after an edit.

    An edit, a hand and a place of the past that is gone to drop all that was found. Worlds of many bodies
    are left out.

    Parameters
    ----------
    command : sequence of str
        The command, before the path of the scene.

    Attributes
    ----------
    wanted : bool
        Whether digits are to be checked.
    since : float
        Time of the world at the last edit, or soon after it, from which digits count [s].
    horizon : float, optional
        Time of the world after which it is one of many possible futures [s]; ``None`` where none is known.
    left_out : str
        Why it is not checked, where it is not.
    """

    niceness = 5

    def __init__(self, command: tuple[str, ...] = _COMMAND) -> None:
        super().__init__(command)
        self.wanted = False
        self.since = 0.0
        self.horizon: float | None = None
        self.left_out = ""
        self._findings: tuple[Finding, ...] = ()
        self._bodies: tuple[int, ...] = ()
        self._seen: tuple[World, int] | None = None
        self._is_still = True  # whether nothing was edited since the frame before
        self._settled = self._began = self._next_look = 0.0
        self._snapshot: WorldSnapshot | None = None
        self._writing: SceneText | None = None
        self._scene: bytes | None = None

    # ---- what is known -------------------------------------------------------------------------------------

    @property
    def state(self) -> tuple[object, ...]:
        """A key that differs if the display must change."""
        return (
            self.wanted, self.running, self.share, self.since, self.left_out, self.failure,
            id(self._findings), self.horizon,
        )  # fmt: skip

    def finding(self, moment: float) -> Finding | None:
        """Return what can be relied on until a time of the world [s], or as far as it was checked."""
        later = (finding for finding in self._findings if finding.until >= moment - _SAME_S)
        return next(later, self._findings[-1] if self._findings else None)

    def is_beyond(self, moment: float) -> bool:
        """Whether a time of the world [s] is after the horizon."""
        return self.horizon is not None and moment > self.horizon

    def digits_of(self, entity: int, moment: float) -> tuple[float, float, float, float] | None:
        """Return the digits of a body's position, velocity, angle and spin at a time of the world [s].

        ``None`` where they are not known.
        """
        found = self.finding(moment)
        if found is None or entity not in self._bodies:
            return None
        n = self._bodies.index(entity)
        return found.bodies[n], found.velocities[n], found.angles[n], found.spins[n]

    def worst(self, moment: float) -> int | None:
        """Return the body with the fewest digits."""
        found = self.finding(moment)
        return None if found is None else self._bodies[found.bodies.index(found.digits)]

    # ---- what is done --------------------------------------------------------------------------------------

    def follow(self, world: World, now: float) -> None:
        """Do what is due in a frame; ``now`` is how long the window has been open [s]."""
        seen = world, world.motion_edits
        was_still, self._is_still = self._is_still, seen == self._seen and not len(world.batch(Held))
        if not self._is_still:
            self._forget(seen, now)
        if self._snapshot is None and (self._is_still or was_still):  # not while edits follow each other
            self._keep(world)
        if not self._is_still or not self.wanted or self.left_out or self.failure:
            return
        if self.running:
            if now >= self._next_look:
                self._look(now)
        elif now - self._settled >= _SETTLED_S and self._is_due(world.time):
            self._start(world, now)

    def toggle(self) -> None:
        """Have digits checked, or no longer."""
        self.wanted = not self.wanted
        self.abandon()
        self._drop()

    def _forget(self, seen: tuple[World, int], now: float) -> None:
        """Drop what was found, and what is under way: the world was edited."""
        self.abandon()
        self._seen, self._settled = seen, now
        self._snapshot = self._writing = self._scene = None
        self._bodies, self.left_out = (), ""
        self._drop()

    def _drop(self) -> None:
        self._findings, self.horizon, self.failure = (), None, ""

    def _keep(self, world: World) -> None:
        """Hold the world still as it is now: digits count from here."""
        self._snapshot, self.since = WorldSnapshot(world), world.time
        moving = set(world.batch(Transform, Velocity).entities.tolist())
        self._bodies = tuple(entity for entity in self._snapshot.entities if entity in moving)
        if len(self._bodies) > BODIES_LIMIT:
            self.left_out = (
                f"{len(self._bodies):,} bodies can move, too many for a window: the scene would be "
                f"computed about {RUNS} times over. The command run does that, with --trust"
            )
        elif not self._bodies:
            self.left_out = "Nothing moves"

    def _is_due(self, moment: float) -> bool:
        """Whether digits must be found for a later time than they were."""
        return not self._findings or moment - self.since > _LEFT * (self._findings[-1].until - self.since)

    def _start(self, world: World, now: float) -> None:
        """Write the scene of the last edit, a little in each frame, and begin when it is written."""
        content = self._text()
        if content is None:
            return
        elapsed = world.time - self.since
        seconds = max(elapsed + _AHEAD_S, _AHEAD * elapsed)
        self._began = now
        try:
            self.begin(lambda path: path.write_bytes(content), "--trust", "--seconds", repr(seconds))
        except OSError as error:
            self.stop()
            self.failure = error.strerror or str(error)

    def _text(self) -> bytes | None:
        """Go on to write the scene; return its text once it is whole. An obstacle is a failure."""
        if self._scene is None:
            assert self._snapshot is not None
            self._writing = self._writing or SceneText(self._snapshot, time.perf_counter)
            try:
                self._scene = self._writing.go_on(_WRITING_S)
            except (SceneError, ValueError) as error:  # ValueError: a number that is not finite
                self._writing, self.failure = None, str(error)
        return self._scene

    def _look(self, now: float) -> None:
        """Look whether it has ended; read what it found, or give it up."""
        self._next_look, report = now + _LOOK_S, self.ended()
        if report:
            (found,) = report["scenes"]
            self._read(found)
        elif report is None and now - self._began > _PATIENCE_S:
            self.abandon()
            self.failure = f"given up after {_PATIENCE_S:g} s"

    def _read(self, found: dict[str, Any]) -> None:
        if found["failure"]:
            self.failure = found["failure"]
            return
        self._findings = tuple(
            Finding(
                self.since + look["seconds"], look["digits"], look["energy"], look["momentum"],
                look["angular_momentum"],
                *(tuple(look[name]) for name in ("bodies", "velocities", "angles", "spins")),
            )
            for look in found["looks"]
        )  # fmt: skip
        if found["horizon_s"] is not None:
            self.horizon = self.since + found["horizon_s"]
