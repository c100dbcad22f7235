"""The fenced blocks of a lesson's file: ``key: value`` lines, and what each kind of block may have.

A line that begins with spaces goes on with the value of the line before it.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from physicslab.ecs.quantity_text import InvalidText
from physicslab.ecs.text import suggestion
from physicslab.files.checks import SceneError, shown
from physicslab.lessons.lesson import Prose
from physicslab.lessons.setup import AS_IT_IS, Case

_ASKED = ("question", "choice", "number", "curve")
_ANSWERED = ("answer", "tolerance", "mistake", "right", "wrong", "idea", "show", "where", "when")
KEYS: dict[str, tuple[str, ...]] = {
    "scene": ("let", "open", "set", "tools", "show"),
    "predict": (*_ASKED, *_ANSWERED),
    "run": ("seconds", "until", "limit", "graph", "case"),
    "compare": ("quantity", "unit", "measure", "along", "theory", "holds", "tolerance", "case", "fails"),
    "explain": ("question", "answer"),
    "check": (*_ASKED, "goal", "solution", *_ANSWERED),
    "recall": ("ask",),
}  # fmt: skip
"""The kinds of blocks, and the keys of each."""
_LINE = re.compile(r"([a-z]+):(?:\s+(.*)|)$")
_NAME = re.compile(r"[a-z][a-z0-9_]*")


class LessonError(SceneError):
    """A lesson that cannot be read or checked; the message is one line: file, line, block and why.

    Attributes
    ----------
    entry : (str, str)
        The kind of the block and the key that cannot be so; empty where it is not one entry.
    why : str
        The message, without the place.
    """

    entry = ("", "")
    why = ""


@dataclass(frozen=True, slots=True)
class Entry:
    """A key of a block with its value and its line."""

    key: str
    value: str
    line: int


@dataclass(slots=True)
class Block:
    """A fenced block.

    Attributes
    ----------
    kind, name : str
        The first and the second word behind the fence.
    line : int
        Where it begins.
    entries : list of Entry
        Its keys, in order.
    json : str
        A scene behind them.
    file : str
        Name of the file in messages.
    """

    kind: str
    name: str
    line: int
    entries: list[Entry]
    json: str
    file: str

    def error(self, what: str, line: int | None = None) -> LessonError:
        """Return the error that something in the block is wrong."""
        name = f" {self.name}" if self.name else ""
        return LessonError(f"{self.file}: line {line or self.line}: {self.kind}{name}: {what}")

    def refusal(self, entry: Entry, why: object) -> LessonError:
        """Return the error that a value cannot be."""
        error = self.error(f"{entry.key} = {shown(entry.value)}: {why}", entry.line)
        error.entry, error.why = (self.kind, entry.key), str(why)
        return error

    def all(self, *keys: str) -> Iterator[Entry]:
        """Yield the entries of some keys, in order."""
        yield from (entry for entry in self.entries if entry.key in keys)

    def find_first(self, key: str) -> Entry | None:
        """Return the first entry of a key, or ``None``."""
        return next(self.all(key), None)

    def find(self, key: str) -> Entry | None:
        """Return the one entry of a key, or ``None``; refuse a second."""
        found = list(self.all(key))
        if len(found) > 1:
            raise self.error(f"{key} is given twice; must be given once", found[1].line)
        return found[0] if found else None

    def one(self, key: str, allowed: str) -> Entry:
        """Return the one entry of a key that a block must have."""
        entry = self.find(key)
        if entry is None or not entry.value:
            error = self.error(f"{key} is missing: must be {allowed}", entry.line if entry else None)
            error.entry, error.why = (self.kind, key), f"must be {allowed}"
            raise error
        return entry

    def check_format(self, allowed: str) -> None:
        """Refuse a head that is not of a format."""
        entry = self.one("format", allowed)
        if entry.value != allowed:
            raise self.refusal(entry, f"must be {allowed}")

    def text(self, key: str, allowed: str) -> str:
        """Return the words of a key that a block must have."""
        return self.one(key, allowed).value

    def read[T](self, entry: Entry, make: Callable[[str], T]) -> T:
        """Return what is made of a value; refuse one of which nothing can be made."""
        try:
            return make(entry.value)
        except (InvalidText, SceneError) as error:
            why = re.sub(rf"^{re.escape(self.file)}: line \d+: \w+: ", "", str(error))
            raise self.refusal(entry, why) from error

    def case(self, entry: Entry) -> Case:
        """Return the case that an entry holds."""
        return replace(self.read(entry, read_case), line=entry.line)


def read_case(text: str) -> Case:
    """Return the case of a text like ``th = 90 deg; ball.Drag.quadratic = 0.1 kg/m | with air``."""
    assigned, _, note = text.partition("|")
    if assigned.strip() == AS_IT_IS.text:
        return replace(AS_IT_IS, note=note.strip())
    values = []
    for part in filter(None, (part.strip() for part in assigned.split(";"))):
        name, sign, value = (piece.strip() for piece in part.partition("="))
        if not (sign and name and value):
            raise InvalidText("must be NAME = VALUE; NAME = VALUE | a note")
        values.append((name, value))
    return Case(assigned.strip(), tuple(values), note.strip())


def read_document(
    text: str, file: str, head_keys: tuple[str, ...], keys: Mapping[str, tuple[str, ...]]
) -> tuple[Block, list[Prose | Block]]:
    """Return the head of a file, and prose and blocks in order, with the keys that each may have."""
    lines = text.splitlines()
    end = next((i for i, line in enumerate(lines[1:], 1) if line.rstrip() == "---"), 0)
    if not lines or lines[0].rstrip() != "---" or not end:
        raise LessonError(f"{file}: line 1: a lesson must begin with --- and its title, level, ..., and ---")
    head = Block("head", "", 1, [], "", file)
    _read_entries(list(enumerate(lines[1:end], 2)), head_keys, head)
    return head, list(_divided(lines, end + 1, file, keys))


def _divided(
    lines: list[str], start: int, file: str, keys: Mapping[str, tuple[str, ...]]
) -> Iterator[Prose | Block]:
    """Yield prose and blocks of the lines from ``start`` on."""
    prose: list[str] = []
    begun, place = start, start
    while place < len(lines):
        line = lines[place]
        place += 1
        if line.startswith("## "):
            yield from _prose(prose, begun)
            prose, begun = [], place - 1
        words = line[3:].strip() if line.startswith("```") else ""
        if words in ("", "text"):
            prose.append(line)
            continue
        yield from _prose(prose, begun)
        prose, number = [], place
        kind, name = _checked_kind(words, file, number)
        block = Block(kind, name, number, [], "", file)
        inner: list[tuple[int, str]] = []
        while place < len(lines) and lines[place].rstrip() != "```":
            inner.append((place + 1, lines[place]))
            place += 1
        if place == len(lines):
            raise block.error("the block has no end: must end with a line of ```")
        place += 1
        begun = place
        _read_entries(inner, keys[kind], block)
        yield block
    yield from _prose(prose, begun)


def _prose(lines: list[str], begun: int) -> Iterator[Prose]:
    """Yield the text of lines, the first of which has ``begun`` before it, if there is any."""
    first = next((i for i, line in enumerate(lines) if line.strip()), None)
    if first is not None:
        yield Prose("\n".join(lines[first:]).strip(), begun + first + 1)


def _read_entries(lines: Iterable[tuple[int, str]], known: tuple[str, ...], block: Block) -> None:
    """Fill a block with the entries of numbered lines; from a line with a bracket on it is a scene."""
    numbered = list(lines)
    for place, (number, text) in enumerate(numbered):
        if not text.strip():
            continue
        if text.startswith("{") and block.kind == "scene":
            block.json = "\n" * (number - 1) + "\n".join(line for _, line in numbered[place:])
            return
        if text[0].isspace() and block.entries:
            last = block.entries[-1]
            block.entries[-1] = Entry(last.key, f"{last.value} {text.strip()}".strip(), last.line)
            continue
        found = _LINE.match(text)
        if found is None:
            raise block.error(f"{shown(text)}: must be KEY: VALUE, or begin with spaces to go on", number)
        key, value = found[1], (found[2] or "").strip()
        if key not in known:
            raise block.error(
                f"{key}: unknown key; must be one of {', '.join(known)}{suggestion(key, known)}", number
            )
        block.entries.append(Entry(key, value, number))


def _checked_kind(words: str, file: str, line: int) -> tuple[str, str]:
    """Return the kind and the name of a block, the words behind its fence."""
    kind, _, name = words.partition(" ")
    if kind not in KEYS:
        raise LessonError(
            f"{file}: line {line}: {shown(kind)}: unknown block; must be one of {', '.join(KEYS)}"
            f"{suggestion(kind, KEYS)}"
        )
    name = name.strip()
    if name and not _NAME.fullmatch(name):
        raise LessonError(
            f"{file}: line {line}: {kind} {shown(name)}: a block's name must be small letters, digits and _"
        )
    return kind, name
