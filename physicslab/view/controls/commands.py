"""All that can be done, opened or plotted, as one list that is searched by a few letters."""

import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache, partial

from physicslab.components.quantities import QUANTITIES
from physicslab.ecs.text import printable
from physicslab.files.listing import scenes_here
from physicslab.languages.catalogue import languages
from physicslab.languages.language import Language
from physicslab.lessons.catalogue import openings
from physicslab.scenes import SCENES
from physicslab.view.controls import actions, dashboard_actions
from physicslab.view.controls.choosing_keys import label_of
from physicslab.view.controls.controls import CONTROLS
from physicslab.view.controls.file_actions import open_from_list
from physicslab.view.controls.lesson_actions import LANGUAGES, choose_language, opener
from physicslab.view.controls.tools import TOOLS, key_of
from physicslab.view.window.desk import LEVELS
from physicslab.view.window.window import Action, Window
from physicslab.world import World

SHOWN = 10
"""So many are found at most."""
_APART, _START, _RUN = 1.0, 3.0, 2.0
"""Score of a letter: anywhere, at the start of a word, and right after the letter found before."""
_LEAST = 1.5
"""The least average score of letters of a match."""
_SPREAD = 0.3
"""Cost of a letter between them."""
_OF_ALSO = 0.9
"""A match in further words has this share of the score of one in a name."""
_OF_TIP = 0.3
"""A match in a tip has this share of the score of one in a name."""


@dataclass(frozen=True, slots=True)
class Command:
    """One line of the list.

    Attributes
    ----------
    words, keys, tip : str
        Its name, its keys or its kind, and its effect in words.
    action : callable
        The action on choice.
    also : tuple of str
        Further words that find it.
    """

    words: str
    keys: str
    tip: str
    action: Action
    also: tuple[str, ...] = ()


def commands(window: Window | None = None) -> Iterator[Command]:
    """Yield every command there is: keys and menus, tools, levels, scenes, and graphs of quantities.

    Keys are those that were chosen in the window, or the usual ones.
    """
    for control in CONTROLS:
        if control.group and control.label != "Ctrl+K":
            keys = control.label if window is None else label_of(control, window)
            yield Command(control.title, keys, control.tip, control.pressed)
    named = {control.tool.name for control in CONTROLS if control.group and control.tool is not None}
    for tool in TOOLS.values():
        if tool.name not in named:
            yield Command(
                tool.title, key_of(tool) or "tool", tool.usage, partial(actions.choose_tool, tool=tool)
            )
    for level, words in LEVELS.items():
        yield Command(f"Level: {level}", "level", words, partial(_choose_level, level=level))
    for code in languages():
        name, tip = LANGUAGES.get(code, code), "The language of the window and of lessons"
        yield Command(name, "language", tip, partial(choose_language, code=code))
    for name, scene in SCENES.items():
        opens = partial(open_from_list, source=name)
        yield Command(scene.title, "scene", scene.description, opens, scene.search_words)
    english = openings()
    for name, one in openings("" if window is None else window.language).items():
        yield Command(one.title, "lesson", one.text, opener(name), (name, one.needs, *english[name]))
    for path in scenes_here():
        yield Command(printable(path.name), "file", str(path), partial(open_from_list, source=path))
    for name, quantity in QUANTITIES.items():
        of = "of the selection" if quantity.of_entity else "of the world"
        yield Command(f"Graph: {name}", "graph", of, partial(dashboard_actions.plot_quantity, name=name))


def _choose_level(world: World, window: Window, level: str) -> None:
    window.level, window.figures = level, True


def find(text: str, among: list[Command], said: Language) -> list[Command]:
    """Return what fits a text best, the best first: all its words are in the name, or in the tip.

    The letters of a word stand there in this order, with others between them. Names and tips are searched as
    they are said in a language, and as the program has them.
    """
    wanted = plain(text).split()
    rated = []
    for command in among:
        names, tips = spellings(command.words, said), spellings(command.tip, said)
        texts = [(_OF_TIP, tip) for tip in tips]
        texts += [(_OF_ALSO, one) for words in command.also for one in spellings(words, said)]
        parts = [
            max(*(rate(word, name) for name in names), *(k * _rate_whole(word, one) for k, one in texts))
            for word in wanted
        ]
        if all(parts):
            rated.append((sum(parts) - 0.01 * len(command.words), command))
    rated.sort(key=lambda one: -one[0])
    return [command for _, command in rated[:SHOWN]]


_UMLAUTS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue"})


_KEPT = 8192
"""How many texts are kept as they are searched: every letter that is typed searches all of them."""


def spellings(text: str, said: Language) -> set[str]:
    """Return how people may write a text, in English and as it is said: an umlaut by one letter or two."""
    shown = said.reword(text).casefold()
    return {plain(text), plain(shown), shown.translate(_UMLAUTS)}


@lru_cache(_KEPT)
def plain(text: str) -> str:
    """Return a text in small letters, without the marks above them.

    >>> plain("Löschen"), plain("Größe")
    ('loschen', 'grosse')
    """
    return "".join(
        one for one in unicodedata.normalize("NFD", text.casefold()) if not unicodedata.combining(one)
    )


def rate(word: str, within: str) -> float:
    """Return how well the letters of a word are found in a text, in their order; 0 where they are not.

    The first of them begins a word of the text.

    >>> rate("gravity", "gravity") > rate("gvty", "gravity") > rate("ravt", "gravity") == 0.0
    True
    """
    if rating := _rate_whole(word, within):
        return rating
    text, rating, last = f" {within}", 0.0, 0
    for letter in word:
        at, initial = text.find(letter, last + 1), text.find(f" {letter}", last) + 1
        if last == 0 or (initial and at != last + 1):
            at = initial  # that of a later word is meant more often than a letter within one
        if at <= 0:
            return 0.0
        rating += _RUN if 0 < last == at - 1 else _START if at == initial else _APART
        last = at
    between = last - text.find(f" {word[0]}") - len(word)
    return max(rating - _SPREAD * between, _SPREAD) if rating > _LEAST * len(word) else 0.0


def _rate_whole(word: str, within: str) -> float:
    """Return how well a text holds a word as it is written."""
    at = f" {within}".find(f" {word}")
    found = at >= 0 or word in within
    return len(word) * (_RUN + (_START if at >= 0 else _APART)) if found else 0.0


def run(world: World, window: Window, command: Command) -> None:
    """Do what was found, and close the search."""
    window.search = None
    command.action(world, window)
