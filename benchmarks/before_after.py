"""Time the scenes of the benchmark in two checkouts, in turns, and compare the states in which they end.

``uv run python benchmarks/before_after.py BEFORE AFTER [SCENE ...] [--json FILE]`` writes scenes of this
checkout's benchmark as scene files. Each checkout runs them in a process of its own, by ``load_scene``,
``World.step``, ``World.run`` and ``World.physics`` alone, so that any version can be compared; the two take
turns of ten steps, or of one call of many. Printed are, for the first two seconds and for the settled scene,
the mean CPU time of a step [ms] in both and the median ratio of turns; and whether both end in the same
state, bit for bit. Settings that a checkout does not have are left out of its file. Scenes that are edited
before every step or stepped in a window are not compared.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from physicslab.files.json_text import json_text
from physicslab.files.scene import save_scene
from physicslab.lab.bench.catalogue import SCENES, by_default
from physicslab.lab.bench.scene import BenchScene
from physicslab.lab.report import cell, lab_document, machine_text, table

DT = 1.0 / 60.0
BEGIN_S = 2.0
BLOCK, ONE_CALL = 10, 200
"""Steps of a turn: single ones, or of one call."""
CHILD = """
import gc, hashlib, json, sys, time
from dataclasses import replace
from physicslab import Vector2, load_scene
from physicslab.components import Transform

path, one_call, gravities = json.loads(sys.stdin.readline())
world = load_scene(path)
gravities = iter(gravities)
gc.disable()
for line in sys.stdin:
    steps = int(line)
    gc.collect()
    began = time.process_time_ns()
    if one_call:
        world.run(steps=steps)
    else:
        for _ in range(steps):
            for gravity in gravities:
                world.physics = replace(world.physics, gravity=Vector2(*gravity))
                break
            world.step()
    print((time.process_time_ns() - began) / 1e6 / steps, flush=True)
table = world.table(Transform)
print(hashlib.sha256(table["position"].tobytes() + table["angle"].tobytes()).hexdigest())
"""
"""What a checkout runs: a turn for each line that it reads, with the number of steps."""


class Checkout:
    """A process in which a checkout runs a scene."""

    def __init__(self, folder: Path, scene: BenchScene, path: Path) -> None:
        steps = round(scene.seconds / DT) + scene.steps
        gravities = [list(scene.gravity_at(n * DT)) for n in range(steps)] if scene.gravity_at else []
        self._process = subprocess.Popen(
            (sys.executable, "-c", CHILD), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
            env=os.environ | {"PYTHONPATH": str(folder)}, cwd=folder,
        )  # fmt: skip
        self._write(json.dumps([str(path), scene.compiled_runs, gravities]))

    def _write(self, line: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()

    def turn(self, steps: int) -> float:
        """Advance, and return the CPU time of a step [ms]."""
        self._write(str(steps))
        assert self._process.stdout is not None
        return float(self._process.stdout.readline())

    def end(self) -> str:
        """End the process, and return the hash of the last state."""
        state, _ = self._process.communicate()
        return state.strip()


def written_for(folder: Path, path: Path) -> Path:
    """Write a scene file without the settings that a checkout does not have, and return its path."""
    scene = json.loads(path.read_text("utf-8"))
    (config,) = (folder / "physicslab").rglob("config.py")
    settings = config.read_text("utf-8")
    for part in ("simulation", "physics"):
        scene[part] = {key: value for key, value in scene[part].items() if f" {key}:" in settings}
    found = path.with_name(f"{path.stem}_{abs(hash(folder))}.json")
    found.write_text(json.dumps(scene), "utf-8")
    return found


def compare(folders: tuple[Path, Path], scene: BenchScene, path: Path) -> dict[str, Any]:
    """Return the figures of a scene in both checkouts."""
    save_scene(scene.build(), path)
    pair = [Checkout(folder, scene, written_for(folder, path)) for folder in folders]
    block = ONE_CALL if scene.compiled_runs else BLOCK
    settling, turns = round(scene.seconds / DT / block), scene.steps // block
    spent: list[tuple[float, float]] = []
    for number in range(settling + turns):
        if number % 2 == 0:
            before, after = pair[0].turn(block), pair[1].turn(block)
        else:
            after, before = pair[1].turn(block), pair[0].turn(block)
        spent.append((before, after))
    begin = spent[1 : min(settling, round(BEGIN_S / DT / block))]  # the first turn loads kernels
    found = {**_figures("begin", begin), **_figures("settled", spent[settling:])}
    same = len({checkout.end() for checkout in pair}) == 1
    return {"scene": scene.name, "bodies": scene.size, "steps": turns * block, **found, "same_bits": same}


def _figures(phase: str, spent: list[tuple[float, float]]) -> dict[str, float | None]:
    """Return the mean of a step in both checkouts [ms], and the median ratio."""
    if not spent:
        return dict.fromkeys((f"{phase}_before_ms", f"{phase}_after_ms", f"{phase}_ratio"))
    before, after = zip(*spent, strict=True)
    return {
        f"{phase}_before_ms": statistics.fmean(before),
        f"{phase}_after_ms": statistics.fmean(after),
        f"{phase}_ratio": statistics.median(b / a for a, b in spent),
    }


def main() -> None:
    """Print a line for each scene."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("before", type=Path, help="a checkout")
    parser.add_argument("after", type=Path, help="another checkout")
    scenes_help = "scenes of the benchmark, or groups; those that it runs by default if none"
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=scenes_help)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every figure")
    options = parser.parse_args()
    folders = options.before.resolve(), options.after.resolve()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for scene in [scene for name in options.scenes for scene in SCENES.select(name)] or by_default():
            if scene.edit is not None or scene.in_window:
                continue
            rows.append(compare(folders, scene, Path(folder) / f"{scene.name}.json"))
            print(f"{scene.name}: after / before {rows[-1]['settled_ratio']:.3f}", flush=True)
    head = ["scene", "first 2 s: before", "after", "ratio", "settled: before", "after", "ratio", "same bits"]
    forms = {"before_ms": ".4f", "after_ms": ".4f", "ratio": ".3f"}
    lines = [
        [
            row["scene"],
            *(cell(row[f"{phase}_{key}"], forms[key]) for phase in ("begin", "settled") for key in forms),
            "yes" if row["same_bits"] else "no",
        ]
        for row in rows
    ]  # fmt: skip
    print(f"{machine_text()}\n{table([head, *lines])}")
    if options.json is not None:
        options.json.write_text(json_text(lab_document("before-after", scenes=rows)), encoding="utf-8")


if __name__ == "__main__":
    main()
