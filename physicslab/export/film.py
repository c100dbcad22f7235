"""A film in a file: GIF or MP4 by the ending of its name, there whole or not at all."""

import importlib.util
import os
import shutil
import subprocess
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray

from physicslab.export.gif import LARGEST_RATE, SMALLEST_RATE, GifWriter
from physicslab.files.replace import check_writable, replacing


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

    Attributes
    ----------
    size : tuple of two ints
        Width and height of the film [px].

    Raises
    ------
    NoEncoder
        If there is no ffmpeg.
    OSError
        If it cannot be started.
    """

    def __init__(self, path: str | os.PathLike[str], size: tuple[int, int], rate: float) -> None:
        self._width, self._height = self.size = size[0] // 2 * 2, size[1] // 2 * 2
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


ENDINGS = (".gif", ".mp4")
"""Endings of the names of films."""


class _Given(Exception):
    """The film was cancelled."""


class Film:
    """A film that is being made, picture by picture.

    The file is there once :meth:`finish` has returned; until then, and where anything fails, it is as it was
    before. In a ``with`` block it is finished at the end, and given up where that is left by an error.

    Parameters
    ----------
    path : path
        Ends in ``.gif`` or ``.mp4``.
    size : tuple of two ints
        Width and height of all pictures [px].
    rate : float
        Pictures a second, at least 0.002; of a GIF at most 50.

    Attributes
    ----------
    count : int
        How many pictures it has.
    size : tuple of two ints
        Their width and height [px], as the file has them.

    Raises
    ------
    NoEncoder, ValueError
        If it is an MP4 film and there is no ffmpeg; if the rate is too high or too low, or the ending none of
        those.
    OSError
        If the file cannot be written.
    """

    def __init__(self, path: str | os.PathLike[str], size: tuple[int, int], rate: float) -> None:
        self.check(path, rate)
        self.path, self.count, self.size = Path(path), 0, size
        self._files = ExitStack()
        try:
            fresh = self._files.enter_context(replacing(path))
            self._writer: GifWriter | Mp4Writer
            if self.path.suffix.lower() == ".gif":
                file = self._files.enter_context(open(fresh, "wb"))  # noqa: SIM115
                self._writer = GifWriter(file, size, rate)
            else:
                self._writer = Mp4Writer(fresh, size, rate)
                self.size = self._writer.size
        except BaseException as error:
            self._files.__exit__(type(error), error, error.__traceback__)
            raise

    @staticmethod
    def check(path: str | os.PathLike[str], rate: float) -> None:
        """Raise what making such a film would, as far as that can be found before."""
        ending = Path(path).suffix.lower()
        if ending not in ENDINGS:
            raise ValueError(f"the name of a film ends in {' or '.join(ENDINGS)}")
        if ending == ".gif" and rate > LARGEST_RATE:
            raise ValueError(f"a GIF film has at most {LARGEST_RATE:g} pictures a second, not {rate:.6g}")
        if rate < SMALLEST_RATE:
            raise ValueError(
                f"a film has at least {SMALLEST_RATE:g} pictures a second, not {rate:.6g}: see --fps"
            )
        if ending == ".mp4":
            check_encoder()
        check_writable(path)

    def write(self, picture: NDArray[np.uint8]) -> None:
        """Add a picture: uint8 (height, width, 4), red, green, blue and one that is not used.

        Raises
        ------
        OSError
            If it cannot be written.
        """
        self._writer.write(picture)
        self.count += 1

    def finish(self) -> None:
        """End the film, and put the file where it belongs.

        Raises
        ------
        OSError
            If that cannot be done.
        """
        try:
            self._writer.close()
        except BaseException:
            self.give_up()
            raise
        self._files.close()

    def give_up(self) -> None:
        """Leave the file as it was before."""
        if isinstance(self._writer, Mp4Writer):
            self._writer.stop()
        with suppress(_Given, OSError), self._files:  # a full disk may refuse what is left to be written
            raise _Given

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            self.finish()
        else:
            self.give_up()
