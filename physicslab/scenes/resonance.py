"""Bobs on springs that are shaken alike."""

import math

from physicslab.components import Drag, Mass, Shape, Spring, Thrust, Trail, Transform, Velocity
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_DRIVE = 1.0
"""Frequency of the force [Hz]."""


@Scene(
    title="Resonance",
    description="Seven bobs on springs are shaken alike at 1 Hz: the one that is in tune swings widest.",
    view=(-4.4, -1.4, 4.4, 2.8),
    moment=3.0,
    teaches=("oscillations", "energy"),
    tags=("springs", "solid bodies"),
    also="vibration, oscillator",
)
def resonance(world: Contents) -> None:
    for n, frequency in enumerate((0.6, 0.75, 0.9, 1.0, 1.1, 1.25, 1.4)):
        x = 1.2 * n - 3.6
        world.spawn(
            Transform((x, 0.0)), Velocity(), Mass(1.0), Shape.circle(0.15), Drag(linear=0.4), Trail(1.0),
            Spring(anchor_b=(x, 2.5), rest_length=2.5, stiffness=(2.0 * math.pi * frequency) ** 2),
            Thrust((0.0, 2.0), frequency=_DRIVE), name=f"{frequency:g} Hz",
        )  # fmt: skip
