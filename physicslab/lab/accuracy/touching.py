"""Bodies that bounce, slide, roll, rest on each other and come to rest, on level ground and on slopes."""

import math
from collections.abc import Callable
from functools import partial
from itertools import pairwise

from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.contacts.report import list_contacts
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.accuracy.problem import Ladder, Problem, number
from physicslab.lab.closed_forms import rolled, slid
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


_contact = partial(Problem, group="contact", touches=True)
_NONE: frozenset[str] = frozenset()
_MU, _SPEED, _THETA = 0.3, 5.0, math.pi / 6.0


def _spawn_wheel(
    world: World, at: Vector2, speed: tuple[float, float], friction: float, share: float
) -> None:
    """Spawn a wheel of 1 kg and 1 m across whose moment of inertia is ``share`` m r^2."""
    shape, material = Shape.circle(0.5), Material(0, friction)
    world.spawn(Transform(at), Velocity(speed), shape, material, Mass(1, inertia=share * 0.25), name="body")


# ---- on level ground ---------------------------------------------------------------------------------------


def _floor(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    box(world, (10, -0.5), width=60, height=1, static=True, friction=_MU)
    return world


def _slide(simulation: SimulationConfig) -> World:
    world = _floor(simulation)
    box(
        world, (0, 0.25), width=1, height=0.5, friction=_MU, velocity=(_SPEED, 0), fixed_rotation=True,
        name="body",
    )  # fmt: skip
    return world


def _slide_error(world: World, i: int) -> float:
    way, speed = slid(_SPEED, _MU * GRAVITY, (1.0, 3.0)[i])
    if i == 1:
        way = number("friction_slide", "d")
    return max(abs(place(world, "body").x - way), abs(velocity(world, "body").x - speed))


def _slide_energy(t: float) -> float:
    return 0.5 * slid(_SPEED, _MU * GRAVITY, t)[1] ** 2 + GRAVITY * 0.25


def _roll(kind: str, share: float, *, way: bool = False) -> Problem:
    """Return the problem of a body thrown flat that comes to roll; its inertia is ``share`` m r^2.

    The speed is compared, or with ``way`` the place, which shows when it began to roll.
    """
    start, stop = number("slip_to_roll", kind, "t"), 1.0

    def build(simulation: SimulationConfig) -> World:
        world = _floor(simulation)
        _spawn_wheel(world, Vector2(0.0, 0.5), (_SPEED, 0), _MU, share)
        return world

    def error(world: World, i: int) -> float:
        speed, gone = number("slip_to_roll", kind, "v"), number("slip_to_roll", kind, "d")
        if way:
            return abs(place(world, "body").x - gone - speed * (stop - start))
        spin = world.component(world.entity("body"), Velocity).angular
        return max(abs(velocity(world, "body").x - speed), abs(-0.5 * spin - speed))

    def energy(t: float) -> float:
        _, speed, _, rim = rolled(_SPEED, _MU * GRAVITY, t, share=share)
        return 0.5 * (speed * speed + share * rim * rim) + GRAVITY * 0.5

    return _contact(
        name=f"slip_to_roll_{kind}" + ("_way" if way else ""), source="slip_to_roll", build=build,
        title=f"A {kind} thrown without spin that comes to roll", times=(stop,), error=error,
        compared="how far it has come after 1 s" if way else "speed and spin after 1 s, when it rolls",
        measure="error [m]" if way else "largest error of the speed, and of the rim's [m/s]",
        good=1e-2 if way else 1e-3, excellent=1e-6 if way else 1e-9, ladder=Ladder(240, 4, by_step=True),
        exact_energy=energy, keeps=_NONE,
    )  # fmt: skip


def _stack(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    box(world, (0, -0.5), width=20, height=1, static=True, friction=0.6)
    for i in range(10):
        box(world, (0, 0.5 + i), width=1, height=1, friction=0.6, name=f"box {i}")
    return world


def _forces_error(world: World, i: int) -> float:
    """Return the largest relative error of the forces between the floor and the boxes of the stack."""
    boxes = [world.entity(f"box {n}") for n in range(10)]
    felt = dict.fromkeys(range(10), 0.0)
    for contact in list_contacts(world):
        above = max(boxes.index(end) for end in (contact.a, contact.b) if end in boxes)
        felt[above] += sum(point.normal_force for point in contact.points)
    true = [number("stack10", "force_k", str(n)) for n in range(10)]
    return max(abs(felt[n] - true[n]) / true[n] for n in range(10))


_stacked = partial(
    _contact, title="Ten boxes on each other, at rest for 10 s", source="stack10", build=_stack,
    times=(10.0,), ladder=Ladder(2400, 2, by_step=True),
)  # fmt: skip

_LEVEL = (
    _contact(
        name="friction_slide", title="A block that slides to a stop", build=_slide, times=(1.0, 3.0),
        compared="place and speed after 1 s, and after 3 s, when it has stopped",
        measure="largest error [m], [m/s]", error=_slide_error, good=1e-2, excellent=1e-6,
        ladder=Ladder(720, 4, by_step=True), exact_energy=_slide_energy, keeps=_NONE,
    ),
    _roll("disc", 0.5),
    _roll("disc", 0.5, way=True),
    _roll("sphere", 0.4),
    _roll("hoop", 1.0),
    _stacked(
        name="stack10_forces", compared="the force at each of ten interfaces after 10 s",
        measure="largest relative error", error=_forces_error, good=1e-2, excellent=1e-9,
    ),
    _stacked(
        name="stack10_height", compared="how high the top box is after 10 s", measure="error [m]",
        error=lambda world, i: abs(place(world, "box 9").y - number("stack10", "top_centre_y")), good=0.05,
        excellent=0.005,
    ),
    _stacked(
        name="stack10_drift", compared="how far boxes have crept sideways after 10 s",
        measure="largest way [m]", good=1e-3, excellent=1e-6,
        error=lambda world, i: max(abs(place(world, f"box {n}").x) for n in range(10)),
    ),
)  # fmt: skip


# ---- on inclined planes ------------------------------------------------------------------------------------


def _plane(simulation: SimulationConfig, angle: float, friction: float) -> tuple[World, Vector2]:
    """Return a world with a plane through the origin that rises to the right, and its unit normal."""
    world = empty_world(simulation)
    normal = Vector2.from_angle(angle).perpendicular
    box(world, normal * -0.5, width=60, height=1, angle=angle, static=True, friction=friction)
    return world, normal


def _block(friction: float, simulation: SimulationConfig) -> World:
    world, normal = _plane(simulation, _THETA, friction)
    box(world, normal * 0.25, width=1, height=0.5, angle=_THETA, friction=friction, name="body")
    return world


def _wheel(friction: float, share: float, simulation: SimulationConfig) -> World:
    world, normal = _plane(simulation, _THETA, friction)
    _spawn_wheel(world, normal * 0.5, (0.0, 0.0), friction, share)
    return world


def _tall(angle: float, simulation: SimulationConfig) -> World:
    world, normal = _plane(simulation, angle, 1.0)
    box(world, normal, width=1, height=2, angle=angle, friction=1, name="body")
    return world


def _gone(world: World) -> tuple[float, float]:
    """Return how far down the body is [m], and how fast it goes down [m/s]; it started over the origin."""
    down = -Vector2.from_angle(_THETA)
    return place(world, "body").dot(down), velocity(world, "body").dot(down)


def _going(name: str, title: str, key: str, build: Callable[[SimulationConfig], World]) -> Problem:
    def error(world: World, i: int) -> float:
        distance, speed = _gone(world)
        acceleration = number("incline", key)
        return max(abs(2.0 * distance / acceleration - 1.0), abs(speed / acceleration - 1.0))

    return _contact(
        name=f"incline_{name}", title=title, source="incline", compared="distance and speed after 1 s",
        measure="largest relative error of the acceleration that they stand for", build=build, times=(1.0,),
        error=error, good=1e-3, excellent=1e-9, ladder=Ladder(240, 4, by_step=True),
        keeps={"energy"} if "rolling" in key else _NONE,
    )  # fmt: skip


def _bisect(low: float, high: float, width: float, above: Callable[[float], bool]) -> float:
    """Return where ``above`` turns from false to true, to half of ``width``."""
    while high - low > width:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if above(middle) else (middle, high)
    return 0.5 * (low + high)


def _threshold(simulation: Callable[[], SimulationConfig]) -> float:
    """Return the relative error of the friction from which on a block is held."""

    def held(friction: float) -> bool:
        world = _block(friction, simulation())
        world.run(seconds=2.0)
        return _gone(world)[1] < 1e-4

    true = number("incline", "block_slides_if_mu_below")
    return abs(_bisect(0.55, 0.6, 2e-5, held) / true - 1.0)


def _topple_error(simulation: Callable[[], SimulationConfig]) -> float:
    """Return the error of the angle from which on a box falls over [deg]."""

    def topples(degrees: float) -> bool:
        angle = math.radians(degrees)
        world = _tall(angle, simulation())
        world.run(seconds=4.0)
        return abs(world.component(world.entity("body"), Transform).angle - angle) > 0.2

    return abs(_bisect(25.5, 27.5, 4e-3, topples) - number("box_topple", "theta_deg"))


def _never(world: World, i: int) -> float:
    raise NotImplementedError("what is compared is looked for with many worlds")


_SLOPES = (
    _going("block", "A block slides down 30 degrees, mu = 0.4", "block_a_mu04", partial(_block, 0.4)),
    _going("disc", "A disc rolls down 30 degrees", "disc_rolling_a", partial(_wheel, 0.6, 0.5)),
    _going("sphere", "A sphere rolls down 30 degrees", "sphere_rolling_a", partial(_wheel, 0.6, 0.4)),
    _going(
        "slipping", "A disc slips down 30 degrees, mu = 0.1", "disc_slip_mu01_a", partial(_wheel, 0.1, 0.5)
    ),
    _contact(
        name="incline_held", title="A block that friction holds on 30 degrees, mu = 0.7", source="incline",
        compared="how far it has gone after 10 s", measure="way [m]", build=partial(_block, 0.7),
        times=(10.0,), error=lambda world, i: abs(_gone(world)[0]), good=1e-4, excellent=1e-12,
        ladder=Ladder(2400, 2, by_step=True),
    ),
    _contact(
        name="incline_threshold", title="The friction that just holds a block on 30 degrees",
        source="incline", measure="relative error of the coefficient", build=partial(_block, 0.5),
        compared="the smallest friction with which it stands still after 2 s, by bisection", times=(2.0,),
        error=_never, good=1e-2, excellent=1e-3, ladder=Ladder(480, 3, by_step=True), keeps=_NONE,
        search=_threshold,
    ),
    _contact(
        name="box_topple", title="The slope on which a box of 1 m by 2 m falls over",
        compared="the smallest angle at which it has fallen after 4 s, by bisection",
        measure="error of the angle [deg]", build=partial(_tall, math.radians(26.0)), times=(4.0,),
        error=_never, good=0.5, excellent=0.05, ladder=Ladder(960, 3, by_step=True), keeps=_NONE,
        search=_topple_error,
    ),
)  # fmt: skip

FRICTION = (*_LEVEL, *_SLOPES)
"""Their problems."""
