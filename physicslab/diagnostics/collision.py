"""One impact taken apart: two bodies, where they touched, and the result of the law of impact.

A record of the table holds the poses and the velocities of both bodies at the moment, masses, restitution,
friction, and the impulses of the solver. :func:`resolve` finds impulses and motions after it from the first
of these again, by the functions of :mod:`physicslab.kernels.constraint.impact_law` run as plain Python: it
takes no impulse and no velocity after the impact from the record.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.kernels.constraint import impact_law, pair
from physicslab.kernels.constraint.pair import ContactFrame, PairInverseMass, PairVelocity, PointState
from physicslab.kernels.interpreter import fallback_of
from physicslab.kernels.solver.impact_log import shares_of

ENERGETIC, LOWERED, NEWTON = impact_law.ENERGETIC, impact_law.LOWERED, impact_law.NEWTON
"""The laws of impacts: Stronge's, Newton's with a lowered restitution, Newton's."""
_STUCK = 1e-9
"""Share of the speeds before up to which the sliding that is left counts as zero."""


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


class Result(NamedTuple):
    """The result of the law: normal and tangential impulses of each point [N s], and the motions after."""

    normal: tuple[float, ...]
    tangent: tuple[float, ...]
    a: Motion
    b: Motion
    restitution: float
    sticks: bool


@dataclass(frozen=True)
class Collision:
    """An impact of two bodies, as the table of impacts has it.

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

    @property
    def inverse_mass(self) -> PairInverseMass[float]:
        """The inverse masses and moments of inertia of both."""
        a, b = self.a, self.b
        return PairInverseMass(
            *map(np.float64, (a.inverse_mass, a.inverse_inertia, b.inverse_mass, b.inverse_inertia))
        )

    def velocity(self, *, after: bool = False) -> PairVelocity[float]:
        """Return how both move."""
        motions = (self.a.after, self.b.after) if after else (self.a.before, self.b.before)
        return PairVelocity(*(np.float64(one) for v in motions for one in (*v.linear, v.angular)))

    def frame(self, spot: Spot) -> ContactFrame[float]:
        """Return the normal, and the arms of a point."""
        return ContactFrame(*map(np.float64, (*self.normal, *spot.arm_a, *spot.arm_b)))

    def _state(self, spot: Spot, *, after: bool = False) -> PointState[float]:
        state: PointState[float] = fallback_of(pair.point_state)(self.frame(spot), self.velocity(after=after))
        return state

    @cached_property
    def states(self) -> tuple[PointState[float], ...]:
        """The moment arms of each point, and how B moves against A there before."""
        return tuple(map(self._state, self.spots))

    @cached_property
    def responses(self) -> tuple[impact_law.PointResponse, ...]:
        """How each point answers impulses."""
        return tuple(
            fallback_of(impact_law.point_response)(state, self.inverse_mass) for state in self.states
        )

    @property
    def pair_response(self) -> impact_law.PairResponse:
        """How both points answer impulses, one and the same twice where there is one."""
        states, make = self.states, fallback_of(impact_law.pair_response)
        response: impact_law.PairResponse = make(states[0], states[-1], self.inverse_mass)
        return response

    def approach(self, spot: Spot, *, after: bool = False) -> tuple[float, float]:
        """Return how fast B moves against A at a point, along normal and tangent [m/s]."""
        state = self._state(spot, after=after)
        return float(state.v), float(state.sliding)

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
        """The kinetic energy lost by restitution and by friction [J], the same for every observer.

        If the sliding reverses within the impact, the mean of its speeds is not that at which friction
        acted: neither share becomes negative by that.
        """
        along = across = 0.0
        for spot in self.spots:
            (vn, vt), (un, ut) = self.approach(spot), self.approach(spot, after=True)
            along += 0.5 * spot.normal_impulse * (vn + un)
            across += 0.5 * spot.tangent_impulse * (vt + ut)
        bounced, friction_work = fallback_of(shares_of)(along, across)
        return float(0.0 - bounced), float(0.0 - friction_work)

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
        """Return the impact in the frame of an observer who moves at a constant velocity."""
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


def resolve(collision: Collision) -> Result:
    """Return the result of the record's law, from poses, motions before, masses, e and mu alone."""
    e, mu, impulses = np.float64(collision.restitution), np.float64(collision.friction), (0.0, 0.0, 0.0, 0.0)
    with np.errstate(all="ignore"):
        if collision.law == LOWERED:
            impulses, e = fallback_of(impact_law.solve_impact_of_two)(collision.pair_response, e, mu)
        elif len(collision.spots) == 2:
            impulses = fallback_of(impact_law.newton_impulses)(collision.pair_response, e, mu)
        else:
            law = impact_law.stronge_impulse if collision.law == ENERGETIC else impact_law.newton_impulse
            impulses = *fallback_of(law)(collision.responses[0], e, mu), 0.0, 0.0
    normal, tangent = tuple(map(float, impulses[::2])), tuple(map(float, impulses[1::2]))
    if len(collision.spots) == 1:
        normal, tangent = (sum(normal),), (sum(tangent),)
    a, b = _motions_after(collision, normal, tangent)
    after = replace(collision, a=collision.a._replace(after=a), b=collision.b._replace(after=b))
    left = [
        abs(after.approach(spot, after=True)[1])
        for spot, pressed in zip(collision.spots, normal, strict=True)
        if pressed > 0.0
    ]
    speed = max(abs(part) for spot in collision.spots for part in collision.approach(spot))
    sticks = bool(left) and collision.friction > 0.0 and max(left) <= _STUCK * speed
    return Result(normal, tangent, a, b, float(e), sticks)


def _motions_after(
    collision: Collision, normal: Sequence[float], tangent: Sequence[float]
) -> tuple[Motion, Motion]:
    """Return the motions of A and B after impulses at each point."""
    v, mass = collision.velocity(), collision.inverse_mass
    for spot, along, across in zip(collision.spots, normal, tangent, strict=True):
        v = fallback_of(pair.after_impulse_at)(v, mass, collision.frame(spot), along, across)
    ax, ay, wa, bx, by, wb = map(float, v)
    return Motion(Vector2(ax, ay), wa), Motion(Vector2(bx, by), wb)
