"""Numbers with units: what they stand for, and that any text is either a finite number or refused."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from physicslab.ecs.component import COMPONENTS
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.quantity_text import InvalidText, evaluate

UNITS = ("1", "m", "kg", "s", "rad", "m/s", "rad/s", "kg m^2", "N/m", "N s/m", "kg/s", "kg/m")


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("2", "m", 2.0), ("-2.5", "m", -2.5), (".5", "m", 0.5), ("1e3", "kg", 1000.0), ("1E-3", "kg", 0.001),
        ("2,5", "m", 2.5), ("0,125", "m", 0.125), ("1,25", "m", 1.25), ("1,0000", "m", 1.0),
        ("2 e", "1", 2 * math.e),
        ("2*e", "1", 2 * math.e), ("2e3", "1", 2000.0), ("1000,5", "m", 1000.5),
        ("2*pi/3", "rad", 2 * math.pi / 3), ("2π", "rad", 2 * math.pi),
        ("30 deg", "rad", math.pi / 6), ("30°", "rad", math.pi / 6), ("1 turn", "rad", 2 * math.pi),
        ("5 km/h", "m/s", 5 / 3.6), ("36 kmh", "m/s", 10.0), ("1e3 g", "kg", 1.0), ("1 t", "kg", 1000.0),
        ("60 rpm", "rad/s", 2 * math.pi), ("2 Hz", "rad/s", 2.0), ("3 kN/m", "N/m", 3000.0),
        ("1 J/m^2", "N/m", 1.0), ("2 kg m²", "kg m^2", 2.0), ("2 kg·m²", "kg m^2", 2.0),
        ("5 N s/m", "N s/m", 5.0), ("5 N*s/m", "N s/m", 5.0), ("1 m + 20 cm", "m", 1.2),
        ("(1 + 2) * 3", "1", 9.0), ("2^3", "1", 8.0), ("2**3", "1", 8.0), ("-2^2", "1", -4.0),
        ("sqrt(2)", "1", math.sqrt(2)), ("sin(30 deg)", "1", 0.5), ("30 %", "1", 0.3), ("\u22123", "m", -3.0),
        ("2 \u00d7 3", "1", 6.0), ("2 m", "m", 2.0), ("  7  ", "s", 7.0), ("1/2 m", "m", 0.5),
        ("e", "1", math.e), ("9.81 m/s^2 * 2 s", "m/s", 19.62), ("3(2)", "1", 6.0), ("1 min", "s", 60.0),
        ("1+1.5*sin(60 deg)", "m", 1 + 0.75 * math.sqrt(3)), 
        ("2 kg * cos(0 deg)", "kg", 2.0),
    ],
)  # fmt: skip
def test_what_a_text_stands_for(text: str, unit: str, value: float) -> None:
    assert evaluate(text, unit) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "unit", "words"),
    [
        ("", "m", "a number is needed"), ("  ", "m", "a number is needed"),
        ("3 kg", "m", "'3 kg' is in kg; this is in m"), ("3 m", "1", "'3 m' is in m; this is in no unit"),
        ("30 deg", "m", "'30 deg' is in no unit; this is in m"), 
        ("1 + 30 deg", "m", "is in no unit"), ("1 m + 2 kg", "m", "cannot be added"),
        ("5 parsec", "m", "'parsec' is no unit that is known"), ("1/0", "m", "is not finite"),
        ("1e999", "m", "is not finite"), ("9^9^9^9", "m", ""), ("sin(2 m)", "1", "takes a pure number"),
        ("m^0.5", "m", "broken power"), ("sqrt(-1)", "1", "is no number"),
        ("(-1)^0.5", "1", "no real number"),
        ("1 +", "m", "is no number"), ("x = 2", "m", "is no number"), ("True", "1", "is no number"),
        ("1j", "1", ""), ("'1'", "1", "is no number"), ("__import__('os')", "1", ""), ("[1]", "1", ""),
        ("lambda: 1", "1", ""), ("m.real", "m", ""), ("1 if 1 else 2", "1", ""), ("2" * 201, "m", "too long"),
        ("1,000 kg", "kg", "thousands or a decimal comma"), ("12,345,678", "1", "thousands"),
        ("1,500", "m", "thousands"),
        ("10,000.5", "m", ""), ("2e", "1", "exponent without digits"),
        ("2.5e kg", "kg", "exponent without digits"),
        ("2E*3", "1", "exponent"), ("1\n\x1b[2J\u202e", "m", r"'1\n\x1b[2J\u202e' is no number"),
        ("2e+", "1", "is no number"),
        ("(" * 150, "m", ""), ("nan", "m", ""), ("inf", "m", ""), ("1 < 2", "1", ""),
    ],
)  # fmt: skip
def test_what_is_refused_and_in_which_words(text: str, unit: str, words: str) -> None:
    with pytest.raises(InvalidText) as refused:
        evaluate(text, unit)
    message = str(refused.value)
    assert words in message and message and "\n" not in message and len(message) < 200


def checked(text: str, unit: str) -> None:
    """Check that a text is a finite number or refused in one line."""
    try:
        value = evaluate(text, unit)
    except InvalidText as error:
        assert str(error) and str(error).isprintable()
    else:
        assert type(value) is float and math.isfinite(value)


WORDS = (
    "1 2.5 1e3 1e308 0 . , m kg s deg ° % km/h N µm pi π e sqrt sin exp log ( ) + - * / ^ ** ² ⁻ ³ · _ j 0x"
)
SIGNS = "if or is ' \\ # = : [ {"
TOKENS = st.sampled_from([*WORDS.split(), *SIGNS.split(), "9" * 30, " ", "\u00d7", "\u2212", "\n", "\0"])


@given(st.text(max_size=220), st.sampled_from(UNITS))
@example("\\d'\\d'", "1")
@example("\udce9", "m")
@example("1_0or 2", "1")
def test_any_text_is_a_finite_number_or_refused(text: str, unit: str) -> None:
    checked(text, unit)


@given(st.lists(TOKENS, max_size=60).map("".join), st.sampled_from(UNITS))
def test_any_pieces_of_formulas_are_a_finite_number_or_refused(text: str, unit: str) -> None:
    checked(text, unit)


@given(st.floats(allow_nan=False, allow_infinity=False), st.sampled_from(UNITS))
def test_every_number_as_python_writes_it_is_itself(value: float, unit: str) -> None:
    assert evaluate(repr(value), unit) == value


def test_the_unit_of_every_field_is_known() -> None:
    fields = [spec for kind in COMPONENTS.values() for spec in kind.FIELDS]
    fields += [*PhysicsConfig.FIELDS, *SimulationConfig.FIELDS]
    units = {spec.unit for spec in fields}
    assert len(units) > 8
    for unit in units - {"", "1"}:
        assert evaluate(f"3*({unit})", unit) == pytest.approx(3.0, rel=1e-15), unit
