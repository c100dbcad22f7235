"""The prose of the program is plain English: a sentence begins with its subject."""

import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "physicslab"
SUBJECT_LAST = re.compile(r'^\s*(?:"""|#)?\s*(?:What|Of) [a-z]', re.MULTILINE)
"""A line of prose that begins so is mostly a translation."""
NOT_OURS = re.compile(r"\b(?:nobody|somebody|hangs on|at the most|anew)\b", re.IGNORECASE)


@pytest.mark.parametrize("folder", sorted(path.name for path in PACKAGE.iterdir() if path.is_dir()))
def test_sentences_begin_with_their_subject(folder: str) -> None:
    found = [
        f"{path.relative_to(PACKAGE)}:{text.count('\n', 0, match.start()) + 1}: {match.group().strip()}"
        for path in sorted((PACKAGE / folder).rglob("*.py"))
        for text in [path.read_text(encoding="utf-8")]
        for pattern in (SUBJECT_LAST, NOT_OURS)
        for match in pattern.finditer(text)
    ]
    assert not found, "\n".join(found)
