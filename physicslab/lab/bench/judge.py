"""How well engines simulate a scene: every engine's state is copied into one world, and measured there.

So what is measured disturbs no engine, and all are measured alike.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from physicslab.components import Transform, Velocity
from physicslab.lab.bench.engine import Engine
from physicslab.lab.bench.quality import Moment, When
from physicslab.lab.bench.result import SceneResult
from physicslab.state.masses import Diverged

__all__ = ["Judge"]


class Judge:
    """Measures the qualities of a scene in every engine, and writes them into its results.

    Parameters
    ----------
    result : SceneResult
        Whose scene it is, and where figures are written: ``None`` where one is not finite. What diverged has
        that as its failure.
    """

    def __init__(self, result: SceneResult) -> None:
        self._result = result
        self._world = result.scene.build()
        self._before: dict[str, Moment] = {}

    def begin(self, engines: Sequence[Engine]) -> None:
        """Note how the engines' worlds are now: what is measured from here on is measured from that."""
        for engine in engines:
            if self._copy(engine):
                self._before[engine.title] = Moment.of(self._world)

    def look(self, engines: Sequence[Engine], when: When) -> None:
        """Measure what is due at a time."""
        due = [quality for quality in self._result.scene.quality if quality.when == when]
        for engine in engines if due else ():
            if not self._copy(engine):
                continue
            found = self._result.engines[engine.title].quality
            for quality in due:
                figure = quality.measure(self._world, self._before[engine.title])
                if when == "throughout":
                    figure = max(figure, found.get(quality.name) or 0.0)
                found[quality.name] = figure if math.isfinite(figure) else None

    def _copy(self, engine: Engine) -> bool:
        """Copy an engine's state into the world; return whether it is finite."""
        here, result = self._world, self._result.engines[engine.title]
        try:
            there = engine.look()
        except Diverged:
            result.failure = "NaN"
        if result.failure:
            return False
        here.synchronise()
        source, place = (world.batch(Transform, Velocity).rows for world in (there, here))
        for component, columns in ((Transform, ("position", "angle")), (Velocity, ("linear", "angular"))):
            for column in columns:
                here.table(component)[column][place] = there.table(component)[column][source]
        return True
