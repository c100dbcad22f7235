"""The words of a lesson in another language: ``de/NAME.md`` beside ``NAME.md``, with words alone.

Scene, theory, tolerance and conditions stand in the lesson; its translation has the same headings, paragraphs
and blocks in the same order, and of each block the lines that are words.
"""

import re
from collections.abc import Iterator
from dataclasses import replace

from physicslab.lessons.blocks import Block, Entry, LessonError, read_document
from physicslab.lessons.lesson import HEADING, Prose
from physicslab.lessons.parts import CITED

FORMAT = "physicslab-lesson-words/1"
_HEAD = ("format", "title", "needs")
_WHOLE = {
    "head": ("title", "needs"), "scene": (), "run": (), "compare": ("quantity",), "recall": (),
    "explain": ("question", "answer"), "predict": ("question", "choice", "right", "wrong", "idea"),
    "check": ("question", "choice", "right", "wrong", "idea"),
}  # fmt: skip
"""Lines that are words, by kinds of blocks."""
_NOTED = ("let", "case", "fails", "show", "where", "solution")
"""Lines of which the note behind ``|`` is words."""
_KEYS = {kind: ("title", *whole, *_NOTED) for kind, whole in _WHOLE.items()}
_TITLE = re.compile(r'"title"\s*:')


def translate(
    head: Block, body: list[Prose | Block], text: str, file: str
) -> tuple[Block, list[Prose | Block]]:
    """Return the head and the body of a lesson with the words of a translation.

    Raises
    ------
    LessonError
        If the translation lacks words of the lesson, or has others; with its file and line.
    """
    own_head, own = read_document(text, file, _HEAD, _KEYS)
    own_head.check_format(FORMAT)
    own_head.entries = [entry for entry in own_head.entries if entry.key != "format"]
    left = iter(own)
    made = [_piece(one, left, file) for one in body]
    for surplus in left:
        raise LessonError(f"{file}: line {surplus.line}: nothing of the lesson is left for this")
    return _block(head, own_head), made


def _piece(one: Prose | Block, left: Iterator[Prose | Block], file: str) -> Prose | Block:
    """Return a paragraph or a block with the next words, if it has words."""
    if isinstance(one, Block) and not list(_words(one)):
        return one
    what = f"{one.kind} {one.name}".rstrip() if isinstance(one, Block) else "text"
    given = next(left, None)
    if given is None:
        raise LessonError(f"{file}: {what}, line {one.line} of the lesson, is missing")
    if isinstance(one, Block):
        if not isinstance(given, Block) or (given.kind, given.name) != (one.kind, one.name):
            raise LessonError(
                f"{file}: line {given.line}: must be {what}, as in line {one.line} of the lesson"
            )
        return _block(one, given)
    found = HEADING.match(one.text)
    if isinstance(given, Block) or bool(found) != given.text.startswith("## "):
        kind = "a heading" if found else what
        raise LessonError(f"{file}: line {given.line}: must be {kind}, as in line {one.line} of the lesson")
    if one.text.count("\n\n") != given.text.count("\n\n"):
        raise LessonError(
            f"{file}: line {given.line}: must have the paragraphs of line {one.line} of the lesson"
        )
    if found is None:
        return Prose(given.text, one.line)
    return Prose(one.text[: found.start(2)] + given.text.removeprefix("## ").lstrip(), one.line)


def _words(block: Block) -> Iterator[Entry]:
    """Yield the title of a scene and the lines of a block that have words; the name of a parameter is one."""
    if _TITLE.search(block.json):
        yield Entry("title", "", block.line)
    for entry in block.entries:
        noted = entry.key == "let" or (entry.key in _NOTED and "|" in entry.value)
        if noted or entry.key in _WHOLE[block.kind]:
            yield entry


def _block(block: Block, given: Block) -> Block:
    """Return a block with the words that are given for it."""
    left, entries = iter(given.entries), {entry.line: entry for entry in block.entries}
    for entry in _words(block):
        own = next(left, None)
        if own is None:
            raise given.error(f"{entry.key} is missing: the words of line {entry.line} of the lesson")
        if own.key != entry.key:
            raise given.refusal(own, f"must be {entry.key}, the words of line {entry.line} of the lesson")
        entries[-1 if entry.key == "title" and block.kind == "scene" else entry.line] = _entry(
            entry, own, given
        )
    for surplus in left:
        raise given.refusal(surplus, "the lesson has no such words here")
    return replace(block, entries=list(entries.values()))


def _entry(entry: Entry, own: Entry, given: Block) -> Entry:
    """Return a line with its words exchanged."""
    words = own.value
    if entry.key == "let":
        name, _, words = (part.strip() for part in words.partition("|"))
        declared = entry.value.partition("=")[0].strip()
        if name != declared:
            raise given.refusal(own, f"must be {declared} | what it is")
    if not words:
        raise given.refusal(own, f"must have the words of line {entry.line} of the lesson")
    cited = sorted(CITED.findall(entry.value))
    if sorted(CITED.findall(words)) != cited:
        raise given.refusal(own, f"must cite {', '.join(cited) or 'no source'}, as the lesson does")
    if entry.key in _NOTED:
        words = f"{entry.value.partition('|')[0].strip()} | {words}"
    return replace(entry, value=words)
