"""From a lesson's file, Markdown with fenced blocks, to its records; errors name the line."""

import hashlib
import os
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from physicslab.diagnostics.figures import FUNCTIONS
from physicslab.ecs.quantity_text import Expression, InvalidText, is_known
from physicslab.ecs.text import printable, shortened
from physicslab.files.checks import SceneError, shown
from physicslab.files.plain import read_bytes
from physicslab.files.reader import FORMAT as SCENE_FORMAT
from physicslab.files.scene import load_scene, parse_json, write_scene
from physicslab.lessons.blocks import KEYS, Block, Entry, LessonError, read_case, read_document
from physicslab.lessons.lesson import DEPTHS, HEADING, Lesson, Part, Prose, Step
from physicslab.lessons.parts import CITED, PartMaker
from physicslab.lessons.setup import Parameters, Setup
from physicslab.lessons.translation import FORMAT as WORDS_FORMAT
from physicslab.lessons.translation import translate
from physicslab.state.attached import INSTRUMENTS
from physicslab.state.contents import SHOWN

FORMAT = "physicslab-lesson/1"
FILE_LIMIT = 2**20
"""Bytes that a lesson may have."""
TOOLS = ("hand", "stopwatch", *(kind.__name__.lower() for kind in INSTRUMENTS))
"""Tools of the window that a lesson may open to its learners."""
_HEAD = ("format", "title", "level", "minutes", "needs", "scene", "language", "source")
_WORDS = re.compile(rf"^format:\s*{re.escape(WORDS_FORMAT)}\s*$", re.MULTILINE)
_LANGUAGE = re.compile(r"[a-z]{2,3}")


def read_lesson(path: str | os.PathLike[str], language: str = "") -> Lesson:
    """Return the lesson of a file.

    Its words are those of ``LANGUAGE/NAME.md`` beside it if there is one, and otherwise its own. The digest
    is that of the lesson alone: answers in one language can be graded in another.

    Raises
    ------
    LessonError
        If anything in it is not allowed; one line: file, line, block, value and what is allowed.
    """
    place, file = Path(path), printable(os.fspath(path))
    if language and not _LANGUAGE.fullmatch(language):
        raise LessonError(f"language = {shown(language)}: must be the code of a language, as de")
    content, text = _text(place, file)
    beside = place.parent / language / place.name
    if not language or not beside.is_file():
        return replace(parse_lesson(text, file, place), digest=hashlib.sha256(content).hexdigest())
    words = printable(str(beside))
    lesson = parse_lesson(text, file, place, (_text(beside, words)[1], words))
    return replace(lesson, digest=hashlib.sha256(content).hexdigest(), language=language)


def _text(path: Path, file: str) -> tuple[bytes, str]:
    """Return the bytes of a file and their text."""
    try:
        content = read_bytes(path, file, FILE_LIMIT, "a lesson")
        return content, content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise LessonError(f"{file}: is not UTF-8: byte {error.start}; must be Markdown in UTF-8") from error
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error).removeprefix(f"{file}: ")
        raise LessonError(f"{file}: cannot be read: {why}") from error


def parse_lesson(text: str, file: str, path: Path = Path(), words: tuple[str, str] | None = None) -> Lesson:
    """Return the lesson of a text that messages call ``file``; scenes are looked for beside ``path``.

    The ``words`` are the text of its translation, and what messages call that.
    """
    if found := _WORDS.search(text):
        why = f"are words of a lesson in another language; must be {path.name} of the folder above"
        line = text.count("\n", 0, found.start()) + 1
        raise LessonError(f"{file}: line {line}: head: these {why}, with --language {path.parent.name}")
    head, body = read_document(text, file, _HEAD, KEYS)
    head.check_format(FORMAT)
    if words is not None:
        head, body = translate(head, body, *words)
    scenes = [block for block in body if isinstance(block, Block) and block.kind == "scene"]
    if len(scenes) > 1:
        raise scenes[1].error("a lesson has one scene; cases say what differs")
    setup = _setup(head, scenes[0] if scenes else Block("scene", "", 1, [], "", file), path)
    language, needs, sources = head.find("language"), head.find("needs"), dict(_sources(head))
    if language and not _LANGUAGE.fullmatch(language.value):
        raise head.refusal(language, 'must be the code of a language, as "en" or "de"')
    if needs and needs.value and not any(map(str.isalpha, needs.value)):
        raise head.refusal(needs, "must be words for what is known before, as: speed, forces")
    maker = PartMaker(setup, sources)
    maker.make_runs(one for one in body if isinstance(one, Block) and one.kind == "run")
    return Lesson(
        name=path.name.removesuffix(".md").partition(".")[0] or "lesson",
        title=shortened(head.text("title", "a line that names the lesson"), 200),
        language=language.value if language else "en",
        level=_whole(head, "level", DEPTHS[0], DEPTHS[-1]), minutes=_whole(head, "minutes", 1, 600),
        needs=tuple(part.strip() for part in needs.value.split(",") if part.strip()) if needs else (),
        setup=setup, steps=tuple(_steps(body, maker, file)), sources=sources,
        quantities=tuple(maker.quantities), path=path,
    )  # fmt: skip


def _setup(head: Block, block: Block, path: Path) -> Setup:
    """Return the scene of a lesson: named in its head, or written in its block."""
    source, named = f"{block.file}: line {block.line}: scene", head.find("scene")
    if bool(named) == bool(block.json):
        raise block.error("must be named in the head (scene: NAME), or written here as { ... }; one of both")
    if named:
        beside = path.parent / named.value
        world = head.read(named, lambda text: load_scene(beside if beside.is_file() else text))
        document = write_scene(world)
    else:
        try:
            found = parse_json(block.json, block.file)
        except SceneError as error:
            raise block.error(str(error).removeprefix(f"{block.file}: ")) from error
        if not isinstance(found, dict) or not isinstance(found.get("entities"), list):
            raise block.error('must be {"entities": [...], ...}')
        document = {"format": SCENE_FORMAT, **found, **{one.key: one.value for one in block.all("title")}}
    parameters: dict[str, Expression] = {}
    values = Parameters(known := {})
    notes: dict[str, str] = {}
    for entry in block.all("let"):
        name, sign, value = (part.strip() for part in entry.value.partition("="))
        text, _, note = (part.strip() for part in value.partition("|"))
        taken = is_known(name) or name in FUNCTIONS or name in parameters or name in ("time", "world")
        if not (sign and name.isidentifier()) or taken:
            why = "is taken: a unit, a constant, a function or a name before it" if taken else ""
            raise block.refusal(entry, f"{why or 'no name'}; must be NAME = VALUE, as in length = 2 m")
        try:
            parameters[name], notes[name] = Expression(text), note
            known[name] = parameters[name].value(values)
        except InvalidText as error:
            raise block.refusal(entry, error) from error
    setup = Setup(
        document, source, parameters, notes, _opened(block, parameters),
        _words(block, "tools", TOOLS), _words(block, "show", SHOWN),
    )  # fmt: skip
    for entry in block.all("set"):
        setup = _fixed(setup, block, entry)
    try:
        setup.world()  # what is wrong with it is refused with its line
    except (InvalidText, SceneError) as error:
        raise block.error(str(error).removeprefix(f"{source}: ")) from error
    for entry, name in zip(block.all("open"), setup.opened, strict=True):
        _check_span(setup, block, entry, name)
    return setup


def _fixed(setup: Setup, block: Block, entry: Entry) -> Setup:
    return block.read(entry, lambda text: setup.fixed(read_case(text)))


def _opened(block: Block, parameters: dict[str, Expression]) -> dict[str, tuple[str, str]]:
    opened: dict[str, tuple[str, str]] = {}
    for entry in block.all("open"):
        name, _, span = (part.strip() for part in entry.value.partition("="))
        low, to, high = (part.strip() for part in span.partition(" to "))
        if name not in parameters or not to or name in opened:
            names = ", ".join(one for one in parameters if one not in opened) or "none"
            raise block.refusal(entry, f"must be NAME = LEAST to GREATEST, the name one of {names}")
        for text in (low, high):
            block.read(replace(entry, value=text), _number)
        opened[name] = low, high
    return opened


def _check_span(setup: Setup, block: Block, entry: Entry, name: str) -> None:
    """Refuse limits that the usual value of a parameter is not within, or that are of another unit."""
    usual = setup.parameters[name].text
    ends = (*setup.opened[name], usual)
    low, high, value = block.read(entry, lambda _: [setup.quantity(name, end) for end in ends])
    if not low <= value <= high or low == high:
        raise block.refusal(
            entry, f"must go from the least to the greatest, with {name} = {usual} in between"
        )


def _number(text: str) -> float:
    """Return the number that a text of numbers and units stands for [SI]."""
    return Expression(text).value().value


def _words(block: Block, key: str, known: tuple[str, ...]) -> tuple[str, ...]:
    entry = block.find(key)
    words = tuple(word.strip() for word in entry.value.split(",")) if entry else ()
    for word in words:
        if entry and word not in known:
            raise block.refusal(entry, f"{shown(word)}: must be some of {', '.join(known)}")
    return words


def _sources(head: Block) -> Iterator[tuple[str, str]]:
    for entry in head.all("source"):
        key, sign, words = (part.strip() for part in entry.value.partition("="))
        if not (sign and words and CITED.fullmatch(f"[{key}]")):
            raise head.refusal(entry, "must be KEY = who, when, where; the key as hestenes1992")
        yield key, words


def _whole(head: Block, key: str, least: int, most: int) -> int:
    allowed = f"a whole number from {least} to {most}"
    entry = head.one(key, allowed)
    if not entry.value.isdecimal() or not least <= int(entry.value) <= most:
        raise head.refusal(entry, f"must be {allowed}")
    return int(entry.value)


def _steps(body: list[Prose | Block], maker: PartMaker, file: str) -> Iterator[Step]:
    """Yield the parts of a lesson by their headings; what stands before the first has none."""
    heading, depth, parts = "", DEPTHS[0], list[Part]()
    taken: dict[str, int] = {}
    for one in body:
        if isinstance(one, Block):
            if one.kind == "scene":
                continue
            part = maker.make(one)
            line = taken.setdefault(part.name, part.line)
            if line != part.line:
                raise one.error(f"the block of line {line} has this name; must have one of its own")
            parts.append(part)
            continue
        first, _, rest = one.text.partition("\n")
        found = HEADING.fullmatch(first)
        if found is None:
            parts.append(one)
            continue
        if heading or parts:
            yield Step(heading, depth, tuple(parts))
        heading, parts = found[2].strip(), []
        if not found[1] or int(found[1]) not in DEPTHS:
            why = "a level must be 1, 2 or 3, as in ## Level 1: QUESTION"
            raise LessonError(f"{file}: line {one.line}: {shown(first)}: {why}")
        depth = int(found[1])
        if rest.strip():
            parts.append(Prose(rest.strip(), one.line + 1))
    if heading or parts:
        yield Step(heading, depth, tuple(parts))
