"""The second page of the accuracy lab: closed forms, convergence, other engines, and what is written."""

import json
import math
from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from pathlib import Path

import mpmath
import numpy as np
import pytest

from physicslab.cli import main
from physicslab.components import Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.contacts import study as studying
from physicslab.lab.accuracy.contacts.catalogue import CONTACTS, CONVERGENCE
from physicslab.lab.accuracy.contacts.study import (
    ENGINES,
    HALVINGS,
    OWN,
    ROUNDING,
    ContactCurve,
    ContactRow,
    ContactStudy,
    fitted_order,
    measure_row,
    study_case,
)  # fmt: skip
from physicslab.lab.accuracy.problem import digits
from physicslab.lab.accuracy.tables import contact_summary, contact_text, order_text
from physicslab.lab.case import Verdict
from physicslab.lab.closed_forms import corner_impact, rolled, slid, stopped_by_friction
from physicslab.lab.jobs import result_of
from physicslab.lab.peers.mirrors import Box2D3Mirror
from physicslab.lab.peers.peer import CannotBuild
from physicslab.lab.worlds import empty_world, place
from physicslab.prefabs import box

SLOW = {"rest_10"}
"""Cases that take seconds with seven steps."""
SHORT = {
    "permuted": "five boxes that chatter: some steps are made by impulses, and two orders of bodies differ"
}
"""Cases in which rigid contacts fall short of what is wanted so far: they stand in the table."""
ENGINE = {engine.name: engine for engine in ENGINES}


@pytest.fixture(scope="module", autouse=True)
def made_once() -> Iterator[None]:
    """Make short runs once: their times, for which they are repeated, are not what is tested."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(studying, "_REPEATED_BELOW_S", 0.0)
        yield


def rigid_rows(name: str, halvings: tuple[int, ...]) -> list[ContactRow]:
    return [measure_row(CONTACTS[name], ENGINE["rigid"], 2.0**-k / 60.0) for k in halvings]


def cases(*names: str) -> list[object]:
    return [pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else []) for name in names]


# ---- references --------------------------------------------------------------------------------------------


def seconds_to_lean(rate2: mpmath.mpf, start: mpmath.mpf, end: mpmath.mpf) -> mpmath.mpf:
    """Return the time from rest at one angle to another of lean'' = rate2 sin(lean), by its energy."""

    def slowness(root: mpmath.mpf) -> mpmath.mpf:
        """With lean = start + root^2 there is no pole at the start."""
        if not root:
            return mpmath.sqrt(2 / (rate2 * mpmath.sin(start)))
        lean = start + root**2
        fallen = 2 * mpmath.sin((lean + start) / 2) * mpmath.sin(root**2 / 2)  # cos(start) - cos(lean)
        return 2 * root / mpmath.sqrt(2 * rate2 * fallen)

    return mpmath.quad(slowness, [0, mpmath.sqrt(end - start)])


@pytest.mark.parametrize("key", ["cube", "tall", "lean", "box", "hexagon"])
def test_equations_of_motion_pass_through_the_angles_on_record(key: str) -> None:
    with mpmath.workdps(50):
        g = mpmath.mpf("9.81")
        over = {name: mpmath.atan(tan * mpmath.mpf("1.001")) - mpmath.atan(tan) for name, tan in (
            ("box", mpmath.mpf("0.5")), ("hexagon", 1 / mpmath.sqrt(3)),
        )}  # fmt: skip
        family, rate2, start, t = {
            "box": ("topple_threshold", g * 3 / (4 * mpmath.sqrt(mpmath.mpf("0.3125"))), over["box"], "1"),
            "hexagon": ("topple_threshold", g * 24 / 17, over["hexagon"], "1"),
            "cube": ("box_pivot", g * 3 / (2 * mpmath.sqrt(2)), "0.3", "0.4"),
            "tall": ("box_pivot", g * 3 / (2 * mpmath.sqrt(mpmath.mpf("2.5"))), "0.05", "0.4"),
            "lean": ("rolling_over_a_hill", g * 4 / 21, "0.1", "1.5"),
        }[key]
        found = seconds_to_lean(rate2, mpmath.mpf(start), mpmath.mpf(digits(family, key)))
        assert abs(found - mpmath.mpf(t)) < mpmath.mpf(10) ** -22


def test_a_block_on_a_spring_goes_as_its_equation_of_motion_has_it() -> None:
    rate, held, x, v, h = 4.0, 0.1, 1.0, 0.0, 1e-4
    for i in range(1, 20_001):
        for _ in (0, 1):  # half a step of each kind, twice
            pull = -(rate**2) * x
            rub = math.copysign(rate**2 * held, v if v else -pull)
            v_next = v + 0.5 * h * (pull - rub)
            stuck = v * v_next < 0.0 and abs(pull) <= rate**2 * held
            v = 0.0 if stuck or (v == 0.0 and abs(pull) <= rate**2 * held) else v_next
            x += 0.5 * h * v
        if i % 1000 == 0:
            assert x == pytest.approx(stopped_by_friction(1.0, rate, held, i * h), abs=1e-3)
    assert abs(x) <= held


@pytest.mark.parametrize("pull", [0.0, 1.5, 9.0])
def test_a_wheel_slips_and_rolls_as_its_equation_of_motion_has_it(pull: float) -> None:
    """Pulled by 9 m/s^2 it slips for ever: friction of 2 m/s^2 cannot turn it as fast."""
    friction, share, h = 2.0, 0.5, 1e-4
    way, speed, rim, turning = 0.0, 3.0, 0.0, 0.0
    for i in range(1, 10_001):
        slips = speed - turning > 1e-9
        rate = pull - friction if slips else pull / (1.0 + share)
        speed, turning = speed + h * rate, turning + h * (friction / share if slips else rate)
        turning = min(turning, speed)
        way, rim = way + h * speed, rim + h * turning
        if i % 2_500 == 0:
            assert rolled(3.0, friction, i * h, pull=pull, share=share) == pytest.approx(
                (way, speed, rim, turning), abs=2e-3
            )
    assert slid(3.0, friction - pull, 1.0) == pytest.approx(
        (3.0 + 0.5 * (pull - friction), 3.0 + pull - friction)
    )


def test_impacts_on_corners_keep_the_laws_of_newton_and_coulomb() -> None:
    random = np.random.default_rng(4)
    slid = 0
    for _ in range(200):
        x, y = random.uniform(-1, 1), -random.uniform(0.1, 1)
        inertia, fall, e, mu = (
            random.uniform(0.05, 1),
            random.uniform(0.1, 5),
            random.random(),
            random.random(),
        )
        vx, vy, spin = corner_impact((x, y), inertia, fall, e, mu)
        jx, jy = vx, vy + fall
        assert spin == pytest.approx((x * jy - y * jx) / inertia, rel=1e-12)
        if vx - spin * y == pytest.approx(0.0, abs=1e-12 * fall):
            assert abs(jx) <= mu * jy * (1 + 1e-12)
        else:  # it slides, and friction is against that
            slid += 1
            assert jx == pytest.approx(-math.copysign(mu * jy, vx - spin * y), rel=1e-12)
        assert vy + spin * x == pytest.approx(e * fall, rel=1e-9)
    assert 20 < slid < 180


# ---- convergence -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", cases(*CONVERGENCE))
def test_rigid_contacts_are_exact_to_rounding_or_have_the_order_of_the_integrator(name: str) -> None:
    """Ten cases, the step halved six times: what is no rounding falls with a power of six and more."""
    rows = rigid_rows(name, tuple(range(HALVINGS + 1)))
    errors = [math.inf if row.error is None else row.error for row in rows]
    assert not any(row.left_to_soft or row.by_impulses for row in rows)
    assert max(errors) <= CONTACTS[name].wanted
    assert errors[-1] <= ROUNDING
    assert all(e <= ROUNDING or finer <= e / 2.0**6 for e, finer in pairwise(errors)), errors


@pytest.mark.parametrize("name", cases(*(name for name in CONTACTS if name not in {*CONVERGENCE, *SHORT})))
def test_rigid_contacts_are_as_exact_as_is_wanted(name: str) -> None:
    for row in rigid_rows(name, (0, 3)):
        assert not row.left_to_soft and not row.by_impulses
        assert row.error is not None and row.error <= CONTACTS[name].wanted, (row.dt, row.error)


def test_cases_are_compared_at_whole_frames_and_their_order_is_looked_at_on_ten() -> None:
    assert len(CONVERGENCE) == 10 and set(CONVERGENCE) <= set(CONTACTS)
    for case in CONTACTS.values():
        assert list(case.times) == sorted(case.times)
        assert all((60.0 * t).is_integer() for t in case.times), case.name
        assert case.family in ("resting", "sliding", "rolling", "toppling", "impacts", "seams", "symmetry")


def test_an_error_that_is_put_in_is_found() -> None:
    """What is compared moves the figure: a body that is shifted by so much is off by that."""
    for case in CONTACTS.values():
        if case.group == "symmetry" or case.name == "free_boxes":
            continue
        world = case.build(ENGINE["rigid"].simulation(1.0 / 60.0))
        world.run(seconds=case.times[0])
        before = case.error(world, 0)
        moving = world.batch(Transform, Velocity).rows
        world.table(Transform)["position"][moving[-1]] += (0.0, 0.125)
        assert case.error(world, 0) == pytest.approx(0.125, abs=1e-6), case.name
        assert before < 1e-6


def test_orders_are_those_of_the_errors_that_are_no_rounding() -> None:
    steps = [0.1 * 2.0**-k for k in range(7)]
    assert fitted_order(steps, [h**2 for h in steps]) == pytest.approx(2.0)
    assert fitted_order(steps, [1e-3] * 7) == 0.0
    assert fitted_order(steps, [1e-14] * 7) is None
    assert fitted_order(steps, [1e-3, None, 5e-4, 1e-15, 1e-15, 1e-15, 1e-15]) is None, "two are too few"


def curve_of(*errors: float | None) -> ContactCurve:
    rows = [ContactRow(2.0**-k / 60.0, error, 1e-3) for k, error in enumerate(errors)]
    order = fitted_order([row.dt for row in rows], [row.error for row in rows])
    return ContactCurve(OWN[1], rows, order, verdict=Verdict.SHORT)


def test_what_is_no_order_is_said() -> None:
    assert order_text(curve_of(1e-3, 5e-4, 2.5e-4)) == "1.0"
    assert order_text(curve_of(1e-15, 1e-15, 1e-15)) == "rounding"
    assert order_text(curve_of(1e-2, 1e-15, 1e-15)) == "-", "one error is no rounding, and gives no order"
    assert order_text(curve_of(None)) == "-"
    study = ContactStudy(CONTACTS["rest_1"], [curve_of(1e-2, 1e-15)])
    assert "0 of 1 cases" in contact_summary([study]) and "rest_1" in contact_summary([study])


# ---- the command -------------------------------------------------------------------------------------------


@cache
def studied(name: str) -> ContactStudy:
    return result_of(study_case(CONTACTS[name], sparse=True))


def test_sparsely_only_ours_are_run() -> None:
    found = studied("rest_1")
    assert [curve.method.name for curve in found.curves] == ["rigid", "soft"]
    assert [len(curve.rows) for curve in found.curves] == [3, 3]
    assert found.curves[0].verdict is Verdict.EXCELLENT
    text = contact_text(found)
    assert "1/60 s" in text and "1/960 s" in text and "rigid contacts  rounding" in text


def test_what_is_written_of_a_case(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["accuracy", "slow_discs", "slide_stop", "--json", "-"]) == 0
    found = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert not found["problems"]
    assert [case["name"] for case in found["contacts"]] == ["slow_discs", "slide_stop"]
    for case in found["contacts"]:
        assert set(case) == {
            "name", "title", "group", "compared", "measure", "reference", "seconds", "wanted", "engines",
        }  # fmt: skip
        assert [engine["name"] for engine in case["engines"]] == [engine.name for engine in ENGINES]
        for engine in case["engines"]:
            assert set(engine) == {"name", "title", "order_measured", "verdict", "refused", "rows"}
            assert bool(engine["rows"]) is not bool(engine["refused"])
            wanted = {"dt", "error", "cpu_s_per_s", "left_to_soft", "by_impulses", "failure"}
            assert all(set(row) == wanted for row in engine["rows"])
        rigid = case["engines"][0]
        assert rigid["verdict"] == "excellent" and len(rigid["rows"]) == HALVINGS + 1


def test_a_family_of_cases_is_named_like_one_of_problems(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["accuracy", "toppling"]) == 0
    out = capsys.readouterr().out
    assert "pivot_cube:" in out and "pivot_tall:" in out
    assert "topple_at_box:" in out and "topple_at_hexagon:" in out
    assert "rigid contacts: 4 of 4 cases are within what is wanted" in out
    assert main(["accuracy", "slide_stup"]) == 2
    assert "slide_stop" in capsys.readouterr().err


@pytest.mark.plot
def test_pictures_of_cases(tmp_path: Path) -> None:
    from physicslab.lab.accuracy.plot import overview

    assert main(["accuracy", "rest_1", "--plot", str(tmp_path)]) == 0
    assert (tmp_path / "rest_1.png").read_bytes().startswith(b"\x89PNG")
    assert not (tmp_path / "contacts_step.png").exists(), "only where all of its cases were studied"
    for by in ("step", "cost"):
        assert overview([studied("rest_1"), studied("slow_discs")], by).startswith(b"\x89PNG")


# ---- other engines -----------------------------------------------------------------------------------------


@pytest.mark.peers
@pytest.mark.parametrize("name", ["pymunk", "box2d", "box2d_v3"])
def test_other_engines_come_near_the_closed_form(name: str) -> None:
    row = measure_row(CONTACTS["slide_stop"], ENGINE[name], 1.0 / 240.0)
    assert row.error is not None and 1e-6 < row.error < 0.05
    assert row.cpu_s_per_s > 0.0
    with pytest.raises(CannotBuild):
        measure_row(CONTACTS["slide_planet"], ENGINE[name], 1.0 / 240.0)


@pytest.mark.peers
def test_box2d_3_has_what_the_world_has() -> None:
    world = empty_world(SimulationConfig(sleeping=False))
    body = box(
        world, (1, 2), width=1, height=0.5, angle=0.3, velocity=(1, 2), angular_velocity=3, mass=7,
        friction=0.6,
    )  # fmt: skip
    mirror = Box2D3Mirror(world)
    assert mirror.state(body) == pytest.approx((1, 2, 1, 2, 0.3, 3), abs=1e-6)
    assert mirror._bodies[body].mass == pytest.approx(7)
    mirror.run(1.0 / 600.0, 60)
    mirror.write_back()
    assert place(world, body).x == pytest.approx(1.1, abs=1e-4)
    assert place(world, body).y == pytest.approx(2.2 - 0.5 * 9.81 * 0.01, abs=1e-3)
