"""Short steps of fixed length with impulses, where events accumulate or no contact forces exist.

Moreau's midpoint rule: half a drift, the forces of the middle as an increment of velocity, impulses of all
points that touch there, the other half of the drift (Moreau, Unilateral Contact and Dry Friction in Finite
Freedom Dynamics, 1988; Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235). Impulses of resting contacts
exist where forces do not (Painleve's paradox), and no number of events within a step matters; its error is
of order one.
"""

from physicslab.kernels import Numbers, inlined, kernel
from physicslab.kernels.forces.force_calls import accelerate
from physicslab.kernels.rigid.complementarity import NOT_FOUND, solve_complementarity
from physicslab.kernels.rigid.constraints import apply, assemble, measure_all
from physicslab.kernels.rigid.equations import FREE, SLIDES_ON, EquationsTuple, named_equations
from physicslab.kernels.rigid.features import GAP, GIVEN, MU, SceneTuple, named_scene
from physicslab.kernels.rigid.touching import length_of

__all__ = ["drift", "kick", "separate"]

_SEPARATIONS = 2
"""How often bodies that overlap are moved apart: gaps are not linear in angles."""


@inlined
def _move(q: Numbers, v: Numbers, h: float) -> None:
    for i in range(len(q)):
        q[i] += h * v[i]


@kernel
def drift(q: Numbers, v: Numbers, h: float) -> None:
    """Move everything for ``h`` seconds at the speeds that it has."""
    _move(q, v, h)


@kernel
def kick(scene: SceneTuple, acceleration: Numbers, q: Numbers, v: Numbers, h: float) -> float:
    """Change speeds by the forces of ``h`` seconds; return the largest change of a body's velocity [m/s]."""
    of, largest = named_scene(scene), 0.0
    accelerate(q, v, acceleration, of.inverse_mass, of.damping, of.calls)
    _move(v, acceleration, h)
    for row in range(of.rows):
        if of.inverse_mass[2 * row] > 0.0:
            largest = max(largest, length_of(acceleration[2 * row], acceleration[2 * row + 1]))
    return h * largest


@kernel
def separate(scene: SceneTuple, equations: EquationsTuple, count: int, q: Numbers, v: Numbers) -> bool:
    """Move bodies that overlap apart, by the least that it takes; return whether that can be done.

    The ``count`` points that touch are pushed and never pulled, and friction plays no part.
    """
    of, points = named_scene(scene), named_equations(equations)
    for _ in range(_SEPARATIONS):
        measure_all(of, points, count, q, v)
        for i in range(count):
            points.measures[i, MU], points.points[i, GIVEN] = 0.0, SLIDES_ON
            points.vectors[FREE, 2 * i], points.vectors[FREE, 2 * i + 1] = points.measures[i, GAP], 0.0
        assemble(of, points, count)
        if solve_complementarity(points, count, 0.0, True) == NOT_FOUND:
            return False
        apply(of, points, count, q)
    return True
