"""The files that were opened or saved last."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

__all__ = ["RecentFiles"]

_LIMIT = 10
"""How many are kept."""


class RecentFiles:
    """Files that were opened or saved, the last one first; each is there once.

    Parameters
    ----------
    paths : iterable of path
        Those of earlier sessions.

    Attributes
    ----------
    paths : list of path
        All that are kept, gone or not: a file of a disk that is not there now may be there again.
    """

    def __init__(self, paths: Iterable[Path] = ()) -> None:
        self.paths = list(dict.fromkeys(paths))[:_LIMIT]

    def note(self, path: Path) -> None:
        """Put a file first."""
        path = path.absolute()
        self.paths = [path, *(other for other in self.paths if other != path)][:_LIMIT]

    @property
    def there(self) -> list[Path]:
        """Those that can be found now."""
        return [path for path in self.paths if _is_there(path)]


def _is_there(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False
