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

from physicslab.kernels import interpreter, motion, twins
from physicslab.kernels.constraint import pair
from physicslab.kernels.events import path
from physicslab.kernels.interpreter import interpreted
from physicslab.kernels.rigid import constraints, curve

__all__ = ["FAULT", "WRONG_DRIFTS", "WRONG_KICKS", "lost_impulses", "mutated"]

FAULT = 1.001
"""By what a wrong kick and a wrong drift are multiplied."""

type Twin = Callable[..., Any]
type Mutant = Callable[..., Any]
"""Called with the function that it replaces, and with that one's arguments."""


def _name(value: Any) -> tuple[Any, Any] | None:
    return (value.__module__, value.__name__) if isinstance(value, FunctionType) else None


@contextmanager
def mutated(function: Any, mutant: Mutant) -> Iterator[None]:
    """Interpret all kernels, and replace one, or a function that they call, within a ``with`` block."""
    interpreter.prepare()
    right = twins._counterpart(function)

    def wrong(*arguments: Any) -> Any:
        return mutant(right, *arguments)

    twin_of = interpreter.twin_of
    with ExitStack() as stack:
        for names in twins._modules.values():
            for name, value in list(names.items()):
                # A function may have two twins: one is made within the making of the other.
                if _name(value) == _name(right):
                    stack.enter_context(patch.dict(names, {name: wrong}))
        found = patch.object(interpreter, "twin_of", lambda one: wrong if one is function else twin_of(one))
        stack.enter_context(found)
        stack.enter_context(interpreted())
        yield


def _longer(twin: Twin, *arguments: Any) -> Any:
    """Change the time of a kick or a drift [s], its last argument."""
    return twin(*arguments[:-1], FAULT * arguments[-1])


def _further(twin: Twin, paths: Any, i: int, now: float, low: float) -> Any:
    """Change the way of a body, or how its velocity has changed, since its path began."""
    column = 0 if twin.__name__ == "place" else 4
    x, x_low, y, y_low = twin(paths, i, now, low)
    x0, y0 = paths[i, column], paths[i, column + 2]
    return x0 + FAULT * (x - x0), x_low, y0 + FAULT * (y - y0), y_low


def _stronger(twin: Twin, scene: Any, *arguments: Any) -> None:
    """Change the accelerations of bodies, the last argument."""
    twin(scene, *arguments)
    arguments[-1][: 2 * scene.rows] *= FAULT


def _off_the_curve(twin: Twin, stages: Any, q: Any, v: Any, h: float, s: float, i: int) -> None:
    """Change the way along a piece of rigid motion."""
    twin(stages, q, v, h, s, i)
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

    def pushed(twin: Twin, v: Any, mass: Any, *impulse: Any) -> Any:
        return twin(v, mass, *impulse)._replace(bx=v.bx, by=v.by, wb=v.wb)

    def not_pushed(twin: Twin, paths: Any, i: int, *impulse: Any) -> None:
        if i not in rows:
            twin(paths, i, *impulse)

    def applied(twin: Twin, scene: Any, equations: Any, count: int, target: Any) -> None:
        places = [place for row in rows for place in (2 * row, 2 * row + 1, 2 * scene.rows + row)]
        before = np.array(target[places])
        twin(scene, equations, count, target)
        target[places] = before

    faults: tuple[tuple[Any, Mutant], ...] = (
        (pair.after_impulse, pushed), (path.push, not_pushed), (constraints.apply, applied),
    )  # fmt: skip
    with ExitStack() as stack:
        for function, mutant in faults:
            stack.enter_context(mutated(function, mutant))
        yield
