"""JSON that people read: one line for each key at the top, and one for each item of what holds many."""

from __future__ import annotations

import json
from collections.abc import Mapping

__all__ = ["json_text"]


def json_text(document: Mapping[str, object]) -> str:
    """Return a document as JSON text, with every bit of its numbers.

    Raises
    ------
    ValueError
        If a number in it is not finite: JSON has no such numbers.

    Examples
    --------
    >>> print(json_text({"name": "drop", "entities": [{"id": "floor"}, {"id": "ball"}]}), end="")
    {
      "name": "drop",
      "entities": [
        {"id": "floor"},
        {"id": "ball"}
      ]
    }
    """
    return "{\n" + ",\n".join(f"  {_line(key)}: {_value(value)}" for key, value in document.items()) + "\n}\n"


def _value(value: object) -> str:
    """Return what stands behind a key; where all its items are lists or objects, one line an item."""
    if isinstance(value, dict) and value and all(isinstance(item, dict | list) for item in value.values()):
        items, ends = [f"{_line(key)}: {_line(item)}" for key, item in value.items()], "{}"
    elif isinstance(value, list) and value and all(isinstance(item, dict | list) for item in value):
        items, ends = [_line(item) for item in value], "[]"
    else:
        return _line(value)
    return ends[0] + "\n    " + ",\n    ".join(items) + "\n  " + ends[1]


def _line(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)
