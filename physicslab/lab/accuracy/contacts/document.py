"""What was found of a contact case, as a part of the lab's document."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from physicslab.lab.accuracy.contacts.study import ContactCurve, ContactStudy
from physicslab.lab.document import finite

__all__ = ["contact_document"]


def contact_document(study: ContactStudy) -> dict[str, Any]:
    """Return everything that was measured of a case."""
    case = study.case
    return {
        "name": case.name, "title": case.title, "group": case.group, "compared": case.compared,
        "measure": case.measure, "reference": case.source, "seconds": case.seconds, "wanted": case.wanted,
        "engines": [_engine(curve) for curve in study.curves],
    }  # fmt: skip


def _engine(curve: ContactCurve) -> dict[str, Any]:
    return {
        "name": curve.engine.name, "title": curve.engine.title, "order_measured": finite(curve.order),
        "verdict": None if curve.verdict is None else str(curve.verdict), "refused": curve.refused,
        "rows": [asdict(row) for row in curve.rows],
    }  # fmt: skip
