"""The components of bodies and of what is measured with, one file each. Presence decides what a thing is."""

from physicslab.components.charge import Charge
from physicslab.components.colour import Colour
from physicslab.components.drag import Drag
from physicslab.components.gate import Gate
from physicslab.components.gear import Gear
from physicslab.components.graph import Graph, GraphLine
from physicslab.components.held import Held
from physicslab.components.layer import Layer
from physicslab.components.made_of import MadeOf
from physicslab.components.mass import Mass
from physicslab.components.material import Material
from physicslab.components.medium import Medium
from physicslab.components.meter import Meter
from physicslab.components.molecule import Molecule
from physicslab.components.name import Name
from physicslab.components.note import Note
from physicslab.components.pin import Pin
from physicslab.components.protractor import Protractor
from physicslab.components.pulley import Pulley
from physicslab.components.rod import Rod
from physicslab.components.rope import Rope
from physicslab.components.ruler import Ruler
from physicslab.components.shape import Shape
from physicslab.components.slider import Slider
from physicslab.components.slot import Slot
from physicslab.components.spring import Spring
from physicslab.components.strobe import Strobe
from physicslab.components.thrust import Thrust
from physicslab.components.trail import Trail
from physicslab.components.transform import Transform
from physicslab.components.velocity import Velocity
from physicslab.components.weld import Weld

__all__ = [
    "Charge", "Colour", "Drag", "Gate", "Gear", "Graph", "GraphLine", "Held", "Layer", "MadeOf", "Mass",
    "Material", "Medium", "Meter", "Molecule", "Name", "Note", "Pin", "Protractor", "Pulley", "Rod", "Rope",
    "Ruler", "Shape", "Slider", "Slot", "Spring", "Strobe", "Thrust", "Trail", "Transform", "Velocity",
    "Weld",
]  # fmt: skip
