"""The motion of the window itself: the camera glides to another view, notices come and go softly."""

from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Camera

GLIDE, FADE = 0.16, 0.12
"""How long the camera takes to another view, and a notice to come or go [s]."""


class Glide:
    """Shows the way to another view; the camera, by which places are read, is there at once."""

    def __init__(self) -> None:
        self._from: tuple[Vector2, float] | None = None
        self._until = 0.0

    def begin(self, shown: Camera, now: float) -> None:
        """Begin at what is shown now, at a time of the window [s]."""
        self._from, self._until = (shown.centre, shown.scale), now + GLIDE

    def runs(self, now: float) -> bool:
        """Whether the view is still on its way."""
        return self._from is not None and now < self._until

    def shown(self, camera: Camera, now: float) -> Camera:
        """Return the camera to draw with: fast at first, slow in the end."""
        if self._from is None or now >= self._until:
            self._from = None
            return camera
        share = 1.0 - (max(self._until - now, 0.0) / GLIDE) ** 3
        centre, scale = self._from
        between = Camera(camera.size, scale=scale * (camera.scale / scale) ** share)
        # The place that does not move is the same at all scales between, so that a zoom goes straight.
        part = share
        if camera.scale != scale:
            part = (1.0 / scale - 1.0 / between.scale) / (1.0 / scale - 1.0 / camera.scale)
        between.centre = centre + (camera.centre - centre) * part
        return between


def fading(shown: float, left: float) -> float:
    """Return how visible a notice is that was shown for a time and is to stay for another [s].

    >>> fading(1.0, 2.0), fading(0.06, 2.0), fading(1.0, 0.03)
    (1.0, 0.5, 0.25)
    """
    return min(max(min(shown, left) / FADE, 0.0), 1.0)
