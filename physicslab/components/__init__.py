"""The components of a body, one file each. Presence decides what an entity is."""

from physicslab.components.drag import Drag
from physicslab.components.held import Held
from physicslab.components.mass import Mass
from physicslab.components.material import Material
from physicslab.components.name import Name
from physicslab.components.note import Note
from physicslab.components.shape import Shape
from physicslab.components.spring import Spring
from physicslab.components.trail import Trail
from physicslab.components.transform import Transform
from physicslab.components.velocity import Velocity

__all__ = [
    "Drag",
    "Held",
    "Mass",
    "Material",
    "Name",
    "Note",
    "Shape",
    "Spring",
    "Trail",
    "Transform",
    "Velocity",
]
