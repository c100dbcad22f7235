"""A run as a page plays it: what moves, one instant after the other, and what stays as it is."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Shape, Spring, Trail, Transform, Velocity
from physicslab.diagnostics.energy import Accounts
from physicslab.diagnostics.run_report import body_names
from physicslab.world import World

type Columns = NDArray[np.float32]

BODY_COLUMNS = 6
"""Numbers of a moving body at an instant: x, y, angle and their rates."""
_LARGEST = float(np.finfo(np.float32).max)


class NotShown(ValueError):
    """A run holds a number that float32 does not: the message says which, and when."""


class RunRecorder:
    """Keeps, of every instant, the time, the energies, and the pose and velocity of each body that moves.

    Parameters
    ----------
    world : World
        At its start. No entity is added to it or removed from it while it is recorded.

    Attributes
    ----------
    moving : int
        How many bodies move.
    energies : tuple of str
        What the energies of an instant are called, the total last.
    start : float
        The time at the first instant [s].
    """

    def __init__(self, world: World) -> None:
        world.synchronise()
        self._rows = world.batch(Transform, Velocity).rows
        self.moving = len(self._rows)
        stored = (force.potential for force in world.schedule.forces)
        self._potentials = tuple(dict.fromkeys(filter(None, stored)))
        self.energies = ("kinetic", *self._potentials, "total")
        self.start = world.time
        self._instants: list[Columns] = []

    def write(self, world: World, account: Accounts) -> None:
        """Keep the state as it is now.

        Raises
        ------
        NotShown
            If a number is too large for float32.
        """
        transform, velocity, rows = world.table(Transform), world.table(Velocity), self._rows
        energy = account.parts
        stored = [energy.potential.get(name, 0.0) for name in self._potentials]
        sums = [world.time - self.start, energy.kinetic, *stored, energy.total]
        bodies = np.column_stack(
            (transform["position"][rows], transform["angle"][rows], velocity["linear"][rows],
             velocity["angular"][rows])
        )  # fmt: skip
        values = np.concatenate((sums, bodies.ravel()))
        if not (np.abs(values) <= _LARGEST).all():
            column = int(np.argmax(~(np.abs(values) <= _LARGEST)))
            names, body = ("the time", *self.energies), column - len(sums)
            what = names[column] if body < 0 else world.label_of_row(int(rows[body // BODY_COLUMNS]))
            raise NotShown(
                f"{what} at t = {world.time:.9g} s: {values[column]:.3g} is more than a page can hold, "
                f"{_LARGEST:.2g} at most"
            )
        self._instants.append(values.astype(np.float32))

    @property
    def count(self) -> int:
        """How many instants were kept."""
        return len(self._instants)

    @property
    def columns(self) -> Columns:
        """Time since the start [s], energies [J] and bodies: float32 (instants, 1 + energies + 6 moving)."""
        return np.stack(self._instants)

    @property
    def motion(self) -> Columns:
        """Of each instant and moving body, x, y, angle and their rates: float32 (instants, moving, 6)."""
        bodies = self.columns[:, 1 + len(self.energies) :]
        return bodies.reshape(len(bodies), self.moving, BODY_COLUMNS)

    def bodies(self, world: World) -> list[dict[str, Any]]:
        """Return every entity with a Transform: name, outline, mass, and where it is if it does not move.

        ``"entity"`` is its number, by which it has its colour as in a window; ``"moves"`` is the
        place of a body among those that move.
        """
        transform, shape, mass, trail = map(world.table, (Transform, Shape, Mass, Trail))
        moves = {row: place for place, row in enumerate(self._rows.tolist())}
        found: list[dict[str, Any]] = []
        for (entity, name), row in zip(
            body_names(world).items(), world.batch(Transform).rows.tolist(), strict=True
        ):
            kind = ("point", "circle", "box")[int(shape["kind"][row])]
            if kind == "point" and row not in moves and not mass.present[row]:
                kind = "none"
            body: dict[str, Any] = {"name": name, "kind": kind, "entity": entity}
            if kind == "circle":
                body["radius"] = float(shape["radius"][row])
            elif kind == "box":
                body["size"] = [float(shape["width"][row]), float(shape["height"][row])]
            if mass.present[row]:
                body["mass"], body["inertia"] = float(mass["mass"][row]), float(mass["inertia"][row])
            if trail.present[row]:
                body["trail"] = float(trail["length"][row])
            if row in moves:
                body["moves"] = moves[row]
            else:
                body["pose"] = [*transform["position"][row].tolist(), float(transform["angle"][row])]
            found.append(body)
        return found

    def joints(self, world: World) -> list[dict[str, Any]]:
        """Return every joint: the body that its mark turns with, by place among the bodies, and where."""
        place = {entity: number for number, entity in enumerate(world.batch(Transform).entities.tolist())}
        joints, entities, found = world.joints, world.entity_index.entities, []
        for joint in joints.joints:
            n = joint.first
            a, b = int(joints.a[n]), int(joints.b[n])
            anchor = joints.anchor_b[n] if b else joints.anchor_a[n]
            body = place[int(entities[b or a])]
            found.append({"body": body, "anchor": anchor.tolist(), "fixed": not (a and b)})
        return found

    def springs(self, world: World) -> list[dict[str, Any]]:
        """Return every spring: its ends by place among the bodies, and its anchors; no B is a fixed point."""
        place = {entity: number for number, entity in enumerate(world.batch(Transform).entities.tolist())}
        spring, batch = world.table(Spring), world.batch(Spring)
        return [
            {
                "a": place[int(spring["a"][row]) or own],
                "b": place.get(int(spring["b"][row])),
                "anchor_a": spring["anchor_a"][row].tolist(),
                "anchor_b": spring["anchor_b"][row].tolist(),
            }
            for own, row in zip(batch.entities.tolist(), batch.rows.tolist(), strict=True)
        ]
