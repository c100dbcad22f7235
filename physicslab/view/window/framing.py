"""The part of the world that is seen: all of it, what its scene says, or what was chosen."""

from collections.abc import Callable, Sequence

from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Camera, Extent
from physicslab.view.canvas.canvas import Canvas, Rect, free_rects, overlap
from physicslab.view.picture.backdrop import falls_down
from physicslab.view.picture.extent import boxes_of, extent_of
from physicslab.world import World

_AROUND = 0.04
"""Room left around the world, as a share of what the panels leave."""

_SKY = 0.25
"""Share of the height that is left over by which a world is lower than the middle where bodies fall down."""

_LEAST = 0.3
"""Share of the usual scale below which nothing is made smaller for the sake of panels that lie over it."""


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
    small : callable
        Returns where meters and sliders lie in it [px].
    above : callable
        Returns how high a banner is that stands at the top of it as long as a world is shown [px].
    """

    def __init__(self, canvas: Canvas, camera: Camera, scale: float) -> None:
        self._canvas, self._camera, self._scale = canvas, camera, scale
        self.room: Callable[[], Rect] = lambda: (0, 0, *canvas.size)
        self.small: Callable[[], Sequence[Rect]] = lambda: ()
        self.above: Callable[[World], int] = lambda _: 0
        self._shown: tuple[Vector2, float, float, Extent | None] | None = None
        self._room: Rect | None = None
        self._count = 0  # of meters and sliders; where one grows by a digit the view stays

    @property
    def middle(self) -> tuple[float, float]:
        """The middle of what is left for the world [px]."""
        left, top, width, height = self.room()
        return left + 0.5 * width, top + 0.5 * height

    def follow(self, world: World) -> None:
        """Let the camera follow the canvas and its room; an untouched view still shows all of the world."""
        now = self.room(), len(self.small())
        if self._camera.size == self._canvas.size and now == (self._room, self._count):
            return
        before, (self._room, self._count) = self._room, now
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
        left, top, width, height = self._below_banner(world)
        middle = self._camera.to_world((left + 0.5 * width, top + 0.5 * height))
        share = (0.5 - _AROUND) / self._camera.scale  # what is left around it is not part of it
        world.view = (
            middle.x - share * width, middle.y - share * height,
            middle.x + share * width, middle.y + share * height,
        )  # fmt: skip

    def fit(self, world: World) -> None:
        """Show all of the world, as large as it goes."""
        self._show(world, float("inf"))

    def _show(self, world: World, largest_scale: float, view: Extent | None = None) -> None:
        extent, room = view or extent_of(world), self._below_banner(world)
        if extent is None:
            self._camera.look_at((0.0, 0.0, 0.0, 0.0), self._scale, room)
        else:
            scale = self._look(world, extent, room, largest_scale)
            if self._is_covered(world):
                rooms = free_rects(room, self.small())
                largest = max(rooms, key=lambda free: self._camera.fitting_scale(extent, free), default=room)
                if self._look(world, extent, largest, largest_scale) < _LEAST * scale:
                    self._look(world, extent, room, largest_scale)
        self._shown = (self._camera.centre, self._camera.scale, largest_scale, view)

    def _below_banner(self, world: World) -> Rect:
        left, top, width, height = self.room()
        taken = min(self.above(world), height - 1)
        return left, top + taken, width, height - taken

    def _look(self, world: World, extent: Extent, room: Rect, largest_scale: float) -> float:
        """Show a part of the world in a part of the canvas, and return the scale [px/m]."""
        scale = min(self._camera.fitting_scale(extent, room, _AROUND), largest_scale)
        self._camera.look_at(extent, scale, room)
        if falls_down(world):
            spare = (1.0 - 2.0 * _AROUND) * room[3] - (extent[3] - extent[1]) * self._camera.scale
            self._camera.pan(0.0, _SKY * max(spare, 0.0))
        return scale

    def _is_covered(self, world: World) -> bool:
        """Whether a meter or a slider lies over a body."""
        small = self.small()
        boxes = boxes_of(world) if small else ()
        for x_min, y_min, x_max, y_max in boxes:
            left, top = self._camera.to_screen(Vector2(x_min, y_max))
            size = (x_max - x_min) * self._camera.scale, (y_max - y_min) * self._camera.scale
            if any(overlap((left, top, *size), rect) for rect in small):
                return True
        return False
