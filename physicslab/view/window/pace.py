"""From frames of any length to steps of one length."""

import math


class Pace:
    """Counts the steps that are due in a frame, so that the motion does not depend on the frame rate.

    Elapsed wall time is made up for in whole steps of ``dt``. Below full speed each
    step is shorter and there are not fewer, so that it looks as smooth, unless steps are measured and stay
    as they are; above, there are more steps and none is longer, so that it is as accurate.

    Parameters
    ----------
    max_dt : float
        The longest time [s] that one frame makes up for. Time beyond that is dropped: after a hitch the world
        goes on where it was, and a world too heavy for the machine runs slower instead of ever more behind.

    Attributes
    ----------
    paused : bool
        Whether time stands still; :meth:`queue_step` still gives single steps.
    slow_motion : bool
        Whether the world runs at a quarter of its speed, whatever speed was chosen.
    measured : bool
        Whether steps are of one length at any speed: figures of a run are not to depend on that.
    chosen : float
        The speed when there is no slow motion; 1 is as fast as life.
    dropped : float
        Time [s] on the wall that was dropped so far.

    Examples
    --------
    >>> pace = Pace(max_dt=0.1)
    >>> pace.begin(0.05)
    >>> pace.due(1 / 60)
    3
    """

    SLOW = 0.25
    """The speed of slow motion."""
    MIN_SPEED, MAX_SPEED = 0.0625, 4.0
    """The speeds that can be chosen."""

    def __init__(self, max_dt: float) -> None:
        self.max_dt = max_dt
        self.paused = False
        self.slow_motion = self.measured = False
        self.chosen = 1.0
        self.dropped = 0.0
        self._due = 0.0
        self._single = 0

    @property
    def speed(self) -> float:
        """How fast the world runs: 1 is as fast as life."""
        return self.SLOW if self.slow_motion else self.chosen

    @property
    def shortening(self) -> float:
        """How long a step is, as a share of ``dt``: less than 1 below full speed, never more."""
        return 1.0 if self.measured else min(self.speed, 1.0)

    @property
    def _rate(self) -> float:
        """How many steps are made for each at full speed: less than 1 only where none is shorter."""
        return self.speed / self.shortening

    def choose(self, factor: float) -> None:
        """Multiply the speed by a factor, within the speeds there are."""
        self.chosen = min(max(self.speed * factor, self.MIN_SPEED), self.MAX_SPEED)
        self.slow_motion = False

    def return_to_life(self) -> None:
        """Run as fast as life again."""
        self.chosen, self.slow_motion = 1.0, False

    def begin(self, elapsed: float) -> None:
        """Begin a frame, ``elapsed`` seconds after the last."""
        if self.paused:
            return
        self._due += min(elapsed, self.max_dt) * self._rate
        self.drop(max(elapsed - self.max_dt, 0.0))

    def due(self, dt: float) -> int:
        """Return how many steps of ``dt`` seconds are due in this frame."""
        if self.paused:
            return self._single
        # Rounded to the nearest, not down: frames as long as a step, give or take, get one step each, and no
        # step depends on the last bit of a sum of frame times.
        return max(math.floor(self._due / dt + 0.5), 0)

    def done(self, steps: int, dt: float) -> None:
        """Count steps as made; others that were due are dropped."""
        due = self.due(dt)
        if self.paused:
            self._single = 0
            return
        self._due -= due * dt
        self.drop((due - steps) * dt / self._rate)

    def drop(self, seconds: float) -> None:
        """Count time [s] that is not made up for."""
        self.dropped += seconds

    def queue_step(self) -> None:
        """Pause, and make one step due."""
        self.paused = True
        self._single += 1

    def halt(self) -> None:
        """Pause because the world cannot go on; no step is due."""
        self.paused = True
        self._due = 0.0
        self._single = 0

    def toggle_pause(self) -> None:
        """Let time stand still, or go on."""
        self.paused = not self.paused
        self._single = 0
