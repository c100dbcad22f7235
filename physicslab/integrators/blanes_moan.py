"""Blanes and Moan's method of order 6 for forces that depend on positions alone."""

from physicslab.integrators.integrator import Integrator, Splitting

_KICKS = (
    0.0414649985182624, 0.198128671918067, -0.0400061921041533, 0.0752539843015807, -0.0115113874206879,
)  # fmt: skip
_DRIFTS = (
    0.123229775946271, 0.290553797799558, -0.127049212625417, -0.246331761062075, 0.357208872795928,
)  # fmt: skip
_KICK, _DRIFT = 0.5 - sum(_KICKS), 1.0 - 2.0 * sum(_DRIFTS)

BLANES_MOAN = Integrator(
    name="blanes_moan",
    title="Blanes-Moan 6 (11 stages)",
    order=6,
    evaluations=11,
    stability_limit=9.07,
    symplectic=True,
    source="Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313, table 3, order 6, 11 stages",
    flow=Splitting(
        drifts=(*_DRIFTS, _DRIFT, *reversed(_DRIFTS)), kicks=(*_KICKS, _KICK, _KICK, *reversed(_KICKS))
    ),
    positions_only=True,
    phase_share=8.08e-8,
    phase_order=6,
)
