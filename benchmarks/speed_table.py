"""Print the tables of docs/performance.md from what the benchmark found beside other engines.

``uv run --group peers physicslab bench --peers --box2d DIR --json FILE``, then
``uv run python benchmarks/speed_table.py FILE [FILE ...]``: for each scene the median of a step's processor
time [ms], while it falls and after that, in every engine, and how many times as long PhysicsLab takes as the
fastest of the others (above 1 it loses); its 99th percentile over the median; then figures of quality and
growth with the number of bodies. The last file's time is printed as that of the measurement.
"""

from __future__ import annotations

import json
import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from physicslab.lab.bench.engine import OURS

PHASES = {"first_seconds_ms": "first 2 s", "step_ms": "then"}


def row(cells: list[str]) -> str:
    """Return a row of a Markdown table."""
    return f"| {' | '.join(cells)} |"


def head(cells: list[str]) -> list[str]:
    """Return the head of a Markdown table."""
    return [row(cells), "|---" * len(cells) + "|"]


def figure(number: float | None, form: str) -> str:
    """Return a number, or a dash where there is none."""
    return "-" if number is None else format(number, form)


def times(found: dict[str, Any], engines: list[str]) -> list[str]:
    """Return the table of times: a row for each scene and phase, the fastest in bold."""
    lines = head(["scene", "when", *engines, f"{OURS} / fastest other", "p99 / median"])
    for scene in found["scenes"]:
        by_name = {engine["name"]: engine for engine in scene["engines"]}
        for key, phase in PHASES.items():
            spreads = {name: by_name[name][key] for name in engines if name in by_name}
            medians = {name: spread["median"] for name, spread in spreads.items() if spread is not None}
            if OURS not in medians:
                continue
            best = min(medians.values())
            cells = [
                f"**{medians[name]:#.3g}**" if medians.get(name) == best and len(medians) > 1
                else figure(medians.get(name), "#.3g")
                for name in engines
            ]  # fmt: skip
            others = [median for name, median in medians.items() if name != OURS]
            loss = medians[OURS] / min(others) if others else None
            tail = spreads[OURS]["p99"] / spreads[OURS]["median"]
            lines.append(row([scene["name"], phase, *cells, figure(loss, ".2f"), figure(tail, ".1f")]))
    return lines


def quality(found: dict[str, Any], engines: list[str]) -> list[str]:
    """Return the table of quality."""
    lines = head(["scene", "figure", *engines, "limit"])
    for scene in found["scenes"]:
        by_name = {engine["name"]: engine["quality"] for engine in scene["engines"]}
        for limit in scene["quality_limits"]:
            cells = [figure(by_name.get(name, {}).get(limit["name"]), ".2g") for name in engines]
            text = f"{limit['limit']:g} {limit['unit']}".rstrip()
            lines.append(row([scene["name"], limit["name"], *cells, text]))
    return lines


def growth(found: dict[str, Any]) -> list[str]:
    """Return the table of growth."""
    sizes = sorted({size for group in found["growth"] for size in group["sizes"]})
    lines = head(["scenes", "engine", *(f"{size:,}" for size in sizes), "p of N^p"])
    for group in found["growth"]:
        costs = dict(zip(group["sizes"], group["ms"], strict=True))
        cells = [figure(costs.get(size), "#.3g") for size in sizes]
        lines.append(row([group["group"], group["engine"], *cells, f"{group['exponent']:.2f}"]))
    return lines


def main() -> None:
    """Print every table."""
    paths = [Path(name) for name in sys.argv[1:]]
    files = [json.loads(path.read_text("utf-8")) for path in paths]
    found = files[0] | {key: [part for file in files for part in file[key]] for key in ("scenes", "growth")}
    engines = list(dict.fromkeys(engine["name"] for scene in found["scenes"] for engine in scene["engines"]))
    measured = datetime.fromtimestamp(max(path.stat().st_mtime for path in paths), UTC)
    machine = ", ".join(f"{key} {value}" for key, value in found["machine"].items())
    print(f"Measured {measured:%Y-%m-%d %H:%M} UTC: {machine}.")
    for lines in (times(found, engines), quality(found, engines), growth(found)):
        print("", *lines, sep="\n")


if __name__ == "__main__":
    main()
