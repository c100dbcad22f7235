"""A virtual screen, on which the program is opened and used with a real mouse and keyboard."""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

type Seen = Callable[[NDArray[np.int64]], bool]

MISSING = [tool for tool in ("Xvfb", "xdotool") if shutil.which(tool) is None]
needs_screen = pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")

ROOT = Path(__file__).parent.parent
PATIENCE = 300.0
"""How long [s] a window may take to come up: the first start compiles, in processes that yield to others."""
MAIN = (sys.executable, str(ROOT / "main.py"))


class Screen:
    """A virtual screen of 1280 x 720, and what a user does at it."""

    def __init__(self, number: str, folder: Path) -> None:
        self.environment = {**os.environ, "DISPLAY": number}
        self.environment.pop("SDL_VIDEODRIVER", None)
        self.environment["XDG_STATE_HOME"] = str(folder / "state")
        self.folder = folder

    def do(self, *words: object) -> str:
        """Run xdotool, and wait a little for the window to notice."""
        command = ["xdotool", *map(str, words)]
        done = subprocess.run(command, env=self.environment, check=True, capture_output=True, text=True)
        time.sleep(0.15)
        return done.stdout

    def picture(self) -> NDArray[np.int64]:
        """Return what the screen shows: red, green and blue (width, height, 3), from 0 to 255."""
        before, found = b"", self._memory()
        while found != before:  # a window was drawing
            before, found = found, self._memory()
        header = np.frombuffer(found, ">u4", 20).astype(int).tolist()
        width, height, stride = header[4], header[5], header[12]
        begin = header[0] + 12 * header[19]  # a table of colours stands between
        rows = np.frombuffer(found, np.uint8, stride * height, begin).reshape(height, stride)
        pixels = rows[:, : 4 * width].reshape(height, width, 4)
        return pixels[..., 2::-1].swapaxes(0, 1).astype(np.int64)  # blue comes first

    def _memory(self) -> bytes:
        """Return what the server keeps of its screen: a header, colours, and rows of pixels."""
        return (self.folder / "Xvfb_screen0").read_bytes()

    def until(self, seen: Seen, what: str) -> NDArray[np.int64]:
        """Take pictures until ``seen`` accepts one, and return it: a busy machine is late, not wrong."""
        deadline = time.monotonic() + 30.0
        while time.monotonic() < deadline:
            picture = self.picture()
            if seen(picture):
                return picture
            time.sleep(0.05)
        raise AssertionError(f"not seen: {what}")

    def launch(self, *arguments: str, command: Sequence[str] = MAIN) -> subprocess.Popen[str]:
        """Start the program and wait until its window has drawn the world."""
        program = subprocess.Popen(
            [*command, *arguments], env=self.environment, cwd=self.folder,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            assert program.poll() is None, program.communicate()[1]
            if self.windows(Path(command[-1]).name) and self.picture()[30:280, 30:300].max() > 200:
                return program  # the figures are there
            time.sleep(0.2)
        program.kill()
        program.communicate()
        raise AssertionError("no window came up")

    def leave(self, program: subprocess.Popen[str]) -> None:
        """Press Escape until the program ends, which must be without a word."""
        try:
            for _ in range(3):  # not within a second of what closed something
                with suppress(subprocess.TimeoutExpired):
                    program.wait(1.2)
                if program.poll() is None:
                    self.do("key", "Escape")
            out, err = program.communicate(timeout=20)
            assert (program.returncode, out, err) == (0, "", ""), (program.returncode, out, err)
        finally:
            program.kill()
            program.communicate()

    def windows(self, program: str = "main.py") -> list[str]:
        """Return the windows of the program; without a window manager xdotool finds them by class alone."""
        command = ["xdotool", "search", "--onlyvisible", "--classname", program]
        found = subprocess.run(command, env=self.environment, capture_output=True, text=True, check=False)
        return found.stdout.split()


@pytest.fixture
def screen(tmp_path: Path) -> Iterator[Screen]:
    reader, writer = os.pipe()
    # Without -noreset the server starts over when its last client leaves, and drops those that come
    # meanwhile.
    size = ["-screen", "0", "1280x720x24"]
    command = ["Xvfb", "-displayfd", str(writer), *size, "-nolisten", "tcp", "-noreset"]
    command += ["-fbdir", str(tmp_path)]
    with subprocess.Popen(command, pass_fds=(writer,), stderr=subprocess.DEVNULL) as server:
        os.close(writer)
        with os.fdopen(reader) as number:
            yield Screen(f":{number.readline().strip()}", tmp_path)
        server.terminate()
