"""Outlines of what is drawn, before it is made, and the words beside the cursor."""

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise

from physicslab.components import Colour, MadeOf, Shape
from physicslab.contacts.outlines import Outlines, discs_at
from physicslab.ecs.vector import Vector2
from physicslab.view.controls.drawn import (
    Drawn,
    at_cursor,
    clicked,
    grip_at,
    is_closed,
    is_dragged,
    is_refused,
)
from physicslab.view.controls.measure import DOMINOES
from physicslab.view.controls.polygons import is_stroke, simplified
from physicslab.view.window.edits import Recipe
from physicslab.view.window.placing import outlines_of, put_down, refused_place, way_aside
from physicslab.view.window.window import Window
from physicslab.world import World


def built(drawn: Drawn, places: Sequence[Vector2], recipe: Recipe) -> World:
    """Return a world with the bodies that are made through points [m]."""
    scratch = World()
    if drawn.build is not None:
        drawn.build(scratch, places, recipe)
    if drawn.by_recipe and recipe.material:
        for entity in scratch.batch(Shape).entities.tolist():
            scratch.add(entity, MadeOf(recipe.material))
            if recipe.colour:
                scratch.add(entity, Colour(recipe.colour))
    return scratch


def put_in_place(
    world: World, drawn: Drawn, places: Sequence[Vector2], window: Window, recipe: Recipe
) -> Sequence[Vector2]:
    """Return points [m] so that what is made of them stands, or lies beside what it was drawn against."""
    if drawn.stands:
        places = put_down(world, places, each=drawn.measure is DOMINOES)
    aside = way_aside(world, window.camera, outlines_through(drawn, places, recipe))
    return [place + aside for place in places] if aside else places


def outlines_through(drawn: Drawn, places: Sequence[Vector2], recipe: Recipe) -> Outlines:
    """Return the outlines of bodies that are made through points [m]."""
    origin = places[0]
    return _outlines_about(drawn, tuple(place - origin for place in places), recipe).moved(origin)


@lru_cache(maxsize=32)
def _outlines_about(drawn: Drawn, places: tuple[Vector2, ...], recipe: Recipe) -> Outlines:
    """Return the outlines of bodies through points, of which the first is the origin."""
    return outlines_of(built(drawn, places, recipe))


def about(drawn: Drawn, window: Window) -> Outlines | None:
    """Return the outlines of what a click makes, as if the cursor were at the origin; none of one corner."""
    try:
        return outlines_through(drawn, clicked(drawn, window, Vector2()), window.recipe)
    except ValueError:  # larger than anything may be, or not a shape yet
        return None


def hovered(world: World, drawn: Drawn, window: Window) -> int | None:
    """Return the body that the next point of a joint would be one of."""
    return grip_at(world, drawn, window, at_cursor(world, drawn, window)).body


def ghost(world: World, drawn: Drawn, window: Window) -> tuple[Outlines, bool] | None:
    """Return the outlines of what a click, or letting go, makes now, and whether there is room for it."""
    sketch = window.sketch
    if drawn.pours and sketch.name == drawn.name:
        return discs_at(sketch.stroke, window.recipe.grain), True
    if sketch.name == drawn.name and sketch.grips:
        places = [grip.anchor for grip in sketch.grips]
        if is_stroke(sketch.stroke):
            places = simplified(sketch.stroke)
        elif drawn.is_open or is_dragged(drawn, window):
            cursor = at_cursor(world, drawn, window)
            places = places if drawn.is_open and is_closed(window, cursor) else [*places, cursor]
        else:
            places = clicked(drawn, window, sketch.spot)
    else:
        places = clicked(drawn, window, window.target)
    recipe = window.recipe.given(drawn.measure.given(sketch.typed) if sketch.name == drawn.name else {})
    try:
        outlines = outlines_through(drawn, put_in_place(world, drawn, places, window, recipe), recipe)
    except ValueError:  # larger than anything may be, or not a shape yet
        return None
    return outlines, not refused_place(world, outlines)


def lines(world: World, drawn: Drawn, window: Window) -> list[tuple[Vector2, Vector2]]:
    """Return the lines of a joint or a polygon in the making, to the point at the cursor [m]."""
    places = [grip.place(world) for grip in window.sketch.grips]
    if drawn.hangs and not is_dragged(drawn, window):
        return []
    if is_stroke(window.sketch.stroke):
        return list(pairwise(window.sketch.stroke))
    places.append(grip_at(world, drawn, window, at_cursor(world, drawn, window)).place(world))
    return list(pairwise(places)) if drawn.is_open else list(zip(places[::2], places[1::2], strict=False))


def number_of_discs(count: int) -> str:
    """Return how many discs there are, in words."""
    return "1 disc" if count == 1 else f"{count} discs"


def reading(world: World, drawn: Drawn, window: Window) -> str:
    """Return what stands beside the cursor: the size of what is drawn, what is typed, or what to do next."""
    sketch = window.sketch
    begun = len(sketch.grips) if sketch.name == drawn.name else 0
    if drawn.pours and begun:
        count = number_of_discs(len(sketch.stroke))
        return f"{sketch.typed}_   {count}" if sketch.typed else count
    if is_stroke(sketch.stroke):
        return "Let go to close it"
    if (begun % 2 or drawn.is_open) and begun and drawn.points != 1 and is_dragged(drawn, window):
        if is_refused(world, drawn, window, told=False):
            return f"{sketch.typed}_"
        first, place = sketch.grips[-1].place(world), at_cursor(world, drawn, window)
        size = drawn.measure.said(place - first)
        return f"{sketch.typed}_   {size}" if sketch.typed else size
    if begun and sketch.typed:
        return f"{sketch.typed}_"
    return drawn.prompts[min(begun, len(drawn.prompts) - 1)] if drawn.prompts else ""
