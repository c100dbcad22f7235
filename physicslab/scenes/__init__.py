"""The built-in scenes, a file each, in one explicit list.

They are Python and not JSON: ten lines that call prefabs say what a scene of two thousand bodies is, can be
read and varied (the pyramid's base, the gas's seed), and are the examples that a contributor starts from.
``save_scene`` makes a file of any of them.

To add one: write a file with a :class:`Scene`, and name it here.
"""

from physicslab.scenes.billiards import BILLIARDS
from physicslab.scenes.bounces import BOUNCES
from physicslab.scenes.dominoes import DOMINOES
from physicslab.scenes.drop import DROP
from physicslab.scenes.gas import GAS
from physicslab.scenes.newtons_cradle import NEWTONS_CRADLE
from physicslab.scenes.pendulum import PENDULUM
from physicslab.scenes.pile import PILE
from physicslab.scenes.pyramid import PYRAMID
from physicslab.scenes.sandbox import SANDBOX
from physicslab.scenes.scene import Scene
from physicslab.scenes.slope import SLOPE
from physicslab.scenes.solar_system import SOLAR_SYSTEM
from physicslab.scenes.spring_chain import SPRING_CHAIN
from physicslab.scenes.stack import STACK
from physicslab.scenes.two_planets import TWO_PLANETS

__all__ = ["SCENES", "Scene"]

SCENES: dict[str, Scene] = {
    scene.name: scene
    for scene in (
        SANDBOX,
        DROP,
        BOUNCES,
        SLOPE,
        STACK,
        PYRAMID,
        DOMINOES,
        PILE,
        GAS,
        BILLIARDS,
        NEWTONS_CRADLE,
        PENDULUM,
        SPRING_CHAIN,
        TWO_PLANETS,
        SOLAR_SYSTEM,
    )
}
"""Every built-in scene by name: the playground that opens by itself, then from the simplest on."""
