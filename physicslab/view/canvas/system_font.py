"""Fonts of the system for letters that the window's own has not: of East Asia, Arabic and Hebrew."""

import os
import re
import sys
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

_IDEOGRAPHS = (
    "\u1100-\u11ff\u2e80-\ua4cf\ua960-\ua97f\uac00-\ud7ff\uf900-\ufaff\ufe30-\ufe4f\uff00-\uffef"
    "\U00020000-\U0003ffff"
)
"""Letters of Chinese, Japanese and Korean, with their punctuation."""
_SEMITIC = "\u0590-\u08ff\ufb1d-\ufdff\ufe70-\ufefc"
"""Letters of Hebrew, Arabic and what is written alike."""
FAR = re.compile(f"([{_IDEOGRAPHS}]+|[{_SEMITIC}]+)")
"""Pieces of a line that are written in a font of the system."""
_NAMES = {
    re.compile(f"[{_IDEOGRAPHS}]"): (
        "NotoSansCJK-Regular.ttc", "NotoSansCJKsc-Regular.otf", "NotoSansSC-Regular.otf",
        "SourceHanSansSC-Regular.otf", "wqy-microhei.ttc", "wqy-zenhei.ttc", "DroidSansFallbackFull.ttf",
        "DroidSansFallback.ttf", "PingFang.ttc", "Hiragino Sans GB.ttc", "Arial Unicode.ttf",
        "Arial Unicode MS.ttf", "msyh.ttc", "msgothic.ttc", "malgun.ttf", "simsun.ttc", "unifont.ttf",
    ),
    re.compile(f"[{_SEMITIC}]"): (
        "DejaVuSans.ttf", "Arial.ttf", "arial.ttf", "Arial Unicode.ttf", "segoeui.ttf", "tahoma.ttf",
        "FreeSans.ttf", "NotoSansArabic-Regular.ttf", "NotoNaskhArabic-Regular.ttf", "GeezaPro.ttc",
        "NotoSansHebrew-Regular.ttf", "unifont.ttf",
    ),
}  # fmt: skip
"""Files of fonts with such letters, the best first."""
_MOST = 20_000
"""Files that are looked at before the search is given up."""


def _folders() -> Iterator[Path]:
    """Yield where the system keeps fonts."""
    home = Path(os.path.expanduser("~"))
    if sys.platform == "win32":
        yield Path(os.environ.get("WINDIR", r"C:\Windows")) / "Fonts"
        yield Path(os.environ.get("LOCALAPPDATA", str(home))) / "Microsoft" / "Windows" / "Fonts"
    elif sys.platform == "darwin":
        yield from (Path("/System/Library/Fonts"), Path("/Library/Fonts"), home / "Library" / "Fonts")
    else:
        yield from (Path("/usr/share/fonts"), Path("/usr/local/share/fonts"), home / ".local/share/fonts")


@lru_cache(maxsize=1)
def _found() -> dict[str, Path]:
    """Return the files of those fonts that the system has, by their names."""
    wanted, found, seen = {name for names in _NAMES.values() for name in names}, dict[str, Path](), 0
    for folder in _folders():
        for place, _, files in os.walk(folder):
            seen += len(files)
            found.update({name: Path(place) / name for name in files if name in wanted})
            if seen > _MOST:
                break
    return found


def system_fonts() -> tuple[Path, ...]:
    """Return the files of fonts of the system for such letters, one for each kind of them that is found."""
    return tuple(dict.fromkeys(filter(None, map(_first, _NAMES.values()))))


def system_font(letter: str) -> Path | None:
    """Return the file of a font of the system with a letter that the own one has not, if there is one."""
    return next((_first(names) for letters, names in _NAMES.items() if letters.match(letter)), None)


def _first(names: tuple[str, ...]) -> Path | None:
    return next((_found()[name] for name in names if name in _found()), None)
