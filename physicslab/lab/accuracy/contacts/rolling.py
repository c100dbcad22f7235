"""Discs that come to roll, spin down in a groove and roll over a hill; boxes that turn over."""

import math
from functools import partial

from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.contacts.case import Pose, pose_case
from physicslab.lab.accuracy.figures import number
from physicslab.lab.closed_forms import rolled
from physicslab.lab.worlds import GRAVITY, empty_world, floor
from physicslab.prefabs import box, circle
from physicslab.world import World

_R = 0.25
_SPEED, _MU = 3.0, 0.3
_SPIN, _GROOVE_MU = 20.0, 0.5
_HILL, _WHEEL, _LEAN = 3.0, 0.5, 0.1


def _thrown(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    floor(world, friction=_MU)
    circle(world, (0, _R), radius=_R, friction=_MU, velocity=(_SPEED, 0), name="disc")
    return world


def _gone(t: float) -> dict[str, Pose]:
    way, _, rim, _ = rolled(_SPEED, _MU * GRAVITY, t)
    return {"disc": (way, _R, -rim / _R)}


def _groove(simulation: SimulationConfig) -> World:
    """Return a disc at the origin that spins between two planes of 45 degrees."""
    world, out = empty_world(simulation), (_R + 0.5) * math.sqrt(0.5)
    for side in (-1.0, 1.0):
        box(
            world, (side * out, -out), width=4, height=1, angle=side * 0.25 * math.pi, static=True,
            friction=_GROOVE_MU,
        )  # fmt: skip
    circle(world, (0, 0), radius=_R, friction=_GROOVE_MU, angular_velocity=_SPIN, name="disc")
    return world


def _spun(t: float) -> dict[str, Pose]:
    """Return how far a disc has turned that two faces slow: each with mu of what presses on it.

    Friction on either face acts along it: statics give the sum of what presses as sqrt(2) g / (1 + mu^2).
    """
    slowing = 2.0 * _GROOVE_MU / _R * math.sqrt(2.0) * GRAVITY / (1.0 + _GROOVE_MU**2)
    t = min(t, _SPIN / slowing)
    return {"disc": (0.0, 0.0, _SPIN * t - 0.5 * slowing * t * t)}


def _over_hill(simulation: SimulationConfig) -> World:
    world, away = empty_world(simulation), _HILL + _WHEEL
    circle(world, (0, 0), radius=_HILL, static=True, friction=2.0)
    start = away * math.sin(_LEAN), away * math.cos(_LEAN)
    circle(world, start, radius=_WHEEL, friction=2.0, name="disc")
    return world


def _on_hill(t: float) -> dict[str, Pose]:
    lean, away = number("rolling_over_a_hill", "lean"), _HILL + _WHEEL
    turned = -(lean - _LEAN) * away / _WHEEL
    return {"disc": (away * math.sin(lean), away * math.cos(lean), turned)}


def _on_corner(width: float, height: float, lean: float, simulation: SimulationConfig) -> World:
    """Return a box that stands on its corner at the origin, its centre ``lean`` [rad] off the vertical."""
    world = empty_world(simulation)
    floor(world, friction=2.0)
    arm, inner = 0.5 * math.hypot(width, height), math.atan(width / height)
    start = arm * math.sin(lean), arm * math.cos(lean)
    box(world, start, width=width, height=height, angle=-(inner + lean), friction=2.0, name="box")
    return world


def _pivoted(width: float, height: float, key: str, t: float) -> dict[str, Pose]:
    lean = number("box_pivot", key)
    arm, inner = 0.5 * math.hypot(width, height), math.atan(width / height)
    return {"box": (arm * math.sin(lean), arm * math.cos(lean), -(inner + lean))}


_rolling = partial(pose_case, group="rolling")
_EQUATION = "an equation of motion, solved to 25 digits"

ROLLING = (
    _rolling(
        "roll_slip", "A disc of 3 m/s that slides and then rolls, mu = 0.3",
        "where it is, and how far it has turned, after 0.2 and 1 s", _thrown, (12, 60), _gone,
    ),
    _rolling(
        "roll_groove", "A disc of 20 rad/s spins down in a groove of 45 degrees, mu = 0.5",
        "where it is, and how far it has turned, after 0.25 and 2 s", _groove, (15, 120), _spun, wanted=1e-8,
    ),
    _rolling(
        "roll_hill", "A disc rolls over a round hill", "where it is, and how far it has turned, after 1.5 s",
        _over_hill, (90,), _on_hill, source=_EQUATION, wanted=1e-8,
    ),
    *(
        pose_case(
            f"pivot_{key}", f"A box of {width:g} m by {height:g} m turns over on its corner",
            "where it is, and its angle, after 0.4 s", partial(_on_corner, width, height, lean), (24,),
            partial(_pivoted, width, height, key), group="toppling", source=_EQUATION, wanted=1e-8,
        )
        for key, width, height, lean in (("cube", 1.0, 1.0, 0.3), ("tall", 0.5, 1.5, 0.05))
    ),
)  # fmt: skip
"""Their cases."""
