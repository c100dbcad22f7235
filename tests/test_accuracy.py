"""The accuracy lab: references, orders, verdicts, thresholds reached, and the command."""

import dataclasses
import json
import math
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import mpmath
import pytest

from physicslab.cli import main
from physicslab.integrators import INTEGRATORS, Integrator
from physicslab.lab.accuracy import measure as measuring
from physicslab.lab.accuracy import study as studying
from physicslab.lab.accuracy.catalogue import LEFT_OUT, PROBLEMS
from physicslab.lab.accuracy.forces import crowd
from physicslab.lab.accuracy.measure import measure, rounding_floor
from physicslab.lab.accuracy.plot import method_styles
from physicslab.lab.accuracy.problem import Problem, Setting, digits, ladder, number, record, refusal
from physicslab.lab.accuracy.study import Study, study
from physicslab.lab.accuracy.tables import document
from physicslab.lab.accuracy.verdict import measured_order, verdict
from physicslab.lab.case import Verdict
from physicslab.lab.jobs import result_of

type Figures = dict[tuple[str, ...], mpmath.mpf]
"""Figures by the keys under which they are on record."""

FIXED = [method for method in INTEGRATORS.values() if method.evaluations and not method.chooses_steps]


@pytest.fixture(scope="module", autouse=True)
def made_once() -> Iterator[None]:
    """Make short runs once: their times, for which they are repeated, are not what is tested."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(measuring, "_REPEATED_BELOW_S", 0.0)
        yield


@cache
def studied(name: str, rungs: int | None = None) -> Study:
    """Return the study of a problem; what is conserved on the way is looked at now and then.

    With ``rungs``, each ladder has so many: the coarsest steps, and tolerances from loose to tight.
    """

    def short(problem: Problem, method: Integrator) -> list[Setting]:
        settings, count = list(ladder(problem, method)), rungs or 1
        return settings[:: max(1, len(settings) // count)] if method.chooses_steps else settings[:count]

    with pytest.MonkeyPatch.context() as patched:
        if not PROBLEMS[name].chaotic:  # there the fastest rate lasts for moments
            patched.setattr(measuring, "_SAMPLES", 6)
        if rungs is not None:
            patched.setattr(studying, "ladder", short)
        return result_of(study(PROBLEMS[name]))


# ---- references --------------------------------------------------------------------------------------------


def oscillation(decay: mpmath.mpf, rate2: mpmath.mpf, t: mpmath.mpf) -> tuple[mpmath.mpf, mpmath.mpf]:
    """Return x and v of x'' + 2 decay x' + rate2 x = 0 from x = 1 at rest, by its characteristic roots."""
    gap = mpmath.sqrt(mpmath.mpc(decay * decay - rate2))
    if gap == 0:
        return (1 + decay * t) * mpmath.exp(-decay * t), -decay * decay * t * mpmath.exp(-decay * t)
    late, early = -decay + gap, -decay - gap
    x = (late * mpmath.exp(early * t) - early * mpmath.exp(late * t)) / (late - early)
    v = late * early * (mpmath.exp(early * t) - mpmath.exp(late * t)) / (late - early)
    return x.real, v.real


def kepler(e: str, t: mpmath.mpf) -> tuple[mpmath.mpf, mpmath.mpf]:
    """Return the place on an orbit with a = 1 and G M = 1, from the pericentre on, by Kepler's equation."""
    share = mpmath.mpf(e)
    mean = mpmath.fmod(t, 2 * mpmath.pi)
    angle = mpmath.findroot(
        lambda angle: angle - share * mpmath.sin(angle) - mean,
        (0, 2 * mpmath.pi),
        solver="anderson",
        tol=1e-60,
    )
    return mpmath.cos(angle) - share, mpmath.sqrt(1 - share**2) * mpmath.sin(angle)


def drag_linear() -> Figures:
    rate, g, t = mpmath.mpf(1) / 4, mpmath.mpf("9.81"), 3
    left, sink = mpmath.exp(-rate * t), g / rate
    return {
        ("x",): 10 * (1 - left) / rate, ("y",): (15 + sink) * (1 - left) / rate - sink * t,
        ("vx",): 10 * left, ("vy",): (15 + sink) * left - sink,
    }  # fmt: skip


def drag_quadratic() -> Figures:
    g = mpmath.mpf("9.81")
    terminal = mpmath.sqrt(g * 10)
    return {
        ("v",): terminal * mpmath.tanh(g * 2 / terminal),
        ("d",): terminal**2 / g * mpmath.log(mpmath.cosh(g * 2 / terminal)),
    }


def damped(damping: str) -> Callable[[], Figures]:
    def figures() -> Figures:
        x, v = oscillation(mpmath.mpf(damping) / 2, mpmath.mpf(100), mpmath.mpf("0.7"))
        return {("x",): x, ("v",): v}

    return figures


def stiff_spring() -> Figures:
    zs = record("stiff_spring")["reference"]
    found: Figures = {(z, "x"): mpmath.cos(1000 * mpmath.mpf(z)) for z in zs}
    return found | {(z, "v_over_w"): -mpmath.sin(1000 * mpmath.mpf(z)) for z in zs}


def sag() -> Figures:
    found: Figures = {}
    for z in record("stiff_spring_gravity_sag")["reference"]:
        rate = 100 * mpmath.mpf(z)
        rest = -mpmath.mpf("9.81") / rate**2
        swing, _ = oscillation(rate / 20, rate**2, mpmath.mpf(1))
        found |= {(z, "rest"): rest, (z, "x_at_1s"): rest * (1 - swing)}
    return found


def damper() -> Figures:
    found: Figures = {}
    for z in record("stiff_damper")["reference"]:
        sink = mpmath.mpf("9.81") / (100 * mpmath.mpf(z))
        found |= {(z, "v_terminal"): -sink, (z, "v_10ms"): (1 + sink) * mpmath.exp(-mpmath.mpf(z)) - sink}
    return found


def orbit(e: str) -> Callable[[], Figures]:
    def figures() -> Figures:
        found: Figures = {}
        times = {"t=1": mpmath.mpf(1), "t=10": mpmath.mpf(10), "t=200pi+1": 200 * mpmath.pi + 1}
        for key, t in times.items():
            found[key, "x"], found[key, "y"] = kepler(e, t)
        return found

    return figures


def bounce() -> Figures:
    g, e = mpmath.mpf("9.81"), mpmath.mpf("0.8")
    fall = mpmath.sqrt(10 / g)
    found: Figures = {(f"h_{n}",): 5 * e ** (2 * n) for n in range(1, 11)}
    found |= {(f"t_{n}",): fall * (1 + 2 * sum(e**i for i in range(1, n))) for n in range(1, 11)}
    return found | {("zeno",): fall * (1 + e) / (1 - e)}


def slopes() -> Figures:
    g, sine, cosine = mpmath.mpf("9.81"), mpmath.mpf(1) / 2, mpmath.sqrt(3) / 2
    return {
        ("block_slides_if_mu_below",): sine / cosine,
        ("block_a_mu04",): g * (sine - mpmath.mpf("0.4") * cosine),
        ("disc_rolling_a",): g * sine / (1 + mpmath.mpf(1) / 2),
        ("sphere_rolling_a",): g * sine / (1 + mpmath.mpf(2) / 5),
        ("disc_slip_mu01_a",): g * (sine - mpmath.mpf("0.1") * cosine),
    }


def rolling() -> Figures:
    found: Figures = {}
    slowing = mpmath.mpf("0.3") * mpmath.mpf("9.81")
    for kind, share in (("disc", "0.5"), ("sphere", "0.4"), ("hoop", "1")):
        v = 5 / (1 + mpmath.mpf(share))
        t = (5 - v) / slowing
        found |= {(kind, "v"): v, (kind, "t"): t, (kind, "d"): 5 * t - slowing * t * t / 2}
    return found


def sliding() -> Figures:
    slowing = mpmath.mpf("0.3") * mpmath.mpf("9.81")
    return {("d",): 25 / (2 * slowing), ("t",): 5 / slowing}


def flight() -> Figures:
    g, up = mpmath.mpf("9.81"), 10 * mpmath.sqrt(3)
    return {("T",): 2 * up / g, ("R",): 20 * up / g, ("H",): up**2 / (2 * g)}


CLOSED_FORMS: dict[str, Callable[[], Figures]] = {
    "projectile": flight, "drag_linear": drag_linear, "drag_quadratic": drag_quadratic,
    "damped_under": damped("2"), "damped_critical": damped("20"), "damped_over": damped("100"),
    "stiff_spring": stiff_spring, "stiff_spring_gravity_sag": sag, "stiff_damper": damper,
    "kepler_e0": orbit("0"), "kepler_e0.5": orbit("0.5"), "kepler_e0.9": orbit("0.9"),
    "kepler_e0.99": orbit("0.99"), "bounce": bounce, "incline": slopes, "slip_to_roll": rolling,
    "friction_slide": sliding,
    "box_topple": lambda: {("theta_deg",): mpmath.degrees(mpmath.atan(mpmath.mpf(1) / 2))},
    "elastic_bounce_100": lambda: {("t_100",): 199 * mpmath.sqrt(10 / mpmath.mpf("9.81"))},
    "lagrange_equal": lambda: {("omega",): mpmath.sqrt(3)},
}  # fmt: skip


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_every_digit_on_record_is_that_of_the_closed_form(name: str) -> None:
    with mpmath.workdps(60):
        for keys, value in CLOSED_FORMS[name]().items():
            written = digits(name, *keys)
            assert abs(mpmath.mpf(written) - value) <= abs(value) * mpmath.mpf(10) ** -18, (keys, written)


@pytest.mark.parametrize("e", ["0", "0.5", "0.9", "0.99"])
def test_orbits_start_at_the_nearest_float_to_the_exact_speed(e: str) -> None:
    from physicslab.lab.worlds import place, velocity

    world = PROBLEMS[f"kepler_e{e}"].build(Setting("auto").simulation(PROBLEMS[f"kepler_e{e}"]))
    with mpmath.workdps(40):
        share = mpmath.mpf(e)
        assert velocity(world, "planet").y == float(mpmath.sqrt((1 + share) / (1 - share)))
        assert place(world, "planet").x == float(1 - share)


def test_the_crowd_starts_without_momentum_to_speak_of_and_at_exact_numbers() -> None:
    bodies = crowd()
    assert len(bodies) == len(record("crowd100")["reference"]["places"]) == 100
    assert all(math.ldexp(value, 20).is_integer() for where, how in bodies for value in (*where, *how))


def test_every_figure_is_kept_as_digits() -> None:
    assert digits("kepler_e0.5", "t=1", "x") == "-0.4279672455611135512613"
    assert number("kepler_e0.5", "t=1", "x") == -0.4279672455611135512613
    with pytest.raises(KeyError, match="no figure"):
        digits("kepler_e0.5", "t=1")


# ---- the list ----------------------------------------------------------------------------------------------


def test_problems_are_in_order() -> None:
    for problem in PROBLEMS.values():
        assert problem.excellent < problem.good, problem.name
        assert list(problem.times) == sorted(problem.times), problem.name
        assert record(problem.family)["method"]
    assert not set(PROBLEMS) & set(LEFT_OUT)


def test_a_family_is_chosen_by_the_name_that_its_problems_share() -> None:
    assert [problem.name for problem in PROBLEMS.select("slip_to_roll")] == [
        "slip_to_roll_disc", "slip_to_roll_disc_way", "slip_to_roll_sphere", "slip_to_roll_hoop",
    ]  # fmt: skip
    assert [problem.name for problem in PROBLEMS.select("figure_eight_simo")] == ["figure_eight_simo"]
    assert not PROBLEMS.select("nothing")
    assert {"kepler_e0.5", "stiff_spring", "stiff_spring_z10"} <= set(PROBLEMS.names)


def test_what_is_compared_is_never_a_whole_period_alone() -> None:
    for e in ("0", "0.5", "0.9", "0.99"):
        assert PROBLEMS[f"kepler_e{e}"].seconds % (2 * math.pi) == pytest.approx(1)
    assert PROBLEMS["harmonic"].seconds % 1 == 0.25


# ---- what is measured --------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", FIXED, ids=lambda method: method.name)
def test_the_measured_order_is_the_stated_one(method: object) -> None:
    (curve,) = [curve for curve in studied("elastic_pendulum").curves if curve.method is method]
    assert not curve.short
    assert curve.order == pytest.approx(curve.method.order, abs=0.1)


QUICK = ("drag_linear", "damped_under")
SMOOTH = ("harmonic", "figure_eight", "figure_eight_simo")
"""Here every method has its order within five rungs."""


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if name in QUICK else [pytest.mark.slow]) for name in PROBLEMS]
)
def test_every_row_reaches_the_stated_order_or_says_why_not(name: str) -> None:
    problem = PROBLEMS[name]
    oscillates = problem.group == "oscillator"
    for curve in studied(name, 5 if name in SMOOTH else None if oscillates or name in QUICK else 2).curves:
        assert bool(curve.rows) != bool(curve.refused)
        assert all(row.error is not None or row.failure for row in curve.rows), curve.method.name
        if curve.refused or not curve.method.evaluations or problem.search is not None:
            continue  # without steps, or looked for with many worlds: no order is measured
        reached = curve.order is not None and curve.order >= 0.9 * curve.method.order
        assert reached != bool(curve.short), (curve.method.name, curve.order, curve.short)
        assert reached or name not in SMOOTH, (curve.method.name, curve.short)
        if oscillates:
            assert "evenly" not in curve.short, "these forces are smooth"


def test_a_method_for_positions_alone_is_said_not_to_hold_its_order_with_drag() -> None:
    curves = {curve.method.name: curve for curve in studied("drag_linear").curves}
    assert not curves["rk4"].short and curves["rk4"].order == pytest.approx(4, abs=0.1)
    assert "velocities" in curves["blanes_moan"].short and curves["blanes_moan"].order == pytest.approx(
        1, abs=0.1
    )


LIMITS = {"kepler_e0.5": 1e-10, "kepler_e0.9": 1e-9, "figure_eight": 1e-10, "pythagorean_t20": 1e-7}


@pytest.mark.parametrize(("name", "limit"), LIMITS.items())
def test_orbits_end_where_they_should(name: str, limit: float) -> None:
    error = measure(PROBLEMS[name], Setting("auto")).error
    assert error is not None and error <= limit


SHORT = {
    "kepler_e0.99": "rounding where the planet is nearest: 14 m/s beside 1 cm",
    "friction_slide": "a block that starts on the floor sinks first, and rubs less meanwhile",
    "slip_to_roll_disc_way": "a disc that starts on the floor sinks first, and rubs less meanwhile",
    "incline_block": "a block that starts on the slope sinks first, and rubs less meanwhile",
    "incline_slipping": "a disc that starts on the slope sinks first, and rubs less meanwhile",
    "incline_held": "a block that starts on the slope sinks first",
    "stack10_forces": "the contacts' impulses have not settled to the last digit after 10 s",
    "stack10_height": "contacts are soft: ten of them sink 20 mm",
    "stack10_drift": "a stack that sinks creeps sideways",
}
"""Where ``auto`` is not excellent so far, and why."""
SLOW = {"elastic_bounce_100", "incline_threshold", "box_topple"}
"""More than a second each."""


def auto_verdict(name: str) -> Verdict:
    """Return what ``auto`` is worth on a problem."""
    problem = PROBLEMS[name]
    found = measure(problem, Setting("auto"))
    if found.collision_count_error:
        return Verdict.SHORT
    floor = rounding_floor(problem)
    return verdict(found.error, problem.good, problem.excellent, floor=floor, chaotic=problem.chaotic)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else [])
        for name in PROBLEMS
        if name not in SHORT
    ],
)
def test_auto_is_excellent_or_as_good_as_chaos_allows(name: str) -> None:
    assert auto_verdict(name) in (Verdict.EXCELLENT, Verdict.CHAOS)


@pytest.mark.parametrize("name", [name for name in PROBLEMS if PROBLEMS[name].group == "contact"])
def test_rigid_contacts_are_excellent_where_bodies_rest_and_rub(name: str) -> None:
    problem = PROBLEMS[name]
    found = measure(problem, Setting("auto", contacts="rigid"))
    assert verdict(found.error, problem.good, problem.excellent) is Verdict.EXCELLENT, found.error


def test_auto_is_excellent_on_nine_of_ten_problems_in_which_nothing_touches() -> None:
    free = [name for name in PROBLEMS if not PROBLEMS[name].touches]
    assert len([name for name in free if name in SHORT]) <= 0.1 * len(free)


def test_steps_and_tolerances_make_a_ladder() -> None:
    problem = PROBLEMS["harmonic"]
    steps = [setting.steps for setting in ladder(problem, INTEGRATORS["rk4"])]
    assert steps == [2048 << i for i in range(8)]
    tolerances = [setting.tolerance for setting in ladder(problem, INTEGRATORS["dop853"])]
    assert tolerances == sorted(filter(None, tolerances), reverse=True)
    assert list(ladder(problem, INTEGRATORS["exact"])) == [Setting("exact")]


def test_the_engine_says_which_methods_it_does_not_use() -> None:
    assert "touch" in refusal(PROBLEMS["bounce"], INTEGRATORS["rk4"])
    assert "closed form" in refusal(PROBLEMS["figure_eight"], INTEGRATORS["exact"])
    assert "force evaluations" in refusal(PROBLEMS["stiff_damper_z1e6"], INTEGRATORS["dop853"])
    assert refusal(PROBLEMS["kepler_e0"], INTEGRATORS["dop853"]) == ""


def test_a_run_that_diverges_is_a_row_without_an_error() -> None:
    found = measure(PROBLEMS["stiff_spring_z10"], Setting("leapfrog", steps=1000))
    assert found.error is None and "finite" in found.failure
    assert verdict(found.error, 1.0, 0.1) is Verdict.FAILED


def test_energy_is_compared_with_the_exact_one_where_some_is_lost() -> None:
    for name in ("drag_linear", "drag_quadratic", "damped_under", "damped_critical", "damped_over"):
        found = measure(PROBLEMS[name], Setting("auto"))
        assert found.energy_drift is not None and found.energy_drift < 1e-12
    found = measure(PROBLEMS["stiff_damper_z1"], Setting("auto"))
    assert found.energy_drift is not None and found.energy_drift < 1e-12


def test_collisions_that_are_missing_are_counted() -> None:
    found = measure(PROBLEMS["galperin_n3"], Setting("leapfrog", steps=1125))
    assert found.collision_count_error is not None and found.collision_count_error < -1000


def test_verdicts() -> None:
    assert verdict(1e-12, 1e-6, 1e-10) is Verdict.EXCELLENT
    assert verdict(1e-8, 1e-6, 1e-10) is Verdict.GOOD
    assert verdict(1e-3, 1e-6, 1e-10) is Verdict.SHORT
    assert verdict(1e-9, 1e-6, 1e-10, floor=1e-10, chaotic=True) is Verdict.CHAOS
    assert verdict(1e-13, 1e-6, 1e-14, floor=1e-13) is Verdict.ROUNDING


def test_the_order_is_measured_above_the_floor_of_rounding() -> None:
    steps = [2**i for i in range(4, 14)]
    errors = [n**-4.0 + 1e-12 for n in steps]
    assert measured_order(steps, errors) == pytest.approx(4, abs=0.02)
    assert measured_order(steps, [1.0] * len(steps)) is None
    assert measured_order([1, 2], [None, 1e-3]) is None


# ---- the command -------------------------------------------------------------------------------------------


def test_the_document_holds_finite_numbers_alone(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["accuracy", "free_fall", "--json", "-"]) == 0
    printed = capsys.readouterr()
    (problem,) = json.loads(printed.out, parse_constant=pytest.fail)["problems"]
    assert problem["auto"]["integrator"] == "exact"
    assert problem["auto"]["verdict"] == "excellent"
    assert problem["rigid"] is None, "nothing touches"
    assert [curve["name"] for curve in problem["integrators"]] == list(INTEGRATORS)
    wanted = {
        "integrator", "reason", "collisions", "dt", "tolerance", "steps", "force_evaluations", "cpu_ms",
        "ms_per_simulated_s", "time", "error", "energy_drift", "energy_numerical", "momentum_error",
        "angular_momentum_error", "omega_max_dt", "max_penetration", "collision_count_error", "verdict",
        "failure",
    }  # fmt: skip
    for curve in problem["integrators"]:
        assert all(set(row) == wanted for row in curve["rows"])


def test_every_method_has_a_style_and_an_entry_in_the_legend() -> None:
    found = studied("free_fall")
    curve = next(curve for curve in found.curves if curve.rows)
    new = [
        dataclasses.replace(curve, method=dataclasses.replace(curve.method, name=name))
        for name in ("new", "newer")
    ]
    styles = method_styles([dataclasses.replace(found, curves=[*found.curves, *new])])
    assert set(styles) == {curve.method.name for curve in found.curves if curve.rows} | {"new", "newer"}
    assert len(set(styles.values())) == len(styles), "told apart"


@pytest.mark.plot
def test_a_table_and_pictures(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found, pictures = tmp_path / "found.json", tmp_path / "new" / "pictures"
    assert main(["accuracy", "damped", "damped_over", "--plot", str(pictures)]) == 2
    capsys.readouterr()
    assert main(["accuracy", "damped_over", "--plot", str(pictures), "--json", str(found)]) == 0
    assert "auto is excellent on 1 of 1 problems" in capsys.readouterr().out
    assert (pictures / "damped_over.png").read_bytes().startswith(b"\x89PNG")
    assert json.loads(found.read_text("utf-8"))["problems"][0]["name"] == "damped_over"


def test_a_scene_is_compared_with_itself(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = tmp_path / "found.json"
    assert main(["accuracy", "two_planets", "--json", str(found)]) == 0
    (scene,) = json.loads(found.read_text("utf-8"))["scenes"]
    assert "estimate" in scene["kind"]
    auto = scene["rows"][0]
    assert auto["asked"] == "auto" and auto["half_step"] < 1e-10 and auto["error"] < 1e-10
    assert "an estimate" in capsys.readouterr().out


def test_what_cannot_be_done_is_said_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    bad = tmp_path / "bad.json"
    bad.write_text("{}")
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    for arguments, words in (
        (["nonsense"], "is no problem, scene or file; the problems are free_fall"),
        (["kepler_e0.55"], "did you mean"),
        ([str(bad)], "format"),
        (["free_fall", "--plot", str(tmp_path)], "pip install 'physicslab[plot]'"),
        (["free_fall", "--json", str(tmp_path / "no" / "file")], "cannot be written"),
    ):
        assert main(["accuracy", *arguments]) == 2
        printed = capsys.readouterr()
        assert words in printed.err and printed.err.count("\n") == 1 and not printed.out


def test_interrupted_it_says_so(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("physicslab.lab.accuracy.study.measure", interrupt)
    assert main(["accuracy", "free_fall"]) == 130
    assert "interrupted" in capsys.readouterr().err


def test_the_document_of_nothing_still_says_what_was_left_out() -> None:
    assert {left["name"] for left in document([])["left_out"]} == {"plummer100", "galperin_n5"}
