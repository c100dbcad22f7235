"""Catalogues of gettext as people edit them, ``CODE.po``, read without tools beside Python."""

import ast
import gettext
import io
import struct
from functools import cache
from importlib.resources import files

FOLDER = files(__package__)
"""Where the catalogues are, be it in an archive."""
SOURCE = "en"
"""The language that the program's own texts are in."""
_MAGIC, _HEADER = 0x950412DE, struct.Struct("<7I")


def languages() -> list[str]:
    """Return the codes of all languages that there are, that of the program's own texts first."""
    return [SOURCE, *sorted(one.name[:-3] for one in FOLDER.iterdir() if one.name.endswith(".po"))]


def translations(code: str) -> gettext.NullTranslations:
    """Return the translations of a language; without a catalogue texts stay as they are."""
    found = sources(code)
    return gettext.GNUTranslations(io.BytesIO(_compiled(found))) if found else gettext.NullTranslations()


@cache
def sources(code: str) -> dict[tuple[str, ...], list[str]]:
    """Return the messages of a language; none without a catalogue."""
    path = FOLDER.joinpath(f"{code}.po")
    if code == SOURCE or not path.is_file():
        return {}
    return messages(path.read_text("utf-8"), path.name)


def messages(text: str, file: str) -> dict[tuple[str, ...], list[str]]:
    """Return what a catalogue has: for each text, or its singular and plural, the translations.

    Raises
    ------
    ValueError
        If a line is none of a catalogue, or a text is given twice; with file and line.
    """
    found: dict[tuple[str, ...], list[str]] = {}
    source: list[str] = []
    target: list[str] = []
    adding = source
    for number, line in enumerate([*text.splitlines(), 'msgid ""'], 1):
        word, _, quoted = line.partition('"')
        key = word.strip().partition("[")[0]
        if not line.strip() or line.startswith("#"):
            continue
        if key == "msgid" and target:
            if tuple(source) in found:
                raise ValueError(f"{file}: line {number}: {source[0]!r} stands twice before this line")
            found[tuple(source)] = target
            source, target = [], []
        if key not in ("msgid", "msgid_plural", "msgstr", "") or not quoted.endswith('"'):
            raise ValueError(f'{file}: line {number}: {line!r}: must be msgid "...", msgstr "..." or "..."')
        if key:
            adding = target if key == "msgstr" else source
            adding.append("")
        adding[-1] += str(ast.literal_eval(f'"{quoted}'))
    return found


def _compiled(found: dict[tuple[str, ...], list[str]]) -> bytes:
    """Return the bytes of a ``.mo`` file, which gettext reads."""
    pairs = sorted(
        ("\0".join(source).encode(), "\0".join(target).encode()) for source, target in found.items()
    )
    count, tables, strings = len(pairs), bytearray(), bytearray()
    begin = _HEADER.size + 16 * count
    for column in (0, 1):
        for pair in pairs:
            tables += struct.pack("<2I", len(pair[column]), begin + len(strings))
            strings += pair[column] + b"\0"
    head = _HEADER.pack(_MAGIC, 0, count, _HEADER.size, _HEADER.size + 8 * count, 0, begin)
    return head + bytes(tables) + bytes(strings)
