"""Text as a font can draw it: scene files and file names may hold any letter, and any number of them."""

import re
import unicodedata
from functools import lru_cache

MAX_LETTERS = 1000
"""Longer text is cut: no line, no caption and no message is read beyond that."""
_MAX_MARKS = 3
"""Accents and other marks on one letter."""


def shortened(words: str, letters: int) -> str:
    """Return text of at most ``letters`` letters, the last of which is an ellipsis where it was cut.

    >>> shortened("Five restitutions", 8), shortened("drop", 8)
    ('Five re…', 'drop')
    """
    return words if len(words) <= letters else words[: letters - 1] + "…"


@lru_cache(maxsize=2048)  # panels write the same words again and again
def drawable(words: str) -> str:
    r"""Return text without what fonts refuse: control characters and halves of surrogate pairs.

    Line breaks and tabs become spaces, all else that cannot be printed a replacement character. Marks
    piled up on one letter that would reach into other lines are left out.

    >>> drawable("a\tb\x00c\udce9")
    'a b\ufffdc\ufffd'
    """
    words = shortened(words, MAX_LETTERS)
    if words.isascii() and words.isprintable():
        return words
    letters, marks = [], 0
    for letter in words:
        marks = marks + 1 if unicodedata.combining(letter) else 0
        if marks <= _MAX_MARKS:
            letters.append(_drawable_letter(letter))
    return "".join(letters)


def encodable(text: str) -> str:
    r"""Return text with each half of a surrogate pair and each NUL replaced: fields take UTF-8 up to a NUL.

    >>> encodable("a\nb\0\udce9")
    'a\nb\ufffd\ufffd'
    """
    return re.sub("[\0\ud800-\udfff]", "\ufffd", text)


def _drawable_letter(letter: str) -> str:
    if letter.isprintable() or unicodedata.category(letter) == "Co":  # icons are for private use
        return letter
    return " " if letter.isspace() else "\ufffd"
