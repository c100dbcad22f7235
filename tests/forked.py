"""Command lines and scripts in processes of their own that need not import the program first.

One process imports it, and forks for each of them: the fork runs ``python -m physicslab.cli``, or a script,
to its end, and that of the interpreter, in a fraction of the time of a fresh process.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

__all__ = ["ForkedProgram"]

_SERVER = """
import json, os, runpy, sys
from physicslab.commands import command
from physicslab.commands.usage import COMMANDS
for name in COMMANDS:
    command(name)
for line in sys.stdin:
    request = json.loads(line)
    child = os.fork()
    if child == 0:
        os.chdir(request["directory"])
        for number, path in enumerate(("stdout", "stderr"), start=1):
            os.dup2(os.open(request[path], os.O_WRONLY | os.O_CREAT), number)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        sys.argv = ["physicslab", *request["line"]]
        if request["script"] is None:
            runpy.run_module("physicslab.cli", run_name="__main__", alter_sys=True)
        else:
            exec(request["script"], {"__name__": "__main__"})
        sys.exit()
    _, status = os.waitpid(child, 0)
    print(os.waitstatus_to_exitcode(status), flush=True)
"""


class ForkedProgram:
    """Runs command lines and scripts one after the other; used in a ``with`` block.

    Parameters
    ----------
    directory : Path
        Where the lines run, and where what they print is put.
    environment : mapping of str to str
        What they find in their environment besides this process's own.
    """

    def __init__(self, directory: Path, environment: Mapping[str, str]) -> None:
        self._directory = directory
        self._out, self._err = directory / ".stdout", directory / ".stderr"
        self._process: subprocess.Popen[str] = subprocess.Popen(
            [sys.executable, "-c", _SERVER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
            cwd=directory, env={**os.environ, **environment},
        )  # fmt: skip

    def __enter__(self) -> ForkedProgram:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait(60)

    def run(self, line: Sequence[str], script: str | None = None) -> tuple[int, bytes, bytes]:
        """Run one command line, or a script with these arguments.

        Returns its status, which is negative where a signal ended it, and what it wrote on stdout and stderr.
        """
        assert self._process.stdin is not None and self._process.stdout is not None
        for path in (self._out, self._err):
            path.unlink(missing_ok=True)
        request: dict[str, Any] = {
            "line": list(line), "script": script, "directory": str(self._directory),
            "stdout": str(self._out), "stderr": str(self._err),
        }  # fmt: skip
        self._process.stdin.write(json.dumps(request) + "\n")
        self._process.stdin.flush()
        status = int(self._process.stdout.readline())
        return status, self._out.read_bytes(), self._err.read_bytes()
