"""A ragdoll that falls down stairs."""

from physicslab import prefabs
from physicslab.components import Colour, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_STEPS, _WIDE, _HIGH = 6, 0.6, 0.35
"""How many stairs; how wide and how high each is [m]."""


@Scene(
    title="A ragdoll on stairs",
    description="Joints bend as far as a person's do; impacts, friction and joints take a fall's energy.",
    view=(-2.0, -0.3, 5.2, 4.4),
    moment=0.9,
    teaches=("energy", "friction", "collisions"),
    tags=("joints", "solid bodies"),
    also="doll",
    simulation=SimulationConfig(contacts="soft", substeps=12),
)
def ragdoll(world: Contents) -> None:
    for n in range(_STEPS):
        top = (_STEPS - n) * _HIGH
        wide, right = _WIDE if n else 2.0, (n + 0.5) * _WIDE
        prefabs.box(
            world, (right - 0.5 * wide, 0.5 * top), width=wide, height=top, static=True, friction=0.6,
            restitution=0.0, material="stone", name=f"stair {n + 1}",
        )  # fmt: skip
    prefabs.box(world, (3.0, -0.1), width=12.0, height=0.2, static=True, friction=0.8, name="floor")
    parts = prefabs.ragdoll(world, (-0.9, 3.6), size=1.0, angle=-0.9)
    colours = ("#56b4e9", "#f0c8a0", *("#56b4e9",) * 2, *("#f0c8a0",) * 2, *("#4a5a8a",) * 4)
    for part, colour in zip(parts, colours, strict=True):
        world.add(part, Colour(colour))
        world.component(part, Velocity).linear = (2.8, 0.2)
