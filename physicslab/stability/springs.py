"""Springs and dampers too stiff for the step."""

from __future__ import annotations

from functools import partial

from physicslab.components import Drag, Spring, Velocity
from physicslab.prefabs import circle
from physicslab.stability.case import Case
from physicslab.stability.worlds import energy_change, floor, largest, open_space, place, spawn_point
from physicslab.vector import Vector2
from physicslab.world import World

__all__ = ["SPRINGS"]

_DT = 1.0 / 60.0
_STEPS = 1_000
_STRETCH = 0.01
_ASIDE = 0.01
"""Sideways [m/s]: what that adds to the stretch is less than the limit sees."""
_G = 9.81
_STIFFNESS = {
    **{f"{rate:g}": (rate / _DT) ** 2 for rate in (0.1, 1.0, 1.9, 10.0, 100.0)},
    "k_1e12": 1e12,
}  # fmt: skip
"""Of each spring [N/m] on 1 kg, by omega dt or its own name."""


def _hung(stiffness: float, below: float, *, gravity: float | None, touches: bool) -> tuple[World, int]:
    """Return a world with a body of 1 kg on a spring of 1 m, so far below its rest length [m]."""
    world = open_space(gravity=gravity, dt=_DT)
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
    world, bob = _hung(stiffness, _G / stiffness, gravity=_G, touches=touches)
    rest = Vector2(0.0, -1.0 - _G / stiffness)
    return largest(world, _STEPS, lambda: (place(world, bob) - rest).magnitude)


def _energy(stiffness: float, touches: bool) -> float:
    """Return what energy changed by; nothing where the engine says that it does not follow the motion."""
    world, _ = _hung(stiffness, _STRETCH, gravity=None, touches=touches)
    changed = energy_change(world, _STEPS)
    return 0.0 if "too fast to be followed" in world.method.reason else changed


def _past_limit(damping: float, drag: bool) -> float:
    """Return how far a body's velocity goes past that at which a damper carries its weight.

    As a share of the 1 m/s that it starts with; or how far it is from there at the end, if that is more.
    """
    world = open_space(dt=_DT)
    brake = Drag(linear=damping) if drag else Spring(rest_length=0.0, stiffness=0.0, damping=damping)
    bob = spawn_point(world, (0.0, -1.0), (0.0, -1.0), brake)
    falls, end = -_G / damping, 0.0

    def past() -> float:
        return world.component(bob, Velocity).linear.y - falls

    most = largest(world, _STEPS, past)
    end = abs(past())
    return max(0.0, most, end)


def _of_spring(name: str, stiffness: float, *, touches: bool) -> list[Case]:
    scene = "in a scene with contacts" if touches else "alone"
    prefix = "spring_touching" if touches else "spring"
    group = "springs"
    what = f"k = 1e12 N/m on 1 kg, {scene}" if name == "k_1e12" else f"omega dt = {name}, {scene}"
    return [
        Case(
            name=f"{prefix}_{name}_bounded", title=f"spring of {what}", group=group,
            right="an undamped oscillation goes no further than it began, for 1,000 steps",
            figure="largest excursion, of the first", limit=1.001,
            measure=partial(_excursion, stiffness, touches),
        ),
        Case(
            name=f"{prefix}_{name}_rest", title=f"spring of {what}, with a weight", group=group,
            right="what hangs at rest stays at the right place",
            figure="largest distance from it", unit="m", limit=1e-9,
            measure=partial(_rest_error, stiffness, touches),
        ),
        Case(
            name=f"{prefix}_{name}_energy", title=f"spring of {what}", group=group,
            right="energy is kept where the oscillation can be resolved; where not, the engine says so",
            figure="largest change of energy that is not announced", limit=1e-6,
            measure=partial(_energy, stiffness, touches),
        ),
    ]  # fmt: skip


def _damper(damping: float, *, drag: bool) -> Case:
    kind, name = ("drag", "drag") if drag else ("damper", "damper")
    return Case(
        name=f"{name}_{damping:.0e}".replace("+", "").replace("e0", "e"),
        title=f"{kind} of {damping:g} {'kg/s' if drag else 'N s/m'} on a falling body of 1 kg",
        group="dampers",
        right="the velocity goes to the one at which the weight is carried, never past it",
        figure="how far past, or off at the end", unit="m/s", limit=1e-9,
        measure=partial(_past_limit, damping, drag),
    )  # fmt: skip


SPRINGS = [
    case
    for touches in (False, True)
    for name, stiffness in _STIFFNESS.items()
    for case in _of_spring(name, stiffness, touches=touches)
] + [_damper(damping, drag=drag) for drag in (False, True) for damping in (1e6, 1e12)]
