"""PhysicsLab: a 2D physics sandbox for vectors, mechanics, momentum and collisions.

Examples
--------
>>> from physicslab import load_scene
>>> world = load_scene("two_planets")
>>> world.run(seconds=1.0)
>>> world.time
1.0
"""

from physicslab.fields import InvalidValue
from physicslab.scene import SceneError, load_scene, save_scene
from physicslab.vector import Vector2
from physicslab.world import World

__all__ = ["InvalidValue", "SceneError", "Vector2", "World", "load_scene", "save_scene"]
