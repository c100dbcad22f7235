"""Physics runs where there is no screen: importing it imports no pygame."""

import subprocess
import sys

IMPORT_ALL = """
import importlib, pkgutil, sys
import physicslab

window = ["desktop.app", "desktop.compiling", "desktop.sandbox", "desktop.session_window"]
window += ["desktop.preferences", "desktop.screen_reader", "desktop.timed_window", "view"]
names = [module.name for module in pkgutil.walk_packages(physicslab.__path__, "physicslab.", onerror=print)]
for name in names:
    if not name.removeprefix("physicslab.").startswith(tuple(window)):
        importlib.import_module(name)
print(len(names), sorted({name.partition(".")[0] for name in sys.modules} & {"pygame", "pygame_gui"}))
"""


def test_nothing_but_the_window_imports_pygame() -> None:
    done = subprocess.run([sys.executable, "-c", IMPORT_ALL], capture_output=True, text=True, check=True)
    count, found = done.stdout.split(maxsplit=1)
    assert int(count) > 40
    assert found.strip() == "[]"
