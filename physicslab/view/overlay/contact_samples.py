"""Contact points with their impulses, as one array: what the overlays show."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.world import World

__all__ = ["TOUCH", "ContactSamples", "impacts_of", "resting_of", "sliding"]

type ContactSamples = NDArray[Any]
"""An array of TOUCH (n,)."""

TOUCH = np.dtype(
    [
        ("a", np.int64),  # entities; 0 is the world's bounds
        ("b", np.int64),
        ("point", np.int64),  # which of the pair's points
        ("place", np.float64, 2),  # [m]
        ("direction", np.float64, 2),  # unit normal, into the body that the impulses are shown on
        ("friction", np.float64),  # coefficient
        ("normal", np.float64),  # impulses [N s]; the tangent is the direction turned counter-clockwise
        ("tangent", np.float64),
        ("speed", np.float64),  # approach before the impulse [m/s]
        ("time", np.float64),  # when the step began [s]
    ]
)
"""What one point of a contact has felt."""


def _touches(world: World, chosen: NDArray[np.int64], normal: str, tangent: str) -> ContactSamples:
    """Return the points of these numbers, with the impulses of two columns."""
    pair, manifolds, points = chosen // 2, world.contacts.manifolds, world.contacts.points
    touches: ContactSamples = np.zeros(len(chosen), TOUCH)
    # A column at a time: what else there is of a contact is several times as much.
    touches["a"], touches["b"], touches["point"] = (
        manifolds["entity_a"][pair], manifolds["entity_b"][pair], chosen % 2,
    )  # fmt: skip
    row_a, row_b = manifolds["a"][pair], manifolds["b"][pair]
    place, centre = touches["place"], world.table(Transform)["position"]
    for axis, arm in enumerate(("arm_bx", "arm_by")):
        place[:, axis] = centre[row_b, axis] + points[arm][chosen]
    # Shown on B, or on A where nothing can push B: seen from there, normal and tangent turn round.
    inverse_mass = world.bodies.inverse_mass
    on_a = (inverse_mass[row_b] == 0.0) & (inverse_mass[row_a] > 0.0)
    for axis, name in enumerate(("normal_x", "normal_y")):
        component = manifolds[name][pair]
        touches["direction"][:, axis] = np.where(on_a, -component, component)
    touches["friction"], touches["speed"] = manifolds["friction"][pair], points["approach_speed"][chosen]
    touches["normal"], touches["tangent"] = points[normal][chosen], points[tangent][chosen]
    touches["time"] = world.time
    return touches


def resting_of(world: World) -> ContactSamples:
    """Return where bodies touch, with the impulses of the last substep that held them apart."""
    contacts = world.contacts
    contacts.sync()
    pairs = np.flatnonzero(contacts.manifolds["count"][: contacts.recorded] > 0)
    both = np.stack((2 * pairs, 2 * pairs + 1), axis=1)
    in_use = np.arange(2) < contacts.manifolds["count"][pairs][:, None]
    chosen = both[in_use]
    return _touches(world, chosen, "normal_impulse", "tangent_impulse")


def impacts_of(world: World) -> ContactSamples:
    """Return the impacts of the step so far."""
    contacts = world.contacts
    pairs = np.flatnonzero(contacts.manifolds["struck"][: contacts.recorded] > 0)
    both = np.stack((2 * pairs, 2 * pairs + 1), axis=1).reshape(-1)
    return _touches(
        world, both[contacts.points["impact_normal"][both] > 0.0], "impact_normal", "impact_tangent"
    )


def sliding(touches: ContactSamples) -> NDArray[np.bool_]:
    """Whether friction is at its limit mu times the normal impulse (Coulomb), so that the contact slips."""
    limit = touches["friction"] * touches["normal"]
    slips: NDArray[np.bool_] = (limit > 0.0) & (np.abs(touches["tangent"]) >= limit * (1.0 - 1e-9))
    return slips
