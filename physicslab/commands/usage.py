"""The options of each command: a function for each, whose docstring is the help.

Numbers are refused with the allowed range; options that several commands have are declared by ``add_...``.
Nothing here imports physics: help is written and bad usage is refused without waiting for it.
"""

import math
from argparse import SUPPRESS, ArgumentParser, ArgumentTypeError
from collections.abc import Callable
from pathlib import Path

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


def add_assignments(parser: ArgumentParser) -> None:
    """Declare the option ``--set``, which may be given any number of times."""
    words = (
        "set a field before the run: a number in SI units or with a unit of its own (2 kg, 30 deg, 5 km/h), "
        "[x, y], [[x, y], ...], true, false, null or a word; of the laws, physics.field or simulation.field; "
        "repeat it for more fields"
    )
    parser.add_argument("--set", metavar="ID.Component.field=VALUE", action="append", default=[], help=words)


def add_budget(parser: ArgumentParser) -> None:
    """Declare the wall-clock time after which a command stops."""
    budget = "stop after so many seconds of wall clock, compiling left out: exit 1, with the results so far"
    parser.add_argument("--at-most", metavar="SECONDS", type=positive_duration, help=budget)


def add_language(parser: ArgumentParser) -> None:
    """Declare in which language a lesson is."""
    words = "of a lesson that has it, as de"
    parser.add_argument("--language", metavar="CODE", type=language_code, help=words)


def add_lab_arguments(parser: ArgumentParser, kind: str, what: str, plot: str = "") -> None:
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


def _read[N: (int, float)](kind: Callable[[str], N], text: str, otherwise: N) -> N:
    """Return the number that a text says, or another where it says none."""
    try:
        return kind(text)
    except ValueError:
        return otherwise


def _seconds(text: str, least: float, range_: str) -> float:
    seconds = _read(float, text, math.nan)
    if not least <= seconds < math.inf:
        raise ArgumentTypeError(f"{text!r}: must be a finite number {range_} s")
    return seconds


def _whole(text: str, least: int) -> int:
    number = _read(int, text, least - 1)
    if not least <= number <= STEP_LIMIT:
        raise ArgumentTypeError(f"{text!r}: must be a whole number >= {least}, at most {STEP_LIMIT:g}")
    return number


def language_code(text: str) -> str:
    """Return the code of a language, which is not empty."""
    if not text:
        raise ArgumentTypeError("'': must be the code of a language, as de")
    return text


def rate(text: str) -> float:
    """Return how many pictures are shown a second."""
    number = _read(float, text, 0.0)
    if not 0.0 < number <= _MAX_RATE:
        raise ArgumentTypeError(f"{text!r}: must be a number > 0, at most {_MAX_RATE:g} a second")
    return number


def film_size(text: str) -> tuple[int, int]:
    """Return width and height [px] of ``960x540``."""
    try:
        width, height = map(int, text.lower().split("x"))
    except ValueError:
        width = height = 0
    if not all(_SMALLEST_PX <= number <= _LARGEST_PX for number in (width, height)):
        allowed = f"WIDTHxHEIGHT, each from {_SMALLEST_PX} to {_LARGEST_PX} px"
        raise ArgumentTypeError(f"{text!r}: must be {allowed}")
    return width, height


def series(text: str) -> tuple[int, int]:
    """Return a seed and the number of a scene of its series, of ``S`` or ``S:K``."""
    seed, colon, first = text.partition(":")
    if not (seed.isdecimal() and (first.isdecimal() or not colon)):
        raise ArgumentTypeError(f"{text!r}: must be S or S:K, whole numbers from 0 on")
    return int(seed), int(first or 0)


def run(parser: ArgumentParser) -> None:
    """Run a scene without a window, and say what came of it."""
    from physicslab.ecs.config import CONTACTS, INTEGRATORS  # numpy with them, for this help alone

    add = parser.add_argument
    add("scene", metavar="SCENE", help="a built-in scene's name, or a path")
    length = parser.add_mutually_exclusive_group()
    seconds = "how long, in the scene's time (%(default)g); the last step may be shorter"
    length.add_argument("--seconds", metavar="T", type=duration, default=10.0, help=seconds)
    length.add_argument("--steps", metavar="N", type=count, help="how long, in steps")
    add("--dt", metavar="S", type=positive_duration, help="length of a step, in place of the scene's")
    add("--substeps", metavar="N", type=positive_count, help="parts of a step, in place of the scene's")
    add("--integrator", metavar="NAME", help=f"one of {', '.join(INTEGRATORS)}")
    add("--contacts", metavar="NAME", help=f"one of {', '.join(CONTACTS)}")
    add_assignments(parser)
    add_budget(parser)
    add("--json", metavar="FILE", help="write energies, momenta, costs and the final state (- for stdout)")
    table = "write every body's state with all energies and momenta, at the start and after each step (-)"
    add("--csv", metavar="FILE", help=table)
    sheet = "with --csv or --ledger: for Excel where numbers have commas: semicolons between cells"
    add("--csv-for", metavar="PROGRAM", choices=["excel"], help=f"{sheet} (excel)")
    spacing = "with --csv: rows at most so often, in the scene's time; those of the start and the end always"
    add("--every", metavar="S", type=positive_duration, help=spacing)
    words = "compute the run in other ways too: how many digits of motion and energy agree, and until when"
    add("--trust", action="store_true", help=words)
    impacts = "write every impact of the run: time, place, speeds before and after, energy lost (-)"
    add("--ledger", metavar="FILE", help=impacts)
    add("--png", metavar="FILE", help="draw the final state, without a window (- for stdout)")


def replay(parser: ArgumentParser) -> None:
    """Play a recording without a window, and say where its bits first differ."""
    parser.add_argument("file", metavar="FILE", help="a recording, as the window or History.save writes it")
    add_budget(parser)
    parser.add_argument("--json", metavar="FILE", help="write the result (- for stdout)")


def accuracy(parser: ArgumentParser) -> None:
    """Measure error against run time, for every integrator, on problems with known answers or on a scene."""
    what = (
        "a problem, a contact case, a family of them, a built-in scene or a scene file; every problem and "
        "case, sparsely, if none"
    )
    add_lab_arguments(parser, "problem", what, "draw a work-precision plot of each problem, as PNG")
    seconds = "how long scenes are run, in their time (%(default)g)"
    parser.add_argument("--seconds", metavar="T", type=positive_duration, default=5.0, help=seconds)
    words = (
        "print the estimate of the error of each problem, as run --trust makes it, beside its true error, "
        "and of random scenes how often it is honest; of a scene, how many digits can be relied on from its "
        "start to some moments"
    )
    parser.add_argument("--trust", action="store_true", help=words)
    parser.epilog = (
        "--list names problems and contact cases with their families; contacts: all cases of contact, by "
        "other engines as well where installed"
    )


def stability(parser: ArgumentParser) -> None:
    """Run stiff, extreme and hostile cases: which pass, which fall short."""
    add_lab_arguments(parser, "case", "a case, or a group of them; all if none")
    parser.epilog = "--list names the cases with their groups"


def bench(parser: ArgumentParser) -> None:
    """Measure speed: how long a step takes and how that grows, alone or beside other engines."""
    what = (
        "a scene of the benchmark, a group of them, a built-in scene or a scene file; if none, all but the "
        "joints and some sizes of piles and gases"
    )
    add_lab_arguments(parser, "scene", what, "draw growth and ratios, as bench.png")
    peers = (
        "time pymunk, Box2D 2.3 and Box2D 3 on the same scenes, in turn (needs the dependency group peers); "
        "those of thousands of bodies only where they are named"
    )
    parser.add_argument("--peers", action="store_true", help=peers)
    built = "time Box2D 3 in C as well, compiled with cc, or CC, from this checkout of it (3.2 or later)"
    parser.add_argument("--box2d", metavar="DIR", type=Path, help=built)
    random = "time N random scenes instead; list what the slowest share"
    parser.add_argument("--random", metavar="N", type=positive_count, help=random)
    alike = "time whole runs, others also in steps so short that they are as right; --random does so too"
    parser.add_argument("--like-quality", action="store_true", help=alike)
    words = "their series (0); S:K begins at its K-th"
    parser.add_argument("--seed", metavar="S", type=series, default=(0, 0), help=words)
    parser.epilog = (
        "--list names the scenes with their groups; unused: what a step costs more for systems that the "
        "scene does not use; added: for one thing more far from a crowd; memory: bytes a body. dt is 1/60 s, "
        "4 substeps, one thread, nothing sleeps; pymunk takes 10 iterations with a slop of 5 mm, Box2D 2.3 8 "
        "and 3. The exit status is 0 whether targets are met or not, and 1 if a run diverges."
    )


def scenes(parser: ArgumentParser) -> None:
    """List the built-in scenes: name, number of bodies and description."""
    parser.add_argument("--json", metavar="FILE", help="write the list as JSON (- for stdout)")


def lesson(parser: ArgumentParser) -> None:
    """Say what a lesson is, check its theories against the engine, or print it for pupils to write on."""
    parser.add_argument(
        "lesson", metavar="NAME|FILE", nargs="?", help="a lesson; without one, all that come with the program"
    )
    parser.add_argument("--check", action="store_true", help="compare every theory with the engine: a table")
    add_language(parser)
    parser.add_argument("--worksheet", metavar="FILE", help="write a page to print, without solutions")
    words = "write one page for a browser without a network: with its runs, and with its solutions in it"
    parser.add_argument("--page", metavar="FILE", help=words)
    words = "say on stderr how far the page is, though that is no terminal"
    parser.add_argument("--progress", action="store_true", help=words)
    parser.add_argument("--json", metavar="FILE", help="write what was found as JSON (- for stdout)")


def grade(parser: ArgumentParser) -> None:
    """Grade the answers of a learner to a lesson: a report that a teacher can read."""
    parser.add_argument("lesson", metavar="LESSON", help="a lesson's name, or its file")
    parser.add_argument("answers", metavar="ANSWERS.json", help="answers as physicslab-answers/1")
    add_language(parser)
    parser.add_argument("--json", metavar="FILE", help="write the report as JSON (- for stdout)")


def import_(parser: ArgumentParser) -> None:
    """Turn a world of KDE Step into a scene file, and name what it leaves out."""
    parser.add_argument("file", metavar="FILE", help="a world of KDE Step, FILE.step")
    out = "the scene file, which must not be there yet (- for stdout); FILE.json beside FILE.step if left out"
    parser.add_argument("--out", metavar="SCENE", help=out)


def export(parser: ArgumentParser) -> None:
    """Export a run as a page of HTML that plays it in any browser, or as a film (GIF, MP4)."""
    add = parser.add_argument
    add("scene", metavar="SCENE", help="a built-in scene's name, or a path")
    kind = parser.add_mutually_exclusive_group(required=True).add_argument
    kind("--html", metavar="FILE", help="one page that plays the run without a network (- for stdout)")
    kind("--gif", metavar="FILE", help="a film that any browser and any mail shows")
    kind("--mp4", metavar="FILE", help="a film in H.264; needs ffmpeg, which the extra video brings")
    seconds = "how long, in the scene's time (%(default)g); the last step may be shorter"
    add("--seconds", metavar="T", type=positive_duration, default=10.0, help=seconds)
    spacing = (
        "time between two instants (1/60, in a film or with --vary 1/30; every step where steps are longer)"
    )
    add("--every", metavar="S", type=positive_duration, help=spacing)
    words = "pictures of a film a second, where it is not to play as fast as the run (a GIF has 50 at most)"
    add("--fps", metavar="N", type=rate, help=words)
    add("--size", metavar="WxH", type=film_size, help="width and height of a film [px] (960x540)")
    add_budget(parser)
    add_assignments(parser)
    words = (
        "one run for each of COUNT values from START to STOP, between which a slider of the page chooses; of "
        f"a vector field.x or field.y; up to {MOST_SLIDERS} of them, of up to {MOST_VALUES} values each"
    )
    add("--vary", metavar=VARY_FORM, action="append", default=[], help=words)
    words = "write to stderr how far it is, terminal or not"
    add("--progress", action="store_true", help=words)
    parser.epilog = (
        f"A page holds bodies times instants, of all runs, of at most {POSES:,}, positions to 7 digits. A "
        "scene of 20 bodies takes less than 300 kB for 10 s. A film with --every 0.02 --fps 25 plays at half "
        "the speed."
    )


def kernels(parser: ArgumentParser) -> None:
    """Compile the physics for this computer ahead of time, or share it with others of its kind."""
    parser.add_argument(
        "action", nargs="?", choices=("export", "import", "wheel"), metavar="ACTION",
        help="export: compile all and write them to FILE; import: take them from FILE in place of compiling; "
        "wheel: write them as a package to be installed beside physicslab, into the folder FILE; none of "
        "these: compile all and keep them",
    )  # fmt: skip
    words = "export, wheel: for any processor of the kind, in place of just this one; the same bits (native)"
    parser.add_argument("--cpu", choices=("native", "x86-64-v3", "x86-64-v2"), default="native", help=words)
    parser.add_argument("file", metavar="FILE", nargs="?", help="an archive of compiled kernels, or a folder")
    parser.add_argument("--worker", action="store_true", help=SUPPRESS)  # what Warmup starts


def sweep(parser: ArgumentParser) -> None:
    """Run a scene many times with other values, on all processors, and keep what is measured of each run."""
    add = parser.add_argument
    add("scene", metavar="SCENE", help="a built-in scene's name, or a path")
    words = (
        "a run for each of COUNT values from START to STOP, with those of other options in every combination"
    )
    add("--vary", metavar=VARY_FORM, action="append", default=[], help=words)
    words = "a number drawn for each sample: uniform:FROM:TO, normal:MEAN:DEVIATION or sobol:FROM:TO"
    add("--sample", metavar=SAMPLE_FORM, action="append", default=[], help=words)
    add("--samples", metavar="N", type=positive_count, help="how many samples, for each combination")
    add("--seed", metavar="N", type=count, help="by which they are drawn (0)")
    words = "what is kept of a run, [NAME=]EXPRESSION: ball.x, max(ball.y), first_impact.time, numerical, ..."
    add("--measure", metavar="EXPR", action="append", default=[], help=words)
    add("--seconds", metavar="T", type=positive_duration, default=10.0,
        help="how long a run is, in the scene's time (%(default)g)")  # fmt: skip
    add("--until", metavar="CONDITION", help="a run ends when this begins to hold: 'ball.x >= 8 m'")
    add("--out", metavar="FILE", help="where the rows go: .npz, .csv or .parquet; else a summary on stdout")
    words = "a picture of the first measure over the two fields that --vary names (extra: plot)"
    add("--map", metavar="FILE.png", help=words)
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--workers", metavar="N", type=positive_count, help="processes (one a processor)")
    where.add_argument("--dask", metavar="ADDRESS", help="the scheduler of a Dask cluster: tcp://host:8786")
    add("--open", metavar="ROW", type=count, help="make no run; open the window on the scene of this row")
    add_assignments(parser)


def schema(parser: ArgumentParser) -> None:
    """Write the JSON Schema of scene files, by which editors complete and check them."""
    parser.add_argument("--out", metavar="FILE", default="-", help="where it goes (stdout)")


COMMANDS: dict[str, Callable[[ArgumentParser], None]] = {
    declare.__name__.removesuffix("_"): declare
    for declare in (
        run, replay, accuracy, stability, bench, scenes, lesson, grade, import_, export, kernels, sweep,
        schema,
    )
}  # fmt: skip
"""Every command, by its name."""
