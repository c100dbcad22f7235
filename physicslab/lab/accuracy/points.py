"""One body without extent, thrown, dropped or on a spring; damped and not, and fast beside the step."""

import math
from collections.abc import Callable
from fractions import Fraction
from functools import partial

from physicslab.components import Drag, Spring
from physicslab.ecs.component import Component
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.problem import Ladder, Problem, number, on_record, record, state_error
from physicslab.lab.closed_forms import dragged_energy
from physicslab.lab.worlds import GRAVITY, Surface, empty_world, place, spawn_point, velocity
from physicslab.prefabs import box, circle
from physicslab.world import World

_STEP = 0.01
_RESTS = "its steps shrink without end as the weight comes to rest: they are measured by the present speed"
_DAMPED_RATE = 10.0
"""The rate of the damped oscillators without their damper [1/s]."""

_ballistic = partial(Problem, group="ballistic")
_damped_ladder = Ladder(16, 9)
_oscillator = partial(Problem, group="oscillator")
_stiff = partial(Problem, group="stiff", dt=_STEP)


def _point(
    start: tuple[float, float] = (0.0, 0.0), speed: tuple[float, float] = (0.0, 0.0),
    *parts: Callable[[], Component], mass: float = 1.0, gravity: float | None = GRAVITY,
) -> Callable[[SimulationConfig], World]:  # fmt: skip
    """Return what builds a world of one body, with parts beside its mass."""

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation, gravity=gravity)
        spawn_point(world, start, speed, *(part() for part in parts), mass=mass, name="body")
        return world

    return build


# ---- thrown and dropped ------------------------------------------------------------------------------------


def _free_fall_error(world: World, i: int) -> float:
    where, how = place(world, "body"), velocity(world, "body")
    found = {"x": where.x, "y": where.y, "vy": how.y}
    return max(abs(value - number("free_fall", key)) for key, value in found.items())


def _projectile(simulation: SimulationConfig) -> World:
    # A ball starts on the floor; one that gives all of its speed back shows by where it is later when it hit.
    world, surface = empty_world(simulation), Surface(friction=0, restitution=1)
    box(world, (30, -0.5), width=100, height=1, static=True, **surface)
    circle(world, (0, 0.25), velocity=(10.0, 10.0 * math.sqrt(3.0)), name="body", **surface)
    return world


def _projectile_error(world: World, i: int) -> float:
    reach, apex = number("projectile", "R"), number("projectile", "H")
    where, how, passed = place(world, "body"), velocity(world, "body"), (0.5, 1.5)[i]
    return max(abs(where.x - passed * reach), abs(where.y - 0.25 - apex), abs(how.y / GRAVITY))


def _drag_quadratic_error(world: World, i: int) -> float:
    depth, speed = (number("drag_quadratic", key) for key in ("d", "v"))
    return state_error(world, "body", (0.0, -depth), (0.0, -speed))


def _drag_quadratic_energy(t: float) -> float:
    # v = v_t tanh(g t / v_t); the distance is its integral.
    terminal = math.sqrt(GRAVITY / 0.1)
    speed = terminal * math.tanh(GRAVITY * t / terminal)
    fallen = terminal**2 / GRAVITY * math.log(math.cosh(GRAVITY * t / terminal))
    return 0.5 * speed * speed - GRAVITY * fallen


_FLIGHT = number("projectile", "T")

_BALLISTIC = (
    _ballistic(
        name="free_fall", title="Free fall with a sideways throw", compared="x, y, vy after 2 s",
        measure="largest error [m], [m/s]", build=_point((0, 20), (5, 0)), times=(2.0,),
        error=_free_fall_error, good=1e-12, excellent=4.0 * math.ulp(20.0), ladder=Ladder(16),
    ),
    _ballistic(
        name="projectile", title="A ball thrown at 60 degrees, bouncing off level ground",
        compared="range, apex and flight time, from the states at half and at one and a half flights",
        measure="largest error of x, y [m] and of the time [s]", build=_projectile,
        times=(0.5 * _FLIGHT, 1.5 * _FLIGHT), error=_projectile_error, good=1e-6, excellent=1e-13,
        ladder=Ladder(1280, 5, by_step=True), touches=True, collisions=1,
    ),
    _ballistic(
        name="drag_linear", title="A throw in a viscous medium", compared="x, y, vx, vy after 3 s",
        measure="largest error [m], [m/s]", times=(3.0,), good=1e-6, excellent=1e-13, ladder=_damped_ladder,
        build=_point((0.0, 0.0), (10, 15), partial(Drag, linear=0.5), mass=2.0),
        error=on_record("drag_linear"),
        exact_energy=lambda t: 2.0 * dragged_energy(0.25, 10.0, 15.0, GRAVITY, t),
    ),
    _ballistic(
        name="drag_quadratic", title="A fall in air", compared="distance fallen and speed after 2 s",
        measure="largest error [m], [m/s]", times=(2.0,), good=1e-6, excellent=1e-13, ladder=_damped_ladder,
        build=_point((0.0, 0.0), (0.0, 0.0), partial(Drag, quadratic=0.1)), error=_drag_quadratic_error,
        exact_energy=_drag_quadratic_energy,
    ),
)  # fmt: skip


# ---- on springs --------------------------------------------------------------------------------------------


def _damped(name: str, title: str, damping: float) -> Problem:
    spring = partial(Spring, rest_length=0, stiffness=_DAMPED_RATE**2, damping=damping)
    return _oscillator(
        name=name, title=title, source=name, compared="x and v after 0.7 s",
        measure="largest error of x and of v / omega [m]", times=(0.7,), good=1e-6, excellent=1e-13,
        build=_point((1, 0), (0.0, 0.0), spring, gravity=None), ladder=Ladder(32, 9),
        error=on_record(name, axes=("x", "", "v", ""), rate=_DAMPED_RATE),
        exact_energy=partial(_damped_energy, 0.5 * damping),
    )  # fmt: skip


def _damped_energy(decay: float, t: float) -> float:
    """Return the energy [J] at a time: x'' + 2 decay x' + 100 x = 0 from x = 1 at rest."""
    gap = 100.0 - decay * decay
    rate = math.sqrt(abs(gap))
    if gap == 0.0:
        swing, slope = 1.0, t
    elif gap > 0.0:
        swing, slope = math.cos(rate * t), math.sin(rate * t) / rate
    else:
        swing, slope = math.cosh(rate * t), math.sinh(rate * t) / rate
    left = math.exp(-decay * t)
    x, v = left * (swing + decay * slope), -100.0 * left * slope
    return 0.5 * v * v + 50.0 * x * x


_OSCILLATORS = (
    _oscillator(
        name="harmonic", title="A mass on a spring, 100 1/4 periods",
        compared="x and v after 100.25 s, where x = 0: an error of the phase shows in full",
        measure="largest error of x and of v / omega [m]", times=(100.25,), good=1e-4, excellent=1e-12,
        build=_point(
            (1, 0), (0.0, 0.0), partial(Spring, rest_length=0, stiffness=4.0 * math.pi**2), gravity=None
        ),
        error=on_record("harmonic", axes=("x", "", "v", ""), rate=2.0 * math.pi), ladder=Ladder(8192),
        keeps={"energy", "angular_momentum"},
    ),
    _damped("damped_under", "A mass on a spring with weak damping (0.1 of critical)", 2.0),
    _damped("damped_critical", "A mass on a spring with critical damping", 20.0),
    _damped("damped_over", "A mass on a spring with strong damping (5 times critical)", 100.0),
    Problem(
        name="elastic_pendulum", title="A mass that swings on a spring", group="pendulum",
        compared="x, y, vx, vy after 1, 5 and 10 s", times=(1.0, 5.0, 10.0),
        measure="largest error of x, y and of vx, vy over sqrt(k / m) [m]",
        build=_point((1.2, 0), (0.0, 0.0), partial(Spring, rest_length=1, stiffness=40)),
        error=on_record("elastic_pendulum", moments=("t=1", "t=5", "t=10"), rate=math.sqrt(40.0)),
        good=1e-5, excellent=1e-11, ladder=Ladder(512),
    ),
)  # fmt: skip


# ---- fast beside the step: each for several z, the rate times a step of 10 ms ------------------------------


def _rate(z: str) -> Fraction:
    """Return z over the step of 10 ms [1/s]."""
    return Fraction(z) * 100


def _fast_spring(z: str) -> Problem:
    rate = float(_rate(z))

    def error(world: World, i: int) -> float:
        x, v = number("stiff_spring", z, "x"), number("stiff_spring", z, "v_over_w")
        return state_error(world, "body", (x, 0.0), (rate * v, 0.0), rate=rate)

    spring = partial(Spring, rest_length=0, stiffness=float(_rate(z) ** 2))
    return _stiff(
        name=f"stiff_spring_z{z}", title=f"An undamped spring, omega dt = {z} at 10 ms",
        source="stiff_spring", compared="x and v after 10 s", times=(10.0,), error=error, good=1e-4,
        measure="largest error of x and of v / omega [m]", excellent=1e-12,
        build=_point((1, 0), (0.0, 0.0), spring, gravity=None), ladder=Ladder(1000, 6, by_step=True),
        keeps={"energy", "angular_momentum"},
    )  # fmt: skip


def _sag(z: str) -> Problem:
    # A spring of no rest length, so that a sag of 0.1 um is not the difference of two lengths of 1 m.
    spring = partial(Spring, rest_length=0, stiffness=float(_rate(z) ** 2))
    damper = partial(Drag, linear=float(_rate(z) / 10))

    def error(world: World, i: int) -> float:
        rest, hangs = (number("stiff_spring_gravity_sag", z, key) for key in ("rest", "x_at_1s"))
        return abs((place(world, "body").y - hangs) / rest)

    return _stiff(
        name=f"stiff_spring_gravity_sag_z{z}", source="stiff_spring_gravity_sag", times=(1.0,), error=error,
        title=f"A weight let go on a damped spring, omega dt = {z} at 10 ms", good=1e-9, excellent=1e-12,
        compared="how far it hangs down after 1 s", measure="error as a share of the sag at rest",
        build=_point((0.0, 0.0), (0.0, 0.0), spring, damper), ladder=Ladder(100, 8, by_step=True),
        keeps=frozenset(), not_used={"dop853": _RESTS} if float(z) > 1.0 else {},
    )  # fmt: skip


def _syrup(z: str) -> Problem:
    rate = float(_rate(z))

    def error(world: World, i: int) -> float:
        return abs(velocity(world, "body").y - number("stiff_damper", z, ("v_10ms", "v_terminal")[i]))

    return _stiff(
        name=f"stiff_damper_z{z}", title=f"A body falling in syrup, c dt / m = {z} at 10 ms",
        source="stiff_damper", times=(_STEP, 4.0), error=error, measure="largest error [m/s]", good=1e-9,
        compared="the velocity after 10 ms, and after 4 s, when it has become steady", excellent=1e-13,
        build=_point((0.0, 0.0), (0, 1), partial(Drag, linear=rate)), ladder=Ladder(400, 6, by_step=True),
        exact_energy=partial(dragged_energy, rate, 0.0, 1.0, GRAVITY),
    )  # fmt: skip


POINTS = (
    *_BALLISTIC,
    *_OSCILLATORS,
    *map(_fast_spring, record("stiff_spring")["reference"]),
    *map(_sag, record("stiff_spring_gravity_sag")["reference"]),
    *map(_syrup, record("stiff_damper")["reference"]),
)
"""Their problems."""
