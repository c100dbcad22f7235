"""Fast bodies against thin walls, and what spins fast."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import energy_growth, floor, largest, open_space
from physicslab.prefabs import box, circle
from physicslab.world import World

__all__ = ["BULLETS"]

_SPEEDS = (50.0, 500.0, 1e5, 1e6)
_RESTITUTIONS = (0.0, 0.5, 1.0)
_RADIUS = 0.05
_STEPS = 60
_ROUNDING = 1e-9


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


def _shot(
    target: Callable[[World, float], int], thickness: float, speed: float, restitution: float, collisions: str
) -> bool:
    """Whether a disc shot from the left stays on the left, and with no more energy than it came with."""
    world = open_space(gravity=None, collisions=collisions)
    hit = target(world, thickness)
    # The flight's length is odd, so that the meeting is at no step's beginning.
    bullet = circle(
        world,
        (-1.0 - 0.37 * speed / 60.0, 0.0),
        radius=_RADIUS,
        velocity=(speed, 0.0),
        restitution=restitution,
    )
    disc, wall = world.component(bullet, Transform), world.component(hit, Transform)
    moves = world.has(hit, Velocity)
    prescribed = moves and not world.has(hit, Mass)
    frame = world.component(hit, Velocity).linear if prescribed else Vector2()
    velocity = world.component(bullet, Velocity)

    def energy() -> float:
        others = world.component(hit, Velocity).linear if moves and not prescribed else Vector2()
        weight = world.component(hit, Mass).mass if moves and not prescribed else 0.0
        return 0.5 * (velocity.linear - frame).magnitude ** 2 + 0.5 * weight * others.magnitude**2

    before = energy()
    through = largest(world, _STEPS, lambda: float(disc.position.x > wall.position.x))
    return through == 0.0 and energy() <= before * (1.0 + _ROUNDING)


def _failed_shots(target: Callable[[World, float], int], thickness: float, collisions: str) -> float:
    """Return how many shots of all speeds and restitutions pass, or gain energy."""
    return float(
        sum(
            not _shot(target, thickness, speed, restitution, collisions)
            for speed in _SPEEDS
            for restitution in _RESTITUTIONS
        )
    )


_TARGETS: dict[str, tuple[str, Callable[[World, float], int], float]] = {
    "static_wall": ("a static wall of 0.1 m", _static, 0.1),
    "thin_wall": ("a static wall of 5 mm", _static, 0.005),
    "coming_wall": ("a wall of 5 mm that comes on at 20 m/s", _towards, 0.005),
    "leaving_wall": ("a heavy wall of 5 mm that leaves at 20 m/s", _away, 0.005),
    "disc": ("a disc of its size at rest", _disc, 0.1),
}


def _against(name: str, collisions: str) -> StabilityCase:
    what, target, thickness = _TARGETS[name]
    how = "exact collisions where auto takes them" if collisions == "auto" else "collisions within steps"
    return StabilityCase(
        name=f"bullet_{name}" if collisions == "auto" else f"bullet_{name}_step",
        title=f"disc of 0.1 m at 50, 500, 1e5 and 1e6 m/s against {what}, {how}", group="bullets",
        right="stopped or reflected: it never passes, and no energy is made",
        figure=f"shots that fail, of {len(_SPEEDS) * len(_RESTITUTIONS)}", limit=0.0,
        measure=partial(_failed_shots, target, thickness, collisions),
    )  # fmt: skip


def _spinning(restitution: float) -> float:
    """Return how the energy grows of a box of 1 m that falls on a floor at 1e5 rad/s."""
    world = open_space()
    floor(world, restitution=restitution)
    box(
        world, (0.0, 1.0), width=1.0, height=1.0, angular_velocity=1e5, angle=math.pi / 7.0,
        restitution=restitution,
    )  # fmt: skip
    return energy_growth(world, 600)


BULLETS = [
    *(_against(name, collisions) for collisions in ("auto", "step") for name in _TARGETS),
    *(
        StabilityCase(
            name=f"spinning_box_e{restitution:g}", group="spinning",
            title=f"box of 1 m spinning at 1e5 rad/s, dropped on a floor, e = {restitution:g}",
            right="finite, and energy never grows", figure="growth of energy, of that at the start",
            limit=1e-9, measure=partial(_spinning, restitution),
        )
        for restitution in (0.0, 1.0)
    ),
]  # fmt: skip
