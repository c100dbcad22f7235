"""The end of a command that fails."""

FAILED = 1
"""Exit status of a run that failed."""
USAGE = 2
"""Exit status of bad usage, or of a bad scene."""


class CommandError(Exception):
    """A command cannot go on; the message is one line for people.

    Attributes
    ----------
    status : int
        The exit status.
    """

    def __init__(self, message: str, status: int = USAGE) -> None:
        super().__init__(message)
        self.status = status
