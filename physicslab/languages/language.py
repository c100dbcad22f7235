"""What is said to people: whole sentences with named gaps, numbers and dates, in one language."""

import re
from datetime import date
from functools import cache
from gettext import NullTranslations

from physicslab.languages.catalogue import SOURCE, translations

_POINT = re.compile(r"(?<=\d)\.(?=\d)")


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
        self._catalogue = translations(code) if catalogue is None else catalogue
        self._mark = self.say(".")

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
        """
        return _POINT.sub(self._mark, text)

    def date(self, day: date) -> str:
        """Return a day with the month by its name.

        >>> language("de").date(date(2026, 3, 1)), language("en").date(date(2026, 3, 1))
        ('1. März 2026', '1 March 2026')
        """
        months = (
            self.say("January"), self.say("February"), self.say("March"), self.say("April"), self.say("May"),
            self.say("June"), self.say("July"), self.say("August"), self.say("September"),
            self.say("October"), self.say("November"), self.say("December"),
        )  # fmt: skip
        return self.say("{day} {month} {year}", day=day.day, month=months[day.month - 1], year=day.year)


@cache
def language(code: str = SOURCE) -> Language:
    """Return a language by its code; one that has no catalogue has the program's own texts."""
    return Language(code)
