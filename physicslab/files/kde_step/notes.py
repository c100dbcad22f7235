"""Room for notes beside bodies: long ones are shortened, those that would cover a body stand beside it."""

import textwrap
from collections.abc import Sequence
from heapq import nsmallest

from physicslab.files.kde_step.draft import Box, Draft, Entity
from physicslab.files.kde_step.item import Pair

_ROOM, _BESIDE_GRAPHS = (640.0, 430.0), (320.0, 430.0)
"""Size of what is seen at first in a usual window, without its margin, and beside graphs [px]."""
_LETTER, _LINE, _PADDING = 7.0, 18.0, 18.0
"""Mean width of a letter, height of a line, and margin of a note [px]."""
_LETTERS, _LONG = 44, 2
"""Letters in a line of a note; a note of more lines than this is long."""
_MORE = " ..."
_NEAR = 32
"""So many boxes are looked at for a place beside them."""


def make_room_for_notes(draft: Draft) -> None:
    """Let notes cover neither bodies nor each other in the first view.

    Long ones are written in the description, and their first lines alone stand in a world that has bodies.
    """
    notes = [entity["Note"] for entity in draft.entities if "Note" in entity]
    if draft.extent is None:
        return
    room = _BESIDE_GRAPHS if any("Graph" in entity for entity in draft.entities) else _ROOM
    for note in notes if draft.bodies else ():
        if len(_written(note["text"])) > _LONG:
            _shorten(note, draft)
    draft.points += [corner for note in notes for corner in _corners(_box(note, _scale(draft.extent, room)))]
    metre = _scale(draft.extent, room)
    taken = [body.box for body in draft.bodies.values()]
    for note in notes:
        box = _box(note, metre)
        if not _is_free(box, taken):
            box = _nearest_free(box, taken)
            note["place"] = [box[0], box[3]]
            draft.points += _corners(box)
        taken.append(box)


def _shorten(note: Entity, draft: Draft) -> None:
    """Leave the first line of a note, and write all of it in the description, if it is not there already."""
    if not any(text.startswith(note["text"].removesuffix(_MORE)) for text in draft.texts):
        draft.texts.append(note["text"])
    note["text"] = note["text"].splitlines()[0][: _LETTERS - len(_MORE)] + _MORE


def _scale(extent: Box, room: tuple[float, float]) -> float:
    """Return how many pixels a metre has if all of a part of the world [m] is seen in a room [px]."""
    left, low, right, high = extent
    return min(room[0] / max(right - left, 1e-300), room[1] / max(high - low, 1e-300))


def _corners(box: Box) -> list[Pair]:
    return [box[:2], box[2:]]


def _written(text: str) -> list[str]:
    """Return the lines of a note as the window breaks them."""
    return [part for line in text.split("\n") for part in textwrap.wrap(line, _LETTERS) or [""]]


def _box(note: Entity, metre: float) -> Box:
    """Return what a note covers, its upper left corner at its place, for so many pixels a metre [m]."""
    lines = _written(note["text"])
    width = (_LETTER * max(map(len, lines)) + _PADDING) / metre
    height = (_LINE * len(lines) + _PADDING) / metre
    x, y = note["place"]
    return x, y - height, x + width, y


def _is_free(box: Box, taken: Sequence[Box]) -> bool:
    """Whether a box lies over none of others [m]."""
    return not any(
        box[0] < right and left < box[2] and box[1] < high and low < box[3]
        for left, low, right, high in taken
    )


def _nearest_free(box: Box, taken: Sequence[Box]) -> Box:
    """Return the place nearest to that of a box, beside others or above all, where it is free [m]."""
    left, low, right, high = box
    width, height = right - left, high - low
    near = nsmallest(
        _NEAR, taken, lambda one: abs(one[0] + one[2] - left - right) + abs(one[1] + one[3] - low - high)
    )
    columns = [left, *(at for one in near for at in (one[2], one[0] - width))]
    rows = [low, max(one[3] for one in taken), *(at for one in near for at in (one[3], one[1] - height))]
    places = sorted((abs(x - left) + abs(y - low), x, y) for x in columns for y in rows)
    boxes = ((x, y, x + width, y + height) for _, x, y in places)
    return next(one for one in boxes if _is_free(one, taken))
