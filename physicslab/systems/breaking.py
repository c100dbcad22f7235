"""Joints that break."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.sentences import sentence
from physicslab.state.joint_figures import figures_of
from physicslab.state.joints import Joint
from physicslab.state.state import State
from physicslab.systems.joint import remove_joint
from physicslab.systems.system import Stage, System, at

_BOUNDS = ("breaks", "breaks_torque")


class Break(NamedTuple):
    """A joint that broke: when [s], what carried it, its kind, and the force [N] and torque [N m] then."""

    time: float
    entity: int
    kind: str
    force: float
    torque: float
    label: str

    def __str__(self) -> str:
        figure = f"{self.torque:.4g} N m" if self.torque else f"{self.force:.4g} N"
        return f"{self.label} broke at t = {self.time:.6g} s, under {figure}"


class BreakSystem(System):
    """Removes joints on which there is more force or torque at the end of a step than they bear.

    Where that is known at any time, a step ends when it comes to that (:mod:`physicslab.stepping.breaks`).

    Attributes
    ----------
    broken : tuple of Break
        Those that broke, in order.
    """

    def __init__(self) -> None:
        self.broken: tuple[Break, ...] = ()

    def keep(self) -> tuple[NDArray[Any], ...]:
        """Return how many joints were broken, an array (1,)."""
        return (np.array([len(self.broken)]),)

    def restore(self, kept: tuple[NDArray[Any], ...]) -> None:
        """Forget what broke later than the number ``kept`` says, an array (1,)."""
        self.broken = self.broken[: int(kept[0][0])]

    def why_left_out(self, state: State) -> str | None:
        """Needed where a joint can break."""
        return None if next(_breakable(state), None) is not None else sentence("no_breaking")

    @at(Stage.FINISH)
    def remove(self, state: State, h: float) -> None:
        """Remove the joints that do not bear their load."""
        end = state.time + h
        self.broken = tuple(one for one in self.broken if one.time < end)  # the clock may have been set back
        figures = figures_of(state)
        forces, torques = np.hypot(*figures.force.T), np.abs(figures.torque)
        numbers = {joint: number for number, joint in enumerate(state.joints.joints)}
        for joint, bounds in list(_breakable(state)):
            force, torque = float(forces[numbers[joint]]), float(torques[numbers[joint]])
            beyond = force > bounds[0], torque > bounds[1]
            if any(beyond):
                label = state.label(joint.entity)
                own = Break(end, joint.entity, joint.kind.__name__, force, torque * beyond[1], label)
                self.broken = (*self.broken, own)
                remove_joint(joint.entity, joint.kind)


def _breakable(state: State) -> Iterator[tuple[Joint, tuple[float, ...]]]:
    """Yield the joints that can break, each with the force [N] and the torque [N m] that it bears."""
    for joint in state.joints.joints:
        table, row = state.table(joint.kind), state.entity_index.row_of[joint.entity]
        known = {spec.name for spec in joint.kind.FIELDS}
        bounds = tuple(
            float(table[name][row]) if name in known and table[f"{name}_given"][row] else math.inf
            for name in _BOUNDS
        )
        if min(bounds) < math.inf:
            yield joint, bounds


def load_of(state: State) -> float:
    """Return the largest load of any joint now, as a share of what that bears; 0 where none can break."""
    figures = figures_of(state)
    loads = np.stack((np.hypot(*figures.force.T), np.abs(figures.torque)), axis=1).tolist()
    numbers = {joint: number for number, joint in enumerate(state.joints.joints)}
    each = [
        pair
        for joint, bounds in _breakable(state)
        for pair in zip(loads[numbers[joint]], bounds, strict=True)
    ]
    return max((load / bound if bound else math.inf for load, bound in each if load), default=0.0)


def breaks_of(systems: tuple[System, ...], time: float) -> tuple[Break, ...]:
    """Return the joints that broke until a ``time`` [s]."""
    found = (system.broken for system in systems if isinstance(system, BreakSystem))
    return tuple(one for broken in found for one in broken if one.time <= time)
