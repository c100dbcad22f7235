"""Texts for people: whole sentences with named gaps, and numbers, in one language."""

import re
import sys
from functools import cache, lru_cache
from gettext import NullTranslations

from physicslab.languages.catalogue import SOURCE, sources, translations
from physicslab.languages.sentence import Sentence

ON_MAC = sys.platform == "darwin"
"""Whether texts are for macOS, where Ctrl is Cmd."""
_POINT = re.compile(r"(?<![\w.])(\d+)\.(\d+(?:e[+-]?\d+)?)(?!\w|\.\w)")
"""A number with a decimal point, which is no part of a name."""
_BETWEEN = re.compile(r"(?<=\d), (?=[-\u2212]?\d)")
_GAP = re.compile(r"\\\{([a-z_]+)\\\}")
_MEASURED = re.compile(r"(\D+?) ([-\u2212]?\d.*)")
"""Words and their number."""
_CTRL = re.compile(r"\b(?:Ctrl|Strg)\b")
"""The key that is Cmd on macOS."""
_KNOWN_BY = 4
"""So many letters around its gaps tell a sentence that begins with one."""
_AS_WRITTEN = frozenset({"block", "entry", "file", "line", "names", "path", "text"})
"""Gaps with what stands in a file, which is the same in every language."""
_IN_GAPS = {"entry": r"\S", "file": r"(?:(?!: line \d).)", "path": r"(?:(?!: line \d).)"}
"""Patterns of what is in gaps, where that is not anything."""
_KEPT = 4096
"""Texts whose translation is kept: panels write the same ones again and again."""


class Language:
    """One language.

    Parameters
    ----------
    code : str
        As ``"de"``.
    catalogue : gettext.NullTranslations, optional
        Its translations; those of ``CODE.po`` where absent.
    """

    def __init__(self, code: str, catalogue: NullTranslations | None = None) -> None:
        self.code = code
        own = translations(code) if catalogue is None else catalogue
        self._catalogue = _MacTexts(own) if ON_MAC else own
        self._mark = self.say(".")
        self._sentences = _sentences(code)
        self._reworded = lru_cache(_KEPT)(self._found)

    def say(self, text: str, /, **gaps: object) -> str:
        """Return a text of the program in this language, its gaps filled: ``{name}``.

        >>> language("de").say("{least} to {most}", least="1 m", most="4 m")
        '1 m bis 4 m'
        """
        return self._catalogue.gettext(text).format(**gaps) if gaps else self._catalogue.gettext(text)

    def say_count(self, one: str, many: str, /, n: int, **gaps: object) -> str:
        """Return one of two texts by a number, which both may have as ``{n}``.

        >>> language("de").say_count("{n} minute", "{n} minutes", 1)
        '1 Minute'
        """
        return self._catalogue.ngettext(one, many, n).format(n=n, **gaps)

    def decimal(self, text: str) -> str:
        """Return a text with the decimal mark of the language in its numbers.

        >>> language("de").decimal("rod = 0.25 m"), language("en").decimal("0.25 m")
        ('rod = 0,25 m', '0.25 m')
        >>> language("de").decimal("(0, -3) kg m/s"), language("de").decimal("1, 2")
        ('(0; -3) kg m/s', '1, 2')
        """
        if self._mark == ".":
            return text
        text, numbers = _POINT.subn(rf"\g<1>{self._mark}\g<2>", text)
        return _BETWEEN.sub("; ", text) if numbers or text.startswith("(") else text

    def reword(self, text: str) -> str:
        """Return a finished text of the program in this language, also the numbers in it.

        A :class:`Sentence` is said as it was made, and names in its gaps stay. In other texts a sentence is
        known by what it has around its gaps, ``"Saved {file}"``, and what stands in these is reworded as
        well; several lines are, each for itself. Any other text stays, but for its numbers.

        >>> [language(code).reword("undo: 2.5 m") for code in ("de", "en")], language("de").reword("undo")
        (['undo: 2,5 m', 'undo: 2.5 m'], 'Rückgängig')
        """
        if isinstance(text, Sentence) and text.values:
            return self._filled(text)
        has_words = any(map(str.isalpha, text))
        return self._reworded(text) if has_words else self.decimal(text)

    def _filled(self, text: Sentence) -> str:
        """Return a sentence whose gaps are known."""
        said = {
            name: self.reword(value) if isinstance(value, Sentence) else self.decimal(value)
            for name, value in text.values.items()
        }
        return (self._known(text.template) or text.template).format(**said)

    def _known(self, text: str) -> str:
        """Return a text in the language; empty where the catalogue has it neither so nor as one begins."""
        for written in (text, text[:1].swapcase() + text[1:]):  # as within a sentence, or where one begins
            known = self._catalogue.gettext(written)
            if known != written or (written,) in sources(self.code):
                return known
        return ""

    def _found(self, text: str) -> str:
        if known := self._known(text):
            return known
        if "\n" in text:
            return "\n".join(map(self.reword, text.split("\n")))
        for pattern, source in (*self._sentences.get(text[:1], ()), *self._sentences.get("", ())):
            if match := pattern.fullmatch(text):
                # A gap may take up the rest of a list: "friction {value}" of "friction 1 J, damping 2 J".
                parts = text.split(", ") if ": " not in text else []
                if len(parts) > 1 and all(map(_MEASURED.fullmatch, parts)) and (row := self._list(text)):
                    return row
                gaps = {
                    name: value if name in _AS_WRITTEN else self.reword(value)
                    for name, value in match.groupdict().items()
                }
                number = int(gaps["n"]) if gaps.get("n", "").isdecimal() else 2
                sentence = self._catalogue.gettext if len(source) == 1 else self._catalogue.ngettext
                arguments = source if len(source) == 1 else (*source, number)
                return str(sentence(*arguments)).format(**gaps)
        return self._list(text) or self.decimal(text)

    def _list(self, text: str) -> str:
        """Return sentences in a row, a list, or words and a number, all known; empty where one is not.

        >>> language("de").reword("cart 1: mass"), language("de").reword("cart 1: what it is")
        ('cart 1: Masse', 'cart 1: what it is')
        """
        for between in (". ", "; ", ": ", ", "):
            parts = text.split(between) if between in text else []
            said = [self.reword(part) for part in parts]
            known = [one != self.decimal(own) for one, own in zip(said, parts, strict=True)]
            if parts and (all(known) or (between == ": " and len(parts) == 2 and known[1])):
                return between.join(said)  # what is before a colon may be the name of a body
        measured = _MEASURED.fullmatch(text)
        said = [self.reword(part) for part in measured.groups()] if measured else []
        return " ".join(said) if measured and said[0] != measured[1] else ""


class _MacTexts(NullTranslations):
    """The texts of a catalogue for macOS."""

    def __init__(self, catalogue: NullTranslations) -> None:
        super().__init__()
        self.add_fallback(catalogue)

    def gettext(self, message: str) -> str:
        return _CTRL.sub("Cmd", super().gettext(message))


@cache
def language(code: str = SOURCE) -> Language:
    """Return a language by its code; one that has no catalogue has the program's own texts."""
    return Language(code)


def _sentences(code: str) -> dict[str, list[tuple[re.Pattern[str], tuple[str, ...]]]]:
    """Return what finds each text with gaps, by its first letter, the longest first; empty before a gap."""
    found: dict[str, list[tuple[re.Pattern[str], tuple[str, ...]]]] = {}
    texts = [(text, source) for source in sources(code) for text in source if _is_sentence(text)]
    for text, source in sorted(texts, key=lambda one: len(one[0]), reverse=True):
        pattern = re.compile(_GAP.sub(_gap_pattern, re.escape(text)))
        found.setdefault("" if text[0] == "{" else text[0], []).append((pattern, source))
    return found


def _gap_pattern(found: re.Match[str]) -> str:
    """Return the pattern of a gap; an entry of a file is one word, and in a file's name there is no line."""
    return rf"(?P<{found[1]}>{_IN_GAPS.get(found[1], '.')}+?)"


def _is_sentence(text: str) -> bool:
    """Whether a text has gaps, and words around them by which it is known: before them, or long enough."""
    letters = sum(map(str.isalpha, re.sub(r"\{[a-z_]+\}", "", text)))
    return "{" in text and (letters >= _KNOWN_BY or (letters > 0 and text[0] != "{"))
