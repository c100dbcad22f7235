"""How good estimates of errors are: beside the true errors, where answers are known."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from physicslab.ecs.config import SimulationConfig
from physicslab.files.reader import read_scene
from physicslab.files.writer import write_scene
from physicslab.lab.accuracy import variants
from physicslab.lab.accuracy.contacts.case import ContactCase
from physicslab.lab.accuracy.contacts.study import OWN, ContactEngine
from physicslab.lab.accuracy.problem import KnownCase, Problem, Setting
from physicslab.lab.accuracy.trust import error_estimates
from physicslab.lab.case import attempt
from physicslab.lab.jobs import Job
from physicslab.world import World

CONTACT_STEP = 1.0 / 60.0
"""With which contact cases are computed [s]."""
_NEAR, _FAR, _SHARE = 10.0, 100.0, 0.95
"""Within what factor of the estimate true errors are to be, how much larger they may ever be, and how often
they are to be as near."""
_OF_ROUNDING = 1e-12
"""An estimate up to this is one of what rounding adds up to, and the sum may by chance be far less."""


@dataclass(frozen=True, slots=True)
class TrustRow:
    """A problem with a known answer: how large its error was estimated to be, and how large it is.

    Attributes
    ----------
    case : KnownCase
        Which.
    method : str
        The method that ran, or the model of contacts.
    estimate, error : float, optional
        Both as the case measures errors; ``None`` where the run failed.
    """

    case: KnownCase
    method: str
    estimate: float | None
    error: float | None

    @property
    def ratio(self) -> float | None:
        """The true error over the estimate; both are taken to be a rounding at least."""
        if self.estimate is None or self.error is None:
            return None
        return max(self.error, variants.ROUNDING) / max(self.estimate, variants.ROUNDING)

    @property
    def near(self) -> bool:
        """Whether the error is within a factor of 10 of the estimate, or less where both are of rounding."""
        if self.estimate is None or self.ratio is None:
            return False
        return self.ratio <= _NEAR and (self.ratio >= 1.0 / _NEAR or self.estimate <= _OF_ROUNDING)


@dataclass(frozen=True, slots=True)
class TrustSummary:
    """The summary of rows.

    Attributes
    ----------
    known, near : int
        How many have both figures, and in how many the error is within a factor of 10 of the estimate.
    largest : float
        The largest true error over its estimate.
    cautious : int
        How many of those that are near have an estimate of rounding that is more than 10 times too large.
    """

    known: int
    near: int
    largest: float
    cautious: int

    @property
    def holds(self) -> bool:
        """Whether 95 % are near, and no error is more than 100 times its estimate."""
        return self.near >= _SHARE * self.known and self.largest <= _FAR


def summarise(rows: Sequence[TrustRow]) -> TrustSummary:
    """Count the rows whose estimate is good."""
    ratios = [row.ratio for row in rows if row.ratio is not None]
    near = [row.ratio for row in rows if row.near and row.ratio is not None]
    cautious = sum(ratio < 1.0 / _NEAR for ratio in near)
    return TrustSummary(len(ratios), len(near), max(ratios, default=0.0), cautious)


def assess_problem(problem: Problem) -> Job[TrustRow]:
    """Estimate the error of a problem, run as ``auto`` runs it, and measure its true error."""
    simulation = Setting("auto").simulation(problem)
    world = problem.build(simulation)
    world.synchronise()
    return (yield from _assess(problem, world.plan.integrator.name, simulation, {}))


def assess_contacts(case: ContactCase, engine: ContactEngine) -> Job[TrustRow]:
    """Estimate the error of a contact case with one of our models of contacts, and measure its true error.

    With soft contacts, rigid ones are another way to compute it.
    """
    others = {own.name: own.simulation(CONTACT_STEP) for own in OWN if own.name == "rigid" != engine.name}
    return (yield from _assess(case, engine.title, engine.simulation(CONTACT_STEP), others))


def _assess(
    case: KnownCase, method: str, simulation: SimulationConfig, others: Mapping[str, SimulationConfig]
) -> Job[TrustRow]:
    """Estimate an error by how much the case's figure changes where it is computed in other ways."""
    worlds, ready = case.worlds(simulation), case.worlds(simulation)
    documents = [variants.with_ids(write_scene(world)) for world in worlds]
    for world in ready:
        world.synchronise()
    error, _ = attempt(partial(case.finish, worlds))
    if error is None:
        return TrustRow(case, method, None, None)

    def change(other: Sequence[World] | None) -> float:
        """Return how far the figure is from that of other worlds; 0 where there are none."""
        found, _ = (None, "") if other is None else attempt(partial(case.finish, other))
        return 0.0 if found is None else abs(error - found)

    known = {name: change(case.worlds(other)) for name, other in others.items()}
    ways = [variant for variant in variants.VARIANTS if variant.differs_in_step or variant.name == "tightest"]
    whole = len(ways) + variants.NUDGES + 1
    for n, variant in enumerate(ways):
        known[variant.name] = change(_variants(variant, documents, ready))
        yield (n + 1) / whole
    nudges = []
    for n in range(variants.NUDGES):
        nudges.append(change([read_scene(variants.nudged(document, n)) for document in documents]))
        yield (len(ways) + n + 1) / whole
    return TrustRow(case, method, float(max(error_estimates(known, nudges))), error)


def _variants(
    variant: variants.Variant, documents: Sequence[variants.Document], worlds: Sequence[World]
) -> list[World] | None:
    """Return the variants of all worlds, ``None`` where one has no such."""
    made = [variant.make(document, world) for document, world in zip(documents, worlds, strict=True)]
    found = [world for world in made if world is not None]
    return found if len(found) == len(made) else None
