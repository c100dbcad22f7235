"""Which machine code is right: what determines that of each module's kernels, as a hash.

numba's own cache does not notice an edit of a callee in another module and would return the old code. So the
key of a module's kernels depends on its source, on the sources of all that it imports within this package,
and on what else determines machine code: numba, Python, the processor. In a build without sources (compiled
modules alone, a frozen program) what all modules are compiled to stands for each of them: two builds of one
version need not be of the same sources.
"""

import hashlib
import importlib.util
import pkgutil
import platform
import re
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from types import CodeType
from typing import Any

import llvmlite
import llvmlite.binding
import numba
import numba.core.config

_PACKAGE = __name__.rpartition(".")[0]
_WITHOUT_CODE = frozenset(
    f"{_PACKAGE}.{name}"
    for name in (
        "__main__", "archive", "cache", "interpreter", "keys", "loading", "program", "python_equivalents",
        "warm",
    )
)  # fmt: skip
"""Modules that determine when kernels are compiled and where they are kept, but no instruction of them."""
_IMPORT = re.compile(
    r"^[ \t]*(?:from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n]*)|import[ \t]+([^\n]+))", re.MULTILINE
)


@cache
def _sources() -> dict[str, str]:
    """Return the source of every module of this package, or what stands for it, by the module's name."""
    package = importlib.util.find_spec(_PACKAGE)
    assert package is not None and package.submodule_search_locations is not None
    loaders = {_PACKAGE: package.loader, **dict(_loaders(package.submodule_search_locations, f"{_PACKAGE}."))}
    sources = {name: loader.get_source(name) for name, loader in sorted(loaders.items())}
    if None in sources.values():
        build = hash_of(*(_digest(loader.get_code(name)) for name, loader in sorted(loaders.items())))
        return {name: source or f"build {build}" for name, source in sources.items()}
    return sources


def _digest(code: CodeType) -> str:
    """Return a hash of a compiled module or function: the same in each process that loads it."""
    parts = [code.co_code.hex(), *code.co_names, *code.co_varnames, *code.co_freevars]
    for value in code.co_consts:
        if isinstance(value, CodeType):
            parts.append(_digest(value))
        else:
            parts.append(repr(sorted(map(repr, value)) if isinstance(value, frozenset) else value))
    return hash_of(*parts)


def _loaders(folders: Iterable[str], prefix: str) -> Iterator[tuple[str, Any]]:
    """Yield the name and the loader of every module in folders of a package, none of which is imported."""
    for finder, name, _ in pkgutil.iter_modules(folders, prefix):
        spec = finder.find_spec(name, None)
        assert spec is not None
        yield name, spec.loader
        if spec.submodule_search_locations:
            yield from _loaders(spec.submodule_search_locations, f"{name}.")


@cache
def _imports(source: str) -> frozenset[str]:
    """Return the modules of this package that a source may import."""
    found: set[str] = set()
    for origin, names, modules in _IMPORT.findall(source):
        if origin:
            found |= {origin, *(f"{origin}.{name}" for name in re.findall(r"\w+", names))}
        else:
            found.update(re.findall(r"[\w.]+", modules))
    return frozenset(found & _sources().keys())


@cache
def depends_on(module: str) -> frozenset[str]:
    """Return the modules of this package on which a module's machine code depends, itself included."""
    sources = _sources()
    found, waiting = {_PACKAGE}, [_PACKAGE, module]
    while waiting:
        name = waiting.pop()
        found.add(name)
        waiting += _imports(sources[name]) - found - _WITHOUT_CODE
    return frozenset(found)


_V2 = frozenset(("cx16", "popcnt", "sahf", "sse3", "sse4.1", "sse4.2", "ssse3"))
_V3 = _V2 | {"avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"}
LEVELS = {"x86-64-v3": _V3, "x86-64-v2": _V2}
"""Kinds of processors for which kernels can be compiled, the best first, and what each must have.

Levels of the x86-64 psABI (https://gitlab.com/x86-psABIs/x86-64-ABI), as LLVM names them. Kernels of each
give the same bits.
"""


def supported_levels() -> list[str]:
    """Return the kinds whose kernels this processor runs, the best first."""
    own = {name for name, is_there in llvmlite.binding.get_host_cpu_features().items() if is_there}
    return [level for level, needed in LEVELS.items() if needed <= own]


def use_processor(level: str) -> None:
    """Compile for one of ``LEVELS``, and load what was; to be called before any kernel is made."""
    settings: Any = numba.core.config
    settings.CPU_NAME, settings.CPU_FEATURES = level, ""
    platform_key.cache_clear()
    folder_of.cache_clear()


def processor_variables() -> dict[str, str]:
    """Return the environment variables by which another process compiles for the same processor."""
    settings: Any = numba.core.config
    found = {"NUMBA_CPU_NAME": settings.CPU_NAME, "NUMBA_CPU_FEATURES": settings.CPU_FEATURES}
    return {name: value for name, value in found.items() if value is not None}


@cache
def platform_key(level: str = "") -> dict[str, str]:
    """Return what determines machine code and its stored form besides the sources, by name.

    Parameters
    ----------
    level : str
        One of ``LEVELS``, in place of the processor that is compiled for now.
    """
    settings: Any = numba.core.config
    features = "" if level else settings.CPU_FEATURES
    if features is None:
        features = llvmlite.binding.get_host_cpu_features().flatten()
    return {
        "numba": numba.__version__,
        "llvmlite": llvmlite.__version__,
        "Python": f"{sys.implementation.cache_tag}{getattr(sys, 'abiflags', '')}",
        "system": f"{sys.platform} {platform.machine()}",
        "processor": level or settings.CPU_NAME or llvmlite.binding.get_host_cpu_name(),
        "processor features": hash_of(features)[:16],
    }


def sources_key() -> str:
    """Return a hash of all that the machine code of all kernels depends on in this package."""
    sources = _sources()
    return hash_of(*(f"{name}\0{sources[name]}" for name in sorted(sources.keys() - _WITHOUT_CODE)))[:16]


def hash_of(*texts: str) -> str:
    """Return a hash of some texts, 64 hexadecimal digits."""
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()


def is_own(module: str) -> bool:
    """Whether a module, by its full name, is one of this package."""
    return module in _sources()


@cache
def folder_of(module: str, path: str = "", level: str = "") -> str:
    """Return the name of the folder for the kernels of a module.

    Parameters
    ----------
    module : str
        Its full name.
    path : str, optional
        Its file, of a module outside this package; its kernels depend on all of this package.
    level : str, optional
        One of ``LEVELS``, in place of the processor that is compiled for now.
    """
    if is_own(module):
        parts = [f"{name}\0{_sources()[name]}" for name in sorted(depends_on(module))]
        name = module.removeprefix(f"{_PACKAGE}.")
    else:
        parts, name = [sources_key(), Path(path).read_text(encoding="utf-8")], f"other.{Path(path).stem}"
    return f"{name}-{hash_of(*platform_key(level).values(), *parts)[:16]}"


def current_folders(level: str = "") -> dict[str, str]:
    """Return the folder's name of every module of this package that may hold kernels, for a processor."""
    return {module: folder_of(module, level=level) for module in _sources() if module not in _WITHOUT_CODE}
