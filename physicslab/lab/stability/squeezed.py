"""A box that spins against a wall, and discs that a piston squeezes beyond their volume."""

from __future__ import annotations

from functools import cache, partial

import numpy as np

from physicslab.components import Material, Shape, Transform, Velocity
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.stability.contact_models import MODELS, touching_space
from physicslab.lab.worlds import energy_growth, place
from physicslab.prefabs import box, circle
from physicslab.world import World

__all__ = ["SQUEEZED"]

_SPIN = 1e4
_DISCS, _RADIUS = 20, 0.25


def _spinning(contacts: str, e: float) -> tuple[World, int]:
    """Return a box of 50 cm that flies at a wall at 5 m/s while it spins, and the box."""
    world = touching_space(contacts, gravity=None)
    box(world, (2.0, 0.0), width=1, height=20, static=True, restitution=e, friction=0.5)
    spinning = box(
        world, (0.0, 0.0), width=0.5, height=0.5, velocity=(5, 0), angular_velocity=_SPIN, restitution=e,
        friction=0.5,
    )  # fmt: skip
    return world, spinning


def _spin_growth(contacts: str, e: float) -> float:
    world, _ = _spinning(contacts, e)
    return energy_growth(world, 60)


def _spin_through(contacts: str, e: float) -> float:
    """Return whether the box is ever behind the wall's face: 0 or 1."""
    world, spinning = _spinning(contacts, e)
    return float(any(place(world, spinning).x > 1.5 for _ in world.stepping(steps=60)))


@cache  # two cases look at one run
def _squeezed(contacts: str, speed: float) -> tuple[float, float]:
    """Return how many discs leave a cylinder, and how fast the fastest is, in speeds of the piston.

    The piston ends where half of the room is left that discs of their area need.
    """
    world = touching_space(contacts, gravity=None)
    width, height = 5 * 2.2 * _RADIUS, 4 * 2.2 * _RADIUS
    for x in (-0.5, width + 0.5):
        box(world, (x, 0.0), width=1, height=10 * height, static=True, friction=0.3)
    box(world, (0.5 * width, -0.5), width=width + 2, height=1, static=True, friction=0.3)
    pitch = 2.2 * _RADIUS
    discs = [
        circle(world, (pitch * (i % 5 + 0.5), pitch * (i // 5 + 0.5)), radius=_RADIUS, friction=0.3)
        for i in range(_DISCS)
    ]
    plate = Shape.box(width, 1.0), Material(0.0, 0.3)  # without a mass nothing holds it up
    piston = world.spawn(Transform((0.5 * width, height + 0.5)), Velocity((0.0, -speed)), *plate)
    end = 0.5 * _DISCS * np.pi * _RADIUS**2 / width
    seconds = (height - end) / speed
    fastest, outside = 0.0, 0.0
    rows = [world.component(disc, Transform) for disc in discs]
    for done in world.stepping(steps=max(1, round(60.0 * (seconds + 1.0)))):
        if done / 60.0 >= seconds:
            world.component(piston, Velocity).linear = (0.0, 0.0)
        top = place(world, piston).y - 0.5
        linear = world.table(Velocity)["linear"]
        fastest = max(fastest, float(np.hypot(linear[:, 0], linear[:, 1]).max()) / speed)
        out = [not (0.0 < row.position.x < width and 0.0 < row.position.y < top) for row in rows]
        outside = max(outside, float(sum(out)))
    return outside, fastest


def _outside(contacts: str, speed: float) -> float:
    return _squeezed(contacts, speed)[0]


def _fastest(contacts: str, speed: float) -> float:
    return _squeezed(contacts, speed)[1]


SQUEEZED = [
    *(
        StabilityCase(
            name=f"spin_1e4_e{e:g}_{kind}_{contacts}",
            title=f"a box that spins at 1e4 rad/s against a wall, e = {e:g}, {model}, 1 s", group="spins",
            right=right, figure=figure, limit=limit, measure=partial(measure, contacts, e),
        )
        for e in (0.0, 0.5, 1.0)
        for contacts, model in MODELS.items()
        for kind, right, figure, limit, measure in (
            ("energy", "energy never grows", "growth, of that at the start", 1e-9, _spin_growth),
            ("through", "it does not pass through", "whether it is behind the face", 0.0, _spin_through),
        )
    ),
    *(
        StabilityCase(
            name=f"piston_{speed:g}_{kind}_{contacts}",
            title=f"a piston of {speed:g} m/s presses 20 discs into half of their own area, {model}",
            group="pistons", right=right, figure=figure, limit=limit,
            measure=partial(measure, contacts, speed), run=f"piston_{speed:g}_{contacts}",
        )
        for speed in (0.2, 2.0, 20.0)
        for contacts, model in MODELS.items()
        for kind, right, figure, limit, measure in (
            ("outside", "none leaves the cylinder", "discs outside", 0.0, _outside),
            ("speed", "none is flung aside at twice its speed", "fastest, of the piston", 2.0, _fastest),
        )
    ),
]  # fmt: skip
"""Their cases."""
