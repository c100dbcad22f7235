"""Compiled kernels as one file, for other computers of the same kind: one compiles, a classroom loads.

The file is a zip archive of the cache's folders and of ``manifest.json``, which says what they fit. Kernels
are programs: an archive is to be trusted like one.
"""

from __future__ import annotations

import io
import json
import os
import re
import shutil
import tempfile
import zipfile
from collections.abc import Collection
from pathlib import Path
from typing import Any

from physicslab.kernels.cache import cache_directory
from physicslab.kernels.keys import current_folders, platform_key, sources_key

__all__ = ["ArchiveError", "pack", "unpack"]

_FORMAT = "physicslab-kernels/1"
_MANIFEST = "manifest.json"
_MEMBER = re.compile(r"([A-Za-z_][\w.]*-[0-9a-f]{16})/([\w.<>-]+\.nb[ic])", re.ASCII)
_MANIFEST_LIMIT = 1 << 16
_LIMIT = 1 << 28
"""Size [bytes] of what an archive may hold in all; a full set of kernels is a twentieth of that."""


class ArchiveError(Exception):
    """An archive cannot be used; the message is one line."""


def pack(folders: Collection[str] | None = None) -> bytes:
    """Return an archive of the kernels in the cache.

    Parameters
    ----------
    folders : collection of str, optional
        The names of the cache's folders that are packed; those of all modules where none are given.
    """
    root, buffer = cache_directory(), io.BytesIO()
    chosen = current_folders().values() if folders is None else folders
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        document = {"format": _FORMAT, "sources": sources_key(), "platform": platform_key()}
        archive.writestr(_MANIFEST, json.dumps(document, indent=1))
        for folder in sorted(chosen):
            for path in sorted((root / folder).glob("*.nb[ic]")):
                archive.write(path, f"{folder}/{path.name}")
    return buffer.getvalue()


def unpack(path: Path) -> int:
    """Put the kernels of an archive into the cache; return how many files they were.

    Nothing is written unless all of it fits: this program's kernels, numba, Python and processor.

    Raises
    ------
    ArchiveError
        If it is no archive of kernels, is damaged, does not fit, or holds what none may.
    OSError
        If it cannot be read, or the cache cannot be written.
    """
    root = cache_directory()
    try:
        with zipfile.ZipFile(path) as archive:
            _check(_manifest(archive))
            members = _members(archive)
            fresh = Path(tempfile.mkdtemp(prefix="importing-", dir=root))  # private, and on the same disk
            try:
                _write(archive, members, fresh, root)
            finally:
                shutil.rmtree(fresh, ignore_errors=True)
    except (zipfile.BadZipFile, EOFError, NotImplementedError, RuntimeError, ValueError) as error:
        raise ArchiveError(f"is damaged, or no archive of kernels: {error}") from error
    return len(members)


def _manifest(archive: zipfile.ZipFile) -> dict[str, Any]:
    """Return what an archive says of itself."""
    if _MANIFEST not in archive.namelist() or archive.getinfo(_MANIFEST).file_size > _MANIFEST_LIMIT:
        raise ArchiveError("is no archive of kernels: it has no manifest")
    manifest = json.loads(archive.read(_MANIFEST))
    if not isinstance(manifest, dict) or manifest.get("format") != _FORMAT:
        raise ArchiveError(f"is no archive of kernels of the format {_FORMAT}")
    return manifest


def _check(manifest: dict[str, Any]) -> None:
    """Refuse an archive that is for another computer or another version, and say what does not fit."""
    theirs = manifest.get("platform")
    for name, own in platform_key().items():
        other = theirs.get(name) if isinstance(theirs, dict) else None
        if other != own:
            raise ArchiveError(f"does not fit: it is for {name} {str(other)[:80]!r}, and here is {own!r}")
    if manifest.get("sources") != sources_key():
        raise ArchiveError("does not fit: it holds the kernels of another version of physicslab")


def _members(archive: zipfile.ZipFile) -> list[tuple[zipfile.ZipInfo, str, str]]:
    """Return the files of an archive, each with its folder and name in the cache; refuse all others."""
    allowed, found, size = set(current_folders().values()), [], 0
    for member in archive.infolist():
        if member.filename == _MANIFEST:
            continue
        match = _MEMBER.fullmatch(member.filename)
        if match is None or match[1] not in allowed:
            raise ArchiveError(f"holds what no kernel is: {member.filename[:80]!r}")
        size += member.file_size
        if size > _LIMIT:
            raise ArchiveError(f"holds more than {_LIMIT >> 20} MiB")
        found.append((member, match[1], match[2]))
    if not found:
        raise ArchiveError("holds no kernels")
    return found


def _write(
    archive: zipfile.ZipFile, members: list[tuple[zipfile.ZipInfo, str, str]], fresh: Path, root: Path
) -> None:
    """Read every file of an archive, and only then put them where they belong: indices after their data."""
    for number, (member, _, _) in enumerate(members):
        (fresh / str(number)).write_bytes(archive.read(member))  # which checks its length and checksum
    order = sorted(range(len(members)), key=lambda number: members[number][2].endswith(".nbi"))
    for number in order:
        _, folder, name = members[number]
        (root / folder).mkdir(mode=0o700, exist_ok=True)
        os.replace(fresh / str(number), root / folder / name)
