"""Joints between bodies, or a body and a fixed point."""

from typing import Any

import esper
import numpy as np
from numpy.typing import NDArray

from physicslab.components import Gear, Name, Pin, Slot, Transform
from physicslab.components.gear import COUPLED, why_not_coupled
from physicslab.components.joint_ends import key_of, why_not_joined
from physicslab.contacts.arguments import do_stage
from physicslab.contacts.islands import wake_all
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.sentences import listed, sentence
from physicslab.kernels.solver import soft
from physicslab.state.joint_rows import KINDS, ends_of
from physicslab.state.state import State
from physicslab.systems.joint_forces import JointForces
from physicslab.systems.system import Stage, System, at


def remove_lost(state: State, kind: type[Any], a: NDArray[np.int64], b: NDArray[np.int64]) -> None:
    """Remove every component that joined a body which was removed, and entities that were nothing else.

    Parameters
    ----------
    state : State
        Whose.
    kind : component type
        It has ends ``a`` and ``b``, bodies; or those of a Gear, entities with joints.
    a, b : int64 arrays (n,)
        The rows of the bodies at the ends of each; 0 is the world, -1 what is not there.

    Raises
    ------
    InvalidValue
        If an end never was an entity, or is one without a Transform, or without a joint.
    """
    placed, batch = state.table(Transform).present, state.batch(kind)
    names, needed, coupled = ("a", "b"), "an entity with a Transform", set[tuple[int, type[Any]]]()
    if kind is Gear:
        names, needed = ("first", "second"), COUPLED
        coupled = {(joint.entity, joint.kind) for joint in state.joints.joints}
    lost_a, lost_b = (a < 0) | ~(placed[a] | (a == 0)), (b < 0) | ~(placed[b] | (b == 0))
    for i in np.flatnonzero(lost_a | lost_b).tolist():
        entity, name = int(batch.entities[i]), names[0 if lost_a[i] else 1]
        if not (esper.entity_exists(entity) and esper.has_component(entity, kind)):
            continue  # removed by an earlier call, before rows were numbered again
        end = int(state.table(kind)[name][batch.rows[i]]) or entity
        gone = end not in state.entity_index.row_of and end <= state.entity_index.newest
        if not gone and (entity, kind) not in coupled:
            owner = f"{state.label(entity)}: {kind.__name__}"
            raise InvalidValue(owner, name, end, needed)
        remove_joint(entity, kind)


def remove_joint(entity: int, kind: type[Any]) -> None:
    """Remove a component that joins bodies, and its entity where that was nothing else."""
    esper.remove_component(entity, kind)
    left: tuple[object, ...] = esper.components_for_entity(entity)
    if all(isinstance(component, Name) for component in left):
        esper.delete_entity(entity, immediate=True)


def _refuse_equal(
    state: State, kind: type[Any], rows: NDArray[np.int64], a: NDArray[np.int64], b: NDArray[np.int64]
) -> None:
    """Refuse joints (n,) whose ends are one body, and those that join the points of another of their kind."""
    if kind is Gear:
        _refuse_gears(state, rows)
        return
    known: dict[tuple[Any, ...], str] = {}
    table, entities = state.table(kind), state.entity_index.entities
    for row, one, other in zip(rows.tolist(), a.tolist(), b.tolist(), strict=True):
        ends = (one, table["anchor_a"][row].tolist()), (other, table["anchor_b"][row].tolist())
        label = state.label_of_row(row)
        refused = why_not_joined(*ends, known)
        if refused is not None:
            name, allowed = refused
            end = int(entities[other]) if other else None
            raise InvalidValue(f"{label}: {kind.__name__}", name, end, allowed)
        known[key_of(*ends)] = label


def _refuse_gears(state: State, rows: NDArray[np.int64]) -> None:
    """Refuse what couples an entity with two joints, or the joints of another Gear."""
    table, known = state.table(Gear), dict[frozenset[int], str]()

    def joints(entity: int) -> int:
        row = state.entity_index.row_of[entity]
        return sum(int(state.table(kind).present[row]) for kind in (Pin, Slot))

    for row in rows.tolist():
        label, ends = state.label_of_row(row), (int(table["first"][row]), int(table["second"][row]))
        if (refused := why_not_coupled(*ends, joints, known)) is not None:
            raise InvalidValue(f"{label}: Gear", *refused)
        known[frozenset(ends)] = label


class JointSystem(System):
    """Holds together what joints join: Pin, Slot, Weld, Rod, Rope, Pulley and Gear.

    In smooth motion, and with rigid contacts, the equations of the joints are solved with those of the
    motion (:class:`JointForces`). Beside soft contacts joints are soft constraints, solved with these.
    """

    engine = True
    kernels = (soft.advance,)

    def __init__(self) -> None:
        self.smooth = JointForces(type(self).__name__)

    def attach(self, state: State) -> None:
        """Find the bodies at both ends of every joint; a joint whose body was removed goes with it.

        Raises
        ------
        InvalidValue
            If an end is nothing that has a place, both are the same, or two joints of a kind are.
        """
        index = state.entity_index
        for kind in filter(index.has_any, KINDS):
            rows, (a, b) = state.batch(kind).rows, ends_of(index, kind)
            remove_lost(state, kind, a, b)
            there = (a >= 0) & (b >= 0)
            _refuse_equal(state, kind, rows[there], a[there], b[there])
        if state.joints.rebuild(index) and state.sleep.count:
            wake_all(state)

    @at(Stage.SOLVE)
    def solve(self, state: State, h: float) -> None:
        """Find the impulses that hold bodies together; those of contacts are solved with them."""
        if not state.joints.beside_contacts:
            do_stage(state, soft.SOLVE, h)

    @at(Stage.RELAX)
    def relax(self, state: State, h: float) -> None:
        """Remove the velocity that came from correcting errors."""
        if not state.joints.beside_contacts:
            do_stage(state, soft.RELAX, h)

    def why_left_out(self, state: State) -> str | None:
        """Needed where anything is joined."""
        names = listed("or", (kind.__name__ for kind in KINDS))
        return None if len(state.joints) else sentence("no_component", components=names)
