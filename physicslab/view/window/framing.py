"""The part of the world that is seen: all of it, what its scene says, or what was chosen."""

from collections.abc import Callable

from physicslab.components import Slider
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Camera, Extent
from physicslab.view.canvas.canvas import Canvas, Rect
from physicslab.view.picture.backdrop import falls_down
from physicslab.view.picture.extent import extent_of
from physicslab.world import World

_AROUND = 0.04
"""Room left around the world, as a share of what the panels leave."""

_SKY = 0.25
"""Share of the height that is left over by which a world is lower than the middle where bodies fall down."""


class Framing:
    """Lets the camera show the world, or what was chosen of it, in the room that the panels leave.

    Parameters
    ----------
    canvas, camera : Canvas, Camera
        The surface to draw on, and the view of the world.
    scale : float
        The usual scale [px/m].

    Attributes
    ----------
    room : callable
        Returns which part of the canvas is left for the world [px].
    """

    def __init__(self, canvas: Canvas, camera: Camera, scale: float) -> None:
        self._canvas, self._camera, self._scale = canvas, camera, scale
        self.room: Callable[[], Rect] = lambda: (0, 0, *canvas.size)
        self._shown: tuple[Vector2, float, float, Extent | None] | None = None
        self._room: Rect | None = None

    @property
    def middle(self) -> tuple[float, float]:
        """The middle of what is left for the world [px]."""
        left, top, width, height = self.room()
        return left + 0.5 * width, top + 0.5 * height

    def follow(self, world: World) -> None:
        """Let the camera follow the canvas and its room; an untouched view still shows all of the world."""
        if self._camera.size == self._canvas.size and self._room == self.room():
            return
        before, self._room = self._room, self.room()
        is_resized = self._camera.size != self._canvas.size
        self._camera.resize(self._canvas.size)
        if self._shown is not None and self._shown[:2] == (self._camera.centre, self._camera.scale):
            self._show(world, *self._shown[2:])
        elif before is not None and not is_resized:  # what was in the middle stays there
            self._camera.pan(
                *(self._room[k] + 0.5 * self._room[k + 2] - before[k] - 0.5 * before[k + 2] for k in (0, 1))
            )

    def go_home(self, world: World) -> None:
        """Show the world as at the start: what its scene says is to be seen, or else all of it.

        A scene that does not say is shown at the usual scale where it fits, else smaller.
        """
        self._show(world, float("inf") if world.view else self._scale, world.view)

    def keep_view(self, world: World) -> None:
        """Let the world open with what is seen of it now; a view that was not touched stays as it is."""
        if self._shown is not None and self._shown[:2] == (self._camera.centre, self._camera.scale):
            return
        _, _, width, height = self.room()
        middle = self._camera.to_world(self.middle)
        share = (0.5 - _AROUND) / self._camera.scale  # what is left around it is not part of it
        world.view = (
            middle.x - share * width, middle.y - share * height,
            middle.x + share * width, middle.y + share * height,
        )  # fmt: skip

    def fit(self, world: World) -> None:
        """Show all of the world, as large as it goes."""
        self._show(world, float("inf"))

    def _show(self, world: World, largest_scale: float, view: Extent | None = None) -> None:
        extent, room = view or extent_of(world), self.room()
        if extent is None:
            self._camera.look_at((0.0, 0.0, 0.0, 0.0), self._scale, room)
        else:
            scale = min(self._camera.fitting_scale(extent, room, _AROUND), largest_scale)
            self._camera.look_at(extent, scale, room)
            if falls_down(world) and not len(world.batch(Slider)):  # sliders stand below the bodies
                spare = (1.0 - 2.0 * _AROUND) * room[3] - (extent[3] - extent[1]) * self._camera.scale
                self._camera.pan(0.0, _SKY * max(spare, 0.0))
        self._shown = (self._camera.centre, self._camera.scale, largest_scale, view)
