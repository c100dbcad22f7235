"""Quantities of bodies, joints, springs and the world: names and units, the one list of them."""

from collections.abc import Iterator
from dataclasses import dataclass

from physicslab.ecs.fields import InvalidValue

JOINT = "joint"
"""Stands for a component of any kind of joint."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """Something that can be measured.

    Attributes
    ----------
    name : str
        Its name in scene files and in the window.
    unit : str
        Its SI unit, as fields have it: ``"kg m^2/s"``.
    column : str
        Its name in the table of ``run --csv``.
    of_body, of_world : bool
        Whether a body has it, and whether the world has.
    carrier : str
        The component that an entity needs for it: ``"Transform"``, ``"Spring"``, or ``JOINT``.
    group : str
        The part of a menu in which it stands; empty for the menu itself.
    """

    name: str
    unit: str
    column: str
    of_body: bool = True
    of_world: bool = False
    group: str = ""
    carrier: str = "Transform"

    @property
    def of_entity(self) -> bool:
        """Whether a body, a joint or a spring has it."""
        return self.of_body or self.carrier != "Transform"

    @property
    def heading(self) -> str:
        """The heading of its column in a table."""
        return f"{self.column} [{self.unit}]"


ENERGY_CAUSES = (
    "edits", "hand", "thrust", "motors", "fields", "impacts", "friction", "contact", "overlap", "damping",
    "joints",
)  # fmt: skip
"""Causes that change the energy of a world; each has an account."""
MOMENTUM_CAUSES = (*ENERGY_CAUSES, "gravity", "springs")
"""Causes from outside that change its momentum."""
UNMEASURED_MOMENTA = ("friction",)
"""The causes whose momentum is not measured by itself: that of friction is part of that of contacts."""


def _accounts() -> Iterator[Quantity]:
    """Yield the accounts of the world since they began, and the errors: what no account explains."""
    kinds = (
        ("J", "account", "error of energy", "Energy, by cause", ENERGY_CAUSES),
        ("N s", "impulse x", "error of momentum x", "Impulse along x, by cause", MOMENTUM_CAUSES),
        ("N s", "impulse y", "error of momentum y", "Impulse along y, by cause", MOMENTUM_CAUSES),
        (
            "N m s", "angular impulse", "error of angular momentum", "Angular impulse, by cause",
            MOMENTUM_CAUSES,
        ),
    )  # fmt: skip
    for unit, kind, error, group, causes in kinds:
        for cause in causes:
            yield Quantity(f"{kind}: {cause}", unit, f"{kind} {cause}", False, True, group)
        yield Quantity(error, unit, error, False, True, group)


QUANTITIES: dict[str, Quantity] = {
    quantity.name: quantity
    for quantity in (
        Quantity("x", "m", "x"),
        Quantity("y", "m", "y"),
        Quantity("angle", "rad", "angle"),
        Quantity("velocity x", "m/s", "vx"),
        Quantity("velocity y", "m/s", "vy"),
        Quantity("speed", "m/s", "speed"),
        Quantity("angular velocity", "rad/s", "omega"),
        Quantity("acceleration x", "m/s^2", "ax"),
        Quantity("acceleration y", "m/s^2", "ay"),
        Quantity("acceleration", "m/s^2", "acceleration"),
        Quantity("force x", "N", "fx"),
        Quantity("force y", "N", "fy"),
        Quantity("net force", "N", "force"),
        Quantity("momentum x", "kg m/s", "px", of_world=True),
        Quantity("momentum y", "kg m/s", "py", of_world=True),
        Quantity("momentum", "kg m/s", "momentum", of_world=True),
        Quantity("angular momentum", "kg m^2/s", "angular momentum", of_world=True),
        Quantity("kinetic energy", "J", "kinetic", of_world=True),
        Quantity("kinetic energy of translation", "J", "kinetic linear", of_world=True),
        Quantity("kinetic energy of rotation", "J", "kinetic angular", of_world=True),
        Quantity("potential energy", "J", "potential", of_world=True),
        Quantity("energy of gravity", "J", "potential gravity", of_body=False, of_world=True),
        Quantity("energy of springs", "J", "potential spring", of_body=False, of_world=True),
        Quantity("total energy", "J", "energy", of_world=True),
        Quantity("joint force x", "N", "joint fx", of_body=False, carrier=JOINT),
        Quantity("joint force y", "N", "joint fy", of_body=False, carrier=JOINT),
        Quantity("joint force", "N", "joint force", of_body=False, carrier=JOINT),
        Quantity("joint torque", "N m", "joint torque", of_body=False, carrier=JOINT),
        Quantity("spring force", "N", "spring force", of_body=False, carrier="Spring"),
        *_accounts(),
    )
}
"""All of them by name. Scene files hold the names."""
KIND_OF_UNIT = {
    "m": "position", "rad": "angle", "m/s": "velocity", "rad/s": "angular velocity", "m/s^2": "acceleration",
    "N": "force", "kg m/s": "momentum", "kg m^2/s": "angular momentum", "J": "energy", "N m": "torque",
    "N s": "momentum given", "N m s": "angular momentum given",
}  # fmt: skip
"""The kind of all quantities in a unit, in words."""
BODY_QUANTITIES = tuple(name for name, quantity in QUANTITIES.items() if quantity.of_body)
"""The names of those that a body has."""
JOINT_QUANTITIES = tuple(name for name, quantity in QUANTITIES.items() if quantity.carrier == JOINT)
"""The names of those that a joint has."""
SPRING_QUANTITIES = tuple(name for name, quantity in QUANTITIES.items() if quantity.carrier == "Spring")
"""The names of those that a spring has."""
WORLD_QUANTITIES = tuple(name for name, quantity in QUANTITIES.items() if quantity.of_world)
"""The names of those that the world has."""


def check_quantity(owner: str, name: str, body: int | None) -> None:
    """Raise :class:`InvalidValue` if a body, or the world for ``None``, has no such quantity."""
    allowed = why_not_of(name, body)
    if allowed is not None:
        raise InvalidValue(owner, "quantity", name, allowed)


def carrier_of(name: str) -> str:
    """Return what an entity must have that has a quantity; of the time, which all have, a place."""
    return QUANTITIES[name].carrier if name in QUANTITIES else "Transform"


def why_not_of(name: str, body: int | None) -> str | None:
    """Return what the name of a quantity must be, if no entity, or the world for ``None``, has one such.

    >>> why_not_of("x", 1) is None, "kinetic energy" in (why_not_of("x", None) or "")
    (True, True)
    """
    allowed = WORLD_QUANTITIES if body is None else BODY_QUANTITIES
    if name in allowed or (body is not None and name in JOINT_QUANTITIES + SPRING_QUANTITIES):
        return None
    words = ", ".join(f'"{other}"' for other in allowed if not QUANTITIES[other].group)
    more = ', or an account such as "account: friction",' if body is None else ""
    return f"one of {words}{more} where there is {'no' if body is None else 'a'} body"
