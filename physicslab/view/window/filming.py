"""A film that the window makes: of what was run, or of what comes from now on."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from physicslab.export.film import Film
from physicslab.history import History
from physicslab.view.canvas.canvas import Canvas, Rect
from physicslab.view.window.naming import Naming
from physicslab.world import World

if TYPE_CHECKING:
    import pygame


ALL, BACK = "All that was run", "From the start to here"
FORWARD, FROM_NOW = "From here to the end", "From now on, until F9"
"""The parts of a run that a film can show."""
_RATE = 30.0
"""Pictures a second."""
_WIDTHS = {".gif": 800, ".mp4": 1920}
"""Width of a film at most [px]: a GIF is sent by mail."""
_JUMP = 0.5
"""Time [s], as the film plays, by which what is shown must be elsewhere to be taken for a cut."""
_LATE = 1e-9
"""Time [s] by which a picture may come early: clocks are sums of rounded steps."""


class Filming:
    """Takes pictures of the world as it is shown, panels left out, and puts them in a file.

    A film of what was run is made by going through the time line, a picture a frame; it plays at the speed at
    which time runs in the window. If the file cannot be written, it stays as it was.

    Parameters
    ----------
    notify : callable
        Called with what came of a film, and whether it failed.

    Attributes
    ----------
    choosing : bool
        Whether the panel is shown in which a film is chosen.
    what : str
        Part of the run that the next film shows.
    naming : Naming
        The name of its file, and why it could not be begun.
    """

    def __init__(self, notify: Callable[[str, bool], None]) -> None:
        self._notify = notify
        self.choosing = False
        self.what, self.naming = ALL, Naming()
        self._film: Film | None = None
        self._size = 0, 0
        self._spacing = 1.0 / _RATE
        self._run = self._time = 0.0  # how much time was filmed, and the clock at the last look [s]
        self._end: int | None = None  # the step at which it ends; none is known of what comes
        self._start = self._step = self._back = 0

    @property
    def running(self) -> bool:
        """Whether a film is being made."""
        return self._film is not None

    @property
    def words(self) -> str:
        """How far it is, and what ends it."""
        if self._end is None:
            return f"FILM: {self._run * _RATE * self._spacing:.1f} s, F9 ends it"
        share = (self._step - self._start) / max(self._end - self._start, 1)
        return f"FILM: {100.0 * share:.0f} %, F9 cancels it"

    def begin(self, path: Path, what: str, history: History, room: Rect, speed: float) -> None:
        """Begin a film.

        Parameters
        ----------
        path : path
            Where it goes.
        what : str
            One of those above.
        history : History
            The run to film.
        room : Rect
            The part of the window that is filmed [px]; the film has its size, or a smaller one.
        speed : float
            How many times as fast as the world's the film's time runs.

        Raises
        ------
        ValueError, OSError
            If it cannot be made: one sentence.
        """
        first, last = history.steps_range
        here = history.step_count
        start, end = {ALL: (first, last), BACK: (first, here), FORWARD: (here, last)}.get(what, (here, None))
        if end is not None and end <= start:
            raise ValueError("There are no steps to film: run first, or film from now on")
        scale = min(_WIDTHS.get(path.suffix.lower(), room[2]) / room[2], 1.0)
        self._size = max(round(scale * room[2]), 2), max(round(scale * room[3]), 2)
        self._film = Film(path, self._size, _RATE)
        self._spacing = speed / _RATE
        self._start, self._end, self._back = start, end, here
        if end is not None:
            history.seek(start)
        self._step, self._run, self._time = start, 0.0, history.time

    def advance(self, history: History) -> None:
        """Go to the next place of which there is to be a picture, or end the film."""
        if self._film is None or self._end is None or self._film.count == 0:
            return
        if history.step_count != self._step:
            self.give_up("The film was cancelled: the time line was moved meanwhile")
            return
        if self._step == self._end:
            self.finish()
            history.seek(self._back)
            return
        wanted = self._film.count * self._spacing - self._run
        while self._step < self._end and abs(history.time - self._time) < wanted - _LATE:
            self._step += 1
            history.seek(self._step)

    def take(self, world: World, canvas: Canvas, room: Rect) -> None:
        """Add the picture on the canvas, as often as it is due: panels are not drawn on it yet."""
        film = self._film
        if film is None:
            return
        passed, self._time = abs(world.time - self._time), world.time
        cut = passed > _JUMP * _RATE * self._spacing and self._end is None
        self._run += self._spacing if cut else passed

        def grab(surface: pygame.Surface) -> None:
            from physicslab.view.overlay.moving import part_of  # it imports pygame

            picture = part_of(surface, room, self._size)
            while film.count * self._spacing <= self._run + _LATE:
                film.write(picture)

        if film.count * self._spacing > self._run + _LATE:
            return
        try:
            canvas.paint(grab)
        except OSError as error:
            self.give_up(f"The film could not be saved: {error.strerror or error}")

    def finish(self) -> None:
        """End the film, and keep it."""
        film, self._film = self._film, None
        if film is None:
            return
        try:
            film.finish()
        except OSError as error:
            self._notify(f"The film could not be saved: {error.strerror or error}", True)
        else:
            self._notify(f"Saved {film.path.name}: {film.count / _RATE:.1f} s", False)

    def give_up(self, words: str = "The film was cancelled") -> None:
        """End the film, and leave the file as it was."""
        film, self._film = self._film, None
        if film is not None:
            film.give_up()
            self._notify(words, True)

    def end(self, history: History | None = None) -> None:
        """Keep what was filmed from some time on; give up a film of the time line that is not whole.

        A history goes back to where it was before that film.
        """
        if self._end is None:
            self.finish()
            return
        was_on = self.running
        self.give_up()
        if was_on and history is not None:
            history.seek(self._back)
