"""Measure error against run time, for every integrator, on problems with known answers or on a scene."""

from __future__ import annotations

import os
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

from physicslab.commands.command_error import FAILED, CommandError
from physicslab.commands.output import Output
from physicslab.commands.pictures import picture_directory
from physicslab.commands.progress import Progress
from physicslab.files.checks import printable, shown, suggestion
from physicslab.files.json_text import json_bytes
from physicslab.files.scene import load_scene
from physicslab.lab.accuracy.catalogue import PROBLEMS, families, names, select
from physicslab.lab.accuracy.document import document
from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.scene_study import SceneStudy, scene_document, scene_text, study_scene
from physicslab.lab.accuracy.study import Study, study
from physicslab.lab.accuracy.tables import left_out_text, study_text, summary_text
from physicslab.scenes import SCENES

__all__ = ["add_arguments", "execute"]


def add_arguments(parser: ArgumentParser) -> None:
    """Declare what the command takes."""
    what = "a problem, a family of them, a built-in scene or a scene file; every problem, sparsely, if none"
    parser.add_argument("problems", metavar="PROBLEM", nargs="*", help=what)
    parser.add_argument("--json", metavar="FILE", help="write everything that was measured (- for stdout)")
    parser.add_argument("--plot", metavar="DIR", help="draw a work-precision plot of each problem, as PNG")
    parser.add_argument("--list", action="store_true", help="name every problem and variant, and run none")
    parser.epilog = f"problems: {', '.join(families())}; --list names all {len(names())} with their variants"


def execute(arguments: Namespace) -> int:
    """Study what was named, print a table of each, and write what was asked for."""
    if arguments.list:
        print("\n".join(names()))
        return 0
    problems, scenes = _chosen(arguments.problems)
    output = None if arguments.json is None else Output("--json", arguments.json)
    pictures = None if arguments.plot is None else picture_directory(arguments.plot, "accuracy.png")
    quiet = output is not None and output.to_stdout
    whole = len(problems) == 1
    jobs: list[Iterator[float | Study] | Iterator[float | SceneStudy]] = [
        study(problem, sparse=not arguments.problems) for problem in problems
    ]
    jobs += [study_scene(printable(name), partial(load_scene, name)) for name in scenes]
    studies: list[Study] = []
    scene_studies: list[SceneStudy] = []
    for result in _results(jobs):
        if isinstance(result, Study):
            studies.append(result)
            _show(study_text(result, whole=whole), quiet)
            if pictures is not None:
                _draw(result, pictures)
        else:
            scene_studies.append(result)
            _show(scene_text(result), quiet)
    if studies:
        _show(summary_text(studies), quiet)
    if not arguments.problems:
        _show(left_out_text(), quiet)
    if output is not None:
        scenes_found = [scene_document(found) for found in scene_studies]
        output.write(json_bytes(document(studies, scenes_found)))
    _check_scenes(scene_studies)
    return 0


def _chosen(wanted: Sequence[str]) -> tuple[list[Problem], list[str]]:
    """Return the problems and the scenes of these names, each once.

    Raises
    ------
    CommandError
        If there is neither of a name.
    SceneError
        If a scene cannot be read.
    """
    if not wanted:
        return list(PROBLEMS.values()), []
    problems: dict[str, Problem] = {}
    scenes: dict[str, None] = {}
    for name in wanted:
        found = select(name)
        if not found and name not in SCENES and not os.path.exists(name):
            likely = suggestion(name, [*names(), *SCENES])
            there_is = f"the problems are {', '.join(families())}; scenes are taken as well"
            raise CommandError(f"{shown(name)}: is no problem, scene or file{likely or '; ' + there_is}")
        problems |= {problem.name: problem for problem in found}
        if not found:
            load_scene(name)  # a bad scene is refused before work is begun
            scenes[name] = None
    return list(problems.values()), list(scenes)


def _results(jobs: Sequence[Iterator[float | Study | SceneStudy]]) -> Iterator[Study | SceneStudy]:
    """Yield the result of each job, and keep the terminal told how far all are."""
    progress = Progress("accuracy", sys.stderr)
    try:
        for i, job in enumerate(jobs):
            for found in job:
                if not isinstance(found, float):
                    progress.clear()
                    yield found
                else:
                    progress.show((i + found) / len(jobs))
    finally:
        progress.clear()


def _show(text: str, quiet: bool) -> None:
    if not quiet:
        print(text, flush=True)


def _draw(found: Study, directory: Path) -> None:
    from physicslab.lab.accuracy.plot import work_precision  # matplotlib takes a while, and may not be there

    Output("--plot", str(directory / f"{found.problem.name}.png")).write(work_precision(found))


def _check_scenes(studies: Sequence[SceneStudy]) -> None:
    for found in studies:
        if found.rows[0].failure:
            raise CommandError(f"{found.name}: {found.rows[0].failure}", FAILED)
