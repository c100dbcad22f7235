"""Measure error against run time, for every integrator, on problems with known answers or on a scene."""

import os
from argparse import Namespace
from collections.abc import Iterable, Iterator, Sequence
from functools import partial

from physicslab.commands import FAILED, CommandError
from physicslab.commands.lab import LabRun, chosen_cases, list_cases, unknown_name
from physicslab.ecs.text import printable
from physicslab.files.scene import load_scene
from physicslab.lab.accuracy import tables
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.lab.accuracy.contacts.catalogue import CONTACTS, CONVERGENCE
from physicslab.lab.accuracy.contacts.study import OWN, ContactCase, ContactStudy, study_case
from physicslab.lab.accuracy.honesty.study import FAMILIES, HonestRow, assess_known
from physicslab.lab.accuracy.plot import case_plot, overview, work_precision
from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.scene_study import SceneStudy, study_scene
from physicslab.lab.accuracy.study import Study, study
from physicslab.lab.accuracy.tables import document, trust_document
from physicslab.lab.accuracy.trust import Trust, TrustRow, assess, assess_contacts, assess_problem, moments_of
from physicslab.lab.jobs import Job
from physicslab.scenes import SCENES

_CONTACTS = "contacts"
"""The name of the whole second page."""
_DRAWN = 10
"""How many random scenes of each family estimates are judged by."""
_LOOKS = 24
"""How often digits are counted in a run of a scene."""


def execute(arguments: Namespace) -> int:
    """Study what was named, print a table of each, and write the outputs that were chosen."""
    if arguments.list:
        return max(list_cases(PROBLEMS), list_cases(CONTACTS))
    scenes: dict[str, None] = {}
    contacts: dict[str, ContactCase] = {}
    problems = chosen_cases(arguments.names, PROBLEMS, partial(_other, scenes, contacts))
    sparse = not arguments.names
    if sparse:
        problems, contacts = list(PROBLEMS.values()), CONTACTS
    run = LabRun("accuracy", arguments, "accuracy")
    if arguments.trust:
        _trust(run, problems, contacts.values(), scenes, arguments.seconds, drawn=_DRAWN if sparse else 0)
        return 0
    jobs: list[tuple[float, Job[Study | ContactStudy | SceneStudy]]] = [
        *((1.0, study(problem, sparse=sparse)) for problem in problems),
        *((1.0, study_case(case, sparse=sparse)) for case in contacts.values()),
        *(
            (1.0, study_scene(printable(name), partial(load_scene, name), arguments.seconds))
            for name in scenes
        ),
    ]
    studies: list[Study] = []
    contact_studies: list[ContactStudy] = []
    scene_studies: list[SceneStudy] = []
    results: Iterator[Study | ContactStudy | SceneStudy] = run.results(jobs)
    for result in results:
        match result:
            case Study():
                studies.append(result)
                run.show(tables.study_text(result, whole=len(problems) == 1))
                run.draw(result.problem.name, partial(work_precision, result))
            case ContactStudy():
                contact_studies.append(result)
                run.show(tables.contact_text(result))
                run.draw(result.case.name, partial(case_plot, result))
            case SceneStudy():
                scene_studies.append(result)
                run.show(tables.scene_text(result))
    if studies:
        run.show(tables.summary_text(studies))
    if contact_studies:
        run.show(tables.contact_summary(contact_studies))
        _draw_overviews(run, contact_studies)
    if sparse:
        run.show(tables.left_out_text())
    run.write(document(studies, scene_studies, contact_studies))
    for found in scene_studies:
        if found.rows[0].failure:
            raise CommandError(f"{found.name}: {found.rows[0].failure}", FAILED)
    return 0


def _trust(
    run: LabRun, problems: Sequence[Problem], contacts: Iterable[ContactCase], scenes: Iterable[str],
    seconds: float, *, drawn: int,
) -> None:  # fmt: skip
    """Write how good estimates of errors are where answers are known, and what to rely on in scenes.

    ``drawn`` is how many random scenes of each family are among the former.
    """
    jobs: list[Job[TrustRow]] = [assess_problem(problem) for problem in problems if problem.search is None]
    jobs += [assess_contacts(case, engine) for case in contacts for engine in OWN]
    rows: list[TrustRow] = list(run.results([(1.0, job) for job in jobs]))
    found: dict[str, Trust] = {}
    for name in scenes:
        load, shown = partial(load_scene, name), printable(name)
        moments = moments_of(seconds, load().simulation.dt, _LOOKS)
        (found[shown],) = run.results([(1.0, assess(load, seconds, moments))])
        run.show(tables.trust_text(shown, found[shown]))
    random = [assess_known(family, seed) for family in FAMILIES for seed in range(drawn)]
    honest: list[HonestRow] = list(run.results([(1.0, job) for job in random]))
    if rows:
        run.show(tables.trust_rows_text(rows))
    if honest:
        run.show(tables.honest_text(honest))
    run.write(trust_document(rows, found, honest))


def _other(scenes: dict[str, None], contacts: dict[str, ContactCase], name: str) -> Problem | None:
    """Add a name that is no problem to the contact cases or to the scenes, if it is one that can be read."""
    found = list(CONTACTS.values()) if name == _CONTACTS else CONTACTS.select(name)
    if found:
        contacts |= {case.name: case for case in found}
        return None
    if name not in SCENES and not os.path.exists(name):
        families = ", ".join([*PROBLEMS.families, *CONTACTS.families])
        known = f"the problems are {families}; scenes are taken as well"
        names = [*PROBLEMS.names, *CONTACTS.names, _CONTACTS, *SCENES]
        raise unknown_name(name, "problem, scene or file", names, known)
    load_scene(name)  # a bad scene is refused before work is begun
    scenes[name] = None
    return None


def _draw_overviews(run: LabRun, found: list[ContactStudy]) -> None:
    """Draw the cases whose order is looked at in one picture, where all of them were studied."""
    shown = [study for study in found if study.case.name in CONVERGENCE]
    if len(shown) == len(CONVERGENCE):
        for by in ("step", "cost"):
            run.draw(f"contacts_{by}", partial(overview, shown, by))
