"""Stacks of unlike masses, sharp wedges that fall into a stack, and balls on chains of segments."""

import math
from functools import cache, partial

from physicslab.components.vertices import regular
from physicslab.contacts.report import list_contacts
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import MODELS, StabilityCase, part_of, touching_space
from physicslab.lab.stability.contacts import WANTED
from physicslab.lab.worlds import GRAVITY, displacements, floor, place
from physicslab.prefabs import circle, ground, loop, polygon, stack
from physicslab.world import World

_SIDE, _TALL = 0.5, 0.5 * math.sqrt(3.0)
"""The base of a body of the stack, and its height [m]: a hexagon's, and for comparison a box's."""
_STACKED = {
    "hexagons": list(regular(6, _SIDE)),
    "boxes": [Vector2(x, y) for x, y in ((0.0, 0.0), (_SIDE, 0.0), (_SIDE, _TALL), (0.0, _TALL))],
}
_MASSES = (1000.0, 1.0, 1000.0, 1.0)
_WEDGE = 0.1
"""The width of a wedge of 1 m, whose point is so 6 degrees sharp [m]."""
_BALL, _LOOP = 0.2, 2.0
_LEAST = math.sqrt(5.0 * GRAVITY * (_LOOP - _BALL))
"""The least speed of the ball [m/s]."""
_STAYS = 2e-4
"""A ball that is off its circle by more than this share has left the loop: that finds the least speed to
0.3 %."""


def _unlike(shape: str, contacts: str) -> float:
    """Return how far the body that moved most is from its place after 10 s, of its height."""
    world = touching_space(contacts=contacts)
    floor(world)
    bodies = [
        polygon(world, (0.0, (n + 0.5) * _TALL), _STACKED[shape], mass=mass, friction=0.6)
        for n, mass in enumerate(_MASSES)
    ]
    moved = displacements(world, bodies, lambda: world.run(seconds=10.0))
    return max(way.magnitude for way in moved) / _TALL


def _depth(world: World, bodies: list[int]) -> float:
    """Return the deepest overlap [m]; what has gone through the floor counts with its depth."""
    points = (point for contact in list_contacts(world) for point in contact.points)
    return max(0.0, *(-point.separation for point in points), *(-place(world, body).y for body in bodies))


@cache  # two cases look at one run
def _wedges(contacts: str, speed: float) -> tuple[float, float]:
    """Return the growth of the energy, of that at the start, and the deepest overlap, of a wedge's width."""
    world = touching_space(contacts=contacts)
    floor(world)
    bodies = stack(world, 5, width=0.5, height=0.5)
    point_down = [(-0.5 * _WEDGE, 1.0), (0.0, 0.0), (0.5 * _WEDGE, 1.0)]
    for n in range(3):
        at = 0.1 * (n - 1), 3.5 + 1.5 * n
        bodies.append(polygon(world, at, point_down, angle=0.1 * n, velocity=(0.0, -speed)))
    start, grown, deepest = measure_energy(world).total, 0.0, 0.0
    for _ in world.stepping(steps=240):
        grown = max(grown, measure_energy(world).total / start - 1.0)
        deepest = max(deepest, _depth(world, bodies) / _WEDGE)
    return grown, deepest


def _seams(contacts: str, speed: float) -> float:
    """Return the energy that a ball loses that rolls over a level chain of 1,000 vertices, as a share."""
    world = touching_space(contacts=contacts)
    ground(world, [(99.0 - 0.1 * k, 0.0) for k in range(1000)], friction=0.5)
    circle(world, (0.0, _BALL), radius=_BALL, velocity=(speed, 0.0), angular_velocity=-speed / _BALL)
    before = measure_energy(world).kinetic
    world.run(seconds=min(5.0, 90.0 / speed))
    return abs(1.0 - measure_energy(world).kinetic / before)


def _goes_round(contacts: str, segments: int, speed: float) -> tuple[bool, float]:
    """Return if a ball without friction stays on the loop until it is over the top, and its loss of energy.

    That is a share of the energy at the start.
    """
    world, inner = touching_space(contacts=contacts), _LOOP - _BALL
    loop(world, (0.0, 0.0), radius=_LOOP, run=1.0, segments=segments, friction=0.0)
    ball = circle(world, (0.0, _BALL), radius=_BALL, velocity=(speed, 0.0), friction=0.0)
    before = measure_energy(world).total
    for _ in world.stepping(steps=120):
        off = place(world, ball) - Vector2(0.0, _LOOP)
        if off.magnitude < (1.0 - _STAYS) * inner:
            return False, math.nan
        if off.x < 0.0 < off.y:
            return True, abs(1.0 - measure_energy(world).total / before)
    return False, math.nan


def _least_speed(contacts: str, segments: int) -> float:
    """Return by what share the least speed that suffices is off sqrt(5 g r), r that of the ball's circle."""
    low, high = 0.5, 1.5
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        goes, _ = _goes_round(contacts, segments, middle * _LEAST)
        low, high = (low, middle) if goes else (middle, high)
    return abs(high - 1.0)


def _loop_loss(contacts: str, segments: int) -> float:
    """Return the energy that a ball loses on its way over the top, at a tenth more than the least speed."""
    return _goes_round(contacts, segments, 1.1 * _LEAST)[1]


_case = partial(StabilityCase, group="shapes")

SHAPES = (
    *(
        _case(
            name=f"{shape}_1000_{contacts}", limit=WANTED[contacts],
            title=f"{shape} of 1,000, 1, 1,000 and 1 kg on each other, {model}, 10 s",
            right=f"it stands: none is off by {WANTED[contacts]:g} of its height",
            figure="farthest from its place, of its height", measure=partial(_unlike, shape, contacts),
        )
        for shape in _STACKED
        for contacts, model in MODELS.items()
    ),
    *(
        _case(
            name=f"wedges_{speed:g}_{kind}_{contacts}", right=right, figure=figure, limit=limit,
            title=f"three wedges of 6 degrees fall at {speed:g} m/s and more into five boxes, {model}, 4 s",
            measure=partial(part_of, n, _wedges, contacts, speed),
        )
        for speed in (10.0, 100.0)
        for contacts, model in MODELS.items()
        for n, kind, right, figure, limit in (
            (0, "energy", "energy never grows", "growth, of that at the start", 1e-9),
            (1, "depth", "nothing is pierced or goes through", "deepest overlap, of a wedge's width", 0.2),
        )
    ),
    *(
        _case(
            name=f"seams_{speed:g}_{contacts}", limit=0.0, measure=partial(_seams, contacts, speed),
            title=f"ball rolls at {speed:g} m/s over the seams of a level chain, {model}",
            right="seams take nothing", figure="energy lost, of that at the start",
        )
        for speed in (1.0, 10.0, 100.0)
        for contacts, model in MODELS.items()
    ),
    *(
        _case(
            name=f"loop_{segments}_{kind}_{contacts}", right=right, limit=0.01, figure=figure,
            title=f"ball slides through a loop-the-loop of {segments} segments, {model}",
            measure=partial(measured, contacts, segments),
        )
        for segments in (50, 900)
        for contacts, model in MODELS.items()
        for kind, measured, right, figure in (
            ("speed", _least_speed, "the least speed at which it stays on it is sqrt(5 g r), within 1 %",
             "error of that speed"),
            ("energy", _loop_loss, "seams take nothing", "energy lost on its way over the top"),
        )
    ),
)  # fmt: skip
