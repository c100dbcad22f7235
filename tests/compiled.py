"""Inner functions of kernels, compiled so that tests can call them: of themselves they have no entry."""

from collections.abc import Callable
from typing import Any, cast

import numba


def compiled[F: Callable[..., Any]](inner: F) -> F:
    """Return a compiled function that calls an inner function of kernels with its own arguments."""

    def call(*arguments: Any) -> Any:
        return inner(*arguments)

    return cast(F, numba.njit(error_model="numpy")(call))
