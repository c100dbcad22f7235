"""Arguments of the commands: numbers, each refused with the allowed range, and options that several have."""

import argparse
import math

STEP_LIMIT = 10**15
"""More than any run will do; beyond it, times could no longer be counted exactly."""
MOST_SLIDERS, MOST_VALUES = 2, 40
"""How many quantities a page may vary, as it has so many sliders, and how many values each may have."""
POSES = 2_000_000
"""Poses that a page may hold, bodies times instants: some 30 MB, which a browser unpacks within seconds."""
SAMPLE_FORM = "ID.Component.field=LAW:A:B"
VARY_FORM = "ID.Component.field=START:STOP:COUNT"
_MAX_RATE = 1000.0
_SMALLEST_PX, _LARGEST_PX = 16, 4096


def add_assignments(parser: argparse.ArgumentParser) -> None:
    """Declare the option ``--set``, which may be given any number of times."""
    words = (
        "set a field before the run: a number in SI units or with a unit of its own (2 kg, 30 deg, 5 km/h), "
        "[x, y], [[x, y], ...], true, false, null or a word; of the laws, physics.field or simulation.field; "
        "repeat it for more fields"
    )
    parser.add_argument("--set", metavar="ID.Component.field=VALUE", action="append", default=[], help=words)


def add_budget(parser: argparse.ArgumentParser) -> None:
    """Declare the wall-clock time after which a command stops."""
    budget = "stop after so many seconds of wall clock, compiling left out: exit 1, with the results so far"
    parser.add_argument("--at-most", metavar="SECONDS", type=positive_duration, help=budget)


def add_lab_arguments(parser: argparse.ArgumentParser, kind: str, what: str, plot: str = "") -> None:
    """Declare the arguments of every lab: names, of what ``kind`` and ``what`` they may be, and outputs.

    Parameters
    ----------
    plot : str
        What ``--plot`` draws; there is no such option where it is empty.
    """
    parser.add_argument("names", metavar=kind.upper(), nargs="*", help=what)
    parser.add_argument("--list", action="store_true", help=f"print the name of every {kind} and stop")
    parser.add_argument("--json", metavar="FILE", help="write everything that was measured (- for stdout)")
    words = "write to stderr how far it is, where that is no terminal too"
    parser.add_argument("--progress", action="store_true", help=words)
    if plot:
        parser.add_argument("--plot", metavar="DIR", help=plot)


def duration(text: str) -> float:
    """Return a time [s] that is finite and not negative."""
    return _seconds(text, 0.0, ">= 0")


def positive_duration(text: str) -> float:
    """Return a time [s] that is finite and greater than 0."""
    return _seconds(text, math.ulp(0.0), "> 0")


def count(text: str) -> int:
    """Return a whole number that is not negative."""
    return _whole(text, 0)


def positive_count(text: str) -> int:
    """Return a whole number of at least 1."""
    return _whole(text, 1)


def _seconds(text: str, least: float, range_: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not least <= seconds < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r}: must be a finite number {range_} s")
    return seconds


def _whole(text: str, least: int) -> int:
    try:
        number = int(text)
    except ValueError:
        number = least - 1
    if not least <= number <= STEP_LIMIT:
        raise argparse.ArgumentTypeError(
            f"{text!r}: must be a whole number >= {least}, at most {STEP_LIMIT:g}"
        )
    return number


def rate(text: str) -> float:
    """Return how many pictures are shown a second."""
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0.0 < number <= _MAX_RATE:
        raise argparse.ArgumentTypeError(f"{text!r}: must be a number > 0, at most {_MAX_RATE:g} a second")
    return number


def film_size(text: str) -> tuple[int, int]:
    """Return width and height [px] of ``960x540``."""
    try:
        width, height = map(int, text.lower().split("x"))
    except ValueError:
        width = height = 0
    if not all(_SMALLEST_PX <= number <= _LARGEST_PX for number in (width, height)):
        allowed = f"WIDTHxHEIGHT, each from {_SMALLEST_PX} to {_LARGEST_PX} px"
        raise argparse.ArgumentTypeError(f"{text!r}: must be {allowed}")
    return width, height


def series(text: str) -> tuple[int, int]:
    """Return a seed and the number of a scene of its series, of ``S`` or ``S:K``."""
    seed, colon, first = text.partition(":")
    if not (seed.isdecimal() and (first.isdecimal() or not colon)):
        raise argparse.ArgumentTypeError(f"{text!r}: must be S or S:K, whole numbers from 0 on")
    return int(seed), int(first or 0)
