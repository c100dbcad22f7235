"""A random scene whose outcome is known, and what it is made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.lab.accuracy.twins import Document

__all__ = ["KnownScene", "State", "body", "still", "written"]

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


def still(name: str, place: tuple[float, float], size: tuple[float, float], *, angle: float = 0.0,
          restitution: float = 0.0, friction: float = 0.0, velocity: tuple[float, float] | None = None,
          ) -> dict[str, Any]:  # fmt: skip
    """Return a box that nothing moves; one with a velocity is driven."""
    driven = {} if velocity is None else {"Velocity": {"linear": list(velocity)}}
    return {
        "id": name,
        "Transform": {"position": list(place), "angle": angle},
        "Shape": {"kind": "box", "width": size[0], "height": size[1]},
        "Material": {"restitution": restitution, "friction": friction},
        **driven,
    }


def body(name: str, place: tuple[float, float], *, velocity: tuple[float, float] = (0.0, 0.0),
         spin: float = 0.0, mass: float = 1.0, radius: float = 0.0,
         size: tuple[float, float] | None = None, angle: float = 0.0,
         restitution: float = 0.0, friction: float = 0.0, **parts: Any) -> dict[str, Any]:  # fmt: skip
    """Return a body that moves: a disc, a box where it has a size, or a point where it has neither."""
    shape = {"kind": "circle", "radius": radius} if size is None else {
        "kind": "box", "width": size[0], "height": size[1]
    }  # fmt: skip
    touches = {"Shape": shape, "Material": {"restitution": restitution, "friction": friction}}
    return {
        "id": name,
        "Transform": {"position": list(place), "angle": angle},
        "Velocity": {"linear": list(velocity), "angular": spin},
        "Mass": {"mass": mass},
        **(touches if radius or size else {}),
        **parts,
    }
