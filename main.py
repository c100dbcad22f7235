# /// script
# requires-python = ">=3.12"
# dependencies = ["physicslab[window]"]
#
# [tool.uv.sources]
# physicslab = { path = ".", editable = true }
# ///
"""PhysicsLab: ``python main.py`` opens the sandbox; ``python main.py --help`` says what else there is."""

import sys

REMEDY = """'uv run main.py' fetches what is needed, and so does 'python -m pip install ".[window]"' once"""
USAGE = 2


def run() -> int:
    """Run the program and return the exit status; where a package is missing, say in one line what to do."""
    if sys.version_info < (3, 12):  # noqa: UP036 - where it is started by hand nothing has looked
        found = ".".join(map(str, sys.version_info[:2]))
        print(f"physicslab: needs Python 3.12 or later, and this is {found}: {REMEDY}", file=sys.stderr)
        return USAGE
    try:
        from physicslab.__main__ import run as run_command

        return run_command()
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package in ("", "physicslab"):
            raise
        print(f"physicslab: the package {package} is not installed: {REMEDY}", file=sys.stderr)
        return USAGE


if __name__ == "__main__":
    sys.exit(run())
