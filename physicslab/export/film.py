"""A film in a file: GIF or MP4 by the ending of its name, there whole or not at all."""

import os
from contextlib import ExitStack, suppress
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import NDArray

from physicslab.export.gif import LARGEST_RATE, GifWriter
from physicslab.export.mp4 import Mp4Writer, check_encoder
from physicslab.files.replace import check_writable, replacing

ENDINGS = (".gif", ".mp4")
"""What the name of a film ends with."""


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
        Pictures a second; of a GIF at most 50.

    Attributes
    ----------
    count : int
        How many pictures it has.

    Raises
    ------
    NoEncoder, ValueError
        If it is an MP4 film and there is no ffmpeg; if the rate is too high, or the ending none of those.
    OSError
        If the file cannot be written.
    """

    def __init__(self, path: str | os.PathLike[str], size: tuple[int, int], rate: float) -> None:
        self.check(path, rate)
        self.path, self.count = Path(path), 0
        self._files = ExitStack()
        try:
            fresh = self._files.enter_context(replacing(path))
            self._writer: GifWriter | Mp4Writer
            if self.path.suffix.lower() == ".gif":
                file = self._files.enter_context(open(fresh, "wb"))  # noqa: SIM115
                self._writer = GifWriter(file, size, rate)
            else:
                self._writer = Mp4Writer(fresh, size, rate)
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

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.finish()
        else:
            self.give_up()
