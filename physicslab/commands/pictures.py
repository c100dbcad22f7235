"""Destinations of a command's pictures."""

from __future__ import annotations

import importlib.util
from pathlib import Path

from physicslab.commands.command_error import CommandError
from physicslab.commands.output import Output
from physicslab.files.checks import shown

__all__ = ["picture_directory"]


def picture_directory(path: str, example: str) -> Path:
    """Return where pictures go, made if it was not there; refuse it if nothing can draw or write them.

    Parameters
    ----------
    path : str
        What the user named with ``--plot``.
    example : str
        A name that a picture may have, to try whether files can be written there.

    Raises
    ------
    CommandError
        If it cannot be written, or there is no matplotlib.
    """
    if importlib.util.find_spec("matplotlib") is None:
        raise CommandError("--plot: needs matplotlib, which is not installed: pip install 'physicslab[plot]'")
    directory = Path(path)
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
        raise CommandError(f"--plot {shown(path)}: cannot be written: {reason}") from error
    Output("--plot", str(directory / example))  # whether files can be written there
    return directory
