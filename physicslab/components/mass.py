"""How a body resists forces and torques."""

from physicslab.ecs.component import Component, Derived, Number, component, field

MIN_MASS = 1e-300
"""The smallest mass [kg] and moment of inertia [kg m^2]: of much smaller ones the inverse is infinite."""


@component
class Mass(Component):
    """How a body resists forces and torques. A moving entity without it is kinematic: infinitely heavy."""

    mass: Number = field(default=1.0, unit="kg", minimum=MIN_MASS, meaning="resistance to force")
    inertia: Derived = field(
        default=None,
        unit="kg m^2",
        minimum=MIN_MASS,
        derived="from the Shape",
        meaning="moment of inertia about the centre of mass",
    )
    fixed_rotation: bool = field(
        default=False, meaning="whether the body keeps its angle whatever the torque"
    )
