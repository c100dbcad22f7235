"""What is loaded at the start is not searched for garbage, and numba learns no more than it needs."""

from __future__ import annotations

import gc
import subprocess
import sys

import pytest

from physicslab.desktop.garbage import loading


def test_nothing_is_searched_while_loading_and_what_was_loaded_never_is() -> None:
    frozen = gc.get_freeze_count()
    try:
        with loading():
            assert not gc.isenabled()
            kept = [[n] for n in range(1_000)]
        assert gc.isenabled()
        assert gc.get_freeze_count() >= frozen + len(kept)
    finally:
        gc.unfreeze()


def test_the_search_goes_on_after_an_error() -> None:
    with pytest.raises(KeyError), loading():
        raise KeyError
    gc.unfreeze()
    assert gc.isenabled()


@pytest.mark.peers
def test_numba_is_prepared_without_linear_algebra_which_can_be_had_afterwards() -> None:
    code = (
        "import sys; from physicslab.kernels import prepare; prepare(); "
        "assert 'scipy.linalg' not in sys.modules; import scipy.linalg"
    )
    subprocess.run((sys.executable, "-c", code), check=True)
