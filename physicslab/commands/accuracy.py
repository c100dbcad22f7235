"""Measure error against run time, for every integrator, on problems with known answers or on a scene."""

from __future__ import annotations

import os
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from functools import partial

from physicslab.commands.command_error import FAILED, CommandError
from physicslab.commands.lab import LabRun, add_lab_arguments, chosen_cases, list_cases, unknown_name
from physicslab.commands.numbers import positive_duration
from physicslab.ecs.text import printable
from physicslab.files.scene import load_scene
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.lab.accuracy.document import document
from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.scene_study import DEFAULT_S, SceneStudy, study_scene
from physicslab.lab.accuracy.study import Study, study
from physicslab.lab.accuracy.tables import left_out_text, scene_text, study_text, summary_text
from physicslab.lab.case import Job
from physicslab.scenes import SCENES

__all__ = ["add_arguments", "execute"]


def add_arguments(parser: ArgumentParser) -> None:
    """Declare what the command takes."""
    what = "a problem, a family of them, a built-in scene or a scene file; every problem, sparsely, if none"
    add_lab_arguments(parser, "problem", what, "draw a work-precision plot of each problem, as PNG")
    seconds = f"how long scenes are run, in their time ({DEFAULT_S:g})"
    parser.add_argument("--seconds", metavar="T", type=positive_duration, default=DEFAULT_S, help=seconds)
    parser.epilog = f"families: {', '.join(PROBLEMS.families)}; --list names the {len(PROBLEMS)} problems"


def execute(arguments: Namespace) -> int:
    """Study what was named, print a table of each, and write the outputs that were chosen."""
    if arguments.list:
        return list_cases(PROBLEMS)
    scenes: dict[str, None] = {}
    problems = chosen_cases(arguments.names, PROBLEMS, partial(_scene, scenes))
    if not arguments.names:
        problems = list(PROBLEMS.values())
    run = LabRun("accuracy", arguments, "accuracy")
    jobs: list[tuple[float, Job[Study | SceneStudy]]] = [
        (1.0, study(problem, sparse=not arguments.names)) for problem in problems
    ]
    jobs += [
        (1.0, study_scene(printable(name), partial(load_scene, name), arguments.seconds)) for name in scenes
    ]
    studies: list[Study] = []
    scene_studies: list[SceneStudy] = []
    results: Iterator[Study | SceneStudy] = run.results(jobs)
    for result in results:
        if isinstance(result, Study):
            studies.append(result)
            run.show(study_text(result, whole=len(problems) == 1))
            run.draw(result.problem.name, partial(_plot, result))
        else:
            scene_studies.append(result)
            run.show(scene_text(result))
    if studies:
        run.show(summary_text(studies))
    if not arguments.names:
        run.show(left_out_text())
    run.write(document(studies, scene_studies))
    for found in scene_studies:
        if found.rows[0].failure:
            raise CommandError(f"{found.name}: {found.rows[0].failure}", FAILED)
    return 0


def _scene(scenes: dict[str, None], name: str) -> Problem | None:
    """Add a name that is no problem to the scenes, if it is one that can be read."""
    if name not in SCENES and not os.path.exists(name):
        known = f"the problems are {', '.join(PROBLEMS.families)}; scenes are taken as well"
        raise unknown_name(name, "problem, scene or file", [*PROBLEMS.names, *SCENES], known)
    load_scene(name)  # a bad scene is refused before work is begun
    scenes[name] = None
    return None


def _plot(found: Study) -> bytes:
    from physicslab.lab.accuracy.plot import work_precision  # matplotlib takes a while, and may not be there

    return work_precision(found)
