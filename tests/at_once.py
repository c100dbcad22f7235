"""Programs that do something at the same moment."""

import json
import subprocess
import sys

_FORKING = """
import builtins, json, os, sys, tempfile
code, count, *sys.argv[1:] = sys.argv[1:]

def input(prompt):
    begin, begun = os.pipe()
    children = {}
    for _ in range(int(count)):
        out, path = tempfile.mkstemp()
        child = os.fork()
        if child == 0:
            os.close(begun)
            os.read(begin, 1)
            os.dup2(out, 1)
            return ""
        children[child] = path
    os.close(begun)
    ends = [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) for child in children]
    said = []
    for path in children.values():
        with open(path) as file:
            said += file.read().splitlines()
        os.unlink(path)
    print(json.dumps([ends, said]), flush=True)
    os._exit(0)

builtins.input = input
exec(code, {"__name__": "__main__"})
"""


def run_at_once(code: str, *arguments: str, count: int) -> list[str]:
    r"""Run a program ``count`` times, and return the lines that all write.

    What follows ``input("ready\n")`` in it begins in all at once; what comes before is done for all by the
    process that they are forks of.
    """
    command = [sys.executable, "-c", _FORKING, code, str(count), *arguments]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    ends, lines = json.loads(done.stdout)
    assert ends == count * [0]
    return [str(line) for line in lines]
