"""Print the tables of docs/accuracy.md from what the accuracy lab found of contact cases.

``uv run --group peers physicslab accuracy contacts --json FILE``, then
``uv run python benchmarks/contact_tables.py FILE``: for each case the largest error of rigid contacts at any
step, and for the others the error at 1/60 s and the order; then the processor time [ms] of a simulated second
at 1/60 s.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any


def errors(engine: dict[str, Any]) -> str:
    """Return a cell: the largest error, or the first one and the order."""
    if engine["refused"]:
        return str(engine["refused"])
    found = [row["error"] for row in engine["rows"]]
    if None in found:
        return "failed"
    if engine["name"] == "rigid":
        return f"{max(found):.0e}"
    order = engine["order_measured"]
    return f"{found[0]:.1e}" + ("" if order is None else f" ({order:.1f})".replace("-0.0", "0.0"))


def cost(engine: dict[str, Any]) -> str:
    """Return a cell: processor time [ms] of a second at the longest step."""
    return str(engine["refused"]) or f"{1e3 * engine['rows'][0]['cpu_s_per_s']:.2g}"


def main() -> None:
    """Print both tables."""
    found = json.loads(Path(sys.argv[1]).read_text("utf-8"))
    titles = [engine["title"] for engine in found["contacts"][0]["engines"]]
    for cell in (errors, cost):
        print("| case |", *(f"{title} |" for title in titles))
        print("|---" * (1 + len(titles)) + "|")
        for case in found["contacts"]:
            print(f"| {case['name']} |", *(f"{cell(engine)} |" for engine in case["engines"]))
        print()
    print(found["machine"])


if __name__ == "__main__":
    main()
