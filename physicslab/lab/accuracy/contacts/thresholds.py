"""Polygons on slopes at their thresholds: from tan th = mu on they slide, from tan th = w/h on they topple.

Each case has two bodies on slopes of their own, 0.1 % below a threshold and 0.1 % above it. One stays where
it is, the other goes as a closed form or its equation of motion has it.
"""

import math
from functools import partial

from physicslab.components.vertices import regular
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.accuracy.contacts.case import ContactCase, Pose, pose_case
from physicslab.lab.accuracy.figures import number
from physicslab.lab.worlds import GRAVITY, empty_world
from physicslab.prefabs import box, polygon
from physicslab.world import World

_RADIUS = 0.5
_SHAPES = {
    "box": [Vector2(x, y) for x, y in ((-0.25, -0.5), (0.25, -0.5), (0.25, 0.5), (-0.25, 0.5))],
    "hexagon": list(regular(6, _RADIUS)),
}
_BASES = {"box": (0.5, 1.0), "hexagon": (_RADIUS, math.sqrt(3.0) * _RADIUS)}
"""The side that each stands on, and its height [m]: w and h of the threshold."""
_SLOPES = {"below": (0.999, -10.0), "above": (1.001, 10.0)}
"""Shares of a threshold, and where each slope is [m]."""
_GRADIENT = 0.4
"""The tangent of slopes on which bodies slide: less than any w/h here."""


def _pairs(shape: str, slides: bool) -> dict[str, tuple[float, float, Vector2]]:
    """Return for each body the angle of its slope [rad], the friction, and where it stands [m]."""
    width, height = _BASES[shape]
    found = {}
    for name, (share, x) in _SLOPES.items():
        angle = math.atan(_GRADIENT if slides else share * width / height)
        found[name] = angle, _GRADIENT / share if slides else 2.0, Vector2(x, 0.0)
    return found


def _two_slopes(shape: str, slides: bool, simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    for name, (angle, friction, at) in _pairs(shape, slides).items():
        normal = Vector2(math.sin(angle), math.cos(angle))
        box(world, at - normal * 0.5, width=12, height=1, angle=-angle, static=True, friction=friction)
        centre = at + normal * (0.5 * _BASES[shape][1])
        polygon(world, centre, _SHAPES[shape], angle=-angle, friction=friction, name=name)
    return world


def _slid(shape: str, t: float) -> dict[str, Pose]:
    poses = {}
    for name, (angle, friction, at) in _pairs(shape, True).items():
        s, c = math.sin(angle), math.cos(angle)
        way, half = max(0.0, 0.5 * GRAVITY * (s - friction * c) * t * t), 0.5 * _BASES[shape][1]
        poses[name] = at.x + way * c + half * s, half * c - way * s, -angle
    return poses


def _toppled(shape: str, t: float) -> dict[str, Pose]:
    """Return the poses of one that stands and one that turns on its lower corner, by its lean on record."""
    width, height = _BASES[shape]
    arm, inner = 0.5 * math.hypot(width, height), math.atan(width / height)
    poses = {}
    for name, (angle, _, at) in _pairs(shape, False).items():
        lean = number("topple_threshold", shape) if name == "above" else angle - inner
        x, y = at.x + 0.5 * width * math.cos(angle), -0.5 * width * math.sin(angle)
        poses[name] = x + arm * math.sin(lean), y + arm * math.cos(lean), -(inner + lean)
    return poses


def _pair(shape: str, *, slides: bool) -> ContactCase:
    does, condition = ("slide", "tan th = mu") if slides else ("topple", "tan th = w/h")
    return pose_case(
        f"{does}_at_{shape}", f"Polygons ({shape}) on slopes 0.1 % below and above {condition}",
        f"where both are after 1 s: one stays, one {does}s", partial(_two_slopes, shape, slides), (60,),
        partial(_slid if slides else _toppled, shape), group="sliding" if slides else "toppling",
        source="closed form" if slides else "an equation of motion, solved to 25 digits",
        wanted=1e-9 if slides else 1e-8,
    )  # fmt: skip


THRESHOLDS = tuple(_pair(shape, slides=slides) for slides in (True, False) for shape in _SHAPES)
"""Their cases."""
