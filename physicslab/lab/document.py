"""The results of a lab, as a JSON document: format, machine, versions; figures in SI, finite or ``null``."""

import math
import os
import platform
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

_PACKAGES = ("physicslab", "numpy", "numba", "esper")
_PEERS = ("pymunk", "box2d", "pyb2d3")


def lab_document(lab: str, *, peers: bool = False, **parts: object) -> dict[str, Any]:
    """Return the document of a lab, with the versions of other engines where ``peers`` took part."""
    return {"format": f"physicslab-{lab}/1", "machine": machine(peers=peers), **plain(parts)}


def plain(value: object) -> Any:
    """Return a value as JSON has it: a record as an object, a number that is not finite as null.

    >>> plain({"figures": (1.0, math.inf)})
    {'figures': [1.0, None]}
    """
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, str):
        return str(value)
    if is_dataclass(value):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {key: plain(part) for key, part in value.items()}
    return [plain(part) for part in value] if isinstance(value, Iterable) else value


def pick(record: object, *names: str) -> dict[str, Any]:
    """Return some attributes of a record by their names.

    >>> pick(1.5, "real", "imag")
    {'real': 1.5, 'imag': 0.0}
    """
    return {name: getattr(record, name) for name in names}


def machine(*, peers: bool = False) -> dict[str, str | int]:
    """Return the processor's model, how many there are, and the versions of what was measured.

    It does not identify the machine.
    """
    found: dict[str, str | int] = {
        "cpu": _model(),
        "cpus": os.cpu_count() or 1,
        "system": f"{platform.system()} {platform.machine()}",
        "python": f"{platform.python_implementation()} {platform.python_version()}",
    }
    for package in (*_PACKAGES, *(_PEERS if peers else ())):
        try:
            found[package] = version(package)
        except PackageNotFoundError:  # run from its sources
            continue
    return found


def machine_text(*, peers: bool = False) -> str:
    """Return the same in a line."""
    found = machine(peers=peers)
    head = f"{found.pop('cpu')}, {found.pop('cpus')} CPUs, {found.pop('system')}, {found.pop('python')}"
    return ", ".join([head, *(f"{package} {number}" for package, number in found.items())])


def _model() -> str:
    """Return the name that the processor gives itself."""
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            key, _, value = line.partition(":")
            if key.strip() == "model name" and value.strip():
                return value.strip()
    except OSError:
        pass  # not Linux
    return platform.processor() or platform.machine() or "unknown"
