"""The command that starts this program again, however it was installed."""

import sys


def own_command(*arguments: str) -> tuple[str, ...]:
    """Return the command of this program with these arguments, to be run in another process.

    A frozen program is itself the command; ``-m`` would open its window. A zip archive is named, as Python
    finds the package nowhere else.
    """
    if getattr(sys, "frozen", False):
        return sys.executable, *arguments
    archive = getattr(sys.modules[__name__].__loader__, "archive", None)
    return (sys.executable, *((archive,) if archive else ("-m", "physicslab")), *arguments)
