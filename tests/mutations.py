"""Kernels with a fault: what a wrong method does must be seen as an error of the method, and as nothing else.

Within ``mutated`` all kernels run as Python (:mod:`physicslab.kernels.interpreter`), and one function of them
is replaced wherever kernels or Python call it. To try a stepper, name in :data:`WRONG_KICKS` and
:data:`WRONG_DRIFTS` what changes its velocities and its places.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from types import FunctionType
from typing import Any
from unittest.mock import patch

import numpy as np

from physicslab.kernels import interpreter, motion, python_fallback
from physicslab.kernels.constraint import pair
from physicslab.kernels.events import path
from physicslab.kernels.interpreter import interpreted
from physicslab.kernels.rigid import constraints, curve

__all__ = ["FAULT", "WRONG_DRIFTS", "WRONG_KICKS", "lost_impulses", "mutated"]

FAULT = 1.001
"""By what a wrong kick and a wrong drift are multiplied."""

type Fallback = Callable[..., Any]
type Mutant = Callable[..., Any]
"""Called with the function that it replaces, and with that one's arguments."""


def _name(value: Any) -> tuple[Any, Any] | None:
    return (value.__module__, value.__name__) if isinstance(value, FunctionType) else None


@contextmanager
def mutated(function: Any, mutant: Mutant) -> Iterator[None]:
    """Interpret all kernels, and replace one, or a function that they call, within a ``with`` block."""
    interpreter.prepare()
    right = python_fallback._counterpart(function)

    def wrong(*arguments: Any) -> Any:
        return mutant(right, *arguments)

    fallback_of = interpreter.fallback_of
    with ExitStack() as stack:
        for names in python_fallback._modules.values():
            for name, value in list(names.items()):
                # A function may have two fallbacks: one is made within the making of the other.
                if _name(value) == _name(right):
                    stack.enter_context(patch.dict(names, {name: wrong}))
        found = patch.object(
            interpreter, "fallback_of", lambda one: wrong if one is function else fallback_of(one)
        )
        stack.enter_context(found)
        stack.enter_context(interpreted())
        yield


def _longer(fallback: Fallback, *arguments: Any) -> Any:
    """Change the time of a kick or a drift [s], its last argument."""
    return fallback(*arguments[:-1], FAULT * arguments[-1])


def _further(fallback: Fallback, paths: Any, i: int, now: float, low: float) -> Any:
    """Change the way of a body, or how its velocity has changed, since its path began."""
    column = 0 if fallback.__name__ == "place" else 4
    x, x_low, y, y_low = fallback(paths, i, now, low)
    x0, y0 = paths[i, column], paths[i, column + 2]
    return x0 + FAULT * (x - x0), x_low, y0 + FAULT * (y - y0), y_low


def _stronger(fallback: Fallback, scene: Any, *arguments: Any) -> None:
    """Change the accelerations of bodies, the last argument."""
    fallback(scene, *arguments)
    arguments[-1][: 2 * scene.rows] *= FAULT


def _off_the_curve(fallback: Fallback, stages: Any, q: Any, v: Any, h: float, s: float, i: int) -> None:
    """Change the way along a piece of rigid motion."""
    fallback(stages, q, v, h, s, i)
    if i < len(q) - 1:  # not the clock
        stages.q[i] = q[i] + FAULT * (stages.q[i] - q[i])


WRONG_KICKS: dict[str, tuple[Any, Mutant]] = {
    "contact": (motion.kick, _longer),
    "fused_contact": (motion.kick, _longer),
    "event_driven": (path.velocity, _further),
    "rigid": (constraints.constrained_acceleration, _stronger),
}
"""By the name of a stepper: what changes its velocities, and how that goes wrong."""
WRONG_DRIFTS: dict[str, tuple[Any, Mutant]] = {
    "contact": (motion.drift, _longer),
    "fused_contact": (motion.drift, _longer),
    "event_driven": (path.place, _further),
    "rigid": (curve._place, _off_the_curve),
}
"""The same of places."""


@contextmanager
def lost_impulses(rows: set[int]) -> Iterator[None]:
    """Let no impulse of any contact move the bodies of some rows: B of their pairs.

    The impulses are found, and booked, as ever; the bodies that they act on besides these are moved.
    """

    def pushed(fallback: Fallback, v: Any, mass: Any, *impulse: Any) -> Any:
        return fallback(v, mass, *impulse)._replace(bx=v.bx, by=v.by, wb=v.wb)

    def not_pushed(fallback: Fallback, paths: Any, i: int, *impulse: Any) -> None:
        if i not in rows:
            fallback(paths, i, *impulse)

    def applied(fallback: Fallback, scene: Any, equations: Any, count: int, target: Any) -> None:
        places = [place for row in rows for place in (2 * row, 2 * row + 1, 2 * scene.rows + row)]
        before = np.array(target[places])
        fallback(scene, equations, count, target)
        target[places] = before

    faults: tuple[tuple[Any, Mutant], ...] = (
        (pair.after_impulse, pushed), (path.push, not_pushed), (constraints.apply, applied),
    )  # fmt: skip
    with ExitStack() as stack:
        for function, mutant in faults:
            stack.enter_context(mutated(function, mutant))
        yield
