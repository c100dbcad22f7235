"""Which machine code is right: what determines that of each module's kernels, as a hash.

numba's own cache does not notice an edit of a callee in another module and would return the old code. So the
key of a module's kernels depends on its source, on the sources of all that it imports within this package,
and on what else determines machine code: numba, Python, the processor.
"""

import hashlib
import platform
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite
import llvmlite.binding
import numba
import numba.core.config

_PACKAGE = __name__.rpartition(".")[0]
_SOURCES = Path(__file__).parent
_WITHOUT_CODE = frozenset(
    f"{_PACKAGE}.{name}"
    for name in (
        "__main__", "archive", "budget", "cache", "interpreter", "keys", "loading", "stand_ins", "warm",
    )
)  # fmt: skip
"""Modules that determine when kernels are compiled and where they are kept, but no instruction of them."""
_IMPORT = re.compile(
    r"^[ \t]*(?:from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n]*)|import[ \t]+([^\n]+))", re.MULTILINE
)


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
    """Return what determines machine code and its stored form besides the sources, by name."""
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
        "processor features": hash_of(features)[:16],
    }


def sources_key() -> str:
    """Return a hash of all that the machine code of all kernels depends on in this package."""
    sources = _sources()
    return hash_of(*(f"{name}\0{sources[name]}" for name in sorted(sources.keys() - _WITHOUT_CODE)))[:16]


def hash_of(*texts: str) -> str:
    """Return a hash of some texts, 64 hexadecimal digits."""
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
    return f"{name}-{hash_of(*platform_key().values(), *parts)[:16]}"


def current_folders() -> dict[str, str]:
    """Return the folder's name of every module of this package that may hold kernels."""
    return {module: folder_of(module) for module in _sources() if module not in _WITHOUT_CODE}
