"""Leapfrog in its drift-kick-drift form."""

from dataclasses import replace

from physicslab.integrators.integrator import Integrator, Splitting
from physicslab.systems.system import Stage

# Between the two half kicks, positions and velocities are both those of the middle of the substep. Impacts
# are resolved there: turning a velocity round at the place it belongs to leaves the energy as it was. The
# contact solver needs the whole kick, or a body at rest would sag by half of one in every substep.
LEAPFROG = Integrator(
    name="leapfrog",
    title="Leapfrog (drift-kick-drift)",
    order=2,
    evaluations=1,
    stability_limit=2.0,
    symplectic=True,
    source="Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, I.1.4",
    flow=Splitting(drifts=(0.5, 0.5), kicks=(0.0, 1.0, 0.0)),
    positions_only=True,
    substep=(
        (Stage.DRIFT, 0.5),
        (Stage.FORCE, 1.0),
        (Stage.KICK, 0.5),
        (Stage.BROAD_PHASE, 1.0),
        (Stage.CONTACT, 1.0),
        (Stage.IMPACT, 1.0),
        (Stage.KICK, 0.5),
        (Stage.SOLVE, 1.0),
        (Stage.DRIFT, 0.5),
        (Stage.RELAX, 0.5),
    ),
    window=(-0.5, 0.5),
    phase_share=1.0 / 24.0,
)

_PREDICTED = ((Stage.PREDICT, 0.5), (Stage.SOLVE, 1.0), (Stage.PREDICT, -0.5))

# Sub-integrated bodies (see physicslab.stepping.split_forces) are not kicked: the contact solver
# gets their predicted velocity.
LEAPFROG_WITH_SPLIT_FORCES = replace(
    LEAPFROG,
    substep=tuple(
        part
        for stage in LEAPFROG.substep
        for part in (_PREDICTED if stage == (Stage.SOLVE, 1.0) else (stage,))
    ),
)
