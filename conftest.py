"""What all tests share: those of the tests' folder and the examples of modules and documents."""

from __future__ import annotations

import atexit
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

# Before anything imports pygame: tests draw, and open windows that are not seen.
os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["SDL_AUDIODRIVER"] = "dummy"
# No test finds what a real window has left, or leaves anything there; each worker has a place of its own.
_STATE = tempfile.mkdtemp(prefix="physicslab-tests-")
atexit.register(shutil.rmtree, _STATE, ignore_errors=True)
os.environ["XDG_STATE_HOME"] = os.environ["LOCALAPPDATA"] = _STATE
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
if sys.dont_write_bytecode:
    # As in many containers: no bytecode beside the sources. Tests start a hundred processes, and each would
    # parse all of numba: 1.2 s of processor time instead of 0.35. It is kept with pytest's own cache.
    sys.dont_write_bytecode = False
    sys.pycache_prefix = str(Path(__file__).parent / ".pytest_cache" / "bytecode")
    os.environ["PYTHONPYCACHEPREFIX"] = sys.pycache_prefix
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# No deadline: the first example of a test may load kernels.
settings.register_profile("physicslab", deadline=None, max_examples=40)
# All that is fuzzed, 10,000 examples: pytest -m "" tests/test_fuzz_*.py --hypothesis-profile=thorough
settings.register_profile("thorough", deadline=None, max_examples=2500)
settings.load_profile("physicslab")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare how long the longest test of the time machine is."""
    words = "random commands that a slow test of tests/test_history.py makes and takes back (10,000)"
    parser.addoption("--commands", metavar="N", type=int, default=10_000, help=words)


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


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with what mostly waits for a window: it fills no processor, and would be late at the end."""
    items.sort(key=lambda item: "screen" not in getattr(item, "fixturenames", ()))


@pytest.fixture(autouse=True)
def _components_of_its_own() -> Iterator[None]:
    """Let a test or an example define components that are gone after it, under any name."""
    from physicslab.ecs.component import local_components

    with local_components():
        yield
