"""Programs that do something at the same moment."""

import subprocess
import sys


def run_at_once(code: str, *arguments: str, count: int) -> list[str]:
    r"""Run a program ``count`` times, and return the lines that all write.

    What follows ``input("ready\n")`` in it begins in all at once, when the last is there.
    """
    command = [sys.executable, "-c", code, *arguments]
    pipe = subprocess.PIPE
    programs = [subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) for _ in range(count)]
    for program in programs:
        assert program.stdout is not None and program.stdout.readline() == "ready\n"
    for program in programs:
        assert program.stdin is not None
        program.stdin.write("\n")
        program.stdin.flush()
    lines = [line for program in programs for line in program.communicate()[0].splitlines()]
    assert [program.returncode for program in programs] == count * [0]
    return lines
