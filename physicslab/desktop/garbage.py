"""Python's search for garbage, kept out of the frames.

The modules loaded at the start, numba above all, are 170,000 objects that last as long as the program. To
search all of them takes 76 ms, as long as five frames, and happens every few minutes of the sandbox; while
they are made it happens several times for nothing.
"""

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def loading() -> Iterator[None]:
    """Search for no garbage for the length of a ``with`` block, and never in what is there at its end.

    The first scene is among that. It is freed all the same when nothing refers to it any more; only what
    refers to itself in a circle stays.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        if enabled:
            gc.enable()
