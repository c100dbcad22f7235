"""JSON that people read: one line for each key at the top, and one for each item of what holds many."""

import json
import re
from collections.abc import Iterator, Mapping


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
    return "".join(json_pieces(document))


def json_bytes(document: Mapping[str, object]) -> bytes:
    r"""Return a document as JSON in UTF-8, as it is written to a file.

    A file name that is not UTF-8 has bytes that Python keeps as half surrogate pairs, which strict readers of
    JSON refuse, escaped or not. They are written out, as on a terminal: a backslash, ``u``, four digits.

    Raises
    ------
    ValueError
        If a number in it is not finite.

    Examples
    --------
    >>> json_bytes({"scene": "caf\udce9"})
    b'{\n  "scene": "caf\\\\udce9"\n}\n'
    """
    text = json_text(document)
    try:
        return text.encode("utf-8")
    except UnicodeEncodeError:
        halves = re.sub("[\ud800-\udfff]", lambda half: f"\\\\u{ord(half[0]):04x}", text)
        return halves.encode("utf-8")


def json_pieces(document: Mapping[str, object]) -> Iterator[str]:
    """Yield the text of :func:`json_text` piece by piece, none longer than one item."""
    lead = "{\n"
    for key, value in document.items():
        yield f"{lead}  {_line(key)}: "
        yield from _value(value)
        lead = ",\n"
    yield "\n}\n" if document else "{\n\n}\n"


def _value(value: object) -> Iterator[str]:
    """Yield what stands behind a key; where all its items are lists or objects, one line an item."""
    if isinstance(value, dict) and value and all(isinstance(item, dict | list) for item in value.values()):
        items, ends = ((f"{_line(key)}: ", item) for key, item in value.items()), "{}"
    elif isinstance(value, list) and value and all(isinstance(item, dict | list) for item in value):
        items, ends = (("", item) for item in value), "[]"
    else:
        yield _line(value)
        return
    lead = ends[0]
    for key, item in items:
        yield f"{lead}\n    {key}{_line(item)}"
        lead = ","
    yield f"\n  {ends[1]}"


def _line(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)
