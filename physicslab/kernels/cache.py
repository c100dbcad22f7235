"""Where compiled kernels are kept between runs, and which of them are still right.

numba's own cache does not see an edit in another module's callee and would return the old code. So each
module's kernels lie in a folder named after a hash of its source, of the sources of all that it imports
within this package, and of what else decides on machine code: numba, Python, the processor. An edit leaves
the folders of modules that do not depend on it as they are.

numba unpickles what lies there, so **a compiled kernel is a program that will be run**. The folder is used
only if it is this user's, closed to all others (mode 0700), and no link. Its place is the environment
variable ``PHYSICSLAB_KERNELS``, or ``physicslab/kernels`` in the user's cache folder, or, where there is no
such folder, ``physicslab-<user>/kernels`` among the temporary files; else a new temporary one that is removed
at the end of the process.
"""

from __future__ import annotations

import atexit
import contextlib
import hashlib
import inspect
import logging
import os
import platform
import re
import shutil
import stat
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite
import llvmlite.binding
import numba
import numba.core.config
from numba.core.caching import CacheImpl, UserProvidedCacheLocator

__all__ = [
    "VARIABLE", "cache_directory", "cached", "current_folders", "depends_on", "folder_of", "is_kept", "mark",
    "note_use", "platform_key", "prune", "sources_key", "use_directory",
]  # fmt: skip

VARIABLE = "PHYSICSLAB_KERNELS"
"""The environment variable that says where compiled kernels are to be kept."""
_PACKAGE = __name__.rpartition(".")[0]
_SOURCES = Path(__file__).parent
_WITHOUT_CODE = frozenset(
    f"{_PACKAGE}.{name}"
    for name in ("__main__", "archive", "budget", "cache", "interpreter", "loading", "stand_ins", "warm")
)
"""Modules that decide when kernels are compiled and where they are kept, but not on a single instruction."""
_IMPORT = re.compile(
    r"^[ \t]*(?:from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n]*)|import[ \t]+([^\n]+))", re.MULTILINE
)
_DAY = 86400.0
_UNUSED = 30 * _DAY
"""Time [s] for which what is not used is kept."""
_VERSIONS = 8
"""How many folders of one module are kept, however many were in use: those used last."""
_log = logging.getLogger(__name__)


# ---- which machine code is right ---------------------------------------------------------------------------


@cache
def _sources() -> dict[str, str]:
    """Return the source of every module of this package, by the module's name."""
    found = {}
    for path in sorted(_SOURCES.rglob("*.py")):
        parts = path.relative_to(_SOURCES).with_suffix("").parts
        found[".".join((_PACKAGE, *parts)).removesuffix(".__init__")] = path.read_text(encoding="utf-8")
    return found


def _imports(source: str) -> Iterator[str]:
    """Yield all that a source may import, as full names; some are names within modules."""
    for module, names, modules in _IMPORT.findall(source):
        if module:
            yield module
            yield from (f"{module}.{name}" for name in re.findall(r"\w+", names))
        else:
            yield from re.findall(r"[\w.]+", modules)


@cache
def depends_on(module: str) -> frozenset[str]:
    """Return the modules of this package on which a module's machine code depends, itself included."""
    sources = _sources()
    found, waiting = {_PACKAGE}, [_PACKAGE, module]
    while waiting:
        name = waiting.pop()
        found.add(name)
        waiting += {part for part in _imports(sources[name]) if part in sources} - found - _WITHOUT_CODE
    return frozenset(found)


@cache
def platform_key() -> dict[str, str]:
    """Return what else than sources decides on machine code, and on the form in which it is kept, by name."""
    settings: Any = numba.core.config
    features = settings.CPU_FEATURES
    if features is None:
        features = llvmlite.binding.get_host_cpu_features().flatten()
    return {
        "numba": numba.__version__,
        "llvmlite": llvmlite.__version__,
        "Python": f"{sys.implementation.cache_tag}{getattr(sys, 'abiflags', '')}",
        "system": f"{sys.platform} {platform.machine()}",
        "processor": settings.CPU_NAME or llvmlite.binding.get_host_cpu_name(),
        "processor features": _digest(features)[:16],
    }


def sources_key() -> str:
    """Return a hash of all that the machine code of all kernels depends on in this package."""
    sources = _sources()
    return _digest(*(f"{name}\0{sources[name]}" for name in sorted(sources.keys() - _WITHOUT_CODE)))[:16]


def _digest(*texts: str) -> str:
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()


@cache
def folder_of(module: str, path: str = "") -> str:
    """Return the name of the folder for the kernels of a module.

    Parameters
    ----------
    module : str
        Its full name.
    path : str, optional
        Its file, of a module outside this package; its kernels depend on all of this package.
    """
    if module in _sources():
        parts = [f"{name}\0{_sources()[name]}" for name in sorted(depends_on(module))]
        name = module.removeprefix(f"{_PACKAGE}.")
    else:
        parts, name = [sources_key(), Path(path).read_text(encoding="utf-8")], f"other.{Path(path).stem}"
    return f"{name}-{_digest(*platform_key().values(), *parts)[:16]}"


def current_folders() -> dict[str, str]:
    """Return the folder's name of every module of this package that may hold kernels."""
    return {module: folder_of(module) for module in _sources() if module not in _WITHOUT_CODE}


def mark() -> Path:
    """Return the file that says that every kernel of this package is kept."""
    return cache_directory() / f"complete-{_digest(*sorted(current_folders().values()))[:16]}"


# ---- where it lies -----------------------------------------------------------------------------------------

_directory: Path | None = None


def cache_directory() -> Path:
    """Return where compiled kernels are kept: a folder of this user's that nobody else can write or read."""
    global _directory
    if _directory is None:
        _directory = _first_private()
    return _directory


def use_directory(directory: Path) -> None:
    """Keep kernels in another folder, of which the caller knows that it is private.

    Kernels that are defined by then stay with the folder of before.
    """
    global _directory
    _directory = directory


def _first_private() -> Path:
    """Return the first of the folders that may be used, or a temporary one."""
    for place in _places():
        try:
            if all([_is_private(folder) for folder in place]):
                return place[-1]
        except (OSError, RuntimeError, KeyError):  # no home, or one that cannot be written to
            continue
    directory = Path(tempfile.mkdtemp(prefix="physicslab-kernels-"))  # which makes it private
    _log.warning("compiled kernels cannot be kept for the next start; this one has them in %s", directory)
    atexit.register(_remove_own, directory, os.getpid())
    return directory


def _places() -> Iterator[tuple[Path, ...]]:
    """Yield where kernels may be kept, best first: each the folders that must be private."""
    if os.environ.get(VARIABLE):
        yield (Path(os.environ[VARIABLE]),)
        return
    with contextlib.suppress(RuntimeError, KeyError):
        yield (_user_cache() / "physicslab" / "kernels",)
    shared = Path(tempfile.gettempdir()) / f"physicslab-{os.getuid() if hasattr(os, 'getuid') else 0}"
    yield shared, shared / "kernels"


def _user_cache() -> Path:
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or tempfile.gettempdir())
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")


def _is_private(folder: Path) -> bool:
    """Make a folder if it is not there; return whether it can be written, and by this user alone.

    Raises
    ------
    OSError
        If it cannot be made or written.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    with contextlib.suppress(FileExistsError):
        folder.mkdir(mode=0o700)
    status = os.lstat(folder)
    if not stat.S_ISDIR(status.st_mode):
        reason = "is a link" if stat.S_ISLNK(status.st_mode) else "is no folder"
    elif hasattr(os, "geteuid") and status.st_uid != os.geteuid():
        reason = "belongs to another user"
    elif hasattr(os, "geteuid") and stat.S_IMODE(status.st_mode) & 0o077:
        reason = f"is open to other users (mode {stat.S_IMODE(status.st_mode):o}, not 700)"
    elif not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(folder)
    else:
        return True
    _log.warning("compiled kernels in %s are not used: it %s", folder, reason)
    return False


def _remove_own(directory: Path, process: int) -> None:
    if os.getpid() == process:  # and not a process that was forked from it
        shutil.rmtree(directory, ignore_errors=True)


# ---- what numba is given -----------------------------------------------------------------------------------


class _Locator(UserProvidedCacheLocator):  # type: ignore[misc]  # numba is typed in part
    """Says to numba where a kernel is kept: by what decides on its code, and not by paths or dates."""

    def __init__(self, function: Callable[..., Any], path: str) -> None:
        self._py_file, self._lineno = path, function.__code__.co_firstlineno
        self._folder = folder_of(function.__module__, path)
        self._cache_path = str(cache_directory() / self._folder)

    def ensure_cache_path(self) -> None:
        """Make the folder; numba calls this before it writes."""
        if os.path.isdir(cache_directory()):
            os.makedirs(self._cache_path, mode=0o700, exist_ok=True)

    def get_source_stamp(self) -> str:
        """Return what must be the same for a kept kernel to be right."""
        return self._folder

    @classmethod
    def from_function(cls, function: Callable[..., Any], path: str) -> _Locator | None:
        """Return the place of a function; numba looks elsewhere for what has no file."""
        return cls(function, path) if os.path.exists(path) else None


@contextmanager
def cached() -> Iterator[None]:
    """Let what numba is given within a ``with`` block keep its code in the cache."""
    settings, before = numba.core.config, CacheImpl._locator_classes
    chosen = getattr(settings, "CACHE_LOCATOR_CLASSES", "")
    CacheImpl._locator_classes = [_Locator, *before]  # read by numba when a function is decorated
    settings.CACHE_LOCATOR_CLASSES = ""
    try:
        yield
    finally:
        CacheImpl._locator_classes = before
        settings.CACHE_LOCATOR_CLASSES = chosen


def _folder(function: Callable[..., Any]) -> Path:
    return cache_directory() / folder_of(function.__module__, inspect.getfile(function))


def is_kept(function: Callable[..., Any]) -> bool:
    """Whether a kernel's machine code is in the cache.

    Parameters
    ----------
    function : callable
        The Python function of the kernel.
    """
    name = f"*.{function.__qualname__}-{function.__code__.co_firstlineno}.py*.nbi"
    return any(_folder(function).glob(name.replace("<", "").replace(">", "")))


@cache
def note_use(function: Callable[..., Any]) -> None:
    """Note that a kernel's folder is in use, so that it is not removed as forgotten."""
    _touch(_folder(function))


def _touch(path: Path) -> None:
    with contextlib.suppress(OSError):
        if time.time() - path.stat().st_mtime > _DAY:
            os.utime(path)


def prune() -> None:
    """Remove what the sources as they are do not need and what was not used for a month.

    Of each module the eight folders that were used last stay at most: other versions of this program, and
    other Pythons, have theirs in the same place.
    """
    root, own = cache_directory(), set(current_folders().values())
    old: dict[str, list[tuple[float, Path]]] = {}
    with contextlib.suppress(OSError):
        beside = root.parent.glob(f"kernels-{'[0-9a-f]' * 16}")  # as they were named before
        for path in (*root.iterdir(), *beside):
            name, _, digest = path.name.rpartition("-")
            if re.fullmatch("[0-9a-f]{16}", digest) and path.name not in own and path != mark():
                old.setdefault(name, []).append((path.stat().st_mtime, path))
    for found in old.values():
        for place, (used, path) in enumerate(sorted(found, reverse=True)):
            if place >= _VERSIONS - 1 or time.time() - used > _UNUSED:
                _remove(path)


def _remove(path: Path) -> None:
    with contextlib.suppress(OSError):
        path.unlink() if path.is_file() else shutil.rmtree(path, ignore_errors=True)
