"""Files that are no scenes: each is refused in one line, in bounded time and memory."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from physicslab.files.plain import FILE_LIMIT
from physicslab.files.scene import BRACKET_LIMIT, SceneError, load_scene

START, END = b'{"format": "physicslab-scene/1", ', b"}"
MEMORY = 1_500_000_000
"""Bytes that refusing the largest file may take, the program itself included."""

HOSTILE_FILES = {
    "empty": (b"", "is not JSON"),
    "deep": (b"[" * 100_000, "is nested too deeply"),
    "deep objects": (START + b'"entities": ' + b'{"a":' * 100_000, "is nested too deeply"),
    "repeated": (START + b'"entities": [], "entities": []' + END, 'the key "entities" is given twice'),
    "repeated in an entity": (
        START + b'"entities": [{"Mass": {"mass": 1, "mass": 2}}]' + END,
        'the key "mass" is given twice',
    ),
    "long whole number": (
        START + b'"entities": [], "time": ' + b"9" * 5000 + END,
        "time = Infinity: must be a finite number",
    ),
    "long negative number": (
        START + b'"entities": [{"Transform": {"angle": -' + b"9" * 5000 + b"}}]" + END,
        "Transform.angle = -Infinity: must be a finite number",
    ),
    "long fraction": (START + b'"entities": [], "time": 1e' + b"9" * 5000 + END, "time = Infinity: must be"),
    "UTF-16": ('{"format": 1}'.encode("utf-16"), "is not UTF-8"),
    "Latin-1": (START + b'"name": "caf\xe9", "entities": []' + END, "is not UTF-8: byte 45"),
    "cut short": (START + b'"name": "caf\xc3', "is not UTF-8"),
    "null characters": (b"\0" * 1000, "is not JSON"),
    "null in a text": (START + b'"name": "a\0b", "entities": []' + END, "is not JSON"),
    "brackets": (b"[" * (BRACKET_LIMIT + 1), f"must have at most {BRACKET_LIMIT:,} objects and lists"),
}


def refused(path: str | Path) -> str:
    """Return the line with which a file is refused, without its path."""
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    line = str(caught.value)
    assert len(line.splitlines()) == 1 and len(line) < 400
    return line.removeprefix(f"{path}: ")


@pytest.mark.parametrize("name", HOSTILE_FILES)
def test_a_hostile_file_is_refused_in_one_line(name: str, tmp_path: Path) -> None:
    content, said = HOSTILE_FILES[name]
    path = tmp_path / "scene.json"
    path.write_bytes(content)
    assert said in refused(path)


def test_a_byte_order_mark_is_no_fault(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_bytes(b"\xef\xbb\xbf" + START + b'"entities": []' + END)
    assert load_scene(path).entities() == []


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_what_is_no_plain_file_is_refused_at_once(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    assert refused(pipe) == "is a pipe or a device; a scene file must be a plain file"
    assert refused("/dev/zero") == "is a pipe or a device; a scene file must be a plain file"
    assert refused(tmp_path) == "is a directory, not a scene file"


def test_a_file_beyond_the_limit_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    with path.open("wb") as file:
        file.truncate(FILE_LIMIT + 1)
    assert refused(path) == "is too large: a scene file must have at most 104,857,600 bytes"


# Not ru_maxrss: a process that is started begins with that of the one that starts it.
MEASURED = """
import sys
from physicslab.cli import main
status = main(["run", sys.argv[1]])
with open("/proc/self/status") as lines:
    print(next(line.split()[1] for line in lines if line.startswith("VmHWM")))
sys.exit(status)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the peak of memory is asked of Linux")
@pytest.mark.parametrize(
    ("start", "filling", "end"),
    [
        pytest.param(b"", b"[", b"", id="brackets"),
        pytest.param(b'"', b"x", b'"', id="a text", marks=pytest.mark.slow),
        pytest.param(b"[0", b",0", b"]", id="whole numbers", marks=pytest.mark.slow),
        pytest.param(b"[1", b",2.5", b"]", id="fractions", marks=pytest.mark.slow),
        pytest.param(b"9", b"9", b"", id="one number", marks=pytest.mark.slow),
    ],
)
def test_memory_is_bounded_for_the_largest_file(
    start: bytes, filling: bytes, end: bytes, tmp_path: Path
) -> None:
    path = tmp_path / "scene.json"
    path.write_bytes(start + filling * ((FILE_LIMIT - 10) // len(filling)) + end)
    done = subprocess.run(
        [sys.executable, "-c", MEASURED, str(path)], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1 and "Traceback" not in done.stderr
    assert int(done.stdout) * 1024 < MEMORY, done.stdout


def test_a_text_as_long_as_a_file_is_shown_shortened(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_text(json.dumps({"format": "x" * 10_000_000, "entities": []}), "utf-8")
    assert refused(path).endswith('...: must be "physicslab-scene/1"')
