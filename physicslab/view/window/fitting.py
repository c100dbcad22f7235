"""Curves that graphs show beside their lines, and the part of the time that they show."""

from collections.abc import Iterable

import numpy as np

from physicslab.diagnostics.fits import Fit, fit
from physicslab.systems.gate import Crossing, GateSystem
from physicslab.view.window.record import Key, Record
from physicslab.world import World


class Fitting:
    """The curve that each graph fits to its lines; they are fitted again where samples were added.

    Attributes
    ----------
    kinds : dict of int to str
        The kind of curve of each graph that has one, of :data:`physicslab.diagnostics.fits.FITS`.
    spans : dict of int to two floats
        From when to when graphs show what was recorded [s], where that is not all of it.
    """

    def __init__(self) -> None:
        self.kinds: dict[int, str] = {}
        self.spans: dict[int, tuple[float, float]] = {}
        self._found: dict[tuple[int, Key], tuple[object, Fit | None]] = {}

    @property
    def state(self) -> tuple[object, ...]:
        """The state that panels show."""
        return tuple(self.kinds.items()), tuple(self.spans.items())

    def keep(self, graphs: set[int]) -> None:
        """Forget what belongs to other graphs."""
        self.kinds = {graph: kind for graph, kind in self.kinds.items() if graph in graphs}
        self.spans = {graph: span for graph, span in self.spans.items() if graph in graphs}
        self._found = {key: found for key, found in self._found.items() if key[0] in self.kinds}

    def of(
        self, graph: int, across: Key | None, key: Key, record: Record, marks: list[float | None]
    ) -> Fit | None:
        """Return the curve of a line, of what is between the cursors or of all; ``None`` if it has none.

        ``across`` is what stands on the horizontal axis of the graph, ``None`` for the time.
        """
        kind = self.kinds.get(graph)
        if kind is None:
            return None
        state = kind, id(record), record.version, tuple(marks), across
        kept = self._found.get((graph, key))
        if kept is None or kept[0] != state:
            times = record.times
            ends = sorted(mark for mark in marks if mark is not None)
            first, last = ends if len(ends) == 2 else (-np.inf, np.inf)
            there = (times >= first) & (times <= last)
            x = times if across is None else record.values(across)
            kept = state, fit(kind, x[there], record.values(key)[there])
            self._found[graph, key] = kept
        return kept[1]


def gate_span(world: World, plotted: Iterable[int | None]) -> tuple[float, float] | None:
    """Return the times of the last two crossings of gates by one body [s]: one that is plotted, if any is."""
    system = world.schedule.find(GateSystem)
    crossings = system.crossings if system is not None else ()
    bodies = set(plotted)
    last: dict[int, Crossing] = {}
    found: dict[bool, tuple[float, float]] = {}
    for one in crossings:
        if one.body in last and one.time > last[one.body].time:
            found[one.body in bodies] = last[one.body].time, one.time
        last[one.body] = one
    return found.get(True) or found.get(False)
