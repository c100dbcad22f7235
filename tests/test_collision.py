"""The law of impact worked out again from records: the solver's figures, and what any observer finds."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from compiled import compiled
from struck import KINDS, impacts_of

from physicslab import World
from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.diagnostics.collision import (
    ENERGETIC,
    LOWERED,
    NEWTON,
    Body,
    Collision,
    Motion,
    Spot,
    read_collision,
    resolve,
)
from physicslab.diagnostics.impact_table import read_impacts
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.kernels.constraint import impact_law
from physicslab.kernels.constraint.pair import PairInverseMass, PointState
from physicslab.systems.standard import standard_systems

point_response: Any = compiled(impact_law.point_response)
pair_response: Any = compiled(impact_law.pair_response)
solve_impact: Any = compiled(impact_law.solve_impact)
solve_impact_of_two: Any = compiled(impact_law.solve_impact_of_two)

AGREES = 1e-9
RESTING = 1e-4
"""Speed of approach [m/s] up to which points of rigid contacts may count as resting."""
NOTHING = 1e-3
"""Share of the momentum at play below which an impulse is compared with that: the rest is rounding."""


def disagreement(collision: Collision) -> float:
    """Return by how much the law and the solver differ, as a share of the largest figure."""
    found = resolve(collision)
    at_play = collision.speed_scale / collision.responses[0].kn
    impulse = max(collision.normal_impulse, NOTHING * at_play)
    wrong = [
        abs(sum(found.normal) - collision.normal_impulse) / impulse,
        abs(sum(found.tangent) - collision.tangent_impulse) / impulse,
    ]
    for body, motion in ((collision.a, found.a), (collision.b, found.b)):
        wrong.append((body.after.linear - motion.linear).magnitude / collision.speed_scale)
        wrong.append(abs(body.after.angular - motion.angular) / max(collision.turning_scale, 1e-300))
    return max(wrong)


def alone(kind: str, count: int, seed: int) -> list[Collision]:
    """Return impacts of random worlds in which no third body had a part."""
    random, found = np.random.default_rng(seed), list[Collision]()
    while len(found) < count:
        every = map(read_collision, impacts_of(kind, random))
        found += [one for one in every if one.alone and (kind != "rigid" or not counts_as_rest(one))]
    return found[:count]


def counts_as_rest(collision: Collision) -> bool:
    """Whether a point is as slow as what rigid contacts do not let bounce, whatever e the materials have."""
    return any(collision.approach(spot)[0] > -RESTING for spot in collision.spots)


# ---- the solver --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_the_law_of_each_record_gives_the_impulses_and_motions_of_the_solver(kind: str) -> None:
    """10,000 in all: discs, boxes, corners, faces, bounds, fixed and driven bodies, each stepper."""
    collisions = alone(kind, 1700, seed=11)
    assert max(map(disagreement, collisions)) < AGREES
    if kind in ("step", "flat", "symplectic_euler"):
        assert sum(len(one.spots) == 2 for one in collisions) > 50
    assert any(not one.a.is_free for one in collisions) and any(one.a.is_free for one in collisions)


def test_stronges_law_and_lowered_restitution_are_worked_out_as_well() -> None:
    random, laws = np.random.default_rng(2), {NEWTON: 0, ENERGETIC: 0, LOWERED: 0}
    for k in range(1500):
        collision = strike(random, two=k % 3 == 0)
        laws[collision.law] += 1
        assert disagreement(collision) < AGREES
    assert min(laws.values()) > 10, laws


def strike(random: np.random.Generator, *, two: bool) -> Collision:
    """Return an impact of two random bodies, by the kernels of the solver."""
    while True:
        free = ((True, True), (False, True), (True, False))[random.integers(3)]
        a, b = (_body(random, number, is_free=is_free) for number, is_free in zip((1, 2), free, strict=True))
        normal = Vector2.from_angle(float(random.uniform(-math.pi, math.pi)))
        place = Vector2(*random.normal(0.0, 0.5, 2).tolist())
        apart = [0.0, float(random.uniform(0.1, 1.5))] if two else [0.0]
        places = [place + along * normal.perpendicular for along in apart]
        spots = tuple(Spot(p, p - a.centre, p - b.centre, 0.0, 0.0) for p in places)
        e, mu = random.choice((0.0, 0.5, 1.0, random.random())), random.choice((0.0, 0.3, 1.2))
        collision = Collision(0.0, a, b, -1, normal, spots, float(e), float(mu), NEWTON, alone=True)
        if all(collision.approach(spot)[0] < 0.0 for spot in spots):
            return _resolved(collision)


def _body(random: np.random.Generator, number: int, *, is_free: bool) -> Body:
    mass = 10.0 ** random.uniform(-1.0, 1.0)
    motion = Motion(Vector2(*random.normal(0.0, 2.0, 2).tolist()), float(random.normal(0.0, 2.0)))
    inertia = mass * 10.0 ** random.uniform(-1.5, 0.0)
    centre = Vector2(*random.normal(0.0, 0.5, 2).tolist())
    per_mass, per_inertia = (1.0 / mass, 1.0 / inertia) if is_free else (0.0, 0.0)
    return Body(number, per_mass, per_inertia, centre, 0.0, motion, motion)


def _resolved(collision: Collision) -> Collision:
    """Return it with the impulses and motions of the solver's kernels."""
    a, b, mass, e, mu = (
        collision.a, collision.b, collision.inverse_mass, collision.restitution, collision.friction
    )  # fmt: skip
    if len(collision.spots) == 2:
        found, used = solve_impact_of_two(pair_response(*collision.states, mass), e, mu)
        pairs = [(found.normal1, found.tangent1), (found.normal2, found.tangent2)]
        law = LOWERED if used < e else NEWTON
    else:
        normal, tangent, law = solve_impact(point_response(collision.states[0], mass), e, mu)
        pairs = [(normal, tangent)]
    moved = [a.before, b.before]
    spots = []
    for spot, (normal, tangent) in zip(collision.spots, pairs, strict=True):
        push = normal * collision.normal + tangent * collision.tangent
        for k, (body, arm, sign) in enumerate(((a, spot.arm_a, -1.0), (b, spot.arm_b, 1.0))):
            linear, angular = moved[k]
            moved[k] = Motion(
                linear + sign * body.inverse_mass * push,
                angular + sign * body.inverse_inertia * arm.cross(push),
            )
        spots.append(spot._replace(normal_impulse=normal, tangent_impulse=tangent))
    return Collision(
        0.0, a._replace(after=moved[0]), b._replace(after=moved[1]), -1, collision.normal, tuple(spots),
        collision.restitution, collision.friction, law, alone=True,
    )  # fmt: skip


def test_two_points_under_strong_friction_stop_where_sweeps_did_not_settle() -> None:
    """A tall box that lands on one edge first: 200 sweeps found a fifth of the friction that stops it."""
    one = PointState(-0.06157346, 0.0641034665, 0.48159289, -0.2023754443, -3.1, 1.4)
    two = PointState(-0.06687910, 0.0587978979, 0.48159289, -0.2023754443, -3.05, 1.4)
    found, _ = solve_impact_of_two(pair_response(one, two, PairInverseMass(0.0, 0.0, 1.0, 47.0)), 0.0, 0.6)
    pushes = ((one, found.normal1, found.tangent1), (two, found.normal2, found.tangent2))
    spin = 47.0 * sum(n * at.normal_b + t * at.tangent_b for at, n, t in pushes)
    normal, tangent = found.normal1 + found.normal2, found.tangent1 + found.tangent2
    for at in (one, two):
        v, sliding = at.v + normal + at.normal_b * spin, at.sliding + tangent + at.tangent_b * spin
        assert v > -1e-9
        held = abs(tangent) < 0.6 * normal * (1.0 - 1e-9)
        assert sliding * tangent <= 1e-9 and (not held or abs(sliding) < 1e-9)


def test_two_points_obey_newton_and_coulomb() -> None:
    """The laws themselves, on the motions after: what the solver and the microscope share is not compared."""
    random, cases = np.random.default_rng(6), set()
    for _ in range(600):
        collision = strike(random, two=True)
        if collision.law != NEWTON:
            continue
        speed, mu = collision.speed_scale, collision.friction
        for spot in collision.spots:
            (v, _), (left, sliding) = collision.approach(spot), collision.approach(spot, after=True)
            pressed, rubbed = spot.normal_impulse, spot.tangent_impulse
            tiny = 1e-10 * collision.normal_impulse
            assert pressed >= -tiny and left >= -collision.restitution * v - 1e-10 * speed
            assert pressed <= tiny or left <= -collision.restitution * v + 1e-10 * speed
            assert abs(rubbed) <= mu * pressed + tiny and rubbed * sliding <= 1e-10 * speed * abs(rubbed)
            sticks = abs(rubbed) < mu * pressed - tiny
            assert not sticks or abs(sliding) <= 1e-10 * speed
            cases.add((pressed > tiny, sticks))
    assert cases == {(True, True), (True, False), (False, False)}


def test_a_box_that_lands_tilted_a_little_obeys_them_as_well() -> None:
    """Arms along the surface that are nearly alike: both points cannot stick, so that one slides a little."""
    for tilt in (0.0, 1e-14, 1e-10, 1e-7, 1e-4, 1e-2):
        one = PointState(0.0, -0.5, 0.0, -0.5, -1.0, 0.4)
        two = PointState(0.0, 0.5, 0.0, -0.5 + tilt, -1.1, 0.4 - 0.1 * tilt)
        mass = PairInverseMass(0.0, 0.0, 1.0, 6.0)
        (n1, t1, n2, t2), used = solve_impact_of_two(pair_response(one, two, mass), 0.5, 0.7)
        spin = 6.0 * (n1 * one.normal_b + n2 * two.normal_b + t1 * one.tangent_b + t2 * two.tangent_b)
        for at, n, t in ((one, n1, t1), (two, n2, t2)):
            assert at.v + n1 + n2 + at.normal_b * spin == pytest.approx(-used * at.v, abs=1e-11)
            sliding = at.sliding + t1 + t2 + at.tangent_b * spin
            assert abs(t) <= 0.7 * n * (1.0 + 1e-11) and sliding * t <= 1e-11
            assert abs(t) > 0.7 * n * (1.0 - 1e-11) or abs(sliding) <= 1e-11


def test_friction_stops_the_sliding_that_there_is_at_the_moment_of_the_impact() -> None:
    """A disc that grazes a wall falls on until they touch: what gravity adds until then slides as well."""
    world = World(
        *standard_systems(), physics=PhysicsConfig(bounds=(0.0, -50.0, 9.0, 50.0), bounds_restitution=0.5),
        simulation=SimulationConfig(dt=0.02, substeps=1, collisions="step", contacts="soft"),
    )  # fmt: skip
    world.spawn(
        Transform((0.217, 0.0)), Velocity((-1.0, 0.0)), Mass(1.0, fixed_rotation=True), Shape.circle(0.2),
        Material(0.5, 50.0),
    )  # fmt: skip
    world.contacts.read = True
    world.step()
    (record,) = world.contacts.impacts
    assert record["before_by"] == pytest.approx(-9.81 * 0.017, rel=1e-9)
    assert record["after_by"] == pytest.approx(0.0, abs=1e-15)


# ---- what any observer finds -------------------------------------------------------------------------------


def test_energy_lost_is_the_same_for_any_observer_and_is_that_of_the_ledger() -> None:
    random = np.random.default_rng(4)
    for record in impacts_of("step", random)[:60]:
        collision = read_collision(record)
        lost = sum(collision.lost)
        assert lost == pytest.approx(float(read_impacts(record[None]).energy_lost[0]), rel=1e-9, abs=1e-14)
        for velocity in (Vector2(), collision.centre_velocity, Vector2(3.0, -7.0)):
            seen = collision.seen_by(velocity)
            before, after = (
                sum(sum(body.energies(motion)) for body, motion in pairs)
                for pairs in (
                    ((seen.a, seen.a.before), (seen.b, seen.b.before)),
                    ((seen.a, seen.a.after), (seen.b, seen.b.after)),
                )
            )
            assert sum(seen.lost) == pytest.approx(lost, rel=1e-9, abs=1e-12 * before)
            assert after == pytest.approx(before - lost + seen.driven, rel=1e-9, abs=1e-12 * before)


def test_in_the_centre_of_mass_momenta_are_opposite_before_and_after() -> None:
    random = np.random.default_rng(5)
    free = [c for c in alone("no forces", 200, seed=5) if c.a.is_free and c.b.is_free]
    assert len(free) > 20
    for collision in free[: int(random.integers(20, 40))]:
        seen = collision.seen_by(collision.centre_velocity)
        scale = seen.b.momentum(seen.b.before).magnitude
        for a, b in ((seen.a.before, seen.b.before), (seen.a.after, seen.b.after)):
            assert (seen.a.momentum(a) + seen.b.momentum(b)).magnitude < 1e-12 * scale


def test_an_impact_beside_the_centre_meets_less_mass() -> None:
    """A rod of mass m that is struck at its end acts like m / 4."""
    still = Motion(Vector2(), 0.0)
    rod = Body(1, 1.0 / 2.0, 12.0 / (2.0 * 1.0), Vector2(), 0.0, still, still)
    fist = Body(2, 0.0, 0.0, Vector2(0.5, 0.0), 0.0, Motion(Vector2(0.0, -1.0), 0.0), still)
    end = Vector2(0.5, 0.0)
    spot = Spot(end, end, Vector2(), 0.0, 0.0)
    collision = Collision(0.0, rod, fist, -1, Vector2(0.0, 1.0), (spot,), 1.0, 0.0, NEWTON, alone=True)
    (response,) = collision.responses
    assert 1.0 / (rod.inverse_mass + fist.inverse_mass) == pytest.approx(2.0, rel=1e-15)
    assert 1.0 / response.kn == pytest.approx(0.5, rel=1e-15)
    assert resolve(collision).normal == pytest.approx((2.0 * 0.5,), rel=1e-15)
