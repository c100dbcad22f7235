"""Time a step in the window beside the same step headless, and beside a step of a compiled run.

``uv run python benchmarks/window_steps.py [SCENE ...] [--rounds N] [--json FILE]`` builds each scene of the
benchmark three times: stepped one by one with the window's systems installed, one by one without them, and in
calls of ``World.run``. The three take turns in one process, in blocks of equal length, after the scene has
settled (``--falling``: from its first step on). Printed are medians of the CPU time of a step [ms], and
medians of the ratios block by block. Between turns the window draws a frame, which is not timed, so that
frame systems use what they have recorded, as in the program. SDL's dummy driver takes the picture.
"""

from __future__ import annotations

import argparse
import statistics
from pathlib import Path
from typing import Any

from physicslab.desktop.timed_window import InWindow
from physicslab.files.json_text import json_text
from physicslab.lab.bench.catalogue import SCENES
from physicslab.lab.bench.engine import Engine
from physicslab.lab.bench.result import take_turns
from physicslab.lab.bench.scene import BenchScene
from physicslab.lab.report import lab_document, machine_text, table

DEFAULT = ("circles_10", "pyramid_30", "pyramid_60", "pile_1000", "pile_4000", "gas_2000")
TURN_MS = 8.0
"""How long a turn takes about: long enough for the clock, short enough for noise to be the same for all."""
FORMS = {
    "scene": "", "bodies": "", "window_ms": ".4f", "step_ms": ".4f", "run_ms": ".4f",
    "window_over_step": ".3f", "step_over_run": ".3f", "step_minus_run_us": ".1f",
}  # fmt: skip
"""The columns of the table, and how their figures are written."""


class SingleSteps(Engine):
    """A world that is stepped by one call a step."""

    def run(self, steps: int) -> None:
        """Advance step by step."""
        for _ in range(steps):
            self.world.step()


def measure(scene: BenchScene, rounds: int, *, falling: bool) -> dict[str, Any]:
    """Return medians of a step of each kind [ms], and of their ratios."""
    engines = (InWindow(scene.build()), SingleSteps(scene.build()), Engine(scene.build()))
    settling = 1 if falling else round(scene.seconds / engines[0].dt)
    for engine in engines:
        engine.run(settling)
        engine.pause()
    block = 10
    if not falling:
        *_, warm = take_turns(engines, 3, block)
        block = min(500, max(10, round(TURN_MS / statistics.median(warm[1].step))))
    for spent in take_turns(engines, rounds, block):
        times = spent
    in_window, stepped, run = (spent.step for spent in times)
    return {
        "scene": scene.name,
        "bodies": scene.size,
        "steps": block * rounds,
        "window_ms": statistics.median(in_window),
        "step_ms": statistics.median(stepped),
        "run_ms": statistics.median(run),
        "window_over_step": statistics.median(a / b for a, b in zip(in_window, stepped, strict=True)),
        "step_over_run": statistics.median(a / b for a, b in zip(stepped, run, strict=True)),
        "step_minus_run_us": 1e3 * statistics.median(a - b for a, b in zip(stepped, run, strict=True)),
    }


def main() -> None:
    """Print a line for each scene."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    which = f"of the benchmark; {', '.join(DEFAULT)} if none"
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=which)
    parser.add_argument("--rounds", type=int, default=60, help="turns of each kind (default: 60)")
    parser.add_argument("--falling", action="store_true", help="from the first step on, unsettled")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every figure")
    options = parser.parse_args()
    rows: list[dict[str, Any]] = []
    for name in options.scenes or DEFAULT:
        rows.append(measure(SCENES[name], options.rounds, falling=options.falling))
        print(f"{name}: window / step {rows[-1]['window_over_step']:.3f}", flush=True)
    head = [name.replace("_over_", " / ").replace("_minus_", " - ").replace("_", " ") for name in FORMS]
    lines = [[format(row[name], form) for name, form in FORMS.items()] for row in rows]
    print(f"{machine_text()}\n{table([head, *lines])}")
    if options.json is not None:
        options.json.write_text(json_text(lab_document("window-steps", scenes=rows)), encoding="utf-8")


if __name__ == "__main__":
    main()
