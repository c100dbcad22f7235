"""A random scene whose outcome is known, and what it is made of."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from random import Random
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.lab.accuracy.variants import Document

type State = tuple[float, float, float, float, float, float]
"""x, y [m], angle [rad], vx, vy [m/s], spin [rad/s]."""


@dataclass(frozen=True, slots=True)
class KnownScene:
    """A scene, and where its moving bodies truly are at its end.

    Attributes
    ----------
    document : Document
        The scene, in which every entity has an id.
    seconds : float
        When its outcome is known, after its start [s].
    truth : callable
        Returns the states of the moving bodies then, in the order of the scene (n, 6), or their first n.
    """

    document: Document
    seconds: float
    truth: Callable[[], NDArray[np.float64]]


def between(draw: Random, low: float, high: float) -> float:
    """Return a number between two, whose logarithm is drawn evenly."""
    return math.exp(draw.uniform(math.log(low), math.log(high)))


def written(
    bodies: list[dict[str, Any]], dt: float, physics: dict[str, Any] | None = None, **simulation: Any
) -> Document:
    """Return a scene of some bodies; gravity is that of the earth unless laws are given."""
    return {
        "format": "physicslab-scene/1",
        "physics": physics or {},
        "simulation": {"dt": dt, **simulation},
        "entities": bodies,
    }


def still(
    name: str, place: tuple[float, float], size: tuple[float, float], *, angle: float = 0.0,
    restitution: float = 0.0, friction: float = 0.0, velocity: tuple[float, float] | None = None,
) -> dict[str, Any]:  # fmt: skip
    """Return a box that nothing moves; one with a velocity is driven."""
    driven = {} if velocity is None else {"Velocity": {"linear": list(velocity)}}
    return _thing(name, place, angle, size, 0.0, restitution, friction) | driven


def body(
    name: str, place: tuple[float, float], *, velocity: tuple[float, float] = (0.0, 0.0), spin: float = 0.0,
    mass: float = 1.0, radius: float = 0.0, size: tuple[float, float] | None = None, angle: float = 0.0,
    restitution: float = 0.0, friction: float = 0.0, **parts: Any,
) -> dict[str, Any]:  # fmt: skip
    """Return a body that moves: a disc, a box where it has a size, or a point where it has neither."""
    motion = {"Velocity": {"linear": list(velocity), "angular": spin}, "Mass": {"mass": mass}}
    return _thing(name, place, angle, size, radius, restitution, friction) | motion | parts


def _thing(
    name: str, place: tuple[float, float], angle: float, size: tuple[float, float] | None, radius: float,
    restitution: float, friction: float,
) -> dict[str, Any]:  # fmt: skip
    found: dict[str, Any] = {"id": name, "Transform": {"position": list(place), "angle": angle}}
    if size is not None:
        found["Shape"] = {"kind": "box", "width": size[0], "height": size[1]}
    elif radius:
        found["Shape"] = {"kind": "circle", "radius": radius}
    if "Shape" in found:
        found["Material"] = {"restitution": restitution, "friction": friction}
    return found


def spring(name: str, a: str, **fields: Any) -> dict[str, Any]:
    """Return a spring that holds a body."""
    return {"id": name, "Spring": {"a": a, **fields}}
