"""Compiled kernels as one file, for other computers of the same kind: one compiles, a classroom loads.

The file is a zip archive of the cache's folders and of ``manifest.json``, which says what they fit. Kernels
are programs: an archive is to be trusted like one.
"""

import hashlib
import io
import json
import os
import re
import secrets
import struct
import zipfile
import zlib
from collections.abc import Collection
from pathlib import Path
from typing import Any

from physicslab.kernels import keys
from physicslab.kernels.cache import cache_directory, place_of

_FORMAT = "physicslab-kernels/1"
_MANIFEST = "manifest.json"
_MEMBER = re.compile(r"([A-Za-z_][\w.]*-[0-9a-f]{16})/([\w.<>-]+\.nb[ic])", re.ASCII)
_MANIFEST_LIMIT = 1 << 20
_LIMIT = 1 << 27
"""Size [bytes] of an archive, and of what it may hold in all; a full set of kernels is a tenth of that."""
_DAMAGE = (
    zipfile.BadZipFile, zlib.error, EOFError, OSError, NotImplementedError, RuntimeError, ValueError,
    struct.error,
)  # fmt: skip
"""What Python raises on reading damaged archives in memory."""


class ArchiveError(Exception):
    """An archive cannot be used; the message is one line."""


def pack(folders: Collection[str] | None = None) -> bytes:
    """Return an archive of the kernels in the cache.

    Parameters
    ----------
    folders : collection of str, optional
        The names of the cache's folders that are packed; those of all modules where none are given.
    """
    cache_directory()  # it determines for which processor is compiled
    buffer = io.BytesIO()
    chosen = keys.current_folders().values() if folders is None else folders
    files = {
        f"{folder}/{path.name}": path.read_bytes()
        for folder in sorted(chosen)
        for path in sorted(place_of(folder).glob("*.nb[ic]"))
    }
    document = {
        "format": _FORMAT,
        "sources": keys.sources_key(),
        "platform": keys.platform_key(),
        "files": {name: _hash(content) for name, content in files.items()},
    }
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(_MANIFEST, json.dumps(document, indent=1))
        for name, content in files.items():
            archive.writestr(name, content)
    return buffer.getvalue()


def unpack(path: Path) -> int:
    """Put the kernels of an archive into the cache; return how many files they were.

    Nothing is written unless all of it fits: this program's kernels, numba, Python and processor.

    Raises
    ------
    ArchiveError
        If it is no archive of kernels, is damaged, does not fit, or holds other files.
    OSError
        If it cannot be read, or the cache cannot be written.
    """
    root = cache_directory()
    with open(path, "rb") as file:
        content = file.read(_LIMIT + 1)
    if len(content) > _LIMIT:
        raise ArchiveError(f"is larger than {_LIMIT >> 20} MiB")
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            files = _files(archive)
    except _DAMAGE as error:
        raise ArchiveError(f"is damaged, or no archive of kernels: {error}") from error
    for folder, name in sorted(files, key=lambda file: file[1].endswith(".nbi")):  # indices after their data
        (root / folder).mkdir(mode=0o700, exist_ok=True)
        fresh = root / folder / f"{name}.tmp.{secrets.token_hex(8)}"
        try:
            fresh.write_bytes(files[folder, name])
            os.replace(fresh, root / folder / name)
        finally:
            fresh.unlink(missing_ok=True)
    return len(files)


def _manifest(archive: zipfile.ZipFile) -> dict[str, Any]:
    """Return an archive's manifest."""
    if _MANIFEST not in archive.namelist() or archive.getinfo(_MANIFEST).file_size > _MANIFEST_LIMIT:
        raise ArchiveError("is no archive of kernels: it has no manifest")
    manifest = json.loads(archive.read(_MANIFEST))
    if not isinstance(manifest, dict) or manifest.get("format") != _FORMAT:
        raise ArchiveError(f"is no archive of kernels of the format {_FORMAT}")
    return manifest


def _check(manifest: dict[str, Any]) -> None:
    """Refuse an archive that is for another computer or another version, and say what does not fit."""
    theirs = manifest.get("platform")
    if isinstance(theirs, dict) and theirs.get("processor") in keys.supported_levels():
        keys.use_processor(str(theirs["processor"]))
    for name, own in keys.platform_key().items():
        other = theirs.get(name) if isinstance(theirs, dict) else None
        if other != own:
            raise ArchiveError(f"does not fit: it is for {name} {str(other)[:80]!r}, and here is {own!r}")
    if manifest.get("sources") != keys.sources_key():
        raise ArchiveError("does not fit: it holds the kernels of another version of physicslab")


def _files(archive: zipfile.ZipFile) -> dict[tuple[str, str], bytes]:
    """Return the files of an archive that fits, by folder and name in the cache; refuse all others."""
    manifest = _manifest(archive)
    _check(manifest)
    allowed, found, size = set(keys.current_folders().values()), {}, 0
    for member in archive.infolist():
        if member.filename == _MANIFEST:
            continue
        match = _MEMBER.fullmatch(member.filename)
        if match is None or match[1] not in allowed:
            raise ArchiveError(f"holds what no kernel is: {member.filename[:80]!r}")
        size += member.file_size
        if size > _LIMIT:
            raise ArchiveError(f"holds more than {_LIMIT >> 20} MiB")
        found[match[1], match[2]] = archive.read(member)  # no more bytes than its header gives
    if not found:
        raise ArchiveError("holds no kernels")
    hashes = {f"{folder}/{name}": _hash(content) for (folder, name), content in found.items()}
    if hashes != manifest.get("files"):
        raise ArchiveError("is damaged: its files are not those that its manifest names")
    return found


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
