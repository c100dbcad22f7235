"""A font of the system for the letters that the window's own has not: Chinese, Japanese and Korean ones."""

import os
import re
import sys
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

IDEOGRAPHS = re.compile(
    "([\u1100-\u11ff\u2e80-\ua4cf\ua960-\ua97f\uac00-\ud7ff\uf900-\ufaff\ufe30-\ufe4f\uff00-\uffef"
    "\U00020000-\U0003ffff]+)"
)
"""Letters of Chinese, Japanese and Korean, with their punctuation."""
_NAMES = (
    "NotoSansCJK-Regular.ttc", "NotoSansCJKsc-Regular.otf", "NotoSansSC-Regular.otf",
    "SourceHanSansSC-Regular.otf",
    "wqy-microhei.ttc", "wqy-zenhei.ttc", "DroidSansFallbackFull.ttf", "DroidSansFallback.ttf",
    "PingFang.ttc", "Hiragino Sans GB.ttc", "Arial Unicode.ttf", "Arial Unicode MS.ttf",
    "msyh.ttc", "msgothic.ttc", "malgun.ttf", "simsun.ttc", "unifont.ttf",
)  # fmt: skip
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
def system_font() -> Path | None:
    """Return the file of a font of the system with such letters, if one is found."""
    found: dict[str, Path] = {}
    seen = 0
    for folder in _folders():
        for place, _, files in os.walk(folder):
            seen += len(files)
            found.update({name: Path(place) / name for name in files if name in _NAMES})
            if seen > _MOST:
                break
    return next((found[name] for name in _NAMES if name in found), None)
