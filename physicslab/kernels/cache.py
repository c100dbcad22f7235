"""Where compiled kernels are kept between runs, and which of them are still right.

Each module's kernels are in a folder named after a hash of all that determines their machine code
(:mod:`physicslab.kernels.keys`). An edit leaves the folders of modules that do not depend on it as they are.

numba unpickles the files there, so **a compiled kernel is a program that will be run**. The folder is used
only if none but this user and root can write in it, or put another in its place: it is no link, and it and
every folder above it is root's or this user's, and closed to others for writing; or sticky, as that of
temporary files is, above ours. Links above it are resolved once, before that is checked.

Its place is the environment variable ``PHYSICSLAB_KERNELS``, or ``physicslab/kernels`` in the user's cache
folder, or, where there is no such folder, ``physicslab-<user>/kernels`` among the temporary files; else a new
temporary one that is removed at the end of the process.

Beside it there may be a shared one, which is only read: that of the variable where this user cannot write, or
``share/physicslab/kernels`` below ``sys.prefix``, where a package, a container or an administrator has put
them. It is used if it holds every kernel.

If there are not all kernels for just this processor, and all for a kind of processors that it belongs to
(:data:`physicslab.kernels.keys.LEVELS`), as ``physicslab kernels import`` brings them, those are used.
"""

from __future__ import annotations

import atexit
import contextlib
import inspect
import logging
import os
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

import numba.core.config
from numba.core import ccallback, dispatcher
from numba.core.caching import CacheImpl, FunctionCache, UserProvidedCacheLocator
from platformdirs import user_cache_path

from physicslab.kernels import keys

if numba.core.config.DISABLE_JIT:  # type: ignore[attr-defined]
    raise ImportError(
        "physicslab cannot work while NUMBA_DISABLE_JIT is set: PHYSICSLAB_INTERPRET=1 has its kernels run "
        "as plain Python, for a debugger"
    )
VARIABLE = "PHYSICSLAB_KERNELS"
"""The environment variable that says where compiled kernels are to be kept."""
SHARED = "share/physicslab/kernels"
"""The folder of kernels that are only read, below ``sys.prefix``."""
_DAY = 86400.0
_UNUSED = 30 * _DAY
"""Time [s] for which what is not used is kept."""
_VERSIONS = 8
"""How many folders of one module are kept, however many were in use: those used last."""
_OF_LEVEL = "complete-x86-64-v*"
_log = logging.getLogger(__name__)


# ---- the folder --------------------------------------------------------------------------------------------

_directory: Path | None = None
_shared: Path | None = None


def cache_directory() -> Path:
    """Return where compiled kernels are kept: a folder in which only this user, or root, can write."""
    global _directory, _shared
    if _directory is None:
        _shared = _first_shared()
        _directory = _first_private()
        _choose_processor([_directory] if _shared is None else [_shared, _directory])
        if _shared is not None and not (_shared / _mark_name()).is_file():
            _shared = None  # it has those of another processor
    return _directory


def place_of(folder: str) -> Path:
    """Return the path of a module's folder: the shared one if it is there."""
    own = cache_directory() / folder
    shared = own if _shared is None else _shared / folder
    return shared if shared.is_dir() else own


def use_directory(directory: Path) -> None:
    """Keep kernels in another folder; the caller ensures that it is private.

    Kernels that are defined before this call stay in the previous folder.
    """
    global _directory, _shared
    _directory, _shared = directory, None


def _first_private() -> Path:
    """Return the first of the folders that may be used, or a temporary one."""
    for place in _places():
        try:
            folder = _resolved(*place)
            if folder is not None:
                return folder
        except (OSError, RuntimeError, KeyError):  # no home, or one that cannot be written to
            continue
    directory = Path(tempfile.mkdtemp(prefix="physicslab-kernels-"))  # which makes it private
    _log.warning("compiled kernels cannot be kept for the next start; this one has them in %s", directory)
    atexit.register(_remove_own, directory, os.getpid())
    return directory


def _places() -> Iterator[tuple[Path, str]]:
    """Yield where kernels may be kept, best first: a folder, and the path in it that is to have no links."""
    if os.environ.get(VARIABLE):
        named = Path(os.path.abspath(os.environ[VARIABLE]))
        yield named.parent, named.name
        if _shared is None or named.resolve() != _shared:
            return
    with contextlib.suppress(RuntimeError, KeyError):
        yield user_cache_path("physicslab", appauthor=False, opinion=False), "kernels"
    shared = f"physicslab-{os.getuid() if hasattr(os, 'getuid') else 0}"
    yield Path(tempfile.gettempdir()), f"{shared}/kernels"


def _resolved(place: Path, name: str) -> Path | None:
    """Make a folder if it is not there; return its path without links, ``None`` where it may not be used.

    Raises
    ------
    OSError
        If it cannot be made.
    """
    folder = _without_links(place) / name
    for path in (*reversed(folder.parents), folder):  # who owns the upper ones can replace the lower ones
        with contextlib.suppress(FileExistsError):
            if not os.path.lexists(path):
                path.mkdir(mode=0o700)
        if not _is_safe(path, folder):
            return None
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(folder)
    return folder


def _first_shared() -> Path | None:
    """Return the folder of kernels that are only read, if there is one with all of them."""
    places = [Path(sys.prefix, SHARED)]
    named = os.environ.get(VARIABLE, "")
    if named and not os.access(named, os.W_OK | os.X_OK):
        places.insert(0, Path(os.path.abspath(named)))
    for place in filter(Path.is_dir, places):
        with contextlib.suppress(OSError):
            folder = _without_links(place)
            is_full = any((folder / _mark_name(level)).is_file() for level in ("", *keys.supported_levels()))
            if is_full and all(_is_safe(path, folder) for path in (*reversed(folder.parents), folder)):
                return folder
    return None


def _choose_processor(folders: list[Path]) -> None:
    """Go by the kernels of a kind of processors, if there are all of those and not all of this one's."""
    settings: Any = numba.core.config
    if settings.CPU_NAME is not None or not any(any(place.glob(_OF_LEVEL)) for place in folders):
        return
    levels = ("", *keys.supported_levels())
    chosen = next((e for e in levels if any((place / _mark_name(e)).is_file() for place in folders)), "")
    if chosen:
        keys.use_processor(chosen)


def _without_links(path: Path) -> Path:
    """Return a path with its links followed, each once.

    Raises
    ------
    PermissionError
        If one is another user's: it may lead to what this user has unpacked from them.
    """
    path = Path(os.path.abspath(path))
    found = Path(path.anchor)
    for part in path.parts[1:]:
        found /= part
        if found.is_symlink():
            if hasattr(os, "geteuid") and os.lstat(found).st_uid not in (0, os.geteuid()):
                raise PermissionError(found)
            found = _without_links(found.parent / os.readlink(found))
    return found


def _is_safe(path: Path, folder: Path) -> bool:
    """Whether a folder may be used as far as that depends on its ``path`` or one above; log why not."""
    reason = _why_unsafe(path, is_above=path != folder) if hasattr(os, "geteuid") else ""
    if reason:
        _log.warning("compiled kernels in %s are not used: %s %s", folder, path, reason)
    return not reason


def _why_unsafe(folder: Path, *, is_above: bool) -> str:
    """Return why others could put files into a folder, or others in the place of what is in it."""
    status = os.lstat(folder)
    mode, own = stat.S_IMODE(status.st_mode), os.geteuid()
    if not stat.S_ISDIR(status.st_mode):
        return "is a link" if stat.S_ISLNK(status.st_mode) else "is no folder"
    if status.st_uid not in (0, own):
        return "belongs to another user"
    of_group = mode & stat.S_IWGRP and not (status.st_uid == own and _is_own_group(status.st_gid))
    if (of_group or mode & stat.S_IWOTH) and not (is_above and mode & stat.S_ISVTX):
        return f"is open to other users (mode {mode:o}: they may write in it)"
    return ""


def _is_own_group(group: int) -> bool:
    """Whether a group is that of this user alone, as many systems give each user one."""
    import grp  # which Windows has not
    import pwd

    user, found = pwd.getpwuid(os.geteuid()), grp.getgrgid(group)
    return group == user.pw_gid and found.gr_name == user.pw_name and set(found.gr_mem) <= {user.pw_name}


def _remove_own(directory: Path, process: int) -> None:
    if os.getpid() == process:  # and not a process that was forked from it
        shutil.rmtree(directory, ignore_errors=True)


def mark() -> Path:
    """Return the file whose existence means that every kernel of this package is kept."""
    own = cache_directory()
    return (own if _shared is None else _shared) / _mark_name()


def _mark_name(level: str = "") -> str:
    processor = keys.platform_key(level)["processor"]
    kind = f"{processor}-" if processor in keys.LEVELS else ""
    return f"complete-{kind}{keys.hash_of(*sorted(keys.current_folders(level).values()))[:16]}"


# ---- for numba ---------------------------------------------------------------------------------------------


class _Locator(UserProvidedCacheLocator):
    """Locates a kernel for numba: by what determines its code, and not by paths or dates."""

    def __init__(self, function: Callable[..., Any], path: str) -> None:
        self._py_file, self._lineno = path, function.__code__.co_firstlineno
        cache_directory()  # it determines for which processor is compiled
        self._folder = keys.folder_of(function.__module__, path)
        self._cache_path = str(place_of(self._folder))

    def ensure_cache_path(self) -> None:
        """Make the folder; numba calls this before it writes."""
        if os.path.isdir(cache_directory()):
            os.makedirs(self._cache_path, mode=0o700, exist_ok=True)

    def get_source_stamp(self) -> str:
        """Return what must be the same for a kept kernel to be right."""
        return self._folder

    @classmethod
    def from_function(cls, function: Callable[..., Any], path: str) -> _Locator | None:
        """Return the locator of a function; None where it is another's without a file."""
        return cls(function, path) if keys.is_own(function.__module__) or os.path.exists(path) else None


_FunctionCache: Any = FunctionCache  # not all of it is typed
_MAKING: tuple[Any, ...] = dispatcher, ccallback
"""The modules of numba that make one for each function."""


class _Kept(_FunctionCache):  # type: ignore[misc]
    """numba's cache of one kernel: torn files count as absent, and what cannot be kept runs all the same."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the kernel; ``None`` where it is not kept, or its files were torn by a crash."""
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # what a torn pickle raises can be anything
            try:
                self.flush()
            except OSError:
                self.disable()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the kernel, if that can be done: it runs in any case."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _tell_not_kept(error.strerror or str(error))


@cache
def _tell_not_kept(reason: str) -> None:
    _log.warning("compiled kernels cannot be kept in %s: %s", cache_directory(), reason)


@contextmanager
def cached() -> Iterator[None]:
    """Let functions compiled by numba within a ``with`` block keep their code in the cache."""
    settings: Any = numba.core.config
    before = CacheImpl._locator_classes
    chosen = getattr(settings, "CACHE_LOCATOR_CLASSES", "")
    CacheImpl._locator_classes = [_Locator, *before]  # read by numba when a function is decorated
    settings.CACHE_LOCATOR_CLASSES = ""
    for module in _MAKING:
        module.FunctionCache = _Kept
    try:
        yield
    finally:
        CacheImpl._locator_classes = before
        settings.CACHE_LOCATOR_CLASSES = chosen
        for module in _MAKING:
            module.FunctionCache = FunctionCache


def _folder(function: Callable[..., Any]) -> Path:
    cache_directory()
    return place_of(keys.folder_of(function.__module__, inspect.getfile(function)))


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
    """Note that a kernel's folder is in use, so that it is not removed as unused."""
    _touch(_folder(function))


def _touch(path: Path) -> None:
    with contextlib.suppress(OSError):
        if time.time() - path.stat().st_mtime > _DAY:
            os.utime(path)


def prune() -> None:
    """Remove what the present sources do not need and what was not used for a month.

    The eight folders of each module that were used last stay at most: other versions of this program, and
    other Pythons, have theirs in the same place.
    """
    root, own = cache_directory(), set(keys.current_folders().values())
    old: dict[str, list[tuple[float, Path]]] = {}
    with contextlib.suppress(OSError):
        beside = root.parent.glob(f"kernels-{'[0-9a-f]' * 16}")  # named as in earlier versions
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


cache_directory()  # it determines for which processor is compiled, which numba notes at the first function
