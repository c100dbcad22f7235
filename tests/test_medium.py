"""Media: buoyancy of clipped outlines, drag and wind, against closed forms and against polygons."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from compiled import compiled
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from physicslab import World, load_scene, save_scene
from physicslab.components import Mass, Medium, Rope, Shape, Transform, Velocity
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.checks import SceneError
from physicslab.integrators import INTEGRATORS
from physicslab.kernels import Numbers, kernel
from physicslab.kernels.forces import medium as media
from physicslab.prefabs import box
from physicslab.state.shapes import cores_of
from physicslab.stepping.soft import Soft
from physicslab.systems.medium import _outlines
from physicslab.systems.standard import standard_systems

G = 9.81
METHODS = tuple(name for name in INTEGRATORS if name != "exact")
WATER = 1000.0


def pool(
    density: float = WATER, *, size: tuple[float, float] = (10.0, 4.0), laws: dict[str, Any] | None = None,
    viscosity: float = 0.0, quadratic: float = 0.0, flow: tuple[float, float] = (0.0, 0.0), **simulation: Any,
) -> World:  # fmt: skip
    """Return a world with a box of fluid, whose surface is at y = 0."""
    world = World(
        *standard_systems(), physics=PhysicsConfig(**(laws or {})), simulation=SimulationConfig(**simulation)
    )
    fluid = Medium(density, viscosity, quadratic, flow)
    world.spawn(Transform((0.0, -0.5 * size[1])), Shape.box(*size), fluid, name="pool")
    return world


def float_in(world: World, shape: Shape, y: float, mass: float, **how: Any) -> int:
    at, own = Transform((0.0, y), how.pop("angle", 0.0)), Shape(**shape.values())  # a row takes one each
    return world.spawn(at, Velocity(**how), Mass(mass), own)


# ---- common areas ------------------------------------------------------------------------------------------


@kernel
def _immersed(numbers: Numbers, psi: float, gx: float, gy: float, size: float, whole: bool) -> None:
    """Immerse the first outline of ``numbers`` in the second; the sums are behind the room."""
    media.immerse(
        numbers, 0, media.OUTLINE, 2 * media.OUTLINE, 2 * media.OUTLINE + media.CUTS,
        psi, gx, gy, size, whole,
    )  # fmt: skip


immersed = compiled(_immersed)


def outline(shape: Shape, at: tuple[float, float], angle: float) -> NDArray[np.float64]:
    """Return an outline (18,), turned and moved."""
    world = World()
    world.spawn(Transform(), Shape(**shape.values()))
    world.synchronise()
    cores = cores_of(world.table(Shape), np.array([1]))
    turn = np.array(((math.cos(angle), -math.sin(angle)), (math.sin(angle), math.cos(angle))))
    corners = cores.corners[0] @ turn.T + at
    made: NDArray[np.float64] = np.concatenate(((cores.vertices[0], cores.radius[0]), corners.ravel()))
    return made


def sums_of(
    one: NDArray[np.float64], other: NDArray[np.float64], *, whole: bool = False
) -> NDArray[np.float64]:
    numbers = np.concatenate((one, other, np.zeros(media.CUTS + media.SUMS)))
    immersed(numbers, 0.0, 0.0, 0.0, 1.0, whole)
    sums: NDArray[np.float64] = numbers[-media.SUMS :]
    return sums


def polygon(one: NDArray[np.float64], fine: int = 80) -> NDArray[np.float64]:
    """Return an outline as a polygon (n, 2), with its arcs in ``fine`` parts."""
    n, r = int(one[0]), one[1]
    corners = one[2 : 2 + 2 * n].reshape(n, 2)
    if r == 0.0:
        return np.array(corners)
    angles = 2.0 * np.pi * np.arange(fine) / fine
    rim = (corners[:, None, :] + r * np.stack((np.cos(angles), np.sin(angles)), axis=1)).reshape(-1, 2)
    middle = rim.mean(axis=0)
    hull: NDArray[np.float64] = _hull(rim - middle) + middle
    return hull


def _hull(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the convex hull, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted(map(tuple, points.tolist()))
    halves = []
    for sequence in (ordered, ordered[::-1]):
        chain: list[tuple[float, float]] = []
        for p in sequence:
            while len(chain) > 1 and _cross(chain[-2], chain[-1], p) <= 0.0:
                chain.pop()
            chain.append(p)
        halves += chain[:-1]
    hull: NDArray[np.float64] = np.array(halves)
    return hull


def _cross(o: Any, a: Any, b: Any) -> float:
    return float((a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]))


def clipped(one: NDArray[np.float64], other: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
    """Return the area and first moments of what two convex polygons have in common (Sutherland, Hodgman)."""
    points = list(one)
    for p, q in zip(other, np.roll(other, -1, axis=0), strict=True):
        kept = []
        for a, b in zip(points, [*points[1:], *points[:1]], strict=True):
            ha, hb = _cross(p, q, a), _cross(p, q, b)
            if ha >= 0.0:
                kept.append(a)
            if ha * hb < 0.0:
                kept.append(a + (b - a) * ha / (ha - hb))
        points = kept
        if not points:
            return 0.0, np.zeros(2)
    x, y = np.array(points).T
    u, w = np.roll(x, -1), np.roll(y, -1)
    twice = x * w - u * y
    return 0.5 * float(twice.sum()), np.array((((x + u) * twice).sum(), ((y + w) * twice).sum())) / 6.0


SHAPES = (
    Shape.circle(0.7),
    Shape.box(1.6, 0.9),
    Shape.capsule(1.1, 0.3),
    Shape.box(4.0, 3.0),
    Shape.circle(2.0),
)


@settings(max_examples=20, deadline=None)
@given(
    a=st.sampled_from(SHAPES), b=st.sampled_from(SHAPES), x=st.floats(-3, 3), y=st.floats(-3, 3),
    angle=st.floats(-4, 4), other=st.floats(-4, 4),
)  # fmt: skip
def test_common_areas_are_those_of_fine_polygons(
    a: Shape, b: Shape, x: float, y: float, angle: float, other: float
) -> None:
    one, two = outline(a, (0.0, 0.0), angle), outline(b, (x, y), other)
    sums = sums_of(one, two)
    area, moment = clipped(polygon(one), polygon(two))
    assert sums[media.AREA] == pytest.approx(area, abs=2e-2)
    assert sums[[media.MX, media.MY]] == pytest.approx(moment, abs=4e-2)
    # The same, seen from the other: each of four points at which outlines touch is as wrong as the root of
    # a rounding, of their size squared.
    rounding = 4.0 * 2.0**2 * math.sqrt(np.finfo(float).eps)
    assert sums_of(two, one)[media.AREA] == pytest.approx(sums[media.AREA], abs=rounding)


@pytest.mark.parametrize(
    ("size", "at", "area"),
    [((5.0, 2.7), (1.7, 0.9), 1.44), ((1.6, 0.9), (0.0, 0.0), 1.44), ((1.6, 4.0), (0.0, 1.0), 1.44),
     ((1.0, 0.9), (1.3, 0.0), 0.0), ((0.8, 0.45), (0.4, 0.225), 0.36)],
)  # fmt: skip
def test_sides_that_coincide_count_once(
    size: tuple[float, float], at: tuple[float, float], area: float
) -> None:
    one, two = outline(Shape.box(1.6, 0.9), (0.0, 0.0), 0.0), outline(Shape.box(*size), at, 0.0)
    assert sums_of(one, two)[media.AREA] == pytest.approx(area, abs=1e-12)
    assert sums_of(two, one)[media.AREA] == pytest.approx(area, abs=1e-12)


# ---- floating ----------------------------------------------------------------------------------------------


def segment(r: float, depth: float) -> float:
    """Return the area of a disc below a line that leaves ``depth`` of it there."""
    h = r - depth
    return r * r * math.acos(h / r) - h * math.sqrt(r * r - h * h)


@pytest.mark.parametrize(("shape", "draft", "area"), [
    (Shape.box(1.0, 0.5), 0.3, 0.3), (Shape.circle(0.5), 0.2, segment(0.5, 0.2)),
    (Shape.capsule(1.0, 0.25), 0.1, segment(0.25, 0.1) + 2.0 * math.sqrt(0.25**2 - 0.15**2) - 0.0),
])  # fmt: skip
def test_what_floats_does_so_at_the_depth_of_archimedes(shape: Shape, draft: float, area: float) -> None:
    if shape.kind == "capsule":
        area = segment(0.25, 0.1) + 0.1  # lying: the straight part has the draft itself
    half = {"box": 0.25, "circle": 0.5, "capsule": 0.25}[shape.kind]
    world = pool(viscosity=300.0)
    body = float_in(world, shape, half - draft + 0.01, WATER * area)
    world.run(seconds=25.0)
    assert world.component(body, Transform).position.y == pytest.approx(half - draft, abs=1e-7)
    assert world.component(body, Velocity).linear.magnitude < 1e-6


def test_a_box_bobs_with_its_period() -> None:
    world = pool()
    body = float_in(
        world, Shape.box(1.0, 0.5), 0.05, WATER * 0.25
    )  # half of it is below the surface at y = 0
    world.run(seconds=2.0)
    rate = math.sqrt(G / 0.25)  # rho g w y = m y''
    assert world.component(body, Transform).position.y == pytest.approx(
        0.05 * math.cos(2.0 * rate), abs=1e-12
    )
    account = measure_account(world)
    assert abs(account.energy["numerical"]) < 1e-10 * WATER
    assert set(measure_energy(world).potential) == {"gravity", "medium"}


@pytest.mark.parametrize("integrator", METHODS)
@pytest.mark.parametrize("shape", [Shape.box(0.6, 0.4), Shape.circle(0.3), Shape.capsule(0.5, 0.2)])
def test_accounts_hold_for_what_splashes_about(integrator: str, shape: Shape) -> None:
    world = pool(1.3, size=(1.5, 1.0), viscosity=0.05, quadratic=0.3, flow=(0.5, 0.2), integrator=integrator,
                 dt=1.0 / 240.0, substeps=1)  # fmt: skip
    body = float_in(world, shape, 0.3, 0.15, linear=(1.4, -1.0), angular=2.0, angle=0.4)
    before = measure_energy(world).total
    world.run(seconds=1.0)
    account = measure_account(world)
    order = INTEGRATORS[integrator].order
    error = {1: 2e-2, 2: 5e-3, 4: 1e-3, 6: 1e-2, 8: 1e-7}[int(order)]
    assert account.energy["damping"] < -0.01 and abs(account.energy["fields"]) > 1e-3
    assert measure_energy(world).total - before == pytest.approx(sum(account.energy.values()), abs=1e-15)
    assert abs(account.energy["numerical"]) < error
    assert account.momentum["numerical"].magnitude < 1e-13
    assert world.component(body, Velocity).angular != 2.0


@pytest.mark.parametrize("contacts", ["auto", "soft"])
def test_the_torque_of_water_on_a_body_that_cannot_turn_is_no_angular_momentum(contacts: str) -> None:
    world = pool(1.3, viscosity=0.5, flow=(0.5, 0.0), contacts=contacts)
    body = float_in(world, Shape.box(0.6, 0.2), 0.05, 0.15, linear=(1.4, -1.0), angle=0.4)
    world.component(body, Mass).fixed_rotation = True
    if contacts == "soft":  # beside something to touch
        box(world, (0.0, -9.0), width=1.0, height=1.0, static=True)
    world.run(steps=30)
    account = measure_account(world).angular_momentum
    assert abs(account["fields"]) > 1e-3
    assert abs(account["numerical"]) < 1e-13


def test_a_wind_carries_along_and_viscosity_stops_a_spin() -> None:
    world = pool(0.0, size=(40.0, 8.0), viscosity=0.2, flow=(3.0, 0.0), laws={"gravity_mode": "none"})
    r, m, t = 0.25, 0.5, 2.0
    ball = float_in(world, Shape.circle(r), -4.0, m, angular=5.0)
    world.run(seconds=t)
    velocity, rate = world.component(ball, Velocity), 0.2 * 2.0 * math.pi * r
    assert velocity.linear.x == pytest.approx(-3.0 * math.expm1(-rate / m * t), rel=1e-12)
    assert velocity.angular == pytest.approx(5.0 * math.exp(-rate * r * r / (0.5 * m * r * r) * t), rel=1e-12)
    account = measure_account(world).energy
    given = 0.5 * m * velocity.linear.x**2
    assert account["fields"] == pytest.approx(m * velocity.linear.x * 3.0, rel=1e-11)
    assert account["fields"] + account["damping"] == pytest.approx(
        given + 0.25 * m * r * r * (velocity.angular**2 - 25.0), rel=1e-10
    )


@pytest.mark.parametrize("contacts", ["soft", "rigid"])
def test_nothing_touches_a_medium_and_wood_rises_from_the_floor_of_a_pool(contacts: str) -> None:
    world = pool(viscosity=200.0, contacts=contacts)
    box(world, (0.0, -4.5), width=12.0, height=1.0, static=True)  # the floor is where the pool ends
    wood = box(world, (-2.0, -3.75), width=1.0, height=0.5, mass=300.0)
    stone = box(world, (2.0, 0.5), width=1.0, height=0.5, mass=900.0)
    world.run(seconds=8.0)
    assert world.component(wood, Transform).position.y == pytest.approx(-0.05, abs=5e-3)
    assert world.component(stone, Transform).position.y == pytest.approx(-3.75, abs=2e-3)
    account = measure_account(world)
    assert account.energy["damping"] < 0.0
    assert abs(account.energy["numerical"]) < 2e-3 * abs(account.energy["damping"])


# ---- files and refusals ------------------------------------------------------------------------------------


def test_files_keep_media_and_refuse_those_that_move(tmp_path: Path) -> None:
    world = pool(1.2, flow=(1.0, 0.0))
    save_scene(world, tmp_path / "pool.json")
    again = load_scene(tmp_path / "pool.json")
    one, other = (w.component(w.entity("pool"), Medium) for w in (world, again))
    assert one.values() == other.values()
    text = (tmp_path / "pool.json").read_text().replace('"Medium":', '"Velocity": {}, "Medium":')
    (tmp_path / "moving.json").write_text(text)
    with pytest.raises(
        SceneError, match=r"Medium = .* must be with a Shape that is no chain, and without a Velocity"
    ):
        load_scene(tmp_path / "moving.json")
    world.add(world.entity("pool"), Velocity())
    with pytest.raises(InvalidValue, match=r"pool: Medium.*a medium stays"):
        world.synchronise()
    chained = World(*standard_systems())
    chained.spawn(Transform(), Shape.chain(((0.0, 0.0), (1.0, 0.0))), Medium(WATER))
    with pytest.raises(InvalidValue, match="a Shape that is no chain"):
        chained.synchronise()
    with pytest.raises(InvalidValue, match=r"Medium\.density = -1"):
        Medium(density=-1.0)


def test_a_scene_without_what_moves_in_it_leaves_it_out() -> None:
    world = pool()
    world.synchronise()
    reasons = {left.name: left.reason for left in world.schedule.left_out}
    assert reasons["MediumSystem"] == "nothing that has a Shape moves in the medium"
    assert reasons["ContactSystem"] == "no Shape in the scene"


def test_sizes_are_followed_where_there_is_a_medium_and_a_polygon_can_hold_one() -> None:
    world = World(*standard_systems())
    triangle = Shape("polygon", vertices=((-3.0, -1.0), (3.0, -1.0), (0.0, 2.0)))
    world.spawn(Transform(), triangle, Medium(WATER))
    ball = float_in(world, Shape.circle(0.2), -0.5, 1.0)
    world.step()
    world.component(ball, Shape).radius = 0.4
    world.step()
    assert world.bodies.shapes.reach[world.entity_index.row_of[ball]] == 0.4
    assert world.bodies.shapes.vertices.tolist() == [0, 0, 1]
    assert not len(world.contacts.impacts) and world.component(ball, Velocity).linear.y > 0.0


@pytest.mark.parametrize(
    "shape", [Shape.circle(0.3), Shape.box(0.6, 0.2), Shape("capsule", radius=0.1, length=0.4)], ids=str
)
def test_what_is_wholly_within_has_the_sums_of_what_is_cut(shape: Shape) -> None:
    one, sea = outline(shape, (0.4, -0.2), 0.7), outline(Shape.box(4.0, 3.0), (0.0, 0.0), 0.2)
    assert sums_of(one, sea, whole=True) == pytest.approx(sums_of(one, sea), rel=1e-13, abs=1e-15)


def test_a_crowd_floats_by_a_method_of_fixed_steps_as_exact_as_its_contacts() -> None:
    world = pool(viscosity=1.0, size=(60.0, 20.0))
    box(world, (0.0, -20.5), width=60.0, height=1.0, static=True)
    for n in range(120):
        made = box(world, (1.6 * (n % 30) - 24.0, 1.2 * (n // 30) - 3.0), width=1.0, height=0.6, mass=300.0)
        world.component(made, Velocity).linear = Vector2(0.1 * (n % 3), 0.0)
    world.step()
    before = measure_energy(world).total
    world.run(seconds=2.0)
    assert world.plan.split_forces is INTEGRATORS["rk4"] and "many bodies" in world.plan.reason
    numerical = measure_account(world).energy["numerical"]
    assert abs(numerical) < 1e-4 * abs(measure_energy(world).total - before)


def test_a_medium_that_reaches_no_body_of_a_flow_is_packed_all_the_same() -> None:
    shape = {"kind": "box", "width": 1.0, "height": 1.0}
    water = {"Transform": {}, "Shape": shape, "Medium": {"density": 1.0}}
    world = load_scene(
        {"format": "physicslab-scene/1", "entities": [water, {"Transform": {"position": [3, 0]}}]}
    )
    none = np.zeros(0, np.int64)
    assert _outlines(world, none).shape == (0, media.OUTLINE)


def heap(world: World) -> list[int]:
    """Spawn a floor and boxes that fall on each other."""
    box(world, (40.0, -0.5), width=10.0, height=1.0, static=True)
    return [box(world, (40.0 + 0.2 * n, 0.6 + 1.1 * n), width=1.0, height=1.0) for n in range(4)]


@pytest.mark.parametrize("viscosity", [0.0, 50.0])
def test_a_body_comes_into_a_medium_beside_contacts_as_without_any(viscosity: float) -> None:
    alone, beside = pool(viscosity=viscosity), pool(viscosity=viscosity, contacts="soft")
    expected = float_in(alone, Shape.circle(0.2), 1.5, 60.0)
    ball = float_in(beside, Shape.circle(0.2), 1.5, 60.0)
    beside.spawn(Rope(ball, heap(beside)[0], length=100.0))  # slack: else it were an island, and smooth
    beside.run(steps=10)
    assert not beside.bodies.sub_integrated.any()
    beside.run(steps=80)
    alone.run(steps=90)
    assert isinstance(beside.stepper, Soft) and beside.contacts.active > 0
    assert beside.bodies.sub_integrated.tolist().count(True) == 1
    found, right = beside.component(ball, Transform).position, alone.component(expected, Transform).position
    assert right.y > -5.0  # it was lifted
    assert found.y == pytest.approx(right.y, abs=1e-7)
    assert abs(measure_account(beside).energy["numerical"]) < 1e-5


def test_a_medium_far_away_changes_no_bit_beside_contacts() -> None:
    def places(medium: bool) -> bytes:
        world = World(*standard_systems(), simulation=SimulationConfig(contacts="soft"))
        bodies = heap(world)
        if medium:
            world.spawn(Transform((5e3, 0.0)), Shape.box(10.0, 4.0), Medium(WATER, 1.0))
        world.run(steps=60)
        rows = [world.entity_index.row_of[body] for body in bodies]
        return world.table(Transform)["position"][rows].tobytes()

    assert places(True) == places(False)
