"""Laws that rigid contacts keep in any small scene, and in their equations alone."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numba
import numpy as np
import pytest
from numpy.typing import NDArray

from physicslab import World
from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.components.shape import BOX
from physicslab.contacts.arguments import motion_of
from physicslab.contacts.report import list_contacts
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.kernels.python_fallback import fallback_of
from physicslab.kernels.rigid import complementarity, lemke, motion, step, time_stepping
from physicslab.kernels.rigid.equations import (
    FREE,
    OPEN,
    SLIDES_BACK,
    SLIDES_ON,
    STICKS,
    UNKNOWN,
    VECTORS,
    Equations,
)
from physicslab.kernels.rigid.features import GIVEN, MEASURES, MU, POINT_FIELDS, STATUS
from physicslab.kernels.rigid.smooth_segment import METHODS, SHORT_LAST
from physicslab.prefabs import box, circle
from physicslab.stepping.rigid import Rigid
from physicslab.systems.standard import standard_systems

G = 9.81


def laboratory() -> World:
    """Return an empty world with rigid contacts and gravity."""
    return World(*standard_systems(), physics=PhysicsConfig(), simulation=SimulationConfig(contacts="rigid"))


def rigid_of(world: World) -> Rigid:
    """Return the stepper of rigid contacts."""
    return next(stepper for stepper in world.steppers.usable if isinstance(stepper, Rigid))


# ---- distances, by separating axes -------------------------------------------------------------------------


def corners(table: Any, shapes: Any, row: int) -> NDArray[np.float64]:
    """Return the corners of a box (4, 2) [m]."""
    angle = float(table["angle"][row])
    x = 0.5 * shapes["width"][row] * np.array((math.cos(angle), math.sin(angle)))
    y = 0.5 * shapes["height"][row] * np.array((-math.sin(angle), math.cos(angle)))
    signs = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    return np.array([table["position"][row] + i * x + j * y for i, j in signs])


def to_polygon(of: NDArray[np.float64], point: NDArray[np.float64]) -> float:
    """Return how far a point is outside a convex polygon, negative inside [m]."""
    along = np.roll(of, -1, axis=0) - of
    length = np.hypot(*along.T)
    rel = point - of
    outside = (rel[:, 0] * along[:, 1] - rel[:, 1] * along[:, 0]) / length
    if outside.max() <= 0.0:
        return float(outside.max())
    share = np.clip((rel * along).sum(1) / length**2, 0.0, 1.0)
    return float(np.hypot(*(rel - share[:, None] * along).T).min())


def apart(world: World, a: int, b: int) -> float:
    """Return the distance of two rows [m], negative where they overlap; for boxes a lower bound of it."""
    table, shapes = world.table(Transform), world.table(Shape)
    boxes = [row for row in (a, b) if shapes["kind"][row] == BOX]
    if len(boxes) == 2:
        one, other = corners(table, shapes, a), corners(table, shapes, b)
        best = -math.inf
        for polygon in (one, other):
            for edge in (polygon[1] - polygon[0], polygon[2] - polygon[1]):
                axis = np.array((edge[1], -edge[0])) / math.hypot(*edge)
                p, q = one @ axis, other @ axis
                best = max(best, q.min() - p.max(), p.min() - q.max())
        return best
    if len(boxes) == 1:
        disc = b if boxes[0] == a else a
        away = to_polygon(corners(table, shapes, boxes[0]), table["position"][disc])
        return float(away - shapes["radius"][disc])
    away = math.hypot(*(table["position"][b] - table["position"][a]))
    return float(away - shapes["radius"][a] - shapes["radius"][b])


def sizes(world: World) -> NDArray[np.float64]:
    """Return the smaller extent of each row [m]."""
    shapes = world.table(Shape)
    boxes = shapes["kind"] == BOX
    return np.where(boxes, np.minimum(shapes["width"], shapes["height"]), 2.0 * shapes["radius"])


# ---- random scenes -----------------------------------------------------------------------------------------


def scattered(seed: int, largest: int = 6) -> World:
    """Return two or more boxes and discs, stacked, leaning or falling, over a floor, some between walls.

    Where there may be more than six, some fall into a groove.
    """
    random = np.random.default_rng(seed)
    e, mu = float(random.choice((0.0, 0.0, 0.3, 0.6))), float(random.choice((0.0, 0.2, 0.5, 0.9)))
    world = laboratory()
    surface: Any = {"restitution": e, "friction": mu}
    box(world, (0, -0.5), width=20, height=1, static=True, name="floor", **surface)
    if random.random() < 0.3:
        for x in (-2.0, 2.0):
            box(world, (x, 1), width=0.5, height=4, static=True, **surface)
    kind, top = random.choice(("stacked", "dropped", "mixed")), 0.0
    if largest > 6 and seed % 4 == 0:
        kind, top = "dropped", 1.5
        for side in (-1, 1):
            box(world, (2 * side, 1.2), width=4, height=0.3, angle=0.6 * side, static=True, **surface)
    for _ in range(random.integers(2, largest + 1)):
        mass = float(10 ** random.uniform(-0.5, 0.5))
        resting = kind == "stacked" or (kind == "mixed" and random.random() < 0.5)
        x = float(random.uniform(-0.2, 0.2))
        spin = 0.0 if resting else float(random.normal(0, 2))
        if random.random() < 0.35:
            r = float(random.uniform(0.15, 0.4))
            y = top + r + (0.0 if resting else float(random.uniform(0.01, 0.5)))
            circle(world, (x, y), radius=r, mass=mass, angular_velocity=spin, **surface)
            top = y + r
        else:
            width, height = (float(size) for size in random.uniform(0.2, 0.9, 2))
            angle = 0.0 if resting else float(random.uniform(-1.5, 1.5))
            up = 0.5 * (abs(width * math.sin(angle)) + abs(height * math.cos(angle)))
            y = top + up + (0.0 if resting else float(random.uniform(0.01, 0.5)))
            box(
                world, (x, y), width=width, height=height, angle=angle, mass=mass, angular_velocity=spin,
                **surface,
            )  # fmt: skip
            top = y + up
    return world


def check_contacts(world: World, weight: float) -> None:
    """Check that no contact pulls, that friction stays in its cone, and that what is pressed touches."""
    dt = world.contacts.impulse_dt
    for contact in list_contacts(world):
        for point in contact.points:
            pressed, rubbed = point.normal_impulse / dt, point.tangent_impulse / dt
            assert pressed >= -1e-9 * weight
            assert abs(rubbed) <= contact.friction * pressed + 1e-9 * weight
            assert abs(point.separation) * (pressed > 1e-9 * weight) <= 1e-9


def check_rest(world: World) -> None:
    """Check that forces on each body at rest add up to its weight."""
    rows = {int(entity): row for row, entity in enumerate(world.entity_index.entities)}
    force = np.zeros((len(rows), 3))
    place, velocity = world.table(Transform)["position"], world.table(Velocity)
    for contact in list_contacts(world):
        normal = np.array((contact.normal.x, contact.normal.y))
        for point in contact.points:
            push = point.normal_impulse * normal + point.tangent_impulse * np.array((-normal[1], normal[0]))
            push /= world.contacts.impulse_dt
            for entity, sign in ((contact.a, -1.0), (contact.b, 1.0)):
                row = rows[entity]
                x, y = point.position.x - place[row, 0], point.position.y - place[row, 1]
                force[row] += sign * np.array((*push, x * push[1] - y * push[0]))
    inverse = world.bodies.inverse_mass
    weight = np.divide(G, inverse, out=np.zeros(len(rows)), where=inverse > 0.0)
    moving = velocity.present & (inverse > 0.0)
    force[:, 1] -= weight
    assert (np.abs(force[moving]) <= 1e-9 * weight.sum()).all()


@pytest.mark.parametrize("part", range(6))
def test_random_small_scenes_keep_the_laws(part: int) -> None:
    assert check_scenes([scattered(seed) for seed in range(10 * part, 10 * part + 10)], every=1) > 0


def test_steps_by_impulses_add_no_energy() -> None:
    """Their straight motion makes bodies overlap; that these are moved apart takes from their speeds."""
    world = scattered(3, largest=12)
    check_scenes([world], every=6)
    assert rigid_of(world).by_impulses > 0


def test_what_moving_bodies_apart_adds_is_booked_and_told() -> None:
    world = laboratory()
    box(world, (0, -0.5), width=20, height=1, static=True)
    box(world, (0, 0.5 - 3e-4), width=1, height=1, mass=2)
    circle(world, (3, 0.25 - 1e-4), radius=0.25, mass=3)
    energy = measure_energy(world).total
    world.step()
    added = measure_energy(world).total - energy
    assert added == pytest.approx(G * (2 * 3e-4 + 3 * 1e-4), rel=1e-9)
    assert rigid_of(world).energy_added == pytest.approx(added, rel=1e-9)
    told = [warning for warning in find_warnings(world) if "moving bodies apart" in warning.what]
    assert [warning.value for warning in told] == [rigid_of(world).energy_added]
    world.run(steps=5)
    assert rigid_of(world).energy_added == told[0].value


@numba.njit(error_model="numpy")
def take_work(
    scene: Any, room: Any, before: Any, q: Any, v: Any, entities: Any, log: Any, account: Any
) -> Any:  # fmt: skip
    """Let bodies that touch pay for a move from ``before``; return what they cannot pay, and all of it."""
    of = step.named_course(scene, room, q, v, entities, log, account)
    _, count, _, _, _ = motion.touch(of.scene, of.equations, of.room, of.stages.acceleration, q, v, 0.0)
    return time_stepping.take_work(of.scene, of.equations, count, of.stages, before, q, v, True)


def test_bodies_that_hang_together_pay_for_their_move() -> None:
    """Two boxes that touch slide; a third one far off keeps its speed. What cannot be paid is returned."""
    world = laboratory()
    rows = [box(world, (x, 2.0), width=1, height=1, mass=m) for x, m in ((0, 1), (1, 3), (5, 1))]
    for row, speed in zip(rows, (0.3, 0.3, 7.0), strict=True):
        world.component(row, Velocity).linear = (speed, 0)
    world.step(1e-9)
    stepper = rigid_of(world)
    made, ode = stepper._motion, stepper._ode
    ode.gather(world)
    scene, pay = stepper._present_scene(world), fallback_of(take_work)
    for by, paid in ((1e-3, True), (1.0, False)):
        before = ode.q.copy()
        ode.q[3:6:2] += by
        energy = 0.5 * 4 * ode.v[2] ** 2
        left, change = pay(
            scene, made._room, before, ode.q, ode.v, world.entity_index.entities, world.contacts.log,
            world.account.sums,
        )  # fmt: skip
        work = 4 * G * by
        assert left == change == pytest.approx(0.0 if paid else work - energy, rel=1e-9)
        assert 0.5 * 4 * ode.v[2] ** 2 == pytest.approx(energy - work if paid else 0.0, rel=1e-9)
        assert ode.v[2] == ode.v[4]
        assert ode.v[6] == 7.0


def test_an_impact_takes_one_short_piece() -> None:
    """Two bounces of a disc are close together: the piece between them is exact on its curve."""
    world = laboratory()
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=0.8)
    circle(world, (0, 0.251), radius=0.25, mass=3, angular_velocity=4.0, restitution=0.8)
    world.run(steps=12)
    assert world.collisions > 40
    assert world.force_evaluations < 16 * world.collisions


def test_the_short_method_has_order_five() -> None:
    nodes, weights = METHODS[1].sum(1), METHODS[1, SHORT_LAST]
    assert nodes[: SHORT_LAST + 1] == pytest.approx([0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1, 1], abs=1e-14)
    for power in range(5):
        assert weights @ nodes**power == pytest.approx(1 / (power + 1), rel=1e-13)
    assert weights @ (METHODS[1] @ nodes**3) == pytest.approx(1 / 20, rel=1e-13)


@pytest.mark.slow
@pytest.mark.seeds
@pytest.mark.parametrize("part", range(10))
def test_a_thousand_scenes_keep_the_laws(part: int) -> None:
    """Two to twelve bodies: gaps, forces in their cones, energy; no step is left to soft contacts."""
    worlds = [scattered(seed, largest=12) for seed in range(100 * part, 100 * part + 100)]
    # Arms turn within a short step, and what rests there can work: 2e-9 in seed 318, 1e-9 in no other.
    check_scenes(worlds, every=6, short=1e-8)
    for world in worlds:
        assert rigid_of(world).left_to_soft == 0, rigid_of(world).why_soft


def test_sliding_that_no_forces_go_on_with_stops_at_once() -> None:
    """Painleve's rod slides with so much friction that pressing draws its end down: an impulse stops that."""
    world = laboratory()
    box(world, (0, -0.5), width=20, height=1, static=True, friction=3.0)
    mass, length, width, angle, speed = 2.0, 2.0, 0.02, 0.9, 0.7
    c, s = math.cos(angle), math.sin(angle)
    x, y = 0.5 * (width * s - length * c), -0.5 * (length * s + width * c)  # its end, from its centre
    rod = box(world, (0, -y), width=length, height=width, angle=angle, mass=mass, friction=3.0)
    world.component(rod, Velocity).linear = (-speed, 0)
    inertia = mass * (length**2 + width**2) / 12
    coupling = -x * y / inertia
    compliance = ((1 / mass + x * x / inertia, coupling), (coupling, 1 / mass + y * y / inertia))
    normal, tangent = np.linalg.solve(compliance, (0.0, speed))
    assert 0.0 < tangent < 3.0 * normal
    world.step(1e-9)
    velocity = world.component(rod, Velocity)
    assert rigid_of(world).by_impulses == 0
    assert velocity.linear.x == pytest.approx(tangent / mass - speed, abs=1e-7)
    assert velocity.linear.y == pytest.approx(normal / mass, abs=1e-7)
    assert velocity.angular == pytest.approx((x * normal - y * tangent) / inertia, abs=1e-7)
    account = measure_account(world).energy
    assert account["friction"] == pytest.approx(-0.5 * tangent * speed, abs=1e-7)
    assert abs(account["numerical"]) < 1e-12


@pytest.mark.parametrize("seed", [60, 272])
def test_what_is_wedged_needs_no_steps_by_impulses(seed: int) -> None:
    """Its forces are not determined, and those of least norm leave a cone; others are found."""
    world = scattered(seed, largest=12)
    check_scenes([world], every=6)
    assert rigid_of(world).by_impulses == 0


def check_scenes(worlds: list[World], every: int, short: float = 1e-9) -> int:
    """Advance by 1.5 s; check the energy at each step, contacts at some; return how many come to rest.

    Steps by impulses may add the share ``short`` of the largest energy, others 1e-9.
    """
    rigid_steps = steps = rested = 0
    for seed, world in enumerate(worlds):
        world.synchronise()
        extent, moving = sizes(world), world.bodies.inverse_mass > 0.0
        shaped = np.flatnonzero(world.table(Shape).present).tolist()
        pairs = [(a, b) for a in shaped for b in shaped if b < a and (moving[a] or moving[b])]
        mass = np.divide(1.0, world.bodies.inverse_mass, out=np.zeros(len(extent)), where=moving)
        weight, energy = G * float(mass.sum()), measure_energy(world).total
        highest, left, booked, by_impulses = energy, 0, 0.0, 0
        for number in range(90):
            world.step()
            steps += 1
            after = measure_energy(world).total
            assert math.isfinite(after), seed
            stepper = world.stepper
            assert stepper is not None
            if stepper.name != "rigid":
                assert rigid_of(world).why_soft, seed
                left += 1
                assert rigid_of(world).left_to_soft == left
            else:
                rigid_steps += 1
                # What rests cannot pay for being moved out of an overlap: that is booked.
                added, booked = rigid_of(world).energy_added - booked, rigid_of(world).energy_added
                assert -1e-15 * abs(highest) <= added <= 1e-6 * abs(highest), (seed, world.time)
                limit = short if rigid_of(world).by_impulses > by_impulses else 1e-9
                by_impulses = rigid_of(world).by_impulses
                assert after <= energy + added + limit * abs(highest), (seed, world.time)
                if number % every:
                    energy = after
                    continue
                check_contacts(world, weight)
                for a, b in pairs:
                    assert apart(world, a, b) >= -1e-9 * min(extent[a], extent[b]), (seed, a, b, world.time)
            energy = after
        velocity = world.table(Velocity)
        still = not velocity["linear"].any() and not velocity["angular"].any()
        if still and world.stepper is not None and world.stepper.name == "rigid":
            rested += 1
            check_rest(world)
    assert rigid_steps > 0.9 * steps
    return rested


# ---- the equations alone -----------------------------------------------------------------------------------


def problem(random: np.random.Generator, count: int, degrees: int, sliding: bool) -> Equations:
    """Return the equations of ``count`` points of bodies with as many degrees of freedom, random ones.

    With fewer degrees than equations forces are not determined.
    """
    jacobian = random.normal(0, 1, (2 * count, degrees))
    inverse = 10 ** random.uniform(-1, 1, degrees)
    m = 2 * count
    equations = Equations(
        np.zeros((count, POINT_FIELDS), np.int64), np.zeros((count, MEASURES)), np.zeros((m, m)),
        np.zeros((VECTORS, m)), np.zeros((m, m)), np.zeros((2, 2 * m), np.int64),
        np.zeros((2 * m, 4 * m + 2)),
    )  # fmt: skip
    equations.a[:] = (jacobian * inverse) @ jacobian.T
    equations.vectors[FREE] = jacobian @ random.normal(0, 3, degrees)
    equations.measures[:, MU] = random.choice((0.0, 0.1, 0.5, 1.0), count)
    equations.points[:, GIVEN] = STICKS
    if sliding:
        equations.measures[:, MU] *= 0.05
        equations.points[:, GIVEN] = random.choice((STICKS, SLIDES_ON, SLIDES_BACK), count)
    equations.points[equations.measures[:, MU] == 0.0, GIVEN] = SLIDES_ON
    return equations


def largest_violation(equations: Equations) -> float:
    """Return by how much the law that is violated most is, as a share of the largest force or rate."""
    z, free = equations.vectors[UNKNOWN], equations.vectors[FREE]
    w = free + equations.a @ z
    mu, given = equations.measures[:, MU], equations.points[:, GIVEN]
    z_scale = max(np.abs(z).max(), np.abs(free / np.diag(equations.a)).max())
    w_scale = np.abs(free).max()
    worst = 0.0
    for i in range(len(mu)):
        pressed, rubbed = z[2 * i] / z_scale, z[2 * i + 1] / z_scale
        opening, along = w[2 * i] / w_scale, w[2 * i + 1] / w_scale
        worst = max(worst, -pressed, -opening, min(pressed, opening))
        worst = max(worst, abs(rubbed) - mu[i] * pressed)
        if given[i] == STICKS:
            inside = mu[i] * pressed - abs(rubbed)
            worst = max(worst, min(inside, abs(along)))  # it sticks, or friction is at its limit
            worst = max(worst, min(along * np.sign(rubbed), abs(rubbed)))  # and against the sliding
        else:
            edge = -mu[i] if given[i] == SLIDES_ON else mu[i]
            worst = max(worst, abs(rubbed - edge * pressed))
    return float(worst)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("sliding", [False, True])
def test_random_problems_are_solved_to_rounding(sliding: bool) -> None:
    random, solve = np.random.default_rng(5), fallback_of(complementarity.solve_complementarity)
    for number in range(150):
        count = int(random.integers(1, 6))
        degrees = int(random.integers(max(1, count // 2), 2 * count + 4))
        equations = problem(random, count, degrees, sliding)
        if not solve(equations, count, 0.0, True):
            assert sliding, number  # what may stick has a solution always
            continue
        assert largest_violation(equations) <= 1e-9, number
        open_points = equations.points[:, STATUS] == OPEN
        assert not equations.vectors[UNKNOWN].reshape(-1, 2)[open_points].any()


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_pivots_find_forces_wherever_points_may_stick() -> None:
    """They solve a problem whose right sides are raised, each by less than 3e-9 of the largest."""
    random, solve = np.random.default_rng(6), fallback_of(lemke.find_by_pivots)
    for number in range(100):
        count = int(random.integers(1, 6))
        degrees = int(random.integers(max(1, count // 2), 2 * count + 4))
        equations = problem(random, count, degrees, False)
        assert solve(equations, count, 1e-10), number
        free = equations.vectors[FREE]
        z = equations.vectors[UNKNOWN]
        w = (free + equations.a @ z) / np.abs(free).max()
        assert z[::2].min() >= -1e-12 * np.abs(z).max(), number
        assert w[::2].min() >= -3e-9, number
        pressed = z[::2] > 1e-7 * np.abs(z).max()
        assert (np.abs(w[::2][pressed]) <= 3e-9).all(), number


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_rounding_of_speeds_does_not_hide_a_solution() -> None:
    """Both corners of a face slide alike, but for the last digit of a speed far above these ones."""
    solve = fallback_of(complementarity.solve_complementarity)
    equations = problem(np.random.default_rng(1), 3, 6, False)
    equations.a[:] = (
        (2.0259767807838176, -1.18439679795242, 0.0, 0.0, 0.0, 0.0),
        (-1.18439679795242, 1.9255584159586205, 0.0, 0.0, 0.0, 0.0),
        (0.0, 0.0, 6.037119833969557, 0.4100551809166397, 0.769748756611089, 0.41005518091663884),
        (0.0, 0.0, 0.41005518091663995, 5.583232237650311, -1.5632397414721169, 5.583232237650311),
        (0.0, 0.0, 0.769748756611089, -1.5632397414721169, 4.771371563474507, -1.563239741472116),
        (0.0, 0.0, 0.41005518091663884, 5.583232237650311, -1.563239741472116, 5.58323223765031),
    )
    equations.vectors[FREE] = (
        -3.458563524461056e-08,
        1.7236136157228188e-08,
        -3.151693211860938e-08,
        -2.1486735049786635e-08,
        -6.056512367106448e-10,
        -2.14867350394552e-08,
    )
    equations.measures[:, MU], equations.points[:, GIVEN] = 0.9, STICKS
    assert solve(equations, 3, 1e-4, True)
    assert largest_violation(equations) <= 1e-9


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("turns", [0.0, 0.5])
def test_forces_of_a_table_with_four_legs_carry_it(turns: float) -> None:
    """Forces are not determined; where it cannot turn those of least norm are alike."""
    solve = fallback_of(complementarity.solve_complementarity)
    legs = np.array((-1.5, -0.5, 0.5, 1.5))
    equations = problem(np.random.default_rng(1), 4, 8, False)
    rows = np.zeros((8, 3))
    rows[::2, 1], rows[::2, 2], rows[1::2, 0] = 1.0, legs, -1.0
    equations.a[:] = (rows * (1.0, 1.0, turns)) @ rows.T
    equations.vectors[FREE] = rows @ (0.0, -G, 0.3 * (turns > 0.0))
    equations.measures[:, MU] = 0.0
    equations.points[:, GIVEN] = SLIDES_ON
    assert solve(equations, 4, 0.0, True)
    forces = equations.vectors[UNKNOWN, ::2]
    assert largest_violation(equations) <= 1e-12
    assert forces.sum() == pytest.approx(G, rel=1e-12)
    if turns:
        assert turns * (forces @ legs) == pytest.approx(-0.3, abs=1e-12)
    else:
        assert forces == pytest.approx([G / 4] * 4, rel=1e-12)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_problem_without_a_solution_is_found_out() -> None:
    """Painleve's: a rod slides with so much friction that pressing draws its end down."""
    solve = fallback_of(complementarity.solve_complementarity)
    equations = problem(np.random.default_rng(1), 1, 3, False)
    equations.a[:] = ((1.0, 2.0), (2.0, 5.0))
    equations.vectors[FREE] = (-1.0, 0.0)
    equations.measures[0, MU], equations.points[0, GIVEN] = 0.8, SLIDES_ON
    assert not solve(equations, 1, 0.0, True)


def test_rest_that_is_remembered_is_rest_that_is_found_again() -> None:
    """A stack rests; whatever is edited then acts at the next step, with the same bits and accounts."""
    remembering, forgetting = laboratory(), laboratory()
    remembered = 0
    for world in (remembering, forgetting):
        box(world, (0, -0.5), width=20, height=1, static=True, friction=0.5)
        box(world, (0, 0.5), width=1, height=1, mass=2, friction=0.5, name="low")
        box(world, (0, 1.5), width=1, height=1, mass=1, friction=0.5, name="high")
        world.synchronise()
    for step_number in range(60):
        for world in (remembering, forgetting):
            if step_number == 10:
                world.component("high", Velocity).linear = (0.5, 0.0)
            if step_number == 30:
                world.component("low", Mass).mass = 3.0
            if step_number == 36:
                world.physics = replace(world.physics, gravity=Vector2(0.5, -4.0))
            if step_number == 44:
                world.component("low", Transform).position = (0.1, 0.5)
            if step_number == 52:
                world.component("low", Material).friction = 0.0
                world.physics = replace(world.physics, gravity=Vector2(3.0, -4.0))
            world.synchronise()
        rigid_of(forgetting)._resting = None
        remembered += rigid_of(remembering)._resting is not None
        remembering.step()
        forgetting.step()
        for one, other in zip(motion_of(remembering), motion_of(forgetting), strict=True):
            assert one.tobytes() == other.tobytes(), step_number
        assert remembering.account.sums.tolist() == forgetting.account.sums.tolist(), step_number
        assert list_contacts(remembering) == list_contacts(forgetting)
    assert 20 < remembered < 55
    assert remembering.component("high", Transform).position.x > 0.05
