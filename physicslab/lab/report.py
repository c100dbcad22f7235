"""The results of every lab: a JSON document, tables for the terminal, plots.

A document has format, machine, versions, and figures in SI, finite or ``null``. Matplotlib is imported when a
plot is drawn.
"""

from __future__ import annotations

import io
import math
import os
import platform
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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


type Row = Sequence[str]


@dataclass(frozen=True, slots=True)
class Columns:
    """How wide the columns of a table are [letters], and which of them, with words, stand to the left.

    Examples
    --------
    >>> Columns((6, 4), words={0}).line(["ball", "2.5"])
    'ball     2.5'
    """

    widths: tuple[int, ...]
    words: Collection[int] = (0,)

    def line(self, row: Row) -> str:
        """Return a row as a line."""
        cells = (
            f"{text:{'<' if i in self.words else '>'}{width}}"
            for i, (text, width) in enumerate(zip(row, self.widths, strict=True))
        )
        return "  ".join(cells).rstrip()


def table(rows: Sequence[Row], words: Collection[int] = (0,), indent: str = "") -> str:
    """Return rows as lines, their columns as wide as what is in them: ``words`` left, numbers right."""
    columns = Columns(tuple(max(map(len, column)) for column in zip(*rows, strict=True)), words)
    return "\n".join(indent + columns.line(row) for row in rows)


def cell(number: float | None, form: str) -> str:
    """Return a number in a format, or a dash where there is none.

    >>> cell(0.125, ".1e"), cell(None, ".1e")
    ('1.2e-01', '-')
    """
    return "-" if number is None else format(number, form)


COLOURS = {
    "blue": "#0072B2", "orange": "#E69F00", "green": "#009E73", "vermilion": "#D55E00", "purple": "#CC79A7",
    "sky": "#56B4E9", "grey": "#999999", "black": "#000000",
}  # fmt: skip
"""Okabe and Ito's colours, which stay apart for the colour-blind: https://jfly.uni-koeln.de/color/"""


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure of a size [inches], which needs no display.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained", dpi=110)
    FigureCanvasAgg(figure)
    return figure


def prepare_axes(axes: Axes, *, logarithmic: bool = False, grid: str = "both") -> None:
    """Give axes a pale grid below what is drawn and no frame above and to the right.

    Parameters
    ----------
    logarithmic : bool
        Whether both scales are.
    grid : str
        Across which axis its lines stand: ``"x"``, ``"y"`` or ``"both"``.
    """
    if logarithmic:
        axes.set_xscale("log")
        axes.set_yscale("log")
    axes.grid(True, which="major", axis=grid, color="#dddddd", linewidth=0.6)  # type: ignore[arg-type]
    axes.set_axisbelow(True)
    for spine in ("top", "right"):
        axes.spines[spine].set_visible(False)


def png(figure: Figure) -> bytes:
    """Return a figure as a PNG."""
    image = io.BytesIO()
    figure.savefig(image, format="png")
    return image.getvalue()
