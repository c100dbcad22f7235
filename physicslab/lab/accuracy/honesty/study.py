"""How honest estimates of errors are: random scenes of many families, beside what is known of each."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from random import Random

import numpy as np
from numpy.typing import NDArray

from physicslab.files.reader import read_scene
from physicslab.lab.accuracy.honesty import smooth, touching
from physicslab.lab.accuracy.honesty.scene import KnownScene
from physicslab.lab.accuracy.paths import differences, run_path
from physicslab.lab.accuracy.trust import OF_ROUNDING, assess, scales
from physicslab.lab.accuracy.variants import ROUNDING
from physicslab.lab.case import attempt
from physicslab.lab.jobs import Job, scaled
from physicslab.world import World

FAMILIES: dict[str, Callable[[Random], KnownScene]] = {
    "springs": smooth.springs,
    "nets": smooth.net,
    "orbits": smooth.orbit,
    "flybys": smooth.flyby,
    "drag": smooth.drag,
    "edges": touching.edge,
    "belts": touching.belt,
    "slopes": touching.slope,
    "bounces": touching.bounce,
    "falls": touching.fall,
    "stacks": touching.stack,
    "crowds": touching.crowd,
}
"""The families from which scenes are drawn."""
QUANTITIES = ("position", "velocity", "angle", "spin")
_HONEST, _FAR = 3.0, 100.0
"""How many times too small an honest estimate may be, and how many times too large one is told."""
_WANTED = 0.99


@dataclass(frozen=True, slots=True)
class HonestRow:
    """A random scene: by how much its errors are larger than they were estimated to be.

    Attributes
    ----------
    family : str
        The family that it was drawn from.
    seed : int
        With which it was drawn.
    ratios : tuple of floats
        The true error over its estimate, of position, velocity, angle and spin, of the worst body; the true
        error is taken to be a rounding at least, and all there is (no digit) at most.
    estimate, error : float
        Errors of the position of the worst body, as shares of it or of its size.
    too_large : bool
        Whether the estimate is more than 100 times the error, and none of rounding.
    failure : str
        Why there are no figures.
    """

    family: str
    seed: int
    ratios: tuple[float, ...] = ()
    estimate: float = 0.0
    error: float = 0.0
    too_large: bool = False
    failure: str = ""


@dataclass(slots=True)
class HonestShare:
    """The summary of the rows of a family, or of all.

    Attributes
    ----------
    known : int
        How many have figures.
    honest : list of ints
        In how many the estimate is at most 3 times too small, of each quantity.
    too_large : int
        In how many that of the position is more than 100 times too large.
    worst : float
        The largest true error of a position over its estimate.
    """

    known: int = 0
    honest: list[int] = field(default_factory=lambda: [0] * len(QUANTITIES))
    too_large: int = 0
    worst: float = 0.0

    @property
    def holds(self) -> bool:
        """Whether the estimates of positions are honest in 99 of 100."""
        return self.honest[0] >= _WANTED * self.known


def share_of(rows: Sequence[HonestRow]) -> HonestShare:
    """Count the rows that are honest."""
    found = HonestShare()
    for row in rows:
        if not row.failure:
            found.known += 1
            found.honest = [n + (ratio <= _HONEST) for n, ratio in zip(found.honest, row.ratios, strict=True)]
            found.too_large += row.too_large
            found.worst = max(found.worst, row.ratios[0])
    return found


def assess_known(family: str, seed: int) -> Job[HonestRow]:
    """Draw a scene of a family, estimate its error, and compare with its truth."""
    known = FAMILIES[family](Random(f"{family} {seed}"))
    trust = yield from scaled(assess(lambda: read_scene(known.document), known.seconds), 0.0, 0.9)
    if trust.failure:
        return HonestRow(family, seed, failure=trust.failure)
    shares, failure = attempt(lambda: _true_shares(known, read_scene(known.document), [*trust.entities]))
    if shares is None:
        return HonestRow(family, seed, failure=failure)
    digits = (trust.entities, trust.velocities, trust.angles, trust.spins)
    claimed = np.array([[10.0**-count for count in each.values()] for each in digits])
    shares = np.clip(shares, ROUNDING, 1.0)
    worst = shares.shape[1] and int((shares[0] / claimed[0]).argmax())
    estimate, error = float(claimed[0].max()), float(shares[0].max())
    return HonestRow(
        family, seed, tuple((shares / claimed).max(axis=1).tolist()), float(claimed[0, worst]),
        float(shares[0, worst]), estimate > OF_ROUNDING and estimate > _FAR * error,
    )  # fmt: skip


def _true_shares(known: KnownScene, world: World, bodies: list[str]) -> NDArray[np.float64]:
    """Return the true errors (4, n): of positions, velocities, angles and spins, as shares."""
    path = run_path(world, bodies, (known.seconds,))
    errors = differences(path.end, known.truth())
    whole = scales(world, path, bodies, (known.seconds,))
    return np.array([error / scale[-1] for error, scale in zip(errors, whole, strict=True)])
