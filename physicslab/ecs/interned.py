"""Values of any length in columns of numbers: each is kept once in this process, and a code stands for it."""

import threading
from collections.abc import Hashable


class Interned[T: Hashable]:
    """Values and the codes that stand for them, counted from 0 on, which is that of the empty one.

    Nothing is ever dropped, so that copies of columns stay valid, be they of key frames or of other worlds.

    >>> names = Interned("")
    >>> names.code_of(""), names.code_of("start"), names.code_of("start"), names.value_of(1), len(names)
    (0, 1, 1, 'start', 2)
    """

    def __init__(self, empty: T) -> None:
        self._values = [empty]
        self._codes = {empty: 0}
        self._adding = threading.Lock()

    def __len__(self) -> int:
        return len(self._values)

    def code_of(self, value: T) -> int:
        """Return the number that stands for a value in this process."""
        code = self._codes.get(value)
        if code is None:
            with self._adding:  # of two threads that add one value, the second finds it there
                code = self._codes.get(value)
                if code is None:
                    code = len(self._values)
                    self._values.append(value)  # before its code can be found
                    self._codes[value] = code
        return code

    def value_of(self, code: int) -> T:
        """Return the value that a number stands for.

        Raises
        ------
        IndexError
            If it stands for none.
        """
        return self._values[code]
