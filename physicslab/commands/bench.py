"""Measure speed: how long a step takes and how that grows, alone or beside other engines."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from physicslab.commands.command_error import FAILED, CommandError
from physicslab.commands.output import Output
from physicslab.commands.pictures import picture_directory
from physicslab.commands.progress import Progress
from physicslab.files.checks import printable, shown, suggestion
from physicslab.files.json_text import json_bytes
from physicslab.lab.bench.catalogue import MOST_BESIDE, SCENES, groups, names, opened, select
from physicslab.lab.bench.document import document
from physicslab.lab.bench.engine import PEERS, missing_peers
from physicslab.lab.bench.measure import measure_scene
from physicslab.lab.bench.memory import measure_memory
from physicslab.lab.bench.report import BenchReport
from physicslab.lab.bench.result import SceneResult
from physicslab.lab.bench.scene import BenchScene
from physicslab.lab.bench.tables import report_text, scene_text
from physicslab.lab.bench.unused import UNUSED, Unused, measure_unused
from physicslab.scenes import SCENES as BUILT_IN

__all__ = ["add_arguments", "execute"]

_MEMORY, _UNUSED = "memory", "unused"


def add_arguments(parser: ArgumentParser) -> None:
    """Declare what the command takes."""
    what = "a scene of the benchmark, a group of them, a built-in scene or a scene file; everything if none"
    parser.add_argument("scenes", metavar="SCENE", nargs="*", help=what)
    peers = (
        "time pymunk and Box2D on the same scenes, in turn (needs the dependency group peers); those of more "
        f"than {MOST_BESIDE:,} bodies only where they are named, for they take them minutes"
    )
    parser.add_argument("--peers", action="store_true", help=peers)
    parser.add_argument("--json", metavar="FILE", help="write everything that was measured (- for stdout)")
    parser.add_argument("--plot", metavar="DIR", help="draw growth and ratios, as bench.png")
    parser.epilog = (
        f"groups: {', '.join(groups())}; scenes: {', '.join(SCENES)}; {_UNUSED}: what a step costs more "
        f"for systems that the scene does not use; {_MEMORY}: bytes a body. dt is 1/60 s, 4 substeps, one "
        "thread, nothing sleeps; pymunk takes 10 iterations with a slop of 5 mm, Box2D 8 and 3. The exit "
        "status is 0 whether targets are met or not, and 1 if a run diverges."
    )


def execute(arguments: Namespace) -> int:
    """Time what was named, print the tables, and write what was asked for."""
    scenes, extras = _chosen(arguments.scenes)
    if arguments.peers and (missing := missing_peers()):
        verb = "is" if len(missing) == 1 else "are"
        raise CommandError(
            f"--peers: {' and '.join(missing)} {verb} not installed: uv sync --group peers, or "
            f"uv run --group peers physicslab bench --peers"
        )
    output = None if arguments.json is None else Output("--json", arguments.json)
    pictures = None if arguments.plot is None else picture_directory(arguments.plot, "bench.png")
    quiet = output is not None and output.to_stdout
    report = BenchReport(arguments.peers)
    beside = {scene.name for scene in scenes if _beside(scene, arguments)}
    for found in _results(scenes, extras, beside):
        if isinstance(found, SceneResult):
            report.scenes.append(found)
            _tell(scene_text(found), quiet)
        else:
            report.unused.append(found)
    if _MEMORY in extras:
        report.memory = measure_memory()
    _tell("", quiet)
    if not quiet:
        print(report_text(report), flush=True)
    if output is not None:
        output.write(json_bytes(document(report)))
    if pictures is not None:
        from physicslab.lab.bench.plot import bench_picture  # matplotlib takes a while, and may not be there

        Output("--plot", str(pictures / "bench.png")).write(bench_picture(report))
    _check(report.scenes)
    return 0


def _chosen(wanted: Sequence[str]) -> tuple[list[BenchScene], list[str]]:
    """Return the scenes of these names, each once, and what else was named; everything where none is.

    Raises
    ------
    CommandError
        If there is none of a name.
    SceneError
        If a scene cannot be read.
    """
    if not wanted:
        return list(SCENES.values()), [_UNUSED, _MEMORY]
    chosen: dict[str, BenchScene] = {}
    extras: list[str] = []
    for name in wanted:
        if name in (_UNUSED, _MEMORY):
            extras.append(name)
        elif found := select(name):
            chosen |= {scene.name: scene for scene in found}
        elif name in BUILT_IN or Path(name).exists():
            scene = opened(name)
            chosen[name] = replace(scene, name=printable(scene.name), title=printable(scene.title))
        else:
            likely = suggestion(name, [*names(), _UNUSED, _MEMORY, *BUILT_IN])
            there_is = f"the groups are {', '.join(groups())}; built-in scenes and files are taken as well"
            raise CommandError(f"{shown(name)}: is no scene{likely or '; ' + there_is}")
    return list(chosen.values()), extras


def _beside(scene: BenchScene, arguments: Namespace) -> bool:
    """Whether other engines take part in a scene."""
    return arguments.peers and (scene.size <= MOST_BESIDE or scene.name in arguments.scenes)


def _results(
    scenes: Sequence[BenchScene], extras: Sequence[str], beside: Collection[str]
) -> Iterator[SceneResult | Unused]:
    """Yield what comes of each, and keep the terminal told how far all are."""
    jobs: list[tuple[int, Iterator[float | SceneResult | Unused]]] = [
        (scene.size, measure_scene(scene, PEERS if scene.name in beside else ())) for scene in scenes
    ]
    if _UNUSED in extras:
        jobs += [(1_000, measure_unused(case)) for case in UNUSED]
    whole, done = max(1, sum(size for size, _ in jobs)), 0
    progress = Progress("bench", sys.stderr)
    try:
        for size, job in jobs:
            for found in job:
                if isinstance(found, float):
                    progress.show((done + found * size) / whole)
                else:
                    progress.clear()
                    yield found
            done += size
    finally:
        progress.clear()


def _tell(text: str, quiet: bool) -> None:
    """Say how far it is where that is no part of the report."""
    if not quiet and sys.stderr is not None:  # a program may be started without
        print(text, file=sys.stderr, flush=True)


def _check(results: Sequence[SceneResult]) -> None:
    for found in results:
        if found.ours.failure:
            raise CommandError(f"{found.scene.name}: {found.ours.failure}", FAILED)
