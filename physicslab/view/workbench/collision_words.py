"""An impact in words, and its law line by line with the numbers put in."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from physicslab.diagnostics.collision import ENERGETIC, LOWERED, Body, Collision, Result
from physicslab.diagnostics.impact_table import WALLS, approached
from physicslab.ecs.text import printable
from physicslab.ecs.vector import Vector2
from physicslab.languages.sentence import Sentence
from physicslab.view.canvas.drawable_text import shortened
from physicslab.view.canvas.quantities import (
    percentage,
    quantity,
    vector_quantity,
    vector_without_rounding,
    without_rounding,
)
from physicslab.world import World

AGREES = 1e-9
"""Relative difference up to which the solver's figure and the one worked out here are the same."""
_LETTERS = 24
_SOFTER = 0.99
"""Share of the mass without rotation below which it is said that rotation makes the impact softer."""


@dataclass(frozen=True, slots=True)
class Step:
    """One line of the working.

    Attributes
    ----------
    words : str
        Its name in words.
    formula, numbers : str
        The formula, and the same with the numbers put in.
    value : str
        Its result, with the unit.
    solver : str
        The solver's value; empty where it keeps no such number.
    difference : float
        Between the two, as a share of the largest such number of this impact.
    """

    words: str
    formula: str
    numbers: str
    value: str
    solver: str = ""
    difference: float = 0.0


_HIT = "{a} hit {b} at {speed}."


def body_name(world: World, entity: int, wall: int) -> str:
    """Return what a body of an impact is called; entity 0 is one of the bounds."""
    if entity == 0:
        return WALLS[wall] if 0 <= wall < len(WALLS) else "the bounds"
    return shortened(printable(world.label(entity)), _LETTERS)


# ---- in words ----------------------------------------------------------------------------------------------


def story(collision: Collision, result: Result, names: tuple[str, str]) -> list[str]:
    """Return what happened, a sentence each; ``names`` are those of A and B.

    The first says who hit whom, the second how they part; the rest is for those who want to know more.
    """
    spot = max(collision.spots, key=lambda one: one.normal_impulse)
    vn, vt = collision.approach(spot)
    left, slides = collision.approach(spot, after=True)
    moved = collision.normal_impulse * (collision.a.inverse_mass + collision.b.inverse_mass)
    rested = not approached(vn, moved)
    told: list[str] = [_who(collision, names, "" if rested else quantity(-vn, "m/s"))]
    told.append(_bounce(collision, result, 0.0 if rested else -left / vn))
    told.append("These speeds are along the normal n of the contact.")
    if len(collision.spots) == 2:
        told.append("Two points met at once, as when a box lands flat: both impulses are found together.")
    told += list(_rotation(collision))
    told.append(_friction(collision, result, vt, slides))
    told += list(_law(collision, result))
    if not collision.alone:
        told.append(
            "Other bodies hit one of these two at the same moment. The working here is of this pair "
            "by itself; the motions after are those of all impacts together, and may differ from it."
        )
    return told


def _who(collision: Collision, names: tuple[str, str], speed: str) -> str:
    """Return which of the two moved into the other; without a ``speed`` they rested on each other."""
    a, b = (
        Sentence("{name} ({letter})", name=name, letter=letter)
        for name, letter in zip(names, "AB", strict=True)
    )
    if not speed:
        return Sentence("{a} and {b} touched, and an impact of others went through.", a=a, b=b)
    of_a = collision.a.before.linear.dot(collision.normal)
    of_b = -collision.b.before.linear.dot(collision.normal)
    if not (collision.a.is_free and collision.b.is_free):
        a, b = (b, a) if collision.b.is_free else (a, b)
        return Sentence(_HIT, a=a, b=b, speed=speed)
    none = AGREES * collision.speed_scale
    if of_a > none and of_b > none:
        return Sentence("{a} and {b} ran into each other at {speed}.", a=a, b=b, speed=speed)
    first, second, other = (a, b, of_b) if of_a > of_b else (b, a, of_a)
    words = "{a} caught up with {b} at {speed}." if other < -none else _HIT
    return Sentence(words, a=first, b=second, speed=speed)


def _bounce(collision: Collision, result: Result, found: float) -> str:
    e = collision.restitution
    if e == 0.0 and abs(found) < AGREES:
        return "They do not bounce (e = 0)."
    words = f"They part at {percentage(found)} of that speed"
    return f"{words}; the materials have e = {e:.3g}."


def _rotation(collision: Collision) -> Iterator[str]:
    """Yield why an impact beside the centre is softer."""
    response = collision.responses[0]
    plain, turning = 1.0 / (collision.a.inverse_mass + collision.b.inverse_mass), 1.0 / response.kn
    if len(collision.spots) == 2:
        yield (
            f"At one point alone it would turn out of the way, as if only {quantity(turning, 'kg')} were hit "
            f"in place of {quantity(plain, 'kg')}; two points hold it, and it turns less."
        )
    elif turning < _SOFTER * plain:
        yield (
            f"The impulse passes beside a centre of mass, so the contact gives way by turning: it acts like "
            f"{quantity(turning, 'kg')}, and not like {quantity(plain, 'kg')} as without rotation. Such an "
            f"impact is softer."
        )
    else:
        acts = f"It acts like {quantity(plain, 'kg')}."
        yield f"The impulse goes through the centres: rotation does not soften it. {acts}"


def _friction(collision: Collision, result: Result, before: float, after: float) -> str:
    if collision.friction == 0.0:
        return "There is no friction: the sliding goes on as before."
    none = AGREES * collision.speed_scale
    if abs(before) < none and abs(after) < none:
        return "There is no sliding, so there is hardly any friction impulse."
    if result.sticks:
        return "It sticks: friction is strong enough to stop the sliding at the contact."
    return (
        f"It slides: friction is at its limit, μ = {collision.friction:.3g} times the normal impulse, and "
        f"the sliding goes from {quantity(before, 'm/s')} to {quantity(after, 'm/s')}."
    )


def _law(collision: Collision, result: Result) -> Iterator[str]:
    """Yield which law holds where it is not Newton's with the e of the materials."""
    if collision.law == ENERGETIC:
        yield (
            "Newton's law would create energy here, since friction reverses the sliding during the impact. "
            "Stronge's law holds: the normal force gives back e² of the work that it took."
        )
    elif collision.law == LOWERED:
        yield (
            f"With e = {collision.restitution:.3g} this impact would create energy, so restitution was "
            f"lowered to {result.restitution:.4g}: the largest that creates none."
        )


# ---- the law with its numbers ------------------------------------------------------------------------------


def law_steps(collision: Collision, result: Result) -> list[Step]:
    """Return the working, line by line; figures of the solver are those of the record."""
    impulses = _impulses_of_two if len(collision.spots) == 2 else _impulses_of_one
    return [*_masses(collision), *impulses(collision, result), *_motions(collision, result)]


def _number(value: float) -> str:
    """Return a number within a formula: four figures, in brackets if it is negative.

    >>> _number(0.5), _number(-2.0), _number(1.25e-7)
    ('0.5', '(-2)', '1.25e-07')
    """
    return f"{value:.4g}" if value >= 0.0 or value == 0.0 else f"({value:.4g})"


def _one_over(inverse: float) -> str:
    return f"1/{1.0 / inverse:.4g}" if inverse > 0.0 else "1/∞"


def _masses(collision: Collision) -> Iterator[Step]:
    a, b, state, response = collision.a, collision.b, collision.states[0], collision.responses[0]
    reach = max(arm.magnitude for spot in collision.spots for arm in (spot.arm_a, spot.arm_b))
    both = f"{_one_over(a.inverse_mass)} + {_one_over(b.inverse_mass)}"

    def terms(*arms: float) -> str:
        """Return the part of both bodies that turn, with their arms."""
        parts = zip(arms, (a, b), strict=True)
        return " + ".join(
            f"{_number(without_rounding(arm, reach))}²·{_one_over(body.inverse_inertia)}"
            for arm, body in parts
        )

    yield Step(
        "Mass that the impulse meets if neither body could turn", "1/m = 1/m_A + 1/m_B", both,
        f"m = {quantity(1.0 / (a.inverse_mass + b.inverse_mass), 'kg')}",
    )  # fmt: skip
    for k, (at, one) in enumerate(zip(collision.states, collision.responses, strict=True)):
        turned = terms(at.normal_a, at.normal_b)
        of = f" at point {k + 1}" if len(collision.responses) == 2 else ""
        yield Step(
            f"Mass along the normal, with rotation{of}",
            "1/m_n = 1/m_A + 1/m_B + (r_A×n)²/I_A + (r_B×n)²/I_B", f"{both} + {turned}",
            f"m_n = {quantity(1.0 / one.kn, 'kg')}",
        )  # fmt: skip
    if collision.friction > 0.0:
        turned = terms(state.tangent_a, state.tangent_b)
        yield Step(
            "Mass along the surface, with rotation",
            "1/m_t = 1/m_A + 1/m_B + (r_A×t)²/I_A + (r_B×t)²/I_B", f"{both} + {turned}",
            f"m_t = {quantity(1.0 / response.kt, 'kg')}",
        )  # fmt: skip
        if without_rounding(response.coupling, response.kn):
            yield Step(
                "Coupling: sliding of the contact by an impulse along n",
                "c = (r_A×n)(r_A×t)/I_A + (r_B×n)(r_B×t)/I_B",
                " + ".join(
                    f"{_number(n)}·{_number(t)}·{_one_over(body.inverse_inertia)}"
                    for n, t, body in (
                        (state.normal_a, state.tangent_a, a), (state.normal_b, state.tangent_b, b),
                    )
                ),
                f"c = {quantity(response.coupling, '1/kg')}",
            )  # fmt: skip


def _impulses_of_one(collision: Collision, result: Result) -> list[Step]:
    response, (vn, vt) = collision.responses[0], collision.approach(collision.spots[0])
    e, mu = result.restitution, collision.friction
    kn, kt, c = response.kn, response.kt, without_rounding(response.coupling, response.kn)
    normal, tangent = result.normal[0], result.tangent[0]
    steps = [
        Step("Approach along n, before", "v_n = (v_B + ω_B×r_B - v_A - ω_A×r_A)·n", "", quantity(vn, "m/s")),
        Step("Sliding along t, before", "v_t = (v_B + ω_B×r_B - v_A - ω_A×r_A)·t", "", quantity(vt, "m/s")),
    ]
    gained = f"(1 + {_number(e)})·{_number(-vn)}"
    if collision.law == ENERGETIC:
        words = "Stronge's law: work given back = e² of the work taken"
        ways = (("v_n, v_t, m_n, m_t, c, e, μ", "by parts: sliding, sticking, sliding back"),) * 2
    elif result.sticks and c:
        words = "It sticks: v_n' = -e v_n and v_t' = 0, two equations for two impulses"
        ways = (
            ("J_n = ((1+e)(-v_n)/m_t + c v_t) / (1/(m_n m_t) - c²)",
             f"({gained}·{kt:.4g} + {_number(c)}·{_number(vt)}) / ({kn:.4g}·{kt:.4g} - {_number(c)}²)"),
            ("J_t = -(v_t/m_n + c (1+e)(-v_n)) / (1/(m_n m_t) - c²)",
             f"-({_number(vt)}·{kn:.4g} + {_number(c)}·{gained}) / ({kn:.4g}·{kt:.4g} - {_number(c)}²)"),
        )  # fmt: skip
    elif c and tangent:
        sign = math.copysign(1.0, tangent)
        shown = "+" if sign > 0.0 else "-"
        words = "It slides: friction is μ J_n, and changes v_n through the coupling"
        ways = (
            (
                f"J_n = -(1+e) v_n / (1/m_n {shown} μ c)",
                f"{gained} / ({kn:.4g} {shown} {mu:.4g}·{_number(c)})",
            ),
            (f"J_t = {shown}mu J_n", f"{shown}{mu:.4g}·{normal:.4g}"),
        )
    else:
        words = "Newton's law: it leaves with e times its approach"
        ways = (
            ("J_n = -(1+e) v_n m_n", f"{gained}·{1.0 / kn:.4g}"),
            ("J_t = clamp(-v_t m_t, ±mu J_n)", f"clamp({-vt / kt:.4g}, ±{mu:.4g}·{normal:.4g})"),
        )
    return [*steps, *_compared(collision, result, words, ways)]


def _impulses_of_two(collision: Collision, result: Result) -> list[Step]:
    speeds = [collision.approach(spot)[0] for spot in collision.spots]
    steps = [
        Step(f"Approach of point {k + 1} along n, before", f"v_{k + 1}", "", quantity(v, "m/s"))
        for k, v in enumerate(speeds)
    ]
    steps.append(
        Step(
            "Each point also moves the other",
            "k = 1/m_A + 1/m_B + (r_A1×n)(r_A2×n)/I_A + (r_B1×n)(r_B2×n)/I_B",
            "", f"k = {quantity(collision.pair_response.kn_12, '1/kg')}",
        )
    )  # fmt: skip
    e = result.restitution
    words = f"Both together: each point leaves with {e:.4g} times its approach, or is not pressed"
    ways = (
        ("J_1/m_1 + k J_2 + c_1 J_t = -(1+e) v_1, and so for the other",
         " + ".join(quantity(one, "N s") for one in result.normal)),
        ("J_t stops the sliding, within ±μ (J_1 + J_2)",
         f"|J_t| ≤ {collision.friction:.4g}·{sum(result.normal):.4g}"),
    )  # fmt: skip
    return [*steps, *_compared(collision, result, words, ways)]


def _compared(
    collision: Collision, result: Result, words: str, ways: tuple[tuple[str, str], ...]
) -> Iterator[Step]:
    """Yield both impulses, beside what the solver gave."""
    scale = collision.normal_impulse
    found = (sum(result.normal), collision.normal_impulse), (sum(result.tangent), collision.tangent_impulse)
    for (formula, numbers), (value, solver), name in zip(ways, found, ("J_n", "J_t"), strict=True):
        shown = (
            words if name == "J_n" else ("Friction: it sticks" if result.sticks else "Friction: it slides")
        )
        if name == "J_t" and collision.friction == 0.0:
            shown = "Friction: there is none"
        yield Step(
            shown, formula, numbers, f"{name} = {quantity(value, 'N s')}", quantity(solver, "N s"),
            abs(value - solver) / scale if scale else 0.0,
        )  # fmt: skip


def _motions(collision: Collision, result: Result) -> Iterator[Step]:
    """Yield the motions after, beside those that the solver gave."""
    bodies = (("A", collision.a, result.a, "-"), ("B", collision.b, result.b, "+"))
    speed, turning, pressed = collision.speed_scale, collision.turning_scale, collision.impulse.magnitude
    for name, body, motion, sign in bodies:
        if not body.is_free:
            continue
        yield Step(
            f"Velocity of {name} after", f"v_{name}' = v_{name} {sign} (J_n n + J_t t)/m_{name}",
            f"{_vector(body.before.linear, speed, '')}{sign} {_vector(collision.impulse, pressed, '')}"
            f"·{_one_over(body.inverse_mass)}",
            _vector(motion.linear, speed, "m/s"), _vector(body.after.linear, speed, "m/s"),
            (motion.linear - body.after.linear).magnitude / speed if speed else 0.0,
        )  # fmt: skip
        if body.inverse_inertia > 0.0:
            yield Step(
                f"Turning of {name} after", f"ω_{name}' = ω_{name} {sign} r_{name}×(J_n n + J_t t)/I_{name}",
                f"{_number(body.before.angular)} {sign} {_number(_torque(body, collision))}"
                f"·{_one_over(body.inverse_inertia)}",
                quantity(without_rounding(motion.angular, turning), "rad/s"),
                quantity(without_rounding(body.after.angular, turning), "rad/s"),
                abs(motion.angular - body.after.angular) / turning if turning else 0.0,
            )  # fmt: skip


def _torque(body: Body, collision: Collision) -> float:
    """Return the turning impulse about a body's centre, of impulses as on B [N m s]."""
    return sum(
        (spot.arm_a if body is collision.a else spot.arm_b).cross(
            spot.normal_impulse * collision.normal + spot.tangent_impulse * collision.tangent
        )
        for spot in collision.spots
    )


def _vector(value: Vector2, scale: float, unit: str) -> str:
    """Return a vector; components that are rounding beside ``scale`` are treated as zero."""
    return vector_quantity(vector_without_rounding(value, scale), unit)
