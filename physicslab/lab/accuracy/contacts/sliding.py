"""Bodies that stand, slide, roll and turn over: on floors, hills and slopes; round a planet."""

import math
from functools import partial

from physicslab.components import Mass, Material, Shape, Spring, Transform
from physicslab.components.vertices import regular
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.accuracy.contacts.study import ContactCase, Pose, pose_case
from physicslab.lab.accuracy.problem import number
from physicslab.lab.closed_forms import rolled, slid, stopped_by_friction
from physicslab.lab.worlds import GRAVITY, PLANETS, empty_world, floor
from physicslab.prefabs import box, circle, ground, polygon
from physicslab.world import World

_SLOPE = math.pi / 6.0
_SIZE, _SPEED, _MU = 0.5, 3.0, 0.3
_STIFFNESS, _PULLED = 20.0, 1.0
_RADIUS, _PULL = 5.5, 1000.0


def _stack(count: int, simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    floor(world)
    for i in range(count):
        box(world, (0, i + 0.5), width=1, height=1, friction=0.6, name=f"cube {i}")
    return world


def _places(count: int, t: float) -> dict[str, Pose]:
    return {f"cube {i}": (0.0, i + 0.5, 0.0) for i in range(count)}


def _on_slope(friction: float, simulation: SimulationConfig) -> World:
    """Return a block of 50 cm on a slope that falls to the right, whose upper face the origin is on."""
    world, normal = empty_world(simulation), Vector2(math.sin(_SLOPE), math.cos(_SLOPE))
    box(world, normal * -0.5, width=40, height=1, angle=-_SLOPE, static=True, friction=friction)
    start = normal * (0.5 * _SIZE)
    box(world, start, width=_SIZE, height=_SIZE, angle=-_SLOPE, friction=friction, name="block")
    return world


def _down_slope(friction: float, t: float) -> dict[str, Pose]:
    return {"block": _let_go_on(_SLOPE, friction, 0.5 * _SIZE, t)}


def _let_go_on(angle: float, friction: float, half: float, t: float, x: float = 0.0) -> Pose:
    """Return the pose of a block that slides down a slope, or stays; ``half`` its height [m].

    It was let go over a point at ``x`` of the face, which falls to the right.
    """
    s, c = math.sin(angle), math.cos(angle)
    way, _ = slid(0.0, GRAVITY * (friction * c - s), t)
    return x + way * c + half * s, half * c - way * s, -angle


def _thrown(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    floor(world, friction=_MU)
    box(world, (0, 0.5 * _SIZE), width=_SIZE, height=_SIZE, friction=_MU, velocity=(_SPEED, 0), name="block")
    return world


def _stopped(t: float) -> dict[str, Pose]:
    return {"block": (slid(_SPEED, _MU * GRAVITY, t)[0], 0.5 * _SIZE, 0.0)}


def _on_spring(simulation: SimulationConfig) -> World:
    """Return a block of 1 kg on a rough floor, whose spring is slack where its centre is at x = 0."""
    world = empty_world(simulation)
    floor(world, friction=_MU)
    block = box(world, (_PULLED, 0.5 * _SIZE), width=_SIZE, height=_SIZE, friction=_MU, name="block")
    world.spawn(Spring(block, anchor_b=(-3, 0.5 * _SIZE), rest_length=3.0, stiffness=_STIFFNESS))
    return world


def _swung(t: float) -> dict[str, Pose]:
    x = stopped_by_friction(_PULLED, math.sqrt(_STIFFNESS), _MU * GRAVITY / _STIFFNESS, t)
    return {"block": (x, 0.5 * _SIZE, 0.0)}


def _round_planet(simulation: SimulationConfig) -> World:
    world = empty_world(simulation, PLANETS)
    world.spawn(Transform(), Mass(_PULL), Shape.circle(5.0), Material(0.0, 0.0))
    speed = 0.5 * math.sqrt(_PULL / _RADIUS)
    circle(world, (0, _RADIUS), radius=0.5, mass=1e-3, friction=0, velocity=(-speed, 0), name="disc")
    return world


def _gone_round(t: float) -> dict[str, Pose]:
    turned = 0.5 * math.sqrt(_PULL / _RADIUS) / _RADIUS * t
    return {"disc": (-_RADIUS * math.sin(turned), _RADIUS * math.cos(turned), 0.0)}


_sliding = partial(pose_case, group="sliding")

SLIDING = (
    *(
        pose_case(
            f"rest_{count}", title, "where every cube is after 2 s", partial(_stack, count), (120,),
            partial(_places, count), group="resting", source="they stay where they were put",
        )
        for count, title in ((1, "A cube of 1 m on a floor"), (10, "Ten cubes of 1 m on each other"))
    ),
    _sliding(
        "slide_incline", "A block slides down 30 degrees, mu = 0.4", "where it is after 1 s",
        partial(_on_slope, 0.4), (60,), partial(_down_slope, 0.4),
    ),
    _sliding(
        "slide_held", "A block that friction holds on 30 degrees, mu = 0.6", "where it is after 1 s",
        partial(_on_slope, 0.6), (60,), partial(_down_slope, 0.6),
    ),
    _sliding(
        "slide_stop", "A block of 3 m/s slides to a stop, mu = 0.3", "where it is after 0.3 and 2 s", _thrown,
        (18, 120), _stopped,
    ),
    _sliding(
        "slide_spring", "A block on a spring of 20 N/m, with Coulomb friction, mu = 0.3",
        "where it is after 0.5 and 1.5 s, and at rest", _on_spring, (30, 90, 150), _swung,
    ),
    _sliding(
        "slide_planet", "A disc slides round a planet at half the orbital speed, without friction",
        "where it is after 4 s, two thirds of a round", _round_planet, (240,), _gone_round, wanted=1e-8,
    ),
)  # fmt: skip
"""Their cases."""


_R = 0.25
_DISC_SPEED, _DISC_MU = 3.0, 0.3
_SPIN, _GROOVE_MU = 20.0, 0.5
_HILL, _WHEEL, _LEAN, _SEGMENTS = 3.0, 0.5, 0.1, 72


def _thrown_disc(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    floor(world, friction=_DISC_MU)
    circle(world, (0, _R), radius=_R, friction=_DISC_MU, velocity=(_DISC_SPEED, 0), name="disc")
    return world


def _gone(t: float) -> dict[str, Pose]:
    way, _, rim, _ = rolled(_DISC_SPEED, _DISC_MU * GRAVITY, t)
    return {"disc": (way, _R, -rim / _R)}


def _groove(chained: bool, simulation: SimulationConfig) -> World:
    """Return a disc at the origin that spins between two planes of 45 degrees, of boxes or of a chain."""
    world, out = empty_world(simulation), (_R + 0.5) * math.sqrt(0.5)
    if chained:
        notch = -_R * math.sqrt(2.0)
        ground(world, [(2.0, 2.0 + notch), (0.0, notch), (-2.0, 2.0 + notch)], friction=_GROOVE_MU)
    for side in () if chained else (-1.0, 1.0):
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


def _over_hill(chained: bool, simulation: SimulationConfig) -> World:
    """Return a disc on a hill, which is a disc, or a chain of which the arcs are its circle."""
    world, away = empty_world(simulation), _HILL + _WHEEL
    if chained:
        outer = regular(_SEGMENTS, _HILL / math.cos(math.pi / _SEGMENTS))
        ground(world, [*outer, outer[0]], friction=2.0)
    else:
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
    x, y, angle = _standing(width, height, lean)
    box(world, (x, y), width=width, height=height, angle=angle, friction=2.0, name="box")
    return world


def _standing(width: float, height: float, lean: float, x: float = 0.0, y: float = 0.0) -> Pose:
    """Return the pose of a box on its corner at a point, its centre ``lean`` [rad] off the vertical."""
    arm, inner = 0.5 * math.hypot(width, height), math.atan(width / height)
    return x + arm * math.sin(lean), y + arm * math.cos(lean), -(inner + lean)


def _pivoted(width: float, height: float, key: str, t: float) -> dict[str, Pose]:
    return {"box": _standing(width, height, number("box_pivot", key))}


_rolling = partial(pose_case, group="rolling")
_EQUATION = "an equation of motion, solved to 25 digits"

ROLLING = (
    _rolling(
        "roll_slip", "A disc of 3 m/s that slides and then rolls, mu = 0.3",
        "where it is, and how far it has turned, after 0.2 and 1 s", _thrown_disc, (12, 60), _gone,
    ),
    *(
        _rolling(
            f"roll_groove{tail}", f"A disc of 20 rad/s spins down in a groove of 45 degrees{of}, mu = 0.5",
            "where it is, and how far it has turned, after 0.25 and 2 s", partial(_groove, chained),
            (15, 120), _spun, wanted=1e-8,
        )
        for tail, chained, of in (("", False, ""), ("_chain", True, ", a corner of a chain"))
    ),
    *(
        _rolling(
            f"roll_hill{tail}", f"A disc rolls over a round hill{of}",
            "where it is, and how far it has turned, after 1.5 s", partial(_over_hill, chained), (90,),
            _on_hill, source=_EQUATION, wanted=1e-8,
        )
        for tail, chained, of in (("", False, ""), ("_chain", True, f", a chain of {_SEGMENTS} segments"))
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


_HEXAGON = 0.5
_SHAPES = {
    "box": [Vector2(x, y) for x, y in ((-0.25, -0.5), (0.25, -0.5), (0.25, 0.5), (-0.25, 0.5))],
    "hexagon": list(regular(6, _HEXAGON)),
}
_BASES = {"box": (0.5, 1.0), "hexagon": (_HEXAGON, math.sqrt(3.0) * _HEXAGON)}
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
    half, slopes = 0.5 * _BASES[shape][1], _pairs(shape, True)
    return {name: _let_go_on(angle, mu, half, t, at.x) for name, (angle, mu, at) in slopes.items()}


def _toppled(shape: str, t: float) -> dict[str, Pose]:
    """Return the poses of one that stands and one that turns on its lower corner, by its lean on record."""
    width, height = _BASES[shape]
    poses = {}
    for name, (angle, _, at) in _pairs(shape, False).items():
        lean = number("topple_threshold", shape) if name == "above" else angle - math.atan(width / height)
        x, y = at.x + 0.5 * width * math.cos(angle), -0.5 * width * math.sin(angle)
        poses[name] = _standing(width, height, lean, x, y)
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
