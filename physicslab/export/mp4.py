"""Films as MP4 files, compressed by the program ffmpeg (H.264), which the extra ``video`` brings."""

import importlib.util
import os
import shutil
import subprocess

import numpy as np
from numpy.typing import NDArray


class NoEncoder(ValueError):
    """There is no program that makes MP4 files: the message is one line that says how to get it."""


def check_encoder() -> str:
    """Return the path of ffmpeg: that of the extra, or else the system's.

    Raises
    ------
    NoEncoder
        If there is none.
    """
    if importlib.util.find_spec("imageio_ffmpeg") is not None:
        from imageio_ffmpeg import get_ffmpeg_exe

        try:
            return str(get_ffmpeg_exe())
        except RuntimeError:  # it came without the program
            pass
    found = shutil.which("ffmpeg")
    if found is None:
        raise NoEncoder("an MP4 film needs ffmpeg, which is not installed: pip install 'physicslab[video]'")
    return found


class Mp4Writer:
    """Writes one picture after the other.

    Parameters
    ----------
    path : path
        Where the film goes; what is there is replaced.
    size : tuple of two ints
        Width and height of all pictures [px]; of an odd one a row or column is left out.
    rate : float
        Pictures a second.

    Raises
    ------
    NoEncoder
        If there is no ffmpeg.
    OSError
        If it cannot be started.
    """

    def __init__(self, path: str | os.PathLike[str], size: tuple[int, int], rate: float) -> None:
        self._width, self._height = (number // 2 * 2 for number in size)
        given = ("-f", "rawvideo", "-pix_fmt", "rgb0", "-s", f"{self._width}x{self._height}")
        film = ("-an", "-c:v", "libx264", "-preset", "veryfast", "-crf", "18", "-pix_fmt", "yuv420p")
        command = (
            check_encoder(), "-loglevel", "error", "-y", *given, "-r", f"{rate:.9g}", "-i", "-",
            *film, "-movflags", "+faststart", "-f", "mp4", os.fspath(path),
        )  # fmt: skip
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(command, stdin=pipe, stdout=subprocess.DEVNULL, stderr=pipe)

    def write(self, picture: NDArray[np.uint8]) -> None:
        """Add a picture: uint8 (height, width, 4), red, green, blue and one that is not used.

        Raises
        ------
        OSError
            If it cannot be written.
        """
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(np.ascontiguousarray(picture[: self._height, : self._width]).data)
        except BrokenPipeError as error:
            raise OSError(self._end()) from error

    def close(self) -> None:
        """End the film.

        Raises
        ------
        OSError
            If it could not be written.
        """
        reason = self._end()
        if self._process.returncode != 0:
            raise OSError(reason)

    def stop(self) -> None:
        """End it at once; what was written is of no use."""
        self._process.kill()
        self._end()

    def _end(self) -> str:
        """Wait until the program ends, and return in a line what it complained of."""
        if self._process.stderr is None or self._process.stderr.closed:
            return ""
        _, complaints = self._process.communicate()
        lines = complaints.decode(errors="replace").strip().splitlines()
        full = next((line for line in lines if "No space left" in line), None)
        return (
            full.rpartition(": ")[2] if full else f"ffmpeg ended: {lines[-1] if lines else 'no reason given'}"
        )
