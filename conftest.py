"""What all tests share: those of the tests' folder and the examples of modules and documents."""

from __future__ import annotations

import atexit
import gc
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Generator, Iterator
from pathlib import Path

import pytest
from _pytest.doctest import DoctestModule
from hypothesis import settings

# Before anything imports pygame: tests draw, and open windows that are not seen.
os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["SDL_AUDIODRIVER"] = "dummy"
# No test finds what a real window has left, or leaves anything there; each worker has a place of its own.
_STATE = tempfile.mkdtemp(prefix="physicslab-tests-")
atexit.register(shutil.rmtree, _STATE, ignore_errors=True)
os.environ["XDG_STATE_HOME"] = os.environ["LOCALAPPDATA"] = _STATE
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ.setdefault("PHYSICSLAB_INTERPRET", "0")  # what is not compiled yet is, before it runs
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # In the background of a script: programs that tests interrupt would go on until the time limit.
    signal.signal(signal.SIGINT, signal.default_int_handler)
if sys.dont_write_bytecode:
    # As in many containers: no bytecode beside the sources. Tests start a hundred processes, and each would
    # parse all of numba: 1.2 s of processor time instead of 0.35. It is kept with pytest's own cache.
    sys.dont_write_bytecode = False
    sys.pycache_prefix = str(Path(__file__).parent / ".pytest_cache" / "bytecode")
    os.environ["PYTHONPYCACHEPREFIX"] = sys.pycache_prefix
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

_BEGUN = pytest.StashKey[float]()
_COSTS: dict[str, float] = {}
# No deadline: the first example of a test may load kernels.
settings.register_profile("physicslab", deadline=None, max_examples=40)
# What is fuzzed, by hand and by .ci/run: pytest -m fuzz --fuzz thorough
settings.register_profile("thorough", deadline=None, max_examples=600)
settings.register_profile("medium", deadline=None, max_examples=150)
settings.load_profile("physicslab")


_COSTLY = Path(__file__).parent / "tests" / "costly.txt"
"""Tests that are slow because of what they cost, as ``pytest -m "" --costs SECONDS`` measured it."""


def _share(text: str) -> float:
    if not 0.0 < (share := float(text)) <= 1000.0:
        raise ValueError(text)
    return share


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare how many random cases are made, and that costs are measured."""
    words = "share of the random cases that slow tests make, of those that they make by themselves (1)"
    parser.addoption("--effort", metavar="SHARE", type=_share, default=1.0, help=words)
    words = f"list tests that take longer than this [s of processor time] in {_COSTLY.name}: they are slow"
    parser.addoption("--costs", metavar="SECONDS", type=float, help=words)
    words = "profile of Hypothesis for tests/test_fuzz_*.py: as many examples of each property as that says"
    parser.addoption("--fuzz", metavar="PROFILE", help=words)
    words = "folder to keep a picture of each stage in when tests/test_lessons_played.py plays the lessons"
    parser.addoption("--pictures", metavar="FOLDER", type=Path, help=words)
    words = "keep what the notebooks of docs/examples show when tests/test_notebooks.py executes them"
    parser.addoption("--renew-notebooks", action="store_true", help=words)


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """Return how many processes run the tests: one a processor for all of them, none of its own for a few.

    What is named on the command line runs in pytest's own process, where a debugger and prints work.
    """
    everything = config.args_source is pytest.Config.ArgsSource.TESTPATHS
    return os.cpu_count() or 1 if everything else 0


def pytest_sessionstart(session: pytest.Session) -> None:
    """Fill the cache of kernels before the workers start: each would compile the same ones."""
    distributed = session.config.getoption("numprocesses", 0) and not hasattr(session.config, "workerinput")
    if not distributed or session.config.option.collectonly:
        return
    from physicslab.kernels.warm import is_warm

    if not is_warm():
        print("compiling the kernels, once (a minute of processor time)", flush=True)
        subprocess.run([sys.executable, "-m", "physicslab.kernels"], stdout=subprocess.DEVNULL, check=False)


@pytest.hookimpl(wrapper=True)
def pytest_collect_file(file_path: Path) -> Generator[None, list[pytest.Collector], list[pytest.Collector]]:
    """Search for examples only in modules that have some: a search goes through all that a module imports."""
    found = yield
    if file_path.suffix != ".py" or b">>>" in file_path.read_bytes():
        return found
    return [collector for collector in found if not isinstance(collector, DoctestModule)]


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Import what is fuzzed while its profile is loaded: tests keep the one of their import."""
    profile = collector.config.getoption("--fuzz")
    if profile is None or not (isinstance(collector, pytest.Module) and is_fuzzed(collector)):
        return (yield)
    before = settings.get_current_profile_name()
    settings.load_profile(profile)
    try:
        return (yield)
    finally:
        settings.load_profile(before)


def is_fuzzed(node: pytest.Collector | pytest.Item) -> bool:
    """Whether a test, or a module of tests, makes random cases for as long as it may."""
    return node.path.name.startswith("test_fuzz_")


def pytest_collection_finish() -> None:
    """Let no search for garbage go through the modules of nine thousand tests, which stay.

    And search less often than after every 700 objects: worlds are made and left by thousands.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(5_000, 10, 10)


def _processor_time() -> float:
    """Return the processor time of this process and of those that it has waited for [s]."""
    return sum(os.times()[:4])


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Note when a test begins."""
    item.stash[_BEGUN] = _processor_time()


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item) -> None:
    """Note what a test has cost, where a worker tells the process that started it."""
    item.user_properties.append(("processor_s", _processor_time() - item.stash[_BEGUN]))


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Keep what each test has cost."""
    if report.when == "teardown":
        _COSTS[report.nodeid] = float(dict(report.user_properties).get("processor_s", 0.0))  # type: ignore[arg-type]


def pytest_sessionfinish(session: pytest.Session) -> None:
    """List the costly tests, if costs are measured; what was not run keeps its place."""
    limit = session.config.getoption("--costs")
    if limit is None or hasattr(session.config, "workerinput"):
        return
    listed = {name for name in _COSTLY.read_text(encoding="utf-8").splitlines() if name not in _COSTS}
    listed |= {name for name, cost in _COSTS.items() if cost > limit}
    _COSTLY.write_text("".join(f"{name}\n" for name in sorted(listed)), encoding="utf-8")
    print(f"\n{sum(_COSTS.values()):.0f} s of processor time, {len(listed)} tests are costly")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark what is costly as slow, and what is fuzzed, and begin with what takes longest.

    That is what mostly waits for a window, which fills no processor, and then what is fuzzed. Of a test with
    many seeds the first ones stay, as many as the effort says.
    """
    costly = set(_COSTLY.read_text(encoding="utf-8").splitlines())
    for item in items:
        if item.nodeid in costly:
            item.add_marker(pytest.mark.slow)
        if is_fuzzed(item):
            item.add_marker(pytest.mark.fuzz)
    seeded = [item for item in items if item.get_closest_marker("seeds") is not None]
    families: dict[str, list[pytest.Item]] = {}
    for item in seeded:
        families.setdefault(item.nodeid.split("[")[0], []).append(item)
    effort = config.getoption("--effort")
    left_out = {item for family in families.values() for item in family[math.ceil(len(family) * effort) :]}
    items[:] = [item for item in items if item not in left_out]
    config.hook.pytest_deselected(items=list(left_out))
    items.sort(key=lambda item: ("screen" not in getattr(item, "fixturenames", ()), not is_fuzzed(item)))


@pytest.fixture(autouse=True)
def _components_of_its_own() -> Iterator[None]:
    """Let a test or an example define components that are gone after it, under any name."""
    from physicslab.ecs.component import local_components

    with local_components():
        yield
