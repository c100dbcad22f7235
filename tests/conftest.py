"""What every test module shares."""

import atexit
import os
import shutil
import tempfile

from hypothesis import settings

# Before anything imports pygame: tests draw, and open windows that nobody sees.
os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["SDL_AUDIODRIVER"] = "dummy"
# No test finds what a real window has left, or leaves anything there.
_STATE = tempfile.mkdtemp(prefix="physicslab-tests-")
atexit.register(shutil.rmtree, _STATE, ignore_errors=True)
os.environ["XDG_STATE_HOME"] = os.environ["LOCALAPPDATA"] = _STATE
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")

# No deadline: the first example of a test may load kernels.
settings.register_profile("physicslab", deadline=None, max_examples=40)
# All that is fuzzed, once: pytest tests/test_fuzz_*.py --hypothesis-profile=thorough (10,000 examples)
settings.register_profile("thorough", deadline=None, max_examples=2500)
settings.load_profile("physicslab")
