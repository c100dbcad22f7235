"""Springs and dampers too stiff for the step."""

from __future__ import annotations

import math
from functools import partial

from physicslab.components import Drag, Spring, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import GRAVITY, energy_change, floor, largest, open_space, place, spawn_point
from physicslab.prefabs import circle
from physicslab.world import World

__all__ = ["SPRINGS"]

_DT = 1.0 / 60.0
_STEPS = 1_000
_STRETCH = 0.01
_ASIDE = 0.01
"""Sideways [m/s]: what that adds to the stretch is too little for the limit."""
_STIFFNESS = {
    **{f"{rate:g}": (rate / _DT) ** 2 for rate in (0.1, 1.0, 1.9, 10.0, 100.0)},
    "k_1e12": 1e12,
}  # fmt: skip
"""Of each spring [N/m] on 1 kg, by omega dt or its own name."""


def _hung(stiffness: float, below: float, *, gravity: float | None, touches: bool) -> tuple[World, int]:
    """Return a world with a body of 1 kg on a spring of 1 m, so far below its rest length [m]."""
    world = open_space(gravity=gravity, dt=_DT, contacts="soft")
    # What oscillates swings sideways as well: along one line, the motion would be solved in closed form.
    swing = (0.0, 0.0) if gravity else (_ASIDE, 0.0)
    where = Vector2(0.0, -1.0 - below)
    if touches:  # one that nothing is near, so that all it does is what the spring makes it do
        floor(world, Vector2(0.0, -10.0))
        bob = circle(world, where, radius=0.1, velocity=swing)
    else:
        bob = spawn_point(world, where, swing)
    world.add(bob, Spring(rest_length=1.0, stiffness=stiffness))
    return world, bob


def _excursion(stiffness: float, touches: bool) -> float:
    world, bob = _hung(stiffness, _STRETCH, gravity=None, touches=touches)
    return largest(world, _STEPS, lambda: abs(place(world, bob).magnitude - 1.0) / _STRETCH)


def _rest_error(stiffness: float, touches: bool) -> float:
    world, bob = _hung(stiffness, GRAVITY / stiffness, gravity=GRAVITY, touches=touches)
    rest = Vector2(0.0, -1.0 - GRAVITY / stiffness)
    return largest(world, _STEPS, lambda: (place(world, bob) - rest).magnitude)


def _energy(stiffness: float, touches: bool) -> float:
    """Return the change of energy; 0 where the engine reports that it does not follow the motion."""
    world, _ = _hung(stiffness, _STRETCH, gravity=None, touches=touches)
    changed = energy_change(world, _STEPS)
    return 0.0 if "too fast to be followed" in world.plan.reason else changed


def _past_limit(damping: float, kind: str, touches: bool) -> float:
    """Return how far a body's velocity goes past that at which a damper carries its weight.

    As a share of the 1 m/s that it starts with; or how far it is from there at the end, if that is more.
    """
    world = open_space(dt=_DT, contacts="soft")
    brake = {
        "damper": Spring(rest_length=0.0, stiffness=0.0, damping=damping),
        "drag": Drag(linear=damping),
        "drag_quadratic": Drag(quadratic=damping),
    }[kind]
    if touches:
        floor(world, Vector2(0.0, -10.0))
        bob = circle(world, (0.0, -1.0), radius=0.1, mass=1.0, velocity=(0.0, -1.0))
        world.add(bob, brake)
    else:
        bob = spawn_point(world, (0.0, -1.0), (0.0, -1.0), brake)
    falls = -math.sqrt(GRAVITY / damping) if kind == "drag_quadratic" else -GRAVITY / damping

    def past() -> float:
        return world.component(bob, Velocity).linear.y - falls

    return max(0.0, largest(world, _STEPS, past), abs(past()))


def _swing(touches: bool, stiffness: float) -> tuple[World, int]:
    """Return a world with a bob of 1 kg let go aside, on a spring of 1 m with a strong damper."""
    world, where = open_space(dt=_DT, contacts="soft"), (0.8, -0.6)
    if touches:
        floor(world, Vector2(0.0, -10.0))
        bob = circle(world, where, radius=0.1, mass=1.0)
    else:
        bob = spawn_point(world, where)
    world.add(bob, Spring(rest_length=1.0, stiffness=stiffness, damping=1e9))
    return world, bob


def _swing_change(touches: bool, stiffness: float) -> float:
    world, _ = _swing(touches, stiffness)
    return energy_change(world, _STEPS)


def _along_the_rod(touches: bool, stiffness: float) -> float:
    world, bob = _swing(touches, stiffness)

    def rate() -> float:
        arm, velocity = place(world, bob), world.component(bob, Velocity).linear
        return abs(arm.x * velocity.x + arm.y * velocity.y) / arm.magnitude

    return largest(world, _STEPS, rate)


def _of_spring(name: str, stiffness: float, *, touches: bool) -> list[StabilityCase]:
    scene = "in a scene with contacts" if touches else "alone"
    prefix = "spring_touching" if touches else "spring"
    group = "springs"
    what = f"k = 1e12 N/m on 1 kg, {scene}" if name == "k_1e12" else f"omega dt = {name}, {scene}"
    return [
        StabilityCase(
            name=f"{prefix}_{name}_bounded", title=f"spring of {what}", group=group,
            right="an undamped oscillation goes no further than it began, for 1,000 steps",
            figure="largest excursion, of the first", limit=1.001,
            measure=partial(_excursion, stiffness, touches),
        ),
        StabilityCase(
            name=f"{prefix}_{name}_rest", title=f"spring of {what}, with a weight", group=group,
            right="what hangs at rest stays at the right place",
            figure="largest distance from it", unit="m", limit=1e-9,
            measure=partial(_rest_error, stiffness, touches),
        ),
        StabilityCase(
            name=f"{prefix}_{name}_energy", title=f"spring of {what}", group=group,
            right="energy is kept where the oscillation can be resolved; where not, the engine reports it",
            figure="largest change of energy that is not announced", limit=1e-6,
            measure=partial(_energy, stiffness, touches),
        ),
    ]  # fmt: skip


def _damper(damping: float, kind: str, *, touches: bool) -> StabilityCase:
    unit = {"damper": "N s/m", "drag": "kg/s", "drag_quadratic": "kg/m"}[kind]
    scene = ", in a scene with contacts" if touches else ""
    prefix = f"{kind}_touching" if touches else kind
    return StabilityCase(
        name=f"{prefix}_{damping:.0e}".replace("+", "").replace("e0", "e"),
        title=f"{kind.replace('_', ', ')} of {damping:g} {unit} on a falling body of 1 kg{scene}",
        group="dampers",
        right="the velocity goes to the one at which the weight is carried, never past it",
        figure="how far past, or off at the end", unit="m/s", limit=1e-9,
        measure=partial(_past_limit, damping, kind, touches),
    )  # fmt: skip


def _swings(stiffness: float, *, touches: bool) -> list[StabilityCase]:
    scene = "in a scene with contacts" if touches else "alone"
    prefix = f"swing{'_touching' if touches else ''}_damped_{stiffness:.0e}".replace("+", "")
    title = f"bob swinging on a spring of {stiffness:g} N/m with a damper of 1e9 N s/m, {scene}"
    return [
        StabilityCase(
            name=f"{prefix}_energy", title=title, group="dampers",
            right="a damper takes nothing from what only swings across it, and never gives",
            figure="largest change of energy", limit=1e-4,
            measure=partial(_swing_change, touches, stiffness),
        ),
        StabilityCase(
            name=f"{prefix}_along", title=title, group="dampers",
            right="the velocity stays across the rod: nothing rings along it",
            figure="largest velocity along the rod", unit="m/s", limit=1e-3,
            measure=partial(_along_the_rod, touches, stiffness),
        ),
    ]  # fmt: skip


SPRINGS = [
    case
    for touches in (False, True)
    for name, stiffness in _STIFFNESS.items()
    for case in _of_spring(name, stiffness, touches=touches)
] + [
    case
    for touches in (False, True)
    for case in (
        *(_damper(damping, kind, touches=touches) for kind in ("damper", "drag") for damping in (1e6, 1e12)),
        _damper(1e9, "drag_quadratic", touches=touches),
        *_swings(1e6, touches=touches),
        *_swings(1e12, touches=touches),
    )
]
