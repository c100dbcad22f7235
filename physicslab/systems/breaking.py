"""Joints that break."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.sentences import sentence
from physicslab.state.joint_figures import is_overloaded
from physicslab.state.state import State
from physicslab.systems.joint import remove_joint
from physicslab.systems.system import Stage, System, at


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

    sampled = True

    def __init__(self) -> None:
        self.broken: tuple[Break, ...] = ()

    def attach(self, state: State) -> None:
        """Let steps end where a joint does not bear its load."""
        state.joints.watched = True

    def keep(self) -> tuple[NDArray[Any], ...]:
        """Return how many joints were broken, an array (1,)."""
        return (np.array([len(self.broken)]),)

    def restore(self, kept: tuple[NDArray[Any], ...]) -> None:
        """Forget what broke later than the number ``kept`` says, an array (1,)."""
        self.broken = self.broken[: int(kept[0][0])]

    def why_left_out(self, state: State) -> str | None:
        """Needed where a joint can break."""
        return None if state.joints.breakable else sentence("no_breaking")

    @at(Stage.FINISH)
    def remove(self, state: State, h: float) -> None:
        """Remove the joints that do not bear their load."""
        end = state.time + h
        self.broken = tuple(one for one in self.broken if one.time < end)  # the clock may have been set back
        if not is_overloaded(state):
            return
        joints = state.joints
        loads, bears = _loads_of(state).tolist(), joints.bears.tolist()
        for joint, (force, torque), bounds in zip(joints.joints, loads, bears, strict=True):
            if force > bounds[0] or torque > bounds[1]:
                label = state.label(joint.entity)
                turned = torque * (torque > bounds[1])
                own = Break(end, joint.entity, joint.kind.__name__, force, turned, label)
                self.broken = (*self.broken, own)
                remove_joint(joint.entity, joint.kind)


def _loads_of(state: State) -> NDArray[np.float64]:
    """Return the force [N] and the torque [N m] on each joint (j, 2), as they were found last."""
    loads = state.joints.loads
    return np.column_stack((np.hypot(loads[:, 0], loads[:, 1]), np.abs(loads[:, 2])))


def load_of(state: State) -> float:
    """Return the largest load of any joint now, as a share of what that bears; 0 where none can break."""
    if not state.joints.breakable:
        return 0.0
    is_overloaded(state)
    loads, bears = _loads_of(state), state.joints.bears
    with np.errstate(divide="ignore"):
        shares: NDArray[np.float64] = np.divide(loads, bears, out=np.zeros_like(loads), where=loads > 0.0)
    return float(shares.max())


def breaks_of(systems: tuple[System, ...], time: float) -> tuple[Break, ...]:
    """Return the joints that broke until a ``time`` [s]."""
    found = (system.broken for system in systems if isinstance(system, BreakSystem))
    return tuple(one for broken in found for one in broken if one.time <= time)
