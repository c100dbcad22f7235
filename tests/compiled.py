"""Inner functions of kernels, compiled so that tests can call them: of themselves they have no entry."""

from collections.abc import Callable
from typing import cast

import numba


def compiled[**P, R](inner: Callable[P, R]) -> Callable[P, R]:
    """Return a compiled function that calls an inner function of kernels with its own arguments."""

    @numba.njit(error_model="numpy")  # type: ignore[untyped-decorator]
    def call(*arguments):  # type: ignore[no-untyped-def]
        return inner(*arguments)

    return cast(Callable[P, R], call)
