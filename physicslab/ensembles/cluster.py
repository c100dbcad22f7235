"""A Dask cluster as an executor."""

from __future__ import annotations

import logging
from concurrent.futures import Executor
from typing import Any

from physicslab.files.checks import SceneError, shown

_PATIENCE_S = 5.0
"""How long [s] a scheduler may take to answer."""


class Dask(Executor):
    """The workers of a Dask scheduler.

    Parameters
    ----------
    address : str
        Address of the scheduler: ``tcp://host:8786``.

    Raises
    ------
    SceneError
        If the package distributed is not installed, nothing answers there, or there is no worker.
    """

    def __init__(self, address: str) -> None:
        try:
            import distributed  # with the extra cluster
        except ImportError as error:
            words = "needs the package distributed: pip install 'physicslab[cluster]'"
            raise SceneError(f"--dask: {words}") from error
        for name in ("distributed", "distributed.client"):  # which tell what is said in one line here
            logging.getLogger(name).setLevel(logging.CRITICAL)
        try:
            distributed.comm.resolve_address(address)  # else a client is left that cannot close
            self._client: Any = distributed.Client(address, timeout=_PATIENCE_S, set_as_default=False)
        except ValueError as error:
            raise SceneError(f"--dask {shown(address)}: must be as tcp://host:8786") from error
        except OSError as error:  # and TimeoutError
            raise SceneError(f"--dask {shown(address)}: no scheduler answers there") from error
        self._max_workers = sum(self._client.ncores().values())
        if not self._max_workers:
            self._client.close()
            raise SceneError(f"--dask {shown(address)}: the scheduler has no workers")
        self._pool: Executor = self._client.get_executor(pure=False)

    def submit(self, *args: Any, **kwargs: Any) -> Any:
        """Hand a call over to the scheduler."""
        return self._pool.submit(*args, **kwargs)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Let go of the scheduler, which goes on."""
        self._pool.shutdown(wait=wait)
        self._client.close()
