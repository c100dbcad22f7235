"""Drawing with the mouse: points are put down by presses and drags, and make a body, a joint or a group."""

import copy
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from types import MappingProxyType

from physicslab.components import Colour, Mass, Shape, Velocity
from physicslab.ecs.component import Component
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.vector import Vector2
from physicslab.history import Command, Group, Spawn
from physicslab.languages.sentence import Sentence
from physicslab.view.controls.drawn import (
    Drawn,
    at_cursor,
    clicked,
    grip_at,
    is_closed,
    is_dragged,
    is_refused,
)
from physicslab.view.controls.polygons import MOST, is_stroke, simplified
from physicslab.view.controls.pouring import pour
from physicslab.view.controls.preview import built, number_of_discs, outlines_through, put_in_place
from physicslab.view.window.edits import Recipe
from physicslab.view.window.ends import brought
from physicslab.view.window.placing import refused_place, snapped_point
from physicslab.view.window.sketch import Grip
from physicslab.view.window.window import Window
from physicslab.world import World

_STEP = 5.0
"""How far apart the points of a stroke are [px]."""


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
    if is_refused(world, drawn, window):
        return
    if drawn.pours and sketch.held:
        release(world, window, drawn)
        return
    sketch.held, place = button, at_cursor(world, drawn, window)
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
        if is_refused(world, drawn, window):
            sketch.cancel()
        else:
            _put(world, window, drawn, at_cursor(world, drawn, window))
    elif drawn.ways:
        places, given = clicked(drawn, window, sketch.spot), drawn.measure.given(sketch.typed)
        sketch.cancel()
        _build(world, window, drawn, places, given=given)


def _put(world: World, window: Window, drawn: Drawn, place: Vector2) -> None:
    sketch = window.sketch
    closes, given = drawn.is_open and is_closed(window, place), drawn.measure.given(sketch.typed)
    if not closes:
        grip = grip_at(world, drawn, window, place)
        if drawn.refuses is not None and (reason := drawn.refuses(world, grip)):
            window.notify(reason, 5.0, failed=True)
            if not sketch.grips:
                sketch.cancel()
            return
        sketch.grips.append(grip)
    sketch.begin, sketch.typed, sketch.stroke = window.pointer, "", []
    if drawn.pours and sketch.held:
        return
    if closes or len(sketch.grips) == (drawn.points or MOST):
        _finish(world, window, drawn, list(sketch.grips), given)


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


# ---- bodies ------------------------------------------------------------------------------------------------


def click(world: World, window: Window, drawn: Drawn) -> None:
    """Make something where the cursor is, as by a click."""
    _build(world, window, drawn, clicked(drawn, window, window.target))


def _build(
    world: World, window: Window, drawn: Drawn, places: Sequence[Vector2], *, checked: bool = False,
    given: Mapping[str, float] = MappingProxyType({}),
) -> bool:  # fmt: skip
    """Make bodies through points; where they would overlap, say so instead. Return whether they were made.

    ``checked`` says that there is room for them.
    """
    if not places:
        return False
    recipe = window.recipe.given(given)
    try:
        places = places if checked else put_in_place(world, drawn, places, window, recipe)
        refused = "" if checked else refused_place(world, outlines_through(drawn, places, recipe))
        made = [] if refused else _commands(drawn, places, window, recipe, given)
    except InvalidValue as error:
        refused = Sentence(f"{error.field} = {error.value}: must be {error.allowed}")
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
        window.notify(number_of_discs(len(places)))
    if drawn.remark and world.physics.gravity_mode != "planet":
        window.notify(drawn.remark, 5.0)
    return True


def _commands(
    drawn: Drawn, places: Sequence[Vector2], window: Window, recipe: Recipe, given: Mapping[str, float]
) -> list[Command]:
    """Return the commands that make bodies through points, of a mass [kg] and a speed to the right [m/s]."""
    scratch, first = built(drawn, places, recipe), window.edits.history.next_entity
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
