"""An item of a Step file: its properties by name, each checked and refused with its line."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

from physicslab.ecs.text import printable, shortened
from physicslab.files.checks import SceneError, refusal, shown
from physicslab.files.kde_step.xml import Element

type Pair = tuple[float, float]
"""A vector [SI unit of the property]."""

_PAIR = re.compile(r"\(([^(),]*),([^(),]*)\)")
_PAIRS = re.compile(rf"\s*{_PAIR.pattern}\s*(?:,\s*{_PAIR.pattern}\s*)*")


@dataclass(frozen=True, slots=True)
class Item:
    """An item: an element of Step with a class, a number by which others refer to it, and properties."""

    element: Element
    source: str

    @property
    def kind(self) -> str:
        """The class: ``Particle``, ``Spring``, ..."""
        return self.element.attributes.get("class", "")

    @property
    def number(self) -> int:
        """The number by which others refer to it."""
        given = self.element.attributes.get("id", "").strip()
        if not (given.isdecimal() and given.isascii() and len(given) < 10 and int(given) > 0):
            raise refusal(f"{self.where}: id", given, "a whole number >= 1")
        return int(given)

    @property
    def label(self) -> str:
        """Its name in messages: class, name and line."""
        name = self.text("name").strip()
        named = f' "{shortened(printable(name))}"' if name else ""
        return f"{shortened(printable(self.kind or self.element.tag))}{named} (line {self.element.line})"

    @property
    def where(self) -> str:
        """The beginning of a message that refuses it."""
        return f"{self.source}: {self.label}"

    @property
    def items(self) -> list[Item]:
        """The items in it, if it is a group."""
        return [Item(element, self.source) for element in self.element.named("item")]

    def has(self, name: str) -> bool:
        """Whether the file gives a property."""
        return next(self.element.named(name), None) is not None

    def text(self, name: str) -> str:
        """Return a property as it stands in the file; empty where the file has none, as Step has it."""
        found = next(self.element.named(name), None)
        return "" if found is None else found.text

    def number_of(self, name: str, default: float, *, infinite: bool = False) -> float:
        """Return a number; ``infinite``: whether it may be, as a mass may."""
        if not self.has(name):
            return default
        value = _number(self.text(name))
        if math.isfinite(value) or (infinite and value == math.inf):
            return value
        raise self._refusal(name, "a finite number" + (" or inf" if infinite else ""))

    def pair(self, name: str) -> Pair:
        """Return a vector; where the file has none, it is zero."""
        if not self.has(name):
            return 0.0, 0.0
        pairs = self.pairs(name)
        if len(pairs) != 1:
            raise self._refusal(name, "two finite numbers (x,y)")
        return pairs[0]

    def pairs(self, name: str) -> Sequence[Pair]:
        """Return a list of vectors."""
        text = self.text(name).strip()
        if text and not _PAIRS.fullmatch(text):
            raise self._refusal(name, "a list of pairs of finite numbers (x,y),(x,y)")
        pairs = [(_number(x), _number(y)) for x, y in _PAIR.findall(text)]
        if not all(map(math.isfinite, (part for pair in pairs for part in pair))):
            raise self._refusal(name, "pairs of finite numbers (x,y)")
        return pairs

    def whole(self, name: str, default: int) -> int:
        """Return a whole number, such as that of another item."""
        text = self.text(name).strip()
        if not text:
            return default
        if not re.fullmatch(r"-?[0-9]{1,9}", text):
            raise self._refusal(name, "a whole number")
        return int(text)

    def colour(self) -> str:
        """Return its colour as ``#rrggbb``; empty for none, and for black, which all begin with."""
        text = self.text("color").strip().lower()
        found = re.fullmatch("#(?:[0-9a-f]{2})?([0-9a-f]{6})", text)
        if text and not found:
            raise self._refusal("color", "a colour #aarrggbb")
        return "" if not found or found[1] == "000000" else f"#{found[1]}"

    def flag(self, name: str) -> bool:
        """Return whether a property is set."""
        return self.text(name).strip() in ("true", "1")

    def _refusal(self, name: str, allowed: str) -> SceneError:
        found = next(self.element.named(name))
        place = f"{self.source}: line {found.line}: {shortened(printable(self.kind or self.element.tag))}"
        return SceneError(f"{place}: <{name}> = {shown(self.text(name).strip())}: must be {allowed}")


def _number(text: str) -> float:
    """Return what a text says, nan where it says no number."""
    try:
        return math.nan if "_" in text else float(text)
    except ValueError:
        return math.nan
