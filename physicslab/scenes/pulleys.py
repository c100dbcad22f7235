"""Weights on ropes over pulleys."""

from physicslab.components import Meter, Pulley
from physicslab.prefabs import box
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_HEIGHT = 2.5
"""Height of the wheels [m]."""


@Scene(
    title="Pulleys",
    description="Atwood's machine: 1 kg against 1.2 kg; 1 kg on two lines, which balances 2 kg, against 2.4.",
    view=(-3.6, -0.4, 3.6, 3.0),
    teaches=("machines", "forces"),
    tags=("joints", "solid bodies"),
)
def pulleys(world: Contents) -> None:
    box(world, (0.0, -0.1), width=8.0, height=0.2, static=True, friction=0.8, name="floor")
    # The second rope goes twice to B: 2 kg are in balance with 1 kg.
    for n, (x, second, ratio, y) in enumerate(((-2.0, 1.2, 1.0, 1.4), (1.8, 2.4, 2.0, 0.8)), 1):
        left, right = x - 0.6, x + 0.6
        a = box(world, (left, 0.5), width=0.4, height=0.4, mass=1.0, name=f"left {n}")
        b = box(world, (right, y), width=0.5, height=0.5, mass=second, name=f"right {n}")
        rope = Pulley(a, b, (0.0, 0.2), (0.0, 0.25), (left, _HEIGHT), (right, _HEIGHT), ratio)
        world.spawn(rope, name=f"rope {n}")
        world.spawn(Meter("velocity y", b))
