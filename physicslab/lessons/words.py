"""The words of a lesson that are the program's own, in the lesson's language."""

import re
from collections.abc import Mapping
from unicodedata import lookup

from physicslab.languages.language import Language
from physicslab.lessons.lesson import Compare, Lesson, Run
from physicslab.lessons.setup import AS_IT_IS, Case

_SIGNS = tuple(
    (re.compile(pattern), sign)
    for pattern, sign in (
        (r"\s*\bdeg\b", "°"), (r"\s*\bpercent\b", " %"), (r"\bpi\b", "π"), (r"\bsqrt\b", "√"),
        (r"\s*\*\s*", " · "), ("<=", "≤"), (">=", "≥"), ("!=", "≠"),
    )
)  # fmt: skip
_LETTERS = (
    "alpha", "beta", "gamma", "delta", "epsilon", "eta", "theta", "kappa", "mu", "nu", "rho", "sigma", "tau",
    "phi", "chi", "psi", "omega",
)  # fmt: skip
_GREEK = {name: lookup(f"GREEK SMALL LETTER {name}") for name in _LETTERS}
_GREEK["th"] = _GREEK["theta"]
_SYMBOL = re.compile(rf"(?<![\w.])({'|'.join(_GREEK)}|[A-Za-z])(\d?)(?![\w.(])")
"""A name of one letter, Greek or Latin, with an index or without."""
_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_POWER = re.compile(r"\^(-?\d+)\b")
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def kind_words(language: Language) -> dict[str, str]:
    """Return what the kinds of a lesson's parts are called."""
    return {
        "predict": language.say("Predict"), "run": language.say("Run"), "compare": language.say("Compare"),
        "explain": language.say("Explain"), "check": language.say("Check"), "recall": language.say("Recall"),
    }  # fmt: skip


def sureness_words(language: Language) -> dict[str, str]:
    """Return how sure a learner may be, by the names that answers have."""
    return {
        "guess": language.say("guess"), "unsure": language.say("unsure"), "sure": language.say("sure"),
        "certain": language.say("certain"),
    }  # fmt: skip


def about_words(language: Language, lesson: Lesson) -> str:
    """Return the line below the title of a lesson: its level, how long it takes, what it needs."""
    said = [language.say("level {level}", level=lesson.level)]
    said.append(language.say_count("{n} minute", "{n} minutes", lesson.minutes))
    said += [language.say("needs {what}", what=", ".join(lesson.needs))] if lesson.needs else []
    return " · ".join(said)


def run_words(language: Language, run: Run) -> str:
    """Return the request to make a run, with the values of its own case."""
    if not run.case.values:
        return language.say("Make the run.")
    return language.say("Make the run with {values}.", values=case_words(language, run.case, noted=False))


def compare_words(language: Language, compare: Compare) -> tuple[str, str, list[str]]:
    """Return the theory of a comparison, where it holds, and the heads of its table."""
    return (
        formula(language, f"{compare.quantity}: {compare.theory.text}"),
        language.say("holds: {when}", when=condition(language, compare.holds.text)),
        [
            language.say("case"), language.say("predicted"), language.say("by theory"),
            language.say("measured"), language.say("gap"),
        ],
    )  # fmt: skip


def formula(language: Language, text: str) -> str:
    """Return an expression as it is shown, with the signs of print.

    >>> formula(Language("de"), "2*pi*sqrt(rod/(9.81 m/s^2)) <= 0.5 s"), formula(Language("en"), "30 deg")
    ('2 · π · √(rod/(9,81 m/s²)) ≤ 0,5 s', '30°')
    >>> formula(Language("en"), "v0^2*sin(2*th)/gravity"), formula(Language("en"), "mu = m1")
    ('v₀² · sin(2 · θ)/gravity', 'μ = m₁')
    """
    for pattern, sign in _SIGNS:
        text = pattern.sub(sign, text)
    text = _SYMBOL.sub(lambda found: _GREEK.get(found[1], found[1]) + found[2].translate(_LOWERED), text)
    return language.decimal(_POWER.sub(lambda found: found[1].translate(_RAISED), text))


_SOURCE = re.compile(r"([^(]+?) \((\d{4})\)")
_AUTHORS = re.compile(r", | and ")
_TWO = 2
"""More authors than that are the first and others."""


def cited(text: str, sources: Mapping[str, str]) -> tuple[str, str]:
    """Return a text with the authors and the year in place of the keys of its sources, and these in full.

    >>> cited("So it is [doe2001].", {"doe2001": "Doe, Roe and Poe (2001), On heaps, Annals 3, 141"})
    ('So it is (Doe et al. 2001).', 'Doe, Roe and Poe (2001), On heaps, Annals 3, 141')
    """
    used = {key: words for key, words in sources.items() if f"[{key}]" in text}
    for key, words in used.items():
        if found := _SOURCE.match(words):
            authors = _AUTHORS.split(found[1])
            short = found[1] if len(authors) <= _TWO else f"{authors[0]} et al."
            text = text.replace(f"[{key}]", f"({short} {found[2]})")
    return text, "; ".join(used.values())


def condition(language: Language, text: str) -> str:
    """Return a condition as it is shown.

    >>> condition(Language("de"), "e = 1 and rub = 0.5"), condition(Language("de"), "always")
    ('e = 1 und rub = 0,5', 'immer')
    """
    if text == "always":
        return language.say("always")
    return f" {language.say('and')} ".join(formula(language, part) for part in text.split(" and "))


def unit_words(language: Language, unit: str) -> str:
    """Return a unit as it is shown, empty for a pure number."""
    return "" if unit == "1" else formula(language, unit).strip()


def measure(language: Language, number: float, unit: str, figures: int = 4) -> str:
    """Return a number and its unit."""
    return formula(language, f"{number:.{figures}g} {'' if unit == '1' else unit}".rstrip())


def case_words(language: Language, case: Case, *, noted: bool = True) -> str:
    """Return what differs in a case, and its note unless that is to be left out."""
    text = language.say("as it is") if case.text == AS_IT_IS.text else formula(language, case.text)
    return f"{text} ({case.note})" if noted and case.note else text


def with_run(run: Run, case: Case) -> Case:
    """Return a run's own case and one more as one case."""
    values = {name: value for one in (run.case, case) for name, value in one.values}
    text = "; ".join(f"{name} = {value}" for name, value in values.items()) or AS_IT_IS.text
    notes = "; ".join(one.note for one in (run.case, case) if one.note)
    return Case(text, tuple(values.items()), notes)
