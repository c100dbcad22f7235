"""Springs and dampers too stiff for the step."""

import math
from collections.abc import Callable
from functools import partial

from physicslab.components import Drag, Spring
from physicslab.ecs.component import Component
from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import GRAVITY, energy_change, largest, open_space, place, spawn_bob, velocity
from physicslab.world import World

_DT = 1.0 / 60.0
_STEPS = 1_000
_STRETCH = 0.01
_ASIDE = 0.01
"""Sideways [m/s]: what that adds to the stretch is too little for the limit."""
_STIFFNESS = {
    **{f"{rate:g}": (rate / _DT) ** 2 for rate in (0.1, 1.0, 1.9, 10.0, 100.0)},
    "k_1e12": 1e12,
}  # fmt: skip
"""The stiffness of each spring [N/m] on 1 kg, by omega dt or its own name."""
_SCENES = {False: "alone", True: "in a scene with contacts"}


def _hung(stiffness: float, below: float, *, gravity: float | None, touches: bool) -> tuple[World, int]:
    """Return a world with a body of 1 kg on a spring of 1 m, so far below its rest length [m]."""
    world = open_space(gravity=gravity, dt=_DT, contacts="soft")
    # The body swings sideways as well: along one line, the motion would be solved in closed form.
    swing = (0.0, 0.0) if gravity else (_ASIDE, 0.0)
    spring = Spring(rest_length=1.0, stiffness=stiffness)
    return world, spawn_bob(world, (0.0, -1.0 - below), swing, touches=touches, part=spring)


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
    changed = energy_change(world, world.stepping(steps=_STEPS))
    return 0.0 if "too fast to be followed" in world.plan.reason else changed


_BRAKES: dict[str, tuple[str, Callable[[float], Component]]] = {
    "damper": ("N s/m", lambda damping: Spring(rest_length=0.0, stiffness=0.0, damping=damping)),
    "drag": ("kg/s", lambda damping: Drag(linear=damping)),
    "drag_quadratic": ("kg/m", lambda damping: Drag(quadratic=damping)),
}
"""The unit of each damper, and what makes one."""


def _past_limit(damping: float, kind: str, touches: bool) -> float:
    """Return how far a body's velocity goes past that at which a damper carries its weight.

    As a share of the 1 m/s that it starts with; or how far it is from there at the end, if that is more.
    """
    world, brake = open_space(dt=_DT, contacts="soft"), _BRAKES[kind][1](damping)
    bob = spawn_bob(world, (0.0, -1.0), (0.0, -1.0), touches=touches, part=brake)
    falls = -math.sqrt(GRAVITY / damping) if kind == "drag_quadratic" else -GRAVITY / damping

    def past() -> float:
        return velocity(world, bob).y - falls

    return max(0.0, largest(world, _STEPS, past), abs(past()))


def _swing(touches: bool, stiffness: float) -> tuple[World, int]:
    """Return a world with a bob of 1 kg let go aside, on a spring of 1 m with a strong damper."""
    world = open_space(dt=_DT, contacts="soft")
    spring = Spring(rest_length=1.0, stiffness=stiffness, damping=1e9)
    return world, spawn_bob(world, (0.8, -0.6), touches=touches, part=spring)


def _swing_change(touches: bool, stiffness: float) -> float:
    world, _ = _swing(touches, stiffness)
    return energy_change(world, world.stepping(steps=_STEPS))


def _along_the_rod(touches: bool, stiffness: float) -> float:
    world, bob = _swing(touches, stiffness)
    return largest(
        world, _STEPS, lambda: abs(place(world, bob).dot(velocity(world, bob))) / place(world, bob).magnitude
    )


def _of_spring(name: str, stiffness: float, touches: bool) -> tuple[StabilityCase, ...]:
    scene, prefix = _SCENES[touches], "spring_touching" if touches else "spring"
    what = f"k = 1e12 N/m on 1 kg, {scene}" if name == "k_1e12" else f"omega dt = {name}, {scene}"
    case = partial(StabilityCase, group="springs")
    return (
        case(
            name=f"{prefix}_{name}_bounded", title=f"spring of {what}", limit=1.001,
            right="an undamped oscillation goes no further than it began, for 1,000 steps",
            figure="largest excursion, of the first", measure=partial(_excursion, stiffness, touches),
        ),
        case(
            name=f"{prefix}_{name}_rest", title=f"spring of {what}, with a weight", unit="m", limit=1e-9,
            right="what hangs at rest stays at the right place", figure="largest distance from it",
            measure=partial(_rest_error, stiffness, touches),
        ),
        case(
            name=f"{prefix}_{name}_energy", title=f"spring of {what}", limit=1e-6,
            right="energy is kept where the oscillation can be resolved; where not, the engine reports it",
            figure="largest change of energy that is not announced",
            measure=partial(_energy, stiffness, touches),
        ),
    )  # fmt: skip


_dampers = partial(StabilityCase, group="dampers")


def _damper(damping: float, kind: str, touches: bool) -> StabilityCase:
    prefix, scene = (f"{kind}_touching", f", {_SCENES[True]}") if touches else (kind, "")
    return _dampers(
        name=f"{prefix}_{damping:.0e}".replace("+", "").replace("e0", "e"), unit="m/s", limit=1e-9,
        title=f"{kind.replace('_', ', ')} of {damping:g} {_BRAKES[kind][0]} on a falling body of 1 kg{scene}",
        right="the velocity goes to the one at which the weight is carried, never past it",
        figure="how far past, or off at the end", measure=partial(_past_limit, damping, kind, touches),
    )  # fmt: skip


def _swings(stiffness: float, touches: bool) -> tuple[StabilityCase, ...]:
    prefix = f"swing{'_touching' if touches else ''}_damped_{stiffness:.0e}".replace("+", "")
    title = f"bob swinging on a spring of {stiffness:g} N/m with a damper of 1e9 N s/m, {_SCENES[touches]}"
    return (
        _dampers(
            name=f"{prefix}_energy", title=title, figure="largest change of energy", limit=1e-4,
            right="a damper takes nothing from what only swings across it, and never gives",
            measure=partial(_swing_change, touches, stiffness),
        ),
        _dampers(
            name=f"{prefix}_along", title=title, figure="largest velocity along the rod", unit="m/s",
            limit=1e-3, right="the velocity stays across the rod: nothing rings along it",
            measure=partial(_along_the_rod, touches, stiffness),
        ),
    )  # fmt: skip


SPRINGS = (
    *(
        case
        for touches in _SCENES
        for name, stiffness in _STIFFNESS.items()
        for case in _of_spring(name, stiffness, touches)
    ),
    *(
        case
        for touches in _SCENES
        for case in (
            *(_damper(damping, kind, touches) for kind in ("damper", "drag") for damping in (1e6, 1e12)),
            _damper(1e9, "drag_quadratic", touches),
            *_swings(1e6, touches),
            *_swings(1e12, touches),
        )
    ),
)
