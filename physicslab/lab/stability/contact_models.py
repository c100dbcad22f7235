"""Both models of contacts, for cases that are run with each."""

from __future__ import annotations

from physicslab.ecs.config import SimulationConfig
from physicslab.lab.worlds import empty_world
from physicslab.world import World

__all__ = ["MODELS", "touching_space"]

MODELS = {"soft": "soft contacts", "rigid": "rigid contacts"}
"""What they are called, by the word in a scene's ``simulation``."""


def touching_space(contacts: str, *, gravity: float | None = 9.81, **simulation: int | float) -> World:
    """Return an empty world with one of them, in which nothing sleeps and impacts belong to that model.

    Parameters
    ----------
    gravity : float, optional
        Downwards [m/s^2].
    **simulation
        Further fields of :class:`~physicslab.ecs.config.SimulationConfig`.
    """
    fixed = {"contacts": contacts, "collisions": "step", "sleeping": False}
    return empty_world(SimulationConfig(**fixed, **simulation), gravity=gravity)  # type: ignore[arg-type]
