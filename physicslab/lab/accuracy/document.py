"""The results of the accuracy lab, as a document."""

from collections.abc import Mapping, Sequence
from typing import Any

from physicslab.lab.accuracy.catalogue import LEFT_OUT
from physicslab.lab.accuracy.contacts.study import ContactStudy
from physicslab.lab.accuracy.figures import record
from physicslab.lab.accuracy.honesty.study import QUANTITIES, HonestRow, share_of
from physicslab.lab.accuracy.scene_study import ESTIMATE, SceneStudy
from physicslab.lab.accuracy.study import MethodCurve, Study
from physicslab.lab.accuracy.trust import Trust, trust_report
from physicslab.lab.accuracy.trust_rows import TrustRow, summarise
from physicslab.lab.document import lab_document, pick, plain


def document(
    studies: Sequence[Study], scenes: Sequence[SceneStudy] = (), contacts: Sequence[ContactStudy] = ()
) -> dict[str, Any]:
    """Return everything that was measured."""
    return lab_document(
        "accuracy",
        peers=any(curve.rows and not curve.method.own for study in contacts for curve in study.curves),
        problems=[_study(study) for study in studies],
        contacts=[_contacts(study) for study in contacts],
        scenes=[_scene(study) for study in scenes],
        left_out=[{"name": name, "reason": reason} for name, reason in LEFT_OUT.items()],
    )


def trust_document(
    rows: Sequence[TrustRow], scenes: Mapping[str, Trust], random: Sequence[HonestRow] = ()
) -> dict[str, Any]:
    """Return estimates of errors beside true errors, and what can be relied on in scenes by their names."""
    found, share = summarise(rows), share_of(random)
    problems = [
        pick(row.case, "name", "measure") | pick(row, "method", "estimate", "error", "ratio", "near")
        for row in rows
    ]
    return lab_document(
        "trust",
        problems=problems,
        summary=pick(found, "known", "near", "largest", "holds"),
        random=[{**plain(row), "ratios": dict(zip(QUANTITIES, row.ratios, strict=False))} for row in random],
        honest=pick(share, "known", "honest", "too_large", "worst", "holds")
        | {"honest": dict(zip(QUANTITIES, share.honest, strict=True))},
        scenes=[{"name": name, **trust_report(trust)} for name, trust in scenes.items()],
    )


def _study(study: Study) -> dict[str, Any]:
    problem = study.problem
    against = "the energy at the start" if "energy" in problem.keeps else None
    return {
        **pick(problem, "name", "title", "group"), "source": problem.family,
        "reference": record(problem.family)["method"],
        **pick(problem, "compared", "measure", "seconds", "good", "excellent"),
        "rounding_floor": study.floor,
        "energy_against": "the exact energy at that time" if problem.exact_energy else against,
        "note": problem.note, **pick(study, "best", "auto", "rigid"),
        "integrators": [_curve(curve) for curve in study.curves],
    }  # fmt: skip


def _curve(curve: MethodCurve) -> dict[str, Any]:
    measured = {"order_measured": curve.order, "order_short": curve.short}
    return pick(curve.method, "name", "title", "order") | measured | pick(curve, "refused", "rows")


def _contacts(study: ContactStudy) -> dict[str, Any]:
    case = study.case
    engines = [
        pick(curve.method, "name", "title")
        | {"order_measured": curve.order}
        | pick(curve, "verdict", "refused", "rows")
        for curve in study.curves
    ]
    names = pick(case, "name", "title", "group", "compared", "measure")
    return names | {"reference": case.source} | pick(case, "seconds", "wanted") | {"engines": engines}


def _scene(study: SceneStudy) -> dict[str, Any]:
    estimate = pick(study.estimate, "error", "worst", "order", "order_reason", "variants", "failure")
    return {
        "scene": study.name, "seconds": study.seconds, "kind": ESTIMATE, "reference": study.reference,
        "estimate": estimate, "rows": study.rows, "horizon_s": study.horizon_s,
    }  # fmt: skip
