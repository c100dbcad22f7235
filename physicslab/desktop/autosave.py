"""Saving the state of a window every few seconds, without holding up a frame."""

import gc
import threading
import time
from collections.abc import Callable
from pathlib import Path

from physicslab.files.checks import SceneError
from physicslab.files.replace import replace_file
from physicslab.files.writer import SceneText, WorldSnapshot
from physicslab.world import World

_PATIENCE = 5.0
"""How long [s] a saving that is under way is waited for where the world is to be saved at once."""


class Autosave:
    """Saves a world when something changed, at most every ``period`` seconds.

    The columns are copied in one frame; turning them into text is spread over the frames that follow, a
    little in each; the disk is waited for in a thread. With 4,000 discs in contact that adds 5 ms to one
    frame and 2 ms to some 200. Python collects no garbage meanwhile: the many small objects of a document
    would set off a search through all there are, which holds up a frame for 100 ms.

    Parameters
    ----------
    path : path
        The file, always the same; it is replaced whole.
    period : float
        Time from the end of one saving to the next [s].
    share : float
        How long writing may take in one frame [s].
    clock : callable
        Returns the time [s].

    Attributes
    ----------
    failure : str
        Why the last attempt failed; empty if it did not.
    """

    def __init__(
        self,
        path: Path,
        period: float = 10.0,
        share: float = 0.002,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self.path = path
        self.failure = ""
        self._period, self._share, self._clock = period, share, clock
        self._due = clock() + period
        self._saved: tuple[object, ...] = ()
        self._writing: SceneText | None = None
        self._collected = False  # whether garbage was collected before
        self._thread: threading.Thread | None = None
        self._outcome: list[OSError] = []

    def finish(self, world: World) -> None:
        """Take the world as it is now for one that need not be saved: nothing was done to it yet."""
        self._saved = _state(world)

    def advance(self, world: World) -> None:
        """Do what is due in this frame."""
        if self._thread is not None:
            if self._thread.is_alive():
                return
            self._thread = None
            self._finish(str(self._outcome[0]) if self._outcome else "")
        elif self._writing is not None:
            self._write()
        elif self._clock() >= self._due:
            state = _state(world)
            if state == self._saved:
                self._due = self._clock() + self._period
            else:
                self._saved = state
                self._collected = gc.isenabled()
                gc.disable()
                self._writing = SceneText(WorldSnapshot(world), self._clock)

    def _write(self) -> None:
        """Write as much as there is time for in a frame; at the end, hand it to the disk."""
        assert self._writing is not None
        try:
            content = self._writing.go_on(self._share)
        except (SceneError, ValueError) as error:  # ValueError: a number that is not finite
            self._finish(str(error))
            return
        if content is None:
            return
        self._let_go()
        outcome = self._outcome = []

        def store() -> None:
            try:
                replace_file(self.path, content)
            except OSError as error:
                outcome.append(error)

        self._thread = threading.Thread(target=store, name="autosave", daemon=True)
        self._thread.start()

    def _let_go(self) -> None:
        """Drop the document, and let garbage be collected again."""
        if self._writing is not None:
            self._writing = None
            if self._collected:
                gc.enable()

    def _finish(self, failure: str) -> None:
        self._let_go()
        self._due = self._clock() + self._period
        self.failure = failure
        if failure:
            self._saved = ()

    def save(self, world: World) -> None:
        """Save the world at once if it is not what was saved last, and save no more after that.

        Where that fails, ``failure`` is the reason, and the state saved before stays.
        """
        under_way = self._writing is not None
        self.stop(_PATIENCE)
        if not under_way and _state(world) == self._saved and not self._outcome:
            return
        try:
            replace_file(self.path, SceneText(WorldSnapshot(world)).go_on() or b"")
        except (OSError, SceneError, ValueError) as error:
            self.failure = str(error)

    def stop(self, patience: float = 2.0) -> None:
        """Save no more, and wait for the disk so many seconds."""
        self._let_go()
        self._due = float("inf")
        if self._thread is not None:
            self._thread.join(patience)


def _state(world: World) -> tuple[object, ...]:
    """Return what differs whenever something was done to a world or time went on in it."""
    return id(world), world.time, world.steps, world.revision
