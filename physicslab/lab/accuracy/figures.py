"""The figures of the reference problems: decimal digits, as ``problems.json`` keeps them."""

import json
from functools import cache
from importlib.resources import files
from typing import Any


@cache
def _document() -> dict[str, Any]:
    text = files("physicslab.lab.accuracy").joinpath("problems.json").read_text(encoding="utf-8")
    problems: dict[str, Any] = json.loads(text)["problems"]
    return problems


def record(problem: str) -> dict[str, Any]:
    """Return all that is on record of a problem: what is given, the reference, and how it was found."""
    found: dict[str, Any] = _document()[problem]
    return found


def digits(problem: str, *keys: str) -> str:
    """Return a figure of a problem's reference as the digits on record.

    >>> digits("projectile", "T")
    '3.531194306970188162135'
    """
    found: Any = record(problem)["reference"]
    for key in keys:
        found = found[key]
    if not isinstance(found, str):
        raise KeyError(f"{problem}: {' '.join(keys)} is no figure")
    return found


def number(problem: str, *keys: str) -> float:
    """Return a figure of a problem's reference, rounded once: the nearest float."""
    return float(digits(problem, *keys))
