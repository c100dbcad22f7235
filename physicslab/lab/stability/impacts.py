"""Fast bodies against thin walls, what spins fast, and elastic collisions that go on for long."""

import math
from collections.abc import Callable
from functools import partial

from physicslab.components import Mass, Material, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import GRAVITY, energy_change, energy_growth, floor, largest, open_space, place
from physicslab.prefabs import box, circle
from physicslab.scenes import SCENES
from physicslab.world import World

type _Target = Callable[[World, float], int]
"""Spawns what is shot at, of a thickness [m]."""

_SPEEDS = (50.0, 500.0, 1e5, 1e6)
_RESTITUTIONS = (0.0, 0.5, 1.0)
_ROUNDING_SHARE = 1e-9
_RADIUS, _HEIGHT = 0.25, 5.0
_CRADLE_LENGTH = 3.0


def _static(world: World, thickness: float) -> int:
    return box(world, (0.0, 0.0), width=thickness, height=10.0, static=True, restitution=1.0)


def _towards(world: World, thickness: float) -> int:
    """Spawn a wall that comes on at 20 m/s and is not slowed by impacts."""
    shape, material = Shape.box(thickness, 1e4), Material(1.0, 0.5)
    return world.spawn(Transform((0.0, 0.0)), Velocity((-20.0, 0.0)), shape, material)


def _away(world: World, thickness: float) -> int:
    """Spawn a heavy wall that can be pushed, and leaves at 20 m/s."""
    return box(
        world, (0.0, 0.0), width=thickness, height=10.0, mass=1e6, velocity=(20.0, 0.0), restitution=1.0,
        fixed_rotation=True,
    )  # fmt: skip


def _disc(world: World, thickness: float) -> int:
    return circle(world, (0.0, 0.0), radius=thickness / 2.0, restitution=1.0)


_TARGETS: dict[str, tuple[str, _Target, float]] = {
    "static_wall": ("a static wall of 0.1 m", _static, 0.1),
    "thin_wall": ("a static wall of 5 mm", _static, 0.005),
    "coming_wall": ("a wall of 5 mm that comes on at 20 m/s", _towards, 0.005),
    "leaving_wall": ("a heavy wall of 5 mm that leaves at 20 m/s", _away, 0.005),
    "disc": ("a disc of its size at rest", _disc, 0.1),
}


def _shot(target: _Target, thickness: float, speed: float, restitution: float, collisions: str) -> bool:
    """Whether a disc shot from the left stays on the left, and with no more energy than it came with."""
    world = open_space(gravity=None, collisions=collisions)
    hit = target(world, thickness)
    start = (-1.0 - 0.37 * speed / 60.0, 0.0)  # of odd length, so that the meeting is at no step's beginning
    bullet = circle(world, start, radius=0.05, velocity=(speed, 0.0), restitution=restitution)
    disc, wall = world.component(bullet, Transform), world.component(hit, Transform)
    moves, pushed = world.has(hit, Velocity), world.has(hit, Mass)
    frame = world.component(hit, Velocity).linear if moves and not pushed else Vector2()
    weight = world.component(hit, Mass).mass if moves and pushed else 0.0

    def energy() -> float:
        own = world.component(bullet, Velocity).linear - frame
        other = world.component(hit, Velocity).linear if weight else Vector2()
        return 0.5 * own.magnitude**2 + 0.5 * weight * other.magnitude**2

    before = energy()
    through = largest(world, 60, lambda: float(disc.position.x > wall.position.x))
    return through == 0.0 and energy() <= before * (1.0 + _ROUNDING_SHARE)


def _failed_shots(target: _Target, thickness: float, collisions: str) -> float:
    """Return how many shots of all speeds and restitutions pass, or gain energy."""
    shots = [(speed, restitution) for speed in _SPEEDS for restitution in _RESTITUTIONS]
    return float(sum(not _shot(target, thickness, *shot, collisions) for shot in shots))


def _spinning(restitution: float) -> float:
    """Return how the energy grows of a box of 1 m that falls on a floor at 1e5 rad/s."""
    world = open_space()
    floor(world, restitution=restitution)
    box(
        world, (0.0, 1.0), width=1.0, height=1.0, angular_velocity=1e5, angle=math.pi / 7.0,
        restitution=restitution,
    )  # fmt: skip
    return energy_growth(world, 600)


def _apex_error(seconds: float, collisions: str) -> float:
    """Return how far the apex of a ball with e = 1 departs from where it was let go, of the height."""
    world = open_space(collisions=collisions)
    floor(world, restitution=1.0)
    circle(world, (0.0, _HEIGHT + _RADIUS), radius=_RADIUS, restitution=1.0)
    start = measure_energy(world).total

    def apex() -> float:  # where the energy would carry it, were it to rise now
        return abs(measure_energy(world).total - start) / (GRAVITY * _HEIGHT)

    return largest(world, round(seconds * 60.0), apex)


def _gas_energy() -> float:
    world = SCENES["gas"].build()
    return energy_change(world, world.stepping(steps=10_000, stride=50))


def _cradle_amplitude(damping: float) -> float:
    """Return by how much the swing of the outer balls differs after a minute, as a share of the first."""
    world = SCENES["newtons_cradle"].build()
    world.synchronise()
    for entity in world.batch(Spring).entities.tolist():
        world.component(entity, Spring).damping = damping
    rest = place(world, "ball 5").x
    first = -rest - place(world, "ball 1").x  # it is held aside at the start
    last = round(1.2 * 2.0 * math.pi * math.sqrt(_CRADLE_LENGTH / GRAVITY) * 60.0)
    world.run(steps=3_600 - last)

    def swing() -> float:
        return max(-rest - place(world, "ball 1").x, place(world, "ball 5").x - rest)

    return abs(largest(world, last, swing) / first - 1.0)


def _against(name: str, collisions: str) -> StabilityCase:
    what, target, thickness = _TARGETS[name]
    how = "exact collisions where auto takes them" if collisions == "auto" else "collisions within steps"
    return StabilityCase(
        name=f"bullet_{name}" + _SUFFIX[collisions], group="bullets", limit=0.0,
        title=f"disc of 0.1 m at 50, 500, 1e5 and 1e6 m/s against {what}, {how}",
        right="stopped or reflected: it never passes, and no energy is made",
        figure=f"shots that fail, of {len(_SPEEDS) * len(_RESTITUTIONS)}",
        measure=partial(_failed_shots, target, thickness, collisions),
    )  # fmt: skip


_SUFFIX = {"auto": "", "step": "_step"}
"""Suffixes of the names of cases, by how collisions are found."""
_bounces = partial(StabilityCase, group="bounces")
_amplitude = partial(
    _bounces, right="the outer balls swing as far as at the start, within 1 %",
    figure="change of the amplitude", limit=0.01,
)  # fmt: skip

IMPACTS = (
    *(_against(name, collisions) for collisions in _SUFFIX for name in _TARGETS),
    *(
        StabilityCase(
            name=f"spinning_box_e{restitution:g}", group="spinning",
            title=f"box of 1 m spinning at 1e5 rad/s, dropped on a floor, e = {restitution:g}",
            right="finite, and energy never grows", figure="growth of energy, of that at the start",
            limit=1e-9, measure=partial(_spinning, restitution),
        )
        for restitution in (0.0, 1.0)
    ),
    *(
        _bounces(
            name=f"ball_{seconds:g}s{suffix}", title=f"ball with e = 1 dropped from 5 m, {seconds:g} s{how}",
            right="the apex stays where it was let go, within 0.1 %", limit=0.001,
            figure="change of the apex, of the height", measure=partial(_apex_error, seconds, collisions),
        )
        for (collisions, suffix), how in zip(_SUFFIX.items(), ("", ", collisions within steps"), strict=True)
        for seconds in (60.0, 200.0)
    ),
    _bounces(
        name="gas_energy", title="gas of 2,000 elastic discs, 10,000 steps", limit=0.002, long_s=4.0,
        right="energy is kept within 0.2 %", figure="largest change of energy", measure=_gas_energy,
    ),
    _amplitude(
        name="cradle_amplitude", title="Newton's cradle, 60 s, strings that take nothing away",
        measure=partial(_cradle_amplitude, 0.0),
    ),
    _amplitude(
        name="cradle_amplitude_damped", title="Newton's cradle as the built-in scene has it, 60 s",
        measure=partial(_cradle_amplitude, 20.0),
    ),
)  # fmt: skip
