"""Compiled kernels as one file, for other computers of the same kind: one compiles, a classroom loads.

The file is a zip archive of the cache's folders and of ``manifest.json``, which says what they fit; or a
wheel, which is installed beside the program. Kernels are programs: an archive is to be trusted like one.
"""

import hashlib
import io
import json
import os
import re
import secrets
import struct
import sys
import zipfile
import zlib
from base64 import urlsafe_b64encode
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from sysconfig import get_platform
from typing import Any

from physicslab.kernels import cache, keys
from physicslab.kernels.cache import cache_directory, place_of

_FORMAT = "physicslab-kernels/1"
_MANIFEST = "manifest.json"
_MEMBER = re.compile(r"([A-Za-z_][\w.]*-[0-9a-f]{16})/([\w.<>-]+\.nb[ic])", re.ASCII)
_MANIFEST_LIMIT = 1 << 20
_LIMIT = 1 << 27
"""Size [bytes] of an archive, and of what it may hold in all; a full set of kernels is a tenth of that."""
_METADATA = """\
Metadata-Version: 2.1
Name: physicslab-kernels-{kind}
Version: {version}
Summary: Compiled kernels of physicslab, for {system} and processors of the kind {kind}
Requires-Python: =={python}.*
Requires-Dist: physicslab=={version}
Requires-Dist: numba=={numba}
Requires-Dist: llvmlite=={llvmlite}
"""
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
    files = _kept(keys.current_folders().values() if folders is None else folders)
    document = {
        "format": _FORMAT,
        "sources": keys.sources_key(),
        "platform": keys.platform_key(),
        "files": {name: _hash(content) for name, content in files.items()},
    }
    return _zipped({_MANIFEST: json.dumps(document, indent=1).encode(), **files})


def wheel(version: str) -> tuple[str, bytes]:
    """Return a wheel of all kernels, which the cache holds: the name of its file, and its content.

    Installers check the hash of each file (PEP 427) and put them where :mod:`physicslab.kernels.cache` finds
    kernels that are only read.

    Parameters
    ----------
    version : str
        That of this package; other versions find nothing there that is theirs.
    """
    mark, platform, python = cache.mark(), keys.platform_key(), sys.version_info
    kind = platform["processor"] if platform["processor"] in keys.LEVELS else "native"
    name = f"physicslab_kernels_{re.sub('[-.]', '_', kind)}-{version}"
    tag = f"cp{python[0]}{python[1]}-none-{re.sub('[-.]', '_', get_platform())}"
    folder = f"{name}.data/data/{cache.SHARED}"
    files = {mark.name: mark.read_bytes(), **_kept(mark.read_text(encoding="utf-8").split())}
    members = {f"{folder}/{path}": content for path, content in files.items()}
    told = _METADATA.format(kind=kind, version=version, python=f"{python[0]}.{python[1]}", **platform)
    members[f"{name}.dist-info/METADATA"] = told.encode()
    members[f"{name}.dist-info/WHEEL"] = f"Wheel-Version: 1.0\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    record = f"{name}.dist-info/RECORD"
    members[record] = "".join([*map(_recorded, members.items()), f"{record},,\n"]).encode()
    return f"{name}-{tag}.whl", _zipped(members)


def _recorded(member: tuple[str, bytes]) -> str:
    """Return the line of a file in the record of a wheel: its path, hash and size."""
    path, content = member
    digest = urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
    return f"{path},sha256={digest},{len(content)}\n"


def _kept(folders: Iterable[str]) -> dict[str, bytes]:
    """Return the files in folders of the cache, by their paths in it."""
    return {
        f"{folder}/{path.name}": path.read_bytes()
        for folder in sorted(folders)
        for path in sorted(place_of(folder).glob("*.nb[ic]"))
    }


def _zipped(members: Mapping[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
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
