"""Steps that take long, or hold a storm of impacts: which, and what takes the time in them."""

import numpy as np

from physicslab.contacts.report import count_near_pairs
from physicslab.diagnostics.step_warnings import ModelWarning
from physicslab.ecs.sentences import sentence
from physicslab.systems.breaking import breaks_of
from physicslab.world import World

_SLOW_S = 1.0
"""Time [s] from which on a step is called slow: sixty times what the window has for one."""
_STORM = 100.0
"""Impacts in a step from which on they are the reason; a gas of 2,000 discs has some twenty."""
STORM_LIMIT = 1000
"""Impacts within the time of one step from which on they are a storm, however fast it is computed: the bodies
of a scene with exact collisions are few, and those that come to rest are taken out at the last bounces."""
_EVALUATIONS = 10_000.0
"""Force evaluations in a step from which on the method is the reason: as many as substeps may be set."""


class StepWatch:
    """Notes how long steps take and how many impacts they hold; reports where the first bad one is, and why.

    Parameters
    ----------
    world : World
        Whose steps.

    Attributes
    ----------
    warnings : tuple of ModelWarning
        Warnings of the slowest step, if one was slow, and of the worst storm of impacts, if there was one.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._collisions, self._evaluations = int(world.collisions), world.force_evaluations
        self._logged = int(world.contacts.logged)
        self._worst = 0.0
        self._broken = len(breaks_of(world.schedule.systems, world.time))
        self._slow: ModelWarning | None = None
        self._storm: ModelWarning | None = None
        self._most_impacts = 0

    @property
    def warnings(self) -> tuple[ModelWarning, ...]:
        """The warnings so far, one of each kind."""
        return tuple(warning for warning in (self._slow, self._storm) if warning is not None)

    def note(self, steps: int, seconds: float) -> str:
        """Take note of so many steps, which took so many seconds without compiling.

        Returns
        -------
        str
            The message, the first time that one is slow; else empty.
        """
        world, steps = self._world, max(steps, 1)
        impacts = (int(world.collisions) - self._collisions) / steps
        evaluations = (world.force_evaluations - self._evaluations) / steps
        self._collisions, self._evaluations = int(world.collisions), world.force_evaluations
        each = seconds / steps
        if each <= max(_SLOW_S, self._worst):
            return ""
        first, self._worst = self._slow is None, each
        why, setting, figures = self._reason(impacts, evaluations)
        self._slow = ModelWarning(None, sentence("step_takes_long", why=why), each, "s", _SLOW_S, setting)
        time = f"{world.time:.9g}"
        line = sentence("slow_step", time=time, seconds=f"{each:.3g}", why=why, figures=figures)
        return sentence("would_help", what=line, setting=setting) if first else ""

    def note_breaks(self) -> str:
        """Return which joints broke since the last call; empty if none did."""
        broken = breaks_of(self._world.schedule.systems, self._world.time)
        new, self._broken = broken[self._broken :], len(broken)
        return "; ".join(map(str, new))

    def note_impacts(self) -> str:
        """Take note of the impacts that were located in time since the last call.

        They are counted by their own times: a storm within one of many compiled steps shows as well.

        Returns
        -------
        str
            The message, the first time that there are too many within a step; else empty.
        """
        world, contacts = self._world, self._world.contacts
        new, self._logged = int(contacts.logged) - self._logged, int(contacts.logged)
        located = [part for part in world.parts if part.plan.collisions == "exact"]
        if new < STORM_LIMIT or not located:
            return ""
        log = contacts.impacts[-new:]
        if len(located) < len(world.parts):
            own = [part.entity_index.entities[part.bodies.inverse_mass > 0.0] for part in located]
            log = log[np.isin((log["entity_a"], log["entity_b"]), np.concatenate(own)).any(axis=0)]
        if not len(log):
            return ""
        times = np.sort(log["time"])
        counts = np.searchsorted(times, times + world.simulation.dt) - np.arange(len(times))
        begin = int(np.argmax(counts))
        count = int(counts[begin])
        if count <= max(STORM_LIMIT, self._most_impacts):
            return ""
        first, start, self._most_impacts = self._storm is None, float(times[begin]), count
        within = (log["time"] >= start) & (log["time"] < start + world.simulation.dt)
        entities, often = np.unique(log["entity_b"][within], return_counts=True)
        struck = int(entities[np.argmax(often)])
        what = sentence("storm")
        setting = 'simulation.collisions = "step"'
        self._storm = ModelWarning.about(world, struck, what, float(count), "", float(STORM_LIMIT), setting)
        return sentence("at_time", time=f"{start:.9g}", what=self._storm.words) if first else ""

    def _reason(self, impacts: float, evaluations: float) -> tuple[str, str, str]:
        """Return in words what takes the time, what would help, and the figures."""
        world, plans = self._world, self._world.plans
        # That of the part which has evaluated its forces most often.
        method = max(world.parts, key=lambda part: part.force_evaluations).plan.integrator
        if impacts >= _STORM and any(plan.collisions == "exact" for plan in plans):
            figures = sentence("impacts_made", count=f"{impacts:.3g}")
            return sentence("impact_after_impact"), 'simulation.collisions = "step"', figures
        if evaluations >= _EVALUATIONS:
            setting = sentence("shorter_dt") if not method.chooses_steps else sentence("larger_tolerance")
            figures = sentence("evaluations_by", count=f"{evaluations:.3g}", method=method.name)
            return sentence("forces_change_fast"), setting, figures
        if any(plan.contacts == "rigid" and plan.collisions == "step" for plan in plans):
            figures = sentence("evaluations", count=f"{evaluations:.3g}")
            return sentence("event_to_event"), 'simulation.contacts = "soft"', figures
        bodies = len(world.entity_index) - 1
        pairs = count_near_pairs(world)
        figures = sentence("size_of_step", bodies=bodies, pairs=pairs, substeps=world.substeps)
        return sentence("much_to_compute"), sentence("fewer"), figures
