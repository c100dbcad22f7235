"""Things to spawn, one file each: functions that take a world and SI numbers and return entity numbers.

They give no more than components; what they make can be changed like anything else. Those that scatter things
take a ``seed``, and give the same things for the same seed.
"""

from physicslab.prefabs.body import BodyOptions, body
from physicslab.prefabs.box import box
from physicslab.prefabs.capsule import capsule
from physicslab.prefabs.chain import chain
from physicslab.prefabs.circle import circle
from physicslab.prefabs.container import container
from physicslab.prefabs.gas import gas
from physicslab.prefabs.pendulum import pendulum
from physicslab.prefabs.pile import pile
from physicslab.prefabs.planets import Planet, binary, planets
from physicslab.prefabs.pyramid import pyramid
from physicslab.prefabs.stack import stack

__all__ = [
    "BodyOptions", "Planet", "binary", "body", "box", "capsule", "chain", "circle", "container", "gas",
    "pendulum", "pile", "planets", "pyramid", "stack",
]  # fmt: skip
