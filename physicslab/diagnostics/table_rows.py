"""Rows of CSV: for programs, or for spreadsheets of languages that write numbers with a comma."""

import csv
import math
from collections.abc import Iterable
from typing import TextIO


class TableRows:
    """Writes rows to a stream.

    Parameters
    ----------
    stream : text stream
        Opened with ``newline=""``.
    for_excel : bool
        Semicolons between cells, commas in numbers, and a mark that it is UTF-8: Excel opens such a file as
        columns where the language of the computer has decimal commas. Otherwise commas and points.
    """

    def __init__(self, stream: TextIO, *, for_excel: bool = False) -> None:
        self._for_excel = for_excel
        self._rows = csv.writer(stream, delimiter=";" if for_excel else ",", lineterminator="\n")
        if for_excel:
            stream.write("\ufeff")

    def number(self, value: float) -> str:
        """Return a number with all its bits as text; one that is not finite is empty."""
        text = repr(float(value)) if math.isfinite(value) else ""
        return text.replace(".", ",") if self._for_excel else text

    def write(self, rows: Iterable[Iterable[object]]) -> None:
        """Write rows of texts and numbers."""
        if self._for_excel:
            rows = ([self.number(cell) if isinstance(cell, float) else cell for cell in row] for row in rows)
        self._rows.writerows(rows)
