"""The estimate of a scene's error, beside the true error where that is known."""

import json
import math
import random
import statistics
from collections.abc import Callable
from dataclasses import replace
from decimal import Decimal, getcontext
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from physicslab.cli import main
from physicslab.components import (
    Charge,
    Drag,
    Mass,
    Medium,
    Pin,
    Rod,
    Shape,
    Slot,
    Spring,
    Thrust,
    Transform,
    Velocity,
)
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene, read_scene, write_scene
from physicslab.lab.accuracy.contacts.catalogue import CONTACTS
from physicslab.lab.accuracy.estimate import Estimate, estimate_error, find_order
from physicslab.lab.accuracy.scene_study import study_scene
from physicslab.lab.accuracy.variants import VARIANTS, Document, with_ids
from physicslab.lab.jobs import result_of
from physicslab.prefabs import pendulum
from physicslab.world import World

G, FLOOR = 9.81, 1e-12
"""An error below the second is as good as none."""

type Place = tuple[float, float]


def body(place: Place, size: Place, *, angle: float = 0.0, friction: float, **parts: Any) -> dict[str, Any]:
    return {
        "Transform": {"position": list(place), "angle": angle},
        "Shape": {"kind": "box", "width": size[0], "height": size[1]},
        "Material": {"restitution": 0.0, "friction": friction},
        **parts,
    }


def moving(place: Place, size: Place, *, speed: float = 0.0, **changes: Any) -> dict[str, Any]:
    return body(place, size, Velocity={"linear": [speed, 0.0]}, Mass={"mass": 1.0}, **changes)


def scene(*bodies: dict[str, Any], contacts: str = "auto", **changes: Any) -> Document:
    simulation = {"contacts": contacts}
    return {"format": "physicslab-scene/1", "entities": list(bodies), "simulation": simulation, **changes}


def tower(number: int, size: float) -> Document:
    boxes = [moving((0.0, (i + 0.5) * size), (size, size), friction=0.6) for i in range(number)]
    return scene(body((0.0, -0.5), (10.0, 1.0), friction=0.6), *boxes, contacts="soft")


def incline(slope: float, friction: float) -> Document:
    """Return a block of 1 m by 0.5 m that lies with its lower face on the line through the origin."""
    ux, uy = math.sin(slope), -math.cos(slope)
    return scene(
        body((0.5 * ux, 0.5 * uy), (60.0, 1.0), angle=slope, friction=friction),
        moving((-0.25 * ux, -0.25 * uy), (1.0, 0.5), angle=slope, friction=friction),
        contacts="soft",
    )


def slid_down(slope: float, friction: float, seconds: float) -> Place:
    way = 0.5 * G * (math.sin(slope) - friction * math.cos(slope)) * seconds**2
    return -way * math.cos(slope) - 0.25 * math.sin(slope), -way * math.sin(slope) + 0.25 * math.cos(slope)


def sliding(speed: float, friction: float) -> Document:
    return scene(
        body((0.0, -0.5), (60.0, 1.0), friction=friction),
        moving((0.0, 0.25), (0.5, 0.5), speed=speed, friction=friction),
        contacts="soft",
    )


SLOPE = math.pi / 6.0
CASES: dict[str, tuple[Document, Place]] = {
    "one box": (tower(1, 1.0), (0.0, 0.5)),
    "ten boxes": (tower(10, 1.0), (0.0, 9.5)),
    "twenty boxes": (tower(20, 1.0), (0.0, 19.5)),
    "ten cubes of 10 cm": (tower(10, 0.1), (0.0, 0.95)),
    "five cubes of 2 cm": (tower(5, 0.02), (0.0, 0.09)),
    "down an incline": (incline(SLOPE, 0.4), slid_down(SLOPE, 0.4, 5.0)),
    "slides to a stop": (sliding(3.0, 0.3), (9.0 / (2.0 * 0.3 * G), 0.25)),
}
"""Scenes of resting and sliding bodies, and where the last body truly is after 5 s."""


def estimate(load: Callable[[], World], seconds: float = 5.0) -> Estimate:
    found = result_of(estimate_error(load, seconds))
    assert found.failure == ""
    return found


def with_order(load: Callable[[], World], seconds: float = 5.0) -> Estimate:
    found = estimate(load, seconds)
    find_order(found, load, seconds)
    return found


@pytest.mark.parametrize("case", CASES)
def test_the_estimate_of_contacts_is_within_a_factor_of_ten_of_the_truth(case: str) -> None:
    document, place = CASES[case]
    world = read_scene(document)
    found = estimate(lambda: read_scene(document))
    world.run(seconds=5.0)
    true = math.dist(world.component(len(document["entities"]), Transform).position, place)
    assert found.error is not None
    assert 0.1 * true - FLOOR <= found.error.position <= 10.0 * true + FLOOR
    half_step = next(variant.spread for variant in found.variants if variant.name == "half step")
    assert half_step is not None and half_step.position <= found.error.position


KNOWN = [name for name, case in CONTACTS.items() if case.group != "symmetry" and name != "free_boxes"]
"""Contact cases in which the places of bodies are known."""


@pytest.mark.slow
@pytest.mark.parametrize("contacts", ["soft", "rigid"])
@pytest.mark.parametrize("name", KNOWN)
def test_the_estimate_of_every_contact_case_is_within_a_factor_of_ten(name: str, contacts: str) -> None:
    case = CONTACTS[name]
    last = len(case.times) - 1

    def load() -> World:
        return case.build(SimulationConfig(contacts=contacts))

    found, world = estimate(load, case.seconds), load()
    world.run(seconds=case.seconds)
    true = case.error(world, last)
    assert found.error is not None
    estimated = max(found.error.position, found.error.angle)
    print(f"| {name} | {contacts} | {true:.1e} | {estimated:.1e} | {estimated / true if true else 1:.2g} "
          f"| {found.worst} |")  # fmt: skip
    assert 0.1 * true - FLOOR <= estimated <= 10.0 * true + FLOOR


def test_the_rigid_variant_of_soft_contacts_is_as_far_off_as_the_truth() -> None:
    case = CONTACTS["corner_rod"]

    def load() -> World:
        return case.build(SimulationConfig(contacts="soft"))

    found, world = estimate(load, case.seconds), load()
    world.run(seconds=case.seconds)
    (rigid,) = [variant.spread for variant in found.variants if variant.name == "rigid"]
    assert rigid is not None and found.reference is not None
    assert max(rigid.position, rigid.angle) == pytest.approx(case.error(world, 0), rel=0.1)


def test_rigid_contacts_have_no_stiffer_variant_and_no_rigid_one() -> None:
    load = partial(CONTACTS["slide_stop"].build, SimulationConfig(contacts="rigid"))
    world, found = load(), estimate(load, 0.5)
    names = {variant.name for variant in found.variants}
    assert names >= {"eighth of the step", "mirrored", "permuted", "nudged"} and names.isdisjoint(
        {"stiffer", "rigid"}
    )
    assert found.reference is None
    document = with_ids(write_scene(world))
    world.synchronise()
    assert all(
        variant.make(document, world) is None for variant in VARIANTS if variant.name in ("stiffer", "rigid")
    )


def test_a_variant_that_takes_too_long_is_given_up() -> None:
    patient = [
        replace(variant, budget_s=-1.0) if variant.name == "rigid" else variant for variant in VARIANTS
    ]
    found = result_of(estimate_error(lambda: read_scene(CASES["one box"][0]), 0.1, variants=patient))
    (rigid,) = [variant for variant in found.variants if variant.name == "rigid"]
    assert rigid.spread is None and rigid.failure.startswith("given up after -1 s, at t = ")
    assert found.error is not None and found.reference is None


def test_methods_are_compared_with_rigid_contacts_where_these_can_be_had() -> None:
    """Leapfrog with a quarter of the step sinks as deep: it is no reference."""
    study = result_of(study_scene("ten", lambda: read_scene(CASES["ten boxes"][0]), 1.0))
    assert study.reference.startswith("rigid contacts, which is")
    auto = study.rows[0]
    world = read_scene(CASES["ten boxes"][0])
    world.simulation = replace(world.simulation, sleeping=False)
    world.run(seconds=1.0)
    true = max(abs(world.component(i + 2, Transform).position.y - i - 0.5) for i in range(10))
    assert not auto.at_most and auto.error == pytest.approx(true, rel=0.01)


def gas(seed: int) -> Document:
    """Return six discs in a box, without losses: a rounding at the start grows about tenfold each second."""
    draw = random.Random(seed).uniform
    discs = [
        {
            "Transform": {"position": [0.75 * (i % 3) - 0.8 + draw(-0.1, 0.1), 0.8 * (i // 3) - 0.45]},
            "Velocity": {"linear": [draw(-2.0, 2.0), draw(-2.0, 2.0)]},
            "Mass": {"mass": 1.0},
            "Shape": {"kind": "circle", "radius": 0.25},
            "Material": {"restitution": 1.0, "friction": 0.0},
        }
        for i in range(6)
    ]
    walls = {"bounds": [-2.0, -2.0, 2.0, 2.0], "bounds_restitution": 1.0, "bounds_friction": 0.0}
    return scene(*discs, physics={"gravity_mode": "none", **walls})


def gas_at(seed: int, seconds: int) -> list[tuple[Decimal, Decimal]]:
    """Return where the discs of the gas truly are: from impact to impact, with 60 digits."""
    getcontext().prec = 60
    discs = gas(seed)["entities"]
    places = [[Decimal(x) for x in disc["Transform"]["position"]] for disc in discs]
    speeds = [[Decimal(x) for x in disc["Velocity"]["linear"]] for disc in discs]
    left, room, width = Decimal(seconds), Decimal("1.75"), Decimal("0.25")
    while True:
        soonest, what = left, (-1, -1, -1)
        for i, (p, v) in enumerate(zip(places, speeds, strict=True)):
            for axis in (0, 1):
                if v[axis] and (t := ((room if v[axis] > 0 else -room) - p[axis]) / v[axis]) < soonest:
                    soonest, what = t, (i, -1, axis)
            for j in range(i):
                d, u = [a - b for a, b in zip(p, places[j], strict=True)], [
                    a - b for a, b in zip(v, speeds[j], strict=True)
                ]  # fmt: skip
                half, square = d[0] * u[0] + d[1] * u[1], u[0] * u[0] + u[1] * u[1]
                root = half * half - square * (d[0] * d[0] + d[1] * d[1] - width)
                if half < 0 and root > 0 and (t := (-half - root.sqrt()) / square) < soonest:
                    soonest, what = t, (i, j, -1)
        for p, v in zip(places, speeds, strict=True):
            p[0], p[1] = p[0] + soonest * v[0], p[1] + soonest * v[1]
        left -= soonest
        i, j, axis = what
        if i < 0:
            return [(x, y) for x, y in places]
        if j < 0:
            speeds[i][axis] = -speeds[i][axis]
            continue
        (ax, ay), (bx, by), v, w = places[i], places[j], speeds[i], speeds[j]
        nx, ny = 2 * (ax - bx), 2 * (ay - by)  # they touch at a distance of one half
        change = (v[0] - w[0]) * nx + (v[1] - w[1]) * ny
        v[0], v[1], w[0], w[1] = (
            v[0] - change * nx,
            v[1] - change * ny,
            w[0] + change * nx,
            w[1] + change * ny,
        )


def test_chaos_shows_where_impacts_are_located() -> None:
    """Which way roundings point is chance: either may be larger, but no estimate is too small by ten."""
    ratios = []
    for seed in range(8):
        seconds = (3, 6, 9)[seed % 3]
        world, truth = read_scene(gas(seed)), gas_at(seed, seconds)
        found = estimate(partial(read_scene, gas(seed)), float(seconds))
        world.run(seconds=float(seconds))
        assert world.plan.collisions == "exact"
        places = [world.component(i, Transform).position for i in range(1, 7)]
        true = max(
            float(((Decimal(p.x) - x) ** 2 + (Decimal(p.y) - y) ** 2).sqrt())
            for p, (x, y) in zip(places, truth, strict=True)
        )
        assert found.error is not None and found.worst in ("nudged", "other steps")
        ratios.append(found.error.position / true)
    # Of 40 such gases 6 or 7 are estimated over ten times too large, at most 66 times, and none too small.
    assert min(ratios) > 0.1 and statistics.median(ratios) < 10.0 and max(ratios) < 100.0


def test_the_order_of_smooth_motion_is_that_of_the_method() -> None:
    def oscillating() -> World:
        world = load_scene("two_planets")
        world.simulation = type(world.simulation)(integrator="leapfrog")
        return world

    found = with_order(oscillating, 7.0)
    assert found.order == pytest.approx(2.0, abs=0.1)


def test_the_sinking_of_a_stack_is_of_order_two() -> None:
    found = with_order(lambda: read_scene(CASES["ten boxes"][0]))
    assert found.order == pytest.approx(2.0, abs=0.1)


def test_the_mirror_image_of_a_scene_without_contacts_is_the_same_scene() -> None:
    def load() -> World:
        world = read_scene(scene(physics={"gravity": [0.7, -9.81]}))
        pendulum(world, (0.3, 1.0), stiffness=5000.0)
        world.spawn(Transform((2.0, 1.0), 0.4), *_loose())
        return world

    found = {variant.name: variant.spread for variant in estimate(load).variants}
    mirrored, nudged = found["mirrored"], found["nudged"]
    assert mirrored is not None and mirrored.position < 1e-12 and mirrored.angle < 1e-12
    assert nudged is not None and 0.0 < nudged.position < 1e-12


def test_joints_fields_and_polygons_are_mirrored_too() -> None:
    world = World(
        physics=PhysicsConfig(coulomb_constant=1.0, electric_field=Vector2(0.3, 0.2), magnetic_field=0.5)
    )
    wedge = Shape.polygon([(-0.5, -0.2), (0.7, -0.2), (-0.5, 0.6)])
    bar = world.spawn(Transform((1.0, 0.0), 0.2), Velocity(), Mass(2.0), wedge, Charge(0.2))
    world.spawn(Pin(b=bar, anchor_b=(-0.3, 0.1), lower=-1.0, upper=0.4))
    bob = world.spawn(Transform((2.0, 0.3)), Velocity((0.0, 1.0)), Mass(1.0), Charge(-0.3))
    world.spawn(Rod(a=bar, b=bob, anchor_a=(0.2, 0.0)))
    cart = world.spawn(Transform((-2.0, 0.0)), Velocity(), Mass(1.0), Thrust((1.0, 0.5), 0.2, at=(0.1, 0.0)))
    world.spawn(Slot(b=cart, axis=(1.0, 0.4), anchor_a=(-2.0, 0.0)))
    world.spawn(Transform((1.0, -0.5)), Shape.box(4.0, 0.6), Medium(1.0, viscosity=0.5, flow=(0.4, 0.0)))
    world.synchronise()
    mirror = next(variant for variant in VARIANTS if variant.name == "mirrored")
    image = mirror.make(write_scene(world), world)
    assert image is not None
    for each in (world, image):
        each.run(seconds=0.7)
    for body in (bar, bob, cart):
        (x, y), (u, v) = (each.component(body, Transform).position for each in (world, image))
        assert (-u, v) == pytest.approx((x, y), abs=1e-11)
    assert image.component(bar, Transform).angle == pytest.approx(-world.component(bar, Transform).angle)


def _loose() -> tuple[Any, ...]:
    spring = Spring(anchor_a=(0.2, 0.1), anchor_b=(1.0, 3.0), rest_length=1.0, stiffness=9.0)
    return Velocity((0.5, 0.0), 0.3), Mass(1.0, inertia=0.2), Drag(linear=0.1), spring


def test_twins_leave_the_scene_as_it_is() -> None:
    world = load_scene("drop")
    document = with_ids(write_scene(world))
    before = json.dumps(document)
    for variant in VARIANTS:
        variant.make(document, world)
    assert json.dumps(document) == before


def test_any_duration_and_what_is_shown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "ten.json"
    path.write_text(json.dumps(CASES["ten boxes"][0]))
    assert main(["accuracy", str(path), "--seconds", "0.5"]) == 0
    out = capsys.readouterr().out
    assert "after 0.5 s" in out and "mirrored" in out and "order of the error in the step: 2.0" in out
    assert main(["accuracy", str(path), "--seconds", "0.25", "--json", "-"]) == 0
    (found,) = json.loads(capsys.readouterr().out)["scenes"]
    assert found["seconds"] == 0.25
    assert set(found["estimate"]["error"]) == {"position", "angle", "velocity", "spin"}
    assert [variant["name"] for variant in found["estimate"]["variants"]][:2] == ["other steps", "half step"]


def test_methods_are_compared_with_the_finest_of_all_and_the_better_one_is_not_blamed() -> None:
    """Rigid contacts of ``auto`` are right to rounding; leapfrog in a quarter of the step is not."""
    document = sliding(0.6, 0.3)
    document["simulation"] = {}
    study = result_of(study_scene("slides", lambda: read_scene(document), 0.3))
    auto, *others = study.rows
    assert "auto: dop853" in study.reference and "known to" in study.reference
    assert auto.at_most and auto.error is not None and auto.error < 1e-12
    leapfrog = [row for row in others if row.integrator == "leapfrog"]
    assert leapfrog and all(not row.at_most and row.error is not None for row in leapfrog)
    assert min(row.error or 0.0 for row in leapfrog) > 1e-9
