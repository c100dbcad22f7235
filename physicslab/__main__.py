"""``python -m physicslab`` is the installed command, and the script of archives and frozen programs."""

import sys


def run() -> int:
    """Run the command line and return the exit status."""
    try:  # whatever is imported takes a while, in which Ctrl+C may come
        from physicslab.commands.interrupts import interrupts_kept

        with interrupts_kept():
            from physicslab.cli import main

            return main()
    except KeyboardInterrupt as error:
        from physicslab.commands import tell
        from physicslab.commands.interrupts import told

        words, status = told(error)
        tell(f"physicslab: {words}")
        return status


if __name__ == "__main__":
    if getattr(sys, "frozen", False):
        from multiprocessing import freeze_support

        freeze_support()  # a frozen program is also what its worker processes run
    sys.exit(run())
