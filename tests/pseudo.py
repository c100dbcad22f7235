"""A pseudo-language, in which all texts are twice as long: what does not fit then would not fit in others."""

import re
from gettext import NullTranslations

from physicslab.languages.language import Language


class Doubled(NullTranslations):
    """A pseudo-language: each letter of a text stands twice, so that it takes twice the room."""

    def gettext(self, message: str) -> str:
        return re.sub(r"\{[a-z_]+\}|\w", lambda found: found[0] * (1 if "{" in found[0] else 2), message)

    def ngettext(self, msgid1: str, msgid2: str, n: int) -> str:
        return self.gettext(msgid1 if n == 1 else msgid2)


class Pseudo(Doubled):
    """The same, for texts of which some are doubled already: those stay."""

    def gettext(self, message: str) -> str:
        words = re.findall(r"[^\W\d]+", message)
        return message if all(word[::2] == word[1::2] for word in words) else super().gettext(message)


PSEUDO = Language("qps", Pseudo())
"""The pseudo-language of a window or a page."""
