"""Semi-implicit Euler."""

from physicslab.integrators.integrator import Integrator, Splitting
from physicslab.systems.system import Stage

SYMPLECTIC_EULER = Integrator(
    name="symplectic_euler",
    title="Semi-implicit (symplectic) Euler",
    order=1,
    evaluations=1,
    stability_limit=2.0,
    symplectic=True,
    source="Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, I.1.2",
    flow=Splitting(drifts=(1.0,), kicks=(1.0, 0.0)),
    substep=(
        (Stage.FORCE, 1.0),
        (Stage.KICK, 1.0),
        (Stage.BROAD_PHASE, 1.0),
        (Stage.CONTACT, 1.0),
        (Stage.IMPACT, 1.0),
        (Stage.SOLVE, 1.0),
        (Stage.DRIFT, 1.0),
        (Stage.RELAX, 1.0),
    ),
    window=(0.0, 1.0),
    phase_share=1.0 / 24.0,
)
