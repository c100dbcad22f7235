"""Tables for the terminal."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

type Row = Sequence[str]


@dataclass(frozen=True, slots=True)
class Columns:
    """How wide the columns of a table are [letters], and which of them, with words, stand to the left.

    Examples
    --------
    >>> Columns((6, 4), words={0}).line(["ball", "2.5"])
    'ball     2.5'
    """

    widths: tuple[int, ...]
    words: Collection[int] = (0,)

    def line(self, row: Row) -> str:
        """Return a row as a line."""
        cells = (
            f"{text:{'<' if i in self.words else '>'}{width}}"
            for i, (text, width) in enumerate(zip(row, self.widths, strict=True))
        )
        return "  ".join(cells).rstrip()


def table(rows: Sequence[Row], words: Collection[int] = (0,), indent: str = "") -> str:
    """Return rows as lines, their columns as wide as what is in them: ``words`` left, numbers right."""
    columns = Columns(tuple(max(map(len, column)) for column in zip(*rows, strict=True)), words)
    return "\n".join(indent + columns.line(row) for row in rows)


def cell(number: float | None, form: str) -> str:
    """Return a number in a format, or a dash where there is none.

    >>> cell(0.125, ".1e"), cell(None, ".1e")
    ('1.2e-01', '-')
    """
    return "-" if number is None else format(number, form)
