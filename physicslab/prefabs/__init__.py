"""Things to spawn, one file each: functions that take a world and SI numbers and return entity numbers.

They give no more than components; what they make can be changed like anything else. Those that scatter things
take a ``seed``, and give the same things for the same seed.
"""

from physicslab.prefabs.body import BodyOptions, body, box, capsule, circle, polygon
from physicslab.prefabs.chain import chain, pendulum
from physicslab.prefabs.container import container
from physicslab.prefabs.gas import gas
from physicslab.prefabs.gears import gears
from physicslab.prefabs.outlines import convex_parts, outline
from physicslab.prefabs.pile import pile, pyramid, stack
from physicslab.prefabs.planets import Planet, binary, planets
from physicslab.prefabs.ragdoll import ragdoll
from physicslab.prefabs.terrain import ground, loop, ramp, regular_polygon, wedge

__all__ = [
    "BodyOptions", "Planet", "binary", "body", "box", "capsule", "chain", "circle", "container",
    "convex_parts", "gas", "gears", "ground", "loop", "outline", "pendulum", "pile", "planets",
    "polygon", "pyramid", "ragdoll", "ramp", "regular_polygon", "stack", "wedge",
]  # fmt: skip
