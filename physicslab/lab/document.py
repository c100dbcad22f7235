"""What a lab found, as a JSON document: format, machine, versions; figures are finite or ``null``, in SI."""

from __future__ import annotations

import math
import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

__all__ = ["finite", "lab_document", "machine", "machine_text"]

_PACKAGES = ("physicslab", "numpy", "numba", "esper")
_PEERS = ("pymunk", "box2d", "pyb2d3")


def lab_document(lab: str, *, peers: bool = False, **parts: object) -> dict[str, Any]:
    """Return the document of a lab, with the versions of other engines where ``peers`` took part."""
    return {"format": f"physicslab-{lab}/1", "machine": machine(peers=peers), **parts}


def finite(number: float | None) -> float | None:
    """Return a number, or ``None`` where it is not finite: JSON has no such numbers."""
    return number if number is not None and math.isfinite(number) else None


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
