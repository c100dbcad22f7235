"""The components of entities, one file each. Presence decides what an entity is."""

from physicslab.components.drag import Drag
from physicslab.components.graph import Graph
from physicslab.components.graph_line import GraphLine
from physicslab.components.held import Held
from physicslab.components.mass import Mass
from physicslab.components.material import Material
from physicslab.components.meter import Meter
from physicslab.components.name import Name
from physicslab.components.shape import Shape
from physicslab.components.slider import Slider
from physicslab.components.spring import Spring
from physicslab.components.trail import Trail
from physicslab.components.transform import Transform
from physicslab.components.velocity import Velocity

__all__ = [
    "Drag",
    "Graph",
    "GraphLine",
    "Held",
    "Mass",
    "Material",
    "Meter",
    "Name",
    "Shape",
    "Slider",
    "Spring",
    "Trail",
    "Transform",
    "Velocity",
]
