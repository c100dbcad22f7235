"""Edits of the selection: one command for all of it, or one sentence that says why it is refused."""

import contextlib
from collections.abc import Callable, Iterator, Sequence

from physicslab.components import Held, MadeOf, Name, Pin, Rod, Rope, Shape, Slot, Spring, Transform, Weld
from physicslab.components.vertices import regular
from physicslab.ecs.component import COMPONENTS, Component
from physicslab.ecs.fields import REQUIRED, Field, InvalidValue
from physicslab.ecs.text import in_words
from physicslab.ecs.vector import Vector2
from physicslab.history import AddComponent, Command, RemoveComponent, SetField
from physicslab.state.attached import local_point as in_frame
from physicslab.state.attached import point_of
from physicslab.state.joint_rows import KINDS
from physicslab.view.window.ends import local_point
from physicslab.view.window.placing import refused_change
from physicslab.view.window.window import Window
from physicslab.world import World

_SIZE = 0.25
"""Radius of a shape that a body is given, half the width of a box [m]."""
_ABOVE = 1.0
"""How far above a body the spring holds it that it is given [m]."""
_IN_SPACE: dict[str, type[Component]] = {"Transform": Transform, "Shape": Shape}
"""Components of which a change may need room."""
_BY_TOOLS: tuple[type[Component], ...] = (Held, MadeOf)
"""Components that are added and removed by tools alone."""


def change_in_place(world: World, window: Window, commands: Sequence[Command], words: str = "") -> None:
    """Make one edit of commands, or say why one of them cannot give a body its place or its size."""
    for one in commands:
        if not isinstance(one, SetField) or one.component not in _IN_SPACE:
            continue
        refused = refused_change(world, one.entity, _IN_SPACE[one.component], one.field, one.value)
        if refused:
            window.notify(f"{one.words(world)}: {refused}", 6.0, failed=True)
            return
    window.edits.do_all(commands, words)


# ---- components ----------------------------------------------------------------------------------------


def addable(world: World, entities: Sequence[int]) -> dict[str, tuple[str, Callable[[int], Component]]]:
    """Return what can be added to some bodies: by its plain name its meaning, and what makes it for a body.

    These are all components that one of them has not, but for those that are made by tools: with values of
    their own, or naming other entities without a part in the motion, as graphs do.
    """
    if not all(world.has(entity, Transform) for entity in entities):
        return {}
    found: dict[str, tuple[str, Callable[[int], Component]]] = {}
    for kind in COMPONENTS.values():
        apart = not kind.physical and any(spec.kind == "entity" for spec in kind.FIELDS)
        if kind in _BY_TOOLS or apart or all(world.has(entity, kind) for entity in entities):
            continue
        for words, make in makers(world, kind):
            found[words] = _meaning(kind), make
    return found


def removable(world: World, entities: Sequence[int]) -> dict[str, tuple[str, type[Component]]]:
    """Return what can be taken from some bodies: by its plain name its meaning, and the component."""
    if not entities or not all(world.has(entity, Transform) for entity in entities):
        return {}
    held = [type(part) for part in world.components(entities[-1]) if isinstance(part, Component)]
    kinds = [kind for kind in held if kind not in _BY_TOOLS]
    common = [kind for kind in kinds if all(world.has(entity, kind) for entity in entities)]
    return {plain_kind(kind): (_meaning(kind), kind) for kind in common}


def give(world: World, window: Window, entities: Sequence[int], make: Callable[[int], Component]) -> None:
    """Add a component to each of some entities that has none of its kind."""
    made = [(entity, make(entity)) for entity in entities]
    window.edits.do_all(
        [AddComponent(entity, part) for entity, part in made if not world.has(entity, type(part))]
    )


def take(world: World, window: Window, entities: Sequence[int], kind: type[Component]) -> None:
    """Take a component from each of some entities that has it, or say why that cannot be."""
    if kind is Transform:
        window.notify("Every body has a position: delete the body instead", 6.0, failed=True)
        return
    if kind.__name__ == "Trail" and window.trails.on:
        window.notify("All that moves leaves a trail now: T turns that off")
        return
    window.edits.do_all(
        [RemoveComponent(entity, kind.__name__) for entity in entities if world.has(entity, kind)]
    )


def plain_kind(kind: type[Component]) -> str:
    """Return what a component is called; one without a plain name by the words of its class.

    >>> plain_kind(Spring), plain_kind(Transform)
    ('Spring', 'Place')
    """
    words = _PLAIN.get(kind.__name__, in_words(kind.__name__))
    return words[:1].upper() + words[1:]


def _meaning(kind: type[Component]) -> str:
    """Return what a component means; without plain words for it, the first sentence of its description."""
    described = (kind.__doc__ or "").strip().split("\n")[0].split(": ")[0].rstrip(".")
    return _MEANINGS.get(kind.__name__, described)


def makers(world: World, kind: type[Component]) -> Iterator[tuple[str, Callable[[int], Component]]]:
    """Yield (label, factory) pairs of a component; none if it cannot be created."""
    if kind is Shape:
        yield "Shape: circle", lambda entity: Shape.circle(_SIZE)
        yield "Shape: box", lambda entity: Shape.box(2.0 * _SIZE, 2.0 * _SIZE)
        yield "Shape: capsule", lambda entity: Shape.capsule(2.0 * _SIZE, _SIZE)
        yield "Shape: polygon", lambda entity: Shape.polygon(regular(3, 1.5 * _SIZE))
        return
    if kind is Spring:
        yield plain_kind(kind), lambda entity: _spring_above(world, entity)
        return
    if kind in (Pin, Slot, Weld):
        yield plain_kind(kind), lambda entity: kind(anchor_b=world.component(entity, Transform).position)
        return
    if kind in (Rod, Rope):
        yield plain_kind(kind), lambda entity: kind(anchor_b=_above(world, entity))
        return
    if kind in KINDS:  # which need two ends
        return
    given = {spec.name: _first(spec) for spec in kind.FIELDS if spec.default is REQUIRED}
    with contextlib.suppress(InvalidValue, TypeError):
        kind(**given)
        yield plain_kind(kind), lambda entity: kind(**given)


def _first(spec: Field) -> object:
    """Return a value that a field without default can hold."""
    if spec.kind == "choice":
        return spec.choices[0]
    if spec.kind in ("number", "whole"):
        value = min(max(1.0, spec.lowest), spec.highest)
        return round(value) if spec.kind == "whole" else value
    return {"vector": (0.0, 0.0), "flag": False, "text": ""}.get(spec.kind)


def _spring_above(world: World, entity: int) -> Spring:
    return Spring(anchor_b=_above(world, entity), rest_length=_ABOVE)


def _above(world: World, entity: int) -> Vector2:
    return world.component(entity, Transform).position + Vector2(0.0, _ABOVE)


_PLAIN: dict[str, str] = {
    "Transform": "place", "Velocity": "motion", "Material": "surface", "Drag": "air resistance",
}  # fmt: skip
"""Plainer names of components."""
_MEANINGS: dict[str, str] = {
    "Transform": "its position and angle",
    "Velocity": "it can move; without it, it is fixed",
    "Mass": "forces move it; without mass, a moving body is infinitely heavy",
    "Shape": "it can touch others",
    "Material": "its restitution and friction",
    "Colour": "it has a colour of its own",
    "Layer": "it touches some bodies and not others",
    "Charge": "it acts on other charges, and electric and magnetic fields on it",
    "Drag": "a medium slows it, as air does",
    "Medium": "it is filled with a fluid: bodies pass through, float and are slowed",
    "Spring": "it hangs from a point that can be dragged",
    "Rod": "a rod keeps its distance from a point above it",
    "Rope": "a rope holds it below a point, which may be slack",
    "Pin": "it turns about a fixed point",
    "Slot": "it slides along a fixed rail",
    "Weld": "it is fixed to the world",
    "Thrust": "it is pushed and turned from within, as by a rocket or a motor",
    "Molecule": "near ones attract each other, and repel each other when they are too near",
    "Strobe": "it leaves pictures of its past positions",
    "Trail": "its past path is shown",
}
"""Meanings of components for their body."""


# ---- names, and ends of springs ------------------------------------------------------------------------


def name_entity(world: World, window: Window, entity: int, name: str) -> None:
    """Give an entity a name; without one it is called by what it is."""
    if name:
        window.edits.do(AddComponent(entity, Name(name)))
    elif world.has(entity, Name):
        window.edits.do(RemoveComponent(entity, Name.__name__))


def set_end(
    world: World, window: Window, entity: int, kind: type[Component], field: str, end: int | None
) -> None:
    """Let a field name another entity; the point there of a spring or an instrument stays where it is."""
    if not world.has(entity, kind):
        window.notify(f"The {plain_kind(kind).lower()} is gone", 6.0, failed=True)
        return
    held = world.component(entity, kind)
    values = held.given() | {field: end}
    if isinstance(held, (Spring, *KINDS)):
        own = entity if world.has(entity, Transform) else None
        first = values["a"] or own
        if first == values["b"] or (first is None and isinstance(held, Spring)):
            words = f"a {plain_kind(kind).lower()} has two ends: two bodies, or a body and a fixed point"
            window.notify(words, 6.0, failed=True)
            return
        anchor = f"anchor_{field}"
        before = getattr(held, field) or (own if field == "a" else None)
        place = point_of(world, before, getattr(held, anchor))
        values[anchor] = local_point(world, end if field == "b" else end or own, place)
    elif (point := field.removesuffix("_body")) in getattr(kind, "POINTS", ()):
        values[point] = in_frame(world, end, point_of(world, getattr(held, field), getattr(held, point)))
    try:
        window.edits.do(AddComponent(entity, kind(**values)))
    except InvalidValue as error:
        window.notify(f"{field}: must be {error.allowed}", 6.0, failed=True)
