"""Bodies that bounce. States at given times are compared, which show when the impacts took place."""

import math
from functools import partial
from itertools import pairwise

from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.figures import number
from physicslab.lab.accuracy.problem import Ladder, Problem
from physicslab.lab.worlds import GRAVITY, Surface, empty_world, place, velocity
from physicslab.prefabs import box, circle
from physicslab.world import World

_problem = partial(Problem, group="collision", touches=True)
_NEEDS_EXACT = "a problem for located impacts: within steps, impacts crowd"
_ELASTIC = Surface(friction=0, restitution=1)


def _galperin(n: int, rungs: int) -> Problem:
    """Return the problem of two discs before a wall, of masses 1 and 100^n, whose collisions count pi."""
    key, small, large = f"n={n}", 0.25, 0.5  # the radii are left out of the exact solution's places
    last, count = number("galperin", key, "t_last"), int(number("galperin", key, "collisions"))
    end = last + 1.0

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation, gravity=None)
        box(world, (-0.5, 0), width=1, height=4, static=True, **_ELASTIC)
        circle(world, (1 + small, 0), radius=small, name="small", **_ELASTIC)
        start, mass = (2 + 2 * small + large, 0), 100.0**n
        circle(world, start, radius=large, mass=mass, velocity=(-1, 0), name="large", **_ELASTIC)
        return world

    def error(world: World, i: int) -> float:
        fast, slow = number("galperin", key, "V_final"), number("galperin", key, "v_final")
        where = number("galperin", key, "X_last") + fast * (end - last)
        return max(
            abs(velocity(world, "large").x - fast), abs(velocity(world, "small").x - slow),
            abs(place(world, "large").x - 2 * small - large - where),
        )  # fmt: skip

    return _problem(
        name=f"galperin_n{n}", source="galperin", build=build, times=(end,), error=error, good=1e-2,
        title=f"Two discs and a wall, 1 to 100^{n}: the collisions count the digits of pi", excellent=1e-9,
        compared=f"velocities and the large disc's place 1 s after the last of {count} collisions",
        measure="largest error [m/s], [m]; excellent and good need the exact number of collisions as well",
        ladder=Ladder(math.ceil(end * 240), rungs, by_step=True), keeps={"energy"}, collisions=count,
        note=_NEEDS_EXACT,
    )  # fmt: skip


def _cradle(name: str, title: str, pushed: int, gap: float) -> Problem:
    """Return the problem of five discs in a row, of which the first ``pushed`` come in at 1 m/s."""
    last = number("newton_cradle", "k1_gap_last_t")

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation, gravity=None)
        for i in range(5):
            speed = (1.0 if i < pushed else 0.0, 0)
            circle(world, (i * (1.0 + gap), 0), radius=0.5, velocity=speed, name=str(i), **_ELASTIC)
        return world

    def error(world: World, i: int) -> float:
        off = [abs(velocity(world, str(i)).x - (1.0 if i >= 5 - pushed else 0.0)) for i in range(5)]
        if gap > 0.0:  # each comes to rest where the next one was, but for a diameter
            ends = [i * (1.0 + gap) + gap for i in range(4)] + [4.0 * (1.0 + gap) + (1.0 - last)]
            off += [abs(place(world, str(i)).x - x) for i, x in enumerate(ends)]
        return max(off)

    return _problem(
        name=name, title=title, source="newton_cradle", build=build, times=(1.0,), error=error, good=1e-6,
        compared="velocities after 1 s" + (", and places, which show when each was hit" if gap else ""),
        measure="largest error [m/s]" + (", [m]" if gap else ""), excellent=1e-12,
        ladder=Ladder(240, 4, by_step=True), keeps={"energy", "momentum"},
        collisions=4 if pushed == 1 else None,
    )  # fmt: skip


def _ball(restitution: float, simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    box(world, (0, -0.5), width=20, height=1, static=True, **_ELASTIC)
    circle(world, (0, 5.5), radius=0.5, restitution=restitution, friction=0, name="ball")
    return world


def _at_apex(world: World, height: float) -> float:
    """Return how far a ball is from the top of its path: in height [m] and in time [s]."""
    return max(abs(place(world, "ball").y - 0.5 - height), abs(velocity(world, "ball").y / GRAVITY))


_HITS = [number("bounce", f"t_{i}") for i in range(1, 11)]
_ZENO = number("bounce", "zeno")
_LAST_HIT = number("elastic_bounce_100", "t_100")

IMPACTS = (
    *(_galperin(n, rungs) for n, rungs in ((0, 4), (1, 4), (2, 4), (3, 3), (4, 3))),
    _cradle("newton_cradle_gap", "Newton's cradle with gaps of 1 cm", 1, 0.01),
    _cradle("newton_cradle_touching", "Newton's cradle, touching", 1, 0.0),
    _cradle("newton_cradle_touching_two", "Newton's cradle, touching, two discs coming in", 2, 0.0),
    _problem(
        name="bounce", title="A ball that loses a fifth of its speed at each bounce",
        compared="height and speed where the top of each of the first nine bounces should be",
        measure="largest error of the height [m] and of the time [s]", build=partial(_ball, 0.8),
        times=tuple(0.5 * (early + late) for early, late in pairwise(_HITS)), good=1e-2, excellent=1e-12,
        error=lambda world, i: _at_apex(world, number("bounce", f"h_{i + 1}")),
        ladder=Ladder(1920, 4, by_step=True), keeps=frozenset(),
    ),
    _problem(
        name="bounce_rest", title="The same ball after infinitely many bounces", source="bounce",
        compared="height and speed one step of 1/60 s after the bounces should have ended",
        measure="largest of height [m] and speed [m/s]", build=partial(_ball, 0.8),
        times=(_ZENO + 1.0 / 60.0,), good=1e-2, excellent=1e-12,
        error=lambda world, i: max(abs(place(world, "ball").y - 0.5), abs(velocity(world, "ball"))),
        ladder=Ladder(2184, 4, by_step=True), keeps=frozenset(),
    ),
    _problem(
        name="elastic_bounce_100", title="A hundred bounces without loss",
        compared="height and speed where the top after the hundredth bounce should be",
        measure="largest error of the height [m] and of the time [s]", build=partial(_ball, 1.0),
        times=(_LAST_HIT * 200.0 / 199.0,), good=5e-2, excellent=1e-10,
        error=lambda world, i: _at_apex(world, number("elastic_bounce_100", "h")),
        ladder=Ladder(48461, 2, by_step=True), collisions=100,
    ),
)  # fmt: skip
"""Their problems."""
