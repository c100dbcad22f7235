"""Measure speed: how long a step takes and how that grows, alone or beside other engines."""

import os
import sys
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from physicslab.commands import FAILED, CommandError, require_window
from physicslab.commands.lab import LabRun, chosen_cases, list_cases, unknown_name
from physicslab.ecs.text import printable
from physicslab.files.checks import shown
from physicslab.lab.bench.added import ADDED, BODIES, Added, measure_added
from physicslab.lab.bench.catalogue import PEER_SIZE_LIMIT, SCENES, by_default, opened
from physicslab.lab.bench.costs import UNUSED, Unused, measure_memory, measure_unused
from physicslab.lab.bench.engine import PEERS, Engine, missing_peers
from physicslab.lab.bench.measure import measure_scene
from physicslab.lab.bench.plot import bench_picture
from physicslab.lab.bench.result import SceneResult
from physicslab.lab.bench.scene import BenchScene
from physicslab.lab.bench.tables import BenchReport, report_text, scene_text
from physicslab.lab.bench.whole_runs import WHOLE_PEERS, WholeReport, alike_jobs, random_jobs, whole_text
from physicslab.lab.jobs import Job
from physicslab.lab.peers.box2d3_built import BuildError, built_box2d
from physicslab.lab.peers.mirrors import Box2DMirror
from physicslab.lab.peers.peer import Peer
from physicslab.scenes import SCENES as BUILT_IN
from physicslab.world import World

_MEMORY, _UNUSED, _ADDED = "memory", "unused", "added"
_EXTRAS = _UNUSED, _ADDED, _MEMORY
_SIZE_LIMITS = {Box2DMirror.title: 2_000}
"""Bodies of the largest scene that an engine runs unless it is named; ``PEER_SIZE_LIMIT`` for others."""
_UNUSED_SIZE = 1_000
"""Bodies that timing the unused systems takes as long as."""


def execute(arguments: Namespace) -> int:
    """Time what was named, print the tables, and write the outputs that were chosen."""
    if arguments.list:
        return list_cases(SCENES)
    extras: list[str] = []
    scenes = chosen_cases(arguments.names, SCENES, partial(_opened, extras))
    if not arguments.names:
        scenes, extras = by_default(), [_UNUSED, _MEMORY]
    if arguments.random is not None and arguments.names:
        given = shown(arguments.names[0])
        raise CommandError(f"--random: draws its scenes, and takes none by name ({given})")
    if arguments.peers:
        _check_peers()
    elif arguments.like_quality:
        raise CommandError("--like-quality: is about other engines: add --peers")
    run = LabRun("bench", arguments, "bench")
    if arguments.random is not None or arguments.like_quality:
        return _run_whole(run, arguments, scenes)
    report = BenchReport(arguments.peers)
    with _other_engines(arguments) as peers:
        results: Iterator[SceneResult | Unused | Added]
        results = run.results(_jobs(scenes, extras, peers, arguments.names))
        for found in results:
            if isinstance(found, SceneResult):
                report.scenes.append(found)
                _note(run, scene_text(found))
            elif isinstance(found, Added):
                report.added.append(found)
            else:
                report.unused.append(found)
    if _MEMORY in extras:
        report.memory = measure_memory()
    _note(run, "")
    run.show(report_text(report))
    run.write(report.document)
    run.draw("bench", partial(bench_picture, report))
    for result in report.scenes:
        if result.ours.failure:
            raise CommandError(f"{result.scene.name}: {result.ours.failure}", FAILED)
    return 0


def _run_whole(run: LabRun, arguments: Namespace, scenes: list[BenchScene]) -> int:
    """Time whole runs of random scenes or of those that are named; print the slowest of them."""
    seed, first = arguments.seed
    with _other_engines(arguments, WHOLE_PEERS) as peers:
        series = "" if arguments.random is None else f"{seed}:{first}"
        report = WholeReport(series, [peer.title for peer in peers])
        jobs = random_jobs(seed, first, arguments.random, peers) if series else alike_jobs(scenes, peers)
        for found in run.results([*jobs]):
            report.found.append(found)
            _note(run, scene_text(found.result))
    _note(run, "")
    run.show(whole_text(report))
    run.write(report.document)
    return FAILED if any(found.result.ours.failure for found in report.found) else 0


def _opened(extras: list[str], name: str) -> BenchScene | None:
    """Return the built-in scene or the file of a name, or add what else it may name to the extras."""
    if name in _EXTRAS:
        extras.append(name)
        return None
    if name in BUILT_IN or os.path.exists(name):
        scene = opened(name)
        return replace(scene, name=printable(scene.name), title=printable(scene.title))
    known = f"the groups are {', '.join(SCENES.families)}; built-in scenes and files are taken as well"
    raise unknown_name(name, "scene", [*SCENES.names, *_EXTRAS, *BUILT_IN], known)


def _check_peers() -> None:
    if missing := missing_peers():
        verb = "is" if len(missing) == 1 else "are"
        raise CommandError(
            f"--peers: {' and '.join(missing)} {verb} not installed: uv sync --group peers, or "
            f"uv run --group peers physicslab bench --peers"
        )


@contextmanager
def _other_engines(
    arguments: Namespace, packages: tuple[type[Peer], ...] = PEERS
) -> Iterator[tuple[type[Peer], ...]]:
    """Return the engines that take part beside PhysicsLab; a compiled library is deleted afterwards."""
    peers = packages if arguments.peers else ()
    if arguments.box2d is None:
        yield peers
        return
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        try:
            built = built_box2d(arguments.box2d, Path(folder))
        except BuildError as error:
            raise CommandError(f"--box2d: {error}") from error
        yield (*peers, built)


def _jobs(
    scenes: list[BenchScene], extras: list[str], peers: tuple[type[Peer], ...], named: list[str]
) -> list[tuple[float, Job[SceneResult | Unused | Added]]]:
    """Return the work, with the bodies of each as how much of the whole it is."""
    jobs: list[tuple[float, Job[SceneResult | Unused | Added]]] = []
    for scene in scenes:
        beside = [
            peer for peer in peers
            if scene.size <= min(PEER_SIZE_LIMIT, _SIZE_LIMITS.get(peer.title, PEER_SIZE_LIMIT))
            or scene.name in named
        ]  # fmt: skip
        if scene.in_window:
            require_window(scene.name)
        make = _in_window if scene.in_window else Engine
        jobs.append((float(scene.size), measure_scene(scene, beside, make)))
    if _UNUSED in extras:
        jobs += [(float(_UNUSED_SIZE), measure_unused(name, *given)) for name, given in UNUSED.items()]
    if _ADDED in extras:
        jobs += [(float(BODIES), measure_added(what)) for what in ADDED]
    return jobs


def _in_window(world: World) -> Engine:
    """Return a world in a window that no screen shows."""
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # its greeting goes to stdout
    from physicslab.desktop.timed_window import InWindow

    return InWindow(world)


def _note(run: LabRun, text: str) -> None:
    """Print to stderr what is no part of the report."""
    if sys.stderr is not None:  # a program may be started without it
        run.show(text, sys.stderr)
