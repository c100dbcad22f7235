"""Drawing with the mouse: points are put down by presses and drags, and make a body, a joint or a group."""

import copy
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import pairwise
from types import MappingProxyType

import pygame

from physicslab.components import Colour, MadeOf, Mass, Shape, Transform, Velocity
from physicslab.contacts.outlines import Outlines, discs_at
from physicslab.ecs.component import Component
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.quantity_text import InvalidText
from physicslab.ecs.vector import Vector2
from physicslab.history import Command, Group, Spawn
from physicslab.languages.sentence import Sentence
from physicslab.view.controls.measure import DOMINOES, HANGING, LENGTH, Measure
from physicslab.view.controls.picking import body_at
from physicslab.view.controls.polygons import MOST, is_stroke, simplified
from physicslab.view.controls.pouring import pour
from physicslab.view.window.edits import Recipe
from physicslab.view.window.ends import brought, local_point
from physicslab.view.window.placing import outlines_of, put_down, refused_place, snapped_point, way_aside
from physicslab.view.window.sketch import Grip
from physicslab.view.window.window import Window
from physicslab.world import World

_CLICK = 8.0
"""How far apart a press and a release are at most that are a click [px]."""
_MIDDLE = 10.0
"""How near to the middle of a body a joint is put at the middle [px]."""
_LEAST = 3.0
"""The least side of a box that is drawn [px]."""
_CLOSING, _STEP = 10.0, 5.0
"""How near to an end a polygon is closed, and how far apart the points of a stroke are [px]."""

type Build = Callable[[World, Sequence[Vector2], Recipe], None]
"""Makes bodies in a world of their own, through points [m]."""
type Join = Callable[[World, Window, Sequence[Grip]], Component | str]
"""Returns the joint of points that were put down, or why there is none."""


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


# ---- points ------------------------------------------------------------------------------------------------


def _clicked(drawn: Drawn, window: Window, place: Vector2) -> list[Vector2]:
    """Return the points of what a click makes at a place [m]: as large as the last one drawn."""
    if drawn.points < 2:
        return [place]
    way = window.sketch.ways.get(drawn.name) or drawn.ways[(window.spawned + 1) % len(drawn.ways)]
    if window.recipe.size and drawn.per_size:
        way = drawn.per_size * window.recipe.size
    return [place - way * 0.5, place + way * 0.5] if drawn.is_centred else [place, place + way]


def _at_cursor(world: World, drawn: Drawn, window: Window) -> Vector2:
    """Return where the next point would be put down now [m]: by the cursor, and by what was typed."""
    sketch, place = window.sketch, window.target
    if not sketch.grips or (len(sketch.grips) % 2 == 0 and not drawn.is_open):
        return place
    first = sketch.grips[-1].place(world)
    way = place - first
    if pygame.key.get_mods() & pygame.KMOD_SHIFT:
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


def _is_refused(world: World, drawn: Drawn, window: Window, *, told: bool = True) -> bool:
    """Whether typed numbers are none that the next point follows from; and say why."""
    sketch = window.sketch
    if not sketch.grips or drawn.pours:
        return False
    refusal = drawn.measure.refusal(sketch.typed, window.target - sketch.grips[-1].place(world))
    if refusal and told:
        window.notify(f"{drawn.title}: {sketch.typed}: {refusal}", 5.0, failed=True)
    return bool(refusal)


def _grip(world: World, drawn: Drawn, window: Window, place: Vector2) -> Grip:
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


def hovered(world: World, drawn: Drawn, window: Window) -> int | None:
    """Return the body that the next point of a joint would be one of."""
    return _grip(world, drawn, window, _at_cursor(world, drawn, window)).body


def is_dragged(drawn: Drawn, window: Window) -> bool:
    """Whether the cursor is far from where the last point was put down, or a size stands in its place."""
    (x, y), (at_x, at_y) = window.sketch.begin, window.pointer
    return bool(drawn.measure.sizes(window.sketch.typed)) or math.hypot(x - at_x, y - at_y) > _CLICK


# ---- presses and releases ----------------------------------------------------------------------------------


def press(world: World, window: Window, drawn: Drawn, button: int = 0) -> None:
    """Put down the next point of what is drawn, or the first one: of a body not so near to a panel."""
    sketch = window.sketch
    if button and drawn.build is not None and window.pointer_beside_panel and sketch.name != drawn.name:
        window.notify(f"{drawn.title}: begin a little farther from the panel")
        return
    if sketch.name != drawn.name:
        sketch.cancel()
        sketch.name, sketch.spot = drawn.name, window.target
    if sketch.grips and drawn.ways and not is_dragged(drawn, window):  # Enter, while the button is held
        release(world, window, drawn)
        return
    if _is_refused(world, drawn, window):
        return
    if drawn.pours and sketch.held:
        release(world, window, drawn)
        return
    sketch.held, place = button, _at_cursor(world, drawn, window)
    if window.snapping.active and drawn.ways:
        place = snapped_point(world, window.camera, window.place)
    _put(world, window, drawn, place)


def release(world: World, window: Window, drawn: Drawn) -> None:
    """Put down a point where a drag ends; a click makes one of the last size, or waits for the next point."""
    sketch = window.sketch
    sketch.follow(world)
    if sketch.name != drawn.name:
        return
    sketch.held = 0
    if drawn.pours:
        pour(world, window, 0.0)
        places = sketch.stroke
        sketch.cancel()
        _build(world, window, drawn, places, checked=True)
    elif drawn.is_open and is_stroke(sketch.stroke) and not sketch.typed:
        _finish(world, window, drawn, [Grip(None, place) for place in simplified(sketch.stroke)])
    elif is_dragged(drawn, window):
        if _is_refused(world, drawn, window):
            sketch.cancel()
        else:
            _put(world, window, drawn, _at_cursor(world, drawn, window))
    elif drawn.ways:
        places, given = _clicked(drawn, window, sketch.spot), drawn.measure.given(sketch.typed)
        sketch.cancel()
        _build(world, window, drawn, places, given=given)


def _put(world: World, window: Window, drawn: Drawn, place: Vector2) -> None:
    sketch = window.sketch
    closes, given = drawn.is_open and _is_closed(window, place), drawn.measure.given(sketch.typed)
    if not closes:
        sketch.grips.append(_grip(world, drawn, window, place))
    sketch.begin, sketch.typed, sketch.stroke = window.pointer, "", []
    if drawn.pours and sketch.held:
        return
    if closes or len(sketch.grips) == (drawn.points or MOST):
        _finish(world, window, drawn, list(sketch.grips), given)


def _is_closed(window: Window, place: Vector2) -> bool:
    """Whether a place [m] is at the first or the last point of a polygon that has at least three."""
    grips = window.sketch.grips
    near = _CLOSING / window.camera.scale
    return len(grips) > 2 and any((grips[end].anchor - place).magnitude <= near for end in (0, -1))


def follow(window: Window, drawn: Drawn | None) -> None:
    """Note the way of a stroke: only the first point of a polygon begins one."""
    sketch = window.sketch
    if drawn is not None and drawn.is_open and sketch.held and len(sketch.grips) == 1:
        last = sketch.stroke[-1] if sketch.stroke else sketch.grips[0].anchor
        if (window.place - last).magnitude * window.camera.scale >= _STEP:
            sketch.stroke += [last, window.place] if not sketch.stroke else [window.place]


def _finish(
    world: World,
    window: Window,
    drawn: Drawn,
    grips: Sequence[Grip],
    given: Mapping[str, float] | None = None,
) -> None:
    """Make what is drawn of its points, with the mass and the speed that were given, by their units."""
    sketch = window.sketch
    sketch.cancel()
    if drawn.join is not None:
        join(world, window, drawn.title, partial(drawn.join, world, window, grips))
        return
    places = [grip.anchor for grip in grips]
    if _build(world, window, drawn, places, given=given or {}) and len(places) == 2:
        sketch.ways[drawn.name] = places[1] - places[0]


def join(world: World, window: Window, title: str, make: Callable[[], Component | str]) -> tuple[int, ...]:
    """Make a joint as one edit and return its entity; or say why there is none."""
    try:
        made = make()
    except InvalidValue as error:
        made = f"No {title.lower()}: {error.field} must be {error.allowed}"
    if not isinstance(made, str):
        return window.edits.do(Spawn([made]))
    if made:
        window.notify(made, 5.0, failed=True)
    return ()


# ---- bodies: they are made in a world of their own, and shown as outlines before that ----------------------


def click(world: World, window: Window, drawn: Drawn) -> None:
    """Make something where the cursor is, as by a click."""
    _build(world, window, drawn, _clicked(drawn, window, window.target))


def _build(
    world: World, window: Window, drawn: Drawn, places: Sequence[Vector2], *, checked: bool = False,
    given: Mapping[str, float] = MappingProxyType({}),
) -> bool:  # fmt: skip
    """Make bodies through points; where they would overlap, say so instead. Return whether they were made.

    ``checked`` says that there is room for them.
    """
    if not places:
        return False
    try:
        places = places if checked else _put_down(world, drawn, places, window)
        refused = "" if checked else refused_place(world, _outlines(drawn, places, window.recipe))
        made = [] if refused else _commands(drawn, places, window, given)
    except InvalidValue as error:
        refused = f"{error.field} must be {error.allowed}"
    except ValueError as error:  # no outline
        refused = str(error)
    if refused:
        said = Sentence("{thing}: {reason}", thing=Sentence(drawn.title), reason=refused)
        window.notify(said if isinstance(refused, Sentence) else str(said), failed=True)
        return False
    window.spawned += 1
    words = f"poured {len(places)} discs" if drawn.pours else f"made {drawn.title.lower()}"
    window.edits.do(Group(words, made))
    if drawn.pours:
        window.notify(_number_of_discs(len(places)))
    if drawn.remark and world.physics.gravity_mode != "planet":
        window.notify(drawn.remark, 5.0)
    return True


def _put_down(world: World, drawn: Drawn, places: Sequence[Vector2], window: Window) -> Sequence[Vector2]:
    """Return points [m] so that what is made of them stands, or lies beside what it was drawn against."""
    if drawn.stands:
        places = put_down(world, places, each=drawn.measure is DOMINOES)
    aside = way_aside(world, window.camera, _outlines(drawn, places, window.recipe))
    return [place + aside for place in places] if aside else places


def _commands(
    drawn: Drawn, places: Sequence[Vector2], window: Window, given: Mapping[str, float]
) -> list[Command]:
    """Return the commands that make bodies through points, of a mass [kg] and a speed to the right [m/s]."""
    scratch, first = _built(drawn, places, window.recipe), window.edits.history.next_entity
    entities, parts_of_one = scratch.entities(), scratch.batch(Shape).entities.tolist()
    if drawn.is_open and len(parts_of_one) > 1 and not scratch.has(parts_of_one[0], Colour):
        colour = Colour("#" + bytes(window.theme.body(first)).hex())
        for entity in parts_of_one:
            scratch.add(entity, copy.copy(colour))
    number = {entity: first + n for n, entity in enumerate(entities)}
    commands: list[Command] = []
    for entity in entities:
        parts = brought([one for one in scratch.components(entity) if isinstance(one, Component)], number)
        for part in parts:
            if isinstance(part, Mass) and "kg" in given:
                part.mass = given["kg"]
            elif isinstance(part, Velocity) and "m/s" in given:
                part.linear = Vector2(given["m/s"], 0.0)
        commands.append(Spawn(parts))
    return commands


def _built(drawn: Drawn, places: Sequence[Vector2], recipe: Recipe) -> World:
    scratch = World()
    if drawn.build is not None:
        drawn.build(scratch, places, recipe)
    if drawn.by_recipe and recipe.material:
        for entity in scratch.batch(Shape).entities.tolist():
            scratch.add(entity, MadeOf(recipe.material))
            if recipe.colour:
                scratch.add(entity, Colour(recipe.colour))
    return scratch


def _outlines(drawn: Drawn, places: Sequence[Vector2], recipe: Recipe) -> Outlines:
    origin = places[0]
    return _outlines_about(drawn, tuple(place - origin for place in places), recipe).moved(origin)


@lru_cache(maxsize=32)
def _outlines_about(drawn: Drawn, places: tuple[Vector2, ...], recipe: Recipe) -> Outlines:
    """Return the outlines of bodies through points, of which the first is the origin."""
    return outlines_of(_built(drawn, places, recipe))


def about(drawn: Drawn, window: Window) -> Outlines | None:
    """Return the outlines of what a click makes, as if the cursor were at the origin; none of one corner."""
    try:
        return _outlines(drawn, _clicked(drawn, window, Vector2()), window.recipe)
    except ValueError:  # larger than anything may be, or not a shape yet
        return None


# ---- what is shown while something is drawn ----------------------------------------------------------------


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
            cursor = _at_cursor(world, drawn, window)
            places = places if drawn.is_open and _is_closed(window, cursor) else [*places, cursor]
        else:
            places = _clicked(drawn, window, sketch.spot)
    else:
        places = _clicked(drawn, window, window.target)
    try:
        outlines = _outlines(drawn, _put_down(world, drawn, places, window), window.recipe)
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
    places.append(_grip(world, drawn, window, _at_cursor(world, drawn, window)).place(world))
    return list(pairwise(places)) if drawn.is_open else list(zip(places[::2], places[1::2], strict=False))


def _number_of_discs(count: int) -> str:
    return "1 disc" if count == 1 else f"{count} discs"


def reading(world: World, drawn: Drawn, window: Window) -> str:
    """Return what stands beside the cursor: the size of what is drawn, what is typed, or what to do next."""
    sketch = window.sketch
    begun = len(sketch.grips) if sketch.name == drawn.name else 0
    if drawn.pours and begun:
        count = _number_of_discs(len(sketch.stroke))
        return f"{sketch.typed}_   {count}" if sketch.typed else count
    if is_stroke(sketch.stroke):
        return "Let go to close it"
    if (begun % 2 or drawn.is_open) and begun and drawn.points != 1 and is_dragged(drawn, window):
        if _is_refused(world, drawn, window, told=False):
            return f"{sketch.typed}_"
        first, place = sketch.grips[-1].place(world), _at_cursor(world, drawn, window)
        size = drawn.measure.said(place - first)
        return f"{sketch.typed}_   {size}" if sketch.typed else size
    if begun and sketch.typed:
        return f"{sketch.typed}_"
    return drawn.prompts[min(begun, len(drawn.prompts) - 1)] if drawn.prompts else ""
