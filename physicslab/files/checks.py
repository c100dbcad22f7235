"""How a scene is refused: in one line that names the place, the value and what is allowed."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from physicslab.ecs.fields import MEASURED, Field
from physicslab.ecs.text import SHORT, has_width, is_line, printable, shortened, suggestion
from physicslab.ecs.value_text import is_written

_BREAKS = dict.fromkeys(map(ord, "\n\t"), " ")


class SceneError(ValueError):
    """A scene that cannot be read, written or found; the message is one line: where and why."""


class JsonObject(dict[str, Any]):
    """An object of a JSON text that remembers a key that stood in it twice.

    A plain ``dict`` keeps the last of the two, without an error.
    """

    repeated: str | None = None

    @classmethod
    def of(cls, pairs: Sequence[tuple[str, Any]]) -> JsonObject:
        """Make the object of its keys and values; an ``object_pairs_hook`` for ``json.loads``."""
        made = cls(pairs)
        if len(made) < len(pairs):
            seen: set[str] = set()
            for key, _ in pairs:
                if key in seen:
                    made.repeated = key
                seen.add(key)
        return made


def refusal(where: str, value: object, allowed: str) -> SceneError:
    """Return the error for ``value`` at ``where``, of which ``allowed`` says in words what it must be.

    >>> print(refusal('drop.json: entity "ball": Mass.mass', -1, "a finite number > 0 kg"))
    drop.json: entity "ball": Mass.mass = -1: must be a finite number > 0 kg
    """
    return SceneError(f"{where} = {shown(value)}: must be {allowed}")


def shown(value: object) -> str:
    r"""Return a value as it would stand in a scene file: on one line, printable, and shortened if it is long.

    >>> shown([1, None, "two\nlines"])
    '[1, null, "two\\nlines"]'
    """
    if isinstance(value, str) and value.isalnum() and len(value) < SHORT:  # as most ids are: a quick test
        return f'"{value}"'
    try:
        text = json.dumps(_beginning(value), ensure_ascii=False, default=repr)
    except (ValueError, RecursionError):  # a whole number of thousands of digits, or lists without end
        text = f"<{type(value).__name__}>"
    text = printable(text)
    return shortened(text)


def _beginning(value: object) -> object:
    """Return as much of a value as can be shown: a whole one may be as long as the file it stood in."""
    if isinstance(value, str):
        return value[: SHORT + 1]
    if isinstance(value, list | tuple):
        return [_beginning(item) for item in value[:SHORT]]
    if isinstance(value, dict):
        return {
            key[:SHORT] if isinstance(key, str) else key: _beginning(item)
            for key, item in itertools.islice(value.items(), SHORT)
        }
    return value


def checked_object(value: object, where: str, allowed: str) -> Mapping[str, Any]:
    """Return an object of the document, no key of which was given twice."""
    if not isinstance(value, dict):
        raise refusal(where, value, allowed)
    if isinstance(value, JsonObject) and value.repeated is not None:
        raise SceneError(f"{where}: the key {shown(value.repeated)} is given twice; must be given once")
    return value


def checked_rows(value: object, where: str, allowed: str) -> Iterator[tuple[str, Any]]:
    """Yield the place, as a message names it, and the value of each item of a list."""
    if not isinstance(value, list):
        raise refusal(where, value, allowed)
    for index, row in enumerate(value):
        yield f"{where}[{index}]", row


_LISTED = 24
"""Names that a message lists."""


def checked_keys(given: Mapping[str, Any], where: str, noun: str, known: Sequence[str]) -> None:
    """Refuse the first key that is not ``known``; ``noun`` is what keys are called there."""
    for key, value in given.items():
        if key not in known:
            plain = isinstance(key, str) and key.isidentifier() and len(key) <= SHORT
            name = key if plain else shown(key)
            likely = suggestion(str(key), known)
            more = f", or of {len(known) - _LISTED} more" if len(known) > _LISTED else ""
            allowed = (", ".join(known[:_LISTED]) or "none") + more
            raise SceneError(
                f"{where}{name} = {shown(value)}: unknown {noun}; must be one of {allowed}{likely}"
            )


def refuse_written(given: Mapping[str, Any], fields: Mapping[str, Field], where: str) -> None:
    """Refuse numbers that are texts: a file has SI numbers, whatever reads it."""
    for name, value in given.items():
        if name in fields and is_written(value) and fields[name].kind in MEASURED:
            raise refusal(f"{where}{name}", value, fields[name].allowed)


def checked_text(value: object, where: str, *, lines: bool = False) -> str:
    """Return a text without half surrogate pairs or control characters (but new lines, if ``lines``)."""
    if isinstance(value, str) and is_line(value.translate(_BREAKS) if lines else value):
        return value
    raise refusal(where, value, "a text" if lines else "a text on one line")


def checked_title(value: object, where: str, longest: int) -> str:
    """Return a text on one line of at most ``longest`` characters: empty, or with something to be seen.

    A text of joiners and marks of direction alone has no width, and a font refuses to draw it.
    """
    text = checked_text(value, where)
    if len(text) > longest:
        raise refusal(where, text, f"a text of at most {longest} characters")
    if text and not has_width(text):
        raise refusal(where, text, "a text in which something can be seen, or empty")
    return text


def is_number(value: object) -> bool:
    """Whether this is a finite number that an int64 or a float64 can hold.

    >>> is_number(2**63), is_number(float("nan")), is_number(True), is_number(1)
    (False, False, False, True)
    """
    if isinstance(value, bool):
        return False
    if isinstance(value, int):
        return -(2**63) <= value < 2**63
    return isinstance(value, float) and math.isfinite(value)
