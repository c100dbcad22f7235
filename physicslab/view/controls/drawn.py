"""Drawn things, and where their points are: by clicks, by the cursor, by what was typed."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import pygame

from physicslab.components import Transform
from physicslab.ecs.component import Component
from physicslab.ecs.quantity_text import InvalidText
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.keyboard import held_keys
from physicslab.view.controls.measure import HANGING, LENGTH, Measure
from physicslab.view.controls.picking import body_at
from physicslab.view.window.edits import Recipe
from physicslab.view.window.ends import local_point
from physicslab.view.window.sketch import Grip
from physicslab.view.window.window import Window
from physicslab.world import World

_CLICK = 8.0
"""How far apart a press and a release are at most that are a click [px]."""
_MIDDLE = 10.0
"""How near to the middle of a body a joint is put at the middle [px]."""
_LEAST = 3.0
"""The least side of a box that is drawn [px]."""
_CLOSING = 10.0
"""How near to an end a polygon is closed [px]."""

type Build = Callable[[World, Sequence[Vector2], Recipe], None]
"""Makes bodies in a world of their own, through points [m]."""
type Join = Callable[[World, Window, Sequence[Grip]], Component | str]
"""Returns the joint of points that were put down, or why there is none."""
type Refuse = Callable[[World, Grip], str]
"""Returns why a joint cannot have a point; empty where it can."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """Something that is drawn: how many points it has, and what they make.

    Attributes
    ----------
    name, title : str
        Its icon, and what it is called.
    usage : str
        How it is drawn.
    points : int
        How many points make it; 0: as many as are put down until it is closed at the first, or by a stroke.
    build, join : callable, optional
        Makes bodies; or returns the joint of what lies at the points.
    refuses : callable, optional
        Returns why a joint cannot have a point, as soon as that is put down; empty where it can.
    measure : Measure
        How its second point follows from numbers.
    ways : tuple of Vector2
        From the first point to the second where there was only a click, in turn [m]; none: there must be two.
    per_size : Vector2
        That way for each metre of the size that is chosen for the next body.
    is_centred : bool
        Whether a click is at the middle between both points, and not at the first.
    prompts : tuple of str
        Prompts beside the cursor, by the number of points that were put down.
    remark : str
        Remark where gravity does not act between bodies.
    by_recipe, stands, pours, is_fixed : bool
        Whether it is made as the recipe for the next body says; whether it is put on what is just below;
        whether as many are made as fit around the way of the cursor while the button is held; and whether it
        is fixed, and has no mass.
    """

    name: str
    title: str
    usage: str
    points: int = 2
    build: Build | None = None
    join: Join | None = None
    refuses: Refuse | None = None
    measure: Measure = LENGTH
    ways: tuple[Vector2, ...] = ()
    per_size: Vector2 = Vector2()
    is_centred: bool = False
    prompts: tuple[str, ...] = ()
    remark: str = ""
    by_recipe: bool = False
    stands: bool = False
    pours: bool = False
    is_fixed: bool = False

    @property
    def by_click(self) -> bool:
        """Whether a click makes it."""
        return self.points < 2 or bool(self.ways)

    @property
    def is_open(self) -> bool:
        """Whether it has any number of points."""
        return self.points == 0

    @property
    def hangs(self) -> bool:
        """Whether it hangs from its first point."""
        return self.measure is HANGING


def clicked(drawn: Drawn, window: Window, place: Vector2) -> list[Vector2]:
    """Return the points of what a click makes at a place [m]: as large as the last one drawn."""
    if drawn.points < 2:
        return [place]
    way = window.sketch.ways.get(drawn.name) or drawn.ways[(window.spawned + 1) % len(drawn.ways)]
    if window.recipe.size and drawn.per_size:
        way = drawn.per_size * window.recipe.size
    return [place - way * 0.5, place + way * 0.5] if drawn.is_centred else [place, place + way]


def at_cursor(world: World, drawn: Drawn, window: Window) -> Vector2:
    """Return where the next point would be put down now [m]: by the cursor, and by what was typed."""
    sketch, place = window.sketch, window.target
    if not sketch.grips or (len(sketch.grips) % 2 == 0 and not drawn.is_open):
        return place
    first = sketch.grips[-1].place(world)
    way = place - first
    if held_keys() & pygame.KMOD_SHIFT:
        way = drawn.measure.rounded(way)
    if sketch.typed:
        try:
            way = drawn.measure.written(sketch.typed, way)
        except InvalidText:
            return first + way  # it is not written to its end
    elif drawn.measure.units == ("m", "m"):
        least = _LEAST / window.camera.scale
        way = Vector2(*(math.copysign(max(abs(part), least), part) for part in way))
    return first + way


def is_refused(world: World, drawn: Drawn, window: Window, *, told: bool = True) -> bool:
    """Whether typed numbers are none that the next point follows from; and say why."""
    sketch = window.sketch
    if not sketch.grips or drawn.pours:
        return False
    refusal = drawn.measure.refusal(sketch.typed, window.target - sketch.grips[-1].place(world))
    if refusal and told:
        window.notify(f"{drawn.title}: {sketch.typed}: {refusal}", 5.0, failed=True)
    return bool(refusal)


def grip_at(world: World, drawn: Drawn, window: Window, place: Vector2) -> Grip:
    """Return the point of what lies at a place, near its middle that itself; of bodies to be the place."""
    if drawn.build is not None:
        return Grip(None, place)
    pixel = window.camera.to_screen(place)
    body = body_at(world, window.camera, pixel)
    if body is None:
        return Grip(None, place)
    middle = world.component(body, Transform).position
    is_near = (middle - place).magnitude * window.camera.scale <= _MIDDLE
    return Grip(body, Vector2() if is_near else local_point(world, body, place))


def is_closed(window: Window, place: Vector2) -> bool:
    """Whether a place [m] is at the first or the last point of a polygon that has at least three."""
    grips = window.sketch.grips
    near = _CLOSING / window.camera.scale
    return len(grips) > 2 and any((grips[end].anchor - place).magnitude <= near for end in (0, -1))


def is_dragged(drawn: Drawn, window: Window) -> bool:
    """Whether the cursor is far from where the last point was put down, or a size stands in its place."""
    (x, y), (at_x, at_y) = window.sketch.begin, window.pointer
    return bool(drawn.measure.sizes(window.sketch.typed)) or math.hypot(x - at_x, y - at_y) > _CLICK
