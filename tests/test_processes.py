"""Processes that work for this one, and what is told of those that end."""

import os
import signal
import threading
from multiprocessing.connection import Connection
from pathlib import Path

import pytest

from physicslab.lab.jobs import NoProcess, ProcessEnded, Processes

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs signals that end a process")


def identity(value: object) -> object:
    return value


def fail(value: object) -> object:
    raise EOFError(value)


def end_in_a_message() -> None:
    """End this process when a part of its answer is sent."""

    def send(connection: Connection, answer: bytes) -> None:
        os.write(connection.fileno(), bytes(answer)[:2])
        os.kill(os.getpid(), signal.SIGKILL)

    setattr(Connection, "_send", send)  # noqa: B010 - that the module has it is no part of its stub


def test_a_process_that_ends_in_the_midst_of_its_answer_fails_its_call_alone() -> None:
    with Processes(1) as pool:
        first, last = pool.submit(end_in_a_message), pool.submit(identity, "next")
        with pytest.raises(ProcessEnded) as ended:
            first.result(60)
        assert ended.value.status == -signal.SIGKILL and last.result(60) == "next"


def test_errors_of_a_call_are_raised_here_and_say_where_they_were_raised_there() -> None:
    with Processes(1) as pool:
        with pytest.raises(EOFError, match="value") as raised:
            pool.submit(fail, "value").result(60)
        assert any("in fail" in note for note in raised.value.__notes__)
        with pytest.raises(AttributeError, match="local object"):
            pool.submit(lambda: None).result(60)
        with pytest.raises(RuntimeError, match="cannot pickle"):
            pool.submit(threading.Lock).result(60)
        assert pool.submit(identity, 3).result(60) == 3


def test_a_process_that_cannot_be_started_fails_its_call_and_the_next_is_tried_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    there, gone = Path.cwd(), tmp_path / "gone"
    gone.mkdir()
    with Processes(1) as pool:
        monkeypatch.chdir(gone)
        gone.rmdir()
        with pytest.raises(NoProcess, match="no process can be started: No such file or directory"):
            pool.submit(identity, 1).result(60)
        os.chdir(there)
        assert pool.submit(identity, 2).result(60) == 2


def test_processes_that_are_abandoned_end_in_the_midst_of_their_work() -> None:
    pool = Processes(2)
    hang = [pool.submit(signal.pause) for _ in range(4)]
    assert not pool.submit(identity, 1).done()
    pool.abandon()
    for leader in pool._leaders:
        leader.join(60)
        assert not leader.is_alive()
    assert not pool._processes and all(call.done() for call in hang)
    with pytest.raises(RuntimeError, match="after the end"):
        pool.submit(identity, 1)
