"""Configuration: frozen records that a world, a scene file and the window are set up with."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from numbers import Real
from typing import Any, ClassVar

from physicslab.columns import InvalidValue
from physicslab.vector import Vector2

__all__ = ["GRAVITY_MODES", "SOFTENING_LAWS", "PhysicsConfig", "SimulationConfig", "WindowConfig"]

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


def _number(
    owner: str, name: str, value: object, *, minimum: float = -math.inf, above: float = -math.inf, maximum: float = math.inf
) -> float:
    words = "a finite number"
    if above > -math.inf:
        words += f" > {above:g}"
    elif maximum < math.inf:
        words += f" from {minimum:g} to {maximum:g}"
    elif minimum > -math.inf:
        words += f" >= {minimum:g}"
    if isinstance(value, Real) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if math.isfinite(number) and minimum <= number <= maximum and number > above:
            return number
    raise InvalidValue(owner, name, value, words)


def _whole(owner: str, name: str, value: object, minimum: int, maximum: int) -> int:
    if isinstance(value, int) and not isinstance(value, bool) and minimum <= value <= maximum:
        return value
    raise InvalidValue(owner, name, value, f"a whole number from {minimum} to {maximum}")


def _choice(owner: str, name: str, value: object, choices: Sequence[str]) -> None:
    if not isinstance(value, str) or value not in choices:
        raise InvalidValue(owner, name, value, "one of " + ", ".join(f'"{choice}"' for choice in choices))


def _flag(owner: str, name: str, value: object) -> None:
    if not isinstance(value, bool):
        raise InvalidValue(owner, name, value, "true or false")


def _numbers(owner: str, name: str, value: object, count: int, words: str) -> tuple[float, ...]:
    if isinstance(value, Vector2):
        value = tuple(value)
    if isinstance(value, Sequence) and not isinstance(value, str) and len(value) == count:
        try:
            return tuple(_number(owner, name, part) for part in value)
        except InvalidValue:
            pass
    raise InvalidValue(owner, name, value, words)


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
    linear_damping, angular_damping : float
        Rates [1/s] at which velocities decay.
    bounds : tuple of four floats, optional
        Walls of the world ``(xmin, ymin, xmax, ymax)`` [m].
    bounds_restitution, bounds_friction : float
        The walls' material.
    """

    gravity_mode: str = "linear"
    gravity: Vector2 = Vector2(0.0, -9.81)
    G: float = 1.0
    softening: float = 0.0
    softening_law: str = "clamp"
    linear_damping: float = 0.0
    angular_damping: float = 0.0
    bounds: tuple[float, float, float, float] | None = None
    bounds_restitution: float = 0.5
    bounds_friction: float = 0.3

    section: ClassVar[str] = "physics"

    def __post_init__(self) -> None:
        put: Any = lambda name, value: object.__setattr__(self, name, value)  # noqa: E731
        _choice(self.section, "gravity_mode", self.gravity_mode, GRAVITY_MODES)
        words = "two finite numbers [gx, gy] m/s^2"
        put("gravity", Vector2(*_numbers(self.section, "gravity", self.gravity, 2, words)))
        put("G", _number(self.section, "G", self.G))
        for name in ("softening", "linear_damping", "angular_damping", "bounds_friction"):
            put(name, _number(self.section, name, getattr(self, name), minimum=0.0))
        _choice(self.section, "softening_law", self.softening_law, SOFTENING_LAWS)
        put("bounds_restitution", _number(self.section, "bounds_restitution", self.bounds_restitution, minimum=0.0, maximum=1.0))
        if self.bounds is not None:
            words = "null or four finite numbers [xmin, ymin, xmax, ymax] m with xmin < xmax and ymin < ymax"
            bounds = _numbers(self.section, "bounds", self.bounds, 4, words)
            if not (bounds[0] < bounds[2] and bounds[1] < bounds[3]):
                raise InvalidValue(self.section, "bounds", list(bounds), words)
            put("bounds", bounds)


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
        Sweeps of the contact solver a substep; ``None`` leaves it to the solver (one).
    integrator : str
        A method by name, or ``"auto"``.
    sleeping : bool
        Whether settled bodies may stop being simulated.
    collisions : str
        ``"step"`` (found and resolved within steps), ``"exact"`` (contact times located) or ``"auto"``.
    """

    dt: float = 1.0 / 60.0
    substeps: int = 4
    iterations: int | None = None
    integrator: str = "auto"
    sleeping: bool = True
    collisions: str = "auto"

    section: ClassVar[str] = "simulation"

    def __post_init__(self) -> None:
        object.__setattr__(self, "dt", _number(self.section, "dt", self.dt, above=0.0))
        _whole(self.section, "substeps", self.substeps, 1, 10_000)
        if self.iterations is not None:
            _whole(self.section, "iterations", self.iterations, 1, 1_000)
        _choice(self.section, "integrator", self.integrator, INTEGRATORS)
        _flag(self.section, "sleeping", self.sleeping)
        _choice(self.section, "collisions", self.collisions, COLLISIONS)


@dataclass(frozen=True, slots=True)
class WindowConfig:
    """The window and its clock.

    Attributes
    ----------
    size : tuple of two ints
        Width and height at the start [px].
    fps : int
        Cap on the frame rate [1/s].
    pixels_per_metre : float
        Scale of the default camera.
    max_dt : float
        The longest time [s] that one frame makes up for; what lies beyond is dropped, and the HUD says so.
    throw_window : float
        How far back [s] the cursor's history counts for a throw.
    max_throw_speed : float
        Cap on the speed of a throw [m/s].
    """

    size: tuple[int, int] = (1280, 720)
    fps: int = 60
    pixels_per_metre: float = 100.0
    max_dt: float = 0.1
    throw_window: float = 0.15
    max_throw_speed: float = 30.0


def field_names(config: type[PhysicsConfig] | type[SimulationConfig]) -> tuple[str, ...]:
    """Return the names of a record's fields, in order."""
    return tuple(f.name for f in fields(config))
