"""XML as a tree of elements with their lines, in bounded memory: entities are refused, not expanded."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from physicslab.files.checks import SceneError, shown

ELEMENT_LIMIT = 1_000_000
"""Elements that a file may hold; a particle is six."""
DEPTH_LIMIT = 50
"""Elements within each other; groups of groups are deeper than two only by hand."""


@dataclass(slots=True)
class Element:
    """An element: its tag without a namespace, its attributes, its line, its text and what is in it."""

    tag: str
    attributes: dict[str, str]
    line: int
    pieces: list[str] = field(default_factory=list)
    children: list[Element] = field(default_factory=list)

    @property
    def text(self) -> str:
        """The text that stands directly in it."""
        return "".join(self.pieces)

    def named(self, tag: str) -> Iterator[Element]:
        """Yield the elements of a tag that stand directly in it."""
        return (child for child in self.children if child.tag == tag)


def parse_xml(content: bytes, source: str) -> Element:
    """Return the root of an XML file; an invalid one, or one with declarations of entities, is a SceneError.

    >>> parse_xml(b"<world><item/></world>", "a.step").children[0].tag
    'item'
    """
    parser = expat.ParserCreate()
    parser.buffer_text = True
    tree = _Tree(parser, source)
    parser.StartElementHandler, parser.EndElementHandler = tree.start, tree.end
    parser.CharacterDataHandler = tree.write
    parser.EntityDeclHandler = tree.refuse_entity
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        words = expat.ErrorString(error.code)
        place = f"at line {error.lineno}, column {error.offset + 1}"
        raise SceneError(f"{source}: is not XML: {words} {place}") from error
    except (LookupError, UnicodeError) as error:  # an encoding that Python does not know
        raise SceneError(f"{source}: is not XML: its encoding cannot be read") from error
    return tree.root.children[0]


class _Tree:
    """Builds the tree while the parser reads."""

    def __init__(self, parser: expat.XMLParserType, source: str) -> None:
        self.root = Element("", {}, 0)
        self._open = [self.root]
        self._parser, self._source, self._count = parser, source, 0

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        line = self._parser.CurrentLineNumber
        self._count += 1
        if self._count > ELEMENT_LIMIT:
            raise SceneError(
                f"{self._source}: holds too much: a scene must have at most {ELEMENT_LIMIT:,} elements"
            )
        if len(self._open) > DEPTH_LIMIT:
            raise SceneError(f"{self._source}: line {line}: is nested too deeply to be a scene")
        made = Element(tag.rpartition(":")[2], attributes, line)
        self._open[-1].children.append(made)
        self._open.append(made)

    def end(self, tag: str) -> None:
        self._open.pop()

    def write(self, text: str) -> None:
        self._open[-1].pieces.append(text)

    def refuse_entity(self, name: str, *_: object) -> None:
        line = self._parser.CurrentLineNumber
        raise SceneError(f"{self._source}: line {line}: declares the entity {shown(name)}; must declare none")
