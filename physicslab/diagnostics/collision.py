"""One impact taken apart: two bodies, where they touched, and what the law of impact makes of that.

A record of the ledger holds the poses and the velocities of both bodies at the moment, masses, restitution,
friction, and the impulses of the solver. All else here is worked out from the first of these again, in closed
form, so that the solver's figures can be compared with it: :func:`resolve` takes no impulse and no velocity
after the impact from the record.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.vector import Vector2
from physicslab.kernels.energetic import energetic_blow
from physicslab.kernels.interpreter import twin_of
from physicslab.kernels.solver.blow import ENERGETIC, LOWERED, NEWTON

__all__ = ["ENERGETIC", "LOWERED", "NEWTON", "Body", "Collision", "Motion", "Response", "Result", "Spot",
           "blow_of_one", "read_collision", "resolve"]  # fmt: skip

_SINGULAR = 1e-12
"""Share of the product of two responses below which their determinant counts as none."""
_HALVINGS = 60
"""Bisections for the restitution of two points that makes no energy."""
_STUCK = 1e-9
"""Share of the speeds before up to which the sliding that is left counts as none."""
_ROUNDING = 1e-12
"""Share of the work of the impulses up to which a gain of energy is rounding."""


class Motion(NamedTuple):
    """The velocity of a centre [m/s], and the angular velocity [rad/s]."""

    linear: Vector2
    angular: float

    def at(self, arm: Vector2) -> Vector2:
        """Return the velocity of a point of the body, at an arm from its centre [m/s]."""
        return self.linear + self.angular * arm.perpendicular


class Body(NamedTuple):
    """One of two bodies: inverse mass and moment of inertia (0 where nothing moves it), pose, motion."""

    entity: int
    inverse_mass: float
    inverse_inertia: float
    centre: Vector2
    angle: float
    before: Motion
    after: Motion

    @property
    def is_free(self) -> bool:
        """Whether impulses move it."""
        return self.inverse_mass > 0.0

    def momentum(self, motion: Motion) -> Vector2:
        """Return the momentum in a motion [kg m/s]; none where nothing moves it."""
        return motion.linear / self.inverse_mass if self.is_free else Vector2()

    def energies(self, motion: Motion) -> tuple[float, float]:
        """Return the kinetic energies of moving along and of turning [J]; none where nothing moves it."""
        along = 0.5 * motion.linear.magnitude_squared / self.inverse_mass if self.is_free else 0.0
        turning = 0.5 * motion.angular**2 / self.inverse_inertia if self.inverse_inertia > 0.0 else 0.0
        return along, turning


class Spot(NamedTuple):
    """A point where they touched: its place, arms from both centres [m], the solver's impulses on B [N s]."""

    place: Vector2
    arm_a: Vector2
    arm_b: Vector2
    normal_impulse: float
    tangent_impulse: float


class Response(NamedTuple):
    """What an impulse of 1 N s at a point changes [1/kg], and the parts of that.

    ``kn`` is how a normal impulse changes the normal velocity, 1 / m_n, ``kt`` how a tangential one changes
    the sliding, 1 / m_t, and ``coupling`` how each changes the other. ``apart`` is 1/m_a + 1/m_b: what both
    would be if neither body turned. ``normal_a`` is r_a x n [m], ``across_a`` r_a x t.
    """

    apart: float
    kn: float
    kt: float
    coupling: float
    normal_a: float
    normal_b: float
    across_a: float
    across_b: float


class Result(NamedTuple):
    """What the law gives: normal and tangential impulses of each point [N s], and the motions after."""

    normal: tuple[float, ...]
    tangent: tuple[float, ...]
    a: Motion
    b: Motion
    restitution: float
    sticks: bool


@dataclass(frozen=True)
class Collision:
    """An impact of two bodies, as the ledger has it.

    Attributes
    ----------
    time : float
        When it was [s].
    a, b : Body
        The two; the normal points from A to B, impulses act on B, and on A with the other sign.
    wall : int
        Which of the bounds A is, -1 for a pair of bodies.
    normal : Vector2
        Unit; the tangent is the normal turned counter-clockwise.
    spots : tuple of Spot
        One point, or two that met at once.
    restitution, friction : float
        Those that were asked for.
    law : int
        ``NEWTON``, ``ENERGETIC`` (Stronge's) or ``LOWERED``.
    alone : bool
        Whether only impulses of this pair acted on the two bodies at that moment.
    """

    time: float
    a: Body
    b: Body
    wall: int
    normal: Vector2
    spots: tuple[Spot, ...]
    restitution: float
    friction: float
    law: int
    alone: bool

    @property
    def tangent(self) -> Vector2:
        """The direction of friction, unit."""
        return self.normal.perpendicular

    @property
    def normal_impulse(self) -> float:
        """The normal impulse on B that the solver gave [N s]."""
        return sum(spot.normal_impulse for spot in self.spots)

    @property
    def tangent_impulse(self) -> float:
        """The friction impulse on B that the solver gave [N s]."""
        return sum(spot.tangent_impulse for spot in self.spots)

    @property
    def impulse(self) -> Vector2:
        """The impulse on B that the solver gave [N s]."""
        return self.normal_impulse * self.normal + self.tangent_impulse * self.tangent

    @cached_property
    def responses(self) -> tuple[Response, ...]:
        """How each point answers impulses."""
        return tuple(self._response(spot, spot) for spot in self.spots)

    def _response(self, one: Spot, two: Spot) -> Response:
        n, t, (a, b) = self.normal, self.tangent, (self.a, self.b)
        na, nb, ta, tb = one.arm_a.cross(n), one.arm_b.cross(n), one.arm_a.cross(t), one.arm_b.cross(t)
        apart = a.inverse_mass + b.inverse_mass
        kn = apart + a.inverse_inertia * na * two.arm_a.cross(n) + b.inverse_inertia * nb * two.arm_b.cross(n)
        kt = apart + a.inverse_inertia * ta * ta + b.inverse_inertia * tb * tb
        return Response(
            apart, kn, kt, a.inverse_inertia * na * ta + b.inverse_inertia * nb * tb, na, nb, ta, tb
        )

    @property
    def between(self) -> float:
        """How a normal impulse at the first point changes the normal velocity of the second [1/kg]."""
        return self._response(self.spots[0], self.spots[-1]).kn

    def approach(self, spot: Spot, *, after: bool = False) -> tuple[float, float]:
        """Return how fast B moves against A at a point, along normal and tangent [m/s]."""
        a, b = (self.a.after, self.b.after) if after else (self.a.before, self.b.before)
        relative = b.at(spot.arm_b) - a.at(spot.arm_a)
        return relative.dot(self.normal), relative.dot(self.tangent)

    @property
    def speed_scale(self) -> float:
        """The largest speed of a centre, or at the contact [m/s]: what speeds are compared with."""
        motions = [motion for body in (self.a, self.b) for motion in (body.before, body.after)]
        contact = [abs(part) for spot in self.spots for part in self.approach(spot)]
        return max(*(motion.linear.magnitude for motion in motions), *contact)

    @property
    def turning_scale(self) -> float:
        """The largest angular velocity that there is, or that these impulses could cause [rad/s]."""
        found = [abs(motion.angular) for body in (self.a, self.b) for motion in (body.before, body.after)]
        for spot in self.spots:
            impulse = math.hypot(spot.normal_impulse, spot.tangent_impulse)
            found += [
                arm.magnitude * impulse * body.inverse_inertia
                for arm, body in ((spot.arm_a, self.a), (spot.arm_b, self.b))
            ]
        return max(found)

    # ---- energy and frames ---------------------------------------------------------------------------------

    @property
    def lost(self) -> tuple[float, float]:
        """What restitution and friction took of the kinetic energy [J]; any observer finds it so.

        Of a sliding that turns round within the impact the mean of its speeds is not that at which friction
        acted: neither share is made negative by that.
        """
        by_normal = by_friction = 0.0
        for spot in self.spots:
            (vn, vt), (un, ut) = self.approach(spot), self.approach(spot, after=True)
            by_normal -= 0.5 * spot.normal_impulse * (vn + un)
            by_friction -= 0.5 * spot.tangent_impulse * (vt + ut)
        both = by_normal + by_friction
        rubbed = max(min(by_friction, both), 0.0) if both >= 0.0 else by_friction
        return both - rubbed, rubbed

    @property
    def driven(self) -> float:
        """The work on the free bodies by one that impulses do not move, but that moves [J]."""
        work = 0.0
        for spot in self.spots:
            impulse = spot.normal_impulse * self.normal + spot.tangent_impulse * self.tangent
            if not self.a.is_free:
                work += impulse.dot(self.a.before.at(spot.arm_a))
            if not self.b.is_free:
                work -= impulse.dot(self.b.before.at(spot.arm_b))
        return work

    def seen_by(self, velocity: Vector2) -> Collision:
        """Return what an observer who moves at a constant velocity sees of it."""
        return replace(self, a=_seen(self.a, velocity), b=_seen(self.b, velocity))

    @property
    def centre_velocity(self) -> Vector2:
        """The velocity of the centre of mass [m/s]: that of the body that nothing moves, where one is."""
        a, b = self.a, self.b
        if not (a.is_free and b.is_free):
            return a.before.linear if not a.is_free else b.before.linear
        heavy = 1.0 / a.inverse_mass, 1.0 / b.inverse_mass
        return (heavy[0] * a.before.linear + heavy[1] * b.before.linear) / sum(heavy)


def _seen(body: Body, velocity: Vector2) -> Body:
    before, after = (Motion(m.linear - velocity, m.angular) for m in (body.before, body.after))
    return body._replace(before=before, after=after)


def read_collision(record: Any) -> Collision:
    """Return the impact of a record of IMPACT."""
    x, y = float(record["x"]), float(record["y"])
    a, b = _body(record, "a"), _body(record, "b")
    places = [Vector2(x, y)]
    normals, tangents = [float(record["normal_impulse"])], [float(record["tangent_impulse"])]
    if record["points"] == 2:
        places.append(Vector2(float(record["x_2"]), float(record["y_2"])))
        normals.append(float(record["normal_impulse_2"]))
        tangents.append(float(record["tangent_impulse_2"]))
        normals[0] -= normals[1]
        tangents[0] -= tangents[1]
    spots = tuple(
        Spot(place, place - a.centre, place - b.centre, normal, tangent)
        for place, normal, tangent in zip(places, normals, tangents, strict=True)
    )
    return Collision(
        float(record["time"]), a, b, int(record["wall"]),
        Vector2(float(record["normal_x"]), float(record["normal_y"])), spots,
        float(record["restitution"]), float(record["friction"]), int(record["law"]), bool(record["alone"]),
    )  # fmt: skip


def _body(record: Any, side: str) -> Body:
    motions = (
        Motion(
            Vector2(float(record[f"{when}_{side}x"]), float(record[f"{when}_{side}y"])),
            float(record[f"{when}_w{side}"]),
        )
        for when in ("before", "after")
    )
    return Body(
        int(record[f"entity_{side}"]), float(record[f"inverse_mass_{side}"]),
        float(record[f"inverse_inertia_{side}"]),
        Vector2(float(record[f"center_{side}x"]), float(record[f"center_{side}y"])),
        float(record[f"angle_{side}"]), *motions,
    )  # fmt: skip


# ---- the law -----------------------------------------------------------------------------------------------


def resolve(collision: Collision) -> Result:
    """Return what the law of the record gives, from poses, motions before, masses, e and mu alone."""
    e = collision.restitution
    found = _blow(collision, e)
    if collision.law == LOWERED and _gain(collision, found) > _ROUNDING:
        low, high = 0.0, e
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            makes_energy = _gain(collision, _blow(collision, middle)) > 0.0
            low, high = (low, middle) if makes_energy else (middle, high)
        e = low
        found = _blow(collision, e)
    normal, tangent, sticks = found
    return Result(normal, tangent, *_motions_after(collision, normal, tangent), e, sticks)


type _Blow = tuple[tuple[float, ...], tuple[float, ...], bool]


def _blow(collision: Collision, restitution: float) -> _Blow:
    """Return the normal and friction impulse of each point [N s] at a restitution, and whether they stick."""
    if len(collision.spots) == 2:
        return _blow_of_two(collision, restitution)
    response, (vn, vt), mu = (
        collision.responses[0],
        collision.approach(collision.spots[0]),
        collision.friction,
    )
    if collision.law != ENERGETIC:
        normal, tangent, sticks = blow_of_one(response, vn, vt, restitution, mu)
        return (normal,), (tangent,), sticks
    numbers = (response.kn, response.kt, response.coupling, vn, vt, restitution, mu)
    normal, tangent = map(float, twin_of(energetic_blow)(*map(np.float64, numbers)))
    left = vt + response.coupling * normal + response.kt * tangent
    return (normal,), (tangent,), abs(left) <= _STUCK * (abs(vt) + abs(vn))


def blow_of_one(
    response: Response, vn: float, vt: float, restitution: float, friction: float
) -> tuple[float, float, bool]:
    """Return the normal and the friction impulse at one point by Newton's law, and whether it sticks.

    It leaves with e times its approach ``vn`` [m/s]. Where friction of at most mu times the normal impulse
    can stop the sliding ``vt`` [m/s], it does; where not, it is mu times that, against the sliding after it.
    """
    kn, kt, c, gained = response.kn, response.kt, response.coupling, -(1.0 + restitution) * vn
    if friction == 0.0:
        return gained / kn, 0.0, False
    determinant = kn * kt - c * c
    if determinant > _SINGULAR * kn * kt:
        normal, tangent = (kt * gained + c * vt) / determinant, -(kn * vt + c * gained) / determinant
        if normal >= 0.0 and abs(tangent) <= friction * normal:
            return normal, tangent, True
    for sign in (1.0, -1.0):
        resisted = kn + sign * friction * c
        if resisted > 1e-9 * kn:
            normal = gained / resisted
            if sign * (vt + (c + kt * sign * friction) * normal) <= 0.0:
                return normal, sign * friction * normal, False
    return gained / kn, 0.0, False


def _blow_of_two(collision: Collision, restitution: float) -> _Blow:
    """Return the impulses of two points at a restitution: those that break none of the laws.

    Each point that is pressed leaves with e times its approach, the other no slower than that; friction stops
    its sliding, or is mu times its normal impulse against that. All cases are tried.
    """
    matrix, speeds = _matrix_of_two(collision), [collision.approach(spot) for spot in collision.spots]
    before = np.array(speeds).T.ravel()  # both approaches, both slidings
    wanted = np.concatenate((-restitution * before[:2], (0.0, 0.0)))
    mu, worst, best = collision.friction, math.inf, np.zeros(4)
    states = ("sticks", 1.0, -1.0, None) if mu > 0.0 else (0.0, None)
    for case in sorted(product(states, repeat=2), key=lambda case: case.count(None)):
        impulses = _of_case(matrix, wanted - before, case, mu)
        wrong = max(_broken(matrix, before, wanted, impulses, case, mu))
        if wrong < worst:
            worst, best = wrong, impulses
        if wrong <= _ROUNDING:
            break
    left = (matrix @ best + before)[2:][best[:2] > 0.0]
    sticks = bool(len(left)) and mu > 0.0 and float(abs(left).max()) <= _STUCK * float(abs(before).max())
    n1, n2, t1, t2 = best.tolist()
    return (n1, n2), (t1, t2), sticks


type _State = str | float | None
"""What a point does: it ``"sticks"``, slides under friction of that sign, or is not pressed."""


def _matrix_of_two(collision: Collision) -> NDArray[np.float64]:
    """Return how both approaches and both slidings answer impulses at both points (4, 4) [1/kg]."""
    a, b, (one, two) = collision.a, collision.b, collision.spots
    ways = (
        (one, collision.normal),
        (two, collision.normal),
        (one, collision.tangent),
        (two, collision.tangent),
    )
    matrix = np.zeros((4, 4))
    for i, (spot, way) in enumerate(ways):
        for k, (other, push) in enumerate(ways):
            turned = a.inverse_inertia * spot.arm_a.cross(way) * other.arm_a.cross(push)
            turned += b.inverse_inertia * spot.arm_b.cross(way) * other.arm_b.cross(push)
            matrix[i, k] = (a.inverse_mass + b.inverse_mass) * way.dot(push) + turned
    return matrix


def _of_case(
    matrix: NDArray[np.float64], gained: NDArray[np.float64], case: Sequence[_State], mu: float
) -> NDArray[np.float64]:
    """Return normal and friction impulses of both points (4,) where each does what the case says."""
    rows, columns = [], []
    for k, state in enumerate(case):
        if state is None:
            continue
        column = np.zeros(4)
        column[k] = 1.0
        if isinstance(state, float):
            column[2 + k] = state * mu
        rows.append(k)
        columns.append(column)
    for k, state in enumerate(case):
        if state == "sticks":
            rows.append(2 + k)
            columns.append(np.eye(4)[2 + k])
    if not rows:
        return np.zeros(4)
    basis = np.array(columns).T
    found: NDArray[np.float64] = (
        basis @ np.linalg.lstsq((matrix @ basis)[rows], gained[rows], rcond=_SINGULAR)[0]
    )
    if list(case) == ["sticks", "sticks"] and found[0] + found[1] > 0.0:  # of what both hold each has a share
        found[2:] = found[2:].sum() * found[:2] / found[:2].sum()
    return found


def _broken(
    matrix: NDArray[np.float64], before: NDArray[np.float64], wanted: NDArray[np.float64],
    found: NDArray[np.float64], case: Sequence[_State], mu: float,
) -> Iterator[float]:  # fmt: skip
    """Yield by how much impulses break each law, as a share of the largest speed or impulse."""
    after = matrix @ found + before
    speed, scale = float(abs(before).max()) or 1.0, float(abs(found).sum()) or 1.0
    for k, state in enumerate(case):
        missing = float(wanted[k] - after[k]) / speed
        normal, tangent, sliding = float(found[k]), float(found[2 + k]), float(after[2 + k])
        yield -normal / scale
        yield missing if state is None else abs(missing)
        if state == "sticks":
            yield abs(sliding) / speed
            yield (abs(tangent) - mu * normal) / scale
        elif isinstance(state, float):
            yield state * sliding / speed if mu > 0.0 else 0.0


def _gain(collision: Collision, found: _Blow) -> float:
    """Return the energy that impulses of two points make, as a share of the sum of its parts."""
    a, b = _motions_after(collision, *found[:2])
    after = replace(collision, a=collision.a._replace(after=a), b=collision.b._replace(after=b))
    work = scale = 0.0
    for spot, normal, tangent in zip(collision.spots, *found[:2], strict=True):
        (vn, vt), (un, ut) = collision.approach(spot), after.approach(spot, after=True)
        work += normal * (vn + un) + tangent * (vt + ut)
        scale += abs(normal * vn) + abs(tangent * vt)
    return work / scale if scale > 0.0 else 0.0


def _motions_after(
    collision: Collision, normal: Sequence[float], tangent: Sequence[float]
) -> tuple[Motion, Motion]:
    """Return the motions of A and B after impulses at each point."""
    (linear_a, angular_a), (linear_b, angular_b) = collision.a.before, collision.b.before
    for spot, pressed, rubbed in zip(collision.spots, normal, tangent, strict=True):
        impulse = pressed * collision.normal + rubbed * collision.tangent
        linear_a -= collision.a.inverse_mass * impulse
        angular_a -= collision.a.inverse_inertia * spot.arm_a.cross(impulse)
        linear_b += collision.b.inverse_mass * impulse
        angular_b += collision.b.inverse_inertia * spot.arm_b.cross(impulse)
    return Motion(linear_a, angular_a), Motion(linear_b, angular_b)
