"""``python -m physicslab`` is the installed command, and the script of archives and frozen programs."""

import sys
from multiprocessing import freeze_support

from physicslab.commands.interrupts import INTERRUPTED, interrupts_kept


def run() -> int:
    """Run the command line and return the exit status."""
    try:
        with interrupts_kept():
            from physicslab.cli import main  # which takes a while, in which Ctrl+C may come

            return main()
    except KeyboardInterrupt:
        print("physicslab: interrupted", file=sys.stderr)
        return INTERRUPTED


if __name__ == "__main__":
    freeze_support()  # a frozen program is also what its worker processes run
    sys.exit(run())
