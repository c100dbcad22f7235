"""Samples of runs, taken after each step, and the names by which expressions call what is sampled."""

import bisect
import re
from collections.abc import Iterable
from keyword import iskeyword

from physicslab.components.quantities import QUANTITIES, carrier_of, why_not_of
from physicslab.diagnostics.impact_table import ImpactReader
from physicslab.diagnostics.quantities import Reading
from physicslab.ecs.quantity_text import Expression, InvalidText
from physicslab.ecs.text import suggestion
from physicslab.world import World

_LISTED = 20
"""Names of entities that a refusal lists."""
COLLISIONS = "world.collisions"
"""The number of impacts since the run began."""
_NAMES = {quantity.column.replace(" ", "_"): name for name, quantity in QUANTITIES.items()}
"""Quantities as expressions call them: ``vx``, ``kinetic``, ``energy``."""


def quoted(text: str, ids: Iterable[str]) -> str:
    """Return an expression or a condition with quotes around ids of entities that are no plain words.

    >>> quoted("box 2.y < 2 box 10.y", ["box", "box 2", "box 10"])
    '"box 2".y < 2 "box 10".y'
    """
    odd = sorted((one for one in ids if not _is_word(one)), key=len, reverse=True)
    either = "|".join(map(re.escape, odd))
    return re.sub(rf'(?<![\w."])({either})(?=\.[^\W\d])', r'"\1"', text) if odd else text


def _is_word(name: str) -> bool:
    return name.isidentifier() and not iskeyword(name)


def quantity_of(name: str, ids: Iterable[str]) -> tuple[str | None, str]:
    """Return the entity and the quantity that ``ball.x`` stands for; ``None`` for the world.

    Raises
    ------
    InvalidText
        If the world has no such quantity; with the names that it has.
    """
    known = [*ids, "world"]
    entity = max((one for one in known if name.startswith(f"{one}.")), key=len, default="")
    if not entity:
        words = ", ".join(one if _is_word(one) else f'"{one}"' for one in known[:_LISTED])
        more = (", ..." if len(known) > _LISTED else "") + suggestion(name.rpartition(".")[0] or name, known)
        raise InvalidText(f"'{name}' is no quantity: must begin with one of {words}{more}")
    column = name[len(entity) + 1 :]
    body = None if entity == "world" else 1
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
        self.dimensions = {name: Expression(unit_of(name)).value().dimension for name in self.columns}

    @property
    def samples(self) -> range:
        """Those until the end."""
        return range(bisect.bisect_right(self.times, self.end))

    def clear(self) -> None:
        """Forget all samples, for another run of the same world."""
        self._impacts.skip()
        for numbers in (self.times, *self.columns.values(), *self.breaks.values()):
            numbers.clear()

    def take(self, times: list[float], columns: Iterable[list[float]]) -> None:
        """Take samples from elsewhere: times [s], and as many values of each column [SI]."""
        self.end, self.times = times[-1], times
        self.columns = dict(zip(self.columns, columns, strict=True))
        self._note_impacts()

    def _note_impacts(self) -> None:
        """Note when impacts were since the last time."""
        for records in self._impacts.read():
            joints, entities = self._world.joints.joints, self._world.entity_index.entities
            held = {int(entities[row]) for joint in joints for row in (joint.a, joint.b)}
            columns = (records[name].tolist() for name in ("time", "entity_a", "entity_b"))
            for time, *pair in zip(*columns, strict=True):
                for breaks, (_, body) in zip(self.breaks.values(), self._sources, strict=True):
                    if (body in (None, *pair) or body in held) and time not in breaks[-1:]:
                        bisect.insort(breaks, time)

    def add(self) -> None:
        """Take a sample of the world as it is now."""
        self.end = self._world.time
        self.times.append(self.end)
        if not self._sources:
            return
        self._note_impacts()
        reading = Reading(self._world)
        for column, (quantity, body) in zip(self.columns.values(), self._sources, strict=True):
            value = self._world.collisions if quantity == "collisions" else reading.value(quantity, body)
            column.append(float(value))
