"""Scenes drawn at random, over families and features: cliffs are where no scene was put by hand.

A scene is made of two numbers, a seed and its place in the series, and is the same wherever it is drawn.
"""

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from physicslab.components import Drag, Mass, Pin, Shape, Spring, Transform, Velocity
from physicslab.components.vertices import regular
from physicslab.ecs.vector import Vector2
from physicslab.lab.bench.scene import BenchScene, energy_gained, largest_overlap, stretched
from physicslab.lab.worlds import GRAVITY, floor, soft_space
from physicslab.prefabs import BodyOptions, box, container
from physicslab.prefabs.body import body
from physicslab.world import World

_LARGEST = 0.4
"""Size of the largest body [m]."""
_COUNTS = 10, 10_000
_MASS_RATIO = 1_000.0
"""Most that the heaviest body may weigh of the lightest."""
_SHARE_WITH_SPRINGS, _SHARE_WITH_DRAG, _SHARE_WITH_MOVERS = 0.15, 0.12, 0.15
_SHARE_WITH_ARMS = 0.3
"""Scenes with springs in which these hold bodies beside their middles."""
_SHARE_FLYING = {"cloud": 0.7, "walls": 0.5}
"""Scenes of a family without gravity."""
_OVERLAP = 0.25
"""Deepest overlap that counts as right, as a share of the largest body's size."""
_STRETCH = 0.05
"""Largest error of a joint that counts as right, as a share of the same."""
_GAIN = 0.05
"""Largest rise of the energy that counts as right, as a share of the largest kinetic energy."""
_SHAPES = ("discs", "boxes", "polygons", "capsules", "mixed")


@dataclass(frozen=True, slots=True)
class Drawn:
    """Properties of a random scene.

    Attributes
    ----------
    random : numpy.random.Generator
        Generator of places and sizes of its bodies.
    family, shapes : str
        How its bodies are placed, and what they are.
    count : int
        About how many move.
    sizes, masses : float
        How many times as large, and as heavy, the largest may be as the smallest.
    restitution, friction : float
        Coefficients of all bodies.
    springs : str
        ``""``, ``"springs"`` or ``"dampers"``.
    arms, drag, mover, gravity : bool
        Whether springs hold bodies beside their middles, air slows some bodies, something driven turns among
        them, they fall.
    """

    random: np.random.Generator
    family: str
    shapes: str
    count: int
    sizes: float
    masses: float
    restitution: float
    friction: float
    springs: str
    arms: bool
    drag: bool
    mover: bool
    gravity: bool

    @property
    def features(self) -> list[str]:
        """Properties that scenes can have in common, in words."""
        named = {
            self.shapes: True, "sizes > 3": self.sizes > 3.0, "masses > 10": self.masses > 10.0,
            "bouncing": self.restitution > 0.0, self.springs: bool(self.springs), "arms": self.arms,
            "drag": self.drag,
            "mover": self.mover, "no gravity": not self.gravity, "up to 100 bodies": self.count <= 100,
            "above 2,000 bodies": self.count > 2_000,
        }  # fmt: skip
        return [name for name, has in named.items() if has]

    def uniform(self, low: float, high: float) -> float:
        """Return a number between two."""
        return float(self.random.uniform(low, high))

    def chance(self, share: float) -> bool:
        """Return true in a share of calls."""
        return bool(self.random.random() < share)


def _log_uniform(random: np.random.Generator, low: float, high: float) -> float:
    return math.exp(float(random.uniform(math.log(low), math.log(high))))


def _drawn(seed: int, number: int) -> Drawn:
    """Return what a scene of a series has."""
    random = np.random.default_rng((seed, number))
    family = str(random.choice(list(_FAMILIES)))
    sizes = _log_uniform(random, 1.0, 30.0) if random.random() < 0.5 else 1.0
    masses = _log_uniform(random, 1.0, _MASS_RATIO) if random.random() < 0.3 else 1.0
    springs = str(random.choice(("springs", "dampers"))) if random.random() < _SHARE_WITH_SPRINGS else ""
    if family == "net" and not springs:
        springs = str(random.choice(("springs", "dampers")))
    return Drawn(
        random, family, str(random.choice(_SHAPES)), round(_log_uniform(random, *_COUNTS)), sizes,
        min(_MASS_RATIO, max(masses, sizes**2)),
        float(random.uniform()) if random.random() < 0.5 else 0.0, float(random.uniform()), springs,
        arms=bool(springs) and bool(random.random() < _SHARE_WITH_ARMS),
        drag=bool(random.random() < _SHARE_WITH_DRAG), mover=bool(random.random() < _SHARE_WITH_MOVERS),
        gravity=bool(random.random() >= _SHARE_FLYING.get(family, 0.0)),
    )  # fmt: skip


# ---- bodies ------------------------------------------------------------------------------------------------


def _spawn(
    world: World, drawn: Drawn, place: Vector2, size: float, velocity: tuple[float, float] = (0.0, 0.0),
    upright: bool = False,
) -> int:  # fmt: skip
    """Spawn one body within a circle of a diameter [m], of 4 kg/m^2 or more of that square."""
    shape, lies = _shape(drawn, size), 0.0 if upright else drawn.uniform(0.0, 2.0 * math.pi)
    dense = max(1.0, drawn.masses / drawn.sizes**2)
    mass = 4.0 * size**2 * _log_uniform(drawn.random, 1.0, dense)
    options = BodyOptions(
        mass=mass, angle=lies, velocity=velocity, restitution=drawn.restitution, friction=drawn.friction
    )  # fmt: skip
    made = body(world, shape, place, **options)
    if drawn.drag and drawn.chance(0.5):
        world.add(made, Drag(linear=drawn.uniform(0.1, 2.0) * mass))
    return made


def _shape(drawn: Drawn, size: float) -> Shape:
    kind = drawn.shapes if drawn.shapes != "mixed" else _SHAPES[int(drawn.random.integers(4))]
    if kind == "discs":
        return Shape.circle(0.5 * size)
    if kind == "boxes":
        return Shape.box(0.8 * size, drawn.uniform(0.3, 0.6) * size)
    if kind == "capsules":
        return Shape.capsule(0.5 * size, 0.2 * size)
    return Shape.polygon(regular(int(drawn.random.integers(3, 9)), 0.5 * size))


def _size(drawn: Drawn) -> float:
    return _LARGEST / _log_uniform(drawn.random, 1.0, drawn.sizes)


def _shelves(
    drawn: Drawn, foot: Vector2, width: float, count: int, loose: float = 1.05
) -> Iterator[tuple[Vector2, float]]:
    """Yield places and sizes of bodies in rows above ``foot``, none of which overlaps another."""
    x, y, row = -0.5 * width, 0.0, 0.0
    for _ in range(count):
        size = loose * _size(drawn)
        if x + size > 0.5 * width:
            x, y, row = -0.5 * width, y + row, 0.0
        yield foot + Vector2(x + 0.5 * size, y + 0.5 * size), size / loose
        x, row = x + size, max(row, size)


def _room(drawn: Drawn, count: int) -> float:
    """Return the width of a square that so many bodies fill [m]."""
    mean = _LARGEST if drawn.sizes < 1.01 else _LARGEST * (1.0 - 1.0 / drawn.sizes) / math.log(drawn.sizes)
    return max(4.0 * _LARGEST, 1.3 * mean * math.sqrt(count))


def _tie(world: World, drawn: Drawn, a: int, b: int | None, anchor: Vector2 = Vector2()) -> None:
    """Join two bodies, or one and a point [m], by a spring of omega dt = 0.1 to 1."""
    mass = world.component(a, Mass).mass
    first = world.component(a, Transform).position
    second = anchor if b is None else world.component(b, Transform).position
    rate = _log_uniform(drawn.random, 6.0, 60.0)
    damping = mass * rate * _log_uniform(drawn.random, 0.02, 1.0) if drawn.springs == "dampers" else 0.0
    arm = Vector2(0.2 * _LARGEST / drawn.sizes, 0.0) if drawn.arms else Vector2()
    length, stiffness = abs(second - first), mass * rate**2
    world.spawn(Spring(a, b, arm, anchor, rest_length=length, stiffness=stiffness, damping=damping))


def _paddle(world: World, at: Vector2, length: float) -> None:
    """Spawn a driven bar that turns."""
    world.spawn(Transform(at), Velocity((0.0, 0.0), 1.5), Shape.box(length, 0.2))


# ---- families ----------------------------------------------------------------------------------------------


def _heap(world: World, drawn: Drawn, foot: Vector2, count: int) -> list[int]:
    width = _room(drawn, count)
    container(world, foot, width=width, height=3.0 * width, friction=drawn.friction)
    low = 0.5 * width if drawn.mover else 0.0
    if drawn.mover:
        _paddle(world, foot + Vector2(0.0, 0.5 * low), 0.8 * low)
    return [
        _spawn(world, drawn, place, size)
        for place, size in _shelves(drawn, foot + Vector2(0.0, low), width - _LARGEST, count)
    ]


def _towers(world: World, drawn: Drawn, foot: Vector2, count: int) -> list[int]:
    """Boxes one on the other, and discs that fly at them."""
    height = int(drawn.random.integers(3, 20))
    towers = max(1, count // height)
    pitch, made = drawn.uniform(1.1, 6.0) * _LARGEST, []
    floor(world, foot, width=pitch * towers + 100.0)
    flat = replace(drawn, shapes="boxes")
    for n in range(towers):
        at = foot + Vector2((n - 0.5 * towers) * pitch, 0.0)
        for _ in range(height):
            made.append(_spawn(world, flat, at, _size(drawn), upright=True))
            half = 0.5 * world.component(made[-1], Shape).height
            world.component(made[-1], Transform).position = at + Vector2(0.0, half)
            at = at + Vector2(0.0, 2.0 * half)
    for n in range(max(1, towers // 8)):
        start = foot + Vector2(-(0.5 * towers + 2.0) * pitch - n * 3.0, drawn.uniform(0.3, 2.0) + 0.5)
        made.append(_spawn(world, drawn, start, _LARGEST, (drawn.uniform(5.0, 20.0), 0.0)))
    return made


def _stream(world: World, drawn: Drawn, foot: Vector2, count: int) -> list[int]:
    """Bodies that slide and fall from board to board into a trough."""
    width = 0.6 * _room(drawn, count)
    reach = 2.0 * width + 4.0
    container(world, foot + Vector2(0.0, -0.9 * reach), width=2.0 * reach, height=reach)
    for n in range(2):
        side = 1.0 if n else -1.0
        board = foot + Vector2(0.35 * reach * side, -0.45 * reach * n)
        box(world, board, width=reach, height=0.3, angle=0.4 * side, static=True, friction=drawn.friction)
    if drawn.mover:
        _paddle(world, foot + Vector2(0.0, -0.6 * reach), 0.2 * reach)
    above = foot + Vector2(-0.35 * reach, 0.25 * reach + 0.5)
    return [_spawn(world, drawn, place, size) for place, size in _shelves(drawn, above, width, count)]


def _cloud(world: World, drawn: Drawn, foot: Vector2, count: int) -> list[int]:
    """Bodies that fly about in a box."""
    loose = drawn.uniform(1.3, 3.0)
    width = loose * _room(drawn, count)
    container(world, foot, width=width + _LARGEST, height=width + 2.0, restitution=drawn.restitution)
    lid = foot + Vector2(0.0, width + 2.5)
    box(world, lid, width=width + 3.0, height=1.0, static=True, restitution=drawn.restitution)
    if drawn.mover:
        _paddle(world, foot + Vector2(0.0, width + 1.2), 0.5)
    speed = _log_uniform(drawn.random, 0.3, 10.0)
    return [
        _spawn(world, drawn, place, size, tuple(drawn.random.normal(0.0, speed, 2).tolist()))
        for place, size in _shelves(drawn, foot + Vector2(0.0, 0.2), width, count, loose)
    ]


def _net(world: World, drawn: Drawn, foot: Vector2, count: int) -> list[int]:
    """Discs on springs, hung up by its sides, under a load."""
    loads = max(1, count // 5)
    columns = max(3, round(math.sqrt(2.0 * (count - loads))))
    rows, pitch = max(2, (count - loads) // columns), 1.05 * _LARGEST
    discs = replace(drawn, shapes="discs", sizes=1.0)
    grid = [
        [_spawn(world, discs, foot + Vector2((i - 0.5 * columns) * pitch, j * pitch), _LARGEST)
         for i in range(columns)] for j in range(rows)
    ]  # fmt: skip
    for row in grid:
        for a, b in itertools.pairwise(row):
            _tie(world, drawn, a, b)
        for end, aside in ((row[0], -1.0), (row[-1], 1.0)):
            _tie(world, drawn, end, None, world.component(end, Transform).position + Vector2(aside, 0.5))
    for below, above in itertools.pairwise(grid):
        for a, b in zip(below, above, strict=True):
            _tie(world, drawn, a, b)
    top = foot + Vector2(0.0, (rows + 0.5) * pitch)
    load = [_spawn(world, drawn, *at) for at in _shelves(drawn, top, 0.8 * columns * pitch, loads)]
    return [*(disc for row in grid for disc in row), *load]


def _mechanism(world: World, drawn: Drawn, foot: Vector2, count: int) -> list[int]:
    """Chains on pins that hang side by side, and bodies that fall among them."""
    links = int(drawn.random.integers(2, 12))
    chains = max(1, count // (2 * links))
    pitch, long, made = 2.5 * _LARGEST, 0.8 * _LARGEST, []
    width = pitch * chains + 2.0
    container(world, foot, width=width, height=(links + 10.0) * long)
    for n in range(chains):
        hook, before = foot + Vector2((n - 0.5 * (chains - 1)) * pitch, (links + 4.0) * long), None
        for k in range(links):
            at = hook + Vector2(0.0, -(k + 0.5) * long)
            link = box(world, at, width=0.1, height=0.9 * long, mass=0.1, friction=drawn.friction)
            world.spawn(Pin(before, link, hook if before is None else (0.0, -0.5 * long), (0.0, 0.5 * long)))
            made.append(link)
            before = link
    fall = foot + Vector2(0.0, (links + 5.0) * long)
    rest = count - len(made)
    return made + [_spawn(world, drawn, *at) for at in _shelves(drawn, fall, width - 1.0, rest)]


def _islands(world: World, drawn: Drawn, foot: Vector2, count: int) -> list[int]:
    """Small heaps, far from each other."""
    heaps = max(2, round(_log_uniform(drawn.random, 2.0, max(3.0, count / 5.0))))
    each = max(1, count // heaps)
    far = 4.0 * _room(drawn, each) + 10.0
    return [made for n in range(heaps) for made in _heap(world, drawn, foot + Vector2(far * n, 0.0), each)]


def _walls(world: World, drawn: Drawn, foot: Vector2, count: int) -> list[int]:
    """Two blocks of bodies that meet."""
    width, speed, made = _room(drawn, count // 2), drawn.uniform(1.0, 10.0), []
    if drawn.gravity:
        floor(world, foot, width=20.0 * width + 200.0, friction=drawn.friction)
    for side in (-1.0, 1.0):
        at = foot + Vector2(side * (0.6 * width + 0.2), 0.0)
        for place, size in _shelves(drawn, at, width, count // 2):
            made.append(_spawn(world, drawn, place, size, (-side * speed, 0.0), upright=True))
    return made


_FAMILIES: dict[str, Callable[[World, Drawn, Vector2, int], list[int]]] = {
    "heap": _heap, "towers": _towers, "stream": _stream, "cloud": _cloud, "net": _net,
    "mechanism": _mechanism, "islands": _islands, "walls": _walls,
}  # fmt: skip
"""How bodies are placed, by name: each returns those that move, above a point."""


def _build(seed: int, number: int) -> World:
    """Return the world of a scene of a series."""
    drawn = _drawn(seed, number)
    world = soft_space(gravity=GRAVITY if drawn.gravity else None)
    made = _FAMILIES[drawn.family](world, drawn, Vector2(), drawn.count)
    if drawn.springs and drawn.family != "net":
        for a, b in zip(made[::4], made[1::4], strict=False):
            _tie(world, drawn, a, b)
    return world


def random_scene(seed: int, number: int) -> tuple[BenchScene, list[str]]:
    """Return a scene of the series of a seed, and its features."""
    drawn = _drawn(seed, number)
    kept = () if drawn.mover else (energy_gained(_GAIN),)  # movers do work
    return BenchScene(
        name=f"{seed}:{number}", title=f"{drawn.family} of about {drawn.count:,}", group=drawn.family,
        size=drawn.count, build=partial(_build, seed, number), seconds=0.0,
        quality=(largest_overlap(_OVERLAP * _LARGEST), stretched(_STRETCH * _LARGEST), *kept),
    ), drawn.features  # fmt: skip
