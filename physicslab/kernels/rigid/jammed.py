"""Sliding that no contact forces go on with: it stops at once, by impulses, though nothing approaches.

Points that slide have their friction given, and what they press may then press them the more: there may be
no forces that keep all laws (Painleve's paradox; piles that come to rest have it often). Impulses keep them:
those of a short step in the limit of no time (a tangential impact, or an impact without collision; Genot &
Brogliato, Eur. J. Mech. A/Solids 18 (1999) 653). In that limit no body moves, so nothing overlaps.
"""

from physicslab.kernels import Numbers, always_inlined
from physicslab.kernels.joints.layout import ROWS
from physicslab.kernels.rigid.budget import book_contacts
from physicslab.kernels.rigid.complementarity import NOT_FOUND, SETTLED, solve_complementarity
from physicslab.kernels.rigid.constraints import apply, measure_all
from physicslab.kernels.rigid.equations import FREE, SLIDES_ON, STICKS, UNKNOWN, Equations
from physicslab.kernels.rigid.features import GIVEN, MU, PAIR, STATUS, VN, VT, Points, RigidScene
from physicslab.kernels.rigid.joined import book_answer
from physicslab.kernels.rigid.least_norm import solve_equations
from physicslab.kernels.rigid.touching import SLOW

_NO_TIME = 0.01
"""Largest speed that forces give in the moment of the impulses, as a share of that treated as zero."""


@always_inlined
def stop_sliding(
    scene: RigidScene, equations: Equations, count: int, changed: Points, q: Numbers, v: Numbers, rest: float
) -> bool:
    """Let impulses act at ``count`` closed points whose free rates are known; return whether any slides less.

    The state of each point is found with the speeds that forces would give in a moment, the impulses without
    these. The points of ``changed`` are forgotten.
    """
    points, measures, vectors, largest = equations.points, equations.measures, equations.vectors, 0.0
    for i in range(2 * count):
        largest = max(largest, abs(vectors[FREE, i]))
    moment = _NO_TIME * rest / largest if largest > 0.0 else 0.0
    for i in range(count):
        points[i, GIVEN] = STICKS if measures[i, MU] > 0.0 else SLIDES_ON
        vectors[FREE, 2 * i] = measures[i, VN] + moment * vectors[FREE, 2 * i]
        vectors[FREE, 2 * i + 1] = measures[i, VT] + moment * vectors[FREE, 2 * i + 1]
    found = solve_complementarity(equations, count, 0.0, True)
    if found == NOT_FOUND:
        return False
    for i in range(count):
        vectors[FREE, 2 * i], vectors[FREE, 2 * i + 1] = measures[i, VN], measures[i, VT]
    if found == SETTLED:
        solve_equations(equations, count, 1.0)
    apply(scene, equations, count, v)
    measure_all(scene, equations, count, q, v)
    stopped: bool = changed[0, PAIR] >= 0
    changed[0, PAIR] = -1
    for i in range(count):
        before, after = vectors[FREE, 2 * i + 1], measures[i, VT]
        back = after if before < 0.0 else -after
        stopped = stopped or (abs(before) > SLOW * rest and back >= -SLOW * rest)
        # Impulses act along the mean of the speeds before and after.
        points[i, STATUS], measures[i, VT] = SLIDES_ON, 0.5 * (before + after)
    book_contacts(scene, equations, count, q, v, v)
    if scene.joints[ROWS] > 0:
        book_answer(scene, points, measures, vectors[UNKNOWN], count, q, v, v)
    return stopped
