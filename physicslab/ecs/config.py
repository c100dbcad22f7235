"""Configuration: frozen records that a world, a scene file and the window are set up with."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import FrozenInstanceError, dataclass, fields, replace
from functools import wraps
from typing import Any, ClassVar, Literal

from physicslab.ecs.fields import COORDINATE_LIMIT, Field, Kind
from physicslab.ecs.text import no_such
from physicslab.ecs.vector import Vector2

GRAVITY_MODES = ("linear", "planet", "none")
SOFTENING_LAWS = ("clamp", "plummer")
INTEGRATORS = (
    "auto",
    "symplectic_euler",
    "leapfrog",
    "rk4",
    "blanes_moan",
    "dop853",
    "exact",
    "implicit_midpoint",
)
COLLISIONS = ("auto", "step", "exact")
CONTACTS = ("auto", "rigid", "soft")
MIN_TIME = 1e-100
"""The shortest step [s]: the parts of shorter ones, and their squares, would soon underflow to zero."""
MAX_TIME = 1e100
"""The longest step [s]: what falls for a longer one, and its square, would soon be infinite."""


def _setting(default: object, kind: Kind, meaning: str, **ranges: Any) -> Any:
    """Describe a setting where it is declared; ``ranges`` are those of :class:`Field`."""
    return dataclasses.field(default=default, metadata={"spec": Field("", kind, meaning=meaning, **ranges)})


def _settle(config: PhysicsConfig | SimulationConfig) -> None:
    """Check every field by its description and store it as the type it is read as."""
    for spec in config.FIELDS:
        value: Any = getattr(config, spec.name)
        if value is None and spec.derived:
            continue
        stored = spec.check(value)
        if spec.kind == "vector":
            stored = Vector2(*stored)
        elif spec.kind == "choice":
            stored = spec.choices[stored - 1]
        object.__setattr__(config, spec.name, stored)


@dataclass(frozen=True, slots=True)
class PhysicsConfig:
    """The laws of one world.

    Attributes
    ----------
    gravity_mode : str
        ``"linear"`` (m g on every body with Mass), ``"planet"`` (pairwise, inverse square) or ``"none"``.
    gravity : Vector2
        Acceleration of the linear mode [m/s^2].
    G : float
        Constant of the planet mode [N m^2/kg^2].
    softening, softening_law : float, str
        Length [m] below which the inverse square law is softened, and how: ``"clamp"`` or ``"plummer"``.
    coulomb_constant : float
        Constant of the force of charges on each other [N m^2/C^2].
    electric_field, magnetic_field : Vector2, float
        The same everywhere [N/C], [T]; the magnetic one points out of the plane.
    linear_damping, angular_damping : float
        Rates [1/s] at which velocities decay.
    bounds : tuple of four floats, optional
        Walls of the world ``(xmin, ymin, xmax, ymax)`` [m].
    bounds_restitution, bounds_friction : float
        The walls' material.
    """

    gravity_mode: str = _setting("linear", "choice", "which law of gravity", choices=GRAVITY_MODES)
    gravity: Vector2 = _setting(
        Vector2(0.0, -9.81), "vector", "acceleration of the linear mode", unit="m/s^2"
    )
    G: float = _setting(1.0, "number", "constant of the planet mode", unit="N m^2/kg^2")
    softening: float = _setting(0.0, "number", "where the inverse square is softened", unit="m", minimum=0.0)
    softening_law: str = _setting("clamp", "choice", "how it is softened", choices=SOFTENING_LAWS)
    coulomb_constant: float = _setting(0.0, "number", "constant of Coulomb's law", unit="N m^2/C^2")
    electric_field: Vector2 = _setting(Vector2(), "vector", "force on a unit charge", unit="N/C")
    magnetic_field: float = _setting(0.0, "number", "magnetic field, out of the plane", unit="T")
    linear_damping: float = _setting(0.0, "number", "rate at which velocities decay", unit="1/s", minimum=0.0)
    angular_damping: float = _setting(0.0, "number", "rate at which spins decay", unit="1/s", minimum=0.0)
    bounds: tuple[float, float, float, float] | None = _setting(
        None, "box", "walls at xmin, ymin, xmax, ymax", unit="m", limit=COORDINATE_LIMIT, derived="no walls"
    )
    bounds_restitution: float = _setting(0.5, "number", "restitution of the walls", minimum=0.0, maximum=1.0)
    bounds_friction: float = _setting(0.3, "number", "Coulomb friction coefficient of the walls", minimum=0.0)

    section: ClassVar[str] = "physics"
    FIELDS: ClassVar[tuple[Field, ...]]

    def __post_init__(self) -> None:
        _settle(self)


def field_names(config: type[PhysicsConfig] | type[SimulationConfig]) -> tuple[str, ...]:
    """Return the names of a record's fields, in order."""
    return tuple(f.name for f in fields(config))


def _takes_fields_only(kind: type[PhysicsConfig] | type[SimulationConfig]) -> Callable[..., None]:
    """Return what makes a record as before, but says which fields there are where another is given."""
    made, known = vars(kind)["__init__"], field_names(kind)

    @wraps(made)
    def make(config: PhysicsConfig | SimulationConfig, *args: Any, **given: Any) -> None:
        for name in given:
            if name not in known:
                raise TypeError(no_such(kind.__name__, "field", name, known))
        made(config, *args, **given)

    return make


def _refuse(config: PhysicsConfig | SimulationConfig, name: str, value: object) -> None:
    """Refuse to change a part: a world notes that its laws are others where a record is assigned."""
    if name not in (known := field_names(type(config))):
        raise AttributeError(no_such(type(config).__name__, "field", name, known), name=None)
    record = f"world.{config.section}"
    raise FrozenInstanceError(
        f"{config.section}.{name} cannot be changed by itself: "
        f"{record} = dataclasses.replace({record}, {name}=...)"
    )


@dataclass(frozen=True, slots=True)
class SimulationConfig:
    """How one world is stepped.

    Attributes
    ----------
    dt : float
        Length of a step [s]: one frame's worth.
    substeps : int
        Into how many parts a step is divided.
    iterations : int, optional
        Sweeps of the contact solver a substep; ``None`` for the default of the solver (one).
    integrator : str
        A method by name, or ``"auto"``.
    sleeping : bool or str
        Whether bodies at rest may stop being simulated; ``"auto"`` for worlds of many bodies only.
    collisions : str
        ``"step"`` (found and resolved within steps), ``"exact"`` (contact times located) or ``"auto"``.
    contacts : str
        ``"rigid"`` (laws solved to rounding, events located; few bodies), ``"soft"`` (stiff springs, any
        number) or ``"auto"``: rigid where few bodies can touch, and beside exact collisions where they rest.
    tolerance : float
        Error a step that an adaptive method accepts, as a share of the largest coordinate and speed. Where
        stiff springs are damped, ``auto`` takes 1e-13 in place of the default.
    """

    dt: float = _setting(
        1.0 / 60.0, "number", "length of a step", unit="s", minimum=MIN_TIME, maximum=MAX_TIME
    )
    substeps: int = _setting(4, "whole", "parts that a step is divided into", minimum=1, maximum=10_000)
    iterations: int | None = _setting(
        None, "whole", "sweeps", minimum=1, maximum=1_000, derived="from the solver"
    )
    integrator: str = _setting("auto", "choice", "how forces and velocities act", choices=INTEGRATORS)
    sleeping: bool | Literal["auto"] = _setting(
        "auto", "flag", "whether bodies at rest are not simulated", choices=("auto",)
    )
    collisions: str = _setting("auto", "choice", "how contacts are found", choices=COLLISIONS)
    contacts: str = _setting("auto", "choice", "how bodies that touch are held apart", choices=CONTACTS)
    tolerance: float = _setting(
        1e-17, "number", "error a step of adaptive methods", minimum=1e-20, maximum=1e-2
    )

    section: ClassVar[str] = "simulation"
    FIELDS: ClassVar[tuple[Field, ...]]

    def __post_init__(self) -> None:
        _settle(self)


@dataclass(frozen=True, slots=True)
class WindowConfig:
    """The window and its clock.

    Attributes
    ----------
    size : tuple of two ints
        Width and height at the start [px].
    least_size : tuple of two ints
        Width and height that the window is made no smaller than [px].
    fps : int
        Cap on the frame rate [1/s].
    pixels_per_metre : float
        Scale of the default camera.
    max_dt : float
        The longest time [s] that one frame makes up for; the rest is dropped, and the HUD shows it.
    throw_window : float
        How far back [s] the cursor's history counts for a throw.
    max_throw_speed : float
        Cap on the speed of a throw [m/s].
    """

    size: tuple[int, int] = (1280, 720)
    least_size: tuple[int, int] = (640, 480)
    fps: int = 60
    pixels_per_metre: float = 100.0
    max_dt: float = 0.1
    throw_window: float = 0.15
    max_throw_speed: float = 30.0


for _kind in (PhysicsConfig, SimulationConfig):
    setattr(_kind, "__setattr__", _refuse)  # noqa: B010
    setattr(_kind, "__init__", _takes_fields_only(_kind))  # noqa: B010
    _kind.FIELDS = tuple(
        replace(f.metadata["spec"], name=f.name, owner=_kind.section) for f in fields(_kind) if f.metadata
    )
