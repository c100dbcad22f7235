"""Andrews' squeezing mechanism: seven bodies on ten pins, a motor and a spring, without gravity.

Data and equations: Hairer & Wanner, Solving Ordinary Differential Equations II, 1996, VII.7, and the
problem ``andrews`` of Mazzia & Magherini's Test Set for IVP Solvers (2008). Its coordinates are angles, some
of them against each other: beta, theta, gamma, phi, delta, omega and epsilon. Its multipliers are the forces
of the three pins where four bodies meet.
"""

import math

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Pin, Spring, Thrust, Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import rotated
from physicslab.lab.accuracy.problem import Ladder, Problem, number
from physicslab.lab.worlds import empty_world
from physicslab.world import World

_TIME = 0.03
_START = (
    -0.0617138900142764496358948458001, 0.0, 0.455279819163070380255912382449,
    0.222668390165885884674473185609, 0.487364979543842550225598953530, -0.222668390165885884674473185609,
    1.23054744454982119249735015568,
)  # fmt: skip
"""The coordinates at first [rad]."""
_MASSES = 0.04325, 0.00365, 0.02373, 0.00706, 0.0705, 0.00706, 0.05498
_INERTIAS = 2.194e-6, 4.41e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5
_O, _A, _B, _C = (0.0, 0.0), (-0.06934, -0.00227), (-0.03635, 0.03273), (0.014, 0.072)
"""Points of the ground [m]: where the first body turns, the fifth and the seventh, the third; the spring."""
_TORQUE, _STIFFNESS, _REST = 0.033, 4530.0, 0.07785
_PINS = (
    (0, 1, _O, (0.0, 0.0)), (1, 2, (0.007, 0.0), (0.0, 0.0)), (0, 3, _B, (0.0, 0.0)), (0, 5, _A, (0.0, 0.0)),
    (0, 7, _A, (0.0, 0.0)), (5, 4, (0.04, 0.0), (0.0, 0.0)), (7, 6, (0.0, -0.04), (0.0, 0.0)),
    (2, 3, (-0.028, 0.0), (0.0, -0.035)), (2, 4, (-0.028, 0.0), (0.0, -0.02)),
    (2, 6, (-0.028, 0.0), (0.02, 0.0)),
)  # fmt: skip
"""Bodies A and B of each pin, 0 is the ground, and where it is in their frames [m]; a body's begins where it
turns about the one before it. The forces of the last three are compared."""
_MIDDLES = (
    (0.00092, 0.0), (-0.0115, 0.0), (0.01043, -0.01874), (0.0, -0.00579), (0.02308, 0.00916), (0.00579, 0.0),
    (0.01228, -0.00449),
)  # fmt: skip
"""The centres of mass in those frames [m]."""
_SPRING_AT = 0.02, -0.018
"""Where the spring pulls the third body, in that frame [m]."""


def _angles(q: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how bodies are turned (7,) [rad], from the coordinates."""
    beta, theta, gamma, phi, delta, omega, epsilon = q
    return np.array((beta, beta + theta, gamma, phi + delta, delta, omega + epsilon, epsilon))


def _build(simulation: SimulationConfig) -> World:
    """Return the mechanism at rest."""
    world, angles = empty_world(simulation, gravity=None), _angles(np.array(_START))
    origins, bodies = {1: np.array(_O), 3: np.array(_B), 5: np.array(_A), 7: np.array(_A)}, [0]
    for a, b, at, _ in _PINS[:7]:
        if a:
            origins[b] = origins[a] + rotated(np.array(at), angles[a - 1])
    for n, (middle, mass, inertia) in enumerate(zip(_MIDDLES, _MASSES, _INERTIAS, strict=True)):
        where = origins[n + 1] + rotated(np.array(middle), angles[n])
        placed = Transform(where, float(angles[n]))
        bodies.append(world.spawn(placed, Velocity(), Mass(mass, inertia=inertia), name=f"k{n + 1}"))
    world.add(bodies[1], Thrust(torque=_TORQUE))
    for a, b, at_a, at_b in _PINS:
        anchors = _from_middle(a, at_a), _from_middle(b, at_b)
        world.spawn(Pin(bodies[a] or None, bodies[b], *anchors))
    arm = _from_middle(3, _SPRING_AT)
    world.add(bodies[3], Spring(anchor_a=arm, anchor_b=_C, stiffness=_STIFFNESS, rest_length=_REST))
    return world


def _from_middle(body: int, at: tuple[float, float]) -> tuple[float, float]:
    """Return a point of a body from its centre of mass [m]."""
    x, y = _MIDDLES[body - 1] if body else (0.0, 0.0)
    return at[0] - x, at[1] - y


def _found(world: World) -> NDArray[np.float64]:
    """Return coordinates, their rates, their accelerations, and the forces of three pins (27,)."""
    bodies = [world.entity(f"k{n}") for n in range(1, 8)]
    turned = [world.component(body, Transform) for body in bodies]
    angles = np.array([one.angle for one in turned])
    spins = np.array([world.component(body, Velocity).angular for body in bodies])
    torques, forces = np.zeros(7), world.joints.force.reshape(-1, 2)
    torques[0] = _TORQUE
    arm = rotated(np.array(_from_middle(3, _SPRING_AT)), angles[2])
    way = np.array(_C) - (np.array(tuple(turned[2].position)) + arm)
    length = math.hypot(*way)
    torques[2] = _STIFFNESS * (length - _REST) / length * (arm[0] * way[1] - arm[1] * way[0])
    for (a, b, at_a, at_b), force in zip(_PINS, forces, strict=True):
        for body, at, pull in ((a, at_a, -force), (b, at_b, force)):
            if body:
                x, y = rotated(np.array(_from_middle(body, at)), angles[body - 1])
                torques[body - 1] += x * pull[1] - y * pull[0]
    parts = [_coordinates(of) for of in (angles, spins, torques / np.array(_INERTIAS))]
    return np.concatenate((*parts, forces[7:].ravel()))


def _coordinates(of: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the coordinates, or rates of them, from the angles of bodies (7,)."""
    k1, k2, k3, k4, k5, k6, k7 = of
    return np.array((k1, k2 - k1, k3, k4 - k5, k5, k6 - k7, k7))


def _error(world: World, _i: int) -> float:
    """Return the largest error of the 27 values, of those above 1 as a share of them."""
    expected = np.array([number("andrews", f"y{n}") for n in range(1, 28)])
    return float((np.abs(_found(world) - expected) / np.maximum(1.0, np.abs(expected))).max())


ANDREWS = Problem(
    name="andrews", title="Andrews' squeezing mechanism: seven bodies, ten pins", group="mechanism",
    compared="angles, their rates, accelerations and forces in three pins after 0.03 s", times=(_TIME,),
    measure="largest error of 27 values, of those above 1 as a share",
    build=_build, error=_error, good=1e-6, excellent=1e-8, ladder=Ladder(2048), dt=1e-3, keeps=frozenset(),
)  # fmt: skip
