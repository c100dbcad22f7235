"""Contact points with their impulses as one array: what rests, and the impacts of the last second."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material, Transform, Velocity
from physicslab.components.material import friction_of_pair
from physicslab.contacts.islands import impulse_spans
from physicslab.world import World

_STILL = 1e-6
"""Speed along a surface [m/s] below which nothing slides."""

type ContactSamples = NDArray[Any]
"""An array of SAMPLE (n,)."""

SAMPLE = np.dtype(
    [
        ("a", np.int64),  # entities; 0 is the world's bounds
        ("b", np.int64),
        ("point", np.int64),  # which of the pair's points; for an impact, a negative number of its own
        ("place", np.float64, 2),  # [m]
        ("direction", np.float64, 2),  # unit normal, into the body that the impulses are shown on
        ("friction", np.float64),  # coefficient
        ("normal", np.float64),  # impulses [N s]; the tangent is the direction turned counter-clockwise
        ("tangent", np.float64),
        ("speed", np.float64),  # of approach before the impulse [m/s]; 0 at rest
        ("slip", np.float64),  # speed along the surface [m/s]; infinite for an impact, which does not tell
        ("time", np.float64),  # of the impact, or now [s]
        ("span", np.float64),  # time over which the impulses act [s]; 0 of an impact
    ]
)
"""The impulses at one point of a contact."""


def resting_of(world: World) -> ContactSamples:
    """Return where bodies touch, with the impulses of the last substep that held them apart."""
    contacts = world.contacts
    contacts.sync()
    manifolds, points = contacts.manifolds, contacts.points
    pairs = np.flatnonzero(manifolds["count"][: contacts.recorded] > 0)
    both = np.stack((2 * pairs, 2 * pairs + 1), axis=1)
    chosen = both[np.arange(2) < manifolds["count"][pairs][:, None]]
    pair = chosen // 2
    samples: ContactSamples = np.zeros(len(chosen), SAMPLE)
    # A column at a time: what else there is of a contact is several times as much.
    samples["a"], samples["b"] = manifolds["entity_a"][pair], manifolds["entity_b"][pair]
    samples["point"] = chosen % 2
    row_a, row_b = manifolds["a"][pair], manifolds["b"][pair]
    centre = world.table(Transform)["position"]
    for axis, arm in enumerate(("arm_bx", "arm_by")):
        samples["place"][:, axis] = centre[row_b, axis] + points[arm][chosen]
    for axis, name in enumerate(("normal_x", "normal_y")):
        samples["direction"][:, axis] = manifolds[name][pair]
    samples["friction"] = manifolds["friction"][pair]
    samples["normal"], samples["tangent"] = (
        points["normal_impulse"][chosen],
        points["tangent_impulse"][chosen],
    )
    samples["time"], samples["span"] = world.time, impulse_spans(world, pair)
    samples["slip"] = _slip_of(world, samples, row_a, row_b, points[chosen])
    _show_on_what_moves(world, samples, row_a, row_b)
    return samples


def _slip_of(
    world: World, samples: ContactSamples, row_a: NDArray[np.int64], row_b: NDArray[np.int64],
    points: NDArray[Any],
) -> NDArray[np.float64]:  # fmt: skip
    """Return how fast bodies move along each other at their points [m/s]."""
    velocity, fixed = world.table(Velocity), samples["a"] == 0
    linear, angular = velocity["linear"], velocity["angular"]
    ours = linear[row_a] + angular[row_a, None] * np.stack((-points["arm_ay"], points["arm_ax"]), axis=1)
    ours[fixed] = 0.0  # the bounds
    theirs = linear[row_b] + angular[row_b, None] * np.stack((-points["arm_by"], points["arm_bx"]), axis=1)
    normal, relative = samples["direction"], theirs - ours
    slip: NDArray[np.float64] = np.abs(normal[:, 0] * relative[:, 1] - normal[:, 1] * relative[:, 0])
    return slip


def samples_of(world: World, impacts: NDArray[Any]) -> ContactSamples:
    """Return impacts, an array of IMPACT (n,), of bodies that still exist."""
    row_a = world.entity_index.rows_of(impacts["entity_a"])
    row_b = world.entity_index.rows_of(impacts["entity_b"])
    exists = (row_a >= 0) & (row_b >= 0)
    impacts, row_a, row_b = impacts[exists], row_a[exists], row_b[exists]
    samples: ContactSamples = np.zeros(len(impacts), SAMPLE)
    samples["a"], samples["b"] = impacts["entity_a"], impacts["entity_b"]
    samples["place"] = np.stack((impacts["x"], impacts["y"]), axis=1)
    samples["direction"] = np.stack((impacts["normal_x"], impacts["normal_y"]), axis=1)
    friction = world.table(Material)["friction"]
    of_a = np.where(impacts["wall"] >= 0, world.physics.bounds_friction, friction[row_a])
    samples["friction"] = friction_of_pair(of_a, friction[row_b])
    samples["normal"], samples["tangent"] = impacts["normal_impulse"], impacts["tangent_impulse"]
    samples["speed"], samples["time"] = impacts["approach_speed"], impacts["time"]
    samples["slip"] = np.inf
    _show_on_what_moves(world, samples, row_a, row_b)
    return samples


def _show_on_what_moves(
    world: World, samples: ContactSamples, row_a: NDArray[np.int64], row_b: NDArray[np.int64]
) -> None:
    """Turn normals from A to B into those of the body that impulses are shown on: B, or A if B is immovable.

    The impulses remain: seen from the other side, normal and tangent turn round, and so do the impulses.
    """
    inverse_mass = world.bodies.inverse_mass
    on_a = (inverse_mass[row_b] == 0.0) & (inverse_mass[row_a] > 0.0)
    samples["direction"][on_a] *= -1.0


def sliding(samples: ContactSamples) -> NDArray[np.bool_]:
    """Return of samples (n,) whether friction is at its limit mu J_n (Coulomb), and bodies move along it.

    At the limit a body can still rest: of the two points under a block one may carry all that friction can.
    """
    limit = samples["friction"] * samples["normal"]
    at_limit = (limit > 0.0) & (np.abs(samples["tangent"]) >= limit * (1.0 - 1e-9))
    slips: NDArray[np.bool_] = at_limit & (samples["slip"] > _STILL)
    return slips


# ---- impacts, kept for long enough to be seen --------------------------------------------------------------


SHOWN = 1.0
"""How long an impact is shown [s]; it is the world's time, which stands still while paused."""
_MAX_KEPT = 256
"""The weakest impacts beyond that number are left out."""
_SAME_PLACE = 0.15
"""Impacts of a pair nearer than that look like one; in lengths of the longest arrow."""


class RecentImpacts:
    """Keeps the impacts of the last second; of those of one pair at one place, the one that stands out most.

    Attributes
    ----------
    kept : array of SAMPLE (n,)
        The impacts, those that stood out most when they were noted first.
    same_place : float
        Two impacts of a pair, or an impact and a resting contact, are shown as one if nearer than that [m].
    """

    def __init__(self) -> None:
        self.same_place = 0.0
        self._count = 0
        self.clear()

    def clear(self) -> None:
        """Forget them all."""
        self.kept: ContactSamples = np.zeros(0, SAMPLE)

    def note(self, world: World, impacts: NDArray[Any], reach: float) -> None:
        """Take in new impacts of a world, of IMPACT (n,); the longest arrow is ``reach`` [m] long."""
        self.same_place = _SAME_PLACE * reach
        if not len(impacts):
            return
        strongest = np.argsort(-impacts["normal_impulse"], kind="stable")[:_MAX_KEPT]
        new = samples_of(world, impacts[strongest])
        new["point"] = -1 - self._count - np.arange(len(new))  # a key that no other contact or impact has
        self._count += len(new)
        every = np.concatenate((self.recent(world.time), new))
        strength = every["normal"] * self.freshness(every, world.time)
        every = every[np.argsort(-strength, kind="stable")]
        stands_behind = np.tril(same_place(every, every, self.same_place), -1).any(axis=1)
        self.kept = every[~stands_behind][:_MAX_KEPT]

    def recent(self, time: float) -> ContactSamples:
        """Return those that are still to be seen at a time [s]."""
        return self.kept[time - self.kept["time"] < SHOWN]

    @staticmethod
    def freshness(impacts: ContactSamples, time: float) -> NDArray[np.float64]:
        """Return how far each of some impacts (n,) has faded at a time [s]: 1 is new, 0 is gone."""
        fresh: NDArray[np.float64] = np.clip(1.0 - (time - impacts["time"]) / SHOWN, 0.0, 1.0)
        return fresh


def same_place(one: ContactSamples, other: ContactSamples, distance: float) -> NDArray[np.bool_]:
    """Return whether samples are of the same pair and nearer than ``distance`` [m], an array (one, other)."""
    same: NDArray[np.bool_] = one["a"][:, None] == other["a"]
    same &= one["b"][:, None] == other["b"]
    first, second = np.nonzero(same)
    apart = one["place"][first] - other["place"][second]
    same[first, second] = np.hypot(apart[:, 0], apart[:, 1]) < distance
    return same
