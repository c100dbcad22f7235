"""Bodies on joints: motion with a closed form, runs of many digits, and events of joints at their times.

In mechanisms nothing touches: no body has a shape but the bars of the compound pendulum and of the motor.
Ropes go taut and over wheels, a motor stalls.
"""

import math
from functools import partial

import numpy as np

from physicslab.components import Gear, Mass, Pin, Pulley, Rod, Rope, Shape, Slot, Transform, Velocity
from physicslab.diagnostics.joints import joint_states
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import rotated
from physicslab.lab.accuracy.problem import Ladder, Problem, number, on_record, state_error
from physicslab.lab.worlds import GRAVITY, empty_world, place, spawn_point, velocity
from physicslab.world import World

_LENGTH, _WIDTH, _ANGLE = 1.0, 0.1, 2.5
"""Length of the bar [m], and its angle from the lowest at first [rad]."""
_RATE = math.sqrt(0.5 * GRAVITY * _LENGTH / ((_LENGTH**2 + _WIDTH**2) / 12.0 + 0.25 * _LENGTH**2))
"""Rate of small oscillations [rad/s]."""
_SWING = math.sqrt(GRAVITY)
"""The rate of a pendulum of 1 m [rad/s]."""
_MOMENTS = (1.0, 10.0)
_CRANK, _ROD, _DRIVE = 0.5, 1.5, 3.0
"""A slider-crank's lengths [m], and how fast it is driven [rad/s]."""
_WEIGHTS, _WHEEL = (1.0, 1.5), 0.5
"""Masses at a wheel [kg], and its moment of inertia over the square of its radius [kg]."""


def _bar(
    world: World, x: float, y: float, angle: float = 0.0, *, v: tuple[float, float] = (0.0, 0.0),
    spin: float = 0.0, length: float = 1.0, name: str = "",
) -> int:  # fmt: skip
    """Return an even bar of 1 kg."""
    mass = Mass(1.0, inertia=length**2 / 12.0)
    return world.spawn(Transform((x, y), angle), Velocity(v, spin), mass, name=name or None)


def _tip_error(world: World, name: str, arm: tuple[float, float], problem: str, i: int) -> float:
    """Return the largest error of a point of a body from the record, and of its velocity over a rate [m]."""
    body = world.entity(name)
    x, y = rotated(np.array(arm), world.component(body, Transform).angle)
    spin, at, how = world.component(body, Velocity).angular, place(world, name), velocity(world, name)
    keys = (number(problem, f"t={_MOMENTS[i]:.0f}", key) for key in ("x", "y", "vx", "vy"))
    found = at.x + x, at.y + y, how.x - spin * y, how.y + spin * x
    scales = 1.0, 1.0, _SWING, _SWING
    return max(float(abs(x - y)) / scale for x, y, scale in zip(found, keys, scales, strict=True))


def _compound_pendulum(simulation: SimulationConfig) -> World:
    """Return a bar that is held at its upper end, and let go high above it."""
    world, half = empty_world(simulation), 0.5 * _LENGTH
    middle = half * math.sin(_ANGLE), -half * math.cos(_ANGLE)
    parts = Transform(middle, _ANGLE), Velocity(), Mass(1.0), Shape.box(_WIDTH, _LENGTH)
    bar = world.spawn(*parts, name="bar")
    world.spawn(Pin(b=bar, anchor_b=(0.0, half)))
    return world


def _chain(simulation: SimulationConfig, links: int, angle: float, *, bars: bool) -> World:
    """Return links of 1 m in a row, at an angle from below: even bars, or masses on rods."""
    world, last = empty_world(simulation), None
    x, y = math.sin(angle), -math.cos(angle)
    for i in range(links):
        name = "end" if i == links - 1 else f"link{i}"
        if bars:
            link = _bar(world, (i + 0.5) * x, (i + 0.5) * y, angle, name=name)
            world.spawn(Pin(last, link, anchor_a=(0.0, -0.5 if i else 0.0), anchor_b=(0.0, 0.5)))
        else:
            link = world.spawn(Transform(((i + 1) * x, (i + 1) * y)), Velocity(), Mass(1.0), name=name)
            world.spawn(Rod(last, link, length=1.0))
        last = link
    return world


def _four_bar(simulation: SimulationConfig) -> World:
    """Return two loops of bars on the ground, cranks upright, whose tops move at 1 m/s."""
    world = empty_world(simulation)
    cranks = [_bar(world, i, 0.5, v=(-0.5, 0.0), spin=1.0, name=f"crank{i}") for i in range(3)]
    for i, crank in enumerate(cranks):
        world.spawn(Pin(b=crank, anchor_a=(i, 0.0), anchor_b=(0.0, -0.5)))
    for i in range(2):
        top = _bar(world, i + 0.5, 1.0, v=(-1.0, 0.0), name=f"top{i}")
        world.spawn(Pin(cranks[i], top, anchor_a=(0.0, 0.5), anchor_b=(-0.5, 0.0)))
        world.spawn(Pin(top, cranks[i + 1], anchor_a=(0.5, 0.0), anchor_b=(0.0, 0.5)))
    return world


def _four_bar_error(world: World, i: int) -> float:
    """Return the error of the first crank's top, and by how much others are elsewhere, or tops not level."""
    angles = [world.component(world.entity(f"crank{n}"), Transform).angle for n in range(3)]
    tilted = [world.component(world.entity(f"top{n}"), Transform).angle for n in range(2)]
    apart = max(*(abs(angle - angles[0]) for angle in angles), *(abs(angle) for angle in tilted))
    return max(_tip_error(world, "crank0", (0.0, 0.5), "four_bar", i), apart)


def _slider_crank(simulation: SimulationConfig, spin: float, *, driven: bool) -> World:
    """Return a crank, a rod and a slider in a row, which a motor drives or that goes by itself."""
    world, r = empty_world(simulation), _CRANK
    crank = _bar(world, 0.5 * r, 0.0, v=(0.0, 0.5 * r * spin), spin=spin, length=r, name="crank")
    tilt = -spin * r / _ROD
    rod = _bar(world, r + 0.5 * _ROD, 0.0, v=(0.0, 0.5 * r * spin), spin=tilt, length=_ROD, name="rod")
    slider = _bar(world, r + _ROD, 0.0, name="slider")
    motor = spin if driven else None
    world.spawn(Pin(b=crank, anchor_b=(-0.5 * r, 0.0), motor_speed=motor))
    world.spawn(Pin(crank, rod, anchor_a=(0.5 * r, 0.0), anchor_b=(-0.5 * _ROD, 0.0)))
    world.spawn(Pin(rod, slider, anchor_a=(0.5 * _ROD, 0.0)))
    world.spawn(Slot(b=slider))
    return world


def _driven_error(world: World, i: int) -> float:
    """Return the error of the slider's place and speed by the crank's angle, and of the motor's torque.

    The torque does the work of all that moves at that rate w: J' w^2 / 2 + U', for 2 T = J w^2.
    """
    s, c, r = math.sin(_DRIVE * _MOMENTS[i]), math.cos(_DRIVE * _MOMENTS[i]), _CRANK
    w = math.sqrt(_ROD**2 - (r * s) ** 2)
    x1 = -r * s - r * r * s * c / w  # the slider's place by the angle, once and twice
    x2 = -r * c - r * r * ((c * c - s * s) / w + (r * s * c) ** 2 / w**3)
    t1, t2 = -r * c / w, r * s / w - r**3 * s * c * c / w**3  # the rod's angle
    half_j = 0.25 * ((x1 - r * s) * (x2 - r * c) - r * r * s * c) + _ROD**2 / 12.0 * t1 * t2 + x1 * x2
    torque = half_j * _DRIVE**2 + GRAVITY * r * c
    off = abs(joint_states(world)[0].torque - torque) / (GRAVITY * r)
    return max(state_error(world, "slider", (r * c + w, 0.0), (_DRIVE * x1, 0.0), _DRIVE), off)


def _free_error(world: World, i: int) -> float:
    x, vx, angle = (number("slider_crank", f"t={_MOMENTS[i]:.0f}", key) for key in ("x", "vx", "angle"))
    turned = world.component(world.entity("crank"), Transform).angle
    return max(state_error(world, "slider", (x, 0.0), (vx, 0.0), _SWING), abs(turned - angle))


def _hoist(simulation: SimulationConfig, ratio: float) -> World:
    """Return two weights on rails, coupled with a wheel: the second moves ``ratio`` times as fast."""
    world, rails = empty_world(simulation), []
    for x, mass, name in zip((-1.0, 1.0), _WEIGHTS, ("left", "right"), strict=True):
        weight = world.spawn(Transform((x, 0.0)), Velocity(), Mass(mass, inertia=1.0), name=name)
        rails.append(world.spawn(Slot(b=weight, anchor_a=(x, 0.0), axis=(0.0, 1.0))))
    wheel = world.spawn(Transform(), Velocity(), Mass(1.0, inertia=_WHEEL), name="wheel")
    axle = world.spawn(Pin(b=wheel))
    world.spawn(Gear(first=rails[0], second=axle, ratio=1.0))
    world.spawn(Gear(first=rails[0], second=rails[1], ratio=ratio))
    return world


def _hoist_error(world: World, i: int, key: str, ratio: float) -> float:
    """Return the error of both weights, which are lifted evenly: (m + w + M r^2) a = -(m + M r) g."""
    a, t, errors = number("hoist", key), _MOMENTS[i], []
    for name, x, share in (("left", -1.0, 1.0), ("right", 1.0, ratio)):
        way, speed = 0.5 * share * a * t * t, share * a * t
        errors.append(state_error(world, name, (x, way), (0.0, speed)) / max(1.0, abs(way)))
    return max(errors)


_mechanism = partial(
    Problem, group="mechanism", times=_MOMENTS, good=1e-6, excellent=1e-10, ladder=Ladder(1024)
)


def _weights(name: str, title: str, key: str, ratio: float) -> Problem:
    """Return the problem of two weights of which the second moves ``ratio`` times as fast."""
    return _mechanism(
        name=name, source="hoist", title=title, compared="y, vy of both weights after 1 and 10 s",
        measure="largest error of x, y, vx, vy over the way [m]", good=1e-9, excellent=1e-13,
        build=lambda simulation: _hoist(simulation, ratio), ladder=Ladder(64),
        error=lambda world, i: _hoist_error(world, i, key, ratio),
    )  # fmt: skip


def _links(name: str, title: str, links: int, angle: float, excellent: float, *, bars: bool) -> Problem:
    """Return a chain that is let go at an angle from below, and of which the end is compared."""
    arm = (0.0, -0.5 if bars else 0.0)
    return _mechanism(
        name=name, title=title, excellent=excellent, compared="x, y, vx, vy of its end after 1 and 10 s",
        measure="largest error of x, y and of vx, vy over sqrt(g / 1 m) [m]",
        build=lambda simulation: _chain(simulation, links, angle, bars=bars),
        error=lambda world, i: _tip_error(world, "end", arm, name, i),
    )  # fmt: skip


JOINED = (
    Problem(
        name="compound_pendulum", title="A bar on a pin, let go 143 degrees from below", group="pendulum",
        compared="x, y, vx, vy of its middle after 1 and 10 s", times=(1.0, 10.0),
        measure="largest error of x, y and of vx, vy over sqrt(m g l / I) [m]",
        build=_compound_pendulum, good=1e-6, excellent=1e-10, ladder=Ladder(512),
        error=on_record("compound_pendulum", moments=("t=1", "t=10"), body="bar", rate=_RATE),
    ),
    _links("rod_pendulum", "A mass on a rod, let go 143 degrees from below", 1, 2.5, 1e-10, bars=False),
    _links("double_pendulum", "Two masses on rods, let go at 57 degrees", 2, 1.0, 1e-9, bars=False),
    _links("double_bars", "Two bars on pins, let go at 57 degrees", 2, 1.0, 1e-9, bars=True),
    _links("ten_links", "Ten bars on pins, let go at 29 degrees", 10, 0.5, 1e-9, bars=True),
    _mechanism(
        name="four_bar", title="Two four-bar linkages in a row, which lie flat five times",
        compared="x, y, vx, vy of a crank's top, and that all are parallel, after 1 and 10 s",
        measure="largest error of x, y, angles and of vx, vy over sqrt(g / 1 m) [m]",
        build=_four_bar, error=_four_bar_error, good=1e-5, excellent=1e-7,
        note="Where a linkage lies flat it could go on in two ways (IFToMM benchmark A02).",
    ),
    _mechanism(
        name="slider_crank_driven", source="slider_crank", title="A slider-crank that a motor turns",
        compared="x, vx of the slider and the motor's torque after 1 and 10 s", error=_driven_error,
        measure="largest error of x, y, of vx, vy over the spin [m], and of the torque over m g r",
        keeps=frozenset(),
        build=lambda simulation: _slider_crank(simulation, _DRIVE, driven=True),
    ),
    _mechanism(
        name="slider_crank", title="A slider-crank that goes by itself, from 4 rad/s on", error=_free_error,
        compared="x, vx of the slider and the crank's angle after 1 and 10 s",
        measure="largest error of x, y, the angle and of vx, vy over sqrt(g / 1 m) [m]",
        build=lambda simulation: _slider_crank(simulation, 4.0, driven=False),
    ),
    _weights("atwood_wheel", "Two weights over a wheel that has inertia", "atwood", -1.0),
    _weights("block_and_tackle", "Two weights, of which one moves a quarter", "tackle", -0.25),
)  # fmt: skip
"""Every problem with joints."""


_NOT_USED = {"leapfrog": "beside its kicks limits are springs, whose error does not go by its order"}
_LADDER = Ladder(240, 4, by_step=True)
_NOTHING_KEPT: frozenset[str] = frozenset()


def _slack(simulation: SimulationConfig) -> World:
    """Return a point on a rope of 1 m, let go .6 m beside the point from which it hangs."""
    world = empty_world(simulation)
    bob = spawn_point(world, (0.6, 0.0), mass=2.0, name="bob")
    world.spawn(Rope(b=bob, length=1.0))
    return world


def _slack_energy(t: float) -> float:
    """Return the energy: of what it has when it goes taut, .8 m below, it keeps (.6 v)^2 of v^2."""
    return -2.0 * 0.64 * 0.8 * GRAVITY if t > math.sqrt(1.6 / GRAVITY) else 0.0


def _hanging(name: str, masses: tuple[float, float], ratio: float) -> Problem:
    """Return the problem of two points at rest that hang over wheels 10 m above, on a rope with a ratio."""

    def build(simulation: SimulationConfig) -> World:
        world = empty_world(simulation)
        first, second = (
            spawn_point(world, (x, 0.0), mass=mass, name=f"{mass:g} kg")
            for x, mass in zip((-1.0, 1.0), masses, strict=True)
        )
        world.spawn(Pulley(a=first, b=second, wheel_a=(-1.0, 10.0), wheel_b=(1.0, 10.0), ratio=ratio))
        return world

    def error(world: World, i: int) -> float:
        pace, pull = number(name, "a"), number(name, "pull")
        off = [abs(float(world.joints.force[0]) - pull) / pull]
        for mass, rate in zip(masses, (ratio * pace, -pace), strict=True):
            body = f"{mass:g} kg"
            off += [abs(velocity(world, body).y - rate), abs(place(world, body).y - 0.5 * rate)]
        return max(off)

    return Problem(
        name=name, group="rope", build=build, error=error, times=(1.0,), good=1e-6, excellent=1e-10,
        title="Two masses over a wheel" if ratio == 1.0 else "A load on a block and tackle of two strands",
        compared="heights and speeds after 1 s, and the pull of the rope",
        measure="largest error of heights [m], of speeds [m/s], and of the pull as a share of it",
        ladder=_LADDER, not_used=_NOT_USED, touches=True,
    )  # fmt: skip


def _lifted(simulation: SimulationConfig) -> World:
    """Return a bar that hangs from a motor, which begins to lift it and can hold it up to 30 degrees."""
    world = empty_world(simulation)
    at = Transform((0.0, -0.5), -0.5 * math.pi), Velocity((0.25, 0.0), 0.5)
    bar = world.spawn(*at, Mass(1.0), Shape.box(1.0, 0.1), name="bar")
    world.spawn(Pin(b=bar, anchor_b=(-0.5, 0.0), motor_speed=0.5, max_torque=0.25 * GRAVITY))
    return world


def _lifted_error(world: World, i: int) -> float:
    moment, bar = ("t=1.5", "t=2.5")[i], world.entity("bar")
    angle = world.component(bar, Transform).angle + 0.5 * math.pi - number("motor_stalls", moment, "angle")
    spin = world.component(bar, Velocity).angular - number("motor_stalls", moment, "spin")
    return max(abs(angle), abs(spin))


LIMITED = (
    Problem(
        name="rope_taut", title="A mass on a slack rope, which goes taut", group="rope", times=(1.0, 3.0),
        compared="x, y, vx, vy after 1 and 3 s", build=_slack,
        error=on_record("rope_taut", moments=("t=1", "t=3"), body="bob", rate=math.sqrt(GRAVITY)),
        measure="largest error of x, y and of vx, vy over sqrt(g / l) [m]", good=1e-6, excellent=1e-10,
        ladder=_LADDER, exact_energy=_slack_energy, keeps=_NOTHING_KEPT, not_used=_NOT_USED, touches=True,
    ),
    _hanging("atwood_rope", (2.0, 3.0), 1.0),
    _hanging("tackle_rope", (1.0, 3.0), 2.0),
    Problem(
        name="motor_stalls", title="A bar that a motor lifts until it is too heavy for it", group="rope",
        compared="angle and spin after 1.5 and 2.5 s", times=(1.5, 2.5), build=_lifted, error=_lifted_error,
        measure="largest error of the angle [rad] and of the spin [rad/s]", good=1e-6, excellent=1e-10,
        ladder=_LADDER, keeps=_NOTHING_KEPT, not_used=_NOT_USED, touches=True,
    ),
)  # fmt: skip
"""Every problem with limits."""
