"""Bodies that touch: towers that stand, crowds on one spot, boxes that spin, discs below a piston."""

from collections.abc import Callable
from functools import cache, partial

import numpy as np

from physicslab.components import Material, Shape, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import MODELS, StabilityCase, part_of, touching_space
from physicslab.lab.worlds import displacements, energy_growth, floor, largest, open_space, place
from physicslab.prefabs import box, circle, pyramid, stack
from physicslab.world import World

_CROWD_RADIUS = 0.1
_SPIN = 1e4
_DISCS, _RADIUS = 20, 0.25


def _crowd(count: int) -> World:
    """Return a world of discs whose centres coincide; nothing pulls at them."""
    world = open_space(gravity=None)
    for _ in range(count):
        circle(world, (0.0, 0.0), radius=_CROWD_RADIUS)
    return world


def _fastest(world: World) -> float:
    linear = world.table(Velocity)["linear"]
    return float(np.hypot(linear[:, 0], linear[:, 1]).max())


@cache  # two cases look at one run
def _parting(count: int, steps: int) -> tuple[float, float]:
    """Return how fast the fastest disc is on the way [m/s], and the overlap at the end, of a radius."""
    world = _crowd(count)
    fastest = largest(world, steps, lambda: _fastest(world))
    return fastest, world.contacts.max_penetration / _CROWD_RADIUS


def _difference(count: int, steps: int) -> float:
    """Return how far apart two runs end."""
    worlds = [_crowd(count), _crowd(count)]
    for world in worlds:
        world.run(steps=steps)
    one, other = (world.table(Transform)["position"] for world in worlds)
    return float(np.abs(one - other).max())


def _spinning(contacts: str, e: float) -> tuple[World, int]:
    """Return a box of 50 cm that flies at a wall at 5 m/s while it spins, and the box."""
    world = touching_space(contacts=contacts, gravity=None)
    box(world, (2.0, 0.0), width=1, height=20, static=True, restitution=e, friction=0.5)
    return world, box(world, (0.0, 0.0), velocity=(5, 0), angular_velocity=_SPIN, restitution=e, friction=0.5)


def _spin_growth(contacts: str, e: float) -> float:
    world, _ = _spinning(contacts, e)
    return energy_growth(world, 60)


def _spin_through(contacts: str, e: float) -> float:
    """Return whether the box is ever behind the wall's face: 0 or 1."""
    world, spinning = _spinning(contacts, e)
    return float(any(place(world, spinning).x > 1.5 for _ in world.stepping(steps=60)))


@cache  # two cases look at one run
def _squeezed(contacts: str, speed: float) -> tuple[float, float]:
    """Return how many discs leave a cylinder, and how fast the fastest is, in speeds of the piston.

    The piston ends where half of the room is left that discs of their area need.
    """
    world, pitch = touching_space(contacts=contacts, gravity=None), 2.2 * _RADIUS
    width, height = 5 * pitch, 4 * pitch
    for x in (-0.5, width + 0.5):
        box(world, (x, 0.0), width=1, height=10 * height, static=True, friction=0.3)
    box(world, (0.5 * width, -0.5), width=width + 2, height=1, static=True, friction=0.3)
    discs = [
        circle(world, (pitch * (i % 5 + 0.5), pitch * (i // 5 + 0.5)), radius=_RADIUS, friction=0.3)
        for i in range(_DISCS)
    ]
    plate = Shape.box(width, 1.0), Material(0.0, 0.3)  # without a mass nothing holds it up
    piston = world.spawn(Transform((0.5 * width, height + 0.5)), Velocity((0.0, -speed)), *plate)
    end = 0.5 * _DISCS * np.pi * _RADIUS**2 / width
    seconds = (height - end) / speed
    fastest, outside = 0.0, 0.0
    rows = [world.component(disc, Transform) for disc in discs]
    for done in world.stepping(steps=max(1, round(60.0 * (seconds + 1.0)))):
        if done / 60.0 >= seconds:
            world.component(piston, Velocity).linear = (0.0, 0.0)
        top = place(world, piston).y - 0.5
        fastest = max(fastest, _fastest(world) / speed)
        out = [not (0.0 < row.position.x < width and 0.0 < row.position.y < top) for row in rows]
        outside = max(outside, float(sum(out)))
    return outside, fastest


_crowds = partial(StabilityCase, group="crowds")


def _apart(count: int, steps: int, long_s: float = 0.0) -> tuple[StabilityCase, ...]:
    title = f"{count:,} discs of 0.1 m on one spot"
    return (
        _crowds(
            name=f"crowd_{count}_speed", title=title, figure="fastest disc", unit="m/s", limit=2.0,
            right="they come apart slowly: coming apart makes no energy to speak of", long_s=long_s,
            measure=partial(part_of, 0, _parting, count, steps),
        ),
        _crowds(
            name=f"crowd_{count}_apart", title=f"{title}, after {steps} steps", limit=0.2, long_s=long_s,
            right="they are apart, to a tenth of their size", figure="deepest overlap, of a radius",
            measure=partial(part_of, 1, _parting, count, steps),
        ),
    )  # fmt: skip


SQUEEZED = (
    _crowds(
        name="coincident_centres", title="two discs on one spot", figure="overlap after 2 s, of a radius",
        right="they come apart, to a tenth of their size", limit=0.2,
        measure=partial(part_of, 1, _parting, 2, 120),
    ),
    *_apart(1_000, 300),
    _crowds(
        name="crowd_1000_same", title="1,000 discs on one spot, twice", figure="difference of two runs",
        unit="m", right="they go the same ways: no normal is left to chance", limit=0.0,
        measure=partial(_difference, 1_000, 6),
    ),
    *_apart(5_000, 900, long_s=60.0),
    *(
        StabilityCase(
            name=f"spin_1e4_e{e:g}_{kind}_{contacts}", group="spins",
            title=f"a box that spins at 1e4 rad/s against a wall, e = {e:g}, {model}, 1 s",
            right=right, figure=figure, limit=limit, measure=partial(measure, contacts, e),
        )
        for e in (0.0, 0.5, 1.0)
        for contacts, model in MODELS.items()
        for kind, right, figure, limit, measure in (
            ("energy", "energy never grows", "growth, of that at the start", 1e-9, _spin_growth),
            ("through", "it does not pass through", "whether it is behind the face", 0.0, _spin_through),
        )
    ),
    *(
        StabilityCase(
            name=f"piston_{speed:g}_{kind}_{contacts}", group="pistons",
            title=f"a piston of {speed:g} m/s presses 20 discs into half of their own area, {model}",
            right=right, figure=figure, limit=limit, measure=partial(part_of, n, _squeezed, contacts, speed),
        )
        for speed in (0.2, 2.0, 20.0)
        for contacts, model in MODELS.items()
        for n, kind, right, figure, limit in (
            (0, "outside", "none leaves the cylinder", "discs outside", 0.0),
            (1, "speed", "none is flung aside at twice its speed", "fastest, of the piston", 2.0),
        )
    ),
)  # fmt: skip


type _Fill = Callable[[World], list[int]]

_TOWERS = ((10, 0.1), (10, 0.05), (10, 0.02), (5, 0.01), (15, 0.15), (7, 0.02))
"""How many cubes, and their size [m]."""
_TOWER_S, _ROD_S = 60.0, 10.0
_ROD, _THICK = 2.0, 0.002
WANTED = {"soft": 0.1, "rigid": 1e-6}
"""Largest distance of a cube from its place, of its size."""


def _moved(fill: _Fill, seconds: float = 10.0) -> list[Vector2]:
    world = open_space(gravity=10.0, contacts="soft")
    floor(world)
    return displacements(world, fill(world), lambda: world.run(seconds=seconds))


def _top(world: World, *, boxes: int, top: float) -> list[int]:
    """Spawn a tower of boxes of 1 m, the highest of another mass."""
    return [
        *stack(world, boxes),
        box(world, (0.0, boxes + 0.5), width=1.0, height=1.0, mass=top, friction=0.6),
    ]


def _off(fill: _Fill) -> float:
    return max(moved.magnitude for moved in _moved(fill))


def _sink(fill: _Fill) -> float:
    return max(-moved.y for moved in _moved(fill))


def _sideways(fill: _Fill, seconds: float) -> float:
    return max(abs(moved.x) for moved in _moved(fill, seconds))


def _share_off(contacts: str, count: int, width: float, height: float, seconds: float) -> float:
    """Return how far the body of a tower that moved most is from its place, in heights of one."""
    world = touching_space(contacts=contacts)
    floor(world)
    bodies = stack(world, count, width=width, height=height)
    moved = displacements(world, bodies, lambda: world.run(seconds=seconds))
    return max(way.magnitude for way in moved) / height


def _swaying(count: int) -> float:
    """Return the largest speed of a pushed tower in its 20th second, as a share of that in its 3rd."""
    world = open_space(gravity=9.81, contacts="soft")
    floor(world)
    for i, one in enumerate(stack(world, count, width=0.32, height=0.2)):
        world.component(one, Velocity).linear = (0.02 * (i / count) ** 2, 0.0)
    speeds = []
    for _ in range(240):
        world.run(steps=5)
        speeds.append(_fastest(world))
    return max(speeds[-12:]) / max(speeds[24:36])


_case = partial(StabilityCase, group="stacks", unit="m")
_stands = partial(
    _case, right="it stands: no box is off by half its width after 10 s", figure="farthest from its place",
    limit=0.5,
)  # fmt: skip
_HEAVY = partial(_top, boxes=10, top=100.0)

STANDING = (
    _stands(
        name="stack_100kg_stands", title="ten boxes of 1 kg, 100 kg on top", measure=partial(_off, _HEAVY)
    ),
    _case(
        name="stack_100kg_sink", title="ten boxes of 1 kg, 100 kg on top", limit=0.05,
        right="no box sinks by more than 5 cm in 10 s", figure="deepest sink", measure=partial(_sink, _HEAVY),
    ),
    _stands(
        name="stack_20_stands", title="twenty boxes", measure=partial(_off, partial(_top, boxes=19, top=1.0))
    ),
    _stands(
        name="stack_1e4kg_stands", title="1e4 kg on 1 kg",
        measure=partial(_off, partial(_top, boxes=1, top=1e4)),
    ),
    _case(
        name="pyramid_60_drift", title="pyramid of 1,830 boxes, 60 s", limit=0.13, long_s=3.0,
        right="no box drifts sideways by more than 0.13 m", figure="farthest drift",
        measure=partial(_sideways, partial(pyramid, base=60), 60.0),
    ),
    *(
        StabilityCase(
            name=f"tower_{count}x{100 * size:g}cm_{contacts}", group="towers",
            title=f"{count} cubes of {100 * size:g} cm, {model}, {_TOWER_S:g} s",
            right=f"it stands: no cube is off by {WANTED[contacts]:g} of its size",
            figure="farthest from its place, of a cube", limit=WANTED[contacts],
            measure=partial(_share_off, contacts, count, size, size, _TOWER_S),
        )
        for count, size in _TOWERS
        for contacts, model in MODELS.items()
    ),
    *(
        StabilityCase(
            name=f"sway_{count}", group="towers", limit=1.0,
            title=f"{count} boxes of 32 by 20 cm, pushed", right="the tower sways less, not more",
            figure="largest speed in the 20th second, of that in the 3rd", measure=partial(_swaying, count),
        )
        for count in (8, 12, 20)
    ),
    *(
        StabilityCase(
            name=f"rods_{count}_{contacts}", group="rods", limit=0.2,
            title=f"{count} rods of {_ROD:g} m by {1e3 * _THICK:g} mm on each other, {model}, {_ROD_S:g} s",
            right="none sinks by a fifth of its thickness", figure="farthest from its place, of a thickness",
            measure=partial(_share_off, contacts, count, _ROD, _THICK, _ROD_S),
        )
        for count in (1, 5, 10)
        for contacts, model in MODELS.items()
    ),
)  # fmt: skip
