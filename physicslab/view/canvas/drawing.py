"""What a picture of the world is drawn with."""

from dataclasses import dataclass

from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas
from physicslab.view.canvas.theme import Theme


@dataclass(frozen=True, slots=True)
class Drawing:
    """A canvas, the camera that shows the world on it, and the look of what is drawn.

    Attributes
    ----------
    canvas : Canvas
        What is drawn on.
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
