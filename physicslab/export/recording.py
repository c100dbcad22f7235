"""A run as a page plays it: what moves, instant after instant, what stays, and the frame around it."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Charge, Colour, Mass, Medium, Shape, Trail, Transform, Velocity
from physicslab.components.shape import KINDS
from physicslab.diagnostics.energy import Accounts
from physicslab.diagnostics.quantities import Reading
from physicslab.diagnostics.run_report import body_names
from physicslab.export.look import edges_of
from physicslab.export.parts import Key, graphs_of, joints_of, quantity_words, springs_of
from physicslab.state.shapes import cores_of
from physicslab.world import World

type Columns = NDArray[np.float32]
"""A float32 array (instants, columns)."""

_MOMENTA: tuple[Key, ...] = ((None, "momentum x"), (None, "momentum y"), (None, "angular momentum"))
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
        Names of the energies of an instant, the total last.
    start : float
        The time at the first instant [s].
    graphs : list of pairs
        The horizontal axis of each graph, and its lines.
    quantities : tuple of Key
        Other quantities of an instant: the momentum of the world, and what graphs show.
    words, joints : lists of dict
        Their names and units, and the joints: as they are at the start, since some may break.
    """

    def __init__(self, world: World) -> None:
        world.synchronise()
        self._rows = world.batch(Transform, Velocity).rows
        self.moving = len(self._rows)
        stored = (force.potential for force in world.schedule.forces)
        self._potentials = tuple(dict.fromkeys(filter(None, stored)))
        self.energies: tuple[str, ...] = ("kinetic", *self._potentials, "total")
        self.start = world.time
        self.graphs = graphs_of(world)
        plotted = [key for across, lines in self.graphs for key in (*((across,) if across else ()), *lines)]
        self.quantities: tuple[Key, ...] = tuple(dict.fromkeys([*_MOMENTA, *plotted]))
        self.words = [quantity_words(world, key) for key in self.quantities]
        self.joints = joints_of(world)
        self._instants: list[Columns] = []

    def write(self, world: World, account: Accounts, unknown: tuple[str, ...] = ()) -> None:
        """Keep the state as it is now, without quantities whose names begin with an ``unknown`` word.

        Raises
        ------
        NotShown
            If a number is too large for float32.
        """
        transform, velocity, rows = world.table(Transform), world.table(Velocity), self._rows
        energy = account.parts
        stored = [energy.potential.get(name, 0.0) for name in self._potentials]
        sums = [world.time - self.start, energy.kinetic, *stored, energy.total]
        reading = Reading(world, account)
        others = np.array(
            [
                math.nan if name.startswith(unknown) else reading.value(name, body)
                for body, name in self.quantities
            ]
        )
        others[~(np.abs(others) <= _LARGEST)] = np.nan  # where it is not defined
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
        whole = np.concatenate((values[: len(sums)], others, values[len(sums) :]))
        self._instants.append(whole.astype(np.float32))

    @property
    def count(self) -> int:
        """How many instants were kept."""
        return len(self._instants)

    def keep(self, instants: Sequence[int]) -> None:
        """Forget all instants but those of these numbers, from 0."""
        self._instants = [self._instants[number] for number in instants]

    @property
    def columns(self) -> Columns:
        """Time since the start [s], energies [J], quantities and bodies: float32 (instants, columns).

        There are 1 + energies + quantities + 6 moving columns.
        """
        return np.stack(self._instants)

    @property
    def motion(self) -> Columns:
        """x, y, angle and their rates of each moving body at each instant: float32 (instants, moving, 6)."""
        bodies = self.columns[:, 1 + len(self.energies) + len(self.quantities) :]
        return bodies.reshape(len(bodies), self.moving, BODY_COLUMNS)

    def bodies(self, world: World) -> list[dict[str, Any]]:
        """Return every entity with a Transform: name, outline, mass, and where it is if it does not move.

        ``"entity"`` is its number, by which it has its colour as in a window; ``"moves"`` is the
        place of a body among those that move.
        """
        transform, shape, mass, trail = map(world.table, (Transform, Shape, Mass, Trail))
        colour, medium, charge = map(world.table, (Colour, Medium, Charge))
        moves = {row: place for place, row in enumerate(self._rows.tolist())}
        found: list[dict[str, Any]] = []
        for (entity, name), row in zip(
            body_names(world).items(), world.batch(Transform).rows.tolist(), strict=True
        ):
            kind = ("point", *KINDS)[int(shape["kind"][row])]
            if kind == "point" and row not in moves and not mass.present[row]:
                kind = "none"
            body: dict[str, Any] = {"name": name, "kind": kind, "entity": entity}
            if shape.present[row]:
                corners, vertices, radius, _ = cores_of(shape, np.array([row]))
                body["core"] = corners[0, : vertices[0]].tolist()
                body["radius"] = float(radius[0])
            if mass.present[row]:
                body["mass"], body["inertia"] = float(mass["mass"][row]), float(mass["inertia"][row])
            if colour.present[row]:
                own = world.component(entity, Colour)
                body["colour"], body["edges"] = own.colour, edges_of(own.rgb)
            if medium.present[row]:
                body["fluid"] = True
            if charge.present[row] and charge["charge"][row]:
                body["charge"] = float(charge["charge"][row])
            if trail.present[row]:
                body["trail"] = float(trail["length"][row])
            if row in moves:
                body["moves"] = moves[row]
            else:
                body["pose"] = [*transform["position"][row].tolist(), float(transform["angle"][row])]
            found.append(body)
        return found


type Boxes = NDArray[np.float64]
"""A float64 array (n, 4): xmin, ymin, xmax, ymax [m]."""
type Box = tuple[float, float, float, float]

_SURROUNDINGS = 8.0
"""How much is shown at least, in sizes of the largest thing that moves."""
_STRAY_FROM_GROUND, _STRAY = 0.25, 4.0
"""How far what leaves the place is followed, in sizes of it, where there is ground and where not."""
_BESIDE = 0.1
"""How far what does not move is shown, in sizes of what is shown."""
_MARGIN = 0.04
"""Free rim, as a share of the size of the picture."""
_EMPTY: Box = (-5.0, -3.0, 5.0, 3.0)
"""The part of an empty world that is shown [m]."""


def extent_of_run(world: World, recorder: RunRecorder) -> Box:
    """Return xmin, ymin, xmax, ymax [m] of what is to be seen of a run that was recorded."""
    bounds, springs = world.physics.bounds, springs_of(world)
    fixed = [[*spring["anchor_b"], *spring["anchor_b"]] for spring in springs if spring["b"] is None]
    return frame_run(recorder.bodies(world), recorder.motion, [*fixed, *([bounds] if bounds else [])])


def frame_run(
    bodies: Sequence[dict[str, Any]], motion: NDArray[np.float32], fixed: Sequence[Sequence[float]]
) -> Box:
    """Return xmin, ymin, xmax, ymax [m] of what is to be seen of a run.

    It holds all that moves, but for what flies or falls far from where things are at the start.

    Parameters
    ----------
    bodies : sequence of dict
        As :meth:`RunRecorder.bodies` has them.
    motion : float32 array (instants, moving, 6)
        As :attr:`RunRecorder.motion` has it.
    fixed : sequence of four floats each
        Boxes that belong to it: the bounds, and the fixed ends of springs.
    """
    drawn = [body for body in bodies if body["kind"] != "none"]
    movers = [body for body in drawn if "moves" in body]
    still = _boxes([_outline(body) for body in drawn if "moves" not in body])
    reach = np.array([_reach(body) for body in movers]).reshape(-1, 1)
    places = motion[:, [body["moves"] for body in movers], :2].astype(np.float64)
    start = np.concatenate((places[0] - reach, places[0] + reach), axis=1)
    start = np.concatenate((start, _boxes(fixed)))
    if not len(start):
        return _grown(_union(still) if len(still) else _EMPTY, _MARGIN)
    widened = _widened(_union(start), 2.0 * _SURROUNDINGS * float(reach.max(initial=0.0)))
    place = _union(np.concatenate(([widened], _clipped(still, _grown(widened, 1.0)))))
    path = np.concatenate((places.min(axis=0) - reach, places.max(axis=0) + reach), axis=1)
    stray = _STRAY_FROM_GROUND if len(still) or len(fixed) else _STRAY
    seen = _union(np.concatenate((start, _clipped(path, _grown(place, stray)))))
    seen = _widened(seen, 0.5 * _SURROUNDINGS * float(reach.max(initial=0.0)))
    return _grown(_union(np.concatenate(([seen], _clipped(still, _grown(seen, _BESIDE))))), _MARGIN)


def _reach(body: dict[str, Any]) -> float:
    """Return the radius of the circle about a body's centre in which it turns [m]."""
    core = body.get("core", [(0.0, 0.0)])
    return float(max(math.hypot(*corner) for corner in core) + body.get("radius", 0.0))


def _outline(body: dict[str, Any]) -> list[float]:
    """Return the box around a body that does not move [m]."""
    x, y, angle = body["pose"]
    core, radius = body.get("core", [(0.0, 0.0)]), body.get("radius", 0.0)
    c, s = math.cos(angle), math.sin(angle)
    across = max(abs(c * u - s * v) for u, v in core) + radius
    up = max(abs(s * u + c * v) for u, v in core) + radius
    return [x - across, y - up, x + across, y + up]


def _boxes(rows: Sequence[Sequence[float]]) -> Boxes:
    return np.array(rows, np.float64).reshape(-1, 4)


def _union(boxes: Boxes) -> Box:
    low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _clipped(boxes: Boxes, region: Box) -> Boxes:
    """Return what of each box lies in a region."""
    low, high = np.maximum(boxes[:, :2], region[:2]), np.minimum(boxes[:, 2:], region[2:])
    there = (low <= high).all(axis=1)
    return np.concatenate((low[there], high[there]), axis=1)


def _grown(box: Box, share: float) -> Box:
    """Return a box with a margin on each side, as a share of its larger extent."""
    margin = share * max(box[2] - box[0], box[3] - box[1])
    return box[0] - margin, box[1] - margin, box[2] + margin, box[3] + margin


def _widened(box: Box, smallest: float) -> Box:
    """Return a box of at least this width and height [m], about the same centre."""
    across, up = (0.5 * max(smallest - (box[2 + k] - box[k]), 0.0) for k in (0, 1))
    return box[0] - across, box[1] - up, box[2] + across, box[3] + up
