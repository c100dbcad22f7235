"""The name of an entity."""

from dataclasses import dataclass
from typing import ClassVar

from physicslab.ecs.text import has_width, is_line

_LENGTH_LIMIT = 200
"""Characters of an id: it stands in reports, in labels and in messages, which are a line each."""


@dataclass(frozen=True, slots=True)
class Name:
    """The id of an entity in scene files and reports. A plain esper component: words have no column."""

    physical: ClassVar[bool] = False
    id: str


def why_no_id(value: object) -> str | None:
    """Return what an id must be, if this cannot be one.

    >>> why_no_id(""), why_no_id("ball")
    ('a text that is not empty', None)
    """
    if not isinstance(value, str) or not is_line(value):
        return "a text on one line"
    if not value.strip():
        return "a text that is not empty"
    if not has_width(value):
        return "a text in which something can be seen"
    return None if len(value) <= _LENGTH_LIMIT else f"a text of at most {_LENGTH_LIMIT} characters"
