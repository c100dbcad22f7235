"""How a body resists forces and torques."""

from physicslab.columns import Component, Derived, InvalidValue, component, field

LEAST = 1e-300
"""The smallest mass [kg]; of much smaller ones the inverse is infinite."""


@component
class Mass(Component):
    """How a body resists forces and torques. A moving entity without it is kinematic: infinitely heavy."""

    mass: float = field(default=1.0, unit="kg", above=0.0, meaning="resistance to force")
    inertia: Derived = field(
        default=None,
        unit="kg m^2",
        above=0.0,
        derived="from the Shape",
        meaning="moment of inertia about the centre of mass",
    )
    fixed_rotation: bool = field(
        default=False, meaning="whether the body keeps its angle whatever the torque"
    )

    def validate(self) -> None:
        """Check that the inverse of the mass, by which forces act, is a finite number."""
        if self.mass < LEAST:
            raise InvalidValue("Mass", "mass", self.mass, f"a finite number > 0 kg, at least {LEAST:g}")
