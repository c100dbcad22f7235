"""Actions of lessons: opened, gone through, run and left."""

from functools import cache, partial
from pathlib import Path

from physicslab.ecs.quantity_text import InvalidText
from physicslab.ecs.text import printable
from physicslab.files.checks import SceneError
from physicslab.lessons.answers import asked
from physicslab.lessons.catalogue import find_lesson
from physicslab.lessons.lesson import Run
from physicslab.lessons.setup import AS_IT_IS, Case
from physicslab.state.contents import LEVELS, Desk
from physicslab.state.masses import Diverged
from physicslab.view.window.desk import desk_of, restore_desk
from physicslab.view.window.lesson import OpenLesson
from physicslab.view.window.window import Window
from physicslab.world import World

_IN_HAND = "select"
"""The tool of lessons: a click on empty space makes nothing in them."""


def open_lesson(world: World, window: Window, name: str) -> str:
    """Open a lesson by its name, or that of a file; the scene that is shown waits until it is left.

    Return why it cannot be opened; all stays as it is then.
    """
    try:
        lesson = find_lesson(name, window.language)
        window.put_down(world)
        desk = desk_of(window) if window.lesson is None else window.lesson.desk
        tool = window.tool if window.lesson is None else window.lesson.tool
        find = cache(partial(find_lesson, language=window.language))  # its panel is built in each frame
        list(asked(lesson, find))  # each question that it recalls is there
        opened = OpenLesson(lesson, name, Path.cwd(), window.own, desk, tool, find)
    except (SceneError, InvalidText, OSError) as error:
        reason = f"Not opened: {error}"
        window.notify(reason, 8.0, failed=True)
        return reason
    window.lesson = opened
    window.scenes.opening, window.scenes.shows_gallery = None, False
    window.scenes.tag = ""
    shown = frozenset(lesson.setup.shown) | ({"grid"} if window.grid else set())
    restore_desk(window, Desk(LEVELS[0], shown))
    window.tool, window.pace.paused = _IN_HAND, True
    window.scenes.next_world = opened.world
    taken_up = f", with the answers of {printable(opened.path.name)}" if opened.given else ""
    window.notify(f"Opened {lesson.title}{taken_up}", 5.0)
    return ""


LANGUAGES = {"en": "English", "de": "Deutsch"}
"""Names of languages in themselves, by their codes."""


def choose_language(world: World, window: Window, code: str) -> None:
    """Take another language; a lesson that is open is opened in it, at the step where it is."""
    window.language, lesson = code, window.lesson
    if lesson is not None:
        step = lesson.step
        open_lesson(world, window, lesson.source)
        go_to_step(world, window, step)


def leave_lesson(world: World, window: Window) -> None:
    """Leave the lesson; what was shown before it is shown again, as it was."""
    lesson = window.lesson
    if lesson is None:
        return
    window.scenes.next_world = lesson.before.history.world
    kept = f"; its answers are in {printable(lesson.path.name)}" if lesson.given else ""
    window.notify(f"Left {lesson.lesson.title}{kept}", 5.0)


def end_lesson(window: Window, lesson: OpenLesson) -> None:
    """Open all again that a lesson had shut: another scene is shown from now on."""
    window.lesson = None
    restore_desk(window, lesson.desk)
    window.tool = lesson.tool


def go_to_step(world: World, window: Window, step: int) -> None:
    """Show another step of the lesson, with the scene of its run."""
    if window.lesson is not None:
        window.scenes.next_world = window.lesson.go_to(step)
        window.pace.paused = True


def begin_run(world: World, window: Window, run: Run, case: Case = AS_IT_IS) -> None:
    """Make a run of the lesson, as it is or in another case."""
    if window.lesson is None:
        return
    try:
        window.scenes.next_world = window.lesson.begin(run, case)
    except (SceneError, InvalidText, Diverged) as error:
        window.notify(f"No run: {error}", 6.0, failed=True)
        return
    window.pace.paused = False


def opener(name: str) -> partial[str]:
    """Return the action that opens a lesson."""
    return partial(open_lesson, name=name)
