"""Words in a line: what can be printed, how long they may be, names that differ; texts in columns."""

import difflib
import itertools
import re
import unicodedata
from collections.abc import Container, Iterable

from physicslab.ecs.interned import Interned

SHORT = 60
"""Characters of a value, a key or a name that a message shows."""


_LISTED = 80
"""Characters of the known words that the refusal of a name lists."""
_SUGGESTED_FROM = 2_000
"""Known words that a misspelt one is compared with."""


def has_width(text: str) -> bool:
    r"""Whether a text has a letter, sign or symbol that can be seen.

    >>> has_width("a"), has_width("\u200b\u200d"), has_width(" ")
    (True, False, False)
    """
    return any(unicodedata.category(c)[0] not in "CZM" or unicodedata.category(c) == "Co" for c in text)


def is_line(text: str) -> bool:
    r"""Whether a text has neither half surrogate pairs nor control characters nor breaks of lines.

    >>> is_line("caf\u00e9"), is_line("a\nb"), is_line("\u2028")
    (True, False, False)
    """
    if text.isprintable():  # as nearly every text is, and quick to find
        return True
    return not {unicodedata.category(c) for c in text} & {"Cc", "Cs", "Zl", "Zp"}


def printable(text: str) -> str:
    r"""Return a text with everything that a terminal would not print written as an escape.

    >>> print(printable("a\x1b[2Jb"))
    a\x1b[2Jb
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def shortened(text: str, length: int = SHORT) -> str:
    """Return a text of at most ``length`` characters, the end of a longer one left out.

    >>> shortened("x" * 1000, 8), shortened("drop", 8)
    ('xxxxx...', 'drop')
    """
    return text if len(text) <= length else f"{text[: length - 3]}..."


def suggestion(word: str, known: Iterable[str]) -> str:
    """Return ``"; did you mean ...?"`` with the likeliest of the ``known`` words, or nothing.

    >>> suggestion("Velocty", ["Transform", "Velocity"])
    '; did you mean "Velocity"?'
    """
    # Comparing takes time with the square of a word's length, and with the number of words.
    likely = difflib.get_close_matches(word[:SHORT], list(itertools.islice(known, _SUGGESTED_FROM)), n=1)
    return f'; did you mean "{shortened(printable(likely[0]))}"?' if likely else ""


def no_such(owner: str, sort: str, name: str, known: Iterable[str], others: Iterable[str] = ()) -> str:
    """Return the refusal of a name: which there are, and the likeliest of these and of some ``others``.

    >>> print(no_such("Velocity", "field", "liner", ["linear", "angular"]))
    Velocity has no field 'liner'; it has linear, angular; did you mean "linear"?
    """
    words = list(known)
    listed = shortened(printable(", ".join(words)), _LISTED) or "none"
    return f"{owner} has no {sort} {shortened(name)!r}; it has {listed}{suggestion(name, [*words, *others])}"


def table_cell(text: str) -> str:
    """Return a text as a cell of a CSV file: an apostrophe is before one that spreadsheets would compute.

    >>> table_cell("=1+1"), table_cell("ball")
    ("'=1+1", 'ball')
    """
    return f"'{text}" if text.startswith(("=", "+", "-", "@", "\t", "\r", "\n")) else text


def unique_name(wanted: str, taken: Container[str]) -> str:
    """Return ``wanted``, numbered if it is taken.

    >>> unique_name("entity 3", ["entity 3", "floor"])
    'entity 3 (2)'
    """
    name, count = wanted, 1
    while name in taken:
        count += 1
        name = f"{wanted} ({count})"
    return name


def in_words(name: str) -> str:
    """Return the name of a class in words.

    >>> in_words("GraphLine"), in_words("Spring")
    ('graph line', 'spring')
    """
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", name).lower()


_TEXTS = Interned("")
code_of, text_of = _TEXTS.code_of, _TEXTS.value_of
"""The number that stands for a text in this process, 0 for the empty one; and the text of a number."""
