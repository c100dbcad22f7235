"""Texts as numbers, so that a column can hold them.

The table belongs to the process and only grows: a code means the same text for as long as the process lives,
in every world, key frame and copy of columns. Nothing that leaves the process holds a code: files,
recordings, copies by pickle and messages hold the text.
"""

import threading

_texts = [""]
_codes = {"": 0}
_adding = threading.Lock()


def code_of(text: str) -> int:
    """Return the number that stands for a text in this process; 0 for the empty one.

    >>> code_of(""), code_of("start") == code_of("start"), text_of(code_of("start"))
    (0, True, 'start')
    """
    code = _codes.get(text)
    if code is None:
        with _adding:  # of two threads that add one text, the second finds it there
            code = _codes.get(text)
            if code is None:
                code = len(_texts)
                _texts.append(text)  # before its code can be found
                _codes[text] = code
    return code


def text_of(code: int) -> str:
    """Return the text that a number stands for.

    Raises
    ------
    IndexError
        If it stands for none.
    """
    return _texts[code]
