"""The components of bodies and of what is measured with, one file each. Presence decides what a thing is."""

from physicslab.components.charge import Charge
from physicslab.components.drag import Drag
from physicslab.components.gate import Gate
from physicslab.components.graph import Graph, GraphLine
from physicslab.components.held import Held
from physicslab.components.mass import Mass
from physicslab.components.material import Material
from physicslab.components.meter import Meter
from physicslab.components.name import Name
from physicslab.components.note import Note
from physicslab.components.pin import Pin
from physicslab.components.protractor import Protractor
from physicslab.components.ruler import Ruler
from physicslab.components.shape import Shape
from physicslab.components.slider import Slider
from physicslab.components.spring import Spring
from physicslab.components.strobe import Strobe
from physicslab.components.thrust import Thrust
from physicslab.components.trail import Trail
from physicslab.components.transform import Transform
from physicslab.components.velocity import Velocity

__all__ = [
    "Charge", "Drag", "Gate", "Graph", "GraphLine", "Held", "Mass", "Material", "Meter", "Name", "Note",
    "Pin", "Protractor", "Ruler", "Shape", "Slider", "Spring", "Strobe", "Thrust", "Trail", "Transform",
    "Velocity",
]  # fmt: skip
