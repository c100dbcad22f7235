"""The electric charge of a body."""

from physicslab.ecs.component import Component, Number, component, field


@component
class Charge(Component):
    """Lets a body act on other charges, and electric and magnetic fields on it.

    The laws are those of a scene: ``coulomb_constant``, ``electric_field`` and ``magnetic_field``.
    """

    charge: Number = field(default=1.0, unit="C", meaning="electric charge")
