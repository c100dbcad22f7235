"""Couplings of Step's bodies: springs, joints, motors and laws of force."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from physicslab.files.kde_step.draft import Body, Draft, turned
from physicslab.files.kde_step.item import Item, Pair
from physicslab.kernels.forces.molecules import CUT2

_ROUNDED = 1e-4
"""Share of a length by which Step's files, of six digits, may be off: the length is then as placed."""
LENNARD_JONES = "GasLJForce"
"""The class of the force of Lennard and Jones."""
_WEIGHT, _GRAVITATION, _COULOMB = 9.80665, 6.67428e-11, 8.987551787e9
"""Step's constants where a file has none [m/s^2], [N m^2/kg^2], [N m^2/C^2]."""


def take_spring(item: Item, draft: Draft) -> None:
    """Take a spring; one of two fixed ends moves nothing."""
    ends = _ends(item, draft)
    if ends is None:
        return
    values = {
        "rest_length": item.number_of("restLength", 0.0),
        "stiffness": item.number_of("stiffness", 1.0),
        "damping": item.number_of("damping", 0.0),
    }
    draft.place(item, {"Spring": ends[0] | values})


def take_stick(item: Item, draft: Draft) -> None:
    """Take a stick or a rope; of no length it is a pin."""
    ends = _ends(item, draft)
    if ends is None:
        return
    values, distance = ends
    length = item.number_of("restLength", 1.0)
    kind = "Rod" if item.kind == "Stick" else "Rope"
    if length == 0.0:
        kind = "Pin"
    elif kind == "Rope":
        slack = abs(distance - length) > _ROUNDED * length
        values["length"] = length if slack else max(length, distance)
    elif abs(distance - length) > _ROUNDED * length:
        values["length"] = length
        draft.lose(item, f"it is {distance:g} m long as placed, and {length:g} m as it should be")
    draft.place(item, {kind: values | {"collide": True}})


def take_pin(item: Item, draft: Draft) -> None:
    """Take a pin. A particle at a distance from its pin goes around it, as if it were on a stick."""
    body, place = _body(item, draft), item.pair("position")
    if body is None or not body.moves:
        return
    draft.points.append(place)
    point = item.pair("localPosition")
    values: dict[str, Any] = {"a": body.id, "anchor_b": list(place)}
    if not body.is_point:
        draft.place(item, {"Pin": values | {"anchor_a": body.anchor(point)}})
    elif point != (0.0, 0.0):
        draft.place(item, {"Rod": values})
    else:
        _hold(body)


def take_anchor(item: Item, draft: Draft) -> None:
    """Take an anchor: the body stays where it is."""
    body = _body(item, draft)
    if body is not None:
        _hold(body)


def take_motor(item: Item, draft: Draft) -> None:
    """Take a motor: a constant force at a point of a body, or a constant torque."""
    body = _body(item, draft)
    if body is None:
        return
    draft.placed[item.number] = body.entity
    if item.kind == "CircularMotor" and body.is_point:
        draft.lose(item, "a particle does not turn")
        return
    if not body.moves:
        return
    thrust = body.entity.setdefault("Thrust", {"force": [0.0, 0.0], "torque": 0.0})
    if item.kind == "CircularMotor":
        thrust["torque"] += item.number_of("torqueValue", 0.0)
        return
    force, fixed = item.pair("forceValue"), item.flag("rigidlyFixed") and not body.is_point
    point = (0.0, 0.0) if body.is_point else item.pair("localPosition")
    if fixed:
        force = turned(force, -body.angle)
    _push(item, draft, thrust, force, body.anchor(point), "body" if fixed else "world")


def _push(item: Item, draft: Draft, thrust: dict[str, Any], more: Pair, at: list[float], frame: str) -> None:
    """Add a force to a thrust. As complex numbers conj(a) F is a . F + i a x F, of which forces add up."""
    one, other = complex(*thrust["force"]), complex(*more)
    if one == 0.0:
        thrust |= {"force": list(more), "at": at, "frame": frame}
        return
    arm, sum_ = complex(*thrust["at"]), one + other
    moment = arm.conjugate() * one + complex(*at).conjugate() * other
    if thrust["frame"] != frame or (frame == "world" and sum_ == 0.0 != moment):
        draft.lose(item, "it cannot be one with the other motors of the body")
        return
    if frame == "body":
        thrust["torque"] += ((complex(*at) - arm).conjugate() * other).imag
    elif sum_ != 0.0:
        arm = (moment / sum_).conjugate()
    thrust |= {"force": [sum_.real, sum_.imag], "at": [arm.real, arm.imag]}


def take_weight(item: Item, draft: Draft) -> None:
    """Take the weight: uniform gravity."""
    strength = item.number_of("weightConst", _WEIGHT) - draft.physics.get("gravity", (0.0, 0.0))[1]
    if draft.physics["gravity_mode"] == "planet":
        draft.lose(item, "bodies attract each other here, and have no weight beside that")
        return
    draft.physics |= {"gravity_mode": "linear", "gravity": [0.0, -strength]}


def take_gravitation(item: Item, draft: Draft) -> None:
    """Take the attraction of masses, which in Step is that of particles alone."""
    strength = item.number_of("gravitationConst", _GRAVITATION)
    if draft.physics.pop("gravity", None) is not None:
        draft.lose(item, "bodies attract each other here, and have no weight beside that")
    draft.physics |= {"gravity_mode": "planet", "G": draft.physics.get("G", 0.0) + strength}
    solid = [body.id for body in draft.bodies.values() if not body.is_point and "Mass" in body.entity]
    if solid:
        draft.lose(item, f"here it pulls {solid[0]} too" + (f" and {len(solid) - 1} more" * (len(solid) > 1)))


def take_coulomb(item: Item, draft: Draft) -> None:
    """Take the force of charges."""
    strength = item.number_of("coulombConst", _COULOMB)
    draft.physics["coulomb_constant"] = draft.physics.get("coulomb_constant", 0.0) + strength


def take_molecules(group: Item, draft: Draft) -> None:
    """Take the forces of Lennard and Jones in a group, which act among its own particles of gas."""
    own = [draft.bodies[item.number].entity for item in group.items if item.kind == "GasParticle"]
    others = [body.entity for body in draft.bodies.values() if "Molecule" in body.entity]
    for item in group.items:
        if item.kind != LENNARD_JONES:
            continue
        if any("Molecule" in entity for entity in own):
            draft.lose(item, "its particles have such a force already")
            continue
        depth, distance = item.number_of("depth", 1.0), item.number_of("rmin", 1.0)
        cut = item.number_of("cutoff", math.inf, infinite=True)
        ends = math.sqrt(CUT2) * distance
        if cut < ends:
            draft.lose(item, f"it ends at {cut:g} m; here at {ends:.3g} m")
        if others and own:
            draft.lose(item, f"molecules of all gases act on each other here, as on {others[0]['id']}")
        for entity in own:
            entity["Molecule"] = {"depth": depth, "distance": distance}


HOLDS: Mapping[str, Callable[[Item, Draft], None]] = {"Pin": take_pin, "Anchor": take_anchor}
"""The classes of what holds one body to the world."""
COUPLINGS: Mapping[str, Callable[[Item, Draft], None]] = {
    "Spring": take_spring,
    "SoftBodySpring": take_spring,
    "Stick": take_stick,
    "Rope": take_stick,
    "LinearMotor": take_motor,
    "CircularMotor": take_motor,
    "WeightForce": take_weight,
    "GravitationForce": take_gravitation,
    "CoulombForce": take_coulomb,
}
"""The classes of what else acts on bodies."""


def _ends(item: Item, draft: Draft) -> tuple[dict[str, Any], float] | None:
    """Return the two ends, a body first, and their distance [m]; nothing where neither is one that moves."""
    ends: list[tuple[Body | None, Pair]] = []
    for n in ("1", "2"):
        name, point = f"body{n}", item.pair(f"localPosition{n}")
        body = _body(item, draft, name) if item.whole(name, 0) else draft.end(item, name)
        if body is None and item.whole(name, 0):
            return None
        ends.append((body, point))
    (a, at_a), (b, at_b) = ends if ends[0][0] is not None else ends[::-1]
    if a is None or not (a.moves or (b is not None and b.moves)):
        draft.lose(item, "neither end is a body that moves")
        return None
    if a is b:
        draft.lose(item, "both ends are the same body")
        return None
    here, there = a.in_world(at_a), at_b if b is None else b.in_world(at_b)
    draft.points += [here, there]
    values = {"a": a.id, "anchor_a": a.anchor(at_a), "anchor_b": list(at_b) if b is None else b.anchor(at_b)}
    if b is not None:
        values["b"] = b.id
    return values, ((here[0] - there[0]) ** 2 + (here[1] - there[1]) ** 2) ** 0.5


def _body(item: Item, draft: Draft, name: str = "body") -> Body | None:
    """Return the body that an item names; without one it is lost, and that is said."""
    body, number = draft.end(item, name), item.whole(name, 0)
    if body is None:
        draft.lose(item, f"its body, item {number}, is not taken" if number else "it has no body")
    return body


def _hold(body: Body) -> None:
    """Keep a body where it is; its mass still attracts others."""
    for name in ("Velocity", "Pin"):
        body.entity.pop(name, None)
