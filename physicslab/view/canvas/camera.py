"""The camera, the one place where metres become pixels, and what else a picture is drawn with."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.vector import Vector2
from physicslab.theme import Theme
from physicslab.view.canvas.canvas import Canvas, Rect

type Extent = tuple[float, float, float, float]
"""A part of the world: ``(xmin, ymin, xmax, ymax)`` [m]."""

_MIN_SCALE, _MAX_SCALE = 1e-15, 1e9
"""Scales [px/m] beyond which floating point shows in the picture."""


class Camera:
    """A view of the world: y points up there and down on the screen.

    Attributes
    ----------
    centre : Vector2
        The point of the world in the middle of the screen [m].
    scale : float
        Pixels per metre.
    size : tuple of two ints
        Width and height of the screen [px].

    Examples
    --------
    >>> camera = Camera((1280, 720), scale=100.0)
    >>> camera.to_screen(Vector2(1, 2))
    (740.0, 160.0)
    >>> camera.to_world((740.0, 160.0))
    Vector2(x=1.0, y=2.0)
    """

    __slots__ = ("centre", "scale", "size")

    def __init__(
        self, size: tuple[int, int], *, centre: Vector2 = Vector2(0.0, 0.0), scale: float = 100.0
    ) -> None:
        self.size = size
        self.centre = centre
        self.scale = scale

    @property
    def visible(self) -> Extent:
        """The part of the world that is on the screen [m]."""
        half_width, half_height = 0.5 * self.size[0] / self.scale, 0.5 * self.size[1] / self.scale
        x, y = self.centre
        return x - half_width, y - half_height, x + half_width, y + half_height

    def to_screen(self, point: Vector2) -> tuple[float, float]:
        """Return where a point of the world [m] is on the screen [px]."""
        offset = point - self.centre
        return 0.5 * self.size[0] + self.scale * offset.x, 0.5 * self.size[1] - self.scale * offset.y

    def project(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return where points of the world, an array (n, 2) [m], are on the screen [px]."""
        # The centre is taken off first: far from the origin nothing else leaves any digits for the screen.
        # A column at a time: numpy is three times slower where the last axis is as short as two.
        pixels = np.empty(points.shape)
        pixels[:, 0] = (points[:, 0] - self.centre.x) * self.scale + 0.5 * self.size[0]
        pixels[:, 1] = (points[:, 1] - self.centre.y) * -self.scale + 0.5 * self.size[1]
        return pixels

    def to_world(self, pixel: tuple[float, float]) -> Vector2:
        """Return which point of the world [m] a place on the screen [px] shows."""
        return Vector2(
            self.centre.x + (pixel[0] - 0.5 * self.size[0]) / self.scale,
            self.centre.y - (pixel[1] - 0.5 * self.size[1]) / self.scale,
        )

    def resize(self, size: tuple[int, int]) -> None:
        """Show the world on a screen of another size, with the same point in the middle."""
        self.size = size

    def pan(self, dx: float, dy: float) -> None:
        """Move the picture by a number of pixels, right and down."""
        self.centre = Vector2(self.centre.x - dx / self.scale, self.centre.y + dy / self.scale)

    def zoom(self, factor: float, at: tuple[float, float]) -> None:
        """Enlarge the picture, leaving the point under the pixel ``at`` where it is."""
        before = self.to_world(at)
        self.scale = min(max(self.scale * factor, _MIN_SCALE), _MAX_SCALE)
        after = self.to_world(at)
        self.centre = self.centre + before - after

    def look_at(self, extent: Extent, scale: float, room: Rect | None = None) -> None:
        """Put the middle of a part of the world in the middle of the screen, at a scale of ``scale`` px/m.

        ``room`` is the part of the screen that it is put in the middle of [px], all of it by default.
        """
        left, top, width, height = room or (0, 0, *self.size)
        self.scale = min(max(scale, _MIN_SCALE), _MAX_SCALE)
        self.centre = Vector2(
            0.5 * (extent[0] + extent[2]) + (0.5 * (self.size[0] - width) - left) / self.scale,
            0.5 * (extent[1] + extent[3]) - (0.5 * (self.size[1] - height) - top) / self.scale,
        )

    def fitting_scale(self, extent: Extent, room: Rect | None = None, margin: float = 0.07) -> float:
        """Return the scale [px/m] at which a part of the world fills the screen but for a share as margin.

        ``room`` is the part of the screen to be filled [px], all of it by default.
        """
        share = 1.0 - 2.0 * margin
        _, _, across, up = room or (0, 0, *self.size)
        width, height = extent[2] - extent[0], extent[3] - extent[1]
        return min(
            across * share / width if width > 0.0 else _MAX_SCALE,
            up * share / height if height > 0.0 else _MAX_SCALE,
        )


@dataclass(frozen=True, slots=True)
class Drawing:
    """A canvas, the camera that shows the world on it, and the look of what is drawn.

    Attributes
    ----------
    canvas : Canvas
        The surface to draw on.
    camera : Camera
        Which part of the world is shown.
    theme : Theme
        The colours.
    size : int
        Height of words [px].
    """

    canvas: Canvas
    camera: Camera
    theme: Theme
    size: int
