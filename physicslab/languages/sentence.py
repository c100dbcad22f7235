"""A sentence of the program with what stands in its gaps, which a language words where it is shown."""

from typing import Self


class Sentence(str):
    """A sentence; as a text it is English, and :meth:`Language.reword` says it in another language.

    Parameters
    ----------
    template : str
        The whole sentence in English, its gaps as ``{name}``. Catalogues know it by that.
    code : str
        Its code for programs: the same whatever its words; empty unless it is a reason.
    **values : object
        Values of the gaps. A sentence there is said in the language too; any other text is a name, and
        the same in every language.

    >>> Sentence("{body} is fixed", body="Box")
    'Box is fixed'
    """

    __slots__ = ("code", "template", "values")

    code: str
    template: str
    values: dict[str, str]

    def __new__(cls, template: str, /, code: str = "", **values: object) -> Self:
        """Return the sentence, its gaps filled."""
        held = {name: value if isinstance(value, str) else str(value) for name, value in values.items()}
        made = super().__new__(cls, template.format(**held) if "{" in template else template)
        made.template, made.code, made.values = template, code, held
        return made

    def capitalize(self) -> Self:
        """Return the sentence as one begins; names in it stay as they are."""
        template = self.template[:1].upper() + self.template[1:]
        return type(self)(template, self.code, **self.values)

    def __getnewargs_ex__(self) -> tuple[tuple[str, str], dict[str, str]]:
        """Return what a copy is made of."""
        return (self.template, self.code), self.values


def proper(name: str) -> Sentence:
    """Return a name as a sentence of its own: what a thing was called is no word of the program.

    >>> proper("Box").template
    '{name}'
    """
    return Sentence("{name}", name=name)


def coded(text: str) -> dict[str, object]:
    """Return the code of a reason and its values, of which reasons are such again; empty without a code.

    >>> coded(Sentence("{body} is fixed", "fixed", body="Box")), coded("a text")
    ({'code': 'fixed', 'values': {'body': 'Box'}}, {})
    """
    if not isinstance(text, Sentence) or not text.code:
        return {}
    return {"code": text.code, "values": {name: coded(one) or one for name, one in text.values.items()}}
