"""Materials of bodies by name: density, surface and colour are chosen with it, as one edit."""

from collections.abc import Sequence

from physicslab.components import Colour, Layer, MadeOf, Mass, Material, Shape
from physicslab.components.made_of import SUBSTANCES
from physicslab.ecs.component import Component
from physicslab.history import AddComponent, Command, SetField
from physicslab.view.window.changing import take
from physicslab.view.window.placing import area_of
from physicslab.view.window.window import Window
from physicslab.world import World

OWN, UNSPECIFIED = "my material", "unspecified"
"""The name of a material of one's own, until it has another; the word where a body is made of none."""


def materials(world: World) -> dict[str | None, str]:
    """Return what bodies can be made of, with words for each: the table, names of this scene, one's own."""
    batch = world.batch(MadeOf)
    own = {world.component(entity, MadeOf).material for entity in batch.entities.tolist()} - SUBSTANCES.keys()
    return {name: name for name in [*SUBSTANCES, *sorted(own | {OWN})]} | {None: UNSPECIFIED}


def made_of(world: World, entity: int) -> str | None:
    """Return what a body is made of, if that is said."""
    return world.component(entity, MadeOf).material if world.has(entity, MadeOf) else None


def choose_material(world: World, window: Window, entities: Sequence[int], name: str) -> None:
    """Let bodies be made of something: one edit of mass, restitution, friction and colour.

    A name of one's own has what the first body has that is made of it; the first of all keeps what it has.
    """
    commands: list[Command] = []
    for entity in entities:
        if not world.has(entity, Shape):
            continue
        commands += [AddComponent(entity, part) for part in _surface(world, name)]
        density, area = _areal_density(world, name), area_of(world, entity)
        if density and area and world.has(entity, Mass):
            commands.append(SetField(entity, "Mass", "mass", density * area))
        commands.append(AddComponent(entity, MadeOf(name)))
    window.edits.do_all(commands, f"made of {name}")


def _model(world: World, name: str) -> int | None:
    """Return the first body that is made of something."""
    entities = world.batch(MadeOf).entities.tolist()
    return next((one for one in entities if world.component(one, MadeOf).material == name), None)


def _surface(world: World, name: str) -> list[Component]:
    known = SUBSTANCES.get(name)
    if known is not None:
        return [Material(known.restitution, known.friction), Colour(known.colour)]
    model = _model(world, name)
    if model is None:
        return []
    return [world.component(model, kind) for kind in (Material, Colour) if world.has(model, kind)]


def _areal_density(world: World, name: str) -> float:
    """Return the mass of a square metre [kg/m^2]; 0 where it is not known."""
    known = SUBSTANCES.get(name)
    if known is not None:
        return known.areal_density
    model = _model(world, name)
    if model is None or not world.has(model, Mass) or not area_of(world, model):
        return 0.0
    return world.component(model, Mass).mass / area_of(world, model)


def choose_colour(world: World, window: Window, entities: Sequence[int], colour: str | None) -> None:
    """Give bodies a colour "#rrggbb", or that of their numbers again for ``None``."""
    _choose(world, window, entities, None if colour is None else Colour(colour), Colour)


def choose_layer(world: World, window: Window, entities: Sequence[int], layer: Layer | None) -> None:
    """Put bodies into a layer, or into none for ``None``."""
    _choose(world, window, entities, layer, Layer)


def _choose(
    world: World, window: Window, entities: Sequence[int], part: Component | None, kind: type[Component]
) -> None:
    if part is None:
        take(world, window, entities, kind)
    else:
        window.edits.do_all([AddComponent(entity, part) for entity in entities])
