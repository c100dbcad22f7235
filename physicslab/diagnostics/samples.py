"""Samples of runs, taken after each step, and the names by which expressions call what is sampled."""

import bisect
import re
from collections.abc import Iterable
from keyword import iskeyword
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components.quantities import QUANTITIES, carrier_of, why_not_of
from physicslab.contacts.report import ImpactReader
from physicslab.diagnostics.quantities import Reading
from physicslab.ecs.quantity_text import Expression, InvalidText
from physicslab.ecs.text import suggestion
from physicslab.state.samples import motion_of_rows, moving_rows, put_motion
from physicslab.systems.within_step import split_at_impacts
from physicslab.world import World

_LISTED = 20
"""Names of entities that a refusal lists."""
COLLISIONS = "world.collisions"
"""The number of impacts since the run began."""
_BOTH_SIDES = {
    "x": ("center_{}x", "center_{}x"), "y": ("center_{}y", "center_{}y"), "angle": ("angle_{}", "angle_{}"),
    "velocity x": ("before_{}x", "after_{}x"), "velocity y": ("before_{}y", "after_{}y"),
    "angular velocity": ("before_w{}", "after_w{}"),
}  # fmt: skip
"""Fields of IMPACT that have a quantity of a body just before an impact and just after it."""
_OF_MOTION = ("speed", "momentum", "angular momentum", "kinetic", "potential", "energy of", "total energy")
"""The beginnings of other quantities that the motion of bodies tells."""
_MOST = 1_000
"""Moments of a step at which impacts of a body are noted at most, evenly chosen: where one is squeezed to a
standstill, half a million come in a step."""
_MANY = 500
"""Impacts of a step times bodies beyond which the world is not read at each, which takes as long as many
steps do: of what so many change little by little there is a straight line through the step."""
_NAMES = {quantity.column.replace(" ", "_"): name for name, quantity in QUANTITIES.items()}
"""Quantities as expressions call them: ``vx``, ``kinetic``, ``energy``."""


def quoted(text: str, ids: Iterable[str]) -> str:
    """Return an expression or a condition with quotes around ids of entities that are no plain words.

    >>> quoted("box 2.y < 2 box 10.y", ["box", "box 2", "box 10"])
    '"box 2".y < 2 "box 10".y'
    """
    odd = sorted((one for one in ids if _written(one) != one), key=len, reverse=True)
    either = "|".join(map(re.escape, odd))
    if not odd:
        return text
    return re.sub(rf'(?<![\w."])({either})(?=\.[^\W\d])', lambda found: _written(found[1]), text)


def _written(name: str) -> str:
    """Return an id as expressions have it: in quotes where it is no plain word, its own ones doubled."""
    if name.isidentifier() and not iskeyword(name):
        return name
    return '"{}"'.format(name.replace('"', '""'))


def quantity_of(name: str, ids: Iterable[str]) -> tuple[str | None, str]:
    """Return the entity and the quantity that ``ball.x`` stands for; ``None`` for the world.

    Raises
    ------
    InvalidText
        If the world has no such quantity; with the names that it has.
    """
    known = [*ids, "world"]
    entity = max((one for one in known if f"{name}.".startswith(f"{one}.")), key=len, default="")
    if not entity:
        words = ", ".join(map(_written, known[:_LISTED]))
        more = (", ..." if len(known) > _LISTED else "") + suggestion(name.rpartition(".")[0] or name, known)
        raise InvalidText(f"'{name}' is no quantity: must begin with one of {words}{more}")
    column = name[len(entity) + 1 :]
    body = None if entity == "world" else 1
    if body is None and known.count("world") > 1 and column in columns(1):
        raise InvalidText(f"'{name}': an entity is called world as well; give it another id")
    if name != COLLISIONS and (column not in _NAMES or why_not_of(_NAMES[column], body) is not None):
        raise InvalidText(f"'{name}' is no quantity: {entity} has {', '.join(columns(body))}")
    return (None if body is None else entity), _NAMES.get(column, column)


def columns(body: int | None) -> dict[str, str]:
    """Return the quantities of a body, or of the world for ``None``, by what expressions call them."""
    return {
        short: long
        for short, long in _NAMES.items()
        if why_not_of(long, body) is None and ":" not in long and carrier_of(long) == "Transform"
    }


def unit_of(name: str) -> str:
    """Return the SI unit of ``ball.x``."""
    return "1" if name == COLLISIONS else QUANTITIES[_NAMES[name.rpartition(".")[2]]].unit


class Record:
    """Samples of a run: times [s], and the values of quantities [SI], each as many.

    Parameters
    ----------
    world : World
        The world that is recorded; it may go on between samples.
    names : iterable of str
        Quantities of it, as ``ball.x``.

    Attributes
    ----------
    end : float
        When the run ends [s]; samples after that serve to interpolate before it.
    breaks : dict of str to list of float
        When impacts end the curve of a quantity [s], as far as the world logs them (``contacts.read``): those
        of the body, and all of what joints hold and of the world.
    sides : dict of str to dict of float to tuple of two floats
        The value [SI] just before such an impact and just after it, by its time, where the log has it.
    """

    def __init__(self, world: World, names: Iterable[str]) -> None:
        ids = {world.label(entity): entity for entity in world.entities()}
        self._world, self._impacts = world, ImpactReader(world)
        self.end = world.time
        self.times: list[float] = []
        self.columns: dict[str, list[float]] = {name: [] for name in names}
        self._sources = []
        for name in self.columns:
            entity, quantity = quantity_of(name, ids)
            self._sources.append((quantity, None if entity is None else ids[entity]))
        self.breaks: dict[str, list[float]] = {name: [] for name in self.columns}
        self.sides: dict[str, dict[float, tuple[float, float]]] = {name: {} for name in self.columns}
        self._derived = [
            (name, *source)
            for name, source in zip(self.columns, self._sources, strict=True)
            if source[0].startswith(_OF_MOTION)
        ]
        self._before: tuple[float, NDArray[np.int64], NDArray[np.float64]] | None = None
        self.dimensions = {name: Expression(unit_of(name)).value().dimension for name in self.columns}

    @property
    def samples(self) -> range:
        """Those until the end."""
        return range(bisect.bisect_right(self.times, self.end))

    def clear(self) -> None:
        """Forget all samples, for another run of the same world."""
        self._impacts.skip()
        self._before = None
        for numbers in (self.times, *self.columns.values(), *self.breaks.values()):
            numbers.clear()
        for sides in self.sides.values():
            sides.clear()

    def take(self, times: list[float], columns: Iterable[list[float]]) -> None:
        """Take samples from elsewhere: times [s], and as many values of each column [SI]."""
        self.end, self.times = times[-1], times
        self.columns = dict(zip(self.columns, columns, strict=True))
        self._note_impacts()

    def _note_impacts(self) -> None:
        """Note when impacts were since the last time, and the motion before and after each."""
        own = [body for _, body in self._sources if body is not None]
        for records in self._impacts.blocks(self._world):
            joints, entities = self._world.joints.joints, self._world.entity_index.entities
            held = {int(entities[row]) for joint in joints for row in (joint.a, joint.b)}
            whole = len(own) < len(self._sources) or not held.isdisjoint(own)
            records = records[self._chosen(records, {None, *own} if whole else {*own})]
            for record in records:
                time, pair = float(record["time"]), [int(record[name]) for name in ("entity_a", "entity_b")]
                for (name, breaks), (quantity, body) in zip(self.breaks.items(), self._sources, strict=True):
                    if (body in (None, *pair) or body in held) and time not in breaks[-1:]:
                        bisect.insort(breaks, time)
                    if body in pair and quantity in _BOTH_SIDES:
                        which = "ab"[pair.index(body)]
                        values = (float(record[field.format(which)]) for field in _BOTH_SIDES[quantity])
                        before, after = values
                        before, _ = self.sides[name].get(time, (before, after))
                        self.sides[name][time] = before, after
            if self._before is not None and self._before[0] < self._world.time:
                self._note_derived(records, held, *self._before)

    def _chosen(self, records: NDArray[Any], bodies: set[int | None]) -> NDArray[np.bool_]:
        """Return which impacts are noted: the first and the last of each body in each share of a step.

        ``None`` is the world, of which all are. Of many of a body at the same moment the first and the last
        tell what was before and after.
        """
        times, chosen = records["time"], np.zeros(len(records), np.bool_)
        shares = np.floor(times * (0.5 * _MOST / self._world.simulation.dt))
        for body in bodies:
            takes_part = (records["entity_a"] == body) | (records["entity_b"] == body) | (body is None)
            begins = np.diff(shares[takes_part], prepend=np.nan, append=np.nan) != 0.0
            chosen |= takes_part & np.isin(times, times[takes_part][begins[1:] | begins[:-1]])
        place = np.tile(np.flatnonzero(chosen), 2)
        ends = np.concatenate((records["entity_a"][chosen], records["entity_b"][chosen]))
        order = np.lexsort((place, ends, times[place]))
        keys = np.stack((times[place], ends))[:, order]
        begins = (np.diff(keys, prepend=np.nan, append=np.nan) != 0.0).any(axis=0)
        chosen[:] = False
        chosen[place[order[begins[1:] | begins[:-1]]]] = True
        return chosen

    def _note_derived(
        self, impacts: NDArray[Any], held: set[int], begin: float, rows: NDArray[np.int64],
        before: NDArray[np.float64],
    ) -> None:  # fmt: skip
        """Note quantities that the motion of bodies tells, before and after impacts of the last step.

        The motion of bodies that joints hold is not known then.
        """
        world = self._world
        concerned = [body for _, _, body in self._derived if body is not None]
        if len(concerned) == len(self._derived):
            takes_part = [np.isin(impacts[name], concerned) for name in ("entity_a", "entity_b")]
            impacts = impacts[takes_part[0] | takes_part[1]]
        elif len(impacts) * len(rows) > _MANY:
            return
        if not np.array_equal(rows, moving_rows(world)):
            return
        now, last, bodies = world.time, motion_of_rows(world, rows), world.entity_index.entities[rows]
        begins, spans, motion = split_at_impacts(
            impacts, bodies, np.array([begin]), np.array([now - begin]), np.stack((before, last))
        )
        pairs = {float(one["time"]): {int(one["entity_a"]), int(one["entity_b"])} for one in impacts}
        try:
            for k in np.flatnonzero(spans == 0.0).tolist():
                time, found = float(begins[k]), []
                for whole in motion[k : k + 2]:
                    put_motion(world, rows, whole)
                    reading = Reading(world)
                    found.append([reading.value(quantity, body) for _, quantity, body in self._derived])
                for (name, _, body), *values in zip(self._derived, *found, strict=True):
                    if time in self.breaks[name] and not held & (pairs[time] if body is None else {body}):
                        first, _ = self.sides[name].get(time, values)
                        self.sides[name][time] = first, values[1]
        finally:
            put_motion(world, rows, last)

    def add(self) -> None:
        """Take a sample of the world as it is now."""
        self.end = self._world.time
        self.times.append(self.end)
        if not self._sources:
            return
        self._note_impacts()
        reading = Reading(self._world)
        if self._derived:
            rows = moving_rows(self._world)
            self._before = self.end, rows, motion_of_rows(self._world, rows)
        for column, (quantity, body) in zip(self.columns.values(), self._sources, strict=True):
            value = self._world.collisions if quantity == "collisions" else reading.value(quantity, body)
            column.append(float(value))
