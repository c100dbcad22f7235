"""The bodies that are drawn, or put down by a click, and groups of them: walls, dominoes, poured discs."""

import math
from collections.abc import Sequence
from functools import partial
from itertools import pairwise

from physicslab import prefabs
from physicslab.components import Pin, Transform
from physicslab.ecs.vector import Vector2
from physicslab.view.controls import measure
from physicslab.view.controls.drawn import Drawn
from physicslab.view.controls.polygons import build_polygon, build_ramp
from physicslab.view.window.copying import MOST
from physicslab.view.window.edits import Recipe
from physicslab.world import World

_RADII = (0.22, 0.30, 0.18, 0.26, 0.34)
_SIZES = ((0.5, 0.5), (0.8, 0.4), (0.4, 0.7), (0.6, 0.6), (1.0, 0.3))
"""The sizes of what is made by a click, in turn [m]."""
_THICKNESS = 0.2
"""Thickness of planks and beams, and the radius of a bob [m]; a quarter of the length at most."""
_LINK = 0.2
"""About how long a link of a chain is [m]."""
_LINK_RADIUS = 0.05
"""Half of how thick it is [m]."""


type Places = Sequence[Vector2]
"""The points through which something is made [m]."""


def _size(length: float) -> float:
    """Return a length [m] without the rounding of the places between which it lies: .11, not .1100...01."""
    return float(f"{length:.12g}")


def _check_number(number: float, things: str) -> None:
    """Refuse more bodies than one drag makes: a way across a view of kilometres has room for millions."""
    if number > MOST:
        raise ValueError(f"room for {number:,.0f} {things}; at most {MOST:,} are made")


def _circle(world: World, places: Places, recipe: Recipe) -> None:
    radius = _size((places[1] - places[0]).magnitude)
    prefabs.circle(world, places[0], radius=radius, **recipe.body(math.pi * radius * radius))


def _box(world: World, places: Places, recipe: Recipe) -> None:
    way = places[1] - places[0]
    width, height = _size(abs(way.x)), _size(abs(way.y))
    options = recipe.body(width * height)
    options["angle"] = recipe.angle
    prefabs.box(world, places[0] + way * 0.5, width=width, height=height, **options)


def _capsule(world: World, places: Places, recipe: Recipe) -> None:
    way = places[1] - places[0]
    radius = min(0.15 * way.magnitude, _THICKNESS)
    length = way.magnitude - 2.0 * radius
    options = recipe.body(radius * (2.0 * length + math.pi * radius))
    options["angle"] = _along(way)
    prefabs.capsule(world, places[0] + way * 0.5, length=length, radius=radius, **options)


def _bar(world: World, places: Places, recipe: Recipe, *, static: bool) -> None:
    way = places[1] - places[0]
    length = _size(way.magnitude)
    height = min(_THICKNESS, 0.25 * length)
    options = recipe.body(length * height)
    options["angle"], options["static"] = _along(way), static
    if static and not recipe.material:
        options["friction"] = 0.6
    prefabs.box(world, places[0] + way * 0.5, width=length, height=height, **options)


def _along(way: Vector2) -> float:
    """Return the angle of a bar along a way [rad], no matter in which direction it was drawn."""
    return math.remainder(way.angle, math.pi)


def _pendulum(world: World, places: Places, recipe: Recipe) -> None:
    way = places[1] - places[0]
    length, angle = way.magnitude, math.remainder(way.angle + 0.5 * math.pi, 2.0 * math.pi)
    radius = min(_THICKNESS, 0.25 * length)
    prefabs.pendulum(world, places[0], length=length, angle=angle, radius=radius)


def _chain(world: World, places: Places, recipe: Recipe) -> None:
    """Make as many links as fit, pinned to each other, the first one to the world."""
    way = places[1] - places[0]
    count = max(round(way.magnitude / _LINK), 1)
    _check_number(count, "links")
    link, radius = way / count, min(_LINK_RADIUS, 0.25 * way.magnitude / count)
    options = recipe.body(radius * (2.0 * link.magnitude + math.pi * radius))
    before, held = None, places[0]
    for n in range(count):
        one = prefabs.capsule(
            world, places[0] + link * (n + 0.5), length=link.magnitude, radius=radius,
            **(options | {"angle": way.angle}),
        )  # fmt: skip
        end = Vector2(0.5 * link.magnitude, 0.0)
        world.spawn(Pin(before, one, anchor_a=held, anchor_b=-end))
        before, held = one, end


CIRCLE = Drawn(
    "circle", "Circle", "drag from its middle, or click", build=_circle, measure=measure.RADIUS,
    ways=tuple(Vector2(radius, 0.0) for radius in _RADII), per_size=Vector2(1.0, 0.0), by_recipe=True,
)  # fmt: skip
BOX = Drawn(
    "box", "Box", "drag from corner to corner, or click", build=_box, measure=measure.CORNERS,
    ways=tuple(Vector2(*size) for size in _SIZES), per_size=Vector2(2.0, 2.0), is_centred=True,
    by_recipe=True,
)  # fmt: skip
PENDULUM = Drawn(
    "pendulum", "Pendulum", "drag from its pin to its bob, or click", build=_pendulum,
    measure=measure.HANGING, ways=(Vector2(0.0, -1.5).rotated(0.7),),
)  # fmt: skip
BODIES = (
    CIRCLE,
    BOX,
    Drawn("block", "Plank", "drag along it, or click; it is fixed", build=partial(_bar, static=True),
          ways=(Vector2(2.0, 0.0),), is_centred=True, by_recipe=True, is_fixed=True),
    Drawn("beam", "Beam", "drag along it, or click; it moves", build=partial(_bar, static=False),
          ways=(Vector2(2.0, 0.0),), is_centred=True, by_recipe=True),
    Drawn("capsule", "Capsule", "drag from end to end, or click", build=_capsule,
          ways=tuple(Vector2(size[0] + size[1], 0.0) for size in _SIZES), per_size=Vector2(3.0, 0.0),
          is_centred=True, by_recipe=True),
    Drawn("polygon", "Polygon", "click its corners, first or last again to close it; or draw around it", 0,
          build=build_polygon, by_recipe=True,
          prompts=("Click a corner, or draw around it", "Click the next corner", "Click the next corner",
                   "... the first one or Enter closes it")),
    Drawn("ramp", "Ramp", "drag from its foot to its top, or click; it is fixed", build=build_ramp,
          ways=(Vector2(2.0, 0.8),), by_recipe=True, stands=True, is_fixed=True),
    PENDULUM,
    Drawn("chain", "Chain", "drag from its upper end to its lower one, or click", build=_chain,
          ways=(Vector2(1.2, -1.2),), by_recipe=True),
)  # fmt: skip
"""Bodies, in the order of the tools."""

_DENSITY = 5.0
"""Mass of groups of bodies per area [kg/m^2]."""
_DOMINO = (0.08, 0.5)
"""Width and height of a domino [m]."""
_JOINT = 1e-3
"""Left between the bricks of a row [m]."""


def _still(recipe: Recipe, area: float) -> prefabs.BodyOptions:
    """Return the options of what is to stand: it does not bounce, unless its material was chosen."""
    options = recipe.body(area)
    if not recipe.material:
        options["restitution"] = 0.0
    return options


def _wall(world: World, places: Places, recipe: Recipe) -> None:
    """Make rows of bricks between two corners; in every second row they lie over the joints of the first."""
    width, height = measure.BRICK
    way = places[1] - places[0]
    columns, rows = (round(number) for number in measure.WALL.numbers(way))
    _check_number(columns * rows, "bricks")
    left, low = min(places[0].x, places[1].x), min(places[0].y, places[1].y)
    for row in range(rows):
        whole = [float(n) for n in range(columns + 1)]
        edges = [0.0, *(n + 0.5 for n in range(columns)), whole[-1]] if row % 2 else whole
        for begin, end in pairwise(edges):
            size = (end - begin) * width - _JOINT
            middle = Vector2(left + 0.5 * (begin + end) * width, low + (row + 0.5) * height)
            prefabs.box(world, middle, width=size, height=height, **_still(recipe, size * height))


def _dominoes(world: World, places: Places, recipe: Recipe) -> None:
    """Make dominoes that stand along a line, from the foot of the first one."""
    width, height = _DOMINO
    way = places[1] - places[0]
    (count,) = measure.DOMINOES.numbers(way)
    _check_number(count, "dominoes")
    along = way.normalized if way else Vector2(1.0, 0.0)
    up = Vector2(-along.y, along.x) if along.x >= 0.0 else Vector2(along.y, -along.x)
    for n in range(round(count)):
        options = _still(recipe, width * height)
        options["angle"] = up.angle - 0.5 * math.pi
        middle = places[0] + along * (n * measure.DOMINO_SPACING) + up * (0.5 * height)
        prefabs.box(world, middle, width=width, height=height, **options)


def _discs(world: World, places: Places, recipe: Recipe) -> None:
    for place in places:
        prefabs.circle(world, place, radius=recipe.grain, **recipe.body(math.pi * recipe.grain**2))


def _stack(world: World, places: Places, recipe: Recipe) -> None:
    prefabs.stack(world, 5, places[0], width=0.5, height=0.4, mass=_DENSITY * 0.2)


def _pyramid(world: World, places: Places, recipe: Recipe) -> None:
    prefabs.pyramid(world, 5, places[0], size=0.4, gap=0.04, mass=_DENSITY * 0.16)


def _heap(world: World, places: Places, recipe: Recipe) -> None:
    prefabs.pile(world, 24, places[0], columns=6, radius=0.12, density=_DENSITY)


def _pit(world: World, places: Places, recipe: Recipe) -> None:
    prefabs.container(world, places[0], width=2.4, height=1.2, thickness=0.15)


def _binary(world: World, places: Places, recipe: Recipe) -> None:
    for planet in prefabs.binary(world, (20.0, 10.0), separation=1.6):
        transform = world.component(planet, Transform)
        transform.position = transform.position + places[0]


GROUPS = (
    Drawn("brush", "Pour discs", "hold the button and move; type a number for so many", 1, build=_discs,
          pours=True, by_recipe=True, prompts=("Hold to pour",)),
    Drawn("wall", "Wall", "drag from corner to corner, or click; type 10 x 6 for so many bricks",
          build=_wall, measure=measure.WALL, ways=(Vector2(6 * measure.BRICK[0], 4 * measure.BRICK[1]),),
          by_recipe=True, stands=True),
    Drawn("dominoes", "Dominoes", "drag along the floor, or click; type 40 for so many", build=_dominoes,
          measure=measure.DOMINOES, ways=(Vector2(9 * measure.DOMINO_SPACING, 0.0),), by_recipe=True,
          stands=True),
    Drawn("stack", "Stack", "click at its foot", 1, build=_stack, stands=True),
    Drawn("pyramid", "Pyramid", "click at its foot", 1, build=_pyramid, stands=True),
    Drawn("heap", "Heap of discs", "click where it is to fall", 1, build=_heap),
    Drawn("pit", "Open box", "click at the middle of its floor", 1, build=_pit, stands=True),
    Drawn("binary", "Planets", "click at the centre of their orbit", 1, build=_binary,
          remark="These two circle each other in planet mode: O turns it on"),
)  # fmt: skip
"""Groups of bodies."""
